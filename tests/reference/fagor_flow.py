"""A Fagor program executed line after line, by itself: no code is shared with the package.

Written from the pages that `plugins/gcxform_plugins/dialects/fagor/dialect.py` names: parameters,
structures, subroutines, polar words. Programs are well formed; lengths in mm, angles in degrees.
`$FOR` runs for its last value, and subroutines have the parameters of who calls.
"""

from __future__ import annotations

import math
import re

TOKEN = re.compile(r"\s*(\*\*|==|!=|>=|<=|[-+*/<>\[\],]|MOD|[A-Z]+(?=\[)|P\d+|\d+\.?\d*|\.\d+)")
WORD = re.compile(r"\s*([A-Z])\s*=?\s*(\[|-?\s*P\d+|[-+]?(?:\d+\.?\d*|\.\d+))", re.IGNORECASE)


class Expression:
    """One expression, by recursive descent: comparisons, sums, products, powers, operands."""

    def __init__(self, text: str, values: dict[str, float], slip: float = 0.0) -> None:
        self.tokens = TOKEN.findall(text.upper())
        self.values, self.at, self.slip = values, 0, slip

    def take(self, *wanted: str) -> str:
        if self.at < len(self.tokens) and self.tokens[self.at] in wanted:
            self.at += 1
            return self.tokens[self.at - 1]
        return ""

    def relation(self) -> float:
        left = self.sum()
        sign = self.take("==", "!=", ">=", "<=", "<", ">")
        if not sign:
            return left
        right = self.sum()
        return float(
            {
                "==": left == right,
                "!=": left != right,
                ">=": left >= right,
                "<=": left <= right,
                "<": left < right,
                ">": left > right,
            }[sign]
        )

    def sum(self) -> float:
        value = self.product()
        while sign := self.take("+", "-"):
            other = self.product()
            value = value + other if sign == "+" else value - other
        return value

    def product(self) -> float:
        value = self.power()
        while sign := self.take("*", "/", "MOD"):
            other = self.power()
            value = {"*": value * other, "MOD": math.fmod(value, other) if other else 0.0}.get(
                sign, value / other if other else 0.0
            )
        return value

    def power(self) -> float:
        value = self.operand()
        return value ** self.operand() if self.take("**") else value

    def operand(self) -> float:
        token = self.tokens[self.at]
        self.at += 1
        if token == "-":
            return -self.operand()
        if token == "[":
            value = self.relation()
            self.take("]")
            return value
        if token[0] == "P":
            return self.values[token]
        if token[0].isalpha():
            return self.function(token)
        return float(token)

    def function(self, name: str) -> float:
        self.take("[")
        given = [self.relation()]
        while self.take(","):
            given.append(self.relation())
        self.take("]")
        x = given[0]
        if name == "ARG":
            return math.degrees(math.atan2(given[1], x)) % 360.0
        return {
            "SIN": lambda: math.sin(math.radians(x * (1.0 + self.slip))) * (1.0 + self.slip),
            "COS": lambda: math.cos(math.radians(x * (1.0 + self.slip))) * (1.0 + self.slip),
            "ATAN": lambda: math.degrees(math.atan(x)),
            "ABS": lambda: abs(x),
            "SQRT": lambda: math.sqrt(x),
            "INT": lambda: float(math.floor(x)),
        }[name]()


class Program:
    """Executes lines; `moves` are the places in which moves end, and the centres of arcs.

    `slip`: by which part sines and cosines, and their angles, are too large, to see what hangs on
    their last bit.
    """

    def __init__(self, text: str, slip: float = 0.0) -> None:
        self.slip = slip
        self.lines = [re.sub(r";.*", "", line).strip() for line in text.upper().splitlines()]
        self.values: dict[str, float] = {}
        self.at = {"X": 0.0, "Y": 0.0, "Z": 0.0}
        self.steps, self.motion = False, "G0"
        self.pole, self.polar = (0.0, 0.0), (0.0, 0.0)
        self.moves: list[tuple[float, ...]] = []
        self.over = False
        names = [k for k, line in enumerate(self.lines) if line.startswith("%")]
        self.subs = {self.lines[k][2:].strip(): k for k in names if self.lines[k][1] == "L"}
        self.run(names[-1] + 1)

    def value(self, text: str) -> float:
        return Expression(text, self.values, self.slip).relation()

    def run(self, line: int) -> None:
        """Execute lines up to the end, or to what returns."""
        loops: dict[int, tuple[str, float, float]] = {}
        while line < len(self.lines) and not self.over:
            text = re.sub(r"^N\d+:?\s*|^\[\w+\]\s*", "", self.lines[line])
            word, _, rest = text.partition(" ")
            if word == "#RET":
                return
            if word in ("LL", "#CALL", "#PCALL"):
                self.call(word, rest)
            elif word.startswith("$"):
                line = self.decide(word, rest, line, loops)
                continue
            elif re.match(r"P\d+\s*[-+*/]?=", text):
                name, sign, value = re.match(r"(P\d+)\s*([-+*/]?)=(.*)", text).groups()
                found = self.value(value)
                old = self.values.get(name, 0.0)
                self.values[name] = {
                    "": found,
                    "+": old + found,
                    "-": old - found,
                    "*": old * found,
                }[sign]
            elif text:
                self.block(text)
            line += 1

    def call(self, word: str, rest: str) -> None:
        name, *given = rest.split()
        if word != "#PCALL":
            self.run(self.subs[name] + 1)
            return
        saved = self.values
        mine = {k: v for k, v in saved.items() if int(k[1:]) > 99}
        self.values = {k: v for k, v in saved.items() if int(k[1:]) > 99}
        for each in given:
            key, _, value = each.partition("=")
            mine[key] = Expression(value, saved).relation()
        self.values = mine
        self.run(self.subs[name] + 1)
        self.values = {k: v for k, v in saved.items() if int(k[1:]) <= 99} | {
            k: v for k, v in self.values.items() if int(k[1:]) > 99
        }

    # --- structures: they are looked for by counting, each time ---

    def end_of(self, line: int, kind: str, *stops: str) -> int:
        """Return the next line that stops a structure, behind a line in it."""
        depth = 0
        for at in range(line + 1, len(self.lines)):
            word = self.lines[at].partition(" ")[0]
            if depth == 0 and word in (f"$END{kind}", *stops):
                return at
            depth += (word == f"${kind}") - (word == f"$END{kind}")
        raise AssertionError(kind)

    def start_of(self, line: int, kind: str) -> int:
        depth = 0
        for at in range(line - 1, -1, -1):
            word = self.lines[at].partition(" ")[0]
            if depth == 0 and word == f"${kind}":
                return at
            depth += (word == f"$END{kind}") - (word == f"${kind}")
        raise AssertionError(kind)

    def decide(self, word: str, rest: str, line: int, loops: dict) -> int:
        """Return the line to go on with."""
        if word in ("$IF", "$ELSEIF") or word == "$ELSE":
            return self.branch(word, rest, line)
        if word == "$WHILE":
            return line + 1 if self.value(rest) else self.end_of(line, "WHILE") + 1
        if word == "$ENDWHILE":
            return self.start_of(line, "WHILE")
        if word == "$ENDDO":
            return self.start_of(line, "DO") + 1 if self.value(rest) else line + 1
        if word == "$FOR":
            name, _, numbers = rest.partition("=")
            first, last, step = (self.value(each) for each in numbers.split(","))
            self.values[name.strip()] = first
            loops[line] = name.strip(), last, step
            return line + 1
        if word == "$ENDFOR":
            start = self.start_of(line, "FOR")
            name, last, step = loops[start]
            self.values[name] += step
            return start + 1 if (last - self.values[name]) * step >= 0 else line + 1
        if word == "$GOTO":
            return next(k for k, text in enumerate(self.lines) if text.startswith(rest.strip()))
        return line + 1

    def branch(self, word: str, rest: str, line: int) -> int:
        """$IF: the first branch that holds; $ELSE and $ELSEIF, come to from above: the end."""
        if word != "$IF":
            at = line
            while not self.lines[at].startswith("$ENDIF"):
                at = self.end_of(at, "IF", "$ELSE", "$ELSEIF")
            return at + 1
        at = line
        while True:
            if self.lines[at].startswith("$ELSE") and not self.lines[at].startswith("$ELSEIF"):
                return at + 1
            if self.value(self.lines[at].partition(" ")[2]):
                return at + 1
            at = self.end_of(at, "IF", "$ELSE", "$ELSEIF")
            if self.lines[at].startswith("$ENDIF"):
                return at + 1

    # --- words ---

    def block(self, text: str) -> None:
        """Execute a block of words."""
        words: dict[str, tuple[float, bool]] = {}
        codes, at = [], 0
        while at < len(text):
            found = WORD.match(text, at)
            assert found is not None, text
            at = found.end()
            if found[2] == "[":
                depth, begin = 1, at
                while depth:
                    depth += {"[": 1, "]": -1}.get(text[at], 0)
                    at += 1
                value = self.value(text[begin : at - 1])
            else:
                value = self.value(found[2])
            marked = (
                at < len(text) and text[at] == "I" and not re.match(r"I\s*[-\d.\[P]", text[at:])
            )
            at += marked
            if found[1] in "GM":
                codes.append(f"{found[1]}{value:g}")
            else:
                words[found[1]] = value, bool(marked)
            at += len(text[at:]) - len(text[at:].lstrip())
        self.modes(codes, words)

    def modes(self, codes: list[str], words: dict[str, tuple[float, bool]]) -> None:
        for code in codes:
            self.steps = code == "G91" if code in ("G90", "G91") else self.steps
            self.motion = code if code in ("G0", "G1", "G2", "G3") else self.motion
            self.over |= code == "M30"
        if "G30" in codes:
            self.pole = words["I"][0], words["J"][0]
            return
        if not words.keys() & {*"XYZRQ"}:
            return
        before = dict(self.at)
        if "Q" in words and len(words.keys() & {*"XY"}) == 1:
            self.by_angle(words)
        elif words.keys() & {*"RQ"}:
            self.to_polar(words)
        for axis in words.keys() & {*"XYZ"}:
            value, marked = words[axis]
            self.at[axis] = before[axis] + value if marked or self.steps else value
        centre: tuple[float, ...] = ()
        if self.motion in ("G2", "G3"):
            centre = self.pole
            if words.keys() & {*"IJ"}:
                centre = tuple(
                    before[a] + words.get(i, (0.0, False))[0] for a, i in (("X", "I"), ("Y", "J"))
                )
        self.moves.append((*self.at.values(), *centre))

    def to_polar(self, words: dict[str, tuple[float, bool]]) -> None:
        new = list(self.polar)
        for k, letter in enumerate("RQ"):
            if letter in words:
                value, marked = words[letter]
                new[k] = new[k] + value if marked or self.steps else value
        self.polar = new[0], new[1]
        angle = math.radians(new[1])
        self.at["X"] = self.pole[0] + new[0] * math.cos(angle)
        self.at["Y"] = self.pole[1] + new[0] * math.sin(angle)

    def by_angle(self, words: dict[str, tuple[float, bool]]) -> None:
        axis = "X" if "X" in words else "Y"
        value, marked = words[axis]
        step = value if marked or self.steps else value - self.at[axis]
        angle = math.radians(words["Q"][0])
        length = step / (math.cos(angle) if axis == "X" else math.sin(angle))
        beside = "Y" if axis == "X" else "X"
        self.at[beside] += length * (math.sin(angle) if axis == "X" else math.cos(angle))
