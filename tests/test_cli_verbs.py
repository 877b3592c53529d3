"""`check`, `compare`, `info`, `list`, `explain` and `schema`."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from cli_kit import ABSOLUTE, COMPENSATED, call, workplace

from gcxform.modal.meaning.tables import FAMILIES, NUMBER, code_of
from gcxform.syntax.source import WINDOW

EXAMPLES = Path(__file__).parents[1] / "examples"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return workplace(tmp_path, monkeypatch)


# --- check ---


def test_check_shows_the_chain(here: Path) -> None:
    found = call("check", "-x", COMPENSATED, "-f", "linuxcnc")
    assert found.exit_code == 0, found.stderr
    for word in ("1      absolute", "ensures  COMPENSATED", "promise  1 um", "rounding", "budget"):
        assert word in found.stdout


def test_check_counts_findings(here: Path) -> None:
    assert "no findings" in call("check", "-p", "job.toml", "part.nc").stdout
    (here / "two.nc").write_bytes(b"G0 G1 X0\nG99.9\nM2\n")
    found = call("check", "-f", "linuxcnc", "two.nc")
    assert found.exit_code == 1
    assert "3 lines, 2 findings" in found.stdout
    assert "two.nc:1:4: error[GX202]" in found.stderr
    assert "two.nc:2:1: error[GX201]" in found.stderr


def test_check_says_what_a_program_looks_like_where_nobody_does(here: Path) -> None:
    """A program that asks gets no guess: it is told what to say."""
    (here / "two.nc").write_bytes(b"G21 G90 G17 G64 P0.1\nG0 X1\nM2\n")
    found = call("check", "two.nc")
    assert found.exit_code == 0, found.stderr
    assert "read as linuxcnc, since it looks like linuxcnc" in found.stderr
    for words in (("check", "--json", "two.nc"), ("run", "two.nc")):
        refused = call(*words)
        assert refused.exit_code == 2
        assert "GX726" in refused.output
        assert "-x absolute -f linuxcnc" in refused.output
    for words in (("run", "-x", "absolute", "two.nc"), ("post", "-x", "absolute", "two.nc")):
        refused = call(*words)
        assert (refused.exit_code, "GX722" in refused.stderr) == (2, True)
        assert "two.nc looks like linuxcnc" in refused.stderr
        assert "; -f linuxcnc; " in refused.stderr


def test_check_says_why_nothing_is_guessed(here: Path) -> None:
    (here / "empty.nc").write_bytes(b"")
    (here / "wide.nc").write_bytes("G21 G90\n".encode("utf-16"))
    for name, code, why in (
        ("none.nc", 5, "cannot read none.nc"),
        ("empty.nc", 2, "empty.nc looks like a program in no dialect"),
        ("wide.nc", 5, "it is UTF-16"),
    ):
        found = call("check", name)
        assert (found.exit_code, why in found.stderr) == (code, True), found.stderr


def test_check_says_of_a_program_in_another_dialect_what_it_looks_like(here: Path) -> None:
    (here / "mill.nc").write_bytes(b"%\nO01234\nN5 G00 G17 G90\nN10 G53 Z0.\nN15 T7 M06\nM30\n%\n")
    found = call("check", "-f", "grbl", "mill.nc")
    assert found.exit_code == 1
    assert "read as grbl, and it looks like haas" in found.stdout
    (here / "mill.nc").write_bytes(b"%\nO01234\nN5 G00 G17 G90\nX?\nN10 G53 Z0.\nM30\n%\n")
    found = call("check", "-f", "haas", "mill.nc")
    assert (found.exit_code, "looks like" in found.stdout) == (1, False), found.stdout


@pytest.mark.parametrize(
    ("text", "place"),
    [
        (b"G0 X1\n", ":1:1"),
        (b"%\nG0 X1\n", ":2:1"),
        (b"G0 X1\n%\n", ":2:1"),
        (b"(part)\n%\nG0 X1\n%\n", ":2:1"),
        (b"", ""),
        (b"G0 X1\nM2\n%\n", None),
        (b"\n %\nG0 X1\n%\n", None),
        (b"%\nG0 X1\nM30\n", None),
        (b"%\n%\n", None),
    ],
)
def test_check_asks_linuxcnc_programs_for_an_end(
    here: Path, text: bytes, place: str | None
) -> None:
    (here / "part.nc").write_bytes(text)
    found = call("check", "-f", "linuxcnc", "part.nc")
    assert found.exit_code == (place is not None)
    assert place is None or f"part.nc{place}: error[GX222]" in found.stderr
    assert "GX222" not in call("check", "-f", "fanuc", "part.nc").stderr


@pytest.mark.parametrize("chain", [(), ("-x", "absolute")])
def test_check_finds_where_compensation_stops_the_control(
    here: Path, chain: tuple[str, ...]
) -> None:
    text = "G21 G90 G17 G94 F100\nG0 X0 Y-5 Z0\nG41.1 D%s G1 Y0\nY20\nG40 X90\nM2\n"
    (here / "good.ngc").write_text(text % "9.9")
    (here / "bad.ngc").write_text(text % "50")
    assert call("check", "-f", "linuxcnc", *chain, "good.ngc").exit_code == 0
    found = call("check", "-f", "linuxcnc", *chain, "bad.ngc")
    assert found.exit_code == 1
    assert "bad.ngc:3:1: error[GX350]: the move that begins compensation is 5.0000" in found.stderr


def test_check_finds_what_is_wrong_in_later_windows(here: Path) -> None:
    line = b"G1 F100 X1 (as long as a comment can be, so that a window is soon full)\n"
    text = b"G91.5\n" + line * (2 * WINDOW // len(line)) + b"G17.1\n"
    (here / "long.nc").write_bytes(text)
    found = call("check", "-f", "linuxcnc", "long.nc")
    assert found.exit_code == 1
    assert "GX201" in found.stderr
    assert f"long.nc:{text.count(bytes([10]))}:1: error[GX210]" in found.stderr


def test_check_asks_the_passes(here: Path) -> None:
    chain = "volumetric model=model.toml part-origin=-5,0,0"
    found = call("check", "-x", chain, "-f", "linuxcnc", "part.nc")
    assert (found.exit_code, "GX310" in found.stderr) == (1, True)


# --- compare ---


def test_compare(here: Path) -> None:
    (here / "out.nc").write_bytes(ABSOLUTE)
    (here / "far.nc").write_bytes(ABSOLUTE.replace(b"X10.", b"X10.004"))
    same = call("compare", "-f", "linuxcnc", "part.nc", "out.nc")
    assert (same.exit_code, same.stdout.splitlines()[-1]) == (0, "SAME")
    differs = call("compare", "-f", "linuxcnc", "part.nc", "far.nc")
    assert (differs.exit_code, differs.stdout.splitlines()[-1]) == (1, "DIFFERENT")
    assert "largest deviation 0.004000 mm" in differs.stdout
    near = call("compare", "-f", "linuxcnc", "--tolerance", "5 um", "part.nc", "far.nc")
    assert near.exit_code == 0


def test_compare_dialects_and_places(here: Path) -> None:
    (here / "f.nc").write_bytes(b"G1 F100. X0. Y0. Z0.\nX10000\nG4 X2.\n")
    (here / "l.nc").write_bytes(b"G1 F100 X0 Y0 Z0\nX4\nX10\nG4 P2\n")
    words = ["compare", "-f", "fanuc", "-t", "linuxcnc", "--increment", "1um", "f.nc", "l.nc"]
    assert call(*words).exit_code == 0, call(*words).output
    found = call(*words[:-1], "-", stdin=b"G1 F100 X0 Y0 Z0\nX4 Y50\n")
    assert found.exit_code == 1
    assert "the paths part: line 2 of A, line 2 of B" in found.stdout


def test_compare_through_a_model(here: Path) -> None:
    run = call("run", "-x", COMPENSATED, "-f", "linuxcnc", "-o", "out.nc", "part.nc")
    assert run.exit_code == 0, run.stderr
    plain = ["compare", "-f", "linuxcnc", "part.nc", "out.nc"]
    assert call(*plain).exit_code == 1
    words = [*plain, "--model", "model.toml", "--part-origin", "10,10,10"]
    found = call(*words, "--outside", "extrapolate")
    assert found.exit_code == 0, found.output


def test_compare_with_arcs_that_end_on_a_node_of_the_model() -> None:
    """Where a node and an even cut of an arc meet, nothing is left between them."""
    bracket = EXAMPLES / "bracket"
    words = ["-f", "linuxcnc", "-m", str(bracket / "machine.toml"), "--tolerance", "20um"]
    model = ["--model", str(EXAMPLES / "lddm" / "model.toml")]
    program = str(bracket / "bracket.nc")
    found = call("compare", *words, *model, program, program)
    assert found.exit_code == 0, found.output
    assert "nan" not in found.stdout


def test_compare_refuses_what_it_cannot_read(here: Path) -> None:
    (here / "lost.nc").write_bytes(b"G2 F100 X1 Y1 R3\n")
    assert call("compare", "-f", "linuxcnc", "part.nc", "lost.nc").exit_code == 3


# --- growth ---

BUDGET = """\
format = 1
[input]
dialect = "linuxcnc"
[budget]
growth = {limit}
[[pass]]
use = "absolute"
[[pass]]
use = "segment"
chord-error = "1 um"
max-length = "1 mm"
"""


def test_growth_is_reported_and_bounded(here: Path) -> None:
    """The way of 15 mm becomes pieces of at most 1 mm; the limit itself is still allowed."""
    (here / "job.toml").write_text(BUDGET.format(limit=1000.0))
    run = call("run", "-p", "job.toml", "-o", "out.nc", "--certificate", "c.json", "part.nc")
    assert run.exit_code == 0, run.stderr
    written = len((here / "out.nc").read_bytes().splitlines())
    told = json.loads((here / "c.json").read_text())["growth"]
    assert told == {"blocks_in": 6, "blocks_out": written, "ratio": written / 6, "limit": 1000.0}
    assert written > 20
    assert f"6 -> {written} blocks (x {written / 6:.3g})" in run.stderr
    assert "growth    1000 blocks for each one read" in call("check", "-p", "job.toml").stdout
    (here / "out.nc").unlink()
    for limit, code in ((written / 6, 0), (written / 6 - 0.001, 3)):
        (here / "job.toml").write_text(BUDGET.format(limit=limit))
        run = call("run", "-p", "job.toml", "-o", "out.nc", "part.nc")
        assert run.exit_code == code, run.stderr
        assert (here / "out.nc").exists() is (code == 0)
        (here / "out.nc").unlink(missing_ok=True)
    assert "GX507" in run.stderr
    assert f"6 blocks became {written}" in run.stderr


def test_growth_without_a_limit_and_of_nothing(here: Path) -> None:
    empty = call("run", "-x", "absolute", "-f", "linuxcnc", "-o", "out.nc", "-", stdin=b"")
    assert empty.exit_code == 0
    assert "0 -> 0 blocks   absolute" in empty.stderr
    assert "the file is empty: it holds no block" in empty.stderr


def test_a_program_in_which_nothing_moves_is_said_to_be_one(here: Path) -> None:
    for text, nothing in ((b"(T1)\nM2\n", True), (b"G21 G90 G0 X1\nM2\n", False)):
        done = call("run", "-x", "absolute", "-f", "linuxcnc", "-o", "out.nc", "-", stdin=text)
        assert done.exit_code == 0
        assert ("no block of it moves an axis" in done.stderr) is nothing
    (here / "empty.nc").write_bytes(b"")
    found = call("check", "-f", "linuxcnc", "empty.nc")
    assert "empty.nc: the file is empty, " in found.stdout


# --- info ---


def test_info_of_words(here: Path) -> None:
    found = json.loads(call("info", "--json", "part.nc").stdout)
    assert found["lines"] == 6
    assert found["line_ends"] == {"CRLF": 6}
    assert found["codes"] == {"G1": 1, "G17": 1, "G21": 1, "G90": 2, "G91": 1, "M30": 1}
    assert found["letters"]["X"] == 3
    assert "dialect" not in found
    assert set(found["guessed"]) == {"grbl", "linuxcnc"}
    assert "guess  grbl or linuxcnc (nothing speaks against it)" in call("info", "part.nc").stdout


def test_info_of_meaning(here: Path) -> None:
    text = b"T3 M6\nG0 X0 Y0 Z5\nG1 F100 Z0\nG2 X0 Y0 I5 J0\nG4 P1\nG38.2 X0\nM2\n"
    (here / "p.nc").write_bytes(text)
    words = ["info", "-f", "linuxcnc", "p.nc"]
    found = json.loads(call(*words, "--json").stdout)
    assert found["moves"] == {"rapids": 1, "lines": 1, "arcs cw": 1}
    assert found["extents"] == {"X": [0.0, 10.0], "Y": [-5.0, 5.0], "Z": [0.0, 5.0]}
    assert found["length_mm"]["feed"] == pytest.approx(5 + 31.416, abs=1e-3)
    tool = found["tools"]["T3"]
    assert (tool["moves"], tool["feed"], tool["extents"]["Z"]) == (3, [100, 100], [0, 5])
    assert found["time_s"]["feed"] == pytest.approx((5 + 10 * math.pi) / 100 * 60, abs=1e-3)
    assert (found["time_s"]["dwell"], found["time_without"]) == (1.0, {"rapid moves": 1})
    assert found["features"] == ["arcs", "full circles", "probing (G38.2)"]
    assert found["refused"] == 1
    assert found["first_refused"]["6"].startswith("GX216")
    shown = call(*words).stdout
    assert "arcs cw 1" in shown
    assert "T3  3 moves" in shown
    assert "line 6: GX216" in shown


@pytest.mark.parametrize(
    "text",
    [b"", b"\n", b"\0" * 50, bytes(range(256)) * 300, b"\r\r\n\r", b"G1 X" * 900, b"%\n%\n%"],
)
@pytest.mark.parametrize("dialect", ["", "fanuc", "haas", "linuxcnc", "grbl"])
def test_info_of_anything(here: Path, text: bytes, dialect: str) -> None:
    found = call("info", *(["-f", dialect] if dialect else []), "--json", "-", stdin=text)
    assert found.exit_code == 0, found.output
    report = json.loads(found.stdout)
    assert report["bytes"] == len(text)
    assert report.get("refused", 0) <= report["lines"]


# --- list, explain, schema ---


def test_lists() -> None:
    for kind, name in (
        ("passes", "segment"),
        ("dialects", "grbl"),
        ("formats", "lddm"),
        ("controls", "fanuc"),
    ):
        found = call("list", kind)
        assert found.exit_code == 0
        (line,) = [line for line in found.stdout.splitlines() if line.startswith(f"{name} ")]
        assert line.rstrip()[-1].isdigit()
        assert call("list", kind, name).stdout.startswith(name)
    assert call("list", "kinematics").exit_code == 0
    assert "chord-error" in call("list", "passes", "segment").stdout
    assert "did you mean 'segment'" in call("list", "passes", "segmnt").stderr


def test_explain_a_code() -> None:
    for name in ("GX301", "gx301", "301"):
        assert call("explain", name).stdout.startswith("GX301: The end of an arc")
    assert "did you mean" in call("explain", "GX391").stderr


def test_explain_a_block(here: Path) -> None:
    (here / "p.nc").write_bytes(b"M72\nG1 F100 X0 Y0 Z0\nN7 G2 X10 I5 M8 (so)\nM2\n")
    found = call("explain", "-f", "linuxcnc", "p.nc:3").stdout
    for words in (
        "word X, number 10",
        "comment (so)",
        "modal G1 G17 G90 G91.1 G94 G21 G54 G40, F 100",
        "X0 Y0 Z0",
        "first line 1",
        "clockwise arc at 100 mm/min",
        "radius 5 mm, in the plane XY",
        "through 180 degrees",
        "M8",
    ):
        assert words in found
    assert "refused [GX210]" in call("explain", "-f", "linuxcnc", "p.nc:1").stdout
    (here / "end.nc").write_bytes(b"M2\nX5\n(so)\n")
    assert "the program has ended" in call("explain", "-f", "linuxcnc", "end.nc:2").stdout
    assert "moves nothing" in call("explain", "-f", "grbl", "end.nc:3").stdout


def test_explain_follows_a_call_into_another_file(here: Path) -> None:
    (here / "O100.nc").write_bytes(b"O100\nG1 Z-1. F100.\nX5.\nM99\n")
    text = b"%\nO1\nG21 G90 G94 G17 G54\nG0 X0. Y0. Z5.\nM98 P100\nG0 Z5.\nM30\n%\n"
    (here / "main.nc").write_bytes(text)
    at_call = call("explain", "-f", "fanuc", "main.nc:5").stdout
    assert "O100.nc:2  G1 Z-1. F100." in at_call
    assert "refused" not in at_call
    assert "to   X5 Y0 Z-1" in at_call
    behind = call("explain", "-f", "fanuc", "main.nc:6").stdout
    assert "modal G1 G17 G90 G91.1 G94 G21 G54 G40, F 100" in behind
    assert "from X5 Y0 Z-1" in behind
    assert "no line 99" in call("explain", "-f", "fanuc", "main.nc:99").stderr


def test_explain_says_what_a_round_of_a_loop_does_first(here: Path) -> None:
    text = b"G21 G90 G94 G0 X0 Y0 Z0\n#1=0\no1 while [#1 LT 3]\n#1=[#1+1]\nX#1\no1 endwhile\nM2\n"
    (here / "p.ngc").write_bytes(text)
    assert "to   X1 Y0 Z0" in call("explain", "-f", "linuxcnc", "p.ngc:5").stdout
    assert "at    X3 Y0 Z0" in call("explain", "-f", "linuxcnc", "p.ngc:7").stdout


@pytest.mark.parametrize(
    ("block", "code"),
    [
        ("G33 Z-5 K1", "G33"),
        ("G5 X1 Y1 I1 J0 P0 Q-1", "G80"),
        ("G5.1 X5 Y5 I1 J1", "G80"),
        ("G81 X1 Z-1 R1", "G81"),
        ("G18 G3 X2 I1 K0", "G3 G18"),
        ("G38.2 X3", "G38.2"),
        ("G0 G55 G90.1 G20 G95 X0 Y0 Z0", "G0 G17 G90 G90.1 G95 G20 G55"),
    ],
)
def test_explain_names_any_code_in_force(here: Path, block: str, code: str) -> None:
    head = "G21 G90 G94 G17\nS100 M3\nG0 X0 Y0 Z0\nF100\n"
    (here / "p.nc").write_text(f"{head}{block}\nM8\nM2\n")
    found = call("explain", "-f", "linuxcnc", "p.nc:6")
    assert (found.exit_code, found.stderr) == (0, "")
    assert f"modal {code} " in found.stdout


def test_every_number_of_a_group_has_its_code() -> None:
    for group, codes in FAMILIES.items():
        assert [code_of(group, NUMBER[code]) for code in codes] == list(codes)


@pytest.mark.parametrize("kind", ["pipeline", "machine", "model"])
def test_schemas(kind: str) -> None:
    assert json.loads(call("schema", kind).stdout)


def test_compare_names_a_place_that_one_program_keeps_to_itself(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("a.nc").write_text("G0 X1 Y1\nG0 Z5\nG1 F100 X10\nM2\n")
    Path("b.nc").write_text("G0 X1 Y1 Z50\nG0 Z5\nG1 F100 X10\nM2\n")
    words = ("compare", "-f", "linuxcnc", "a.nc", "b.nc")
    done = call(*words)
    assert done.exit_code == 1
    assert "only B says where Z is (line 1 of A, 1 of B): not compared there\n" in done.stdout
    assert "largest deviation 0.000000 mm" in done.stdout
    assert call(*words, "--start", "Z=50").stdout.endswith("SAME\n")


# --- explain ---


def test_only_the_line_that_calls_tells_what_another_file_does(here: Path) -> None:
    (here / "sub.ngc").write_bytes(b"o<sub> sub\nG1 X[#1] F100\no<sub> endsub\nM2\n")
    loop = b"o100 repeat [3]\nG91 G1 X1\no100 endrepeat\nM2\n"
    (here / "main.ngc").write_bytes(b"G90 G21 G94\nG0 X0 Y0 Z0\no<sub> call [5]\n" + loop)
    told = [call("explain", "-f", "linuxcnc", f"main.ngc:{n}").stdout for n in range(1, 8)]
    assert ["runs sub.ngc:2" in each for each in told] == [n == 3 for n in range(1, 8)]
    assert "at    X5 " in told[3]
