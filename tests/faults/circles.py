"""Faults of circular tests of linear axes: their causes, their tables, what is made of them."""

from __future__ import annotations

from faults.mutation import Mutation

FITS = "tests/test_circles.py"
FILES = "tests/test_circle_files.py"
CAUSES = "gcxform/calibrate/circles/causes.py"
CIRCLES = "gcxform/calibrate/circles/circles.py"
MACHINE = "gcxform/calibrate/circles/machine.py"
TABLE = "gcxform/calibrate/circles/file.py"
DRIVES = "gcxform/simulate/drives.py"


def _circles(file: str, name: str, old: str, new: str, tests: str = FITS) -> Mutation:
    return Mutation(f"circle tests: {name}", file, old, new, tests)


SCALES = "gcxform/calibrate/circles/scales.py"
BOWS = "gcxform/calibrate/circles/bows.py"
PERIODS = "gcxform/calibrate/circles/periods.py"

MUTATIONS = (
    _circles(
        SCALES, "any radius is believed", "if away > REJECTED * self.radius_noise:", "if False:"
    ),
    _circles(SCALES, "any scale is believed", "if abs(largest.value) > LARGEST:", "if False:"),
    _circles(
        SCALES,
        "a radius is sure",
        "deviations.append(self.radius_noise)",
        "deviations.append(1e-9)",
    ),
    _circles(SCALES, "points tell their own radius", "calibrated and setup.stated", "calibrated"),
    _circles(
        BOWS, "bows of the other axis", "into, along = axes[1 - place]", "into, along = axes[place]"
    ),
    _circles(PERIODS, "one look is enough", "1.0 + width * math.sqrt(z)", "1.0"),
    _circles(PERIODS, "pitches of both axes at once", "letters.remove(letter)", "letters.clear()"),
    _circles(CAUSES, "squareness of the other sign", "-0.5 * np.sin(twice)", "0.5 * np.sin(twice)"),
    _circles(
        CAUSES, "servo mismatch of no sense", "0.5 * np.sin(twice) * sense", "0.5 * np.sin(twice)"
    ),
    _circles(
        CAUSES, "one backlash for both ends", "(1.0 + side * along) / 2.0", "0.5 + 0.0 * along"
    ),
    _circles(
        CAUSES, "spikes are fitted", "found |= (sense != 0) & (way", "found &= (sense != 0) & (way"
    ),
    _circles(
        CAUSES, "play as backlash", "-sense * np.abs(np.cos(t)) / 2.0", "-sense * np.cos(t) / 2.0"
    ),
    _circles(
        CIRCLES,
        "smooth residuals count in full",
        "self.scatter.ratio * smooth",
        "self.scatter.ratio",
    ),
    _circles(
        CIRCLES, "what no reading depends on is told", "~(free > NEGLIGIBLE)", "~(free > 2.0)"
    ),
    _circles(
        CIRCLES,
        "a pivot far off is squareness",
        "readings - second[used]",
        "readings + 0.0 * second[used]",
    ),
    _circles(MACHINE, "B0Z of the other sign", '("B0Z", -1.0)', '("B0Z", 1.0)'),
    _circles(MACHINE, "a slope of the other sign", "(1, 2, -1.0)", "(1, 2, 1.0)", FILES),
    _circles(
        SCALES, "a bar at one feed tells scales", "-((feed / setup.radius) ** 2) / 2.0", "0.0"
    ),
    _circles(
        MACHINE, "a model of one sense", 'if test.index("squareness") is None:', "if not test.runs:"
    ),
    _circles(TABLE, "a touch is as a bar", "sign = 1.0 if sense else -1.0", "sign = 1.0", FILES),
    _circles(
        TABLE,
        "the way travelled is the place",
        "        return -degrees",
        "        return degrees",
        FILES,
    ),
    _circles(
        TABLE,
        "rising angles are those of the place",
        "if not _rising(degrees) or said",
        "if True or said",
        FILES,
    ),
    _circles(TABLE, "the way in is a part of the run", "> TURN:", "> 1e9:", FILES),
    _circles(
        "gcxform/plot/polar.py",
        "a diagram about the pivot",
        "_about(path - centre, radius)",
        "_about(path - 0.0 * centre, radius)",
        f"{FILES}::test_the_sheet_shows_both_senses_the_causes_and_what_is_left",
    ),
    _circles(DRIVES, "an axis leads its command", "-= self.lag[axis]", "+= self.lag[axis]", FILES),
    _circles(
        "gcxform/calibrate/csv_text.py",
        "points among commas",
        'if "." in text else text.replace',
        'if "!" in text else text.replace',
        FILES,
    ),
)
