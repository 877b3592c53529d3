"""TOML files of ours in an editor: what their loaders say, as they are saved."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from gcxform.cli.plant.tasks import load_manifest
from gcxform.cli.program.named_schemas import kind_of
from gcxform.diagnostics import Diagnostic, GcxformError
from gcxform.errormodel.model_file import load_model
from gcxform.machine.file import load_machine
from gcxform.pipeline.file import load
from gcxform.plugin.registry import default_registry

LOADERS: Final[dict[str, Callable[[Path], Any]]] = {
    "pipeline": lambda path: load(path, default_registry()),
    "machine": lambda path: load_machine(path, default_registry().machines),
    "model": lambda path: load_model(path, tuple(default_registry().formats.values())),
    "manifest": load_manifest,
}


def findings(path: str) -> list[Diagnostic]:
    """Return what is wrong with a file; nothing of those that are not ours."""
    try:
        text = Path(path).read_text("utf-8")
        values = tomllib.loads(text)
    except (OSError, ValueError, RecursionError):
        values = {}
    if "format" not in values:
        return []
    try:
        LOADERS[kind_of(values)](Path(path))
    except GcxformError as error:
        return list(error.diagnostics)
    return []
