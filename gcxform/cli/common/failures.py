"""From exceptions to messages and exit codes: nothing else of the package prints an error."""

from __future__ import annotations

import errno
import os
import re
import sys
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any, Final, TextIO

import click

from gcxform.cli.common import DEBUG
from gcxform.cli.common.answer import ANSWER, Answer
from gcxform.cli.common.options import ENVIRONMENT
from gcxform.cli.common.progress import stages_shown
from gcxform.cli.common.signals import Ended, ending
from gcxform.diagnostics import Diagnostic, FileError, GcxformError, Location, render_all
from gcxform.system.inputs import visit
from gcxform.system.stages import stage
from gcxform.version import VERSION

USAGE: Final = 2
FAILED: Final = 5
BUG: Final = 70
INTERRUPTED: Final = 130
WORDS: Final = "gcxform.words"
COUNTED: Final = ("run", "post", "watch")
"""Verbs that show by themselves how far they are, or are read by other programs."""
FOUND: Final = "gcxform.found"
ALL_AT_ONCE: Final = "gcxform check, with the same words, says all that is missing at once, as TOML"

_HEAD = re.compile(r"\b(error|warning|note)\[(GX\d+)\]:")
_VARIES = re.compile(r"\b[A-Z]\b|(?<![A-Za-z#.\d])[-+]?\d[\d.]*")
"""What differs between findings of one cause: an axis or a word, and numbers, not codes."""
_COLOUR = {"error": "31;1", "warning": "33;1", "note": "36;1"}


def guarded(group: click.Command, name: str, words: list[str], extra: Mapping[str, Any]) -> int:
    """Run a command and return its exit code; whatever goes wrong is said on stderr."""
    _tolerate_names()
    try:
        with ending(), visit():
            return _run(group, name, words, extra)
    except Ended as stopped:
        say(str(stopped))
        return stopped.exit_code


def _run(group: click.Command, name: str, words: list[str], extra: Mapping[str, Any]) -> int:
    meta: dict[str, Any] = {}
    try:
        with group.make_context(name, [*words], **extra) as context:
            meta = context.meta
            meta[WORDS] = words
            with stages_shown(not words or words[0] not in COUNTED):
                code = group.invoke(context)
            code = code if isinstance(code, int) else 0
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except click.Abort:
        say("interrupted")
        return INTERRUPTED
    except Exception as error:
        if "--json" in words and ANSWER not in meta:  # it was not come to yet
            meta[ANSWER] = Answer(_verb(error, words))
        code = told(error, {**meta, WORDS: words})
        if words[:1] == ["run"] and _asks(error) and ANSWER not in meta:
            say(ALL_AT_ONCE)
    return _finished(meta, code)


def _verb(error: Exception, words: list[str]) -> str:
    """Return the verb that a command line has come to."""
    context = error.ctx if isinstance(error, click.UsageError) else None
    path = "" if context is None else context.command_path.partition(" ")[2]
    return path or next(word for word in words if not word.startswith("-"))


def _finished(meta: Mapping[str, Any], code: int) -> int:
    """Print the document, if one is asked for, and see stdout out; return the exit code."""
    try:
        if ANSWER in meta:
            click.echo(meta[ANSWER].text(code))
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError as error:
        return max(code, _system_failure(error, None))
    return code


def told(error: Exception, meta: Mapping[str, Any]) -> int:
    """Say what went wrong, or add it to the document; return the exit code it stands for.

    `meta` is that of the context of the command.
    """
    words = meta.get(WORDS, [])
    found = meta[ANSWER].findings if ANSWER in meta else None
    if isinstance(error, click.ClickException):
        return _misspelt(error, found)
    if isinstance(error, GcxformError):
        if found is None:
            say(paint(render_all(typed(said_once(error.diagnostics), meta)), sys.stderr))
        else:
            found += error.diagnostics
        return error.exit_code
    if isinstance(error, OSError | MemoryError):
        return _system_failure(error, found)
    return _bug(words, bool(meta.get(DEBUG)))


def reported(error: Exception) -> tuple[str, int, tuple[Diagnostic, ...]]:
    """Return in words what went wrong with one program of many, the exit code, and the findings."""
    if isinstance(error, OSError | MemoryError):
        error = _as_failure(error)
    if isinstance(error, GcxformError):
        return error.render(), error.exit_code, error.diagnostics
    import traceback

    trace = "".join(traceback.format_exception(error))
    report = _report(f"gcxform {VERSION}, Python {sys.version}\n\n{trace}")
    return f"internal error: {type(error).__name__}; please report it with {report}", BUG, ()


def _misspelt(error: click.ClickException, found: list[Diagnostic] | None) -> int:
    """Report a command line that is not understood."""
    if found is None:
        error.show()
    else:
        found.append(Diagnostic("GX700", error.format_message().rstrip(".")))
    return USAGE


def _asks(error: Exception) -> bool:
    """Whether an error ends if more is said of the program or the machine."""
    found = error.diagnostics if isinstance(error, GcxformError) else ()
    from gcxform.catalogue.questions import questions

    return any(True for each in found for _ in questions(each.hint))


def say(text: str) -> None:
    """Write a line to stderr, if there is one."""
    stage("")
    if sys.stderr is not None:
        with suppress(OSError):
            print(text, file=sys.stderr, flush=True)


def warn(diagnostics: Iterable[Diagnostic]) -> None:
    """Write findings that stop nothing to stderr, or add them to the document."""
    context = click.get_current_context(silent=True)
    meta = {} if context is None else context.meta
    if ANSWER in meta:
        meta[ANSWER].findings += diagnostics
    elif text := render_all(typed(diagnostics, meta)):
        say(paint(text, sys.stderr))


def typed(diagnostics: Iterable[Diagnostic], meta: Mapping[str, Any]) -> list[Diagnostic]:
    """Return diagnostics with hints for who has no pipeline file: as the command line takes them.

    Who named one, or has one in the environment or in the folder, can write into it what a hint
    gives.
    """
    options = [word.partition("=")[0] for word in meta.get(WORDS, ())]
    chain = any(word == "--chain" or word.startswith("-x") for word in options)
    file = any(word == "--pipeline" or word.startswith("-p") for word in options)
    if file or FOUND in meta or (os.environ.get(ENVIRONMENT) and not chain):
        return list(diagnostics)
    from gcxform.catalogue.remedies import said_to_chain

    return [replace(each, hint=said_to_chain(each.hint)) for each in diagnostics]


def said_once(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return each cause once, with the other lines that have it.

    That are findings of one code whose sentences differ in axes, words and numbers alone.
    """
    first: dict[tuple[object, ...], Diagnostic] = {}
    lines: dict[tuple[object, ...], dict[int, Location]] = {}
    for each in diagnostics:
        file = each.where.file if each.where is not None else ""
        key = each.code, file, each.severity, _VARIES.sub("", each.message)
        shown = first.setdefault(key, each)
        if each.where is not None and shown.where is not None:
            others = [place for place in (each.where, *each.also) if place.line != shown.where.line]
            lines.setdefault(key, {}).update((place.line, place) for place in others)
    return [
        replace(each, also=tuple(place for _, place in sorted(lines.get(key, {}).items())))
        for key, each in first.items()
    ]


def paint(text: str, stream: TextIO) -> str:
    """Return diagnostics in colour if the stream is a terminal and NO_COLOR is not set."""
    if os.environ.get("NO_COLOR") or stream is None or not stream.isatty():
        return text
    return _HEAD.sub(lambda m: f"\x1b[{_COLOUR[m[1]]}m{m[1]}[{m[2]}]\x1b[0m:", text)


def _tolerate_names() -> None:
    """Let names that are not text be shown rather than fail."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")


def _system_failure(error: OSError | MemoryError, found: list[Diagnostic] | None) -> int:
    """Report what the operating system refused; a reader that went away is no news."""
    if isinstance(error, OSError) and error.errno == errno.EPIPE:
        _abandon_stdout()
        return FAILED
    failure = _as_failure(error)
    if found is None:
        _abandon_stdout()
        say(paint(failure.render(), sys.stderr))
    else:
        found += failure.diagnostics
    return failure.exit_code


def _as_failure(error: OSError | MemoryError) -> FileError:
    """Return what the operating system refused as an error of ours."""
    if isinstance(error, MemoryError):
        error = OSError(errno.ENOMEM, "there is not enough memory")
    what = f"{error.filename}: " if error.filename else ""
    return FileError.one("GX903", f"{what}{error.strerror or error}")


def _abandon_stdout() -> None:
    """Keep Python from flushing once more at exit what cannot be written."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _bug(words: list[str], debug: bool) -> int:
    """Report an exception that nobody foresaw: to a file, with a traceback only on demand."""
    import traceback

    trace = traceback.format_exc()
    if debug:
        say(trace.rstrip())
    kind, value, _ = sys.exc_info()
    reason = f"{kind.__name__ if kind else 'error'}: {str(value).partition(chr(10))[0]}"
    report = _report(f"gcxform {VERSION}, Python {sys.version}\n{words}\n\n{trace}")
    say(f"gcxform: internal error: {reason}")
    say(f"this is a bug; please report it{f' with {report}' if report else ''}")
    return BUG


def _report(text: str) -> str:
    """Write a report beside other temporary files; return its name, nothing if that fails."""
    with suppress(OSError):
        import tempfile

        handle, name = tempfile.mkstemp(prefix="gcxform-bug-", suffix=".txt")
        with os.fdopen(handle, "w", encoding="utf-8", errors="backslashreplace") as stream:
            stream.write(text)
        return name
    return ""
