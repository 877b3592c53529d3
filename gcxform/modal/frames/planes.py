"""Planes in space (G68.2, G53.1) on a table that turns: where words lead in them.

G68.2 says a plane in the work offset in force, and moves nothing: a zero, and Euler angles I, J, K
about Z, X' and Z''. G53.1 turns the rotary axes until the tool stands on the plane, which the table
takes along; from there on words count in it, until G69. With w a point of the workpiece where all
rotary axes are at 0, and M_T what the table does (`gcxform/machine/chain.py`),

    w = zero of the work offset + zero of the plane + Rz(I) Rx(J) Rz(K) word
    position = M_T(q) w - gauge point + tool

The tool stands along Z, so that of the plane a turn about Z is left, and arcs stay arcs. Of two
attitudes the control takes that with the least way of the axis next to the base, then of the other
one, then the one that stands nearer to 0.

Sources: Fanuc B-63942EN/02 p. 248 and B-63944EN/02 p. 719 (angles, zero, and that the plane goes
with the table), A-78712E/04 pp. 61-62 (attitudes). The order and the sense of the angles are those
of two programs that a CAM wrote of one part for two machines. What no manual says is refused: moves
between G68.2 and G53.1, a head that turns, an attitude in which an axis is free.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gcxform.machine.chain import Chain
from gcxform.machine.inverse import State, attitudes, turns
from gcxform.machine.tilting import carried, spin
from gcxform.modal.frame_state import (
    FrameState,
    TiltedPlane,
    matrix_of,
    replace,
    rotation,
    vector_of,
)
from gcxform.modal.frames.act import ActError, Asked
from gcxform.modal.meaning.meaning import ORIENTING
from gcxform.system.arrays import Floats
from gcxform.toolpath.frames import Vector

FLAT = 1e-9  # the sine of what may be between the tool and the plane it stands on
EQUAL, APART = 1e-6, 0.01  # degrees: ways that are the same, and ways that are not for certain
TURN = 360.0
LEAVE = "leave the plane before, by G69, CYCLE800() or PLANE RESET"
ANGLES = dict(zip("ABC", "IJK", strict=True))
"""The words in which a block says to which angles the axes turn."""
IN_PLANE = frozenset(
    {
        *("length", "length-negative", "length-number", "no-length", "change-tool", "set-tool"),
        *("user-code", "call", "orient", "swivel", "turn-to", "no-rotate"),
        *("home", "machine", "probe"),
    }
)
"""Acts that leave a plane where it is."""
WITH_TIP = frozenset({"no-length", "change-tool", "set-tool", "user-code", "call", "no-rotate"})
"""Acts that leave a tip where it is, or end it."""
PLANE = "the plane"


def check_in_plane(state: FrameState, name: str, code: str) -> None:
    """Refuse an act that would change what a plane, or a tip, counts from. Raises ActError."""
    if state.plane is None:
        return
    if state.plane.tip and name not in WITH_TIP:
        message = f"{code} while the control follows the tip is not resolved"
        raise ActError("GX213", message, "draw the tool back, and write G49 before")
    if not state.plane.tip and name not in IN_PLANE:
        raise ActError("GX213", f"{code} in a tilted plane is not followed", LEAVE)


def out_of_plane(state: FrameState, failed: str) -> FrameState:
    """Return the state behind an act that failed: of words in no plane nothing need be said."""
    return replace(state, plane=None) if failed in ORIENTING else state


def define(state: FrameState, asked: Asked) -> FrameState:
    """G68.2: a plane in the coordinates of the work offset."""
    zero = zero_of_work(state, asked, PLANE)
    if asked.written.get("P") or {"Q", "R"} & asked.written.keys():
        raise ActError("GX213", f"{asked.code} is followed by three Euler angles alone: I, J, K")
    missing = [word for word in "XYZIJK" if word not in asked.written]
    if missing or set(asked.axes) - {*"XYZ"}:
        what = f"without {', '.join(missing)}" if missing else "with words of rotary axes"
        raise ActError("GX213", f"{asked.code} {what} is not followed")
    i, j, k = (asked.written[letter] for letter in "IJK")
    about_z, about_x, again = (
        np.array(turn) for turn in (rotation(i, 0, 1), rotation(j, 1, 2), rotation(k, 0, 1))
    )
    zero += [asked.words[axis] for axis in "XYZ"]
    return replace(state, plane=TiltedPlane(matrix_of(about_z @ about_x @ again), vector_of(zero)))


def zero_of_work(state: FrameState, asked: Asked, what: str) -> Floats:
    """Return where words of 0 lead (3,) with all rotary axes at 0. Raises ActError."""
    if state.turns or state.polar or any(state.rotation.values()):
        raise ActError("GX213", f"{asked.code} upon coordinates that are turned is not followed")
    zero = np.array(state.zero_of(state.work))[:3] + state.preset[:3] + state.local[:3]
    if state.adrift or not np.isfinite(zero - state.machine[:3]).all():
        raise ActError(
            "GX213",
            f"where the table takes {what} depends on where {state.work} is",
            f"say its place in the machine: [work-offset.{state.work}] in the machine file",
        )
    return np.asarray(zero)


def orient(state: FrameState, asked: Asked) -> FrameState:
    """G53.1: the rotary axes turn until the tool stands on the plane, and take it along."""
    return _oriented(state, asked, _attitude, open_=False)


def swivel(state: FrameState, asked: Asked) -> FrameState:
    """As G53.1, to the attitude that P says: of one axis the lower (-1) or the higher (1) value.

    With P0 no axis turns. Which axis that is the machine's builder has set; where only one attitude
    is within the limits that one is taken (SINUMERIK operating manual, CYCLE800, _DIR). So it does
    not hang on where the axes stand: only in which turn one without end comes to stand does, and
    all of its turns are one place.
    """
    open_ = bool(asked.written.get("P"))
    return _oriented(state, asked._replace(code="the swivel"), _said_attitude, open_)


def turn_to(state: FrameState, asked: Asked) -> FrameState:
    """As G53.1, to the angles of A, B and C that I, J and K say, for who has chosen an attitude."""
    return _oriented(state, asked._replace(code="the plane"), _told_attitude, open_=True)


def _oriented(
    state: FrameState,
    asked: Asked,
    attitude: Callable[[Chain, Floats, Floats, Asked], Floats],
    open_: bool,
) -> FrameState:
    chain, plane = asked.reading.tables, state.plane
    assert chain is not None  # else no code has this act
    if plane is None or plane.angles:
        raise ActError("GX213", f"no plane is said before {asked.code}")
    tilted = np.array(plane.turned)
    which = f"which attitude {asked.code} takes"
    angles = attitude(chain, tilted, standing(chain, state, asked, which, PLANE, open_), asked)
    turned = carried(chain, tilted, angles)
    if np.abs(turned[2] - [0.0, 0.0, 1.0]).max() > FLAT:
        raise ActError("GX213", f"{asked.code}: in no attitude the tool stands on the plane")
    zero = zero_carried(chain, state, np.array(plane.zero), angles)
    about_z = rotation(spin(turned), 0, 1)
    return replace(state, plane=TiltedPlane(about_z, zero, named(chain, angles)))


def named(chain: Chain, angles: Floats) -> dict[str, float]:
    """Return angles (axes,) by the letters of their axes."""
    return {axis: float(angle) for axis, angle in zip(chain.letters, angles, strict=True)}


def zero_carried(chain: Chain, state: FrameState, zero: Floats, angles: Floats) -> Vector:
    """Return where a zero (3,) is once the table has taken it along."""
    gauge, base = np.array(chain.tip), np.array(state.machine[:3])
    return vector_of(chain.onto_machine(zero - base + gauge, angles) - gauge + base)


def standing(
    chain: Chain, state: FrameState, asked: Asked, what: str, turned: str, open_: bool = False
) -> Floats:
    """Return where the rotary axes stand in the machine, degrees. Raises ActError.

    `what` depends on it, and `turned` is what turns with the axes; where it may be `open_`, one of
    which it is not known is said to be at 0.
    """
    found = np.full(len(chain.axes), np.nan)
    for n, axis in enumerate(chain.axes):
        if axis.letter in state.axes:
            k = state.axes.index(axis.letter)
            found[n] = asked.position[k] - state.machine[k]
            _check_unturned(state, asked, k, turned)
        if np.isnan(found[n]) and not open_:
            raise ActError(
                "GX213",
                f"{what} depends on where {axis.letter} stands",
                f"write {axis.letter} before, or say start = {{ {axis.letter} = ... }} in [input]",
            )
    return np.asarray(np.nan_to_num(found))


def _check_unturned(state: FrameState, asked: Asked, k: int, turned: str) -> None:
    """Refuse a zero of a rotary axis, in column k, off that of the machine. Raises ActError.

    Whether X, Y and Z then lie on the table as that turns them no manual says; G52 and G92 shift
    the zero of a work offset as its own number does.
    """
    letter = state.axes[k]
    elsewhere = f"say {turned} in a work offset that does not"
    for what, shift, hint in (
        (state.work, state.zero_of(state.work)[k] - state.machine[k], elsewhere),
        ("G52 or G92", state.preset[k] + state.local[k], f"end it before {turned}"),
    ):
        if abs(shift) > EQUAL:
            message = f"{asked.code}: {what} turns {letter}, and {turned} with it"
            raise ActError("GX213", message, hint)


def _check_ways(chain: Chain, asked: Asked) -> None:
    """Refuse axes of which it is not known how far they turn. Raises ActError."""
    for axis in chain.axes:
        if axis.limits is None and axis.wrap is None:
            raise ActError(
                "GX213",
                f"which attitude {asked.code} takes depends on how far {axis.letter} turns",
                f"say limits, or wrap, in [axis.{axis.letter}] of the machine file",
            )


def _attitude(chain: Chain, tilted: Floats, standing: Floats, asked: Asked) -> Floats:
    """Return the angles (axes,) that the control takes. Raises ActError."""
    angles, free = _possible(chain, tilted, standing, asked)
    angles = _nearest(angles, standing, asked)
    if free is not None and abs(spin(carried(chain, tilted, angles))) > EQUAL:
        raise ActError(
            "GX213",
            f"{asked.code}: {chain.letters[free]} is free in this plane, and no manual "
            "says whether it turns",
            "let the CAM turn X of the plane along X of the machine, or write it without a plane",
        )
    return angles


def _said_attitude(chain: Chain, tilted: Floats, standing: Floats, asked: Asked) -> Floats:
    """Return the angles (axes,) that P chooses. Raises ActError."""
    angles, free = _possible(chain, tilted, standing, asked)
    if free is not None:
        message = f"the plane leaves {chain.letters[free]} free, and where it turns is not certain"
        raise ActError("GX213", message, "let the CAM write the positions without a plane")
    way = asked.written.get("P", 0.0)
    if not way:
        stands = np.abs(angles - standing).max(axis=1) <= EQUAL
        if not stands.any():
            message = "the axes do not stand as the plane asks, and are not told to turn"
            raise ActError("GX213", message, "turn them exactly there before, or say _DIR")
        return np.asarray(angles[stands][0])
    if np.ptp(angles, axis=0).max() <= EQUAL:
        return np.asarray(angles[0])
    by = asked.reading.control.get("swivel-reference")
    if by not in chain.letters:
        message = "two attitudes give this plane, and by which axis one is chosen is not known"
        said = f'swivel-reference = "{chain.letters[0]}" in [control] of the machine file'
        hint = f"say {said}, if it is that one"
        raise ActError("GX213", message, hint)
    column = chain.letters.index(str(by))
    values = angles[:, column] * way
    chosen = values >= values.max() - APART
    apart = [*(np.ptp(angles[chosen], axis=0) > EQUAL)]
    apart[column] |= chain.axes[column].limits is None
    if any(apart):
        letter = chain.letters[apart.index(True)]
        message = f"which attitude has the lower {by} is not certain"
        hint = f"say limits in [axis.{letter}] that leave one turn of it"
        raise ActError("GX213", message, hint)
    return np.asarray(angles[chosen][0])


def _told_attitude(chain: Chain, tilted: Floats, standing: Floats, asked: Asked) -> Floats:
    """Return the angles (axes,) that the words of the block say. Raises ActError."""
    lacks = [ANGLES[letter] for letter in chain.letters if ANGLES[letter] not in asked.written]
    if lacks:
        raise ActError("GX213", f"to which angle an axis turns no {lacks[0]} says")
    return np.array([asked.written[ANGLES[letter]] for letter in chain.letters])


def _possible(
    chain: Chain, tilted: Floats, standing: Floats, asked: Asked
) -> tuple[Floats, int | None]:
    """Return the attitudes (n, axes) within limits, and the axis that is free. Raises ActError."""
    _check_ways(chain, asked)
    found = attitudes(chain, tilted[:, 2][None, :])
    state = State(int(found.state[0]))
    if state is State.UNREACHABLE:
        raise ActError("GX213", f"{asked.code}: in no attitude the tool stands on the plane")
    if state is State.POLE:
        assert found.free is not None
        found.angle[..., found.free] = standing[found.free]
    angles, allowed = turns(chain, found.angle)
    wraps = np.array([axis.limits is None for axis in chain.axes])
    nearest = angles[0] + TURN * np.round((standing - angles[0]) / TURN)
    angles = np.where(wraps, nearest, angles[0])[allowed[0]]
    if not len(angles):
        raise ActError("GX213", f"{asked.code}: no attitude is within the limits of the axes")
    return angles, found.free if state is State.POLE else None


def _nearest(angles: Floats, standing: Floats, asked: Asked) -> Floats:
    """Return the attitude (axes,) with the least way, axis by axis, then that nearest to 0."""
    ways = np.abs(angles - standing)
    from_zero = np.abs(angles - TURN * np.round(angles / TURN))
    left = np.arange(len(angles))
    for column in (*ways.T, *from_zero.T):
        beyond = column[left] - column[left].min()
        if ((beyond > EQUAL) & (beyond < APART)).any():
            break
        left = left[beyond <= EQUAL]
    if np.ptp(angles[left], axis=0).max() > EQUAL:
        message = f"{asked.code}: two attitudes are equally near, and which is taken is not certain"
        raise ActError("GX213", message, "turn the axes near to the one that is meant before")
    return np.asarray(angles[left[0]])
