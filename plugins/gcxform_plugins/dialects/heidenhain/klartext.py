"""Programs of a TNC: their frame, tools, functions and labels, statement by statement."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from decimal import Decimal
from math import isnan
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.cycles import AUTO
from gcxform_plugins.dialects.heidenhain.datums import VALUE
from gcxform_plugins.dialects.heidenhain.fetching import told_of
from gcxform_plugins.dialects.heidenhain.lines import BEGIN_PGM
from gcxform_plugins.dialects.heidenhain.moves import retracts
from gcxform_plugins.dialects.heidenhain.parameters import NAMED
from gcxform_plugins.dialects.heidenhain.planes import Planes
from gcxform_plugins.dialects.heidenhain.words import MM, exact, goes_on, plain, written

BEGIN = re.compile(r"BEGIN\s+PGM\b.*?\b(MM|INCH)\s*")
OWN_NAME = re.compile(
    r"BEGIN\s+PGM\s+([^\s;]|[^\s;][^;]*?[^\s;])\s+(?:MM|INCH)\s*(?:;|$)", re.IGNORECASE
)
END = re.compile(r"END\s+PGM\b(?:.*?\b(MM|INCH))?.*")
TOOL = re.compile(rf"TOOL\s+DEF\s*(\d{{1,9}})(?:\s+L\s*({VALUE}))?(?:\s+R\s*({VALUE}))?\s*")
FETCHED = re.compile(r'TOOL\s+DEF\s*"([^"]*)"\s*$', re.IGNORECASE)
BLANK = re.compile(r"[\s\d/]*BLK(?![A-Z])", re.IGNORECASE)
OPEN = re.compile(rf"{NAMED.pattern}|(?<![A-Z])LBL(?![A-Z])")
FIRST_WORD = re.compile(r"TOOL|[A-Z]+")
TCPM = "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS"
RESET = "FUNCTION RESET TCPM"
OTHERWISE = {
    "F CONT": "F is then that of the axes, and not that of the tip",
    "AXIS SPAT": "angles are then those of space, and not those of the axes",
    "PATHCTRL VECTOR": "the tool axis then stays in a plane; write PATHCTRL AXIS",
    "REFPNT": "the control then follows another point of the tool",
}
ONE_LINE = re.compile(
    r"[\s\d/]*(?:[;*]|(?:L|LP|C|CC|CP|CR|CT|RND|CHF|APPR|DEP|M|STOP|TOOL)(?![A-Z]))", re.IGNORECASE
)
"""Statements that are read from one line."""
COMMENT = re.compile(r"[\s\d]*;")
UNNUMBERED = re.compile(r"\s*[^\s\d;]")
LBL_0 = "write LBL 0 where it ends, behind what it does"
ENDS_ALL = "END PGM behind a label that nothing stands behind ends the program"
NOTHING = re.compile(r"[\s\d/]*(?:[;*].*)?")
"""A line that does nothing."""
LONGEST_TOOL = 9  # digits
RADIUS = "Q108"
RADIUS_TOLD = "Q108 is the radius of the tool in the machine file, and DR of TOOL CALL"


class Klartext(Planes):
    """Turns the statements of a TNC into blocks of words."""

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self.begun = False
        self.axis = self.tool_name = ""
        self.tool = ""
        self.statements: dict[str, Callable[[Sequence[gx.Item]], list[str]]] = {
            "L": self.straight,
            "LP": self.polar_line,
            "C": self.circle,
            "CP": self.polar_circle,
            "CR": self.by_radius,
            "CT": self.tangential,
            "RND": self.rounded,
            "onto": self.along_contour,
            "CHF": self.rounded,
            "centre": self.centre,
            "tool_call": self.tool_call,
            "stop": self.stop,
            "m": self.functions,
            "text": self.text,
        }
        self.texts: dict[str, Callable[[gx.Item], list[str]]] = {
            "BEGIN": self._begin,
            "END": self._end,
            "BLK": self._blank,
            "TOOL": self._tool_def,
            "CYCL": self.define,
            "CYCLE": self.define,
            "LBL": self.label,
            "CALL": self.call,
            "SEL": self.select,
            "TRANS": self.transformed,
            "PATTERN": self.pattern,
            "PLANE": self.plane_of,
            **dict.fromkeys(("FN", "Q", "QL", "QR", "QS"), self.computed),
            **dict.fromkeys(("FL", "FLT", "FC", "FCT", "FPOL"), self.free),
            "FUNCTION": self._function_of,
        }

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a statement. Block numbers count nothing."""
        first = items[0]
        if first.kind == "seq":
            items = items[1:]
            if not items:
                return ()
            first = items[0]
        kind = first.kind
        if kind == "structure":
            if self.reading.asides:
                return [gx.Speller.aside(self.statement)]
            words = self.lines[self.line].partition("*")[2].lstrip("* -")
            return [f"({words.strip().translate(BRACKETS)})"]
        if kind == "outside" and not self.begun:
            return []
        if kind == "outside":
            raise self.refusal("GX101", "a bracket begins no block of the program", first)
        if not self.begun and not (kind == "text" and first.name.startswith("BEGIN")):
            raise self.refusal("GX101", "a program begins with BEGIN PGM", first)
        self.check_tilt(items)
        blocks = self.statements[first.name if kind == "path" else kind](items)
        blocks += self.stood()
        if self.over:
            self.at = len(self.lines)
        return blocks

    def closing(self) -> Iterable[str]:
        """Return nothing. Raises InputError for a program that breaks off."""
        if self.begun and not self.over:
            raise self.refusal("GX222", "the program breaks off: END PGM is missing")
        return ()

    # --- statements ---

    def text(self, items: Sequence[gx.Item]) -> list[str]:
        """Return the blocks of what is no path function."""
        item = items[0]
        name = item.name
        word = FIRST_WORD.match(name)
        assert word is not None
        read = self.texts.get(word[0])
        if read is not None:
            return read(item)
        self.refuse(f"{name.strip()[:40]} is not resolved", item)

    def _begin(self, item: gx.Item) -> list[str]:
        match = BEGIN.fullmatch(item.name)
        self._check_continued()
        if match is not None and self.calls and self.line == self.calls[-1].first:
            if (match[1] == "INCH") != self.inch:
                self.refuse("a program in another unit is called", item)
            return []
        if match is None or self.begun:
            raise self.refusal("GX101", "BEGIN PGM stands once, and ends with MM or INCH", item)
        self.begun, self.inch = True, match[1] == "INCH"
        for axis, value in self.reading.start.items():
            scale = MM if self.inch and axis not in "ABC" else 1.0
            self.place[axis] = exact(Decimal(repr(value / scale)))
        own = OWN_NAME.search(self.lines[self.line])
        text = f"{BEGIN_PGM}{own[1] if own else ''}"
        name = [gx.Speller.aside(text)] if self.reading.asides else []
        return [" ".join([f"{'G20' if self.inch else 'G21'} G17 G90 G94", *name])]

    def _check_continued(self) -> None:
        """Refuse a line without a number behind `~` of which it is not certain what it is.

        It may be a part of the comment before it, or words: where it can be no words it is taken
        for the former. Raises InputError.
        """
        lines = self.lines
        for k in [k for k in range(self.line, len(lines) - 1) if "~" in lines[k]]:
            if goes_on(lines[k]) and ONE_LINE.match(lines[k]) and UNNUMBERED.match(lines[k + 1]):
                if COMMENT.match(lines[k]) and self._says_nothing(lines[k + 1]):
                    self.take_for(k + 1, f";{lines[k + 1]}")
                    continue
                message = "this line goes on with the one before it, which ends in ~"
                hint = "take ~ away, or make one line of both"
                place = 0, len(lines[k + 1])
                raise self.error_at(k + 1, "GX210", message, place, hint)

    def _says_nothing(self, text: str) -> bool:
        """Whether a line is no statement."""
        try:
            return all(item.kind == "outside" for item in self.items_in(text))
        except gx.InputError:
            return True

    def _end(self, item: gx.Item) -> list[str]:
        match = END.fullmatch(item.name)
        if match is None or (match[1] and (match[1] == "INCH") != self.inch):
            raise self.refusal("GX101", "this is not the END PGM of this program", item)
        while self.calls and self.calls[-1].lines is None:
            if not all(map(NOTHING.fullmatch, self.lines[self.calls[-1].first + 1 : self.line])):
                raise self.refusal("GX223", "a subprogram does not end with LBL 0", item, LBL_0)
            self.assumed[ENDS_ALL] = None
            self.go_back()
        if self.calls:
            self.go_back()
            return []
        self.over = True
        return ["M2"]

    def _blank(self, item: gx.Item) -> list[str]:
        """BLK FORM: the blank, which is only drawn: not by parameters and labels, which are gone.

        Its two corners stand in two lines.
        """
        near = self.lines[max(self.line - 1, 0) : self.line + 2]
        open_ = any(BLANK.match(each) and OPEN.search(each.upper()) for each in near)
        return [] if open_ else self.along()

    def stop(self, items: Sequence[gx.Item]) -> list[str]:
        """STOP: the program waits."""
        self.spindle, self.untold = "", False
        return self._all(self.said(items[1:]), "M0")

    def functions(self, items: Sequence[gx.Item]) -> list[str]:
        """M functions in a block of their own."""
        if retracts(items):
            return self.retracted(items[0])
        said = self.said(items)
        wrong = said.machine or next(iter(said.axes), None)
        if wrong or said.radius or said.sense:
            raise self.refusal("GX101", "coordinates without a path function", wrong)
        self.keep_side(said)
        return self._all(said, said.feed.strip())

    # --- tools ---

    def tool_call(self, items: Sequence[gx.Item]) -> list[str]:
        """TOOL CALL: the tool with its length, then speed and feed."""
        if self.following:
            self.refuse(
                "TOOL CALL while the control follows the tip", items[0], "write M129 before"
            )
        self.tool, self.tool_name, self.tool_feed = "", "", ""
        self.assigned(AUTO)
        words = "".join(self._tool_word(item) for item in items[1:] if item.kind != "delta")
        deltas = self._deltas([item for item in items if item.kind == "delta"])
        if not self.tool and (deltas or self.deltas):
            self.refuse(
                "TOOL CALL without a tool, and DL or DR: which hold is not certain", items[0]
            )
        if self.axis not in ("Z", "") or (self.tool and not self.axis):
            self.refuse("a tool along another axis than Z", items[0])
        self.deltas = deltas if self.tool else self.deltas
        blocks = self._changed(items[0]) if self.tool else []
        return [*blocks, words.strip()] if words else blocks

    def _tool_word(self, item: gx.Item) -> str:
        """Take a word of TOOL CALL, and return what it is in the block behind the tool change."""
        kind = item.kind
        if kind == "number" and self.tool:
            raise self.refusal("GX203", "a tool stands here twice", item)
        if kind == "number":
            self.tool = self._tool_number(item)
        elif kind == "tool_axis":
            self.axis = item.name
        elif kind == "speed":
            return f" S{self.number_of(item)}"
        elif kind == "feed":
            word = self.feed_word(self.number_of(item))
            self.tool_feed = self.feed
            return word
        else:
            raise self.refusal("GX101", f"{item.name[:20]!r} does not fit here", item)
        return ""

    def _deltas(self, items: Sequence[gx.Item]) -> dict[str, Decimal]:
        """Return DL and DR that are not 0; to the same control they need not be known."""
        found = {item.name: Decimal(self.number_of(item)) for item in items}
        if len(found) < len(items):
            raise self.refusal("GX203", "a delta of the tool stands here twice", items[0])
        if found.get("DR2") and not self.reading.stays:
            self.refuse("DR2: what it does to the path is not certain", items[0])
        return {} if self.reading.stays else {name: by for name, by in found.items() if by}

    def _length(self, item: gx.Item, tool: str) -> str:
        """Return the block of the length of a tool, with its DL."""
        known, unit = self.reading.tools.get(int(tool)), MM if self.inch else 1.0
        open_ = known is None or isnan(known.length)
        if not self.deltas.get("DL") or (open_ and self.reading.asides):
            return "G49" if tool == "0" else f"G43 H{tool}"
        if known is None or isnan(known.length) or any(known.vector[:2]):
            hint = f"give a machine file with the tool: length = ... in [tool.{tool}]"
            self.refuse(f"DL of tool {tool}, whose length is not known", item, hint)
        return f"G43.1 Z{written(Decimal(repr(known.length / unit)) + self.deltas['DL'])}"

    def _tool_number(self, item: gx.Item) -> str:
        if item.name.startswith('"'):
            self.tool_name = self.text_in(self.line, item).strip('"')
            return self._number_of(self.tool_name, item)
        text = self.number_of(item)
        if not text.isdigit() or len(text) > LONGEST_TOOL:
            self.refuse(f"a tool with the number {text}", item)
        return str(int(text))

    def _number_of(self, name: str, item: gx.Item) -> str:
        """Return the number of a tool that is called by its name. Raises InputError."""
        try:
            return self.tool_names.number(name)
        except gx.UnspeakableError as why:
            self.refuse(str(why), item, why.hint)

    def _changed(self, item: gx.Item) -> list[str]:
        """Return the blocks of a tool change; tool 0 has no length.

        For the same control lengths need not be known.
        """
        self.refuse_beside("TOOL CALL", item)
        tool, self.spindle, self.untold = self.tool, "", False
        self.in_spindle = tool
        if self.dialect.m_codes[6].loses_position:
            self.lose()
        if self.reading.stays:
            return [f"T{tool} M6"]
        self.assigned(RADIUS)
        if RADIUS[1:] not in self.reading.parameters:
            self.q[RADIUS] = self._radius_known(tool)
        beside = self.tool_names.beside(self.tool_name)
        if self.reading.asides and self.deltas:
            beside += f" {told_of(self.deltas, self.inch)}"
        return [f"T{tool} M6{beside}", self._length(item, tool)]

    def _radius_known(self, tool: str) -> float | None:
        """Return the radius of a tool with its DR, as Q108 has it; None where it is not known."""
        known = self.reading.tools.get(int(tool))
        if known is None or isnan(known.radius):
            return None
        if any(RADIUS in line.upper() for line in self.lines):
            self.assumed[RADIUS_TOLD] = None
        return known.radius / (MM if self.inch else 1.0) + float(self.deltas.get("DR", 0))

    def _tool_def(self, item: gx.Item) -> list[str]:
        """TOOL DEF: prepares a tool; what it says of it must be what the machine file says.

        With a number alone it is fetched for the next change.
        """
        match = TOOL.fullmatch(item.name)
        named = FETCHED.search(self.lines[self.line].partition(";")[0])
        if named is not None and not self.reading.stays:
            return [f"T{self._number_of(named[1], item)}{self.tool_names.beside(named[1])}"]
        if match is None and self.reading.stays:
            return []
        if match is None:
            self.refuse(f"{item.name.strip()} is not resolved", item)
        known = self.reading.tools.get(int(match[1]))
        if known is not None:
            unit = MM if self.inch else 1.0
            for text, value, what in ((match[2], known.length, "L"), (match[3], known.radius, "R")):
                if text and abs(float(plain(text)) * unit - value) > 1e-9:
                    message = f"{what} of tool {match[1]} is another one in the machine file"
                    self.refuse(message, item, "give the tool its measures in one place")
        return self.along() if match[2] or match[3] else [f"T{match[1]}"]

    # --- following the tip ---

    def _function_of(self, item: gx.Item) -> list[str]:
        """Follow the tip by FUNCTION TCPM where that is what M128 does."""
        said = " ".join(item.name.split())
        if said in (RESET, TCPM):
            self.refuse_beside(said, item)
            if said == RESET and not self.following and self.reading.asides:
                return self.along()
            return [*self.switch(said == TCPM)]
        why = next((why for words, why in OTHERWISE.items() if words in said), "")
        self.refuse(f"{said} is not resolved" + (f": {why}" if why else ""), item)


BRACKETS = str.maketrans("()", "[]")
