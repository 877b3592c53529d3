"""`gcxform resume`: prefix and line N on do what preamble and line N on do, or it is refused."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from random import Random
from typing import Any

import pytest
from cli_kit import call
from oracles import rs274
from oracles.canon import CanonProgram
from reference.interpreter import Move, interpret
from seeds_kit import DRAWN

import gcxform as gx
from gcxform import vocabulary as v
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.resume.restart import Restart
from gcxform.syntax.source import Source
from gcxform.testing.generate import Options, program

NAMES = ("fanuc", "grbl", "haas", "linuxcnc")
CLEAR = "2000"
PROGRAMS = min(DRAWN // 5, 15)
CLOSE = 2e-6  # mm, degrees


def restarted(folder: Path, text: bytes, dialect: str, line: int) -> tuple[bytes, int] | None:
    """Return preamble and rest, and the line in it that is the line; None if it is refused."""
    (folder / "p.nc").write_bytes(text)
    words = ["resume", "-f", dialect, "--line", str(line), "--rest"]
    words += ["--clearance", CLEAR, "--plunge", "100"]
    found = call(*words, str(folder / "p.nc"))
    if found.exit_code == 3:
        codes = ("GX732", "GX207", "GX208")  # unsafe, or refused by any reading
        assert any(code in found.stderr for code in codes), found.stderr
        assert found.stdout == ""
        return None
    assert found.exit_code == 0, (found.stderr, text, line)
    out = found.stdout_bytes
    rest = text.split(b"\n")[line - 1 :]
    assert out.split(b"\n")[-len(rest) :] == rest
    return out, len(out.split(b"\n")) - len(rest) + 1


def drawn(name: str, seed: int) -> bytes:
    return program(Random(seed).randint, Options(name, max_blocks=22))


def from_line(moves: list[Any], line: int) -> list[Any]:
    return [move for move in moves if move.line >= line]


def switched(text: bytes, dialect: str) -> dict[str, Any]:
    """Return what is switched on at the end of a program: speed, direction, coolant, tool."""
    found: dict[str, Any] = {"coolant": frozenset()}
    for _, what in interpret(text, dialect).events:
        if what[0] in "ST":
            found[what[0]] = what
        elif what in ("M3", "M4", "M5"):
            found["spindle"] = what
        elif what in ("M7", "M8"):
            found["coolant"] |= {what}
        elif what == "M9":
            found["coolant"] = frozenset()
        elif what == "M6":
            found["loaded"] = found.get("T")
    return found


def alike(mine: Move, other: Move) -> bool:
    same = (mine.kind, mine.plane, mine.feed_mode) == (other.kind, other.plane, other.feed_mode)
    same &= mine.turns == other.turns
    same &= mine.end == pytest.approx(other.end, abs=CLOSE, rel=0)
    same &= (mine.feed or 0.0) == pytest.approx(other.feed or 0.0, rel=1e-6)
    if mine.centre is not None:
        same &= mine.centre == pytest.approx(other.centre, abs=1e-4, rel=0, nan_ok=True)
        same &= mine.sweep == pytest.approx(other.sweep, abs=1e-4)
    return bool(same)


@pytest.mark.parametrize("name", NAMES)
def test_restart_at_every_line(name: str, tmp_path: Path) -> None:
    """The scalar reference, which shares no code with the package, is the judge."""
    counts: Counter[str] = Counter()
    end = b"M2\n" if name == "linuxcnc" else b""
    for seed in range(PROGRAMS):
        text = drawn(name, seed)
        lines = text.split(b"\n")
        whole = interpret(text, name).moves
        for line in range(1, len(lines)):
            made = restarted(tmp_path, text, name, line)
            counts["safe" if made else "refused"] += 1
            if made is None:
                continue
            out, first = made
            after = from_line(interpret(out, name).moves, first)
            expected = from_line(whole, line)
            assert len(after) == len(expected), (line, out)
            assert all(alike(a, b) for a, b in zip(after, expected, strict=True)), (line, out)
            before = b"\n".join(lines[: line - 1]) + b"\n" + end
            preamble = b"\n".join(out.split(b"\n")[: first - 1]) + b"\n" + end
            assert switched(preamble, name) == switched(before, name), (line, out)
    assert counts["safe"] > PROGRAMS * (4 if name in ("fanuc", "haas") else 7), counts


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_linuxcnc_restarts_at_every_line(tmp_path: Path) -> None:
    cases = []
    for seed in range(100, 100 + PROGRAMS):
        text = drawn("linuxcnc", seed)
        for line in range(1, text.count(b"\n") + 1):
            if made := restarted(tmp_path, text, "linuxcnc", line):
                cases.append((text, line, *made))
    originals = rs274.run_many([text for text, *_ in cases])
    restarts = rs274.run_many([out for _, _, out, _ in cases])
    assert len(cases) > 6 * PROGRAMS
    for (_, line, out, first), one, other in zip(cases, originals, restarts, strict=True):
        assert isinstance(one, CanonProgram)
        assert isinstance(other, CanonProgram), (other, out)
        expected, after = from_line(one.moves, line), from_line(other.moves, first)
        assert len(after) == len(expected), out
        for mine, theirs in zip(after, expected, strict=True):
            assert (mine.kind, mine.plane, mine.turns) == (theirs.kind, theirs.plane, theirs.turns)
            assert mine.end == pytest.approx(theirs.end, abs=3e-4 * theirs.unit)
            assert mine.feed_mode == theirs.feed_mode
            if mine.kind != "RAPID":
                assert mine.feed == pytest.approx(theirs.feed, rel=1e-3, abs=3e-4 * theirs.unit)


# --- refusals ---

HEAD = "G21 G90 G94 G17\nG0 X0. Y0. Z5.\nG1 Z1. F100.\n"  # three lines


@pytest.mark.parametrize(
    ("dialect", "body", "line", "why"),
    [
        ("linuxcnc", "", 1, "where X, Y, Z stands is not known"),
        ("linuxcnc", "", 2, "where X, Y, Z stands is not known"),
        ("linuxcnc", "G2 X5. I2.5\nX10. I2.5\n", 5, "G2 is in force"),
        ("linuxcnc", "M2\nG1 X1.\n", 5, "has ended"),
        ("linuxcnc", "M64 P1\nX1.\n", 5, "in line 4 M64 switched"),
        ("linuxcnc", "M71\nX1.\n", 5, "in line 4 M71 switched"),
        ("fanuc", "T1 M6\nX1. Y1.\n", 5, "where X, Y, Z stands is not known"),
        ("fanuc", "T1 M6\nX1. Y1.\nZ3.\nX2.\n", 6, "where Z stands is not known"),
        ("fanuc", "M77\nX1. Y1.\n", 5, "M77 switched"),
        ("fanuc", "G68 X0 Y0 R30.\nX1. Y1.\nX2.\n", 6, "in line 4 G68 was in force"),
        ("fanuc", "G52 X1. Y2.\nG52 X0\nX1. Y1.\n", 6, "in line 5 G52 was in force"),
        ("fanuc", "G92 X1.\nG92 X0\nX1. Y1.\n", 6, "in line 4 G92 was in force"),
        ("haas", "G55\nX1. Y1.\n", 5, "where X, Y, Z stands is not known"),
        ("linuxcnc", "G93 G1 X5 F2\nX6 F2\n", 5, "at which feed"),
    ],
)
def test_where_no_restart_is_safe(
    tmp_path: Path, dialect: str, body: str, line: int, why: str
) -> None:
    (tmp_path / "p.nc").write_text(HEAD + body)
    words = ["resume", "-f", dialect, "--line", str(line), "--clearance", "50mm"]
    found = call(*words, str(tmp_path / "p.nc"))
    assert (found.exit_code, found.stdout) == (3, "")
    assert "GX732" in found.stderr
    assert why in found.stderr


def test_no_restart_behind_a_program_of_the_machine(tmp_path: Path) -> None:
    (tmp_path / "p.nc").write_text(HEAD + "M100 P1\nX1. Y1. Z1.\n")
    words = ["resume", "-f", "linuxcnc", "--line", "5", "--clearance", "50mm"]
    found = call(*words, str(tmp_path / "p.nc"))
    assert (found.exit_code, found.stdout) == (3, "")
    assert "p.nc:4:1: error[GX214]: M100" in found.stderr


@pytest.mark.parametrize("dialect", NAMES)
@pytest.mark.parametrize("block", ["G92 X0", "G10 L2 P1 X1.", "G53 G0 Z0.", "G28", "G43 H1"])
def test_what_is_not_read_before_the_line_is_refused(
    tmp_path: Path, dialect: str, block: str
) -> None:
    """Whatever such a block comes to mean, it must not be passed over in silence."""
    (tmp_path / "p.nc").write_text(f"{HEAD}{block}\nX1.\nX2.\nM30\n")
    words = ["resume", "-f", dialect, "--line", "6", "--clearance", "50mm"]
    found = call(*words, str(tmp_path / "p.nc"))
    if found.exit_code == 0:
        assert block.split()[0] in found.stdout
    else:
        assert found.exit_code == 3
        assert found.stdout == ""


def test_skipped_blocks(tmp_path: Path) -> None:
    (tmp_path / "p.nc").write_text(HEAD + "/X1.\nX2.\nM2\n")
    words = ["resume", "-f", "linuxcnc", "--clearance", "50mm", str(tmp_path / "p.nc")]
    assert "GX211" in call(*words, "--line", "5").stderr
    assert "skipped" in call(*words, "--block-delete", "skip", "--line", "4").stderr
    assert call(*words, "--block-delete", "skip", "--line", "5").exit_code == 0
    assert "G0 X1." in call(*words, "--block-delete", "execute", "--line", "5").stdout
    (tmp_path / "p.nc").write_text(HEAD + "/M8\nX2.\nX3.\nM2\n")
    assert "GX732" in call(*words, "--line", "6").stderr
    assert call(*words, "--block-delete", "execute", "--line", "6").exit_code == 0


COMPENSATED = b"""G21 G90 G17 G94 G40
G0 X0 Y0 Z0
G41.1 D2
G1 X10 Y0 F100
Y20
G40
G1 X0
X5
M2
"""


@pytest.mark.parametrize("line", [6, 7, 8])
def test_compensation_that_is_over_is_not_begun_again(tmp_path: Path, line: int) -> None:
    found = restarted(tmp_path, COMPENSATED, "linuxcnc", line)
    assert (found is None) == (line == 6)  # there it is on
    if found is not None:
        assert b"G41" not in found[0]


def test_a_length_is_added_to_one_that_is_not_known(tmp_path: Path) -> None:
    text = b"G21 G90 G17 G94 G49\nG0 X0 Y0 Z0\nF200\nG43.2 H2\nG1 X-22 Y24\nX5\nM2\n"
    assert restarted(tmp_path, text, "linuxcnc", 4) is not None
    assert restarted(tmp_path, text, "linuxcnc", 5) is None


def test_usage(tmp_path: Path) -> None:
    (tmp_path / "p.nc").write_text(HEAD + "X2.\nM2\n")
    words = ["resume", "-f", "linuxcnc", str(tmp_path / "p.nc")]
    for more, code in (
        (["--line", "9"], "GX731"),
        (["--line", "4", "--rest"], "GX705"),
        (["--line", "4", "--clearance", "x"], "GX708"),
        (["--line", "4", "--clearance", "5", "--plunge", "0"], "GX706"),
    ):
        found = call(*words, *more)
        assert (found.exit_code, found.stdout) == (2, "")
        assert code in found.stderr
    low = call(*words, "--line", "4", "--clearance", "0.5mm")
    assert (low.exit_code, "below Z1" in low.stderr) == (3, True)


@pytest.mark.parametrize(
    ("turned", "ended"),
    [
        ("G68 X1. Y2. R30.", "G69"),
        ("G51.1 X3.", "G50.1 X0"),
        ("G52 X4. Y5.", "G52 X0 Y0"),
    ],
)
def test_words_that_are_turned_no_more_are_restated(
    tmp_path: Path, turned: str, ended: str
) -> None:
    """Its end goes along: the control may have been stopped within."""
    text = f"{HEAD}{turned}\nG0 X1. Y1. Z9.\n{ended}\nX7. Y2. Z3.\nG1 X8. F5.\nM30\n"
    lines = resumed(tmp_path, text, "fanuc", 8, "--clearance", "50")
    assert ended in lines
    assert turned not in lines
    assert lines.index(ended) < lines.index("G0 X7. Y2.") < lines.index("G1 Z3. F100.")


def test_planes_and_tips_have_to_be_left(tmp_path: Path) -> None:
    """In one no restart is safe; behind it G69 is restated, as where a program has it alone."""
    machine = Path(__file__).parents[1] / "examples" / "three-plus-two" / "machine.toml"
    head = HEAD.replace("G17", "G17 G54 G69") + "G0 Z90.\nA0. C0.\n"
    plane = f"{head}G68.2 X0. Y0. Z0. I0. J30. K0.\nG53.1\nX1. Y1. Z5.\nX2.\nG69\nX3. Y3. Z9.\n"
    tip = f"{head}G43.4 H1\nX1. Y1. Z5.\nX2.\nG49\nX3. Y3. Z9.\n"
    for text, inside, behind in ((plane, 9, 12), (tip, 8, 11)):
        (tmp_path / "p.nc").write_text(f"{text}X4.\nM30\n")
        words = ["resume", "-f", "fanuc", "-m", str(machine), "--clearance", "99mm"]
        refused, found = (
            call(*words, "--line", str(line), str(tmp_path / "p.nc")) for line in (inside, behind)
        )
        assert "which is not restated" in refused.stderr
        assert found.exit_code == 0, found.stderr
        assert "G69" in found.stdout.splitlines()
        assert "G68.2" not in found.stdout
        assert "G43.4" not in found.stdout


@pytest.mark.parametrize("dialect", ["fanuc", "grbl", "linuxcnc"])
@pytest.mark.parametrize("placed", ["G54 G55", "G55", "G54"])
@pytest.mark.parametrize("offsets", ["G54 G55", "G55 G54", "G55 G55", "G54 G56"])
def test_positions_count_from_the_offset_that_the_program_states_first(
    tmp_path: Path, dialect: str, placed: str, offsets: str
) -> None:
    """And not from that of the restart, where the machine file has the places of some."""
    first, then = offsets.split()
    places = (
        f"[work-offset.{name}]\nX = {n}.5\nZ = -7.0\n" for n, name in enumerate(placed.split())
    )
    (tmp_path / "machine.toml").write_text("format = 1\n" + "".join(places))
    head = f"G21 G90 G94 G17 {first}\nG0 X1. Y2. Z20.\nG1 F100. X3.\n"
    text = f"{head}{then}\nG90 G0 X8. Y-4. Z10.\nG1 X1.\nG54\nG0 X2. Y2. Z5.\nM2\n"
    words = "--clearance", "90", "-m", str(tmp_path / "machine.toml")
    lines = resumed(tmp_path, text, dialect, 6, *words)
    assert any(line.endswith(f" {then}") for line in lines)
    assert lines[-5:-3] == ["G0 Z90.", "G0 X8. Y-4."]


# --- what it prints ---


def resumed(folder: Path, text: str, dialect: str, line: int, *words: str) -> list[str]:
    (folder / "p.nc").write_text(text)
    found = call("resume", "-f", dialect, "--line", str(line), *words, str(folder / "p.nc"))
    assert found.exit_code == 0, found.stderr
    return found.stdout.splitlines()


def test_blocks_in_their_order(tmp_path: Path) -> None:
    text = (
        "G20 G90 G94 G17 G54\nG64 P0.002\nT2 M6\nT5\nS800 M3\nM7\nM8\nG40 G49\n"
        "G0 X1 Y2 Z3\nG91 G1 Z-1 F5\nG93 X1 F2\nX1 F3\nM2\n"
    )
    found = resumed(tmp_path, text, "linuxcnc", 12, "--clearance", "4in", "--plunge", "254")
    assert found == [
        "(RESTART AT LINE 12)",
        "G20 G17 G90 G94 G40 G54",
        "G64 P0.002",
        "G49",
        "T2 M6",
        "T5",
        "S800 M3",
        "M7",
        "M8",
        "G0 Z4.",
        "G0 X2. Y2.",
        "G1 Z2. F10",
        "G93",
        "G91",
    ]
    loaded = resumed(tmp_path, text, "linuxcnc", 12, "--tool-loaded")
    assert "(T2 MUST BE IN THE SPINDLE)" in loaded
    assert "T2 M6" not in loaded
    assert loaded[-1] == "(THE AXES MUST STAND AT X2. Y2. Z2.)"


def test_a_feed_keeps_the_unit_it_was_given_in(tmp_path: Path) -> None:
    """LinuxCNC keeps 100 mm/min after G20; stating it in inches would round it."""
    text = "G21 G90 G94\nG0 X0 Y0 Z0\nG1 X5 F100\nG20\nX1\nX2\nM2\n"
    found = resumed(tmp_path, text, "linuxcnc", 6, "--clearance", "1in")
    assert found[-4:] == ["G1 Z0. F3.937", "G21", "G94 F100", "G20"]


def test_a_note_says_where_the_proof_ends(tmp_path: Path) -> None:
    (tmp_path / "p.nc").write_text(HEAD + "X1.\nX2.\nM98 P100\nX3.\nM30\n")
    words = ["resume", "-f", "fanuc", "--clearance", "50", str(tmp_path / "p.nc")]
    found = call(*words, "--line", "5")
    assert found.exit_code == 0
    assert "G0 X1." in found.stdout
    assert "compared up to line 5: line 6 is not read (GX210)" in found.stderr
    assert call(*words, "--line", "6").exit_code == 3


@pytest.mark.parametrize("dialect", ["fanuc", "haas"])
def test_a_tool_change_that_moves_axes_needs_a_clearance(tmp_path: Path, dialect: str) -> None:
    (tmp_path / "p.nc").write_text("T1 M6\nG43 H1\n" + HEAD + "X1.\nX2.\nM30\n")
    words = ["resume", "-f", dialect, "--line", "7", str(tmp_path / "p.nc")]
    found = call(*words)
    assert (found.exit_code, found.stdout) == (3, "")
    assert "GX732" in found.stderr
    assert "--clearance" in found.stderr
    assert call(*words, "--clearance", "50").exit_code == 0


def test_the_length_of_the_tool_in_the_spindle_waits_for_the_tool(tmp_path: Path) -> None:
    text = "T1 M6\nG43\n" + HEAD + "X1.\nX2.\nM2\n"
    found = resumed(tmp_path, text, "linuxcnc", 7)
    assert found.index("T1 M6") < found.index("G43")
    assert "G0 G43 Z50." in resumed(tmp_path, text, "linuxcnc", 7, "--clearance", "50")
    loaded = resumed(tmp_path, text, "linuxcnc", 7, "--clearance", "50", "--tool-loaded")
    assert "(T1 MUST BE IN THE SPINDLE)" in loaded
    restart = Restart(
        default_registry().dialect("linuxcnc"), Source.of_bytes(text.encode()), Reading(), 7
    )
    preamble = restart.preamble(None, None, True)
    blocks = [block for block in preamble.blocks() if block != "G43"]
    with pytest.raises(gx.InputError, match="move Z, and to where is not known"):
        restart.prove(preamble, "\n".join([blocks[0], "G43", *blocks[1:], ""]).encode())


def test_parameters_that_a_line_not_read_may_take_are_no_restart(tmp_path: Path) -> None:
    text = HEAD + "#1=5\nX1.\no100 if [#1 gt 2]\nX3.\no100 endif\nM2\n"
    words = ["resume", "-f", "linuxcnc", "--line", "5", "--clearance", "50"]
    (tmp_path / "p.nc").write_text(text)
    found = call(*words, str(tmp_path / "p.nc"))
    assert (found.exit_code, found.stdout) == (3, "")
    assert "line 6, which is not read, may take them" in found.stderr
    (tmp_path / "p.nc").write_text(text.replace("#1=5\n", "\n"))
    assert call(*words, str(tmp_path / "p.nc")).exit_code == 0


def test_a_feed_that_a_line_not_read_may_take_is_no_restart(tmp_path: Path) -> None:
    """Behind G20 nobody knows what F was worth, and the plunge leaves another one in force."""
    text = "G21 G90 G94 G17\nG0 X0 Y0 Z5.\nG1 X3. F100.\nG20\nG0 X1.\nG1 X2.\nM30\n"
    words = ["resume", "-f", "fanuc", "--clearance", "50", "--plunge", "20", str(tmp_path / "p.nc")]
    (tmp_path / "p.nc").write_text(text)
    found = call(*words, "--line", "5")
    assert (found.exit_code, found.stdout) == (3, "")
    assert "line 6, which is not read, may take it" in found.stderr
    assert call(*words, "--line", "4").exit_code == 0  # with F100. in force before G20
    for known in ("G0 X1. F9.", "G0 X1.\nM98 P7"):
        text = text.replace("F100.", "") if "P7" in known else text
        (tmp_path / "p.nc").write_text(text.replace("G1 X3.", "").replace("G0 X1.", known))
        assert call(*words, "--line", "5").exit_code == 0


def test_the_proof_sees_a_wrong_preamble() -> None:
    """Whatever is broken in the text, the comparison must notice."""
    text = b"G21 G90 G94 G17\nG0 X0 Y0 Z5\nG1 Z1 F100\nG91 X1\nX2\nM2\n"
    kind = default_registry().dialect("linuxcnc")
    restart = Restart(kind, Source.of_bytes(text), Reading(), 5)
    preamble = restart.preamble(50.0, None, True)
    good = "".join(f"{block}\n" for block in preamble.blocks())
    for old, new in (
        ("G91", "G90"),
        ("F100\n", "F90\n"),
        ("X1.", "X1.01"),
        ("G94 F", "G93 F"),
        ("G21", "G20"),
        ("Z1.", "Z1.1"),
        ("G17", "G18"),
    ):
        assert old in good
        again = Restart(kind, Source.of_bytes(text), Reading(), 5)
        with pytest.raises(gx.VerificationError):
            again.prove(preamble, good.replace(old, new).encode())
    assert restart.prove(preamble, good.encode()) is None


def test_modal_codes_that_no_preamble_states_are_unsafe() -> None:
    """A dialect may make any code modal: what is not in the tables is refused by name."""

    class Acme(default_registry().dialect("fanuc")):  # type: ignore[misc]
        """A control whose G19.1 and G5 are read, whatever they do."""

        name = "acme"
        codes = {  # noqa: RUF012
            **default_registry().dialect("fanuc").codes,
            "G19.1": gx.Code("plane"),
            "G5": gx.Code("thermal", v.inert("").effect),
        }

    for block, code in (("G19.1", "G19.1"), ("G5", "G5")):
        text = f"{HEAD}{block}\nG1 X1.\nX2.\nM30\n".encode()
        with pytest.raises(gx.InputError, match=f"in line 4 {code} was in force"):
            Restart(Acme, Source.of_bytes(text), Reading(), 6)


@pytest.mark.parametrize(("line", "safe"), [(4, True), (5, False), (6, False), (7, True)])
def test_no_restart_is_safe_behind_a_corner(tmp_path: Path, line: int, safe: bool) -> None:
    text = (
        b"G21 G17 G90 G54 G94 G40 G0 X0 Y0 Z0\nG1 F100.\nX10.\nX50. ,R5.\nY50. ,C3.\nX0\nY0\nM30\n"
    )
    (tmp_path / "p.nc").write_bytes(text)
    found = call("resume", "-f", "fanuc", "--line", str(line), str(tmp_path / "p.nc"))
    assert (found.exit_code == 0) is safe, found.stderr
    assert safe or "ends in a corner" in found.stderr
