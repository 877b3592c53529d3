"""Foreign file formats of error models: the door through which plugins read other tables."""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path
from typing import ClassVar

from gcxform.machine.errors import ErrorModel


class ErrorFormat(ABC):
    """A file format of error models; its docstring is what `gcxform list formats` shows.

    `name` is unique among the formats, `suffixes` are the file name endings which are usual.
    """

    name: ClassVar[str]
    suffixes: ClassVar[tuple[str, ...]]

    @classmethod
    @abstractmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the file or directory is meant to be of this format; raise nothing."""

    @classmethod
    @abstractmethod
    def read(cls, path: Path) -> ErrorModel:
        """Return the model of a file, or raise UsageError with file and line."""
