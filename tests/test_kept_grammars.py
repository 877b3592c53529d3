"""Grammars are kept compiled, and made anew where what is kept does not fit."""

from __future__ import annotations

import pickle
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import lark
import pytest

from gcxform.syntax import grammar_cache as kept
from gcxform.syntax.grammar import Grammar

OURS = Path(__file__).parents[1] / "grammars" / "gcxform_grammars"
LINES = ["N10 G1 X-1.5 Y[#1 + 2] F100 (feed)", "/G0 X#<_x>", "%", "G1 X1 ?", ""]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Return the folder of a package of its own, with a copy of our grammars."""
    package = tmp_path / "kept_here"
    shutil.copytree(OURS, package, ignore=shutil.ignore_patterns("__pycache__"))
    (package / "__pycache__").mkdir()
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(sys, "pycache_prefix", None)
    yield package
    sys.modules.pop("kept_here", None)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return a list of the grammars that are made, and not read."""
    names: list[str] = []
    make = kept._made

    def counted(package: str, name: str) -> lark.Lark:
        names.append(name)
        return make(package, name)

    monkeypatch.setattr(kept, "_made", counted)
    return names


def files(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.glob("__pycache__/*.lalr"))


def test_a_kept_grammar_reads_as_a_made_one(folder: Path, made: list[str]) -> None:
    grammars = [Grammar("kept_here", "linuxcnc") for _ in range(2)]
    assert made == ["linuxcnc"]
    for line in LINES:
        first, second = (grammar.parse(line) for grammar in grammars)
        assert first == second


@pytest.mark.parametrize("changed", ["linuxcnc.lark", "iso.lark"])
def test_a_changed_grammar_is_made_anew(folder: Path, made: list[str], changed: str) -> None:
    """Also where the change is in a grammar that it imports."""
    kept.grammar("kept_here", "linuxcnc")
    with (folder / changed).open("a") as text:
        text.write("\n// changed\n")
    kept.grammar("kept_here", "linuxcnc")
    kept.grammar("kept_here", "linuxcnc")
    assert made == ["linuxcnc", "linuxcnc"]


def test_another_lark_makes_its_own(
    folder: Path, made: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    kept.grammar("kept_here", "grbl")
    monkeypatch.setattr(lark, "__version__", "99.0")
    kept.grammar("kept_here", "grbl")
    assert made == ["grbl", "grbl"]


@pytest.mark.parametrize("length", [0, 10, 32, 33, 1000, -1])
def test_a_damaged_file_is_made_anew(folder: Path, made: list[str], length: int) -> None:
    kept.grammar("kept_here", "fanuc")
    (place,) = folder.glob("__pycache__/*.lalr")
    place.write_bytes(place.read_bytes()[:length])
    assert Grammar("kept_here", "fanuc").parse("G1 X1").error is None
    kept.grammar("kept_here", "fanuc")
    assert made == ["fanuc", "fanuc"]


def test_nothing_is_kept_where_nothing_can_be_written(
    folder: Path, monkeypatch: pytest.MonkeyPatch, made: list[str]
) -> None:
    def refuse(*_: object, **__: object) -> tuple[int, str]:
        raise PermissionError(13, "read-only")

    monkeypatch.setattr("tempfile.mkstemp", refuse)
    assert Grammar("kept_here", "grbl").parse("G1 X1").error is None
    assert files(folder) == []


def test_a_file_that_cannot_take_its_place_leaves_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch, made: list[str]
) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(13, "in use")

    monkeypatch.setattr(kept.os, "replace", refuse)
    kept.grammar("kept_here", "grbl")
    assert [path.name for path in folder.glob("__pycache__/*") if path.suffix != ".pyc"] == []


def test_nothing_is_kept_where_python_keeps_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    kept.grammar("kept_here", "grbl")
    assert files(folder) == []
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    kept.grammar("kept_here", "grbl")
    assert len(files(folder)) == 1


class Planted:
    """What, once it is unpickled, has made a file."""

    def __init__(self, place: Path) -> None:
        self.place = place

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        return Path.touch, (self.place,)


def test_what_somebody_has_planted_is_not_executed(folder: Path, made: list[str]) -> None:
    """A pickle under the right digest, as whoever reads this file can make it."""
    kept.grammar("kept_here", "grbl")
    (place,) = folder.glob("__pycache__/*.lalr")
    digest = kept._digest("kept_here")
    assert place.read_bytes().startswith(digest)
    place.write_bytes(digest + pickle.dumps(Planted(folder / "executed")))
    assert Grammar("kept_here", "grbl").parse("G1 X1").error is None
    assert not (folder / "executed").exists()
    assert made == ["grbl", "grbl"]
    pickle.loads(pickle.dumps(Planted(folder / "executed")))
    assert (folder / "executed").exists()


@pytest.mark.parametrize(
    "name", sorted(path.stem for path in OURS.glob("*.lark") if "start" in path.read_text())
)
def test_every_grammar_is_kept_whole(folder: Path, made: list[str], name: str) -> None:
    """Also where terminals have no end: their width is a number beyond 64 bits."""
    first, second = (kept.grammar("kept_here", name) for _ in range(2))
    assert made == [name]
    for line in LINES:
        assert parsed(first, line) == parsed(second, line)
    assert [t.name for t in first.terminals] == [t.name for t in second.terminals]


def parsed(grammar: lark.Lark, line: str) -> object:
    try:
        return grammar.parse(line)
    except lark.exceptions.UnexpectedInput as error:
        return error.pos_in_stream
