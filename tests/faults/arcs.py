"""Faults of the pass `arcs`, and of the proof where a move stands for a run of them."""

from __future__ import annotations

from faults.mutation import ARCS, Mutation

CENTRES = "tests/test_centres_written.py"

MUTATIONS = (
    Mutation(
        "centres: the nearest one is written, whatever its radii",
        "gcxform/emit/arcs.py",
        "NEAREST = 0.49",
        "NEAREST = 99.0",
        CENTRES,
    ),
    Mutation(
        "arcs: the sense is swapped",
        "plugins/gcxform_plugins/passes/arcs/fit.py",
        "np.where(self._sum(y) < 0, 1.0, -1.0)",
        "np.where(self._sum(y) < 0, -1.0, 1.0)",
        ARCS,
    ),
    Mutation(
        "arcs: the sagitta of the lines is not looked at",
        "plugins/gcxform_plugins/passes/arcs/fit.py",
        "flat = np.maximum(np.abs(size - inside), sagitta)",
        "flat = np.abs(size - inside)",
        ARCS,
    ),
    Mutation(
        "arcs: corners are not looked at",
        "plugins/gcxform_plugins/passes/arcs/fit.py",
        "flat = np.maximum(np.abs(size - inside), sagitta)",
        "flat = sagitta",
        ARCS,
    ),
    Mutation(
        "arcs: lines may go back",
        "plugins/gcxform_plugins/passes/arcs/fit.py",
        "good = (angle > 0) & (angle <= WIDEST) & self._points_along(x, y, size, wx, wy, length)",
        "good = angle <= WIDEST",
        ARCS,
    ),
    Mutation(
        "arcs: a break between lines is explained away",
        "plugins/gcxform_plugins/passes/arcs/fit.py",
        "(angle <= WIDEST) & self._points_along(x, y, size, wx, wy, length)",
        "(angle <= WIDEST)",
        ARCS,
    ),
    Mutation(
        "arcs: the axis of a helix is not looked at",
        "plugins/gcxform_plugins/passes/arcs/fit.py",
        "axial = self._off_axis(turned / sweep[self.run])",
        "axial = np.zeros(len(turned))",
        ARCS,
    ),
    Mutation(
        "arcs: what happens between lines is ignored",
        "plugins/gcxform_plugins/passes/arcs/arcs.py",
        "follows[[e.row for e in path.events if e.row < len(path)]] = False",
        "pass",
        ARCS,
    ),
    Mutation(
        "arcs: another feed is ignored",
        "plugins/gcxform_plugins/passes/arcs/arcs.py",
        "(path.plane, path.feed, path.feed_mode, path.frame)",
        "(path.plane, path.feed_mode, path.frame)",
        ARCS,
    ),
    Mutation(
        "arcs: they end inside blocks",
        "plugins/gcxform_plugins/passes/arcs/reach.py",
        "return np.where(self._own(first, stop), stop, self.before[stop])",
        "return stop",
        ARCS,
    ),
    Mutation(
        "arcs: a way straight ahead is an arc",
        "plugins/gcxform_plugins/passes/arcs/fit.py",
        "curved = near & (rises > self.limits.tolerance + self.limits.step)",
        "curved = near.copy()",
        ARCS,
    ),
    Mutation(
        "arcs: the motion code of a block that is gone counts",
        "gcxform/emit/needed_modes.py",
        "pieces.leads & ~silent & (pieces.role != Role.GONE)",
        "pieces.leads & ~silent",
        ARCS,
    ),
    Mutation(
        "runs: events may stand inside",
        "gcxform/proof/trace.py",
        "self.through[np.maximum(written_rows - 1, 0)] < rows",
        "self.written_owner[np.maximum(written_rows - 1, 0)] < rows",
        ARCS,
    ),
    Mutation(
        "runs: another feed is ignored",
        "gcxform/deviations/runs.py",
        "return np.asarray(same & (np.abs(path.feed - path.feed[base]) <= SAME_FEED * path.feed))",
        "return np.asarray(same)",
        ARCS,
    ),
    Mutation(
        "runs: another work offset is ignored",
        "gcxform/deviations/runs.py",
        "same = free & free[base] & (path.frame == path.frame[base])",
        "same = free & free[base]",
        ARCS,
    ),
    Mutation(
        "runs: rapids are joined",
        "gcxform/deviations/runs.py",
        "free = plain & (path.kind != Kind.RAPID)",
        "free = plain & (path.kind >= Kind.RAPID)",
        ARCS,
    ),
    Mutation(
        "runs: what lies behind a row that is not alike is joined",
        "gcxform/deviations/runs.py",
        "covered = alike & (stop < base)",
        "covered = alike",
        ARCS,
    ),
    Mutation(
        "runs: arcs are compared at their ends alone",
        "gcxform/deviations/chains.py",
        "bound[pieces] = np.maximum(bound[pieces], off)",
        "pass",
        ARCS,
    ),
    Mutation(
        "runs: lines are not compared at their ends",
        "gcxform/deviations/chains.py",
        "bound = np.maximum(_apart(one.start, other.start), _apart(one.end, other.end))",
        "bound = np.zeros(len(one.row))",
        ARCS,
    ),
)
