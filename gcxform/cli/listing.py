"""`gcxform list`: what is installed, where it comes from, and which options it has."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from typing import Any

import click

from gcxform.cli import VERBS
from gcxform.cli.common.answer import answer
from gcxform.cli.common.failures import warn
from gcxform.config.toml_text import did_you_mean
from gcxform.contract.options import OptionDoc, describe
from gcxform.contract.passes import Pass, TextPass
from gcxform.diagnostics import UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.machine.presets import MachinePreset, said_by
from gcxform.plugin.registry import Registry, default_registry

KINDS = {
    "passes": "pass",
    "dialects": "dialect",
    "kinematics": "kinematics",
    "presets": "preset",
    "formats": "format",
    "controls": "control",
}


@click.command("list", help=VERBS["list"], short_help=VERBS["list"])
@click.argument("kind", type=click.Choice(list(KINDS)))
@click.argument("name", required=False)
def command(kind: str, name: str | None) -> None:
    """List things of a kind, or describe one of them."""
    registry = default_registry()
    things: Mapping[str, type] = getattr(registry, kind)
    loaded = {n: things[n] for n in (things if name is None else (name,)) if n in things}
    warn(registry.diagnostics)
    if name is None:
        rows = [(n, _first_line(t), registry.origin(KINDS[kind], n)) for n, t in loaded.items()]
        keys = ("name", "says", "origin")
        values = [dict(zip(keys, row, strict=True)) for row in rows]
        answer({"kind": kind, "things": values}, _table(rows))
    else:
        lines = _described(_chosen(things, kind, name), KINDS[kind], registry)
        answer({"kind": kind, "name": name, "lines": lines}, lines)


def _chosen(things: Mapping[str, type], kind: str, name: str) -> type:
    if name in things:
        return things[name]
    code = {"passes": "GX704", "dialects": "GX703"}.get(kind, "GX730")
    what = {"kinematics": "kinematic model", "formats": "format"}.get(kind, KINDS[kind])
    raise UsageError.one(code, f"there is no {what} {name!r}", hint=did_you_mean(name, things))


def _table(rows: Sequence[tuple[str, str, str]]) -> list[str]:
    width = max((len(name) for name, _, _ in rows), default=0)
    middle = max((len(text) for _, text, _ in rows), default=0)
    return [f"{name:{width}}  {text:{middle}}  {origin}" for name, text, origin in rows]


def _first_line(thing: type) -> str:
    return (inspect.getdoc(thing) or "").partition("\n\n")[0].replace("\n", " ")


def _described(thing: Any, kind: str, registry: Registry) -> list[str]:
    """Return all that is known of one thing."""
    lines = [f"{thing.name}   {registry.origin(kind, thing.name)}", ""]
    lines += (inspect.getdoc(thing) or "").splitlines()
    if issubclass(thing, Pass | TextPass) or hasattr(thing, "__dataclass_fields__"):
        lines += ["", *_options(describe(thing))]
    if issubclass(thing, Pass):
        lines += _facts(thing)
    if issubclass(thing, Dialect):
        lines += ["", *_dialect(thing)]
    if suffixes := getattr(thing, "suffixes", ()):
        lines += ["", f"files: {' '.join(suffixes)}"]
    if issubclass(thing, MachinePreset):
        lines += ["", f"source: {thing.source}", *said_by(thing)]
    if control := getattr(thing, "control", ""):
        lines.append(f"in the control: {control}")
    return lines


def _options(found: list[OptionDoc]) -> list[str]:
    """Return the options of a pass, one a line."""
    if not found:
        return ["no options"]
    rows = [(option.name, _type(option), _help(option)) for option in found]
    width = max(len(name) for name, _, _ in rows)
    middle = max(len(kind) for _, kind, _ in rows)
    return [f"  {name:{width}}  {kind:{middle}}  {text}".rstrip() for name, kind, text in rows]


def _type(option: OptionDoc) -> str:
    return " | ".join(option.choices) or option.type


def _help(option: OptionDoc) -> str:
    default = f"default {option.default}" if option.default else ""
    last = "mandatory" if option.mandatory else default
    return "; ".join(part for part in (option.help, option.range, last) if part)


def _facts(thing: type[Pass]) -> list[str]:
    names = ("requires", "ensures", "clears")
    sets = {name: sorted(fact.name for fact in getattr(thing, name)) for name in names}
    return [f"{name:8} {' '.join(facts)}" for name, facts in sets.items() if facts]


def _written(translator: type) -> str:
    """Return from which dialects programs in a language of its own are written."""
    if getattr(translator, "speller", None) is not None:
        return "from itself and from others, by passes that put no stamp into programs"
    if getattr(translator, "writes", False):
        return "from itself, by passes that keep positions"
    return "no: name another dialect in [output]"


def _dialect(thing: type[Dialect]) -> list[str]:
    """Return what a dialect can do, in a few lines."""
    codes = sorted(thing.codes, key=lambda code: float(code[1:]))
    numbers = thing.numbers
    if thing.translator is not None:
        tips = thing.tip_rule
        switches = (tips.spelled.get(code, code) for code in tips.switches.values())
        return [
            f"axes      {' '.join(thing.axes)}",
            f"tip       {', '.join(switches)}",
            f"written   {_written(thing.translator)}",
        ]
    return [
        f"axes      {' '.join(thing.axes)}",
        f"G codes   {' '.join(codes)}",
        f"M codes   {' '.join(f'M{code}' for code in sorted(thing.m_codes))}",
        f"at start  {' '.join(thing.initial.values())}",
        f"decimals  {numbers.mm} in mm, {numbers.inch} in inch, {numbers.angle} of degrees",
    ]
