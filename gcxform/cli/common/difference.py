"""What a run would change, as a unified diff: only the lines that change, and why they do.

Behind the second `@@` of each part stands which step changes which of its lines of the source. The
source map says which lines belong together, so nothing is searched for; only where the output runs
through the source in another order (calls that are written out) difflib does.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from typing import Any, Final, NamedTuple

from gcxform.cli.common.transform import Done, Texts
from gcxform.diagnostics import shown
from gcxform.stamps.comment import is_stamp

CONTEXT: Final = 3  # lines around those that change
_LINE = re.compile(rb"[^\r\n]*(?:\r\n|\n|\r)|[^\r\n]+\Z")
_COLOUR: Final = {"-": "31", "+": "32", "@": "36", "*": "1"}
_SENT: Final = re.compile(r"[^\S \n\t]|[\x00-\x08\x0b-\x1f\x7f-\x9f]")


class Line(NamedTuple):
    """A line of the diff: ' ', '-' or '+', its text, and the line of the source, from 0."""

    sign: str
    text: bytes
    source: int


class Part(NamedTuple):
    """Lines of a diff that stand together; `first` are their lines in source and output, from 1."""

    first: tuple[int, int]
    lines: list[Line]
    why: list[str]

    def head(self) -> str:
        """Return the line above them: where they are, and why they change."""
        old, new = (sum(each.sign in signs for each in self.lines) for signs in (" -", " +"))
        (one, two), why = self.first, "; ".join(self.why)
        return f"@@ -{one - (not old)},{old} +{two - (not new)},{new} @@ {why}\n"


def parts_of(done: Done) -> list[Part]:
    """Return what a run has changed."""
    assert done.texts is not None
    lines = list(_lines(done.texts))
    return [_part(done, lines, first, last) for first, last in _stretches(lines)]


def unified(done: Done) -> Iterator[str]:
    """Yield the lines of a diff, each byte a character; nothing if nothing is changed."""
    parts = parts_of(done)
    name = shown(done.certificate.source["name"])
    if parts:
        yield from (f"--- {name}\n", f"+++ {name}\n")
    for part in parts:
        yield part.head()
        for line in part.lines:
            text = line.text.decode("latin-1")
            yield line.sign + text
            if not text.endswith(("\n", "\r")):
                yield "\n\\ No newline at end of file\n"


def on_terminal(line: str) -> str:
    """Return a line of a diff in colour; what would command the terminal is shown as ?."""
    text = line.rstrip("\r\n")
    sign = "*" if line.startswith(("--- ", "+++ ")) else text[:1]
    safe = _SENT.sub("?", text)
    if os.environ.get("NO_COLOR"):
        return f"{safe}\n"
    return f"\x1b[{_COLOUR[sign]}m{safe}\x1b[0m\n" if sign in _COLOUR else f"{safe}\n"


def described(done: Done) -> list[dict[str, Any]]:
    """Return what a run has changed as plain values."""
    return [
        {
            "source_line": part.first[0],
            "output_line": part.first[1],
            "why": part.why,
            "lines": [each.sign + each.text.decode("latin-1") for each in part.lines],
        }
        for part in parts_of(done)
    ]


# --- which lines belong together ---


def _lines(texts: Texts) -> Iterator[Line]:
    old, new = _LINE.findall(texts.source), _LINE.findall(b"".join(texts.output))
    ordered = all(a <= b for a, b in zip(texts.lines, texts.lines[1:], strict=False))
    if ordered and len(texts.lines) == len(new):
        yield from _by_map(old, new, texts.lines)
    else:
        yield from _searched(old, new)


def _by_map(old: list[bytes], new: list[bytes], lines: list[int]) -> Iterator[Line]:
    """Yield the lines of both, those of the output behind the line that they come from."""
    at = 0
    for number, text in enumerate(old):
        first = at
        while at < len(new) and lines[at] <= number:
            at += 1
        made = new[first:at]
        kept = made.index(text) if text in made else -1
        if kept < 0:
            yield Line("-", text, number)
        for nth, each in enumerate(made):
            yield Line(" " if nth == kept else "+", each, number)
    yield from (Line("+", text, len(old) - 1) for text in new[at:])


def _searched(old: list[bytes], new: list[bytes]) -> Iterator[Line]:
    """Yield the lines of both, as difflib pairs them."""
    import difflib

    matcher = difflib.SequenceMatcher(None, old, new, autojunk=False)
    for kind, i, i_end, j, j_end in matcher.get_opcodes():
        same = kind == "equal"
        yield from (Line(" " if same else "-", old[k], k) for k in range(i, i_end))
        if not same:
            yield from (Line("+", new[k], max(i_end - 1, 0)) for k in range(j, j_end))


def _stretches(lines: list[Line]) -> Iterator[tuple[int, int]]:
    """Yield first and end of what changes with the lines around it."""
    first, end = -1, -1
    for number, line in enumerate(lines):
        if line.sign == " ":
            continue
        if first < 0 or number - CONTEXT > end:
            if first >= 0:
                yield first, end
            first = max(number - CONTEXT, 0)
        end = min(number + CONTEXT + 1, len(lines))
    if first >= 0:
        yield first, end


def _part(done: Done, lines: list[Line], first: int, end: int) -> Part:
    before = lines[:first]
    place = (
        sum(each.sign != "+" for each in before) + 1,
        sum(each.sign != "-" for each in before) + 1,
    )
    return Part(place, lines[first:end], list(_why(done, lines[first:end])))


# --- why ---


def _why(done: Done, lines: list[Line]) -> Iterator[str]:
    """Yield which step has changed which lines of the source."""
    assert done.texts is not None
    found: dict[str, list[int]] = {}
    for number in dict.fromkeys(each.source for each in lines if each.sign != " "):
        for name in done.texts.steps.get(number) or [_otherwise(done, lines, number)]:
            found.setdefault(name, []).append(number + 1)
    yield from (f"{name}: {_ranges(numbers)}" for name, numbers in found.items())


def _otherwise(done: Done, lines: list[Line], number: int) -> str:
    """Return why a line is another one that no step has changed."""
    new = [each.text for each in lines if each[::2] == ("+", number)]
    if new and all(is_stamp(text.decode("latin-1")) for text in new):
        return "stamp"
    dialects = done.certificate.source["dialect"], done.certificate.output["dialect"]
    if dialects[0] != dialects[1]:
        return f"written for {dialects[1]}"
    return "by what stands before"


def _ranges(numbers: Iterable[int]) -> str:
    """Return numbers that rise in words: 3, 5-9."""
    parts: list[list[int]] = []
    for number in sorted(numbers):
        if parts and number == parts[-1][1] + 1:
            parts[-1][1] = number
        else:
            parts.append([number, number])
    return ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in parts)
