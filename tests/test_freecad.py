"""Every post processor of FreeCAD, and what gcxform makes of what it writes.

The table of `docs/hosts/freecad.md` is held to: row by row against what the posts of Debian's
FreeCAD have written (`tests/freecad/posts/`), and against FreeCAD itself where it is installed.
With KEEP=1 what it writes is kept there.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import stamp_kit
from cli_kit import call

import gcxform as gx

HERE = Path(__file__).parent
PAGE = HERE.parent / "docs" / "hosts" / "freecad.md"
POSTS = HERE / "freecad" / "posts"
ROW = re.compile(r"^\| `(\w+)` \|(.*)\|$", re.MULTILINE)
ROWS = {
    name: [cell.strip(" `") for cell in said.split("|")]
    for name, said in ROW.findall(PAGE.read_text("utf-8"))
}
WRITTEN = {name: said for name, said in ROWS.items() if said[1]}
CHAINS = (
    "absolute",
    "cycles | segment chord-error=5um",
    "cycles | segment chord-error=5um | volumetric model=model.toml part-origin=0,0,0",
)
DATE = re.compile(rb"(?i)(output time: ?)[0-9][^)\r\n]*")
PIPELINE = """format = 1
[input]
dialect = "grbl"
[[pass]]
use = "volumetric"
model = "model.toml"
part-origin = [0, 0, 0]
"""


def file_of(name: str) -> str:
    """Return what the file of a post is called: fanuc writes it as the number of the program."""
    return "O1234" if name == "fanuc" else f"{name}.nc"


def lasting(text: bytes) -> list[bytes]:
    """Return the lines in which there is no date, nor a digest of one."""
    return [line for line in text.splitlines() if not DATE.search(line) and b"SEAL" not in line]


def outcome(text: bytes, dialect: str, chain: str, folder: Path) -> str:
    """Return what a chain does with a program: that it is proved, or the code of its refusal."""
    try:
        done = stamp_kit.pipeline(chain, folder, dialect).run(text)
    except gx.GcxformError as error:
        return error.diagnostics[0].code
    return "proved" if done.certificate.verified else "not proved"


@pytest.mark.parametrize("name", WRITTEN)
def test_what_a_post_writes(name: str, tmp_path: Path) -> None:
    (tmp_path / "model.toml").write_text(stamp_kit.MODEL)
    _, dialect, *said = WRITTEN[name][:5]
    text = (POSTS / file_of(name)).read_bytes()
    found = [outcome(text, dialect, chain, tmp_path) for chain in CHAINS]
    assert found == said, name


@pytest.fixture(scope="module")
def posted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with what FreeCAD has written by all posts, and through gcxform."""
    program = shutil.which("freecadcmd")
    if program is None:
        pytest.skip("freecadcmd is not installed: no post of FreeCAD is run")
    home, out = tmp_path_factory.mktemp("a home"), tmp_path_factory.mktemp("out")
    (home / "mill it.toml").write_text(PIPELINE)
    (home / "model.toml").write_text(stamp_kit.MODEL)
    words = ("hosts", "freecad", "--install", "-p", str(home / "mill it.toml"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOME", str(home))
        assert call(*words).exit_code == 0
    lines = [f"{file_of(name)}={name} {said[0]}" for name, said in ROWS.items()]
    lines.append("through.nc=gcxform --base grbl --translate_drill")
    lines += ["wrong.nc=gcxform --base linuxcnc", "none.nc=gcxform --base nothing"]
    said = {"HOME": str(home), "OUT": str(out), "POSTS": "\n".join(lines)}
    said["PATH"] = os.environ["PATH"]
    job = [program, str(HERE / "freecad" / "job.py")]
    subprocess.run(job, env=said, timeout=120, capture_output=True, check=False)
    return out


@pytest.mark.parametrize("name", ROWS)
def test_posts_write_what_is_kept(name: str, posted: Path) -> None:
    """A row without a dialect is of a post that fails by itself, or writes no G-code."""
    place, kept = posted / file_of(name), POSTS / file_of(name)
    if name not in WRITTEN:
        failed = (posted / f"{file_of(name)}.error").exists()
        assert failed == ROWS[name][2].startswith("fails"), name
        return
    text = DATE.sub(rb"\g<1>then", place.read_bytes()).replace(os.fsencode(posted), b"OUT")
    text = text.replace(os.fsencode(str(posted).upper()), b"OUT")
    if os.environ.get("KEEP"):
        kept.write_bytes(text)
    assert text == kept.read_bytes()


def test_a_post_runs_another_and_gcxform(posted: Path, tmp_path: Path) -> None:
    """The program is that of `run`; what is refused, or posted by nothing, is not written."""
    (tmp_path / "job.toml").write_text(PIPELINE)
    (tmp_path / "model.toml").write_text(stamp_kit.MODEL)
    (tmp_path / "base.nc").write_bytes((posted / "grbl.nc").read_bytes())
    wanted = call("run", "-q", "-p", str(tmp_path / "job.toml"), str(tmp_path / "base.nc"))
    assert wanted.exit_code == 0, wanted.output
    assert lasting((posted / "through.nc").read_bytes()) == lasting(wanted.stdout_bytes)
    for name, reason in {"wrong": "grbl has no code", "none": "no post processor nothing"}.items():
        assert not (posted / f"{name}.nc").exists()
        assert reason in (posted / f"{name}.nc.error").read_text()
