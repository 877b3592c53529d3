"""Acts on the tool: which one is in the spindle, and the length that is added for it."""

from __future__ import annotations

from math import isnan

import numpy as np

from gcxform.catalogue.remedies import tool_said
from gcxform.dialect.dialect import Dialect
from gcxform.modal.frame_state import BY_VALUE, INSTEAD, NO_TOOL, FrameState, replace
from gcxform.modal.frames.act import ActError, Asked
from gcxform.modal.state import Reading

BEFORE = "the H before the program"
LENGTH_STEP = "tool-length-alone"  # what another tool length does to Z before Z is programmed


def length_moves(dialect: type[Dialect], reading: Reading) -> bool:
    """Whether another tool length may move the axes by itself."""
    return dialect.tool_rule.length_may_move and reading.control.get(LENGTH_STEP) != "shifts"


def change_tool(state: FrameState, asked: Asked) -> FrameState:
    """M6: the tool that T has named is in the spindle."""
    return replace(state, in_spindle=in_spindle(asked.tool_word), changes=state.changes + 1)


def in_spindle(word: float) -> int:
    """Return the number of the tool that a T has named, -1 where none is known."""
    return -1 if isnan(word) else int(word)


def user_code(state: FrameState, asked: Asked) -> FrameState:
    """M100 to M199: a program of the machine's maker; where it leaves the axes is not known."""
    inert = int(asked.code[1:]) in asked.reading.inert_m
    if not inert and asked.reading.control.get("user-codes") != "keep":
        raise ActError(
            "GX214",
            f"{asked.code} runs a program of this machine, if it has one",
            'say that it has: user-codes = "keep" in [control] of the machine file; positions are '
            "then lost behind it",
        )
    return state


def tip_on(state: FrameState, asked: Asked) -> FrameState:
    """Codes of the machine file: from here on the control follows the tip of the tool."""
    return replace(state, following=True)


def tip_off(state: FrameState, asked: Asked) -> FrameState:
    """Codes of the machine file: X, Y and Z are again those of the axes."""
    return replace(state, following=False)


def set_tool(state: FrameState, asked: Asked) -> FrameState:
    """M61 Q: another number for the tool that is in the spindle."""
    if "Q" not in asked.words:
        raise ActError("GX213", f"{asked.code} needs a Q word")
    return replace(state, in_spindle=int(asked.words["Q"]), changes=state.changes + 1)


def length(state: FrameState, asked: Asked) -> FrameState:
    """G43 H: the length of a tool of the table."""
    return _with_length(state, asked, 1.0)


def length_negative(state: FrameState, asked: Asked) -> FrameState:
    """G44 H: the length of a tool of the table, taken off."""
    return _with_length(state, asked, -1.0)


def _with_length(state: FrameState, asked: Asked, sign: float) -> FrameState:
    """Return the state with a length in force, and the H that says which."""
    by_length = kept_by_length(asked) and "follow-tip" in asked.dialect.tip_rule.planes.values()
    if state.following and by_length and asked.code not in asked.dialect.tip_rule.planes:
        message = f"{asked.code} while the control follows the tip is not resolved"
        raise ActError("GX213", message, "draw the tool back, and write G49 before")
    if "H" in asked.words:
        state = _with_number(state, asked.words["H"])
    return replace(state, tip="").with_tool(*_tool_vector(state, asked, sign))


def tip(state: FrameState, asked: Asked) -> FrameState:
    """G43.4 H: the length of a tool, whose tip the control follows, nobody knows where."""
    count = state.tilted + 1
    state = _with_length(state, asked, 1.0)
    return replace(state, tip=f" at the tip ({count})", tilted=count)


def _with_number(state: FrameState, number: float) -> FrameState:
    """Return the state with an H in force; one that is not known has a name of its own."""
    if not np.isnan(number):
        return replace(state, number=f"H{number:g}")
    lost = state.lost_numbers + 1
    return replace(state, number=f"the tool that H names ({lost})", lost_numbers=lost)


def length_number(state: FrameState, asked: Asked) -> FrameState:
    """H by itself: another length, or another radius and the same length: a parameter decides."""
    number = asked.words["H"]
    if number % 1 > 0 or number < 0:
        raise ActError("GX213", "H is not a number of a tool")
    before = state.number.rpartition(" or ")[2]
    state = _with_number(state, number)
    state = replace(state, number=f"{state.number} or {before or BEFORE}")
    if not state.tool_name:
        return state
    sign = "-" * state.tool_name.startswith("-")
    return state.with_tool((*state.tool[:2], np.nan), sign + state.number)


def length_add(state: FrameState, asked: Asked) -> FrameState:
    """G43.2 H: the length of a tool more."""
    if "H" not in asked.words:
        raise ActError("GX213", f"{asked.code} needs an H word")
    state = _with_number(state, asked.words["H"])
    vector, name = _tool_vector(state, asked, 1.0)
    total = np.array(state.tool) + np.array(vector)
    return state.with_tool(tuple(total.tolist()), f"{state.tool_name}+{name}")


def _tool_vector(
    state: FrameState, asked: Asked, sign: float
) -> tuple[tuple[float, float, float], str]:
    """Return the vector of a tool, nan along Z where its length is not known, and its name."""
    number = _tool_number(state, asked)
    if np.isnan(number) and "H" in asked.words:
        return _unknown_tool(state, asked, state.number)
    if np.isnan(number) and asked.dialect.tool_rule.h_stays:
        return _unknown_length((state.number or BEFORE) + _table(state), sign)
    if np.isnan(number):
        return _unknown_tool(state, asked)
    if number == 0:
        return NO_TOOL, ""
    tool = asked.reading.tools.get(int(number))
    if tool is None and asked.reading.tools and asked.dialect.tool_rule.g43_takes_spindle_tool:
        raise ActError("GX213", f"the tool table has no tool {number:g}", tool_said(number))
    times = state.written.get(int(number), 0)
    if tool is None or times:
        return _unknown_length(f"H{number:g}" + f" as set by G10 ({times})" * bool(times), sign)
    x, y, z = tool.vector
    return (sign * x, sign * y, sign * z), f"H{number:g}" if sign > 0 else f"-H{number:g}"


def _tool_number(state: FrameState, asked: Asked) -> float:
    """Return the number of the tool whose length is meant, nan where no block has said which."""
    tools = asked.dialect.tool_rule
    number = asked.words.get("H", np.nan)
    if number % 1 > 0 or number < 0:
        raise ActError("GX213", "H is not a number of a tool")
    if "H" in asked.words and np.isnan(number):
        return number
    if tools.g43_takes_spindle_tool and not number > 0:
        return float(state.in_spindle) if state.in_spindle >= 1 else np.nan
    if np.isnan(number) and not tools.h_stays:
        raise ActError("GX213", f"{asked.code} needs an H word")
    if np.isnan(number) and state.number[1:].isdigit():
        return float(state.number[1:])
    return number


def _unknown_length(name: str, sign: float) -> tuple[tuple[float, float, float], str]:
    """Return the vector and the name of a tool of unknown length: taken off it is another one."""
    return (0.0, 0.0, np.nan), name if sign > 0 else f"-{name}"


def _unknown_tool(
    state: FrameState, asked: Asked, name: str = "the tool in the spindle"
) -> tuple[tuple[float, float, float], str]:
    """Return the vector and the name of the tool that H0, no H, or a number not known stands for.

    Which that is no block has said, or none is there (then `rs274` takes the length of the one
    before): its length is not known, and after every change it may be another.
    """
    aside = any(tool.vector[0] or tool.vector[1] for tool in asked.reading.tools.values())
    across = np.nan if aside else 0.0
    if state.changes:
        name += f" after tool change {state.changes}"
    return (across, across, np.nan), name + _table(state)


def _table(state: FrameState) -> str:
    """Return which state of the tool table a length is of: nothing for that before the program."""
    times = sum(state.written.values())
    return f", as set by G10 ({times})" if times else ""


def written(state: FrameState, asked: Asked) -> FrameState:
    """G10 of a tool: what it sets is added to what is not known, and when it acts is not either."""
    number = asked.words.get("P", np.nan)
    if not number >= 1 or number % 1:
        raise ActError("GX213", "P is not a number of a tool")
    return set_in_table(state, int(number))


def set_in_table(state: FrameState, number: int) -> FrameState:
    """Return the state behind a number of a tool that was set to what is not known."""
    times = {**state.written, number: state.written.get(number, 0) + 1}
    state = replace(state, written=times)
    if not state.tool_name:
        return state
    name = f"{state.tool_name}, after G10 ({sum(times.values())})"
    return state.with_tool((*state.tool[:2], np.nan), name)


def length_vector(state: FrameState, asked: Asked) -> FrameState:
    """G43.1: the vector given."""
    vector = [*state.tool]
    for axis, value in asked.axes.items():
        if axis not in asked.dialect.tool_rule.length_axes:
            raise ActError("GX213", f"{asked.code} takes no {axis} on this control")
        vector[asked.column(state, axis)] = value
    x, y, z = vector
    return state.with_tool((x, y, z), name_by_value(state.tool_name))


def name_by_value(before: str) -> str:
    """Return the name of a tool vector that the program gives, by that of the one before it."""
    return BY_VALUE if before in ("", BY_VALUE) else INSTEAD


def offset_of_tool(state: FrameState, asked: Asked) -> FrameState:
    """T by itself: the offset of a tool of the table, which may be along any axis."""
    number = asked.words["T"]
    if not number >= 0 or number % 1:
        raise ActError("GX213", "T is not a number of a tool")
    tool = asked.reading.tools.get(int(number))
    vector = (np.nan, np.nan, np.nan) if tool is None else tool.vector
    state = replace(state, in_spindle=int(number), changes=state.changes + 1)
    return state.with_tool(vector, f"T{number:g}")


def no_length(state: FrameState, asked: Asked) -> FrameState:
    """G49: no tool length, and beside it H0 says nothing more."""
    if asked.words.get("H", 0.0) != 0:
        raise ActError("GX213", f"{asked.code} takes no H but H0")
    followed = state.plane is not None and state.plane.tip
    plane = None if followed else state.plane
    following = False if state.following and kept_by_length(asked) else state.following
    return replace(state, tip="", plane=plane, following=following).with_tool(NO_TOOL, "")


def kept_by_length(asked: Asked) -> bool:
    """Whether the code of a length follows the tip, and stays; not beside M codes that do so."""
    return asked.reading.keeps_tips and "tip-on" not in asked.reading.control


def vectors(state: FrameState, asked: Asked) -> FrameState:
    """G43.5 H: the length of a tool, and the control turns the tool along I, J, K and follows."""
    return replace(length(state, asked), following=True)


def no_vectors(state: FrameState, asked: Asked) -> FrameState:
    """G49 after it: the axes stay where the control has turned them."""
    return replace(no_length(state, asked), following=False)
