"""Words beside M98 and M99: a drawn program does what it does with each call on a line of its own.

Both are read by code that differs in nothing but that, so what is written is executed by a few
lines of the test's own as well.
"""

from __future__ import annotations

import random
import re

import pytest
from seeds_kit import some

import gcxform as gx

CHAINS = {
    "metric": "metric",
    "absolute": "absolute",
    "cut": "segment arcs=split max-length=30",
}
CALLS = re.compile(r"M98 P(\d+)(?: L(\d+))?|M99")
Place = tuple[float, ...]


def drawn(seed: int) -> str:
    """Return a program in inches whose calls and returns have words beside them, or none."""
    draw = random.Random(seed)

    def words() -> str:
        axes = draw.sample("XYZ", draw.randint(1, 2))
        code = draw.choice(["", "", "G90 ", "G91 ", "G1 ", "G0 "])
        return code + " ".join(f"{a}{draw.randint(-9, 9)}." for a in sorted(axes))

    def line(callees: list[int]) -> str:
        if not callees or draw.random() < 0.3:
            return words()
        call = f"M98 P{draw.choice(callees)}" + draw.choice(["", "", " L2"])
        return draw.choice([call, f"{words()} {call}", f"{words()} {call}", f"{call} {words()}"])

    lines = ["O1", "G20 G90 G17 G94 G54", "G0 X0. Y0. Z0.", "G1 X1. F10."]
    lines += [line([2, 3, 4]) for _ in range(draw.randint(2, 6))] + ["M30"]
    for number, callees in ((2, [3, 4]), (3, [4]), (4, [])):
        lines += [f"O{number}", *(line(callees) for _ in range(draw.randint(1, 3)))]
        lines.append(draw.choice(["M99", f"{words()} M99", "G90 M99"]))
    return "\n".join(lines) + "\n"


def executed(text: str) -> list[Place]:
    """Return where each block ends, mm: words first, then the call."""
    bodies = dict(re.findall(r"^O(\d+)\n((?:(?!O\d).*\n)*)", text, re.MULTILINE))
    at, scale, incremental, found = [0.0] * 3, 25.4, False, list[Place]()

    def run(number: str) -> None:
        nonlocal scale, incremental
        for line in bodies[number].splitlines():
            rest = CALLS.sub("", line)
            for code in re.findall(r"G(\d+)", rest):
                scale = {"20": 25.4, "21": 1.0}.get(code, scale)
                incremental = {"90": False, "91": True}.get(code, incremental)
            moves = re.findall(r"([XYZ])(-?[\d.]+)", rest)
            for axis, value in moves:
                place = "XYZ".index(axis)
                at[place] = float(value) * scale + (at[place] if incremental else 0.0)
            if moves:
                found.append(tuple(at))
            call = CALLS.search(line)
            if "M30" in line or (call and call[0] == "M99"):
                return
            for _ in range(int(call[2] or 1) if call else 0):
                run(call[1])

    run("1")
    return found


def thinned(path: list[Place]) -> list[Place]:
    """Return a path without what stands where it was before."""
    found: list[Place] = []
    for place in path:
        if not found or max(abs(a - b) for a, b in zip(place, found[-1], strict=True)) > 1e-6:
            found.append(place)
    return found


def same(one: list[Place], other: list[Place]) -> bool:
    """Whether two paths stop at the same places, but for what is rounded."""
    pairs = zip(one, other, strict=False)
    return len(one) == len(other) and all(
        abs(a - b) < 0.02 for p, q in pairs for a, b in zip(p, q, strict=True)
    )


@pytest.mark.parametrize("chain", CHAINS)
@pytest.mark.parametrize("seed", some(40))
def test_words_come_first(seed: int, chain: str) -> None:
    text = drawn(seed)
    pipeline = gx.Pipeline.parse(CHAINS[chain], "fanuc")
    written = pipeline.run(text.encode()).text.decode()
    meant, done = thinned(executed(text)), thinned(executed(written))
    if chain == "cut":
        assert all(any(same([place], [each]) for each in done) for place in meant)
        assert len(done) >= len(meant)
    else:
        assert same(meant, done)


def test_a_line_of_words_and_a_call_stays_one() -> None:
    """As it stands where nothing of it changes, byte for byte; and some of the drawn ones do."""
    kept = 0
    for seed in range(20):
        pipeline = gx.Pipeline.parse("metric", "fanuc")
        written = pipeline.run(drawn(seed).encode()).text.decode()
        kept += len(re.findall(r"[XYZ][-\d.]+ M9[89]", written))
        assert pipeline.run(written.encode()).text.decode() == written
    assert kept > 20
