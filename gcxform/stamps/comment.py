"""Stamps: comments in a program that say what has been done to it, so that it is not done twice.

A run whose steps turn positions into other positions (`volumetric`, `rtcp`) writes two comments:

    (GCXFORM STAMP 0123456789AB COMPENSATED AXES 1A2B3C BY 0.1.0 RTCP VOLUMETRIC)
    (GCXFORM SEAL 0123456789AB)

The stamp has a digest of the pipeline, what positions are since then, the version and the steps;
AXES has a digest of the rotary axes they are for. The newest stamp stands first. The seal has a
digest of all lines but its own, carriage returns left out: what was edited or cut off since does
not fit it. Letters, digits, blanks, points and signs are all that is used, in fewer than 80
characters, because every control takes those.

Other tools indent comments, number them, change their case, drop their blanks or give them another
bracket; a stamp is known all the same. A comment that only talks about gcxform is none.

They are read from the bytes of a program, before anything else is.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence

from gcxform.syntax.source import Source
from gcxform.values import dataclass

LONGEST = 76  # characters between the brackets
DIGITS = 12  # of the digest of a pipeline, and of a seal
FACTS = ("NOMINAL", "COMPENSATED", "TIP", "AXES")
PAIRS = (FACTS[:2], FACTS[2:])
"""What positions may be, in pairs of which one excludes the other."""

OPEN_SEAL = "GCXFORM SEAL " + "0" * DIGITS
"""A seal whose digits are to come: see `sealed_anew`."""
_ANY = re.compile(
    rb"[(;][ \t]*GCXFORM[ \t]*(STAMP|SEAL)[ \t]*([0-9A-F]{%d})([^()\r\n]*)" % DIGITS, re.IGNORECASE
)
_LINE = re.compile(
    rb"(?:^|(?<=[\r\n]))[ \t]*(?:N?[ \t]*\d+[ \t]*)?[(;][ \t]*GCXFORM[ \t]*(STAMP|SEAL)[ \t]*"
    rb"([0-9A-F]{%d})[^()\r\n]*\)?[ \t]*(?:\r\n|\n|\r|\Z)" % DIGITS,
    re.IGNORECASE,
)
_SAID = re.compile(
    rf"(?P<facts>(?:{'|'.join(FACTS[:3])}|AXES *(?:[0-9A-F]{{6}})?| )*)BY *"
    r"(?P<version>[0-9]+(?:\.[0-9]+)*(?:[+-][0-9A-Z.]+)?)(?P<steps>[^;]*)"
)
_FACT = re.compile(rf"({'|'.join(FACTS)}) *([0-9A-F]{{6}})?")


@dataclass(frozen=True)
class Stamp:
    """One stamp: the digest of a pipeline, what positions are since, who says so, and the steps.

    `axes` is the digest of the rotary axes that AXES is about. `facts` is None where the stamp is
    broken: then nothing is known of the positions. `line` counts from 1, 0 in a new one.
    """

    digest: str
    facts: tuple[str, ...] | None
    axes: str
    version: str
    steps: tuple[str, ...]
    line: int = 0
    text: str = ""

    @property
    def content(self) -> str:
        """What stands in the comment."""
        if self.text:
            return self.text
        said = " ".join(f"AXES {self.axes}".strip() if f == "AXES" else f for f in self.facts or ())
        head = f"GCXFORM STAMP {self.digest} {said} BY {self.version}"
        names, left = [*self.steps], 0
        while len(text := " ".join([head, *names, *([f"AND {left} MORE"] if left else [])])) > (
            LONGEST
        ):
            if not names:
                return head
            names, left = names[:-1], left + 1
        return text

    def __str__(self) -> str:
        """Return who did what, for a person."""
        version = f" {self.version.lower()}" if self.version else ""
        steps = " | ".join(step.lower() for step in self.steps) or "steps that it does not tell"
        return f"gcxform{version} did {steps}"


@dataclass(frozen=True)
class Stamps:
    """The stamps of a program, the newest first; whether there is a seal, and whether it fits."""

    stamps: tuple[Stamp, ...] = ()
    seals: tuple[str, ...] = ()
    fits: bool = False
    lines: tuple[int, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.stamps or self.seals)

    @property
    def line(self) -> int:
        """The first line with one, from 1."""
        return min(self.lines, default=0)

    @property
    def readable(self) -> bool:
        """Whether it is known what was done."""
        return bool(self.stamps) and all(stamp.facts is not None for stamp in self.stamps)

    @property
    def edited(self) -> str:
        """What was done to the program after it was stamped; empty where nothing was."""
        if not self or self.fits:
            return ""
        if not self.stamps:
            return "it has a seal, and the stamp that belongs to it is gone"
        return "it has been edited since" if self.seals else "its seal, near the end, is gone"

    def stating(self, pair: Iterable[str]) -> tuple[Stamp, str] | None:
        """Return the newest stamp that says which of a pair of facts holds, and which does."""
        for stamp in self.stamps:
            for fact in stamp.facts or ():
                if fact in pair:
                    return stamp, fact
        return None


def stamps_in(source: Source) -> Stamps:
    """Return the stamps of a program. One that has none is only searched for a word."""
    if not any(_may_have(text) for text in source.windows()):
        return Stamps()
    reader = StampReader()
    for text in source.windows():
        reader.take(text)
    return reader.found


class StampReader:
    """Is shown the windows of a program in order; `found` are then its stamps."""

    def __init__(self) -> None:
        self.stamps: list[Stamp] = []
        self.seals: list[str] = []
        self.places: list[int] = []
        self.line = 1
        self.digest = hashlib.sha256()

    def take(self, text: bytes) -> None:
        """Look at whole lines."""
        for found in _ANY.finditer(text) if _may_have(text) else ():
            self.places.append(self.line + _ends_in(text[: found.start()]))
            if found[1].upper() == b"SEAL":
                self.seals.append(found[2].decode().upper())
            else:
                self.stamps.append(_read(found, self.places[-1]))
        self.line += _ends_in(text)
        self.digest.update(sealed(without_lines(text, ("SEAL",))))

    @property
    def found(self) -> Stamps:
        """The stamps, and whether the seal fits all that was shown."""
        fits = bool(self.stamps) and self.seals == [short(self.digest.hexdigest())]
        return Stamps(tuple(self.stamps), tuple(self.seals), fits, tuple(self.places))


def _may_have(text: bytes) -> bool:
    """Whether there may be a stamp: this is asked of every program, so it has to be fast."""
    return b"CXFORM" in text or b"cxform" in text


def _ends_in(text: bytes) -> int:
    return text.count(b"\n") + text.count(b"\r") - text.count(b"\r\n")


def _read(found: re.Match[bytes], line: int) -> Stamp:
    """Return the stamp of a comment, as far as it can be read."""
    digest = found[2].decode().upper()
    rest = " ".join(found[3].decode("ascii", "replace").upper().split())
    text = f"GCXFORM STAMP {digest} {_plain(rest)}"[:LONGEST].rstrip()
    said = _SAID.fullmatch(rest)
    if said is None:
        return Stamp(digest, None, "", "", (), line, text)
    facts = [(fact[1], fact[2] or "") for fact in _FACT.finditer(said["facts"])]
    names = tuple(name for name, _ in facts)
    known = names if facts and not any(set(pair) <= set(names) for pair in PAIRS) else None
    axes = next((digits for name, digits in facts if name == "AXES"), "")
    return Stamp(digest, known, axes, said["version"], tuple(said["steps"].split()), line, text)


def _plain(text: str) -> str:
    """Return a text with nothing in it that a control may not take in a comment."""
    return re.sub(r"[^0-9A-Z .+-]", "-", text)


def named(*names: str) -> tuple[str, ...]:
    """Return names as stamps have them."""
    return tuple(_plain(name.upper()).replace(" ", "-") for name in names)


def short(digest: str) -> str:
    """Return as much of a digest as stamps have."""
    return digest[:DIGITS].upper()


def sealed(text: bytes) -> bytes:
    """Return what a seal is about of a text: on its way to a control a file may get CRs."""
    return text.replace(b"\r", b"")


def is_stamp(line: str) -> bool:
    """Whether a line is a stamp or a seal and nothing else."""
    return "CXFORM" in line.upper() and bool(_LINE.fullmatch(line.encode("latin-1")))


def without_lines(text: bytes, kinds: Sequence[str] = ("STAMP", "SEAL")) -> bytes:
    """Return whole lines without those that are stamps and nothing else."""
    return b"".join(part for part, gone in parts(text, kinds) if not gone)


def sealed_anew(text: bytes, digits: str | None = None) -> bytes:
    """Return a text whose one seal fits it, or has the digits that are given."""
    for found in _LINE.finditer(text):
        if found[1].upper() == b"SEAL":
            rest = text[: found.start()] + text[found.end() :]
            new = short(hashlib.sha256(sealed(rest)).hexdigest()) if digits is None else digits
            return text[: found.start(2)] + new.encode() + text[found.end(2) :]
    return text


def parts(text: bytes, kinds: Sequence[str] = ("STAMP", "SEAL")) -> Iterator[tuple[bytes, bool]]:
    """Yield a text in parts, each with whether it is the line of a stamp."""
    at = 0
    for found in _LINE.finditer(text) if _may_have(text) else ():
        if found[1].decode().upper() in kinds:
            yield text[at : found.start()], False
            yield found[0], True
            at = found.end()
    yield text[at:], False
