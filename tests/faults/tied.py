"""Faults of threads, taps, probes and the codes that the machine file excepts."""

from __future__ import annotations

from faults.mutation import PASSES, Mutation

TIED = "tests/properties/test_tied.py"


def _tied(name: str, old: str, new: str, tests: str = TIED) -> Mutation:
    return Mutation(f"tied: {name}", "gcxform/modal/tied.py", old, new, tests)


MUTATIONS = (
    _tied("a tap stays down", "track.state.position = start.copy()", "track.state.position = end"),
    _tied("threads in the unit of mm", "word[0][rows.line] * unit", "word[0][rows.line]"),
    _tied("threads without a spindle", "(spindle == 0) |", "(spindle == 9) &"),
    _tied(
        "a probe stands at its target",
        "track.state.position[k] = np.nan",
        "pass",
        "tests/test_corpus.py::test_case[tied/probe-then-distance]",
    ),
    Mutation(
        "the proof takes a thread for a line",
        "gcxform/verify.py",
        "tied & (form != was)",
        "tied & (form < 0)",
        "tests/test_tied.py",
    ),
    Mutation(
        "threads are cut",
        f"{PASSES}/splitting.py",
        "(path.form == gx.Form.PLAIN)",
        "(path.form >= gx.Form.PLAIN)",
        "tests/test_corpus.py::test_case[tied/thread-not-straight]",
    ),
    Mutation(
        "a user code leaves positions known",
        "gcxform/modal/lines.py",
        "return np.asarray(lost & ~known[self.shape])",
        "return np.asarray(lost & known[self.shape])",
        "tests/test_corpus.py::test_case[tied/user-code-inert]",
    ),
)
