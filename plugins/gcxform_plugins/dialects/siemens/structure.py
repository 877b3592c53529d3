"""Which lines of a program for a SINUMERIK belong together, and where jumps lead.

Structures are IF, WHILE, FOR, LOOP and REPEAT with the lines that end them. A jump is looked for
as text, the nearest first, in its direction; none leads into a structure.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

HEAD = re.compile(
    r"[ \t]*(?:/[0-9]?)?[ \t]*(?:[N:][ \t]*(?P<number>[0-9]+))?"
    r"[ \t]*(?:(?P<label>[A-Z_]{2}[A-Z0-9_]*)[ \t]*:(?!=))?[ \t]*(?P<word>[A-Z_][A-Z0-9_]*)?",
    re.IGNORECASE,
)
STRING = re.compile(r'"[^"]*"')
JUMP = re.compile(r"(?<![A-Z0-9_])GOTO[BFCS]?(?![A-Z0-9_])", re.IGNORECASE)
JUMPS = re.compile(
    r"(?<![A-Z0-9_])(GOTO[BFC]?)[ \t]*([A-Z0-9_]+)(?![ \t]*(?:<<|\[))", re.IGNORECASE
)
BEYOND = re.compile(
    r"(?<![A-Z0-9_])(?:GOTOS|RET[ \t]*\(|PROC|REPEATB?[ \t]+[A-Z_]|CALL[ \t]+BLOCK"
    r"|GOTO[BFC]?(?![A-Z0-9_])[ \t]*(?![ \t]*[A-Z0-9_]+(?![A-Z0-9_])(?![ \t]*(?:<<|\[))))",
    re.IGNORECASE,
)
"""What goes on where nobody knows, or repeats lines: jumps to what is computed among them."""
ENDS_HERE = re.compile(r"(?<![A-Z0-9_])(?:RET|M0*(?:2|17|30))(?![A-Z0-9_])", re.IGNORECASE)
LEAVES = re.compile(
    r"(?<![A-Z0-9_])(?:(?:GOTO[BFCS]?|CASE|RET|ENDLABEL|M0*(?:2|17|30))(?![A-Z0-9_])"
    r"|REPEATB?[ \t]+[A-Z_]|CALL[ \t]+BLOCK)",
    re.IGNORECASE,
)
"""What leaves a section that is repeated, or ends it in another place."""
BACK = re.compile(
    r"(?<![A-Z0-9_])(?:GOTO|GOTO[BCS]|REPEATB?|RET|UNTIL|WHILE|FOR|LOOP)(?![A-Z0-9_])",
    re.IGNORECASE,
)
SET = re.compile(
    r"(?<![A-Z0-9_$.])([A-Z_][A-Z0-9_]*)[ \t]*(?:\[[^]]*\][ \t]*)?=(?!=)", re.IGNORECASE
)
ENDS = {"ENDIF": "IF", "ENDWHILE": "WHILE", "ENDFOR": "FOR", "ENDLOOP": "LOOP", "UNTIL": "REPEAT"}


class StructureError(Exception):
    """Lines that do not fit together: the line, and why."""

    def __init__(self, line: int, message: str) -> None:
        super().__init__(message)
        self.line, self.message = line, message


def code(text: str, with_texts: bool = False) -> str:
    """Return a line without comment; what stands in texts is left out, or stays."""
    if with_texts:
        found = re.match(r'(?:[^";]|"[^"]*")*', text)
        return found[0] if found else text
    return STRING.sub('""', text).partition(";")[0]


@dataclass(frozen=True, slots=True)
class Part:
    """A structure: its kind, its first line, that of ELSE (-1 without), and its last."""

    kind: str
    first: int
    other: int
    last: int


class Structure:
    """The structures of the lines from `first` up to `stop`. Raises StructureError."""

    def __init__(self, lines: Sequence[str], first: int, stop: int) -> None:
        self.lines, self.first, self.stop = lines, first, stop
        self.parts: list[Part] = []
        self.at: dict[int, Part] = {}
        open_: list[tuple[str, int, int]] = []
        for line in range(first, stop):
            found = HEAD.match(code(lines[line]))
            word = (found["word"] or "").upper() if found else ""
            if word in ("IF", "WHILE", "FOR", "LOOP", "REPEAT") and self._opens(word, line):
                open_.append((word, line, -1))
            elif word == "ELSE":
                if not open_ or open_[-1][0] != "IF" or open_[-1][2] >= 0:
                    raise StructureError(line, "ELSE without an IF that is open")
                open_[-1] = (*open_[-1][:2], line)
            elif word in ENDS:
                if not open_ or open_[-1][0] != ENDS[word]:
                    raise StructureError(line, f"{word} ends nothing that is open here")
                self._close(*open_.pop(), line)
        if open_:
            raise StructureError(open_[-1][1], f"{open_[-1][0]} has no end")

    def _opens(self, word: str, line: int) -> bool:
        text = code(self.lines[line])
        if word == "IF":
            return not JUMP.search(text)
        found = HEAD.match(text)
        return word != "REPEAT" or (found is not None and not text[found.end() :].strip())

    def _close(self, kind: str, first: int, other: int, last: int) -> None:
        part = Part(kind, first, other, last)
        self.parts.append(part)
        self.at[first] = self.at[last] = part
        if other >= 0:
            self.at[other] = part

    def around(self, line: int) -> frozenset[int]:
        """Return the first lines of the structures that a line stands in; heads stand outside."""
        return frozenset(part.first for part in self.parts if part.first < line <= part.last)

    def is_whole(self, first: int, stop: int) -> bool:
        """Whether lines up to another are executed from the first to the last, and no other way."""
        if self.around(first) != self.around(stop):
            return False
        section = [code(line) for line in self.lines[first:stop]]
        return not any(LEAVES.search(line) for line in section)

    def target(self, way: str, name: str, line: int) -> int | None:
        """Return the line that a jump goes to, None where there is none. Raises StructureError."""
        ahead, back = range(line + 1, self.stop), range(line, self.first - 1, -1)
        for lines in {"GOTOF": (ahead,), "GOTOB": (back,)}.get(way, (ahead, back)):
            for at in lines:
                if self._is(at, name):
                    if not self.around(at) <= self.around(line):
                        raise StructureError(line, f"the jump to {name} leads into a structure")
                    return at
        return None

    def places(self, name: str) -> list[int]:
        """Return the lines of a label."""
        return [line for line in range(self.first, self.stop) if self._is(line, name)]

    def _is(self, line: int, name: str) -> bool:
        found = HEAD.match(code(self.lines[line]))
        if found is None:
            return False
        number = name.upper().removeprefix("N")
        if number.isdigit():
            return found["number"] is not None and int(found["number"]) == int(number)
        return found["label"] is not None and found["label"].upper() == name.upper()

    def reach(
        self, first: int, last: int, called: bool, is_text: Callable[[str], bool]
    ) -> range | None:
        """Return the lines that may be executed, or not, where only the machine decides in some.

        Behind them it goes on in any case, but for where the program ends among them, which of one
        that is `called` is not known: then, and where nobody knows how far, None. Where jumps lead
        back it begins before `first`. `is_text`: whether a name is that of a variable.
        """
        low, high, line = first, last, first
        while line <= high:
            text, part = code(self.lines[line]), self.at.get(line)
            if BEYOND.search(text) or (called and ENDS_HERE.search(text)):
                return None
            if part is not None and line == part.last and part.kind != "IF":
                low = min(low, part.first)
            elif part is not None:
                high = max(high, part.last)
            for way, name in JUMPS.findall(text):
                target = None if is_text(name) else self._found(way.upper(), name, line)
                if target is None:
                    return None
                low, high = min(low, target), max(high, target - 1)
            first, line = (low, low) if low < first else (first, line + 1)
        return range(low, high + 1)

    def _found(self, way: str, name: str, line: int) -> int | None:
        try:
            return self.target(way, name, line)
        except StructureError:
            return None

    def may_go_back(self, line: int) -> bool:
        """Whether a line or one behind it may lead back to lines before it."""
        inside = any(p.kind != "IF" and p.first < line <= p.last for p in self.parts)
        return inside or any(BACK.search(code(self.lines[at])) for at in range(line, self.stop))


def names_set(lines: Sequence[str]) -> Iterator[str]:
    """Yield the names, in capitals, that lines assign values to."""
    for line in lines:
        yield from (name.upper() for name in SET.findall(code(line)))
