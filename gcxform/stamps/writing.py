"""How stamps get into a text, window by window: stamps at its head, the seal near its end.

The head goes behind percent signs, program numbers and comments, in front of the first line that
holds anything else. The seal is the last line, but for a percent sign that closes the program.
Stamps that the text has already are taken out where they stand, and written with the new one.

Stamps are put in before the proof reads the window; passes that change text never see them. The
seal comes last, when all text is known: it is the hash of the output, which is made anyway, unless
lines end in CR. It is the one line that the verifier does not read; that it is a comment is asked
of the grammar of the target.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Sequence

import numpy as np

from gcxform.dialect.dialect import Dialect
from gcxform.stamps.comment import parts, sealed, short
from gcxform.syntax.source import lines_in
from gcxform.syntax.tree import Comment
from gcxform.system.arrays import Ints

Lines = Sequence[int] | Ints
HELD_AT_MOST = 1 << 16  # bytes from a percent sign on that may still be what closes the program
_LINE_END = re.compile(rb"\r\n|\n|\r")
_COMMENTS = rb"(?:[ \t]*\([^()\r\n]*\))*+[ \t]*"
_FRAME = re.compile(
    rb"(?:(?:\xef\xbb\xbf|[\x00\x7f])[^\r\n]*(?:\r\n|\n|\r|\Z))?"
    rb"(?>(?:[ \t]*%[^\r\n]*|[ \t]*(?:O|:)[ \t]*\d++" + _COMMENTS + rb"|[ \t]*<[^<>\r\n]*>"
    + _COMMENTS + rb"|[ \t]*;[^\r\n]*|" + _COMMENTS + rb")(?:\r\n|\n|\r|\Z))*+",
    re.IGNORECASE,
)  # fmt: skip


def comment_line(dialect: type[Dialect], content: str) -> bytes:
    """Return a comment that is a line by itself and does nothing; empty if a control has none.

    It is read again with the grammar of the control, and that is its proof.
    """
    for begin in dialect.text_rule.comments:
        line = begin + content + (")" if begin == "(" else "")
        if dialect.text_rule.executes(line):
            continue
        block = dialect.load_grammar().parse(line)
        spans = [(item.start, item.end) for item in block.items if isinstance(item, Comment)]
        if block.error is None and len(block.items) == 1 and spans == [(0, len(line))]:
            return line.encode()
    return b""


class Heads:
    """Takes stamps out of the windows of a text, and puts lines at its head."""

    def __init__(self, dialect: type[Dialect], lines: Iterable[bytes], takes_out: bool) -> None:
        self.dialect = dialect
        self.lines = [line for line in lines if line]
        self.takes_out = takes_out
        self.waits = bool(self.lines)
        self.end = b""
        self.added = self.removed = 0  # lines

    def edit(self, text: bytes) -> tuple[bytes, Ints | None]:
        """Return a window's new text, and which of its old lines (n,) each line stands for.

        None says that no line has changed. A line at the head stands for the one behind it.
        """
        self._look_at(text)
        kept: Ints | None = None
        if self.takes_out:
            text, kept = self._without_stamps(text)
        place = _FRAME.match(text) if self.waits else None
        at = place.end() if place else 0
        if not self.waits or at == len(text):
            return text, kept
        self.waits = False
        self.added += len(self.lines)
        head = b"".join(line + self.line_end for line in self.lines)
        kept = np.arange(lines_in(text)) if kept is None else kept
        before = lines_in(text[:at]) if at else 0
        kept = np.insert(kept, before, [kept[before]] * len(self.lines))
        return text[:at] + head + text[at:], kept

    @property
    def line_end(self) -> bytes:
        """How lines end in this text."""
        alone = self.end == b"\r" and self.dialect.text_rule.lone_cr_is_blank
        return b"\n" if alone or not self.end else self.end

    def _look_at(self, text: bytes) -> None:
        """Note how the first line ends."""
        if not self.end and (found := _LINE_END.search(text)):
            self.end = found[0]

    def _without_stamps(self, text: bytes) -> tuple[bytes, Ints | None]:
        """Return a text without the lines that are stamps, and the lines (n,) that stay."""
        found, stays, at = [], [], 0
        for part, is_stamp in parts(text):
            count = lines_in(part) if part else 0
            if not is_stamp:
                found.append(part)
                stays.append(np.arange(at, at + count))
            at += count
        if len(found) == 1:
            return text, None
        kept = np.concatenate(stays)
        self.removed += at - len(kept)
        return b"".join(found), kept


class Seal:
    """Lets the text of a program through, but for a percent sign that may close it; then seals it.

    `written` is the digest of what has been written so far; it serves as long as there is no CR.
    `fixed` is a seal that is carried on as it is; None: one that fits is made.
    """

    def __init__(
        self, dialect: type[Dialect], written: hashlib._Hash, fixed: str | None = None
    ) -> None:
        self.dialect = dialect
        self.written = written
        self.own: hashlib._Hash | None = None
        self.fixed = fixed
        self.held = b""
        self.added = 0  # lines
        self.lines: list[int] = []  # those that are held
        self.last = 0  # the source line of the last line that was let through
        self.ended = True  # whether the last line that was let through has its line end

    def let_through(self, text: bytes, lines: Lines) -> tuple[bytes, Lines]:
        """Return what can be written of a text, and the source lines that belong to it."""
        if not text:
            return text, lines
        text, lines = self.held + text, [*self.lines, *lines] if self.lines else lines
        at = _closing(text)
        count = lines_in(text[at:]) if at < len(text) else 0
        rest = len(lines) - count
        self.held, self.lines = text[at:], list(lines[rest:])
        text, lines = text[:at], lines[:rest]
        self._note(text, lines)
        return text, lines

    def _note(self, text: bytes, lines: Lines) -> None:
        if self.own is None and b"\r" in text:
            self.own = self.written.copy()
        if self.own is not None:
            self.own.update(sealed(text))
        if text:
            self.last = int(lines[-1])
            self.ended = text.endswith((b"\n", b"\r"))

    def close(self, end: bytes, seals: bool) -> tuple[bytes, list[int]]:
        """Return the seal, if it is wanted, and what was held, with the source lines.

        `end` is a line end.
        """
        before = b"" if self.ended else end
        digest = (self.own or self.written).copy()
        digest.update(sealed(before + self.held))
        digits = short(digest.hexdigest()) if self.fixed is None else self.fixed
        line = comment_line(self.dialect, f"GCXFORM SEAL {digits}") if digits and seals else b""
        if not line:
            return self.held, self.lines
        self.added = 1
        return before + line + end + self.held, [self.last, *self.lines]


def _closing(text: bytes) -> int:
    """Return where the percent sign begins that may close a program; else the length."""
    body = text.rstrip(b" \t\r\n")
    if not body.endswith(b"%"):
        return len(text)
    at = max(body.rfind(b"\n"), body.rfind(b"\r")) + 1
    alone = body[at:].strip(b" \t") == b"%" and len(text) - at <= HELD_AT_MOST
    return at if alone else len(text)
