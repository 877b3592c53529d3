"""The proof of `rtcp` for programs with tool vectors: the tool points where I, J and K say.

    k0, k1  (3,) unit vectors that the program says at both ends of a block; w rad between them
    a'      (3,) the tool axis as the axes drive it at part s of the block; q' (m,) its angles
    c(s)    (3,) the point of the great circle from k0 to k1
    e       degrees: half of the last decimals of all angles

Claimed: |a'(1) - k1| <= e, and |a' - c(s)| <= axis tolerance on great circles. With angles in
proportion: q'(s) = q'(0) + s (q'(1) - q'(0)) to half of the last decimal, no angle turns by more
than 180 degrees in a block, and |a' - c(s)| <= w + 2 e, with room for the places between which it
is not looked at (`proof.py`).

Tips, tool axes and times are compared as ever, with the vectors of the source in the place of its
angles. At the ends of blocks no more is left than the angles are rounded by. Between them the tool
axis is on a great circle; or, where angles change in proportion, they do, by no more than half a
turn, and the tool axis is never farther from the circle than from one end of it to the other: so no
axis went round the other way, and none flipped over. Rows outside of G43.5 are those of the source.
"""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.proof.driven import Driven, Pointed
from gcxform_plugins.passes.rtcp.proof.proof import LEAN_SHARE, STILL, Proof

ROOM = 1e-9  # degrees
HALF_A_TURN = 180.0


class PointedProof(Proof):
    """The proof of one window; `left` (n, axes) are axes that the control leaves where they are.

    `lean` counts the ends of blocks too, `ends` (degrees) these alone. With angles in proportion
    `lean` is that of the ends, `beside` how far the tool axis is from the great circle between
    them, and `round` how much farther it is than these are apart.
    """

    def __init__(
        self,
        options: Options,
        context: gx.PassContext,
        source: Pointed,
        target: Driven,
        left: Flags,
    ) -> None:
        self.left = left
        self.vectors = source.vectors
        self.circles = options.great_circles
        self.turned = np.degrees(source.vectors.turn())
        self.ends, self.beside, self.round = 0.0, 0.0, 0.0
        super().__init__(options, context, source, target)

    def _known(self) -> Flags:
        return self.vectors.on[self.owner]

    def _note_lean(self, lean: Floats, slack: Floats, rows: Ints, part: Floats) -> None:
        degrees = np.degrees(np.where(np.isnan(lean), np.inf, lean))
        end = part == 1.0
        self.ends = max(self.ends, float(degrees[end].max(initial=0.0)))
        if self.circles:
            super()._note_lean(np.radians(degrees), slack, rows, part)
            return
        self.lean = self.ends
        cut = self.before.kind[rows] != gx.Kind.RAPID
        beside = (degrees + np.degrees(slack))[cut]
        self.beside = max(self.beside, float(beside.max(initial=0.0)))
        self.round = max(self.round, float((beside - self.turned[rows[cut]]).max(initial=0.0)))

    def _steps(self) -> Floats:
        """Return the last decimals (m,) of the angles, degrees."""
        letters = self.target.place.chain.letters
        return np.array([10.0 ** -self.context.decimals_of_angle(a) for a in letters])

    def measured(self) -> dict[str, float]:
        """Return what the certificate says besides."""
        return {} if self.circles else {"tool axis beside its great circle, degrees": self.beside}

    # --- the verdict ---

    def check(self, lean: float, turn: float) -> None:
        """Raise VerificationError for more than the tolerances, and for another speed."""
        self._check_outside()
        super().check(lean, turn)
        if (self.vectors.on & (self.count == 0) & (self.turned > STILL)).any():
            self._fail("a turn of the tool is missing", self.worst)
        rounding = float(self._steps().sum()) / 2.0 + ROOM
        if not self.ends <= rounding:
            self._fail(f"the tool axis is {self.ends:.5f} degrees off its vector", self.worst)
        if self.circles:
            return
        finest = LEAN_SHARE * self.options.axis_tolerance
        if not self.round <= 2.0 * (rounding + finest):
            self._fail(f"the tool axis goes {self.round:.5f} degrees round about", self.worst)
        self._check_proportion()

    def _check_outside(self) -> None:
        """Check that rows outside of sections are there, and go where they are said to."""
        outside = np.flatnonzero(~self.vectors.on[self.owner])
        lone = np.flatnonzero(~self.vectors.on)
        same = np.array_equal(self.owner[outside], lone)
        said, found = self.before.end[lone], self.after.end[outside] if same else np.empty((0, 0))
        stays = self.after.end[np.maximum(outside - 1, 0)]
        if same:
            said = np.where(self.left[lone], stays, said)
            gap = np.abs(np.where(np.isnan(said) & np.isnan(found), 0.0, said - found))
            same = bool((gap <= ROOM).all())
        if not same:
            self._fail("a move outside of G43.5 has changed", int(lone[0]) if len(lone) else 0)

    def _check_proportion(self) -> None:
        """Check that angles change in proportion within a block, and by half a turn at most."""
        angles = self.target.place.angles
        rows = np.flatnonzero(self._known() & (self.after.kind != gx.Kind.RAPID))
        owner = self.owner[rows]
        first = np.append(True, np.diff(owner) != 0)[: len(rows)]
        last = np.append(np.diff(owner) != 0, True)[: len(rows)]
        block = np.cumsum(first) - 1
        begin = angles(self.target.start[rows[first]])[block]
        way = angles(self.target.end[rows[last]])[block] - begin
        nth = np.arange(len(rows)) - np.flatnonzero(first)[block] + 1
        part = (nth / self.count[owner])[:, None]
        off = np.abs(angles(self.target.end[rows]) - begin - part * way)
        wrong = ~(off <= 0.5 * self._steps() + ROOM).all(axis=1)
        wrong |= ~(np.abs(way) <= HALF_A_TURN + self._steps() + ROOM).all(axis=1)
        if wrong.any():
            self._fail("angles do not change in proportion", int(owner[np.argmax(wrong)]))
