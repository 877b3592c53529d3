"""The proof of what stays under G41 and G42: where the control takes the centre of the tool.

What is programmed there is a contour. Rounding a point of it moves the centre by more: beside an
arc in the measure of both radii, at a corner by the slant of it, and a contour that the tool could
just follow may be one that it cannot. So the centre path of the source and that of the output are
computed, by the installed pass that resolves compensation, and these are compared.

Claimed of every stretch p of the source and w of the output, with C the centre path that a control
makes of one and b the budget: |C(w) - C(p)| <= b, along both in the order of travel
(`gcxform/deviations/`), for every C in `ways` that p has. That C(p) itself is beside the contour is
the claim of the pass that resolves compensation, and proved there.

A stretch that is the same to the last bit leads the centre the same way. Of such a one, as of every
other, is asked whether the control stops at it, where that is known.

Where a parameter of the machine decides about corners and entry, `CompensationPass.ways` has a pass
for each setting, and all are compared that can take the source. Too far off, or no longer possible,
is GX351: a refusal, because nothing is wrong but the decimals. Without a budget of the user 3 um
are allowed, for no number of decimals bounds what a corner makes of them. Where the radius is not
known, or what the control does, the certificate counts the moves of which only the contour was
compared. Where the control itself stops (`CompensationPass.stops`: a first move no longer than the
radius, an inside corner without room), the program is refused, changed or not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from gcxform.catalogue.remedies import Hint, StepBefore
from gcxform.contract.passes import CompensationPass, PassContext
from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.dialect.dialect import Dialect
from gcxform.plugin.registry import default_registry
from gcxform.proof.compensated_stretches import Stretches
from gcxform.system.arrays import Ints
from gcxform.toolpath.path import Toolpath
from gcxform.values import dataclass

REACH = 1.0  # mm; what is farther off is not measured
SHAPE = ("kind", "end", "centre", "sweep", "side", "radius", "plane", "lost")
OPEN = ("GX231", "GX232")
"""What a resolving pass refuses because it is not known, and not because it cannot be done."""
MENDED = Hint(
    "write more decimals, or put the pass cutter-comp before: its path is proved as it is",
    StepBefore("cutter-comp"),
)


@dataclass(slots=True)
class Off:
    """How far (mm) the centre has moved at most, and on which lines, from 0."""

    distance: float
    source_line: int
    output_line: int


def ways_of(dialect: type[Dialect]) -> tuple[CompensationPass, ...]:
    """Return passes that resolve compensation in each way in which such controls may do it."""
    for step in default_registry().passes.values():
        if issubclass(step, CompensationPass):
            return step.ways(dialect, {})
    return ()


class CentreProof:
    """Is shown the windows of source and output in order.

    unknown     moves of which only the contour was compared
    compared    stretches whose centre paths were compared
    """

    def __init__(self, context: PassContext, file: str = "-") -> None:
        self.file = file
        self.context = replace(context, source=context.target)
        self.ends = {f"M{number}" for number, code in context.target.m_codes.items() if code.ends}
        self.compared = 0
        self._unknown = 0
        self._before, self._after = Stretches(), Stretches()

    @cached_property
    def ways(self) -> tuple[CompensationPass, ...]:
        """The ways of the control, which are loaded when there is a contour."""
        return ways_of(self.context.target)

    @property
    def unknown(self) -> int:
        """Moves of which only the contour was compared, or of a stretch that nothing has ended."""
        one, other = self._before.waiting, self._after.waiting
        if one is None or (other is not None and _same(one, other)):
            return self._unknown
        return self._unknown + len(one)

    def check(self, before: Toolpath, after: Toolpath, budget: float) -> list[Off]:
        """Return how far the centre is off in the stretches that these windows complete.

        Raises InputError where the control stops, or where the output leads the centre elsewhere.
        """
        if not (before.side.any() or self._before.waiting or self._after.waiting):
            return []
        end = next((e for e in after.events if e.row == len(after) and e.what in self.ends), None)
        pairs = self._before.of(before, end), self._after.of(after, end)
        if len(pairs[0]) != len(pairs[1]):
            raise _too_short(before)
        try:
            found = [self._check(one, other, budget) for one, other in zip(*pairs, strict=True)]
        except InputError as error:
            where = (d.where or Location("") for d in error.diagnostics)
            places = [Location(self.file, each.line) for each in where]
            raise InputError(tuple(map(Diagnostic.at, error.diagnostics, places))) from None
        return [off for off in found if off is not None]

    def stops(self, path: Toolpath) -> tuple[Diagnostic, ...]:
        """Return where the control stops at what a window of a program completes, as it stands."""
        try:
            self.check(path, path, 0.0)
        except InputError as error:
            return error.diagnostics
        return ()

    def _check(self, one: Toolpath, other: Toolpath, budget: float) -> Off | None:
        if (stop := _stop(self.ways, one, self.context)) is not None:
            raise stop
        if _same(one, other):
            return None
        if np.isnan(one.radius[0]) or not self.ways:
            self._unknown += len(one)
            return None
        centres = self._resolved(one)
        if not centres:
            self._unknown += len(one)
            return None
        self.compared += 1
        offs = [self._off(centre, way, one, other, budget) for way, centre in centres]
        return max(offs, key=lambda off: off.distance)

    def _resolved(self, path: Toolpath) -> list[tuple[CompensationPass, Toolpath]]:
        """Return the centre paths of a stretch, each with the pass that it comes from.

        There is none where something is not known. Raises InputError if no setting of the control
        lets the tool follow.
        """
        done: list[tuple[CompensationPass, Toolpath]] = []
        refusals: list[InputError] = []
        for way in self.ways:
            try:
                done.append((way, way.apply(path, self.context)))
            except InputError as error:
                refusals.append(error)
        if not done and not any(r.diagnostics[0].code in OPEN for r in refusals):
            raise refusals[0]
        return done

    def _off(
        self, centre: Toolpath, way: CompensationPass, one: Toolpath, other: Toolpath, budget: float
    ) -> Off:
        """Return how far the centre path of the output is off. Raises InputError if too far."""
        try:
            written = way.apply(other, self.context)
        except InputError as error:
            said = error.diagnostics[0].message
            message = f"rounded, this contour is another one: {said}"
            raise one.refuse("GX351", _row_beside(one, other, error), message, MENDED) from None
        off, row = farthest(centre, written, budget)
        if not off.distance <= budget:
            size = f"{off.distance:.5f} mm" if np.isfinite(off.distance) else "far"
            message = f"rounded, this contour leads the centre of the tool {size} off"
            message += f", the budget is {budget:.5f} mm"
            rows = np.flatnonzero(one.source == centre.source[row])
            raise one.refuse("GX351", rows, message, MENDED)
        return off


def farthest(one: Toolpath, other: Toolpath, tolerance: float) -> tuple[Off, int]:
    """Return how far two paths are apart at most, and in which row of the first that is."""
    from gcxform.deviations.matching import match
    from gcxform.deviations.paired_pieces import measure

    matching = match(one, other, tolerance, REACH)
    if matching.parted is not None:
        a, b = (max(row, 0) for row in matching.parted)
        return Off(np.inf, int(one.source[a]), int(other.source[b])), a
    if not len(matching.a):
        return Off(0.0, int(one.source[0]), int(other.source[0])), 0
    distance = measure(one, other, matching).distance
    worst = int(np.argmax(distance))
    a, b = int(matching.a.row[worst]), int(matching.b.row[worst])
    return Off(float(distance[worst]), int(one.source[a]), int(other.source[b])), a


def _same(one: Toolpath, other: Toolpath) -> bool:
    """Whether two stretches are the same to the last bit."""
    if len(one) != len(other):
        return False
    pairs = [(getattr(one, name), getattr(other, name)) for name in SHAPE]
    pairs.append((one.entry, other.entry))
    return all(np.array_equal(a, b, equal_nan=a.dtype.kind == "f") for a, b in pairs)


def _too_short(path: Toolpath) -> InputError:
    message = "rounded, nothing is left of a move that begins or ends cutter compensation"
    rows = np.flatnonzero(path.side)[:1]
    return path.refuse("GX351", rows if len(rows) else np.arange(1), message, MENDED)


def _row_beside(one: Toolpath, other: Toolpath, error: InputError) -> Ints:
    """Return the row of the source beside the row of the output that an error is about."""
    where = error.diagnostics[0].where
    line = where.line - 1 if where is not None else -1
    row = int(np.searchsorted(other.source, line))
    return np.array([min(row, len(one) - 1)])


def _stop(
    ways: Sequence[CompensationPass], path: Toolpath, context: PassContext
) -> InputError | None:
    """Return why the control stops at a stretch, if it is known how it compensates."""
    known = len(ways) == 1 and not np.isnan(path.radius[0])
    return ways[0].stops(path, context) if known else None
