"""Faults of error tables: signs, directions of travel, and what conversions keep."""

from __future__ import annotations

from faults.mutation import Mutation

FORMATS = "plugins/gcxform_plugins/formats"
TABLES = "plugins/gcxform_plugins/tables"
COMP = "tests/test_linuxcnc_comp.py::test_the_sign"
COMP_WRITTEN = "tests/test_linuxcnc_comp.py::test_what_is_written"
PARAMETERS = "tests/test_parameter_formats.py"
HEIGHTS = "tests/test_height_formats.py"
SIEMENS = "tests/test_siemens_formats.py"
POSITIONING = "tests/test_positioning_formats.py"
CONVERTING = "tests/test_converting.py"

MUTATIONS = (
    # pitch tables and conversions
    Mutation(
        "pitch: forward and reverse are swapped",
        "gcxform/errormodel/pitch.py",
        "found[0] + sense[..., k] * found[1]",
        "found[0] - sense[..., k] * found[1]",
        CONVERTING,
    ),
    Mutation(
        "pitch: the mean is the forward error",
        "gcxform/errormodel/pitch.py",
        "(self.forward + self.reverse) / 2.0",
        "self.forward",
        CONVERTING,
    ),
    Mutation(
        "pitch: corrections are errors",
        "gcxform/errormodel/pitch_file.py",
        'sign = -1.0 if file.values == "correction" else 1.0',
        "sign = 1.0",
        CONVERTING,
    ),
    Mutation(
        "lattice: turns have the other sign",
        "gcxform/errormodel/converting.py",
        "np.stack([by_y[:, 2], -by_x[:, 2], by_x[:, 1]], axis=1)",
        "np.stack([by_y[:, 2], by_x[:, 2], by_x[:, 1]], axis=1)",
        CONVERTING,
    ),
    Mutation(
        "functions: the levers are those of the other end",
        "gcxform/errormodel/converting.py",
        "order[order.index(axis) + 1 :]",
        "order[: order.index(axis)]",
        CONVERTING,
    ),
    Mutation(
        "functions: the mean is counted thrice",
        "gcxform/errormodel/converting.py",
        "for j in range(3) if j != k)) - whole for k in range(3)]",
        "for j in range(3) if j != k)) for k in range(3)]",
        CONVERTING,
    ),
    # LinuxCNC
    Mutation(
        "linuxcnc-comp: positions are the other way round",
        "plugins/gcxform_plugins/formats/linuxcnc_comp.py",
        'column - position if self.type == "0"',
        'position - column if self.type == "0"',
        COMP,
    ),
    Mutation(
        "linuxcnc-comp: trims are errors",
        "plugins/gcxform_plugins/formats/linuxcnc_comp.py",
        "else -column",
        "else column",
        COMP,
    ),
    Mutation(
        "linuxcnc-comp: forward is reverse",
        "plugins/gcxform_plugins/formats/linuxcnc_comp.py",
        "position, forward, reverse = numbers.T",
        "position, reverse, forward = numbers.T",
        COMP,
    ),
    Mutation(
        "linuxcnc-comp: errors are written as trims",
        "plugins/gcxform_plugins/formats/linuxcnc_comp.py",
        'sign = 1.0 if self.type == "0" else -1.0',
        "sign = 1.0",
        COMP_WRITTEN,
    ),
    # ISG, ETALON
    Mutation(
        "parameters: corrections are errors",
        "plugins/gcxform_plugins/formats/shared/parameters.py",
        "{n: (p, -v) for n, (p, v)",
        "{n: (p, v) for n, (p, v)",
        PARAMETERS,
    ),
    Mutation(
        "parameters: squareness leans the other way",
        "plugins/gcxform_plugins/formats/shared/parameters.py",
        '"C0Y": ("EXY", -1.0)',
        '"C0Y": ("EXY", 1.0)',
        PARAMETERS,
    ),
    Mutation(
        "parameters: squareness of Z to X leans the other way",
        "plugins/gcxform_plugins/formats/shared/parameters.py",
        '"B0Z": ("EXZ", 1.0)',
        '"B0Z": ("EXZ", -1.0)',
        PARAMETERS,
    ),
    Mutation(
        "parameters: squareness of Z to Y leans the other way",
        "plugins/gcxform_plugins/formats/shared/parameters.py",
        '"A0Z": ("EYZ", -1.0)',
        '"A0Z": ("EYZ", 1.0)',
        PARAMETERS,
    ),
    Mutation(
        "parameters: the place of the measurement is forgotten",
        "plugins/gcxform_plugins/formats/shared/parameters.py",
        "values[:, :3] -= np.cross(values[:, 3:], away)",
        "values[:, :3] += np.cross(values[:, 3:], away)",
        PARAMETERS,
    ),
    # height maps, skew
    Mutation(
        "heights: high surfaces lower the tool",
        "plugins/gcxform_plugins/formats/shared/height_points.py",
        "values[:, :, 0, 2] = -height.T",
        "values[:, :, 0, 2] = height.T",
        HEIGHTS,
    ),
    Mutation(
        "heights: X and Y are swapped",
        "plugins/gcxform_plugins/formats/shared/height_points.py",
        "_place(row, 1, y, at_y), _place(row, 0, x, at_x)",
        "_place(row, 0, x, at_x), _place(row, 1, y, at_y)",
        HEIGHTS,
    ),
    Mutation(
        "klipper-skew: the other way",
        "plugins/gcxform_plugins/formats/klipper.py",
        "matrix[to, by] = section.number(key)",
        "matrix[to, by] = -section.number(key)",
        HEIGHTS,
    ),
    # Siemens
    Mutation(
        "siemens-eec: values are corrections",
        "plugins/gcxform_plugins/formats/siemens_eec.py",
        "values[:, axis] = value",
        "values[:, axis] = -value",
        SIEMENS,
    ),
    Mutation(
        "siemens-cec: a positive value moves the other way",
        "plugins/gcxform_plugins/formats/siemens_cec.py",
        '1.0 if self.positive == "minus" else -1.0',
        '1.0 if self.positive == "plus" else -1.0',
        SIEMENS,
    ),
    Mutation(
        "siemens-cec: input and output are swapped",
        "plugins/gcxform_plugins/formats/siemens_cec.py",
        'AXIS_KEYS = ("_INPUT_AXIS", "_OUTPUT_AXIS")',
        'AXIS_KEYS = ("_OUTPUT_AXIS", "_INPUT_AXIS")',
        SIEMENS,
    ),
    Mutation(
        "siemens-cec: directions are swapped",
        "plugins/gcxform_plugins/formats/siemens_cec.py",
        "forward += values * (part.sense >= 0)",
        "forward += values * (part.sense <= 0)",
        SIEMENS,
    ),
    # positioning tests
    Mutation(
        "iso230-csv: directions are swapped",
        "plugins/gcxform_plugins/formats/iso230_csv.py",
        'SENSES = {"+": 1, "-": -1}',
        'SENSES = {"+": -1, "-": 1}',
        POSITIONING,
    ),
    Mutation(
        "renishaw-rtl: the first run goes back",
        "plugins/gcxform_plugins/formats/renishaw_rtl.py",
        "sense = rising if run % 2 or not both else -rising",
        "sense = -rising if run % 2 or not both else rising",
        POSITIONING,
    ),
    Mutation(
        "renishaw-rtl: targets always rise",
        "plugins/gcxform_plugins/formats/renishaw_rtl.py",
        "rising = 1 if targets[-1:] > targets[:1] else -1",
        "rising = 1",
        POSITIONING,
    ),
    # LDDM
    Mutation(
        "lddm: columns are written in another order",
        "plugins/gcxform_plugins/formats/lddm.py",
        "np.column_stack([function.position, function.values])",
        "np.column_stack([function.position, function.values[:, ::-1]])",
        "tests/test_table_verb.py",
    ),
)
