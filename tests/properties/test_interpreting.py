"""The vectorised interpreter against the scalar reference, in windows of any size."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference.interpreter import Move, Refused, interpret

import gcxform as gx
from gcxform.modal.interpreter import Interpreter
from gcxform.plugin.registry import default_registry
from gcxform.proof.verify import WindowReader
from gcxform.syntax.source import Source
from gcxform.testing.strategies import programs
from gcxform.toolpath.path import FeedMode, Kind, Plane, Toolpath

KINDS = {Kind.RAPID: "RAPID", Kind.LINE: "LINE", Kind.ARC_CW: "ARC_CW", Kind.ARC_CCW: "ARC_CCW"}
MODES = {FeedMode.INVERSE_TIME: "G93", FeedMode.PER_MINUTE: "G94", FeedMode.PER_TURN: "G95"}
CLOSE = 1e-9  # mm, degrees
HALF_TURN = 1e-6  # mm; the centre of an arc by radius over half a turn hangs on the last bits


class KeepingFanuc(default_registry().dialect("fanuc")):  # type: ignore[misc]
    """A Fanuc whose tool change moves no axis, as the reference has it."""

    m_codes = {**default_registry().dialect("fanuc").m_codes, 6: gx.MCode("tool")}  # noqa: RUF012


class KeepingHaas(default_registry().dialect("haas")):  # type: ignore[misc]
    """A Haas whose tool change moves no axis, as the reference has it."""

    m_codes = {**default_registry().dialect("haas").m_codes, 6: gx.MCode("tool")}  # noqa: RUF012


DIALECTS = {
    "fanuc": KeepingFanuc,
    "haas": KeepingHaas,
    "grbl": default_registry().dialect("grbl"),
    "linuxcnc": default_registry().dialect("linuxcnc"),
}


def paths_of(program: bytes, name: str, size: int) -> list[Toolpath]:
    """Return the toolpaths of the windows of a program."""
    dialect = DIALECTS[name]
    reader, axes = WindowReader(dialect), "XYZ" if name == "grbl" else "XYZABC"
    interpreter = Interpreter(dialect, axes=axes)
    windows = map(reader.read, Source.of_bytes(program).windows(size))
    return [interpreter.interpret(window, reader.table).path for window in windows]


def moves_of(path: Toolpath) -> list[Move]:
    """Return a toolpath as moves of the reference."""
    moves = []
    for row in range(len(path)):
        kind, mode = Kind(path.kind[row]), FeedMode(path.feed_mode[row])
        start, end = (
            {a: float(v) for a, v in zip(path.axes, p, strict=True) if not math.isnan(v)}
            for p in (path.start[row], path.end[row])
        )
        arc: dict[str, Any] = {}
        if kind >= Kind.ARC_CW:
            arc = {"centre": tuple(path.centre[row].tolist()), "sweep": float(path.sweep[row])}
        moves.append(
            Move(
                KINDS[kind],
                start,
                end,
                int(path.source[row]) + 1,
                None if kind == Kind.RAPID else float(path.feed[row]),
                MODES[mode],
                Plane(path.plane[row]).name,
                **arc,
            )
        )
    return moves


def assert_same(mine: Move, other: Move) -> None:
    assert (mine.kind, mine.line, mine.plane) == (other.kind, other.line, other.plane)
    assert mine.feed_mode == other.feed_mode
    assert mine.end == pytest.approx(other.end, abs=CLOSE, rel=0)
    assert mine.start == pytest.approx(other.start, abs=CLOSE, rel=0)
    assert (mine.feed is None) == (other.feed is None)
    assert (mine.feed or 0.0) == pytest.approx(other.feed or 0.0, rel=CLOSE)
    if other.centre is not None:
        assert mine.centre is not None
        half = abs(math.remainder(other.sweep - math.pi, math.tau)) < HALF_TURN
        close = HALF_TURN if half else CLOSE
        assert mine.centre == pytest.approx(other.centre, abs=close, rel=0, nan_ok=True)
        radius = math.dist(mine.centre, list(mine.start.values())[:3])
        assert mine.sweep == pytest.approx(other.sweep, abs=CLOSE + close / radius, rel=0)


@pytest.mark.parametrize("name", DIALECTS)
@given(data=st.data())
def test_columns_and_scalars_read_alike(name: str, data: st.DataObject) -> None:
    program = data.draw(programs(name))
    size = data.draw(st.sampled_from((1 << 19, 1, 20, 57, 200)))
    expected = interpret(program, name).moves
    moves = [move for path in paths_of(program, name, size) for move in moves_of(path)]
    assert len(moves) == len(expected)
    for mine, other in zip(moves, expected, strict=True):
        assert_same(mine, other)


def refused_line(program: bytes, name: str) -> int:
    """Return the first line that is refused, 0 if none is."""
    try:
        paths_of(program, name, 1 << 19)
    except gx.InputError as error:
        where = error.diagnostics[0].where
        return where.line if where else -1
    return 0


@pytest.mark.parametrize("name", DIALECTS)
@given(data=st.data())
def test_refusals_agree(name: str, data: st.DataObject) -> None:
    """Without its first motion block a program often has no known position."""
    lines = data.draw(programs(name)).split(b"\n")
    del lines[data.draw(st.integers(0, len(lines) - 3))]  # LinuxCNC needs its end
    program = b"\n".join(lines)
    try:
        interpret(program, name)
        expected = 0
    except Refused as refusal:
        expected = refusal.line
    assert refused_line(program, name) == expected, program


def test_a_tool_change_of_a_fanuc_ends_what_is_known() -> None:
    dialect = default_registry().dialect("fanuc")
    reader = WindowReader(dialect)
    window = reader.read(b"G0 X1. Y2. Z3.\nT1 M6\nG0 X5.\n")
    path = Interpreter(dialect, axes="XYZ").interpret(window, reader.table).path
    assert np.isnan(path.end[1]).tolist() == [False, True, True]
