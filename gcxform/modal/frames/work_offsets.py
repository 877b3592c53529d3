"""Acts on where zero is: work offsets, G10, G52, G92, stored reference points."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from gcxform.dialect.machine_parameters import among
from gcxform.modal.frame_state import FrameState, replace, rotation
from gcxform.modal.frames.act import ActError, Asked
from gcxform.modal.frames.tool_lengths import set_in_table, written
from gcxform.toolpath.frames import Vector


def moved_to_names(state: FrameState, asked: Asked, values: Vector) -> Vector:
    """Return a vector with the numbers of the named axes in the place of its own."""
    changed = list(values)
    for axis, value in asked.axes.items():
        changed[asked.column(state, axis)] = value
    return tuple(changed)


def _article(address: str) -> str:
    return "an" if address in "AEFHILMNORSX" else "a"


# --- work offsets ---


def behind_call(state: FrameState, asked: Asked) -> FrameState:
    """Lose work offsets and tool length behind a call of what is not there: it may have set them.

    Nothing is lost where the machine file says that all is as it was, nor behind a code by which
    the control itself cuts.
    """
    code = asked.dialect.codes.get(asked.code)
    if asked.ends not in ("", "unknown") or (code is not None and code.reason):
        return state
    unknown = (np.nan,) * len(state.axes)
    tool = (*state.tool[:2], np.nan) if state.tool_name else state.tool
    state = state.with_tool((tool[0], tool[1], tool[2]), state.tool_name)
    return replace(state.shifted(), machine=unknown)


def table(state: FrameState, asked: Asked) -> FrameState:
    """`#5221 = 5`: a number of the control's tables of tools and of zeros.

    When it acts no manual says that is at hand: at once, or with the next code that names it.
    """
    arithmetic, key = asked.dialect.flow_rule.arithmetic, int(asked.code[1:])
    if asked.reading.crosses or not asked.reading.tables_stay:
        message = f"{asked.code} is a number of a table of the control, which is not followed"
        hint = "say in the machine file what the table has, and leave this block out"
        raise ActError("GX213", message, hint)
    assert arithmetic is not None
    if among(key, arithmetic.machine.lengths):
        return set_in_table(state, arithmetic.machine.tool_of(key))
    return replace(state.shifted(), unsettled=True)


def work(state: FrameState, asked: Asked) -> FrameState:
    """G54 and its like: another work offset; a code that takes words names one by each of them.

    Before anything moves positions count from it, if no zero has been set anew, and the control
    began in no other that is known, or in one that lies nobody knows where beside it. Of two
    controls one may know that it begins in G54, and not the other: they count from G54 where files
    say both.
    """
    if state.unsettled:
        state = replace(state.shifted(), unsettled=False)
    name = asked.dialect.offset_rule.names.get(asked.code, asked.code)
    for address in asked.numbers:
        number = asked.words.get(address)
        if number is None:
            raise ActError("GX213", f"{name} needs {_article(address)} {address} word")
        if number < 1 or number % 1:
            raise ActError("GX213", f"{name} needs a whole number in {address}")
        name = f"{name} {address}{number:.0f}"
    places = asked.reading.work_offsets
    apart = name in places and bool(np.isnan(state.zero_of(name)).any())
    unmoved = not state.given and bool(np.isnan(asked.position).all())
    starts = unmoved and (apart or not state.known)
    if starts and not (asked.reading.crosses and {name, state.first} <= places.keys()):
        return state.starting_in(name, places, True)
    return state.in_work(name)


def set_work(state: FrameState, asked: Asked) -> FrameState:
    """G10: work offsets (L2, L20) and tools (L1, L10 to L13)."""
    kind = asked.words.get("L", np.nan)
    if kind in asked.dialect.offset_rule.g10_tools:
        return _set_tool(state, asked, int(kind))
    if kind not in (2, 20):
        raise ActError("GX213", "this G10 writes something into the control that is not followed")
    rule = asked.dialect.offset_rule
    turns = kind == 2 and rule.g10_rotates
    for address in asked.written:
        if address not in asked.axes and address not in ("LPR" if turns else "LP"):
            raise ActError("GX213", f"{address} has no meaning in G10 L{kind:g}")
    _refuse_unknown(asked)
    some = np.isnan(asked.words.get("P", 0.0))  # only the machine knows which
    if some or (kind == 2 and rule.g10_p0 == "all" and asked.words.get("P") == 0):
        return state.shifted()
    name = _named_work(asked, state)
    if kind == 20 and rule.g10_l20 == "here":
        return _set_zero_here(state, asked, name)
    return _set_zero(state, asked, name)


def _refuse_unknown(asked: Asked) -> None:
    """Refuse a value that only the machine knows where the block cannot stay as it stands.

    Elsewhere the zero is not known behind it.
    """
    lost = [address for address, value in asked.words.items() if np.isnan(value)]
    if lost and (asked.reading.crosses or not asked.reading.tables_stay or "R" in lost):
        message = f"{lost[0]} of this G10 has a value that only the machine knows"
        raise ActError("GX220", message, "set it to a number in the program before")


def _named_work(asked: Asked, state: FrameState) -> str:
    """Return the work offset that P names."""
    rule = asked.dialect.offset_rule
    number = asked.words.get("P", np.nan if rule.g10_needs_p else 0.0)
    if asked.words["L"] == 20 and not rule.g10_l20:
        raise ActError("GX213", "this control has no G10 L20")
    if asked.words["L"] == 20 and rule.g10_l20 != "here":
        if number % 1 or not number >= 1:
            raise ActError("GX213", "P names no work offset", f"P1 is {rule.g10_l20} P1")
        return f"{rule.g10_l20} P{number:g}"
    if number == 0 and rule.g10_p0 == "active":
        return state.work
    names = rule.g10_offsets
    if not (number % 1 == 0 and 1 <= number <= len(names)):
        raise ActError("GX213", "P names no work offset", "P1 is G54")
    return names[int(number) - 1]


def _set_zero(state: FrameState, asked: Asked, name: str) -> FrameState:
    """G10 L2: the zero of a work offset in machine coordinates."""
    if asked.incremental and not asked.dialect.offset_rule.g10_ignores_g91:
        raise ActError("GX213", "under G91, G10 adds on some controls and does not on others")
    turned = "R" in asked.written or state.rotation.get(name, 0.0)
    shifted = any(state.preset[:2]) or not state.adrift.keys().isdisjoint({0, 1})
    if turned and name == state.work and shifted:
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
        if np.isnan(here[k]) and asked.reading.crosses:
            _refuse_tied(state, asked, axis)
        local[k] = inner[k] + value
    if turned:
        local[:2] = about @ local[:2]
    named = [asked.column(state, axis) for axis in asked.axes] + [0, 1] * bool(turned)
    zero[named] = (here - local)[named]
    if not state.adrift.keys().isdisjoint(named):
        zero[named] = np.nan
    return state.with_zero(name, tuple(zero.tolist()))


def _set_tool(state: FrameState, asked: Asked, kind: int) -> FrameState:
    """G10 of a tool: the block stays as it is, and what it has written is not known."""
    rule = asked.dialect.offset_rule
    if not asked.reading.tables_stay:
        raise ActError(
            "GX213",
            f"G10 L{kind} writes the tool table of the control",
            "set the table at the control, give the tool the same in the machine file, and leave "
            "this block out",
        )
    if asked.incremental and not rule.g10_ignores_g91:
        message = f"under G91, G10 L{kind} adds to what the table has"
        raise ActError("GX213", message, "write it in G90 with the sum, and G91 again behind it")
    if "R" in asked.written and rule.g10_rotates:
        raise ActError("GX213", f"R in G10 L{kind} is a radius, and an angle in G10 L2")
    if across := sorted(set(asked.axes) - {"Z"}):
        message = f"G10 L{kind} gives the tool a length along {across[0]}, which is not followed"
        raise ActError("GX213", message, "give the tool its length in the machine file")
    return written(state, asked)


# --- G52 and G92 ---


def local(state: FrameState, asked: Asked) -> FrameState:
    """G52: a shift of all work offsets; on some controls the one that G92 sets."""
    _refuse_turned(state, asked)
    if not asked.axes:
        raise ActError("GX213", f"{asked.code} names no axis")
    if asked.dialect.offset_rule.g52_is_g92:
        named = {asked.column(state, axis) for axis in asked.axes}
        adrift = {k: nth for k, nth in state.adrift.items() if k not in named}
        return _with_preset(state, moved_to_names(state, asked, state.preset), adrift)
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
    shift, adrift, presets = np.array(state.preset), dict(state.adrift), state.presets
    for axis, value in asked.axes.items():
        k = asked.column(state, axis)
        shift[k] += here[k] - value
        if np.isnan(shift[k]):
            _refuse_tied(state, asked, axis)
            shift[k], presets, adrift[k] = 0.0, presets + 1, presets + 1
    return replace(_with_preset(state, tuple(shift.tolist()), adrift), presets=presets)


def _refuse_tied(state: FrameState, asked: Asked, axis: str) -> None:
    """Refuse to count from an axis that is nowhere known where more than a zero hangs on that.

    Where a code has moved it, it stands elsewhere on another control; where it stood before the
    first block it still stands.
    """
    turned = state.rotation.get(state.work, 0.0) and axis in "XY"
    moved = asked.reading.crosses and asked.lost >> asked.column(state, axis) & 1
    if turned or moved or state.following:
        raise ActError(
            "GX213",
            f"{asked.code} counts {axis} from where it stands, and that is not known",
            f"program {axis} before",
        )


def _with_preset(state: FrameState, shift: Vector, adrift: Mapping[int, int]) -> FrameState:
    """Return the state with another shift of G92, which is also what G92.3 restores."""
    return replace(state, preset=shift, held=shift, adrift=adrift, held_adrift=adrift)


def _refuse_turned(state: FrameState, asked: Asked) -> None:
    if asked.incremental and not asked.dialect.offset_rule.g10_ignores_g91:
        message = f"under G91, {asked.code} adds on some controls and does not on others"
        raise ActError("GX213", message, "write it under G90, with the numbers that are meant")
    if state.turns or state.polar:
        raise ActError("GX213", f"{asked.code} in turned or scaled coordinates")


def _refuse_unset(asked: Asked) -> None:
    """Refuse G52 and G92 where a setting decides what they shift, but for the one that is known."""
    if asked.dialect.offset_rule.g52_known or asked.reading.control.get("g52") == "fanuc":
        return
    raise ActError(
        "GX214",
        f"what {asked.code} does depends on a setting of the control",
        'say that it is as on a Fanuc: g52 = "fanuc" in [control] of the machine file; see the '
        "dialect's page",
    )


def preset_clear(state: FrameState, asked: Asked) -> FrameState:
    """G92.1: no shift."""
    return _with_preset(state, (0.0,) * len(state.axes), {})


def preset_suspend(state: FrameState, asked: Asked) -> FrameState:
    """G92.2: no shift, but what it was is kept."""
    return replace(state, preset=(0.0,) * len(state.axes), adrift={})


def preset_restore(state: FrameState, asked: Asked) -> FrameState:
    """G92.3: the shift that was kept."""
    return replace(state, preset=state.held, adrift=state.held_adrift)


# --- reference points ---


def store_home(state: FrameState, asked: Asked) -> FrameState:
    """G28.1, G30.1: where the axes stand is the reference point from now on."""
    name = asked.code.split(".")[0]
    known = [origin == state.first for origin in state.frame().origin]  # where others are nobody is
    where = np.where(known, np.asarray(asked.position) - np.array(state.machine), np.nan)
    place = {a: float(w) for a, w in zip(state.axes, where, strict=True) if np.isfinite(w)}
    return replace(state, homes={**state.homes, name: place})
