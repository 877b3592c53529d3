"""`gcxform post`: edits a file in place, as CAM systems and slicers call it.

They pass the file last, show stderr in a plain box when the exit code is not 0, and read the file
again. The dialect is never guessed from the file's name, which they make up.
"""

from __future__ import annotations

import sys
from typing import Any, Final

import click

from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.outputs import STDOUT, check_places
from gcxform.cli.common.request import Asked, excluding
from gcxform.cli.common.transform import Job, edited_since, transform
from gcxform.diagnostics import GcxformError
from gcxform.stamps.chain import DONE

SHOWN: Final = 4  # findings that fit into a dialog box


@click.command("post", help=VERBS["post"], short_help=VERBS["post"])
@options.pipeline_options
@options.CERTIFICATE
@options.MAP
@options.VERIFY
@options.FILE
def command(
    file: str,
    certificate: str | None,
    source_map: str | None,
    verify: str,
    **asked: Any,
) -> int:
    """Transform a file in place; exit 0 only if it was written."""
    try:
        _post(Asked(**asked), Job(file, file, certificate, source_map, verify, quiet=True))
    except GcxformError as error:
        if error.diagnostics[0].code == DONE:  # the file is what was asked for
            print(f"{file}: {error.diagnostics[0].message}", file=sys.stderr, flush=True)
            return 0
        print(_plain(error), file=sys.stderr, flush=True)
        return error.exit_code
    return 0


def _post(asked: Asked, job: Job) -> None:
    if job.file == STDOUT:
        raise excluding("post, which edits a file, and stdin")
    written = {"--certificate": job.certificate, "--map": job.source_map}
    check_places(written, (job.file, asked.file, asked.machine))
    done = transform(asked.build(), job)
    for warning in edited_since(done.certificate):
        print(warning.render(), file=sys.stderr, flush=True)


def _plain(error: GcxformError) -> str:
    """Return the first findings without colour."""
    first = type(error)(error.diagnostics[:SHOWN])
    more = len(error.diagnostics) - SHOWN
    return f"{first.render()}\n... and {more} more" if more > 0 else first.render()
