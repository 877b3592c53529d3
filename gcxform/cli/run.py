"""`gcxform run`: the main job."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import click

from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.failures import say, warn
from gcxform.cli.common.outputs import STDOUT, check_places, same
from gcxform.cli.common.request import Asked, excluding
from gcxform.cli.common.transform import Done, Job, edited_since, transform
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry


@click.command("run", help=VERBS["run"], short_help=VERBS["run"])
@options.pipeline_options
@click.option("-o", "--output", metavar="FILE", help="Where to write.  [default: stdout]")
@click.option("--in-place", is_flag=True, help="Replace FILE by the result.")
@options.CERTIFICATE
@options.MAP
@options.VERIFY
@options.QUIET
@options.FILE
def command(
    file: str,
    output: str | None,
    in_place: bool,
    certificate: str | None,
    source_map: str | None,
    verify: str,
    quiet: bool,
    **asked: Any,
) -> None:
    """Transform one program."""
    what = Asked(**asked)
    out = _place(file, output, in_place)
    written = {"--certificate": certificate, "--map": source_map}
    read = (file, what.file, what.machine)
    check_places({"-o": None if in_place else out, **written}, read)
    pipeline = what.build()
    if not quiet:
        warn((*default_registry().diagnostics, *pipeline.warnings))
    done = transform(pipeline, Job(file, out, certificate, source_map, verify, quiet))
    if not quiet:
        warn((*edited_since(done.certificate), *done.certificate.warnings))
        say(summary(pipeline, done))


def _place(file: str, output: str | None, in_place: bool) -> str:
    """Return where the result goes. Raises UsageError."""
    if not in_place:
        return output or STDOUT
    if output is not None and not same(file, output):
        raise excluding("--in-place and -o")
    if file == STDOUT:
        raise excluding("--in-place and stdin")
    return file


def summary(pipeline: Pipeline, done: Done) -> str:
    """Return what a run has done in one or two lines."""
    found = done.certificate
    growth = found.growth["ratio"]
    counts = f"{found.growth['blocks_in']} -> {found.growth['blocks_out']} blocks"
    counts += "" if growth is None else f" (x {growth:.3g})"
    if pipeline.copies and not pipeline.text_passes:
        counts = "copied byte for byte"
    steps = " | ".join(step.name for step in pipeline.passes) or "no passes"
    head = f"{found.source['name']}: {pipeline.source.name} -> {pipeline.target.name}"
    first = f"{head}   {counts}   {steps}   {done.seconds:.2f} s"
    return "\n  ".join([first, *_states(found), *_measured(found), _proof(found)])


def _states(found: Certificate) -> Iterator[str]:
    """Yield what the temperatures were for which the program is compensated, and the drift."""
    for step in found.steps:
        for state in step.get("model", {}).get("states", ()):
            warm, sensors = state["temperatures"], state["sensors"]
            travel = state["travel"][1] - state["travel"][0]
            yield (
                f"{state['axis']} at {state['time']}: {min(warm):.1f} to {max(warm):.1f} degC at "
                f"{len(sensors)} sensors ({sensors[0]} to {sensors[-1]}), off by up to "
                f"{1000 * state['largest']:.1f} um; drift {1000 * state['drift']:.2f} um per K "
                f"over {travel:g} mm"
            )


def _measured(found: Certificate) -> Iterator[str]:
    """Yield what passes tell of their own work."""
    if found.measured:
        yield "; ".join(f"{what}: {most:.4g}" for what, most in found.measured.items())


def _proof(found: Certificate) -> str:
    """Return the outcome of the verification."""
    if not found.verified:
        return "NOT VERIFIED"
    if not found.largest:
        return "PASS"
    largest = found.largest
    text = f"largest deviation {largest['deviation']:.5f} mm of {found.budget['deviation']:.5f} mm"
    if largest["source_line"]:
        file = f"{largest['source_file']} " if "source_file" in largest else ""
        text += f", {file}source line {largest['source_line']}"
        text += f", output line {largest['output_line']}"
    return f"{text}   PASS"
