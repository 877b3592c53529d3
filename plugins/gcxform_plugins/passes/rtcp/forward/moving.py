"""How a program gets other angles: those of a calibrated machine, or of another one.

Of each place of the source path the tip and the tool axis are known, by the machine that it was
posted for. The angles that give the same tool axis on the target are rounded as they are written,
and X, Y and Z brought to the tip with them. Between two such places both machines move all axes in
proportion, so both tips are within a bound of the same chord, and both tool axes of the same arc.
"""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.rtcp.forward.choice import DRAWN_BACK, WHY, Choice, NoWayError, nearest
from gcxform_plugins.passes.rtcp.forward.correction_bound import bend_of_correction
from gcxform_plugins.passes.rtcp.forward.cutting import Cutting
from gcxform_plugins.passes.rtcp.forward.retracting import Drawing, Retract, inserted, with_lines
from gcxform_plugins.passes.rtcp.forward.ways import Between
from gcxform_plugins.passes.rtcp.options import Options
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.shared.tip_bound import leaving

NEXT = 1e-9  # degrees; rows that do not turn still follow one another
NEAR = 1e-7  # part of a row
SAMPLE = 5.0  # degrees; how far the axes of the source turn between two points of the search
STILL = 1e-7  # mm, degrees; what moves by less stands still


class Moving(Cutting):
    """The work on one window, of axes of the source machine those of the target."""

    def __init__(
        self,
        options: Options,
        path: gx.Toolpath,
        context: gx.PassContext,
        source: Place,
        target: Place,
    ) -> None:
        super().__init__(options, path, context, source, Between(source, to_axes=False))
        self.target = target
        self.known = np.isfinite(self.end[:, [0, 1, 2, *source.columns]]).all(axis=1) & ~self.own
        self.starts_known = np.isfinite(self.start[:, [0, 1, 2, *source.columns]]).all(axis=1)
        self.retracts = np.zeros(0)
        self.first, self.count = np.zeros((2, len(path)))
        self.samples = np.zeros((1, len(target.chain.axes)))
        self.blocks_may = (path.feed_mode == gx.FeedMode.INVERSE_TIME) & self.cuts
        self.blocks_may &= ~path.blocks.leaves[path.block]

    def run(self) -> tuple[gx.Toolpath, Ints]:
        """Return the path of the target, and of which row (n,) each of its rows is a piece."""
        self._check()
        self._check_lines()
        self._choose()
        path = self.path
        pieces = np.where(self.nowhere, 0, self._pieces())
        row = np.repeat(np.arange(len(path)), pieces)
        source, part = self._cut(pieces, row), self._parts(pieces, row)
        end = np.asfortranarray(self._moved(source, row, part))
        entry = self._entry()
        feeds = self._feeds(pieces, row, np.concatenate([entry[None, :], end]))
        feeds |= {"kind": path.kind[row], "form": path.form[row]}
        retracts = self._retracts(source, row, part, end)
        for name, column in feeds.items():
            feeds[name] = inserted(column, retracts, name)
        row, end = inserted(row, retracts, "row"), inserted(end, retracts, "end")
        drawn = inserted(np.zeros(len(part), np.bool_), retracts, "drawn")
        pieces = np.bincount(row, minlength=len(path))
        self._leave(end, row)
        self._check_reach(end, row, drawn)
        nth = path.nth[row] + np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
        new = path.with_rows(pieces, end=np.asfortranarray(end), nth=nth, **feeds)
        new = with_lines(new, retracts)
        others = "".join(a for a in self.place.chain.letters if a not in self.target.chain.letters)
        return new.replace(entry=entry, left_out=path.left_out + others), row

    # --- positions ---

    def _rounded(self, positions: Floats) -> Floats:
        """Return positions as they are: angles of the source are not written."""
        return positions.copy()

    def _parts(self, pieces: Ints, row: Ints) -> Floats:
        """Return at which part (n,) of its row each piece ends."""
        nth = np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
        return np.asarray(nth / np.maximum(pieces[row], 1))

    def _tips(self, positions: Floats, row: Ints) -> Floats:
        """Return where tips (n, 3) are on the workpiece."""
        return self.place.tips_of(positions[:, :3], self.place.angles(positions), row)

    def _axis(self, positions: Floats, row: Ints, part: Floats) -> Floats:
        """Return the tool axes (n, 3) at positions, which are parts of rows."""
        return self.place.chain.tool_axis(self.place.angles(positions))

    def _moved(self, positions: Floats, row: Ints, part: Floats, after: bool = False) -> Floats:
        """Return the positions (n, axes) of the target for those of the source.

        Where the tool is drawn back they are those before it, or those after.
        """
        tips = self._tips(positions, row)
        angles = self._angles(positions, row, part, after)
        found = positions.copy()
        found[:, self.place.columns] = np.nan
        found[:, self.target.columns] = angles
        found[:, :3] = self.target.axes_of(tips, angles, row)
        return found

    def _angles(self, positions: Floats, row: Ints, part: Floats, after: bool = False) -> Floats:
        """Return the angles (n, m) as written; 0 where X, Y or Z is not known yet, nan at home."""
        angles = np.where(self.own[row][:, None], np.nan, np.zeros((len(row), 2)))
        here = np.flatnonzero(self.known[row])
        guess = self._guess(positions[here], row[here], part[here], after)
        axis = self._axis(positions[here], row[here], part[here])
        found = nearest(self.target.chain, axis, guess)
        angles[here] = self.target.written(self._mixed(found, positions[here], row[here]))
        return angles

    def _mixed(self, angles: Floats, positions: Floats, row: Ints) -> Floats:
        """Return the angles that are taken for those which give the tool axis exactly."""
        return angles

    def _entry(self) -> Floats:
        """Return where the target stands before the first row, if that is known."""
        entry = self.path.entry[None, :].copy()
        said = self.place.angles(entry)
        whole = bool(np.isfinite(entry[:, :3]).all() and np.isfinite(said).all())
        turned = bool((said != 0.0).any())
        angles = np.where(turned, np.nan, np.zeros((1, 2)))
        if whole:
            angles = self._entered(entry)
        first = np.array([0])
        tips = self.place.tips_of(entry[:, :3], said, first) if self._drives else entry[:, :3]
        found = self.target.axes_of(tips, angles, first)
        if np.isnan(angles).any() and turned:
            found[:] = np.nan
        entry[:, :3] = found
        entry[:, self.place.columns] = np.nan
        entry[:, self.target.columns] = angles
        return np.asarray(entry[0])

    _drives = True
    """Whether the source is in axes, and not in tips."""

    def _entered(self, entry: Floats) -> Floats:
        """Return the angles (1, m) before the first row, which is a rapid from wherever it is."""
        said = self.place.angles(entry)
        return np.where(bool((said != 0.0).any()), np.nan, np.zeros((1, 2)))

    def _leave(self, result: Floats, row: Ints) -> None:
        """Let moves to the machine's own points go where they are said to; other axes stay."""
        for at in np.flatnonzero(self.own[row]).tolist():
            before = self.path.start[row[at]]
            stays = np.abs(self.path.end[row[at]] - before) < STILL
            here = result[at - 1] if at else self._entry()
            result[at] = np.where(stays, here, self.path.end[row[at]])
            result[at, self.target.columns] = here[self.target.columns]
            result[at, self.place.columns] = np.where(
                np.isin(self.place.columns, self.target.columns),
                result[at, self.place.columns],
                np.nan,
            )

    # --- which angles ---

    def _choose(self) -> None:
        """Choose the angles at places along all cuts, each by itself from axes at 0.

        The row i goes from place `first[i]` of the `samples` to place `first[i] + count[i]`, which
        is between two of them where the row is short.
        """
        found, total = [], 0
        self.first, self.count = np.zeros((2, len(self.path)))
        for rows in self._groups():
            angles, place = self._group(rows)
            place += total
            self.first[rows] = np.append(place[0] - 1.0, place[:-1])
            self.count[rows] = place - self.first[rows]
            found.append(angles)
            total = round(float(place[-1])) + 1
        self.samples = np.concatenate([*found, np.zeros((1, len(self.target.chain.axes)))])

    def _groups(self) -> list[Ints]:
        """Return the rows of cuts, each with the rapids that lead to it."""
        rapid = self.path.kind == gx.Kind.RAPID
        rows = np.flatnonzero(self.known)
        begins = np.flatnonzero(rapid[rows] & ~np.append(True, rapid[rows][:-1])[: len(rows)])
        groups = [group for group in np.split(rows, begins) if len(group)]
        message = "a cut begins where no rapid has led to"
        hint = "begin it with G0 to where it starts, with all axes"
        lost = np.zeros(len(self.path), np.bool_)
        lost[rows[:1]] = True
        lost[1:] |= ~self.known[:-1]
        self._refuse("GX330", lost & self.known & ~rapid, message, hint)
        return groups

    def _group(self, rows: Ints) -> tuple[Floats, Floats]:
        """Return the angles at places of a cut, and at which place each row ends.

        Rows that turn far have several places, and of short ones that follow each other some have
        none.
        """
        turn, rapid = self._turn(rows), self.path.kind[rows] == gx.Kind.RAPID
        turn[rapid] = 0.0
        along = np.cumsum(turn)
        cells = np.floor(2.0 * along / SAMPLE)
        far, last = turn > SAMPLE, np.append(rapid[1:] | (turn[1:] > SAMPLE), True)
        kept = rapid | far | last | (np.diff(cells, append=np.inf) > 0.0)
        count = np.where(kept, np.maximum(np.ceil(turn / SAMPLE), 1.0), 0.0).astype(np.int64)
        row, pieces = np.repeat(rows, count), np.zeros(len(self.path), np.int64)
        pieces[rows] = count
        part = self._parts(pieces, row)
        axis = self._axis(self._cut(pieces, row), row, part)
        angles, retracts = self._choice(axis, np.repeat(self._holds(rows), count), row)
        self.retracts = np.append(self.retracts, row[retracts] + part[retracts])
        inner = [at for at in retracts if part[at] < 1.0]
        self.least[row[inner]] = pieces[row[inner]]
        along += NEXT * np.arange(len(rows))
        ends = np.cumsum(count)[kept] - 1.0
        return angles, np.interp(along, along[kept], ends)

    def _turn(self, rows: Ints) -> Floats:
        """Return by how much (n,) degrees the tool turns in rows."""
        turn = np.abs(self.place.angles(self.end[rows] - self.start[rows])).max(axis=1)
        return np.asarray(np.nan_to_num(turn))

    def _holds(self, rows: Ints) -> Flags:
        """Return in which rows (n,) no axis may leap."""
        return np.asarray(self.path.kind[rows] != gx.Kind.RAPID)

    def _choice(self, axis: Floats, cut: Flags, row: Ints) -> tuple[Floats, list[int]]:
        """Return the angles of the target for tool axes along the source. Raises InputError.

        With them come the numbers of the places where the tool is drawn back; nowhere, if there is
        a way without that.
        """
        may = self.blocks_may[row]
        for allowed in (None, may):
            try:
                choice = Choice(self.target.chain, axis, cut, allowed)
                return choice.run(np.zeros(2)), choice.retracts
            except NoWayError as problem:
                trouble = problem
            if self.options.retraction is None or trouble.trouble not in DRAWN_BACK:
                break
        code, message, hint = WHY[trouble.trouble]
        if self.options.target is None:
            hint = hint.rpartition('retract = "20 mm"; or ')[2]
        raise self.path.refuse(code, row[trouble.at : trouble.at + 1], message, hint)

    def _guess(self, positions: Floats, row: Ints, part: Floats, after: bool = False) -> Floats:
        """Return the angles (n, m) between those that were chosen, at parts of rows."""
        rapid = self.path.kind[row] == gx.Kind.RAPID
        part = np.where(rapid, 1.0, part)
        along = self.first[row] + part * self.count[row]
        along += np.searchsorted(self.retracts, row + part + (NEAR if after else -NEAR))
        low = np.maximum(np.floor(along + 1e-9).astype(np.int64), 0)
        high = np.minimum(low + 1, len(self.samples) - 1)
        share = np.clip(along - low, 0.0, 1.0)[:, None]
        return np.asarray((1.0 - share) * self.samples[low] + share * self.samples[high])

    def _retracts(self, source: Floats, row: Ints, part: Floats, end: Floats) -> list[Retract]:
        """Return the moves that draw the tool back, of pieces from whose ends they begin."""
        found = []
        inch = self.path.blocks.inch[self.path.block]
        message = "retract-lines and return-lines are in mm, and this block is in inches"
        where = np.isin(np.arange(len(inch)), np.floor(self.retracts - NEAR)) & inch
        if self.options.retraction is not None and self.options.retraction.lines.in_mm:
            self._refuse("GX330", where, message, gx.put_before("metric"))
        for at in np.searchsorted(row + part, self.retracts - NEAR).tolist():
            here = slice(at, at + 1)
            leaves = self._moved(source[here], row[here], part[here], after=True)[0]
            assert self.options.retraction is not None
            drawn = Drawing(self.target, self.options.retraction, int(row[at]))
            found.append(drawn.retract(at, (end[at], leaves)))
        return found

    # --- pieces ---

    def _off(self, sides: tuple[Floats, Floats], pieces: Ints, row: Ints) -> Floats:
        """Return how far (n,) mm the tip, and in its proportion the tool axis, can be off."""
        part = self._parts(pieces, row)
        begin = part - 1.0 / pieces[row]
        moved = self._moved(sides[0], row, begin, after=True), self._moved(sides[1], row, part)
        return self._far(sides, moved, row)

    def _far(self, source: tuple[Floats, ...], target: tuple[Floats, ...], row: Ints) -> Floats:
        """Return how far (n,) mm the tips of both machines are from one another in pieces."""
        far, lean = np.zeros(len(row)), np.zeros(len(row))
        for place, sides in ((self.place, source), (self.target, target)):
            angles = [place.angles(side) for side in sides]
            turn = np.abs(np.radians(angles[1] - angles[0])).sum(axis=1)
            lean += turn**2 / 8.0
            for chain, here in place.chains(row):
                held = [side[here] for side in sides]
                ends = (place.tips_of(s[:, :3], place.angles(s), row[here]) for s in held)
                one, other = (place.on_workpiece(tip, chain) for tip in ends)
                far[here] += leaving(chain, (one, other), (angles[0][here], angles[1][here]))
        share = np.degrees(lean) / self.options.axis_tolerance
        return np.asarray(np.maximum(far, share * self.options.tolerance))

    # --- what is refused ---

    def _check_lines(self) -> None:
        other = self.path.is_arc | self.path.is_spline
        hint = 'make lines of it in a run of its own before, with "segment"'
        self._refuse("GX330", other, "this is no line", hint)
        some = ~self.known & ~self.own & (self.path.kind != gx.Kind.RAPID)
        message = "where the axes stand is not known here"
        self._refuse("GX311", some, message, "program all axes before")
        if self._has_other_places():
            message = "this goes to a place of the machine, and that is elsewhere on the target"
            hint = "give both machine files one work offset, and the same homes"
            self._refuse("GX330", self.own, message, hint)

    def _has_other_places(self) -> bool:
        """Whether places of the machine are others, as the work offset counts them."""
        machine, other = self.context.machine, self.options.target
        if machine is None or other is None:
            return False
        homes = machine.homes != other.homes
        return homes or bool((self.place.zero != self.target.zero).any())

    def _check_reach(self, result: Floats, row: Ints, drawn: Flags) -> None:
        """Refuse positions that the target does not reach."""
        axes = result[:, :3] + self.target.zero
        named = [*zip("XYZ", self.target.chain.travel, axes.T, strict=True)]
        for axis, values in zip(self.target.chain.axes, self.target.angles(result).T, strict=True):
            if axis.limits is not None:
                named.append((axis.letter, axis.limits, values))
        self._check_named(named, row, drawn)


class Correcting(Moving):
    """The same for a machine whose axes are a little elsewhere, with angles near those posted."""

    def _choose(self) -> None:
        """Leave the attitudes and turns as they are; refuse ends of blocks near the pole."""
        self._angles(self.end, np.arange(len(self.path)), np.ones(len(self.path)))

    def _entered(self, entry: Floats) -> Floats:
        said = self.place.angles(entry)
        found = nearest(self.target.chain, self.place.chain.tool_axis(said), said)
        return self.target.written(self._mixed(found, entry, np.array([0])))

    def _guess(self, positions: Floats, row: Ints, part: Floats, after: bool = False) -> Floats:
        return self.place.angles(positions)

    def _mixed(self, angles: Floats, positions: Floats, row: Ints) -> Floats:
        """Return the angles that are taken: near the pole those of the program, if asked.

        Between half of the largest turn and all of it the correction fades out.
        """
        posted = self.place.angles(positions)
        turn = np.abs(self.target.written(angles) - posted).max(axis=1, initial=0.0)
        largest = self.options.largest_turn
        if not self.options.keeps_at_pole:
            far = np.zeros(len(self.path), np.bool_)
            far[row[turn > largest]] = True
            message = f"an axis would have to turn by more than {largest:g} degrees"
            hint = 'near the pole keep the angles: orientation = "correct-if-tilt"'
            self._refuse("GX333", far, message, hint)
            return angles
        share = np.clip(2.0 - 2.0 * turn / largest, 0.0, 1.0)[:, None]
        return np.asarray(posted + share * (angles - posted))

    def _far(self, source: tuple[Floats, ...], target: tuple[Floats, ...], row: Ints) -> Floats:
        """Return how far (n,) mm the corrections of X, Y and Z are from being in proportion."""
        far = np.zeros(len(row))
        for (one, here), (other, _) in zip(
            self.place.chains(row), self.target.chains(row), strict=True
        ):
            first, last = (side[here, :3] + self.place.zero for side in source)
            posted = [self.place.angles(side[here]) for side in source]
            slips = [self.target.angles(s[here]) - q for s, q in zip(target, posted, strict=True)]
            far[here] = bend_of_correction(
                (one, other), (first, last), (posted[0], posted[1]), (slips[0], slips[1])
            )
        return far
