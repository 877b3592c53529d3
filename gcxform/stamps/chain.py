"""Never twice: which stamp a chain of passes writes, and whether it may run on a stamped program.

A pass that ensures or clears a fact of `AT_READING` turns positions into other positions, so its
runs are stamped. What a stamp says is then what a program is taken for when it is read: a chain
that takes it for something else is refused before anything is written.

Each pair of facts is what the newest stamp says of it, and steps that correct axes must be told of
the axes that it is about. Options that are as by default are not in the digest of a pipeline, nor
is where files are. The output is searched for its stamps: one that is not written, or one that was
not read, fails the run.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, field, fields
from datetime import datetime
from typing import Any

import msgspec
import numpy as np

from gcxform.contract.options import KinematicsFile, ModelFile, to_toml
from gcxform.contract.passes import Pass, PassContext, TextPass
from gcxform.diagnostics import Diagnostic, InputError, Location, Severity, VerificationError
from gcxform.machine.chain import chain_of
from gcxform.machine.machine import Machine
from gcxform.stamps.comment import PAIRS, Stamp, Stamps, named, short
from gcxform.syntax.source import Source
from gcxform.toolpath.facts import AT_READING, AXIS_POSITIONS, Fact
from gcxform.values import dataclass
from gcxform.version import VERSION

Step = Pass | TextPass
WORDS = {
    fact: word
    for choice, pair in zip(AT_READING, PAIRS, strict=True)
    for fact, word in zip(choice, pair, strict=True)
}
"""What stamps call the facts that a program may have when it is read."""
REFUSED, DONE, EDITED = "GX240", "GX241", "GX242"


# --- the stamp of a chain ---


def described(step: Step) -> dict[str, Any]:
    """Return a step's name, options and promise; files by their content."""
    entry: dict[str, Any] = {"use": step.name, **to_toml(step)}
    for key, value in vars(step).items():
        if isinstance(value, ModelFile | KinematicsFile):
            entry[key] = {"file": value.path.name, "sha256": value.sha256}
            if isinstance(value, ModelFile) and value.model.states:
                entry[key] |= {"states": [asdict(state) for state in value.model.states]}
    if isinstance(step, Pass):
        entry["promise"] = step.promise if np.isfinite(step.promise) else None
    return entry


def stamp_of(passes: Sequence[Step], context: PassContext, words: str) -> Stamp | None:
    """Return the stamp that a run of some passes writes; None if it changes no positions."""
    steps = [step for step in passes if isinstance(step, Pass) and _touched(step)]
    if not steps:
        return None
    facts: dict[int, str] = {}
    axes = ""
    for step in steps:
        for number, fact in _left_behind(step):
            facts[number] = WORDS[fact]
            if fact is AXIS_POSITIONS:
                axes = _axes_digest(_machine_after(step, context))
    digest = _digest(passes, context, words)
    said = tuple(facts[number] for number in sorted(facts))
    version, *names = named(VERSION, *(step.name for step in steps))
    return Stamp(digest, said, axes, version, tuple(names))


def _touched(step: Pass) -> list[int]:
    """Return the choices of `AT_READING`, by number, about which a step changes what holds."""
    changed = step.ensures | step.clears
    return [number for number, choice in enumerate(AT_READING) if changed & {*choice}]


def _left_behind(step: Pass) -> list[tuple[int, Fact]]:
    """Return the facts of a program that a step has written: the second if it ensures neither.

    That is how `retarget` does it: no step may take its axes for those of [machine], and they are
    axes all the same.
    """
    return [
        (number, next((f for f in AT_READING[number] if f in step.ensures), AT_READING[number][1]))
        for number in _touched(step)
    ]


def _machine_after(step: Pass, context: PassContext) -> Machine | None:
    """Return the machine that the axes of a step's output are for."""
    own = (value for value in vars(step).values() if isinstance(value, KinematicsFile))
    file = next(own, None)
    return file.machine if file is not None else context.machine


def _axes_digest(machine: Machine | None) -> str:
    """Return six digits for where the rotary axes of a machine are; nothing if it has none."""
    if machine is None or not machine.table + machine.head:
        return ""
    chain = chain_of(machine)
    axes = [
        [(axis.letter, axis.direction, axis.point, axis.sign) for axis in side]
        for side in (chain.table, chain.head)
    ]
    text = repr((axes, tuple(machine.gauge_point)))
    return hashlib.sha256(text.encode()).hexdigest()[:6].upper()


def _digest(passes: Sequence[Step], context: PassContext, words: str) -> str:
    """Return the digest of what decides about an output: steps, machine, dialects, numbers."""
    about = {
        "steps": [_chosen(step) for step in passes],
        "dialects": [context.source.name, context.target.name],
        "numbers": [_numbers(context), words],
        "machine": _content(context.machine),
    }
    text = json.dumps(about, sort_keys=True, default=str)
    return short(hashlib.sha256(text.encode()).hexdigest())


def _chosen(step: Step) -> dict[str, Any]:
    """Return a step's name and the options that are not as they are by default.

    So an option that is new in a later version does not make another pipeline of the same file; and
    a model is what stands in it, wherever it is.
    """
    usual = {f.name for f in fields(step) if f.init and getattr(step, f.name) == f.default}
    raw = {key: value for key, value in to_toml(step).items() if key.replace("-", "_") not in usual}
    for key, value in vars(step).items():
        if isinstance(value, ModelFile | KinematicsFile):
            raw[key] = value.sha256
    return {"use": step.name, **raw}


def _numbers(context: PassContext) -> dict[str, Any]:
    """Return how numbers are written, as far as it is not the manner of the dialect."""
    usual = asdict(context.target.numbers)
    own = {key: value for key, value in asdict(context.numbers).items() if value != usual[key]}
    return own | dict(context.decimals)


def _content(machine: Machine | None) -> dict[str, Any]:
    """Return what a machine file says, without where it is."""
    if machine is None:
        return {}
    plain = msgspec.to_builtins(msgspec.structs.replace(machine, open={}, taken=()), enc_hook=str)
    plain["inert_m"] = sorted(machine.inert_m)
    return {
        key: value
        for key, value in plain.items()
        if value and key not in ("file", "errors", "subprograms")
    }


@dataclass(frozen=True)
class Marks:
    """The stamps of one run: those of its program, and the one that it makes, if it makes any.

    `changes` says whether positions become others, so that what old stamps say of them holds no
    more by itself; `against` is why the chain should not have run, and did all the same.
    """

    read: Stamps = field(default_factory=Stamps)
    new: Stamp | None = None
    changes: bool = False
    against: str = ""

    @property
    def written(self) -> tuple[Stamp, ...]:
        """The stamps of the output, the newest first; none where a new one is not wanted."""
        if self.new is not None:
            return (self.new, *self.read.stamps)
        return () if self.changes else self.read.stamps

    @property
    def seal(self) -> str | None:
        """The seal that is carried on because it does not fit; None: one that fits is made."""
        if self.new is None and self.changes:
            return ""
        return None if self.new or self.read.fits else "".join(self.read.seals[:1])


def check_stamps(found: Stamps, marks: Marks) -> None:
    """Raise VerificationError if an output, read again, has not the stamps that it should have.

    A stamp in a block with words stays where it is, besides the one at the head.
    """
    first = len(marks.written)
    texts = [stamp.content for stamp in found.stamps]
    right = texts[:first] == [stamp.content for stamp in marks.written]
    right &= {*texts[first:]} <= {stamp.content for stamp in marks.read.stamps}
    right &= found.fits == bool(marks.written) or marks.seal is not None
    if not right:
        message = "the output, read again, does not have the stamps that it should have"
        hint = "nothing was written; this is a bug of gcxform"
        raise VerificationError.one("GX609", message, hint=hint)


# --- stamped programs ---


def against(
    stamps: Stamps, passes: Sequence[Pass], context: PassContext, ours: Stamp | None
) -> tuple[str, str] | None:
    """Return the code and the reason for which a chain must not run on a program; None if it may.

    `ours` is the stamp that the chain would write. A chain that was the last to run is done, also
    where nothing speaks against it: axes corrected for the very same axes, for instance.
    """
    if not stamps:
        return None
    done = [stamp for stamp in stamps.stamps if ours is not None and stamp.digest == ours.digest]
    why = _conflict(stamps, passes, context)
    if done and stamps.fits and (why or done[0] is stamps.stamps[0]):
        return DONE, why or str(done[0])
    return None if why is None else (REFUSED, why)


def _conflict(stamps: Stamps, passes: Sequence[Pass], context: PassContext) -> str | None:
    """Return why a program is not what a chain takes it for."""
    for choice, pair in zip(AT_READING, PAIRS, strict=True):
        asked = next(((s, f) for s in passes for f in choice if f in s.requires), None)
        if asked is None:
            continue
        step, fact = asked
        if not stamps.readable:
            what = "a stamp that cannot be read" if stamps.stamps else "a seal without its stamp"
            return f"{step.name} requires {fact.name}, and the program has {what}"
        stated = stamps.stating(pair)
        if stated is not None and stated[1] != WORDS[fact]:
            is_now = next(f.name for f, word in WORDS.items() if word == stated[1])
            return f"{step.name} requires {fact.name}, and the program is {is_now}: {stated[0]}"
        if stated is not None and fact is AXIS_POSITIONS and _other_axes(stated[0], step, context):
            machine = "the axes of another machine than that of [machine]"
            return f"{step.name} takes the positions for those of {machine}: {stated[0]}"
    return None


def _other_axes(stamp: Stamp, step: Pass, context: PassContext) -> bool:
    """Whether a step that corrects axes is told of other ones than a stamp has.

    Where the tip goes with them on another machine may well be asked (`to-tip`).
    """
    here = _axes_digest(context.machine)
    corrects = any(fact is AXIS_POSITIONS for _, fact in _left_behind(step))
    return corrects and bool(here) and bool(stamp.axes) and here != stamp.axes


def refusal(stamps: Stamps, source: Source, found: tuple[str, str]) -> InputError:
    """Return the error for a program that a chain must not run on."""
    code, why = found
    written = _written(source)
    said = ["done already by this very pipeline"] if code == DONE else []
    said += [why, *([f"the file is of {written}"] if written else [])]
    said += [stamps.edited] if stamps.edited else []
    hint = "nothing is left to be done" if code == DONE else "take the program as it was posted"
    hint += f"; where the comment is wrong, `gcxform explain {code}` says how to go on"
    return InputError.one(code, "; ".join(said), Location(source.name, stamps.line), hint)


def edited(why: str, file: str, line: int) -> Iterator[Diagnostic]:
    """Yield the warning about a program that does not fit its stamp, if there is a reason to."""
    if why:
        message = f"the program is stamped, and {why}"
        hint = "what its stamp says may hold no longer; take the program as it was written"
        yield Diagnostic(EDITED, message, Location(file, line), hint, severity=Severity.WARNING)


def _written(source: Source) -> str:
    """Return when the file of a program was written, in the local time; nothing if it is none."""
    if source.written is None:
        return ""
    try:
        return datetime.fromtimestamp(source.written).strftime("%Y-%m-%d %H:%M")
    except (OSError, ValueError, OverflowError):
        return ""


def told(stamps: Stamps) -> list[str]:
    """Return what is said of a stamped program, a line for each stamp and one for the seal."""
    if not stamps:
        return []
    lines = [f"{stamp}: {' '.join(stamp.facts or ('not readable',))}" for stamp in stamps.stamps]
    return [*lines, stamps.edited or "not edited since"]
