"""LinuxCNC's interpreter as the judge of canned cycles: the same moves, or the same refusal."""

from __future__ import annotations

import random

import pytest
from cycle_kit import Drawn, Played, Player, text
from oracles import rs274, toolpaths
from oracles.canon import CanonProgram
from seeds_kit import DRAWN, shares

import gcxform as gx
from gcxform.plugin.registry import default_registry

COUNT = 5 * DRAWN
NEAR = 1e-4  # of a unit of the program: the rounding of the print, and a little

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


@shares(COUNT, 250)
def test_cycles_move_as_linuxcnc_moves(seeds: range) -> None:
    rule = default_registry().dialect("linuxcnc").cycle_rule
    assert rule is not None
    moves = refused = 0
    programs = [Drawn(seed).blocks() for seed in seeds]
    answers = rs274.run_many([text(blocks) for blocks in programs])
    for blocks, answer in zip(programs, answers, strict=True):
        played = Player(rule).play(blocks)
        problem = difference(played, answer) or program_difference(text(blocks), answer)
        assert problem == "", f"{problem}\n{text(blocks).decode()}"
        moves += len(played.moves)
        refused += played.refused > 0
    assert moves > 20 * len(seeds)
    assert 0.05 * len(seeds) < refused < 0.5 * len(seeds)


def program_difference(program: bytes, answer: CanonProgram | rs274.Rejected) -> str:
    """Say how a program as the package reads it differs from what LinuxCNC does."""
    try:
        path = read(program)
    except gx.InputError as error:
        return "" if isinstance(answer, rs274.Rejected) else f"refused by us alone: {error}"
    if isinstance(answer, rs274.Rejected):
        return f"refused by LinuxCNC alone: {answer}"
    return toolpaths.difference(path, answer)


def read(program: bytes) -> gx.Toolpath:
    return toolpaths.read(program, {})


def test_linuxcnc_makes_the_moves_of_expanded_cycles() -> None:
    """What the pass `cycles` writes, alone and in chains, moves as the program with cycles does."""
    jobs = []
    for seed in range(COUNT // 2):
        program = text(Drawn(seed).blocks())
        chain = random.Random(seed).choice(CHAINS)
        try:
            jobs.append((read(program), chain, gx.Pipeline.parse(chain, "linuxcnc").run(program)))
        except gx.VerificationError as error:
            pytest.fail(f"{chain}: {error}\n{program.decode()}")
        except gx.InputError:
            continue
    assert len(jobs) > 0.25 * COUNT
    answers = rs274.run_many([result.text for _, _, result in jobs])
    for (path, chain, result), answer in zip(jobs, answers, strict=True):
        assert isinstance(answer, CanonProgram), f"{answer}\n{result.text.decode()}"
        problem = toolpaths.difference(path, answer)
        assert problem == "", f"{chain}: {problem}\n{result.text.decode()}"


CHAINS = ("cycles", "cycles | absolute", "absolute | cycles", "cycles | offsets")


def difference(played: Played, answer: CanonProgram | rs274.Rejected) -> str:
    if isinstance(answer, rs274.Rejected) or played.refused:
        line = answer.line if isinstance(answer, rs274.Rejected) else 0
        same = line == played.refused
        return "" if same else f"refused: {played.refused} {played.why}, theirs: {answer}"
    ends = [(m.kind, m.end["X"], m.end["Y"], m.end["Z"]) for m in answer.moves]
    if [m.line for m in answer.moves] != played.lines:
        return f"lines {played.lines}, {[m.line for m in answer.moves]}\n{played.moves}\n{ends}"
    for ours, theirs, move in zip(played.moves, ends, answer.moves, strict=True):
        near = NEAR * move.unit
        if ours[0] != theirs[0] or any(
            abs(a - b) > near for a, b in zip(ours[1:], theirs[1:], strict=True)
        ):
            return f"line {move.line}: {ours}, theirs {theirs}"
    events = [(row, name) for row, name in answer.events if name[0] not in "S" and name != "M2"]
    return "" if events == played.events else f"events {played.events}, {events}"


@pytest.mark.parametrize("code", [74, 84])
def test_linuxcnc_taps_in_other_planes_at_another_place(code: int) -> None:
    """Why this is refused: the feed goes to X-4 Y3 Z1, and not to the hole at X1 Y-4 Z3."""
    turning = "M4" if code == 74 else "M3"
    program = f"G0 X10 Y20 Z30\n{turning} S100 F100\nG18 G{code} X1 Y-4 Z3 R2\nM2\n"
    move = next(m for m in rs274.run(program.encode()).moves if m.kind == "LINE")
    assert [move.end[axis] for axis in "XYZ"] == [-4, 3, 1]
