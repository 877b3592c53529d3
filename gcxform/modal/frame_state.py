"""Which frame is in force: work offsets, G52, G92, rotation, scaling, tool length.

The state is a value: acts (`gcxform/modal/frames/acts.py`) return a new one. All zeros are told as
positions (see `gcxform/toolpath/frames.py`), nan where they are not known.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from math import isfinite, nan
from typing import TYPE_CHECKING, Final

import numpy as np

from gcxform.catalogue.remedies import SET_ANEW
from gcxform.system.arrays import Floats
from gcxform.toolpath.frames import Frame, Matrix, Vector
from gcxform.values import dataclass

NO_TOOL = (0.0, 0.0, 0.0)
BY_VALUE = "G43.1"
"""The name of a tool vector that the program gives."""
INSTEAD = f"{BY_VALUE} instead of a number"
"""And of one that takes the place of a length by its number, which has not been ended."""
UNFRAMED: Final = frozenset(
    {
        *("known", "in_spindle", "changes", "homes", "written", "number", "lost_numbers", "tilted"),
        *("work", "tool", "tool_name", "tilt", "tip"),
    }
)
"""Fields on which no frame depends, and those by which frames are looked up."""
FRAMES_AT_MOST: Final = 256
"""So many frames are kept: a program may have a length of its own for every block."""


@dataclass(frozen=True, slots=True)
class Turn:
    """What G68, G51 and G51.1 do to X, Y, Z: word -> matrix @ (word - centre) + centre."""

    matrix: Matrix
    centre: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class TiltedPlane:
    """A plane in space: word -> turned @ word + zero, in positions of a tool without length.

    Before the rotary axes have turned that holds where they are at 0; `angles` (deg) are those that
    they have then been turned to. `tip`: words are those of a tip that the control follows, as long
    as the axes stand at these angles, and without `turned` they are those of the work offset.
    """

    turned: Matrix | None
    zero: Vector
    angles: Mapping[str, float] = field(default_factory=dict)
    tip: bool = False


@dataclass(frozen=True)
class FrameState:
    """What decides how words become positions. Vectors have one number per axis, mm or degrees.

    work, first   the work offset in force, and that from whose zero positions count
    known         whether `work` is what the program has stated, or the control's first for certain
    unsettled     zeros have been set of which it is not known when they act
    zeros         positions of the zeros of work offsets; what is not here is not known
    machine       position of the machine's zero
    rotation      deg, about Z, of work offsets (G10 L2 R)
    preset, held  the shift of G92, and what G92.3 would restore
    adrift        by axis, the number of the G92 that has set it where it stood nowhere known: what
                  that shifted is not known, and `preset` counts from there; `held_adrift` is that
                  of G92.3, and `presets` counts such blocks
    local         the shift of G52 where it is not that of G92
    tool          mm, from the tip to the reference point; nan where a length is not known
    tool_name     what the tool vector belongs to: "H3", "-H3" where it is taken off; "" for none
    number        the H in force, as part of such a name; "" where no block has stated one.
                  `lost_numbers` counts those that only the control knows
    given         how often each work offset was set, or may have been, and all of them at once
                  (""), so that zeros that are not known have names of their own
    written       how often G10 has written each tool into the control's table
    in_spindle    number of the tool, -1 where not known; `changes` counts the tool changes
    turns         rotation, scaling and mirror of the program, the innermost first
    polar, diameter   G16 and G7 are in force
    homes         machine positions of G28 and G30
    following     whether the control follows the tip of the tool; None where that is not known
    plane         the tilted plane that is followed, by G68.2 and G53.1, or the tip, by G43.4
    tilt, tip     the tilted plane and the tip that are in force, by code and number: where they are
                  is not known; `tilted` counts them
    """

    axes: str
    work: str = "G54"
    first: str = "G54"
    known: bool = False
    unsettled: bool = False
    zeros: Mapping[str, Vector] = field(default_factory=dict)
    machine: Vector = ()
    rotation: Mapping[str, float] = field(default_factory=dict)
    preset: Vector = ()
    held: Vector = ()
    adrift: Mapping[int, int] = field(default_factory=dict)
    held_adrift: Mapping[int, int] = field(default_factory=dict)
    presets: int = 0
    local: Vector = ()
    tool: tuple[float, float, float] = NO_TOOL
    tool_name: str = ""
    number: str = ""
    lost_numbers: int = 0
    given: Mapping[str, int] = field(default_factory=dict)
    written: Mapping[int, int] = field(default_factory=dict)
    in_spindle: int = -1
    changes: int = 0
    turns: tuple[tuple[str, Turn], ...] = ()
    polar: bool = False
    diameter: bool = False
    homes: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    following: bool | None = None
    plane: TiltedPlane | None = None
    tilt: str = ""
    tip: str = ""
    tilted: int = 0
    made: dict[tuple[str, Vector, str, str, str], Frame] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """The frames of work offsets, tools and tilted planes that were asked for."""

    @classmethod
    def at_start(
        cls,
        axes: str,
        work: str,
        known: bool,
        offsets: Mapping[str, Mapping[str, float]],
        homes: Mapping[str, Mapping[str, float]],
    ) -> FrameState:
        """Return the state before a program; `offsets` are machine positions by work offset."""
        none = (0.0,) * len(axes)
        state = cls(axes, preset=none, held=none, local=none, homes=homes)
        return state.starting_in(work, offsets, known)

    def starting_in(
        self, work: str, offsets: Mapping[str, Mapping[str, float]], known: bool
    ) -> FrameState:
        """Return the state with positions counted from the zero of a work offset."""
        none = (0.0,) * len(self.axes)
        unknown = (np.nan,) * len(self.axes)

        def placed(code: str) -> Vector:
            return tuple(float(offsets[code].get(axis, 0.0)) for axis in self.axes)

        zeros = {work: none}
        machine = unknown
        if work in offsets:
            base = np.array(placed(work))
            zeros = {code: vector_of(placed(code) - base) for code in offsets}
            machine = vector_of(-base)
        return replace(self, work=work, first=work, known=known, zeros=zeros, machine=machine)

    def zero_of(self, work: str) -> Vector:
        """Return the position of the zero of a work offset, nan where it is not known."""
        return self.zeros.get(work, (np.nan,) * len(self.axes))

    def with_zero(self, work: str, zero: Vector) -> FrameState:
        """Return the state with the zero of a work offset elsewhere."""
        return replace(self, zeros={**self.zeros, work: zero}, given=self._given_anew(work))

    def shifted(self) -> FrameState:
        """Return the state with the zeros of all work offsets elsewhere, nobody knows where."""
        return replace(self, zeros={}, given=self._given_anew(""))

    def _given_anew(self, work: str) -> Mapping[str, int]:
        return {**self.given, work: self.given.get(work, 0) + 1}

    def _unknown_zero(self) -> str:
        """Return the name of the zero in force where it is not known: no other has the same."""
        times = self.given.get(self.work, 0) + self.given.get("", 0)
        if not times:
            return self.work
        return f"{self.work}{SET_ANEW}" + (f" ({times})" if times > 1 else "")

    def ended(self, work: str, shift_ends: bool) -> FrameState:
        """Return the state behind the end of a program, on a control that goes on."""
        none = (0.0,) * len(self.axes)
        kept = replace(self, preset=none, local=none, adrift={}) if shift_ends else self
        return kept.in_work(work)

    def in_work(self, work: str) -> FrameState:
        """Return the state in another work offset."""
        return replace(self, work=work, known=True)

    def with_tool(self, vector: tuple[float, float, float], name: str) -> FrameState:
        """Return the state with another tool vector; `name` says whose it is.

        What is not known is one and the same nan, and nothing is 0 and not -0, so that frames of
        the same tool are the same to the bit: `made` takes one for the other.
        """
        x, y, z = (length + 0.0 if length == length else nan for length in vector)
        return replace(self, tool=(x, y, z), tool_name=name)

    def frame(self) -> Frame:
        """Return the frame in force."""
        key = self.work, self.tool, self.tool_name, self.tilt, self.tip
        frame = self.made.get(key)
        if frame is None:
            if len(self.made) >= FRAMES_AT_MOST:
                self.made.clear()
            frame = self.made[key] = self._frame()
        return frame

    def _frame(self) -> Frame:
        zero = self.zero_of(self.work)
        away = self._unknown_zero()
        origin = [self.first if isfinite(place) else away for place in zero]
        matrix, offset = self._matrix()
        for k, name in self._set_anywhere(matrix is not None).items():
            origin[k] += name
        shift = [place if isfinite(place) else 0.0 for place in zero]
        if self.plane is not None and self.plane.angles and self.plane.turned is not None:
            matrix, shift[:3] = self.plane.turned, self.plane.zero
        assert self.axes[:3] == "XYZ"
        for k, length in enumerate(self.tool):
            if isfinite(length):
                shift[k] += length
            else:
                origin[k] += f" + {self.tool_name}"
        origin = [each + self.tilt + self.tip for each in origin]
        for k, value in enumerate(offset):
            shift[k] += value
        for k in range(0 if matrix is None else 3, len(shift)):
            shift[k] += self.preset[k] + self.local[k]
        return Frame(
            self.work,
            tuple(shift),
            tuple(origin),
            matrix,
            self.diameter,
            self.polar,
            self.tool,
            self.following,
            bool(self.tool_name),
            self.tool_name in (BY_VALUE, INSTEAD),
            self.tool_name == INSTEAD,
        )

    def _set_anywhere(self, turned: bool) -> dict[int, str]:
        """Return by axis what names an origin that G92 has set nobody knows where.

        Where coordinates are turned, what one of X, Y and Z counts from is not known of any.
        """
        names = {k: f"{SET_ANEW} by G92 ({nth})" for k, nth in self.adrift.items()}
        together = "".join(names[k] for k in sorted(names) if k < 3)
        return {**names, **dict.fromkeys(range(3), together)} if turned and together else names

    def _matrix(self) -> tuple[Matrix | None, Sequence[float]]:
        """Return matrix and shift (3,) of what is done to words before the work offset is added.

        The turns of the program first, then G52 and G92, then the rotation of the work offset.
        """
        angle = self.rotation.get(self.work, 0.0)
        if not self.turns and not angle:
            return None, ()
        matrix, shift = np.eye(3), np.zeros(3)
        for _, turn in self.turns:
            step, centre = np.array(turn.matrix), np.array(turn.centre)
            matrix, shift = step @ matrix, step @ (shift - centre) + centre
        shift = shift + np.array(self.preset[:3]) + np.array(self.local[:3])
        about = np.array(rotation(angle, 0, 1))
        matrix, shift = about @ matrix, about @ shift
        return matrix_of(matrix), shift.tolist()


if TYPE_CHECKING:
    from dataclasses import replace as replace
else:

    def replace(state: FrameState, **changes: object) -> FrameState:
        """Return a state with some fields changed, as `dataclasses.replace` does.

        A program may change its frame in every other line, and a constructor of 30 fields takes
        longer than all else that is then done.
        """
        changed = object.__new__(FrameState)
        fields = changed.__dict__
        fields.update(state.__dict__)
        fields.update(changes)
        if not changes.keys() <= UNFRAMED:
            fields["made"] = {}
        return changed


def rotation(angle: float, first: int, second: int) -> Matrix:
    """Return the matrix that turns the first axis towards the second by an angle (deg)."""
    exact = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}
    radians = np.deg2rad(angle)
    c, s = exact.get(angle % 360.0, (float(np.cos(radians)), float(np.sin(radians))))
    matrix = np.eye(3)
    matrix[first, first] = matrix[second, second] = c
    matrix[first, second], matrix[second, first] = -s, s
    return matrix_of(matrix)


def matrix_of(values: Floats) -> Matrix:
    """Return an array (3, 3) as a value."""
    return tuple((float(a), float(b), float(c)) for a, b, c in values)


def vector_of(values: Floats) -> Vector:
    """Return an array (n,) as a value."""
    return tuple(float(value) for value in values)
