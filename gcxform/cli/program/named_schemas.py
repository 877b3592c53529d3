"""Schemas as files beside those that a user writes, and the comment that names one.

    #:schema .gcxform/machine.schema.json

Editors that check TOML (taplo, and what stands on it) look for this comment at the head of a file.
It holds a path relative to the file, so it works without a network; for our readers it is a comment
like any other.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final, Literal, get_args

from gcxform.cli.common.discovery import upwards
from gcxform.cli.common.outputs import destination
from gcxform.cli.plant import tasks
from gcxform.config.toml_text import Codes, read_toml
from gcxform.pipeline import schema as files
from gcxform.pipeline.file import KEYS
from gcxform.system.inputs import visit

FOLDER: Final = ".gcxform"
"""The folder in which new files look for schemas, beside them or above."""
MANIFEST: Final = "manifest"
Kind = files.Kind | Literal["manifest"]
KINDS: Final[tuple[Kind, ...]] = (*get_args(files.Kind), MANIFEST)
CODES: Final = Codes("GX709", "GX710", "GX701", "GX705", "GX702")
_COMMENT = re.compile(r"\A#:schema [^\n]*\n")


def schema(kind: Kind) -> dict[str, Any]:
    """Return the JSON Schema of a kind of files."""
    return tasks.schema() if kind == "manifest" else files.schema(kind)


def file_of(kind: Kind, folder: Path) -> Path:
    """Return the file of a schema."""
    return folder / f"{kind}.schema.json"


def write_schemas(folder: Path, names: Iterable[str]) -> list[Path]:
    """Write the schemas into a folder, and name each in the files of its kind; return all files.

    Raises UsageError for a file that is no TOML, before anything is written.
    """
    with visit():  # what is read here is written again
        named = {Path(name): _with_comment(Path(name), folder) for name in names}
    folder.mkdir(parents=True, exist_ok=True)
    written = {file_of(kind, folder): _text(kind) for kind in KINDS} | named
    for path, text in written.items():
        with destination(str(path)) as put:
            put(text.encode())
    return list(written)


def _text(kind: Kind) -> str:
    return json.dumps(schema(kind), indent=2, ensure_ascii=False) + "\n"


def _with_comment(path: Path, folder: Path) -> str:
    """Return the text of a file that names its schema in a folder."""
    found = read_toml(path, CODES)
    comment = _comment(file_of(kind_of(found.values), folder), path)
    ends = "\r\n" if "\r\n" in found.text else "\n"
    mark = "\ufeff" if path.read_bytes().startswith("\ufeff".encode()) else ""
    return f"{mark}{comment}{ends}{_COMMENT.sub('', found.text)}"


def _comment(target: Path, path: Path) -> str:
    place = os.path.relpath(target.absolute(), path.absolute().parent)
    return f"#:schema {Path(place).as_posix()}"


def kind_of(values: dict[str, Any]) -> Kind:
    """Return which kind of files one is, by its keys: each has some that no other has."""
    if "kind" in values:
        return "model"
    if "batch" in values:
        return "manifest"
    pipeline = values.keys() & {*KEYS} - {"format"}
    return "pipeline" if pipeline and values.keys() <= {*KEYS} else "machine"


def comment_for(kind: Kind, path: Path) -> list[str]:
    """Return the line that names the schema of a new file, if its folder or one above has it."""
    for folder in upwards(path.absolute().parent):
        target = file_of(kind, folder / FOLDER)
        if target.is_file():
            return [_comment(target, path)]
    return []
