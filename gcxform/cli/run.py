"""`gcxform run`: the main job."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

import click

from gcxform.cli import VERBS
from gcxform.cli.common import options
from gcxform.cli.common.answer import asked
from gcxform.cli.common.difference import described, on_terminal, unified
from gcxform.cli.common.failures import say, warn
from gcxform.cli.common.jobs import Places
from gcxform.cli.common.pipelines import Pipelines
from gcxform.cli.common.request import Asked
from gcxform.cli.common.several import Outcome, counted, each, exit_code
from gcxform.cli.common.transform import Done, Job, edited_since
from gcxform.diagnostics import shown
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.pipeline import Pipeline


@click.command("run", help=VERBS["run"], short_help=VERBS["run"])
@options.pipeline_options
@click.option(
    "-o", "--output", metavar="FILE", help="Where to write, or a folder.  [default: stdout]"
)
@click.option("--in-place", is_flag=True, help="Replace each FILE by its result.")
@click.option("--check", is_flag=True, help="Write nothing; exit 1 if anything would change.")
@click.option("--diff", is_flag=True, help="Write nothing; print what would change, and why.")
@options.CERTIFICATE
@options.MAP
@options.VERIFY
@options.QUIET
@options.FILES
def command(
    files: tuple[str, ...],
    output: str | None,
    in_place: bool,
    check: bool,
    diff: bool,
    certificate: str | None,
    source_map: str | None,
    verify: str,
    quiet: bool,
    **asked_: Any,
) -> int:
    """Transform programs, those of folders too; each by itself, all or nothing."""
    pipelines = Pipelines(Asked(**asked_), not quiet, not quiet)
    places = Places(output, in_place, check or diff, certificate, source_map)
    like = Job("", None, verify=verify, quiet=quiet, compared=diff)
    jobs = places.jobs(files, like, pipelines.read)
    for job in jobs:  # what is wrong with pipelines ends the call before a program is read
        pipelines.of(job.file)
    outcomes = []
    for outcome in each(pipelines.of, jobs):
        outcomes.append(outcome)
        _tell(outcome, pipelines, diff, quiet)
    if len(outcomes) > 1 and not quiet and asked() is None:
        say(counted(outcomes))
    return exit_code(outcomes, check)


def _tell(outcome: Outcome, pipelines: Pipelines, diff: bool, quiet: bool) -> None:
    """Say what became of a program, and show what would change of it."""
    if (document := asked()) is not None:
        parts = {"diff": described(outcome.done)} if diff and outcome.done else {}
        document.values.setdefault("programs", []).append({**outcome.described(), **parts})
    if outcome.done is None:
        if outcome.state == "done-before" and not quiet and document is None:
            say(f"{shown(outcome.job.file)}: {outcome.why}")
        return
    if not quiet:
        warn((*edited_since(outcome.done.certificate), *outcome.done.certificate.warnings))
        if document is None:
            say(summary(pipelines.of(outcome.job.file), outcome.done))
    if diff and document is None:
        _show(outcome.done)


def _show(done: Done) -> None:
    """Print a diff: in colour on a terminal, as bytes elsewhere."""
    terminal = sys.stdout is not None and sys.stdout.isatty()
    for line in unified(done):
        click.echo(on_terminal(line) if terminal else line.encode("latin-1"), nl=False)


def summary(pipeline: Pipeline, done: Done) -> str:
    """Return what a run has done in one or two lines."""
    found = done.certificate
    growth = found.growth["ratio"]
    counts = f"{found.growth['blocks_in']} -> {found.growth['blocks_out']} blocks"
    counts += "" if growth is None else f" (x {growth:.3g})"
    if pipeline.copies and not pipeline.text_passes:
        counts = "copied byte for byte"
    steps = " | ".join(step.name for step in pipeline.passes) or "no passes"
    head = f"{shown(found.source['name'])}: {pipeline.source.name} -> {pipeline.target.name}"
    first = f"{head}   {counts}   {steps}   {done.seconds:.2f} s"
    return "\n  ".join([first, *_nothing(found), *_states(found), *_measured(found), _proof(found)])


def _nothing(found: Certificate) -> Iterator[str]:
    """Say that nothing was there to be transformed: a file may have been lost on the way."""
    if not found.growth["blocks_in"]:
        yield "the file is empty: it holds no block"
    elif found.verified and found.checked.get("moves") == 0:
        yield "no block of it moves an axis"


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
