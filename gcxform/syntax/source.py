"""A program as bytes, cut into windows of whole lines: memory does not grow with the file.

A source is a copy, in memory or in a temporary file without a name. So every reading is of the same
bytes, and a file that is written to meanwhile is refused (GX904).
"""

from __future__ import annotations

import io
import os
import re
import stat
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import IO, BinaryIO, cast

from gcxform.config import arguments
from gcxform.diagnostics import FileError, InputError, Location
from gcxform.syntax.undecided import DECIDED, Undecided
from gcxform.system.inputs import UTF16, is_changed, is_utf16
from gcxform.system.limits import how_to_raise, limits
from gcxform.system.stages import stage

IN_MEMORY = 1 << 24  # bytes of a program or an output; more goes to a temporary file
TICK = 0.01  # s; two writes may be that far apart and have the same time
SHOWN = 100  # characters of a line that is too long
WINDOW = 1 << 20  # bytes; what is worked on at once should stay in the processor's cache
CHUNK = 1 << 22
LOOK_BACK = 1 << 20  # bytes; so long a row of corners is divided
CORNER = re.compile(rb",[ \t]*[RrCc]")
COMMENT = re.compile(rb"\([^()\r\n]*\)")  # of every dialect; some have others besides


class Source:
    """A program and its name. The stream can be read from the start more than once.

    `assumed` is what was chosen among several meanings where the text was made of another one, and
    `undecided` what of it only the machine decides;
    `written` is when its file was (seconds of the epoch), None for what is no file; `folder` is
    where that lies, whose other files it may call, `suffix` the ending of its name, and `state`
    what the system said of it when it was read.
    """

    assumed: tuple[str, ...] = ()
    undecided: Undecided = DECIDED
    folder: Path | None = None
    suffix = ""
    state: os.stat_result | None = None

    def __init__(self, stream: BinaryIO, name: str = "-", written: float | None = None) -> None:
        self.stream = stream
        self.name = name
        self.written = written

    @classmethod
    def of_bytes(cls, text: bytes, name: str = "-") -> Source:
        """Return a program held in memory."""
        return cls(io.BytesIO(text), name)

    @classmethod
    def open(cls, path: Path, called: str = "") -> Source:
        """Return a copy of a program in a file, or in a pipe that has a name. Raises FileError.

        `called` is what messages call it, where that is not its path.
        """
        name = called or str(path)
        try:
            kind = path.stat().st_mode
            if stat.S_ISDIR(kind):
                hint = "run, post, batch, watch and machine new take folders"
                raise FileError.one("GX901", f"{name} is a directory, not a program", hint=hint)
            if stat.S_ISCHR(kind) or stat.S_ISBLK(kind):
                hint = "- is the program on stdin"
                raise FileError.one("GX901", f"{name} is a device, not a program", hint=hint)
            with path.open("rb") as stream:
                found = cls.copied(stream, name)
            if stat.S_ISREG(kind):
                found.folder, found.suffix = path.parent, path.suffix
            return found
        except (OSError, ValueError) as error:  # ValueError: a null character in the name
            reason = getattr(error, "strerror", None) or str(error)
            raise FileError.one("GX901", f"cannot read {name}: {reason}") from None

    @classmethod
    def copied(cls, stream: BinaryIO, name: str = "-") -> Source:
        """Return a copy of what a stream gives, from which all is read. Raises FileError.

        A source is read more than once, to guess, to execute, to transform: from what is still
        being written every time would get something else. A copy of a regular file is refused if
        the file was written to meanwhile.
        """
        before = _settled(stream)
        with ExitStack() as stack:
            copy = stack.enter_context(tempfile.SpooledTemporaryFile(max_size=IN_MEMORY))
            size = _copy(stream, copy, name, endless=before is None)
            if before is not None and is_changed(before, os.fstat(stream.fileno()), size):
                raise FileError.one("GX904", f"{name} changed while it was read")
            copy.seek(0)
            if is_utf16(copy.read(64)):
                raise FileError.one("GX901", f"{name} is not a program of bytes", hint=UTF16)
            copy.seek(0)
            stack.pop_all()  # from here on the source has it
        found = cls(cast(BinaryIO, copy), name, before.st_mtime if before else None)
        found.state = before
        return found

    def is_still(self, path: Path) -> bool:
        """Whether a file is the one that was read, and has not been written to since."""
        try:
            now = path.stat()
        except OSError:
            return False
        before = self.state
        return before is None or (
            os.path.samestat(before, now) and not is_changed(before, now, now.st_size)
        )

    def line_of(self, line: int) -> int:
        """Return the line of the file, from 1, that a line of the text came from; 0 for 0."""
        return line

    def place_of(self, line: int) -> tuple[str, int]:
        """Return the file, and its line, from 1, that a line of the text came from."""
        return self.name, self.line_of(line)

    def is_called(self, line: int) -> bool:
        """Whether a line of the text, from 0, came from a subprogram that was called."""
        return False

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
        size = size or WINDOW
        whole = self.size if self.is_long(size) else 0
        self.stream.seek(0)
        rest, coming, done = b"", max(size // 8, 1), 0
        while chunk := self.stream.read(coming):
            coming = size
            if whole:
                stage(self.name, done / whole)
            text = rest + chunk
            if (at := _too_long(text)) is not None:
                raise _refused(self._place(done + at))
            cut = before_corners(text, _last_line_end(text))
            done += cut
            if cut:
                yield text[:cut]
            rest = text[cut:]
        if rest:
            yield rest

    def _place(self, offset: int) -> Location:
        """Return the place of a line that begins at an offset, with the beginning of it."""
        self.stream.seek(0)
        line = lines_in(self.stream.read(offset)) + 1 if offset else 1
        return Location(self.name, line, 1, self.stream.read(SHOWN).decode("latin-1"))


def _copy(stream: BinaryIO, copy: IO[bytes], name: str, endless: bool) -> int:
    """Copy a stream and return its size; `endless`: nobody knows before whether it has an end."""
    size = 0
    while chunk := stream.read(CHUNK):
        copy.write(chunk)
        size += len(chunk)
        if size > limits().program_size:
            message = f"{name} has more than {limits().program_size} bytes"
            raise FileError.one("GX901", message, hint=how_to_raise("program_size"))
        if endless and _too_long(chunk) is not None:
            raise _refused(Location(name))
    return size


def _too_long(text: bytes) -> int | None:
    """Return where in a text a line begins that is longer than any of a program, None if none."""
    at, most = 0, limits().line
    while len(text) - at > most:
        end = max(text.rfind(mark, at, at + most + 1) for mark in (b"\n", b"\r"))
        if end < 0:
            return at
        at = end + 1
    return None


def _refused(where: Location) -> InputError:
    """Return the error about a line that is too long."""
    message = f"this line has more than {limits().line} bytes"
    return InputError.one("GX761", message, where, how_to_raise("line"))


def _settled(stream: BinaryIO) -> os.stat_result | None:
    """Return the state of a regular file, once its clock would show that it is written to again."""
    try:
        found = os.fstat(stream.fileno())
    except OSError:  # not a file at all
        return None
    if not stat.S_ISREG(found.st_mode):
        return None
    if 0.0 <= time.time() - found.st_mtime < TICK:
        time.sleep(TICK)
    return found


def _last_line_end(text: bytes) -> int:
    """Return how much of a text is whole lines; a CR at the very end may be half of a line end."""
    line_feed = text.rfind(b"\n") + 1
    carriage_return = text.rfind(b"\r", 0, len(text) - 1) + 1
    if carriage_return > line_feed and text[carriage_return : carriage_return + 1] != b"\n":
        return carriage_return
    return line_feed


def before_corners(text: bytes, cut: int) -> int:
    """Return where to cut a text so that a corner is not divided from the block behind it.

    `,R5.` and `,C3.` put a piece between two blocks, which may have such a word as well.
    """
    at, least = cut, max(cut - LOOK_BACK, 0)
    while at > least:
        stop = at - 1 - text.endswith(b"\r\n", 0, at)
        begin = 1 + max(text.rfind(b"\n", 0, stop), text.rfind(b"\r", 0, stop))
        if CORNER.search(text, begin, at) is None:
            return at
        at = begin
    return cut if at else 0


def has_sign(sign: re.Pattern[bytes], text: bytes) -> bool:
    """Whether a text has a pattern of capital letters that begins with one, in either case.

    It is asked of every program before anything else can begin, so it has to be fast: a letter is
    found ten times as quickly as one of two, and most windows of a long program do not have it.
    """
    letter = sign.pattern[:1]
    has_letter = letter in text or letter.lower() in text
    return has_letter and sign.search(text.upper()) is not None


def lines_in(text: bytes) -> int:
    """Return the number of lines of a text: LF, CRLF and CR end one, the last may have none."""
    ends = text.count(b"\n") + text.count(b"\r") - text.count(b"\r\n")
    return ends + (not text.endswith((b"\n", b"\r")))


def line_end(line: bytes) -> bytes:
    """Return what ends a line; LF if it is the last one and has none."""
    return line[len(line.rstrip(b"\r\n")) :] or b"\n"


def program_of(given: object, name: str = "-") -> Source:
    """Return a program: its bytes, or the file of that name. Raises FileError and UsageError."""
    if isinstance(given, bytes | bytearray | memoryview):
        return Source.of_bytes(bytes(given), name)
    arguments.instance("program", given, (str, Path), "the bytes of a program, or a path")
    return Source.open(Path(str(given)))
