"""Whether tips stay where axes bring them, at angles that are rounded: `to-tip` and `repost`.

In the notation of `proof.py`, claimed for every s of a cut in which axes are turned, and checked in
the same way: |p - p'| <= tolerance, of which p' is the tip at angles as they are written.

What is written is compared with the source in positions of axes. These stand where they would have
stood, whatever the angles are rounded to; the tip does not, by the lever that it has about each
axis. So here the tips of both are followed beside each other, before anything is written.

They are compared at as many places as `undoing.py` says. Which piece belongs to which row is told
by the cutting, and need not be trusted: with a wrong row the tips would be apart.
"""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Ints
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.place import turned_at
from gcxform_plugins.passes.rtcp.proof.driven import Driven, Straight
from gcxform_plugins.passes.rtcp.proof.proof import Proof


class TipProof(Proof):
    """The same proof of tips alone: kinds, feeds and events are compared once it is written."""

    def __init__(
        self,
        options: Options,
        context: gx.PassContext,
        source: Driven,
        target: Driven | Straight,
        owner: Ints,
    ) -> None:
        """Take the row of the source for each row: where it is a wrong one, tips are far apart."""
        self.given_owner = owner
        super().__init__(options, context, source, target)

    def _owners(self) -> Ints:
        return self.given_owner

    def _known(self) -> Flags:
        """Return which rows (n,) are compared: where axes are turned, and the tool is known."""
        place, rapid = self.target.place, self.after.kind == gx.Kind.RAPID
        sides = self.target.start, self.target.end
        turned = turned_at(place.angles(sides[0])) | turned_at(place.angles(sides[1]))
        starts = np.isfinite(sides[0][:, [0, 1, 2, *place.columns]]).all(axis=1)
        return np.asarray(super()._known() & turned & (starts | rapid))

    def check_tips(self) -> None:
        """Raise VerificationError where the tip is farther off than the tolerance."""
        if not len(self.after):
            return
        self.run()
        if not self.tip <= self.options.tolerance:
            self._fail(f"the tip is {self.tip:.5f} mm off", self.worst)
