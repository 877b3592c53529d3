"""Whether a program for another machine keeps tool and speed: the proof of `rtcp`.

It has the forward models of both machines, and no search. A move of the source is followed from
end to end beside the moves that it became, which share it evenly; at so many places that between
them each tip is within a tenth of the tolerance of its chord. There both tools are compared.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import gcxform as gx
from gcxform_plugins.passes.rtcp_place import Place
from gcxform_plugins.passes.rtcp_undoing import SHARE, Undoing

if TYPE_CHECKING:
    from gcxform_plugins.passes.rtcp import Rtcp

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

AT_ONCE = 200_000  # places compared at once
SAME_TIME = 1e-9  # relative


class Proof:
    """The tips and tool axes of one window, on the source machine and on the target."""

    def __init__(
        self, step: Rtcp, before: gx.Toolpath, after: gx.Toolpath, source: Place, target: Place
    ) -> None:
        self.step, self.before, self.after = step, before, after
        self.source, self.target = source, target
        self.owner = self._owners()
        self.tip, self.lean, self.turn = 0.0, 0.0, 0.0
        self.worst = 0

    def _owners(self) -> Ints:
        """Return the row of the source for each row: of a line with more than one, one for one."""
        lines, first, old = np.unique(self.before.source, return_index=True, return_counts=True)
        line = np.searchsorted(lines, self.after.source)
        begins = np.append(True, np.diff(self.after.source) != 0)[: len(line)]
        nth = np.arange(len(line)) - np.flatnonzero(begins)[np.cumsum(begins) - 1]
        line = np.minimum(line, max(len(lines) - 1, 0))
        return np.asarray(first[line] + np.minimum(nth, old[line] - 1))

    def run(self) -> None:
        """Measure `tip` (mm), `lean` and `turn` (degrees), with the row where the tip is worst."""
        before, after = self.before, self.after
        own = np.isin(after.form, (gx.Form.HOME, gx.Form.MACHINE))
        known = np.isfinite(after.end[:, [0, 1, 2, *self.target.columns]]).all(axis=1) & ~own
        rapid = after.kind == gx.Kind.RAPID
        self._ends(np.flatnonzero(known & rapid))
        lines = np.flatnonzero(known & ~rapid)
        bends = [self._bends(p, path) for p, path in ((self.source, before), (self.target, after))]
        count = np.bincount(self.owner, minlength=len(before))
        bend = bends[0][self.owner] / count[self.owner] ** 2 + bends[1]
        many = np.ceil(np.sqrt(bend / (SHARE * self.step.tolerance)) - 1e-9)
        many = np.maximum(many, 1.0).astype(np.int64)
        first = np.cumsum(count) - count
        nth = np.arange(len(after)) - first[self.owner]
        cuts = np.cumsum(many[lines] + 1) // AT_ONCE
        for rows in np.split(lines, np.flatnonzero(np.diff(cuts)) + 1):
            self._along(rows, many[rows], nth[rows], count[self.owner[rows]], bend[rows])

    def _bends(self, place: Place, path: gx.Toolpath) -> Floats:
        return Undoing(self.step, path, place, to_tips=True).bends()

    def _ends(self, rows: Ints) -> None:
        """Compare where rapids end."""
        owner = self.owner[rows]
        self._compare(
            self.before.end[owner], owner, self.after.end[rows], rows, np.zeros(len(rows))
        )

    def _along(self, rows: Ints, many: Ints, nth: Ints, count: Ints, bend: Floats) -> None:
        """Compare places along moves, both ends among them."""
        row = np.repeat(np.arange(len(rows)), many + 1)
        at = np.arange(len(row)) - np.repeat(np.cumsum(many + 1) - many - 1, many + 1)
        part = at / many[row]
        whole = (nth[row] + part) / count[row]
        new, old = rows[row], self.owner[rows][row]
        sides = (
            (self.before.start[old], self.before.end[old], whole),
            (self.after.start[new], self.after.end[new], part),
        )
        source, target = (a + u[:, None] * (b - a) for a, b, u in sides)
        self._compare(source, old, target, new, bend[row] / many[row] ** 2)

    def _compare(self, source: Floats, old: Ints, target: Floats, new: Ints, slack: Floats) -> None:
        if not len(old):
            return
        found = []
        for place, at, rows in ((self.source, source, old), (self.target, target, new)):
            angles = place.angles(at)
            tips = place.tips_of(at[:, :3], angles, rows)
            found.append((tips, place.chain.tool_axis(angles), angles))
        off = np.linalg.norm(found[0][0] - found[1][0], axis=1) + slack
        off = np.where(np.isnan(off), np.inf, off)
        if off.max() > self.tip:
            self.tip, self.worst = float(off.max()), int(old[np.argmax(off)])
        lean = np.linalg.norm(found[0][1] - found[1][1], axis=1).max()
        self.lean = max(self.lean, float(np.degrees(lean)))
        if self.source.columns == self.target.columns:
            self.turn = max(self.turn, float(np.abs(found[0][2] - found[1][2]).max()))

    # --- the verdict ---

    def check(self, lean: float, turn: float) -> None:
        """Raise VerificationError for more than the tolerances, and for another speed."""
        self.run()
        if not self.tip <= self.step.tolerance:
            self._fail(f"the tip is {self.tip:.5f} mm off", self.worst)
        if not self.lean <= lean:
            self._fail(f"the tool axis is {self.lean:.5f} degrees off", self.worst)
        if not self.turn <= turn:
            self._fail(f"an axis has turned by {self.turn:.5f} degrees", self.worst)
        self._check_times()

    def _check_times(self) -> None:
        """Check that moves are as many and as fast: feeds the same, inverse times in sum."""
        before, after = self.before, self.after
        same = (before.source[self.owner] == after.source) & (before.kind[self.owner] == after.kind)
        same &= before.feed_mode[self.owner] == after.feed_mode
        timed = (after.feed_mode == gx.FeedMode.INVERSE_TIME) & (after.kind != gx.Kind.RAPID)
        fed = (after.kind != gx.Kind.RAPID) & ~timed
        same &= ~fed | (after.feed == before.feed[self.owner])
        if not same.all() or len(np.unique(self.owner)) != len(before):
            self._fail("a move or its feed has changed", int(self.owner[np.argmin(same)]))
        time = np.bincount(self.owner[timed], 1.0 / after.feed[timed], len(before))
        rows = np.unique(self.owner[timed])
        wrong = rows[np.abs(time[rows] * before.feed[rows] - 1.0) > SAME_TIME]
        if len(wrong):
            self._fail("the time of a move has changed", int(wrong[0]))

    def _fail(self, message: str, row: int) -> None:
        line = int(self.before.source[row]) + 1 if len(self.before) else 0
        hint = "nothing was written; this is a bug of gcxform or of a plugin"
        raise gx.VerificationError.one("GX606", message, gx.Location("", line), hint)
