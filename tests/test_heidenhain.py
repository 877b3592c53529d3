"""Klartext of a TNC: read as a reader reads it that knows one line at a time."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from heidenhain_kit import DIALECT, TOOLS, program, read
from oracles.toolpaths import moves_of
from reference import heidenhain as reference
from rtcp_kit import chain_of_kind, machine_text
from seeds_kit import some

import gcxform as gx

REAL = Path(__file__).parents[2] / "shared" / "corpus" / "programs" / "heidenhain"
TOLD = ("DWELL", "T", "S", "M0", "M1", "M3", "M4", "M5", "M8", "M9")


# --- random programs ---


class Writer:
    """Draws programs that are read: it knows where the tool is, and little else."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        self.at = {}
        self.pole = None
        self.polar = False
        self.following = False
        self.inch = self.rng.random() < 0.2
        self.label = 0

    def program(self):
        unit = "INCH" if self.inch else "MM"
        lines = [f"BEGIN PGM A {unit}", *self.tool()]
        for _ in range(int(self.rng.integers(5, 25))):
            lines += self.statement()
        if self.rng.random() < 0.5:
            lines += [self.rng.choice(["L Z+9 FMAX M2", "L M30", "M30"]), *self.sub(5)]
        lines.append(f"END PGM A {unit}")
        return "".join(self.odd(number, line) for number, line in enumerate(lines))

    def odd(self, number, line):
        """Return a line as people write it: with or without number, blanks, small letters."""
        if self.rng.random() < 0.1:
            line = line.lower()
        if self.rng.random() < 0.1:
            line = line.replace(" ", "  ")
        if self.rng.random() < 0.1:
            line += " ; a comment (with) Q1 = 5"
        if self.rng.random() < 0.3:
            line = re.sub(r"(?<=\d)\.(?=\d)", ",", line) if line[:4].upper() != "CYCL" else line
        head = f"{number * int(self.rng.integers(1, 3))} " if self.rng.random() < 0.8 else ""
        return f"{head}{line}{' ' * int(self.rng.integers(0, 2))}\n"

    def number(self, size=50.0):
        text = f"{self.rng.uniform(-size, size):+.{self.rng.integers(0, 5)}f}"
        return text[1:] if text[0] == "+" and self.rng.random() < 0.3 else text

    def words(self, axes, most=3):
        """Return coordinates, some of them as steps."""
        chosen = self.rng.permutation(list(axes))[: int(self.rng.integers(1, most + 1))]
        said = []
        for axis in chosen:
            number = self.number()
            step = axis in self.at and self.rng.random() < 0.3
            self.at[axis] = self.at.get(axis, 0.0) * step + float(number)
            said.append(f"{'I' * step}{axis}{number}")
        return " ".join(said)

    def tail(self, rapid=True):
        feed = ["", "", f" F{self.rng.integers(50, 900)}", " FAUTO"]
        feed += [" FMAX", " F MAX"] * rapid
        compensation = " R0" if self.rng.random() < 0.3 else ""
        function = self.rng.choice(["", "", "", "", " M3", " M8", " M13", " M5 M9", " M0"])
        return f"{compensation}{self.rng.choice(feed)}{function}"

    def tool(self):
        self.at, self.polar = {}, False
        axes = " ".join(f"{a}{self.number()}" for a in "XYZ")
        self.at = dict.fromkeys("XYZABC", 0.0)
        self.at |= {a: float(n) for a, n in re.findall(r"([XYZ])([-+.\d]+)", axes)}
        return [
            f"TOOL CALL {self.rng.integers(1, 9)} Z S{self.rng.integers(1, 9)}000 F250 DL+0",
            f"L {axes} A+0 B+0 C+0 R0 FMAX",
        ]

    def statement(self):
        kinds = [self.line, self.turned, self.centre, self.circle, self.radius, self.polar_line]
        kinds += [self.helix, self.switch, self.quiet, self.repeat, self.shift]
        if not self.following:
            kinds.append(self.tool)
        return kinds[int(self.rng.integers(0, len(kinds)))]()

    def line(self):
        self.polar = False
        return [f"L {self.words('XYZ')}{self.tail()}"]

    def turned(self):
        """Axes are turned only where nothing is switched with them turned."""
        if not self.following:
            return self.line()
        self.polar = False
        return [f"L {self.words('XYZ')} B{self.number()} C{self.number()}{self.tail()}"]

    def centre(self):
        self.polar, self.pole = False, True
        x, y = self.number(), self.number()
        kinds = [f"CC X{x} Y{y}", f"CC IX{x} Y{y}", f"CC X{x} IY{y}", f"CC IX{x} IY{y}"]
        return [self.rng.choice(kinds)]

    def circle(self):
        """A full circle, or a part of one: its end is put on the circle by a line before."""
        self.polar = False
        x, y, radius = (float(self.number()) for _ in range(3))
        radius = round(abs(radius) + 1.0, 3)
        sense = self.rng.choice(["DR+", "DR-", "DR -"])
        self.at |= {"X": x, "Y": y - radius}
        lines = [f"CC X{x} Y{y}", f"L X{x + radius:.6f} Y{y}{self.tail()}"]
        self.pole = True
        if self.rng.random() < 0.3:
            self.at |= {"X": x + radius, "Y": y}
            return [*lines, f"C {sense}{self.tail(False)}"]
        end = f"IX{-radius:.6f} IY{-radius:.6f}" if self.rng.random() < 0.5 else ""
        return [*lines, f"C {end or f'X{x} Y{y - radius:.6f}'} {sense}{self.tail(False)}"]

    def radius(self):
        self.polar, self.pole = False, None
        step = [round(float(v), 3) for v in self.rng.uniform(1.0, 20.0, 2)]
        sign = self.rng.choice(["+", "-"])
        size = np.hypot(*step) / 2 * self.rng.uniform(1.01, 3.0)
        return [
            f"CR IX+{step[0]} IY-{step[1]} R{sign}{size:.4f} {self.rng.choice(['DR+', 'DR-'])}"
            f"{self.tail(False)}"
        ]

    def polar_line(self):
        if self.pole is None:
            return self.line()
        whole = f"LP PR+{self.rng.uniform(1, 30):.3f} PA{self.number(400.0)}{self.tail()}"
        more = ["LP IPA+30.5", "LP PA-17.25 FMAX", "LP IPR+2 IPA-10", "LP PR+7 IPA+1 IZ+2"]
        lines = [whole, *self.rng.choice(more, int(self.rng.integers(0, 3)))]
        self.polar = True
        return lines

    def helix(self):
        if self.pole is None:
            return self.centre()
        sign = self.rng.choice(["+", "-"])
        angle = self.rng.choice(["45", "359.5", "360", "720", "1080.25", "90.5"])
        start = f"LP PR+{self.rng.uniform(1, 30):.3f} PA{self.number(90.0)} FMAX"
        if self.rng.random() < 0.3:
            return [start, f"CP PA+190.5 DR{sign}{self.tail(False)}"]
        steps = self.rng.choice(["", f" IZ{self.number(5.0)}", f" Z{self.number(5.0)}"])
        return [start, f"CP IPA{sign}{angle}{steps} DR{sign}{self.tail(False)}"]

    def switch(self):
        """Follow the tip, or leave it with all rotary axes at 0."""
        tcpm = "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS"
        if not self.following:
            self.following = True
            x = self.number()
            return [self.rng.choice(["M128", tcpm, f"L X{x} M128 F900", f"L X{x} FMAX M128"])]
        self.following = self.polar = False
        x = self.number()
        ends = [["L A+0 B+0 C+0 FMAX", "M129"], ["L B+0 C+0 A+0 FMAX", "FUNCTION RESET TCPM"]]
        ends.append([f"L X{x} A+0 B+0 C+0 FMAX M129"])
        return ends[int(self.rng.integers(0, 3))]

    def quiet(self):
        several = [
            ["BLK FORM 0.1 Z X+0 Y+0 Z-20"],
            ["* - a structure"],
            ["TOOL DEF 3"],
            ["CYCL DEF 32.0 TOLERANCE", "CYCL DEF 32.1 T0.05"],
            ["CYCL DEF 9.0 DWELL TIME", "CYCL DEF 9.1 DWELL 0.5"],
            ["TOOL CALL S500 F175"] if not self.following else ["L F123"],
            ["STOP"],
        ]
        return several[int(self.rng.integers(0, len(several)))]

    def repeat(self):
        self.label += 10
        inner = [f"L IX+1{self.tail()}", f"L IY-0.5 F{self.rng.integers(50, 900)}"]
        self.polar = False
        return [f"LBL {self.label}", *inner, f"CALL LBL {self.label} REP {self.rng.integers(1, 4)}"]

    def sub(self, number):
        """A subprogram behind the end that nobody calls, with nonsense in it."""
        return [f"LBL {number}", "L IX+1", "L Q99 nonsense", "LBL 0"]

    def shift(self):
        if self.following:
            return self.quiet()
        self.pole, self.polar = None, False
        return [
            "CYCL DEF 7.0 DATUM SHIFT",
            *(f"CYCL DEF 7.{k} {axis}{self.number()}" for k, axis in enumerate("XYZ", 1)),
        ]


def assert_same(text):
    path, wanted = read(text, tools=TOOLS), reference.read(text)
    moves = list(moves_of(path))
    assert len(moves) == len(wanted.steps), text
    following = [path.frames[k].following for k in path.frame.tolist()]
    for move, step, tip in zip(moves, wanted.steps, following, strict=True):
        here = f"{text}\nblock {move.line}: {move}\n{step}"
        assert move.kind == step.kind, here
        assert bool(tip) == step.following, here
        assert {a: move.end.get(a) for a in step.end} == pytest.approx(step.end, abs=2e-6), here
        if step.feed is not None:
            assert move.feed == pytest.approx(step.feed), here
        if step.centre is not None:
            assert move.centre[:2] == pytest.approx(step.centre, abs=3e-6), here
            assert move.turns == step.turns, here
    told = [e for e in path.events if e.what in TOLD]
    assert [_event(e) for e in told] == wanted.events, text


def _event(event):
    value = event.values[0][1] if event.values else 0.0
    return {"DWELL": f"dwell {value:g}", "T": f"T{value:g}", "S": f"S{value:g}"}.get(
        event.what, event.what
    )


@pytest.mark.parametrize("seed", some(300))
def test_it_is_read_as_by_a_reader_of_one_line_at_a_time(seed):
    assert_same(Writer(seed).program())


def test_the_two_readers_differ_where_the_program_does():
    text = program("TOOL CALL 1 Z F50", "L X+1 Y+2 Z+3 FMAX", "L X+5", "L IX+1 M8")
    assert_same(text)
    wanted = reference.read(text.replace("IX+1", "IX+2"))
    assert wanted.steps[-1].end["X"] == 7.0


# --- blocks ---


def blocks(*lines, unit="MM", **reading):
    """Return the blocks behind the header, without the end."""
    text = program(*lines, unit=unit).encode()
    return gx.read(text, DIALECT, **reading).executed.decode().splitlines()[1:-1]


def test_places_of_the_machine_leave_the_tool_out():
    text = program("TOOL CALL 1 Z", "L X+5 Y+5 Z+5 F100", "L Z-10 FMAX M91 M9", "L X+6 Z+5")
    zero = {"G54": {"Z": 100.0}}
    path = read(text, tools=TOOLS, work_offsets=zero)
    assert path.end[:, 2].tolist() == [15.0, -110.0, 15.0]
    assert blocks("L Z-10 M91 F50") == ["G53 G1 Z-10 F50"]


def test_a_shift_counts_from_the_datum():
    lines = ["L X+10 Y+10 Z+10 FMAX", "CYCL DEF 7.0", "CYCL DEF 7.1 X+5", "L IX+1 FMAX"]
    more = ["CYCL DEF 7.0 DATUM SHIFT", "CYCL DEF 7.1 X+0", "L IX+1 FMAX"]
    path = read(program(*lines, *more))
    assert path.end[:, 0].tolist() == [10.0, 11.0, 12.0]
    assert blocks(*lines)[1:] == ["G52 X5 Y0 Z0", "X6"]
    assert blocks("CYCL DEF 7.0", "CYCL DEF 7.1 X+0", "CYCL DEF 7.2 Y0,000") == []


HOLE = "CYCL DEF 200 DRILLING ~|Q200=2 ;UP ~|Q201=-15 ~|Q206=+150 ~|Q202=20 ~|Q210=0 ~|Q203=+1 ~"


def test_a_hole_in_one_stroke():
    lines = [*HOLE.split("|"), "Q204=50 ;HIGH ~", "Q211=0.5 ;DWELL", "L X+5 Y+5 Z+60 FMAX M99"]
    down = ["G0 X5 Y5 Z60", "G0 Z3", "G1 Z-14 F150", "G4 P0.5", "G0 Z51"]
    assert blocks(*lines) == down
    assert blocks(*lines, "L X+6 FMAX", "CYCL CALL") == [*down, "X6", *down[1:]]
    with pytest.raises(gx.InputError, match="GX204"):
        blocks(*lines, "L X+6")


@pytest.mark.parametrize("change", ["Q202=10", "Q201=15", "Q204=1", "Q210=1", "Q395=1", "Q299=1"])
def test_other_holes_are_not_certain(change):
    lines = [*HOLE.split("|"), "Q204=50 ~", "Q211=0", "L X+5 Y+5 Z+60 FMAX M99"]
    name = change.partition("=")[0]
    kept = [line for line in lines if not line.startswith(name)]
    with pytest.raises(gx.InputError, match="GX215"):
        blocks(*kept[:-2], f"{change} ~", *kept[-2:])


PECKED = ["CYCL DEF 1.0 PECKING", "CYCL DEF 1.1 DIST2.000", "CYCL DEF 1.2 DEPTH-7.5"]
PECKED += ["CYCL DEF 1.3 PLNGNG3.0", "CYCL DEF 1.4 DWELL0,2", "CYCL DEF 1.5 F276"]


def test_strokes_of_the_old_cycle():
    first = ["G0 X1 Y1 Z12", "G1 Z7 F276", "G0 Z12", "Z7.6", "G1 Z4 F276", "G0 Z12", "Z4.6"]
    last = ["G1 Z2.5 F276", "G4 P0.2", "G0 Z12"]
    assert blocks(*PECKED, "L X+1 Y+1 Z+12 FMAX M99") == [*first, *last]
    with pytest.raises(gx.InputError, match="GX207"):
        blocks(*PECKED, "L X+1 Y+1 FMAX M99")
    with pytest.raises(gx.InputError, match="GX215"):
        blocks(*PECKED[:-1], "L X+1 Y+1 Z+12 FMAX M99")


@pytest.mark.parametrize(("depth", "near"), [("-30", 7.6), ("-40", 7.8), ("-500", 14.0)])
def test_how_far_before_the_hole_it_stops(depth, near):
    """0.6 mm, or a fiftieth of holes that are deeper than 30 mm, up to 7 mm."""
    lines = [*PECKED]
    lines[2] = f"CYCL DEF 1.2 DEPTH{depth}"
    lines[1] = "CYCL DEF 1.1 DIST20"
    height = 30.0
    path = read(program(*lines, f"L X+1 Y+1 Z+{height} FMAX M99"))
    assert path.end[3, 2] == pytest.approx(near)


@pytest.mark.parametrize("lines", [["M128", "L C+30 F50", "M129"], ["L C+30 FMAX", "M128"]])
def test_behind_a_switch_with_turned_axes_places_are_lost(lines):
    """What X, Y and Z show then is another place, so that steps count from nowhere known."""
    here = ["L X+1 Y+2 Z+3 C+0 FMAX", *lines]
    with pytest.raises(gx.InputError, match="GX207"):
        read(program(*here, "L IX+1 FMAX"))
    assert len(read(program(*here, "L X+1 FMAX", "L IX+1 F5")))
    straight = [line.replace("+30", "+360") for line in here]
    assert len(read(program(*straight, "L IX+1 FMAX")))


def test_labels_in_labels():
    lines = ["L X+0 FMAX", "LBL 1", "CALL LBL 2", "LBL 3", "L IX+1 FMAX", "CALL LBL 3 REP 2"]
    lines += ["CALL LBL 1 REP 1", "M30", "LBL 2", "L IX+100 FMAX", "LBL 0", "nonsense"]
    places = (0, 100, 101, 102, 103, 203, 204, 205, 206)
    assert [block[-3:].strip("X ") for block in blocks(*lines)] == [f"{n}" for n in places]
    assert blocks("L X+0 FMAX", 'CALL LBL "a"', "M30", 'LBL "A"', "L IX+2 FMAX", "LBL 0")[1] == "X2"


def test_a_slash_is_what_the_setting_says():
    lines = ["L X+1 FMAX", "/ L X+2 FMAX", "5 / L X+3 FMAX", "/5 L X+4 FMAX"]
    assert blocks(*lines, block_delete="skip") == ["G0 X1"]
    assert blocks(*lines, block_delete="execute") == ["G0 X1", "X2", "X3", "X4"]
    with pytest.raises(gx.InputError, match="GX211"):
        blocks(*lines)


def test_a_start_is_in_mm_also_in_inches():
    assert blocks("L IX+1 FMAX", unit="INCH", start={"X": 25.4}) == ["G0 X2"]


def test_m_functions_of_a_machine_move_nothing_where_it_is_said():
    assert blocks("L X+1 FMAX M25", inert_m=frozenset({25})) == ["M25", "G0 X1"]


# --- five axes ---

CONTROL = '[control]\ntip-on = "M428"\ntip-off = "M429"\n'
TIPS = [
    *(["X10. Y5. Z3. A0. C0. F600.", "X12.5 Y7. Z4. A20. C30.", "X13. Y7.5 Z4. A10. C-40."]),
    *(["Z3.25 F450.", "X9. Y2. A0. C0."]),
]
ON = ["M128", "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS"]
OFF = ["M129", "FUNCTION RESET TCPM"]


def klartext(on, off):
    """Return the program of tips for a TNC."""
    signed = [re.sub(r"([XYZAC])(?=\d)", r"\1+", line) for line in TIPS]
    lines = [
        "TOOL CALL 1 Z",
        "L X+0. Y+0. Z+90. A+0. C+0. R0 FMAX M3",
        on,
        *(f"L {t}" for t in signed),
    ]
    return program(*lines, off, "L Z+90. FMAX M5", "M30").encode()


def by_hand():
    """Return the same program for LinuxCNC, with the switches of its machine."""
    lines = ["G21 G17 G90 G94", "T1 M6", "G43 H1", "M3", "G0 X0. Y0. Z90. A0. C0.", "M428"]
    lines += [f"{'G1 ' * (not k)}{line}" for k, line in enumerate(TIPS)]
    return "\n".join([*lines, "M429", "G0 Z90.", "M5", "M30", ""]).encode()


def five_axes(folder, source, passes=("segment", "rtcp")):
    """Return the pipeline from a dialect to LinuxCNC on a trunnion."""
    folder.mkdir()
    machine = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 3)) + CONTROL
    (folder / "machine.toml").write_text(machine)
    options = {"segment": 'chord-error = "1 um"', "rtcp": 'tolerance = 0.01\ntip-codes = "read"'}
    steps = [f'[[pass]]\nuse = "{name}"\n{options.get(name, "")}\n' for name in passes]
    text = f'format = 1\n[input]\ndialect = "{source}"\n[output]\ndialect = "linuxcnc"\n'
    text += "stamp = false\n"
    text += '[machine]\nfile = "machine.toml"\n[[pass]]\nuse = "absolute"\n'
    (folder / "p.toml").write_text(text + "".join(steps))
    return gx.Pipeline.load(folder / "p.toml")


@pytest.mark.parametrize("on", ON)
@pytest.mark.parametrize("off", OFF)
def test_tips_become_the_axes_that_linuxcnc_programs_become(tmp_path, on, off):
    ours = five_axes(tmp_path / "a", "heidenhain").run(klartext(on, off))
    theirs = five_axes(tmp_path / "b", "linuxcnc").run(by_hand())
    assert ours.certificate.verified
    assert b"M12" not in ours.text
    assert len(ours.text.splitlines()) > len(TIPS) + 9
    assert behind_the_tool(ours.text) == behind_the_tool(theirs.text)


def behind_the_tool(text):
    """Return what stands behind the tool change.

    On a TNC it may move axes, so that it is made in G94, and G93 is said again behind it.
    """
    head, length, rest = text.partition(b"G43 H1")
    assert b"T1 M6" in head
    assert length
    return rest.replace(b"G93 ", b"")


@pytest.mark.parametrize("passes", [("segment",), ()])
@pytest.mark.parametrize("on", ON)
def test_what_the_control_follows_is_not_corrected_twice(tmp_path, passes, on):
    with pytest.raises(gx.InputError, match="M128") as error:
        five_axes(tmp_path / "a", "heidenhain", passes).run(klartext(on, "M129"))
    found = error.value.diagnostics[0]
    assert (found.code, found.where.line, found.where.text) == ("GX210", 4, on)


# --- real programs ---

READ = {
    "0D.h": 1,
    "DangaRPT-CNC_Prog/test.h": 1571,
    "parts-2021/basemach/11.h": 2277,
    "parts-2022/Dem-target1/11.h": 110,
    "parts-2022/Dem-target2/11.h": 527,
    "parts-2022/Interface-glue/11.h": 6421,
    "WALLX20X20.h": 49,
    "MEASTOK.h": 1,
    "LP.nc": 10,
}
WHY = {
    "DASHCEN.h": (24, "Q1 has a value that only the control knows"),
    "RECTIFI.h": (16, "IZ counts"),
    "PRINTR1.h": (18, "Q12 has a value"),
    "0TREF.h": (37, "Q12 has a value"),
    "CALL_PGM.nc": (8, "CALL PGM100"),
    "RND.nc": (11, "RND"),
    "CYCL_DEF_10.nc": (3, "TOOL DEF1"),
    "Teflon-gasket/11.h": (53, "cycle 1 counts from where Z stands"),
    ".nc": (3, "TOOL DEF1"),
}


@pytest.mark.skipif(not REAL.is_dir(), reason="the collection of real programs is absent")
def test_real_programs():
    """Each is read, with as many moves as were counted, or refused where it should be."""
    found = sorted(path for path in REAL.rglob("*") if path.is_file())
    assert len(found) >= len(READ) + len(WHY)
    for path in found:
        name = path.as_posix()
        moves = next((n for end, n in READ.items() if name.endswith(end)), None)
        if moves is not None:
            assert len(gx.read(path, DIALECT).path) == moves
            continue
        line, why = next(told for end, told in WHY.items() if name.endswith(end))
        with pytest.raises(gx.InputError, match=why) as error:
            gx.read(path, DIALECT).path  # noqa: B018
        assert error.value.diagnostics[0].where.line == line


CONTOUR = ["TOOL CALL 2 Z", "L X-10 Y-5 Z+0 R0 FMAX", "L X+0 Y+0 RL F100", "L Y+20", "L X+20 RL"]
CONTOUR += ["L Y+0", "CC X+20 Y-5", "C X+20 Y-10 DR-", "L X+10 Y-20 R0", "L X+5 R0"]


def test_beside_a_contour_it_is_read_as_g41(tmp_path):
    assert blocks(*CONTOUR)[2:] == [
        *["G0 X-10 Y-5 Z0", "G41 D2 G1 X0 Y0 F100", "Y20", "X20", "Y0"],
        *["G2 X20 Y-10 I0 J-5", "G40 G1 X10 Y-20", "X5"],
    ]
    path = read(program(*CONTOUR), tools=TOOLS)
    assert path.side.tolist() == [0, 1, 1, 1, 1, 1, 0, 0]
    assert path.radius[1:6].tolist() == [1.0] * 5
    ours = beside(tmp_path / "a", "heidenhain", program(*CONTOUR).encode())
    theirs = ["G21 G17 G90 G94", "T2 M6", "G43 H2", *blocks(*CONTOUR)[2:], "M30"]
    pointed = re.sub(r"([XYZIJ]-?\d+)", r"\1.", "\n".join(theirs))
    assert ours == beside(tmp_path / "b", "fanuc", pointed.encode())


def beside(folder, source, text):
    """Return the words of X and Y of the path of the tool's centre."""
    folder.mkdir()
    (folder / "m.toml").write_text(
        "format = 1\n[axis.X]\n[axis.Y]\n[axis.Z]\n[tool.2]\nradius = 1.0\n"
    )
    (folder / "p.toml").write_text(
        f'format = 1\n[input]\ndialect = "{source}"\n[output]\ndialect = "linuxcnc"\n'
        '[machine]\nfile = "m.toml"\n[[pass]]\nuse = "absolute"\n'
        '[[pass]]\nuse = "cutter-comp"\ncorners = "arc"\nentry = "next"\n'
    )
    result = gx.Pipeline.load(folder / "p.toml").run(text)
    assert result.certificate.verified
    return re.findall(r"[XYIJ][-.\d]+", result.text.decode())
