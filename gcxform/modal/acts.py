"""What single codes do to the frame: G54, G10, G52, G92, G43, G68 and their like.

Each act is a function from the state before it to the state after it. What a control leaves open,
or what is known of it from hearsay only, is refused by name.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect import LINEAR, Dialect
from gcxform.modal.frames import NO_TOOL, FrameState, Turn, rotation
from gcxform.modal.state import Reading
from gcxform.toolpath.frames import Vector
from gcxform.toolpath.path import Plane

Floats = NDArray[np.float64]


class ActError(Exception):
    """A block asks for what is not understood: code of the catalogue, message, hint."""

    def __init__(self, code: str, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hint = hint


@dataclass(frozen=True, slots=True)
class Asked:
    """A block that acts: its code, and all that its effect depends on.

    words     numbers of the words it takes, lengths in mm, by address
    written   the same numbers as they stand in the block
    axes      the axes it names, with their words in mm or degrees, X as a radius
    position  (axes,) where the axes stand before the block
    """

    code: str
    words: Mapping[str, float]
    written: Mapping[str, float]
    axes: Mapping[str, float]
    position: Floats
    incremental: bool
    plane: Plane
    tool_word: float
    dialect: type[Dialect]
    reading: Reading

    def column(self, state: FrameState, axis: str) -> int:
        """Return the index of an axis."""
        return state.axes.index(axis)


Act = Callable[[FrameState, Asked], FrameState]


def moved_to_names(state: FrameState, asked: Asked, values: Vector) -> Vector:
    """Return a vector with the numbers of the named axes in the place of its own."""
    changed = list(values)
    for axis, value in asked.axes.items():
        changed[asked.column(state, axis)] = value
    return tuple(changed)


# --- work offsets ---


def work(state: FrameState, asked: Asked) -> FrameState:
    """G54 and its like: another work offset."""
    name = asked.dialect.work_names.get(asked.code, asked.code)
    if "P" in asked.words:
        number = asked.words["P"]
        if number < 1 or number % 1:
            raise ActError("GX213", f"{name} needs a whole number in P")
        name = f"{name} P{number:g}"
    elif name in ("G54.1", "G154"):
        raise ActError("GX213", f"{name} needs a P word")
    unmoved = bool(np.isnan(asked.position).all())
    if not state.known and unmoved and name not in asked.reading.work_offsets:
        return state.starting_in(name, asked.reading.work_offsets, True)
    return state.in_work(name)


def set_work(state: FrameState, asked: Asked) -> FrameState:
    """G10: work offsets (L2, L20) and tools (L1, L10, L11)."""
    kind = asked.words.get("L", np.nan)
    if kind in (1, 10, 11):
        return _set_tool(state, asked, int(kind))
    if kind not in (2, 20):
        raise ActError("GX213", "this G10 writes something into the control that is not followed")
    turns = kind == 2 and asked.dialect.g10_rotates
    for address in asked.written:
        if address not in asked.axes and address not in ("LPR" if turns else "LP"):
            raise ActError("GX213", f"{address} has no meaning in G10 L{kind:g}")
    name = _named_work(state, asked)
    if kind == 2:
        return _set_zero(state, asked, name)
    return _set_zero_here(state, asked, name)


def _named_work(state: FrameState, asked: Asked) -> str:
    number = asked.words.get("P", np.nan if asked.dialect.g10_needs_p else 0.0)
    if asked.words.get("L") == 20 and not asked.dialect.g10_sets_position:
        raise ActError("GX213", "G10 L20 sets other offsets on this control")
    if number == 0 and asked.dialect.g10_p0_is_active:
        return state.work
    names = [*asked.dialect.g10_offsets]
    if not (number % 1 == 0 and 1 <= number <= len(names)):
        raise ActError("GX213", "P names no work offset", "P1 is G54")
    return names[int(number) - 1]


def _set_zero(state: FrameState, asked: Asked, name: str) -> FrameState:
    """G10 L2: the zero of a work offset in machine coordinates."""
    if asked.incremental and not asked.dialect.g10_ignores_g91:
        raise ActError("GX213", "under G91, G10 adds on some controls and does not on others")
    turned = "R" in asked.written or state.rotation.get(name, 0.0)
    if turned and name == state.work and any(state.preset[:2]):
        raise ActError("GX213", "G10 L2 turns the work offset in force, under G52 or G92")
    zero = list(state.zero_of(name))
    for axis, value in asked.axes.items():
        k = asked.column(state, axis)
        zero[k] = state.machine[k] + value
    state = state.with_zero(name, tuple(zero))
    if "R" in asked.written:
        state = replace(state, rotation={**state.rotation, name: asked.written["R"]})
    return state


def _set_zero_here(state: FrameState, asked: Asked, name: str) -> FrameState:
    """G10 L20: the zero is where the axes come to stand at the numbers given.

    Where the work offset is rotated, X and Y that are not named keep the numbers they have there.
    """
    inner = np.array(state.preset) + np.array(state.local)
    zero = np.array(state.zero_of(name))
    here = np.array(asked.position)
    here[:3] -= state.tool
    about = np.array(rotation(state.rotation.get(name, 0.0), 0, 1))[:2, :2]
    turned = about[0, 0] != 1.0 and not {"X", "Y"}.isdisjoint(asked.axes)
    local = here - zero
    if turned:
        local[:2] = about.T @ local[:2]
    for axis, value in asked.axes.items():
        k = asked.column(state, axis)
        local[k] = inner[k] + value
    if turned:
        local[:2] = about @ local[:2]
    named = [asked.column(state, axis) for axis in asked.axes] + [0, 1] * bool(turned)
    zero[named] = (here - local)[named]
    return state.with_zero(name, tuple(zero.tolist()))


def _set_tool(state: FrameState, asked: Asked, kind: int) -> FrameState:
    """G10 L1: a tool in the table; what is in use changes only with the next G43."""
    if kind != 1:
        raise ActError("GX213", f"G10 L{kind} sets a tool length from where the axes stand")
    raise ActError(
        "GX213",
        "G10 L1 writes the tool table of the control",
        "give the tool its length in the machine file, and leave this block out",
    )


# --- G52 and G92 ---


def local(state: FrameState, asked: Asked) -> FrameState:
    """G52: a shift of all work offsets; on some controls the one that G92 sets."""
    _refuse_turned(state, asked)
    if not asked.axes:
        raise ActError("GX213", f"{asked.code} names no axis")
    if asked.dialect.g52_is_g92:
        return _with_preset(state, moved_to_names(state, asked, state.preset))
    _refuse_unset(asked)
    return replace(state, local=moved_to_names(state, asked, state.local))


def preset(state: FrameState, asked: Asked) -> FrameState:
    """G92: the numbers given are where the axes stand now."""
    _refuse_turned(state, asked)
    if not asked.axes:
        raise ActError("GX213", f"{asked.code} names no axis")
    _refuse_unset(asked)
    if any(state.local[asked.column(state, axis)] for axis in asked.axes):
        message = f"{asked.code} under a shift of G52: whether that shift stays is not certain"
        raise ActError("GX213", message, "write G52 with zeros before it")
    here = state.frame().local(np.asarray(asked.position)[None, :])[0]
    shift = np.array(state.preset)
    for axis, value in asked.axes.items():
        k = asked.column(state, axis)
        shift[k] += here[k] - value
        if np.isnan(shift[k]):
            raise ActError(
                "GX213",
                f"{asked.code} counts {axis} from where it stands, and that is not known",
                f"program {axis} before, or say start = {{ {axis} = ... }} in [input]",
            )
    return _with_preset(state, tuple(shift.tolist()))


def _with_preset(state: FrameState, shift: Vector) -> FrameState:
    """Return the state with another shift of G92, which is also what G92.3 restores."""
    return replace(state, preset=shift, held=shift)


def _refuse_turned(state: FrameState, asked: Asked) -> None:
    if asked.incremental and not asked.dialect.g10_ignores_g91:
        message = f"under G91, {asked.code} adds on some controls and does not on others"
        raise ActError("GX213", message, "write it under G90")
    if state.turns or state.polar:
        raise ActError("GX213", f"{asked.code} in turned or scaled coordinates")


def _refuse_unset(asked: Asked) -> None:
    """Refuse G52 and G92 where a setting decides what they shift, but for the one that is known."""
    if asked.dialect.g52_known or asked.reading.control.get("g52") == "fanuc":
        return
    raise ActError(
        "GX214",
        f"what {asked.code} does depends on a setting of the control",
        'say that it is as on a Fanuc: [control] g52 = "fanuc" in the machine file; see the '
        "dialect's page",
    )


def preset_clear(state: FrameState, asked: Asked) -> FrameState:
    """G92.1: no shift."""
    none = (0.0,) * len(state.axes)
    return replace(state, preset=none, held=none)


def preset_suspend(state: FrameState, asked: Asked) -> FrameState:
    """G92.2: no shift, but what it was is kept."""
    return replace(state, preset=(0.0,) * len(state.axes))


def preset_restore(state: FrameState, asked: Asked) -> FrameState:
    """G92.3: the shift that was kept."""
    return replace(state, preset=state.held)


# --- tools ---


def change_tool(state: FrameState, asked: Asked) -> FrameState:
    """M6: the tool that T has named is in the spindle."""
    return replace(state, in_spindle=int(asked.tool_word))


def user_code(state: FrameState, asked: Asked) -> FrameState:
    """M100 to M199: a program of the machine's maker; where it leaves the axes is not known."""
    inert = int(asked.code[1:]) in asked.reading.inert_m
    if not inert and asked.reading.control.get("user-codes") != "keep":
        raise ActError(
            "GX214",
            f"{asked.code} runs a program of this machine, if it has one",
            'say that it has: [control] user-codes = "keep" in the machine file; positions are '
            "then lost behind it",
        )
    return state


def set_tool(state: FrameState, asked: Asked) -> FrameState:
    """M61 Q: another number for the tool that is in the spindle."""
    if "Q" not in asked.words:
        raise ActError("GX213", f"{asked.code} needs a Q word")
    return replace(state, in_spindle=int(asked.words["Q"]))


def length(state: FrameState, asked: Asked) -> FrameState:
    """G43 H: the length of a tool of the table."""
    return state.with_tool(*_tool_vector(state, asked, 1.0))


def length_negative(state: FrameState, asked: Asked) -> FrameState:
    """G44 H: the length of a tool of the table, taken off."""
    return state.with_tool(*_tool_vector(state, asked, -1.0))


def length_add(state: FrameState, asked: Asked) -> FrameState:
    """G43.2 H: the length of a tool more."""
    if "H" not in asked.words:
        raise ActError("GX213", f"{asked.code} needs an H word")
    vector, name = _tool_vector(state, asked, 1.0)
    total = np.array(state.tool) + np.array(vector)
    return state.with_tool(tuple(total.tolist()), f"{state.tool_name}+{name}")


def _tool_vector(
    state: FrameState, asked: Asked, sign: float
) -> tuple[tuple[float, float, float], str]:
    """Return the vector of a tool, nan along Z where its length is not known, and its name."""
    number = asked.words.get("H", np.nan)
    if asked.dialect.g43_takes_spindle_tool:
        number = number if number > 0 else float(_tool_in_spindle(state, asked))
    elif np.isnan(number):
        raise ActError("GX213", f"{asked.code} needs an H word")
    if number % 1 or number < 0:
        raise ActError("GX213", "H is not a number of a tool")
    if number == 0:
        return NO_TOOL, ""
    tool = asked.reading.tools.get(int(number))
    if tool is None:
        if asked.reading.tools and asked.dialect.g43_takes_spindle_tool:
            raise ActError("GX213", f"the tool table has no tool {number:g}")
        return (0.0, 0.0, np.nan), f"H{number:g}"
    x, y, z = tool.vector
    return (sign * x, sign * y, sign * z), f"H{number:g}"


def _tool_in_spindle(state: FrameState, asked: Asked) -> int:
    """Return the tool that H0, or no H, stands for."""
    if asked.words.get("H", 0.0) < 0:
        raise ActError("GX213", "H is not a number of a tool")
    if state.in_spindle < 1:
        message = f"{asked.code} takes the tool in the spindle, and which that is is not known"
        raise ActError("GX213", message, "write H, or the tool change before")
    return state.in_spindle


def length_vector(state: FrameState, asked: Asked) -> FrameState:
    """G43.1: the vector given."""
    vector = np.array(state.tool)
    for axis, value in asked.axes.items():
        if axis not in asked.dialect.length_axes:
            raise ActError("GX213", f"{asked.code} takes no {axis} on this control")
        vector[asked.column(state, axis)] = value
    return state.with_tool(tuple(vector.tolist()), "G43.1")


def no_length(state: FrameState, asked: Asked) -> FrameState:
    """G49: no tool length."""
    return state.with_tool(NO_TOOL, "")


# --- turns ---


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
    if asked.dialect.mirrors_at_zero and any(asked.axes.values()):
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
        return replace(state, turns=tuple(turn for turn in state.turns if turn[0] != name))

    return ended


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


def store_home(state: FrameState, asked: Asked) -> FrameState:
    """G28.1, G30.1: where the axes stand is the reference point from now on."""
    name = asked.code.split(".")[0]
    where = np.asarray(asked.position) - np.array(state.machine)
    place = {a: float(w) for a, w in zip(state.axes, where, strict=True) if np.isfinite(w)}
    return replace(state, homes={**state.homes, name: place})


ACTS: Mapping[str, Act] = {
    "change-tool": change_tool,
    "set-tool": set_tool,
    "user-code": user_code,
    "length": length,
    "length-negative": length_negative,
    "length-vector": length_vector,
    "length-add": length_add,
    "no-length": no_length,
    "work": work,
    "diameter": diameter,
    "polar": polar,
    "no-polar": no_polar,
    "rotate": rotate,
    "no-rotate": no_turn("rotate"),
    "scale": scale,
    "no-scale": no_turn("scale"),
    "mirror": mirror,
    "no-mirror": no_turn("mirror"),
    "set-work": set_work,
    "local": local,
    "preset": preset,
    "preset-clear": preset_clear,
    "preset-suspend": preset_suspend,
    "preset-restore": preset_restore,
    "store-home": store_home,
}


def is_length(address: str) -> bool:
    """Whether a word of an act is a length."""
    return address in LINEAR
