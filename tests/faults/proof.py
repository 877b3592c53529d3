"""Faults of the proof."""

from __future__ import annotations

from faults.mutation import CORPUS, VERIFY, Mutation


def _verifier(
    name: str, old: str, new: str = "if False:", file: str = "gcxform/proof/verify.py"
) -> Mutation:
    return Mutation(f"verifier: {name}", file, old, new, VERIFY)


def _feeds(name: str, old: str) -> Mutation:
    return _verifier(name, old, file="gcxform/proof/feeds.py")


MUTATIONS = (
    Mutation(
        "spelled out: a move of other axes in the machine leaves the tool nowhere",
        "gcxform/proof/spelled_out.py",
        "led, left = row, False",
        "led, left = row, a.axes[ALONG] not in _words(one[a.source[row]])",
        "tests/test_corpus.py::test_case[dialects/across/machine-move-length-open]",
    ),
    Mutation(
        "spelled out: a centre counts along the tool where only one path knows it",
        "gcxform/proof/spelled_out.py",
        "    about[alone & (a.plane == Plane.XY) & (b.plane == Plane.XY), ALONG] = True\n",
        "",
        "tests/test_corpus.py::test_case[dialects/across/machine-move-length-open]",
    ),
    Mutation(
        "spelled out: a work offset that is named late is a fault",
        "gcxform/proof/spelled_out.py",
        "LATE if row in late else LOST",
        "LOST",
        "tests/test_corpus.py::test_case[dialects/across/offset-named-late-for-klartext]",
    ),
    _verifier("the budget is ignored", "if not distance[worst] <= self.budget:"),
    _verifier(
        "rotary axes are ignored", "None if angle[turned] <= self.angle_budget else turned", "None"
    ),
    _verifier("kinds are ignored", "if wrong.any():"),
    _feeds("feeds are ignored", "if (off & plain).any():"),
    _feeds("feed modes are ignored", "if strange.any():"),
    _feeds("converted feeds are ignored", "if len(off):"),
    _feeds(
        "feed modes left behind are ignored",
        "if (mode != read.modes.feed_mode[line]).any():",
    ),
    _feeds("the pace of a piece is ignored", "if off.any():"),
    _feeds("times are ignored", "if len(wrong):"),
    _verifier(
        "events are ignored",
        "wrongs = *self.events.wrong(old, new, trace, self.budget), lost",
        "wrongs = (lost,)",
    ),
    _verifier(
        "missing events are ignored", "if len(old) != len(new):", file="gcxform/proof/events.py"
    ),
    _verifier(
        "the place of events is ignored",
        "if not same or not stays:",
        "if not same:",
        "gcxform/proof/events.py",
    ),
    _verifier("missing moves are ignored", "self._missing(trace, runs)\n        if not", "if not"),
    _verifier("moves of nobody are ignored", "if len(trace.owner) and int(trace.owner.min()) < 0:"),
    _verifier("nothing is undone", "path = step.undo(path, self.context)", "pass"),
    Mutation(
        "writing: a code of the machine without axes is gone on its own control",
        "gcxform/emit/codewords.py",
        "else (Role.VERBATIM, Role.NONE)",
        "else (Role.VERBATIM,)",
        "tests/test_corpus.py::test_case[metric/machine-without-axes]",
    ),
    Mutation(
        "proof: in what order a block tells spindle and coordinates counts",
        "gcxform/proof/events.py",
        "SWITCHED if self._sets_frame(event) else frozenset[str]()",
        "frozenset[str]()",
        "tests/test_corpus.py::test_case[dialects/across/frame-beside-switch]",
    ),
    Mutation(
        "proof: a code of the machine without axes is told",
        "gcxform/proof/events.py",
        "told = self._without_bare_machine(told, path) if saying.crosses else told",
        "pass",
        "tests/test_corpus.py::test_case[dialects/across/frame-beside-switch]",
    ),
    Mutation(
        "proof: the rounding leaves nothing for what is computed in binary",
        "gcxform/emit/manner.py",
        'for a in "XYZ"))) + NOISE',
        'for a in "XYZ")))',
        "tests/test_corpus.py::test_case[dialects/across/half-steps]",
    ),
    Mutation(
        "proof: a tool length that the source may have let go of is the target's",
        "gcxform/proof/known_positions.py",
        "wrong = open_here[owner] & ~open_there & np.isfinite(trace.before.end[owner, 2])",
        "wrong = open_here[owner] & open_there",
        "tests/test_lengths_across.py",
    ),
    Mutation(
        "proof: an arc may begin where only the output knows where an axis stands",
        "gcxform/proof/known_positions.py",
        "lost=path.lost | (left & np.isfinite(start)) @ bits)",
        "lost=path.lost)",
        "tests/test_corpus.py::test_case[dialects/haas/arc-behind-home]",
    ),
    Mutation(
        "deviation: the sense of arcs is ignored",
        "gcxform/deviations/deviation.py",
        "(after.sense[rows] == self.sense)",
        "np.isfinite(self.sense)",
        VERIFY,
    ),
    Mutation(
        "deviation: what is compared with nothing passes",
        "gcxform/deviations/deviation.py",
        "self.distance = np.full(len(owner), np.inf)",
        "self.distance = np.zeros(len(owner))",
        VERIFY,
    ),
    Mutation(
        "proof: what turns alone may be given a linear axis",
        "gcxform/proof/feeds.py",
        "        if alone.any():\n            row = int(written",
        "        if not len(alone):\n            row = int(written",
        VERIFY,
    ),
    Mutation(
        "proof: an axis that only the target loses is a bug",
        "gcxform/proof/known_positions.py",
        "    if not lost.any():\n        return _lengthened",
        "    if len(lost):\n        return _lengthened",
        CORPUS,
    ),
    Mutation(
        "proof: a budget that nobody promised is a bug",
        "gcxform/proof/verify.py",
        "if self.bounded or not np.isfinite(distance):",
        "if True:",
        CORPUS,
    ),
    Mutation(
        "deviation: a radius that changes is that of a circle",
        "gcxform/deviations/deviation.py",
        "return np.asarray((np.abs(last - first) > ROUND) | (np.abs(r1 - r0) > ROUND))",
        "return np.zeros(len(r0), np.bool_)",
        "tests/test_spirals.py",
    ),
    Mutation(
        "spirals: the other keeps its radius",
        "gcxform/deviations/spirals.py",
        "radius = its.first + its.grows * np",
        "radius = its.first + 0.0 * np",
        "tests/test_spirals.py",
    ),
    Mutation(
        "spirals: far centres count as near ones",
        "gcxform/deviations/spirals.py",
        "_at_parts(mine.of(far), its.of(far), shift[far], sense[far])",
        "_at_parts(mine.of(far), mine.of(far), 0 * shift[far], sense[far])",
        "tests/test_spirals.py",
    ),
    Mutation(
        "runs: splines end a run",
        "gcxform/deviations/runs.py",
        "plain = (path.form == Form.PLAIN) | (path.form == Form.SPLINE)",
        "plain = path.form == Form.PLAIN",
        CORPUS,
    ),
    Mutation(
        "proof: an arc from nowhere is worked out by where its known axes stand",
        "gcxform/modal/moves/arcs.py",
        "np.where(blind, words.way, end)",
        "np.where(nowhere, words.way, end - began)",
        "tests/test_corpus.py::test_case[flow/half-circle-from-nowhere]",
    ),
)
