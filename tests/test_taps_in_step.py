"""A tap in step with the spindle in other languages: `compare` sees all that makes it one."""

import random

import numpy as np
import pytest
from seeds_kit import DRAWN

import gcxform as gx
from gcxform.emit.taps_as_cycles import TapsAsCycles
from gcxform.emit.taps_in_step import TapsInStep
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.toolpath.path import FeedMode, Form, Toolpath

WORDS = b"G21 G17 G90 G94\nG0 X0 Y0 Z5\nS300 M3\nG33.1 Z-10 K1.25\nG0 Z9\nM2\n"
AT = Reading({"X": 0.0, "Y": 0.0, "Z": 5.0})
OTHERWISE = {
    "pitch": (("K1.25", "K1.5"), ("Q239=+1.25", "Q239=+1.5")),
    "depth": (("G331 Z-10", "G331 Z-9"), ("Q201=-14", "Q201=-13")),
    "speed": (("S300", "S400"),),
    "hand": (("K1.25", "K-1.25"), ("Q239=+1.25", "Q239=-1.25"), ("M3", "M4")),
    "a plain move": (
        ("SPOS=0\nG331 Z-10 K1.25 S300\nG332 Z5 K1.25\nM3 S300\n", "G1 Z-10 F375\nG1 Z5\n"),
        ("CYCL CALL\n6 M3\n", "L Z-10 F375\n6 L Z+5 F375\n"),
    ),
}


@pytest.mark.parametrize("name", ["siemens", "heidenhain"])
def test_another_tap_is_another_program(name):
    words, there = default_registry().dialect("linuxcnc"), default_registry().dialect(name)
    said = Pipeline(words, there, (), AT).run(WORDS).text.decode()
    first = gx.Program(WORDS, words, AT)
    assert gx.compare(first, gx.Program(said.encode(), there, AT), 0.001).same
    for what, changes in OTHERWISE.items():
        other = said
        for old, new in changes:
            other = other.replace(old, new)
        assert other != said, what
        assert not gx.compare(first, gx.Program(other.encode(), there, AT), 0.001).same, what


TARGETS = ("linuxcnc", "siemens", "heidenhain")
Hole = tuple[float, float, float, float, float]


def drawn(seed: int) -> tuple[bytes, list[Hole]]:
    """Return a program of a Fanuc that taps, and its holes: X, Y, R, depth, pitch; mm."""
    draw = random.Random(seed)
    lines, holes = ["G21 G17 G90 G94 G54", "G0 X0. Y0. Z60."], list[Hole]()
    for _ in range(draw.randint(1, 3)):
        code, sense = draw.choice((("G84", "M3"), ("G74", "M4")))
        speed, pitch = draw.choice((100, 250, 400)), draw.choice((0.5, 0.8, 1.25, 2.0))
        top, first = draw.choice((1.0, 3.0)), True
        lines += [f"S{speed} {sense}", *draw.choice(([], [f"M29 S{speed}"]))]
        for _ in range(draw.randint(1, 3)):
            x, y, z = (float(draw.randint(-30, 30)) for _ in range(3))
            z, top = -abs(z) - 1, top if draw.random() < 0.7 else top + 2
            back, times = draw.choice(("G98", "G99")), draw.choice((1, 1, 2))
            head = f"{back} {code} F{speed * pitch:.1f}" if first else back
            lines.append(f"{head} X{x}Y{y}Z{z}R{top}" + (f" K{times}" if times > 1 else ""))
            holes += [(x, y, top, z, pitch)] * times
            first = False
        lines += ["G80", "G0 Z60."]
    return "\n".join([*lines, "M30", ""]).encode(), holes


def tapped(program: gx.Program) -> list[Hole]:
    """Return the holes of a program, as its own reader has them."""
    path, found = program.path, list[Hole]()
    rows = np.flatnonzero(path.form == Form.SYNCHRONISED)
    assert (path.feed_mode[rows] == FeedMode.PER_TURN).all()
    for into, out in rows.reshape(-1, 2).tolist():
        assert (path.end[out] == path.start[into]).all()
        x, y, z = path.end[into, :3].tolist()
        assert path.start[into, :2].tolist() == [x, y]
        found.append((x, y, float(path.start[into, 2]), z, float(path.feed[into])))
    return found


@pytest.mark.parametrize("name", TARGETS)
def test_drawn_taps_go_where_and_as_steep_as_they_are_told(name):
    there = default_registry().dialect(name)
    for seed in range(DRAWN):
        text, holes = drawn(seed)
        fanuc = default_registry().dialect("fanuc")
        said = Pipeline(fanuc, there, (), taps="in-step").run(text).text
        found = tapped(gx.Program(said, there, Reading()))
        assert np.allclose(found, holes, atol=1e-9), text.decode()


def tapped_by_cycles(program: gx.Program) -> list[Hole]:
    """Return the holes of a program with G84 and G74, their pitches by F and S."""
    path, found = program.path, list[Hole]()
    rows = np.flatnonzero(path.form == Form.SYNCHRONISED)
    speeds = [(e.row, e.values[0][1]) for e in path.events if e.what == "S"]
    for into, out in rows.reshape(-1, 2).tolist():
        speed = [value for row, value in speeds if row <= into][-1]
        x, y, z = path.end[into, :3].tolist()
        assert (path.end[out] == path.start[into]).all()
        found.append((x, y, float(path.start[into, 2]), z, float(path.feed[into]) / speed))
    return found


@pytest.mark.parametrize("name", TARGETS)
def test_drawn_taps_come_back(name):
    fanuc, there = (default_registry().dialect(each) for each in ("fanuc", name))
    for seed in range(DRAWN):
        text, holes = drawn(seed)
        said = Pipeline(fanuc, there, (), taps="in-step").run(text).text
        back = Pipeline(there, fanuc, (), taps="in-step").run(said).text
        first, last = (gx.Program(each, fanuc, Reading()) for each in (text, back))
        assert np.allclose(tapped_by_cycles(first), holes, atol=1e-9)
        assert np.allclose(tapped_by_cycles(last), holes, atol=1e-9), said.decode()
        assert [e.what for e in last.path.events].count("M29") == len(holes)


WRONG = {
    "another pitch": ("_pitch", lambda self, row, speed: 1.0),
    "the other hand": ("_check_hand", lambda self, line, code: None),
    "one that does not wait": ("_refuse_waits", lambda self: None),
}


@pytest.mark.parametrize("what", WRONG)
def test_the_proof_finds(what, monkeypatch):
    fanuc, there = (default_registry().dialect(name) for name in ("fanuc", "linuxcnc"))
    text = b"G21 G17 G90 G94 G54\nS300 M3\nG0 X0. Y0. Z50.\nG84 X1. Y5. Z-5. R2. F375.\nG80\nM30\n"
    made = Pipeline(fanuc, there, (), taps="in-step")
    assert b"K1.25" in made.run(text).text
    text = text.replace(b"M3\n", b"M4\n") if "hand" in what else text
    text = text.replace(b"F375.", b"F375. P500") if "wait" in what else text
    monkeypatch.setattr(TapsInStep, *WRONG[what])
    with pytest.raises(gx.VerificationError) as error:
        made.run(text)
    assert error.value.diagnostics[0].code == "GX601"


WRONG_CYCLES = {
    "another feed": ("pace", lambda taps: taps.pace * 1.01),
    "the other hand": ("code", lambda taps: np.where(taps.code == 84, 74, taps.code)),
}


@pytest.mark.parametrize("what", WRONG_CYCLES)
def test_the_proof_of_cycles_finds(what, monkeypatch):
    words, there = (default_registry().dialect(name) for name in ("linuxcnc", "haas"))
    made = Pipeline(words, there, (), AT, taps="in-step")
    assert b"G84 Z-10. X0. Y0. R5. F375." in made.run(WORDS).text
    name, wrong = WRONG_CYCLES[what]
    find = TapsAsCycles._find

    def otherwise(self: TapsAsCycles) -> None:
        find(self)
        setattr(self, name, wrong(self))

    monkeypatch.setattr(TapsAsCycles, "_find", otherwise)
    with pytest.raises(gx.GcxformError) as error:
        made.run(WORDS)
    assert error.value.diagnostics[0].code in ("GX601", "GX215")


def test_each_tap_costs_the_same(monkeypatch):
    fanuc, there = (default_registry().dialect(name) for name in ("fanuc", "linuxcnc"))
    begins, asked, found = Toolpath.start.fget, [0], list[int]()

    def start(path: Toolpath) -> np.ndarray:
        asked[0] += 1
        return begins(path)

    monkeypatch.setattr(Toolpath, "start", property(start))
    for count in (10, 200):
        asked[0] = 0
        holes = "".join(f"X{n}.\n" for n in range(1, count))
        text = f"G21 G17 G90 G94 G54\nS300 M3\nG0 X0. Y0. Z9.\nG84 X0. Z-5. R2. F375.\n{holes}G80\n"
        made = Pipeline(fanuc, there, (), taps="in-step").run(f"{text}M30\n".encode()).text
        assert made.count(b"G33.1") == count
        back = Pipeline(there, fanuc, (), taps="in-step").run(made).text
        assert back.count(b"G84") == count
        found.append(asked[0])
    assert found[0] == found[1]  # each is a copy of all
