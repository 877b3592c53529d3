"""The settings that hints name: found, tried, and said as the command line takes them.

A hint gives a setting as a pipeline file has it, `increment = "IS-B" in [input]`, as a machine file
has it, `X = ... in [home.G28]`, or as a step has it, `chord-error = "2 um"`; dots stand for numbers
that the reader knows. Who has typed a chain has no pipeline file: to them it is an option of the
command line, `--increment IS-B`, or a word of the chain, `chord-error=2um`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any, Final, NamedTuple

VALUE: Final = r'"[^"]*"|\'[^\']*\'|\[[^\]]*\]|\{[^}]*\}|-?[0-9.]+'
SETTING: Final = re.compile(
    rf"(?P<key>[a-z][a-z0-9-]*|\b[A-Z](?= = \S+ in \[)) = (?P<value>{VALUE})"
    r"(?: in \[(?P<section>[a-z][^\]]*)\])?"
)
ON_COMMAND_LINE: Final[Mapping[tuple[str, str], str]] = {
    ("input", "dialect"): "-f",
    ("output", "dialect"): "-t",
    ("machine", "file"): "-m",
    ("budget", "deviation"): "--budget",
    **{
        (section, key): f"--{key}"
        for section, keys in (
            ("input", "start increment feed-increment feed tool block-delete units parameters"),
            ("output", "decimals"),
            ("budget", "growth"),
        )
        for key in keys.split()
    },
}
"""What the command line calls the keys of the sections of a pipeline file."""


class Setting(NamedTuple):
    """A setting in a hint: its section ("" for a step), key, and value as TOML."""

    section: str
    key: str
    value: str

    def worth(self) -> Any:
        """Return the value; 0 where dots or a small letter stand for a number."""
        text = re.sub(r"\.\.\.|\b[a-z]\b(?=[],])", "0.0", self.value).replace(", 0.0 }", " }")
        import tomllib

        return tomllib.loads(f"value = {text}")["value"]


def settings(hint: str) -> Iterator[Setting]:
    """Yield the settings that a hint gives."""
    for found in SETTING.finditer(hint):
        yield Setting(found["section"] or "", found["key"], found["value"])


def for_chain(hint: str) -> str:
    """Return a hint for who has typed a chain, and has no pipeline file."""
    return SETTING.sub(_typed, hint)


def _typed(found: re.Match[str]) -> str:
    key, value, section = found["key"], _words(found["value"]), found["section"]
    if section is None:
        return f"{key}={value}"
    option = ON_COMMAND_LINE.get((section, key))
    return found[0] if option is None else f"{option} {value}"


def _words(value: str) -> str:
    """Return a value of TOML as it is typed: without blanks where it means the same."""
    if value[0] in "\"'":
        inner = value[1:-1]
        inner = re.sub(r"(?<=[0-9.]) (?=[a-z]+$)", "", inner)
        return f"'{inner}'" if " " in inner else inner
    if value[0] in "[{":
        return re.sub(r"\s*([=,])\s*", r"\1", value[1:-1].strip()).replace('"', "")
    return value
