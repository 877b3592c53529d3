"""Random programs of LinuxCNC in which everything is computed: words, codes, arguments, counters.

On top of `flows`: named parameters, local and global, every function and operator in expressions,
arguments and values of calls inside calls, a subprogram that calls itself, offsets, arcs and canned
cycles in loops, modes that are stored and restored around them, and parameters that the interpreter
sets: positions, tools, modes.
"""

from __future__ import annotations

from oracles.flows import COMPARE, Flow

NAMES = ("#1", "#2", "#31", "#<a>", "#<_g>", "#[1 + 1]", "#abs[2]", "#<_value>", "#30")
SET = ("#1", "#2", "#31", "#<a>", "#<_g>", "#[31]", "#[#30]")
TOLD = ("#5420", "#5421", "#5422", "#<_x>", "#<_z>", "#5220", "#5400", "#<_metric>", "#<_plane>")
"""What the interpreter knows of itself; all of it is known before the machine runs."""
ANGLES = ("sin[{}]", "cos[{}]", "atan[{}]/[{}]", "tan[[{}] mod 80]")
UNARY = ("abs[{}]", "fix[{}]", "fup[{}]", "round[{}]", "-[{}]", "sqrt[abs[{}]]", "exists[#<a>]")
TAMED = ("exp[[{}] / 50]", "ln[abs[{}] + 1]", "asin[[{}] / 1000000]", "acos[[{}] / 1000000]")
BINARY = ("+", "-", "*", "/", "mod", "**", "and", "or", "xor", *COMPARE)


class Rich(Flow):
    """One program in which as much as possible is computed."""

    def parameter(self) -> str:
        return self.choose.choice(NAMES if self.choose.random() < 0.93 else TOLD)

    def expression(self, depth: int = 2) -> str:
        """Return the inside of a bracket; its values stay small."""
        kind = self.choose.random()
        if depth <= 0 or kind < 0.3:
            return self.choose.choice((self.number(), self.parameter()))
        if kind < 0.6:
            form = self.choose.choice(self.choose.choice((ANGLES, UNARY, TAMED)))
            return form.replace("{}", "\0").replace("\0", self.expression(depth - 1))
        operator = self.choose.choice(BINARY)
        left, right = self.expression(depth - 1), self.expression(depth - 1)
        if operator == "/":
            return f"[{left}] / [abs[{right}] + 1]"
        if operator == "**":
            return f"[[abs[{left}] mod 3] + 0.5] ** [[{right}] mod 3]"
        if operator == "mod":
            return f"[{left}] mod {self.choose.choice(('7', '2.5', '3'))}"
        if self.choose.random() < 0.3:
            return f"{self.number()} {operator} {left} {self.choose.choice('+*-')} {self.number()}"
        return f"[{left}] {operator} [{right}]"

    def value(self) -> str:
        """Return a value that stays small enough to be printed exactly."""
        return f"[[{self.expression()}] mod 50]"

    def condition(self) -> str:
        return f"[{self.value()} {self.choose.choice(COMPARE)} {self.number()}]"

    # --- blocks ---

    def plain(self, depth: int) -> list[str]:
        one, two = self.value(), self.value()
        centre = self.choose.choice((f"[0 - 3] J{self.number()}", "2.5", f"[{self.number()} + 4]"))
        forms = (
            f"G0 X{one} Y{two}",
            f"G1 X{one} Z{two} F[100 + {self.number()}]",
            f"G[1 - 1] X-{one}",
            f"Y{one} Z#2" if depth % 2 else f"G0 Z{one}",
            f"G{self.choose.choice((2, 3))} X#5420 Y#5421 I{centre}",
            f"G18 G2 X#5420 Z#5422 I{centre}\nG17".replace(" J", " K"),
            f"G4 P[0.5 + abs{one}]",
            "(debug, x #5420)",
            f"S[100 + abs{one}] M{self.choose.choice((3, 4))}",
        )
        return self.choose.choice(forms).split("\n")

    def assignment(self, depth: int) -> list[str]:
        names = [self.choose.choice(SET) for _ in range(self.choose.choice((1, 1, 2, 3)))]
        if "#[#30]" in names or "#[31]" in names:
            names = names[:1]
        return ["#30=33", " ".join(f"{name}={self.value()}" for name in names)]

    def mode(self, depth: int) -> list[str]:
        choices = ("G90", "G91", "G20", "G21", "M8", "M9", "M7", "G17", "F[50 + 5]", "G54", "G55")
        return [self.choose.choice(choices)]

    def frame(self, depth: int) -> list[str]:
        one = self.value()
        forms = (
            f"G10 L2 P[1 + {self.choose.choice((0, 1))}] X{one} Y2",
            f"G10 L20 P0 X{one}",
            f"G92 X{one}",
            "G92.1",
            "G92.2",
            "G92.3",
            "G53 G0 X1",
            f"G43.1 Z{one}",
            "G49",
            f"G52 X{one}",
        )
        return [self.choose.choice(forms)]

    def cycle(self, depth: int) -> list[str]:
        code = self.choose.choice((81, 82, 83, 85, 89, 73))
        words = {82: " P.5", 83: " Q1.5", 73: " Q1.5", 89: " P.5"}.get(code, "")
        high = self.choose.choice(("G98", "G99"))
        hole = f"G90 {high} G{code} X{self.value()} Y2 Z-4 R1{words} L{self.choose.choice((1, 2))}"
        return ["G90 G17 G0 Z5", hole, f"X{self.value()}", "G80"]

    def lost(self, depth: int) -> list[str]:
        """Blocks with values that only the machine knows, and what depends on them."""
        told = self.choose.choice(("#5063", "#5070", "#5399", "#5061", "#<l>"))
        return self.choose.choice(
            (
                ["G90 G38.2 Z-50 F40", f"#<l>=[#5063 + {self.number()}]"],
                ["M66 P0 L0", f"#<l>=[{told} * 2]"],
                [f"G0 X[{told} mod 9]", f"G91 X{self.value()}", "G90"],
                [f"G0 Z{told}", f"G0 Z{self.value()}"],
                [f"S[100 + abs[{told}]]", f"G1 X[{told}] Y2 F[100 + abs[{told}]]", "F100 S100"],
                [f"#1={told}", f"#2=[#1 + {self.number()}]", "G0 Y#2", f"#1={self.value()}"],
                [f"(debug, l {told})", f"G4 P[1 + abs[{told}]]"],
                [f"G10 L2 P1 X{told}", f"G0 X{self.value()}", "G10 L2 P1 X0"],
                [f"G92 X{told}", f"G0 X{self.value()} Y1", "G92.1"],
            )
        )

    def machine(self, depth: int) -> list[str]:
        """Blocks that act on the machine and on frames."""
        return self.choose.choice(
            (
                ["T1 M6", "G0 Z3"],
                [f"G10 L2 P1 R{self.choose.choice((0, 30, -45))}"],
                ["G93 G1 X1 F[2 + 1]", "Y2 F5", "G94 F100"],
                ["G90.1", "G2 X#5420 Y#5421 I[#5420 + 3] J#5421", "G91.1"],
                ["G61", "G64 P.01"],
                ["G28.1", "G0 X5", "G28 X1", "G30 Z2"],
                [f"A{self.value()}", f"G1 X{self.value()} A{self.value()} F[90]"],
                ["G95 F.1 G1 X2", "G94 F100"],
                ["M48", "M49", "M62 P0"],
                ["G59.1", f"G0 X{self.value()}", "G54"],
                ["M0", "M1", "M60"],
                ["G5 X#5420 Y[#5421 + 3] I0 J1 P0 Q-1 F[100]", "G0 X1"],
                ["M19 R10"],
            )
        )

    def itself(self, depth: int) -> list[str]:
        """A subprogram that calls itself until its argument is used up."""
        if not self.again:
            return self.plain(depth)
        return [f"o{self.again} call [{self.choose.choice((0, 1, 2, 3))}] {self.value()}"]

    def call(self, depth: int) -> list[str]:
        if not self.subs:
            return self.plain(depth)
        values = "".join(f" {self.value()}" for _ in range(self.choose.randint(0, 3)))
        lines = [f"o{self.choose.choice(self.subs)} call{values}"]
        if self.choose.random() < 0.4:
            lines.append("G0 X[#<_value> mod 50] Y[1 + #<_value_returned>]")
        return lines

    def stored(self, depth: int) -> list[str]:
        inner = [*self.mode(depth), *self.plain(depth), *self.mode(depth)]
        keep = self.choose.choice((["M70"], ["M70", "M71", "M70"]))
        return [*keep, *inner, self.choose.choice(("M72", "M72", "M70")), *self.plain(depth)]

    def body(self, depth: int) -> list[str]:
        """Some blocks; deep inside only plain ones."""
        flat = (self.plain, self.plain, self.assignment, self.mode, self.call, self.frame)
        deep = (self.branch, self.repeat, self.loop, self.stored, self.cycle, self.itself)
        deep += (self.lost, self.machine, self.by_number)
        lines: list[str] = []
        for _ in range(self.choose.randint(1, 3)):
            kinds = flat if depth <= 0 else (*flat, *deep)
            lines += self.choose.choice(kinds)(depth - 1)
        return lines

    def subprogram(self) -> list[str]:
        number = next(self.labels) + 500
        head = ["M73"] if self.choose.random() < 0.3 else []
        lines = [f"o{number} sub", *head, "#<a>=[#1 + 1]", *self.body(1)]
        if self.choose.random() < 0.4:
            name = self.label()
            lines += [f"{name} if {self.condition()}", f"o{number} return {self.value()}"]
            lines += [f"{name} endif", *self.plain(0)]
        value = self.choose.choice(("", f" {self.value()}", " [#<a>]"))
        self.subs.append(number)
        return [*lines, f"o{number} endsub{value}"]

    def recursion(self) -> list[str]:
        number, name = 2000 + next(self.labels), self.label()
        self.again = number
        inner = [f"o{number} call [#1 - 1] [#2 + 1]", *self.plain(0)]
        body = [f"{name} if [#1 gt 0]", *inner, f"{name} endif"]
        return [f"o{number} sub", *self.plain(0), *body, f"o{number} endsub [#1 + #2]"]

    def program(self) -> bytes:
        self.again = 0
        lines = ["G21 G90 G94 G17 F100 S100 G0 X0", "#1=1 #2=2 #31=3 #30=33 #33=4"]
        lines += ["#<a>=5 #<_g>=6"]
        for _ in range(self.choose.randint(0, 3)):
            lines += self.subprogram()
        if self.choose.random() < 0.4:
            lines += self.recursion()
        for _ in range(self.choose.randint(1, 3)):
            lines += self.body(2)
        lines.append("M2")
        for number in (900, 901):
            head = ["M73"] if self.choose.random() < 0.3 else []
            lines += [f"O{number}", *head, *self.plain(0), *self.mode(0), *self.plain(0), "M99"]
        return "\n".join(lines).encode() + b"\n"


def program(seed: int) -> bytes:
    """Return the program of a seed."""
    return Rich(seed).program()
