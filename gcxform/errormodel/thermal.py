"""Axes that grow with their temperature: ball screws and scales as rods that are warm in places.

A rod at rest at one point, theta(s) warmer at its place s than when the geometry was measured,
grows by u(s) = integral of alpha theta. With sensors along it and a temperature that is linear
between them, u is quadratic between them.

The state that the axes are in is part of the model, of its fingerprint and of the certificate.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import field
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from gcxform.errormodel.model import BORDER, State
from gcxform.errormodel.tabled import AxisTables
from gcxform.system.arrays import Floats
from gcxform.values import dataclass


class Held(NamedTuple):
    """A screw held at both ends: stiffness of the bearings A (at s = 0) and B, and of the screw.

    a, b      N/mm; inf: rigid
    section   N, modulus of elasticity times cross-section
    length    mm, from bearing to bearing
    """

    a: float
    b: float
    section: float
    length: float

    def strain(self, free: float) -> float:
        """Return the strain of the axial force when the screw would grow by `free` (mm) if free.

        The force is N = -free / (1/a + 1/b + length/section), and the strain N / section.
        """
        return -free / (self.section * (1.0 / self.a + 1.0 / self.b) + self.length)


@dataclass(frozen=True)
class Rod:
    """A screw or a scale: its sensors, and how it lies beside the axis.

    at         (n,) mm, places of the sensors along the rod, from its fixed bearing or its zero
    expansion  alpha, 1/K
    zero       mm, place on the rod that belongs to axis position 0: where the nut or the head is
    sense      +1 if the axis runs towards larger places, -1 if towards smaller ones
    still      mm, axis position without error: where the axis was homed, or the scale is fixed
    held       the bearings if both ends are held; None: one end floats
    """

    at: Floats
    expansion: float
    zero: float = 0.0
    sense: int = 1
    still: float = 0.0
    held: Held | None = None

    def places(self, position: Floats | float) -> Floats:
        """Return the places (n,) mm on the rod that belong to axis positions (n,) mm."""
        return np.asarray(self.zero + self.sense * np.asarray(position, dtype=np.float64))

    def positions(self, place: Floats | float) -> Floats:
        """Return the axis positions (n,) mm that belong to places (n,) mm on the rod."""
        return np.asarray(self.sense * (np.asarray(place, dtype=np.float64) - self.zero))

    def strain(self, warmer: Floats, place: Floats) -> Floats:
        """Return du/ds (n,) at places (n,) mm, with sensors warmer by (m,) K."""
        strain = self.expansion * np.interp(place, self.at, warmer)
        if self.held is not None:
            ends = np.array([0.0, self.held.length])
            strain += self.held.strain(float(np.diff(self._free(warmer, ends))[0]))
        return np.asarray(strain)

    def growth(self, warmer: Floats, place: Floats) -> Floats:
        """Return u (n,) in mm at places (n,) mm, with sensors warmer by (m,) K.

        It counts from the bearing A, which gives way by N/a if both ends are held.
        """
        grown = self._free(warmer, place)
        if self.held is not None:
            bearings = self._free(warmer, np.array([0.0, self.held.length]))
            strain = self.held.strain(float(np.diff(bearings)[0]))
            grown += strain * (place + self.held.section / self.held.a) - bearings[0]
        return grown

    def _free(self, warmer: Floats, place: Floats) -> Floats:
        """Return the integral of alpha theta (n,) in mm from the first sensor to places (n,) mm."""
        gap = np.diff(self.at)
        nodes = np.append(0.0, np.cumsum(gap * (warmer[:-1] + warmer[1:]) / 2.0))
        cell = np.clip(np.searchsorted(self.at, place, side="right") - 1, 0, len(gap) - 1)
        beyond = place - self.at[cell]
        rise = (np.diff(warmer) / gap)[cell]
        return np.asarray(
            self.expansion * (nodes[cell] + (warmer[cell] + rise * beyond / 2.0) * beyond)
        )

    def error(self, warmer: Floats, position: Floats) -> Floats:
        """Return the error (n,) in mm at axis positions (n,) mm: zero at `still`."""
        still = np.atleast_1d(self.places(self.still))
        grown = self.growth(warmer, self.places(position)) - self.growth(warmer, still)
        return np.asarray(self.sense * grown)


@dataclass(frozen=True, eq=False)
class Stretch:
    """The error of one axis: quadratic between its nodes, straight beyond the first and the last.

    position  (n,) mm, ascending: the ends of the travel, and the sensors between them
    value     (n,) mm
    slope     (n - 1,) at the left of each cell
    bend      (n - 1,) second derivative, 1/mm
    """

    position: Floats
    value: Floats
    slope: Floats
    bend: Floats

    def at(self, coordinate: Floats) -> Floats:
        """Return the error (n,) in mm at positions (n,) in mm."""
        inside = np.clip(coordinate, self.position[0], self.position[-1])
        cell = np.searchsorted(self.position[1:-1], inside, side="right")
        part = inside - self.position[cell]
        found = self.value[cell] + part * (self.slope[cell] + part * self.bend[cell] / 2.0)
        slope = np.where(coordinate < inside, self.slope[0], self._last)
        return np.asarray(found + slope * (coordinate - inside))

    @property
    def _last(self) -> float:
        """The slope at the end."""
        return float(self.slope[-1] + self.bend[-1] * (self.position[-1] - self.position[-2]))

    @property
    def steepest(self) -> float:
        """The largest |slope|: the slope is linear in each cell, so it is at nodes."""
        right = self.slope + self.bend * np.diff(self.position)
        return float(max(np.abs(self.slope).max(), np.abs(right).max()))

    @cached_property
    def largest(self) -> float:
        """The largest |error| in mm within the travel: at nodes, or where the slope is zero."""
        with np.errstate(divide="ignore", invalid="ignore"):
            part = -self.slope / self.bend
        flat = np.isfinite(part) & (part > 0.0) & (part < np.diff(self.position))
        between = self.at(self.position[:-1][flat] + part[flat])
        return float(np.abs(np.append(self.value, between)).max())


def stretch(rod: Rod, warmer: Floats, travel: tuple[float, float], linear: bool = False) -> Stretch:
    """Return the error of an axis along its travel (mm), with sensors warmer by (n,) K.

    `linear` is what a control does that has the errors at the sensors and interpolates between
    them; it is off by alpha |rise of temperature| distance / 8 in each cell.
    """
    low, high = travel
    sensors = np.sort(rod.positions(rod.at))
    between = (sensors > low + BORDER) & (sensors < high - BORDER)
    position = np.array([low, *sensors[between], high])
    width = np.diff(position)
    if linear:
        value = np.interp(position, sensors, rod.error(warmer, sensors))
        return Stretch(position, value, np.diff(value) / width, np.zeros(len(width)))
    # de/dx = du/ds, because both the error and the way along the rod have the sign of the sense.
    slope = rod.strain(warmer, rod.places(position))
    value = rod.error(warmer, position)
    return Stretch(position, value, slope[:-1], np.diff(slope) / width)


@dataclass(frozen=True, eq=False)
class ThermalScrew(AxisTables[Stretch]):
    """The positioning errors of axes whose screws or scales are warm; see `Stretch`.

    An axis whose stretch is None has no error and no limits. `choose` returns the model in its
    state at another time.
    """

    known: tuple[State, ...] = ()
    choose: Callable[[str], ThermalScrew] | None = field(default=None, compare=False, repr=False)
    kind: ClassVar[str] = "thermal-screw"
    composed: ClassVar[bool] = True

    @property
    def states(self) -> tuple[State, ...]:
        """The state of each axis."""
        return self.known

    def at_time(self, time: str) -> ThermalScrew:
        """Return the model in its state at a time (ISO 8601). Raises UsageError."""
        return self if self.choose is None else self.choose(time)

    def add(self, total: Floats, place: Floats, tool: Floats | None, sense: Floats | None) -> None:
        """Add the errors (3, n) at places (n, 3): see `Tabled.add`."""
        for k, axis in enumerate(self.axes):
            if axis is not None:
                total[k] += axis.at(place[:, k])

    def lipschitz(self, reach: float = 0.0) -> float:
        """Return the steepest slope: dE/dc is diagonal, so it is the spectral norm, exactly."""
        slopes = [0.0 if axis is None else axis.steepest for axis in self.axes]
        return max(slopes) if all(map(math.isfinite, slopes)) else math.inf

    def curvature(self, reach: float = 0.0) -> Floats:
        """Return the largest |d2E/dx2| of each axis on the diagonal."""
        bends = [0.0 if axis is None else float(np.abs(axis.bend).max()) for axis in self.axes]
        return np.diag(bends)

    def largest(self, reach: float = 0.0) -> float:
        """Return the largest |E| in mm: that of the axes together, as each has its own place."""
        return math.hypot(*(0.0 if axis is None else axis.largest for axis in self.axes))


def drift(rod: Rod, travel: tuple[float, float]) -> float:
    """Return how much the error between the ends of a travel (mm) grows per K, in mm per K."""
    low, high = rod.error(np.ones(len(rod.at)), np.array(travel))
    return float(high - low)
