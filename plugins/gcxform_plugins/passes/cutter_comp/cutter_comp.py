"""`cutter-comp`: the contour of G41 and G42 becomes the path of the tool's centre."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats, Ints
from gcxform_plugins.passes.cutter_comp.corners_said import corners_said, refuse_rapid_corners
from gcxform_plugins.passes.cutter_comp.offsetting import (
    CannotOffsetError,
    Corners,
    Edge,
    Entry,
    Manner,
    offset,
    swept,
    turns_about,
)
from gcxform_plugins.passes.cutter_comp.proof import prove_beside
from gcxform_plugins.passes.cutter_comp.refusals import STILL, refuse_unresolved

CODES = ("G41", "G42", "G41.1", "G42.1")
STRAIGHT = 1e-4  # rad; smaller turns are none, on controls of which nothing else is known


@dataclass(frozen=True)
class CutterComp(gx.CompensationPass):
    """Compute the path of the tool's centre, and leave cutter compensation to no control.

    Inside corners end where the offset moves meet, outside corners are joined by an arc about the
    corner. What the tool cannot reach without cutting into the contour is refused. For LinuxCNC the
    path is the one that its interpreter executes. Other controls leave `corners` and `entry` to
    parameters of the machine: say what they are set to, here or in the machine file
    (`cutter-comp-corners`, `cutter-comp-entry`).

    Where the errors of a machine are taken off a program for LinuxCNC that is done by itself.
    """

    name = "cutter-comp"
    ensures = frozenset({gx.NO_CUTTER_COMP})
    demands = gx.Demands(resolves=True)
    corners: Annotated[
        Corners | None, gx.Option("what joins two moves outside: an arc, or lines that meet")
    ] = None
    entry: Annotated[
        Entry | None,
        gx.Option("the move that begins compensation ends beside its own end, or the next move"),
    ] = None

    def begin(self, context: gx.PassContext) -> None:
        """Refuse options that the control leaves no choice of."""
        for name in CHOICES:
            known, asked = getattr(context.source.cutter_comp, name), getattr(self, name)
            if known and asked is not None and asked != known:
                raise gx.UsageError.one(
                    "GX740",
                    f'{context.source.name} has {name} = "{known}", and nothing else',
                    hint=f"leave {name} out",
                )

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the centre path, in G40."""
        blocks = replace(path.blocks, uncompensated=True)
        path = path.replace(events=tuple(e for e in path.events if e.what not in CODES))
        if not path.side.any():
            return path.replace(blocks=blocks)
        refuse_unresolved(path, context)
        self._refuse_open(path, context)
        centre = _CentrePath(path, self._manner(path, context))
        for first, last in _sections(path):
            centre.resolve(first, last)
        if not context.source.cutter_comp.corners:
            refuse_rapid_corners(path, centre.inserted)
        return centre.path().replace(blocks=blocks)

    def prove(self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext) -> None:
        """Check that the centre is beside the contour all along, and everything else as it was."""
        manner = self._manner(before, context)
        straight = manner.straight * (1 + 1e-9)
        linear, beside_next = manner.corners is Corners.LINEAR, manner.entry is Entry.NEXT
        prove_beside(before, after, straight, linear, beside_next)

    @classmethod
    def ways(cls, dialect: type[gx.Dialect]) -> tuple[CutterComp, ...]:
        """Return one of it for each setting that a control may have."""
        rule = dialect.cutter_comp
        return tuple(
            cls(corners=corners, entry=entry)
            for corners in ([Corners(rule.corners)] if rule.corners else Corners)
            for entry in ([Entry(rule.entry)] if rule.entry else Entry)
        )

    def stops(self, path: gx.Toolpath, context: gx.PassContext) -> gx.InputError | None:
        """Return where LinuxCNC stops; of other controls it is not known."""
        rule = context.source.cutter_comp
        if not (rule.corners and rule.entry):
            return None
        try:
            self.apply(path, context)
        except ContourError as error:
            return error if error.alarm else None
        except gx.InputError:
            pass
        return None

    def _said(self, name: str, path: gx.Toolpath, context: gx.PassContext) -> str:
        """Return how the control does it: by itself, as the option, program or machine file says.

        What a program says overrides the parameter of the machine; it says nothing of the entry.
        """
        machine = context.machine.control if context.machine is not None else {}
        known = getattr(context.source.cutter_comp, name) or getattr(self, name)
        known = known or (corners_said(path, context).only if name == "corners" else "")
        return str(known or machine.get(f"{self.name}-{name}", ""))

    def _refuse_open(self, path: gx.Toolpath, context: gx.PassContext) -> None:
        """Refuse contours where a parameter decides how they are resolved, and nothing says it."""
        first = np.flatnonzero(path.side)[:1]
        found: list[gx.Diagnostic] = []
        for name, values in CHOICES.items() if "G41" in context.source.codes else ():
            if not self._said(name, path, context):
                message = f"{name} of cutter compensation depends on a parameter of the machine"
                ways = [f'{self.name}-{name} = "{value}" in [control]' for value in values]
                hint = f'say what it is set to: {", or ".join(ways)}; or {name} = "{values[0]}"'
                found += path.refuse("GX740", first, message, hint).diagnostics
        if found:
            raise gx.InputError(tuple(found))
        corners_said(path, context).check(path, self._said("corners", path, context))

    def _manner(self, path: gx.Toolpath, context: gx.PassContext) -> Manner:
        rule = context.source.cutter_comp
        corners = Corners(self._said("corners", path, context) or Corners.ARC)
        entry = Entry(self._said("entry", path, context) or Entry.OWN)
        return Manner(corners, entry, rule.straight or STRAIGHT, bool(rule.corners and rule.entry))


@dataclass
class ContourError(gx.InputError):
    """A contour that the tool cannot follow; `alarm`: LinuxCNC stops at it as well."""

    alarm: bool = False


CHOICES = {"corners": ("arc", "linear"), "entry": ("own", "next")}


def _sections(path: gx.Toolpath) -> Iterator[tuple[int, int]]:
    """Yield first row and row after the last of each stretch under compensation."""
    on = np.concatenate([[False], path.side != 0, [False]])
    edges = np.flatnonzero(on[1:] != on[:-1])
    yield from zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)


class _CentrePath:
    """The columns of a path whose rows under compensation become those of the centre."""

    def __init__(self, path: gx.Toolpath, manner: Manner) -> None:
        self.before = path
        self.manner = manner
        self.start = path.start
        self.end = np.array(path.end)
        self.centre = np.array(path.centre)
        self.sweep = np.array(path.sweep)
        self.sense = path.sense.astype(np.int64)
        self.inserted: dict[int, Edge] = {}
        self.rows, self.axes = list[int](), list[list[int]]()
        self.finish: list[tuple[float, float]] = []
        self.standing: list[tuple[int, int, list[int], list[int]]] = []
        self.listed: dict[tuple[int, ...], tuple[list[Any], ...]] = {}

    def resolve(self, first: int, last: int) -> None:
        """Resolve the rows of one stretch under compensation."""
        path = self.before
        side, radius = int(path.side[first]), float(path.radius[first])
        if radius == 0.0:
            return
        axes = list(gx.Plane(int(path.plane[first])).axes[:2])
        rows, edges = self._edges(first, last, axes)
        try:
            offset(edges, side, radius, self.manner)
        except CannotOffsetError as error:
            where = np.array([rows[error.index]])
            begins = error.index == 0
            hint = "use a smaller tool, or " + (
                "begin farther away" if begins else "change the contour"
            )
            refusal = path.refuse("GX350", where, error.message, hint)
            raise ContourError(refusal.diagnostics, error.alarm) from None
        self._place(rows, edges, axes)
        if len(rows) < last - first:
            self.standing.append((first, last, rows, axes))

    def _edges(self, first: int, last: int, axes: list[int]) -> tuple[list[int], list[Edge]]:
        """Return the rows that move in the plane, and what they are there."""
        path, part = self.before, slice(first, last)
        rows, edges = [], []
        moves = zip(*(column[part] for column in self._in_plane(*axes)), strict=True)
        for row, (a, b, c, sense, sweep) in enumerate(moves, first):
            if sense:
                edges.append(Edge((a[0], a[1]), (b[0], b[1]), (c[0], c[1]), sense, sweep))
            elif abs(a[0] - b[0]) + abs(a[1] - b[1]) > STILL:
                edges.append(Edge((a[0], a[1]), (b[0], b[1])))
            else:
                continue
            rows.append(row)
        if not rows or rows[0] != first:
            message = "the move that begins compensation does not move in the plane"
            raise path.refuse("GX350", np.array([first]), message, "program X or Y in that block")
        return rows, edges

    def _in_plane(self, *axes: int) -> tuple[list[Any], ...]:
        """Return starts, ends, centres, senses and sweeps of all moves, in a plane."""
        if axes not in self.listed:
            path, columns = self.before, [*axes]
            places = (each[:, columns].tolist() for each in (self.start, path.end, path.centre))
            self.listed[axes] = *places, self.sense.tolist(), path.sweep.tolist()
        return self.listed[axes]

    def _place(self, rows: list[int], edges: list[Edge], axes: list[int]) -> None:
        """Take note of where moves go; their ends are written for all stretches together."""
        self.rows += rows
        self.axes += [axes] * len(rows)
        self.finish += [edge.finish for edge in edges]
        for row, edge in zip(rows, edges, strict=True):
            if edge.centre is not None:
                self.sweep[row] = swept(edge)
            if edge.middle is not None:
                self.centre[row, axes] = edge.middle
            if edge.corner:
                self.inserted[row] = edge

    def _still(self, first: int, last: int, rows: list[int], axes: list[int]) -> None:
        """Let rows that stand still in the plane stand where the centre is."""
        inside = np.arange(first, last)
        mover = np.array(rows)[np.searchsorted(rows, inside, "right") - 1]
        for axis in axes:
            self.end[inside, axis] = self.end[mover, axis]

    def path(self) -> gx.Toolpath:
        """Return the centre path."""
        before = self.before
        if self.rows:
            self.end[np.array(self.rows)[:, None], np.array(self.axes)] = self.finish
        for each in self.standing:
            self._still(*each)
        counts = np.ones(len(before), np.int64)
        counts[list(self.inserted)] = 2
        row = np.repeat(np.arange(len(before)), counts)
        nth = np.arange(len(row)) - (np.cumsum(counts) - counts)[row]
        columns: dict[str, Any] = {
            "end": np.asfortranarray(self.end[row]),
            "kind": before.kind[row],
            "centre": self.centre[row],
            "sweep": self.sweep[row],
            "nth": before.nth[row] + nth + _inserted_before(before.source, counts)[row],
            "side": np.zeros(len(row), np.int8),
            "radius": np.full(len(row), np.nan),
        }
        corner = np.flatnonzero((counts[row] == 2) & (nth == 0))
        if len(corner):
            self._corners(corner, row[corner], columns)
        path = before.with_rows(counts, **columns)
        return path.replace(feed=_feeds(before, path, row))

    def _corners(self, places: Ints, rows: Ints, columns: dict[str, Any]) -> None:
        """Write the rows that lead around outside corners; each is before one of `rows`."""
        path, edges = self.before, [self.inserted[row] for row in rows.tolist()]
        of = {plane: gx.Plane(plane).axes[:2] for plane in {*path.plane[rows].tolist()}}
        at = np.arange(len(rows))[:, None], np.array([of[n] for n in path.plane[rows].tolist()])
        begin, corner = (
            np.array(each) for each in zip(*((e.begin, e.start) for e in edges), strict=True)
        )
        rapid = path.kind[rows] == gx.Kind.RAPID
        around = ~rapid & np.array([edge.corner == "arc" for edge in edges])
        before = self.end[rows - 1]
        end, centre = before.copy(), before[:, :3].copy()
        end[at], centre[at] = begin, corner
        turned = np.where(path.side[rows] > 0, gx.Kind.ARC_CW, gx.Kind.ARC_CCW)
        straight = np.where(rapid, gx.Kind.RAPID, gx.Kind.LINE)
        columns["end"][places] = end
        columns["kind"][places] = np.where(around, turned, straight)
        columns["centre"][places] = np.where(around[:, None], centre, np.nan)
        columns["sweep"][places] = np.where(around, turns_about(before[at], corner, begin), 0.0)


def _inserted_before(source: Ints, counts: Ints) -> Ints:
    """Return how many moves are inserted in the line of each row (n,) before it and its own."""
    before = np.cumsum(counts - 1) - (counts - 1)
    return np.asarray(before - before[np.searchsorted(source, source)])


def _feeds(before: gx.Toolpath, after: gx.Toolpath, row: Ints) -> Floats:
    """Return the feeds: in inverse time the speed is that of the contour as programmed."""
    feed = before.feed[row]
    timed = (before.feed_mode == gx.FeedMode.INVERSE_TIME) & (before.side != 0)
    timed &= before.kind != gx.Kind.RAPID
    if not timed.any():
        return feed
    programmed, mine = _lengths(before)[row], _lengths(after)
    change = timed[row] & (mine > STILL) & (programmed > STILL)
    return np.where(change, feed * programmed / np.where(change, mine, 1.0), feed)


def _lengths(path: gx.Toolpath) -> Floats:
    """Return the lengths (mm) of moves of the linear axes X, Y and Z."""
    way = np.nan_to_num(path.end[:, :3] - path.start[:, :3])
    length = np.sqrt((way**2).sum(axis=1))
    arcs = np.flatnonzero(path.is_arc)
    if len(arcs):
        radius, _, _ = gx.radius_and_angle(path, arcs)
        normal = np.array([gx.Plane(p).axes[2] for p in path.plane[arcs].tolist()])
        length[arcs] = np.hypot(radius * path.sweep[arcs], way[arcs, normal])
    return np.asarray(length)
