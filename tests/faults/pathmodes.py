"""Faults of path modes around cycles that are written out, and of their proof."""

from __future__ import annotations

from faults.mutation import Mutation

TESTS = "tests/test_path_modes.py"


def _writing(name: str, old: str, new: str, file: str = "gcxform/emit/path_modes.py") -> Mutation:
    return Mutation(f"path modes: {name}", file, old, new, TESTS)


def _proof(name: str, old: str, new: str) -> Mutation:
    return _writing(name, old, new, "gcxform/proof/path_modes.py")


MUTATIONS = (
    _writing(
        "the window before has stated none",
        "self.emitter.path_mode = self.exactness.after",
        "pass",
        "gcxform/emit/emitter.py",
    ),
    _writing(
        "units do not matter",
        "mode.words and bool(blocks.inch[line]) != mode.inch",
        "False",
    ),
    _writing("what is computed is said again", "event.values and computed", "False"),
    _writing("what was called is said again", "CALLED if called(event.line)", "CALLED if False"),
    _writing("G64 in the block is behind it", "line + blocks.first in self.lines", "False"),
    _writing("G64 behind the end", "LEAVES if blocks.leaves[line] or ends", "LEAVES if False"),
    _writing("G64 without its words", "BLENDING, mode.words, at", "BLENDING, (), at"),
    _writing("back before the last move", "Event(end + 1, BLENDING", "Event(end, BLENDING"),
    _writing("exact after the first move", "Event(row, EXACT", "Event(row + 1, EXACT"),
    _writing(
        "G61 leads the block",
        "(first & ~opening) | np.roll(opening, 1)",
        "first",
        "gcxform/emit/pieces.py",
    ),
    _writing(
        "G64 ends the block",
        "(ends & ~closing) | np.roll(closing, -1)",
        "ends",
        "gcxform/emit/pieces.py",
    ),
    _proof(
        "any mode is right",
        "if not len(rows):\n            return None\n        row",
        "if True:\n            return None\n        row",
    ),
    _proof("expanded moves may be rounded", "np.where(exactly, number[EXACT], one)", "one"),
    _proof("the end does not matter", "self.source != self.output", "False"),
    _proof("more than a pair", 'if names != ["G61", "G64"]:', "if False:"),
    _proof("nothing is counted", "self.added += sum(map(len, pairs.values()))", "pass"),
    _proof(
        "the windows before are forgotten",
        "self.source, self.output = before[-1], after[-1]",
        "self.source, self.output = before[0], before[0]",
    ),
)
