"""Lines that compute something are worth as columns, bit by bit, what they are one by one."""

from __future__ import annotations

import random
from typing import Any

import pytest
from seeds_kit import DRAWN, shares

import gcxform as gx
from gcxform.modal.expressions.assignments import _Run
from gcxform.modal.line_notes import Assignments

COUNT = 2 * DRAWN
KEYS = ("#1", "#2", "#40", "#100", "#<a>")
START = dict.fromkeys("XYZ", 0.0)
HEAD = "G21 G90 G94 G17 F100\n"


class Lines:
    """One program being written; an assignment reads what stands before it in the alphabet."""

    def __init__(self, seed: int) -> None:
        self.choose = random.Random(seed)
        self.round_about = self.choose.random() < 0.2

    def value(self, keys: tuple[str, ...]) -> str:
        number = self.choose.choice(("0.1", "1.", "0.25", "3.7", "2."))
        if not keys or self.choose.random() < 0.4:
            return number
        key = self.choose.choice(keys)
        return self.choose.choice(("{k}", "[{k}*{n}]", "[{k}/3+{n}]", "SIN[{k}]")).format(
            k=key, n=number
        )

    def assignment(self) -> str:
        nth = self.choose.randrange(len(KEYS))
        reads = KEYS if self.round_about else KEYS[:nth]
        return f"{KEYS[nth]}=[{self.value(reads)}+{self.value(reads)}]"

    def line(self) -> str:
        words = f"X[{self.value(KEYS)}] Y[{self.value(KEYS)}]"
        if self.choose.random() < 0.5:
            return f"G1 {words}"
        if self.choose.random() < 0.3:
            return f"G1 {words} {self.assignment()}"
        return " ".join(self.assignment() for _ in range(self.choose.choice((1, 1, 2))))

    def program(self) -> bytes:
        known = self.choose.choice((KEYS, KEYS, KEYS[1:]))
        first = [f"{key}={self.value(())}" for key in known if self.choose.random() < 0.95]
        lines = [self.line() for _ in range(self.choose.randint(10, 40))]
        return (HEAD + "\n".join([*first, *lines, "M2", ""])).encode()


def computed(program: bytes, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return all that is computed, or what is refused."""
    found: list[Any] = []
    run = _Run.run

    def noted(self: _Run) -> Assignments:
        result = run(self)
        made = [(*each[:2], each.value.hex(), each.text) for each in result]
        found.append((self.value.tobytes(), made, sorted(map(str, self.lines.parameters.items()))))

    with monkeypatch.context() as patch:
        patch.setattr(_Run, "run", noted)
        try:
            _ = gx.read(program, "linuxcnc", start=START, parameters={"1": 0.5}).path
        except gx.InputError as error:
            return str(error)
    return found


@shares(COUNT, 150)
def test_columns_are_worth_what_lines_are(seeds: range, monkeypatch: pytest.MonkeyPatch) -> None:
    straight, done = _Run._straight, [0]

    def counted(self: _Run) -> Assignments | None:
        found = straight(self)
        done[0] += found is not None
        return found

    def never(self: _Run) -> None:
        del self

    for seed in seeds:
        program = Lines(seed).program()
        with monkeypatch.context() as patch:
            patch.setattr(_Run, "_straight", never)
            one = computed(program, monkeypatch)
        with monkeypatch.context() as patch:
            patch.setattr(_Run, "_straight", counted)
            assert computed(program, monkeypatch) == one, program.decode()
    assert done[0] > len(seeds) // 4
