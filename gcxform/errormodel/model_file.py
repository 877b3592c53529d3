"""Files of error models: the native TOML and the door to foreign formats.

Lengths are in mm, angles in rad. What is read is the error, actual minus nominal; a file of
corrections (`values = "correction"`) is negated. Each kind has its reader in a file of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import msgspec

from gcxform.config.schemas import format_schema, headed, of_toml
from gcxform.config.toml_text import Codes, TomlText, convert, did_you_mean, read_toml
from gcxform.diagnostics import Location, UsageError
from gcxform.errormodel.formats import ErrorFormat, check_readable, chosen_format, unsaid
from gcxform.errormodel.functions_file import AxisFunctionsFile, axis_functions
from gcxform.errormodel.grid_file import (
    HeightMapFile,
    LatticeFile,
    SkewFile,
    height_map,
    lattice,
    skew,
)
from gcxform.errormodel.model import ErrorModel, check_contraction
from gcxform.errormodel.pitch_file import PitchFile, pitch
from gcxform.errormodel.sum import Sum, SumFile, checked_sum
from gcxform.errormodel.thermal_file import ThermalScrewFile, thermal_screw
from gcxform.system import inputs
from gcxform.system.limits import how_to_raise, limits

FORMAT = 1
CODES = Codes("GX401", "GX402", "GX403", "GX404", "GX405")
SUFFIX = ".toml"
Formats = Sequence[type[ErrorFormat]]


def load_model(path: Path, formats: Formats = ()) -> ErrorModel:
    """Return the error model of a file: native TOML by its suffix, otherwise a foreign format.

    Raises UsageError, with the place in the file, for all that is wrong with it.
    """
    return _Loading(formats).load(path, ())


class _Loading:
    """Loads one model with all its parts, which are counted: few files can name very many."""

    def __init__(self, formats: Formats) -> None:
        self.formats = formats
        self.files = 0

    def load(self, path: Path, above: tuple[Path, ...]) -> ErrorModel:
        """Return the model of a file which is part of the files above it."""
        self.files += 1
        if path.suffix.lower() == SUFFIX:
            model = self._native(path, above)
        else:
            model = _foreign(path, self.formats)
        check_contraction(model, Location(str(path)))
        return model

    def _native(self, path: Path, above: tuple[Path, ...]) -> ErrorModel:
        document = read_toml(path, CODES)
        check_version(document, "error models")
        kind = document.values.get("kind")
        if kind is None:
            raise document.missing_key(("kind",))
        if kind == Sum.kind:
            return self._sum(document, path, (*above, path.resolve()))
        if not isinstance(kind, str) or kind not in KINDS:
            raise UsageError.one(
                "GX407",
                f"error models of the kind {kind!r} are not known",
                document.where("kind"),
                did_you_mean(str(kind), [*KINDS, Sum.kind]),
            )
        return KINDS[kind](document)

    def _sum(self, document: TomlText, path: Path, above: tuple[Path, ...]) -> Sum:
        """Return the sum of the models of the files that a file names."""
        file = convert(document, SumFile)
        models = []
        for k, name in enumerate(file.models):
            where = document.where("models", k)
            self._check_limits(where, above)
            models.append(self.load(_part(path, name, where, above), above))
        return checked_sum(document, models)

    def _check_limits(self, where: Location, above: tuple[Path, ...]) -> None:
        """Refuse one more part than a model may have, and one in too many others."""
        limit = "parts" if self.files > limits().parts else "nesting"
        if limit == "parts" or len(above) > limits().nesting:
            message = f"the model is made of {self.files} files, and of more"
            raise UsageError.one("GX761", message, where, how_to_raise(limit))


def _part(path: Path, name: str, where: Location, above: tuple[Path, ...]) -> Path:
    """Return the file of a part of a sum. Raises UsageError if there is none."""
    if "\0" in name:
        raise UsageError.one("GX401", f"no file is called {name!r}", where)
    part = inputs.referred(path.parent, name, where)
    if part.resolve() in above:
        raise UsageError.one("GX424", f"the sum {name} is a part of itself", where)
    if not part.exists():
        raise UsageError.one("GX401", f"there is no file {name}", where)
    return part


def _foreign(path: Path, formats: Sequence[type[ErrorFormat]]) -> ErrorModel:
    where = Location(str(path))
    if not path.exists():
        raise UsageError.one("GX401", "the file cannot be read: it does not exist", where)
    if form := chosen_format(path, formats):
        return read_foreign(path, form)
    known = [f"TOML ({SUFFIX})", *(f"{f.name} ({', '.join(f.suffixes)})" for f in formats)]
    raise UsageError.one(
        "GX416",
        f"no format of error models fits this {'directory' if path.is_dir() else 'file'}",
        where,
        f"known: {', '.join(known)}",
    )


def read_foreign(path: Path, form: type[ErrorFormat]) -> ErrorModel:
    """Return the model of a foreign file. Raises UsageError if it needs to be told more."""
    if missing := unsaid(form):
        options = " ".join(f"{name}=..." for name in missing)
        hint = f"gcxform table convert {path.name} model.toml --from '{form.name} {options}'"
        message = f"the format {form.name!r} does not say {' and '.join(missing)}"
        raise UsageError.one("GX480", message, Location(str(path)), hint)
    check_readable(path)
    return form().read(path)


def check_version(document: TomlText, what: str) -> None:
    """Raise UsageError unless the file says that it is of the format which is known."""
    version = document.values.get("format")
    if version is None:
        raise document.missing_key(("format",))
    if version != FORMAT or isinstance(version, bool):
        message = f"format {version!r} of {what} is not known, only format = {FORMAT} is"
        raise UsageError.one("GX406", message, document.where("format"))


def schema() -> dict[str, Any]:
    """Return the JSON Schema of error models: one of their kinds, whose key says which."""
    functions = [AxisFunctionsFile, PitchFile, ThermalScrewFile]
    files = [*functions, LatticeFile, HeightMapFile, SkewFile, SumFile]
    found = msgspec.json.schema_components(files, ref_template="#/$defs/{name}")
    kinds, parts = of_toml(list(found))
    for file in files:
        parts[file.__name__]["properties"]["format"] = format_schema(FORMAT)
    return headed("model", {"type": "object", "anyOf": kinds, "$defs": parts})


KINDS: dict[str, Callable[[TomlText], ErrorModel]] = {
    "axis-functions": axis_functions,
    "lattice": lattice,
    "height-map": height_map,
    "skew": skew,
    "thermal-screw": thermal_screw,
    "pitch": pitch,
}
