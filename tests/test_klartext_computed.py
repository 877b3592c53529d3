"""Random programs of Q parameters, jumps, repeats and calls mean the same to two readers."""

from __future__ import annotations

import re

import numpy as np
import pytest
from heidenhain_kit import program, read
from reference import klartext
from seeds_kit import LONG, some

import gcxform as gx

FUNCTIONS = [*klartext.FUNCTIONS]


class Writer:
    """Draws programs: `label` is the last one, `depth` how deep loops are."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        self.label = self.depth = 0

    def one(self, *things):
        return things[int(self.rng.integers(0, len(things)))]

    def number(self):
        text = f"{self.rng.uniform(0, 20):.{self.rng.integers(0, 3)}f}"
        return text.replace(".", ",") if self.rng.random() < 0.2 else text

    def operand(self):
        return self.one(self.number(), f"Q{self.rng.integers(1, 9)}")

    def formula(self, deep=3):
        kind = self.rng.integers(0, 9) if deep else 0
        if kind <= 2:
            return self.operand()
        if kind == 3:
            return f"({self.formula(deep - 1)})"
        if kind == 4:
            return f"{self.one(*FUNCTIONS)} {self.formula(deep - 1)}"
        if kind == 5:
            return f"{self.one('-', '+')}{self.operand()}"
        if kind == 6:
            return f"{self.formula(deep - 1)} ^ {self.one('2', '3', '0,5', 'Q3')}"
        return f"{self.formula(deep - 1)} {self.one('+', '-', '*', '/')} {self.formula(deep - 1)}"

    def signed(self):
        return f"{self.one('+', '-')}{self.operand()}"

    def statement(self):
        kinds = [self.assignment, self.assignment, self.function, self.move, self.move, self.skip]
        if self.depth < 2:
            kinds += [self.loop, self.repeat]
        return self.one(*kinds)()

    def assignment(self):
        return [f"Q{self.rng.integers(1, 9)} = {self.formula()}"]

    def function(self):
        target = f"Q{self.rng.integers(1, 9)} = "
        kinds = {0: "", 5: "SQRT ", 6: "SIN ", 7: "COS "}
        number = self.one(0, 1, 2, 3, 4, 5, 6, 7, 8, 13)
        if number in kinds:
            return [f"FN {number}: {target}{kinds[number]}{self.signed()}"]
        operator = {1: "+", 2: "-", 3: "*", 4: "DIV", 8: "LEN", 13: "ANG"}[number]
        return [f"FN {number}: {target}{self.signed()} {operator} {self.signed()}"]

    def move(self):
        return [f"L X{self.one('+', '-')}Q{self.rng.integers(1, 9)} Y+{self.number()} FMAX"]

    def body(self):
        self.depth += 1
        lines = [line for _ in range(self.rng.integers(1, 4)) for line in self.statement()]
        self.depth -= 1
        return lines

    def next(self):
        self.label += 1
        return self.label

    def skip(self):
        label, relation = self.next(), self.one("EQU", "NE", "GT", "LT")
        number = 9 + ["EQU", "NE", "GT", "LT"].index(relation)
        head = f"FN {number}: IF {self.signed()} {relation} {self.signed()} GOTO LBL {label}"
        return [head, *self.body(), f"LBL {label}"]

    def loop(self):
        label, counter = self.next(), f"Q{40 + self.depth}"
        count = [f"{counter} = {counter} + 1", f"FN 12: IF +{counter} LT +3 GOTO LBL {label}"]
        return [f"{counter} = 0", f"LBL {label}", *self.body(), *count]

    def repeat(self):
        label = self.next()
        return [f"LBL {label}", *self.body(), f"CALL LBL {label} REP {self.rng.integers(1, 4)}"]

    def program(self):
        lines = [f"Q{n} = {self.one('', '-')}{self.number()}" for n in range(1, 9)]
        for _ in range(self.rng.integers(2, 7)):
            lines += self.statement()
        subs = []
        for number in (91, 92):
            lines += [f"CALL LBL {number}", *self.move()]
            subs += [f"LBL {number}", *self.body(), "LBL 0"]
        return [*lines, "M30", *subs]


def path_or_doubt(lines):
    """Return the path of a program, or why it is refused."""
    try:
        return read(program(*lines))
    except gx.InputError as error:
        return str(error)


@pytest.mark.parametrize("seed", some(50 if not LONG else 20_000))
def test_it_is_computed_as_by_a_reader_of_one_line_at_a_time(seed):
    lines = Writer(seed).program()
    try:
        wanted = klartext.run(lines)
    except (klartext.DoubtfulError, RecursionError):
        return
    found = path_or_doubt(lines)
    if isinstance(found, str):  # the engine may doubt more
        assert re.search("sign before a power|nearly equal|too large", found), lines
        return
    places = found.end[:, :2].tolist()
    assert places == [pytest.approx(place, rel=1e-7, abs=1e-6) for place in wanted], lines


def test_the_two_readers_differ_where_the_program_does():
    lines = ["Q1 = 2 ^ 3 ^ 2", "L X+Q1 Y+0 FMAX"]
    assert klartext.run(lines) == [(512.0, 0.0)]
    assert read(program("Q1 = (2 ^ 3) ^ 2", lines[1])).end[0, 0] == 64.0


def test_what_is_too_large_on_the_way_has_no_value():
    assert "too large" in path_or_doubt(["Q1 = TAN (19 ^ 19)", "L X+Q1 Y+0 FMAX"])
