"""A distribution of somebody else, built and installed: its dialect, pass and control, by name."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PLUGIN = Path(__file__).parent / "plugin_dist"
MODULE = PLUGIN / "src" / "gcxform_acme" / "__init__.py"
MOST_LINES = 19  # of a dialect and of a pass: under 20

PIPELINE = """
format = 1
[input]
dialect = "linuxcnc"
[[pass]]
use = "shift"
by = ["10 mm", 0.0, -1.0]
[[pass]]
use = "plane"
chord-error = "0.5 mm"
[output]
dialect = "acme9000"
"""
PROGRAM = """\
G21 G90 G17 G94
G0 X0 Y0 Z10
G3 X10 Y10 I0 J10 F100
G18 G3 X20 Z0 K-10
M2
"""
EXPECTED = """\
G21 G90 G17 G94
G0 X10.0000 Y0.0000 Z9.0000
G3 X20.0000 Y10.0000 I0.0000 J10.0000 F100
G18 G1 X25.0000 Z7.6603
G1 X28.6603 Z4.0000
G1 X30.0000 Z-1.0000
M2
"""


pytestmark = pytest.mark.xdist_group("plugin")  # it is built once


def install(source: Path, folder: Path) -> Path:
    """Build a distribution and install it into a folder of its own, without any network."""
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index"]
    command += ["--no-build-isolation", "--disable-pip-version-check", "--root-user-action=ignore"]
    subprocess.run([*command, "--target", str(folder), str(source)], check=True)
    return folder


def copied(folder: Path, changes: dict[str, str]) -> Path:
    """Return a copy of the plugin in which words of all files are changed."""
    shutil.copytree(PLUGIN, folder, ignore=shutil.ignore_patterns("__pycache__", "dist"))
    for path in [folder / "pyproject.toml", folder / "src" / "gcxform_acme" / "__init__.py"]:
        text = path.read_text()
        for old, new in changes.items():
            text = text.replace(old, new)
        path.write_text(text)
    return folder


@pytest.fixture(scope="session")
def acme(tmp_path_factory) -> Path:
    base = tmp_path_factory.mktemp("acme")
    return install(copied(base / "source", {}), base / "installed")


def python(*arguments: object, paths: tuple[Path, ...], folder: Path | None = None):
    """Run Python with distributions that are installed in folders."""
    places = os.pathsep.join(map(str, paths))
    environment = {**os.environ, "PYTHONPATH": places, "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, env=environment, cwd=folder)


def gcxform(*arguments: object, paths: tuple[Path, ...], folder: Path | None = None):
    return python("-m", "gcxform.cli", *arguments, paths=paths, folder=folder)


def test_dialect_and_pass_by_name(acme, tmp_path):
    (tmp_path / "acme.toml").write_text(PIPELINE)
    (tmp_path / "part.nc").write_text(PROGRAM)
    done = gcxform("run", "-p", "acme.toml", "part.nc", paths=(acme,), folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout == EXPECTED


def test_they_are_listed_with_their_distribution(acme):
    for kind, name in (("dialects", "acme9000"), ("passes", "shift"), ("controls", "acme")):
        listed = gcxform("list", kind, paths=(acme,))
        assert listed.returncode == 0, listed.stderr
        line = next(line for line in listed.stdout.splitlines() if line.startswith(name))
        assert "gcxform-acme 1.0" in line


TABLE = "tool-table = 'acme.tools'\ntool-table-units = 'in'\ntool-table-control = 'acme'\n"


def machine(*words, acme, folder):
    return gcxform("machine", *words, paths=(acme,), folder=folder)


def test_the_files_of_its_control(acme, tmp_path):
    (tmp_path / "pivot.txt").write_text("PIVOT 250.5\n")
    helped = machine("import", "acme", "--help", acme=acme, folder=tmp_path)
    assert "Take over the pivot of a swivel head B" in helped.stdout
    assert "--turns [left|right]  Hand of the head, from its plate.  [required]" in helped.stdout
    words = ("import", "acme", "--turns", "left", "-o", "m.toml", "pivot.txt")
    done = machine(*words, acme=acme, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    written = (tmp_path / "m.toml").read_text()
    assert "point = [0.0, 0.0, 250.5]\nsign = -1\n" in written
    (tmp_path / "m.toml").write_text(written.replace("format = 1\n", f"format = 1\n{TABLE}"))
    (tmp_path / "acme.tools").write_text("; number and length\n7 10.0\n")
    done = machine("jog", "--tool", "7", "m.toml", acme=acme, folder=tmp_path)
    assert done.stdout.startswith("acme\nat X0 Y0 Z0 B0 the tip is on the workpiece at\n  X0.000 ")
    assert " Z-254.000, the tool axis" in done.stdout


def test_errors_in_the_files_of_its_control_have_their_places(acme, tmp_path):
    (tmp_path / "pivot.txt").write_text("\nPIVOT  25O\n")
    words = ("import", "acme", "--turns", "left", "pivot.txt")
    refused = machine(*words, acme=acme, folder=tmp_path)
    assert refused.returncode == 2
    assert refused.stderr.startswith(
        "pivot.txt:2:8: error[GX419]: '25O' is not a number\n2 | PIVOT"
    )
    (tmp_path / "m.toml").write_text(f"format = 1\n{TABLE}")
    (tmp_path / "acme.tools").write_text("1 5.0\n 2 long\n")
    refused = machine("jog", "m.toml", acme=acme, folder=tmp_path)
    assert refused.returncode == 2
    assert refused.stderr.startswith("acme.tools:2:4: error[GX419]: 'long' is not a number\n")


def test_a_control_that_a_broken_plugin_lacks(tmp_path):
    """It is no command, and the reason why is said."""
    changes = {"gcxform-acme": "gcxform-blunt", "gcxform_acme": "gcxform_blunt"}
    changes["[AcmeFiles]"] = "[gx.ControlFiles]"
    source = copied(tmp_path / "source", changes)
    (source / "src" / "gcxform_acme").rename(source / "src" / "gcxform_blunt")
    blunt = install(source, tmp_path / "installed")
    done = machine("import", "acme", "pivot.txt", acme=blunt, folder=tmp_path)
    assert done.returncode == 2
    assert "gcxform-blunt 1.0 returns in gcxform_control_files what is not a control" in done.stderr
    assert "No such command 'acme'." in done.stderr


def test_without_the_distribution_they_are_not_known(tmp_path):
    (tmp_path / "acme.toml").write_text(PIPELINE)
    (tmp_path / "part.nc").write_text(PROGRAM)
    done = gcxform("run", "-p", "acme.toml", "part.nc", paths=(), folder=tmp_path)
    assert done.returncode == 2
    assert "GX703" in done.stderr
    assert "GX704" in done.stderr


def test_they_keep_their_contracts(acme):
    code = (
        "from gcxform.testing import check_dialect, check_pass\n"
        "from gcxform_acme import Acme9000, Shift\n"
        "check_dialect(Acme9000)\n"
        "check_pass(Shift, Shift(), Shift((1.0, -2.5, 0.001)))\n"
    )
    checked = python("-c", code, paths=(acme,))
    assert checked.returncode == 0, checked.stderr


@pytest.mark.parametrize("name", ["Acme9000", "Shift"])
def test_they_are_short(name):
    tree = ast.parse(MODULE.read_text())
    found = next(n for n in tree.body if isinstance(n, ast.ClassDef) and n.name == name)
    first = min([found.lineno, *(d.lineno for d in found.decorator_list)])
    assert found.end_lineno is not None
    assert found.end_lineno - first + 1 <= MOST_LINES


def test_it_imports_only_the_public_api():
    tree = ast.parse(MODULE.read_text())
    imported = {a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names}
    imported |= {str(n.module) for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)}
    given = {"dataclasses", "pathlib", "typing", "numpy"}
    assert imported - given == {"gcxform", "gcxform.vocabulary"}


def test_two_distributions_with_one_name(acme, tmp_path):
    changes = {"gcxform-acme": "gcxform-rival", "gcxform_acme": "gcxform_rival"}
    source = copied(tmp_path / "source", changes)
    (source / "src" / "gcxform_acme").rename(source / "src" / "gcxform_rival")
    rival = install(source, tmp_path / "installed")
    listed = gcxform("list", "passes", paths=(acme, rival))
    assert listed.returncode == 2
    assert "GX801" in listed.stderr
    assert "gcxform-acme 1.0" in listed.stderr
    assert "gcxform-rival 1.0" in listed.stderr


BROKEN = {
    "import": ("import gcxform as gx\n", "import gcxform as gx\nimport no_such_module\n"),
    "exit": ("import gcxform as gx\n", "import gcxform as gx\nraise SystemExit(3)\n"),
    "hook": ("return [Shift]", "return [Shift()]"),
    "raise": ("return [Shift]", "return [Shifty]"),
    "unfrozen": ("@dataclass(frozen=True)\n", ""),
}


@pytest.mark.parametrize("how", BROKEN)
def test_a_broken_plugin_costs_itself_only(how, tmp_path):
    changes = {"gcxform-acme": "gcxform-broken", "gcxform_acme": "gcxform_broken"}
    old, new = BROKEN[how]
    source = copied(tmp_path / "source", {**changes, old: new})
    (source / "src" / "gcxform_acme").rename(source / "src" / "gcxform_broken")
    broken = install(source, tmp_path / "installed")
    (tmp_path / "part.nc").write_text("G21 G90 G94\nG0 X1 Y2 Z3\nG91 X1\nM2\n")
    done = gcxform(
        "run", "-f", "linuxcnc", "-x", "absolute", "part.nc", paths=(broken,), folder=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "G21 G90 G94\nG0 X1 Y2 Z3\nG90 X2.\nM2\n"
    assert "GX802" in done.stderr
    assert "gcxform-broken 1.0" in done.stderr
