"""What a verb answers: lines for a person, or with `--json` one document for a program.

    {"format": 1, "verb": "run", "exit_code": 0, "findings": [], "written": ["out.nc"], ...}

All verbs take `--json`. What they would print to stdout besides is in `output`; files are written
as without it. `gcxform schema answer` prints the schema (`gcxform/cli/schemas/`), which has what
each verb adds. A document is printed for failures too: what went wrong is in `findings`.
"""

from __future__ import annotations

import io
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from dataclasses import field
from typing import Any, Final, TextIO

import click

from gcxform.cli.common.findings import described
from gcxform.diagnostics import Diagnostic
from gcxform.system.stages import stage
from gcxform.values import dataclass

FORMAT: Final = 1
ANSWER: Final = "gcxform.answer"


@dataclass
class Answer:
    """What is known so far of what a verb answers."""

    verb: str
    values: dict[str, Any] = field(default_factory=dict)
    findings: list[Diagnostic] = field(default_factory=list)
    written: list[str] = field(default_factory=list)
    real: TextIO = field(default_factory=lambda: sys.stdout)
    output: io.TextIOWrapper = field(
        default_factory=lambda: io.TextIOWrapper(
            io.BytesIO(), "utf-8", "surrogateescape", "", write_through=True
        )
    )

    def text(self, exit_code: int) -> str:
        """Return the document."""
        said = {"format": FORMAT, "verb": self.verb, "exit_code": exit_code}
        said["findings"] = [described(each) for each in self.findings]
        more = {"written": self.written, "output": _text(self.output.buffer.getvalue())}  # type: ignore[attr-defined]
        said |= {**{key: value for key, value in more.items() if value}, **self.values}
        import json

        return json.dumps(_plain(said), indent=2, allow_nan=False)


def _plain(value: Any) -> Any:
    """Return values as JSON has them: a number that is not known is null."""
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value


def _text(given: bytes) -> str:
    """Return what was printed; a program that is not UTF-8 has a character for each byte."""
    try:
        return given.decode()
    except UnicodeDecodeError:
        return given.decode("latin-1")


def asked() -> Answer | None:
    """Return the document that is being made, None if none is asked for."""
    context = click.get_current_context(silent=True)
    return None if context is None else context.meta.get(ANSWER)


def answer(values: Mapping[str, Any], lines: Iterable[str], err: bool = False) -> None:
    """Print lines, to stderr if `err`; or add values to the document if one is asked for."""
    stage("")
    if (found := asked()) is not None:
        found.values.update(values)
    elif text := "\n".join(lines):
        click.echo(text, err=err)


def note_written(name: str) -> None:
    """Remember a file that a verb has written."""
    if (found := asked()) is not None and name not in found.written:
        found.written.append(name)


@contextmanager
def lines_of_documents() -> Iterator[Callable[[str], None] | None]:
    """Give what prints documents as they come, a line for each; None where lines are wanted.

    No other document follows them.
    """
    context = click.get_current_context()
    found: Answer | None = context.meta.get(ANSWER)
    if found is None:
        yield None
        return

    def put(text: str) -> None:
        print(text, file=found.real, flush=True)

    yield put
    del context.meta[ANSWER]


def option() -> click.Option:
    """Return the option of every verb that asks for a document."""
    return click.Option(
        ["--json", "as_json"],
        is_flag=True,
        expose_value=False,
        is_eager=True,
        help="Answer with one JSON document (`gcxform schema answer`).",
        callback=_begin,
    )


def _begin(context: click.Context, _: click.Parameter, said: bool) -> None:
    verb = context.command_path.partition(" ")[2]
    found: Answer | None = context.meta.get(ANSWER)
    if found is not None:
        found.verb = verb
    elif said and not context.resilient_parsing:
        context.meta[ANSWER] = found = Answer(verb)
        context.find_root().with_resource(_kept(found.output))


@contextmanager
def _kept(stream: TextIO) -> Iterator[None]:
    """Keep what is printed to stdout in a stream."""
    real = sys.stdout
    with redirect_stdout(stream):
        yield
    assert sys.stdout is real
