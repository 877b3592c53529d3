"""Grammars, kept compiled: making lark's tables takes a fifth of the start of a short run.

They are kept where Python keeps compiled modules, in `__pycache__` beside the grammar, under a
digest of all they are made from. What is stale, damaged or cannot be written is made anew. They are
kept as plain data (msgpack): reading a pickle would run whatever code somebody has put into it.
"""

from __future__ import annotations

import hashlib
import os
import sys
from contextlib import suppress
from importlib import import_module
from importlib.util import cache_from_source
from pathlib import Path
from pkgutil import get_data
from typing import Any

import lark
import msgspec
from lark.grammar import Rule
from lark.lexer import TerminalDef
from lark.load_grammar import FromPackageLoader

GRAMMARS = "gcxform_grammars"
SUFFIX = ".lark"
LARGEST = 2**64 - 1
OF_MAKING = frozenset({"import_paths"})  # options that reading the tables does not need, nor data


def grammar(package: str, name: str) -> lark.Lark:
    """Return the parser of a grammar in a package, which may import from it and from ours."""
    source = _folder(package) / (name + SUFFIX)
    if not source.is_file():  # in a zip file: there is no place beside it
        return _made(package, name)
    place, digest = Path(cache_from_source(str(source))).with_suffix(".lalr"), _digest(package)
    with suppress(Exception):  # damaged tables can raise anything
        kept = place.read_bytes()
        if kept.startswith(digest):
            return _loaded(kept[len(digest) :])
    made = _made(package, name)
    if not sys.dont_write_bytecode:
        with suppress(OSError):
            _keep(made, digest, place)
    return made


def _folder(package: str) -> Path:
    """Return where a package lies; `importlib.resources` would load what reads zip files for it."""
    return Path(import_module(package).__path__[0])


def _made(package: str, name: str) -> lark.Lark:
    text = get_data(package, name + SUFFIX)
    assert text is not None  # only a loader that can read no data returns that
    loaders = [FromPackageLoader(package, ("",)), FromPackageLoader(GRAMMARS, ("",))]
    return lark.Lark(
        text.decode("utf-8"),
        parser="lalr",
        import_paths=loaders,
        propagate_positions=True,
        maybe_placeholders=False,
    )


def _saved(made: lark.Lark) -> bytes:
    """Return the tables of a parser as plain data: what lark's own `save` would pickle."""
    data, memo = made.memo_serialize([TerminalDef, Rule])
    options = {name: value for name, value in data["options"].items() if name not in OF_MAKING}
    return msgspec.msgpack.encode(_plain({"data": data | {"options": options}, "memo": memo}))


def _plain(value: Any) -> Any:
    """Return tokens as the text they are, and no number that is larger than the largest there is.

    Only the width of terminals without an end is larger, and it has to stay above all others.
    """
    if isinstance(value, dict):
        return {_plain(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if type(value) is int:
        return min(value, LARGEST)
    return str(value) if isinstance(value, str) else value


def _loaded(data: bytes) -> lark.Lark:
    """Return the parser of such tables; lark's `load` takes them also without a pickle."""
    tables: Any = msgspec.msgpack.decode(data)
    return lark.Lark.load(tables)


def _digest(package: str) -> bytes:
    """Return a digest of lark, Python, this file and every grammar that could be imported."""
    made_by = f"{lark.__version__} {sys.version}".encode()
    digest = hashlib.sha256(made_by + Path(__file__).read_bytes())
    for folder in dict.fromkeys([package, GRAMMARS]):
        for path in sorted(_folder(folder).glob(f"*{SUFFIX}")):
            text = path.read_bytes()
            digest.update(f"\n{folder} {path.name} {len(text)}\n".encode() + text)
    return digest.digest()


def _keep(made: lark.Lark, digest: bytes, place: Path) -> None:
    """Write a file at once or not at all: another run may be reading it, or writing it too."""
    import tempfile

    data = _saved(made)
    handle, name = tempfile.mkstemp(dir=place.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(digest + data)
        os.chmod(name, 0o644)
        os.replace(name, place)
    except OSError:
        os.unlink(name)
        raise
