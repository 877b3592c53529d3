"""A program whose numbers are disguised as parameters and expressions is the same program.

Generated programs of plain numbers are the judge of programs that compute: what is read from both,
what every chain makes of both, and what LinuxCNC says to both must be the same.
"""

from __future__ import annotations

import random
import re
from dataclasses import dataclass, field

import numpy as np
import pytest
from oracles import rs274
from oracles.canon import CanonProgram
from properties.test_rs274 import chain, drawn
from seeds_kit import DRAWN, shares

import gcxform as gx
from gcxform.plugin.registry import default_registry
from gcxform.toolpath.columns import COLUMNS

COUNT = DRAWN
WORD = re.compile(
    r"(?<![A-Z#<])([ABCFIJKPRSTXYZ][ \t]*)([+-]?(?:\d+\.?\d*|\.\d+))(?![\d. \t]*[\d.])"
)
END = re.compile(r"\s*(N\d+)?\s*M0*2\b", re.IGNORECASE)
LONGEST = 200  # characters, so that LinuxCNC takes the block also with what a chain adds
NAMES = ("1", "2", "30", "31", "4999", "<depth>", "<_a b>")


@dataclass
class Disguise:
    """Writes a program anew; `known` are the parameters and what they are worth."""

    choose: random.Random
    known: dict[str, str] = field(default_factory=dict)

    def program(self, text: str) -> str:
        lines = text.split("\n")
        numbers = [found[2].lstrip("+-") for found in WORD.finditer(text.upper())]
        ended = next(k for k, line in enumerate(lines) if END.match(line))
        return "\n".join(
            self.line(line, numbers) if 0 < k < ended and line.strip("% \r") else line
            for k, line in enumerate(lines)
        )

    def line(self, line: str, numbers: list[str]) -> str:
        code, rest = re.fullmatch(r"([^(;\r]*)(.*\r?)", line, re.S).groups()  # type: ignore[union-attr]
        new = WORD.sub(lambda found: found[1] + self.number(found[2]), code.upper())
        changes = {}
        if self.choose.random() < 0.4 and numbers:
            changes[self.choose.choice(NAMES)] = self.choose.choice(numbers)
            new += "".join(f" #{name}={self.value(value)}" for name, value in changes.items())
        if len(new) + len(rest) > LONGEST or new.startswith("/"):
            return line
        self.known |= changes
        return new + rest

    def value(self, number: str) -> str:
        return self.choose.choice((number, f"[{number}]", f"[{number}*2/2]", f"--{number}"))

    def number(self, text: str) -> str:
        """Return a number as it is, or something that is worth the same to the last bit."""
        size, minus = text.lstrip("+-"), "-" if text.startswith("-") else ""
        names = [name for name, value in self.known.items() if value == size]
        if names and self.choose.random() < 0.8:
            name = f"#{self.choose.choice(names)}"
            return minus + self.choose.choice((name, f"[{name}]", f"[{name}*1]"))
        ways = (text, f"[{text}]", f"{minus}[{size}+0]", f"{minus}ABS[-{size}]", f"[{text}/1]")
        return self.choose.choice(ways)


def pair(seed: int, **options: bool) -> tuple[bytes, bytes]:
    plain = drawn(seed, max_blocks=12, **options)
    text = Disguise(random.Random(seed)).program(plain.decode("latin-1"))
    return plain, text.encode("latin-1")


def same_path(one: gx.Toolpath, other: gx.Toolpath) -> str:
    """Say in what two paths differ, over the axes that both have: letters of functions are none."""
    axes = [other.axes.index(axis) for axis in one.axes]
    for name in COLUMNS:
        a, b = getattr(one, name), getattr(other, name)
        b = b[:, axes] if name == "end" else b
        if not np.array_equal(a, b, equal_nan=True):
            return name
    return "" if one.events == other.events else f"events {one.events} {other.events}"


def read(program: bytes) -> gx.Toolpath:
    return gx.read(program, "linuxcnc", start=dict.fromkeys("XYZABC", 0.0)).path


def test_the_same_is_read() -> None:
    changed = 0
    for seed in range(COUNT):
        plain, disguised = pair(seed)
        problem = same_path(read(plain), read(disguised))
        assert not problem, f"{problem}\n{plain.decode()}\n{disguised.decode()}"
        changed += b"#" in disguised or b"[" in disguised
    assert changed > 0.9 * COUNT


@shares(COUNT, 25)
def test_the_same_is_made_of_it(seeds: range) -> None:
    """Random chains: each output is proved by itself, and the two are the same path."""
    done = 0
    for seed in seeds:
        plain, disguised = pair(seed)
        steps, _ = chain(random.Random(seed))
        one, other = outcome(steps, plain), outcome(steps, disguised)
        if isinstance(one, str) or isinstance(other, str):
            assert one == other, f"{one} {other}\n{disguised.decode()}"
            continue
        problem = same_path(read(one.text), read(other.text))
        assert not problem, f"{problem}\n{disguised.decode()}\n{other.text.decode()}"
        assert one.source_map == other.source_map
        done += 1
    assert done > 0.8 * len(seeds)


def test_another_dialect_needs_no_parameters() -> None:
    """Across dialects the two are written in the same words."""
    across = gx.Pipeline(*(default_registry().dialect(name) for name in ("linuxcnc", "grbl")))
    done = 0
    for seed in range(COUNT):
        plain, disguised = pair(seed, rotary=False)
        one, other = outcome(across, plain), outcome(across, disguised)
        if isinstance(one, str) or isinstance(other, str):
            assert one == other
            continue
        assert b"#" not in other.text
        assert b"[" not in other.text
        paths = [gx.read(each.text, "grbl").path for each in (one, other)]
        assert not same_path(*paths), f"{one.text.decode()}\n{other.text.decode()}"
        done += 1
    assert done > 0.2 * COUNT


def outcome(steps: gx.Pipeline, program: bytes) -> gx.Result | str:
    """Return what a chain makes of a program, or the codes with which it refuses it."""
    try:
        return steps.run(program)
    except gx.VerificationError as error:
        pytest.fail(f"{error}\n{program.decode('latin-1')}\n{steps.passes}")
    except gx.InputError as error:
        return " ".join(sorted({found.code for found in error.diagnostics}))


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_linuxcnc_reads_the_same() -> None:
    """Of programs in disguise, and of what is made of them."""
    few = range(COUNT // 6)
    pairs = [pair(seed) for seed in few]
    made = [outcome(chain(random.Random(seed))[0], pairs[seed][1]) for seed in few]
    outputs = [result.text for result in made if isinstance(result, gx.Result)]
    plain = rs274.run_many([one for one, _ in pairs])
    for one, other in zip(plain, rs274.run_many([two for _, two in pairs]), strict=True):
        assert isinstance(one, CanonProgram)
        assert isinstance(other, CanonProgram), other
        assert (one.moves, one.events) == (other.moves, other.events)
    for text, answer in zip(outputs, rs274.run_many(outputs), strict=True):
        assert isinstance(answer, CanonProgram), f"{answer}\n{text.decode()}"
    assert len(outputs) > len(few) / 2


def test_few_arcs_are_cut_as_many_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of few arcs several halvings are looked at together: what is written is the same."""
    cut = 0
    for seed in range(COUNT // 4):
        plain, steps = pair(seed)[0], chain(random.Random(seed))[0]
        together = outcome(steps, plain)
        with monkeypatch.context() as many:
            many.setattr("gcxform_plugins.passes.volumetric.forward.arcs.FEW", -1)
            each = outcome(steps, plain)
        texts = [one if isinstance(one, str) else one.text for one in (together, each)]
        assert texts[0] == texts[1], plain.decode()
        cut += b"G2" in plain and "volumetric" in [step.name for step in steps.passes]
    assert cut > COUNT // 40
