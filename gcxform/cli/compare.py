"""`gcxform compare`: how far two programs are apart, however each of them is cut."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from gcxform.api import Program
from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.answer import answer
from gcxform.cli.common.outputs import STDOUT
from gcxform.cli.common.programs import opened
from gcxform.cli.common.request import Asked, excluding, needed_dialect
from gcxform.comparison import TOLERANCE, Comparison, Difference, compare
from gcxform.contract.options import Argument, build
from gcxform.contract.passes import Pass
from gcxform.diagnostics import Location, UsageError
from gcxform.plugin.registry import default_registry

MODEL_PASS = "volumetric"
SHOWN = 10


@click.command("compare", help=VERBS["compare"], short_help=VERBS["compare"])
@click.option("-f", "--from", "dialect", metavar="DIALECT", help="Dialect of A.")
@click.option("-t", "--to", metavar="DIALECT", help="Dialect of B.  [default: that of A]")
@click.option(
    "--tolerance",
    type=options.ABOVE_NOTHING,
    default=f"{TOLERANCE:g}",
    help=f"What is still the same, in mm or with a unit.  [default: {TOLERANCE * 1000:g} um]",
)
@click.option("--model", metavar="FILE", help="B is what a machine with these errors is told.")
@click.option("--part-origin", metavar="X,Y,Z", help="Origin of the programs in the machine.")
@click.option("--table-origin", metavar="X,Y,Z", help="Origin of the measurement.")
@click.option("--outside", metavar="POLICY", help="What the error is beyond the table.")
@click.option("--time", metavar="TIME", help="Time (ISO 8601) whose temperatures hold.")
@click.option("--backlash", metavar="WHAT", help="Of a model with backlash: mean takes the mean.")
@click.option("--max-extrapolation", metavar="N", help="Cells beyond the table.  [default: 1]")
@options.reading_options
@click.argument("a", metavar="A")
@click.argument("b", metavar="B")
def command(
    a: str,
    b: str,
    dialect: str | None,
    to: str | None,
    tolerance: float,
    model: str | None,
    part_origin: str | None,
    table_origin: str | None,
    outside: str | None,
    time: str | None,
    backlash: str | None,
    max_extrapolation: str | None,
    **asked: Any,
) -> int:
    """Compare two programs; exit 1 if path, feeds or events differ."""
    if a == b == STDOUT:
        raise excluding("stdin as A and stdin as B")
    told = {"model": model, "part-origin": part_origin, "table-origin": table_origin}
    told |= {"outside": outside, "time": time, "backlash": backlash}
    through = _model({**told, "max-extrapolation": max_extrapolation})
    what = Asked(**asked)
    dialect = needed_dialect(dialect)
    first, second = _program(a, dialect, dialect, what), _program(b, to or dialect, dialect, what)
    found = compare(first, second, tolerance, through, what.loaded_machine)
    answer(values(found, first, second), report(found, first, second).splitlines())
    return 0 if found.same else 1


def _model(given: dict[str, str | None]) -> Pass | None:
    """Return the pass that made B, None if there is none."""
    raw = {key: Argument(text) for key, text in given.items() if text is not None}
    if "model" not in raw:
        if raw:
            raise UsageError.one("GX705", f"--{next(iter(raw))} needs --model")
        return None
    registry = default_registry()
    chosen = registry.pass_(MODEL_PASS)
    formats = registry.formats.values()
    step = build(chosen, raw, Path.cwd(), formats, lambda key: Location(f"--{key}"))
    assert isinstance(step, Pass)
    return step


def _program(file: str, dialect: str, machine_of: str, asked: Asked) -> Program:
    """Return a program; `machine_of` is the dialect of the machine file."""
    kind, reading = asked.reads(dialect, machine_of)
    with opened(file) as source:
        text = b"".join(source.windows())
        return Program(text, kind, reading, source.name)


def report(found: Comparison, a: Program, b: Program) -> str:
    """Return a comparison in words."""
    lines = [f"{k}: {p.name} ({p.dialect.name}), {_moves(p)}" for k, p in (("A", a), ("B", b))]
    if found.parted:
        one, other = (f"line {n}" if n else "nothing" for n in found.parted)
        lines.append(f"the paths part: {one} of A, {other} of B")
        lines.append(f"until then {found.matched} pairs of moves belong together")
    else:
        place = f", line {found.line_a} of A, line {found.line_b} of B" if found.line_a else ""
        limit = f"tolerance {found.tolerance:g} mm"
        lines.append(f"largest deviation {found.deviation:.6f} mm ({limit}){place}")
        if found.angle:
            lines.append(f"largest difference of a rotary axis {found.angle:.6f} degrees")
    for lone in found.places:
        lines.append(
            f"{lone.what} (line {lone.line_a} of A, {lone.line_b} of B): not compared there"
        )
    if found.places:
        lines.append("say where the axes are at the start (--start), if the programs do not")
    if found.ends_only:
        lines.append(f"{found.ends_only} moves only at their ends: rapids, unknown starts")
    if found.spared:
        off = f"off by up to {found.spared_by:.4f} mm, and compared by what the control is told"
        rapids = f"{found.spared} rapid{'s' if found.spared != 1 else ''}"
        lines.append(f"{rapids} of B left to the machine: {off}")
    for name, all_ in (("feeds", found.feeds), ("events", found.events)):
        lines.append(f"{name}: {'differ' if all_ else 'the same'}")
        lines += [f"  {d.what} (line {d.line_a} of A, line {d.line_b} of B)" for d in all_[:SHOWN]]
        lines += [f"  ... and {len(all_) - SHOWN} more"] if len(all_) > SHOWN else []
    return "\n".join([*lines, "SAME" if found.same else "DIFFERENT"])


def values(found: Comparison, a: Program, b: Program) -> dict[str, Any]:
    """Return a comparison as plain values: mm, degrees, lines from 1 (0: none)."""
    said: dict[str, Any] = {"same": found.same, "tolerance": found.tolerance}
    if not found.parted:
        said |= {"deviation": found.deviation, "angle": found.angle}
    else:
        said["parted"] = {"line_a": found.parted[0], "line_b": found.parted[1]}
    lists = {"feeds": found.feeds, "events": found.events, "not_compared": found.places}
    return {
        **{k: {"file": p.name, "dialect": p.dialect.name} for k, p in (("a", a), ("b", b))},
        **said,
        **{"line_a": found.line_a, "line_b": found.line_b, "ends_only": found.ends_only},
        **{"left_to_the_machine": found.spared, "left_by": found.spared_by},
        **{name: [_difference(each) for each in all_] for name, all_ in lists.items()},
    }


def _difference(found: Difference) -> dict[str, Any]:
    return {"what": found.what, "line_a": found.line_a, "line_b": found.line_b}


def _moves(program: Program) -> str:
    count = len(program.path)
    return f"{count} move{'' if count == 1 else 's'}"
