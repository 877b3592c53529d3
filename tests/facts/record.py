"""Write what LinuxCNC says to the programs of this folder: `python tests/facts/record.py`.

One line of `linuxcnc.json` for each fact, in the form of the collection beside the checkout: what
is expected, motions in the active program coordinates and units with four decimals, and the message
where it is refused. Moves that LinuxCNC makes after a probe or a spline are not comparable, so no
program has one.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from facts import more_programs, programs  # noqa: E402
from oracles.canon import AXES, CALL, PLANES  # noqa: E402

RECORDED = HERE / "linuxcnc.json"
ENDINGS = ("M2", "M30", "%", "")
KEPT = {
    "START_SPINDLE_CLOCKWISE",
    "START_SPINDLE_COUNTERCLOCKWISE",
    "STOP_SPINDLE_TURNING",
    "PROGRAM_STOP",
    "OPTIONAL_PROGRAM_STOP",
    "MIST_ON",
    "FLOOD_ON",
    "FLOOD_OFF",
    "CHANGE_TOOL",
    "MESSAGE",
    "SET_G5X_OFFSET",
    "SET_G92_OFFSET",
    "USE_TOOL_LENGTH_OFFSET",
    "SET_XY_ROTATION",
    "START_SPEED_FEED_SYNC",
}


def facts() -> Iterator[dict[str, Any]]:
    """Yield name, fact and program of each, and the tools and variables it is run with."""
    for module in (programs, more_programs):
        for topic, table in vars(module).items():
            if not isinstance(table, dict) or topic.startswith("_"):
                continue
            for name, (fact, text, *extra) in table.items():
                lines = text.split("|")
                if not any(line.endswith(ENDINGS[:3]) or not line for line in lines):
                    lines.append("M2")
                given = {"var_file" if topic == "HOMES" else "tool_table": e for e in extra if e}
                program = "\n".join(line for line in lines if line) + "\n"
                yield {"name": f"{topic.lower()}_{name}", "fact": fact, "text": program, **given}


def recorded(fact: dict[str, Any]) -> dict[str, Any]:
    """Return what is stored of a fact: it, and what LinuxCNC says to its program."""
    calls, said = executed(fact["text"], fact.get("tool_table", ""), fact.get("var_file", ""))
    motions = [*motions_of(calls)]
    ends = [m["end"] for m in motions if "end" in m]
    given = {k: v for k, v in fact.items() if k in ("tool_table", "var_file")}
    result = {
        "name": fact["name"],
        "program": fact["text"],
        "dialect": "linuxcnc",
        "fact": fact["fact"],
        "status": "verified by rs274",
        "expect": "refuse" if said else "ok",
        "motions": motions,
        "end_position": ends[-1] if ends and not said else None,
        **given,
    }
    return result | ({"rs274_error": said} if said else {})


def executed(program: str, tools: str, variables: str) -> tuple[list[tuple[str, str]], list[str]]:
    """Run a program; return the calls between its start and its end, and the message if refused."""
    with tempfile.TemporaryDirectory() as folder:
        at = Path(folder)
        for name, text in (("in.ngc", program), ("tools", tools), ("var", variables)):
            (at / name).write_text(text)
        command = ["rs274", "-g", "-t", "tools", "-v", "var", "in.ngc", "out"]
        home = os.environ | {"HOME": folder}
        done = subprocess.run(command, cwd=at, env=home, capture_output=True, timeout=10)
        text = (at / "out").read_text("latin-1")
    calls = [match.groups() for match in map(CALL.match, text.splitlines()) if match]
    names = [name for name, _ in calls]
    first = names.index("ON_RESET") + 1 if "ON_RESET" in names else len(names)
    if done.returncode:
        said = [line for line in done.stderr.decode("latin-1").splitlines() if line.strip()]
        return calls[first:], [s for s in said if not s.startswith(("executing", "link ("))]
    if "PROGRAM_END" in names:
        end = names.index("PROGRAM_END")
        del calls[end - names[end::-1].index("SET_G5X_OFFSET") :]
    return calls[first:], []


def motions_of(calls: list[tuple[str, str]]) -> Iterator[dict[str, Any]]:
    """Yield canon calls as the motions of a fact."""
    plane, feed, inch = "XY", 0.0, False
    for name, text in calls:
        if name.startswith(("STRAIGHT_TRAVERSE", "STRAIGHT_FEED")):
            kind = "feed" if name.endswith("FEED") else "rapid"
            end = dict(zip(AXES, map(float, text.split(",")), strict=True))
            yield {"type": kind, "end": end} | ({"F": feed} if kind == "feed" and feed else {})
        elif name == "ARC_FEED":
            yield arc(plane, [float(number) for number in text.split(",")]) | {"F": feed}
        elif name == "SELECT_PLANE":
            plane = text[-2:]
        elif name == "SET_FEED_RATE":
            feed = float(text)
        elif name == "USE_LENGTH_UNITS" and inch != ("INCHES" in text):
            feed, inch = round(feed * 25.4 if inch else feed / 25.4, 6), not inch
        elif name == "DWELL":
            yield {"type": "dwell", "seconds": float(text)}
        elif name in KEPT:
            yield {"type": "canon", "call": name, "args": text}


def arc(plane: str, numbers: list[float]) -> dict[str, Any]:
    """Return the motion of an arc from the numbers of its call."""
    axes = PLANES[plane][1]
    first, second, centre1, centre2, rotation, normal, *rotary = numbers
    end = dict(zip(axes, (first, second, normal), strict=True))
    end |= dict(zip("ABC", rotary, strict=True))
    return {
        "type": "arc",
        "plane": plane,
        "sense": "cw" if rotation < 0 else "ccw",
        "turns": int(abs(rotation)),
        "end": {axis: end[axis] for axis in AXES},
        "center": {axes[0]: centre1, axes[1]: centre2},
    }


def main() -> None:
    """Write all facts anew, one a line."""
    lines = [json.dumps(recorded(fact)) for fact in facts()]
    RECORDED.write_text("[\n" + ",\n".join(lines) + "\n]\n")


if __name__ == "__main__":
    main()
