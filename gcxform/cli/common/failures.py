"""From exceptions to messages and exit codes: nothing else of the package prints an error."""

from __future__ import annotations

import errno
import json
import os
import re
import sys
import tempfile
import traceback
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, Final, TextIO

import click

from gcxform.catalogue.offers import said_to_chain
from gcxform.catalogue.questions import questions
from gcxform.cli.common import DEBUG
from gcxform.cli.common.findings import described
from gcxform.cli.common.options import ENVIRONMENT
from gcxform.cli.common.signals import Ended, ending
from gcxform.diagnostics import Diagnostic, FileError, GcxformError, render_all
from gcxform.system.inputs import visit
from gcxform.version import VERSION

USAGE: Final = 2
FAILED: Final = 5
BUG: Final = 70
INTERRUPTED: Final = 130
WORDS: Final = "gcxform.words"
FOUND: Final = "gcxform.found"
JSON_VERBS: Final = ("check", "info")
"""Verbs of which `--json` makes all that they say JSON, what ends them included."""
ALL_AT_ONCE: Final = "gcxform check, with the same words, says all that is missing at once, as TOML"

_HEAD = re.compile(r"\b(error|warning|note)\[(GX\d+)\]:")
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
        with group.make_context(name, words, **extra) as context:
            meta = context.meta
            meta[WORDS] = words
            code = group.invoke(context)
        if sys.stdout is not None:
            sys.stdout.flush()
        return code if isinstance(code, int) else 0
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except click.ClickException as error:
        if _says_json(words):
            _say_json([*meta.get(FOUND, ()), Diagnostic("", error.format_message())])
        else:
            error.show()
        return USAGE
    except GcxformError as error:
        return _refused(error, words, meta)
    except click.Abort:
        say("interrupted")
        return INTERRUPTED
    except (OSError, MemoryError) as error:
        return _system_failure(error, words)
    except Exception:
        return _bug(words, bool(meta.get(DEBUG)))


def _refused(error: GcxformError, words: list[str], meta: Mapping[str, Any]) -> int:
    """Report what a user can mend; return the exit code."""
    if _says_json(words):
        _say_json([*meta.get(FOUND, ()), *error.diagnostics])
        return error.exit_code
    say(paint(render_all(_typed(error.diagnostics, words)), sys.stderr))
    if words[:1] == ["run"] and _asks(error):
        say(ALL_AT_ONCE)
    return error.exit_code


def _says_json(words: Sequence[str]) -> bool:
    """Whether a command line asks that all that is found be JSON."""
    verb = next((word for word in words if not word.startswith("-")), "")
    return verb in JSON_VERBS and "--json" in words


def _say_json(found: Sequence[Diagnostic]) -> None:
    """Print what ended a verb as the findings that they are; as text if stdout is no more."""
    try:
        click.echo(json.dumps({"findings": [described(each) for each in found]}, indent=2))
    except OSError:
        _abandon_stdout()
        say(paint(render_all(found), sys.stderr))


def _asks(error: GcxformError) -> bool:
    """Whether an error ends if more is said of the program or the machine."""
    return any(True for each in error.diagnostics for _ in questions(each.hint))


def say(text: str) -> None:
    """Write a line to stderr, if there is one."""
    if sys.stderr is not None:
        with suppress(OSError):
            print(text, file=sys.stderr, flush=True)


def warn(diagnostics: Iterable[Diagnostic]) -> None:
    """Write findings that stop nothing to stderr; where all is JSON, keep them for it."""
    context = click.get_current_context(silent=True)
    words = [] if context is None else context.meta.get(WORDS, [])
    if context is not None and _says_json(words):
        context.meta.setdefault(FOUND, []).extend(diagnostics)
        return
    if text := render_all(_typed(diagnostics, words)):
        say(paint(text, sys.stderr))


def _typed(diagnostics: Iterable[Diagnostic], words: Iterable[str]) -> list[Diagnostic]:
    """Return diagnostics with hints for who has no pipeline file: as the command line takes them.

    Who named one, or has one in the environment, can write into it what a hint gives.
    """
    options = [word.partition("=")[0] for word in words]
    chain = any(word == "--chain" or word.startswith("-x") for word in options)
    file = any(word == "--pipeline" or word.startswith("-p") for word in options)
    if file or (os.environ.get(ENVIRONMENT) and not chain):
        return list(diagnostics)
    return [replace(each, hint=said_to_chain(each.hint)) for each in diagnostics]


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


def _system_failure(error: OSError | MemoryError, words: list[str]) -> int:
    """Report what the operating system refused; a reader that went away is no news."""
    if isinstance(error, MemoryError):
        error = OSError(errno.ENOMEM, "there is not enough memory")
    if error.errno == errno.EPIPE:
        _abandon_stdout()
        return FAILED
    what = f"{error.filename}: " if error.filename else ""
    failure = FileError.one("GX903", f"{what}{error.strerror or error}")
    if _says_json(words):
        _say_json(failure.diagnostics)
    else:
        _abandon_stdout()
        say(paint(failure.render(), sys.stderr))
    return failure.exit_code


def _abandon_stdout() -> None:
    """Keep Python from flushing once more at exit what cannot be written."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _bug(words: list[str], debug: bool) -> int:
    """Report an exception that nobody foresaw: to a file, with a traceback only on demand."""
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
        handle, name = tempfile.mkstemp(prefix="gcxform-bug-", suffix=".txt")
        with os.fdopen(handle, "w", encoding="utf-8", errors="backslashreplace") as stream:
            stream.write(text)
        return name
    return ""
