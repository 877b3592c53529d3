"""Pieces in corners (`,R5.` and `,C3.`) lie where plane geometry has them, and the control goes."""

from __future__ import annotations

import cmath
import math
import random
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
import seeds_kit
from across_kit import DIALECTS
from oracles import rs274

import gcxform as gx
from gcxform.syntax.source import before_corners
from gcxform.toolpath.path import Kind, Toolpath

HEAD = "G21 G17 G90 G94 G54\nG0 X0 Y0 Z0\n"
CLOSE = 1e-9  # mm
PLANES = {"G17": "XYZ", "G18": "ZXY", "G19": "YZX"}


class Move(NamedTuple):
    """A move in a plane: what is in the program, and where its arc has its centre."""

    kind: int
    end: complex
    centre: complex = complex("nan")


class Drawn(NamedTuple):
    """The corners of a contour from 0, and the words there: `,R2.`, `,C1.` or nothing."""

    points: list[complex]
    words: list[str]


def drawn(seed: int) -> Drawn:
    """Return a contour with pieces that fit."""
    draw = random.Random(seed)
    points, heading = [0j], draw.uniform(0, math.tau)
    for _ in range(draw.randint(2, 7)):
        point = points[-1] + cmath.rect(draw.uniform(10, 40), heading)
        points.append(complex(round(point.real, 3), round(point.imag, 3)))
        heading += draw.choice((1, -1)) * draw.choice((math.pi / 2, draw.uniform(0.1, 2.8)))
    words = [""]
    for a, v, b in zip(points, points[1:], points[2:], strict=False):
        room = draw.uniform(0.05, 0.45) * min(abs(v - a), abs(b - v))
        flat = room / abs(math.tan(cmath.phase((b - v) / (v - a)) / 2))
        size = {"C": room, "R": flat}[letter := draw.choice("CR")]
        words.append(f" ,{letter}{size:.4f}" if draw.random() < 0.8 and size > 0.01 else "")
    return Drawn(points, [*words, ""])


def wanted(contour: Drawn) -> list[Move]:
    """Return the moves: an arc is about the point that is r beside both lines, where they cross."""
    moves = []
    for nth, (v, word) in enumerate(zip(contour.points, contour.words, strict=True)):
        if not word:
            moves.append(Move(Kind.LINE, v))
            continue
        a, b, size = contour.points[nth - 1], contour.points[nth + 1], float(word[3:])
        u, w = (v - a) / abs(v - a), (b - v) / abs(b - v)
        if word[2] == "C":
            moves += [Move(Kind.LINE, v - size * u), Move(Kind.LINE, v + size * w)]
            continue
        left = 1j if (u.conjugate() * w).imag > 0 else -1j
        matrix = [[u.real, -w.real], [u.imag, -w.imag]]
        gap = left * size * (w - u)
        along = float(np.linalg.solve(matrix, [gap.real, gap.imag])[0])
        centre = v + left * size * u + along * u
        kind = Kind.ARC_CCW if left == 1j else Kind.ARC_CW
        moves += [Move(Kind.LINE, centre - left * size * u)]
        moves += [Move(kind, centre - left * size * w, centre)]
    return moves[1:]


def program(contour: Drawn, plane: str = "G17", steps: bool = False) -> str:
    """Return the blocks of a contour."""
    first, second, _ = PLANES[plane]
    blocks, before = [f"{plane} {'G91' if steps else 'G90'} F100."], 0j
    for v, word in zip(contour.points[1:], contour.words[1:], strict=True):
        to = v - before if steps else v
        blocks.append(f"G1 {first}{to.real:.3f} {second}{to.imag:.3f}{word}")
        before = v
    return "\n".join([*blocks, "G90", ""])


def written(text: str, chain: str, target: str = "fanuc") -> bytes:
    """Return what a chain makes of a program, with six decimals."""
    made = replace(gx.Pipeline.parse(chain, "fanuc"), target=DIALECTS[target])
    return replace(made, numbers=gx.NumberFormat(mm=6, inch=7)).run(text.encode(), "full").text


def check(path: Toolpath, moves: list[Move], plane: str = "G17") -> None:
    """Compare a path behind its first rapid with moves."""
    axes = ["XYZ".index(axis) for axis in PLANES[plane][:2]]
    path = path.take(np.arange(len(path)) > 0)
    assert path.kind.tolist() == [move.kind for move in moves]
    for places, name in ((path.end, "end"), (path.centre, "centre")):
        found = places[:, axes[0]] + 1j * places[:, axes[1]]
        there = np.array([getattr(move, name) for move in moves])
        there = there if name == "end" else np.where(path.is_arc, there, found)
        assert np.abs(np.nan_to_num(found - there)).max() < CLOSE
    radius = np.abs([move.end - move.centre for move in moves])
    length = np.abs(np.diff([0j, *(move.end for move in moves)]))
    chord = 2 * radius * np.sin(path.sweep / 2)
    assert np.abs(np.where(path.is_arc, chord - length, 0)).max() < CLOSE


@pytest.mark.parametrize("steps", [False, True])
@pytest.mark.parametrize("plane", PLANES)
def test_pieces_touch_both_moves(plane: str, steps: bool) -> None:
    for seed in seeds_kit.some(100):
        contour = drawn(seed)
        path = gx.read((HEAD + program(contour, plane, steps)).encode(), "fanuc").path
        check(path, wanted(contour), plane)


@pytest.mark.parametrize("code", ["G68 X0 Y0 R{:.1f}", "G51.1 X0"])
def test_they_turn_with_coordinates(code: str) -> None:
    for seed in seeds_kit.some(50):
        contour, angle = drawn(seed), random.Random(seed).uniform(-180, 180)
        said = code.format(angle)
        text = f"G21 G17 G90 G94 G54\n{said}\nG0 X0 Y0 Z0\n{program(contour)}"
        turn = cmath.rect(1, math.radians(float(said.split("R")[1]))) if "R" in said else 1
        points = [turn * v for v in contour.points]
        if "R" not in said:
            points = [-v.conjugate() for v in contour.points]
        check(gx.read(text.encode(), "fanuc").path, wanted(Drawn(points, contour.words)))


def test_unchanged_blocks_are_copied() -> None:
    for seed in seeds_kit.some(50):
        contour = drawn(seed)
        text = HEAD + program(contour) + "G0 X0 Y0\n" + program(contour, steps=True)
        assert written(text, "segment arcs=split max-length=400mm").decode() == text


def written_out(moves: list[Move]) -> str:
    """Return moves as blocks of lines and arcs."""
    blocks, at = [], 0j
    for move in moves:
        block = f"G{move.kind} X{move.end.real:.6f} Y{move.end.imag:.6f}"
        out = move.centre - at
        blocks.append(block + (f" I{out.real:.6f} J{out.imag:.6f}" if move.kind > 1 else ""))
        at = move.end
    return f"{HEAD}F100\n" + "\n".join(blocks) + "\nM2\n"


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_linuxcnc_goes_the_way_that_is_written_for_it() -> None:
    contours = [drawn(seed) for seed in seeds_kit.some(100)]
    texts = [HEAD + program(each) + "M30\n" for each in contours]
    found = rs274.run_many(written(text, "absolute", "linuxcnc") for text in texts)
    twins = rs274.run_many(written_out(wanted(each)).encode() for each in contours)
    for one, other in zip(found, twins, strict=True):
        assert not isinstance(one, rs274.Rejected)
        assert not isinstance(other, rs274.Rejected)
        assert [move.kind for move in one.moves] == [move.kind for move in other.moves]
        for a, b in zip(one.moves, other.moves, strict=True):
            assert max(abs(a.end[axis] - b.end[axis]) for axis in "XY") < 3e-4


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (b"X1\nX2 ,R5.\r\nX3 ,C5\n", 3),
        (b"X1\rX2 ,r5.\r", 3),
        (b"X1,R1\nX2\n", 9),
        (b"X1,R1\nX2 ,R1\n", 0),
        (b"", 0),
        (b"\n\n", 2),
    ],
)
def test_no_window_ends_in_a_corner(text: bytes, wanted: int) -> None:
    assert before_corners(text, len(text)) == wanted
