"""Faults of pieces that the control puts into corners."""

from __future__ import annotations

from faults.mutation import CORPUS, PASSES, Mutation

CORNERS = "tests/test_corners.py"
FANUC = f"{CORPUS}[dialects/fanuc/corner"


def _corner(name: str, old: str, new: str, tests: str = CORNERS) -> Mutation:
    return Mutation(f"corner: {name}", "gcxform/modal/moves/corners.py", old, new, tests)


def _emitted(name: str, old: str, new: str, tests: str) -> Mutation:
    return Mutation(f"corner: {name}", "gcxform/emit/corners.py", old, new, tests)


MUTATIONS = (
    _corner("an arc takes its radius of the moves", "size * np.tan(np.abs(self.turn) / 2)", "size"),
    _corner("the centre is a radius from the corner", "size / np.cos(self.turn / 2)", "size"),
    _corner("the centre is outside", "across = (w - u)", "across = (u - w)"),
    _corner("an arc turns the other way", "self.turn[arc] > 0", "self.turn[arc] < 0"),
    _corner(
        "an arc turns by what is left of half a turn",
        "= np.abs(self.turn[arc])",
        "= np.pi - np.abs(self.turn[arc])",
    ),
    _corner("the piece begins behind the corner", "corner - cut * u", "corner + cut * u"),
    _corner("the piece ends in the direction before", "corner + cut * w", "corner + cut * u"),
    _corner(
        "sizes are in millimetres",
        "np.where(self.lines.inch[self.line], INCH, 1.0)",
        "1.0",
        f"{FANUC}-in-inches]",
    ),
    _corner(
        "each corner has the move for itself",
        "np.add.at(used, self.row + 1, self._cut)",
        "pass",
        f"{FANUC}-too-large]",
    ),
    _corner(
        "the feed of the block before holds",
        "same = (feed[row] == feed[row + 1])",
        "same = (feed[row] == feed[row])",
        f"{FANUC}-at-another-feed]",
    ),
    _corner(
        "what begins at a corner is compensated",
        "(side[row] != side[row + 1]) | (side[row + 1]",
        "(side[row + 1]",
        f"{FANUC}-at-g41]",
    ),
    _corner(
        "another tool behind a corner is the same",
        'begins |= (side[row + 1] != 0) & self._says_behind("D")',
        "pass",
        f"{FANUC}-at-g41]",
    ),
    _corner(
        "axes beside the plane may move behind it",
        "for nth in (0, 1):",
        "for nth in (0,):",
        f"{FANUC}-too-large]",
    ),
    _corner(
        "a corner may be nearly straight",
        "(angle <= STRAIGHT)",
        "(angle <= 0)",
        f"{FANUC}-that-is-none]",
    ),
    _corner(
        "polar words are as others",
        "return not (frame.polar or frame.diameter)",
        "return True",
        f"{FANUC}-polar]",
    ),
    _emitted(
        "a block of a corner stays alone",
        "~np.isin(together, broken)",
        "_as_before(task.path, task.read.path, task.read.live)",
        f"{FANUC}-cut]",
    ),
    _emitted(
        "distances behind a piece count from the corner",
        "np.append(False, corner)[:-1] & task.path.blocks.incremental",
        "np.append(False, corner)[:-1] & False",
        f"{FANUC}-cut]",
    ),
    Mutation(
        "corner: a window ends in one",
        "gcxform/syntax/source.py",
        "        at = begin\n",
        "        return cut\n",
        CORNERS,
    ),
    Mutation(
        "corner: what is executed next is next in the file",
        "gcxform/flow/corners.py",
        "np.diff(lines, append=-1) != 1",
        "np.diff(lines, append=-1) == 0",
        f"{FANUC}-before-m99]",
    ),
    Mutation(
        "corner: the first of two moves of a block has the corner before it",
        f"{PASSES}/cutter_comp/unchanged.py",
        "later[later] = _goes_along(before, first[later], after, begin[later])",
        "later[later] = False",
        f"{FANUC}-compensated]",
    ),
)
