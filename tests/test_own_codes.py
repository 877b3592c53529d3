"""Codes that a machine file declares: every verb and the API take them, and no other control's."""

from __future__ import annotations

from pathlib import Path

import pytest
from cli_kit import call

import gcxform as gx

MACHINE = """format = 1
[control]
inert-m = [77]
[control.macro.G100]
ends = "at XY"
[control.macro.M250]
ends = "unchanged"
"""
PROGRAM = b"O1\nG21 G90 G94 G17 G54 G0 X0. Y0. Z5.\nG100 X5. Y6.\nG1 X7. F100.\nM250\nX8.\nM30\n"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "machine.toml").write_text(MACHINE)
    (tmp_path / "part.nc").write_bytes(PROGRAM)
    return tmp_path


@pytest.mark.parametrize(
    ("verb", "says"),
    [
        (("info", "part.nc"), "refused  0"),
        (("explain", "part.nc:4"), "to   X7 Y6"),
        (("compare", "part.nc", "part.nc"), "SAME"),
        (("view", "-o", "page.html", "part.nc"), ""),
        (("check", "part.nc"), "no findings"),
        (("run", "-x", "absolute", "part.nc"), "G100"),
    ],
)
def test_every_verb_takes_the_codes_of_the_machine(
    here: Path, verb: tuple[str, ...], says: str
) -> None:
    name, *rest = verb
    done = call(name, "-f", "fanuc", "-m", "machine.toml", *rest)
    assert done.exit_code == 0, done.stderr
    assert says in done.stdout
    bare = call(name, "-f", "fanuc", *rest)
    assert "GX201" in bare.stdout + bare.stderr or "1 refused line" in bare.stdout


@pytest.mark.parametrize("words", [b"G65 P9810 X5. Y6.", b"G100 X5. Y6.", b"M250"])
def test_no_restart_is_safe_behind_a_call_that_is_kept(here: Path, words: bytes) -> None:
    text = PROGRAM.replace(b"G100 X5. Y6.", words)
    (here / "part.nc").write_bytes(text.replace(b"G1 X7.", b"G90 G1 X7. Y6. Z1."))
    done = call("resume", "-f", "fanuc", "-m", "machine.toml", "--line", "5", "part.nc")
    assert "GX732" in done.stderr


def test_a_program_in_memory_has_the_codes_of_its_machine(here: Path) -> None:
    read = gx.read(PROGRAM, "fanuc", machine="machine.toml")
    assert read.path.end[-1, 0] == 8.0
    with pytest.raises(gx.UsageError, match="machine"):
        gx.read(PROGRAM, "fanuc", machine=3)  # type: ignore[arg-type]
    with pytest.raises(gx.UsageError, match="GX405"):
        gx.read(PROGRAM, "haas", machine="machine.toml")


def test_the_codes_of_a_machine_are_none_of_another_control(here: Path) -> None:
    """A Haas has a G100 of its own, and LinuxCNC no calls with values: neither is asked."""
    (here / "plain.nc").write_bytes(b"O1\nG21 G90 G94 G17 G54 G0 X0. Y0. Z5.\nM30\n")
    for to in ("haas", "linuxcnc"):
        options = ("-f", "fanuc", "-t", to, "-m", "machine.toml")
        done = call("run", "-x", "absolute", *options, "plain.nc")
        assert done.exit_code == 0, done.stderr
        (here / "other.nc").write_text(done.stdout)
        done = call("compare", *options, "plain.nc", "other.nc")
        assert done.exit_code == 0, done.stderr + done.stdout
        done = call("run", "-x", "absolute", *options, "part.nc")
        assert done.exit_code == 3
        assert "G100" in done.stderr


@pytest.mark.parametrize(
    ("dialect", "words", "known"),
    [
        ("haas", b"G13 I1. F10. Z-1. D1", False),
        ("haas", b"G37 Z0 F10. H1", False),
        ("fanuc", b"G100 X5. F3.", False),
        ("fanuc", b"M250", True),
    ],
)
def test_what_f_is_behind_a_code_of_its_own_is_not_known(
    here: Path, dialect: str, words: bytes, known: bool
) -> None:
    text = b"G21 G90 G94 G17 G54\nG0 X0. Y0. Z5.\nG1 X1. F50.\n%s\nG90 G1 X7. Y7. Z7.\n" % words
    machine = here / "machine.toml" if dialect == "fanuc" else None  # G100 is Haas' own
    path = gx.read(text, dialect=dialect, machine=machine).path
    assert (path.feed[-1] == 50.0) == known
