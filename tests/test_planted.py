"""Faults planted in a pass: each is caught by the proof that every run makes, before it is written.

A pass that is wrong once stands at the end of a chain and promises to move nothing. What it has
spoiled is refused by the verification or by the writer; a program that comes out does on the
machine what the source does, which the proof of a run without the fault has shown by its bytes.
`test_verify.py` has writers that lie, `faults/` what the tests notice.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from test_verify import Change, inserted, run, said
from test_verify import swapped as swapped_lines

import gcxform as gx
from gcxform.machine.machine import Machine, Tool
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.toolpath.path import Form, Kind, Toolpath

START = dict.fromkeys("XYZA", 0.0)
OFFSETS = {"G54": START, "G55": {**START, "X": 100.0}}
MILL = Machine(
    file=Path("mill.toml"),
    work_offsets=OFFSETS,
    homes={"G28": START},
    tools={1: Tool(length=50.0, radius=2.0)},
)
PROGRAM = b"""\
G21 G90 G17 G94
T1 M6
S1000 M3
G0 X0 Y0 Z5 A0
M8
G1 Z-1.5 F100
X40 Y-10 F300
G2 X60 Y10 I0 J20
G3 X60 Y10 Z-8 I5 J0 P2
G1 X60 Y40 A90
G4 P1.5
G93 G1 X0 Y40 F2
G94 F120 G91
G1 X1.5 Y-2.5
G1 X-3 Z2
G90 G18 G2 X8.5 Z-6 I5 K0 F150
G17 G53 G1 X5 Y5 F200
G55 G1 X5 Y7
G54 G0 Z20
G5 X20 Y20 I5 J0 P0 Q-5 F100
G0 X1 Y1
G81 X5 Y5 Z-3 R2 F90
X9
G80
G33 Z-5 K1.5
G0 Z20
G41.1 D4 G1 X20 Y0 F100
X30
Y30
G40 G1 X40 Y40
G0 Z30
G28 X0 Z31
G38.2 Z-10 F50
M9
M2
"""
LINES = dict(
    rapid=4, plunge=6, line=7, arc=8, helix=9, turning=10, timed=12, step=14, back=15, upright=16,
    machine=17, other=18, up=19, spline=20, away=21, hole=22, again=23, thread=25, contour=28,
    corner=29, home=32, probe=33,
)  # fmt: skip

Fault = Callable[[Toolpath], Toolpath]


def row_of(path: Toolpath, name: str, nth: int = 0) -> int:
    """Return the row of a move of the program."""
    return int(np.flatnonzero(path.source == LINES[name] - 1)[nth])


def changed(name: str, column: str, change: Callable[[np.ndarray], object], nth: int = 0) -> Fault:
    """Return a fault in one value of a column; the function gets what stands there."""

    def fault(path: Toolpath) -> Toolpath:
        values, row = np.array(getattr(path, column)), row_of(path, name, nth)
        values[row] = change(values[row])
        return path.replace(**{column: values})

    return fault


def shifted(name: str, axis: str, size: float, nth: int = 0) -> Fault:
    """Return a fault that moves the end of a move; the next move starts there."""

    def fault(path: Toolpath) -> Toolpath:
        end = np.array(path.end)
        end[row_of(path, name, nth), path.axes.index(axis)] += size
        return path.replace(end=end)

    return fault


def onwards(name: str, axis: str, size: float) -> Fault:
    """Return a fault that shifts all from a move on: an offset that is taken twice."""

    def fault(path: Toolpath) -> Toolpath:
        end = np.array(path.end)
        end[row_of(path, name) :, path.axes.index(axis)] += size
        return path.replace(end=end)

    return fault


def everywhere(change: Callable[[np.ndarray, str], np.ndarray]) -> Fault:
    """Return a fault in all positions."""
    return lambda path: path.replace(end=change(np.array(path.end), path.axes))


def taken(order: Callable[[list[int], Toolpath], list[int]]) -> Fault:
    """Return a fault in which rows there are, and in their order; events stay with their rows."""

    def fault(path: Toolpath) -> Toolpath:
        rows = order(list(range(len(path))), path)
        place = {row: at for at, row in reversed([*enumerate(rows)])}
        events = tuple(
            e.at(next((place[r] for r in range(e.row, len(path)) if r in place), len(rows)))
            for e in path.events
        )
        return path.take(np.array(rows)).replace(events=events)

    return fault


def without(name: str) -> Fault:
    return taken(lambda rows, path: [row for row in rows if row != row_of(path, name)])


def swapped(name: str) -> Fault:
    def order(rows: list[int], path: Toolpath) -> list[int]:
        k = row_of(path, name)
        rows[k], rows[k + 1] = rows[k + 1], rows[k]
        return rows

    return taken(order)


def twice(name: str) -> Fault:
    return taken(lambda rows, path: sorted([*rows, row_of(path, name)]))


def bulged(name: str, size: float) -> Fault:
    """Cut a line in two, with its middle off the line."""

    def fault(path: Toolpath) -> Toolpath:
        row = row_of(path, name)
        counts = np.ones(len(path), np.int64)
        counts[row] = 2
        out = path.with_rows(counts)
        end = np.array(out.end)
        end[row] = (path.start[row] + path.end[row]) / 2
        end[row, 1] += size
        return out.replace(end=end)

    return fault


def chord(name: str) -> Fault:
    """Make a line of an arc."""

    def fault(path: Toolpath) -> Toolpath:
        row = row_of(path, name)
        kind, sweep, centre = np.array(path.kind), np.array(path.sweep), np.array(path.centre)
        kind[row], sweep[row], centre[row] = Kind.LINE, 0.0, np.nan
        return path.replace(kind=kind, sweep=sweep, centre=centre)

    return fault


def in_frame(name: str, other: str) -> Fault:
    """Say a move in the frame of another one, where its position is a different one."""

    def fault(path: Toolpath) -> Toolpath:
        row, there = row_of(path, name), path.frame[row_of(path, other)]
        words = np.array(path.words)
        frame = np.array(path.frame)
        frame[row] = there
        end = np.array(path.end)
        end[row] = path.frames[there].positions(words[row : row + 1])[0]
        return path.replace(end=end)

    return fault


def negated(name: str) -> Fault:
    """Turn the sense of a distance round."""

    def fault(path: Toolpath) -> Toolpath:
        row, end = row_of(path, name), np.array(path.end)
        end[row] = 2 * path.start[row] - path.end[row]
        return path.replace(end=end)

    return fault


def mirrored(values: np.ndarray, axes: str) -> np.ndarray:
    values[:, 1] *= -1
    return values


def crossed(values: np.ndarray, axes: str) -> np.ndarray:
    values[:, [0, 1]] = values[:, [1, 0]]
    return values


PLANTED: dict[str, Fault] = {
    "an end is off by a hundredth": shifted("line", "X", 0.01),
    "an end is off by twice the budget": shifted("line", "Y", 0.02),
    "a depth": shifted("plunge", "Z", -0.05),
    "the end of a rapid": shifted("rapid", "X", 0.05),
    "an offset at G53": shifted("machine", "X", 0.05),
    "an offset at G53 and all behind it": onwards("machine", "Y", 0.05),
    "the point by way of which G28 goes": shifted("home", "Z", 1.0),
    "home itself": shifted("home", "X", 0.5, 1),
    "an offset from G55 on": onwards("other", "X", 100.0),
    "the place of a hole": shifted("hole", "X", 0.05),
    "the depth of a hole": shifted("again", "Z", -0.5, 2),
    "the wrong sign in G91": negated("step"),
    "a distance of G91 twice": shifted("back", "X", -3.0),
    "all mirrored": everywhere(mirrored),
    "two axes exchanged": everywhere(crossed),
    "all a thousandth larger": everywhere(lambda values, axes: values * 1.001),
    "all rounded to a tenth": everywhere(lambda values, axes: np.round(values * 4.1) / 4.1),
    "a rotary axis is off": shifted("turning", "A", 0.5),
    "a rotary axis a turn off": shifted("turning", "A", 360.0),
    "the sense of an arc": changed("arc", "kind", lambda kind: Kind.ARC_CCW),
    "the sense of a helix": changed("helix", "kind", lambda kind: Kind.ARC_CW),
    "a centre": changed("arc", "centre", lambda centre: centre + np.array([0.0, 0.1, 0.0])),
    "a dropped turn": changed("helix", "sweep", lambda sweep: sweep - 2 * np.pi),
    "a turn more": changed("helix", "sweep", lambda sweep: sweep + 2 * np.pi),
    "a part of the sweep": changed("arc", "sweep", lambda sweep: sweep / 2),
    "the height of a helix": shifted("helix", "Z", 6.5),
    "an arc becomes its chord": chord("arc"),
    "a circle becomes a line": chord("helix"),
    "a feed": changed("line", "feed", lambda feed: 310.0),
    "a feed is lost": changed("line", "feed", lambda feed: np.nan),
    "the time of a move": changed("timed", "feed", lambda feed: 2.5),
    "a rapid cuts": changed("up", "kind", lambda kind: Kind.LINE),
    "a cut is a rapid": changed("line", "kind", lambda kind: Kind.RAPID),
    "a move is missing": without("line"),
    "an arc is missing": without("arc"),
    "a move to another height is missing": without("up"),
    "two moves change places": swapped("line"),
    "two moves of G91 change places": swapped("step"),
    "a circle comes twice": twice("helix"),
    "a line bulges": bulged("line", 0.05),
    "a line of four axes bulges": bulged("turning", 0.05),
    "a spline becomes a line": changed("spline", "form", lambda form: Form.PLAIN),
    "a probe goes elsewhere": shifted("probe", "Z", -1.0),
    "a probe becomes a feed move": changed("probe", "form", lambda form: Form.PLAIN),
    "a thread becomes a feed move": changed("thread", "form", lambda form: Form.PLAIN),
    "a thread is too deep": shifted("thread", "Z", -1.0),
    "the contour under compensation": shifted("contour", "X", 0.05),
}


WRITTEN: dict[str, Change] = {
    "G53 is left out": said("G17 G53 G1", "G17 G1"),
    "another work offset": said("G55 G1", "G54 G1"),
    "the work offset stays": said("G54 G0", "G0"),
    "an offset more": inserted("G92 X0", 6),
    "a tool length": inserted("G43 H1", 6),
    "a work offset is set": inserted("G10 L2 P1 X5", 3),
    "the side of the contour": said("G41.1", "G42.1"),
    "the diameter of the tool": said("D4", "D5"),
    "compensation does not end": said("G40 G1", "G1"),
    "the clearance of a cycle": said("R2", "R3"),
    "the depth of a cycle": said("Z-3 R2", "Z-4 R2"),
    "another cycle": said("G81", "G85"),
    "a hole twice": said("X9", "X9 L2"),
    "the pitch of a thread": said("K1.5", "K1.6"),
    "a thread becomes a line": said("G33 Z-5 K1.5", "G1 Z-5"),
    "another probe": said("G38.2", "G38.3"),
    "a probe becomes a line": said("G38.2", "G1"),
    "a control point": said("Q-5", "Q-6"),
    "a spline becomes a line": said("G5 X20 Y20 I5 J0 P0 Q-5", "G1 X20 Y20"),
    "the plane of an arc": said("G90 G18", "G90"),
    "a turn more": said("P2", "P3"),
    "one axis goes home": said("G28 X0 Z31", "G28 Z31"),
    "G28 becomes G30": said("G28", "G30"),
    "the way home": said("Z31", "Z1"),
    "another tool": said("T1", "T2"),
    "no tool change": said("T1 M6", "T1"),
    "distances become positions": said(" G91", ""),
    "positions become distances": said("G90 G18", "G18"),
    "a feed of before": said(" F120", ""),
    "the other rotary axis": said("A90", "B90"),
    "the spindle turns the other way": said("M3", "M4"),
    "the coolant stops early": swapped_lines(31),
    "no dwell": said("G4 P1.5", ""),
    "milliseconds for seconds": said("P1.5", "P1500"),
    "the end is another one": said("M2", "M30"),
    "inches": said("G21", "G20"),
    "a stop more": inserted("M0", 9),
    "a line is not executed": said("G1 X60 Y40", "(G1 X60 Y40)"),
    "a line is deleted by a slash": said("X9", "/X9"),
    "a line of a subroutine": said("X9", "o1 sub\nX9\no1 endsub"),
}


def planted(fault: Fault) -> gx.Pass:
    """Return a pass that spoils the path and promises that it is as it was."""

    class Planted(gx.Pass):
        name = "planted"

        def apply(self, path: Toolpath, context: gx.PassContext) -> Toolpath:
            return fault(path)

    return Planted()


def nothing(path: Toolpath) -> Toolpath:
    return path


def pipeline(fault: Fault = nothing) -> gx.Pipeline:
    kind = default_registry().dialect("linuxcnc")
    reading = Reading(start=START)
    return gx.Pipeline(kind, kind, (planted(fault),), reading, MILL, budget=0.004)


def test_without_a_fault_the_program_is_written() -> None:
    assert pipeline().run(PROGRAM, verify="full").text == PROGRAM
    assert run(iter, pipeline(), PROGRAM) == PROGRAM


def test_there_are_many() -> None:
    assert len(PLANTED) + len(WRITTEN) >= 80


@pytest.mark.parametrize("name", PLANTED)
def test_a_fault_planted_in_a_pass_is_caught(name: str) -> None:
    with pytest.raises((gx.VerificationError, gx.InputError), match=r"GX601|GX50[46]|GX233|GX302"):
        pipeline(PLANTED[name]).run(PROGRAM)


@pytest.mark.parametrize("name", WRITTEN)
def test_a_fault_planted_in_the_writer_is_caught(name: str) -> None:
    with pytest.raises(gx.VerificationError):
        run(WRITTEN[name], pipeline(), PROGRAM)
