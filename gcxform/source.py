"""A program as bytes, cut into windows of whole lines: memory does not grow with the file."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

from gcxform.diagnostics import FileError, Location

WINDOW = 1 << 20  # bytes; what is worked on at once should stay in the processor's cache
CHUNK = 1 << 22
COMMENT = re.compile(rb"\([^()\r\n]*\)")  # of every dialect; some have others besides


class Source:
    """A program and its name. The stream can be read from the start more than once."""

    def __init__(self, stream: BinaryIO, name: str = "-") -> None:
        self.stream = stream
        self.name = name

    @classmethod
    def of_bytes(cls, text: bytes, name: str = "-") -> Source:
        """Return a program held in memory."""
        return cls(io.BytesIO(text), name)

    @classmethod
    def open(cls, path: Path) -> Source:
        """Return a program in a file. Raises FileError."""
        try:
            if path.is_dir():
                raise FileError.one("GX901", f"{path} is a directory, not a program")
            return cls(path.open("rb"), str(path))
        except OSError as error:
            raise FileError.one("GX901", f"cannot read {path}: {error.strerror}") from None

    def line_of(self, line: int) -> int:
        """Return the line of the file, from 1, that a line of the text came from; 0 for 0."""
        return line

    def shown(self, where: Location) -> Location:
        """Return a place in the file for one in the text."""
        return replace(where, line=self.line_of(where.line))

    @property
    def size(self) -> int:
        """How many bytes there are."""
        return self.stream.seek(0, io.SEEK_END)

    def is_long(self, size: int = 0) -> bool:
        """Whether there is more text than one window of that size."""
        return self.size > (size or WINDOW)

    def axes(self, among: str) -> str:
        """Return those of the axes that the program may name, X, Y and Z whether it does or not.

        An axis less is a column less in all that follows, so letters in comments do not count.
        """
        self.stream.seek(0)
        found = set("XYZ")
        while chunk := self.stream.read(CHUNK):
            text = b""
            for axis in (axis for axis in among if axis not in found):
                either = axis.encode(), axis.lower().encode()
                if either[0] in chunk or either[1] in chunk:
                    text = text or COMMENT.sub(b"", chunk)
                    found |= {axis} if either[0] in text or either[1] in text else set()
        return "".join(axis for axis in among if axis in found)

    def windows(self, size: int = 0) -> Iterator[bytes]:
        """Yield the text, a number of whole lines at a time: `size` bytes, or 0 for WINDOW.

        The first is shorter, so that who works on what was read begins sooner.
        """
        self.stream.seek(0)
        size = size or WINDOW
        rest, coming = b"", max(size // 8, 1)
        while chunk := self.stream.read(coming):
            coming = size
            text = rest + chunk
            cut = _last_line_end(text)
            if cut:
                yield text[:cut]
            rest = text[cut:]
        if rest:
            yield rest


def _last_line_end(text: bytes) -> int:
    """Return how much of a text is whole lines; a CR at the very end may be half of a line end."""
    line_feed = text.rfind(b"\n") + 1
    carriage_return = text.rfind(b"\r", 0, len(text) - 1) + 1
    if carriage_return > line_feed and text[carriage_return : carriage_return + 1] != b"\n":
        return carriage_return
    return line_feed


def lines_in(text: bytes) -> int:
    """Return the number of lines of a text: LF, CRLF and CR end one, the last may have none."""
    ends = text.count(b"\n") + text.count(b"\r") - text.count(b"\r\n")
    return ends + (not text.endswith((b"\n", b"\r")))
