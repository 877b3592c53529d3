"""The reference interpreter against LinuxCNC's own, and the strategies against both."""

import contextlib
import json
import math
import random
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from oracles import rs274
from oracles.compare import difference
from properties.contours import contour
from properties.test_whole import drawn as whole
from reference.interpreter import Move, Program, Refused, interpret
from reference.words import blocks
from seeds_kit import DRAWN

from gcxform.testing.generate import Options, program
from gcxform.testing.strategies import lines_of_bytes, programs

FACTS = Path(__file__).parents[2] / "shared" / "dialect-facts"
ZERO = dict.fromkeys("XYZABC", 0.0)
COUNT = 20 * DRAWN
CHUNK = 2000
OTHERS = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
INSERTS = """X1 Y Z- A5 G0 G1 G2 G3 G4 G17 G18 G91 G90 G93 G94 G95 G20 G21 G80 G90.1 G91.1 F0 F-1
F5 I1 J K2 R5 R-5 R0 P2 P0 P1.5 M3 M5 M0 M9 M2 M6 M7 M8 M60 S0 S-1 T1.5 T-1 N5 (c) ; ( ) / % O5 .
- + 1 E1 D1 H1 Q1 L1 $ ,"""
installed = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def interpreted(source: bytes, dialect: str, **options: object) -> Program | Refused:
    """Return the program, or the refusal."""
    try:
        return interpret(source, dialect, **options)  # type: ignore[arg-type]
    except Refused as refusal:
        return refusal


def reference(source: bytes) -> Program | Refused:
    """Interpret as `rs274` does: from zero, with equal work offsets."""
    return interpreted(source, "linuxcnc", start=ZERO, same_frames=True)


def drawn(seed: int, **options: object) -> bytes:
    return program(random.Random(seed).randint, Options(**options))  # type: ignore[arg-type]


def disagreement(source: bytes, theirs: rs274.CanonProgram | rs274.Rejected) -> str | None:
    """Say how reference and LinuxCNC differ: what is refused and on which line, or what moves."""
    ours = reference(source)
    if isinstance(ours, Refused) != isinstance(theirs, rs274.Rejected):
        return f"{ours} / {theirs}"
    if isinstance(theirs, rs274.Rejected):
        return None if ours.line == theirs.line else f"{ours} / {theirs}"
    return difference(ours, theirs)


def assert_agreement(sources: list[bytes]) -> None:
    for source, theirs in zip(sources, rs274.run_many(sources), strict=True):
        if problem := disagreement(source, theirs):
            pytest.fail(f"{problem}\n{source.decode('latin-1')}")


@installed
def test_generated_programs_do_what_linuxcnc_says() -> None:
    for start in range(0, COUNT, CHUNK):
        sources = [drawn(seed) for seed in range(start, min(start + CHUNK, COUNT))]
        accepted = rs274.run_many(sources)
        assert not [answer for answer in accepted if isinstance(answer, rs274.Rejected)]
        for source, theirs in zip(sources, accepted, strict=True):
            assert disagreement(source, theirs) is None, source.decode("latin-1")


@installed
def test_damaged_programs_are_refused_on_the_same_line() -> None:
    sources = [damaged(seed) for seed in range(COUNT // 4)]
    refused = 0
    for source, theirs in zip(sources, rs274.run_many(sources), strict=True):
        ours = reference(source)
        message = getattr(theirs, "message", "")
        if "not found in the tool table" in message or "not in this language" in str(ours):
            continue
        refused += bool(message)
        assert disagreement(source, theirs) is None, source.decode("latin-1")
    assert refused > COUNT // 10


def damaged(seed: int) -> bytes:
    """Return a short generated program with one or two lines spoilt, but not its last one."""
    choose, inserts = random.Random(seed), [*INSERTS.split(), " ", "\t"]
    lines = drawn(seed, max_blocks=8).decode("latin-1").split("\n")
    for _ in range(choose.randint(1, 2)):
        index = choose.randrange(len(lines) - 2)
        line, word = lines[index], choose.choice(inserts)
        at = choose.randint(0, len(line))
        lines[index] = choose.choice(
            (
                line[:at] + word + line[at:],
                line[:at] + line[at + 1 :],
                f"{word} {line}",
                f"{line.rstrip()} {word}",
                line[:at] + choose.choice("GMXYZIJKRFPS0123456789.-") + line[at + 1 :],
            )
        )
    return "\n".join(lines).encode("latin-1")


@installed
@given(source=programs(max_blocks=12))
@OTHERS
def test_hypothesis_finds_no_disagreement(source: bytes) -> None:
    assert_agreement([source])


@installed
def test_linuxcnc_is_asked_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What it answered is kept by digest, that of other text or of another version is not."""
    monkeypatch.setattr(rs274, "KEPT", tmp_path / "answers")
    monkeypatch.setattr(rs274, "KEEPS", True)
    sources = [drawn(1), damaged(7), b"G1 F1 X1 (\xe9)\nM2\n"]
    before = rs274.run_many(sources)
    with monkeypatch.context() as blind:
        blind.setattr(rs274, "_asked", lambda source: pytest.fail("it was asked again"))
        for one, other in zip(before, rs274.run_many(sources), strict=True):
            assert vars(one) == vars(other)
        with pytest.raises(pytest.fail.Exception):
            rs274.run_many([drawn(2)])
        blind.setattr(rs274, "_version", lambda: b"another")
        with pytest.raises(pytest.fail.Exception):
            rs274.run_many([drawn(1)])


@installed
def test_many_programs_in_one_process_answer_as_each_alone() -> None:
    sources = [drawn(seed) for seed in range(20)] + [damaged(seed) for seed in range(20)]
    sources += [contour(seed) for seed in range(20)] + [whole(seed) for seed in range(20)]
    for source, together in zip(sources, rs274.run_many(sources), strict=True):
        if isinstance(together, rs274.CanonProgram):
            assert rs274.run(source) == together
            continue
        with pytest.raises(rs274.Rejected) as caught:
            rs274.run(source)
        assert vars(caught.value) == vars(together)


@installed
@pytest.mark.parametrize(
    "change",
    [
        lambda move: replace(move, end=move.end | {"Y": move.end["Y"] + 0.001}),
        lambda move: replace(move, end=move.end | {"A": move.end["A"] - 0.001}),
        lambda move: replace(move, kind="ARC_CCW"),
        lambda move: replace(move, plane="ZX"),
        lambda move: replace(move, turns=1),
        lambda move: replace(move, centre=(5.0, 0.001, 0.0)),
        lambda move: replace(move, sweep=3 * math.pi),
        lambda move: replace(move, feed=99.0),
        lambda move: replace(move, feed_mode="G93"),
        lambda move: replace(move, line=2),
    ],
)
def test_the_comparison_sees_every_field(change: object) -> None:
    source = b"G21 G90 G17 G94 G2 X10 Y0 A5 I5 J0 F100\nM2\n"
    right, canon = reference(source), rs274.run(source)
    assert difference(right, canon) is None
    wrong = Program([change(right.moves[0])], right.events)  # type: ignore[operator]
    assert difference(wrong, canon) is not None
    assert difference(Program(right.moves, [(0, "M2")]), canon) is not None


@pytest.mark.parametrize("dialect", ["linuxcnc", "fanuc", "haas", "grbl"])
def test_strategies_are_valid_and_know_their_positions(dialect: str) -> None:
    @given(source=programs(dialect))
    @OTHERS
    def check(source: bytes) -> None:
        moves = interpret(source, dialect).moves
        axes = {"X", "Y", "Z"} if dialect == "grbl" else set("XYZABC")
        assert all(set(move.end) == axes for move in moves)

    check()


@pytest.mark.parametrize("dialect", ["linuxcnc", "fanuc", "haas", "grbl"])
def test_generated_programs_use_the_whole_language(dialect: str) -> None:
    sources = [drawn(seed, dialect=dialect) for seed in range(400)]
    moves = [move for source in sources for move in interpret(source, dialect).moves]
    kinds = {(m.kind, m.plane, m.feed_mode) for m in moves if m.feed is not None}
    modes = ["G93", "G94"] if dialect == "grbl" else ["G93", "G94", "G95"]
    for mode in modes:
        for plane in ("XY", "ZX", "YZ"):
            assert {("LINE", plane, mode), ("ARC_CW", plane, mode)} <= kinds
            assert ("ARC_CCW", plane, mode) in kinds
    assert any(m.turns for m in moves) == (dialect == "linuxcnc")
    assert any(abs(m.sweep - math.tau) < 1e-9 for m in moves)
    for code in (b"G20", b"G91", b"R-", b"T"):
        assert any(code in source for source in sources)


@pytest.mark.parametrize(
    ("off", "words"),
    [
        ("arcs", {"G2", "G3", "R", "I", "G90.1"}),
        ("incremental", {"G91"}),
        ("inches", {"G20"}),
        ("rotary", {"A", "B", "C"}),
        ("feed_modes", {"G93", "G95"}),
        ("planes", {"G18", "G19"}),
    ],
)
def test_a_part_of_the_language_can_be_left_out(off: str, words: set[str]) -> None:
    without, with_it = (
        set().union(*(words_of(drawn(seed, **{off: wanted})) for seed in range(200)))
        for wanted in (False, True)
    )
    assert not words & without
    assert words <= with_it


def words_of(source: bytes) -> set[str]:
    """Return the letters of a program, and its letters with their numbers."""
    words = []
    with contextlib.suppress(Refused):  # what comes behind the end of the program
        for block in blocks(source, "linuxcnc"):
            words += block.words
    return {f"{w.letter}{w.value:g}" for w in words} | {w.letter for w in words}


@given(source=lines_of_bytes())
@OTHERS
def test_arbitrary_bytes_are_interpreted_or_refused(source: bytes) -> None:
    for dialect in ("linuxcnc", "fanuc", "haas", "grbl"):
        answer = interpreted(source, dialect)
        if isinstance(answer, Refused):
            assert 0 <= answer.line <= source.count(b"\n") + 1
        else:
            assert all(isinstance(move, Move) for move in answer.moves)


# --- one fact, one program ------------------------------------------------------------------

OUTSIDE = ("not in this language", "'#", "sub'", "x#<")  # parameters, subroutines, other codes
FACT_FILES = sorted(FACTS.glob("lcnc_*.json"))


@pytest.mark.skipif(not FACT_FILES, reason="the collection of dialect facts is absent")
def test_facts_about_linuxcnc() -> None:
    inside = [path.stem for path in FACT_FILES if check_fact(path)]
    assert len(inside) >= 30, inside


def check_fact(path: Path) -> bool:
    """Check one fact; return False if its program needs more than this language."""
    fact = json.loads(path.read_text())
    source = (path.parent / fact["file"]).read_bytes()
    ours = reference(source)
    if isinstance(ours, Refused):
        if any(mark in ours.reason for mark in OUTSIDE):
            return False
        refused_line = source.decode("latin-1").split("\n")[ours.line - 1]
        assert fact["expect"] == "refuse", (path.stem, ours)
        assert refused_line.strip().startswith(fact["rs274_error"][1].strip()), path.stem
        moves = ours.partial.moves  # type: ignore[attr-defined]
    else:
        assert fact["expect"] == "ok", path.stem
        moves = ours.moves
    wanted = [m for m in fact.get("motions", ()) if m["type"] in ("rapid", "feed", "arc")]
    got = [m for m in moves if m.start != m.end or m.centre]
    wanted = without_repeats(wanted)
    assert len(got) == len(wanted), path.stem
    for move, expected in zip(got, wanted, strict=True):
        check_motion(move, expected, path.stem)
    return True


def without_repeats(motions: list[dict]) -> list[dict]:
    """Drop lines and rapids that end where they start (G1 alone is one for LinuxCNC)."""
    kept, at = [], ZERO
    for motion in motions:
        if motion["type"] == "arc" or motion["end"] != at:
            kept.append(motion)
        at = motion["end"]
    return kept


def check_motion(move: Move, expected: dict, name: str) -> None:
    kinds = {"rapid": "RAPID", "feed": "LINE", "arc": f"ARC_{expected.get('sense', '').upper()}"}
    assert move.kind == kinds[expected["type"]], name
    assert move.end == pytest.approx(expected["end"], abs=1e-4), name
    if "F" in expected and move.feed_mode != "G93":
        assert move.feed == pytest.approx(expected["F"], abs=1e-4), name
    if expected["type"] == "arc":
        assert move.centre is not None
        centre = dict(zip("XYZ", move.centre, strict=True))
        plane = {axis: centre[axis] for axis in expected["center"]}
        assert plane == pytest.approx(expected["center"], abs=1e-4), name
        assert move.turns == expected["turns"] - 1, name
        assert set(move.plane) == set(expected["plane"]), name
