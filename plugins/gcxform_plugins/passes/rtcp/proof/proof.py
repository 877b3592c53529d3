"""Whether a program with other angles keeps tool and speed: the proof of all that turns anew.

It has the forward models of both machines, and no search. A move of the source is followed from
end to end beside the n moves that it became, which share it evenly. At part t of the i-th of these,
which is part s = (i - 1 + t) / n of the source's:

    p, a, q     (3,) mm, (3,), (m,) degrees: tip, tool axis and angles as the source leads them
    p', a', q'  the same as the target drives them
    b, b'       mm: `bends` of both, an eighth of bounds of second derivatives; l, l' `leans`, rad
    N           into how many pieces each of the n is divided: their ends are looked at
    d           mm: (b / n^2 + b') / N^2 <= SHARE tolerance, and so for l with LEAN_SHARE

Claimed, for every s of a cut, and for s = 1 of a rapid:

    |p - p'| <= tolerance     |a - a'| <= axis tolerance     |q - q'| <= largest turn

where the last holds for one machine and its calibrated twin. Checked: |p - p'| + d <= tolerance at
the places, and so for a. That is enough: between two places both curves are within d, together, of
their chords, and two chords are farthest apart at an end. q' is linear in s and q too. The times
1 / F of the n moves are each a n-th of the source's, or what an axis needs at its full speed. Moves
that draw the tool back are taken out before (`retracted.py`): the rest has to be the source.
"""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.proof.driven import Driven, Leading, Straight
from gcxform_plugins.passes.rtcp.proof.retracted import Retracted
from gcxform_plugins.passes.rtcp.proof.undoing import SHARE

AT_ONCE = 20_000  # places compared at once
LEAN_SHARE = 0.02  # of the tolerance of the tool axis, that is left to the places looked at
SAME_TIME = 1e-9  # relative
STILL = 1e-7  # mm, degrees; what moves by less stands still


class Proof:
    """The tips and tool axes of one window, as the source leads them and as the target does."""

    def __init__(
        self, options: Options, context: gx.PassContext, source: Leading, target: Driven | Straight
    ) -> None:
        self.options, self.context = options, context
        self.source, self.target = source, target
        self.before, self.after = source.path, target.path
        self.events, self.given = self.after.events, list(self.after.given)
        self.drawn = self._drawn()
        self.owner = self._owners()
        self.kept = np.flatnonzero(~self.drawn)
        self.count = np.bincount(self.owner[self.kept], minlength=len(self.before))
        self.tip, self.lean, self.turn = 0.0, 0.0, 0.0
        self.worst = 0

    def _drawn(self) -> Flags:
        """Return which rows (n,) draw the tool back."""
        drawn = np.zeros(len(self.after), np.bool_)
        if self.options.retraction is not None:
            assert isinstance(self.target, Driven)
            found = Retracted(self.options, self.target)
            for rows in found.found:
                drawn[rows.start : rows.stop] = True
            inside = {id(event) for event in found.inside}
            self.events = tuple(event for event in self.events if id(event) not in inside)
            self.given = [g for g in self.given if g not in found.given]
        return drawn

    def _owners(self) -> Ints:
        """Return the row of the source for each row: of a line with more than one, one for one."""
        lines, first, old = np.unique(self.before.source, return_index=True, return_counts=True)
        line = np.searchsorted(lines, self.after.source)
        begins = np.append(True, np.diff(self.after.source) != 0)[: len(line)]
        nth = np.cumsum(~self.drawn) - 1
        nth = nth - nth[np.flatnonzero(begins)[np.cumsum(begins) - 1]]
        line = np.minimum(line, len(lines) - 1)
        return np.asarray(first[line] + np.minimum(nth, old[line] - 1))

    def run(self) -> None:
        """Measure `tip` (mm), `lean` and `turn` (degrees), with the row where the tip is worst."""
        after = self.after
        known = self._known()
        rapid = after.kind == gx.Kind.RAPID
        ends = np.flatnonzero(known & rapid)
        whole, none = np.ones(len(ends)), np.zeros(len(ends))
        self._compare((self.owner[ends], whole), (ends, whole), (none, none))
        lines, count = np.flatnonzero(known & ~rapid & ~self.drawn), self.count
        shared = count[self.owner] ** 2
        bend = self.source.bends[self.owner] / shared + self.target.bends
        lean = self.source.leans[self.owner] / shared + self.target.leans
        finest = LEAN_SHARE * np.radians(self.options.axis_tolerance)
        many = np.sqrt(np.maximum(bend / (SHARE * self.options.tolerance), lean / finest))
        many = np.maximum(np.ceil(many - 1e-9), 1.0).astype(np.int64)
        first = np.cumsum(count) - count
        nth = np.cumsum(~self.drawn) - 1 - first[self.owner]
        cuts = np.cumsum(many[lines] + 1) // AT_ONCE
        for rows in np.split(lines, np.flatnonzero(np.diff(cuts)) + 1):
            slack = bend[rows] / many[rows] ** 2, lean[rows] / many[rows] ** 2
            self._along(rows, many[rows], nth[rows], count[self.owner[rows]], slack)

    def _known(self) -> Flags:
        """Return which rows (n,) are compared: where the tool is known."""
        own = np.isin(self.after.form, (gx.Form.HOME, gx.Form.MACHINE))
        columns = [0, 1, 2, *self.target.place.columns]
        return np.asarray(np.isfinite(self.after.end[:, columns]).all(axis=1) & ~own)

    def _along(
        self, rows: Ints, many: Ints, nth: Ints, count: Ints, slack: tuple[Floats, Floats]
    ) -> None:
        """Compare places along moves, both ends among them."""
        row = np.repeat(np.arange(len(rows)), many + 1)
        at = np.arange(len(row)) - np.repeat(np.cumsum(many + 1) - many - 1, many + 1)
        part = at / many[row]
        whole = (nth[row] + part) / count[row]
        new, old = rows[row], self.owner[rows][row]
        self._compare((old, whole), (new, part), (slack[0][row], slack[1][row]))

    def _compare(
        self, old: tuple[Ints, Floats], new: tuple[Ints, Floats], slack: tuple[Floats, Floats]
    ) -> None:
        """Compare places; `slack` (mm, rad) is how far both may be from what is between them."""
        if not len(old[0]):
            return
        found = self.source.at(*old), self.target.at(*new)
        off = np.linalg.norm(found[0][0] - found[1][0], axis=1) + slack[0]
        off = np.where(np.isnan(off), np.inf, off)
        if off.max() > self.tip:
            self.tip, self.worst = float(off.max()), int(old[0][np.argmax(off)])
        lean = np.linalg.norm(found[0][1] - found[1][1], axis=1)
        self._note_lean(lean, slack[1], *old)
        if self.source.place.columns == self.target.place.columns:
            self.turn = max(self.turn, float(np.abs(found[0][2] - found[1][2]).max()))

    def measured(self) -> dict[str, float]:
        """Return what the certificate says besides tips, tool axes and angles."""
        return {}

    def _note_lean(self, lean: Floats, slack: Floats, rows: Ints, part: Floats) -> None:
        """Note how far (n,) rad tool axes are apart at parts of rows of the source."""
        self.lean = max(self.lean, float(np.degrees((lean + slack).max())))

    # --- the verdict ---

    def check(self, lean: float, turn: float) -> None:
        """Raise VerificationError for more than the tolerances, and for another speed."""
        self.run()
        if not self.tip <= self.options.tolerance:
            self._fail(f"the tip is {self.tip:.5f} mm off", self.worst)
        if not self.lean <= lean:
            self._fail(f"the tool axis is {self.lean:.5f} degrees off", self.worst)
        if not self.turn <= turn:
            self._fail(f"an axis has turned by {self.turn:.5f} degrees", self.worst)
        self._check_times()
        self._check_events()

    def _check_events(self) -> None:
        """Check that nothing happens but what does in the source, and where the tool is drawn back.

        What happens in the source stands before the moves that its row became.
        """
        begins = np.searchsorted(self.owner, [e.row for e in self.before.events]).tolist()
        events = zip(self.before.events, begins, strict=True)
        wanted = [(row, e.what, e.values, e.line) for e, row in events]
        if self.given or [(e.row, e.what, e.values, e.line) for e in self.events] != wanted:
            self._fail("something happens that the source does not have, or elsewhere", 0)

    def _check_times(self) -> None:
        """Check that moves are as many and as fast: feeds the same, inverse times in sum."""
        before, after = self.before, self.after
        rapid = after.kind == gx.Kind.RAPID
        timed = (after.feed_mode == gx.FeedMode.INVERSE_TIME) & ~rapid
        same = (before.source[self.owner] == after.source) & (np.diff(self.owner, prepend=0) >= 0)
        same &= self.drawn | (before.kind[self.owner] == after.kind)
        same &= timed | rapid | (after.feed == before.feed[self.owner])
        same &= timed | (before.feed_mode[self.owner] == after.feed_mode) | rapid
        gone = self.count == 0
        gone &= self._ways() > STILL
        if not same.all() or gone.any():
            row = int(np.argmax(gone)) if gone.any() else int(self.owner[np.argmin(same)])
            self._fail("a move or its feed has changed", row)
        rows = np.flatnonzero(timed & ~self.drawn)
        owner = self.owner[rows]
        time, wanted = 1.0 / after.feed[rows], self._times()[owner] / self.count[owner]
        least = np.where(before.feed_mode[owner] == after.feed_mode[rows], 0.0, self._least()[rows])
        wanted = np.maximum(wanted, least)
        wrong = owner[~(np.abs(time / wanted - 1.0) <= SAME_TIME)]
        if len(wrong):
            self._fail("the time of a move has changed", int(wrong[0]))

    def _least(self) -> Floats:
        """Return the times (min) that axes take at least for moves of the target."""
        step = np.abs(self.target.end - self.target.start)
        found = np.zeros(len(step))
        machine = self.context.machine
        axes = machine.axes.items() if machine is not None and self.options.to_axes else ()
        for letter, axis in axes:
            if axis.max_speed is not None:
                column = self.after.axes.index(letter)
                found = np.fmax(found, step[:, column] / axis.max_speed)
        return found

    def _ways(self) -> Floats:
        """Return how far the moves of the source go: mm of the tip, degrees where it rests."""
        step = self.source.end - self.source.start
        way = np.sqrt((step[:, :3] ** 2).sum(axis=1))
        turned = np.sqrt((self.source.place.angles(step) ** 2).sum(axis=1))
        return np.asarray(np.where(way < STILL, turned, way))

    def _times(self) -> Floats:
        """Return the times (min) of the moves of the source."""
        before = self.before
        minutes = before.feed_mode == gx.FeedMode.PER_MINUTE
        return np.asarray(np.where(minutes, self._ways(), 1.0) / before.feed)

    def _fail(self, message: str, row: int) -> None:
        line = int(self.before.source[row]) + 1 if len(self.before) else 0
        hint = "nothing was written; this is a bug of gcxform or of a plugin"
        raise gx.VerificationError.one("GX606", message, gx.Location("", line), hint)
