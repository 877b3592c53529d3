"""What is said about a program in another language shows its lines, whoever says it."""

from __future__ import annotations

import hashlib
import json

import numpy as np
import pytest
from cli_kit import call, expanded

import gcxform as gx
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.syntax.source import Source

PROGRAM = b"""%PART
; a comment of 3 (words)
G71 G90 G17 G94 G54
#RTCP OFF
T1 M6
D1
G0 X0 Y0 Z50 (to the start

N70 G1 X10 F1000
   X5I Y3I
G6 G2 X20 Y3 I17.5 J3
M30
nothing here is executed?
"""
MACHINE = """format = 1
kinematics = "ac-trunnion"
[axis.X]
[axis.Y]
[axis.Z]
[axis.A]
point = [0.0, 0.0, 0.0]
limits = [-100.0, 100.0]
[axis.C]
point = [0.0, 0.0, 0.0]
[work-offset.G54]
[tool.1]
length = 50.0
"""
RTCP = """format = 1
[input]
dialect = "fagor"
[output]
dialect = "linuxcnc"
[machine]
file = "machine.toml"
[[pass]]
use = "absolute"
[[pass]]
use = "segment"
chord-error = "1 um"
[[pass]]
use = "rtcp"
tolerance = "0.01 mm"
tip-codes = "read"
"""
TIPS = b"""%TIPS
G71 G90 G17 G94 G54
T1 M6
D1
G0 X0 Y0 Z70 A0 C0
#RTCP ON
; the cut
G1 X10 A10 C30 F1000
A0 C0
#RTCP OFF
M30
"""


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GCXFORM_PIPELINE", raising=False)
    (tmp_path / "a.nc").write_bytes(PROGRAM)
    (tmp_path / "tips.nc").write_bytes(TIPS)
    (tmp_path / "machine.toml").write_text(MACHINE)
    (tmp_path / "p.toml").write_text(RTCP)
    return tmp_path


def written(*words, stdin=None):
    return call("run", "-f", "fagor", "-t", "linuxcnc", "-x", "absolute", *words, stdin=stdin)


def test_a_run_its_map_and_its_certificate(place):
    found = written("a.nc", "-o", "o.nc", "--map", "map", "--certificate", "c.json")
    assert found.exit_code == 0, found.output
    lines = (place / "o.nc").read_text().split("\n")
    assert lines[:2] == ["(a comment of 3 [words])", "G21 G90 G17 G94 G54"]
    told = json.loads((place / "map").read_text())
    assert told["source"]["name"] == "a.nc"
    source = expanded(told["lines"])
    program = PROGRAM.split(b"\n")
    assert program[source[lines.index("X15. Y3.")]] == b"   X5I Y3I"
    assert program[source[lines.index("G0 X0. Y0. Z50. (to the start)")]].startswith(b"G0 X0")
    certificate = json.loads((place / "c.json").read_text())
    assert certificate["source"]["name"] == "a.nc"
    assert certificate["source"]["lines"] == 13
    assert certificate["source"]["sha256"] == hashlib.sha256(PROGRAM).hexdigest()
    from_stdin = written("-", stdin=PROGRAM)
    assert from_stdin.stdout_bytes == (place / "o.nc").read_bytes()


def test_a_run_without_passes_copies(place):
    found = call("run", "-f", "fagor", "-x", "", "a.nc", "-o", "o.nc")
    assert found.exit_code == 0
    assert (place / "o.nc").read_bytes() == PROGRAM


def test_info_counts_blocks_and_lines(place):
    found = json.loads(call("info", "-f", "fagor", "--json", "a.nc").output)
    assert (found["lines"], found["blocks"]) == (13, 11)
    assert found["line_ends"] == {"LF": 13}
    assert found["moves"] == {"rapids": 1, "lines": 2, "arcs cw": 1}
    assert found["events"]["#RTCP OFF"] == 1
    assert "M129" not in found["codes"]
    assert found["refused"] == 0
    (place / "b.nc").write_bytes(PROGRAM.replace(b"G6 G2", b"G9 G2"))
    found = json.loads(call("info", "-f", "fagor", "--json", "b.nc").output)
    assert found["moves"] == {"rapids": 1, "lines": 2}
    assert found["first_refused"].keys() == {"11"}
    assert "not read" in found["first_refused"]["11"]
    (place / "b.nc").write_bytes(TIPS)
    found = json.loads(call("info", "-f", "fagor", "--json", "b.nc").output)
    assert found["first_refused"]["6"].startswith("GX210 #RTCP ON")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (1, ["%PART", "it stands for no block", "moves nothing"]),
        (4, ["\n  M129\n", "what it does\n  #RTCP OFF"]),
        (10, ["   X5I Y3I", "\n  X15 Y3\n", "from X10 Y0", "to   X15 Y3"]),
        (11, ["G90.1 G2 X20", "\n  G91.1\n", "radius 2.5 mm", "from X15 Y3"]),
        (13, ["nothing here", "it stands for no block", "the program has ended"]),
    ],
)
def test_explain_shows_a_line_its_blocks_and_what_they_do(place, line, said):
    found = call("explain", "-f", "fagor", f"a.nc:{line}").output
    for text in said:
        assert text in found
    assert "refused" not in found


def test_explain_shows_what_is_refused(place):
    (place / "b.nc").write_bytes(PROGRAM.replace(b"T1 M6", b"T1 M6 X4"))
    found = call("explain", "-f", "fagor", "b.nc:5").output
    assert "refused [GX210]: M6 beside a move" in found
    found = call("explain", "-f", "fagor", "b.nc:11").output
    assert "refused line(s) before, first line 5" in found
    assert "b.nc has 13 lines and no line 14" in call("explain", "-f", "fagor", "b.nc:14").output


def test_resume_would_have_to_write(place):
    found = call("resume", "-f", "fagor", "--line", "9", "a.nc")
    assert found.exit_code == 2
    assert "GX747" in found.output


def test_compare_tells_the_lines_of_both():
    """Each program is read in a dialect of its own."""
    lines = PROGRAM.replace(b"   X5I Y3I\n", b"   X5I Y4I\nX15 Y3\n")
    found = gx.compare(gx.read(PROGRAM, "fagor"), gx.read(lines, "fagor"), 1e-3)
    assert not found.same
    assert (found.line_a, found.line_b) in {(10, 10), (11, 11), (10, 11)}


def test_compare_finds_what_is_written_the_same(place):
    """The code that leaves the tip is not written for a control that follows none."""
    assert written("a.nc", "-o", "o.nc").exit_code == 0
    found = call("compare", "-f", "fagor", "-t", "linuxcnc", "a.nc", "o.nc")
    assert found.exit_code == 0, found.output
    assert "A: a.nc (fagor), 4 moves" in found.output


CHECKED = {
    "GX101": (b"M30\n", b"G1 ?\nM30\n", 12, "G1 ?", 4),
    "GX201": (b"M30\n", b"G555\nM30\n", 12, "G555", 1),
    "GX203": (b"F1000", b"F1000 F3", 9, "N70 G1 X10 F1000 F3", 1),
    "GX301": (b"I17.5", b"I7.5", 11, "G6 G2 X20 Y3 I7.5 J3", 1),
}


@pytest.mark.parametrize("code", CHECKED)
def test_check_shows_lines_of_the_program(place, code):
    old, new, line, text, column = CHECKED[code]
    (place / "b.nc").write_bytes(PROGRAM.replace(old, new))
    found = call("check", "-f", "fagor", "-t", "linuxcnc", "b.nc").output
    assert f"b.nc:{line}:{column}: error[{code}]" in found
    assert f"{line} | {text}" in found
    found = written("b.nc").output
    assert f"b.nc:{line}:{column}: error[{code}]" in found


def refused(program, **options):
    step = gx.Pipeline.load("p.toml")
    with pytest.raises(gx.GcxformError) as error:
        Run(step, Source.of_bytes(program, "tips.nc"), "on").over(
            Output(len, None), abs, options.get("size", 0)
        )
    return error.value.diagnostics[0]


@pytest.mark.parametrize("size", [1, 40, 0])
def test_what_rtcp_refuses_names_line_and_word_of_the_program(place, size):
    """It comes from a pass, far behind the reading."""
    late = TIPS.replace(b"A0 C0\n#RTCP OFF\n", b"#RTCP OFF\nA0 C0\n")
    found = refused(late, size=size)
    assert (found.where.file, found.where.line) == ("tips.nc", 10)
    assert found.code in ("GX311", "GX320")
    assert found.where.text == "A0 C0"
    (place / "machine.toml").write_text(MACHINE.replace("100.0]", "5.0]"))
    found = refused(TIPS, size=size)  # beyond a limit: told of the move
    assert found.where.line in (8, 9)
    assert found.where.text in ("G1 X10 A10 C30 F1000", "A0 C0")


def test_what_the_proof_finds_shows_the_line_of_the_program(place, monkeypatch):
    """GX6xx: a fault in writing, put there by hand, is told of the line in which it is."""
    from gcxform.emit import emitter

    write = emitter.Emitter.emit

    def broken(self, *given, **named):
        made = write(self, *given, **named)
        for name in ("text", "data"):
            if hasattr(made, name):
                value = getattr(made, name)
                object.__setattr__(made, name, value.replace(b"X10.", b"X11."))
        return made

    monkeypatch.setattr(emitter.Emitter, "emit", broken)
    pipeline = gx.Pipeline.load("p.toml")
    with pytest.raises(gx.GcxformError) as error:
        pipeline.run(TIPS)
    (found, *_) = error.value.diagnostics
    assert found.code.startswith("GX6")


def test_programs_in_memory_know_their_lines():
    program = gx.read(PROGRAM, "fagor")
    executed = program.executed.split(b"\n")
    assert executed[0] == b"(a comment of 3 [words])"
    assert program.line_of(executed.index(b"X15 Y3") + 1) == 10
    path = program.path
    assert np.allclose(path.end[-1][:3], [20.0, 3.0, 50.0])
    broken = PROGRAM.replace(b"I17.5", b"I7.5")
    with pytest.raises(gx.InputError) as error:
        _ = gx.read(broken, "fagor").path
    (found,) = error.value.diagnostics
    assert (found.where.line, found.where.text) == (11, "G6 G2 X20 Y3 I7.5 J3")
    where = gx.Location("-", executed.index(b"X15 Y3") + 1, 1, "X15 Y3", 6)
    told = program.located(gx.InputError((gx.Diagnostic("GX301", "somehow", where),)))
    place = told.diagnostics[0].where
    assert (place.line, place.column, place.text) == (10, 4, "   X5I Y3I")


def test_programs_of_several_windows_and_workers(place):
    """Over a megabyte other processes read and prove; lines stay those of the program."""
    rng = np.random.default_rng(3)
    lines = ["G71 G90 G17 G94 G54", "G0 X0 Y0 Z0", "G1 F500"]
    for x, y, z in rng.uniform(-99.0, 99.0, (60_000, 3)):
        lines.append(f"; {x:.0f}" if x < -98.9 else f"X{x:.3f} Y{y:.3f} Z{z:.3f}")
    text = ("\n".join([*lines, "M30"]) + "\n").encode()
    (place / "long.nc").write_bytes(text)
    found = written("long.nc", "-o", "o.nc", "--map", "map")
    assert found.exit_code == 0, found.output
    out = (place / "o.nc").read_text().split("\n")
    source = expanded(json.loads((place / "map").read_text())["lines"])
    for k in (3, 30_000, 60_002):
        words = {w[0]: float(w[1:]) for w in lines[source[k]].split() if w[0] in "XYZ"}
        assert words == {w[0]: float(w[1:]) for w in out[k].split() if w[0] in "XYZ"}
    lines[50_000] = "X1 X2"
    (place / "long.nc").write_text("\n".join([*lines, "M30"]) + "\n")
    found = written("long.nc").output
    assert "long.nc:50001:1: error[GX203]" in found
    assert "50001 | X1 X2" in found
