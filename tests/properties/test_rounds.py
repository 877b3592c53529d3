"""Rounds of loops that are executed as columns do, bit by bit, what they do one by one."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import pytest
from seeds_kit import DRAWN, shares

import gcxform as gx
from gcxform.flow import rounds
from gcxform.flow.straightened import written_out
from gcxform.flow.walk import Walked
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.system.limits import Limits, in_force

COUNT = 2 * DRAWN
STEPS = 1500
KEYS = ("#1", "#2", "#3", "#20", "#101")
ADDED = ("[{k}+{e}]", "[{e}+{k}]", "[{k}-{e}]", "[{e}-{k}]", "{k}+{e}", "[{k}*{e}]", "[{e}]")
WORDS = "XYZTXY"
LINES = ("G1 X1. Y2.", "G91", "G90", "M8", "(said)", "G20", "", "N10 G0 Z5.", "/G1 X3.")
READING = Reading(start=dict.fromkeys("XYZ", 0.0), increment="IS-B", block_delete="skip")
OWORDS = "G21 G90 G94 G17 F100\n#1=0\no1 while [#1 LT 40]\n{}\no1 endwhile\nM2\n"
MACRO = "G21 G90 G94 G17 F100.\n#1=0\n#2=#0\n#3=#0\n#4=#0\nWHILE[#1LT40]DO1\n{}\nEND1\nM30\n"
MINDED = {
    "a line that reads what it sets": OWORDS.format("G1 X#1 Y[#1*2] #1=[#1+1]"),
    "a parameter set twice": OWORDS.format("#2=#1\nX#2\n#2=[#1+1]\nX#2\n#1=[#1+1]"),
    "one that is set and added to": OWORDS.format("#2=1\nX#2\n#2=[#2+1]\nX#2\n#1=[#1+1]"),
    "a line that is skipped": OWORDS.format("/X[#1*2] #3=#1\n#1=[#1+1]"),
    "null in the first round": MACRO.format("G0 X#2 Y1.\n#2=#3\n#3=#4\n#4=#1+1.\n#1=#1+1."),
    "moves that call": "O1\n"
    + MACRO.format("G66 P9\nG0 X#1\nG67\n#1=#1+1.")
    + "O9\nG91 G1 Z-1.\nG90\nM99\n",
    "moves that call all the time": "O1\nG66 P9\n"
    + MACRO.format("G0 X#1\n#1=#1+1.")
    + "O9\nG91 G1 Z-1.\nG90\nM99\n",
    "units": MACRO.format("G20\nG0 X[#1/3]\nG21\nY[#1/3]\n#1=#1+1."),
}


class Loops:
    """One program being written, of a dialect."""

    def __init__(self, seed: int, words: bool) -> None:
        self.choose = random.Random(seed)
        self.words = words

    def number(self) -> str:
        return self.choose.choice(("0.1", "1.", "0.25", "3.7", "0.", "2.", "0.3"))

    def value(self, depth: int = 1) -> str:
        pick = self.choose.random()
        if pick < 0.35 or not depth:
            return self.choose.choice((*KEYS, self.number()))
        if pick < 0.5:
            name = self.choose.choice(("SIN", "COS", "ABS", "FIX", "SQRT", "ROUND"))
            return f"{name}[{self.value(depth - 1)}]"
        sign = self.choose.choice("++--**/")
        return f"[{self.value(depth - 1)}{sign}{self.value(depth - 1)}]"

    def line(self, keys: list[str]) -> str:
        pick = self.choose.random()
        if pick < 0.35 and keys:
            key = keys.pop() if self.choose.random() < 0.9 else keys[-1]
            form = self.choose.choice(ADDED if key != "#1" else ADDED[:3])
            return f"{key}={form.format(k=key, e=self.value(0 if key == '#1' else 1))}"
        if pick < 0.9:
            address = self.choose.choice(WORDS)
            value = f"[{self.value()}]" if address not in "T" else "[2+#1-#1]"
            return f"G1 {address}{value} Y{self.value(0)}" if address not in "YT" else f"Y{value}"
        return self.choose.choice(LINES)

    def body(self) -> list[str]:
        keys = [key for key in KEYS if self.choose.random() < 0.6]
        self.choose.shuffle(keys)
        lines = [self.line(keys) for _ in range(self.choose.randint(1, 6))]
        if self.choose.random() < 0.8 and not any(line.startswith("#1=") for line in lines):
            lines.insert(self.choose.randint(0, len(lines)), f"#1=[#1+{self.number()}]")
        return lines

    def program(self) -> bytes:
        return "\n".join(self.lines()).encode()

    def lines(self) -> list[str]:
        condition = (
            f"[#1{self.choose.choice((' LT ', ' LE ', ' NE '))}{self.choose.randint(3, 60)}]"
        )
        head = ["G21 G90 G94 G17 F100.", "#1=0", *(f"{key}={self.number()}" for key in KEYS[1:])]
        body = self.body()
        if not self.words:
            loop = [f"WHILE{condition.replace(' ', '')}DO1", *body, "END1"]
        elif (kind := self.choose.choice(("while", "do", "repeat"))) == "while":
            loop = [f"o1 while {condition}", *body, "o1 endwhile"]
        elif kind == "do":
            loop = ["o1 do", *body, f"o1 while {condition}"]
        else:
            loop = [f"o1 repeat [{self.choose.randint(3, 60)}]", *body, "o1 endrepeat"]
        if self.choose.random() < 0.3:
            loop = self.around(["#1=0", *loop] if self.choose.random() < 0.7 else loop)
        return [*head, *loop, f"G0 X{self.choose.choice(KEYS)}", "M30", ""]

    def around(self, loop: list[str]) -> list[str]:
        """Return a loop in another one, which may begin or end on the next line."""
        if self.words:
            return ["o2 repeat [3]", *loop, "o2 endrepeat"]
        return ["#30=0", "WHILE[#30LT3]DO2", *loop, "#30=#30+1", "END2"]


def executed(program: bytes, name: str) -> Any:
    """Return all that an execution says of itself, or what is refused."""
    dialect = default_registry().dialect(name)
    try:
        with in_force(Limits(steps=STEPS)):
            found = written_out(Source.of_bytes(program), dialect, READING, dialect)
    except gx.InputError as error:
        return str(error)
    assert isinstance(found, Walked)
    made = [(*each[:2], repr(each.value)) for each in found.walk.made]
    held = found.executed
    assert held is not None
    done = repr(held.assigned), held.locals_set, tuple(found.assumed)
    table, times = found.walk.table.tolist(), found.walk.times.tolist()
    return found.text, found.origin.tolist(), table, times, made, found.walk.deciding, done


@pytest.mark.parametrize("what", MINDED)
def test_what_rounds_at_once_have_to_mind(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    name = "fanuc" if "DO1" in MINDED[what] else "linuxcnc"
    many, one = both_ways(MINDED[what].encode(), name, monkeypatch)
    assert many == one


def both_ways(program: bytes, name: str, monkeypatch: pytest.MonkeyPatch) -> tuple[Any, Any]:
    """Return what is said of rounds that are done at once, and of the same one by one."""
    monkeypatch.setattr(rounds, "WAIT", 1)
    many = executed(program, name)
    monkeypatch.setattr(rounds, "WAIT", 10**9)
    return many, executed(program, name)


@pytest.mark.parametrize("name", ["linuxcnc", "fanuc"])
@shares(COUNT, 75)
def test_rounds_at_once_are_those_one_by_one(
    seeds: range, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    at_once = [0]
    take: Callable[..., None] = rounds.Columns._take

    def counted(self: Any, count: int, *more: Any) -> None:
        at_once[0] += count
        take(self, count, *more)

    monkeypatch.setattr(rounds.Columns, "_take", counted)
    for seed in seeds:
        program = Loops(seed, name == "linuxcnc").program()
        many, one = both_ways(program, name, monkeypatch)
        assert many == one, program.decode()
    assert at_once[0] > 5 * len(seeds)
