"""The reference, made from the running code: what `<!-- made: NAME -->` on a page stands for.

Each function returns the lines of Markdown for one name. Nothing of it is kept in the repository,
so nothing of it can be out of date; the command that prints the same stands in its place.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator, Mapping
from html import escape
from typing import Any

import click

from gcxform.calibrate import csv_text
from gcxform.calibrate.ballbar import file as ballbar
from gcxform.calibrate.circles import file as circles
from gcxform.calibrate.diagonal import file as diagonals
from gcxform.calibrate.rotary import ball_file as balls
from gcxform.catalogue import CATALOGUE
from gcxform.cli import VERBS
from gcxform.cli import verbs as command_line
from gcxform.contract.options import describe
from gcxform.dialect.codes import Effect
from gcxform.dialect.dialect import Dialect
from gcxform.flow.straightened import EXECUTED
from gcxform.pipeline.schema import schema
from gcxform.plugin.registry import default_registry

REGISTRY = default_registry()
FLOW = {"o-words": "and O-words", "macro-b": "and IF, GOTO, WHILE"}
TABLES = "plugins/gcxform_plugins/dialects"

# --- text ---


def prose(text: str) -> str:
    """Return plain text as Markdown: what stands in backticks stays, and nothing is a tag."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(p if p.startswith("`") else _plain(p) for p in parts)


def _plain(text: str) -> str:
    return re.sub(r"([*_#\[\]])", r"\\\1", escape(text, quote=False))


def cell(text: str) -> str:
    """Return text for a cell of a table."""
    return prose(" ".join(text.split())).replace("|", "\\|")


def described(text: str) -> Iterator[str]:
    """Yield a docstring as Markdown; what is aligned in columns stays as it stands."""
    for paragraph in text.split("\n\n"):
        aligned = any(re.search(r"^\s|\S {2,}\S", line) for line in paragraph.splitlines())
        yield f"```text\n{paragraph}\n```" if aligned else prose(paragraph)
        yield ""


def first_sentences(thing: object) -> str:
    """Return the first paragraph of a docstring."""
    return " ".join((inspect.getdoc(thing) or "").partition("\n\n")[0].split())


# --- passes and dialects ---


def passes() -> Iterator[str]:
    """Yield a section for each pass: what it does, its facts, its options."""
    for name, step in REGISTRY.passes.items():
        yield from (f"## {name}", "", *described(inspect.getdoc(step) or ""))
        options = list(describe(step))
        if options:
            yield from ("| option | takes | default | what it says |", "|---|---|---|---|")
        for option in options:
            takes = ", ".join(f"`{c}`" for c in option.choices) or option.type
            takes += f", {option.range}" if option.range else ""
            default = "mandatory" if option.mandatory else option.default
            yield f"| `{option.name}` | {takes} | {default} | {cell(option.help)} |"
        yield ""


def dialects() -> Iterator[str]:
    """Yield a section for each dialect: its axes, and what becomes of each of its codes."""
    for name, dialect in REGISTRY.dialects.items():
        said = (dialect.__doc__ or "").partition("\n")[0]
        axes = " ".join(dialect.axes)
        yield from (f"## {name}", "", f"{said} Axes: {axes}.", "", "| | codes |", "|---|---|")
        own = dialect.__module__.removeprefix("gcxform_plugins.dialects.").split(".")[0]
        if dialect.translator is not None:
            yield f"| read | what the table at the top of `{TABLES}/{own}/dialect.py` says |"
            codes = [dialect.tip_rule.spelled.get(c, c) for c in dialect.tip_rule.switches.values()]
            yield f"| for `tip-codes` | {', '.join(codes)} |"
        else:
            yield from (f"| {word} | {codes} |" for word, codes in effects(dialect))
        yield ""


def effects(dialect: type[Dialect]) -> Iterator[tuple[str, str]]:
    """Yield what becomes of codes, and which: read, kept, refused, executed."""
    codes = sorted(dialect.codes.items(), key=lambda item: float(item[0][1:]))
    numbers = executed(dialect)
    m_codes = [(m, c) for m, c in sorted(dialect.m_codes.items()) if m not in numbers]
    which = {
        "read": (Effect.MODAL, Effect.DWELL, Effect.FRAME),
        "kept": (Effect.INERT, Effect.CALL),
        "refused": (Effect.BARRIER,),
    }
    for word, kinds in which.items():
        found = [g for g, code in codes if code.effect in kinds]
        if word != "read":
            found += [f"M{m}" for m, code in m_codes if bool(code.barrier) == (word == "refused")]
        yield word, re.sub(r"M100 (M1\d\d )+M199", "M100 ... M199", " ".join(found))
    if numbers:
        yield "executed", f"{' '.join(f'M{m}' for m in numbers)} {FLOW[dialect.flow_rule.language]}"


def executed(dialect: type[Dialect]) -> list[int]:
    """Return the M codes that are executed while a program is read."""
    return [m for m in EXECUTED.get(dialect.flow_rule.language, ()) if m in dialect.m_codes]


# --- diagnostics ---


def diagnostics() -> Iterator[str]:
    """Yield a section for each code, which is its anchor: `#gx301`."""
    for code, (title, text) in CATALOGUE.items():
        yield from (f"### {code}", "", f"**{prose(title)}.** {prose(text)}", "")


# --- verbs ---


def verbs() -> Iterator[str]:
    """Yield a section for each verb, and for each command below it, with its options."""
    context = click.Context(command_line, info_name="gcxform")
    for name in VERBS:
        command = command_line.get_command(context, name)
        assert command is not None
        yield from _command(command, f"gcxform {name}", context)


def _command(command: click.Command, name: str, above: click.Context) -> Iterator[str]:
    context = click.Context(command, parent=above, info_name=name.split()[-1])
    usage = " ".join(command.collect_usage_pieces(context))
    yield from (f"## {name}", "", *described(inspect.cleandoc(command.help or "")))
    yield from (f"```text\n{name} {usage}\n```", "")
    rows = [p.get_help_record(context) for p in command.params if p.name != "help"]
    shown = [row for row in rows if row]
    if shown:
        yield from ("| option | what it says |", "|---|---|")
        yield from (f"| `{o}` | {cell(said)} |" for o, said in shown)
        yield ""
    if isinstance(command, click.Group):
        for below in command.list_commands(context):
            found = command.get_command(context, below)
            assert found is not None
            yield from _command(found, f"{name} {below}", context)


# --- files ---


def files() -> Iterator[str]:
    """Yield a section for each kind of file, with its tables and their keys."""
    for kind in ("pipeline", "machine", "model"):
        whole = schema(kind)
        yield from (f"## {kind.capitalize()} files", "")
        if "properties" in whole:
            yield from _tables(whole)
        for table in whole.get("$defs", {}).values():
            yield from _keys(table["title"], table, "###")


def _tables(whole: Mapping[str, Any]) -> Iterator[str]:
    for name, table in whole["properties"].items():
        item = table.get("items", table)
        if "properties" in item:
            yield from _keys(f"[{name}]", item, "###")


def _keys(title: str, table: Mapping[str, Any], mark: str) -> Iterator[str]:
    yield from (f"{mark} {prose(title)}", "")
    yield from described(inspect.cleandoc(table.get("description", "")))
    if table.get("properties"):
        yield from ("| key | takes | what it says |", "|---|---|---|")
    for key, value in table.get("properties", {}).items():
        said = cell(value.get("description", ""))
        if (default := value.get("default")) not in (None, "", {}, []):
            said = f"{said}; default `{default}`".removeprefix("; ")
        yield f"| `{key}` | {cell(takes(value))} | {said} |"
    yield ""
    for key, value in table.get("properties", {}).items():
        for inner, below in ((value, key), (value.get("additionalProperties"), f"{key}.NAME")):
            if isinstance(inner, Mapping) and inner.get("properties"):
                yield from _keys(f"[{below}]", inner, mark)


def takes(value: Mapping[str, Any]) -> str:
    """Return in words what a key takes, from its JSON Schema."""
    if "anyOf" in value:
        return " or ".join(filter(None, map(takes, value["anyOf"])))
    if "$ref" in value:
        return f"the keys of {value['$ref'].rpartition('/')[2]}"
    if "enum" in value:
        return ", ".join(f"`{c}`" for c in value["enum"] if c != "")
    if "const" in value:
        return f"`{value['const']}`"
    kind = value.get("type", "")
    words = [{"null": "", "object": "table", "array": "list"}.get(k, k) for k in _list(kind)]
    return " or ".join(filter(None, words))


def _list(kind: str | list[str]) -> list[str]:
    return [kind] if isinstance(kind, str) else kind


# --- tables of readings ---

READINGS = {
    "What they have in common": csv_text,
    "Diagonals and linear tests": diagonals,
    "Centres of balls": balls,
    "Circles of the linear axes": circles,
    "Circular tests with RTCP on": ballbar,
}


def readings() -> Iterator[str]:
    """Yield a section for each kind of tables, as the module that reads it says."""
    for title, module in READINGS.items():
        yield from (f"## {title}", "", *described(inspect.getdoc(module) or ""))


# --- what else plugins offer ---


def _offers(things: Mapping[str, type]) -> Iterator[str]:
    yield from ("| name | what it is |", "|---|---|")
    yield from (f"| `{n}` | {cell(first_sentences(thing))} |" for n, thing in things.items())


def formats() -> Iterator[str]:
    """Yield the formats of error tables."""
    return _offers(REGISTRY.formats)


def controls() -> Iterator[str]:
    """Yield the controls whose files are read."""
    return _offers(REGISTRY.controls)


def kinematics() -> Iterator[str]:
    """Yield the kinds of machines."""
    return _offers(REGISTRY.kinematics)


def presets() -> Iterator[str]:
    """Yield the presets of machines."""
    return _offers(REGISTRY.presets)


def facts() -> Iterator[str]:
    """Yield the facts, which passes require, ensure and clear."""
    yield from ("| fact | what it says |", "|---|---|")
    yield from (f"| `{n}` | {cell(fact.meaning)} |" for n, fact in REGISTRY.facts.items())


MADE: Mapping[str, Callable[[], Iterator[str]]] = {
    made.__name__: made
    for made in (
        *(passes, dialects, diagnostics, verbs, files, readings),
        *(formats, controls, kinematics, presets, facts),
    )
}
