"""Random programs of a Fanuc or Haas with subprograms, loops, jumps and macros."""

from __future__ import annotations

import random

MOVES = ("G0 X{} Y{}", "G1 X{} Z{} F100.", "G0 X[{}+#1]", "Y[#2*2.-{}] Z#100")
COUNTERS = ("#10", "#11", "#12", "#101")


class MacroFlow:
    """One program being written; `calls_own`: M97 calls lines of its own program."""

    def __init__(self, seed: int, calls_own: bool) -> None:
        self.choose = random.Random(seed)
        self.calls_own = calls_own
        self.labels = iter(range(10, 1000, 10))
        self.subs = [f"{number}" for number in (1000, 1001, 1002)]

    def number(self) -> str:
        return self.choose.choice(("0", "1.", "2.", "-1.", "0.5", "2.25"))

    def plain(self) -> list[str]:
        return [self.choose.choice(MOVES).format(self.number(), self.number())]

    def assignment(self) -> list[str]:
        name = self.choose.choice(("#1", "#2", "#100", "#500"))
        return [f"{name}=[#100*0.5+{self.number()}]"]

    def increment(self) -> list[str]:
        lines = ["G91", f"G0 X{self.choose.choice(('1.', '-0.5', '#100'))}", "G90"]
        return self.choose.choice((lines, ["G90"], lines[:2]))

    def loop(self, depth: int) -> list[str]:
        counter, label = COUNTERS[depth], 3 - depth
        first = f"WHILE[{counter}LT{self.choose.randint(1, 3)}]DO{label}"
        step = f"{counter}={counter}+1"
        return [f"{counter}=0", first, step, *self.body(depth - 1), f"END{label}"]

    def jump_back(self, depth: int) -> list[str]:
        counter, label = "#20", next(self.labels)
        body = self.choose.choice((self.plain, self.increment))()
        return [
            f"{counter}=0",
            f"N{label} {counter}={counter}+1",
            *body,
            f"IF[{counter}LT3]GOTO{label}",
        ]

    def jump(self, depth: int) -> list[str]:
        label = next(self.labels)
        condition = f"[#100{self.choose.choice(('LT', 'GT', 'EQ'))}{self.number()}]"
        return [f"IF{condition}GOTO{label}", *self.body(depth - 1), f"N{label}", *self.plain()]

    def branch(self, depth: int) -> list[str]:
        return [f"IF[#100GT{self.number()}]THEN #2=3."]

    def call(self, depth: int = 0) -> list[str]:
        if not self.subs:
            return self.plain()
        times = self.choose.choice(("", "", "L2"))
        return [f"M98 P{self.choose.choice(self.subs)} {times}".strip()]

    def body(self, depth: int) -> list[str]:
        flat = (self.plain, self.assignment, self.increment, self.call)
        deep = (self.loop, self.jump, self.branch, self.jump_back)
        lines: list[str] = []
        for _ in range(self.choose.randint(1, 3)):
            if depth > 0 and self.choose.random() < 0.5:
                lines += self.choose.choice(deep)(depth)
            else:
                lines += self.choose.choice(flat)()
        return lines

    def program(self) -> bytes:
        values = ["#1=1.", "#2=2.", "#100=3."]
        lines = ["%", "O1", "G21 G90 G94 G17 G0 X0. Y0. Z0. F100.", *values]
        lines += [*self.body(2), *self.body(2)]
        if self.calls_own:
            lines += ["M97 P9000 L2", "M30", "N9000 G1 Z-1. F50.", *self.increment(), "M99"]
        else:
            lines += ["M30"]
        for sub in list(self.subs):
            self.subs.remove(sub)
            moves = [line for line in self.body(1) if "#1+" not in line]
            lines += [f"O{sub}", "#1=4.", "#2=5.", *moves, "M99"]
        return "\n".join([*lines, "%", ""]).encode()


def program(seed: int, calls_own: bool = False) -> bytes:
    """Return the program of a seed."""
    return MacroFlow(seed, calls_own).program()
