"""Acts that turn, scale or mirror words, or read them as radius, angle or diameter."""

from __future__ import annotations

import numpy as np

from gcxform.modal.frame_state import FrameState, Turn, replace, rotation
from gcxform.modal.frames.act import Act, ActError, Asked
from gcxform.toolpath.path import Plane


def rotate(state: FrameState, asked: Asked) -> FrameState:
    """G68: turn about a point of the plane."""
    first, second, _ = asked.plane.axes
    names = "XYZ"[first], "XYZ"[second]
    if asked.incremental:
        raise ActError("GX213", f"{asked.code} under G91 differs between controls")
    if set(asked.axes) != set(names):
        raise ActError("GX213", f"{asked.code} needs its centre: {names[0]} and {names[1]}")
    if not asked.written.keys().isdisjoint("IJK"):
        raise ActError("GX213", f"{asked.code} about an axis in space is not followed")
    if "R" not in asked.written:
        raise ActError("GX213", f"{asked.code} needs its angle: R")
    centre = [0.0, 0.0, 0.0]
    for axis in names:
        centre["XYZ".index(axis)] = asked.axes[axis]
    turn = Turn(rotation(asked.written["R"], first, second), (centre[0], centre[1], centre[2]))
    return _turned(state, asked, "rotate", turn)


def scale(state: FrameState, asked: Asked) -> FrameState:
    """G51: scale about a point."""
    if "P" in asked.written:
        raise _scale_unit(asked)
    factors = [asked.written.get(letter, np.nan) for letter in "IJK"]
    if np.isnan(factors).any() or 0.0 in factors:
        raise ActError("GX213", f"{asked.code} needs its factors: I, J and K, none of them 0")
    raise _scale_unit(asked)


def _scale_unit(asked: Asked) -> ActError:
    return ActError(
        "GX214",
        f"what a factor of 1 is in {asked.code} depends on a parameter of the control",
        "let the CAM system write the scaled program",
    )


def mirror(state: FrameState, asked: Asked) -> FrameState:
    """G51.1: mirror named axes about the points given."""
    if not asked.axes or set(asked.axes) - set("XYZ"):
        raise ActError("GX213", f"{asked.code} needs X, Y or Z")
    if asked.dialect.offset_rule.mirrors_at_zero and any(asked.axes.values()):
        raise ActError("GX213", f"where {asked.code} mirrors is known for zeros only")
    matrix, centre = np.eye(3), [0.0, 0.0, 0.0]
    for axis, value in asked.axes.items():
        k = "XYZ".index(axis)
        matrix[k, k], centre[k] = -1.0, value
    rows = [(float(a), float(b), float(c)) for a, b, c in matrix]
    turn = Turn((rows[0], rows[1], rows[2]), (centre[0], centre[1], centre[2]))
    return _turned(state, asked, "mirror", turn)


def _turned(state: FrameState, asked: Asked, name: str, turn: Turn) -> FrameState:
    if state.turns or state.polar:
        before = state.turns[0][0] if state.turns else "polar words"
        raise ActError("GX213", f"{asked.code} upon {before}: controls differ in order")
    return replace(state, turns=((name, turn),))


def no_turn(name: str) -> Act:
    """Return the act that ends a kind of turn."""

    def ended(state: FrameState, asked: Asked) -> FrameState:
        if name == "mirror" and asked.axes and not _mirrored(state) <= set(asked.axes):
            raise ActError("GX213", f"{asked.code} for some of the mirrored axes is not followed")
        state = replace(state, turns=tuple(turn for turn in state.turns if turn[0] != name))
        return no_plane(state, asked) if name == "rotate" else state

    return ended


def plane(state: FrameState, asked: Asked) -> FrameState:
    """G68.2 and G53.1: another plane, or other angles, nobody knows where."""
    count = state.tilted + 1
    return replace(state, tilt=f" in {asked.code} ({count})", tilted=count)


def no_plane(state: FrameState, asked: Asked) -> FrameState:
    """G69: the coordinates of the work offset again; a tip is none of its planes."""
    followed = state.plane if state.plane is not None and state.plane.tip else None
    return replace(state, tilt="", plane=followed)


def _mirrored(state: FrameState) -> set[str]:
    """Return the axes that G51.1 has mirrored."""
    matrices = [turn.matrix for name, turn in state.turns if name == "mirror"]
    return {axis for matrix in matrices for k, axis in enumerate("XYZ") if matrix[k][k] < 0}


def polar(state: FrameState, asked: Asked) -> FrameState:
    """G16: radius and angle about the zero of the work offset."""
    if asked.incremental or state.turns:
        raise ActError("GX213", f"{asked.code} under G91, or turned: controls differ in the pole")
    return replace(state, polar=True)


def no_polar(state: FrameState, asked: Asked) -> FrameState:
    """G15: words are coordinates again."""
    return replace(state, polar=False)


def diameter(state: FrameState, asked: Asked) -> FrameState:
    """G7, G8: X words are diameters, or not."""
    return replace(state, diameter=asked.code == "G7")


def turned_by(before: FrameState, after: FrameState, plane: Plane) -> int:
    """Return the axes, as bits, of which controls differ in where a turn leaves them."""
    if before.polar != after.polar:
        first, second, _ = plane.axes
        return 1 << first | 1 << second
    turns = {*before.turns} ^ {*after.turns}
    matrices = [np.array(turn.matrix) - np.eye(3) for _, turn in turns]
    return sum({1 << int(k) for matrix in matrices for k in np.flatnonzero(matrix.any(axis=1))})
