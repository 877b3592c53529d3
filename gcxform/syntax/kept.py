"""Grammars, kept compiled: making lark's tables takes a fifth of the start of a short run.

They are kept where Python keeps compiled modules, in `__pycache__` beside the grammar, under a
digest of all they are made from. What is stale, damaged or cannot be written is made anew.
"""

from __future__ import annotations

import hashlib
import io
import os
import sys
import tempfile
from contextlib import suppress
from importlib.resources import files
from importlib.util import cache_from_source
from pathlib import Path

import lark
from lark.load_grammar import FromPackageLoader

GRAMMARS = "gcxform_grammars"
SUFFIX = ".lark"


def grammar(package: str, name: str) -> lark.Lark:
    """Return the parser of a grammar in a package, which may import from it and from ours."""
    source = files(package).joinpath(name + SUFFIX)
    if not isinstance(source, Path):  # in a zip file: there is no place beside it
        return _made(package, name)
    place, digest = Path(cache_from_source(str(source))).with_suffix(".lalr"), _digest(package)
    with suppress(Exception):  # a damaged pickle can raise anything
        kept = place.read_bytes()
        if kept.startswith(digest):
            return lark.Lark.load(io.BytesIO(kept[len(digest) :]))
    made = _made(package, name)
    if not sys.dont_write_bytecode:
        with suppress(OSError):
            _keep(made, digest, place)
    return made


def _made(package: str, name: str) -> lark.Lark:
    loaders = [FromPackageLoader(package, ("",)), FromPackageLoader(GRAMMARS, ("",))]
    return lark.Lark(
        files(package).joinpath(name + SUFFIX).read_text("utf-8"),
        parser="lalr",
        import_paths=loaders,
        propagate_positions=True,
        maybe_placeholders=False,
    )


def _digest(package: str) -> bytes:
    """Return a digest of lark, Python, this file and every grammar that could be imported."""
    made_by = f"{lark.__version__} {sys.version}".encode()
    digest = hashlib.sha256(made_by + Path(__file__).read_bytes())
    for folder in dict.fromkeys([package, GRAMMARS]):
        for path in sorted(files(folder).iterdir(), key=lambda path: path.name):
            if path.name.endswith(SUFFIX):
                text = path.read_bytes()
                digest.update(f"\n{folder} {path.name} {len(text)}\n".encode() + text)
    return digest.digest()


def _keep(made: lark.Lark, digest: bytes, place: Path) -> None:
    """Write a file at once or not at all: another run may be reading it, or writing it too."""
    data = io.BytesIO()
    made.save(data)
    handle, name = tempfile.mkstemp(dir=place.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(digest + data.getvalue())
        os.chmod(name, 0o644)
        os.replace(name, place)
    except OSError:
        os.unlink(name)
        raise
