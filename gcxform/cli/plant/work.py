"""One task, wherever it is done: a program is run, and its result published once.

    OUT/.gcxform/staged/KEY.n    the result, proved and whole
    OUT/.gcxform/receipts/KEY    a receipt, the row: the result is whole, where it is and goes
    OUT/BELOW                    the result: it is moved here, by which it is published

Whoever is killed leaves one of these states behind. Who comes next finishes what has a receipt, and
does again what has none: nobody has seen a result of it. So a task is done once, whoever does it
and however often they die.
"""

from __future__ import annotations

import json
import os
import threading
from contextlib import ExitStack, suppress
from dataclasses import replace
from functools import lru_cache
from typing import Any, Final
from uuid import uuid4

from gcxform.cli.common.failures import reported
from gcxform.cli.common.request import Asked
from gcxform.cli.common.several import Outcome, attempt
from gcxform.cli.common.transform import Job
from gcxform.cli.plant.rests import Present, Rests, digest
from gcxform.cli.plant.rows import Row
from gcxform.cli.plant.stores import Store, at_hand, store_of
from gcxform.cli.plant.tasks import Task
from gcxform.diagnostics import Diagnostic, FileError
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import versions
from gcxform.system.inputs import visit
from gcxform.system.limits import Limits, in_force, said
from gcxform.values import dataclass

HIDDEN: Final = ".gcxform"
STAGED, RECEIPTS = f"{HIDDEN}/staged", f"{HIDDEN}/receipts"
REFUSED: Final = (2, 3, 4)
"""Exit codes for which there is a reason in files: the same again while those are the same."""
_ONE_AT_A_TIME: Final = threading.Lock()
"""A scheduler may have several threads in a process; a run has stdout for itself."""


def done(task: Task) -> Row:
    """Do a task and return what became of it; nothing is raised, and nothing done twice."""
    with _ONE_AT_A_TIME:
        try:
            store = store_of(task.root)
            return finished(store, task.key) or _published(store, task)
        except Exception as error:
            return _refused(task, error, Rests())


def finished(store: Store, key: str) -> Row | None:
    """Publish the result that a receipt is of; None if there is none, or nothing is left of it.

    Raises OSError and GcxformError.
    """
    try:
        staged, _, text = store.read(f"{RECEIPTS}/{key}").partition(b"\n")
        row = Row.from_json(text)
    except (FileNotFoundError, ValueError):
        return None
    with suppress(FileNotFoundError):
        store.move(f"{STAGED}/{staged.decode()}", row.output)
    with suppress(FileNotFoundError):
        if digest(store.read(row.output)) == row.output_sha256:
            return row
    store.drop(f"{RECEIPTS}/{key}")
    return None


def _published(store: Store, task: Task) -> Row:
    """Run a program and publish its result; what is refused has none.

    Raises OSError and GcxformError.
    """
    staged = f"{task.key}.{uuid4().hex[:8]}"
    with store.staging(f"{STAGED}/{staged}") as place:
        row = _attempted(task, place)
    if not row.through:
        return row
    store.write(f"{RECEIPTS}/{task.key}", f"{staged}\n{row.to_json()}".encode())
    found = finished(store, task.key)
    if found is None:
        raise FileError.one("GX903", f"the result {row.output} is not what was written there")
    return found


def _attempted(task: Task, place: str) -> Row:
    """Run a program into a file; return its row."""
    with ExitStack() as stack:
        file, called = stack.enter_context(at_hand(task.program))
        stack.enter_context(in_force(task.limits))
        seen = stack.enter_context(visit(True, task.anywhere))
        rests = Rests()
        try:
            pipeline, rests = _built(task.asked, task.anywhere)
            rests |= Rests({task.program: Present().digest(file)})
            job = Job(file, place, verify=task.verify, quiet=True, name=task.program)
            outcome = attempt(lambda _: pipeline, job)
        except Exception as error:
            return _refused(task, error, rests | Rests.of(seen, called))
        return _row(task, outcome, rests | Rests.of(seen, called))


# --- pipelines ---


@dataclass(frozen=True)
class _Built:
    pipeline: Pipeline
    rests: Rests
    looks: tuple[tuple[str, int, int], ...]


def _built(asked: Asked, anywhere: bool) -> tuple[Pipeline, Rests]:
    """Return a pipeline, and what it rests on; built anew if a file of it has changed.

    Raises UsageError.
    """
    found = _known(asked, anywhere, said())
    if found.looks != _looks(found.rests):
        _known.cache_clear()
        found = _known(asked, anywhere, said())
    return found.pipeline, found.rests


@lru_cache(maxsize=64)
def _known(asked: Asked, anywhere: bool, limits: Limits | None) -> _Built:
    with visit(True, anywhere) as seen:
        pipeline = asked.build()
    rests = Rests.of(seen)
    return _Built(pipeline, rests, _looks(rests))


def _looks(rests: Rests) -> tuple[tuple[str, int, int], ...]:
    """Return what tells cheaply that a file has changed."""
    looks = []
    for name in rests.files:
        try:
            found = os.stat(name)
        except OSError:
            return ()
        looks.append((name, found.st_mtime_ns, found.st_size))
    return tuple(looks)


# --- rows ---


def _about(task: Task, rests: Rests) -> dict[str, Any]:
    files = rests.files
    return {
        "program": task.program,
        "pipeline": task.pipeline,
        "machine": task.machine,
        "source_sha256": files.get(task.program, ""),
        "pipeline_sha256": files.get(task.pipeline, ""),
        "machine_sha256": files.get(task.machine, ""),
        "version": versions(),
        "options": task.options,
        "rests": json.dumps(rests.described()),
    }


def _row(task: Task, outcome: Outcome, rests: Rests) -> Row:
    """Return the row of a program that came through."""
    assert outcome.done is not None
    found, largest = outcome.done.certificate, outcome.done.certificate.largest
    return Row(
        **_about(task, rests),
        state=outcome.state,
        output=task.below,
        output_sha256=found.output["sha256"],
        deviation=largest.get("deviation"),
        budget=found.budget["deviation"],
        source_line=largest.get("source_line"),
        output_line=largest.get("output_line"),
        blocks_in=found.growth["blocks_in"],
        blocks_out=found.growth["blocks_out"],
        verified=found.verified,
        seconds=round(outcome.done.seconds, 4),
        certificate=json.dumps(found.described()),
    )


def _refused(task: Task, error: Exception, rests: Rests) -> Row:
    """Return the row of a program that did not."""
    text, code, findings = reported(error)
    first: Diagnostic | None = next(iter(findings), None)
    return Row(
        **_about(task, rests),
        state="refused" if code in REFUSED else "failed",
        exit_code=code,
        codes=" ".join(dict.fromkeys(each.code for each in findings)),
        place="" if first is None else str(first.where or ""),
        reason=text.partition("\n")[0] if first is None else first.message,
    )


def died(task: Task, why: str) -> Row:
    """Return the row of a program whose process ended, each time that it was tried."""
    row = Row(**_about(task, Rests()), state="failed", exit_code=5)
    return replace(row, codes="GX903", reason=why)
