"""The shop in `examples/`: 50 programs through `machine new`, filled in, `check`, `run`."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from cli_kit import call, process
from seeds_kit import LONG

import gcxform as gx

SHOP = Path(__file__).parents[1] / "examples" / "shop"
NEW = ("machine", "new", "-f", "fanuc", "programs", "-o", "machine.toml", "-p", "shop.toml")


def fill_in(folder: Path) -> None:
    """Put the values of `filled.txt` in the place of "?"."""
    values = dict(re.findall(r"^(\S+) = (.+)$", (SHOP / "filled.txt").read_text(), re.MULTILINE))
    for name in ("machine.toml", "shop.toml"):
        text = (folder / name).read_text()
        text = re.sub(r'^(\S+) = "\?"$', lambda m: f"{m[1]} = {values[m[1]]}", text, flags=re.M)
        (folder / name).write_text(text)


def test_fifty_programs_with_shared_subprograms(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(SHOP))
    sys.modules.pop("make_programs", None)
    __import__("make_programs").write(tmp_path / "programs")
    found = call(*NEW)
    page = (SHOP / "README.md").read_text()
    assert found.stderr in page
    written = (tmp_path / "machine.toml").read_text() + (tmp_path / "shop.toml").read_text()
    said = re.findall(r"^# needed .*\n.*\"\?\"$", page, re.MULTILINE)
    assert len(said) == 2
    assert all(each in written for each in said)
    fill_in(tmp_path)
    assert '"?"' not in (tmp_path / "machine.toml").read_text().replace('is "?": until', "")
    pipeline = gx.Pipeline.load(tmp_path / "shop.toml")
    programs = sorted((tmp_path / "programs").glob("O1*.nc"))
    assert len(programs) == 50
    # each ninth: all kinds, inches, the switch, six of seven tools
    for program in programs if LONG else programs[::9]:
        done = pipeline.run(program)
        assert done.certificate.verified
        assert done.certificate.checked["moves"] > 5
    for program in programs[:10] if LONG else programs[:2]:
        assert call("check", "-p", "shop.toml", str(program)).exit_code == 0
    assert process("run", "-p", "shop.toml", "programs/O1004.nc", "-o", "out.nc").returncode == 0
