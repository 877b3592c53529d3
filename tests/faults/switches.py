"""Faults of what is known where a control is told to follow the tip while axes are turned."""

from __future__ import annotations

from faults.mutation import Mutation

CUTTING = "plugins/gcxform_plugins/passes/rtcp/forward/cutting.py"
PLACE = "plugins/gcxform_plugins/passes/rtcp/place.py"
TRACK = "gcxform/modal/frames/track.py"
KNOWN = "gcxform/proof/known_positions.py"
TESTS = "tests/test_tip_switches.py"
TURNED = f"{TESTS}::test_switched_with_axes_turned"
REFUSED = f"{TESTS}::test_it_is_refused_by_name"

MUTATIONS = (
    Mutation(
        "switches: X, Y and Z stay known where axes are turned",
        TRACK,
        "self._lose(line, 0 if self._upright() else SPATIAL)",
        "self._lose(line, 0)",
        REFUSED,
    ),
    Mutation(
        "switches: Z stays known",
        TRACK,
        "0 if self._upright() else SPATIAL",
        "0 if self._upright() else 3",
        REFUSED,
    ),
    Mutation(
        "switches: X, Y and Z are lost wherever it is switched",
        TRACK,
        "abs(remainder(v, WHOLE_TURN)) < NOISE",
        "abs(remainder(v, WHOLE_TURN)) > NOISE",
        f"{TESTS}::test_it_writes_what_it_writes_of_a_program_without_the_codes",
    ),
    Mutation(
        "switches: one axis at 0 is enough",
        TRACK,
        "return all(isfinite(v)",
        "return any(isfinite(v)",
        f"{TESTS}::test_whole_turns_are_as_none",
    ),
    Mutation(
        "switches: axes are taken for tips while it is off",
        PLACE,
        "turned = turned_at(angles) & ~self.off[rows]",
        "turned = turned_at(angles)",
        TURNED,
    ),
    Mutation(
        "switches: what is cut while it is off is cut for the tip",
        CUTTING,
        "turned_at(place.angles(self.start)) & ~place.off",
        "turned_at(place.angles(self.start))",
        f"{TESTS}::test_it_is_read",
    ),
    Mutation(
        "switches: feeds of linear and rotary axes together are taken for those of the tip",
        CUTTING,
        "axes = np.full(len(path), not self.to_axes) | self.place.off",
        "axes = np.full(len(path), not self.to_axes)",
        REFUSED,
    ),
    Mutation(
        "switches: the proof takes everything for tips",
        KNOWN,
        "replace(path.frames[mine], following=read.frames[its].following)",
        "replace(path.frames[mine], following=True)",
        TURNED,
    ),
    Mutation(
        "switches: the proof takes the tips of another frame",
        KNOWN,
        "    pair = path.frame * count + read.frame[row]",
        "    pair = path.frame * count + read.frame[0]",
        TESTS,
    ),
    Mutation(
        "switches: the proof lets axes move of which the source knows nothing",
        KNOWN,
        "left = (end == start) & unknown",
        "left = unknown",
        f"{TESTS}::test_what_is_not_known_may_not_move",
    ),
)
