"""Times, tools and features of `gcxform info`."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from cli_kit import call

HEAD = "G21 G90 G94 G17\nG0 X0 Y0 Z0 A0\n"
MACHINE = """format = 1
[axis.X]
max-speed = 6000.0
[axis.Y]
max-speed = 3000.0
"""


def info(folder: Path, text: str, *words: str, dialect: str = "linuxcnc") -> dict:
    (folder / "p.nc").write_text(text)
    found = call("info", "-f", dialect, "--json", *words, str(folder / "p.nc"))
    assert found.exit_code == 0, found.stderr
    return json.loads(found.stdout)


@pytest.mark.parametrize(
    ("blocks", "seconds"),
    [
        ("G1 X10 F100", 6.0),
        ("G1 X3 Y4 F100", 3.0),
        ("G20 G1 X1 F254", 6.0),
        ("G93 G1 X10 F2", 30.0),
        ("G93 G1 X10 F2\nX20 F4", 45.0),
        ("S500 M3\nG95 G1 X10 F0.2", 6.0),
        ("G2 X0 Y0 I5 J0 F100", 10 * math.pi / 100 * 60),
        ("G2 X0 Y0 Z3 I5 J0 F100", math.hypot(10 * math.pi, 3) / 100 * 60),
        ("G1 A90 F180", 30.0),
        ("G1 X3 A90 F180", 1.0),
    ],
)
def test_time_of_feed_moves(tmp_path: Path, blocks: str, seconds: float) -> None:
    found = info(tmp_path, f"{HEAD}{blocks}\nM2\n")
    assert found["time_s"]["feed"] == pytest.approx(seconds, abs=1e-3)
    assert "feed moves" not in found["time_without"]


def test_feed_per_turn_needs_the_spindle(tmp_path: Path) -> None:
    found = info(tmp_path, f"{HEAD}G95 G1 X10. F0.2\nM2\n", dialect="fanuc")
    assert found["time_s"]["feed"] == 0
    assert found["time_without"]["feed moves"] == 1


def test_rapids_take_as_long_as_the_slowest_axis(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(MACHINE)
    program = "G21 G90\nG0 X0 Y0\nX100 Y100\nX200\nZ5\nM2\n"
    with_machine = info(tmp_path, program, "-m", str(tmp_path / "m.toml"))
    assert with_machine["time_s"]["rapid"] == pytest.approx(2.0 + 1.0)
    assert with_machine["time_without"] == {"rapid moves": 2}  # the first, and Z has no speed
    assert info(tmp_path, program)["time_without"] == {"rapid moves": 4}


@pytest.mark.parametrize(
    ("dialect", "change"), [("linuxcnc", "M6"), ("grbl", ""), ("haas", "M16"), ("fanuc", "M6")]
)
def test_tools_in_order(tmp_path: Path, dialect: str, change: str) -> None:
    program = (
        f"T7 {change}\nS800 M3\nG0 X0. Y0. Z0.\nG1 X10. F100.\n"
        f"T2 {change}\nS900\nG0 X0. Y0. Z0.\nG1 Y-5. F60.\nM30\n"
    )
    tools = info(tmp_path, "G21 G90 G94\n" + program, dialect=dialect)["tools"]
    assert list(tools) == ["T7", "T2"]
    one, other = tools["T7"], tools["T2"]
    assert (one["feed"], one["speed"], one["extents"]["X"]) == ([100, 100], [800, 800], [0, 10])
    assert (other["feed"], other["speed"], other["extents"]["Y"]) == ([60, 60], [900, 900], [-5, 0])
    assert other["moves"] == 2


def test_a_tool_that_waits_is_not_in_the_spindle(tmp_path: Path) -> None:
    tools = info(tmp_path, f"{HEAD}T1 M6\nT2\nG1 X1 F60\nM6\nG1 X3\nM2\n")["tools"]
    assert [(name, use["seconds"]) for name, use in tools.items() if name != "none"] == [
        ("T1", 1.0),
        ("T2", 2.0),
    ]


def test_a_speed_that_only_the_machine_knows(tmp_path: Path) -> None:
    program = "G21 G90 G54 T3 M6\nS#681 M3\nG1 X9. F90.\nS500\nM30\n"
    assert info(tmp_path, program, dialect="fanuc")["tools"]["T3"]["speed"] == [500, 500]


def test_features(tmp_path: Path) -> None:
    program = f"{HEAD}G91 G20 G55\nG54\nX0 Y0 Z0 A0 G18 G90\nG3 X1 I.5 K0 Y1 F9\nG1 A3\nG81\nM2\n"
    features = info(tmp_path, program)["features"]
    for name in ("arcs in other planes", "helices", "rotary axes", "inch (G20)"):
        assert name in features, features
    assert "work offsets (G54 G55)" in features
    assert "canned cycles (G81)" in features


@pytest.mark.parametrize(
    ("dialect", "word"),
    [
        ("linuxcnc", "P1.5"),
        ("grbl", "P1.5"),
        ("fanuc", "P1500"),
        ("fanuc", "X1.5"),
        ("haas", "P1500"),
        ("haas", "P1.5"),
    ],
)
def test_a_dwell_of_a_second_and_a_half(tmp_path: Path, dialect: str, word: str) -> None:
    found = info(tmp_path, f"G21 G90 G94\nG4 {word}\nM30\n", dialect=dialect)
    assert found["time_s"]["dwell"] == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("program", "guessed", "comments"),
    [
        ("%\nO9004 (ENDS) ;\n(WAITS) ;\n;\n#10000= 2 ;\nG103 P0 ;\nM30 ;\n%\n", "haas", 2),
        ("0 BEGIN PGM P MM\n1 L X+1 R0 FMAX ; TO IT\n2 END PGM P MM\n", "heidenhain", 1),
    ],
)
def test_words_without_a_dialect_are_those_of_the_likeliest(
    tmp_path: Path, program: str, guessed: str, comments: int
) -> None:
    (tmp_path / "p.nc").write_text(program)
    found = json.loads(call("info", "--json", str(tmp_path / "p.nc")).stdout)
    assert found["guessed"] == [guessed]
    assert found.get("not_read", 0) == 0
    assert found["comments"] == comments
