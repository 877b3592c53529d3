"""The functions of `import gcxform as gx` that are not classes."""

from __future__ import annotations

from pathlib import Path

from gcxform.files import write_atomically
from gcxform.pipeline import Result


def write(result: Result | bytes, path: str | Path) -> None:
    """Write a result's program to a file, whole or not at all. Raises FileError."""
    text = result.text if isinstance(result, Result) else result
    with write_atomically(Path(path)) as put:
        put(text)
