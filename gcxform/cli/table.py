"""`gcxform table`: error tables from one format to another, each written one read again."""

from __future__ import annotations

import shlex
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import click
import numpy as np

from gcxform.cli import VERBS
from gcxform.cli.common.answer import answer
from gcxform.cli.common.failures import say
from gcxform.cli.common.options import one_of
from gcxform.cli.common.outputs import STDOUT, check_places, destination
from gcxform.config.toml_text import did_you_mean
from gcxform.contract.options import Argument, build, describe
from gcxform.diagnostics import Location, UsageError, VerificationError
from gcxform.errormodel import converting
from gcxform.errormodel.formats import ErrorFormat, chosen_format
from gcxform.errormodel.mean import Mean
from gcxform.errormodel.model import AXES, ErrorModel, check_contraction
from gcxform.errormodel.model_file import SUFFIX, load_model
from gcxform.errormodel.model_text import to_toml
from gcxform.errormodel.pitch import PitchTables
from gcxform.plugin.registry import default_registry
from gcxform.system.arrays import Floats

NATIVE = "toml"
TOOL = 100.0  # mm: by so much another tool differs, where angular errors are compared
SAME = 1e-6  # mm: what the rounding of written numbers may change
UM = 1e3
FORMAT = "NAME OPTION=VALUE ..."


@click.group("table", help=VERBS["table"], short_help=VERBS["table"])
def command() -> None:
    """Convert and show error tables."""


@command.command("convert", short_help="Write the errors of a file in another format.")
@click.argument("source", metavar="A")
@click.argument("target", metavar="B")
@click.option("-f", "--from", "given", metavar=f"'{FORMAT}'", help="Format of A.")
@click.option("-t", "--to", "wanted", metavar=f"'{FORMAT}'", help="Format of B.")
@click.option("--axis", type=click.Choice(list(AXES)), help="Axis of a file with one axis.")
@click.option(
    "--kind", type=click.Choice(list(converting.KINDS)), help="Fit a model of this kind first."
)
@one_of(
    "--backlash",
    words=["keep", "mean"],
    help="Of a table with backlash: keep it, or take the mean of both directions.",
)
@click.option("--order", default=AXES, show_default=True, help="Axes from workpiece to tool.")
def convert(
    source: str,
    target: str,
    given: str | None,
    wanted: str | None,
    axis: str | None,
    kind: str | None,
    backlash: str,
    order: str,
) -> None:
    """Write the errors in A to B.

    Formats are found by the files and their names; what a file does not say of itself is said with
    the format: --from 'linuxcnc-comp axis=X type=1 units=mm'. `gcxform list formats` shows all.
    """
    check_places({"B": target}, [source])
    reading, writing = _reading(source, given, axis), _writing(target, wanted, axis)
    model = _read(Path(source), reading)
    if sorted(order) != sorted(AXES):
        raise UsageError.one("GX421", f"order = {order!r} is not X, Y and Z, each once")
    if backlash == "mean" and model.backlash.any():
        kind = kind or PitchTables.kind
        model = Mean(model)
    if kind:
        fit = converting.KINDS[kind](model, order)
        bent = " and half way between them" if model.curvature().diagonal().any() else ""
        say(
            f"{kind}: leaves {fit.rms * UM:.3g} um rms, {fit.largest * UM:.3g} um at most, "
            f"over all nodes{bent}"
        )
        model = fit.model
    files = {"": _native_text(model)} if writing is None else dict(writing.write(model))
    _prove(model, files, writing)
    _write(target, files)
    for note in _notes(reading, writing):
        say(note)


@command.command("show", short_help="Say what an error table holds.")
@click.argument("source", metavar="A")
@click.option("-f", "--from", "given", metavar=f"'{FORMAT}'", help="Format of A.")
@click.option("--axis", type=click.Choice(list(AXES)), help="Axis of a file with one axis.")
def show(source: str, given: str | None, axis: str | None) -> None:
    """Print kind, ranges and largest errors of a table."""
    model = _read(Path(source), _reading(source, given, axis))
    axes = {letter: _axis(model, k) for k, letter in enumerate(AXES)}
    known = {letter: each for letter, each in axes.items() if each}
    values: dict[str, Any] = {"kind": model.kind, "axes": known}
    values |= {"largest_mm": model.largest(), "steepest_um_per_mm": model.lipschitz() * UM}
    lines = [f"kind      {model.kind}"]
    for letter, each in known.items():
        low, high = each["range_mm"]
        back = ", with backlash" if each["backlash"] else ""
        lines.append(
            f"{letter}         {each['positions']} positions, {low:g} to {high:g} mm{back}"
        )
    lines.append(f"largest   {model.largest() * UM:.4g} um")
    lines.append(f"steepest  {model.lipschitz() * UM:.4g} um/mm")
    if model.needs_tool and model.tool is not None:
        values["tool_mm"] = [float(part) for part in model.tool]
        lines.append(f"tool      {', '.join(f'{part:g}' for part in model.tool)} mm")
    answer(values, lines)


def _axis(model: ErrorModel, k: int) -> dict[str, Any]:
    """Return where a table knows the errors of an axis; nothing if everywhere."""
    low, high = model.range_of(k)
    if not np.isfinite([low, high]).all():
        return {}
    back = bool(model.backlash[k])
    return {"positions": len(model.nodes[k]), "range_mm": [float(low), float(high)]} | {
        "backlash": back
    }


# --- formats ---


def _reading(source: str, given: str | None, axis: str | None) -> ErrorFormat | None:
    """Return the format of a file, None for the native one. Raises UsageError."""
    path = Path(source)
    if given is not None:
        return _format(given, "--from", axis)
    if path.suffix.lower() == SUFFIX or not path.exists():
        return None
    found = chosen_format(path, default_registry().formats.values())
    return None if found is None else _format(found.name, "--from", axis)


def _writing(target: str, wanted: str | None, axis: str | None) -> ErrorFormat | None:
    """Return the format to write, None for the native one. Raises UsageError."""
    if wanted is not None:
        return _format(wanted, "--to", axis)
    suffix = Path(target).suffix.lower()
    if suffix == SUFFIX:
        return None
    fitting = [f.name for f in default_registry().formats.values() if suffix in f.suffixes]
    if len(fitting) != 1:
        known = ", ".join(fitting or default_registry().formats)
        message = f"which format is {target} to be in?"
        raise UsageError.one("GX730", message, Location("--to"), f"known: {known}")
    return _format(fitting[0], "--to", axis)


def _format(text: str, option: str, axis: str | None) -> ErrorFormat | None:
    """Return a format as a command line says it: its name and its options."""
    try:
        name, *pairs = shlex.split(text)
    except ValueError as error:
        raise UsageError.one("GX712", f"{text!r}: {error}", Location(option)) from None
    formats = default_registry().formats
    if name == NATIVE and not pairs:
        return None
    if name not in formats:
        hint = did_you_mean(name, formats)
        raise UsageError.one("GX730", f"there is no format {name!r}", Location(option), hint)
    form, raw = formats[name], dict(_pair(pair, option) for pair in pairs)
    if not hasattr(form, "__dataclass_fields__"):
        if raw:
            message = f"the format {name!r} has no options, and {next(iter(raw))!r} is given"
            raise UsageError.one("GX701", message, Location(option))
        return form()
    if axis and "axis" in (doc.name for doc in describe(form)):
        raw.setdefault("axis", Argument(axis))
    place = Location(option)
    return build(form, raw, Path.cwd(), formats.values(), lambda key: place, f"the format {name!r}")


def _pair(text: str, option: str) -> tuple[str, Argument]:
    key, equals, value = text.partition("=")
    if not equals or not key:
        hint = "options of a format are key=value, separated by blanks"
        raise UsageError.one("GX712", f"{text!r} is not an option", Location(option), hint)
    return key, Argument(value)


# --- models ---


def _read(path: Path, form: ErrorFormat | None) -> ErrorModel:
    if form is None:
        return load_model(path, tuple(default_registry().formats.values()))
    if not path.exists():
        raise UsageError.one("GX401", "the file does not exist", Location(str(path)))
    model = form.read(path)
    check_contraction(model, Location(str(path)))
    return model


def _native_text(model: ErrorModel) -> str:
    try:
        return to_toml(model)
    except TypeError as error:
        hint = f"--kind with one of {', '.join(converting.KINDS)} makes one model of it"
        raise UsageError.one("GX481", str(error), hint=hint) from None


def _prove(model: ErrorModel, files: Mapping[str, str], form: ErrorFormat | None) -> None:
    """Read what is to be written again; raise VerificationError unless it is the same model."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / (f"model{SUFFIX}" if form is None else "table")
        for name, text in files.items():
            file = place / name if name else place
            file.parent.mkdir(exist_ok=True)
            file.write_text(text, encoding="utf-8", newline="")
        again = load_model(place) if form is None else form.read(place)
    apart = max(float(converting.difference(model, again, *how).max()) for how in _ways(model))
    if not apart <= SAME:
        message = f"the table reads back as errors that differ by {apart * UM:.3g} um"
        hint = "nothing was written; this is a bug of the format: report it to its author"
        raise VerificationError.one("GX605", message, hint=hint)


def _ways(model: ErrorModel) -> Iterator[tuple[float, Floats | None]]:
    """Yield the directions of travel and the tools with which two models are compared."""
    for sense in (-1.0, 0.0, 1.0):
        yield sense, None
    if model.needs_tool:
        yield from ((0.0, away) for away in TOOL * np.eye(3))


def _write(target: str, files: Mapping[str, str]) -> None:
    """Write the files of a table: one, or several into a directory."""
    if target != STDOUT and "" not in files:
        Path(target).mkdir(exist_ok=True)
    for name, text in files.items():
        place = str(Path(target) / name) if name and target != STDOUT else target
        with destination(place) as put:
            put(text.encode())


def _notes(reading: ErrorFormat | None, writing: ErrorFormat | None) -> Iterator[str]:
    """Yield what to know where a control holds the table itself."""
    if reading is not None and reading.control:
        yield (
            f"the control may compensate with the {reading.name} table already: then programs must "
            "not be compensated as well"
        )
    if writing is not None and writing.control:
        yield (
            f"the control can hold this table itself, which beats rewriting programs: "
            f"{writing.control}"
        )
