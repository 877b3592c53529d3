"""A start loads what the job uses: modules by name, which no clock has to be asked for."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from gcxform.plugin.registry import default_registry

PROGRAM = "G21 G90 G17 G54\nG0 X0. Y0. Z5.\nG91\nG1 Z-6. F500.\nG90\nX10.\nM2\n"
SAID = """
import sys
from gcxform.cli import main
sys.argv = ["gcxform", *sys.argv[1:]]
try:
    main()
finally:
    print(*sys.modules, file=sys.stderr)
"""
NEVER = {  # of what no small job needs
    *("asyncio", "concurrent", "email", "importlib.metadata", "matplotlib", "multiprocessing"),
    *("numpy.ma", "numpy.polynomial", "numpy.random", "pandas", "scipy", "subprocess"),
    *("tomlkit", "xml"),
}
NOT_FOR_WORDS = NEVER | {  # said without a program: help, versions, what a shell completes
    *("gcxform_plugins", "gcxform.catalogue", "gcxform.contract", "gcxform.dialect"),
    *("hashlib", "lark", "msgspec", "numpy", "pluggy"),
}
NOT_FOR_PLAIN = NEVER | {  # programs: no model, no machine file, no calls, no other language
    *("gcxform.errormodel.model", "gcxform.machine.file", "gcxform.notebook", "html", "tomllib"),
    *("gcxform.flow.execution", "gcxform.flow.run_state", "gcxform.flow.walk"),
    *("gcxform.emit.folding", "gcxform.proof.structure", "gcxform.pipeline.subprogram"),
    *("gcxform.emit.respelling", "gcxform.proof.respelled"),
    *("gcxform.deviations.matching", "gcxform.calibrate", "gcxform.simulate", "gcxform.view"),
}


def loaded(folder: Path, *words: str, **environment: str) -> set[str]:
    """Return the modules that a command line has loaded, and the packages that they are in."""
    (folder / "part.nc").write_text(PROGRAM)
    done = subprocess.run(
        [sys.executable, "-c", SAID, *words],
        capture_output=True,
        text=True,
        cwd=folder,
        env={**os.environ, **environment},
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return set(done.stderr.rpartition("\n")[0].rpartition("\n")[2].split())


COMPLETED = {
    "_GCXFORM_COMPLETE": "bash_complete",
    "COMP_WORDS": "gcxform ru",
    "COMP_CWORD": "1",
}


@pytest.mark.parametrize(
    ("words", "environment"),
    [
        (("--help",), {}),
        (("--version",), {}),
        (("completion", "zsh"), {}),
        ((), COMPLETED),
    ],
)
def test_words_about_the_command(
    words: tuple[str, ...], environment: dict[str, str], tmp_path: Path
) -> None:
    assert loaded(tmp_path, *words, **environment) & NOT_FOR_WORDS == set()


CHAIN = ("-f", "linuxcnc", "-x", "absolute", "part.nc")


@pytest.mark.parametrize(
    "words",
    [
        ("run", "-q", *CHAIN, "-o", "out.nc", "--certificate", "out.json"),
        ("post", *CHAIN),
        ("check", *CHAIN),
        ("info", "-f", "linuxcnc", "part.nc"),
    ],
    ids=lambda words: words[0],
)
def test_a_small_job(words: tuple[str, ...], tmp_path: Path) -> None:
    found = loaded(tmp_path, *words)
    assert found & NOT_FOR_PLAIN == set()
    plugins = {each for each in found if each.startswith("gcxform_plugins.")}
    kinds = {"gcxform_plugins.dialects", "gcxform_plugins.passes"}
    used = {"gcxform_plugins.dialects.linuxcnc", "gcxform_plugins.passes.absolute"}
    assert plugins - kinds <= used
    assert "gcxform_plugins.dialects.linuxcnc" in plugins


def test_the_schema_of_machines_has_the_settings_of_every_dialect() -> None:
    command = [sys.executable, "-m", "gcxform.cli", "schema", "machine"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    settings = {
        each.name for kind in default_registry().dialects.values() for each in kind.settings
    }
    assert settings
    assert [name for name in sorted(settings) if f'"{name}"' not in printed] == []
