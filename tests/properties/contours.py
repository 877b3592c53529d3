"""Random programs of LinuxCNC under cutter compensation."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, field

Point = tuple[float, float]
TURNS = (math.pi / 2, -math.pi / 2, math.pi / 4, -math.pi / 4, 0.0)


@dataclass
class Contour:
    """A program that grows: where it stands, in the coordinates of its plane, and its heading."""

    choose: random.Random
    lines: list[str] = field(default_factory=list)
    at: Point = (0.0, 0.0)
    z: float = 0.0
    heading: float = 0.0
    xz: bool = False
    incremental: bool = False
    inverse: bool = False
    scale: float = 10.0

    def program(self) -> bytes:
        """Return the text of one to three stretches."""
        choose = self.choose
        self.xz = choose.random() < 0.3
        self.scale = choose.choice((4.0, 10.0, 40.0))
        self.lines += ["G21 G90 G94 F100", "G18" if self.xz else "G17", "G1 X0 Y0 Z0"]
        for _ in range(choose.choice((1, 1, 2, 3))):
            self.stretch()
        return "\n".join([*self.lines, "M2", ""]).encode()

    def stretch(self) -> None:
        """Begin compensation, cut a few moves, and end it or leave it on."""
        choose = self.choose
        radius = self.begin()
        self.heading = choose.uniform(-math.pi, math.pi)
        length = choose.uniform(0.2, 2) * self.scale
        self.line(max(length, radius * 1.01 + 0.01) if choose.random() < 0.95 else length)
        for _ in range(choose.randint(0, 7)):
            self.between()
            self.turn()
            length = choose.uniform(0.2, 2) * self.scale * choose.choice((1, 1, 1, 1, 0.02))
            if choose.random() < 0.4:
                self.arc(length)
            else:
                self.line(length)
        self.lines.append("G40")
        if self.inverse:
            self.lines.append("G94 F100")
            self.inverse = False
        self.line(choose.uniform(0.2, 2) * self.scale, rapids=False)

    def begin(self) -> float:
        """Write the block that begins compensation; return the tool's radius."""
        choose = self.choose
        radius = round(choose.choice((choose.uniform(0.1, 1), choose.uniform(0.5, 2.5), 2.0)), 3)
        side, sign = choose.choice(("41", "42")), choose.choice((1, 1, 1, -1))
        if choose.random() < 0.5:
            self.lines.append(f"G{side}.1 D{2 * radius * sign:.4f}")
            return radius
        tool = choose.randint(1, 5)
        if choose.random() < 0.5:
            self.lines.append(f"G{side} D{tool}")
        else:
            self.lines += [f"T{tool} M6", f"G{side}"]
        return tool / 2

    def turn(self) -> None:
        """Choose where the next move goes."""
        choose = self.choose
        kind = choose.random()
        if kind < 0.3:
            self.heading += choose.choice(TURNS)
        elif kind < 0.75:
            self.heading += choose.uniform(-1.2, 1.2)
        elif kind < 0.85:
            self.heading += choose.uniform(-0.08, 0.08)
        elif kind < 0.88:
            self.heading += math.pi
        else:
            self.heading += choose.uniform(-math.pi, math.pi)

    def between(self) -> None:
        """Now and then write something that is no move of the plane."""
        what = self.choose.random()
        if what < 0.05:
            self.z = round(self.choose.uniform(-5, 5), 3)
            self.lines.append(f"G1 {'Y' if self.xz else 'Z'}{self.down():.4f}{self.timed()}")
        elif what < 0.08:
            self.lines.append("G4 P0.5")
        elif what < 0.11:
            self.lines.append(self.choose.choice(("M3 S100", "M5", "M8", "M9", "(a comment)")))
        elif what < 0.15:
            self.incremental = not self.incremental
            self.lines.append("G91" if self.incremental else "G90")
        elif what < 0.17 and not self.inverse:
            self.inverse = True
            self.lines.append("G93")
        elif what < 0.21 and not self.inverse:
            self.lines.append(f"F{self.choose.randint(1, 900)}")

    def down(self) -> float:
        """Return the word of the axis across the plane, and let it stand there."""
        before, self.standing = getattr(self, "standing", 0.0), self.z
        return self.z - before if self.incremental else self.z

    def timed(self) -> str:
        """Return the feed word that a block in G93 needs."""
        return f" F{self.choose.randint(1, 20)}" if self.inverse else ""

    def words(self, to: Point) -> str:
        """Return the axis words of a move, and stand there."""
        names = "ZX" if self.xz else "XY"
        from_ = self.at if self.incremental else (0.0, 0.0)
        self.at = to
        text = "".join(f" {n}{b - a:.6f}" for n, a, b in zip(names, from_, to, strict=True))
        if self.choose.random() < 0.1:
            self.z = round(self.choose.uniform(-5, 5), 3)
            text += f" {'Y' if self.xz else 'Z'}{self.down():.4f}"
        return text

    def line(self, length: float, rapids: bool = True) -> None:
        """Write a line or a rapid."""
        x = round(self.at[0] + length * math.cos(self.heading), 6)
        y = round(self.at[1] + length * math.sin(self.heading), 6)
        if (x, y) == self.at:
            return
        self.heading = math.atan2(y - self.at[1], x - self.at[0])
        rapid = rapids and self.choose.random() < 0.08
        text = self.words((x, y))
        self.lines.append(f"G0{text}" if rapid else f"G1{text}{self.timed()}")

    def arc(self, radius: float) -> None:
        """Write an arc that goes on in the present heading."""
        choose, sense = self.choose, self.choose.choice((1, -1))
        sweep = choose.choice((math.pi / 2, math.pi, choose.uniform(0.05, 6.0), math.tau))
        x, y = self.at
        u = round(-sense * radius * math.sin(self.heading), 6)
        v = round(sense * radius * math.cos(self.heading), 6)
        angle = math.atan2(-v, -u) + sense * sweep
        size = math.hypot(u, v)
        end = (round(x + u + size * math.cos(angle), 6), round(y + v + size * math.sin(angle), 6))
        if sweep == math.tau:
            end = self.at
        elif math.dist(end, self.at) < 0.02:
            return
        self.heading = angle + sense * math.pi / 2
        names = "KI" if self.xz else "IJ"
        text = f"G{3 if sense > 0 else 2}{self.words(end)} {names[0]}{u:.6f} {names[1]}{v:.6f}"
        self.lines.append(text + self.timed())


def contour(seed: int) -> bytes:
    """Return a program."""
    return Contour(random.Random(seed)).program()
