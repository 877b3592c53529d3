"""Random programs of LinuxCNC that hang on parameters which the program does not set.

What these are worth is written in front of a program (`made_concrete`): the interpreter then goes
one way, and what was written for all ways has to go the same.
"""

from __future__ import annotations

from oracles.flows import COMPARE, Flow

LOST = ("#3101", "#3102", "#3103")
COUNTERS = range(3110, 3140)


class Lost(Flow):
    """One being written; about half of what decides is known."""

    stores = 0.1

    def condition(self) -> str:
        if self.choose.random() < 0.5:
            return super().condition()
        left = self.choose.choice((*LOST, f"{self.choose.choice(LOST)} + #31"))
        return f"[{left} {self.choose.choice(COMPARE)} {self.number()}]"

    def assignment(self, depth: int) -> list[str]:
        if self.choose.random() < 0.6:
            return super().assignment(depth)
        parameter = self.choose.choice(("#1", "#2", "#31", "#32", *LOST))
        value = self.choose.choice((self.number(), f"[{self.choose.choice(LOST)} + 1]", "#31"))
        return [f"{parameter}={value}"]

    def plain(self, depth: int) -> list[str]:
        kinds = (f"G1 X{self.number()} F{self.choose.randint(1, 5)}00", "G0 Z#31 X[#2+1]")
        lines = [self.choose.choice(kinds)] if self.choose.random() < 0.4 else super().plain(depth)
        return [
            line.replace("X", f"X[{self.choose.choice(LOST)}] (X", 1) + ")"
            if self.choose.random() < 0.06 and "[" not in line
            else line
            for line in lines
        ]

    def mode(self, depth: int) -> list[str]:
        return [
            self.choose.choice(("G90", "G91 G0 X1", "G90 G0 X1", "G91 G1 Y1 F50", "G90 G0 X#2"))
        ]

    def position(self, depth: int) -> list[str]:
        often = self.choose.random() < 0.3
        return super().position(depth) if often else [f"#3{self.choose.randint(1, 2)}=#5421"]

    def loop(self, depth: int) -> list[str]:
        """A loop that ends; often only the machine knows when."""
        if self.choose.random() < 0.5:
            return super().loop(depth)
        name, counter = self.label(), self.choose.choice(COUNTERS)
        step = f"#{counter}=[#{counter} - 1]"
        condition = f"[#{counter} gt 0]"
        kind = self.choose.choice(("while", "do", "repeat"))
        if kind == "repeat":
            return [f"{name} repeat [#{counter}]", *self.body(depth), f"{name} endrepeat"]
        inside = self.inside(name, depth)
        if kind == "do":
            return [f"{name} do", step, *inside, f"{name} while {condition}"]
        return [f"{name} while {condition}", step, *inside, f"{name} endwhile"]

    def body(self, depth: int) -> list[str]:
        """Some blocks; now and then one way ends the program."""
        lines = super().body(depth)
        if self.choose.random() < 0.05:
            name = self.label()
            lines += [f"{name} if {self.condition()}", *self.plain(0), "M2", f"{name} endif"]
        return lines

    def program(self) -> bytes:
        text = super().program().decode()
        return (text.replace("#31=3", "", 1) if self.choose.random() < 0.3 else text).encode()


def made_concrete(text: bytes, seed: int) -> bytes:
    """Return a program behind a line that says what is not known in it."""
    choose = Flow(seed).choose
    given = [f"{name}={choose.choice((-1, 0, 1, 2, 2.25))}" for name in (*LOST, "#31", "#32")]
    given += [f"#{n}={choose.randint(0, 3)}" for n in COUNTERS]
    return "\n".join(given).encode() + b"\n" + text


def program(seed: int) -> bytes:
    """Return the program of a seed."""
    return Lost(seed).program()
