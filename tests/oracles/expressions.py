"""Random programs with parameters and expressions, for a comparison with LinuxCNC.

Numbers are small and operators many, so that precedence, signs and ranges show in the four decimals
of the print. Only parameters that were set before are read, because the others are refused here.
"""

from __future__ import annotations

import random

FUNCTIONS = (
    *("ABS", "ACOS", "ASIN", "COS", "EXP", "FIX"),
    *("FUP", "LN", "ROUND", "SIN", "SQRT", "TAN"),
)
RELATIONS = ("EQ", "NE", "GT", "GE", "LT", "LE")
OPERATORS = ("+", "-", "*", "/", "**", "MOD", "AND", "OR", "XOR", *RELATIONS)
LONGEST = 230  # characters: LinuxCNC takes 252, with the mark of the line
NAMES = ("<depth>", "<_Feed Of Mine>", "<a1>")


class Writer:
    """Writes one program; `known` are the parameters it has set."""

    def __init__(self, seed: int) -> None:
        self.choose = random.Random(seed)
        self.known: list[str] = []

    def number(self) -> str:
        value = self.choose.choice((0, 1, 2, 3, 0.5, 2.5, 30, 45, 60, 90, 10, 0.1, 7, 4))
        return self.choose.choice((f"{value}", f"{value:.3f}", f"{value}"))

    def operand(self, depth: int) -> str:
        way = self.choose.random()
        if way < 0.1:
            return self.choose.choice("-+-") + self.operand(depth)
        if depth <= 0 or way < 0.35:
            return self.read() if self.known and self.choose.random() < 0.4 else self.number()
        if way < 0.65:
            return f"[{self.expression(depth - 1)}]"
        name = self.choose.choice([*FUNCTIONS, "ATAN"])
        name = name if self.choose.random() < 0.8 else name.lower()
        if name.upper() == "ATAN":
            return f"{name}[{self.expression(depth - 1)}]/[{self.expression(depth - 1)}]"
        return f"{name}[{self.expression(depth - 1)}]"

    def expression(self, depth: int) -> str:
        parts = [self.operand(depth)]
        for _ in range(self.choose.choice((0, 1, 1, 2, 3))):
            operator = self.choose.choice(OPERATORS)
            blank = " " if operator.isalpha() or self.choose.random() < 0.5 else ""
            parts.append(f"{blank}{operator}{blank}{self.operand(depth)}")
        return "".join(parts)

    def read(self) -> str:
        name = self.choose.choice(self.known)
        if name.isdecimal() and self.choose.random() < 0.2:
            return f"#[{int(name) - 1}+1]"
        return "#" + (name.swapcase() if self.choose.random() < 0.3 else name)

    def assignment(self) -> tuple[str, str]:
        name = self.choose.choice((*NAMES, *map(str, range(1, 6)), "100", "4999"))
        depth = self.choose.randint(0, 2)
        return name, f"#{name}={self.operand(depth)}"

    def block(self) -> str:
        words = []
        if self.choose.random() < 0.7:
            depth = self.choose.randint(0, 3)
            axes = self.choose.sample("XYZ", self.choose.randint(1, 3))
            words += [f"{axis}{self.operand(depth)}" for axis in axes]
        made = [self.assignment() for _ in range(self.choose.choice((0, 0, 1, 1, 2)))]
        words += [text for _, text in made]
        self.choose.shuffle(words)
        text = self.choose.choice(("", " ")).join(words)
        if len(text) > LONGEST:
            return ""
        self.known += [name for name, _ in made if name not in self.known]
        return text


def program(seed: int, blocks: int = 5) -> bytes:
    """Return a program of rapids between computed places."""
    writer = Writer(seed)
    lines = ["G21 G90 G0", *(writer.block() for _ in range(blocks)), "M2"]
    return "\n".join(lines).encode() + b"\n"
