"""Faults of the proof."""

from __future__ import annotations

from faults.mutation import VERIFY, Mutation


def _verifier(name: str, old: str, new: str = "if False:") -> Mutation:
    return Mutation(f"verifier: {name}", "gcxform/verify.py", old, new, VERIFY)


MUTATIONS = (
    _verifier("the budget is ignored", "if not distance[worst] <= self.budget:"),
    _verifier("rotary axes are ignored", "if not off.angle[turned] <= self.angle_budget:"),
    _verifier("kinds are ignored", "if wrong.any():"),
    _verifier("feeds are ignored", "if (off & plain).any():"),
    _verifier("feed modes are ignored", "if strange.any():"),
    _verifier("converted feeds are ignored", "if len(off):"),
    _verifier(
        "feed modes left behind are ignored",
        "if (mode != read.modes.feed_mode[line]).any():",
    ),
    _verifier("times are ignored", "if len(wrong):"),
    _verifier(
        "events are ignored",
        "self._events(self._told(read.path), self._told(back.path), trace)",
        "",
    ),
    _verifier("missing events are ignored", "if len(old) != len(new):"),
    _verifier(
        "the place of events is ignored",
        "or not trace.stands_before(after.row, before.row, self.budget)",
        "",
    ),
    _verifier("missing moves are ignored", "self._missing(trace, runs)\n        if not", "if not"),
    _verifier("moves of nobody are ignored", "if len(trace.owner) and int(trace.owner.min()) < 0:"),
    _verifier("nothing is undone", "path = step.undo(path, self.context)", "pass"),
    Mutation(
        "deviation: the sense of arcs is ignored",
        "gcxform/toolpath/deviation.py",
        "(after.sense[rows] == self.sense)",
        "np.isfinite(self.sense)",
        VERIFY,
    ),
)
