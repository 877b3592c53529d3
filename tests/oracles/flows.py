"""Random programs of LinuxCNC with subprograms, loops, calls and stored modes."""

from __future__ import annotations

import random

MOVES = ("G0 X{} Y{}", "G1 X{} Z{} F100", "G0 X[{} + {}]", "Y[#1 * 2 - {}] Z#2")
COMPARE = ("lt", "gt", "le", "ge", "eq", "ne")


class Flow:
    """One program being written; numbers of labels are never used twice."""

    stores = 0.3
    """How many of the subprograms of M98 bring modes back."""

    def __init__(self, seed: int) -> None:
        self.choose = random.Random(seed)
        self.labels = iter(range(1, 1000))
        self.subs: list[int] = []

    def number(self) -> str:
        return str(self.choose.choice((0, 1, 2, 3, -1, 0.5, 2.25)))

    def condition(self) -> str:
        parameter = self.choose.choice(("#1", "#2", "#31"))
        return f"[{parameter} {self.choose.choice(COMPARE)} {self.number()}]"

    def label(self) -> str:
        number = next(self.labels)
        return self.choose.choice((f"o{number}", f"O{number}", f"o<l{number}>"))

    # --- blocks ---

    def plain(self, depth: int) -> list[str]:
        text = self.choose.choice(MOVES)
        return [text.format(self.number(), self.number())]

    def assignment(self, depth: int) -> list[str]:
        parameter = self.choose.choice(("#1", "#2", "#31"))
        return [f"{parameter}=[{parameter} * 0.5 + {self.number()}]"]

    def mode(self, depth: int) -> list[str]:
        return [self.choose.choice(("G90", "G91", "G20", "G21", "G90 G0 X1", "@2 ^30", "^45"))]

    def branch(self, depth: int) -> list[str]:
        name = self.label()
        lines = [f"{name} if {self.condition()}", *self.body(depth)]
        for _ in range(self.choose.randint(0, 2)):
            lines += [f"{name} elseif {self.condition()}", *self.body(depth)]
        if self.choose.random() < 0.5:
            lines += [f"{name} else", *self.body(depth)]
        return [*lines, f"{name} endif"]

    def repeat(self, depth: int) -> list[str]:
        name, count = self.label(), self.choose.choice((0, 0.5, 1, 2, 2.4, 2.5, 2.6, -1))
        return [f"{name} repeat [{count}]", *self.body(depth), f"{name} endrepeat"]

    def loop(self, depth: int) -> list[str]:
        """A loop over a counter of its own, that ends."""
        name, counter = self.label(), 40 + next(self.labels)
        step = f"#{counter}=[#{counter} + 1]"
        condition = f"[#{counter} lt {self.choose.randint(1, 3)}]"
        first, last = (
            (f"{name} do", f"{name} while {condition}")
            if self.choose.random() < 0.4
            else (f"{name} while {condition}", f"{name} endwhile")
        )
        return [f"#{counter}=0", first, step, *self.inside(name, depth), last]

    def inside(self, name: str, depth: int) -> list[str]:
        lines = self.body(depth)
        for _ in range(self.choose.choice((0, 0, 0, 1, 1, 2))):
            inner = self.label()
            leave = self.choose.choice(("break", "continue"))
            lines += [f"{inner} if {self.condition()}", f"{name} {leave}", f"{inner} endif"]
            lines += self.plain(depth)
        return lines

    def call(self, depth: int) -> list[str]:
        if not self.subs:
            return self.plain(depth)
        gaps = (" ", " ", " (a [7]) ", "")
        values = (
            f"{self.choose.choice(gaps)}[{self.number()}]" for _ in range(self.choose.randint(0, 3))
        )
        number = self.choose.choice(self.subs)
        names = (f"{number}", f"{number}", f"[{number - 7} + 3.5 * 2]", f"[#1 - #1 + {number}]")
        lines = [f"o{self.choose.choice(names)} call" + "".join(values)]
        if self.choose.random() < 0.3:
            lines.append("G0 X#<_value> Y#<_value_returned>")
        return lines

    def by_number(self, depth: int) -> list[str]:
        return [f"M98 P{self.choose.choice((900, 901))} L{self.choose.randint(0, 2)}"]

    def stored(self, depth: int) -> list[str]:
        return ["M70", *self.mode(depth), *self.plain(depth), "M72", *self.plain(depth)]

    def position(self, depth: int) -> list[str]:
        return ["G0 Y[#5420 + 1]"]

    def body(self, depth: int) -> list[str]:
        """Some blocks; deep inside only plain ones."""
        flat = (self.plain, self.assignment, self.mode, self.call, self.position)
        deep = (self.branch, self.repeat, self.loop, self.by_number, self.stored)
        lines: list[str] = []
        for _ in range(self.choose.randint(1, 3)):
            kinds = flat if depth <= 0 else (*flat, *deep)
            lines += self.choose.choice(kinds)(depth - 1)
        return lines

    def subprogram(self) -> list[str]:
        number = next(self.labels) + 500
        head = ["M73"] if self.choose.random() < 0.3 else []
        lines = [f"o{number} sub", *head, *self.body(1)]
        if self.choose.random() < 0.3:
            name = self.label()
            label = self.choose.choice((name, f"o{number}"))
            back = [f"{name} if {self.condition()}", f"{label} return [7]", f"{name} endif"]
            loop = self.label()
            inside = [f"{loop} repeat [2]", *self.plain(0), *back, f"{loop} endrepeat"]
            lines += self.choose.choice((back, inside))
        value = self.choose.choice(("", " [3]", " [#1]"))
        self.subs.append(number)
        return [*lines, f"o{number} endsub{value}"]

    def program(self) -> bytes:
        lines = ["G21 G90 G94 G17 F100 S100 G0 X0", "#1=1 #2=2 #31=3"]
        for _ in range(self.choose.randint(0, 3)):
            lines += self.subprogram()
        for _ in range(self.choose.randint(1, 3)):
            lines += self.body(2)
        lines.append("M2")
        for number in (900, 901):
            head = ["M73"] if self.choose.random() < self.stores else []
            lines += [f"O{number}", *head, *self.plain(0), *self.mode(0), *self.plain(0), "M99"]
        return "\n".join(lines).encode() + b"\n"


class Kept(Flow):
    """One in which less rests on the path itself, so that more of its structure can be kept."""

    stores = 0.03

    def mode(self, depth: int) -> list[str]:
        move = self.choose.choice(("X1", "Y-0.5", "X#31", "Z[#1 * 2]"))
        return self.choose.choice((["G90"], ["G91", f"G0 {move}", "G90"], [f"G91 G0 {move} #2=3"]))

    def stored(self, depth: int) -> list[str]:
        return super().stored(depth) if self.choose.random() < 0.05 else self.call(depth)

    def position(self, depth: int) -> list[str]:
        return super().position(depth) if self.choose.random() < 0.05 else self.plain(depth)

    def call(self, depth: int) -> list[str]:
        lines = super().call(depth)
        return lines if self.choose.random() < 0.1 else [n for n in lines if "_value" not in n]

    def subprogram(self) -> list[str]:
        lines = super().subprogram()
        return lines if self.choose.random() < 0.1 else [n for n in lines if n != "M73"]


def program(seed: int, kind: type[Flow] = Flow) -> bytes:
    """Return the program of a seed."""
    return kind(seed).program()
