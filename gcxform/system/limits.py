"""What one run may take: limits that no program of a machine reaches, and hostile input does.

What is counted is counted where it comes in, once: lines and programs in `source`, files in
`inputs`, expressions in `syntax`, moves in `toolpath`, executed lines in `flow`, the parts of an
error model in `machine`. A limit that is reached is a diagnostic, and says how to raise it.

A pass gives its counts to `Toolpath.check_rows` before it makes points of them. Trees of lark are
no deeper than `nesting`, and therefore code that follows them may call itself.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import fields
from typing import Annotated

from gcxform.system.option_mark import Option
from gcxform.values import dataclass

FRAMES_A_LEVEL = 8  # calls of Python that one level of an expression may take, and some to spare
SHALLOW = 100  # levels for which Python's own limit is enough


@dataclass(frozen=True)
class Limits:
    """The limits of a run: `[limits]` of a pipeline file, or `--limit KEY=N`."""

    line: Annotated[int, Option("bytes of one line of a program", at_least=1)] = 1 << 17
    nesting: Annotated[
        int, Option("levels of an expression, or of sums of error models", at_least=1, at_most=1000)
    ] = SHALLOW
    rows: Annotated[
        int, Option("moves that a window of a program, a megabyte, may become", at_least=1)
    ] = 800_000
    steps: Annotated[
        int, Option("lines with calls and loops that are executed one by one", at_least=1)
    ] = 500_000
    parts: Annotated[int, Option("files that one error model may be made of", at_least=1)] = 100
    file_size: Annotated[
        int, Option("bytes of a pipeline, machine, model or data file", at_least=1)
    ] = 1 << 26
    program_size: Annotated[int, Option("bytes of a program", at_least=1)] = 1 << 32


DEFAULT = Limits()
_IN_FORCE: ContextVar[Limits | None] = ContextVar("limits", default=None)


def limits() -> Limits:
    """Return the limits in force."""
    return _IN_FORCE.get() or DEFAULT


def said() -> Limits | None:
    """Return the limits that were said, None if none were."""
    return _IN_FORCE.get()


@contextmanager
def in_force(chosen: Limits | None) -> Iterator[None]:
    """Let limits hold until the block ends, unless some were said before: on the command line."""
    if chosen is None or _IN_FORCE.get() is not None:
        yield
        return
    token, depth = _IN_FORCE.set(chosen), sys.getrecursionlimit()
    if chosen.nesting > SHALLOW:
        sys.setrecursionlimit(depth + FRAMES_A_LEVEL * chosen.nesting)
    try:
        yield
    finally:
        sys.setrecursionlimit(depth)
        _IN_FORCE.reset(token)


def how_to_raise(name: str, needed: int = 0) -> str:
    """Return the hint for a limit that is reached, by the name of its field.

    What is `needed` may be so much that nobody means it.
    """
    now = getattr(limits(), name)
    if needed > 10 * now:
        return "look for a length or a tolerance that is nearly nothing, or lacks its unit"
    assert name in {field.name for field in fields(Limits)}
    key = name.replace("_", "-")
    return f"if that is meant: {key} = {10 * now} in [limits], or --limit {key}={10 * now}"
