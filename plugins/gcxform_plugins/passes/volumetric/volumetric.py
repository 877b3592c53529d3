"""`volumetric`: commands that make a machine with known errors go where the program says.

The error E is a function of the machine position. A command c takes the tool to c + E(c), so for a
target p the command solves c + E(c) = p. Between two commands the control goes straight; the error
bends at the nodes of its table, so a line is cut where its command crosses a node, and nowhere else
unless asked: then the machine is on the line, exactly. With a tolerance, only those cuts stay that
the tolerance needs. An arc stays an arc where one fitted to the compensated points holds the
tolerance, and is cut where it does not.

With `inverse` the program holds commands, and what is written is where the machine goes with them:
c + E(c), cut where the error bends. The undo is then the search for the command.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats
from gcxform_plugins.passes.volumetric.bored import Bored
from gcxform_plugins.passes.volumetric.followed import Followed
from gcxform_plugins.passes.volumetric.forward.compensation import Compensation
from gcxform_plugins.passes.volumetric.forward.followed import FollowedCompensation
from gcxform_plugins.passes.volumetric.forward.window import Window, left_to_machine
from gcxform_plugins.passes.volumetric.levers import UNKNOWN, check_known, lever_of
from gcxform_plugins.passes.volumetric.options import VolumetricOptions
from gcxform_plugins.passes.volumetric.place import Place
from gcxform_plugins.passes.volumetric.ranges import beyond, leaves
from gcxform_plugins.passes.volumetric.undo.commands import Commands
from gcxform_plugins.passes.volumetric.undo.followed import FollowedMachine
from gcxform_plugins.passes.volumetric.undo.machine import Machine
from gcxform_plugins.passes.volumetric.ways import aside_of, ways_of

FOLLOWED = "moves of a tip that the control follows, axes turned"


@dataclass(frozen=True)
class Volumetric(VolumetricOptions, gx.Pass):
    """Compensate the volumetric errors of a machine.

    Positions in the table are program + part-origin - table-origin; with a machine file the work
    offset in force takes the place of part-origin.
    """

    name = "volumetric"
    requires = frozenset({gx.NOMINAL, gx.AXIS_POSITIONS})
    ensures = frozenset({gx.COMPENSATED})
    clears = frozenset({gx.NOMINAL})

    def __post_init__(self) -> None:
        """Take the model at its time and between its directions; turn facts round for the inverse.

        Raises ValueError for what the inverse cannot do.
        """
        if self.time is not None:
            object.__setattr__(self, "model", self.model.at_time(self.time))
        if self.backlash == "mean" and self.model.model.backlash.any():
            mean = gx.Mean(self.model.model)
            object.__setattr__(self, "model", replace(self.model, model=mean))
        if self.inverse and self.outside is gx.Outside.ZERO:
            raise ValueError("inverse does not go with outside = zero, where the error jumps")
        if self.inverse and self.iterations:
            raise ValueError("inverse writes where the machine goes, which takes no iterations")
        if self.inverse:
            asked = self.ensures | {gx.AXIS_POSITIONS}
            nominal = frozenset({gx.NOMINAL})
            turned = {"requires": asked, "ensures": nominal, "clears": self.ensures}
            for name, facts in turned.items():
                object.__setattr__(self, name, facts)

    def begin(self, context: gx.PassContext) -> None:
        """Refuse a model that cannot be inverted, and a run without origin."""
        gx.check_contraction(self.model.model)
        self._check_extrapolation()
        if self.model.model.backlash.any():
            axes = " ".join(a for a, b in zip("XYZ", self.model.model.backlash, strict=True) if b)
            message = f"volumetric does not compensate backlash, and the model has some on {axes}"
            hint = 'backlash = "mean" compensates what both directions have in common'
            raise gx.UsageError.one("GX484", message, hint=hint)
        if self.part_origin is None and context.machine is None:
            raise gx.UsageError.one(
                "GX721",
                "volumetric needs to know where the program's origin is in the machine",
                hint="give part-origin = [x, y, z], or a machine file with work offsets",
            )

    def _check_extrapolation(self) -> None:
        """Refuse to go farther beyond a table than its bounds of the error hold."""
        extrapolated = self.outside is gx.Outside.EXTRAPOLATE and self.max_extrapolation > 1.0
        if extrapolated and self.model.model.curvature(1.0).any():
            raise gx.UsageError.one(
                "GX713",
                f"max-extrapolation = {self.max_extrapolation:g}, and the error is curved: how "
                "steep it is farther than 1 cell beyond the table has no bound",
                hint='leave max-extrapolation out, or outside = "clamp"',
            )

    # --- forward and back ---

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the commands for a path; for the inverse, where the machine goes with it."""
        if not len(path):
            return path
        followed, place = Followed.of(path, context), self._place(path, context)
        if followed.place is None:
            return Compensation(self, path, place).run()
        self._check_place(followed)
        return FollowedCompensation(self, followed, place).run()

    def undo(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return where the machine goes: command plus error, cut where the error bends.

        For the inverse it is the commands with which the machine goes where the path says.
        """
        if not len(path):
            return path
        followed, place = Followed.of(path, context), self._place(path, context)
        if followed.place is not None:
            return FollowedMachine(self, followed, place).run()
        return (Commands if self.inverse else Machine)(self, path, place).run()

    @property
    def demands(self) -> gx.Demands:
        """Some rapids are left to the machine; tips that the control follows stay tips."""
        turns, keeps = self.tips == "turning", not self.inverse
        return gx.Demands(
            spares=self._spares,
            keeps_tip_codes=keeps,
            turns_tips=keeps and turns,
            counts=frozenset({FOLLOWED}),
        )

    def _spares(self, path: gx.Toolpath) -> Flags:
        """Return the rapids to points of the machine, to unknown places, or all if so asked."""
        return left_to_machine(path, self.rapids == "skip")

    def measure(
        self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext
    ) -> dict[str, float]:
        """Return how far the path goes beyond the tables, and how far grounds of holes are off."""
        if not len(before):
            return {}
        place, followed = self._place(before, context), Followed.of(before, context)
        before = followed.axes()
        bored = Bored.of(before)
        found = bored.figures(Window(self, before, place)) if len(bored.rows) else {}
        found |= {FOLLOWED: float(len(followed.rows))} if len(followed.rows) else {}
        if self.outside is gx.Outside.ERROR:
            return found
        rows = np.flatnonzero(~left_to_machine(before))
        return found | beyond(self, before, place.offset, rows, self._on_ways(followed, place))

    def _on_ways(self, followed: Followed, place: Place) -> Floats:
        """Return points (n, 3) in the table of lines that axes turn along, near its borders."""
        if followed.place is None:
            return np.empty((0, 3))
        which = np.flatnonzero(followed.turning)
        rows, path = followed.rows[which], followed.axes()
        start, end = (side[rows, :3] + place.offset_of(rows) for side in (path.start, path.end))
        near = leaves(self, start, end, aside_of(followed, which))
        points, rows = ways_of(followed, which[near])
        return points + place.offset_of(rows)

    def _place(self, path: gx.Toolpath, context: gx.PassContext) -> Place:
        """Return where the rows of a path are in the machine."""
        origin = np.array(self.table_origin)
        tools = np.nan_to_num(np.array([frame.tool for frame in path.frames]))
        if self.part_origin is not None:
            self._check_head(path, context)
            self._check_frames(path, "a second work offset, but only one part-origin", False)
            offset = np.array(self.part_origin) - origin - tools
            return Place(offset if len(offset) == 1 else offset[path.frame])
        assert context.machine is not None
        table = context.machine.work_offsets
        self._check_frames(path, "the machine file has not all offsets of this block", True)
        if path.first not in table:
            message = f"the machine file has no work offset {path.first}"
            hint = f"add it there: X = ... in [work-offset.{path.first}]"
            raise path.refuse("GX314", np.array([0]), message, hint)
        zero = [table[path.first].get(axis, 0.0) for axis in "XYZ"]
        offset = np.array([zero]) - origin
        if not self.model.model.needs_tool:
            return Place(offset)
        tip = -tools
        lever = None
        if context.machine.head:
            lever = lever_of(path, context, tip[path.frame])
        if lever is not None:
            return Place(offset, lever.ends, lever)
        return Place(offset, tip[0] if len(tip) == 1 else tip[path.frame])

    def _check_place(self, followed: Followed) -> None:
        """Refuse to follow the tip where only the origin of the tip is known."""
        if self.part_origin is not None:
            message = "the control follows the tip, and part-origin says nothing of the axes"
            hint = "give a machine file with [work-offset.*] and [tool.*] instead of part-origin"
            raise followed.path.refuse("GX314", followed.rows[:1], message, hint)

    def _check_head(self, path: gx.Toolpath, context: gx.PassContext) -> None:
        """Refuse angular errors where the head is turned, and only the origin of the tip known."""
        machine = context.machine
        if machine is None or not self.model.model.needs_tool:
            return
        check_known(path, machine.head)
        letters = [letter for letter in machine.head if letter in path.axes]
        zero = machine.work_offsets.get(path.first, {})
        angles = path.end[:, [path.axes.index(letter) for letter in letters]]
        angles = angles + np.array([zero.get(letter, 0.0) for letter in letters])
        turned = (np.nan_to_num(angles) != 0.0).any(axis=1)
        if turned.any():
            message = f"{UNKNOWN}part-origin says nothing of the axes"
            hint = "give a machine file with [work-offset.*] and [tool.*] instead of part-origin"
            raise path.refuse("GX314", np.flatnonzero(turned)[:1], message, hint)

    def _check_frames(self, path: gx.Toolpath, message: str, tools: bool) -> None:
        """Refuse rows whose X, Y, Z count from elsewhere; `tools`: tool lengths matter.

        An axis that stands nowhere known counts from nothing: such a rapid is left to the machine.
        """
        for number in np.flatnonzero(np.bincount(path.frame)).tolist():
            origins = path.frames[number].origin[:3]
            named = [name if tools else name.split(" + ")[0] for name in origins]
            elsewhere = [k for k, name in enumerate(named) if name != path.first]
            known = np.isfinite(path.end[:, elsewhere]).any(axis=1)
            rows = np.flatnonzero((path.frame == number) & known)[:1]
            if len(rows):
                raise path.refuse("GX314", rows, message, _ways_to_know(path.first, named, tools))


def _ways_to_know(first: str, named: list[str], tools: bool) -> str:
    """Return what to do about frames of which it is not known where they are."""
    known = " and ".join(dict.fromkeys(name for name in named if name != first))
    if not tools:
        return f"not known: {known}; a machine file says it, with part-origin left out"
    if ", after " in known:
        return f"not known: {known}; call the length again behind it, with G43, before Z is named"
    said = gx.ways_to_offsets(first, *(name.split(" + ")[0] for name in named))
    if any(" + " in name for name in named):
        said += ", length = ... in [tool.*]"
    return f"not known: {known}; {said}"
