"""Where tip and axes of a path are in the machine."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints

TURN_BACK = "before it, draw the tool back along its axis and turn the axes to 0"

SAME = 1e-9  # mm; two tools that differ by less are one
TURN = 360.0
ENOUGH = "positions are converted in one work offset, with known tool lengths and nothing turned"


def turned_at(angles: Floats) -> Flags:
    """Return where (n,) all angles (n, m) are known and some axis is not at 0, or whole turns."""
    known = np.isfinite(angles).all(axis=1)
    return np.asarray(off_zero(angles).any(axis=1) & known)


def off_zero(angles: Floats) -> Flags:
    """Return which angles are neither 0 nor whole turns, at which all is as at 0; nan is not."""
    off = np.asarray(angles != 0.0)
    far = np.abs(angles) >= TURN
    if far.any():
        off[far] = np.mod(angles[far], TURN) != 0.0
    return off


def check_upright(
    path: gx.Toolpath, offset: Mapping[str, float], letters: Iterable[str], row: Ints
) -> None:
    """Refuse a work offset that turns axes: angles are then not those of words."""
    if any(offset.get(letter, 0.0) for letter in letters):
        message = f"the work offset {path.first} turns axes"
        raise path.refuse("GX330", row, message, "take the offset with all rotary axes at 0")


class Place:
    """The machine's chain, or another given, and what has to be added to positions of a path.

    `others` are letters of axes of another machine, which the path may have.

    A position is that of the gauge point, as words would bring it there with all rotary axes at 0.
    A tip on the workpiece is then position - tool + zero + gauge point, and the axes stand at
    position + zero, where `zero` (3,) is the work offset. `which` (n,) of the `tools` (k, 3) in mm
    holds in each row, and `which_before` in the one before it: the frame of the row before the
    first is the first of the frames. `switched`: codes say where the control follows the tip, and
    in rows that are `off` (n,) X, Y and Z are those of the axes.
    """

    def __init__(
        self,
        path: gx.Toolpath,
        context: gx.PassContext,
        chain: gx.Chain | None = None,
        others: str = "",
        switched: bool = False,
    ) -> None:
        assert context.machine is not None
        self.path = path
        self.others = others
        self.context = context
        self.chain = chain or gx.chain_of(context.machine)
        self.gauge = np.array(self.chain.tip)
        self.columns = self._columns()
        self.zero = self._zero(context)
        self._check_frames()
        tools = np.array([frame.tool for frame in path.frames])
        off = np.array([switched and frame.following is False for frame in path.frames])
        self.off = np.asarray(off[path.frame])
        self.called = np.array([frame.called for frame in path.frames], np.bool_)[path.frame]
        self.tools, which = np.unique(tools, axis=0, return_inverse=True)
        of_frame = which.reshape(-1)
        self.which = np.asarray(of_frame[path.frame])
        self.which_before = np.append(of_frame[:1], self.which[:-1])

    # --- what is refused ---

    def _columns(self) -> list[int]:
        """Return the columns of the rotary axes in the order of the chain."""
        first, own = np.array([0]), self.chain.letters
        for letter in own:
            if letter not in self.path.axes:
                message = f"where the axis {letter} of the machine stands is not known"
                raise self.path.refuse("GX311", first, message, f"program {letter} before")
        for column, letter in enumerate(self.path.axes[3:], 3):
            moved = np.flatnonzero(np.isfinite(self.path.end[:, column]))
            if letter not in own and letter not in self.others and len(moved):
                message = f"the machine file has no rotary axis {letter}"
                raise self.path.refuse("GX330", moved[:1], message, "add it there")
        return [self.path.axes.index(letter) for letter in own]

    def _zero(self, context: gx.PassContext) -> Floats:
        """Return the work offset (3,) of the path."""
        assert context.machine is not None
        table, first = context.machine.work_offsets, np.array([0])
        if self.path.first not in table:
            message = f"the machine file has no work offset {self.path.first}"
            hint = f"add it there: X = ... in [work-offset.{self.path.first}]"
            raise self.path.refuse("GX314", first, message, hint)
        offset = table[self.path.first]
        check_upright(self.path, offset, self.chain.letters, first)
        return np.array([offset.get(axis, 0.0) for axis in "XYZ"])

    def _check_frames(self) -> None:
        """Refuse words that count from anything but the work offset and a known tool."""
        path = self.path
        for number in np.flatnonzero(np.bincount(path.frame)).tolist():
            frame = path.frames[number]
            names = {name for name in frame.origin if name != path.first}
            known = not names and frame.work == path.first and bool(np.isfinite(frame.tool).all())
            shift = np.array(frame.shift)
            shift[:3] -= np.nan_to_num(frame.tool)
            plain = frame.shifts_only and not frame.polar and not (np.abs(shift) > SAME).any()
            if not known or not plain:
                rows = np.flatnonzero(path.frame == number)[:1]
                message = "this block counts from another zero"
                if names:
                    message += f": {', '.join(sorted(names))}"
                raise path.refuse("GX330", rows, message, ENOUGH)

    def refuse_followed_late(self, by_length: bool) -> None:
        """Refuse turned axes where the control would not follow the tip, or begin to follow it.

        Positions are those of the axes without a tool length; and where the control begins with
        axes turned, a parameter says whether X, Y and Z turn with the table. `by_length`: the code
        of the tool length follows the tip, which an M code has switched off before or behind it.
        """
        before = np.append(self.path.frames[0].called, self.called[:-1])
        start, end = (self.angles(side) for side in (self.path.start, self.path.end))
        cuts = (np.nan_to_num(end - start) != 0.0).any(axis=1) & (self.path.kind != gx.Kind.RAPID)
        without = (~self.called | (self.off & by_length)) & (turned_at(end) | cuts)
        begins = (self.which != self.which_before) | (self.called != before)
        begins &= turned_at(start)
        for rows, what in (
            (without, "axes are turned while the control does not follow the tip"),
            (begins, "the control begins or ends to follow the tip while axes are turned"),
        ):
            if rows.any():
                raise self.path.refuse("GX330", np.flatnonzero(rows)[:1], what, TURN_BACK)

    # --- from one to the other ---

    def angles(self, positions: Floats) -> Floats:
        """Return the angles (n, m) of positions (n, axes), as the chain has them."""
        return np.asarray(positions[:, self.columns])

    def written(self, angles: Floats) -> Floats:
        """Return angles (n, m) as they are written."""
        decimals = [self.context.decimals_of_angle(a) for a in self.chain.letters]
        columns = [np.round(angles[:, k], d) for k, d in enumerate(decimals)]
        return np.stack(columns, axis=1) + 0.0

    def axes_of(self, tips: Floats, angles: Floats, rows: Ints) -> Floats:
        """Return the positions (n, 3) with which the axes take tips to positions (n, 3)."""

        def solve(chain: gx.Chain, points: Floats, turned: Floats) -> Floats:
            return chain.linear(points + self.gauge - self._tool(chain), turned)

        return self._by_tool(solve, tips, angles, rows)

    def tips_of(self, axes: Floats, angles: Floats, rows: Ints) -> Floats:
        """Return the positions (n, 3) of the tips where the axes stand at positions (n, 3)."""

        def follow(chain: gx.Chain, points: Floats, turned: Floats) -> Floats:
            return np.asarray(chain.tip_at(points, turned) - self.gauge + self._tool(chain))

        return self._by_tool(follow, axes, angles, rows)

    def _tool(self, chain: gx.Chain) -> Floats:
        return np.asarray(self.gauge - np.array(chain.tip))

    def chains(self, rows: Ints) -> list[tuple[gx.Chain, Ints]]:
        """Return the chain of each tool, and which of the rows it holds for."""
        found = []
        for number, tool in enumerate(self.tools):
            x, y, z = (self.gauge - tool).tolist()
            here = np.flatnonzero(self.which[rows] == number)
            if len(here):
                found.append((replace(self.chain, tip=(x, y, z)), here))
        return found

    def _by_tool(
        self,
        change: Callable[[gx.Chain, Floats, Floats], Floats],
        points: Floats,
        angles: Floats,
        rows: Ints,
    ) -> Floats:
        """Return points changed, but those where no axis is known to be turned."""
        result = points.copy()
        turned = turned_at(angles) & ~self.off[rows]
        for chain, here in self.chains(rows):
            here = here[turned[here]]
            result[here] = change(chain, points[here] + self.zero, angles[here]) - self.zero
        return result

    def on_workpiece(self, tips: Floats, chain: gx.Chain) -> Floats:
        """Return positions (n, 3) of tips as points in the frame of the workpiece."""
        return np.asarray(tips + self.zero + self.gauge - self._tool(chain))
