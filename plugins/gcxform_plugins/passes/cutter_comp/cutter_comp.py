"""`cutter-comp`: the contour of G41 and G42 becomes the path of the tool's centre."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.cutter_comp.corners_said import corners_said, refuse_rapid_corners
from gcxform_plugins.passes.cutter_comp.moves import Moves
from gcxform_plugins.passes.cutter_comp.offsetting import (
    CannotOffsetError,
    Corners,
    Entry,
    Manner,
    Offset,
    offset,
    turns_about,
)
from gcxform_plugins.passes.cutter_comp.proof import prove_beside
from gcxform_plugins.passes.cutter_comp.refusals import STILL, refuse_unresolved

CODES = ("G41", "G42", "G41.1", "G42.1")
STRAIGHT = 1e-3
"""rad; smaller turns are none, on controls of which nothing else is known: so much the last decimal
makes of arcs that meet straight, and the centre is nearer by half a millionth of the radius."""


@dataclass(frozen=True)
class CutterComp(gx.CompensationPass):
    """Compute the path of the tool's centre, and leave cutter compensation to no control.

    Inside corners end where the offset moves meet, outside corners are joined by an arc about the
    corner. What the tool cannot reach without cutting into the contour is refused. For LinuxCNC the
    path is the one that its interpreter executes. Other controls leave `corners` and `entry` to
    parameters of the machine: say what they are set to, here or in the machine file
    (`cutter-comp-corners`, `cutter-comp-entry`).

    Where the errors of a machine are taken off a program that is done by itself, for LinuxCNC and
    where the machine file says both.
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
        contours = _Contours.of(path, self._manner(path, context))
        if not context.source.cutter_comp.corners:
            refuse_rapid_corners(path, contours.row[contours.made.around])
        return contours.centre_path().replace(blocks=blocks)

    def prove(self, before: gx.Toolpath, after: gx.Toolpath, context: gx.PassContext) -> None:
        """Check that the centre is beside the contour all along, and everything else as it was."""
        manner = self._manner(before, context)
        straight = manner.straight * (1 + 1e-9)
        linear, beside_next = manner.corners is Corners.LINEAR, manner.entry is Entry.NEXT
        prove_beside(before, after, straight, linear, beside_next)

    @classmethod
    def ways(
        cls, dialect: type[gx.Dialect], control: Mapping[str, str | float]
    ) -> tuple[CutterComp, ...]:
        """Return one of it for each setting that a control may have.

        What a machine file says is left to it: a program may say otherwise.
        """
        rule = dialect.cutter_comp
        corners: list[Corners | None] = [Corners(rule.corners)] if rule.corners else [*Corners]
        entries: list[Entry | None] = [Entry(rule.entry)] if rule.entry else [*Entry]
        if f"{cls.name}-corners" in control and not rule.corners:
            corners = [None]
        if f"{cls.name}-entry" in control and not rule.entry:
            entries = [None]
        return tuple(cls(corners=one, entry=other) for one in corners for other in entries)

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
AXES = np.array([plane.axes[:2] for plane in gx.Plane]).T


@dataclass(frozen=True)
class _Contours:
    """The rows (n,) of a path that are compensated, and what becomes of them in their planes.

    axes (2, n) are those of the plane of each; still (m,) rows that stand still there.
    """

    path: gx.Toolpath
    row: Ints
    still: Ints
    axes: Ints
    moves: Moves
    made: Offset

    @classmethod
    def of(cls, path: gx.Toolpath, manner: Manner) -> _Contours:
        """Compensate the contours of a path. Raises ContourError for the first that cannot be."""
        held = (path.side != 0) & (path.radius > 0)
        rows = np.flatnonzero(held)
        moving = _moves_in_plane(path, rows)
        row, still = rows[moving], rows[~moving]
        begins = held & ~np.append(False, held[:-1])
        blind = still[begins[still]]
        if len(blind):
            row = row[row < blind[0]]
        moves = _moves(path, row, begins)
        made = _offset(path, row, moves, manner)
        if len(blind):
            message = "the move that begins compensation does not move in the plane"
            raise path.refuse("GX350", blind[:1], message, "program X or Y in that block")
        return cls(path, row, still, AXES[:, path.plane[row]], moves, made)

    def centre_path(self) -> gx.Toolpath:
        """Return the path of the centre, with moves around corners."""
        path, made = self.path, self.made
        corner = np.flatnonzero(made.around | made.across)
        counts = np.ones(len(path), np.int64)
        counts[self.row[corner]] = 2
        row = np.repeat(np.arange(len(path)), counts)
        first = np.cumsum(counts) - counts
        end, centre, sweep = self._ends(), np.array(path.centre), np.array(path.sweep)
        arcs, enters = self.moves.arc, ~np.isnan(made.middle[0])
        sweep[self.row[arcs]] = made.sweep[arcs]
        centre[self.row[enters], self.axes[:, enters]] = made.middle[:, enters]
        nth = path.nth[row] + (np.arange(len(row)) - first[row])
        columns: dict[str, Any] = {
            "end": np.asfortranarray(end[row]),
            "kind": path.kind[row],
            "centre": centre[row],
            "sweep": sweep[row],
            "nth": nth + _inserted_before(path.source, counts)[row],
            "side": np.zeros(len(row), np.int8),
            "radius": np.full(len(row), np.nan),
        }
        if len(corner):
            self._lead_around(corner, first[self.row[corner]], end, columns)
        after = path.with_rows(counts, **columns)
        return after.replace(feed=_feeds(path, after, row))

    def _ends(self) -> Floats:
        """Return where moves end; those that stand still in the plane stand where the centre is."""
        path, still = self.path, self.still
        end = np.array(path.end)
        end[self.row, self.axes] = self.made.finish
        mover = self.row[np.searchsorted(self.row, still) - 1]
        axes = AXES[:, path.plane[still]]
        end[still, axes] = end[mover, axes]
        return end

    def _lead_around(
        self, corner: Ints, places: Ints, end: Floats, columns: dict[str, Any]
    ) -> None:
        """Write the rows that lead around outside corners, before moves (m,), to their places."""
        path, rows, axes = self.path, self.row[corner], self.axes[:, corner]
        begin, point = self.made.begin[:, corner], self.moves.start[:, corner]
        rapid = path.kind[rows] == gx.Kind.RAPID
        around = ~rapid & self.made.around[corner]
        before = end[rows - 1]
        ends, centre, each = before.copy(), before[:, :3].copy(), np.arange(len(rows))
        ends[each, axes], centre[each, axes] = begin, point
        turned = np.where(path.side[rows] > 0, gx.Kind.ARC_CW, gx.Kind.ARC_CCW)
        straight = np.where(rapid, gx.Kind.RAPID, gx.Kind.LINE)
        columns["end"][places] = ends
        columns["kind"][places] = np.where(around, turned, straight)
        columns["centre"][places] = np.where(around[:, None], centre, np.nan)
        sweep = turns_about(before[each, axes], point, begin)
        columns["sweep"][places] = np.where(around, sweep, 0.0)


def _moves_in_plane(path: gx.Toolpath, rows: Ints) -> Flags:
    """Return which of the rows are arcs, or do not stand still in their planes."""
    axes = AXES[:, path.plane[rows]]
    way = np.abs(path.start[rows, axes] - path.end[rows, axes])
    return np.asarray(path.is_arc[rows] | (way[0] + way[1] > STILL))


def _moves(path: gx.Toolpath, row: Ints, begins: Flags) -> Moves:
    """Return rows as moves in their planes."""
    axes = AXES[:, path.plane[row]]
    start, end, centre = (points[row, axes] for points in (path.start, path.end, path.centre))
    sense, sweep, side = path.sense[row], path.sweep[row], path.side[row].astype(float)
    return Moves(start, end, centre, sense, sweep, side, path.radius[row], begins[row])


def _offset(path: gx.Toolpath, row: Ints, moves: Moves, manner: Manner) -> Offset:
    """Compensate rows. Raises ContourError."""
    try:
        return offset(moves, manner)
    except CannotOffsetError as error:
        farther = moves.begins[error.index]
        way_out = "begin farther away" if farther else "change the contour"
        hint = f"use a smaller tool, or {way_out}"
        refusal = path.refuse("GX350", row[[error.index]], error.message, hint)
        raise ContourError(refusal.diagnostics, error.alarm) from None


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
