"""Faults of frames: offsets, shifts, turns, tool lengths."""

from __future__ import annotations

from faults.mutation import CORPUS, FACTS, FOUND, OFFSETS, SHIFTS, Mutation

MUTATIONS = (
    Mutation(
        "frames: the sign of G92 is swapped",
        "gcxform/modal/frames/work_offsets.py",
        "shift[k] += here[k] - value",
        "shift[k] += value - here[k]",
        OFFSETS,
    ),
    Mutation(
        "frames: a shift is taken off",
        "gcxform/toolpath/frames.py",
        "np.asarray(self.turned(local) + np.array",
        "np.asarray(self.turned(local) - np.array",
        OFFSETS,
    ),
    Mutation(
        "frames: G92 is added behind the rotation",
        "gcxform/modal/frame_state.py",
        "matrix, shift = about @ matrix, about @ shift",
        "matrix = about @ matrix",
        SHIFTS,
    ),
    Mutation(
        "frames: the centre of a turn is forgotten",
        "gcxform/modal/frame_state.py",
        "step @ (shift - centre) + centre",
        "step @ shift",
        OFFSETS,
    ),
    Mutation(
        "frames: a mirror keeps the sense of arcs",
        "gcxform/toolpath/frames.py",
        "return m[first][first] * m[second][second] <",
        "return False and m[first][first] * m[second][second] <",
        OFFSETS,
    ),
    Mutation(
        "frames: a tool is added twice",
        "gcxform/modal/frame_state.py",
        "shift[k] += length\n",
        "shift[k] += 2.0 * length\n",
        SHIFTS,
    ),
    Mutation(
        "frames: G92.3 restores nothing",
        "gcxform/modal/frames/work_offsets.py",
        "return replace(state, preset=shift, held=shift)",
        "return replace(state, preset=shift)",
        SHIFTS,
    ),
    Mutation(
        "frames: diameters are radii in what acts",
        "gcxform/modal/frames/track.py",
        'return {**words, "X": words["X"] / 2}',
        "return words",
        SHIFTS,
    ),
    Mutation(
        "frames: G54.1 is taken for the offset before",
        "gcxform/modal/moves/moves.py",
        "again &= (self.modes.work != MANY_WORK) & ~reset",
        "again &= ~reset",
        FOUND,
    ),
    Mutation(
        "frames: radius and angle are not carried into the next window",
        "gcxform/modal/frames/track.py",
        "self.state.polar = float(columns[0][-1]), float(columns[1][-1])",
        "pass",
        "tests/test_corpus.py::test_windows_make_no_difference",
    ),
    Mutation(
        "frames: G10 L20 forgets the rotation",
        "gcxform/modal/frames/work_offsets.py",
        "local[:2] = about @ local[:2]",
        "pass",
        FACTS,
    ),
    Mutation(
        "frames: G10 L20 moves the axis that is not named",
        "gcxform/modal/frames/work_offsets.py",
        "+ [0, 1] * bool(turned)",
        "+ []",
        FACTS,
    ),
    Mutation(
        "frames: two tools that are not known are one",
        "gcxform/modal/frames/tool_lengths.py",
        'name += f" after tool change {state.changes}"',
        "pass",
        "tests/test_corpus.py::test_case[dialects/linuxcnc/length-of-another-unknown-tool]",
    ),
    Mutation(
        "frames: no tool is one of no length",
        "gcxform/modal/frames/tool_lengths.py",
        "if state.in_spindle < 1:",
        "if state.in_spindle < 0:",
        "tests/test_corpus.py::test_case[dialects/linuxcnc/length-without-tool]",
    ),
    Mutation(
        "frames: a tool length of 0 is none",
        "gcxform/modal/frame_state.py",
        "bool(self.tool_name),",
        "any(self.tool),",
        "tests/test_corpus.py::test_case[rtcp/tool-length-zero]",
    ),
    Mutation(
        "frames: a length goes on behind G28 where it may have ended",
        "gcxform/modal/moves/home.py",
        "    if frames.tool_name:",
        "    if not frames.tool_name:",
        CORPUS + "[dialects/haas/home-ends-the-length]",
    ),
)
