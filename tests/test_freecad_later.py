"""The post for FreeCAD in the hands of FreeCAD 1.0 and later, which are not here.

What calls it is a stand-in by their source (`Path/Post/Processor.py`, `Path/Post/Command.py` of
FreeCAD): a post without a class of its name is a script, whose `export` is called with the objects
of each file, the name `-` and the words of the job, and whose text FreeCAD writes.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest
from cli_kit import ABSOLUTE, PART, PIPELINE, call

SCRIPT = """
def export(objects, filename, words):
    text = "".join(objects)
    if filename != "-" and WRITES:
        with open(filename, "w", newline="") as stream:
            stream.write(text)
    return MARK + text
"""
CLASS = "class {}:\n    def __init__(self, job): self.job = job\n"
UNIX = PART.replace(b"\r\n", b"\n")
WANTED = ABSOLUTE.replace(b"\r\n", b"\n")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of macros, with our post, in a FreeCAD that is only its folders."""
    (tmp_path / "job.toml").write_text(PIPELINE)
    said = call("hosts", "freecad", "-p", str(tmp_path / "job.toml"))
    assert said.exit_code == 0, said.output
    (tmp_path / "gcxform_post.py").write_text(said.stdout)
    path = ModuleType("Path")
    path.Preferences = SimpleNamespace(searchPathsPost=lambda: [str(tmp_path)])  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "Path", path)
    return tmp_path


def posted(folder: Path, name: str, sections: list[tuple[str, list[str]]], words: str) -> None:
    """Post as FreeCAD 1.0 does: a file for each section, as it writes it."""
    place = folder / f"{name}_post.py"
    spec = importlib.util.spec_from_file_location(f"{name}_post", place)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert not hasattr(module, name.title())  # or FreeCAD would take that, and no script
    for part, objects in sections:
        text = module.export(objects, "-", words)
        kept = None
        if text[:2] == "\n\n":
            kept, text = "", text[2:]
        elif "\r" in text:
            kept = ""
        with (folder / f"{part}.nc").open("w", encoding="utf-8", newline=kept) as stream:
            stream.write(text)


@pytest.mark.parametrize(
    ("writes", "mark", "text"), [(True, "", PART), (False, "", PART), (False, "\n\n", UNIX)]
)
def test_each_file_of_a_job_is_transformed(
    writes: bool, mark: str, text: bytes, folder: Path
) -> None:
    """A job that is split by tools or offsets becomes several files, each a program."""
    script = SCRIPT.replace("WRITES", str(writes)).replace("MARK", repr(mark))
    (folder / "mine_post.py").write_text(script)
    sections = [("one", [text.decode()]), ("two", [text.decode().replace("X10", "X20")])]
    posted(folder, "gcxform", sections, "--base mine --other words")
    wanted = ABSOLUTE if text == PART else WANTED
    assert (folder / "one.nc").read_bytes() == wanted
    assert (folder / "two.nc").read_bytes() == wanted.replace(b"X10.", b"X20.")


def test_a_post_that_is_a_class_gives_way_to_the_script_it_was(folder: Path) -> None:
    """Since FreeCAD 1.1 `grbl_post.py` is a class, and `grbl_legacy_post.py` the script."""
    (folder / "grbl_post.py").write_text(CLASS.format("Grbl"))
    sections = [("one", [UNIX.decode()])]
    with pytest.raises(RuntimeError, match="no function export"):
        posted(folder, "gcxform", sections, "--base grbl")
    script = SCRIPT.replace("WRITES", "True").replace("MARK", "''")
    (folder / "grbl_legacy_post.py").write_text(script)
    posted(folder, "gcxform", sections, "--base grbl")
    assert (folder / "one.nc").read_bytes() == WANTED


def test_what_is_refused_is_not_written(folder: Path) -> None:
    script = SCRIPT.replace("WRITES", "True").replace("MARK", "''")
    (folder / "mine_post.py").write_text(script)
    (folder / "one.nc").write_bytes(b"before")
    with pytest.raises(RuntimeError, match="GX202"):
        posted(folder, "gcxform", [("one", ["G1 G2 X1 F100\n"])], "--base mine")
    with pytest.raises(RuntimeError, match="no post processor gcxform"):
        posted(folder, "gcxform", [("one", ["M2\n"])], "--base gcxform")
    assert (folder / "one.nc").read_bytes() == b"before"
