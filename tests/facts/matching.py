"""Whether gcxform does with a program what a fact about its control says it should.

A fact is a dictionary: `expect`, and what the program means as `motions` or as a `trace`. Values
that are given must hold, axes and keys that are not given may be anything. Motions that move
nothing may be missing on either side. What cannot be interpreted is a failure that says so.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from oracles.canon import EVENTS, CanonMove
from oracles.compare import PRINTED, SLACK, feed_difference
from oracles.toolpaths import HOMES, OFFSETS, START, moves_of, resolved
from reference.model import Move

import gcxform as gx
from gcxform.dialect.dialect import INCH
from gcxform.machine.machine import Tool
from gcxform.modal.program_end import Ending
from gcxform.modal.reader import windows_of
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.toolpath.path import Toolpath

REFUSED = {"refuse", "partial", "tool_refuse"}
ALWAYS = {"M0", "M1", "M3", "M4", "M5", "M7", "M8", "M9"}
SILENT = re.compile(
    r"SET_|USE_|MESSAGE|COMMENT|MIST_OFF|START_CHANGE|SELECT_|.*_SPEED_FEED_|.*ABLE_"
)
"""Calls that leave no motion: offsets are seen in the ends of those behind them."""
DEBUG = re.compile(r"\(debug,([^)]*)\)", re.IGNORECASE)
REFERENCE = re.compile(r"#(?:<[^>]*>|#*\d+)")
TRACED = {"RAPID": "rapid", "LINE": "feed", "FEED": "feed", "LINEAR": "feed"}
NUMBER = re.compile(r"([A-Z])(-?\d+\.\d+)")


class NotReadYet(Exception):
    """The fact is about a control that gcxform has no dialect for."""


@dataclass(frozen=True)
class Step:
    """A motion as gcxform has it, or something between motions: `what` and a value."""

    what: str
    value: float = 0.0
    move: Move | None = None
    unit: float = 1.0


def dialect_of(fact: dict[str, Any]) -> str:
    """Return our name of the control. Raises NotReadYet."""
    name = re.split(r"[-( ]", fact["dialect"])[0]
    if name not in default_registry().dialects:
        raise NotReadYet(f"{name} is not read yet")
    return name


def problem(fact: dict[str, Any], program: bytes) -> str:
    """Return what is wrong; nothing if gcxform does with the program what the fact expects."""
    name = dialect_of(fact)
    try:
        wanted = [*motions(fact)] if fact["expect"] == "ok" else []
        if any(m["type"] == "told" for m in wanted):
            program = DEBUG.sub(_as_rapid, program.decode("latin-1")).encode("latin-1")
        path = gx.read(program, name, **reading(fact), parameters=parameters(program, name)).path
        if name == "linuxcnc" and path.side.any():
            path = resolved(path)  # what the control does with a contour
        refuse_ending(program, name)
    except gx.InputError as error:
        return "" if fact["expect"] in REFUSED else f"refused: {error.diagnostics[0].render()}"
    except KeyError as error:
        return f"the fact cannot be interpreted: no {error}"
    if fact["expect"] in REFUSED:
        return "it is read, and should be refused"
    if fact["expect"] != "ok":
        return f"the fact cannot be interpreted: expect = {fact['expect']}"
    return _compared(steps(path, wanted), wanted, b"M6" in program.upper()) or _end(fact, path)


def refuse_ending(program: bytes, name: str) -> None:
    """Raise InputError for a file that does not end as its control asks for."""
    dialect = default_registry().dialect(name)
    ending = Ending(dialect)
    for window, reader in windows_of(Source.of_bytes(program), dialect):
        reader.table.update()
        ending.look(window, reader.table)
    if ending.wrong:
        raise gx.InputError(tuple(ending.wrong))


def reading(fact: dict[str, Any]) -> dict[str, Any]:
    """Return what gcxform is told beside the program: what the control was told."""
    skips = "-b" in fact.get("rs274_args", ())
    by_switch = "skip" if skips else "execute"
    told: dict[str, Any] = {"start": START, "work_offsets": OFFSETS, "homes": HOMES}
    if "block delete off" in fact.get("fact", ""):
        told["block_delete"] = "execute"
    if fact["dialect"] == "linuxcnc":
        told |= {"block_delete": by_switch, "homes": homes_of(fact), "tools": tools_of(fact)}
    return told


def parameters(program: bytes, name: str) -> dict[str, float]:
    """Return the numbered parameters a program names, all 0 as `rs274` starts with them."""
    named = re.findall(rb"#(\d+)", program) if name == "linuxcnc" else []
    return {number.decode(): 0.0 for number in named}


def homes_of(fact: dict[str, Any]) -> dict[str, dict[str, float]]:
    """Return the stored points of the variables of `rs274`, which are in inches."""
    values = {}
    for line in fact.get("var_file", "").splitlines():
        number, value = line.split()[:2]
        values[int(number)] = float(value)
    points = {"G28": 5161, "G30": 5181}
    return {
        code: {
            a: values.get(first + k, 0.0) * (INCH if k < 3 else 1) for k, a in enumerate("XYZABC")
        }
        for code, first in points.items()
    }


def tools_of(fact: dict[str, Any]) -> dict[int, Tool]:
    """Return the tools of the table of `rs274`, which is in inches; D is a diameter."""
    found = {}
    for line in fact.get("tool_table", "").splitlines():
        word = {w[0]: float(w[1:]) * INCH for w in line.split()}
        tool = Tool(
            length=word.get("Z", 0.0),
            radius=word.get("D", 0.0) / 2,
            x=word.get("X", 0.0),
            y=word.get("Y", 0.0),
        )
        found[round(word["T"] / INCH)] = tool
    return found


# --- what the fact says ---


def motions(fact: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the motions of a fact, each of them one step. Raises KeyError for an unknown one."""
    if "trace" in fact:
        return [_traced(line) for line in fact["trace"] if not line.startswith("[")]
    found: list[dict[str, Any]] = []
    for motion in fact.get("motions") or ():
        found += _steps_of(motion)
    return [
        one
        for one, after in zip(found, [*found[1:], {}], strict=False)
        if not (one.get("what") == "M5" and after.get("what") == "M6")  # M6 stops the spindle
    ]


def _steps_of(motion: dict[str, Any]) -> list[dict[str, Any]]:
    kind = motion["type"]
    if kind == "canon":
        call = motion["call"]
        numbers = re.findall(r"-?\d+\.\d{6}", motion["args"]) if call == "MESSAGE" else []
        if numbers:
            end = dict(zip("XYZABC", map(float, numbers), strict=False))
            return [{"type": "told", "end": end}]
        return [] if SILENT.match(call) else [{"type": "event", "what": EVENTS[call]}]
    if kind == "hole":
        at = {"X": motion["X"], "Y": motion["Y"]}
        levels = [("rapid", "start"), ("feed", "depth"), ("rapid", "retract")]
        down = [{"type": k, "end": at | {"Z": motion[level]}} for k, level in levels]
        return [{"type": "rapid", "end": at}, *down]
    return [
        {"rapid": motion, "feed": motion, "arc": motion, "dwell": motion, "event": motion}[kind]
    ]


def _traced(line: str) -> dict[str, Any]:
    """Return a line of a trace of GRBL: `RAPID X1.0000 Y2.0000 Z0.0000 F0.000`."""
    verb, value = line.split()[0], {k: float(v) for k, v in NUMBER.findall(line)}
    end = {axis: value[axis] for axis in "XYZ" if axis in value}
    if verb == "DWELL":
        return {"type": "dwell", "seconds": value["P"]}
    if verb not in TRACED:
        raise KeyError(verb)
    feeds = TRACED[verb] == "feed" and "INV" not in line
    return {"type": TRACED[verb], "end": end} | ({"F": value["F"]} if feeds else {})


def _as_rapid(comment: re.Match[str]) -> str:
    """Return a message of parameters as a rapid to their values, which a path can show."""
    names = zip("XYZABC", REFERENCE.findall(comment[1]), strict=False)
    return "G0 " + " ".join(axis + name for axis, name in names)


# --- what gcxform says ---


def steps(path: Toolpath, wanted: list[dict[str, Any]]) -> list[Step]:
    """Return moves and events in order; events that nobody asks for are left out."""
    asked = ALWAYS | {m["what"] for m in wanted if m["type"] == "event"}
    found: list[tuple[int, int, Step]] = []
    for event in path.events:
        value = event.values[0][1] if event.values else 0.0
        if event.what in asked | {"DWELL"}:
            found.append((event.row, 0, Step(event.what, value)))
    inch = path.blocks.inch
    for row, (block, move) in enumerate(zip(path.block.tolist(), moves_of(path), strict=True)):
        found.append((row, 1, Step("move", 0.0, move, 25.4 if inch[block] else 1.0)))
    return [step for _, _, step in sorted(found, key=lambda one: one[:2])]


# --- side by side ---


def _compared(ours: list[Step], wanted: list[dict[str, Any]], changes_tool: bool) -> str:
    """Walk both; what moves nothing may be skipped."""
    at: dict[str, float] = dict.fromkeys("XYZABC", 0.0)
    left = list(ours)
    for motion in wanted:
        while left and _differs(left[0], motion) and _still(left[0]):
            del left[0]
        difference = _differs(left[0], motion) if left else "nothing is left"
        if not difference:
            del left[0]
        elif not _moves_nothing(motion, at, changes_tool):
            return f"{difference}\n  wanted {motion}\n  read {left[0] if left else 'nothing'}"
        at |= motion.get("end", {})
    late = [step for step in left if not _still(step)]
    return f"too much: {late[0]}" if late and wanted else ""


def _still(step: Step) -> bool:
    move = step.move
    if move is None or move.centre is not None:
        return False
    return all(abs(v - move.start.get(a, 1e9)) < 1e-6 for a, v in move.end.items())


def _moves_nothing(motion: dict[str, Any], at: dict[str, float], changes_tool: bool) -> bool:
    if motion["type"] == "event":
        return changes_tool and motion["what"] == "M5"
    if motion["type"] == "dwell":
        return not motion["seconds"]
    end = motion["end"].items()
    return motion["type"] != "arc" and all(abs(v - at[axis]) < 1e-6 for axis, v in end)


def _differs(step: Step, motion: dict[str, Any]) -> str:
    kind = motion["type"]
    if kind == "event":
        return "" if step.what == motion["what"] else "event"
    if kind == "dwell":
        same = step.what == "DWELL" and abs(step.value - motion["seconds"]) < 1e-4
        return "" if same else "dwell"
    if step.move is None:
        return "no motion"
    kinds = {"rapid": "RAPID", "told": "RAPID", "feed": "LINE"}
    wanted = f"ARC_{motion['sense'].upper()}" if kind == "arc" else kinds[kind]
    if step.move.kind != wanted:
        return "kind"
    near = SLACK + PRINTED * step.unit
    for axis, value in motion["end"].items():
        unit = 1.0 if axis in "ABC" else step.unit
        if abs(step.move.end.get(axis, 0.0) - value * unit) > near:
            return f"end {axis}"
    return _arc_differs(step, motion, near) or _feed_differs(step, motion)


def _arc_differs(step: Step, motion: dict[str, Any], near: float) -> str:
    move = step.move
    if move is None or move.centre is None:
        return ""
    if "plane" in motion and set(motion["plane"]) != set(move.plane):
        return "plane"
    if "turns" in motion and motion["turns"] != move.turns + 1:
        return "turns"
    for axis in set(motion.get("center", {})) & set(move.plane):
        if abs(move.centre["XYZ".index(axis)] - motion["center"][axis] * step.unit) > near:
            return f"centre {axis}"
    return ""


def _feed_differs(step: Step, motion: dict[str, Any]) -> str:
    """Compare feeds; LinuxCNC has made those of G93 rates."""
    move = step.move
    if move is None or "F" not in motion:
        return ""
    value = motion["F"]
    feeds = (value * step.unit, value)
    theirs = CanonMove(move.kind, move.start, move.end, 0, step.unit, feeds, move.feed_mode)
    return feed_difference(move, theirs)  # type: ignore[no-any-return]


def _end(fact: dict[str, Any], path: Toolpath) -> str:
    """Compare where the program leaves the tool."""
    told = any(m.get("call") == "MESSAGE" for m in fact.get("motions") or ())
    if not fact.get("end_position") or told:
        return ""
    moves = [*moves_of(path)]
    at = moves[-1].end if moves else {}
    inch = bool(len(path) and path.blocks.inch[int(path.block[-1])])
    unit = 25.4 if inch else 1.0
    for axis, value in fact["end_position"].items():
        scale = 1.0 if axis in "ABC" else unit
        if abs(at.get(axis, 0.0) - value * scale) > SLACK + PRINTED * unit:
            return f"it ends at {axis} {at.get(axis)}, and should at {value}"
    return ""
