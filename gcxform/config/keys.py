"""What the keys of files say, at the fields that have them: for schemas, and for the reference."""

from __future__ import annotations

import msgspec


def says(sentence: str) -> msgspec.Meta:
    """Return what a key says, for `Annotated`: a sentence without a full stop, with its unit."""
    return msgspec.Meta(description=sentence)
