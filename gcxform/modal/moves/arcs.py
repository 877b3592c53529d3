"""The words of arcs to centres and sweeps, with the checks a control makes.

I, J, K are distances from the start to the centre along X, Y, Z, or the centre itself in G90.1. R
is the radius: positive for the arc of at most half a turn, negative for the longer one.
"""

from __future__ import annotations

import numpy as np

from gcxform.dialect.dialect import INCH, ROTARY, Dialect
from gcxform.dialect.move_rules import ArcRule
from gcxform.modal.findings import Findings
from gcxform.modal.frames.track import Track
from gcxform.modal.lines import Lines
from gcxform.modal.moves.blind_moves import ways
from gcxform.modal.moves.tilted_arcs import with_legs
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.angles import SAME_POINT, TURN, swept
from gcxform.toolpath.frames import Frame, by_frame
from gcxform.toolpath.path import Form, Plane, Toolpath
from gcxform.values import dataclass

CLOSED = 1e-4
"""rad; below this some controls take an arc for none: more than their single precision leaves."""


@dataclass(frozen=True, slots=True)
class ArcWords:
    """The words of arcs, in mm; nan where a word is missing.

    line (n,) in the window; offset (n, 3) is I, J, K; named (n, 3): which of X, Y, Z stand there;
    turned (n,): so does a rotary axis;
    absolute (n,): the centre itself is given; inch (n,): the block is in inches; way (n, 3): its
    distances along X, Y, Z where it is in G91.
    """

    line: Ints
    offset: Floats
    radius: Floats
    turns: Floats
    named: Flags
    turned: Flags
    absolute: Flags
    inch: Flags
    way: Floats


def words_of_arcs(track: Track, lines: Ints) -> ArcWords:
    """Return centre, radius and turns words of arcs, nan where there is none, in mm."""
    scale = np.where(track.modes.inch[lines], INCH, 1.0)
    arcs = np.zeros(track.lines.live, np.bool_)
    arcs[lines] = True

    def column(address: str) -> Floats:
        word = track.lines.word(address, arcs) if address else None
        if word is None:
            return np.full(len(lines), np.nan)
        return np.where(word[1][lines], word[0][lines], np.nan)

    return ArcWords(
        lines,
        np.stack([column(a) * scale for a in "IJK"], axis=1),
        column("R") * scale,
        column(track.dialect.arc_rule.turns),
        np.stack([~np.isnan(column(a)) for a in "XYZ"], axis=1),
        np.any([~np.isnan(column(a)) for a in ROTARY], axis=0),
        track.modes.absolute_centre[lines],
        track.modes.inch[lines],
        ways(track, lines),
    )


def resolve_arcs(path: Toolpath, words: ArcWords, lines: Lines) -> Toolpath:
    """Return the path with centres and sweeps of its arcs."""
    dialect, findings = lines.dialect, lines.findings
    rows = np.flatnonzero(path.is_arc)
    centre = np.full((len(path), 3), np.nan)
    sweep = np.zeros(len(path))
    if not len(rows):
        return path.replace(centre=centre, sweep=sweep)
    ends = path.start[rows], path.end[rows]
    lost = np.asarray((np.isnan(ends[0]) & ~np.isnan(ends[1])).any(axis=1))
    frames = path.frames, path.frame[rows]
    start, end = (by_frame(Frame.local, *frames, place[:, :3], -1.0) for place in ends)
    nowhere = np.isnan(start) & (path.form[rows] == Form.BLIND)[:, None] & ~words.absolute[:, None]
    blind = nowhere.any(axis=1)[:, None]
    began = np.where(blind, start, 0.0)
    if blind.any():  # such an arc is worked out by its words alone, as if it began at 0
        lost &= ~blind[:, 0]
        start, end = np.where(blind, 0.0, start), np.where(blind, words.way, end)
    for plane in Plane:
        here = path.plane[rows] == plane
        if here.any():
            unknown = lost[here]
            chosen = _select(words, here)
            part = _Part(plane, chosen, start[here], end[here], unknown, dialect, findings)
            middle, angle = part.resolve(path.sense[rows[here]])
            centre[rows[here]], sweep[rows[here]] = middle, angle
    centre[rows] += began
    return _as_positions(path.replace(centre=centre, sweep=sweep), lines)


def _as_positions(path: Toolpath, lines: Lines) -> Toolpath:
    """Return arcs of turned frames as they lie between positions; a mirror changes their sense."""
    if path.plainly_framed:
        return path
    if _turned(path):
        path = with_legs(path, lines)
    kind = np.where(path.is_arc & path.mirrored, 5 - path.kind, path.kind).astype(np.int8)
    arcs = np.flatnonzero(path.is_arc)
    centre = path.centre.copy()
    centre[arcs] = by_frame(Frame.placed, path.frames, path.frame[arcs], centre[arcs], 1.0)
    return path.replace(centre=centre, kind=kind)


def _turned(path: Toolpath) -> bool:
    return any(frame.matrix is not None for frame in path.frames)


def _select(words: ArcWords, here: Flags) -> ArcWords:
    return ArcWords(*(getattr(words, name)[here] for name in ArcWords.__slots__))


class _Part:
    """The arcs of one plane."""

    def __init__(
        self,
        plane: Plane,
        words: ArcWords,
        start: Floats,
        end: Floats,
        unknown: Flags,
        dialect: type[Dialect],
        findings: Findings,
    ) -> None:
        self.first, self.second, self.normal = plane.axes
        self.plane = plane.name
        self.words = words
        self.start = start
        self.unknown = unknown
        self.a = start[:, [self.first, self.second]]
        self.b = end[:, [self.first, self.second]]
        self.dialect = dialect
        self.rule: ArcRule = dialect.arc_rule
        self.findings = findings

    def resolve(self, sense: Floats) -> tuple[Floats, Floats]:
        """Return centres (n, 3) and sweeps (n,)."""
        self._refuse_words()
        by_radius = ~np.isnan(self.words.radius)
        middle = self._from_offsets()
        if by_radius.any():
            middle[by_radius] = self._from_radius(sense)[by_radius]
        self._check_radii(middle, by_radius)
        sweep = swept(self.a - middle, self.b - middle, sense)
        turns = np.nan_to_num(self.words.turns, nan=1.0)
        self._refuse((turns < 1) | (turns % 1 != 0), "GX305", "turns must be 1, 2, 3 ...", "P")
        centre = np.empty((len(sweep), 3))
        centre[:, self.first], centre[:, self.second] = middle.T
        centre[:, self.normal] = self.start[:, self.normal]
        return centre, sweep + TURN * (turns - 1)

    def _refuse(
        self, which: Flags, code: str, message: str, address: str = "", hint: str = ""
    ) -> None:
        for line in self.words.line[which][: Findings.enough].tolist():
            self.findings.add(line, code, message, address, hint)

    def _refuse_words(self) -> None:
        """Refuse arcs whose words do not make one."""
        has = ~np.isnan(self.words.offset)
        has_radius = ~np.isnan(self.words.radius)
        in_plane = has[:, self.first] | has[:, self.second]
        unknown = np.any(np.isnan(np.hstack([self.a, self.b])), axis=1) | self.unknown
        self._refuse(
            unknown,
            "GX208",
            "an arc, but where it starts is not known",
            hint="begin with a line to a known point, or say "
            f"start = {{ {'XYZ'[self.first]} = ..., {'XYZ'[self.second]} = ... }} in [input]",
        )
        nothing = (self.rule.third == "zero") & (self.words.offset[:, self.normal] == 0)
        across = has[:, self.normal] & ~(in_plane & ((self.rule.third == "dropped") | nothing))
        self._refuse(
            across,
            "GX304",
            f"{'IJK'[self.normal]} is not in the plane of this arc",
            "IJK"[self.normal],
        )
        self._refuse(
            has.any(axis=1) & has_radius,
            "GX304",
            "the arc has both R and a centre; controls differ in which they take",
            "R",
        )
        self._refuse(
            ~in_plane & ~has_radius & ~has[:, self.normal],
            "GX303",
            "the arc has neither a centre nor a radius",
            hint="controls differ in what they do here: some cut a straight line",
        )
        both = has[:, self.first] & has[:, self.second]
        self._refuse(
            self.words.absolute & in_plane & ~both,
            "GX303",
            "an absolute centre (G90.1) needs both of its words",
        )
        if self.plane not in self.rule.planes:
            every = np.ones(len(self.a), np.bool_)
            self._refuse(every, "GX302", f"{self.dialect.name} has no arcs in {self.plane}")
        if not self.rule.turns_axes:
            message = f"how {self.dialect.name} turns an axis beside an arc is not certain"
            self._refuse(self.words.turned, "GX302", message, hint="turn it in a block of its own")
        self._refuse_circles()

    def _refuse_circles(self) -> None:
        """Refuse circles that name axes of their plane, or none, where the control wants it so."""
        named = self.words.named[:, self.first] | self.words.named[:, self.second]
        if self.rule.circle == "some":
            self._refuse(~named, "GX303", "the arc names no axis of its plane")
        elif self.rule.circle == "none":
            closed = np.hypot(*(self.b - self.a).T) < CLOSED * np.hypot(
                *(self.a - self._from_offsets()).T
            )
            message = f"{self.dialect.name} cuts a full circle only without the axes of its plane"
            self._refuse(named & closed, "GX303", message, hint="leave them out, if one is meant")

    def _from_offsets(self) -> Floats:
        """Return centres given by I, J, K (n, 2)."""
        offset = self.words.offset[:, [self.first, self.second]]
        relative = self.a + np.nan_to_num(offset)
        return np.where(self.words.absolute[:, None], offset, relative)

    def _from_radius(self, sense: Floats) -> Floats:
        """Return centres given by R: beside the middle of the chord, on the side of the sense."""
        chord = self.b - self.a
        half = np.hypot(*chord.T) / 2
        radius = self.words.radius
        given = ~np.isnan(radius)
        self._refuse(
            given & (half * 2 < SAME_POINT),
            "GX302",
            "an arc by radius cannot end where it starts",
            "R",
            "give the centre by I, J, K",
        )
        short = half - np.abs(radius)
        self._refuse(
            given & (short > self.rule.r_short + 1e-12),
            "GX302",
            "the radius is less than half the distance to the end",
            "R",
        )
        height = np.sqrt(np.maximum(radius**2 - half**2, 0.0))
        side = np.where(radius > 0, sense, -sense) * height
        with np.errstate(invalid="ignore", divide="ignore"):
            normal = np.stack([-chord[:, 1], chord[:, 0]], axis=1) / (2 * half)[:, None]
        return np.asarray((self.a + self.b) / 2 + side[:, None] * normal)

    def _check_radii(self, middle: Floats, by_radius: Flags) -> None:
        """Refuse arcs whose start and end are not on one circle, by the control's own rule."""
        first = np.hypot(*(self.a - middle).T)
        last = np.hypot(*(self.b - middle).T)
        bad = ~accepts(self.rule, first, last, self.words.inch)
        bad &= ~by_radius & ~np.isnan(first + last)
        bad &= ~np.isnan(self.words.offset[:, [self.first, self.second]]).all(axis=1)
        for index in np.flatnonzero(bad)[: Findings.enough].tolist():
            delta = abs(float(first[index] - last[index]))
            self.findings.add(
                int(self.words.line[index]),
                "GX301",
                f"the end is {delta:.4f} mm off the circle: radius {first[index]:.4f} at start, "
                f"{last[index]:.4f} at the end",
                hint="the centre may be written absolute where incremental is read, or the reverse",
            )


def accepts(rule: ArcRule, first: Floats, last: Floats, inch: Flags) -> Flags:
    """Return whether a control takes arcs with these radii (mm) at start and end.

    `inch` (n,): the block is in inches, which changes how far the radii may differ.
    """
    delta = np.abs(first - last)
    radius = np.maximum(first, last)
    unit = np.where(inch, rule.in_inch, 1.0)
    relative = np.minimum(rule.relative * radius, unit * rule.largest)
    limit = np.maximum(unit * rule.absolute, relative)
    good = (delta <= limit + 1e-12) & (np.minimum(first, last) > rule.smallest)
    return np.asarray(good)
