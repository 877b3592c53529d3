"""Where the text of a run goes: what is counted, hashed, sealed and proved on the way."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import field

from gcxform.stamps.comment import StampReader
from gcxform.stamps.writing import Heads, Lines, Seal
from gcxform.values import dataclass

Sink = Callable[[bytes], object]


@dataclass
class Output:
    """Where the text of a run goes, and what is counted on the way. Stamps are no blocks."""

    sink: Sink
    source_map: list[int] | None
    seal: Seal | None = None
    proof: StampReader | None = None
    read: hashlib._Hash = field(default_factory=hashlib.sha256)
    written: hashlib._Hash = field(default_factory=hashlib.sha256)
    lines_in: int = 0
    lines_out: int = 0
    stamps_in: int = 0
    stamps_out: int = 0

    @property
    def blocks_in(self) -> int:
        """The lines read, without those of stamps."""
        return self.lines_in - self.stamps_in

    @property
    def blocks_out(self) -> int:
        """The lines written, without those of stamps."""
        return self.lines_out - self.stamps_out

    @property
    def growth(self) -> float | None:
        """Blocks written for each one read; None where nothing was read."""
        return self.blocks_out / self.blocks_in if self.blocks_in else None

    def put(self, text: bytes, lines: Lines) -> None:
        """Hand text on; `lines` are those of the source, from 0, for each of its lines."""
        if self.seal is not None:
            text, lines = self.seal.let_through(text, lines)
        self._write(text, lines)

    def close(self, heads: Heads) -> None:
        """Write what has been held back, and the seal if the program has a head.

        A program in a language of its own has sealed itself.
        """
        self.stamps_in, self.stamps_out = heads.removed, heads.added + bool(heads.added)
        if self.seal is None:
            return
        text, lines = self.seal.close(heads.line_end, not heads.waits)
        self.stamps_out = heads.added + self.seal.added
        self._write(text, lines)

    def _write(self, text: bytes, lines: Lines) -> None:
        self.lines_out += len(lines)
        if self.source_map is not None:
            self.source_map += list(lines)
        self.written.update(text)
        if self.proof is not None:
            self.proof.take(text)
        self.sink(text)
