"""What functions of texts of a SINUMERIK are worth (Job planning 07/2010 p. 74; siemens.md 2.3).

Characters count from 0, and -1 is the place of one that is not there. Where no source tells what a
control does there is no value: for parts beyond the end of a text, for letters that are not of
ASCII, for texts that are numbers only to some.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from gcxform import vocabulary as v

Text = str | float
PLAIN = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
NO_NUMBER = re.compile(r"[^0-9.+\-EX \t]", re.IGNORECASE)


def _text(value: Text) -> str:
    if not isinstance(value, str):
        raise v.NoValueError("a number where a text is due")
    return value


def _count(value: Text) -> int:
    if isinstance(value, str) or value != int(value) or value < 0:
        raise v.NoValueError("a place in a text is a whole number from 0")
    return int(value)


def _letter(value: Text) -> str:
    """Return the character that is looked for: a text of one, or the number of one."""
    if isinstance(value, str) and len(value) == 1:
        return value
    if not isinstance(value, str) and value == int(value) and 0 < value < 256:
        return chr(int(value))
    raise v.NoValueError("one character is looked for")


def _part(text: Text, first: Text, count: Text | None = None) -> str:
    whole, at = _text(text), _count(first)
    end = len(whole) if count is None else at + _count(count)
    if not at < len(whole) or end > len(whole):
        raise v.NoValueError("a part beyond the end of its text")
    return whole[at:end]


def _number(text: Text) -> float:
    if not PLAIN.fullmatch(_text(text)):
        raise v.NoValueError(f'"{text}" is no plain number')
    return float(_text(text))


def _is_number(text: Text) -> float:
    whole = _text(text)
    if not PLAIN.fullmatch(whole) and not NO_NUMBER.search(whole):
        raise v.NoValueError(f'whether "{whole}" is a number no source tells')
    return float(PLAIN.fullmatch(whole) is not None)


def _cased(change: Callable[[str], str]) -> Callable[[Text], str]:
    def cased(text: Text) -> str:
        if not _text(text).isascii():
            raise v.NoValueError("letters that are not of ASCII")
        return change(_text(text))

    return cased


Function = Callable[..., Text]
FUNCTIONS: dict[str, tuple[Function, range]] = {
    "STRLEN": (lambda text: float(len(_text(text))), range(1, 2)),
    "SUBSTR": (_part, range(2, 4)),
    "INDEX": (lambda text, one: float(_text(text).find(_letter(one))), range(2, 3)),
    "RINDEX": (lambda text, one: float(_text(text).rfind(_letter(one))), range(2, 3)),
    "NUMBER": (_number, range(1, 2)),
    "ISNUMBER": (_is_number, range(1, 2)),
    "TOUPPER": (_cased(str.upper), range(1, 2)),
    "TOLOWER": (_cased(str.lower), range(1, 2)),
}
"""Functions that take or give texts, and how many arguments they take."""
TRUTHS = frozenset(("TRUE", "FALSE", "ISNUMBER"))
UNTOLD = frozenset(("BOOL", "CHAR"))
"""Types of which no source tells how they stand in a text."""


def of_texts(name: str, given: Sequence[Text]) -> Text:
    """Return what a function of texts gives. Raises NoValueError."""
    function, counts = FUNCTIONS[name]
    if len(given) not in counts:
        raise v.NoValueError(f"{name} takes another number of arguments")
    return function(*given)
