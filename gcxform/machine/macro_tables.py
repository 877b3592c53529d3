"""`[control.macro]` of a machine file: what calls do, and which codes call programs.

`P9810` whose program is not at hand, or a code of the machine's own, is said to end in some way. A
code, a range of codes whose programs follow one another, or T, is said to call a program: with
values as G65 (Fanuc 6050 to 6059, 6080 to 6089, Haas parameters 81 to 100), or with the variables
of its caller as M98 does (Fanuc 6071 to 6079; T with 6001#5, whose value is #149 then).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any, Final

from gcxform.config.schemas import Schema, whole
from gcxform.config.toml_text import TomlText
from gcxform.diagnostics import Diagnostic

MACRO: Final = "macro"
"""The name of the table."""
SHARED: Final = "shared"
"""What begins the settings of codes whose programs have the variables of their caller."""
ENDS: Final = ("unchanged", "unknown", "at XYZ")
_ENDS = re.compile("unchanged|unknown|at [XYZABCUVW]{1,9}")
_CALLED = re.compile(r"P[1-9][0-9]{0,7}|[GM][0-9]{1,3}(?:\.[0-9])?")
_CODE = "[GM][1-9][0-9]{0,2}"
_ONLY_CALLED = r"P[1-9][0-9]{0,7}|[GM](?:0[0-9]{0,2}|[0-9]{1,3}\.[0-9])"  # no code, so no alias
_ALIAS = re.compile(f"{_CODE}|T")
_RANGE = re.compile(f"({_CODE})-({_CODE})")
VARIABLES: Final = ("own", "shared")
LARGEST: Final = 10**8


def calls_of(tables: Mapping[str, Mapping[str, str | int]]) -> dict[str, str | float]:
    """Return what is said of calls, as settings; tables of which nothing is said are left out."""
    found: dict[str, str | float] = {}
    for name, said in tables.items():
        if "ends" in said:
            found[f"{MACRO} {name}"] = said["ends"]
        for code, program in _programs(name, said):
            found[f"{MACRO} {code}"] = program
            if code == "T" or said.get("variables") == "shared":
                found[f"{SHARED} {code}"] = program
    return found


def _programs(name: str, said: Mapping[str, str | int]) -> Iterator[tuple[str, int]]:
    """Yield codes with the programs that they call."""
    program = said.get("program")
    if not isinstance(program, int):
        return
    ends = _RANGE.fullmatch(name)
    if ends is None:
        yield name, program
        return
    letter, first, last = name[0], int(ends[1][1:]), int(ends[2][1:])
    yield from ((f"{letter}{n}", program + n - first) for n in range(first, last + 1))


def findings(document: TomlText, value: object) -> Iterator[Diagnostic]:
    """Yield what is wrong with what is said of calls."""
    code = document.codes.wrong_value
    if not isinstance(value, dict):
        message = f'{MACRO}: expected tables, such as [control.macro."P9810"]'
        yield Diagnostic(code, message, document.where("control", MACRO))
        return
    for name, said in value.items():
        if said == {}:
            continue
        wrong = expected(name, said)
        if wrong:
            yield Diagnostic(
                code, f"{name}: expected {wrong}", document.where("control", MACRO, name)
            )


def expected(name: str, said: object) -> str:
    """Return what was expected of a table of a call or a code, nothing where it is right."""
    ends = _RANGE.fullmatch(name)
    if ends and (ends[1][0] != ends[2][0] or int(ends[1][1:]) >= int(ends[2][1:])):
        return "the first and the last of some codes, such as G100-G109"
    table = said if isinstance(said, dict) else {}
    calls = "program" in table and (ends is not None or _ALIAS.fullmatch(name) is not None)
    if calls:
        return "" if _calls_right(table) else "program = 9010, or its like"
    if not _CALLED.fullmatch(name):
        if ends or _ALIAS.fullmatch(name):
            return "program = 9010, or its like"
        return 'a call or a code, such as "P9810", "G100" or "M50"'
    right = table.keys() == {"ends"} and _ENDS.fullmatch(str(table["ends"]))
    alias = ", or program = 9010" if _ALIAS.fullmatch(name) else ""
    return "" if right else " or ".join(f'ends = "{each}"' for each in ENDS) + alias


def _calls_right(said: Mapping[str, object]) -> bool:
    number = said["program"]
    known = said.keys() <= {"program", "variables"} and said.get("variables", "own") in VARIABLES
    return known and type(number) is int and 0 < number < LARGEST


def schema() -> dict[str, Any]:
    """Return the JSON Schema of the table: how a code is called decides what may be said of it."""
    properties: Schema = {
        "ends": {
            "type": "string",
            "pattern": whole(_ENDS.pattern),
            "description": "where the axes are behind the call",
        },
        "program": {
            "type": "integer",
            "exclusiveMinimum": 0,
            "exclusiveMaximum": LARGEST,
            "description": "the program that the code calls",
        },
        "variables": {"enum": [*VARIABLES], "description": "whose #1 to #33 it has"},
    }

    def table(*keys: str) -> Schema:
        of = {"variables": ["program"]} if "variables" in keys else {}
        said = {key: properties[key] for key in keys}
        found = {"type": "object", "properties": said, "dependentRequired": of}
        return {**found, "additionalProperties": False}

    calls = ("program", "variables")
    either = {"not": {"required": ["ends", "program"]}}
    named = {
        whole(_CODE): table("ends", *calls) | either,
        whole(_ONLY_CALLED): table("ends"),
        whole(f"T|{_CODE}-{_CODE}"): table(*calls),
    }
    other = table("ends", *calls) | {"maxProperties": 0}
    said = "what macros and codes of the machine's own do, by name: P9832, G100, M50"
    return {
        "type": "object",
        "patternProperties": named,
        "additionalProperties": other,
        "description": said,
    }
