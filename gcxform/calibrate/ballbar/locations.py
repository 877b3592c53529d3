"""The names of location errors: of each rotary axis by itself, and of a trunnion's axes in turn.

Those of ISO 230-7: YOA and ZOA are where the axis A is off, BOA and COA about what its direction
is turned, and likewise for the others. They are counted at the points that the machine file names,
with all axes at 0.

The eight of a trunnion (Tsutsumi and Saito, Int. J. Mach. Tools Manuf. 43 (2003) 771) go from axis
to axis: dxAY, dyAY, dzAY, alAY, beAY, gaAY of the tilting axis as it stands on Y, with the table C
and all, and dyCA, beCA of C as it stands on A. With o from the point of A to that of C

    XOC = dxAY + beAY oz - gaAY oy          AOC = alAY
    YOC = dyAY + gaAY ox - alAY oz + dyCA   BOC = beAY + beCA

and YOA = dyAY, ZOA = dzAY, BOA = beAY, COA = gaAY. With B and C it is the same in X, and alCB.
"""

from __future__ import annotations

import numpy as np

from gcxform.calibrate.ballbar.ballbar import Identified
from gcxform.calibrate.rotary.predicted_check import effects
from gcxform.machine.chain import Chain
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

TURNS = "ABC"
GREEK = ("al", "be", "ga")


@dataclass(frozen=True, eq=False)
class Named:
    """Errors by name, mm and rad, with the covariance (n, n)."""

    names: tuple[str, ...]
    value: Floats
    covariance: Floats

    @property
    def deviation(self) -> Floats:
        """The standard deviations (n,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance).clip(0.0)))


def locations(found: Identified) -> Named:
    """Return the location errors of each axis: two shifts and two turns, in the order of axes."""
    names: list[str] = []
    parts = np.zeros((0, len(found.unknowns)))
    for k, axis in enumerate(found.believed.table):
        shift, turn = effects(axis)
        rows = np.zeros((4, len(found.unknowns)))
        others = [j for j in range(3) if j != int(np.abs(axis.direction).argmax())]
        rows[:2, 4 * k : 4 * k + 2] = shift[others]
        rows[2:, 4 * k + 2 : 4 * k + 4] = turn[others]
        parts = np.vstack([parts, rows])
        names += [f"{'XYZ'[j]}O{axis.letter}" for j in others]
        names += [f"{TURNS[j]}O{axis.letter}" for j in others]
    return Named(tuple(names), parts @ found.unknowns, parts @ found.covariance @ parts.T)


def of_trunnion(found: Identified) -> Named | None:
    """Return the eight errors of a tilting axis A or B that carries a table C; None of others."""
    chain = found.believed
    if [axis.letter for axis in chain.table] not in (["A", "C"], ["B", "C"]):
        return None
    where = locations(found)
    matrix = _in_turn(chain)
    tilting = TURNS.index(chain.table[0].letter)
    other = 1 - tilting
    pair = f"{TURNS[tilting]}Y"
    names = [f"d{axis}{pair}" for axis in "xyz"] + [f"{angle}{pair}" for angle in GREEK]
    names += [f"d{'xy'[other]}C{TURNS[tilting]}", f"{GREEK[other]}C{TURNS[tilting]}"]
    return Named(tuple(names), matrix @ where.value, matrix @ where.covariance @ matrix.T)


def _in_turn(chain: Chain) -> Floats:
    """Return the eight errors from axis to axis (8, 8) for those of each by itself."""
    first, second = chain.table
    tilting = TURNS.index(first.letter)
    other = 1 - tilting
    ox, oy, oz = np.subtract(second.point, first.point).tolist()
    lever = np.array([[0.0, oz, -oy], [-oz, 0.0, ox]])  # of the turns, at the point of C
    turns = np.zeros((3, 8))
    turns[tilting, 6 + tilting] = 1.0  # about its own axis it is seen as that of C
    turns[other, 2] = turns[2, 3] = 1.0
    shifts = np.zeros((3, 8))
    shifts[other, 0] = shifts[2, 1] = 1.0
    carried = lever @ turns
    shifts[tilting] = np.eye(8)[4 + tilting] - carried[tilting]
    beside = np.eye(8)[4 + other] - carried[other] - shifts[other]
    turned = np.eye(8)[6 + other] - turns[other]
    return np.vstack([shifts, turns, beside, turned])
