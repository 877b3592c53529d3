"""Which programs the parser of GRBL 1.1h accepts: its rules, read in its sources, said once more.

A program is accepted if each of its lines is answered with "ok", on a controller as it is built by
default, with all offsets at zero, that stands at zero. Sources: `protocol.c` (blanks, `/` and
comments are dropped, 79 characters are left at most), `serial.c` (characters that act at once never
reach the line), `gcode.c` (words, modal groups, and what each code asks of the words beside it).
Lines of `%` alone are answered with error 1, do nothing, and are left out by what sends programs;
lines that begin with `$` are no G-code. Neither counts.

This shares no code with gcxform, and is no part of it: it says which programs count.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

ACTS_AT_ONCE = re.compile(rb"[!?~\x18\x80-\xff]")
WORD = re.compile(r"([A-Z])([-+]?(?:\d+\.?\d*|\.\d+))")
LONGEST, LARGEST_N, LARGEST_T = 79, 10_000_000, 255
GROUPS = {
    "non-modal": "4 10 28 28.1 30 30.1 53 92 92.1",
    "motion": "0 1 2 3 38.2 38.3 38.4 38.5 80",
    "plane": "17 18 19",
    "distance": "90 91",
    "arc": "91.1",
    "feed mode": "93 94",
    "units": "20 21",
    "compensation": "40",
    "length": "43.1 49",
    "frame": "54 55 56 57 58 59",
    "path": "61",
}
GROUP_OF = {f"G{code}": group for group, codes in GROUPS.items() for code in codes.split()}
GROUP_OF |= {f"M{code}": "program" for code in (0, 1, 2, 30)}
GROUP_OF |= {f"M{code}": "spindle" for code in (3, 4, 5)} | {"M8": "coolant", "M9": "coolant"}
MOTIONS = {f"G{code}" for code in GROUPS["motion"].split()} - {"G80"}
DROPPED = dict.fromkeys((*range(33), ord("/")))  # blanks, what is no letter, and the slash
USES_AXES = MOTIONS | {"G10", "G28", "G30", "G92", "G43.1", "G49"}
PLANES = {"G17": "XYIJ", "G18": "ZXKI", "G19": "YZJK"}
AT_START = {
    **{"motion": "G0", "plane": "G17", "distance": "G90", "feed mode": "G94", "units": "G21"},
    "frame": "G54",
}
AT_END = {"motion": "G1", "plane": "G17", "distance": "G90", "feed mode": "G94", "frame": "G54"}


class RejectedError(Exception):
    """A line that is answered with an error."""


def check(right: bool, why: str) -> None:
    """Raise Rejected where something does not hold."""
    if not right:
        raise RejectedError(why)


@dataclass
class Parser:
    """What the controller knows between two lines: modes, feed, where it stands, offsets in mm."""

    modes: dict[str, str] = field(default_factory=lambda: dict(AT_START))
    feed: float = 0.0
    at: dict[str, float] = field(default_factory=lambda: dict.fromkeys("XYZ", 0.0))
    preset: dict[str, float] = field(default_factory=lambda: dict.fromkeys("XYZ", 0.0))
    frames: dict[str, dict[str, float]] = field(default_factory=dict)
    length: float = 0.0

    def offset(self, axis: str, frame: str) -> float:
        """Return where an axis stands at its zero in a frame."""
        moved = self.frames.get(frame, {}).get(axis, 0.0) + self.preset[axis]
        return moved + (self.length if axis == "Z" else 0.0)

    def line(self, text: str) -> None:
        """Take a line, without blanks and comments; raise RejectedError."""
        codes, words = words_of(text)
        modes = {**self.modes, **{GROUP_OF[code]: code for code in codes}}
        action = modes.pop("non-modal", "")
        axes = {axis for axis in "XYZ" if axis in words}
        using = [code for code in codes if code in USES_AXES]
        check(len(using) < 2, "two codes use the axis words")
        moves = (axes and not using) or (using and GROUP_OF[using[0]] == "motion")
        words.pop("N", None), words.pop("S", None), words.pop("T", None)
        feed = self.feed_of(modes, words, bool(moves))
        scale = 25.4 if modes["units"] == "G20" else 1.0
        target = self.target(modes, action, words, scale)
        self.check_action(action, words, axes, modes)
        if "G43.1" in codes:
            check(axes == {"Z"}, "G43.1 without Z alone")
        if modes["motion"] == "G80":
            check(not axes, "axis words in G80")
        elif moves and modes["motion"] != "G0":
            check(feed > 0, "no feed")
            self.check_motion(modes, words, axes, target, scale)
        left = set(words) - (axes if using or moves else set())
        check(not left, f"{''.join(sorted(left))} is not used")
        self.take(codes, action, words, target, modes, scale, feed)

    def feed_of(self, modes: dict[str, str], words: dict[str, float], moves: bool) -> float:
        """Return the feed that a line has in mm a minute, or a value for inverse time."""
        given = words.pop("F", None)
        if modes["feed mode"] == "G93":
            check(
                given is not None or not moves or modes["motion"] in ("G0", "G80"),
                "no F in inverse time",
            )
            return given or 0.0
        if given is not None:
            return given * (25.4 if modes["units"] == "G20" else 1.0)
        return self.feed if self.modes["feed mode"] == "G94" else 0.0

    def target(
        self, modes: dict[str, str], action: str, words: dict[str, float], scale: float
    ) -> dict[str, float]:
        """Return where the axis words of a line lead, in the machine."""
        found = dict(self.at)
        for axis in set("XYZ") & set(words):
            value = words[axis] * scale
            shift = self.offset(axis, modes["frame"])
            if action == "G53":
                shift = 0.0
            elif modes["distance"] == "G91":
                shift = self.at[axis]
            found[axis] = value + shift
        return found

    def check_action(
        self, action: str, words: dict[str, float], axes: set[str], modes: dict[str, str]
    ) -> None:
        """Check a code of the group 0, and take its words."""
        if action == "G4":
            check("P" in words, "G4 without P")
            del words["P"]
        elif action == "G10":
            check(bool(axes), "G10 without axes")
            check("P" in words or "L" in words, "G10 without P and L")
            check(int(words.pop("P", 0)) <= 6, "no such frame")
            kind = int(words.pop("L", 0))
            check(kind == 20 or (kind == 2 and "R" not in words), "no such L")
        elif action == "G92":
            check(bool(axes), "G92 without axes")
        elif action == "G53":
            check(modes["motion"] in ("G0", "G1"), "G53 beside another motion")

    def check_motion(
        self,
        modes: dict[str, str],
        words: dict[str, float],
        axes: set[str],
        target: dict[str, float],
        scale: float,
    ) -> None:
        """Check an arc or a probe, and take the words of an arc."""
        motion = modes["motion"]
        if motion.startswith("G38"):
            check(bool(axes) and target != self.at, "a probe that goes nowhere")
        if motion not in ("G2", "G3"):
            return
        one, two, first, second = PLANES[modes["plane"]]
        check(bool(axes & {one, two}), "an arc without an axis of its plane")
        x, y = target[one] - self.at[one], target[two] - self.at[two]
        if "R" in words:
            radius = words.pop("R") * scale
            check(target != self.at, "an arc of a radius that goes nowhere")
            check(4 * radius**2 >= x**2 + y**2, "an arc whose radius is too small")
            return
        check(bool({first, second} & set(words)), "an arc without a centre in its plane")
        i, j = words.get(first, 0.0) * scale, words.get(second, 0.0) * scale
        for name in set("IJK") & set(words):
            del words[name]
        radius = math.hypot(i, j)
        off = abs(math.hypot(x - i, y - j) - radius)
        check(off <= 0.005 or off <= min(0.5, 0.001 * radius), "an arc that ends off its circle")

    def take(
        self,
        codes: list[str],
        action: str,
        words: dict[str, float],
        target: dict[str, float],
        modes: dict[str, str],
        scale: float,
        feed: float,
    ) -> None:
        """Remember what an accepted line does; G10, G28 and G30 lead back to zero offsets."""
        frame = modes["frame"]
        self.feed = feed if modes["feed mode"] == "G94" else 0.0
        if action == "G92":
            for axis in set("XYZ") & set(words):
                self.preset[axis] = 0.0
                self.preset[axis] = self.at[axis] - self.offset(axis, frame) - words[axis] * scale
        elif action == "G92.1":
            self.preset = dict.fromkeys("XYZ", 0.0)
        elif action in ("G28", "G30"):
            named = set("XYZ") & set(words) or set("XYZ")
            self.at = {axis: 0.0 if axis in named else at for axis, at in self.at.items()}
        elif "G43.1" in codes:
            self.length = words["Z"] * scale
        elif action != "G10":
            self.at = target
        if "G49" in codes:
            self.length = 0.0
        ends = "M2" in codes or "M30" in codes
        self.modes = {**modes, **AT_END} if ends else modes


def words_of(text: str) -> tuple[list[str], dict[str, float]]:
    """Return the codes of a line, each of a group of its own, and its other words."""
    check(not WORD.sub("", text), "a letter and a number are expected")
    codes: list[str] = []
    words: dict[str, float] = {}
    for letter, number in WORD.findall(text):
        value = float(number)
        if letter in "GM":
            code = f"{letter}{value:g}"
            check(code in GROUP_OF, f"no code {code}")
            check(GROUP_OF[code] not in map(GROUP_OF.get, codes), f"a second code beside {code}")
            codes.append(code)
            continue
        check(letter in "FIJKLNPRSTXYZ", f"no word {letter}")
        check(letter not in words, f"{letter} twice")
        check(value >= 0 or letter not in "FNPST", f"{letter} is negative")
        words[letter] = value
    check(words.get("N", 0) <= LARGEST_N and words.get("T", 0) <= LARGEST_T, "too large")
    return codes, words


def without_comments(line: str) -> str:
    """Return what is left of a line: no blanks, no `/`, no comments, capital letters."""
    if ";" not in line and "(" not in line:
        return line.translate(DROPPED).upper()
    kept, inside = [], False
    for letter in line:
        if inside:
            inside = letter != ")"
        elif letter == ";":
            break
        elif letter == "(":
            inside = True
        elif letter > " " and letter != "/":
            kept.append(letter.upper())
    return "".join(kept)


def rejected(text: bytes) -> tuple[int, str] | None:
    """Return the first line that is answered with an error, and why; None if none is."""
    parser = Parser()
    lines = ACTS_AT_ONCE.sub(b"", text).decode("latin-1")
    for number, line in enumerate(re.split(r"\r\n|\n|\r", lines), 1):
        bare = without_comments(line)
        if not bare or bare == "%" or bare.startswith("$"):
            continue
        try:
            check(len(bare) <= LONGEST, "more than 79 characters")
            parser.line(bare)
        except RejectedError as error:
            return number, str(error)
    return None


def accepts(text: bytes) -> bool:
    """Whether GRBL answers each line of a program with "ok"."""
    return rejected(text) is None
