"""Lines of a program as words, per dialect: the lexical half of the reference interpreter."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

BREAK = "\x1f"  # stands where a comment was: a number may not run across it
NUMBER = re.compile(r"[+-]*(?:\d+\.?\d*|\.\d+)")
ONE_SIGN = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)")
LINUXCNC_LINE = 252  # characters, comments included
GRBL_LINE = 79  # characters, without comments and blanks


class Refused(Exception):
    """The control refuses `line` (1-based), or it needs more than this language."""

    def __init__(self, line: int, reason: str) -> None:
        super().__init__(f"line {line}: {reason}")
        self.line = line
        self.reason = reason


@dataclass(frozen=True)
class Word:
    """A letter, its value as programmed, and whether the number had a decimal point."""

    letter: str
    value: float
    pointed: bool


@dataclass(frozen=True)
class Block:
    """The words of one source line (1-based)."""

    line: int
    words: tuple[Word, ...]


def blocks(program: bytes, dialect: str, *, skip: bool = False) -> Iterator[Block]:
    """Yield the blocks in order, up to the end of the frame if there is one.

    `skip` leaves out the lines which begin with a slash; GRBL has no such switch.
    """
    reader = {"linuxcnc": _linuxcnc, "fanuc": _fanuc, "haas": _haas, "grbl": _grbl}[dialect]
    lines = program.decode("latin-1").split("\n")
    if lines and not lines[-1]:
        lines.pop()
    yield from reader(lines, skip)


# --- LinuxCNC ------------------------------------------------------------------------------


def _linuxcnc(lines: list[str], skip: bool) -> Iterator[Block]:
    """Blocks of a LinuxCNC file: a frame of percent signs, or an end by M2 or M30."""
    filled = [i for i, text in enumerate(lines) if text.strip()]
    framed = bool(filled) and lines[filled[0]].strip() == "%"
    for index in filled[1:] if framed else filled:
        number, text = index + 1, lines[index]
        if framed and text.strip() == "%":
            return
        if len(text) > LINUXCNC_LINE:
            raise Refused(number, "the block is too long")
        if not (skip and text.lstrip(" \t").startswith("/")):
            yield _block(number, _strip_comments(text, number, semicolon=True).lower(), NUMBER)
    raise Refused(len(lines), "the file ends without a percent sign or program end")


# --- Fanuc ---------------------------------------------------------------------------------


def _haas(lines: list[str], skip: bool) -> Iterator[Block]:
    """Blocks of a Haas program: a Fanuc tape in capitals or small letters."""
    yield from _fanuc(lines, skip, any_case=True)


def _fanuc(lines: list[str], skip: bool, *, any_case: bool = False) -> Iterator[Block]:
    """Blocks of a Fanuc tape: nothing before the first percent sign, nothing after the second."""
    filled = [i for i, text in enumerate(lines) if text.strip()]
    framed = bool(filled) and lines[filled[0]].strip() == "%"
    named = False
    for index in filled[1:] if framed else filled:
        number, text = index + 1, lines[index]
        if framed and text.strip() == "%":
            return
        if skip and text.lstrip(" ").startswith("/"):
            continue
        text = _strip_comments(text, number, semicolon=False)
        text = text.upper() if any_case else text
        if re.search("[a-z;]", text):
            raise Refused(number, "lower case and semicolons are not in the alphabet")
        if re.fullmatch(rf"[O:]\d+{BREAK}*", text):
            if named:
                raise Refused(number, "a second program")
            named = True
            continue
        yield _block(number, text.lower(), ONE_SIGN, delete_digit=True)


# --- GRBL ----------------------------------------------------------------------------------


def _grbl(lines: list[str], _skip: bool) -> Iterator[Block]:
    """Blocks of a GRBL stream: comments, blanks and slashes vanish before the words are read."""
    for number, line in enumerate(lines, start=1):
        for part in line.split("\r"):
            text = _grbl_filter(part)
            if len(text) > GRBL_LINE:
                raise Refused(number, "the block overflows the line buffer")
            if text:
                yield Block(number, tuple(_words(text.lower(), number, ONE_SIGN)))


def _grbl_filter(text: str) -> str:
    """Return the line as GRBL keeps it: the first ) ends a comment, however many ( there were."""
    kept, depth = [], 0
    for char in text:
        if depth:
            depth = 0 if char == ")" else 1
        elif char == "(":
            depth = 1
        elif char == ";":
            break
        elif char > " " and char != "/":
            kept.append(char)
    return "".join(kept)


# --- shared --------------------------------------------------------------------------------


def _strip_comments(text: str, number: int, *, semicolon: bool) -> str:
    """Drop blanks and replace each comment by `BREAK`; comments do not nest and must close."""
    kept, inside = [], False
    for char in text:
        if inside:
            if char == "(":
                raise Refused(number, "nested comment")
            inside = char != ")"
        elif char == "(":
            kept.append(BREAK)
            inside = True
        elif char == ";" and semicolon:
            break
        elif char not in " \t\r":
            kept.append(char)
    if inside:
        raise Refused(number, "unclosed comment")
    return "".join(kept)


def _block(
    number: int, text: str, numeral: re.Pattern[str], *, delete_digit: bool = False
) -> Block:
    """Read an optional slash, an optional sequence number, then words."""
    text = re.sub(r"^/[1-9]?" if delete_digit else "^/", "", text)
    text = re.sub(rf"^n\d+(\.\d+)?(?=[a-z{BREAK}]|$)", "", text)
    if re.fullmatch(rf"o\d+{BREAK}*", text):
        text = ""
    return Block(number, tuple(_words(text, number, numeral)))


def _words(text: str, number: int, numeral: re.Pattern[str]) -> Iterator[Word]:
    """Yield letter and number pairs; anything else is refused."""
    at = 0
    while at < len(text):
        if text[at] == BREAK:
            at += 1
            continue
        found = numeral.match(text, at + 1)
        if not ("a" <= text[at] <= "z") or found is None:
            raise Refused(number, f"not a word: {text[at:]!r}")
        digits = found.group().lstrip("+-")
        sign = -1.0 if found.group().count("-") % 2 else 1.0
        yield Word(text[at].upper(), sign * float(digits), "." in digits)
        at = found.end()
