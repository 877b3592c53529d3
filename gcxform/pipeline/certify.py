"""From a finished run to its certificate: what was done, what was checked, and what was not."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from gcxform.contract.passes import resolved
from gcxform.diagnostics import Diagnostic, InputError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.straightened import located
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.meaning.tables import GROUPS
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.lathe_doubt import lathe_doubts
from gcxform.pipeline.output import Output
from gcxform.pipeline.plan import Plan
from gcxform.pipeline.run import Run
from gcxform.proof.findings import Findings
from gcxform.stamps.chain import described
from gcxform.syntax.source import Source, lines_in
from gcxform.version import VERSION

WHOLE_FILE = "whether this is a whole program"


def certificate(run: Run, out: Output) -> Certificate:
    """Return what was proved of a run, once its output is complete."""
    plan = run.plan
    run.text.finish()
    executed, lines = run.source is not run.given, 0
    for text in run.given.windows() if executed else ():
        out.read.update(text)
        lines += lines_in(text)
    made = Certificate(
        VERSION,
        {"name": run.source.name, "dialect": plan.source.name, "lines": lines or out.lines_in}
        | {"sha256": out.read.hexdigest()},
        {"dialect": plan.target.name, "lines": out.lines_out} | {"sha256": out.written.hexdigest()},
        [described(step) for step in plan.passes],
        _budget(plan, run.findings),
        {"blocks_in": out.blocks_in, "blocks_out": out.blocks_out}
        | {"ratio": out.growth, "limit": plan.growth},
        run.verifier is not None or (plan.copies and run.verify != "off"),
    )
    if run.files:
        made.source["files"] = [each.described() for each in run.files]
    made.measured = run.measured
    made.added = run.added
    made.written_out = [] if run.structure is None else list(run.structure.why)
    made.inventory = dict(run.account.table())
    if run.frame.behind or run.frame.before:
        made.inventory["percent_signs"] = {
            "source": 0,
            "output": run.frame.before + run.frame.behind,
            "rules": {f"{plan.target.name} wants an end": run.frame.before + run.frame.behind},
        }
    _stamps(run, made)
    _fill(run, made)
    return made


def _stamps(run: Run, certificate: Certificate) -> None:
    """Say which stamps there were and are, and what was assumed against them."""
    marks, heads = run.marks, run.heads
    written = [line.decode() for line in heads.lines] if heads and not heads.waits else []
    certificate.stamps = {
        "read": [stamp.content for stamp in marks.read.stamps],
        "edited": marks.read.edited,
        "line": marks.read.line,
        "written": written,
    }
    if marks.against:
        certificate.assumed.append(f"the program may be run once more, though {marks.against}")
    if run.plan.stamp and marks.changes and not marks.written:
        certificate.not_checked.append("whether it is run twice: no stamp could be written")


def _fill(run: Run, certificate: Certificate) -> None:
    if run.verifier is None:
        if run.plan.copies and not run.text.passes:
            certificate.not_checked.append("meaning: every byte was copied")
        elif run.verify == "off":
            certificate.not_checked.append("anything: verification was switched off")
        return
    found = run.findings
    file, line = run.source.place_of(found.source_line)
    certificate.largest = {
        "deviation": found.deviation,
        **({} if file == run.source.name else {"source_file": file}),
        "source_line": line,
        "output_line": found.output_line,
        "angle": found.angle,
    }
    _add_promised(run, certificate.largest)
    certificate.checked = {"moves": found.moves, "events": found.events}
    _not_checked(run, certificate)


def _add_promised(run: Run, largest: dict[str, Any]) -> None:
    """Let `largest` count what passes measure of their promises besides what was compared.

    What is written beside a path that a pass has proved adds to that; otherwise both are measures
    of one thing.
    """
    for number, step in enumerate(run.steps):
        for key, name in step.demands.deviates.items():
            off = run.measured.get(name, 0.0)
            proved = number < resolved(run.steps)
            largest[key] = largest[key] + off if proved else max(largest[key], off)


def _not_checked(run: Run, certificate: Certificate) -> None:
    if run.executes:
        what = "the order in which calls and loops execute blocks: it was found once"
        certificate.not_checked.append(what)
    certificate.not_checked += _of_the_file(run)
    assert run.stages is not None
    found = run.findings
    for count, what in (
        (
            found.rapids,
            "rapids: only their ends, because controls do not move straight in them",
        ),
        (
            found.spared - found.spared_unknown,
            "rapids to points of the machine, and others left uncompensated: the machine is off "
            f"there by up to {found.spared_by:.4f} mm",
        ),
        (
            found.spared_unknown,
            "rapids left uncompensated where the error of the machine is not known",
        ),
        (found.unknown_starts, "moves from an unknown position: only their ends"),
        (
            found.between_taps,
            f"moves between taps: only that they are within {found.aside:.4f} mm",
        ),
        (
            found.contour_only,
            "where the control takes the centre under cutter compensation: only the contour, moves",
        ),
        (found.unset, "zeros that codes leave in the control for what runs next: not set, codes"),
        (found.lines_after_end, "lines after the end of the program: copied, not read"),
    ):
        if count:
            certificate.not_checked.append(f"{what}: {count}")
    certificate.kept_calls = dict(sorted(run.stages.interpreter.state.kept_calls.items()))
    if calls := [f"{name} ({count})" for name, count in certificate.kept_calls.items()]:
        what = "what programs do that are called and not at hand"
        certificate.not_checked.append(f"{what}: {', '.join(calls)}")
    if added := [f"{count} {what}" for what, count in run.added.items() if count]:
        what = "whether the tool is clear in moves that the source does not have"
        certificate.not_checked.append(f"{what}: {', '.join(added)}")
    taken = run.plan.machine.taken if run.plan.machine else ()
    told = getattr(run.structure, "told", ())
    chosen = (*run.assumed, *told, *run.stages.emitter.assumed, *run.books.sentences, *taken)
    certificate.assumed += assumptions(run.stages.interpreter, run.plan.source, chosen)
    certificate.warnings += warnings_of(run.stages.interpreter, run.source)
    certificate.warnings += lathe_doubts(run.given, run.plan.source)


def assumptions(
    interpreter: Interpreter, dialect: type[Dialect], chosen: Iterable[str] = ()
) -> list[str]:
    """Return what a program was taken to mean that it does not say, in sentences.

    `chosen` is what was chosen outside of the interpreter.
    """
    state, reading = interpreter.state, interpreter.reading
    found = [*dict.fromkeys((*chosen, *state.assumed))]
    for group in GROUPS:
        if group not in state.stated and group not in ("motion", "arc-distance"):
            code = dialect.initial[group]
            if group == "units" and reading.units:
                code = {"mm": "G21", "in": "G20"}[reading.units]
            found.append(f"{group} {code}, which the program does not state")
    following = reading.follows_at_start(dialect.tip_rule.follows_at_start)
    if following is not None:
        what = "follows" if following else "does not follow"
        found.append(f"the control {what} the tip before the first block")
    for axis, value in reading.start.items():
        found.append(f"{axis} stands at {value:g} before the first block")
    if reading.feed is not None:
        found.append(f"F{reading.feed:g} is in force before the first block")
    if reading.tool is not None:
        found.append(f"tool {reading.tool} is in the spindle before the first block")
    for name, value in reading.parameters.items():
        found.append(f"#{name} is {value:g} before the first block")
    if reading.told:
        found.append("what the file of the control says that ini of the machine file names")
    return found


def warnings_of(interpreter: Interpreter, source: Source) -> tuple[Diagnostic, ...]:
    """Return what may surprise of what was assumed, with places in the program."""
    found = tuple(each for each in interpreter.state.assumed.values() if each is not None)
    return located(InputError(found), source).diagnostics


def _of_the_file(run: Run) -> Iterator[str]:
    """Yield what was not checked of the file as a whole."""
    if run.executed is not None and run.executed.kept:
        what = (
            "subprograms that nothing calls, and what they call: kept as they stand, behind the end"
        )
        yield f"{what}: {run.executed.kept}"
    if why := run.findings.file.no_end:
        yield f"{WHOLE_FILE}: {why}, and the source has none"


def _budget(plan: Plan, found: Findings) -> dict[str, object]:
    promised, inch = plan.promised(), found.inch
    return {
        "deviation": plan.limit(inch, found.contours > 0, found.arcs),
        "explicit": plan.budget is not None,
        "steps": promised if np.isfinite(promised) else None,
        "angle": max(plan.angle_limits().values()),
        "rounding": plan.rounding(inch),
    }
