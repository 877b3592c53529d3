"""The section `[control]` of a machine file: settings on which the meaning of codes depends.

A setting is declared before a file can have it: here, or by the dialect that asks for it
(`Dialect.settings`). So a word that is misspelt is refused, and never takes the place of silence.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, ClassVar, Final

from gcxform.config.quantities import LENGTH
from gcxform.config.schemas import quantity_schema, whole
from gcxform.config.toml_text import TomlText, did_you_mean
from gcxform.diagnostics import Diagnostic
from gcxform.machine import macro_tables
from gcxform.machine.machine import SWITCHES, TIP_AT_START
from gcxform.machine.macro_tables import MACRO
from gcxform.values import dataclass

INERT: Final = "inert-m"
"""The setting that lists M codes which move nothing."""
OTHER: Final = "code "
"""What the settings begin with that a file of the control says of an M code of its own."""
Value = str | float | list[int] | dict[str, dict[str, str | int]]
LIKE: Final = "like"
"""The key that names a preset, which is gone when the settings are read."""
D_IS: Final = "d-is"
"""The setting that says what `d` of a tool is."""
COMP_CORNERS: Final = "cutter-comp-corners"
COMP_ENTRY: Final = "cutter-comp-entry"
"""The settings that say how the control resolves a contour under cutter compensation."""
HOME: Final = re.compile(r"G28|G30( P[0-9]+)?|M140|M92")
FURTHER: Final = r"G5(0[5-9]|[1-9][0-9])"
WORK_OFFSET: Final = re.compile(rf"G5[4-9](\.[1-9])?( P[0-9]+)?|G154 P[0-9]+|G15 H[0-9]+|{FURTHER}")
"""The names of homes and of work offsets that a machine file takes."""
PER_TABLE: Final = 6  # work offsets that have codes of two digits
_OWN_CODE = re.compile("M[1-9][0-9]{2,3}")


def offset_in_blocks(name: str) -> str:
    """Return what blocks call a work offset that a control counts with three digits, as G505."""
    if not re.fullmatch(FURTHER, name):
        return name
    place = int(name[2:])
    return f"G{53 + place}" if place <= PER_TABLE else f"G54.1 P{place - PER_TABLE}"


@dataclass(frozen=True)
class Setting:
    """A setting of a control: its key, what it says, and the values that it takes.

    `choices` are those values; without any it is a length in mm that is not negative, which a file
    may write with its unit. The settings of a control are not options: what is not said is not
    known, and codes that depend on it are refused.
    """

    name: str
    help: str
    choices: tuple[str | int, ...] = ()
    kind: ClassVar[str] = "a length in mm"

    def read(self, raw: object) -> str | float:
        """Return the value; ValueError, with a sentence, for what is none."""
        if not self.choices:
            return _length(raw)
        if isinstance(raw, bool) or raw not in self.choices:
            wanted = ", or ".join(f'"{c}"' if isinstance(c, str) else str(c) for c in self.choices)
            raise ValueError(f"expected {wanted}")
        assert isinstance(raw, str | float | int)
        return raw

    def told(self, raw: object) -> dict[str, str | float]:
        """Return what is known by it, by name; ValueError for what says nothing."""
        return {self.name: self.read(raw)}

    def schema(self) -> dict[str, Any]:
        """Return its JSON Schema."""
        length = quantity_schema(LENGTH) | {"minimum": 0}
        taken = {"enum": [*self.choices]} if self.choices else length
        return {**taken, "description": self.help}


@dataclass(frozen=True)
class NumberSetting(Setting):
    """A setting that is a whole number, such as a line of a table."""

    kind: ClassVar[str] = "a whole number"

    def read(self, raw: object) -> int:
        """Return the number; ValueError for what is none."""
        if isinstance(raw, bool) or not isinstance(raw, int | float) or raw < 0 or raw % 1:
            raise ValueError("expected a whole number")
        return int(raw)

    def schema(self) -> dict[str, Any]:
        """Return its JSON Schema."""
        return {"type": "integer", "minimum": 0, "description": self.help}


@dataclass(frozen=True)
class NumbersSetting(NumberSetting):
    """A setting that is a list of different whole numbers, in an order that means something.

    What is known is the place of each, from 0, under the name of the setting and the number.
    """

    kind: ClassVar[str] = "a list of whole numbers"

    def told(self, raw: object) -> dict[str, str | float]:
        """Return the place of each number; ValueError for what is no such list."""
        if not isinstance(raw, list):
            raise ValueError("expected a list of whole numbers")
        places = {f"{self.name} {self.read(each)}": place for place, each in enumerate(raw)}
        if len(places) < len(raw):
            raise ValueError("expected each number once")
        return dict(places)

    def schema(self) -> dict[str, Any]:
        """Return its JSON Schema."""
        items = {"type": "integer", "minimum": 0}
        return {"type": "array", "items": items, "uniqueItems": True, "description": self.help}


@dataclass(frozen=True)
class _Code(Setting):
    """A setting that names an M code of the machine's own."""

    kind: ClassVar[str] = "an M code"

    def read(self, raw: object) -> str | float:
        """Return the code; ValueError for what is none."""
        if not isinstance(raw, str) or not _OWN_CODE.fullmatch(raw):
            raise ValueError('expected an M code of the machine\'s own, such as "M428"')
        return raw

    def schema(self) -> dict[str, Any]:
        """Return its JSON Schema."""
        return {"type": "string", "pattern": whole(_OWN_CODE.pattern), "description": self.help}


_KNOWN: dict[str, Setting] = {}


def declare(settings: Iterable[Setting]) -> None:
    """Let machine files have settings. ValueError if one of the name takes other values."""
    for setting in settings:
        if _KNOWN.setdefault(setting.name, setting) != setting or setting.name == INERT:
            raise ValueError(f"the setting {setting.name!r} is there, and is another one")


declare(
    (
        Setting("g52", "what G52 does: Setting 33 of haas", ("fanuc", "haas", "yasnac")),
        Setting("user-codes", "whether M100 to M199 are there", ("keep",)),
        Setting("argument-list", "how G65 takes I, J, K: parameter 6008#7", ("I", "II")),
        Setting("local-variables", "what #1 to #33 are before the program", ("null",)),
        Setting("null-compare", "whether null EQ 0 is false, or true", ("distinct", "zero")),
        Setting("macro-repeat", "variables of a macro in the second run of L", ("keep", "anew")),
        Setting("cycle-levels", "what R and Z of a cycle in G90 are behind a G91", ("stay",)),
        Setting("cycle-repeats", "what counts the holes of a cycle, if not K", ("L",)),
        Setting("peck-return", "how far G73 goes up between pecks"),
        Setting("peck-clearance", "how far above the last depth a peck of G83 begins"),
        _Code("tip-on", "the M code from which the control follows the tip of the tool"),
        _Code("tip-off", "the M code from which it does not"),
        Setting(D_IS, "what D calls: 5004#2 of fanuc, Setting 40 of haas", ("diameter", "radius")),
        Setting(COMP_CORNERS, "what joins moves outside a corner under G41", ("arc", "linear")),
        Setting(COMP_ENTRY, "beside which end the move with G41 ends", ("own", "next")),
        Setting("tool-length-alone", "what G43 without Z does: Z, or zero", ("moves", "shifts")),
        Setting("tool-length-axis", "where lengths stay in G18 and G19", ("Z",)),
        Setting(TIP_AT_START, "whether it does before the first block", ("off", "on")),
        Setting(
            "tip-words",
            "where X, Y and Z of G43.4 count if it comes with the table turned",
            ("workpiece", "machine"),
        ),
    )
)


def answers(name: str) -> str:
    """Return what a setting says and which values it takes, in words; "" for one that is none."""
    setting = _KNOWN.get(name)
    if setting is None:
        return ""
    choices = " or ".join(f'"{c}"' if isinstance(c, str) else str(c) for c in setting.choices)
    return f"{setting.help}: {choices or setting.kind}"


def settings_of(control: Mapping[str, Value]) -> dict[str, str | float]:
    """Return the values of a section that has no findings; lengths in mm."""
    found: dict[str, str | float] = {}
    for name, raw in control.items():
        found |= {} if name in (INERT, MACRO) else _KNOWN[name].told(raw)
    calls = control.get(MACRO, {})
    return found | (macro_tables.calls_of(calls) if isinstance(calls, dict) else {})


def codes_of(codes: Mapping[str, str]) -> dict[str, str | float]:
    """Return what a file of the control says of its own M codes, as settings."""
    return {f"{OTHER}{name}": how for name, how in codes.items()}


def inert_of(control: Mapping[str, Value]) -> frozenset[int]:
    """Return the M codes that move nothing."""
    codes = control.get(INERT, [])
    return frozenset(codes) if isinstance(codes, list) else frozenset()


def undeclared(control: Mapping[str, Value]) -> bool:
    """Whether there is a setting that nothing which is loaded has declared."""
    return not control.keys() <= {*_KNOWN, INERT, MACRO}


def findings(document: TomlText, control: Mapping[str, Value]) -> Iterator[Diagnostic]:
    """Yield what is wrong with a section."""
    for name, value in control.items():
        if name == MACRO:
            yield from macro_tables.findings(document, value)
            continue
        if name != INERT and name not in _KNOWN:
            known = [*_KNOWN, INERT, MACRO]
            yield from document.unknown_key(("control", name), known).diagnostics
            continue
        try:
            _codes(value) if name == INERT else _KNOWN[name].told(value)
        except ValueError as error:
            setting = _KNOWN.get(name)
            words = [str(choice) for choice in setting.choices] if setting else []
            hint = did_you_mean(str(value), words) if words and isinstance(value, str) else ""
            where = document.where("control", name)
            yield Diagnostic(document.codes.wrong_value, f"{name}: {error}", where, hint)
    yield from _switch_findings(document, control)


def _switch_findings(document: TomlText, control: Mapping[str, Value]) -> Iterator[Diagnostic]:
    """Yield what is wrong with the two codes that let the control follow the tip, and leave it."""
    given = {name: control[name] for name in SWITCHES if name in control}
    message = ""
    if 0 < len(given) < len(SWITCHES):
        message = f"{' and '.join(SWITCHES)} are given together"
    elif len(given) == len(SWITCHES) and given[SWITCHES[0]] == given[SWITCHES[1]]:
        message = "one code cannot say both"
    for name in given if message else ():
        where = document.where("control", name)
        yield Diagnostic(document.codes.wrong_value, f"{name}: {message}", where)


def schema() -> dict[str, Any]:
    """Return the JSON Schema of the section."""
    codes = {
        "type": "array",
        "items": {"type": "integer"},
        "description": "the machine's own M codes that move no axis and set no variable",
    }
    known = {name: setting.schema() for name, setting in _KNOWN.items()}
    like = {"type": "string", "description": "a preset of a machine"}
    properties = {**known, INERT: codes, MACRO: macro_tables.schema(), LIKE: like}
    return {
        "type": "object",
        "properties": properties,
        "dependentRequired": {name: [n for n in SWITCHES if n != name] for name in SWITCHES},
        "additionalProperties": False,
    }


def _length(raw: object) -> float:
    if isinstance(raw, bool) or not isinstance(raw, str | int | float):
        raise ValueError('expected a length, such as "0.5 mm"')
    length = LENGTH.parse(raw) if isinstance(raw, str) else float(raw)
    if not length >= 0.0:
        raise ValueError(f"{length:g} mm is below 0")
    return length


def _codes(raw: object) -> None:
    if not isinstance(raw, list):
        raise ValueError("expected a list of M codes, such as [100, 101]")
