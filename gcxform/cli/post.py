"""`gcxform post`: edits a file in place, as CAM systems and slicers call it.

They pass the file last, show stderr in a plain box when the exit code is not 0, and read the file
again. The dialect is never guessed from the file's name, which they make up.

With --filter the file stays, and stdout is the program: as LinuxCNC's interfaces call it. What was
done already is handed on as it is. They read stderr as UTF-8, and fail where it is not.
"""

from __future__ import annotations

import sys
from typing import Any, Final

import click

from gcxform.cli import VERBS
from gcxform.cli.common import answer, options
from gcxform.cli.common.failures import typed
from gcxform.cli.common.outputs import STDOUT, check_places
from gcxform.cli.common.pipelines import Pipelines
from gcxform.cli.common.request import Asked, excluding
from gcxform.cli.common.several import attempt
from gcxform.cli.common.transform import Job, edited_since
from gcxform.diagnostics import GcxformError

SHOWN: Final = 4  # findings that fit into a dialog box


@click.command("post", help=VERBS["post"], short_help=VERBS["post"])
@options.pipeline_options
@options.CERTIFICATE
@options.MAP
@options.VERIFY
@click.option(
    "--filter",
    "filters",
    is_flag=True,
    help="Write to stdout, and how far it is to stderr: for [FILTER] of LinuxCNC.",
)
@options.FILE
def command(
    file: str,
    certificate: str | None,
    source_map: str | None,
    verify: str,
    filters: bool,
    **asked: Any,
) -> int:
    """Transform a file in place; exit 0 only if it was written."""
    if filters and hasattr(sys.stderr, "reconfigure"):
        sys.stderr.reconfigure(encoding="utf-8", errors="backslashreplace")
    out = STDOUT if filters else file
    try:
        _post(Asked(**asked), Job(file, out, certificate, source_map, verify, True, filters))
    except GcxformError as error:
        if answer.asked() is not None:
            raise
        _say(_plain(error))
        return error.exit_code
    return 0


def _post(asked: Asked, job: Job) -> None:
    """Run, and say what is worth a warning; what was done already is what was asked for."""
    if job.file == STDOUT:
        raise excluding("post, which edits a file, and stdin")
    pipelines = Pipelines(asked, warns=False)
    written = {"--certificate": job.certificate, "--map": job.source_map}
    check_places(written, (job.file, *pipelines.read))
    outcome = attempt(pipelines.of, job)
    if (document := answer.asked()) is not None:
        document.values["programs"] = [outcome.described()]
    elif outcome.done is None:
        _say(f"{job.file}: {outcome.why}")
    else:
        for warning in edited_since(outcome.done.certificate):
            _say(warning.render())


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _plain(error: GcxformError) -> str:
    """Return the first findings without colour, as the command line takes their hints."""
    meta = click.get_current_context().meta
    first = type(error)(tuple(typed(error.diagnostics[:SHOWN], meta)))
    more = len(error.diagnostics) - SHOWN
    return f"{first.render()}\n... and {more} more" if more > 0 else first.render()
