"""A reader of what Klartext computes and where it goes on, line by line, in floats.

It shares no code with the package: formulas are read by descent, programs by a list of lines and a
stack of calls. It knows what the tests write, and raises `DoubtfulError` for what nobody knows.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

TOKEN = re.compile(r"\d+(?:[.,]\d*)?|[.,]\d+|Q[LR]?\d+|[A-Z]+|[-+*/^()%]")
FUNCTIONS: dict[str, Callable[[float], float]] = {
    "SIN": lambda a: math.sin(math.radians(a)),
    "COS": lambda a: math.cos(math.radians(a)),
    "TAN": lambda a: math.tan(math.radians(a)),
    "ATAN": lambda a: math.degrees(math.atan(a)),
    "SQRT": math.sqrt,
    "SQ": lambda a: a**2,
    "ABS": abs,
    "NEG": lambda a: 0.0 - a,
    "INT": lambda a: float(int(a)),
    "FRAC": lambda a: a - int(a),
    "EXP": math.exp,
    "LN": math.log,
}
RELATIONS: dict[str, Callable[[float, float], bool]] = {
    "EQU": lambda a, b: a == b,
    "NE": lambda a, b: a != b,
    "GT": lambda a, b: a > b,
    "LT": lambda a, b: a < b,
}
NEAR = 1e-6
STEPS = 20_000
OPERAND = r"([-+]?(?:Q\d+|\d+(?:[.,]\d*)?))"


class DoubtfulError(Exception):
    """What has no value, or one that another way of computing might turn."""


class Formula:
    """Reads a formula: sums of products of powers of what functions and signs stand before."""

    def __init__(self, text: str, q: dict[str, float]) -> None:
        self.tokens = [*TOKEN.findall(text), ""]
        self.q, self.at = q, 0

    def take(self, *wanted: str) -> str:
        found = self.tokens[self.at] if self.tokens[self.at] in wanted else ""
        self.at += bool(found)
        return found

    def sum(self) -> float:
        value = self.product()
        while sign := self.take("+", "-"):
            value = value + self.product() if sign == "+" else value - self.product()
        return value

    def product(self) -> float:
        value = self.power()
        while sign := self.take("*", "/"):
            value = value * self.power() if sign == "*" else value / self.power()
        return value

    def power(self) -> float:
        signed = self.tokens[self.at] in ("-", "+")
        base = self.applied()
        if not self.take("^"):
            return base
        exponent = self.power()
        if signed or (base < 0 and exponent != int(exponent)):
            raise DoubtfulError
        return float(base**exponent)

    def applied(self) -> float:
        if sign := self.take("+", "-"):
            return -self.applied() if sign == "-" else self.applied()
        if name := self.take(*FUNCTIONS):
            return FUNCTIONS[name](self.applied())
        return self.operand()

    def operand(self) -> float:
        if self.take("("):
            value = self.sum()
            assert self.take(")")
            return value
        token = self.tokens[self.at]
        self.at += 1
        return self.q[token] if token[0] == "Q" else float(token.replace(",", "."))


def worth(text: str, q: dict[str, float]) -> float:
    """Return what a formula is worth. Raises DoubtfulError."""
    try:
        value = Formula(text, q).sum()
    except (ValueError, ZeroDivisionError, OverflowError):
        raise DoubtfulError from None
    if not abs(value) < 1e6:
        raise DoubtfulError
    return value


def function(number: int, text: str, q: dict[str, float]) -> float:
    """Return what FN 0 to 8 and 13 are worth."""
    one = re.fullmatch(rf"(SQRT|SIN|COS)? *{OPERAND}", text)
    if one:
        return worth(f"{one[1] or ''} {one[2]}", q)
    two = re.fullmatch(rf"{OPERAND} *(\+|-|\*|DIV|LEN|ANG) *{OPERAND}", text)
    assert two, text
    a, b = worth(two[1], q), worth(two[3], q)
    if two[2] == "LEN":
        return math.sqrt(a * a + b * b)
    if two[2] == "ANG":
        if not (a or b):
            raise DoubtfulError
        return math.degrees(math.atan2(a, b)) % 360
    if two[2] == "DIV" and b == 0:
        raise DoubtfulError
    return {"+": a + b, "-": a - b, "*": a * b, "DIV": a / (b or 1.0)}[two[2]]


class Runner:
    """A program that is executed: where it is, and where it has led to."""

    def __init__(self, lines: list[str]) -> None:
        self.lines = lines
        self.q: dict[str, float] = {}
        self.places: list[tuple[float, float]] = []
        self.calls: list[int] = []
        self.left: dict[tuple[int, int], int] = {}
        self.at = 0

    def label(self, number: str) -> int:
        return self.lines.index(f"LBL {number}")

    def sets(self, target: str, formula: str) -> None:
        self.q[target] = worth(formula, self.q)

    def jumps(self, first: str, relation: str, second: str, label: str) -> None:
        a, b = worth(first, self.q), worth(second, self.q)
        if a != b and abs(a - b) < NEAR:
            raise DoubtfulError
        if RELATIONS[relation](a, b):
            self.at = self.label(label)

    def computes(self, number: str, target: str, text: str) -> None:
        self.q[target] = function(int(number), text, self.q)

    def moves(self, x: str, y: str) -> None:
        self.places.append((worth(x, self.q), worth(y, self.q)))

    def repeats(self, label: str, times: str) -> None:
        key = self.at, len(self.calls)
        self.left[key] = self.left.get(key, int(times)) - 1
        if self.left[key] >= 0:
            self.at = self.label(label)
        else:
            del self.left[key]

    def goes_in(self, label: str) -> None:
        self.calls.append(self.at)
        self.at = self.label(label)

    def goes_back(self) -> None:
        self.at = self.calls.pop()

    def ends(self) -> None:
        self.at = len(self.lines)

    def passes(self) -> None:
        """Go on at a label."""


STATEMENTS: tuple[tuple[str, Callable[..., None]], ...] = (
    (r"(Q\d+) = (.*)", Runner.sets),
    (r"FN \d+: IF (\S+) (\w+) (\S+) GOTO LBL (\d+)", Runner.jumps),
    (r"FN (\d+): (Q\d+) = (.*)", Runner.computes),
    (r"L X(\S+) Y(\S+) FMAX", Runner.moves),
    (r"CALL LBL (\d+) REP (\d+)", Runner.repeats),
    (r"CALL LBL (\d+)", Runner.goes_in),
    (r"LBL 0", Runner.goes_back),
    (r"M30", Runner.ends),
    (r"LBL \d+", Runner.passes),
)


def run(lines: list[str]) -> list[tuple[float, float]]:
    """Return where X and Y are led to by lines of L X.. Y.., in order. Raises DoubtfulError."""
    runner = Runner(lines)
    for _ in range(STEPS):
        if runner.at >= len(lines):
            return runner.places
        line = lines[runner.at]
        runner.at += 1
        tried = ((re.fullmatch(pattern, line), act) for pattern, act in STATEMENTS)
        found, act = next((match, act) for match, act in tried if match)
        act(runner, *found.groups())
    raise DoubtfulError
