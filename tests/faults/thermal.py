"""Faults of thermal models: the growth of a rod, its readings, its state."""

from __future__ import annotations

from faults.mutation import RIGID, Mutation

NUMBERS = "tests/test_thermal.py"
FILES = "tests/test_thermal_files.py"
PASS = "tests/test_thermal_pass.py"
ROD = "gcxform/errormodel/thermal.py"
READINGS = "gcxform/errormodel/temperatures.py"
FILE = "gcxform/errormodel/thermal_file.py"


def _fault(name: str, file: str, old: str, new: str, tests: str = NUMBERS) -> Mutation:
    return Mutation(f"thermal: {name}", file, old, new, tests)


MUTATIONS = (
    _fault("no half of the last cell", ROD, "rise * beyond / 2.0) * beyond", "rise) * beyond"),
    _fault(
        "the sum of the ends, not the mean", ROD, "(warmer[:-1] + warmer[1:]) / 2.0", "warmer[1:]"
    ),
    _fault("the wrong sense of the rod", ROD, "self.zero + self.sense * np", "self.zero + np"),
    _fault("the wrong sense of the error", ROD, "self.sense * grown)", "grown)"),
    _fault(
        "never homed", ROD, "- self.growth(warmer, still)", "- 0.0 * self.growth(warmer, still)"
    ),
    _fault(
        "a bearing that gives way is rigid", ROD, "(1.0 / self.a + 1.0 / self.b)", "(1.0 / self.a)"
    ),
    _fault("the screw itself is rigid", ROD, " + self.length)", ")"),
    _fault(
        "the bearing A does not move", ROD, "(place + self.held.section / self.held.a)", "place"
    ),
    _fault("a wrong curve", ROD, "part * self.bend[cell] / 2.0", "part * self.bend[cell]"),
    _fault(
        "the slope of a held screw",
        ROD,
        "strain += self.held.strain(",
        "strain += 0.0 * (",
    ),
    _fault(
        "beyond the travel the slope goes on growing",
        ROD,
        "inside = np.clip(coordinate, self.position[0], self.position[-1])",
        "inside = coordinate",
    ),
    _fault("the steepest place is at the left", ROD, "np.abs(right).max()", "0.0"),
    _fault("a smaller bend", ROD, "np.abs(axis.bend).max()", "np.abs(axis.bend).mean()", RIGID),
    _fault(
        "the largest error at nodes only",
        ROD,
        "np.append(self.value, between)",
        "self.value",
        FILES,
    ),
    _fault("the axes take turns", ROD, "math.hypot(*(0.0 if", "max(*(0.0 if"),
    _fault("kelvin", READINGS, "KELVIN = 273.15", "KELVIN = 273.0", FILES),
    _fault(
        "the row after the time",
        READINGS,
        "self.rows[number - 1]",
        "self.rows[min(number, len(self.rows) - 1)]",
        FILES,
    ),
    _fault(
        "the row before the same time", READINGS, "bisect.bisect_right", "bisect.bisect_left", FILES
    ),
    _fault("readings of any age", READINGS, "if age > oldest:", "if age > 10 * oldest:", FILES),
    _fault(
        "the reference is not subtracted",
        FILE,
        "np.array(warm) - self._reference(axis)",
        "np.array(warm)",
        FILES,
    ),
    _fault(
        "the reference counts twice",
        FILE,
        "- self._reference(axis)",
        "- 2 * self._reference(axis)",
        FILES,
    ),
    _fault("stiffness in N/mm", FILE, "Held(ends.kA / UM,", "Held(ends.kA,"),
    _fault(
        "no limit",
        FILE,
        "if not state.largest <= self.file.limit:",
        "if state.largest < 0.0:",
        FILES,
    ),
    _fault(
        "the pass forgets its time",
        "plugins/gcxform_plugins/passes/volumetric/volumetric.py",
        "self.model.at_time(self.time)",
        "self.model",
        PASS,
    ),
    _fault(
        "the readings are not in the fingerprint",
        "gcxform/contract/option_kinds.py",
        'data += fingerprint(model) if model.composed else b""',
        'data += b""',
        FILES,
    ),
)
