"""SINUMERIK 840D: its programs beside a reader that goes line by line, end to end, and bad ones."""

from __future__ import annotations

import math
import random
import re
from pathlib import Path

import pytest
from oracles.toolpaths import moves_of
from reference import siemens as reference
from seeds_kit import some

import gcxform as gx
from gcxform.contract.tip_codes import with_switches
from gcxform.machine.machine import Tool
from gcxform.plugin.registry import default_registry

BESIDE = Path(__file__).parents[2] / "shared" / "corpus" / "programs"
SIEMENS = default_registry().dialect("siemens")
FOLLOWS = with_switches(SIEMENS, {})
KINDS = {"RAPID": "0", "LINE": "1", "ARC_CW": "2", "ARC_CCW": "3"}
TOLD = {
    "work_offsets": {"G54": {"X": 3.0, "C": 5.0}, "G55": {"X": -20.0, "Y": 7.0, "Z": 1.0}},
    "tools": {n: Tool(length=40.0 + n) for n in range(1, 9)},
    "control": {"tool-length-axis": "Z"},
}
NEAR = 2e-3
CODES = ("G0", "G1")


def executed(text, **told):
    """Return the blocks of a program."""
    return gx.read(text.encode(), SIEMENS, **told).executed.decode().splitlines()


def refused(text, **told):
    """Return the only finding about a program."""
    with pytest.raises(gx.InputError) as error:
        _ = gx.read(text.encode("latin-1"), SIEMENS, **told).path
    return error.value.diagnostics[0]


def check(text):
    """Compare what we read with what the reference does."""
    path = gx.read(text.encode(), FOLLOWS, **TOLD).path
    there = reference.read(text)
    ours = [*moves_of(path)]
    assert len(ours) == len(there.moves), text
    for row, (one, other) in enumerate(zip(ours, there.moves, strict=True)):
        where = f"move {row}, line {one.line}\n{one}\n{other}\n{text}"
        assert KINDS[one.kind] == other.kind, where
        for axis, value in other.end.items():
            assert one.end[axis] == pytest.approx(value, abs=NEAR), f"{axis}: {where}"
        frame = path.frames[int(path.frame[row])]
        assert bool(frame.following) == other.follows, where
        if other.kind != "0":
            assert one.feed == pytest.approx(other.feed), where
        if other.centre is not None:
            centre = [one.centre["XYZ".index(a)] for a in other.plane]
            assert centre == pytest.approx(other.centre, abs=5 * NEAR), where
            assert one.turns == other.turns, where
    waits = [event.values[0][1] for event in path.events if event.what == "DWELL"]
    assert waits == pytest.approx(there.seconds), text


def test_a_frame_turns_about_x_before_y_and_z():
    """Programming manual, ROT: angles of one block are RPY, Z first as the axes are turned."""
    text = b"G710 G90 G17 G94\nROT X90 Z90\nG1 X0 Y0 Z1 F100\nROT X30 Y20\nX0 Y0 Z1\nM30\n"
    ends = gx.read(text, "siemens", start={"X": 0.0, "Y": 0.0, "Z": 0.0}).path.end
    assert ends[0] == pytest.approx([1, 0, 0], abs=NEAR)
    x, y = math.radians(30), math.radians(20)
    turned = [math.cos(x) * math.sin(y), -math.sin(x), math.cos(x) * math.cos(y)]
    assert ends[1] == pytest.approx(turned, abs=NEAR)


# --- random programs ---


class Builder:
    """Makes random programs that the control takes, and follows them with the reference."""

    def __init__(self, seed):
        self.draw = random.Random(seed)
        self.lines = []
        self.control = reference.Control()
        self.ways = {"C": "DC"} if seed % 2 else {}
        self.put("G90 G94 G17 G710 G54")
        self.tool()

    def text(self):
        return "\n".join(self.lines) + "\n"

    def put(self, line):
        reference.one(self.control, line)
        draw = self.draw
        if draw.random() < 0.3:
            line = f"N{len(self.lines) * 10} {line}"
        if draw.random() < 0.1:
            line = line.lower()
        if draw.random() < 0.1:
            line += " ; X99 a comment"
        self.lines.append(line)

    def word(self, letter, way, value):
        """Return a word in one of the ways to write it."""
        number = f"{value:.3f}"
        draw = self.draw.random()
        if way:
            return f"{letter}={way}({number})" if draw < 0.7 else f"{letter} = {way} ( {number} )"
        return f"{letter}{number}" if draw < 0.6 else f"{letter}={number}"

    def somewhere(self, axis, spread=60.0):
        """Return a word that leads anywhere, absolute or not."""
        if axis in self.ways:
            return self.rotary(axis)
        steps = axis in self.control.at and self.draw.random() < 0.4
        value = self.draw.uniform(-spread, spread)
        plain = self.control.steps == steps and self.draw.random() < 0.6
        return self.word(axis, "" if plain else "IC" if steps else "AC", value)

    def rotary(self, axis):
        at = self.control.at.get(axis)
        if at is not None and self.draw.random() < 0.3:
            return self.word(axis, "IC", self.draw.uniform(-200.0, 200.0))
        wanted = self.draw.uniform(1.0, 359.0)
        way = self.draw.choice(["DC", "DC", "ACP", "ACN"])
        if at is not None and abs(math.remainder(wanted - at - 180.0, 360.0)) < 1.0:
            way = "ACP"
        return self.word(axis, way, wanted)

    def tool(self):
        number = self.draw.randint(1, 8)
        form = self.draw.choice(["T{0} M6\nD1", "T={0}\nM6\nD1", "T{0} M06 D1"])
        for line in form.format(number).split("\n"):
            self.put(line)
        self.everywhere()

    def everywhere(self):
        """Tell all axes where to go, and turn back to G90 before."""
        rest = " ".join(
            self.word(a, "DC" if a in self.ways else "", 10.0 + k) for k, a in enumerate("XYZAC")
        )
        self.put(f"G0 G90 {rest}")
        self.put(f"G1 F{self.draw.randint(1, 99) * 10}")

    def line(self):
        axes = self.draw.sample("XYZAC", self.draw.randint(1, 4))
        code = self.draw.choice(["G0", "G1", "G01", ""])
        if not code and self.control.motion not in ("0", "1"):
            code = "G1"
        feed = f" F{self.draw.randint(1, 900)}" if self.draw.random() < 0.2 else ""
        mode = self.draw.choice(["", "", "", "G90 ", "G91 "])
        if mode:
            self.control.steps = "91" in mode
        self.put(f"{mode}{code} {' '.join(self.somewhere(a) for a in axes)}{feed}".strip())

    def end(self, axis, value):
        """Return a word that leads to a point."""
        steps = self.draw.random() < 0.4
        plain = self.control.steps == steps and self.draw.random() < 0.7
        number = value - self.control.at[axis] if steps else value
        return self.word(axis, "" if plain else "IC" if steps else "AC", number)

    def arc(self):
        plane = self.draw.choice(["XY", "ZX", "YZ"])
        if plane != self.control.plane:
            self.put({"XY": "G17", "ZX": "G18", "YZ": "G19"}[plane])
        a, b = plane
        start = complex(self.control.at[a], self.control.at[b])
        radius, angle = self.draw.uniform(2.0, 40.0), self.draw.uniform(0.0, 6.28)
        short, long = self.draw.uniform(20, 160), self.draw.uniform(200, 340)
        sweep = math.radians(self.draw.choice([short, long]))
        sense = self.draw.choice([1, -1])
        centre = start + radius * complex(math.cos(angle), math.sin(angle))
        turn = complex(math.cos(sweep), sense * math.sin(sweep))
        end, half = (
            centre + (start - centre) * turn,
            complex(math.cos(sweep / 2), sense * math.sin(sweep / 2)),
        )
        middle = centre + (start - centre) * half
        code = "G3" if sense > 0 else "G2"
        ends = f"{self.end(a, end.real)} {self.end(b, end.imag)}"
        letters = [reference.CENTRES[x] for x in plane]
        way = self.draw.choice(["IJ", "AC", "mixed", "CR", "AR", "AR of centre", "CIP", "TURN"])
        off = centre - start
        if way == "CIP":
            form = "{}1=AC({:.4f})" if self.control.steps else "{}1={:.4f}"
            points = zip(letters, (middle.real, middle.imag), strict=True)
            middles = [form.format(letter, value) for letter, value in points]
            self.put(f"CIP {ends} {' '.join(middles)}")
        elif way == "CR":
            self.put(f"{code} {ends} CR={'-' if sweep > math.pi else ''}{radius:.4f}")
        elif way == "AR":
            self.put(f"{code} {ends} AR={math.degrees(sweep):.4f}")
        elif way == "AR of centre":
            words = f"{letters[0]}{off.real:.4f} {letters[1]}{off.imag:.4f}"
            self.put(f"{code} {words} AR={math.degrees(sweep):.3f}")
        else:
            self.put(f"{code} {ends} {self.centre(way, letters, off, centre)}")

    def centre(self, way, letters, off, centre):
        first = f"{letters[0]}{off.real:.4f}"
        second = f"{letters[1]}={off.imag:.4f}"
        if way in ("AC", "mixed"):
            first = f"{letters[0]}=AC({centre.real:.4f})"
        if way == "AC":
            second = f"{letters[1]}=AC({centre.imag:.4f})"
        rest = f" TURN={self.draw.randint(0, 3)}" if way == "TURN" else ""
        return f"{first} {second}{rest}"

    def drill(self):
        if self.control.follows:
            return
        axis = next(a for a in "XYZ" if a not in self.control.plane)
        dwell = self.draw.choice(
            [
                "CYCLE81(30,4,1.5,-8.25)",
                "CYCLE82(25.5,1.25,2,,7.5,0.5)",
                "CYCLE82(5,-1,5,-17.26, ,0.25,0,0,10)",
            ]
        )
        self.put(f"MCALL {dwell}")
        places = " ".join(self.word(a, "", 7.0) for a in "XYZ" if a != axis)
        self.put(f"{self.draw.choice(CODES)} G90 {places}")
        self.put(f"{self.control.plane[0]}=IC(2)")
        self.put("MCALL")
        if self.draw.random() < 0.5:
            self.put(dwell)

    def step(self):
        kind = self.draw.choice("llllllaaaawtsdco")
        if kind == "l":
            self.line()
        elif kind == "a":
            self.arc()
        elif kind == "w":
            self.put(self.draw.choice(["G54", "G55", "G56"]))
            self.everywhere()
        elif kind == "t" and not self.control.follows:
            self.tool()
        elif kind == "s":
            self.put("ORIAXES")
            on = self.draw.choice(["TRAORI", "TRAORI(1)"])
            self.put("TRAFOOF" if self.control.follows else on)
            self.everywhere()
        elif kind == "d":
            self.drill()
        elif kind == "c":
            self.put(
                self.draw.choice(
                    ['MSG("to do: X5")', "; G0 X1", "", "LABEL_1: ", "SOFT FFWON", "G641 ADIS=0.5"]
                )
            )
        elif kind == "o":
            self.put(self.draw.choice(["S1000 M3", "M8", "G4 F1.5", "FFWOF", "M5 M9"]))


@pytest.mark.parametrize("seed", some(300))
def test_it_reads_what_the_reference_reads(seed):
    builder = Builder(seed)
    for _ in range(builder.draw.randint(5, 40)):
        builder.step()
    builder.put("M30")
    check(builder.text())


# --- the fact about MCALL, with what its program leaves open ---


def test_a_modal_cycle_drills_behind_each_place():
    text = "G0 F100\nMCALL CYCLE81(5,0,2,-10)\nX10 Y10\nX20\nMCALL\nM30\n"
    levels = ["G0 Z2", "G1 Z-10", "G0 Z5"]
    assert executed(text) == ["G0 F100", "X10 Y10", *levels, "X20", *levels, "M30"]


@pytest.mark.parametrize(("switch", "end"), [("skip", "G0 X8 Y2"), ("execute", "G0 X9 Y2")])
def test_lines_that_are_skipped_move_nothing(switch, end):
    """Plain lines are not looked at before a position is asked for; those with a slash are none."""
    text = "G0 X1 Y0\nX7\n/ X8\nG0 X=IC(1) Y2\n"
    assert executed(text, block_delete=switch)[-1] == end


def test_a_refusal_shows_its_own_line():
    """Lines of one shape share their items, and not their columns."""
    found = refused("G0 C0\nN1 C=DC(10)\nN20000 C=DC(190)\n")
    assert (found.code, found.where.line, found.where.column) == ("GX210", 3, 8)


# --- end to end ---

MACHINE = """format = 1
kinematics = "ac-trunnion"
[axis.X]
[axis.Y]
[axis.Z]
[axis.A]
point = [3.0, -2.0, 40.0]
limits = [-100.0, 100.0]
[axis.C]
point = [1.0, 5.0, 0.0]
[work-offset.G54]
X = 12.0
Z = -100.0
[tool.1]
length = 50.0
[tool.2]
length = 62.5
"""
SWITCHED = MACHINE + '[control]\ntip-on = "M428"\ntip-off = "M429"\n'
PASSES = """[[pass]]
use = "absolute"
[[pass]]
use = "segment"
chord-error = "10 um"
"""
TIPS = '[[pass]]\nuse = "rtcp"\ntolerance = "20 um"\ntip-codes = "read"\nrapids = "ends"\n'
FIVE_AXES = """; five axes
N10 G710 G17 G90 G94 G54
N20 T1 M6
N30 D1
N40 ORIAXES
N50 G0 X0 Y0 Z=70 A0 C=DC(0)
N60 TRAORI ; from here the tip
N70 G0 Z20
N80 G1 X=10 C=IC(30) F100
N90 G2 X0 Y-10 I=AC(0) J=AC(0) A=10
N100 G1 X-5 Y=IC(3) A0 C=DC(355)
N110 C=DC(0)
N120 TRAFOOF
N130 G0 Z70
N140 T2 M6
N150 D1
N160 G0 X0 Y0 Z=AC(80) A0 C0
N170 M30
"""
BY_HAND = """(five axes)
N10 G21 G17 G90 G94 G54
N20 T1 M6
N30 G43 H1
N50 G0 X0. Y0. Z70. A0. C0.
N60 M428 (from here the tip)
N70 G0 Z20.
N80 G1 X10. C30. F100.
N90 G2 X0. Y-10. A10. I-10. J0.
N100 G1 X-5. Y-7. A0. C-5.
N110 C0.
N120 M429
N130 G0 Z70.
N140 T2 M6
N150 G43 H2
N160 G0 X0. Y0. Z80. A0. C0.
N170 M30
"""
"""The same for LinuxCNC; the points are for a Fanuc, as which it is read as well."""


def run(folder, dialect, machine, text, passes):
    """Return the result of a pipeline to LinuxCNC."""
    (folder / "machine.toml").write_text(machine)
    head = f'format = 1\n[input]\ndialect = "{dialect}"\n[output]\ndialect = "linuxcnc"\n'
    head += "stamp = false\n"
    (folder / "p.toml").write_text(f'{head}[machine]\nfile = "machine.toml"\n{passes}')
    return gx.Pipeline.load(folder / "p.toml").run(text.encode(), verify="full")


def bare(text):
    """Return lines without comments, and without what copied blocks say again."""
    lines = re.sub(r"\([^()]*\)", "", text.decode()).splitlines()
    return [re.sub(r"G90 |G9[34] |(?<=\d)\.(?!\d)", "", line).strip() for line in lines]


@pytest.mark.parametrize("dialect", ["linuxcnc", "fanuc"])
def test_five_axes_become_what_the_same_program_by_hand_becomes(tmp_path, dialect):
    ours = run(tmp_path, "siemens", MACHINE, FIVE_AXES, PASSES + TIPS)
    there = run(tmp_path, dialect, SWITCHED, BY_HAND, PASSES + TIPS)
    assert ours.certificate.verified
    if dialect == "fanuc":
        assert ours.text.replace(b" G94", b"") == there.text.replace(b" G94", b"")
    one, other = (gx.read(x.text, "linuxcnc", tools=TOOLS).path for x in (ours, there))
    assert len(one) == len(other) > 40
    for k, (a, b) in enumerate(zip(moves_of(one), moves_of(other), strict=True)):
        assert (a.kind, a.end, a.feed) == (b.kind, b.end, b.feed), k


TOOLS = {1: Tool(length=50.0), 2: Tool(length=62.5)}


@pytest.mark.parametrize("use", ["segment", "volumetric"])
def test_nothing_is_corrected_twice(tmp_path, use):
    passes = PASSES
    if use == "volumetric":
        (tmp_path / "model.toml").write_text(MODEL)
        passes += '[[pass]]\nuse = "volumetric"\nmodel = "model.toml"\ntolerance = "5 um"\n'
    with pytest.raises(gx.InputError) as error:
        run(tmp_path, "siemens", MACHINE, FIVE_AXES, passes)
    (found,) = error.value.diagnostics
    assert (found.code, found.where.line, found.where.column) == ("GX210", 7, 1)
    assert "TRAORI" in found.message


MODEL = (Path(__file__).parents[1] / "examples" / "lddm" / "model.toml").read_text()

# --- what turns between ends ---

TIP = "G90 G0 X0 Y0 Z0 A0 C0\n{}TRAORI\nG1 X1 {} F100\n"
LINEAR = {"control": {"orientation-path": "angles"}}


@pytest.mark.parametrize(
    ("said", "words", "told", "good"),
    [
        ("ORIAXES\n", "A10", {}, True),
        ("ORIAXES ORIMKS\n", "A10", {}, True),
        ("ORIAXES ORIWKS\n", "A10", {}, False),
        ("ORIAXES ORIWKS\n", "A10", LINEAR, True),
        ("ORIVECT\n", "A10", LINEAR, False),
        ("ORIPLANE\n", "A10", {}, False),
        ("ORIMKS\n", "A10", {}, False),
        ("ORIWKS\n", "A10", {}, False),
        ("", "A10", {}, False),
        ("", "A10", LINEAR, True),
        ("", "A0 C=DC(360)", {}, True),
        ("", "C=IC(0)", {}, True),
        ("", "C360", {}, False),
        ("", "B0", {}, False),
    ],
)
def test_what_turns_between_ends_is_said(said, words, told, good):
    text = TIP.format(said, words)
    if good:
        _ = gx.read(text.encode(), FOLLOWS, **told).path
    else:
        with pytest.raises(gx.InputError, match="TRAORI: whether angles change in proportion"):
            _ = gx.read(text.encode(), FOLLOWS, **told).path


# --- bad input ---

GOOD = FIVE_AXES.splitlines()


@pytest.mark.parametrize("seed", some(200))
def test_broken_lines_are_refused_or_read_and_never_fail(seed):
    """Lines are cut, mixed, and have signs put in; each is read, or there is a diagnostic."""
    draw = random.Random(seed)
    lines = [*GOOD]
    for _ in range(draw.randint(1, 5)):
        k = draw.randrange(len(lines))
        at = draw.randrange(len(lines[k]) + 1)
        sign = draw.choice('=()";:/%$[]{}XAGNM0.-+*EDC\x00\xff?\t ')
        lines[k] = draw.choice([lines[k][:at], lines[k][:at] + sign + lines[k][at:], lines[k][at:]])
    text = "\n".join(lines)[: draw.choice([10**6, draw.randint(0, 300)])]
    try:
        _ = gx.read(text.encode("latin-1"), FOLLOWS, **TOLD).path
    except gx.InputError as error:
        found = error.diagnostics[0]
        assert re.fullmatch("GX[0-9]{3}", found.code)
        assert found.where.line >= 1


@pytest.mark.parametrize("seed", range(20))
def test_noise_is_refused(seed):
    noise = bytes(random.Random(seed).randrange(256) for _ in range(400))
    with pytest.raises(gx.InputError):
        _ = gx.read(b"G0 X1\n" + noise, SIEMENS).path


@pytest.mark.parametrize("text", ["", "\n", "\r\n\r\n", "; only a comment", "%_N_A_MPF\n", "N10\n"])
def test_nothing_is_nothing(text):
    assert len(gx.read(text.encode(), SIEMENS).path) == 0


# --- real programs ---

REAL = sorted(p for p in (BESIDE / "sinumerik").rglob("*.[mMsS][pP][fF]") if p.is_file())
READ = {
    "sinumerik_traori_ac.mpf": '[control] orientation-path = "angles"',
    "case_insensitive_variables.mpf": "",
    "logic_operators.mpf": "",
    "loop.mpf": "",
}
"""Programs that are read, with what they have to be told."""


@pytest.mark.skipif(not REAL, reason="the collection of real programs is absent")
@pytest.mark.parametrize("path", REAL, ids=lambda path: path.name)
def test_real_programs_are_read_or_refused(path):
    told = {"control": {"orientation-path": "angles"}} if READ.get(path.name) else {}
    try:
        _ = gx.read(path, FOLLOWS, **told).path
        assert path.name in READ
    except gx.InputError as error:
        found = error.diagnostics[0]
        assert path.name not in READ, found.render()
        assert found.code != "GX101" or b"%MPF" in path.read_bytes(), found.render()
