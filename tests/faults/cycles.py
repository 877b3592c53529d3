"""Faults in the arithmetic of canned cycles."""

from __future__ import annotations

from faults.mutation import CYCLES, Mutation

LEVELS = "gcxform/modal/cycles.py"
STEPS = "gcxform/modal/cyclesteps.py"

FAULTS = (
    (
        "words of another cycle stay",
        LEVELS,
        "& (not rule.keeps_words)",
        "& False",
    ),
    (
        "words do not stay",
        LEVELS,
        "~np.isnan(word) | self.fresh, self",
        "self.fresh | True, self",
    ),
    (
        "G98 goes back to R",
        LEVELS,
        "np.maximum(initial, self.clearance), self",
        "self.clearance, self",
    ),
    (
        "G98 goes back to the initial level, even below R",
        LEVELS,
        "np.maximum(initial, self.clearance)",
        "initial",
    ),
    (
        "the initial level is taken anew",
        LEVELS,
        "mode.initial if mode.code else ",
        "",
    ),
    (
        "over the hole before up to R",
        LEVELS,
        "self.rises = initial < self.clearance",
        "pass",
    ),
    (
        "over the hole at R",
        LEVELS,
        "level = np.where(standing > self.clearance, standing, low)",
        "level = low",
    ),
    (
        "under G98 over the hole at R",
        LEVELS,
        "low = np.where(calls.initial, initial, self.clearance)",
        "low = self.clearance",
    ),
    (
        "increments are made once",
        LEVELS,
        "word * self.repeats",
        "word",
    ),
    (
        "increments are made at once",
        LEVELS,
        "(count[call] - 1 - number)",
        "(0 * number)",
    ),
    (
        "R is a distance from nowhere",
        LEVELS,
        "np.where(calls.incremental, initial, 0.0)",
        "0.0",
    ),
    (
        "the bottom is a distance from nowhere",
        LEVELS,
        "np.where(calls.incremental, self.clearance, 0.0)",
        "0.0",
    ),
    (
        "the middle is no distance",
        LEVELS,
        "middle + np.where(calls.incremental, self.bottom, 0.0)",
        "middle + 0.0",
    ),
    (
        "blocks that store words drill",
        LEVELS,
        "wanted & (self.repeats > 0)",
        "self.repeats > -1",
    ),
    (
        "inches are counted in mm",
        LEVELS,
        "lengths if unit == 1.0 else",
        "lengths if unit > 0.0 else",
    ),
    (
        "every repeat rises",
        LEVELS,
        "self.rises[call] & (number == 0)",
        "self.rises[call]",
    ),
    (
        "repeats come from where the first came",
        LEVELS,
        "np.where(number == 0, self.level[call], self.retract[call])",
        "self.level[call]",
    ),
    (
        "the dwell is forgotten",
        LEVELS,
        "_Mode(dwell=self.mode.dwell)",
        "_Mode()",
    ),
    (
        "pecks begin at the last depth",
        STEPS,
        "depth + back)",
        "depth)",
    ),
    (
        "clearance and return are swapped",
        STEPS,
        "clears, rule.peck_clearance or 0.0, rule.peck_return or 0.0",
        "clears, rule.peck_return or 0.0, rule.peck_clearance or 0.0",
    ),
    (
        "the first peck is left out",
        STEPS,
        "(peck + 1) * holes",
        "(peck + 2) * holes",
    ),
    (
        "pecks are not cleared",
        STEPS,
        "np.where(clears & (part == 1), top, normal)",
        "normal",
    ),
    (
        "the rise is made over the hole",
        STEPS,
        "end[rising, :2] = holes.start[hole[rising]]",
        "pass",
    ),
    (
        "the tool is not shifted",
        STEPS,
        "end[shifted, axis] += holes",
        "end[shifted, axis] += 0 * holes",
    ),
    (
        "down to R before the hole",
        STEPS,
        "at[rows] == holes.rises[hole[rows]]",
        "at[rows] == 1 + holes.rises[hole[rows]]",
    ),
    (
        "what is done comes a move too late",
        STEPS,
        "row + number + 1",
        "row + number + 2",
    ),
    (
        "the spindle turns the other way",
        STEPS,
        "spindle > 0 else",
        "spindle < 0 else",
    ),
    (
        "the rounding of many pecks",
        STEPS,
        "if len(doubtful):",
        "if False:",
    ),
)
"""Name, file, old, new; the tests are those of cycles."""

MUTATIONS = (
    *(Mutation(f"cycles: {name}", *where, CYCLES) for name, *where in FAULTS),
    Mutation(
        "cycles: a hole above R",
        "gcxform/modal/cycles.py",
        "self.bottom > self.clearance",
        "self.bottom > np.inf",
        "tests/test_cycle_refusals.py",
    ),
)
