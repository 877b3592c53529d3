"""Every host is told the right words, and gets a proved program or its own, with a reason.

Where LinuxCNC is installed, its interfaces filter programs by their own code.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import axis_kit
import host_kit as kit
import pytest
import stamp_kit
from cli_kit import call
from matplotlib import image

# hosts leave files open
pytestmark = [
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]
LINUXCNC: dict[str, Callable[[str, Path, Path], kit.Filtered]] = {
    "axis": kit.by_axis,
    "qtvcp": partial(kit.by_vcp, kit.QTVCP),
    "gmoccapy": partial(kit.by_vcp, kit.GMOCCAPY),
}
PIPELINE = """format = 1
[input]
dialect = "linuxcnc"
[[pass]]
use = "volumetric"
model = "model.toml"
part-origin = [0, 0, 0]
"""
BOX = b"""G21 G90 G17 G54
G0 X-40 Y-40 Z5
G1 Z-1 F500
X40
Y40
G3 X-40 Y40 I-40 J0
G1 Y-40
G0 Z5
M2
"""
LONG = os.environ.get("HYPOTHESIS_PROFILE") == "long"
PICTURES = os.environ.get("PICTURES", "")


@pytest.fixture
def shop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with a blank and a quote in its name, with a pipeline and a model."""
    monkeypatch.delenv("GCXFORM_PIPELINE", raising=False)
    folder = tmp_path / "the shop's"
    folder.mkdir()
    (folder / "mill 1.toml").write_text(PIPELINE)
    (folder / "model.toml").write_text(stamp_kit.MODEL)
    (folder / "a part.ngc").write_bytes(stamp_kit.PLATE)
    return folder


def filter_of(folder: Path, ending: str = "ngc") -> str:
    """Return the command that the INI file has for an ending."""
    printed = call("hosts", "linuxcnc", "-p", str(folder / "mill 1.toml"))
    assert printed.exit_code == 0, printed.output
    lines = dict(line.split(" = ", 1) for line in printed.stdout.splitlines() if " = " in line)
    return lines[ending]


@pytest.mark.parametrize("name", LINUXCNC)
def test_linuxcnc_filters(name: str, shop: Path) -> None:
    """The result is what `run` writes; filtered again, it stays; what is refused says why."""
    command, program, out = filter_of(shop), shop / "a part.ngc", shop / "out.ngc"
    done = LINUXCNC[name](command, program, out)
    assert (done.code, done.shown) == (0, "")
    wanted = call("run", "-q", "-p", str(shop / "mill 1.toml"), str(program))
    assert done.text == wanted.stdout_bytes != program.read_bytes()
    (shop / "bad.ngc").write_bytes("G1 X1 (\u00fc)\nM2\n".encode("latin-1"))
    bad = LINUXCNC[name](command, shop / "bad.ngc", out)
    assert (bad.code, bad.text) == (3, b"")
    assert "bad.ngc:1:" in bad.shown


def test_a_finished_program_is_opened_as_it_is(shop: Path) -> None:
    command, program, out = filter_of(shop), shop / "a part.ngc", shop / "out.ngc"
    done = call("run", "-q", "-p", str(shop / "mill 1.toml"), str(program)).stdout_bytes
    program.write_bytes(done)
    again = kit.by_axis(command, program, out)
    assert (again.code, again.text) == (0, done)
    program.write_bytes(done.replace(b"Y50.", b"Y51."))
    edited = kit.by_axis(command, program, out)
    assert (edited.code, edited.text) == (3, b"")
    assert "edited since" in edited.shown


def test_a_bar_is_shown(shop: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is not the program is lines that AXIS takes for its bar."""
    monkeypatch.setattr("gcxform.cli.common.progress.PATIENCE", -1)
    words = ("post", "--filter", "-p", str(shop / "mill 1.toml"), str(shop / "a part.ngc"))
    said = call(*words).stderr.splitlines()
    bar = kit.taken(kit.AXIS, "progress_re")["progress_re"]
    assert [bar.match(line)[1] for line in said] == ["100"]


def lines_for(name: str, folder: Path) -> str:
    """Return what a host is to be given."""
    printed = call("hosts", name, "-p", str(folder / "mill 1.toml"))
    assert printed.exit_code == 0, printed.output
    return printed.stdout


def by_fusion(folder: Path, program: Path) -> int:
    """Call what `execute` of a post is given: a program, and its words as one text."""
    said = re.search(r'execute\((".*"), (".*") \+ " \\"" \+', lines_for("fusion", folder))
    assert said is not None
    exe, words = (json.loads(text) for text in said.groups())
    return subprocess.run([exe, *shlex.split(words), str(program)], check=False).returncode


def by_vectric(folder: Path, program: Path) -> int:
    """Call what the two lines of the file say, with the program in the place of %s."""
    exe, words = lines_for("vectric", folder).splitlines()
    words = words.replace("%s", shlex.quote(str(program)))
    return subprocess.run([exe, *shlex.split(words)], check=False).returncode


def by_nx(folder: Path, program: Path) -> int:
    """Run the lines in Tcl, with nothing behind the commands of the post."""
    if shutil.which("tclsh") is None:
        pytest.skip("tclsh is not installed: the lines for NX are not run")
    stand_ins = "proc MOM_close_output_file f {}\nproc MOM_open_output_file f {}\n"
    text = f"{stand_ins}set ptp_file_name {{{program}}}\n{lines_for('nx', folder)}"
    return subprocess.run(["tclsh"], input=text.encode(), check=False).returncode


@pytest.mark.parametrize("host", [by_fusion, by_nx, by_vectric])
def test_posts_call_it_in_place(host: Callable[[Path, Path], int], shop: Path) -> None:
    """The file, with blanks and quotes in its name, is what `run` writes; again, it stays."""
    wanted = call("run", "-q", "-p", str(shop / "mill 1.toml"), str(shop / "a part.ngc"))
    assert host(shop, shop / "a part.ngc") == 0
    assert (shop / "a part.ngc").read_bytes() == wanted.stdout_bytes != stamp_kit.PLATE


def test_a_pipe_has_both_ends(shop: Path) -> None:
    """Program and result are both called -, and are not one file."""
    words = ("run", "-q", "-p", str(shop / "mill 1.toml"))
    done = call(*words, "-", stdin=stamp_kit.PLATE)
    assert (done.exit_code, done.stderr) == (0, "")
    assert done.stdout_bytes == call(*words, str(shop / "a part.ngc")).stdout_bytes


@pytest.mark.skipif(not LONG, reason="AXIS is looked at with HYPOTHESIS_PROFILE=long")
def test_axis_shows_the_compensated_path() -> None:
    """What AXIS draws of a program that it filters is what it draws of the finished one."""
    with TemporaryDirectory() as name:  # which `nobody` reaches
        folder = Path(name)
        (folder / "mill 1.toml").write_text(PIPELINE + 'max-correction = "20 mm"\n')
        (folder / "model.toml").write_text(stamp_kit.MODEL.replace("0.2]", "80.0]"))
        (folder / "part.ngc").write_bytes(BOX)
        (folder / "part.plain").write_bytes(BOX)
        done = call("run", "-q", "-p", str(folder / "mill 1.toml"), str(folder / "part.ngc"))
        assert done.exit_code == 0, done.output
        (folder / "part.done").write_bytes(done.stdout_bytes)
        said = call("hosts", "linuxcnc", "-p", str(folder / "mill 1.toml")).stdout
        with axis_kit.started(folder, said) as axis:
            finished = axis.open(folder / "part.done")
            plain = axis.open(folder / "part.plain")  # so that the next picture has to be drawn
            filtered = axis.open(folder / "part.ngc", finished)
    if PICTURES:
        for name, shown in {"axis": filtered, "axis-finished": finished}.items():
            image.imsave(Path(PICTURES) / f"{name}.png", shown)
    assert (finished == filtered).all()
    assert (plain != filtered).any(axis=2).sum() > 500
