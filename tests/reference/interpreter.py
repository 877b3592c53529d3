"""A slow scalar interpreter, written from the facts about three controls.

It shares nothing with the package: it is what the vectorised interpreter is tested against, and
it is itself tested against LinuxCNC. Every block is read, checked and executed by itself.

Power-up state: millimetres, G90, G91.1, G17, G94; the motion mode is none (GRBL: G0). The
position is unknown unless `start` is given.
"""

import math

from reference.arcs import (
    FUZZ,
    INCH,
    Point,
    centre_from_radius,
    radii_agree,
    radius_reaches,
    sweep,
)
from reference.model import (
    DIALECTS,
    FANUCS,
    PLANES,
    Dialect,
    Move,
    Program,
    rank,
    with_feed,
)
from reference.sorting import Sorted, sort
from reference.words import Block, Refused, Word, blocks

__all__ = ["Move", "Program", "Refused", "interpret"]


def interpret(
    program: bytes,
    dialect: str,
    start: dict[str, float] | None = None,
    increment: float | str | None = None,
    *,
    block_delete: bool = False,
    same_frames: bool = False,
) -> Program:
    """Execute a program; raise `Refused`, whose `partial` holds what came before.

    `increment` is what a Fanuc distance word counts without a point: a length in mm, or IS-B.
    `block_delete` is the switch: blocks with a slash are skipped. `same_frames` says that all
    work offsets are equal, so that a change of frame leaves the position known.
    """
    machine = _Machine(DIALECTS[dialect], dict(start or {}), increment, same_frames)
    try:
        for block in blocks(program, dialect, skip=block_delete):
            if block.words:
                machine.execute(block)
            if machine.ended:
                break
    except Refused as refusal:
        refusal.partial = machine.program  # type: ignore[attr-defined]
        raise
    return machine.program


class _Machine:
    """The modal state; `modal` maps a group to a code times ten."""

    def __init__(
        self,
        dialect: Dialect,
        position: dict[str, float],
        increment: float | str | None,
        same_frames: bool,
    ) -> None:
        self.dialect = dialect
        self.position = position  # known axes only; mm, degrees
        self.increment = increment
        self.same_frames = same_frames
        self.modal: dict[str, int | None] = {
            "motion": dialect.motion,
            "plane": 170,
            "distance": 900,
            "arc": 911,
            "feed": 940,
            "units": 210,
            "frame": dialect.frame if not position or dialect.frame else 540,
        }
        self.feed: tuple[float, float] = (0.0, 0.0)  # linear (mm), rotary (degrees)
        self.speed = 0.0
        self.ended = False
        self.program = Program()
        self.line = 0

    def execute(self, block: Block) -> None:
        """Check one block, then do what it says in the order of the control."""
        self.line = block.line
        said = sort(block, self.dialect)
        had = dict(self.modal)
        self._set_modes(said.codes)
        motion = self._motion_of_block(said)
        self._check_words(said, motion)
        self._set_feed(said, had)
        self._speeds_and_tools(said.values)
        self._m_codes(said, late=False)
        if said.dwell:
            self._event(f"DWELL {self._dwell(said.values):.10g}")
        if motion is not None:
            self._move(motion, said.values)
        self._m_codes(said, late=True)
        if {2, 30} & set(said.ms):
            self._end()

    def _m_codes(self, said: Sorted, *, late: bool) -> None:
        for m in sorted(said.ms, key=rank):
            if (m in self.dialect.late) == late:
                self._event(f"M{m}")

    # --- checking the block

    def _motion_of_block(self, said: Sorted) -> int | None:
        """Return the motion that this block performs, if any."""
        values = said.values
        fanuc_dwell = said.dwell and self.dialect.name in FANUCS  # X is a time there
        axes = not fanuc_dwell and any(axis in values for axis in self.dialect.axes)
        motion = self.modal["motion"]
        if motion == 800:
            if axes:
                raise self._refused("axis words without a motion mode")
            return None
        arc_words = motion in (20, 30) and any(letter in values for letter in "IJKR")
        if axes or "motion" in said.codes or (arc_words and self.dialect.name != "grbl"):
            return motion
        return None

    def _check_words(self, said: Sorted, motion: int | None) -> None:
        """Refuse letters which nothing in the block uses, and values out of their range."""
        name, values = self.dialect.name, said.values
        allowed = set("FST" + self.dialect.axes) | ({"N"} if name == "grbl" else set())
        if said.dwell:
            allowed |= set("PXU") if name == "fanuc" else {"P"}
        if motion in (20, 30):
            allowed |= set("IJKR") | ({"P"} if name == "linuxcnc" else set())
        if stray := set(values) - allowed:
            raise self._refused(f"nothing uses {sorted(stray)}")
        if any(values[letter].value < 0 for letter in "FSTP" if letter in values):
            raise self._refused("negative value")
        if "T" in values and abs(values["T"].value - round(values["T"].value)) > 1e-4:
            raise self._refused("T is an integer")
        self._check_company(said, motion)
        if name in FANUCS:
            self._check_points(values)

    def _check_company(self, said: Sorted, motion: int | None) -> None:
        """Refuse codes which do not go together."""
        name, explicit = self.dialect.name, "motion" in said.codes
        if said.dwell and motion in (20, 30) and explicit and name == "linuxcnc":
            raise self._refused("G4 with G2 or G3")
        if said.dwell and name in FANUCS and (explicit or len(said.values) != 1):
            raise self._refused("G4 stands alone")
        if "length" in said.codes and name == "grbl" and (explicit or motion is not None):
            raise self._refused("G49 with axis words")

    def _check_points(self, values: dict[str, Word]) -> None:
        """Refuse Fanuc numbers whose unit depends on whether they have a point."""
        whole = "STNM" if self.dialect.name == "haas" else "STNPM"
        if any(values[letter].pointed for letter in whole if letter in values):
            raise self._refused("an integer word with a decimal point")
        feed = values.get("F")
        plain = self.modal["feed"] != 950 and self.modal["units"] == 210
        plain = plain and self.dialect.name != "haas"
        if feed is not None and feed.value and not feed.pointed and not plain:
            raise self._refused("F without a point here depends on parameters")

    # --- acting

    def _set_modes(self, codes: dict[str, int]) -> None:
        """Take over the modal codes of the block."""
        frame = codes.get("frame", self.modal["frame"])
        if frame != self.modal["frame"] and not self.same_frames:
            self.position = {}
        self.modal.update(codes)

    def _set_feed(self, said: Sorted, had: dict[str, int | None]) -> None:
        """Apply the F word; a feed survives a change of units in mm, not one of feed mode.

        LinuxCNC sets the feed before the units: `G20 F10` is still 10 mm/min after G21.
        """
        changed, inverse = self.modal["feed"] != had["feed"], self.modal["feed"] == 930
        name = self.dialect.name
        inch = (had["units"] if name == "linuxcnc" else self.modal["units"]) == 200
        if changed or inverse or ("feed" in said.codes and name == "linuxcnc"):
            self.feed = (0.0, 0.0)
        if name in FANUCS and self.modal["units"] != had["units"]:
            self.feed = (0.0, 0.0)
        if "F" in said.values:
            if name == "grbl" and changed and not inverse and inch:
                raise self._refused("GRBL forgets to convert this F to inches")
            value = said.values["F"].value
            self.feed = (value * INCH if inch and not inverse else value, value)

    def _speeds_and_tools(self, values: dict[str, Word]) -> None:
        if "S" in values:
            self.speed = values["S"].value
            self._event(f"S{self.speed:.10g}")
        if "T" in values:
            self._event(f"T{values['T'].value:.0f}")

    def _dwell(self, values: dict[str, Word]) -> float:
        """Return the dwell in seconds."""
        if self.dialect.name not in FANUCS:
            if "P" not in values:
                raise self._refused("dwell without a time")
            return values["P"].value
        word = next(iter(values.values()))
        if word.letter != "P" and not word.pointed:
            raise self._refused("dwell without a point")
        in_ms = word.letter == "P" and not (self.dialect.name == "haas" and word.pointed)
        return word.value / 1000 if in_ms else word.value

    def _move(self, motion: int, values: dict[str, Word]) -> None:
        """Perform a rapid, line or arc."""
        if motion != 0:
            self._check_feed(values)
        start, end = dict(self.position), self._target(values)
        if motion in (20, 30):
            move = self._arc(motion == 20, values, start, end)
        elif not any(axis in values for axis in self.dialect.axes):
            return  # G0 or G1 alone moves nothing
        else:
            move = Move("LINE" if motion else "RAPID", start, end, self.line, **self._common())
        if motion:
            move = with_feed(move, self.feed)
        self.program.moves.append(move)
        self.position = end

    def _check_feed(self, values: dict[str, Word]) -> None:
        if self.modal["feed"] == 930:
            if "F" not in values or (self.dialect.name != "linuxcnc" and not self.feed[0]):
                raise self._refused("G93 needs F in every block")
        elif not self.feed[0]:
            raise self._refused("no feed")
        if self.modal["feed"] == 950 and self.dialect.name == "linuxcnc" and not self.speed:
            raise self._refused("G95 without spindle speed")

    def _target(self, values: dict[str, Word]) -> dict[str, float]:
        """Return the position after the axis words, known axes only."""
        end = dict(self.position)
        for axis in self.dialect.axes:
            if axis not in values:
                continue
            value = self._length(values[axis])
            if self.modal["distance"] == 910:
                if axis not in self.position:
                    continue  # by a distance from nowhere known: as unknown as before
                value += self.position[axis]
            end[axis] = value
        return end

    def _length(self, word: Word) -> float:
        """Return a distance word in mm, or degrees for a rotary axis."""
        value = word.value
        if self.dialect.name in FANUCS and not word.pointed and value:
            if self.increment is None:
                raise self._refused(f"{word.letter} has no decimal point")
            if isinstance(self.increment, str):
                finer = self.modal["units"] == 200 and word.letter not in "ABC"
                value /= 10_000 if finer else 1000
            elif word.letter in "ABC":
                raise self._refused(f"{word.letter} counts angles, and the increment is a length")
            else:
                return value * self.increment
        return value * INCH if self.modal["units"] == 200 and word.letter not in "ABC" else value

    def _arc(
        self, clockwise: bool, values: dict[str, Word], start: dict[str, float], end: dict
    ) -> Move:
        """Return the arc; its centre has the normal coordinate of the start (nan if unknown)."""
        _, axes, letters = PLANES[self.modal["plane"] or 170]
        steps = self.modal["distance"] == 910  # an arc by distances may begin nowhere known
        steps &= "R" in values or self.modal["arc"] != 901  # but not about a place
        known = steps or {axes[0], axes[1]} <= set(start)
        if not known or set(end) - set(start):
            raise self._refused("arc from an unknown position")
        first: Point = (start.get(axes[0], 0.0), start.get(axes[1], 0.0))
        ways = [self._length(values[a]) if a in values else 0.0 for a in axes[:2]]
        last: Point = (end.get(axes[0], ways[0]), end.get(axes[1], ways[1]))
        if self.dialect.name == "grbl" and not {axes[0], axes[1]} & set(values):
            raise self._refused("no axis word of the plane")
        if "R" in values:
            centre = self._radius_centre(clockwise, values, first, last, axes)
        else:
            centre = self._offset_centre(values, first, last, letters)
        extra = self._turns(values)
        angle = sweep(first, last, centre, clockwise, FUZZ[self.dialect.name])
        at = {axes[0]: centre[0], axes[1]: centre[1], axes[2]: start.get(axes[2], math.nan)}
        return Move(
            "ARC_CW" if clockwise else "ARC_CCW",
            start,
            end,
            self.line,
            centre=(at["X"], at["Y"], at["Z"]),
            turns=extra,
            sweep=angle + math.tau * extra,
            **self._common(),
        )

    def _turns(self, values: dict[str, Word]) -> int:
        """Return the turns beyond the first; LinuxCNC's P counts that one too."""
        if "P" not in values:
            return 0
        turns = round(values["P"].value)
        if abs(values["P"].value - turns) > 1e-3 or turns < 1:
            raise self._refused("P is a positive integer")
        return turns - 1

    def _radius_centre(
        self, clockwise: bool, values: dict[str, Word], first: Point, last: Point, axes: str
    ) -> Point:
        if set("IJK") & set(values) and self.dialect.name not in FANUCS:
            raise self._refused("R with I, J or K")
        if not {axes[0], axes[1]} & set(values) or first == last:
            raise self._refused("R needs another end point")
        radius, inch = self._length(values["R"]), self.modal["units"] == 200
        if not radius_reaches(radius, math.dist(first, last), self.dialect.name, inch):
            raise self._refused("the radius does not reach the end point")
        return centre_from_radius(first, last, radius, clockwise)

    def _offset_centre(
        self, values: dict[str, Word], first: Point, last: Point, letters: str
    ) -> Point:
        given = set("IJK") & set(values)
        if not given & set(letters[:2]) or (letters[2] in given and self.dialect.name != "grbl"):
            raise self._refused("centre words do not fit the plane")
        i, j = (self._length(values[c]) if c in values else 0.0 for c in letters[:2])
        if self.modal["arc"] == 901:
            if letters[2] in given or not set(letters[:2]) <= given:
                raise self._refused("an absolute centre needs both words")
            centre = (i, j)
        else:
            centre = (first[0] + i, first[1] + j)
        radii = math.dist(first, centre), math.dist(last, centre)
        if not radii_agree(*radii, self.dialect.name, self.modal["units"] == 200):
            raise self._refused(f"radii differ or vanish: {radii[0]:.6f}, {radii[1]:.6f} mm")
        return centre

    def _common(self) -> dict[str, str]:
        """Return the modal fields of a move."""
        plane = PLANES[self.modal["plane"] or 170][0]
        return {"plane": plane, "feed_mode": f"G{(self.modal['feed'] or 940) // 10}"}

    def _end(self) -> None:
        """End the program; GRBL only resets its modes and executes what still comes."""
        if self.dialect.name != "grbl":
            self.ended = True
            return
        if self.modal["feed"] == 930:
            self.feed = (0.0, 0.0)
        reset = {"motion": 10, "plane": 170, "distance": 900, "feed": 940, "frame": 540}
        self._set_modes(reset)

    def _event(self, text: str) -> None:
        self.program.events.append((len(self.program.moves), text))

    def _refused(self, reason: str) -> Refused:
        return Refused(self.line, reason)
