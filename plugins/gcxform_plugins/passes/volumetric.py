"""`volumetric`: commands that make a machine with known errors go where the program says.

The error E is a function of the machine position. A command c takes the tool to c + E(c), so for a
target p the command solves c + E(c) = p. Between two commands the control goes straight; the error
bends at the nodes of its table, so a line is cut where its command crosses a node, and nowhere else
unless asked: then the machine is on the line, exactly. With a tolerance, only those cuts stay that
the tolerance needs. An arc stays an arc where one fitted to the compensated points holds the
tolerance, and is halved where it does not.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

import gcxform as gx
from gcxform_plugins.passes.fitting import ArcFitter
from gcxform_plugins.passes.splitting import cuts_of_lines

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ARC_TOLERANCE = 0.001  # mm, where no tolerance is given: an arc cannot be exact
UNDO_SLACK = 2e-6  # mm; how far the pieces of an undone arc are from the curve they stand for


@dataclass(frozen=True)
class Volumetric(gx.Pass):
    """Compensate the volumetric errors of a machine.

    Positions in the table are program + part-origin - table-origin; with a machine file the work
    offset in force takes the place of part-origin.
    """

    name = "volumetric"
    requires = frozenset({gx.NOMINAL})
    ensures = frozenset({gx.COMPENSATED})
    clears = frozenset({gx.NOMINAL})

    model: Annotated[gx.ModelFile, gx.Option("error model: TOML, or a format of a plugin")]
    outside: Annotated[gx.Outside, gx.Option("what the error is beyond the table")] = (
        gx.Outside.ERROR
    )
    tolerance: Annotated[
        gx.Length | None,
        gx.Option(
            "residual allowed between cuts; absent: lines are exact, arcs within 1 um", above=0.0
        ),
    ] = None
    max_correction: Annotated[
        gx.Length, gx.Option("a larger correction is an error", above=0.0)
    ] = 0.2
    split: Annotated[Literal["adaptive", "nodes", "none"], gx.Option("where moves are cut")] = (
        "adaptive"
    )
    rapids: Annotated[
        Literal["ends", "skip"], gx.Option("rapids: compensate their ends, or leave them")
    ] = "ends"
    iterations: Annotated[
        int, gx.Option("steps of the inverse; 0: until it has converged", at_least=0, at_most=20)
    ] = 0
    arc_centres: Annotated[
        Literal["refit", "nominal"], gx.Option("nominal: I, J stay as they were")
    ] = "refit"
    table_origin: Annotated[gx.Vector, gx.Option("origin of the measurement")] = (0.0, 0.0, 0.0)
    part_origin: Annotated[gx.Vector | None, gx.Option("origin of the program")] = None
    max_extrapolation: Annotated[
        float, gx.Option("cells by which the table may be extrapolated", above=0.0)
    ] = 1.0

    @property
    def promise(self) -> float:
        """The tolerance; nothing where moves are not cut, or rapids not compensated."""
        if self.split == "none" or self.rapids == "skip" or self.arc_centres == "nominal":
            return float("inf")
        return self.limit

    @property
    def limit(self) -> float:
        """The residual (mm) that arcs are held to."""
        return ARC_TOLERANCE if self.tolerance is None else self.tolerance

    def begin(self, context: gx.PassContext) -> None:
        """Refuse a model that cannot be inverted, and a run without origin."""
        gx.check_contraction(self.model.model)
        offsets = context.machine.work_offsets if context.machine else {}
        if self.part_origin is None and not offsets:
            raise gx.UsageError.one(
                "GX721",
                "volumetric needs to know where the program's origin is in the machine",
                hint="give part-origin = [x, y, z], or a machine file with work offsets",
            )

    # --- forward and back ---

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the commands for a path."""
        if not len(path):
            return path
        offset = self._offset(path, context)
        return Compensation(self, path, offset).run()

    def undo(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return where the machine goes: command plus error, cut where the error bends."""
        if not len(path):
            return path
        offset = self._offset(path, context)
        return _Machine(self, path, offset).run()

    def _offset(self, path: gx.Toolpath, context: gx.PassContext) -> Floats:
        """Return table position minus program position of each row (n, 3), or of all (1, 3)."""
        origin = np.array(self.table_origin)
        if self.part_origin is not None:
            frames = path.frame[path.frame != path.frame[0]]
            if len(frames):
                row = int(np.argmax(path.frame != path.frame[0]))
                raise path.refuse(
                    "GX314",
                    np.array([row]),
                    "a second work offset, but only one part-origin",
                    "give a machine file with [work-offset.*] instead of part-origin",
                )
            return (np.array(self.part_origin) - origin)[None, :]
        assert context.machine is not None
        table = context.machine.work_offsets
        names = [gx.frame_name(frame) for frame in range(9)]
        rows = np.flatnonzero([names[f] not in table for f in path.frame])
        if len(rows):
            name = names[int(path.frame[rows[0]])]
            raise path.refuse(
                "GX314", rows[:1], f"the machine file has no work offset {name}", "add it there"
            )
        known = np.array([[table.get(n, {}).get(a, 0.0) for a in "XYZ"] for n in names])
        return np.asarray(known[path.frame] - origin)

    def nodes(self) -> tuple[Floats, Floats, Floats]:
        """Return the planes on which the error bends, under the policy for outside."""
        bends = self.outside in (gx.Outside.CLAMP, gx.Outside.ZERO)
        x, y, z = (n if bends else n[1:-1] for n in self.model.model.nodes)
        return x, y, z

    def error(self, position: Floats) -> Floats:
        """Return the error (n, 3) at positions in the table (n, 3), mm."""
        return self.model.model.error(position, self.outside)

    def command(self, target: Floats) -> Floats:
        """Return the commands (n, 3) for targets in the table (n, 3), mm."""
        return gx.compensate(self.model.model, target, self.outside, self.iterations).position


class Compensation:
    """The forward work on one window."""

    def __init__(self, step: Volumetric, path: gx.Toolpath, offset: Floats) -> None:
        self.step = step
        self.path = path
        self.offset = offset
        self.start = path.start[:, :3] + offset
        self.end = path.end[:, :3] + offset

    def offset_of(self, rows: Ints) -> Floats:
        """Return table position minus program position of rows."""
        return self.offset if len(self.offset) == 1 else self.offset[rows]

    def correction(self, rows: Ints, part: Floats) -> Floats:
        """Return the error (n, 3) at parts of the way of arcs."""
        point = gx.points_on_arcs(self.path, rows, part)
        return self.step.error(point + self.offset_of(rows))

    def run(self) -> gx.Toolpath:
        """Return the commands."""
        self._check_known()
        self._check_inside()
        commands = self.step.command(self.end)
        self.entry_command = self.step.command(self.start[:1])[0]
        rows, part = self._cuts(commands)
        if len(rows):
            return self._cut(rows, part, commands)
        self._check_size(commands, self.end, np.arange(len(self.path)))
        end = self._with_others(commands - self.offset)
        return self._arcs(self.path.replace(end=end, entry=self._entry()), np.arange(len(end)))

    def _entry(self) -> Floats:
        entry = self.path.entry.copy()
        if np.isfinite(self.entry_command).all():
            entry[:3] = self.entry_command - self.offset[0]
        return entry

    def _cuts(self, commands: Floats) -> tuple[Ints, Floats]:
        """Return row and part of all cuts."""
        if self.step.split == "none":
            return np.empty(0, np.int64), np.empty(0)
        row, part = cuts_of_lines(self, commands)
        if self.path.has_arcs:
            arc_row, arc_part = ArcFitter(self).cuts()
            row, part = np.append(row, arc_row), np.append(part, arc_part)
        return row, part

    # --- refusals ---

    def _check_known(self) -> None:
        unknown = np.isnan(self.end)
        if unknown.any():
            row = int(np.argmax(unknown.any(axis=1)))
            axis = "XYZ"[int(np.argmax(unknown[row]))]
            raise self.path.refuse(
                "GX311",
                np.array([row]),
                f"where {axis} stands is not known here, and the error depends on it",
                f"program {axis} before, or say start = {{ {axis} = ... }} in [input]",
            )

    def _check_inside(self) -> None:
        """Refuse positions beyond the table, or too far beyond it."""
        points, rows = self.end, np.arange(len(self.path))
        if self.path.has_arcs:
            more, owners = gx.arc_extremes(self.path)
            offset = self.offset if len(self.offset) == 1 else self.offset[owners]
            points = np.vstack([points, more + offset])
            rows = np.append(rows, owners)
        model = self.step.model.model
        beyond = model.outside(points)
        if not beyond.any():
            return
        if self.step.outside is gx.Outside.ERROR:
            self._refuse_outside(points, rows, beyond, "")
        elif self.step.outside is gx.Outside.EXTRAPOLATE:
            for axis in range(3):
                nodes = model.nodes[axis]
                if len(nodes):
                    self._check_extrapolation(points, rows, axis, nodes)

    def _refuse_outside(
        self, points: Floats, rows: Ints, beyond: NDArray[np.bool_], more: str
    ) -> None:
        first = int(np.argmax(beyond.any(axis=1)))
        axis = int(np.argmax(beyond[first]))
        low, high = self.step.model.model.range_of(axis)
        value = float(points[first, axis])
        limit = low if value < low else high
        raise self.path.refuse(
            "GX310",
            rows[first : first + 1],
            f"{'XYZ'[axis]} {value:.3f} is outside the error table, which ends at {limit:g}{more}",
            'outside = "clamp" or "extrapolate" goes beyond, or measure a larger volume',
        )

    def _check_extrapolation(self, points: Floats, rows: Ints, axis: int, nodes: Floats) -> None:
        allowed = self.step.max_extrapolation
        low = nodes[0] - allowed * (nodes[1] - nodes[0])
        high = nodes[-1] + allowed * (nodes[-1] - nodes[-2])
        beyond = np.zeros(points.shape, np.bool_)
        beyond[:, axis] = (points[:, axis] < low - 1e-9) | (points[:, axis] > high + 1e-9)
        if beyond.any():
            self._refuse_outside(points, rows, beyond, f", by more than {allowed:g} cells")

    def _check_size(self, command: Floats, target: Floats, rows: Ints) -> None:
        size = np.sqrt(((command - target) ** 2).sum(axis=1))
        if np.nanmax(size, initial=0.0) > self.step.max_correction:
            worst = int(np.nanargmax(size))
            raise self.path.refuse(
                "GX313",
                rows[worst : worst + 1],
                f"the correction is {size[worst]:.4f} mm, more than {self.step.max_correction:g}",
                "values in the table are in mm; if they are, raise max-correction",
            )

    # --- rows ---

    def _with_others(self, command: Floats) -> Floats:
        """Return the ends of all rows: commands for X, Y, Z, the other axes as they are."""
        path = self.path
        end = gx.column_major(len(path), len(path.axes))
        end[:, :3], end[:, 3:] = command, path.end[:, 3:]
        if self.step.rapids == "skip":
            rapid = path.kind == gx.Kind.RAPID
            end[rapid] = path.end[rapid]
        return end

    def _cut(self, cut_row: Ints, cut_part: Floats, commands: Floats) -> gx.Toolpath:
        """Return the path cut at parts of its rows."""
        path = self.path
        row = np.append(np.arange(len(path)), cut_row)
        part = np.append(np.ones(len(path)), cut_part)
        order = np.lexsort((part, row))
        row, part = row[order], part[order]
        inner = part < 1.0
        target = self.end[row]
        target[inner] = self._between(row[inner], part[inner])
        command = commands[row]
        command[inner] = self.step.command(target[inner])
        self._check_size(command, target, row)
        end = self._with_others(commands - self.offset)[row]
        end[:, :3] = np.where(inner[:, None], command - self.offset_of(row), end[:, :3])
        a, b = path.start[row, 3:], path.end[row, 3:]
        end[:, 3:] = np.where(inner[:, None], a + part[:, None] * (b - a), b)
        low = np.where(np.append(True, row[1:] != row[:-1]), 0.0, np.append(0.0, part[:-1]))
        columns = self._timed_and_swept(row, part - low)
        counts = np.bincount(row, minlength=len(path))
        new = path.with_rows(counts, end=np.asfortranarray(end), **columns)
        return self._arcs(new.replace(entry=self._entry()), row, low, part)

    def _between(self, rows: Ints, part: Floats) -> Floats:
        """Return the points of rows at parts of their way, in the table."""
        start, end = self.start[rows], self.end[rows]
        point = start + part[:, None] * (end - start)
        arcs = self.path.is_arc[rows]
        if arcs.any():
            on_arc = gx.points_on_arcs(self.path, rows[arcs], part[arcs])
            point[arcs] = on_arc + self.offset_of(rows[arcs])
        return np.asarray(point)

    def _timed_and_swept(self, row: Ints, share: Floats) -> dict[str, Floats]:
        """Return sweeps of the pieces, and feeds where a feed is the inverse of a time."""
        path = self.path
        columns: dict[str, Floats] = {}
        if path.has_arcs:
            columns["sweep"] = path.sweep[row] * share
        inverse = path.feed_mode[row] == gx.FeedMode.INVERSE_TIME
        if inverse.any():
            columns["feed"] = np.where(inverse, path.feed[row] / share, path.feed[row])
        return columns

    def _arcs(
        self, new: gx.Toolpath, row: Ints, low: Floats | None = None, high: Floats | None = None
    ) -> gx.Toolpath:
        """Return the path with the centres of its arcs moved to suit the commands."""
        if not new.has_arcs:
            return new
        arcs = np.flatnonzero(new.is_arc)
        centre = new.centre.copy()
        if self.step.arc_centres == "nominal":
            nominal = self._between_starts(row[arcs], None if low is None else low[arcs])
            centre[arcs] = new.start[arcs, :3] + (self.path.centre[row[arcs]] - nominal)
            return new.replace(centre=centre, refit_centres=False)
        begin = np.zeros(len(arcs)) if low is None else low[arcs]
        stop = np.ones(len(arcs)) if high is None else high[arcs]
        centre[arcs] = ArcFitter(self).centres(row[arcs], begin, stop)
        return new.replace(centre=centre)

    def _between_starts(self, rows: Ints, low: Floats | None) -> Floats:
        """Return where pieces start in the program's coordinates, before compensation."""
        if low is None:
            return np.asarray(self.path.start[rows, :3])
        return self._between(rows, low) - self.offset_of(rows)


class _Machine:
    """Where the machine goes with commands: the forward model alone."""

    def __init__(self, step: Volumetric, path: gx.Toolpath, offset: Floats) -> None:
        self.step = step
        self.path = path
        self.offset = offset
        self.start = path.start[:, :3] + offset
        self.end = path.end[:, :3] + offset

    def run(self) -> gx.Toolpath:
        path = self.path
        rows, part, _, _ = self._crossings()
        whole = np.arange(len(path))
        counts = np.ones(len(path), np.int64)
        every, at = whole, np.ones(len(path))
        if len(rows):
            every = np.concatenate([whole, rows])
            at = np.concatenate([at, part])
            order = np.lexsort((at, every))
            every, at = every[order], at[order]
            counts = np.bincount(every, minlength=len(path))
        point = self._points(every, at)
        offset = self.offset if len(self.offset) == 1 else self.offset[every]
        actual = point + self.step.error(point + offset)
        if self.step.rapids == "skip":
            rapid = path.kind[every] == gx.Kind.RAPID
            actual[rapid] = point[rapid]
        return self._path(counts, every, at, actual)

    def _crossings(self) -> tuple[Ints, Floats, Ints, Floats]:
        """Return where lines and arcs are cut: at nodes, and arcs also where they turn far."""
        path = self.path
        points = np.empty((3, len(path) + 1)).T
        points[0], points[1:] = self.start[0], self.end
        lines = path.kind == gx.Kind.LINE
        row, part, axis, plane = gx.line_crossings(points, lines, self.step.nodes())
        if path.has_arcs:
            reach = self.step.model.model.lipschitz
            arc_row, arc_part = gx.arc_cuts(path, self.offset, self.step.nodes(), reach, UNDO_SLACK)
            row, part = np.append(row, arc_row), np.append(part, arc_part)
        return row, part, axis, plane

    def _points(self, rows: Ints, part: Floats) -> Floats:
        """Return commanded points (n, 3) of rows at parts of their way."""
        path = self.path
        if len(rows) == len(path):
            return np.asarray(path.end[:, :3])
        start, end = path.start[rows, :3], path.end[rows, :3]
        point = start + part[:, None] * (end - start)
        arcs = path.is_arc[rows]
        if arcs.any():
            point[arcs] = gx.points_on_arcs(path, rows[arcs], part[arcs])
        return np.where((part == 1.0)[:, None] | np.isnan(point), end, point)

    def _path(self, counts: Ints, rows: Ints, part: Floats, actual: Floats) -> gx.Toolpath:
        path = self.path
        end = gx.column_major(len(rows), len(path.axes))
        end[:, :3] = actual
        a, b = path.start[rows, 3:], path.end[rows, 3:]
        end[:, 3:] = np.where((part == 1.0)[:, None], b, a + part[:, None] * (b - a))
        entry = path.entry.copy()
        if np.isfinite(entry[:3]).all():
            entry[:3] += self.step.error(entry[None, :3] + self.offset[:1])[0]
        columns: dict[str, Floats] = {"end": end}
        if path.has_arcs:
            before = np.where(
                np.append(True, rows[1:] != rows[:-1]), 0.0, np.append(0.0, part[:-1])
            )
            columns["sweep"] = path.sweep[rows] * (part - before)
            middle = self._points_between(rows, (part + before) / 2)
            columns["centre"] = path.centre[rows] + middle
        slack = UNDO_SLACK if path.has_arcs else 0.0
        return path.with_rows(counts, **columns).replace(entry=entry, slack=path.slack + slack)

    def _points_between(self, rows: Ints, part: Floats) -> Floats:
        """Return the errors (n, 3) in the middle of pieces of arcs; 0 for other rows."""
        errors = np.zeros((len(rows), 3))
        arcs = np.flatnonzero(self.path.is_arc[rows])
        point = gx.points_on_arcs(self.path, rows[arcs], part[arcs])
        offset = self.offset if len(self.offset) == 1 else self.offset[rows[arcs]]
        errors[arcs] = self.step.error(point + offset)
        return errors
