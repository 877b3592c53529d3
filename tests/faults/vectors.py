"""Faults of tool vectors: how they are read, which angles are made of them, and the proof."""

from __future__ import annotations

from faults.mutation import Mutation

TESTS = "tests/test_rtcp_vectors.py"
PROVED = "tests/test_rtcp_vectors_proof.py"
READING = "gcxform/modal/moves/tool_vectors.py"
POINTING = "plugins/gcxform_plugins/passes/rtcp/forward/vectors.py"
POINTED = "plugins/gcxform_plugins/passes/rtcp/proof/vectors.py"
VECTORS = "plugins/gcxform_plugins/passes/rtcp/tool_vectors.py"
DRIVEN = "plugins/gcxform_plugins/passes/rtcp/proof/driven.py"
ANY = f"{TESTS}::test_any_vectors"
ANGLES = f"{TESTS}::test_it_does_what_angles_do"
LIMITS = f"{TESTS}::test_turns_go_on_and_limits_hold"
SEEN = f"{PROVED}::test_the_proof_sees_it"
ROUND = f"{PROVED}::test_the_proof_sees_ways_round_about"
CORPUS = "tests/test_corpus.py::test_case"

MUTATIONS = (
    Mutation(
        "vectors: J and K are one another",
        READING,
        'for k, address in enumerate("IJK"):\n            word',
        'for k, address in enumerate("IKJ"):\n            word',
        ANGLES,
    ),
    Mutation(
        "vectors: what is left out stays as it was",
        READING,
        "self.raw[:, k] = np.where(word[1], word[0], 0.0)",
        "self.raw[:, k] = np.where(word[1], word[0], 0.5)",
        ANY,
    ),
    Mutation(
        "vectors: their length counts",
        READING,
        "value = np.where(self.named, self.raw[:, k] / length, UPRIGHT[k])",
        "value = np.where(self.named, self.raw[:, k], UPRIGHT[k])",
        ANY,
    ),
    Mutation(
        "vectors: one without length is read",
        READING,
        "named & (self.length == 0.0)",
        "named & (self.length < 0.0)",
        f"{CORPUS}[rtcp/vectors-words]",
    ),
    Mutation(
        "vectors: they last for one line",
        READING,
        "fill(np.where(said, value, np.nan), said | ~self.on, state.vector[k])",
        "np.where(said, value, UPRIGHT[k])",
        ANY,
    ),
    Mutation(
        "vectors: a section begins with the vector that the one before had",
        READING,
        "said = self.named | self.begins",
        "said = self.named",
        f"{CORPUS}[rtcp/vectors-steps]",
    ),
    Mutation(
        "vectors: words of rotary axes are read beside them",
        READING,
        "if axis in LINEAR else self.lines.word(axis, self.on, distance=False)",
        "if axis else self.lines.word(axis, self.on, distance=False)",
        f"{CORPUS}[rtcp/vectors-words]",
    ),
    Mutation(
        "vectors: after G49 axes stand where G43.5 found them",
        "gcxform/modal/frames/track.py",
        "self.state.position[:] = LEFT",
        "self.state.position[:2] = LEFT",
        f"{CORPUS}[rtcp/vectors-read]",
    ),
    Mutation(
        "vectors: steps are taken from where the control has left an axis",
        "gcxform/modal/frames/track.py",
        "nowhere = incremental & ~np.isfinite(position) & np.isfinite(value)",
        "nowhere = incremental & np.isnan(position) & np.isfinite(value)",
        f"{CORPUS}[rtcp/vectors-incremental-after]",
    ),
    Mutation(
        "vectors: a line may be copied with its vector",
        "gcxform/emit/copying.py",
        "self.lines &= ~self._pointed()",
        "self.lines |= self._pointed() & False",
        f"{CORPUS}[rtcp/vectors-read]",
    ),
    Mutation(
        "vectors: a section is divided",
        "gcxform/pipeline/whole_cuts.py",
        '(one[1], other[1]) == (b"9", b"3")',
        'other[1] == b"3" or other[1] == b"9"',
        f"{TESTS}::test_sections_are_not_divided",
    ),
    Mutation(
        "vectors: a cut turns from where the tool will be",
        VECTORS,
        "return cls(on, np.concatenate([first, end])[: len(end)], end)",
        "return cls(on, end, end)",
        ANY,
    ),
    Mutation(
        "vectors: only the turn of the tool is looked at, beside the pole",
        POINTING,
        "np.maximum(self.turns[rows], way.max(axis=1))",
        "np.maximum(self.turns[rows], 0.0 * way.max(axis=1))",
        f"{TESTS}::test_small_vectors_beside_the_pole",
    ),
    Mutation(
        "vectors: rapids that turn nothing may turn axes",
        POINTING,
        "super()._holds(rows) | (self.turns[rows] <= STILL)",
        "super()._holds(rows) | (self.turns[rows] < -STILL)",
        f"{TESTS}::test_axes_unwind_where_the_tool_turns",
    ),
    Mutation(
        "vectors: every cut is a group of its own",
        POINTING,
        "begins = np.flatnonzero(np.diff(rows, prepend=-2) > 1)",
        "begins = np.flatnonzero(np.diff(rows, prepend=-2) > 0)",
        LIMITS,
    ),
    Mutation(
        "vectors: a feed is read while the tip rests",
        POINTING,
        'axis=1) < STILL)\n        message = "the tool turns about its tip',
        'axis=1) < 0.0)\n        message = "the tool turns about its tip',
        f"{CORPUS}[rtcp/vectors-resting-tip]",
    ),
    Mutation(
        "vectors: half a turn has a way",
        POINTING,
        "half = cut & (self.turns > MOST)",
        "half = cut & (self.turns > 2.0 * MOST)",
        f"{CORPUS}[rtcp/vectors-half-turn]",
    ),
    Mutation(
        "vectors: G43.5 may begin with axes turned",
        POINTING,
        "turned = on & (angles != 0.0).any(axis=1)",
        "turned = on & (angles != 0.0).all(axis=1)",
        f"{CORPUS}[rtcp/vectors-turned]",
    ),
    Mutation(
        "vectors: another tool under G43.5",
        POINTING,
        "changed = on & np.append(False, on[:-1])[: len(on)] & (place.which != place.which_before)",
        "changed = on & np.append(False, ~on[:-1])[: len(on)] & (place.which < 0)",
        f"{CORPUS}[rtcp/vectors-other-length]",
    ),
    Mutation(
        "vectors: circles may leap",
        POINTING,
        "self._refuse_leaps(rows[self._turn(rows) > LEAST])",
        "self._refuse_leaps(rows[self._turn(rows) > 400.0 * LEAST])",
        f"{CORPUS}[rtcp/vectors-circle-leaps]",
    ),
    Mutation(
        "vectors: angles in proportion are not rounded",
        POINTING,
        "self.target.written(one + part * (other - one))",
        "one + part * (other - one)",
        f"{TESTS}::test_rounded_angles_are_made_good",
    ),
    Mutation(
        "vectors: angles in proportion need no pieces",
        POINTING,
        "return self._off_line(source, target, row)",
        "return 0.0 * self._off_line(source, target, row)",
        ANY,
    ),
    Mutation(
        "vectors: the proof does not look at the ends of blocks",
        POINTED,
        "if not self.ends <= rounding:",
        "if not self.ends <= 10.0:",
        SEEN,
    ),
    Mutation(
        "vectors: the proof does not look at the ways between them",
        POINTED,
        "if not self.round <= 2.0 * (rounding + finest):",
        "if not self.round <= 1000.0:",
        ROUND,
    ),
    Mutation(
        "vectors: the proof does not look at proportions",
        POINTED,
        "wrong = ~(off <= 0.5 * self._steps() + ROOM).all(axis=1)",
        "wrong = ~(off <= 90.0).all(axis=1)",
        f"{PROVED}::test_the_proof_sees_what_is_out_of_proportion",
    ),
    Mutation(
        "vectors: the proof does not look outside of sections",
        POINTED,
        "same = bool((gap <= ROOM).all())",
        "same = bool((gap <= 9.0).all())",
        SEEN,
    ),
    Mutation(
        "vectors: the proof knows nothing of axes that stay",
        POINTED,
        "said = np.where(self.left[lone], stays, said)",
        "said = np.where(self.left[lone], found, said)",
        f"{PROVED}::test_the_proof_sees_an_axis_that_should_have_stayed",
    ),
    Mutation(
        "vectors: a turn of the tool may be missing",
        POINTED,
        "(self.vectors.on & (self.count == 0) & (self.turned > STILL)).any()",
        "(self.vectors.on & (self.count == 0) & (self.turned < 0.0)).any()",
        f"{PROVED}::test_the_proof_sees_a_missing_turn",
    ),
    Mutation(
        "vectors: the proof follows the wrong side of the circle",
        DRIVEN,
        "axis = np.cos(angle)[:, None] * one + np.sin(angle)[:, None] * np.cross(pole, one)",
        "axis = np.cos(angle)[:, None] * one - np.sin(angle)[:, None] * np.cross(pole, one)",
        ANY,
    ),
)
