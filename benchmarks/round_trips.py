"""Write every real program without macros in another language and back, and compare all three.

    python benchmarks/round_trips.py [CORPUS] [--to NAME] [--from NAME] [--list] [--keep FOLDER]
                                     [--bare]

The programs are those of `corpus.py`, with the machines that it gives them and what their users
know besides (`round_trips.toml`). What counts is a program without macros that goes through
`absolute` in its own dialect, and is no file of a subprogram. *Round* is one that is proved on both
ways, and whose three programs `compare` the same within what rounding does; codes that both
certificates list as said otherwise are not compared, nor places that the control of the source
alone knows, as behind the G49 that ends a tip, and the programs made of it say. Taps of which a
user knows that they are in step with the spindle are compared by pitch, whichever code says them.
Both ways take what hints offer: a pass, a code to be left out, and that a tool change moves no axis
(`--bare` takes nothing).
"""

from __future__ import annotations

import argparse
import itertools
import re
import sys
import tomllib
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from msgspec import structs
from translation import WAYS, offered, taken
from translation import said as step_name

import gcxform as gx
from corpus import BESIDE, HERE, NUMBERS, Job, Outcome, counted, filled_in
from corpus import run as run_in_own
from gcxform.contract.inert_codes import with_inert
from gcxform.modal.state import Reading
from gcxform.pipeline.chain_text import parse_chain
from gcxform.pipeline.pipeline import Pipeline, Result
from gcxform.pipeline.translated_moves import CHORD_ERROR
from gcxform.pipeline.translated_moves import SAID as SPLINES
from gcxform.plugin.registry import default_registry
from gcxform.toolpath.path import Event, FeedMode, Form, Toolpath

TARGETS = ("heidenhain", "siemens", "fagor")
SOURCES = ("linuxcnc", "fanuc")
MACRO = re.compile(rb"#|\bO\s*<|\bO[ \t]*[0-9]+[ \t]*[A-Z]|\[|M98|G65", re.IGNORECASE)
COMMENT = re.compile(rb"\([^)]*\)|;.*")
ENDS = {"M2", "M30", "G80", "G98", "G99", "G43", "G49", "G54", "G28", "BY", "G53"}
"""What a language need not say: the end of a file, cycles that are moves, lengths with tools; and
returns, which are moves to the same places in other words."""
CONTROL = {
    "siemens": {"tool-length-axis": "Z"},
    "fagor": {"tool-length-axis": "Z", "inch-feeds": "inches"},
    "fanuc": {"tool-length-alone": "shifts"},
}
"""What a user knows of each control: on a mill lengths stay along Z (SD42940), and none of them
moves an axis by itself; F is in the unit of the program."""
KNOWN = HERE / "round_trips.toml"
LONGEST = 200_000  # bytes
SAID = re.compile(r"(\S+)(?: [A-Z]+)? is (?:left out|a comment|said as (\S+))")
CENTRED = "cutter-comp"
OUTPUT = ("drop", "inert")
"""What a user gives of the output where a hint offers it."""
ONCE_KNOWN = "only B says"
TAPS_SAID = "taps in step"
"""What is told where certificates say that G84 is one."""
TOLERANCE = 0.002  # mm: twice what a program is rounded by


def plain(job: Job) -> bool:
    """Whether a program has no macros, and is not too long to be compared."""
    bare = b"\n".join(COMMENT.sub(b"", line) for line in job.text.splitlines())
    return job.chain == "absolute" and len(bare) < LONGEST and not MACRO.search(bare)


def round_trip(job: Job, target: str, keep: Path | None = None, bare: bool = False) -> Outcome:
    """Write a program in a language and back; `bare`: without what hints offer."""
    try:
        return _round_trip(job, target, keep, 0 if bare else WAYS)
    except gx.GcxformError as error:
        first = error.diagnostics[0]
        return Outcome(job, first.code, first.message, first.where.line if first.where else 0)
    except Exception as error:
        return Outcome(job, "CRASH", repr(error))


def _round_trip(job: Job, target: str, keep: Path | None, ways: int) -> Outcome:
    registry = default_registry()
    known = {**CONTROL.get(job.dialect, {}), **CONTROL.get(target, {})}
    known |= {key: said for user in users(job) for key, said in user.get("control", {}).items()}
    made, chain = _made(job, known), parse_chain("absolute", HERE, registry)
    there = registry.dialect(target)
    reading = made.machine_reading
    bare = _bare(reading, known)
    way = replace(made, target=there, passes=(), numbers=NUMBERS, inert=_back(job))
    way, said = by_hints(way, job.corpus / job.path, ways)
    here, there = (
        with_inert(kind, way.inert & {f"M{number}" for number in kind.m_codes})
        for kind in (made.source, there)
    )
    if keep is not None:
        (keep / job.path.replace("/", "__")).write_bytes(said.text)
    anew = replace(made, source=there, target=here, passes=tuple(chain), numbers=NUMBERS)
    anew = replace(anew, inert=_back(job))
    _, back = by_hints(replace(anew, reading=bare), said.text, ways)
    first = _beside(way, job.text, made)
    texts = (first, here, reading), (said.text, there, bare), (back.text, here, bare)
    programs = [gx.Program(text, kind, replace(of, curves=True)) for text, kind, of in texts]
    lines = SPLINES in (*said.certificate.assumed, *back.certificate.assumed)
    near = TOLERANCE + CHORD_ERROR * lines
    for one, other in itertools.pairwise(programs):
        if why := apart(one, other, told(said, back), near):
            return Outcome(job, "DIFFERS", f"{one.dialect.name} to {other.dialect.name}: {why}")
    return Outcome(job)


def _beside(way: Pipeline, text: bytes, made: Pipeline) -> bytes:
    """Return a program, with the path of the centre where the one there has no contour any more."""
    centred = any(step.name == CENTRED for step in way.passes)
    return replace(made, passes=way.passes, numbers=NUMBERS).run(text).text if centred else text


def by_hints(made: Pipeline, program: Path | bytes, ways: int) -> tuple[Pipeline, Result]:
    """Run a pipeline, up to so many times with what its hints offer. Raises GcxformError.

    A pass that is offered once more is put before those that have been put before it.
    """
    added = list[str]()
    while True:
        try:
            return made, made.run(program)
        except gx.GcxformError as error:
            step = offered(error.diagnostics[0].hint, [*added[-1:]], OUTPUT)
            if step is None or len(added) == ways:
                raise
            rest = [each for each in made.passes if each.name != step_name(step).split(" ")[0]]
            made = taken(replace(made, passes=tuple(rest)), step)
            added.append(step_name(step))


def _made(job: Job, known: Mapping[str, str | float]) -> Pipeline:
    """Return the pipeline of a program, with what is known of the control that it is said to."""
    made = filled_in(job.dialect, job.path, "absolute", job.corpus)
    for user in users(job):
        made = _told(made, user)
    if made.machine is None:
        return replace(made, reading=replace(made.reading, control=known))
    control = {**made.machine.control, **known}
    return replace(made, machine=structs.replace(made.machine, control=control))


def users(job: Job) -> list[dict[str, Any]]:
    """Return what users know of a program, and were never asked for."""
    said: list[dict[str, Any]] = tomllib.loads(KNOWN.read_text("utf-8"))["user"]
    return [each for each in said if re.search(each["programs"], job.path)]


def _back(job: Job) -> frozenset[str]:
    """Return the M codes behind which axes stand where they stood, here as there."""
    return frozenset(f"M{code}" for user in users(job) for code in user.get("inert-m", ()))


def _told(made: Pipeline, user: Mapping[str, Any]) -> Pipeline:
    """Return a pipeline with what a user knows."""
    reading, machine = made.reading, made.machine
    reading = replace(
        reading,
        units=user.get("units", reading.units),
        tool=user.get("tool", reading.tool),
        start={**reading.start, **user.get("start", {})},
    )
    if machine is not None:
        inert = machine.inert_m | set(user.get("inert-m", ()))
        machine = structs.replace(machine, inert_m=inert)
    return replace(made, reading=reading, machine=machine, taps=user.get("taps", made.taps))


def _bare(reading: Reading, control: Mapping[str, str | float]) -> Reading:
    """Return what is known of the machine, without what holds for the language of the source."""
    return Reading(
        reading.start,
        tool=reading.tool,
        tools=reading.tools,
        work_offsets=reading.work_offsets,
        homes=reading.homes,
        crosses=reading.crosses,
        block_delete=reading.block_delete,
        control=control,
    )


def told(*results: Result) -> set[str]:
    """Return the names of codes that certificates list as said otherwise."""
    said = (SAID.match(line) for result in results for line in result.certificate.assumed)
    names = {name for found in said if found for name in found.groups() if name}
    taps = any("tap in step" in line for result in results for line in result.certificate.assumed)
    return names | ({TAPS_SAID} if taps else set())


def apart(one: gx.Program, other: gx.Program, but: set[str], near: float) -> str:
    """Return how two programs differ; nothing where they are the same but for some codes."""
    for program in (one, other):
        vars(program)["path"] = _without(program.path, but)
    found = gx.compare(one, other, near)
    places = tuple(each for each in found.places if not each.what.startswith(ONCE_KNOWN))
    found = replace(found, places=places)
    if found.same:
        return ""
    first = [each.what for each in (*found.feeds, *found.events, *found.places)][:1]
    return f"{found.deviation:.4g} mm, {found.angle:.4g} degrees, {found.parted or first}"


def _without(path: Toolpath, but: set[str]) -> Toolpath:
    """Return a path without events that are said otherwise; taps by feed are those by pitch."""
    path = _by_pitch(path) if TAPS_SAID in but else path
    again = _again(path)
    events = [
        e
        for e in path.events
        if e not in again and e.what.split(" ")[0].lstrip("/") not in but | ENDS
    ]
    sides = ("G41", "G42")  # with the tool in the spindle where no D is said: radii are compared
    events = [replace(e, values=()) if e.what in sides else e for e in events]
    if "(...)" in but:
        events = [e for e in events if not e.what.startswith("(")]
    return replace(path, events=tuple(events))


def _by_pitch(path: Toolpath) -> Toolpath:
    """Return a path whose taps in step are fed per turn, F by S, and hold nothing but moves."""
    tied, feed = path.form == Form.SYNCHRONISED, path.feed.copy()
    speeds = [(event.row, event.values[0][1]) for event in path.events if event.what == "S"]
    for row in np.flatnonzero(tied & (path.feed_mode == FeedMode.PER_MINUTE)).tolist():
        feed[row] /= [value for at, value in speeds if at <= row][-1]
    around = (path.form == Form.CYCLE) & np.isin(path.block, path.block[tied])
    lines = {*path.source[tied].tolist()}
    held, events = 0.0, list[Event]()
    for event in path.events:
        same = event.what == "S" and event.values[0][1] == held
        held = event.values[0][1] if event.what == "S" else held
        inner = event.within and event.line in lines
        events += [event] * (not (inner or same or event.what == "M29"))
    return path.replace(
        feed=feed,
        feed_mode=np.where(tied, FeedMode.PER_TURN, path.feed_mode).astype(path.feed_mode.dtype),
        form=np.where(around, Form.PLAIN, path.form).astype(path.form.dtype),
        events=tuple(events),
    )


def _again(path: Toolpath) -> list[Event]:
    """Return the T words that choose a tool once more which is chosen: a Fagor says it with M6."""
    chosen, found = "", list[Event]()
    for event in path.events:
        if event.what[0] == "T":
            found += [event] * (event.what == chosen)
            chosen = event.what
        elif event.what == "M6":
            chosen = ""
    return found


def counts(job: Job) -> bool:
    """Whether a program is one of those that are asked for."""
    return plain(job) and run_in_own(job).code in ("", "LOST")


def main() -> int:
    """Print the table; return 1 for what crashed, or differs and should not."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpus", nargs="?", type=Path, default=BESIDE)
    parser.add_argument("--to", choices=TARGETS, default=TARGETS[0])
    parser.add_argument("--from", dest="source", choices=SOURCES, action="append")
    parser.add_argument("--list", action="store_true", help="one line per program")
    parser.add_argument("--bare", action="store_true", help="take nothing that hints offer")
    parser.add_argument("--keep", type=Path, help="write what is in the language into a folder")
    options = parser.parse_args()
    with ProcessPoolExecutor(2) as pool:
        jobs = [*counted(options.corpus, options.source or SOURCES)]
        jobs = [job for job, good in zip(jobs, pool.map(counts, jobs), strict=True) if good]
        to = [options.to] * len(jobs)
        how = [options.keep] * len(jobs), [options.bare] * len(jobs)
        found = [*pool.map(round_trip, jobs, to, *how)]
    found = [one for one in found if one.code != "GX226"]
    for one in found:
        if options.list:
            print(f"{one.job.path}: {one.code} {one.line} {one.says}".rstrip(" 0:"))
    for cause, count in Counter(f"{one.code} {one.says[:90]}" for one in found).most_common():
        print(f"| {count} | {cause.strip() or 'round'} |")
    print(f"{sum(not one.code for one in found)} of {len(found)} there and back")
    return 1 if {"CRASH", "DIFFERS"} & {one.code for one in found} else 0


if __name__ == "__main__":
    sys.exit(main())
