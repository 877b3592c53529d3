"""TOML files as text: where a key stands, and diagnostics which show the line.

`tomllib` gives the values of a file and nothing about their places. The scan here finds the places
in a text which `tomllib` has accepted, so it may take correct syntax for granted.
"""

from __future__ import annotations

import enum
import re
import typing
from collections.abc import Iterable, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import msgspec

from gcxform.catalogue.remedies import write_instead
from gcxform.diagnostics import Location, UsageError
from gcxform.system import inputs
from gcxform.system.inputs import UTF16, UTF16_MARKS
from gcxform.values import dataclass

Keys = tuple[str | int, ...]
Config = TypeVar("Config", bound=msgspec.Struct)

_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_SPACE = re.compile(r"[ \t]*")
_STRING = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}(?!")|' + r"'''.*?'{3,5}(?!')|" + r'"(?:\\.|[^"\\])*"|' + r"'[^']*'",
    re.DOTALL,
)
BACKSLASH = "a path of Windows stands in single quotes, or has / in the place of \\"
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_BARE_VALUE = re.compile(r"[^,\]}#\n]*")


def locate_key(text: str, path_of_keys: Sequence[str | int]) -> tuple[int, int]:
    """Return the 1-based line and column of a key or array element of a valid TOML text.

    An element of an array of tables is its `[[header]]`. What the text does not have is placed at
    the innermost table that is there, and at (0, 1), which is no line, if there is none.
    """
    return _line_and_column(text, _innermost(_Scan(text).places, tuple(path_of_keys)))


def _innermost(places: dict[Keys, int], keys: Keys) -> int | None:
    while keys and keys not in places:
        keys = keys[:-1]
    return places.get(keys)


def _line_and_column(text: str, offset: int | None) -> tuple[int, int]:
    if offset is None:
        return 0, 1
    return text.count("\n", 0, offset) + 1, offset - text.rfind("\n", 0, offset)


class _Scan:
    """The offset of every key and array element of a TOML text."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.places: dict[Keys, int] = {}
        self._tables_in: dict[Keys, int] = {}  # elements of each array of tables so far
        table: Keys = ()
        while self._skip(_BLANK) < len(text):
            table = self._header() if text[self.at] == "[" else self._assignment(table)

    def _skip(self, pattern: re.Pattern[str]) -> int:
        """Move behind what the pattern matches here and return the new offset."""
        found = pattern.match(self.text, self.at)
        self.at = found.end() if found else self.at
        return self.at

    def _header(self) -> Keys:
        """Read `[a.b]` or `[[a.b]]` and return the table which it opens."""
        start = self.at
        brackets = 2 if self.text.startswith("[[", start) else 1
        self.at += brackets
        table: Keys = ()
        names = [name for name, _ in self._dotted()]
        for name in names[:-1]:
            table = self._last((*table, name))
            self.places.setdefault(table, start)
        table += (names[-1],)
        if brackets == 2:
            count = self._tables_in[table] = self._tables_in.get(table, 0) + 1
            self.places.setdefault(table, start)
            table += (count - 1,)
        self.places.setdefault(table, start)
        self.at += brackets
        return table

    def _last(self, table: Keys) -> Keys:
        """Return the table, or its last element if it is an array of tables."""
        count = self._tables_in.get(table)
        return table if count is None else (*table, count - 1)

    def _assignment(self, table: Keys) -> Keys:
        """Read `key = value` into a table, which is returned."""
        keys = table
        for name, start in self._dotted():
            keys += (name,)
            self.places.setdefault(keys, start)
        self.at = self.text.index("=", self.at) + 1
        self._value(keys)
        return table

    def _dotted(self) -> list[tuple[str, int]]:
        """Read the parts of a dotted key and return them with their offsets."""
        import tomllib

        parts: list[tuple[str, int]] = []
        while not parts or self.text[self.at] == ".":
            self.at += bool(parts)
            start = self._skip(_SPACE)
            quoted = self.text[start] in "\"'"
            raw = self.text[start : self._skip(_STRING if quoted else _BARE_KEY)]
            if not raw:
                raise ValueError(f"not TOML at offset {start}")
            parts.append((tomllib.loads(f"key = {raw}")["key"] if quoted else raw, start))
            self._skip(_SPACE)
        return parts

    def _value(self, keys: Keys) -> None:
        first = self.text[self._skip(_SPACE)]
        if first == "[":
            self._array(keys)
        elif first == "{":
            self._inline_table(keys)
        else:
            self._skip(_STRING if first in "\"'" else _BARE_VALUE)

    def _array(self, keys: Keys) -> None:
        self.at += 1
        index = 0
        while self.text[self._skip(_BLANK)] != "]":
            self.places[(*keys, index)] = self.at
            self._value((*keys, index))
            index += 1
            self._separator()
        self.at += 1

    def _inline_table(self, keys: Keys) -> None:
        self.at += 1
        while self.text[self._skip(_BLANK)] != "}":
            self._assignment(keys)
            self._separator()
        self.at += 1

    def _separator(self) -> None:
        self._skip(_BLANK)
        self.at += self.text[self.at] == ","


class Codes(NamedTuple):
    """The diagnostic codes of one sort of file."""

    unreadable: str
    not_toml: str
    unknown_key: str
    missing_key: str
    wrong_value: str


@dataclass(frozen=True)
class TomlText:
    """A TOML file which was read: its name, its text and its values."""

    file: str
    text: str
    values: dict[str, Any]
    codes: Codes

    @cached_property
    def _places(self) -> dict[Keys, int]:
        return _Scan(self.text).places

    def where(self, *keys: str | int) -> Location:
        """Return the place of a key, or of the innermost table which is there."""
        line, column = _line_and_column(self.text, _innermost(self._places, keys))
        return _location(self.file, self.text, line, column)

    def unknown_key(self, keys: Keys, known: Iterable[str]) -> UsageError:
        """Return the error for a key which is not one of the known ones."""
        message = f"unknown key {keys[-1]!r}{_in(keys[:-1])}"
        return UsageError.one(
            self.codes.unknown_key, message, self.where(*keys), did_you_mean(str(keys[-1]), known)
        )

    def missing_key(self, keys: Keys) -> UsageError:
        """Return the error for a key which has to be there."""
        message = f"the key {keys[-1]!r} is missing{_in(keys[:-1])}"
        return UsageError.one(self.codes.missing_key, message, self.where(*keys[:-1]))


def _in(keys: Keys) -> str:
    return f" in {_written(keys)}" if keys else ""


def _written(keys: Keys) -> str:
    """Return a path as a person writes it; elements are counted from one."""
    return "".join(f"[{k + 1}]" if isinstance(k, int) else f".{k}" for k in keys).lstrip(".")


def _location(file: str, text: str, line: int, column: int) -> Location:
    if not line:
        return Location(file)
    lines = text.split("\n")
    shown = lines[line - 1].rstrip("\r") if line <= len(lines) else ""
    return Location(file, line, column, shown)


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return a hint: the known word nearest to a wrong one, otherwise all that are known."""
    names = {name.lower(): name for name in known}
    import difflib

    if near := difflib.get_close_matches(word.lower(), names, n=1):
        return write_instead(names[near[0]], word, f"did you mean {names[near[0]]!r}?")
    return f"known: {', '.join(names.values())}" if names else ""


def read_toml(path: Path, codes: Codes) -> TomlText:
    """Return a TOML file, or raise UsageError with the place where it is not one."""
    import tomllib

    text = read_text(path, codes.unreadable, codes.not_toml)
    if text.count(".") > MOST_PARTS and _DEEP.search(_STRING.sub("q", _COMMENT.sub("", text))):
        message = f"a key has more than {MOST_PARTS} parts"
        raise UsageError.one(codes.not_toml, message, Location(str(path)))
    try:
        return TomlText(str(path), text, tomllib.loads(text), codes)
    except (ValueError, RecursionError) as error:  # a plain ValueError: 5000 digits, month 13
        raise _not_toml(path, text, codes.not_toml, str(error)) from None


_OURS = re.compile(r"^[ \t]*format[ \t]*=[ \t]*[0-9]", re.MULTILINE)
"""What the files that we know begin with; lines of any others are not shown: they may be secret."""
MOST_PARTS = 100  # of a dotted key: tomllib and whoever follows the tables go through all of them
_COMMENT = re.compile(r"^[ \t]*#[^\n]*", re.MULTILINE)
_DEEP = re.compile(rf"(?<![\w.-])[\w-]++(?:[ \t]*+\.[ \t]*+[\w-]++){{{MOST_PARTS}}}")
_AT = re.compile(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", re.DOTALL)


def _not_toml(path: Path, text: str, code: str, message: str) -> UsageError:
    """Return the error for a message of tomllib, which has the place in its words."""
    found = _AT.fullmatch(message)
    reason = (found[1] if found else message).rstrip(".")
    line, column = 0, 1
    if found and found[2]:
        line, column = int(found[2]), int(found[3])
    elif found:
        line, column = _line_and_column(text, len(text.rstrip()))
    where = _location(str(path), text if _OURS.search(text) else "", line, column)
    hint = BACKSLASH if line and "\\" in text.splitlines()[line - 1] else ""
    return UsageError.one(code, f"this is not TOML: {reason}", where, hint)


def read_text(path: Path, unreadable: str, not_utf8: str) -> str:
    """Return the text of a UTF-8 file without byte order mark, or raise UsageError."""
    try:
        data = inputs.read(path)
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError.one(
            unreadable, f"the file cannot be read: {reason}", Location(str(path))
        ) from None
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        column = error.start - data.rfind(b"\n", 0, error.start)
        where = Location(str(path), line, column)
        hint = UTF16 if data.startswith(UTF16_MARKS) else "save it as UTF-8"
        raise UsageError.one(not_utf8, "the file is not UTF-8 text", where, hint) from None


_UNKNOWN = re.compile(r"Object contains unknown field `(.*?)`")
_MISSING = re.compile(r"Object missing required field `(.*?)`")
_PLACE = re.compile(r" - at `\$(.*)`$")
_STEP = re.compile(r"\.([^.\[]+)|\[(\d+)\]")


def convert(document: TomlText, config: type[Config]) -> Config:
    """Return the values of a file as a msgspec struct, or raise UsageError with the place."""
    try:
        return msgspec.convert(document.values, config)
    except msgspec.ValidationError as error:
        raise _explained(document, config, str(error)) from None


def _explained(document: TomlText, config: type[msgspec.Struct], message: str) -> UsageError:
    """Return msgspec's message as our diagnostic."""
    place = _PLACE.search(message)
    keys: Keys = ()
    for step in _STEP.finditer(place[1].split("[...]")[0] if place else ""):
        keys += (int(step[2]) if step[2] else step[1],)
    if found := _UNKNOWN.match(message):
        return document.unknown_key((*keys, found[1]), _known_keys(config, keys))
    if found := _MISSING.match(message):
        return document.missing_key((*keys, found[1]))
    reason = message[: place.start()] if place else message
    subject = f"{_written(keys)}: " if keys else ""
    choice = re.fullmatch(r"Invalid enum value '(.*)'", reason)
    return UsageError.one(
        document.codes.wrong_value,
        f"{subject}{choice[1]!r} is not one of its values" if choice else subject + _plain(reason),
        document.where(*keys),
        did_you_mean(choice[1], _choices(config, keys)) if choice else "",
    )


_PLAIN = {
    "float": "a number",
    "int": "a whole number",
    "str": "a string",
    "bool": "true or false",
    "array": "a list",
    "object": "a table",
}


def _plain(reason: str) -> str:
    """Return msgspec's sentence in the words of TOML: `Expected `float`, got `str``."""
    reason = reason.replace(" | null", "")
    words = re.sub(r"`([a-z]+)`", lambda m: _PLAIN.get(m[1], m[0]), reason)
    return words[:1].lower() + words[1:]


def _known_keys(config: type[msgspec.Struct], keys: Keys) -> list[str]:
    """Return the keys which the table at a path may have."""
    return [f.encode_name for f in _fields(config, keys)]


def _choices(config: type[msgspec.Struct], keys: Keys) -> list[str]:
    """Return the words which the key at a path may hold, also as an element of its list."""
    named = [k for k, key in enumerate(keys) if isinstance(key, str)]
    last = named[-1] if named else 0
    types = [f.type for f in _fields(config, keys[:last]) if f.encode_name == keys[last]]
    return [word for t in types for word in _words_of(t)]


def _fields(config: type[msgspec.Struct], keys: Keys) -> list[msgspec.structs.FieldInfo]:
    """Return the fields of the structs which the table at a path may be."""
    fields = list(msgspec.structs.fields(config))
    for key in keys:
        if isinstance(key, str):
            structs = [s for f in fields if f.encode_name == key for s in _structs_of(f.type)]
            fields = [f for s in structs for f in msgspec.structs.fields(s)]
    return fields


def _structs_of(annotation: Any) -> list[type[msgspec.Struct]]:
    """Return the structs in a type such as `list[A] | B | None`."""
    if isinstance(annotation, type) and issubclass(annotation, msgspec.Struct):
        return [annotation]
    return [s for part in typing.get_args(annotation) for s in _structs_of(part)]


def _words_of(annotation: Any) -> list[str]:
    """Return the words of an enumeration, of literals, or of a type which holds some."""
    if isinstance(annotation, str):  # an argument of Literal
        return [annotation]
    if isinstance(annotation, type) and issubclass(annotation, enum.Enum):
        return [str(member.value) for member in annotation]
    return [word for part in typing.get_args(annotation) for word in _words_of(part)]
