"""Proves a program that is written in a language of its own: its lines say what has been proved.

The blocks were proved as they were written. The lines that stand for them are read anew, and say
blocks as well: word for word, and in the same modes, these have to be those that were proved. A
block is compared with all modes in force behind it, so it does not matter which block states one.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal

from gcxform.diagnostics import (
    Diagnostic,
    GcxformError,
    Location,
    SpellingError,
    VerificationError,
)
from gcxform.dialect.dialect import Dialect
from gcxform.flow.translated import Translated, translated
from gcxform.modal.state import Reading
from gcxform.syntax.source import Source

COMMENT = re.compile(r"\([^()]*\)")
WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")
HINT = "nothing was written; this is a bug of gcxform"
SPELL_HINT = "let the CAM write plain moves in its place, or write for another dialect"
KEPT_HINT = "state the mode in the block itself, or before it what the rest of the program is in"
TURN = "G", Decimal(68)
Said = tuple[tuple[tuple[str, Decimal], ...], tuple[str, ...], tuple[tuple[str, str], ...]]
"""The words of a block, its comments, and the codes in force behind it, by group."""


def check_respelled(
    written: Source,
    blocks: Iterable[bytes],
    dialect: type[Dialect],
    reading: Reading,
    known: Translated | None = None,
) -> None:
    """Check that what was written says blocks that have been proved. Raises GcxformError.

    `known` is what the same bytes were read as, where they were.
    """
    try:
        found = known or translated(written, dialect, reading)
    except GcxformError as error:
        (first, *_) = error.diagnostics
        message = f"what was written is not read: {first.message}"
        raise VerificationError((Diagnostic("GX601", message, first.where, HINT),)) from None
    proved, told = [*blocks], found.text.splitlines()
    if proved == told:
        return
    wanted = said_by((b.decode("latin-1") for b in proved), dialect)
    now = said_by((b.decode("latin-1") for b in told), dialect)
    for _, one in wanted:
        at, other = next(now, (-1, None))
        if one != other:
            raise _wrong(found, at)
    if (more := next(now, None)) is not None:
        raise _wrong(found, more[0])


def _wrong(found: Translated, block: int) -> SpellingError:
    """Return the error about a line that says something else than its block."""
    line = found.line_of(block + 1) if block >= 0 else len(found.lines)
    text = found.lines[line - 1] if found.lines else ""
    where = Location(found.name, line, 1, text, max(1, len(text.rstrip())))
    message = "what this line became cannot be said in its language"
    return SpellingError((Diagnostic("GX501", message, where, SPELL_HINT),))


def check_kept(source: Translated, blocks: Iterable[bytes], dialect: type[Dialect]) -> None:
    """Check that what is kept as it stands is executed in the modes in which it was programmed.

    Raises SpellingError.
    """
    code, blocks = source.translator.kept, [*blocks]
    if blocks == source.text.splitlines():
        return
    if code.encode() not in source.text and not any(code.encode() in each for each in blocks):
        return
    before, after = (
        [each for each in said_by(texts, dialect) if _is_kept(each[1], code)]
        for texts in (
            source.text.decode("latin-1").splitlines(),
            (block.decode("latin-1") for block in blocks),
        )
    )
    for (at, one), (_, other) in zip(before, after, strict=True):
        changed = [f"{new[1]}, and not {old[1]}" for old, new in _changed(one, other)]
        if changed:
            line = source.line_of(at + 1)
            text = source.lines[line - 1]
            where = Location(source.name, line, 1, text, max(1, len(text.rstrip())))
            message = f"this is kept as it stands, and would be executed in {'; '.join(changed)}"
            raise SpellingError((Diagnostic("GX501", message, where, KEPT_HINT),))


def _changed(one: Said, other: Said) -> list[tuple[tuple[str, str], tuple[str, str]]]:
    return [(old, new) for old, new in zip(one[2], other[2], strict=True) if old != new]


def _is_kept(said: Said, code: str) -> bool:
    return bool(code) and any(
        letter == code[0] and f"{letter}{_plain(value)}" == code for letter, value in said[0]
    )


def said_by(blocks: Iterable[str], dialect: type[Dialect]) -> Iterator[tuple[int, Said]]:
    """Yield what blocks say, with their numbers; those that only state modes are left out."""
    modes, codes = dict(dialect.initial), _Modal(dialect)
    in_force = tuple(sorted(modes.items()))
    bare = getattr(getattr(dialect.translator, "speller", None), "names_planes", False)
    for number, block in enumerate(blocks):
        words = []
        for letter, digits in WORD.findall(COMMENT.sub("", block)):
            group, code = codes[digits] if letter == "G" else ("", "")
            if group not in modes:
                words.append((letter, Decimal(digits)))
            elif modes[group] != code:
                modes[group] = code
                in_force = tuple(sorted(modes.items()))
        comments = tuple(COMMENT.findall(block))
        if words or comments:
            plane = not bare or _in_plane(modes, words)
            counts = in_force if plane else tuple(m for m in in_force if m[0] != "plane")
            yield number, (tuple(sorted(words)), comments, counts)


def _in_plane(modes: Mapping[str, str], words: Iterable[tuple[str, Decimal]]) -> bool:
    """Whether the plane matters to a block: that of an arc, a contour, a cycle, a turn."""
    straight = modes["motion"] in ("G0", "G1") and modes["cutter-comp"] == "G40"
    return not straight or TURN in words


class _Modal(dict[str, tuple[str, str]]):
    """The group of a G code, and what it is called, by its digits as they are written."""

    def __init__(self, dialect: type[Dialect]) -> None:
        self.dialect = dialect

    def __missing__(self, digits: str) -> tuple[str, str]:
        name = f"G{_plain(Decimal(digits))}"
        code = self.dialect.codes.get(name)
        self[digits] = found = ("" if code is None else code.group, name)
        return found


def _plain(value: Decimal) -> str:
    text = format(value, "f")
    return text.rstrip("0").rstrip(".") if "." in text else text
