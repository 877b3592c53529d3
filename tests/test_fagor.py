"""Programs of a Fagor 8065: against a reader of its own, broken ones, and five axes to the end."""

from __future__ import annotations

import math
import re
from decimal import Decimal

import numpy as np
import pytest
from reference import fagor as reference
from seeds_kit import some

import gcxform as gx
from gcxform.contract.tip_codes import with_switches
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

FAGOR = default_registry().dialect("fagor")
LENGTH = {"tool-length-axis": "Z"}
TIPS = with_switches(FAGOR, {})  # as rtcp reads it
KINDS = {gx.Kind.RAPID: "rapid", gx.Kind.LINE: "line", gx.Kind.ARC_CW: "cw", gx.Kind.ARC_CCW: "ccw"}


class Programs:
    """Writes random programs; places are counted in micrometres and thousandths of a degree."""

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng(seed)
        self.at: dict[str, int | None] = dict.fromkeys("XYZABC", 0)
        self.incremental = False
        self.fresh: set[str] = set()  # axes whose last coordinate holds
        self.lines: list[str] = []

    def one(self, *choices):
        return choices[int(self.rng.integers(len(choices)))]

    def number(self, steps: int) -> str:
        """Return steps as one of the ways to write a number."""
        text = f"{Decimal(steps) / 1000:f}"
        if "." in text:
            text = text.rstrip("0").rstrip(".") if self.rng.random() < 0.5 else text
        elif self.rng.random() < 0.3:
            text += "."
        if steps >= 0 and self.rng.random() < 0.1:
            text = f"+{text}"
        return re.sub(r"^(-?)0\.(?=\d)", r"\1.", text) if self.rng.random() < 0.1 else text

    def word(self, name: str, steps: int) -> str:
        gap = self.one("", "", "", "=", " = ", " " if name != "I" else "")
        name = name.lower() if self.rng.random() < 0.1 else name
        return f"{name}{gap}{self.number(steps)}"

    def axis(self, name: str, to: int) -> str:
        """Return the word that brings an axis to a place, and keep that in mind."""
        before, self.at[name] = self.at[name], to
        counted = name in self.fresh
        self.fresh |= set() if self.incremental else {name}
        if not self.incremental and (not counted or self.rng.random() < 0.6):
            return self.word(name, to)
        mark = self.one("I", "i", "I") if not self.incremental or self.rng.random() < 0.2 else ""
        return self.word(name, to - before) + mark

    def put(self, *words: str) -> None:
        """Write a line, with what may stand around its words."""
        text = self.one(" ", "", " ").join(words) if len(words) > 1 else words[0]
        if any(word[-1:] in "Ii" for word in words):
            text = " ".join(words)
        head = self.one(
            "", "", "", f"N{len(self.lines)} ", f"N{len(self.lines)}: ", "[HERE] ", "\t"
        )
        tail = self.one("", "", "", " ; X1 (", " (G1 X9)", "(to the end")
        self.lines.append(f"{head}{text}{tail}")

    # --- blocks ---

    def straight(self) -> None:
        known = [name for name in "XYZABC" if self.at[name] is not None]
        names = [name for name in known if self.rng.random() < 0.4] or ["X"]
        self.rng.shuffle(names)
        words = [self.axis(name, int(self.rng.integers(-99_999, 99_999))) for name in names]
        self.put(self.one("G0", "G1", "g01", "G00", "G 1"), *words)

    def feed(self) -> None:
        self.put("G1", f"F{int(self.rng.integers(1, 3000))}")

    def arc(self) -> None:
        plane = self.one("G17", "G18", "G19")
        u, v, w = reference.PLANES[int(plane[1:])]
        cu, cv = (int(value) for value in self.rng.integers(-30_000, 30_000, 2))
        if abs(cu) + abs(cv) < 1000:
            return
        turn = self.one("full", "quarter", "half")
        su, sv = self.at[u], self.at[v]
        ends = {"full": (0, 0), "half": (2 * cu, 2 * cv), "quarter": (cu + cv, cv - cu)}[turn]
        letters = {"X": "I", "Y": "J", "Z": "K"}
        words, code = [], self.one("G2", "G3")
        if turn != "full":
            words = [self.axis(u, su + ends[0]), self.axis(v, sv + ends[1])]
            if self.rng.random() < 0.3:
                words.append(self.axis(w, int(self.rng.integers(-9_999, 9_999))))
        if self.rng.random() < 0.3:
            centre = [self.word(letters[u], su + cu), self.word(letters[v], sv + cv)]
            self.put(plane, "G6", code, *words, *centre)
            return
        centre = [self.word(letters[u], cu), self.word(letters[v], cv)]
        self.put(plane, code, *words, *centre)

    def with_radius(self) -> None:
        cu = int(self.rng.integers(1000, 30_000))
        ends = self.axis("X", self.at["X"] + cu), self.axis("Y", self.at["Y"] + cu)
        radius = self.one(cu, -cu)
        self.put("G17", self.one("G2", "G3"), *ends, self.word("R", radius))

    def distances(self) -> None:
        self.incremental = not self.incremental
        self.fresh = set()
        self.put("G91" if self.incremental else "G90")

    def marked(self) -> None:
        """All of a block is incremental, wherever it counts from."""
        words = []
        for name in ("X", "Y", self.one("A", "B", "C", "Z")):
            step = int(self.rng.integers(-999, 999))
            self.at[name] += step
            words.append(f"{self.word(name, step)}I")
        self.put("G1", *words)

    def tips(self) -> None:
        """Switch with all axes at 0: with one turned X, Y and Z would not be known behind it."""
        if any(self.at[name] is None for name in "ABC"):
            return
        self.put("G0", *(self.axis(name, 0) for name in "ABC"))
        self.fresh = set()
        self.lines.append(self.one("#RTCP ON", "#RTCP OFF", "#rtcp  on ; now", " N5 #RTCP\tOFF"))

    def quiet(self) -> None:
        self.put(
            self.one("G4 K1.5", "G5", "G7", "G80", "S1000 M3", "M8", "#HSC ON [CONTERROR 0.1]")
        )

    def tool(self) -> None:
        number = int(self.rng.integers(1, 5))
        self.lines += self.one(
            [f"T{number} M6", "D1"],
            [f"T{number} D1", "M6"],
            [f"T{number}", "M6", "(then)", "D1"],
            [f"T{number} D1 M6"],
            [f"T{number} M6", "D0"],
        )
        self.place()

    def place(self) -> None:
        self.at, self.fresh = dict.fromkeys(self.at), set()
        self.incremental = False
        words = [self.axis(name, int(self.rng.integers(-9999, 9999))) for name in "XYZABC"]
        self.put("G90", "G0", *words)

    def unit(self) -> None:
        self.lines.append(f"G71 F{int(self.rng.integers(1, 99))}")
        self.place()

    def program(self) -> str:
        """Return a program of some thirty blocks."""
        self.lines = ["%RANDOM", "G71 G90 G17 G94 G54", "G1 F100"]
        self.place()
        verbs = (
            [self.straight] * 6 + [self.arc] * 4 + [self.with_radius, self.distances, self.marked]
        )
        verbs += [self.feed, self.tips, self.quiet, self.tool, self.unit]
        for _ in range(30):
            self.one(*verbs)()
        end = self.one("\n", "\r\n", "\r")
        return end.join([*self.lines, "M30", "what is behind it ?"])


def told(program: gx.Program) -> list[reference.Move]:
    """Return the moves of a program as the package reads it."""
    path, moves = program.path, []
    for row in range(len(path)):
        end = {
            a: None if math.isnan(p) else p for a, p in zip(path.axes, path.words[row], strict=True)
        }
        kind = KINDS[gx.Kind(int(path.kind[row]))]
        frame = path.frames[int(path.frame[row])]
        length = [origin.partition(" + ")[2] for origin in frame.origin[2:3]]
        line = program.line_of(int(path.source[row]) + 1)
        feed = None if kind == "rapid" else float(path.feed[row])
        move = reference.Move(line, kind, end, feed, following=frame.following, length=length[0])
        if kind in ("cw", "ccw"):
            centre = path.local(path.centre)[row]
            move.centre = {a: p for a, p in zip("XYZ", centre, strict=True) if not math.isnan(p)}
            move.sweep = float(path.sweep[row])
        moves.append(move)
    return moves


def same(a: reference.Move, b: reference.Move) -> bool:
    """Whether two moves are the same; axes that are never named need not be told."""
    names = a.end.keys() & b.end.keys()
    ends = [(a.end[name], b.end[name]) for name in names]
    ends += [(a.centre.get(name, 0.0), b.centre[name]) for name in b.centre]
    ends += [(a.sweep, b.sweep), (a.feed, b.feed)]
    close = all((x is None) == (y is None) and abs((x or 0) - (y or 0)) < 1e-6 for x, y in ends)
    alike = (a.line, a.kind, a.following, a.length) == (b.line, b.kind, b.following, b.length)
    return close and alike and "X" in names


@pytest.mark.parametrize("seed", some(60))
def test_it_reads_what_another_reader_reads(seed):
    text = Programs(seed).program()
    ours, theirs = told(gx.read(text.encode("latin-1"), TIPS, control=LENGTH)), reference.read(text)
    for mine, other in zip(ours, theirs, strict=False):
        assert same(mine, other), f"{mine}\n{other}\n{text}"
    assert len(ours) == len(theirs)


@pytest.mark.parametrize("seed", some(40))
def test_broken_programs_are_diagnosed(seed):
    """Cut, shuffled, overwritten: what is read is read without a traceback, or a place is named."""
    rng = np.random.default_rng(seed)
    text = bytearray(Programs(seed).program().encode("latin-1"))
    for _ in range(int(rng.integers(1, 6))):
        at = int(rng.integers(len(text)))
        what = int(rng.integers(4))
        if what == 0:
            text[at : at + 1] = bytes([int(rng.integers(256))])
        elif what == 1:
            del text[at : at + int(rng.integers(1, 9))]
        elif what == 2:
            text[at:at] = rng.choice(
                [b"I", b" I", b"X", b"(", b"[", b"#", b"$", b"=", b"NR", b"P1"]
            )
        else:
            del text[at:]
        text = text or bytearray(b" ")
    try:
        path = gx.read(bytes(text), TIPS).path
    except gx.InputError as error:
        for found in error.diagnostics:
            assert found.where is not None
            assert 1 <= found.where.line <= max(1, len(re.split(rb"\r\n|\n|\r", bytes(text))))
    else:
        assert np.isin(path.kind, [*KINDS]).all()


@pytest.mark.parametrize("text", [b"", b"\n", b"\0" * 99, b"%", b"%\n", b"(", b";", b"N1", b"[A]"])
def test_programs_with_nothing_in_them(text):
    assert len(gx.read(text, FAGOR).path) == 0


@pytest.mark.parametrize(
    "text", [b"#RTCP ON #HSC ON", b"\x80\xff", bytes(range(256)), b"G", b"X", b"10", b"#", b"/1"]
)
def test_noise(text):
    with pytest.raises(gx.InputError, match="GX"):
        _ = gx.read(text, FAGOR).path


# --- five axes, to the end ---

MACHINE = """format = 1
kinematics = "ac-trunnion"
[axis.X]
[axis.Y]
[axis.Z]
[axis.A]
point = [1.0, 2.0, 3.0]
limits = [-100.0, 100.0]
[axis.C]
point = [0.5, 0.0, 0.0]
[work-offset.G54]
[tool.1]
length = 50.0
[tool.2]
length = 70.0
"""
CONTROL = '[control]\ntip-on = "M428"\ntip-off = "M429"\n'
PIPELINE = """format = 1
[input]
dialect = "{source}"
[output]
dialect = "linuxcnc"
stamp = false
[machine]
file = "{machine}"
[[pass]]
use = "absolute"
[[pass]]
use = "segment"
chord-error = "1 um"
"""
RTCP = '[[pass]]\nuse = "rtcp"\ntolerance = "0.01 mm"\ntip-codes = "read"\n'


def five_axes(seed: int) -> tuple[bytes, bytes]:
    """Return a program for a Fagor, and the same for a LinuxCNC with M428 and M429."""
    rng = np.random.default_rng(seed)
    ours, theirs = ["%FIVE"], []

    def both(one: str, *other: str) -> None:
        ours.append(one)
        theirs.extend(other or (one,))

    both("G71 G90 G17 G94 G54", "G21 G90 G17 G94 G54")
    for tool in (1, 2):
        both(f"T{tool} M6 ; tool {tool}", f"T{tool} M6 (tool {tool})")
        both("D1", f"G43 H{tool}")
        both("#KIN ID[1]", *())
        if theirs[-1] == "#KIN ID[1]":
            theirs.pop()
        both("N5 G0 X0 Y0 Z90 A0 C0 (up")
        theirs[-1] += ")"
        both("#RTCP ON", "M428")
        x = y = z = Decimal(0)
        both("G1 X0 Y0 Z10 F700")
        z = Decimal(10)
        for _ in range(6):
            dx, dy, dz = (Decimal(int(n)) / 1000 for n in rng.integers(-9000, 9000, 3))
            a, c = (Decimal(int(n)) / 100 for n in rng.integers(-3000, 3000, 2))
            x, y, z = x + dx, y + dy, z + dz
            both(f"X{dx}I Y{dy}I Z{z} A{a} C{c}", f"X{x} Y{y} Z{z} A{a} C{c}")
        both("X0 Y0 A0 C0")
        both("G2 X10 Y0 I5 J0")
        both("N9 #RTCP OFF", "N9 M429")
        both("G0 Z99")
    both("D0", "G49")
    both("M30")
    return "\n".join([*ours, ""]).encode(), "\n".join([*theirs, ""]).encode()


def pipeline(folder, source: str, control: str = "", passes: str = RTCP) -> gx.Pipeline:
    name = f"{source}.machine.toml"
    (folder / name).write_text(MACHINE + control)
    place = folder / f"{source}.toml"
    place.write_text(PIPELINE.format(source=source, machine=name) + passes)
    return gx.Pipeline.load(place)


def meant(text: bytes) -> list[list[tuple[str, float]]]:
    """Return the words of each line, but for G93 and G94.

    M6 of a Fagor runs a program, so G94 is in force before it, and positions are written behind it.
    """
    lines = re.sub(rb"\([^)]*\)", b"", text).decode().split("\n")
    words = [re.findall(r"([A-Z]) *(-?[0-9.]+)", line) for line in lines]
    numbers = [[(name, float(number)) for name, number in line] for line in words]
    return [[word for word in line if word not in {("G", 93), ("G", 94)}] for line in numbers]


@pytest.mark.parametrize("seed", range(4))
def test_five_axes_come_out_as_those_of_a_program_by_hand(tmp_path, seed):
    ours, theirs = five_axes(seed)
    done = pipeline(tmp_path, "fagor").run(ours)
    by_hand = pipeline(tmp_path, "linuxcnc", CONTROL).run(theirs)
    assert done.certificate.verified
    assert meant(done.text) == meant(by_hand.text)
    assert b"M428" not in done.text
    assert b"M128" not in done.text
    lines = ours.split(b"\n")
    for line, source in zip(done.text.split(b"\n"), done.source_map, strict=False):
        if b"(up)" in line:
            assert lines[source].startswith(b"N5 G0 X0")


@pytest.mark.parametrize("size", [1, 60, 0])
def test_windows_of_any_size_are_alike(tmp_path, size):
    ours, _ = five_axes(9)
    step = pipeline(tmp_path, "fagor")
    parts = []
    Run(step, Source.of_bytes(ours), "on").over(Output(parts.append, None), abs, size)
    assert b"".join(parts) == step.run(ours).text


@pytest.mark.parametrize("passes", ["", '[[pass]]\nuse = "metric"\n'])
def test_tips_are_not_corrected_twice(tmp_path, passes):
    ours, _ = five_axes(1)
    with pytest.raises(gx.InputError) as error:
        pipeline(tmp_path, "fagor", passes=passes).run(ours)
    (found, *_) = error.value.diagnostics
    assert found.code == "GX210"
    assert found.message.startswith("#RTCP ON is not resolved")
    assert found.where.text == "#RTCP ON"


def test_where_axes_are_turned_the_word_of_the_control_is_named(tmp_path):
    """On great circles it has to be switched with all axes at 0; else a rapid says all again."""
    ours, _ = five_axes(1)
    late = ours.replace(b"X0 Y0 A0 C0\nG2 X10 Y0 I5 J0\n", b"")
    place = tmp_path / "great.toml"
    pipeline(tmp_path, "fagor")
    head, _, _ = PIPELINE.format(source="fagor", machine="fagor.machine.toml").partition(
        '[[pass]]\nuse = "segment"'
    )
    place.write_text(f'{head}{RTCP}orientation-path = "great-circle"\n')
    with pytest.raises(gx.InputError, match="#RTCP OFF where not all") as error:
        gx.Pipeline.load(place).run(late.replace(b"G2 X10 Y0 I5 J0\n", b""))
    assert error.value.diagnostics[0].where.text == "N9 #RTCP OFF"
    step = pipeline(tmp_path, "fagor", passes=RTCP + 'rapids = "ends"\n')
    assert step.run(late.replace(b"G0 Z99", b"G0 X1 Y2 Z99")).certificate.verified


def test_a_tool_change_takes_d0_away():
    text = b"G71 G90 G17 G94 G54\nT3 M6\nD0\nT4 M6\n#MCS ON\nG0 Z9\n#MCS OFF\n"
    with pytest.raises(gx.InputError, match="whether a tool length is in them"):
        _ = gx.read(text, FAGOR).path
