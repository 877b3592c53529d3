"""Faults of virtual tests: standard programs, where the machine is, figures, deviations."""

from __future__ import annotations

from faults.mutation import Mutation

FIGURES = "tests/test_figures.py"
TESTS = "tests/test_simulate.py"
PICTURES = "tests/test_pictures.py"
MODELS = "tests/test_model_pictures.py"
FOLDER = "gcxform/simulate"

MUTATIONS = (
    Mutation(
        "simulate: the machine is off the other way",
        "gcxform/simulate/positions.py",
        "return commanded + self.model.error(",
        "return commanded - self.model.error(",
        TESTS,
    ),
    Mutation(
        "simulate: the sense of travel is forgotten where an axis stands",
        "gcxform/simulate/positions.py",
        "last = np.maximum.accumulate(moved, axis=0)",
        "last = moved",
        TESTS,
    ),
    Mutation(
        "simulate: a target is read where its line begins",
        "gcxform/simulate/positions.py",
        'side="right") - 1\n        return',
        'side="left") - 1\n        return',
        TESTS,
    ),
    Mutation(
        "simulate: the senses of circles are swapped",
        "gcxform/simulate/programs.py",
        '{"ccw": "G3", "cw": "G2"}',
        '{"ccw": "G2", "cw": "G3"}',
        TESTS,
    ),
    Mutation(
        "simulate: the pivot is the programmed centre",
        "gcxform/simulate/virtual.py",
        "[0] + self.pivot\n",
        "[0] * 0 + self.centre + self.pivot\n",
        TESTS,
    ),
    Mutation(
        "simulate: runs down are not turned around",
        "gcxform/simulate/virtual.py",
        'runs if way == "up" else runs[:, ::-1]',
        "runs",
        TESTS,
    ),
    Mutation(
        "simulate: a diagonal of one axis goes the other way",
        "gcxform/simulate/virtual.py",
        '[c == "N" for c in name]], [low, high], middle)',
        '[c == "N" for c in name]], [high, low], middle)',
        TESTS,
    ),
    Mutation(
        "figures: s with n instead of n - 1",
        "gcxform/simulate/figures.py",
        "ddof=1",
        "ddof=0",
        FIGURES,
    ),
    Mutation(
        "figures: the reversal error is left out of R",
        "gcxform/simulate/figures.py",
        "(up + down) / 2 + np.abs(self.reversal)",
        "(up + down) / 2",
        FIGURES,
    ),
    Mutation(
        "figures: A up to the lower limits only",
        "gcxform/simulate/figures.py",
        "float(high_up.max() - low_up.min())",
        "float(low_up.max() - low_up.min())",
        FIGURES,
    ),
    Mutation(
        "circles: G about the mean of the points",
        "gcxform/calibrate/circles/deviations.py",
        "return mean + centre,",
        "return mean,",
        FIGURES,
    ),
    Mutation(
        "circles: G(b) of one sense",
        "gcxform/calibrate/circles/deviations.py",
        "circular_deviation(both)",
        "circular_deviation(next(iter(paths.values())))",
        FIGURES,
    ),
    Mutation(
        "show: squareness without the other straightness",
        "gcxform/plot/models.py",
        "sign * (_slope(found[one]) + _slope(found[other]))",
        "sign * _slope(found[one])",
        MODELS,
    ),
    Mutation(
        "show: the worst place by its executed line",
        "gcxform/simulate/heat.py",
        'f"line {line}{beside}"',
        'f"line {self.line[self.worst]}{beside}"',
        f"{PICTURES}::test_the_worst_place_is_named_by_the_line_of_the_file",
    ),
    Mutation(
        "show: rapids are the worst",
        "gcxform/simulate/heat.py",
        "feeds[np.argmax(self.deviation[feeds])]",
        "np.argmin(self.deviation)",
        f"{PICTURES}::test_the_worst_place_is_named_by_the_line_of_the_file",
    ),
    Mutation(
        "show: moves of a cycle are taken for one another",
        "gcxform/simulate/heat.py",
        "far <= far.min() + NEAR",
        "far >= far.min() + NEAR",
        PICTURES,
    ),
    Mutation(
        "show: the path as commanded, without the machine's error",
        "gcxform/simulate/heat.py",
        "return pipeline.path_passes[-1].undo(path, pipeline.context)",
        "return path",
        PICTURES,
    ),
)
