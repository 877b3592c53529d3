"""What may have to be said of a control for a program to be read: what each setting means.

A question is the place of a setting, as keys: `("input", "increment")` of a pipeline file,
`("control", "peck-return")` or `("tool", "3", "length")` of a machine file. Hints of diagnostics
ask them (`gcxform.catalogue.settings`). Where a control shows the value is known as its manual or
the module of its dialect says; where nothing is said here, nothing is known.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

from gcxform.catalogue.settings import Setting, settings

Question = tuple[str, ...]
PIPELINE: Final = "input"

_INPUT: Final = (
    "start",
    "increment",
    "feed-increment",
    "feed",
    "block-delete",
    "units",
    "parameters",
)
_MACHINE: Final = ("control", "tool", "work-offset", "home")
OF_THE_STATE: Final = ("start", "parameters", "feed", "units")
"""Settings that are asked for because of what stood before, and not by the block alone."""

MEANINGS: Final[Mapping[Question, str]] = {
    ("input", "start"): "where the axes stand before the first block, as its words would say it",
    ("input", "increment"): "what 1 means in a distance without a decimal point",
    ("input", "feed-increment"): "what 1 means in an F without a decimal point",
    ("input", "feed"): "the feed before the first F word, in units per minute",
    ("input", "block-delete"): 'whether blocks with a slash run: "execute" or "skip"',
    ("input", "units"): 'units before the first G20 or G21: "mm" or "in"',
    ("input", "parameters"): "what a parameter is worth that the program reads and does not set",
    ("control", "inert-m"): "which of these M codes move no axis and set no variable, as [20, 21]",
    ("control", "macro"): 'where axes are behind it: "unchanged", "unknown" or "at XYZ"',
    ("tool", "length"): "from the gauge point of the spindle to the tip, mm: what H calls",
    ("tool", "radius"): "mm: what D calls, half of it where the control has diameters",
    ("work-offset",): "the zero of the work offset in the machine, as the page of offsets has it",
    ("home",): "the reference point in the machine, mm or degrees",
}
COUNTS: Final = "siemens"
"""The dialect whose work offsets beyond the fourth are G505 to G599."""
FURTHER: Final = "G54.1 P"
SHOWN: Final[Mapping[Question, Mapping[str, str]]] = {
    ("input", "increment"): {
        "fanuc": 'parameter 3401 bit 0 (DPI): 1 is "calculator", 0 an increment system',
        "haas": 'Setting 162, DEFAULT TO FLOAT: on is "calculator"',
    },
    ("input", "feed-increment"): {"haas": "Setting 77, SCALE INTEGER F"},
    ("input", "block-delete"): {"haas": "BLOCK DELETE"},
    ("control", "peck-return"): {"fanuc": "parameter 5114", "haas": "Setting 22"},
    ("control", "peck-clearance"): {"fanuc": "parameter 5115", "haas": "Setting 22"},
    ("control", "g52"): {"haas": "Setting 33"},
    ("control", "cycle-without-place"): {"haas": "Setting 28"},
    ("control", "cycle-repeats"): {"fanuc": "parameter 0001 bit 1 (FCV): 1 is L"},
}


def kind_of(question: Question) -> Question:
    """Return what a question is about, without number of tool, code or axis."""
    if question[0] in ("work-offset", "home"):
        return question[:1]
    return (question[0], question[-1]) if question[0] == "tool" else question[:2]


def questions(hint: str) -> Iterator[tuple[Question, Any]]:
    """Yield what a hint asks for, each with the value that it gives, 0 where it has dots."""
    for setting in settings(hint):
        section, *name = setting.section.split(".", 1)
        if section == PIPELINE and setting.key in _INPUT:
            yield from _of_input(setting)
        elif name and section == "control":
            table, _, call = name[0].partition(".")
            yield (section, table, call.strip('"'), setting.key), setting.worth()
        elif section in _MACHINE:
            yield (section, *(part.strip('"') for part in name), setting.key), setting.worth()


def _of_input(setting: Setting) -> Iterator[tuple[Question, Any]]:
    worth = setting.worth()
    if not isinstance(worth, dict):
        yield (PIPELINE, setting.key), worth
        return
    for name, value in worth.items():
        yield (PIPELINE, setting.key, name), value


def meaning_of(question: Question) -> str:
    """Return what a setting means, empty where its own declaration says it."""
    return MEANINGS.get(kind_of(question), "")


def shown_by(question: Question, dialect: str) -> str:
    """Return where a control shows a setting, empty where that is not known."""
    if question[0] == "work-offset" and dialect == COUNTS:
        return _counted(question[1])
    return SHOWN.get(kind_of(question), {}).get(dialect, "")


def _counted(name: str) -> str:
    """Return what a control that counts its work offsets calls one beyond the fourth."""
    place = {"G58": "05", "G59": "06"}.get(name, "")
    if name.startswith(FURTHER):
        place = f"{int(name.removeprefix(FURTHER)) + 6:02}"
    return f"G5{place}, as which this table may be called too" if place else ""
