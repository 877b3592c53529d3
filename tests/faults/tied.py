"""Faults of threads, taps, probes and the codes that the machine file excepts."""

from __future__ import annotations

from faults.mutation import Mutation

TIED = "tests/properties/test_tied.py"
TAPPING = "tests/properties/test_tapping.py"
EMITTED = "gcxform/emit/taps_in_step.py"


def _tied(name: str, old: str, new: str, tests: str = TIED) -> Mutation:
    return Mutation(f"tied: {name}", "gcxform/modal/moves/spindle_and_probe.py", old, new, tests)


def _tapping(name: str, old: str, new: str, tests: str = TAPPING) -> Mutation:
    return Mutation(f"tapping: {name}", "gcxform/emit/tapping.py", old, new, tests)


SPEEDS = "tests/test_corpus.py::test_case[bad/gx204-per-turn-without-speed]"


def _turning(name: str, old: str, new: str) -> Mutation:
    return Mutation(f"tied: {name}", "gcxform/modal/control_limits.py", old, new, SPEEDS)


def _in_step(name: str, old: str, new: str, case: str, file: str = EMITTED) -> Mutation:
    tests = f"tests/test_corpus.py::test_case[dialects/across/taps-in-step-{case}]"
    return Mutation(f"taps in step: {name}", file, old, new, tests)


def _cycles(name: str, old: str, new: str, case: str = "for-haas") -> Mutation:
    tests = f"tests/test_corpus.py::test_case[dialects/across/tap-in-step-{case}]"
    return Mutation(f"taps as cycles: {name}", "gcxform/emit/taps_as_cycles.py", old, new, tests)


def _proved(name: str, old: str, new: str) -> Mutation:
    tests = "tests/test_taps_in_step.py"
    return Mutation(f"taps in step: {name}", "gcxform/proof/taps_in_step.py", old, new, tests)


MUTATIONS = (
    _turning("S 0 is a speed", "word[0][said] != 0.0", "True"),
    _turning("a speed is forgotten", "np.maximum.accumulate(np", "np.asarray(np"),
    _proved(
        "any feed of a cycle is one",
        "known & (np.abs(feed - wanted)",
        "known | (np.abs(feed - wanted)",
    ),
    _proved("any pitch is one", "off = timed | ~(", "off = timed & ~("),
    _proved("any hand is one", "other = back.modes.spindle[line] != sense", "other = sense < 0"),
    _proved("any tap may wait", "if event.within and event.what ==", "if False and event.what =="),
    _proved("speeds are those of the end", "if event.row > at:", "if False:"),
    _in_step(
        "taps by steps stay so",
        "incremental[tapped] = False",
        "incremental[tapped[:0]] = False",
        "by-steps-for-siemens",
        "gcxform/pipeline/translated_moves.py",
    ),
    _in_step("the pitch is S by F", "return feed / speed", "return speed / feed", "for-linuxcnc"),
    _in_step(
        "a feed per turn is divided by the speed",
        "int(path.feed_mode[row]) == FeedMode.PER_TURN",
        "False",
        "by-feed-per-turn",
    ),
    _in_step(
        "any sense of the spindle does",
        "int(self.task.read.modes.spindle[line]) != TURNING[code]",
        "False",
        "of-the-other-hand",
    ),
    _in_step(
        "taps that wait do not", "if waits and self.rows[", "if False and self.rows[", "that-wait"
    ),
    _in_step(
        "a tool change leaves the speed",
        "code is None or code.loses_position or code.barrier",
        "code is None",
        "behind-a-tool-change",
    ),
    _in_step(
        "taps that follow at once are one",
        "(at - begins) % 2 == 1",
        "(at - begins) > 0",
        "for-linuxcnc",
    ),
    _in_step(
        "the way out is written",
        "stays = ~_at_pieces(in_step.out,",
        "stays = ~_at_pieces(in_step.out & False,",
        "for-linuxcnc",
        "gcxform/emit/pieces.py",
    ),
    _in_step(
        "the motion behind is the one before",
        "sets[self._in_step] = TAP",
        "pass",
        "for-linuxcnc",
        "gcxform/emit/needed_modes.py",
    ),
    _in_step(
        "a mirror leaves the hand",
        "np.linalg.det(np.array(m)) < 0",
        "False",
        "mirrored",
    ),
    _cycles("the feed is the pitch", "1.0 if per_turn else self.speeds[row]", "1.0", "for-fanuc"),
    _cycles("G74 for M3", "{1: 84, 2: 74}", "{1: 74, 2: 84}", "for-haas"),
    _cycles(
        "R is the depth", "positions.before[row, normal]", "positions.held[row, normal]", "for-haas"
    ),
    _cycles(
        "steps are levels", "if path.blocks.incremental[line]:", "if False:", "by-steps-for-fanuc"
    ),
    _cycles("no G80", "return opens if rigid else [], closes", "return opens if rigid else [], []"),
    _cycles("no M29", "return opens if rigid else [], closes", "return [], closes", "for-fanuc"),
    _in_step(
        "G84 of LinuxCNC is in step",
        "return self.crosses and by_cycle and",
        "return self.crosses and",
        "of-linuxcnc",
        "gcxform/dialect/code_translation.py",
    ),
    _tapping(
        "the place is that of the bottom",
        "(hole.top[place] + hole.bottom[place]) / 2",
        "hole.bottom[place]",
        "tests/test_corpus.py::test_case[tied/tapping-moved]",
    ),
    _tapping(
        "a setting that is not known makes no tap of a block",
        "not self.task.manner.open_place or first",
        "True or first",
        "tests/test_corpus.py::test_case[dialects/haas/tap-without-place-is-not-written-anew]",
    ),
    _tapping("what leans is not measured", "if off <= self._allowed:", "if off < 1.0:"),
    _tapping("depths in G91 count from the level", "from_here[normal] = rest", "pass"),
    _tapping("G98 goes back to R", "max(self.level, rest) if retracts else rest", "rest"),
    _tapping("the control stands where it shall", "self.positions.held[rows] = standing", "pass"),
    _tapping(
        "R rises above the level of the cycle",
        "return min(top, self.level)",
        "return top",
        "tests/test_corpus.py::test_case[tied/tapping-at-r]",
    ),
    _tapping(
        "words in force are relied on",
        "self.moved |= ",
        "self.moved = ",
        "tests/test_corpus.py::test_case[tied/tapping-in-force]",
    ),
    _tapping(
        "feed moves begin where a tap has ended",
        "self.aside > self._allowed",
        "self.aside > 1.0",
        "tests/test_corpus.py::test_case[tied/tapping-then-feed]",
    ),
    _tapping(
        "the level is not carried to the next window",
        "going_on = 0 if believed.level == believed.level else -1",
        "going_on = -1",
        "tests/test_corpus.py::test_windows_make_no_difference[tied/tapping-in-force]",
    ),
    _tapping(
        "mirrored taps are written",
        "frame.shifts_only and not frame.polar",
        "not frame.polar",
        "tests/test_corpus.py::test_case[hazards/tapping-mirrored]",
    ),
    Mutation(
        "the proof leaves R out",
        "gcxform/toolpath/facts.py",
        "(cycle & ~to_r) | (way_out & past)",
        "cycle | tied",
        "tests/test_tied.py",
    ),
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
        "gcxform/proof/verify.py",
        "tied & (form != was)",
        "tied & (form < 0)",
        "tests/test_tied.py",
    ),
    Mutation(
        "the way of a thread is not looked at",
        "plugins/gcxform_plugins/passes/volumetric/forward/lines.py",
        "((path.form == gx.Form.PLAIN) | whole)",
        "(path.form == gx.Form.PLAIN)",
        "tests/test_corpus.py::test_case[tied/thread-not-straight]",
    ),
    Mutation(
        "a user code leaves positions known",
        "gcxform/modal/lines.py",
        "return np.asarray(lost & ~known[self.shape])",
        "return np.asarray(lost & known[self.shape])",
        "tests/test_corpus.py::test_case[tied/user-code-inert]",
    ),
    Mutation(
        "threads in passes: they end where they began",
        "gcxform/modal/moves/thread_cycles.py",
        "(Kind.RAPID, end)]",
        "(Kind.RAPID, start)]",
        "tests/test_thread_cycles.py",
    ),
    Mutation(
        "threads in passes: they begin anywhere",
        "gcxform/emit/same_rows.py",
        "(self.path.form[rows] == Form.PASSES)[:, None]",
        "np.zeros((len(rows), 1), np.bool_)",
        "tests/test_corpus.py::test_case[hazards/thread-linuxcnc-moved]",
    ),
    Mutation(
        "threads in passes: only Z has a unit",
        "gcxform/emit/copying.py",
        " | ~self.same.units()[points]",
        "",
        "tests/test_corpus.py::test_case[hazards/thread-linuxcnc]",
    ),
)
