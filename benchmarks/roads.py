"""The roads beside the main one: for each a program, a command, and how long it may take.

Time is user + sys against that of `rs274 -g` on the same program, or on its twin for LinuxCNC. The
goal is the same for all but straight code: three times as long, proof included. Only the standard
library is used.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from jobs import GCXFORM, HERE, Job, reading_job
from road_programs import write

GOAL, STRAIGHT_GOAL = 3.0, 1.2
MACHINE = ("-m", str(HERE / "shop-machine.toml"))
LINUXCNC = ("-q", "-f", "linuxcnc", *MACHINE)


@dataclass(frozen=True)
class Road:
    """A program of `road_programs.py`, what gcxform does with it, and its limit.

    ``words`` is the verb with its options; ``most`` the ratio that is reached, with a fifth to
    spare; ``twin`` the program that rs274 reads instead; ``beside`` a second program of the verb.
    """

    name: str
    program: str
    words: tuple[str, ...]
    most: float
    goal: float = GOAL
    twin: str = ""
    beside: str = ""

    @property
    def reading(self) -> str:
        """Return what the job of rs274 is called."""
        return f"{self.name}: `rs274 -g`"

    @property
    def ours(self) -> str:
        """Return what our job is called."""
        return f"{self.name}: gcxform {self.words[0]}"


def run(name: str, program: str, most: float, chain: str = "absolute") -> Road:
    """Return a road of `gcxform run`, with the proof."""
    return Road(name, program, ("run", *LINUXCNC, "-x", chain), most)


def plain(name: str, dialect: str, most: float) -> Road:
    """Return a road of straight code in a language of its own."""
    words = "run", "-q", "-f", dialect, "-x", "absolute"
    return Road(f"{name}, plain", f"{name}-plain", words, most, GOAL, "straight")


ROADS = (
    Road("straight", "straight", ("run", *LINUXCNC, "-x", "absolute"), 2.6, STRAIGHT_GOAL),
    run("nine decimals", "decimals", 2.6),
    run("comments", "comments", 4.5),
    run("expressions", "expressions", 4.0),
    run("assignments", "assignments", 5.0),
    run("loop", "loop", 3.0),
    run("loop written out", "written-out", 5.0),
    run("frames", "frames", 3.5),
    run("returns and tools", "returns", 3.5),
    run("arcs", "circles", 2.6),
    run("drilling", "drilling", 4.5),
    run("drilling, cycles", "drilling", 4.6, "cycles | absolute"),
    run("cutter compensation", "contours", 4.0, "cutter-comp | absolute"),
    run("pass arcs", "chords", 3.8, "arcs tolerance=0.005"),
    Road("compare", "straight", ("compare", "-f", "linuxcnc"), 2.8, beside="nearby"),
    Road("info", "straight", ("info", "-f", "linuxcnc"), 1.6),
    Road("siemens", "siemens", ("run", "-q", "-f", "siemens", "-x", "absolute"), 6.0, GOAL,
         "siemens-twin"),
    plain("siemens", "siemens", 4.0),
    plain("klartext", "heidenhain", 4.2),
    plain("fagor", "fagor", 6.3),
    Road("klartext", "klartext", ("run", "-q", "-f", "heidenhain", "-x", "absolute"), 7.0, GOAL,
         "klartext-twin"),
)  # fmt: skip


def road_jobs(scratch: Path, lines: int) -> list[Job]:
    """Return the jobs on all roads, each of a fifth of the lines: rs274's and ours in turn."""
    lines = max(lines // 5, 100)
    return [job for road in ROADS for job in _jobs(road, scratch, lines)]


def _jobs(road: Road, scratch: Path, lines: int) -> tuple[Job, Job]:
    def program(name: str) -> Path:
        file = scratch / f"{name}.ngc"
        if not file.exists():
            write(name, lines, file)
        return file

    reading = reading_job(program(road.twin or road.program), scratch, lines)
    reading.name = road.reading
    verb, *options = road.words
    files = [str(program(name)) for name in (road.program, road.beside) if name]
    out = scratch / "road-out.ngc" if verb == "run" else None
    writes = ["-o", str(out)] if out else []
    return reading, Job(road.ours, [str(GCXFORM), verb, *options, *writes, *files], out, lines)


def used(find: Callable[[str], Job], road: Road) -> float | None:
    """Return the ratio of a road, None where one of its programs was not measured."""
    ours, reading = (find(name).middle("cpu") for name in (road.ours, road.reading))
    return ours / reading if ours is not None and reading else None
