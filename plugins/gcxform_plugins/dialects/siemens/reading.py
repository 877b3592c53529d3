"""Items of a line for a SINUMERIK, put in order; what is not understood is refused by its name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from decimal import Decimal
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.shared.tips_left import goes_along
from gcxform_plugins.dialects.siemens import cycles as cycles
from gcxform_plugins.dialects.siemens.asides import (
    BLENDS,
    GEARS,
    INERT,
    QUIET,
    TOLERANCES,
)
from gcxform_plugins.dialects.siemens.frames import Frame
from gcxform_plugins.dialects.siemens.line import ABSOLUTE, CORNERS, FRAMES, STEP, Line
from gcxform_plugins.dialects.siemens.offsets import WORK
from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY, Place

MODAL = {
    **dict.fromkeys(("17", "18", "19"), "plane"),
    **dict.fromkeys(("93", "94", "95"), "feed"),
    **dict.fromkeys(("40", "41", "42"), "comp"),
}
PLANES = {"17": "XY", "18": "ZX", "19": "YZ"}
NO_OFFSET = "G500"
REASONS = {
    "53": "G53 leaves basic frames in force, which only the control knows; SUPA does not",
    "58": "G58 is a programmable shift, and no work offset",
    "59": "G59 is a programmable shift, and no work offset",
    "70": "G70 has lengths in inches, and feeds in the basic unit of the control",
    "74": "G74 moves axes to their reference points",
    "75": "G75 moves axes to fixed points",
    "291": "G291 switches to another language",
    "500": "G500 leaves basic frames in force, which only the control knows",
}
HINTS = {
    "53": ('write SUPA in its place; or say basic-frames = "none" in [control], if it is so',),
    "70": ("write G700 in its place if feeds are in inches too",),
}
ORIENTATION = {"ORIAXES": 0, "ORIVECT": 0, "ORIPLANE": 0, "ORIMKS": 1, "ORIWKS": 1}
WHY = {
    "CT": "CT is an arc whose centre follows from the move before",
    "TRANSMIT": "TRANSMIT turns X and Y into a rotary axis",
    "TRACYL": "TRACYL winds the path about a cylinder",
    "INVCW": "INVCW is an involute",
    "INVCCW": "INVCCW is an involute",
    "CYCLE800": "CYCLE800 swivels the plane, or may turn axes",
    "CYCLE832": "CYCLE832 may switch TRAORI",
    "TRAORI": "TRAORI selects another transformation, or changes one",
}
AXES = LINEAR + ROTARY
POLAR_WAYS = frozenset((("AP", ABSOLUTE), ("RP", ABSOLUTE), ("AP", STEP)))
"""Ways of polar words that are read: AP=IC() turns on from the last AP (PM 175)."""
COOLANTS = {7: 8, 8: 7}
"""Both may be on, and both stand in a block of several M functions."""
OWN = frozenset((128, 129, 9000, 9001))
"""The M codes with which blocks say TRAORI, TRAFOOF and what is kept: elsewhere the machine's."""
PLAIN = "write plain numbers, or let the CAM write them"
Reader = Callable[[Line, gx.Item], None]


class Statements(gx.Translator):
    """Puts items into a `Line`, and keeps what the control keeps.

    frame         TRANS, ROT and their like, as far as blocks are written outside of it
    motion        of the program: "0" to "3", "CIP", or nothing where none has been stated
    said, said_steps, said_centres   what the blocks have said of motion, G91 and G90.1
    following     TRAORI is in force;  orientation: what ORIAXES and ORIMKS and their like have said
    tool, waiting the tools in the spindle and of the last T;  edge: "0", "1", None where not known
    straight      the plain words that stand for a line which computes, while they are read
    promised      the edge that has been said between T and M6, or nothing
    changed       M6 has been;  comp: G41 or G42 is in force
    drilling      the cycle of MCALL;  once: that of a line;  holes: the places of a pattern
    """

    def __init__(
        self, lines: list[str], file: str, dialect: type[gx.Dialect], reading: Any
    ) -> None:
        super().__init__(lines, file, dialect, reading)
        self.place = Place(self.reading.start)
        at_start = str(self.reading.control.get("motion-at-start", ""))
        self.motion, self.said, self.plane, self.work = at_start.removeprefix("G"), "", "XY", ""
        self.unit = ""
        self.steps = self.said_steps = self.said_centres = False
        self.frame = Frame()
        self.following = self.comp = self.changed = False
        self.orientation = "", ""
        self.tool = None if self.reading.tool is None else str(self.reading.tool)
        self.waiting: str | None = None
        self.edge: str | None = None
        self.promised = self.straight = ""
        self.drilling: cycles.Drilling | None = None
        self.once: cycles.Drilling | None = None
        self.holes: list[tuple[Decimal, Decimal]] = []
        self.read: Mapping[str, Reader] = {
            "word": self._word,
            "value": self._word,
            "function": self._function,
            "indexed": self._indexed,
            "named": self._named,
            "command": self._command,
            "call": self._call,
            "label": self._nothing,
            "header": self._nothing,
            "main_number": self._number,
        }

    def text_of(self, item: gx.Item) -> str:
        """Return an item as it is written."""
        return self.text_in(self.line, item, self.straight or None)

    def _nothing(self, line: Line, item: gx.Item) -> None:
        """Take labels, which jumps look for, and the name of the program."""

    def _number(self, line: Line, item: gx.Item) -> None:
        if item.numbers[0].isdigit():
            line.number = f"N{item.numbers[0]} "

    def unread(self, line: Line, item: gx.Item) -> None:
        """Refuse what is only taken to be refused. Raises InputError."""
        what = {
            "flow": f"{item.name.split()[0].split('(')[0]} decides what is executed, or defines it",
            "array": "a variable is not computed",
            "system": "a variable of the control is not known",
            "expression": "an expression is not computed",
        }
        self.refuse(what[item.kind], item, PLAIN)

    # --- words ---

    def _word(self, line: Line, item: gx.Item) -> None:
        letter, number = item.names[0], item.numbers[0]
        if letter in "XYZABC":
            self._put(line.axes, letter, "", number, item)
        elif letter in "IJK":
            self._put(line.centres, letter, "", number, item)
        elif letter == "F":
            self._once(line, item, "F")
            line.feed = number
        elif letter == "N":
            self._number(line, item)
        elif letter == "G":
            self._code(line, item, number)
        else:
            self._other(line, item, letter, number)

    def _put(
        self,
        where: dict[str, tuple[str, str, gx.Item]],
        letter: str,
        way: str,
        number: str,
        item: gx.Item,
    ) -> None:
        if letter in where:
            raise self.refusal("GX213", f"{letter} stands twice in its block", item)
        where[letter] = (way, number, item)

    def _other(self, line: Line, item: gx.Item, letter: str, number: str) -> None:
        """Take S, M, T and D. Raises InputError for other letters."""
        if letter == "S":
            line.others.append(f"S{number}")
        elif letter == "M" and number.isdigit() and int(number) == 6:
            line.changes = item
        elif letter == "M" and number.isdigit() and int(number) == 17 and self.reading.crosses:
            self.refuse("M17 returns to a program that is not here", item)
        elif letter == "M" and number.isdigit() and int(number) in GEARS:
            line.asides.append(f"M{number}")
        elif letter == "M" and number.isdigit() and int(number) not in OWN:
            said = {int(word[1:]) for word in line.others if word[0] == "M"}
            beside = COOLANTS.get(int(number)) in said
            (line.ahead if beside else line.others).append(f"M{number}")
        elif letter == "T" and number.isdigit():
            self._once(line, item, "T")
            line.tool = str(int(number))
        elif letter == "D" and number.isdigit():
            self._once(line, item, "D")
            line.edge, line.edge_number = item, str(int(number))
        elif letter in "LP":
            self.refuse(f"{letter}{number} calls a subprogram", item)
        else:
            self.refuse(f"{letter}{number} is not read", item)

    def _code(self, line: Line, item: gx.Item, number: str) -> None:
        code = str(int(number)) if number.isdigit() else number
        if code in MODAL:
            self._modal(line, item, code)
        elif code in ("0", "1", "2", "3"):
            self._motion_code(line, item, code)
        elif code in ("90", "91"):
            self._once(line, item, "distance")
            self.steps = self.said_steps = code == "91"
            line.codes.append(f"G{code}")
        elif code in WORK:
            self._once(line, item, "work")
            line.codes.append(WORK[code])
            line.work = WORK[code], item
        elif code in INERT:
            line.asides.append(f"G{code}")
        else:
            self._rare_code(line, item, code)

    def _once(self, line: Line, item: gx.Item, group: str) -> None:
        if group in line.groups:
            if item.kind == "named" or not item.name.startswith(("G", "CIP")):
                raise self.refusal("GX203", f"{item.name} stands twice in its block", item)
            raise self.refusal("GX202", "two codes of one group in a block", item)
        line.groups.add(group)

    def _one(self, line: Line, name: str, item: gx.Item, value: object = None) -> None:
        """Put into a line what stands in it once. Raises InputError where there is another one."""
        if getattr(line, name) is not None:
            raise self.refusal("GX202", "two things of one kind in a block", item)
        setattr(line, name, item if value is None else value)

    def _modal(self, line: Line, item: gx.Item, code: str) -> None:
        group = MODAL[code]
        self._once(line, item, group)
        if group == "plane":
            if self.drilling is not None and self.plane != PLANES[code]:
                self.refuse("another plane under MCALL", item, "write MCALL before")
            if self.plane != PLANES[code]:
                self.lose_pole()
            self.plane = PLANES[code]
        if group == "comp" and code != "40":
            self._compensates(line, item, code)
            return
        if group == "comp":
            self.comp = False
        line.codes.append(f"G{code}")

    def _compensates(self, line: Line, item: gx.Item, code: str) -> None:
        """Take G41 and G42, with the radius of the tool whose edge is in force."""
        if not self.keeps_radii:
            self.refuse("compensation in a frame that mirrors, grows or tilts", item)
        edge = line.edge_number if line.edge is not None else self.edge
        if edge != "1" or self.tool is None or line.tool or self.following or self.drilling:
            message = "compensation needs D1 of a known tool, and neither TRAORI nor MCALL"
            self.refuse(message, item, "write T, M6 and D1 before")
        self.comp = True
        line.codes.append(f"G{code} D{self.tool}")

    def lose_pole(self) -> None:
        """Forget the pole of polar coordinates."""
        raise NotImplementedError

    @property
    def keeps_radii(self) -> bool:
        """Whether the frame of the program keeps sides and radii in the plane."""
        raise NotImplementedError

    def _motion_code(self, line: Line, item: gx.Item, code: str) -> None:
        self._once(line, item, "motion")
        line.motion = code

    def _rare_code(self, line: Line, item: gx.Item, code: str) -> None:
        if code == "4":
            line.dwell = item
        elif code in ("60", "9"):
            line.codes.append(f"G{code}")
        elif code in BLENDS:
            line.asides += [f"G{code}"] if code != "64" else []
            line.codes.append("G64")
        elif code in ("71", "700", "710"):
            self._units(line, item, code)
        elif code in ("110", "111", "112"):
            self._one(line, "pole", item, (code, item))
        elif code == "153" or (code == "53" and self.has_no_basic_frame):
            line.machine = item
        elif code == "500" and not self.reading.stays:
            self._once(line, item, "work")
            line.work = NO_OFFSET, item
            line.asides += [NO_OFFSET] if self.reading.asides else []
        else:
            self.refuse(REASONS.get(code, f"G{code} is not read"), item, *HINTS.get(code, ()))

    @property
    def has_no_basic_frame(self) -> bool:
        """Whether the machine file says that no basic frame is in force."""
        return self.reading.control.get("basic-frames") == "none"

    def _units(self, line: Line, item: gx.Item, code: str) -> None:
        if code == "71" and self.reading.units != "mm":
            message = "G71: feeds are in the basic unit of the control, and which that is is open"
            self.refuse(message, item, 'say units = "mm" in [input], or write G710')
        self._once(line, item, "units")
        unit = "G20" if code == "700" else "G21"
        if self.frame != Frame() and unit != self.unit:
            self.refuse("other units in a frame of the program", item, "write TRANS before")
        if self.unit not in ("", unit) or unit == "G20":
            self.place.lose(LINEAR, shifted=False)
        if self.unit not in ("", unit):
            self.lose_pole()
        self.unit = unit
        line.codes.append(unit)

    # --- values ---

    def _function(self, line: Line, item: gx.Item) -> None:
        letter, way = item.names[:2]
        where = line.axes if letter in LINEAR + ROTARY else line.centres
        if letter not in "XYZABCIJK" or (where is line.centres and way not in (ABSOLUTE, STEP)):
            self.refuse(f"{letter}={way}(...) is not read", item)
        if where is line.centres and way == STEP:
            way = ""
        self._put(where, letter, way, item.numbers[0], item)

    def _indexed(self, line: Line, item: gx.Item) -> None:
        letter, index = item.name, item.numbers[0]
        if letter in "IJK" and index == "1":
            way = item.names[1] if len(item.names) > 1 else ""
            self._put(line.middles, letter, way, item.numbers[1], item)
            return
        what = {"R": "parameters are not computed", "S": "another spindle", "M": "another spindle"}
        vector = "the tool axis, or a normal, is programmed: only angles of rotary axes are read"
        message = vector if letter in ROTARY else what.get(letter, "another axis")
        self.refuse(f"{letter}{index}=: {message}", item)

    def _named(self, line: Line, item: gx.Item) -> None:
        name, way = item.name, item.names[1] if len(item.names) > 1 else ""
        if way and (name, way) not in POLAR_WAYS:
            self.refuse(f"{name}={way}(...) is not read", item)
        if name in ("CR", "AR", "TURN", "RPL", "AP", "RP"):
            self._once(line, item, name)
            line.onwards |= way == STEP
            line.named[name] = (item.numbers[0], item)
        elif name == "ANG" and not self.reading.stays:
            self._once(line, item, name)
            line.named[name] = (item.numbers[0], item)
        elif name in CORNERS and not self.reading.stays:
            self._once(line, item, name)
            line.corner[name] = (item.numbers[0], item)
        elif name not in TOLERANCES:
            self.refuse(f"{name}= is not read", item)
        else:
            self._goes_along(line, item, f"{name}=", item.numbers[0])

    def _goes_along(self, line: Line, item: gx.Item, what: str, value: str) -> None:
        """Let what has a tolerance go along. Raises InputError for one in inches."""
        inches = (self.unit or self.reading.units) in ("G20", "in")
        counts = not value.endswith("()") and not value.upper().startswith("GROUP")
        if counts and self.reading.asides and inches:
            said = what or value.partition("(")[0]
            self.refuse(f"{said} in inches, beside moves that are written anew", item)
        line.asides.append(f"{what}{value}")

    # --- commands ---

    def _command(self, line: Line, item: gx.Item) -> None:
        name = item.name
        if name in QUIET or name in ORIENTATION:
            line.asides.append(name)
        if name in QUIET:
            return
        if name in ORIENTATION:
            said = [*self.orientation]
            said[ORIENTATION[name]] = name
            self.orientation = said[0], said[1]
        elif name in FRAMES:
            self._one(line, "alone", item)
        elif name == "SUPA":
            line.machine = item
        elif name == "CIP" or (name == "CT" and not self.reading.stays):
            self._motion_code(line, item, name)
        elif name in ("TRAORI", "TRAFOOF"):
            self._switched(line, item, name)
        elif name == "MCALL":
            line.modal = item
            self.drilling = None
        elif name in ("CYCLE800", "CYCLE832") and self._quiet(name, [""]):
            self._one(line, "alone", item)
            line.asides += [f"{name}()"] if name == "CYCLE832" or self.reading.asides else []
        else:
            self.refuse(WHY.get(name, f"{name} is not read"), item)

    def _switched(self, line: Line, item: gx.Item, name: str) -> None:
        along = name == "TRAFOOF" and goes_along(self)
        line.asides += [name] if along else []
        code = "" if along else "M128" if name == "TRAORI" else "M129"
        self._one(line, "act", item, (code, item))

    def _call(self, line: Line, item: gx.Item) -> None:
        """Take a call with arguments."""
        raise NotImplementedError

    def _quiet(self, name: str, given: Sequence[str]) -> bool:
        """Whether a call moves nothing and changes no word behind it."""
        raise NotImplementedError

    def first_of(self, line: Line) -> gx.Item | None:
        """Return the first word of an arc."""
        named = [item for _, item in line.named.values()]
        words = [*line.centres.values(), *line.middles.values()]
        return next(iter([*named, *(item for _, _, item in words)]), None)
