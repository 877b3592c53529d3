"""Where `volumetric` cuts lines: at the nodes that their commands cross, as far as needed.

A model with angular errors is also curved between the nodes, and bounds that: where the bound is
too large for a piece between two nodes, it is divided, and these places may be cut as well.

Between cuts at the nodes the machine is straight, and it is right at both ends, hence everywhere.
With a tolerance, a straight command is off by the largest amount at one of the nodes that it
passes; the cuts that stay are those which a farthest-reaching walk needs. Off is what is aside of
the line: where a machine is only ahead on it or behind, and no rotary axis turns, it is on its
path. `min-length` bounds how short a piece may be; where the walk leaves a shorter one, the fewest
places are looked for, breadth first, that leave none and hold the tolerance, and where there are
none the move is refused, with the length that the tolerance needs.

Without a tolerance, cuts that would mend less than 0.01 um are left out. In the LDDM example the
command for Z360 is 360.008 and crosses the node at 360 just before the end of the line: a cut there
is worth 1e-6 mm and a block. So the default gives 56 moves with 1.0e-06 mm left before rounding,
and `tolerance = "1e-9 mm"` gives 58 with 1.8e-10 mm.
"""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.volumetric.forward.window import Window

TIED = (gx.Form.THREAD, gx.Form.SYNCHRONISED, gx.Form.PROBE)
REFINEMENTS = 4  # each shrinks the error of a crossing by the Lipschitz constant of the error
NEGLIGIBLE = 1e-5  # mm; a cut that mends less is not worth a block: a hundredth of the rounding
CURVED = 1e-4  # mm; what may stay between two cuts, without a tolerance, where the error is curved
AHEAD, AHEAD_AT_MOST = 64, 1024  # places
CURVED_SHARE = 0.25  # of a tolerance, for the same
ASIDE = 1e-6  # mm; so far before and behind a border the error is what it is on either side
BEHIND = 10.0  # times what it moves the machine aside counts what a command is ahead or behind


def cuts_of_lines(window: Window, entry: Floats, commands: Floats) -> tuple[Ints, Floats]:
    """Return row and part of each cut.

    `entry` (3,) is the command before the first row, `commands` (n, 3) those for the ends of rows.
    """
    step, path = window.step, window.path
    points = np.empty((3, len(path) + 1)).T
    points[0], points[1:] = entry, commands
    bending = np.vstack([window.start[:1], window.end]) if step.inverse else points
    whole = np.isin(path.form, TIED)
    lines = (path.kind == gx.Kind.LINE) & ((path.form == gx.Form.PLAIN) | whole)
    lines &= path.starts_known & ~window.left
    _refuse_jumps(window, points, lines)
    row, part = _at_nodes(window, bending, lines)
    exact = step.tolerance is None or step.split == "nodes"
    most = np.full(len(path), window.room)
    if window.curvature.any() or window.swing is not None:
        between = CURVED if exact else CURVED_SHARE * step.limit
        row, part, left = _divided(window, row, part, lines, between)
        most -= left
    if not len(row):
        return row, part
    residual = np.where(whole, most, NEGLIGIBLE) if exact else most
    row, part = _needed(window, row, part, points, (residual, most))
    if whole[row].any():
        message = "this move is tied to the spindle or to a probe and cannot be cut, and the error "
        message += f"bends on its way by more than {window.step.limit * 1000:g} um"
        hint = "give volumetric a larger tolerance, or the move a shorter way"
        raise path.refuse("GX506", row[whole[row]][:1], message, hint)
    return row, part


def _refuse_jumps(window: Window, points: Floats, lines: Flags) -> None:
    """Refuse lines on whose way the error jumps aside of them by more than they may be off.

    So it does at the border of its tables where it is zero outside; no cut mends that. `points`
    (n + 1, 3) mm are the ends of commands.
    """
    step, path = window.step, window.path
    if step.outside is not gx.Outside.ZERO:
        return
    ends = (np.array(step.model.model.range_of(axis)) for axis in range(3))
    borders = [border[np.isfinite(border)] for border in ends]
    row, part, _, _ = gx.line_crossings(points, lines, borders)
    if not len(row):
        return
    way = points[row + 1] - points[row]
    along = way / np.sqrt((way**2).sum(axis=1))[:, None]
    place, tool = points[row] + part[:, None] * way, window.place.tool_of(row, part)
    jump = step.error(place - ASIDE * along, tool) - step.error(place + ASIDE * along, tool)
    turns = (np.nan_to_num(path.end - path.start)[:, 3:] != 0.0).any(axis=1)[row]
    ahead = np.where(turns, 0.0, (jump * along).sum(axis=1))
    off = np.sqrt(((jump - ahead[:, None] * along) ** 2).sum(axis=1))
    wrong = np.flatnonzero(off > window.room)[:1]
    if len(wrong):
        raise window.refuse_jump(row[wrong], float(off[wrong][0]))


def _at_nodes(window: Window, points: Floats, lines: Flags) -> tuple[Ints, Floats]:
    """Return row and part of the places where commands cross a node; `points`: their ends."""
    step = window.step
    row, part, axis, plane = gx.line_crossings(points, lines, step.nodes())
    if not len(row):
        return row, part
    start, way = window.start[row], window.end[row] - window.start[row]
    index = np.arange(len(row))
    for _ in range(0 if step.inverse else REFINEMENTS):
        command = window.command(start + part[:, None] * way, row, part)
        with np.errstate(divide="ignore", invalid="ignore"):
            shift = (plane - command[index, axis]) / way[index, axis]
        part = part + np.where(np.isfinite(shift) & (np.abs(shift) < 0.5), shift, 0.0)
    inside = (part > 0) & (part < 1)
    row, part = row[inside], part[inside]
    order = np.lexsort((part, row))  # of two nodes near to each other another may now be the first
    return row[order], part[order]


def _divided(
    window: Window, row: Ints, part: Floats, lines: Flags, between: float
) -> tuple[Ints, Floats, Floats]:
    """Return the places, and more so that between two of them the error bends by `between` mm.

    With them stands by how much (mm) it still bends, at most, for each row of the path.
    """
    whole = np.flatnonzero(lines)
    row, part = np.append(row, whole), np.append(part, np.ones(len(whole)))
    order = np.lexsort((part, row))
    row, part = row[order], part[order]
    before = np.where(np.append(True, row[1:] != row[:-1]), 0.0, np.append(0.0, part[:-1]))
    way = np.abs(window.end[row] - window.start[row]) * (part - before)[:, None]
    bend = np.einsum("ni,ij,nj->n", way, window.curvature, way) / 8 * (1 + 4 * window.lipschitz)
    if window.swing is not None:
        bend += window.swing.bend(row, way, part - before) * (1 + 4 * window.lipschitz)
    pieces = np.ceil(np.sqrt(bend / between)).astype(np.int64)
    left = np.zeros(len(window.path))
    np.maximum.at(left, row, bend / np.maximum(pieces, 1) ** 2)
    long = np.flatnonzero(pieces > 1)
    which = np.repeat(long, pieces[long] - 1)
    first = np.cumsum(pieces[long] - 1) - (pieces[long] - 1)
    nth = np.arange(len(which)) - np.repeat(first, pieces[long] - 1) + 1
    more = before[which] + (part - before)[which] * nth / pieces[which]
    inner = part < 1.0
    row, part = np.append(row[inner], row[which]), np.append(part[inner], more)
    order = np.lexsort((part, row))
    return row[order], part[order], left


def _needed(
    window: Window,
    row: Ints,
    part: Floats,
    points: Floats,
    residuals: tuple[Floats, Floats],
) -> tuple[Ints, Floats]:
    """Return the cuts that residuals (mm) of rows need; larger ones where they would be too near.

    A straight command from one exact point to another is off at the places between them, and
    nowhere more than there, by its distance from the exact command.
    """
    steep = float(np.hypot(1 + window.undone, 1 / BEHIND))
    limit, most = (residual * (1 - 1e-6) / steep for residual in residuals)
    start, way = window.start[row], window.end[row] - window.start[row]
    exact = window.command(start + part[:, None] * way, row, part)
    straight = points[row] + part[:, None] * (points[row + 1] - points[row])
    along = _along(window, row)
    off = np.sqrt((_squeezed(window, exact - straight, along) ** 2).sum(axis=1))
    begins = np.flatnonzero(np.append(True, row[1:] != row[:-1]))
    stops = np.append(begins[1:], len(row))
    worst = np.maximum.reduceat(off, begins)
    kept: list[int] = []
    for which in np.flatnonzero(worst > limit[row[begins]]).tolist():
        members = slice(int(begins[which]), int(stops[which]))
        owner = int(row[begins[which]])
        ends = points[[owner]], points[[owner + 1]]
        way = np.vstack([ends[0], exact[members], ends[1]])
        way = _squeezed(window, way, along[[begins[which]]])
        parts = np.concatenate([[0.0], part[members], [1.0]])
        inner = _farthest_reaching(way, parts, float(limit[owner]))
        if window.step.min_length:
            inner = _long_enough(window, owner, (way, parts), inner, float(most[owner]))
        kept += [int(begins[which]) + k - 1 for k in inner]
    chosen = np.array(kept, np.int64)
    return row[chosen], part[chosen]


def _along(window: Window, row: Ints) -> Floats:
    """Return the directions (n, 3) in which rows may be ahead or behind; 0 where they may not.

    A machine that is ahead is still on its path, unless a rotary axis turns along it. Without a
    tolerance lines are exact in their time as well.
    """
    way = window.end[row] - window.start[row]
    length = np.sqrt((way**2).sum(axis=1))
    turning = (np.nan_to_num(window.path.end - window.path.start)[:, 3:] != 0).any(axis=1)
    free = (length > 0) & ~turning[row] & (window.step.tolerance is not None)
    return np.where(free[:, None], way / np.where(free, length, 1.0)[:, None], 0.0)


def _squeezed(window: Window, points: Floats, along: Floats) -> Floats:
    """Return points (n, 3) brought together along directions (n or 1, 3) of unit length.

    A command that is ahead by s and aside by q moves the machine aside by (1 + k) q + k s at most,
    where k is the Lipschitz constant. With s squeezed to b k s this is no more than the length of
    both times the root of (1 + k)^2 + 1 / b^2.
    """
    kept = min(BEHIND * window.undone, 1.0)
    ahead = (points * along).sum(axis=1)
    return np.asarray(points - (1.0 - kept) * ahead[:, None] * along)


def _farthest_reaching(points: Floats, parts: Floats, limit: float) -> list[int]:
    """Return the inner points to stop at, when each piece reaches as far as the limit allows.

    It is looked for among the next `AHEAD` points, and among twice as many while the last of them
    is reached: a line may have thousands of places.
    """
    stops, at, last = [], 0, len(points) - 1
    while at < last:
        ahead = min(AHEAD, last - at)
        reach = _reach(points, parts, at, at + ahead, limit)
        while reach == at + ahead < last and ahead < AHEAD_AT_MOST:
            ahead = min(2 * ahead, last - at)
            reach = _reach(points, parts, at, at + ahead, limit)
        if reach < last:
            stops.append(reach)
        at = reach
    return stops


def _reach(points: Floats, parts: Floats, at: int, end: int, limit: float) -> int:
    """Return the last point up to `end` to which the straight way keeps the limit between.

    Seen from `at`, the way to point j has the velocity v_j, and is off point k by |v_j - v_k| times
    the time to k.
    """
    time = np.maximum(parts[at + 1 : end + 1] - parts[at], 1e-15)
    velocity = (points[at + 1 : end + 1] - points[at]) / time[:, None]
    square = np.zeros((len(time), len(time)))
    for axis in range(3):
        square += (velocity[:, None, axis] - velocity[None, :, axis]) ** 2
    within = square <= (limit / time) ** 2
    holds = (within | np.triu(np.ones_like(within))).all(axis=1)
    return at + 1 + int(np.flatnonzero(holds)[-1])


def _shortest(parts: Floats, inner: list[int]) -> float:
    """Return the part of the way that is the shortest piece; infinite where nothing is cut."""
    stops = parts[[0, *inner, len(parts) - 1]]
    return float(np.diff(stops).min()) if inner else float("inf")


def _long_enough(
    window: Window, row: int, places: tuple[Floats, Floats], inner: list[int], most: float
) -> list[int]:
    """Return the inner points, or others where they make too short pieces. Raises InputError."""
    length = float(np.linalg.norm(window.end[row] - window.start[row]))
    least = window.step.min_length / length
    if _shortest(places[1], inner) >= least:
        return inner
    long = _long_pieces(*places, most, least)
    if long is None:
        shortest = _shortest(places[1], _farthest_reaching(*places, most))
        raise window.refuse_short(row, shortest * length)
    return long


def _long_pieces(points: Floats, parts: Floats, limit: float, least: float) -> list[int] | None:
    """Return the fewest inner points to stop at so that no piece is shorter than `least`.

    `least` is a part of the way. None where the limit cannot be held by such pieces.
    """
    last = len(points) - 1
    came, reached, k = {0: 0}, [0], 0
    while k < len(reached) and last not in came:
        at, k = reached[k], k + 1
        for to in range(last, at, -1):
            long = parts[to] - parts[at] >= least or (at, to) == (0, last)
            if long and to not in came and _holds(points, parts, at, to, limit):
                came[to] = at
                reached.append(to)
    if last not in came:
        return None
    inner = [came[last]]
    while inner[-1]:
        inner.append(came[inner[-1]])
    return inner[-2::-1]


def _holds(points: Floats, parts: Floats, at: int, to: int, limit: float) -> bool:
    """Whether the straight way between two points keeps all points between within the limit."""
    if to == at + 1:
        return True
    between = slice(at + 1, to)
    share = (parts[between] - parts[at]) / (parts[to] - parts[at])
    straight = points[at] + share[:, None] * (points[to] - points[at])
    return bool((((points[between] - straight) ** 2).sum(axis=1) <= limit**2).all())
