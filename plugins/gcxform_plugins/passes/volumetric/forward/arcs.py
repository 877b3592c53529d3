"""How `volumetric` keeps arcs: one through compensated points, cut until it is near enough.

Where a piece would be shorter than `min-length`, equal ones that hold the tolerance are looked for.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.volumetric.forward.window import Window

FEWEST, MOST = 8, 256  # points at which a piece is looked at
AT_ONCE = 200_000  # points looked at together
SHORTEST = 2.0**-32  # of an arc; no piece that follows the error of a machine is so short
HALVINGS = 24
REFINEMENTS = 6  # a piece is a sixty-fourth shorter than it could be, at most
FEW, AHEAD = (
    64,
    3,
)  # of so few arcs, so many halvings are looked at together: it takes as long as one
EVEN_TRIES = 8  # numbers of equal pieces that are tried, where others would be too short
FLAT = 0.1  # mm; with less between arc and chord, three points say little about the centre
NO_CHORD = 1e-6  # mm
UNEVEN = 1e-4  # mm; by so much the radii of an arc may differ more than they did
MARGIN = 0.9  # of the tolerance: what looking at points, and not along the curve, may miss
LONGEST = 1.9 * np.pi  # rad; rounded, the ends of a longer piece may change places


@dataclass(frozen=True)
class Sent:
    """Where pieces of arcs are sent, (n, 3) mm in the program's coordinates.

    first, last    the ends of the pieces
    second, third  points on the way; `third` is the end of a piece that is not about a turn
    shift          command minus target, in the mean of both ends
    """

    first: Floats
    second: Floats
    third: Floats
    last: Floats
    shift: Floats

    def take(self, which: Ints) -> Sent:
        """Return that of some pieces."""
        return Sent(*(each[which] for each in vars(self).values()))


class ArcFitter:
    """Finds the pieces into which the arcs of a path are cut, and their centres."""

    def __init__(self, window: Window) -> None:
        self.window = window
        self.path = window.path
        self.step = window.step
        self.limit = min(MARGIN * self.step.limit, window.room)
        self.reach = window.undone
        rotary = np.nan_to_num(self.path.end - self.path.start)[:, 3:]
        self._turning = (rotary != 0).any(axis=1)

    def cuts(self) -> tuple[Ints, Floats]:
        """Return row and part of the cuts of the arcs.

        Each piece reaches as far as the tolerance lets it, and where pieces of one size hold it as
        well, as many of these are taken.
        """
        row = np.flatnonzero(self.path.is_arc)
        row = row[self._too_far(row, np.zeros(len(row)), np.ones(len(row)))]
        cut_row, cut_part = self._farthest_reaching(row)
        if not len(row):
            return cut_row, cut_part
        pieces = np.bincount(np.searchsorted(row, cut_row), minlength=len(row)) + 1
        which = np.repeat(np.arange(len(row)), pieces)
        nth = np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
        low, high = nth / pieces[which], (nth + 1) / pieces[which]
        even = np.ones(len(row), np.bool_)
        even[which[self._too_far(row[which], low, high)]] = False
        own = ~even[np.searchsorted(row, cut_row)]
        same = even[which] & (nth > 0)
        cut_row = np.append(cut_row[own], row[which[same]])
        cut_part = np.append(cut_part[own], low[same])
        return self._long_pieces(cut_row, cut_part) if self.step.min_length else (cut_row, cut_part)

    def _long_pieces(self, cut_row: Ints, cut_part: Floats) -> tuple[Ints, Floats]:
        """Return the cuts, others where they make too short pieces. Raises InputError."""
        order = np.lexsort((cut_part, cut_row))
        cut_row, cut_part = cut_row[order], cut_part[order]
        for row in np.unique(cut_row).tolist():
            mine = cut_row == row
            length = self._length(row)
            shortest = length * float(np.diff(cut_part[mine], prepend=0.0, append=1.0).min())
            if shortest < self.step.min_length:
                even = self._even(row, int(mine.sum()) + 1, int(length / self.step.min_length))
                if even is None:
                    raise self.window.refuse_short(row, shortest)
                cut_row = np.append(cut_row[~mine], np.full(len(even), row))
                cut_part = np.append(cut_part[~mine], even)
        return cut_row, cut_part

    def _length(self, row: int) -> float:
        """Return the length (mm) of an arc in its plane."""
        first, last, _ = gx.radius_and_angle(self.path, np.array([row]))
        return float((first + last)[0] / 2 * self.path.sweep[row])

    def _even(self, row: int, fewest: int, most: int) -> Floats | None:
        """Return where an arc is cut into equal pieces that hold the tolerance, None if none do."""
        for count in np.unique(np.linspace(fewest, most, EVEN_TRIES).astype(int)).tolist():
            part = np.arange(count + 1) / max(count, 1)
            rows = np.full(count, row)
            if fewest <= count <= most and not self._too_far(rows, part[:-1], part[1:]).any():
                return np.asarray(part[1:-1])
        return None

    def _farthest_reaching(self, row: Ints) -> tuple[Ints, Floats]:
        """Return row and part of the cuts of arcs when each piece is as long as it can be.

        Raises InputError where pieces come no nearer to a place at which the error jumps.
        """
        at, reach = np.zeros(len(row)), np.full(len(row), 0.5)
        cut_rows, cut_parts = [np.empty(0, np.int64)], [np.empty(0)]
        while len(row):
            reach = self._reach(row, at, np.minimum(2 * reach, 1 - at))
            at = at + reach
            on = at < 1.0
            if len(stuck := np.flatnonzero(on & (reach < SHORTEST))):
                raise self.window.refuse_jump(row[stuck[:1]])
            row, at, reach = row[on], at[on], reach[on]
            cut_rows.append(row)
            cut_parts.append(at)
        return np.concatenate(cut_rows), np.concatenate(cut_parts)

    def _reach(self, row: Ints, at: Floats, most: Floats) -> Floats:
        """Return how far (part of the arc) pieces that begin at `at` reach, at most `most`."""
        ahead = AHEAD if len(row) <= FEW else 1
        reach = most.copy()
        far = np.arange(len(row))
        for _ in range(0, HALVINGS, ahead):
            sizes = reach[far][:, None] / 2.0 ** np.arange(ahead)
            holds = self._hold(row[far], at[far], sizes)
            found = holds.any(axis=1)
            reach[far] /= 2.0 ** np.where(found, holds.argmax(axis=1), ahead)
            far = far[~found]
            if not len(far):
                break
        step = np.where(reach < most, reach / 2, 0.0)
        for _ in range(0, REFINEMENTS, ahead):
            more = np.flatnonzero(step > 0.0)
            longer = _longer(reach[more], step[more], ahead)
            holds = self._hold(row[more], at[more], longer[:, 1:])
            reach[more] = longer[np.arange(len(more)), _halved(holds, ahead)]
            step /= 2**ahead
        return np.where(self._stop(at, reach) == 1.0, 1.0 - at, reach)

    def _hold(self, row: Ints, at: Floats, sizes: Floats) -> Flags:
        """Return which of some pieces (n, k) that begin at `at` (n,) an arc can stand for."""
        count = sizes.shape[1]
        low = np.repeat(at, count)
        far = self._too_far(np.repeat(row, count), low, self._stop(low, sizes.ravel()))
        return np.asarray(~far.reshape(-1, count))

    def _stop(self, at: Floats, reach: Floats) -> Floats:
        """Return where pieces end: at the end of the arc if that is where rounding puts them."""
        stop = at + reach
        return np.where(stop > 1.0 - 1e-12, 1.0, stop)

    def _too_far(self, row: Ints, low: Floats, high: Floats) -> Flags:
        """Return the pieces that an arc cannot stand for."""
        if not len(row):
            return np.empty(0, np.bool_)
        sent = self._sent(row, low, high)
        far = self._residual(row, low, high, sent) > self.limit
        return np.asarray(far | self._goes_round(row, low, high, sent))

    def _goes_round(self, row: Ints, low: Floats, high: Floats, sent: Sent) -> Flags:
        """Return the pieces of about a turn whose ends are not one point: they would be lost."""
        gap = np.abs(sent.last - sent.first).max(axis=1, initial=0.0)
        return np.asarray(self._about_a_turn(row, low, high) & (gap > 0.0))

    def centres(self, row: Ints, low: Floats, high: Floats) -> Floats:
        """Return the centres (n, 3), in the program's coordinates, of pieces of arcs."""
        if not len(row):
            return np.empty((0, 3))
        return self._centres(row, low, high, self._sent(row, low, high))

    def _sent(self, row: Ints, low: Floats, high: Floats) -> Sent:
        """Return where pieces are sent: all points at once, for to solve one takes as long."""
        count, turns = len(row), np.flatnonzero(self._about_a_turn(row, low, high))
        middle = low + (high - low) / 2
        middle[turns] = (low + (high - low) / 3)[turns]
        later = (low + (high - low) * 2 / 3)[turns]
        rows = np.concatenate([row, row, row, row[turns]])
        target, command = self._command(rows, np.concatenate([low, middle, high, later]))
        first, second, last = command[: 3 * count].reshape(3, count, 3)
        third = last.copy()
        third[turns] = command[3 * count :]
        moved = command - target
        return Sent(first, second, third, last, (moved[:count] + moved[2 * count : 3 * count]) / 2)

    def _about_a_turn(self, row: Ints, low: Floats, high: Floats) -> Flags:
        return np.asarray((high - low) * self.path.sweep[row] > LONGEST)

    def _centres(self, row: Ints, low: Floats, high: Floats, sent: Sent) -> Floats:
        centre = np.full((len(row), 3), np.nan)
        about_a_turn = self._about_a_turn(row, low, high)
        size, last, _ = gx.radius_and_angle(self.path, row)
        sag = size * (1 - np.cos((high - low) * self.path.sweep[row] / 2))
        uneven = np.where(high - low < 1.0, -np.inf, np.abs(last - size) + UNEVEN)
        for plane in gx.Plane:
            here = np.flatnonzero(self.path.plane[row] == plane)
            if not len(here):
                continue
            axes, normal = np.array(plane.axes[:2]), plane.axes[2]
            sent_to = (sent.first, sent.second, sent.third)
            points = [point[np.ix_(here, axes)] for point in sent_to]
            fitted = gx.circle_through(*points)
            moved = (self.path.centre[row] + sent.shift)[np.ix_(here, axes)]
            ends = (np.hypot(*(point - moved).T) for point in points[::2])
            far = (np.abs(np.subtract(*ends)) > uneven[here]) & ~about_a_turn[here]
            moved = np.where(far[:, None], _as_far(moved, *points[::2]), moved)
            flat = ~np.isfinite(fitted).all(axis=1) | (sag[here] < FLAT)
            centre[np.ix_(here, axes)] = np.where(flat[:, None], moved, fitted)
            centre[here, normal] = sent.first[here, normal]
        return centre

    def _command(self, row: Ints, part: Floats) -> tuple[Floats, Floats]:
        """Return points of arcs (n, 3) and their commands, in the program's coordinates."""
        offset = self.window.offset_of(row)
        target = gx.points_on_arcs(self.path, row, part)
        return target, self.window.command(target + offset, row) - offset

    def _residual(self, row: Ints, low: Floats, high: Floats, sent: Sent) -> Floats:
        """Return how far (mm) the machine is from the arcs when it is sent along fitted ones.

        Between two points that are looked at, a bend of the error adds at most the Lipschitz
        constant times half their distance.
        """
        size, _, _ = gx.radius_and_angle(self.path, row)
        length = size * self.path.sweep[row] * (high - low)
        count = np.clip(self.reach * length / (0.2 * self.limit), FEWEST, MOST).astype(np.int64)
        count = 2 ** np.ceil(np.log2(count)).astype(np.int64)
        centre = self._centres(row, low, high, sent)
        worst = np.zeros(len(row))
        for number in np.unique(count).tolist():
            members = np.flatnonzero(count == number)
            for piece in np.array_split(members, len(members) * number // AT_ONCE + 1):
                share = (high - low)[piece]
                fitted = self._fitted(row[piece], share, centre[piece], sent.take(piece))
                worst[piece] = self._largest(row[piece], low[piece], high[piece], fitted, number)
        return worst + self.reach * length / count / 2

    def _largest(
        self, row: Ints, low: Floats, high: Floats, pieces: gx.Toolpath, number: int
    ) -> Floats:
        """Return the largest distance of the machine from the arcs, at a number of points each."""
        every = np.repeat(np.arange(len(row)), number)
        part = np.tile((np.arange(number) + 0.5) / number, len(row))
        command = gx.points_on_arcs(pieces, 2 * every + 1, part)
        place = self.window.place
        offset = place.offset_of(row[every])
        actual = self.window.meant(command + offset, place.tool_of(row[every])) - offset
        along = low[every] + part * (high - low)[every]
        wanted = gx.points_on_arcs(self.path, row[every], along)
        off = self._beside(row[every], along, wanted, actual)
        return np.asarray(off.reshape(len(row), number).max(axis=1))

    def _beside(self, row: Ints, part: Floats, wanted: Floats, actual: Floats) -> Floats:
        """Return the distance of points from arcs and helices.

        A helix is compared where it has the angle of the point; what is off along its axis there
        is nearer to the helix by the cosine of its slope. Where a rotary axis turns with the arc,
        what is off along the arc counts as well.
        """
        off = np.zeros(len(row))
        for plane in gx.Plane:
            here = np.flatnonzero(self.path.plane[row] == plane)
            if not len(here):
                continue
            a, b, normal = plane.axes
            centre = self.path.centre[row[here]][:, [a, b]]
            u, v = actual[here][:, [a, b]] - centre, wanted[here][:, [a, b]] - centre
            size = np.hypot(*v.T)
            ahead = (v[:, 0] * u[:, 1] - v[:, 1] * u[:, 0]) / np.maximum(size, 1e-9) ** 2
            sweep = self.path.sense[row[here]] * self.path.sweep[row[here]]
            way = np.nan_to_num(self.path.end - self.path.start)[row[here], normal]
            along = actual[here, normal] - wanted[here, normal] - way * ahead / sweep
            length = np.abs(size * sweep)
            along *= length / np.maximum(np.hypot(length, way), 1e-12)
            off[here] = np.hypot(np.hypot(*u.T) - size, along)
        turning = self._turning[row]
        off[turning] = np.sqrt(((actual - wanted)[turning] ** 2).sum(axis=1))
        return off

    def _fitted(self, row: Ints, share: Floats, centre: Floats, sent: Sent) -> gx.Toolpath:
        """Return the fitted pieces as arcs: row 2k + 1, after a row that leads to its start."""
        path = self.path.take(np.repeat(row, 2))
        end = np.array(path.end)
        end[0::2, :3], end[1::2, :3] = sent.first, sent.last
        sweep = np.array(path.sweep)
        sweep[1::2] *= share
        path = path.replace(end=end, sweep=sweep, centre=np.repeat(centre, 2, axis=0))
        return path.replace(sweep=gx.swept_anew(path))


def _longer(reach: Floats, step: Floats, halvings: int) -> Floats:
    """Return lengths (n, 2**halvings) with every choice of a step, its half, its quarter and so on.

    Added one after the other, so that they are the lengths that are found one at a time.
    """
    choice = np.arange(2**halvings)
    longer = np.repeat(reach[:, None], len(choice), axis=1)
    for nth in range(halvings):
        longer += (choice >> (halvings - 1 - nth) & 1) * step[:, None] / 2**nth
    return longer


def _halved(holds: Flags, halvings: int) -> Ints:
    """Return to which choice (n,) halving leads; `holds` (n, k) are those with any step at all."""
    found = np.zeros(len(holds), np.int64)
    for bit in 2 ** np.arange(halvings)[::-1]:
        found += bit * holds[np.arange(len(holds)), found + bit - 1]
    return found


def _as_far(centre: Floats, start: Floats, end: Floats) -> Floats:
    """Return the points next to centres (n, 2) that are as far from starts as from ends."""
    chord = end - start
    square = np.maximum((chord**2).sum(axis=1), NO_CHORD**2)
    beside = ((start + end) / 2 - centre) * chord
    return np.asarray(centre + (beside.sum(axis=1) / square)[:, None] * chord)
