"""Faults of kinematics: signs, orders, branches, limits, and what is taken over from controls."""

from __future__ import annotations

from faults.mutation import Mutation

CHAIN = "gcxform/machine/chain.py"
INVERSE = "gcxform/machine/inverse.py"
KINDS = "gcxform/machine/kinds.py"
HAL = "plugins/gcxform_plugins/controls/linuxcnc/hal.py"
FANUC = "plugins/gcxform_plugins/controls/fanuc.py"
JOG = "gcxform/machine/jog.py"
TESTS = "tests/test_kinematics.py"
MACHINES = "tests/test_machine_kinds.py"
CONTROLS = "tests/test_controls.py"
SINUMERIK = "tests/test_controls_siemens.py"
WORDS = "tests/test_jog.py"

MUTATIONS = (
    Mutation(
        "chain: everything turns the other way",
        CHAIN,
        "found[..., k] = own + sine * across + rest * back",
        "found[..., k] = own - sine * across + rest * back",
        TESTS,
    ),
    Mutation(
        "chain: the sign of an axis is forgotten",
        CHAIN,
        "self.direction, self.sign * degrees) + point",
        "self.direction, degrees) + point",
        TESTS,
    ),
    Mutation(
        "chain: vectors swing without the sign",
        CHAIN,
        "return turned(vectors, self.direction, self.sign * degrees)",
        "return turned(vectors, self.direction, degrees)",
        TESTS,
    ),
    Mutation(
        "chain: the table turns the tool its own way",
        CHAIN,
        "vectors = axis.swing(vectors, -angles[..., k])",
        "vectors = axis.swing(vectors, angles[..., k])",
        TESTS,
    ),
    Mutation(
        "chain: tables from the workpiece inwards",
        CHAIN,
        """        for k, axis in enumerate(self.table):
            points = axis.turn""",
        """        for k, axis in reversed([*enumerate(self.table)]):
            points = axis.turn""",
        TESTS,
    ),
    Mutation(
        "chain: head axes take the angles of the table",
        CHAIN,
        """        points = self._everywhere(self.tip, angles)
        for k, axis in reversed([*enumerate(self.head, len(self.table))]):""",
        """        points = self._everywhere(self.tip, angles)
        for k, axis in reversed([*enumerate(self.head)]):""",
        TESTS,
    ),
    Mutation(
        "chain: an axis through the origin",
        CHAIN,
        "point = np.array(self.point)",
        "point = 0.0 * np.array(self.point)",
        TESTS,
    ),
    Mutation(
        "chain: the tip is above the gauge point",
        CHAIN,
        "np.subtract(gauge_point, tool.vector)",
        "np.add(gauge_point, tool.vector)",
        MACHINES,
    ),
    Mutation(
        "inverse: the axis at the base is first",
        INVERSE,
        "loop = table[::-1] + head",
        "loop = table + head",
        TESTS,
    ),
    Mutation(
        "inverse: tables count as heads do",
        INVERSE,
        "_Turn(k, axis.direction, -axis.sign)",
        "_Turn(k, axis.direction, axis.sign)",
        TESTS,
    ),
    Mutation(
        "inverse: one branch twice",
        INVERSE,
        "enumerate((two.factor, -two.factor))",
        "enumerate((two.factor, two.factor))",
        TESTS,
    ),
    Mutation(
        "inverse: the branches are exchanged",
        INVERSE,
        "enumerate((two.factor, -two.factor))",
        "enumerate((-two.factor, two.factor))",
        TESTS,
    ),
    Mutation(
        "inverse: the triangle has one side twice",
        INVERSE,
        "np.sin((tilt + a - b) / 2.0) * np.sin((tilt - a + b) / 2.0)",
        "np.sin((tilt + a - b) / 2.0) * np.sin((tilt + a - b) / 2.0)",
        TESTS,
    ),
    Mutation(
        "inverse: psi by a cosine",
        INVERSE,
        "corner = np.degrees(_corner(a, b, tilt))",
        "corner = np.degrees(np.arccos(np.clip((np.cos(tilt) - math.cos(a) * math.cos(b))"
        " / (math.sin(a) * math.sin(b)), -1.0, 1.0)))",
        TESTS,
    ),
    Mutation(
        "inverse: the reach does not end at a + b",
        INVERSE,
        "miss = np.maximum(np.maximum(least - tilt, tilt - most), 0.0)",
        "miss = np.maximum(least - tilt, 0.0)",
        TESTS,
    ),
    Mutation(
        "inverse: no hole at the pole",
        INVERSE,
        "miss = np.maximum(np.maximum(least - tilt, tilt - most), 0.0)",
        "miss = np.maximum(tilt - most, 0.0)",
        TESTS,
    ),
    Mutation(
        "inverse: the far side of the reach is forgotten",
        INVERSE,
        "abs(a - b), min(a + b, 2.0 * math.pi - a - b)",
        "abs(a - b), a + b",
        TESTS,
    ),
    Mutation(
        "inverse: what is unreachable is allowed",
        INVERSE,
        "allowed &= (found.state != State.UNREACHABLE)[:, None]",
        "allowed &= (found.state != State.BORDER)[:, None]",
        TESTS,
    ),
    Mutation(
        "inverse: one turn within any limits",
        INVERSE,
        "return 1 + int((high - low + 2.0 * SLACK) // TURN)",
        "return 1",
        TESTS,
    ),
    Mutation(
        "inverse: the first turn may be below the limit",
        INVERSE,
        "np.ceil((lowest - angle) / TURN)",
        "np.floor((lowest - angle) / TURN)",
        TESTS,
    ),
    Mutation(
        "inverse: no slack at the limits",
        INVERSE,
        "SLACK = 1e-9",
        "SLACK = 0.0",
        TESTS,
    ),
    Mutation(
        "inverse: the travel of X, Y and Z is not looked at",
        INVERSE,
        "(linear >= low - SLACK) & (linear <= high + SLACK)",
        "(linear >= low - SLACK) | (linear <= high + SLACK)",
        TESTS,
    ),
    Mutation(
        "inverse: a free angle beyond its limits",
        INVERSE,
        "angle[pole, :, free] = min(max(0.0, low), high)",
        "angle[pole, :, free] = 0.0",
        TESTS,
    ),
    Mutation(
        "kinds: heads turn as tables do",
        KINDS,
        "return 1 if letter in cls.head else -1",
        "return -1",
        MACHINES,
    ),
    Mutation(
        "kinds: nutating axes lean the other way",
        KINDS,
        "return 0.0, math.sin(lean), math.cos(lean)",
        "return 0.0, -math.sin(lean), math.cos(lean)",
        MACHINES,
    ),
    Mutation(
        "kinds: an axis that is given backwards turns backwards",
        KINDS,
        "(-1 if _opposed(direction, kind, letter, file) else 1)",
        "1",
        MACHINES,
    ),
    Mutation(
        "machine files: a line is turned around without its sign (C8)",
        "gcxform/machine/file.py",
        "sign = None if axis.sign is None else flip * axis.sign",
        "sign = axis.sign",
        MACHINES,
    ),
    Mutation(
        "LinuxCNC: tables of the trt modules turn as in ISO 841",
        HAL,
        "sign = -1 if pins.get(CONVENTIONAL) else 1",
        "sign = 1 if pins.get(CONVENTIONAL) else -1",
        CONTROLS,
    ),
    Mutation(
        "LinuxCNC: the tilting axis is through the rotary one",
        HAL,
        'point=(x, y + at.get("y-offset", 0.0), up)',
        "point=(x, y, up)",
        CONTROLS,
    ),
    Mutation(
        "FANUC: tools turn left-handed",
        FANUC,
        "sign = -1 if values[sense] else 1",
        "sign = 1 if values[sense] else -1",
        CONTROLS,
    ),
    Mutation(
        "FANUC: the first axis of the head is as high as the second",
        FANUC,
        "return _sum(swivel, _vector(values, HEAD)), swivel",
        "return swivel, swivel",
        CONTROLS,
    ),
    Mutation(
        "Siemens: the second axis of the table is measured from the machine",
        "plugins/gcxform_plugins/controls/siemens.py",
        """_sum(vectors["I2"], vectors["I3"]))""",
        """_sum(vectors["I3"]))""",
        SINUMERIK,
    ),
    Mutation(
        "Siemens: vectors of axes are turned around",
        "plugins/gcxform_plugins/controls/siemens.py",
        "point=point, sign=1)",
        "point=point, sign=-1)",
        SINUMERIK,
    ),
    Mutation(
        "jog: clockwise is said the other way",
        JOG,
        '"counterclockwise" if rotary.sign > 0 else "clockwise"',
        '"clockwise" if rotary.sign > 0 else "counterclockwise"',
        WORDS,
    ),
    Mutation(
        "jog: what is carried goes the other way",
        JOG,
        "goes = rotary.sign * np.cross(way, side)",
        "goes = rotary.sign * np.cross(side, way)",
        WORDS,
    ),
    Mutation(
        "jog: the tip is held where it is afterwards",
        JOG,
        "held = chain.linear(before[0], moved) - linear",
        "held = chain.linear(tip, moved) - linear",
        WORDS,
    ),
    Mutation(
        "picture: arrows turn against +",
        "gcxform/plot/chains.py",
        "AROUND) + point  # the sense of +",
        "-AROUND) + point  # the sense of +",
        WORDS,
    ),
)
