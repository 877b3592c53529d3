"""How `rtcp` finds angles for a program that says the tool axis as a vector (G43.5 with I, J, K).

Attitude and turns are chosen as for another machine, but over a whole section from G43.5 to G49,
which begins with all axes at 0. In rapids that do not turn the tool no axis leaps, so a tool that
is drawn back keeps its attitude. Between the ends of blocks the tool axis goes on a great circle,
or the axes turn in proportion. What is outside of sections has positions of axes, and stays.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.rtcp.forward.choice import TURN
from gcxform_plugins.passes.rtcp.forward.great_circles import OnCircles
from gcxform_plugins.passes.rtcp.forward.moving import STILL
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.rtcp.tool_vectors import Vectors, without_left

MOST = 179.0  # degrees that the tool turns in a block: of half a turn nobody knows the way
LEAST = 0.5  # degrees; where no axis turns by as much in a block, none leaps in it
PLAIN = (gx.Form.PLAIN,)
OWN = (gx.Form.PLAIN, gx.Form.HOME, gx.Form.MACHINE)
TO_ZERO = "before G43.5, draw the tool back and turn them to 0"
END = "before it, draw the tool back along its axis and end G43.5 with G49"


class Pointing(OnCircles):
    """Of tips and vectors the axes of a machine, the tool axis on great circles between blocks."""

    def __init__(
        self,
        options: Options,
        path: gx.Toolpath,
        context: gx.PassContext,
        source: Place,
        target: Place,
    ) -> None:
        super().__init__(options, without_left(path), context, source, target)
        self.left = np.isinf(path.end)
        self.vectors = Vectors.of(path)
        self.turns = np.nan_to_num(np.degrees(self.vectors.turn()))
        self.known &= self.vectors.on
        self.said: Floats | None = None  # angles (n, m) in proportion, at the ends of rows

    # --- what is refused ---

    def _check(self) -> None:
        for code, where, message, hint in self._objections():
            self._refuse(code, where, message, hint)
        self._check_feeds(self.turns > STILL)

    def _objections(self) -> Iterator[tuple[str, Flags, str, str]]:
        """Yield codes, rows that are wrong, messages and hints."""
        path, on = self.path, self.vectors.on
        yield from self._outside()
        angles = self.place.angles(path.end)
        unknown = on & ~np.isfinite(angles).all(axis=1)
        letters = ", ".join(f"{letter} = 0.0" for letter in self.place.chain.letters)
        said = f"{TO_ZERO}; or say start = {{ {letters} }} in [input], if they stand there"
        yield "GX311", unknown, "where the rotary axes stand at G43.5 is not known", said
        turned = on & (angles != 0.0).any(axis=1)
        yield "GX330", turned, "G43.5 begins while axes are turned", TO_ZERO
        lost = on & ~np.isfinite(path.end[:, :3]).all(axis=1)
        yield "GX311", lost, "where the tip stands is not known here", "program X, Y and Z before"
        cut = on & self.cuts
        lost = cut & ~np.isfinite(self.start[:, :3]).all(axis=1)
        yield "GX311", lost, "where this cut begins is not known", "program X, Y and Z before"
        form = on & ~np.isin(path.form, PLAIN)
        yield "GX330", form, "this is no plain move", END
        yield from self._lengths()
        half = cut & (self.turns > MOST)
        hint = "program a point on the way"
        yield "GX330", half, "the tool turns by half a turn, either way round", hint
        told = cut & (path.feed_mode == gx.FeedMode.PER_MINUTE) & (self.turns > STILL)
        rests = told & (np.linalg.norm((self.end - self.start)[:, :3], axis=1) < STILL)
        message = "the tool turns about its tip, and what its feed counts is not known"
        yield "GX320", rests, message, "write this block in G93"

    def _outside(self) -> Iterator[tuple[str, Flags, str, str]]:
        """Yield what is wrong outside of sections."""
        path, on = self.path, self.vectors.on
        cut = ~on & (path.kind != gx.Kind.RAPID)
        message = "a cut where the control does not follow the tip"
        yield "GX330", cut, message, "write G43.5 with the tool length before"
        form = ~on & ~np.isin(path.form, OWN)
        yield "GX330", form, "this is no plain move", "leave it out of the program"
        inside = np.asarray(np.isnan(self.vectors.start).any(axis=1))
        message = "a window ends within G43.5"
        yield "GX330", inside, message, "write G49 in a block of its own"

    def _lengths(self) -> Iterator[tuple[str, Flags, str, str]]:
        """Yield rows without a tool length, and those in which it changes within a section."""
        place, on = self.place, self.vectors.on
        none = ~place.called
        message = "no tool length is in force"
        yield "GX330", np.asarray(on & none), message, "call it with H in the block of G43.5"
        changed = on & np.append(False, on[:-1])[: len(on)] & (place.which != place.which_before)
        yield "GX330", changed, "the tool length changes under G43.5", END

    # --- which angles ---

    def _choose(self) -> None:
        super()._choose()
        if self.options.great_circles:
            rows = self._turning()
            self._refuse_leaps(rows[self._turn(rows) > LEAST])

    def _turn(self, rows: Ints) -> Floats:
        """Return by how much (n,) degrees the tool turns in rows, or an axis if that is more."""
        chain = self.target.chain
        one, other = (gx.attitudes(chain, side).angle[:, 0] for side in self._vectors(rows))
        way = np.abs(np.remainder(other - one + TURN / 2, TURN) - TURN / 2)
        return np.asarray(np.maximum(self.turns[rows], way.max(axis=1)))

    def _holds(self, rows: Ints) -> Flags:
        """Return in which rows no axis may leap: in cuts, and in rapids that turn nothing."""
        return np.asarray(super()._holds(rows) | (self.turns[rows] <= STILL))

    def _groups(self) -> list[Ints]:
        """Return the rows of sections."""
        super()._groups()
        rows = np.flatnonzero(self.known)
        begins = np.flatnonzero(np.diff(rows, prepend=-2) > 1)
        return [group for group in np.split(rows, begins) if len(group)]

    def _vectors(self, row: Ints) -> tuple[Floats, Floats]:
        return self.vectors.start[row], self.vectors.end[row]

    # --- positions ---

    def _turning(self) -> Ints:
        return np.flatnonzero(self.cuts & self.known & (self.turns > 0.0))

    def _entry(self) -> Floats:
        return self.path.entry.copy()

    def _leave(self, result: Floats, row: Ints) -> None:
        """Let rows outside of sections go where they are said to; axes that were left stay."""
        outside = np.flatnonzero(~self.vectors.on[row])
        result[outside] = self.path.end[row[outside]]
        for at in outside[self.left[row[outside]].any(axis=1)].tolist():
            before = result[at - 1] if at else self._entry()
            result[at] = np.where(self.left[row[at]], before, result[at])


class InProportion(Pointing):
    """The same, with angles that change in proportion between the ends of blocks."""

    def _choose(self) -> None:
        """Choose angles along the vectors; those at the ends of blocks are taken."""
        super()._choose()
        said = np.zeros((len(self.path), len(self.target.chain.axes)))
        rows = np.flatnonzero(self.known)
        said[rows] = super()._angles(self.end[rows], rows, np.ones(len(rows)))
        self.said = said

    def _angles(self, positions: Floats, row: Ints, part: Floats, after: bool = False) -> Floats:
        if self.said is None:
            return super()._angles(positions, row, part, after)
        one, other = np.where(row[:, None] > 0, self.said[row - 1], 0.0), self.said[row]
        part = np.where(self.cuts[row], part, 1.0)[:, None]
        return np.where(part == 1.0, other, self.target.written(one + part * (other - one)))

    def _far(self, source: tuple[Floats, ...], target: tuple[Floats, ...], row: Ints) -> Floats:
        """Return how far (n,) mm the tip leaves its line; the tool axis is where it has to be."""
        return self._off_line(source, target, row)
