"""What of a contour under G41 and G42 cannot be resolved, whatever the control does at corners."""

from __future__ import annotations

import numpy as np

import gcxform as gx

STILL = 1e-9  # mm; a row that moves by less in the plane stands still there
WRITTEN = (
    "the program writes the tool table with G10: set the radius at the control, give the machine "
    "file the same, and leave the block out"
)
AGAIN = "lead the tool off the contour and cancel it with G40 before, and begin it again behind"
END = "lead the tool off the contour, and end it with G40"


def refuse_unresolved(path: gx.Toolpath, context: gx.PassContext) -> None:
    """Refuse rows under compensation that cannot be resolved."""
    on = path.side != 0
    both = on[1:] & on[:-1]
    changes = np.append(False, both & (np.diff(path.side) != 0))
    changes |= np.append(False, both & (path.radius[1:] != path.radius[:-1]))
    changes |= np.append(False, both & (path.plane[1:] != path.plane[:-1]))
    changes |= np.append(False, both & (path.frame[1:] != path.frame[:-1]))
    leaves = np.append(False, on[:-1]) & ~on
    rule = context.source.cutter_comp
    way = np.abs(path.end - path.start)[:, :3] > STILL
    in_plane = (way & (np.arange(3) != 2 - path.plane[:, None])).any(axis=1)
    tilted = np.array([[frame.tilts(normal) for normal in range(3)] for frame in path.frames])
    for wrong, code, message, hint in (
        (
            on & np.isnan(path.radius),
            "GX231",
            "the radius of the tool under cutter compensation is not known",
            _radius_said(path, context),
        ),
        (
            changes,
            "GX232",
            "side, tool, plane or work offset change under cutter compensation",
            AGAIN,
        ),
        (
            (on | leaves)
            & (path.lost | ~path.starts_known | np.isnan(path.end[:, :3]).any(axis=1)),
            "GX232",
            "a position under cutter compensation is not known",
            "program X, Y and Z before G41 or G42",
        ),
        (
            (on | leaves) & (path.form != gx.Form.PLAIN),
            "GX232",
            "a move of its own kind under cutter compensation",
            AGAIN,
        ),
        (
            (on | leaves) & tilted[path.frame, 2 - path.plane],
            "GX232",
            "cutter compensation in a plane that is turned out of the axes",
            "write the contour in coordinates that are not turned",
        ),
        (
            leaves & ~in_plane & (not (rule.corners and rule.entry)),
            "GX232",
            "the first move behind G40 is not in the plane: controls differ in whether it ends it",
            "program X or Y in the block with G40",
        ),
    ):
        if wrong.any():
            raise path.refuse(code, np.flatnonzero(wrong), message, hint)
    _refuse_open_end(path, context)


def _radius_said(path: gx.Toolpath, context: gx.PassContext) -> str:
    """Return how a radius becomes known: a machine file says it, unless G10 writes the table."""
    kinds = context.source.offset_rule.g10_tools
    tables = (event for event in path.events if event.what == "G10")
    if any(dict(event.values).get("L", np.nan) in kinds for event in tables):
        return WRITTEN
    said = "give a machine file with the tool, -m MACHINE.toml: radius = ... in [tool.*]"
    if context.source.cutter_comp.stored or any(event.what == "M6" for event in path.events):
        return said
    return f"{said}; a tool that is in the spindle from the start: tool = n in [input]"


def _refuse_open_end(path: gx.Toolpath, context: gx.PassContext) -> None:
    """Refuse compensation that nothing cancels, unless the control is known to end it so."""
    if not path.side[-1]:
        return
    ends = {f"M{number}" for number, code in context.source.m_codes.items() if code.ends}
    ended = any(event.what in ends and event.row == len(path) for event in path.events)
    rule = context.source.cutter_comp
    if not (ended and rule.corners and rule.entry):
        last = np.array([len(path) - 1])
        raise path.refuse("GX232", last, "nothing cancels cutter compensation", END)
