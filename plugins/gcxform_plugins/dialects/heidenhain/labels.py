"""Labels of a TNC: subprograms (CALL LBL ... LBL 0) and repeats of a part of the program (REP)."""

from __future__ import annotations

import re
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.moves import Moves

NAME = r'(?:0*(\d{1,9})|"([^"]*)")'
LABEL = re.compile(rf"LBL\s*{NAME}\s*", re.IGNORECASE)
LABEL_LINE = re.compile(rf"[\s\d/]*LBL\s*{NAME}\s*(?:;.*)?", re.IGNORECASE)
CALL = re.compile(
    rf"CALL\s+LBL\s*{NAME}(?:\s*REP\s*(\d{{1,9}})(?:\s*/\s*(\d{{1,9}}))?)?\s*", re.IGNORECASE
)
END = ("", None)
DEEPEST = 8  # calls within calls on the control that takes the fewest
MOST = 65534


class Labels(Moves):
    """Jumps to labels and back."""

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self.calls: list[int] = []
        self.left: dict[tuple[int, int], int] = {}
        self._labels: dict[str, int] | None = None

    def labels(self, item: gx.Item) -> dict[str, int]:
        """Return the lines that labels stand on. Raises InputError for one that stands twice."""
        if self._labels is None:
            found: dict[str, int] = {}
            for line, text in enumerate(self.lines):
                match = LABEL_LINE.fullmatch(text.upper())
                name = _name(match[1], match[2]) if match else "0"
                if name == "0":
                    continue
                if name in found:
                    raise self.refusal("GX223", f"LBL {name} stands in this program twice", item)
                found[name] = line
            self._labels = found
        return self._labels

    def label(self, item: gx.Item) -> list[str]:
        """LBL n is a place; LBL 0 goes back to where the subprogram was called."""
        match = LABEL.fullmatch(item.name)
        if match is None:
            self.refuse("a label that is a parameter", item)
        if _name(match[1], match[2]) == "0":
            if not self.calls:
                raise self.refusal("GX223", "LBL 0 ends a subprogram, and none was called", item)
            depth = len(self.calls)
            self.left = {key: n for key, n in self.left.items() if key[1] < depth}
            self.at = self.calls.pop()
        return []

    def call_label(self, item: gx.Item) -> list[str]:
        """CALL LBL n runs a subprogram; with REP k what is behind the label runs k times more."""
        match = CALL.fullmatch(item.name)
        if match is None:
            self.refuse(f"{item.name.strip()[:30]} runs what is not in this file", item)
        name = _name(match[1], match[2])
        line = self.labels(item).get(name)
        if line is None:
            raise self.refusal("GX223", f"there is no LBL {name}", item)
        if match[3] is None:
            self.calls.append(self.at)
            if len(self.calls) > DEEPEST:
                raise self.refusal("GX223", f"calls are deeper than {DEEPEST}", item)
        elif not self._again(item, line, match):
            return []
        self.at = line
        return []

    def _again(self, item: gx.Item, line: int, match: re.Match[str]) -> bool:
        """Whether the part of the program between a label and its call runs once more."""
        times = int(match[3])
        if match[4] is not None and int(match[4]) != times:
            self.refuse("REP in the middle of its count", item)
        if not 1 <= times <= MOST or line > self.line:
            raise self.refusal("GX223", "REP needs a label before it, and 1 to 65534", item)
        key = self.line, len(self.calls)
        left = self.left.get(key, times)
        self.left[key] = left - 1
        if not left:
            del self.left[key]
        return left > 0


def _name(number: str | None, text: str | None) -> str:
    """Return the name of a label: its number, or its text with quotes."""
    return str(int(number or 0)) if text is None else f'"{text}"'
