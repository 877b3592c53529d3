"""A post processor of FreeCAD that runs another one and then gcxform: gcxform_post.py.

`gcxform hosts freecad` prints this file with its own place and a pipeline in it. FreeCAD 0.20 and
1.0 call `export`, the latter with the name `-` once for each file that it writes itself
(`WrapperPost` in `Path/Post/Processor.py`). Its Python need not have gcxform, which is started as a
program of its own. A program that is refused is not written: its reason is what FreeCAD shows as
the error.
"""

from __future__ import annotations

import importlib.util
import os
import shlex
import subprocess
import tempfile
from typing import Any

GCXFORM = ["gcxform"]
PIPELINE = ""
BASE = "linuxcnc"

TOOLTIP = "Runs another post processor, and gcxform on what it writes."
TOOLTIP_ARGS = """--base NAME      the other post processor; without it: linuxcnc
--pipeline FILE  another pipeline file than the one that was installed
All other words are those of the other post processor."""


def export(objectslist: Any, filename: str, argstring: str) -> str:
    """Post objects of a job; write the program, unless the name is -, and return it."""
    base, pipeline, rest = _asked(shlex.split(argstring or ""))
    name = "program.nc" if filename == "-" else os.path.basename(filename)
    done = _transformed(_posted(base, objectslist, rest, name), pipeline)
    if filename != "-":
        with open(filename, "wb") as stream:
            stream.write(done)
    return done.decode("utf-8", "surrogateescape")


def _asked(words: list[str]) -> tuple[str, str, list[str]]:
    """Return the other post, the pipeline and the words that are left."""
    said = {"--base": BASE, "--pipeline": PIPELINE}
    rest: list[str] = []
    while words:
        word = words.pop(0)
        name, equals, value = word.partition("=")
        if name in said:
            said[name] = value if equals else words.pop(0)
        else:
            rest.append(word)
    return said["--base"], said["--pipeline"], rest


def _posted(base: str, objectslist: Any, words: list[str], name: str) -> bytes:
    """Return what another post writes: most write a file themselves, some only return a text.

    The file has the name that was asked for: fanuc writes it into the program.
    """
    if "--no-show-editor" not in words:
        words = [*words, "--no-show-editor"]
    with tempfile.TemporaryDirectory() as folder:
        place = os.path.join(folder, name)
        text = _module(base).export(objectslist, place, shlex.join(words))
        if os.path.exists(place):
            with open(place, "rb") as stream:
                return stream.read()
    if not isinstance(text, str) or not text.strip():
        raise RuntimeError(f"the post processor {base} has written nothing")
    text = text.removeprefix("\n\n")  # FreeCAD's mark that line ends are to stay as they are
    return text.encode("utf-8", "surrogateescape")


def _module(base: str) -> Any:
    """Return the module of another post, from where FreeCAD looks for them.

    A post that is a class in later versions posts whole jobs and has no `export`; the script that
    it was before stands beside it as `NAME_legacy_post.py`.
    """
    without = ""
    for name in (base, f"{base}_legacy"):
        for folder in _folders():
            place = os.path.join(folder, f"{name}_post.py")
            if name != "gcxform" and os.path.exists(place):
                module = _loaded(f"{name}_post", place)
                if hasattr(module, "export"):
                    return module
                without = f": {place} has no function export"
    raise RuntimeError(f"FreeCAD has no post processor {base} to be a base{without}")


def _loaded(name: str, place: str) -> Any:
    spec = importlib.util.spec_from_file_location(name, place)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _folders() -> list[str]:
    try:
        from Path import Preferences  # FreeCAD 0.21 and later
    except ImportError:
        from PathScripts import PathPreferences as Preferences
    return list(Preferences.searchPathsPost())


def _transformed(program: bytes, pipeline: str) -> bytes:
    """Return a program as gcxform writes it. Raises RuntimeError with its reason."""
    own = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    words = [*GCXFORM, "run", "-q", "-p", pipeline, "-"]
    done = subprocess.run(words, input=program, capture_output=True, env=own, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.decode("utf-8", "replace"))
    return done.stdout
