"""The lines of files that a program calls, put behind its own; an empty line ends each part.

Who comes to such a line, a seam, has left a file at its end.
"""

from __future__ import annotations

import re
from pathlib import Path

from gcxform.flow.executed import CalledFile
from gcxform.flow.lookup import Folders, Found, only

BYTE_ORDER_MARK = b"\xef\xbb\xbf"
LEADER = b"\0\x7f"  # NUL and DEL, as in `iso.lark`
BLANK_TAPE = LEADER.decode("latin-1")
LINE_END = re.compile(rb"\r\n|\n|\r")
ENDS = re.compile(LINE_END.pattern.decode("latin-1"))


def lines_of(text: bytes) -> list[str]:
    """Return the lines of a program, without the leader of a tape and what editors put first."""
    text = text.removeprefix(BYTE_ORDER_MARK)
    whole = text.decode("latin-1")
    lines = whole.split("\n") if b"\r" not in text else ENDS.split(whole)
    if any(sign in text for sign in LEADER):
        return [line if line.strip(BLANK_TAPE) else "" for line in lines]
    return lines


class Annexed:
    """The files behind the lines of a program, which are added to `lines`.

    files  what is called, in order;  seams: the lines behind the last of each part
    """

    def __init__(self, lines: list[str], folders: Folders) -> None:
        self.lines = lines
        self.folders = folders
        self.files: list[CalledFile] = []
        self.seams = {len(lines)}
        self._parts: list[range] = []

    def file(self, name: str) -> range | None:
        """Return the lines of the file of a subprogram, None without one.

        Raises LookupFailedError for two files that differ.
        """
        for file, lines in zip(self.files, self._parts, strict=True):
            if Path(file.name).stem.casefold() == name.casefold():
                return lines
        found = only([*self.folders.of_name(name)], name)
        return None if found is None else self._added(found)

    def place(self, line: int) -> tuple[str, int] | None:
        """Return the file in which a line stands, and which of its lines that is, from 1."""
        of = (k for k, part in enumerate(self._parts) if part.start <= line <= part.stop)
        at = next(of, None)
        return None if at is None else (self.files[at].name, line - self._parts[at].start + 1)

    def _added(self, found: Found) -> range:
        """Put the lines of a file behind those there are."""
        if not self.files:
            self.lines.append("")
        first, lines = len(self.lines), lines_of(found.text)
        self.files.append(CalledFile(found.name, first, found.text))
        self.lines += lines if lines[-1] else lines[:-1]
        self._parts.append(range(first, len(self.lines)))
        self.seams.add(len(self.lines))
        self.lines.append("")
        return self._parts[-1]
