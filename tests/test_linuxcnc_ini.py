"""What an INI file of LinuxCNC says of programs, held against `rs274 -i`."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from oracles import rs274

import gcxform as gx

INI = """[RS274NGC]
SUBROUTINE_PATH = subs:nowhere
[DISPLAY]
PROGRAM_PREFIX = programs
[VARS]
A = 1.5
A = 2
b = 3
B = -4e1
C = 5 # a comment
[OTHER]
A = 6
[VARS]
D = 7
[lower]
E = 8
"""
READS = (
    ("x#<_ini[vars]a>", 1.5),
    ("x#<_ini[VARS]B>", -40.0),
    ("x#<_ini[other]a>", 6.0),
    ("x#<_ini[vars]c>", None),
    ("x#<_ini[vars]d>", None),
    ("x#<_ini[lower]e>", None),
)
SUB = "o<{}> sub\ng0 x{}\no<{}> endsub\nm2\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for place, name, where in (("subs", "s", 11), ("programs", "t", 12), (".", "u", 13)):
        (tmp_path / place).mkdir(exist_ok=True)
        (tmp_path / place / f"{name}.ngc").write_text(SUB.format(name, where, name))
    (tmp_path / "m.ini").write_text(INI)
    (tmp_path / "machine.toml").write_text('format = 1\nini = "m.ini"\n')
    return tmp_path


def ends_at(folder: Path, block: str) -> float:
    """Return X behind a block, as it is read with the machine file; nan: not known."""
    program = folder / "p.ngc"
    program.write_text(f"g21 g90 g94 g17\ng0 x0 y0 z0\n{block}\nm2\n")
    return float(gx.read(program, "linuxcnc", machine=folder / "machine.toml").path.end[-1, 0])


def on_linuxcnc(folder: Path) -> float | None:
    """Return X behind the program in the folder, None where the interpreter refuses it."""
    command = ["rs274", "-i", "m.ini", "-g", "p.ngc"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=10)
    moves = re.findall(r"STRAIGHT_TRAVERSE\(([-0-9.]+)", done.stdout)
    return float(moves[-1]) if done.returncode == 0 else None


@pytest.mark.parametrize(("word", "value"), READS)
def test_what_programs_read_of_it(folder: Path, word: str, value: float | None) -> None:
    found = ends_at(folder, f"g0 {word}")
    assert (found == value) if value is not None else found != found
    if rs274.available():
        assert on_linuxcnc(folder) == value


@pytest.mark.parametrize(("name", "value"), [("s", 11.0), ("t", 12.0), ("u", 13.0)])
def test_where_subprograms_are(folder: Path, name: str, value: float) -> None:
    assert ends_at(folder, f"o<{name}> call") == value
    if rs274.available():
        assert on_linuxcnc(folder) == value


def test_what_includes_another_file_is_refused(folder: Path) -> None:
    (folder / "m.ini").write_text(INI + "#INCLUDE other.inc\n")
    with pytest.raises(gx.UsageError, match="INCLUDE is not followed"):
        ends_at(folder, "g0 x1")


def test_a_code_that_runs_a_program_is_refused_where_it_stands(folder: Path) -> None:
    (folder / "m.ini").write_text("[RS274NGC]\nREMAP=M61 ngc=a\nREMAP = m6 modalgroup=6 ngc=b\n")
    assert ends_at(folder, "g0 x1") == 1.0
    for code in ("m6", "m61 q1"):
        with pytest.raises(gx.InputError, match="runs a program of the machine"):
            ends_at(folder, f"t1 {code}\ng91 g0 x1")


@pytest.mark.parametrize("key", ["TOOL_CHANGE_POSITION = 0 0 2", "TOOL_CHANGE_QUILL_UP = 1"])
def test_a_tool_change_that_moves(folder: Path, key: str) -> None:
    step = "t1 m6\ng91 g0 x1"
    (folder / "m.ini").write_text("[EMCIO]\nTOOL_CHANGE_AT_G30 = 0\n")
    assert ends_at(folder, step) == 1.0
    (folder / "m.ini").write_text(f"[EMCIO]\n{key}\n")
    assert ends_at(folder, step) != 1.0


@pytest.mark.parametrize("line", ["REMAP=T ngc=t", "RS274NGC_STARTUP_CODE = G17 G20"])
def test_words_and_modes_that_are_not_followed(folder: Path, line: str) -> None:
    (folder / "m.ini").write_text("[RS274NGC]\nRS274NGC_STARTUP_CODE = g21 g40 G64P0.01\n")
    assert ends_at(folder, "g0 x1") == 1.0
    (folder / "m.ini").write_text(f"[RS274NGC]\n{line}\n")
    with pytest.raises(gx.UsageError, match="not followed"):
        ends_at(folder, "g0 x1")


def test_a_control_that_has_no_such_file(folder: Path) -> None:
    (folder / "machine.toml").write_text('format = 1\nini = "m.ini"\nini-control = "linuxnc"\n')
    with pytest.raises(gx.UsageError, match="did you mean"):
        ends_at(folder, "g0 x1")


def test_what_only_the_machine_knows_may_be_given(folder: Path) -> None:
    program = b"g21 g90 g94 g17\ng0 x#<_hal[a.b]>\nm2\n"
    told = {"<_hal[a.b]>": 4.0}
    assert gx.read(program, "linuxcnc", parameters=told).path.end[-1, 0] == 4.0
