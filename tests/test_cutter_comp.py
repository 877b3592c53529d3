"""Cutter compensation: what is read, what `cutter-comp` makes of it, and whether its proof sees."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from dataclasses import replace
from itertools import accumulate
from pathlib import Path

import numpy as np
import pytest
from oracles import rs274

import gcxform as gx
from gcxform.contract.passes import PassContext
from gcxform.machine.machine import Machine, Tool
from gcxform.pipeline.cutter_comp import whole_stretches
from gcxform.plugin.registry import default_registry
from gcxform.toolpath.path import Toolpath

START = {"X": 0.0, "Y": 0.0, "Z": 0.0}
HEAD = "G21 G90 G17 G94 F200\nG0 X0 Y-10 Z0\n"
TOOLS = {1: Tool(radius=2.0), 2: Tool(radius=0.5)}

# Left of it: an outside corner, a still move, an inside corner at an arc, an outside one, a corner
# that is nearly none, and an inside one of two lines.
CONTOUR = (
    HEAD
    + "G41 D1 G1 X0 Y0\nY20\nZ-1\nX10\nG2 X20 I5\nG1 X30\nY10\nX40 Y9.8\nX50\nY30\n"
    + "G40 X40\nX0\nM2\n"
)


def pipeline(chain: str = "cutter-comp", dialect: str = "linuxcnc") -> gx.Pipeline:
    made = gx.Pipeline.parse(chain, dialect)
    return replace(made, machine=Machine(file=Path("mill.toml"), tools=TOOLS))


def done(program: str, chain: str = "cutter-comp", dialect: str = "linuxcnc") -> list[str]:
    return pipeline(chain, dialect).run(program.encode(), "full").text.decode().splitlines()


def refused(program: str, chain: str = "cutter-comp", dialect: str = "linuxcnc") -> str:
    with pytest.raises(gx.GcxformError) as error:
        done(program, chain, dialect)
    return error.value.diagnostics[0].code


def path_of(program: str, dialect: str = "linuxcnc", **reading: object) -> Toolpath:
    return gx.read(program.encode(), dialect, start=START, tools=TOOLS, **reading).path


# --- reading ---


@pytest.mark.parametrize(
    ("code", "side", "radius"),
    [
        ("G41 D1", 1, 2.0),
        ("G42 D2", -1, 0.5),
        ("G41.1 D3", 1, 1.5),
        ("G42.1 D3", -1, 1.5),
        ("G41.1 D-3", -1, 1.5),
        ("T2 M6\nT1\nG41", 1, 0.5),
        ("T2 M6\nT1 M6\nG42 D0", -1, 2.0),
        ("G20 G41.1 D1", 1, 12.7),
    ],
)
def test_side_and_radius(code: str, side: int, radius: float) -> None:
    path = path_of(f"F100\n{code}\nG1 X90\nX180\nG40 X1\nX2\nM2\n")
    assert path.side.tolist() == [side, side, 0, 0]
    assert path.radius[:2] == pytest.approx([radius, radius])
    assert np.isnan(path.radius[2:]).all()


@pytest.mark.parametrize("code", ["G41 D3", "G41", "T1 M6 G41", "M61 Q1\nG41"])
def test_a_tool_that_is_not_known_has_no_radius(code: str) -> None:
    path = path_of(f"F100\n{code}\nG1 X90\nG40 X1\nM2\n")
    assert path.side.tolist() == [1, 0]
    assert np.isnan(path.radius).all()


def test_an_offset_stays_in_force() -> None:
    path = path_of("F100 D1\nG41 G1 X9.\nD2 X20.\nG40 X30.\nG42 X40.\nG40 D0\nX50.\nM30\n", "fanuc")
    assert path.side.tolist() == [1, 1, 0, -1, 0]
    assert path.radius[[0, 1, 3]].tolist() == [2.0, 0.5, 0.5]


@pytest.mark.parametrize("size", [1, 1 << 20])
def test_compensation_does_not_begin_again_without_a_move(
    size: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", size)
    again = HEAD + "G41 D1 G1 Y0\nY20\nG40\nG4 P1\nG41 D1\nX30\nG40 X40\nM2\n"
    assert refused(again) == "GX230"
    assert done(again.replace("G4 P1", "X-5"))


@pytest.mark.parametrize("size", [1, 20, 60, 200])
def test_windows_make_no_difference(size: int, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = done(CONTOUR + "")
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", size)
    assert done(CONTOUR) == whole


def test_stretches_stay_whole() -> None:
    texts = [b"X1\n", b"g 041 d1\n", b"X2\n", b"G40 (X)\n", b"G4 P1\n", b"Z3\n", b"X9\n"]
    last = b"G42\nG40 X1 Y1\n"
    assert list(whole_stretches(iter([*texts, last]))) == [texts[0], b"".join(texts[1:]), last]
    assert list(whole_stretches(iter(texts[:3]))) == [texts[0], b"".join(texts[1:3])]


LEAVING = """G21 G90 G17 G94 G40 G49
G54 G0 X0. Y-10. Z5.
G1 Z-1. F200
G41 D1 X0. Y10.
X10. Y10.
X10. Y0.
G40
Z5.
G1 X50. Y0.
X100. Y0.
M30
"""


@pytest.mark.parametrize("size", [1, 20, 1 << 20])
def test_the_way_off_a_contour_is_kept_in_every_window(
    size: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", size)
    chain = "segment arcs=split max-length=30mm"
    with pytest.raises(gx.InputError) as error:
        done(LEAVING, chain, "fanuc")
    assert [(each.code, each.where.line) for each in error.value.diagnostics] == [("GX233", 9)]
    short = LEAVING.replace("X50.", "X30.").replace("X100.", "X120.")
    assert "X60." in done(short, chain, "fanuc")


def test_how_a_contour_is_left_along_the_tool_is_not_guessed() -> None:
    chain = "cutter-comp corners=arc entry=own"
    assert refused(LEAVING, chain, "fanuc") == "GX232"
    assert "X10. Z5." in done(LEAVING, "cutter-comp")


# --- the centre path ---


def test_a_contour_of_all_corners() -> None:
    assert done(CONTOUR)[2:] == [
        "G1 X-2. Y0.",
        "Y20",
        "Z-1",
        "G2 X0. Y22. I2. J0.",
        "G1 X8.2918",
        "G2 X21.7082 I6.7082 J-2.",
        "G1 X30",
        "G2 X32. Y20. I0. J-2.",
        "G1 Y11.9604",
        "X40.04 Y11.7996",
        "X48. Y11.8",
        "Y30",
        "G40 X40",
        "X0",
        "M2",
    ]


@pytest.mark.parametrize(
    ("corners", "entry", "lines"),
    [
        ("arc", "own", ["G1 X-2. Y0.", "Y20.", "G2 X0. Y22. I2. J0.", "G1 X30."]),
        ("linear", "own", ["G1 X-2. Y0.", "Y22.", "X30."]),
        ("arc", "next", ["G1 X-2. Y0.", "Y20.", "G2 X0. Y22. I2. J0.", "G1 X30."]),
    ],
)
def test_what_a_machine_is_set_to(corners: str, entry: str, lines: list[str]) -> None:
    program = "G21 G90 G17 G94\nG0 X0. Y-10. Z0. F200\nG41 D1 G1 Y0.\nY20.\nX30.\nG40 X40.\nM30\n"
    chain = f"cutter-comp corners={corners} entry={entry}"
    found = done(program, chain, "fanuc")
    assert found[2 : 2 + len(lines)] == lines


def test_where_the_first_move_ends() -> None:
    program = "G21 G90 G17 G94\nG0 X0. Y-10. Z0. F200\nG41 D1 G1 Y0.\nX30.\nG40 X40.\nM30\n"
    own, other = (
        done(program, f"cutter-comp corners=arc entry={e}", "fanuc") for e in ("own", "next")
    )
    assert own[2:5] == ["G1 X-2. Y0.", "G2 X0. Y2. I2. J0.", "G1 X30."]
    assert other[2:4] == ["G1 Y2.", "X30."]


def test_the_speed_in_inverse_time_is_that_of_the_contour() -> None:
    found = done(HEAD + "G41 D1 G93 G1 Y0 F2\nX10 F2\nG40 X20 F1\nM2\n")
    assert found[2:5] == ["G93 G1 X-2. Y0. F1.961", "G2 X0. Y2. I2. J0. F6.366", "G1 X10. F2"]


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_linuxcnc_cuts_into_a_contour_that_is_refused_here() -> None:
    """It comes down to 0.5 mm above the line at Y0, with a tool of 2 mm."""
    program = "G21 F200\nG0 X0 Y0 Z0\nG41.1 D4 G1 X10\nX20\nY0.5\nY10\nG40 X0\nM2\n"
    moves = rs274.run(program.encode()).moves
    assert any(m.start["Y"] == 2.0 and m.end == m.end | {"X": 18.0, "Y": 0.5} for m in moves)
    assert refused(program) == "GX350"


# --- what passes may not do ---


CUTS = (
    "segment arcs=split max-length=5mm",
    "segment arcs=split arc-step=90deg",
    "segment chord-error=1um",
)


@pytest.mark.parametrize("chain", CUTS)
@pytest.mark.parametrize("dialect", ["linuxcnc", "fanuc"])
def test_a_pass_may_cut_no_contour(chain: str, dialect: str) -> None:
    contour = (
        CONTOUR if dialect == "linuxcnc" else CONTOUR.replace("D1 ", "D1 ").replace("M2", "M30")
    )
    chain_of_points = contour.replace("-10 ", "-10. ")
    assert refused(pointed_numbers(chain_of_points), chain, dialect) == "GX233"


def pointed_numbers(program: str) -> str:
    """Return a program with a point in every distance."""
    return re.sub(r"([XYZI]-?\d+)(?![\d.])", r"\1.", program)


def test_a_pass_that_leaves_the_contour_may_cut_the_rest() -> None:
    found = done(CONTOUR + "", "segment arcs=split max-length=12mm".replace("12", "40"))
    assert found[2].startswith("G41 D1")


# --- the proof ---


def moved(row: int, axis: int, by: float) -> Callable[[Toolpath], Toolpath]:
    def change(path: Toolpath) -> Toolpath:
        end = np.array(path.end)
        end[row, axis] += by
        return path.replace(end=end)

    return change


def column(name: str, row: int, value: object) -> Callable[[Toolpath], Toolpath]:
    def change(path: Toolpath) -> Toolpath:
        values = np.array(getattr(path, name))
        values[row] = value
        return path.replace(**{name: values})

    return change


def without(row: int) -> Callable[[Toolpath], Toolpath]:
    def change(path: Toolpath) -> Toolpath:
        events = tuple(replace(e, row=e.row - (e.row > row)) for e in path.events)
        return path.take(np.arange(len(path)) != row).replace(events=events)

    return change


def mirrored(path: Toolpath) -> Toolpath:
    """Put the first lines on the other side."""
    end = np.array(path.end)
    end[1:4, 0] = 2.0
    return path.replace(end=end)


def pointed(path: Toolpath) -> Toolpath:
    """Let the moves at the first outside corner meet, in place of the arc."""
    end = np.array(path.end)
    end[2:4, 1] = 22.0
    return without(4)(path.replace(end=end))


# Rows: 0 rapid, 1 entry, 2 Y20, 3 Z-1, 4 corner, 5 X8.29, 6 arc, 7 X30, 8 corner, 9 Y12, 10 nearly
# straight, 11 X48, 12 Y30, 13 exit, 14 free
TAMPERED = {
    "a line is too near": moved(2, 0, 0.01),
    "a line is too far": moved(2, 0, -0.01),
    "a line is on the other side": mirrored,
    "the entry ends elsewhere": moved(1, 0, 0.01),
    "an inside corner is cut short": moved(5, 0, -0.01),
    "an inside corner is overrun": moved(5, 0, 0.01),
    "the other crossing": moved(5, 0, 13.4164079),
    "the arc has another centre": column("centre", 6, (15.0, 20.001, -1.0)),
    "the arc is turned": column("kind", 6, 3),
    "the arc sweeps too far": column("sweep", 6, 6.0),
    "the arc sweeps too little": column("sweep", 6, 1.0),
    "the arc sweeps a turn more": column("sweep", 6, 2.4614 + 6.2831853),
    "a corner is missing": without(4),
    "a corner is a point": pointed,
    "the last move ends aside": moved(12, 0, 0.01),
    "the last move ends short": moved(12, 1, -5.0),
    "the last move is overrun": moved(12, 1, 0.01),
    "a corner goes the wrong way": column("kind", 4, 3),
    "a corner has another centre": column("centre", 4, (0.0, 20.01, -1.0)),
    "a corner is cut": column("kind", 4, 1),
    "a corner sweeps another angle": column("sweep", 4, 3.0),
    "a corner is a rapid": column("kind", 4, 0),
    "a corner has another feed": column("feed", 4, 100.0),
    "a corner has another feed mode": column("feed_mode", 4, 1),
    "a corner rises": moved(4, 2, 0.1),
    "a still move goes aside": moved(3, 1, 0.1),
    "another depth": moved(2, 2, 0.1),
    "another feed": column("feed", 5, 100.0),
    "a cut becomes a rapid": column("kind", 5, 0),
    "another plane": column("plane", 5, 1),
    "a free move is moved": moved(14, 0, 0.01),
    "the exit ends elsewhere": moved(13, 0, 0.01),
    "a move is dropped": without(7),
    "an event is dropped": lambda path: path.replace(events=()),
    "a small turn is a large one": moved(9, 1, 0.3),
}


def proving() -> tuple[gx.Pass, PassContext]:
    kind = default_registry().dialect("linuxcnc")
    return pipeline().path_passes[0], PassContext(kind, kind, kind.numbers)


@pytest.mark.parametrize("name", TAMPERED)
def test_the_proof_sees(name: str) -> None:
    step, context = proving()
    before = path_of(CONTOUR)
    after = step.apply(before, context)
    step.prove(before, after, context)
    with pytest.raises(gx.VerificationError) as error:
        step.prove(before, TAMPERED[name](after), context)
    assert error.value.diagnostics[0].code == "GX604"


def test_a_still_move_along_the_contour_is_seen() -> None:
    step, context = proving()
    before = path_of("F100\nG41 D1 G1 X10 Y0\nX20\nZ-1\nX30\nG40 X40\nM2\n")
    after = step.apply(before, context)
    with pytest.raises(gx.VerificationError, match="aside"):
        step.prove(before, moved(2, 0, 0.1)(after), context)


@pytest.mark.parametrize(
    ("contour", "row", "axis", "entry"),
    [
        *(("X20.\nX30.", row, 0, entry) for row in range(3) for entry in ("own", "next")),
        ("Y20.\nX20.", 0, 1, "next"),
    ],
)
def test_an_end_that_slides_along_the_contour_is_seen(
    contour: str, row: int, axis: int, entry: str
) -> None:
    """Both curves of a straight joint are at the tool's radius wherever it is."""
    kind = default_registry().dialect("fanuc")
    step = pipeline(f"cutter-comp corners=arc entry={entry}", "fanuc").path_passes[0]
    context = PassContext(kind, kind, kind.numbers)
    before = path_of(f"G94 F100\nG41 D1 G1 X10. Y0.\n{contour}\nG40 X40.\nM30\n", "fanuc")
    after = step.apply(before, context)
    step.prove(before, after, context)
    with pytest.raises(gx.VerificationError, match="along the contour"):
        step.prove(before, moved(row, axis, 0.01)(after), context)


@pytest.mark.parametrize("row", [2, 3, 4])
def test_another_speed_in_inverse_time_is_seen(row: int) -> None:
    step, context = proving()
    before = path_of(HEAD + "G41 D1 G93 G1 Y0 F2\nX10 F2\nG2 X20 I5 F3\nG40 G1 X30 F1\nM2\n")
    after = step.apply(before, context)
    step.prove(before, after, context)
    with pytest.raises(gx.VerificationError, match="feed"):
        step.prove(before, column("feed", row, after.feed[row] * 1.01)(after), context)


def test_a_line_that_goes_backwards_is_seen() -> None:
    """The centre of an entry may go anywhere forwards, but that of a contour not back."""
    step, context = proving()
    before = path_of("F100\nG41 D1 G1 X10 Y0\nX20\nY0.5\nY10\nG40 X0\nM2\n")
    good = path_of("F100\nG41 D1 G1 X10 Y0\nX20\nY5\nY10\nG40 X0\nM2\n")
    after = step.apply(good, context)
    step.prove(good, after, context)
    end = np.array(after.end)
    end[2, 1] = 0.5
    with pytest.raises(gx.VerificationError, match="backwards"):
        step.prove(before, after.replace(end=end), context)


def test_programs_differ_in_their_compensation() -> None:
    def program(text: str) -> gx.Program:
        return gx.read(
            text.encode(), "linuxcnc", start=START, tools={1: Tool(radius=2.0), 2: Tool(radius=0.5)}
        )

    for other in ("G42 D1", "G41 D2", "G41 D7", "G41.1 D4", "G40"):
        changed = CONTOUR.replace("G41 D1", other)
        if other == "G41 D7":
            changed = changed.replace("D7", "D6")
            one = program(CONTOUR.replace("D1", "D7"))
        else:
            one = program(CONTOUR)
        assert not gx.compare(one, program(changed)).same, other
    assert gx.compare(program(CONTOUR), program(CONTOUR)).same


REFUSED = {
    "G41.1 D4": "Cannot turn cutter radius comp on when on",
    "G42 D1": "Cannot turn cutter radius comp on when on",
    "G18": "Cannot change planes with cutter radius compensation on",
    "G55 G1 X20": "Cannot change coordinate systems with cutter radius compensation on",
    "G49": "Cannot change tool offset with cutter radius compensation on",
    "G64": "Cannot change control mode with cutter radius compensation on",
    "G98": "Cannot change retract mode with cutter radius compensation on",
    "M6": "Cannot change tools with cutter radius compensation on",
    "M48": "Cannot enable overrides with cutter radius compensation on",
    "M62 P1": "Cannot set motion output with cutter radius compensation on",
    "G40\nG2 X30 I5": "The move just after exiting cutter compensation mode must be straight, not",
    "G3 X10 Y1.9 J0.95": "Tool radius not less than arc radius with comp",
    "G40\nG1 X20\nG19 G41 D1": "Cutter radius compensation allowed only in XY, XZ planes",
    "G40\nG1 X20\nG41 D1.5": "G41 requires D word to be a whole number",
    "G40\nG1 X20\nG41.1": "G41.1 with no D word",
}


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
@pytest.mark.parametrize("blocks", REFUSED)
def test_linuxcnc_refuses_it_too(blocks: str) -> None:
    program = f"G21 G90 G17 G94 F200\nG0 X0 Y0 Z0\nG41.1 D4 G1 X10\n{blocks}\nG40 G1 X50\nM2\n"
    with pytest.raises(rs274.Rejected) as refusal:
        rs274.run(program.encode())
    assert refusal.value.message.startswith(REFUSED[blocks])
    assert refused(program) in ("GX230", "GX350")


def test_a_long_program_of_contours_is_cut_between_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a window ends within a contour, what is before that contour goes on."""
    monkeypatch.setattr("gcxform.pipeline.cutter_comp.SMALL", 0)
    one, two = b"G41 D1 G1 X1\nX2\nG40 X3 Y3\n", b"G42 X9\nX8\n"
    end = b"G40 X7 Y7\nX1\n"
    found = list(whole_stretches(iter([b"G17 G40\nX0 Y0\n" + one + two, end])))
    assert found == [b"G17 G40\nX0 Y0\n" + one, two + end]
    beside = [b"X0\nG41 D1 X1\nG40 X3 Y3 G41 D2\nX5\n", b"G40 X7 Y7\n"]
    assert list(whole_stretches(iter(beside))) == [b"X0\n", beside[0][3:] + beside[1]]


PIECES = (b"X1\n", b"G41 D1 X2\n", b"G40\n", b"G40 X1 Y2\n", b"Y3\n", b"Z1\n", b"X1 Y1\n")
PIECES += (b"G40 X1 Y1 G42\n", b"(G41) X1\n", b"; G40\n", b"g 042\n", b"G40 X3\r")


def clean(text: bytes) -> set[int]:
    """Return where lines begin before which no stretch is open, line by line."""
    found, at, begun, off, seen = {0}, 0, False, False, set[bytes]()
    for line in text.splitlines(keepends=True):
        bare = re.sub(rb"\([^)]*\)|;.*", b"", line).upper()
        for word in re.findall(rb"G *0*4([012])|([XYZ])", bare):
            if word[0]:
                begun, off, seen = True, word[0] == b"0", set()
            elif begun and off:
                seen.add(word[1])
                begun = len(seen) < 2
        at += len(line)
        found |= set() if begun else {at}
    return found


@pytest.mark.parametrize("seed", range(400))
def test_stretches_are_cut_where_none_is_open(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gcxform.pipeline.cutter_comp.SMALL", 0)
    draw = random.Random(seed)
    texts = [
        b"".join(draw.choice(PIECES) for _ in range(draw.randint(1, 5)))
        for _ in range(draw.randint(1, 5))
    ]
    found = list(whole_stretches(iter(texts)))
    assert b"".join(found) == b"".join(texts)
    assert {*accumulate(map(len, found[:-1]))} <= clean(b"".join(texts))
    for size in (0, 6, 14, 30):  # however little of the end is looked at
        monkeypatch.setattr("gcxform.pipeline.cutter_comp.TAIL", size)
        assert list(whole_stretches(iter(texts))) == found
