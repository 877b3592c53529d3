"""Which lines of a Fagor program belong together: subroutines, structures behind `$`, labels."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

HEAD = re.compile(
    r"[ \t]*(?P<slash>/)?[ \t]*(?:N[ \t]*(?P<number>[0-9]+)[ \t]*:?)?[ \t]*"
    r"(?P<labels>(?:\[[ \t]*[A-Z_][A-Z0-9_]*[ \t]*\][ \t]*)*)(?:\$(?P<word>[A-Z]+))?",
    re.IGNORECASE,
)
LABEL = re.compile(r"\[[ \t]*([A-Z_][A-Z0-9_]*)[ \t]*\]", re.IGNORECASE)
HEADER = re.compile(r"[ \t]*%(?P<rest>[^;(]*)")
LOCAL = re.compile(r"[ \t]*L(?:[ \t]+(?P<name>[^ \t]+)|(?P<number>[0-9]+))[ \t]*", re.IGNORECASE)
COMMENT = re.compile(r"\([^)\n]*\)?|;.*")
ENDS = {
    "ENDIF": "IF",
    "ENDFOR": "FOR",
    "ENDWHILE": "WHILE",
    "ENDDO": "DO",
    "ENDSWITCH": "SWITCH",
}
OPENS = frozenset(ENDS.values())
INNER = {"ELSE": "IF", "ELSEIF": "IF", "CASE": "SWITCH", "DEFAULT": "SWITCH"}
LOOPS = frozenset(("FOR", "WHILE", "DO"))


class StructureError(Exception):
    """Lines that do not fit together: the line, and why."""

    def __init__(self, line: int, message: str) -> None:
        super().__init__(message)
        self.line, self.message = line, message


def code(text: str) -> str:
    """Return lines without their comments."""
    return COMMENT.sub("", text) if "(" in text or ";" in text else text


@dataclass(frozen=True, slots=True)
class Part:
    """A structure: its kind, its first line, those of $ELSE, $CASE and their like, its last."""

    kind: str
    first: int
    inner: tuple[tuple[str, int], ...]
    last: int


class Structure:
    """The structures and labels of the lines from `first` up to `stop`. Raises StructureError."""

    def __init__(self, lines: Sequence[str], first: int, stop: int) -> None:
        self.parts: list[Part] = []
        self.at: dict[int, Part] = {}
        self.labels: dict[str, list[int]] = {}
        open_: list[tuple[str, int, list[tuple[str, int]]]] = []
        for line in range(first, stop):
            found = HEAD.match(code(lines[line]))
            assert found is not None
            for name in _names(found):
                self.labels.setdefault(name, []).append(line)
            word = (found["word"] or "").upper()
            if word and found["slash"]:
                raise StructureError(line, f"a switch decides whether ${word} is executed")
            if word in OPENS:
                open_.append((word, line, []))
            elif word in INNER:
                if not open_ or open_[-1][0] != INNER[word]:
                    raise StructureError(line, f"${word} belongs to nothing that is open here")
                open_[-1][2].append((word, line))
            elif word in ENDS:
                if not open_ or open_[-1][0] != ENDS[word]:
                    raise StructureError(line, f"${word} ends nothing that is open here")
                kind, begin, inner = open_.pop()
                self._close(Part(kind, begin, tuple(inner), line))
        if open_:
            raise StructureError(open_[-1][1], f"${open_[-1][0]} has no end")

    def _close(self, part: Part) -> None:
        words = [word for word, _ in part.inner]
        if "ELSE" in words[:-1]:
            raise StructureError(part.first, "$ELSE is not the last branch of this $IF")
        self.parts.append(part)
        self.at |= {part.first: part, part.last: part, **{at: part for _, at in part.inner}}

    def around(self, line: int) -> list[Part]:
        """Return the structures that a line stands in, the innermost first; heads are outside."""
        inside = (part for part in self.parts if part.first < line <= part.last)
        return sorted(inside, key=lambda part: -part.first)

    def target(self, name: str, line: int) -> int:
        """Return the line that a jump goes to. Raises StructureError."""
        places = self.labels.get(name, [])
        if len(places) != 1:
            message = f"{name} stands here more than once" if places else f"there is no {name}"
            raise StructureError(line, message)
        outer = {part.first for part in self.around(line)}
        if not {part.first for part in self.around(places[0])} <= outer:
            raise StructureError(line, f"the jump to {name} leads into a structure")
        return places[0]


def _names(found: re.Match[str]) -> Iterator[str]:
    if found["number"]:
        yield f"N{int(found['number'])}"
    yield from (name.upper() for name in LABEL.findall(found["labels"]))


def sections(lines: Sequence[str]) -> tuple[dict[str, range], int]:
    """Return the lines of local subroutines behind their headers, and where the program begins.

    Subroutines stand before the program (8070, Ref. 1709, p. 32); without any it begins at 0.
    """
    if "%" not in "\n".join(lines):
        return {}, 0
    heads = [(k, m) for k, text in enumerate(lines) if "%" in text and (m := HEADER.match(text))]
    if not heads or any(code(lines[k]).strip() for k in range(heads[0][0])):
        return {}, 0
    found: dict[str, range] = {}
    for at, (line, match) in enumerate(heads):
        local = LOCAL.fullmatch(match["rest"])
        if local is None:
            return (found, line) if at else ({}, 0)
        stop = heads[at + 1][0] if at + 1 < len(heads) else len(lines)
        name = (local["name"] or local["number"]).upper()
        if name in found:
            raise StructureError(line, f"a subroutine {name} stands here twice")
        found[name] = range(line + 1, stop)
    return {}, 0
