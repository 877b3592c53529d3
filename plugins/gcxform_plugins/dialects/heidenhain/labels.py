"""Labels of a TNC: subprograms (CALL LBL ... LBL 0), repeats of a part of the program (REP), jumps.

Programs that are called by CALL PGM stand in files beside the program; their labels are their own.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.fk import FreeContours

NAME = r'(?:0*(\d{1,9})|"([^"]*)")'
LABEL = re.compile(rf"LBL\s*{NAME}\s*", re.IGNORECASE)
LABEL_LINE = re.compile(rf"[\s\d/]*LBL\s*{NAME}\s*(?:;.*)?", re.IGNORECASE)
CALL = re.compile(
    rf"CALL\s+LBL\s*{NAME}(?:\s*REP\s*(\+?Q[LR]?\d+|\d{{1,9}})(?:\s*/\s*(\d{{1,9}}))?)?\s*",
    re.IGNORECASE,
)
PROGRAM = re.compile(r"CALL\s+PGM\s*(.*?)\s*", re.IGNORECASE)
SELECTS = re.compile(r"SEL\s+PGM\s*(.*?)\s*", re.IGNORECASE)
CHOSEN = re.compile(r"CALL\s+SELECTED\s+PGM\s*", re.IGNORECASE)
END = ("", None)
DEEPEST = 8  # calls within calls on the control that takes the fewest
MOST = 65534
JUMPS = "label-jumps"
"""The setting that says what ends a subprogram that a jump has left."""
RETURNS = (
    f'say {JUMPS} = "return" in [control] if the control then goes back to that call at the next '
    "LBL 0, as the programs of some CAM systems expect"
)
PASSED = "LBL 0 to which no call has led is passed over"


@dataclass(frozen=True, slots=True)
class Call:
    """What has called: the line behind it, and the first line that is called.

    `lines` are those of a program, None of a label; `local` the QL parameters of who calls it.
    """

    back: int
    first: int
    lines: range | None = None
    local: tuple[tuple[str, float | None], ...] = ()


class Labels(FreeContours):
    """Jumps to labels and back."""

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self.calls: list[Call] = []
        self.left: dict[tuple[int, int], int | None] = {}
        self.repeated: dict[tuple[int, int], int] = {}
        self.selected = ""
        self._labels: dict[int, dict[str, int]] = {}
        self.deep: list[tuple[int, int]] = []
        """Executions of lines that call a label or a program, or end one, and how deep that is."""

    @property
    def part(self) -> range:
        """The lines of the file that is executed."""
        called = (call.lines for call in reversed(self.calls) if call.lines is not None)
        return next(called, range(self.own))

    def labels(self, item: gx.Item) -> dict[str, int]:
        """Return the lines that labels stand on. Raises InputError for one that stands twice."""
        part = self.part
        if part.start not in self._labels:
            found: dict[str, int] = {}
            for line in part:
                match = LABEL_LINE.fullmatch(self.lines[line].upper())
                name = _name(match[1], match[2]) if match else "0"
                if name == "0":
                    continue
                if name in found:
                    raise self.refusal("GX223", f"LBL {name} stands in this program twice", item)
                found[name] = line
            self._labels[part.start] = found
        return self._labels[part.start]

    def label(self, item: gx.Item) -> list[str]:
        """LBL n is a place; LBL 0 goes back to where the subprogram was called, if one was."""
        match = LABEL.fullmatch(item.name)
        if match is None:
            self.refuse("a label that is a parameter", item)
        if _name(match[1], match[2]) == "0":
            if self.calls and self.calls[-1].lines is None:
                self.go_back()
            else:
                self.assumed[PASSED] = None
        return []

    def go_back(self) -> None:
        """Go on behind the last call."""
        depth = len(self.calls)
        self.left = {key: n for key, n in self.left.items() if key[1] < depth}
        call = self.calls.pop()
        self.deep.append((self.visit, len(self.calls)))
        if call.lines is not None:
            self.q = {key: value for key, value in self.q.items() if key[:2] != "QL"}
            self.q |= dict(call.local)
        self.at = call.back

    def call(self, item: gx.Item) -> list[str]:
        """CALL LBL n runs a subprogram; with REP k what is behind the label runs k times more."""
        if CHOSEN.fullmatch(item.name):
            return self._call_program(item, self.selected)
        program = PROGRAM.fullmatch(item.name)
        if program is not None:
            return self._call_program(item, program[1])
        match = CALL.fullmatch(item.name)
        if match is None:
            self.refuse(f"{item.name.strip()[:30]} runs what is not in this file", item)
        line = self._line_of(item, _name(match[1], match[2]))
        if match[3] is None:
            self._enter(item, Call(self.at, line))
        elif self._again(item, line, match):
            self.at = line
        return []

    def _line_of(self, item: gx.Item, name: str) -> int:
        line = self.labels(item).get(name)
        if line is None:
            raise self.refusal("GX223", f"there is no LBL {name}", item)
        return line

    def _enter(self, item: gx.Item, call: Call) -> None:
        self.calls.append(call)
        self.deep.append((self.visit, len(self.calls)))
        if len(self.calls) > DEEPEST:
            raise self.refusal("GX223", f"calls are deeper than {DEEPEST}", item)
        self.at = call.first

    def _again(self, item: gx.Item, line: int, match: re.Match[str]) -> bool:
        """Whether the part of the program between a label and its call runs once more."""
        times = self._times(item, match[3])
        if match[4] is not None and int(match[4]) != times:
            self.refuse("REP in the middle of its count", item)
        if not 1 <= times <= MOST or line > self.line:
            raise self.refusal("GX223", "REP needs a label before it, and 1 to 65534", item)
        key = self.line, len(self.calls)
        left = self.left.get(key, times)
        if left is None:
            self.refuse("a jump has left this repeat before: how it counts on is not known", item)
        self.left[key], self.repeated[key] = left - 1, line
        if not left:
            del self.left[key]
        return left > 0

    def _times(self, item: gx.Item, text: str) -> int:
        if text.isdigit():
            return int(text)
        self.computes = True
        number = self.value_of(text, item)
        if not number.isdigit():
            self.refuse(f"REP {number}", item)
        return int(number)

    def go_to(self, item: gx.Item, text: str) -> None:
        """Jump to a label: out of a subprogram a setting has to say where that returns to."""
        match = LABEL.fullmatch(text)
        assert match is not None
        line = self._line_of(item, _name(match[1], match[2]))
        if self.calls and self.calls[-1].lines is None:
            first = self.calls[-1].first
            ends = (n for n in range(first, self.part.stop) if _is_end(self.lines[n]))
            inside = first <= line < next(ends, self.part.stop)
            if not inside and self.reading.control.get(JUMPS) is None:
                message = "a jump out of a subprogram: where that returns to is not known"
                self.refuse(message, item, RETURNS)
        for key in self.left:
            if key[1] == len(self.calls) and not self.repeated[key] <= line <= key[0]:
                self.left[key] = None
        self.at = line

    # --- programs ---

    def select(self, item: gx.Item) -> list[str]:
        """SEL PGM: the program that CALL SELECTED PGM runs."""
        match = SELECTS.fullmatch(item.name)
        if match is None:
            self.refuse(f"{item.name.strip()[:40]} is not resolved", item)
        self.selected = match[1]
        return []

    def _call_program(self, item: gx.Item, path: str) -> list[str]:
        """CALL PGM: the program in a file beside this one; QL parameters are its own."""
        name = re.split(r"[\\/:]", path.strip('"'))[-1]
        stem = name[:-2] if name.upper().endswith(".H") else name
        self.refuse_beside("CALL PGM", item)
        lines = self.called_file(stem) if stem and "Q" not in path[:1] else None
        if lines is None:
            self.refuse(f"{item.name.strip()[:40]} runs what is not beside this file", item)
        if any(call.lines == lines for call in self.calls):
            raise self.refusal("GX223", f"{stem} calls itself", item)
        local = tuple(each for each in self.q.items() if each[0][:2] == "QL")
        self._enter(item, Call(self.at, lines.start, lines, local))
        self.q = {key: value for key, value in self.q.items() if key[:2] != "QL"}
        return []


def _name(number: str | None, text: str | None) -> str:
    """Return the name of a label: its number, or its text with quotes."""
    return str(int(number or 0)) if text is None else f'"{text}"'


def _is_end(text: str) -> bool:
    match = LABEL_LINE.fullmatch(text.upper())
    return match is not None and _name(match[1], match[2]) == "0"
