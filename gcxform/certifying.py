"""From a finished run to its certificate: what was done, what was checked, and what was not."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.certificate import Certificate
from gcxform.contract import Pass, TextPass
from gcxform.modal.tables import GROUPS
from gcxform.options import KinematicsFile, ModelFile, to_toml
from gcxform.source import lines_in
from gcxform.version import VERSION

if TYPE_CHECKING:
    from gcxform.pipeline import Pipeline
    from gcxform.run import Output, Run


def certificate(run: Run, out: Output) -> Certificate:
    """Return what was proved of a run, once its output is complete."""
    pipeline = run.pipeline
    run.text.finish()
    executed, lines = run.source is not run.given, 0
    for text in run.given.windows() if executed else ():
        out.read.update(text)
        lines += lines_in(text)
    made = Certificate(
        VERSION,
        {"name": run.source.name, "dialect": pipeline.source.name, "lines": lines or out.lines_in}
        | {"sha256": out.read.hexdigest()},
        {"dialect": pipeline.target.name, "lines": out.lines_out}
        | {"sha256": out.written.hexdigest()},
        [_described(step) for step in pipeline.passes],
        _budget(pipeline, run.findings.inch),
        {"blocks_in": out.lines_in, "blocks_out": out.lines_out}
        | {"ratio": out.growth, "limit": pipeline.growth},
        run.verifier is not None or (pipeline.copies and run.verify != "off"),
    )
    made.measured = run.measured
    made.added = run.added
    _fill(run, made)
    return made


def _fill(run: Run, certificate: Certificate) -> None:
    if run.verifier is None:
        if run.pipeline.copies and not run.text.passes:
            certificate.not_checked.append("meaning: every byte was copied")
        elif run.verify == "off":
            certificate.not_checked.append("anything: verification was switched off")
        return
    found = run.findings
    certificate.largest = {
        "deviation": found.deviation,
        "source_line": run.source.line_of(found.source_line),
        "output_line": found.output_line,
        "angle": found.angle,
    }
    certificate.checked = {"moves": found.moves, "events": found.events}
    _not_checked(run, certificate)


def _not_checked(run: Run, certificate: Certificate) -> None:
    if run.executes:
        what = "the order in which calls and loops execute blocks: it was found once"
        certificate.not_checked.append(what)
    assert run.interpreter is not None
    found = run.findings
    for count, what in (
        (
            found.rapids,
            "rapids: only their ends, because controls do not move straight in them",
        ),
        (found.unknown_starts, "moves from an unknown position: only their ends"),
        (
            found.between_taps,
            f"moves between taps: only that they are within {found.aside:.4f} mm",
        ),
        (found.lines_after_end, "lines after the end of the program: copied, not read"),
    ):
        if count:
            certificate.not_checked.append(f"{what}: {count}")
    if added := [f"{count} {what}" for what, count in run.added.items() if count]:
        what = "whether the tool is clear in moves that the source does not have"
        certificate.not_checked.append(f"{what}: {', '.join(added)}")
    stated = run.interpreter.state.stated
    for group in GROUPS:
        if group not in stated and group not in ("motion", "arc-distance"):
            code = run.pipeline.source.initial[group]
            certificate.assumed.append(f"{group} {code}, which the program does not state")
    if run.pipeline.source.follows_at_start is False:
        certificate.assumed.append("the control does not follow the tip before the first block")
    for axis, value in run.interpreter.reading.start.items():
        certificate.assumed.append(f"{axis} stands at {value:g} before the first block")
    for name, value in run.interpreter.reading.parameters.items():
        certificate.assumed.append(f"#{name} is {value:g} before the first block")


def _described(step: Pass | TextPass) -> dict[str, Any]:
    """Return a step's name, options and promise for the certificate."""
    entry: dict[str, Any] = {"use": step.name, **to_toml(step)}
    for key, value in vars(step).items():
        if isinstance(value, ModelFile | KinematicsFile):
            entry[key] = {"file": value.path.name, "sha256": value.sha256}
            if isinstance(value, ModelFile) and value.model.states:
                entry[key] |= {"states": [asdict(state) for state in value.model.states]}
    if isinstance(step, Pass):
        entry["promise"] = step.promise if np.isfinite(step.promise) else None
    return entry


def _budget(pipeline: Pipeline, inch: bool) -> dict[str, object]:
    promised = pipeline.promised()
    return {
        "deviation": pipeline.limit(inch),
        "explicit": pipeline.budget is not None,
        "steps": promised if np.isfinite(promised) else None,
        "rounding": pipeline.rounding(inch),
    }
