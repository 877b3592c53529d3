"""Feeds by the clock: how long every line of a program takes, before a chain and after it.

A feed may become an inverse time and the reverse, and a move many; the minutes of its line stay.
For LinuxCNC the clock is its own interpreter, which turns the feeds of G93 into rates itself; for
the others it is the reference interpreter.
"""

from __future__ import annotations

import random
from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache

import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles import rs274
from oracles.canon import CanonMove, CanonProgram
from oracles.compare import lengths
from properties import test_laws as laws
from properties.test_rs274 import as_move, compensation, drawn, drawn_model
from reference.interpreter import Move, interpret

import gcxform as gx

TOGETHER = 50  # programs in a test
FIRST = range(0, max(5 * laws.EXAMPLES, 150), TOGETHER)  # of fewer none stays in inverse time
INVERSE, MINUTE = "feed mode=inverse-time", "feed mode=per-minute"
CUTS = ("segment chord-error=5um", "segment arcs=split arc-step=20deg max-length=7mm", "plane")
CHAINS = (
    *(INVERSE, MINUTE, f"{INVERSE} | {MINUTE}", f"metric | absolute | {INVERSE}"),
    *(f"{INVERSE} | metric", f"{MINUTE} | absolute", f"{MINUTE} | {INVERSE} | {MINUTE}"),
    *(f"{cut} | {INVERSE}" for cut in CUTS),
    *(f"{INVERSE} | {cut}" for cut in CUTS),
    *(f"{INVERSE} | {cut} | {MINUTE}" for cut in CUTS),
    *(f"{MINUTE} | {cut} | {INVERSE}" for cut in CUTS),
    *CUTS,
)
PRINTED = 0.51e-4  # units of the program: positions and rates of LinuxCNC's canon
CLOSE = 1e-3  # relative: what the rounding of feeds may change
STRAIN = 4e-3  # relative: what a drawn machine may stretch


@dataclass
class Clock:
    """What the moves of one line take: minutes, by how much that is sure, and their way."""

    time: float = 0.0
    unsure: float = 0.0
    way: float = 0.0
    modes: frozenset[str] = frozenset()

    def add(self, move: Move, rate: float, loose: float, off: float) -> None:
        """Count a move at a rate (mm/min or deg/min) that may be off by `loose`, its ends `off`."""
        linear, rotary = lengths(move)
        way = linear or rotary
        if way and rate:
            self.way += way
            self.time += way / rate
            self.unsure += way / rate * (loose / rate) + 2 * off / rate
        self.modes |= {move.feed_mode}


def of_canon(moves: Iterable[CanonMove], off: float) -> dict[int, Clock]:
    """Return what LinuxCNC takes for each line with feed moves."""
    clocks: dict[int, Clock] = defaultdict(Clock)
    for canon in moves:
        if canon.kind == "RAPID" or canon.feed is None:
            continue
        move = as_move(canon)
        alone = not lengths(move)[0]
        unit = 1.0 if alone else canon.unit
        rate, loose = canon.feed[alone], PRINTED * unit
        clocks[canon.line].add(move, rate, loose, off + 2 * PRINTED * unit)
    return clocks


def of_reference(moves: Iterable[Move], off: float) -> dict[int, Clock]:
    """Return what the reference interpreter takes for each line with feed moves."""
    clocks: dict[int, Clock] = defaultdict(Clock)
    for move in moves:
        if move.kind == "RAPID":
            continue
        assert move.feed is not None
        linear, rotary = lengths(move)
        rate = move.feed * ((linear or rotary) if move.feed_mode == "G93" else 1.0)
        clocks[move.line].add(move, rate, 0.0, off)
    return clocks


def check(before: dict[int, Clock], after: dict[int, Clock], close: float, text: str) -> None:
    """Check that every line takes as long as before, if it goes anywhere."""
    for line, old in before.items():
        new = after.get(line, Clock())
        if old.way == 0.0 or new.way == 0.0:
            continue
        slack = close * old.time + old.unsure + new.unsure
        assert abs(new.time - old.time) <= slack, (line, old, new, text)


# --- LinuxCNC ---


def compensated(choose: random.Random, chain: str) -> list[gx.Pass]:
    """Return a chain with a compensation somewhere in it."""
    steps = laws.chain_of(chain)
    made = compensation(drawn_model(choose), (3.0, -7.0, 11.0), True, choose.choice((None, 0.01)))
    steps.insert(choose.randint(0, len(steps)), made)
    return steps


def written(seed: int) -> tuple[gx.Pipeline, bytes, gx.Result, float] | None:
    """Return what a chain makes of a program; None if it is refused."""
    choose = random.Random(seed)
    chain = choose.choice(CHAINS)
    machine = choose.random() < 0.3
    steps = compensated(choose, chain) if machine else laws.chain_of(chain)
    source = drawn(seed, max_blocks=12).replace(b"G95", b"G94")
    pipeline = laws.pipeline(steps, "linuxcnc")
    try:
        result = pipeline.run(source)
    except gx.VerificationError as error:
        pytest.fail(f"{error}\n{source.decode('latin-1')}\n{chain}")
    except gx.InputError:
        return None
    return pipeline, source, result, STRAIN if machine else CLOSE


Modes = tuple[frozenset[str], frozenset[str]]


@cache
def compared(first: int) -> frozenset[Modes]:
    """Compare some programs with what becomes of them; return the modes before and after."""
    modes: set[Modes] = set()
    seeds = range(first, first + TOGETHER)
    jobs = [job for seed in seeds if (job := written(seed)) is not None]
    old = rs274.run_many([source for _, source, _, _ in jobs])
    new = rs274.run_many([result.text for _, _, result, _ in jobs])
    for job, one, other in zip(jobs, old, new, strict=True):
        pipeline, source, result, close = job
        text = f"{source.decode('latin-1')}\n{result.text.decode('latin-1')}\n{pipeline}"
        assert isinstance(one, CanonProgram), f"{one}\n{text}"
        assert isinstance(other, CanonProgram), f"{other}\n{text}"
        before = of_canon((m for m in one.moves if not unclear(m)), 0.0)
        moves = by_source(other.moves, result)
        after = of_canon(moves, pipeline.limit(b"G20" in result.text.upper()))
        check(before, after, close, text)
        modes |= {(before[k].modes, after[k].modes) for k in set(before) & set(after)}
    assert len(jobs) > 0.6 * len(seeds)
    return frozenset(modes)


def with_linuxcnc(test: Callable[..., None]) -> Callable[..., None]:
    """Mark a test that asks LinuxCNC: one process does, for the last test has all answers."""
    group = pytest.mark.xdist_group("feeds of LinuxCNC")
    there = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
    return there(group(test))


@with_linuxcnc
@pytest.mark.parametrize("first", FIRST)
def test_linuxcnc_takes_as_long(first: int) -> None:
    compared(first)


@with_linuxcnc
def test_linuxcnc_is_asked_in_all_modes() -> None:
    minute, inverse = frozenset({"G94"}), frozenset({"G93"})
    wanted = {(minute, inverse), (inverse, minute), (inverse, inverse), (minute, minute)}
    assert wanted <= frozenset().union(*map(compared, FIRST))


def unclear(move: CanonMove) -> bool:
    """Whether the time of a circle is not known from what LinuxCNC prints, or not what G93 says.

    One that closes but for the last bit goes round, and its rate in G93 is that of no way at all.
    """
    if move.centre is None:
        return False
    u, v, _ = laws.PLANES[move.plane]
    gap = max(abs(move.start["XYZ"[k]] - move.end["XYZ"[k]]) for k in (u, v))
    return gap < 0.01 and (gap > 0.0 or move.feed_mode == "G93")


def by_source(moves: Iterable[CanonMove], result: gx.Result) -> Iterable[CanonMove]:
    """Yield moves with the line of the source that they came from."""
    for move in moves:
        yield replace(move, line=result.source_map[move.line - 1] + 1)


# --- all dialects ---

NAMES = ("linuxcnc", "fanuc", "grbl")


@pytest.mark.parametrize("name", NAMES)
def test_every_line_takes_as_long(name: str) -> None:
    done = []

    @laws.SOME
    @given(
        program=laws.programs(name, max_blocks=10, rotary=name == "linuxcnc"),
        chain=st.sampled_from(CHAINS),
    )
    def check_one(program: bytes, chain: str) -> None:
        source = program.replace(b"G95", b"G94")
        pipeline = laws.pipeline(laws.chain_of(chain), name)
        result = laws.transformed(pipeline, source)
        done.append(result is not None)
        if result is None:
            return
        text = f"{source.decode('latin-1')}\n{result.text.decode('latin-1')}\n{chain}"
        before, after = interpret(source, name), interpret(result.text, name)
        off = pipeline.limit(b"G20" in result.text.upper())
        lines = result.source_map
        moves = [replace(m, line=lines[m.line - 1] + 1) for m in after.moves]
        check(of_reference(before.moves, 0.0), of_reference(moves, off), CLOSE, text)
        assert [event for _, event in before.events] == [event for _, event in after.events]
        wanted = {INVERSE: {"G93"}, MINUTE: {"G94"}}.get(chain)
        if wanted:
            assert {m.feed_mode for m in moves if m.kind != "RAPID"} <= wanted

    check_one()
    assert sum(done) > len(done) / 3


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("mode", ["inverse-time", "per-minute"])
def test_a_second_time_changes_nothing(name: str, mode: str) -> None:
    chain = laws.pipeline(laws.chain_of(f"feed mode={mode}"), name)

    @laws.FEW
    @given(program=laws.programs(name, max_blocks=10, rotary=False))
    def check_one(program: bytes) -> None:
        result = laws.transformed(chain, program)
        if result is not None:
            assert chain.run(result.text).text == result.text

    check_one()
