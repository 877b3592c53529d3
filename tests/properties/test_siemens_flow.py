"""Programs for a SINUMERIK that compute, decide, call, turn frames and drill, beside a reference.

The reference (`tests/reference/siemens_flow.py`) is written from the manuals and shares nothing
with the package. Programs are drawn so that they end, and take no rule that is left open.
"""

from __future__ import annotations

import random

import pytest
from oracles.toolpaths import moves_of
from reference.siemens_flow import moves
from seeds_kit import DRAWN, shares

import gcxform as gx
from gcxform.plugin.registry import default_registry

SIEMENS = default_registry().dialect("siemens")
KINDS = {"RAPID": "0", "LINE": "1"}
NEAR = 2e-6
CONTROL = {"section-repeats": "further"}
FILES = {
    "ALONG": "PROC ALONG(REAL TX=1, INT TY, VAR REAL SUM)\nG1 X=TX Y=TY\nSUM=SUM+TX\nM17\n",
    "TWICE": "PROC TWICE(INT MN)\nDEF INT K_\nFOR K_=1 TO MN+1\nY=2*K_\nENDFOR\nRET\n",
    "PLAIN": "PROC PLAIN\nG0 Z=IC(1)\nG1 X3\nM17\n",
}


class Builder:
    """Makes random programs."""

    def __init__(self, seed):
        self.draw = random.Random(seed)
        self.lines = [
            "DEF REAL AA=1.5, BB=2",
            "DEF INT NN=3, MM",
            "DEF REAL CC[4]",
            "R1=1 R2=-2.5 R3=7",
        ]
        self.lines += ["G90 G94 G17 G710 G54", "G0 X1 Y2 Z3", "G1 F100"]
        self.labels = 0
        self.shifted, self.turned = set(), False
        self.counters = ["KA", "KB", "KC"]
        self.lines.insert(0, "DEF INT " + ", ".join(self.counters))

    def pick(self, *of):
        return self.draw.choice(of)

    def number(self):
        return self.pick("0.5", "1", "2", "3.25", "7", "-4", "10.125")

    def value(self, depth=2):
        """Return an expression that is defined everywhere."""
        kind = self.draw.randrange(9) if depth else self.draw.randrange(2)
        if kind == 0:
            return self.number()
        if kind in (1, 2):
            return self.pick(
                "R1", "R2", "R3", "AA", "BB", "NN", "MM", f"CC[{self.draw.randrange(4)}]"
            )
        a, b = self.value(depth - 1), self.value(depth - 1)
        if kind in (3, 4):
            sign = self.pick("+", "-", "*")
            return f"{a}{sign}{b.replace('-', '', 1) if b.startswith('-') else b}"
        if kind == 5:
            return f"({a}{self.pick('+', '-')}({b}))*{self.pick('0.5', '0.25', '-1')}"
        if kind == 6:
            return self.pick("SIN({})", "COS({})", "ABS({})", "TRUNC({})", "ROUNDUP({})").format(a)
        if kind == 7:
            return self.pick("MINVAL({},{})", "MAXVAL({},{})").format(a, b)
        return f"(ABS({a})+7) / 3"

    def bounded(self):
        """Return an expression whose worth is small."""
        return self.pick(f"SIN({self.value()})*10", f"COS({self.value()})*7+1", self.number())

    def condition(self):
        a, b = self.value(1), self.value(1)
        one = f"({a}{self.pick('>', '<', '>=', '<=')}{b}+0.0137)"
        return self.pick(one, f"{one} {self.pick('AND', 'OR', 'XOR')} (NN<3)", f"NOT {one}")

    def block(self):
        """Return a move."""
        axes = self.draw.sample("XYZ", self.draw.randint(1, 3))
        words = []
        for axis in axes:
            way = self.pick("{}={}", "{}={}", "{}=AC({})", "{}=IC({})")
            if self.shifted & {axis}:
                way = "{}=AC({})"
            words.append(way.format(axis, self.bounded()))
        self.shifted -= {*axes}
        return f"{self.pick('G0', 'G1', '')} {' '.join(words)}".strip()

    def statement(self, depth):
        kind = self.draw.randrange(16 if depth else 6)
        put = self.lines.append
        if kind < 3:
            put(self.block())
        elif kind == 3:
            target = self.pick(
                "R1", "R2", "R3", "AA", "BB", f"CC[{self.draw.randrange(4)}]", "R[3]"
            )
            put(f"{target}={self.bounded()}")
        elif kind == 4:
            put(f"NN=ABS({self.bounded()}) MM=TRUNC({self.bounded()})")
        elif kind == 5:
            put(self.called())
        elif kind < 9:
            self.decided(depth)
        elif kind < 12:
            self.looped(depth)
        elif kind == 12:
            self.framed()
        elif kind == 13:
            self.polar()
        else:
            self.drilled()

    def called(self):
        values = f"({self.bounded()},{self.bounded()},AA)"
        return self.pick(f"ALONG{values}", "ALONG(,2,BB)", "TWICE(1)", "PLAIN", "PLAIN P2")

    def section(self, depth):
        for _ in range(self.draw.randint(1, 3)):
            self.statement(depth - 1)

    def decided(self, depth):
        put, kind = self.lines.append, self.draw.randrange(3)
        before = {*self.shifted}
        self.shifted = {*"XYZ"}
        if kind == 0:
            put(f"IF {self.condition()}")
            self.section(depth)
            if self.draw.random() < 0.5:
                put("ELSE")
                self.shifted = {*"XYZ"}
                self.section(depth)
            put("ENDIF")
        elif kind == 1:
            self.labels += 1
            label = f"LAB{self.labels}"
            put(f"IF {self.condition()} GOTOF {label}")
            self.section(depth)
            put(f"{label}: R9=1")
        else:
            self.labels += 3
            one, two, end = (f"LAB{self.labels - k}" for k in range(3))
            put(f"CASE (NN) OF 1 GOTOF {one} 3 GOTOF {two} DEFAULT GOTOF {end}")
            put(f"{one}: G1 X1 Y1 Z1")
            put(f"{two}: G1 Z4 X=AC(2)")
            put(f"{end}: R9=2")
        self.shifted = {*"XYZ"} if self.turned else before

    def looped(self, depth):
        if not self.counters:
            return
        put, counter, kind = self.lines.append, self.counters.pop(), self.draw.randrange(5)
        self.shifted = {*"XYZ"} if self.turned else {*self.shifted}
        if kind == 0:
            put(f"FOR {counter}={self.pick('1', '2')} TO {self.pick('0', '2', '3')}")
            self.section(depth)
            put("ENDFOR")
        elif kind == 1:
            put(f"{counter}=0")
            put(f"WHILE {counter}<2")
            self.section(depth)
            put(f"{counter}={counter}+1")
            put("ENDWHILE")
        elif kind == 2:
            put(f"{counter}=0")
            put("REPEAT")
            self.section(depth)
            put(f"{counter}={counter}+1")
            put(f"UNTIL {counter}>=2")
        elif kind == 3:
            self.labels += 1
            put(f"LAB{self.labels}: {counter}={counter}+1")
            for _ in range(self.draw.randint(1, 3)):
                self.statement(0)  # no jump, which may leave it
            put(f"REPEAT LAB{self.labels}{self.pick('', ' P=1', f' P={counter}+3-{counter}')}")
        else:
            self.labels += 1
            label = f"LAB{self.labels}"
            put(f"{counter}=0")
            put("LOOP")
            put(f"{counter}={counter}+1")
            put(f"IF {counter}>2 GOTOF {label}")
            self.section(depth)
            put("ENDLOOP")
            put(f"{label}: R9=3")

    def framed(self):
        angle = self.pick("30", "90", "-45", "R3")
        self.lines.append(
            self.pick(
                f"TRANS X={self.bounded()} Y4",
                f"ATRANS Z={self.bounded()}",
                f"ROT RPL={angle}",
                f"AROT RPL={angle}",
                "AROT X20 Y-30 Z10",
                "ROT Y15",
                "AMIRROR X0",
                "MIRROR Y0",
                "SCALE X2 Y2 Z2",
                "ASCALE X0.5 Y0.5 Z0.5",
                "TRANS",
                "ROT",
            )
        )
        self.shifted, self.turned = {*"XYZ"}, True
        told = self.pick("XYZ", "XYZ", "YZ", "X")
        self.lines.append("G0 " + " ".join({"X": "X1", "Y": "Y=BB", "Z": "Z5"}[a] for a in told))
        self.shifted -= {*told}

    def polar(self):
        if self.shifted & {*"XY"}:
            pole = f"G111 X{self.number()} Y={self.bounded()}"
        else:
            pole = f"{self.pick('G110', 'G111')} X={self.bounded()} Y{self.number()}"
        self.lines += [pole, f"G1 F100 RP=ABS({self.bounded()})+1 AP={self.bounded()}"]
        for _ in range(self.draw.randrange(3)):
            far = f"RP={self.pick('2', '0.5', 'ABS(AA)')}"
            polar = f"G112 {far} AP={self.number()}"
            on = f"AP=IC({self.bounded()})"
            self.lines += self.pick(
                [f"AP={self.bounded()} Z1"], [far], [on], [polar, f"{far} AP=R1"]
            )
            if "Z1" in self.lines[-1]:
                self.shifted -= {"Z"}
        self.shifted -= {*"XY"}

    def drilled(self):
        depth = self.pick("-3.5", "", "-10")
        levels = f"9,1,0.5,{depth},{'' if depth else '4'}"
        feeds, first = "100,250", self.pick("-1", "0.25", "-2.5")
        strokes = f"{first},,0,{self.pick('', '0.5')},,1,{self.pick('0', '1')},,,1.25,,0.75"
        hole, words = self.pick(
            ("CYCLE81", levels),
            ("CYCLE82", levels),
            ("CYCLE83", f"{levels},{strokes}"),
            ("CYCLE85", f"{levels},,{feeds}"),
            ("CYCLE89", f"{levels},0.5"),
        )
        to = "G0 " if hole == "CYCLE85" else ""  # behind it no feed is in force
        self.lines.append("G1 F100")
        if self.draw.random() < 0.5:
            self.lines.append(f"{hole}({words})")
        else:
            self.lines += [f"MCALL {hole}({words})", f"{to}X4", f"{to}X=AC({self.bounded()}) Y3"]
            if self.draw.random() < 0.5:
                self.lines.append("HOLES2(1,2,5,30,0,3)")
            self.lines.append("MCALL")
        self.lines.append("F100")

    def text(self):
        for _ in range(self.draw.randint(4, 9)):
            self.statement(2)
        return "\n".join([*self.lines, "M30", ""])


def check(seed, folder):
    """Compare what a program does here and there; return whether it was not refused."""
    text = Builder(seed).text()
    there = moves(text, FILES)
    try:
        path = gx.read(text.encode(), SIEMENS, subprograms=(folder,), control=CONTROL).path
    except gx.InputError as error:  # a draw with a step behind a frame: a setting decides on it
        if "SD42440" not in error.diagnostics[0].message:
            raise
        return False
    ours = [(KINDS[m.kind], *(m.end[a] for a in "XYZ")) for m in moves_of(path)]
    assert [m[0] for m in ours] == [m[0] for m in there], f"seed {seed}\n{text}"
    for k, (one, other) in enumerate(zip(ours, there, strict=True)):
        assert one[1:] == pytest.approx(other[1:], abs=NEAR), f"seed {seed} move {k}\n{text}"
    return True


def write_files(folder):
    """Write the subprograms that programs call."""
    for name, text in FILES.items():
        (folder / f"{name}.SPF").write_text(text)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with the subprograms."""
    place = tmp_path_factory.mktemp("subprograms")
    write_files(place)
    return place


@shares(DRAWN, 15)
def test_programs_do_what_the_reference_does(seeds, folder):
    for seed in seeds:
        check(seed, folder)
