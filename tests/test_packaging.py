"""The wheel of gcxform: everything is inside, and it works where nothing else is."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tarfile
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = {
    "gcxform": ROOT / "gcxform",
    "gcxform_plugins": ROOT / "plugins" / "gcxform_plugins",
    "gcxform_grammars": ROOT / "grammars" / "gcxform_grammars",
}
JUNK = {"__pycache__"}
LONG = pytest.mark.skipif(
    os.environ.get("HYPOTHESIS_PROFILE") != "long",
    reason="sdist and image are built with HYPOTHESIS_PROFILE=long",
)
PIP = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]


pytestmark = pytest.mark.xdist_group("wheel")  # it is built once


@pytest.fixture(scope="session")
def wheel(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    options = ["--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", str(folder)]
    subprocess.run([*PIP, "wheel", *options, str(ROOT)], check=True)
    (built,) = folder.glob("gcxform-*.whl")
    return built


@pytest.fixture(scope="session")
def installed(wheel, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("installed")
    options = ["--no-deps", "--no-index", "--root-user-action=ignore", "--target", str(folder)]
    subprocess.run([*PIP, "install", *options, str(wheel)], check=True)
    return folder


def isolated(installed: Path, code: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run code with the wheel in front of everything, in a folder where no checkout is."""
    place = f"import sys; sys.path.insert(0, {str(installed)!r})\n"
    return subprocess.run(
        [sys.executable, "-c", place + code, *arguments],
        capture_output=True,
        text=True,
        cwd=installed,
    )


@pytest.mark.parametrize("package", PACKAGES)
def test_every_file_is_inside(wheel, package):
    source = PACKAGES[package]
    files = [p for p in source.rglob("*") if p.is_file() and not JUNK & set(p.parts)]
    wanted = {f"{package}/{path.relative_to(source).as_posix()}" for path in files}
    inside = {name for name in zipfile.ZipFile(wheel).namelist() if name.startswith(package + "/")}
    assert inside == wanted
    assert f"{package}/py.typed" in inside


def test_grammars_are_inside(wheel):
    inside = zipfile.ZipFile(wheel).namelist()
    grammars = {Path(name).stem for name in inside if name.endswith(".lark")}
    assert {"iso", "expressions", "fanuc", "grbl", "linuxcnc"} <= grammars


def test_nothing_else_is_inside(wheel):
    tops = {name.split("/")[0] for name in zipfile.ZipFile(wheel).namelist()}
    assert {top for top in tops if not top.endswith(".dist-info")} == set(PACKAGES)


def test_entry_points(wheel):
    archive = zipfile.ZipFile(wheel)
    (name,) = (n for n in archive.namelist() if n.endswith("entry_points.txt"))
    text = archive.read(name).decode()
    assert "gcxform = gcxform.cli:main" in text
    assert "builtin = gcxform_plugins" in text


def test_it_works_by_itself(installed):
    code = (
        "import gcxform as gx, gcxform_plugins, gcxform_grammars\n"
        "for module in (gx, gcxform_plugins, gcxform_grammars):\n"
        f"    assert module.__file__.startswith({str(installed)!r}), module.__file__\n"
        "pipeline = gx.Pipeline.parse('absolute', 'linuxcnc')\n"
        "result = pipeline.run(b'G21 G90\\nG0 X1\\nG91 X1\\nM2\\n')\n"
        "sys.stdout.write(result.text.decode())\n"
    )
    done = isolated(installed, code)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "G21 G90\nG0 X1\nG90 X2.\nM2\n"


def test_its_command_works(installed):
    code = "from gcxform.cli import main; sys.argv[0] = 'gcxform'; main()"
    done = isolated(installed, code, "--version")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("gcxform ")


@LONG
def test_the_sdist_makes_the_same_wheel(wheel, tmp_path):
    """Who builds from it gets every file, and needs no repository for that."""
    words = ["-m", "build", "--sdist", "--no-isolation", "--outdir", str(tmp_path), str(ROOT)]
    subprocess.run([sys.executable, *words], check=True, capture_output=True)
    (packed,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(packed) as archive:
        archive.extractall(tmp_path, filter="data")
    options = ["--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", str(tmp_path)]
    subprocess.run([*PIP, "wheel", *options, str(tmp_path / packed.name[:-7])], check=True)
    (built,) = tmp_path.glob("*.whl")
    assert built.name == wheel.name
    one, other = (zipfile.ZipFile(each) for each in (built, wheel))
    assert sorted(one.namelist()) == sorted(other.namelist())
    assert all(one.read(name) == other.read(name) for name in one.namelist())


def test_all_is_everything_for_users():
    """An extra for users is one of `all`; what is for developers is not."""
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"][
        "optional-dependencies"
    ]
    (named,) = extras["all"]
    inside = re.fullmatch(r"gcxform\[(.*)\]", named)[1].split(",")
    assert set(inside) == set(extras) - {"all", "docs", "dev"}


def lines_of_the_image() -> list[str]:
    """Return what the Containerfile runs, in order."""
    text = (ROOT / "Containerfile").read_text()
    return re.findall(r"^RUN (.*)$", text, re.MULTILINE)


def test_the_image_copies_what_it_uses():
    text = (ROOT / "Containerfile").read_text()
    assert text.count("FROM ") == 2
    assert re.search(r"^USER [1-9]", text, re.MULTILINE), "not the superuser"
    assert text.rstrip().endswith('ENTRYPOINT ["gcxform"]')
    assert len(lines_of_the_image()) == 4


@LONG
def test_the_lines_of_the_image_run(tmp_path):
    """In a new environment in the place of an image; pip needs an index for the first of them."""
    venv.create(tmp_path / "image", with_pip=True)
    path = {**os.environ, "PATH": f"{tmp_path / 'image' / 'bin'}:{os.environ['PATH']}"}
    for line in lines_of_the_image():
        there = line.replace("/src", str(ROOT)).replace("/wheels", str(tmp_path / "wheels"))
        done = subprocess.run(
            ["sh", "-ec", there], cwd=tmp_path, env=path, capture_output=True, text=True
        )
        assert done.returncode == 0, f"{line}\n{done.stderr}"
    assert done.stdout == ""
