"""What hints offer to do: values that an editor or a test carries out, and their words.

A setting stands in the sentence of a hint as TOML has it, and is read from there
(`gcxform.catalogue.settings`). What is no TOML, a pass that is to be put before another or a word
that is to be written otherwise, is a value that the sentence carries: a `Hint` is a string, made by
one of the functions here, and the only place that finds words for an offer is its function.

One offer is enough, but where a machine file has to say several places at once (`ways`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any, Final, Literal, NamedTuple, Self

from gcxform.catalogue.settings import Setting, for_chain, settings


class StepBefore(NamedTuple):
    """A pass in the chain: put before `step` (before all if it is ""), with options as typed."""

    name: str
    step: str = ""
    options: str = ""


class Edit(NamedTuple):
    """A change of the text at the place of a diagnostic.

    how      "replace": `instead`, which stands at the place, by `text`; "line-out": the block,
             which does nothing
    """

    how: Literal["replace", "line-out"]
    text: str = ""
    instead: str = ""


Offer = Setting | StepBefore | Edit
OFFSET: Final = re.compile(r"G\d+(\.\d+)?( P\d+)?")
PLACES: Final = ("tool.", "work-offset.", "home.")
MACHINE: Final = ("control", "tool", "work-offset", "home", "axis")


class Hint(str):
    """The sentence of a hint, and what it offers beside the settings that stand in it."""

    beside: tuple[StepBefore | Edit, ...]

    def __new__(cls, text: str, *beside: StepBefore | Edit) -> Self:
        """Return a sentence that carries offers."""
        hint = super().__new__(cls, text)
        hint.beside = beside
        return hint

    def __add__(self, more: str) -> Hint:
        """Return the sentence with more behind it; what either offers stays."""
        return Hint(str(self) + str(more), *self.beside, *getattr(more, "beside", ()))

    def __getnewargs__(self) -> tuple[Any, ...]:
        return (str(self), *self.beside)


def offers(hint: str) -> Iterator[Offer]:
    """Yield what a hint offers."""
    beside = getattr(hint, "beside", ())
    own = {
        each.partition("=")[0] for step in beside for each in getattr(step, "options", "").split()
    }
    yield from (each for each in settings(hint) if each.section or each.key not in own)
    yield from beside


def ways(hint: str) -> list[tuple[Offer, ...]]:
    """Return the ways out of a hint, each of which is enough: what it takes for one of them.

    What a machine file is to have of its work offsets, tools and homes belongs together.
    """
    found = list(offers(hint))
    places = tuple(o for o in found if isinstance(o, Setting) and o.section.startswith(PLACES))
    return [*((o,) for o in found if o not in places), *([places] if places else [])]


def said_to_chain(hint: str) -> str:
    """Return a hint for who has typed a chain, and has no pipeline file."""
    return Hint(for_chain(hint), *getattr(hint, "beside", ()))


def as_table(offer: Offer) -> dict[str, str]:
    """Return an offer as strings by name, for JSON: `kind` is setting, option, pass or edit."""
    if isinstance(offer, StepBefore):
        return {"kind": "pass", **_said(offer._asdict())}
    if isinstance(offer, Edit):
        return {"kind": "edit", **_said(offer._asdict())}
    if not offer.section:
        return {"kind": "option", "key": offer.key, "value": offer.value}
    file = "machine" if offer.section.partition(".")[0] in MACHINE else "pipeline"
    return {"kind": "setting", "file": file, **offer._asdict()}


def _said(fields: dict[str, str]) -> dict[str, str]:
    return {key: value for key, value in fields.items() if value}


# --- the words ---


SET_ANEW: Final = " as set anew"
"""What stands behind the name of a work offset whose zero was set to what is not known."""


def _offsets_said(*names: str) -> str:
    """Return the settings of a machine file that say where work offsets are; `*` for no name."""
    quoted = {n: _quoted(n) for n in names if OFFSET.fullmatch(n)}
    sections = list(dict.fromkeys(quoted.values())) if len(quoted) == len({*names}) else ["*"]
    return ", ".join(f"X = ... in [work-offset.{each}]" for each in sections)


def ways_to_offsets(first: str, *names: str) -> str:
    """Return what to do about work offsets of which it is not known where they are.

    `first` is that from which positions count. No file says where a program or a call puts one.
    """
    if any(SET_ANEW in name for name in names):
        return "the program sets it there, or a call whose program is not at hand"
    return f"give a machine file with {_offsets_said(first, *names)}"


def tool_said(number: float) -> str:
    """Return the setting of a machine file that puts a tool into the table."""
    return f"if it is in the table of the control: length = ... in [tool.{number:g}]"


def way_home_said(code: str, axis: str, offsets: Iterable[str], lengths: list[str]) -> list[str]:
    """Return the settings that say where an axis goes by a way home; none where none would do.

    `offsets` and `lengths` are those that the place hangs on and that are not known, as frames
    name them. The first of the settings is home.
    """
    tools = [re.fullmatch("-?H([0-9]+)", each) for each in lengths]
    if not all(tools) or not all(map(OFFSET.fullmatch, offsets)):
        return []
    said = [f"{axis} = ... in [work-offset.{_quoted(each)}]" for each in offsets]
    said += [f"length = ... in [tool.{tool[1]}]" for tool in tools if tool]
    return [f"{axis} = ... in [home.{_quoted(code)}]", *said]


def _quoted(name: str) -> str:
    return f'"{name}"' if "." in name or " " in name else name


def put_before(name: str, step: str = "", options: str = "", why: str = "") -> Hint:
    """Offer a pass before a step, before all if none is named; `options` as typed in a chain."""
    given = ", ".join(each.replace("=", ' = "', 1) + '"' for each in options.split())
    text = f'put the pass "{name}" before' + (f' "{step}"' if step else "")
    text += (f", with {given}" if given else "") + why
    return Hint(text, StepBefore(name, step, options))


def write_instead(text: str, wrong: str, said: str) -> Hint:
    """Offer a word for a wrong one, in a sentence."""
    return Hint(said, Edit("replace", text, wrong))


def leave_out_block(said: str = "leave the block out") -> Hint:
    """Offer the program without the block."""
    return Hint(said, Edit("line-out"))


def either(*hints: str, by: str = ", or ") -> Hint:
    """Return several ways out as one hint."""
    beside = [offer for hint in hints for offer in getattr(hint, "beside", ())]
    return Hint(by.join(map(str, hints)), *beside)
