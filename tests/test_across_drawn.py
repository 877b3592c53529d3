"""Drawn programs of one control mean on another what they mean on theirs, by readers of their own.

Where one side is LinuxCNC its interpreter says what that is. What is refused is no business here,
but that it is no fault of ours (GX601, GX604), and that not everything is.
"""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
import seeds_kit
from oracles import rs274
from reference import shop
from shop_kit import Drawn, by_linuxcnc

import gcxform as gx
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry

DIALECTS = default_registry().dialects
AXES = "XYZ"
READING = Reading(
    dict.fromkeys(AXES, 0.0),
    tools={n: Tool(length=length, radius=3.0) for n, length in shop.LENGTHS.items() if n},
    work_offsets={f"G{53 + n}": dict(zip(AXES, at, strict=True)) for n, at in shop.OFFSETS.items()},
    homes={"G28": dict(zip(AXES, shop.HOME, strict=True))},
    control={"peck-return": shop.BREAK, "peck-clearance": shop.CLEAR},
    inert_m=frozenset({6}),
)
OF_CONTROL = {
    "haas": {"cycle-without-place": "drills", "g52": "fanuc"},
    "mach3": {"arc-centres": "incremental"},
}
SOURCES = ("linuxcnc", "fanuc", "haas", "grbl", "mach3", "siemens", "fagor", "tinyg", "g2core")
TARGETS = ("linuxcnc", "fanuc", "haas", "grbl", "siemens", "fagor", "tinyg", "g2core")
CHANGED = ("fanuc", "haas", "siemens", "fagor")
"""Controls whose tool changes may move axes: here they do not."""


def reading_of(source: str) -> Reading:
    control = {} if source not in ("fanuc", "haas") else dict(READING.control)
    return replace(READING, control={**control, **OF_CONTROL.get(source, {})})


def done(control: str, text: str) -> list[shop.Move | str]:
    return by_linuxcnc(text) if control == "linuxcnc" else shop.read(control, text)


def translated(seed: int, source: str, target: str) -> tuple[str, str] | None:
    """Return a drawn program and what it becomes; None where it is refused."""
    text = Drawn(seed, source).text()
    inert = frozenset({"M6"}) if target in CHANGED else frozenset()
    dialects = DIALECTS[source], DIALECTS[target]
    try:
        found = gx.Pipeline(*dialects, (), reading_of(source), inert=inert).run(text.encode())
    except gx.VerificationError:
        raise
    except gx.GcxformError:
        return None
    return text, found.text.decode()


def in_part(reading: Reading, draw: random.Random) -> Reading:
    """Return a reading of which something is not known, as a newcomer's."""
    left_out = {
        "start": {},
        "tools": {},
        "work_offsets": {},
        "homes": {},
        "inert_m": frozenset[int](),
    }
    return replace(reading, **{k: v for k, v in left_out.items() if draw.random() < 0.5})


@pytest.mark.parametrize("source", SOURCES)
def test_what_nobody_has_said_is_no_fault_of_ours(source: str) -> None:
    """It is refused by name, or what is written does not hang on it: never GX601, never a crash.

    A program goes to every other control, the next one to those between; over night to all.
    """
    targets = [target for target in (*TARGETS, "heidenhain") if target != source]
    proved = 0
    for seed in seeds_kit.some(40):
        draw = random.Random(seed)
        text, reading = Drawn(seed, source).text(), in_part(reading_of(source), draw)
        for target in targets if seeds_kit.LONG else targets[seed % 2 :: 2]:
            inert = frozenset({"M6"} if target in CHANGED and draw.random() < 0.5 else ())
            run = gx.Pipeline(DIALECTS[source], DIALECTS[target], (), reading, inert=inert).run
            try:
                run(text.encode())
            except gx.InputError:
                continue
            proved += 1
    assert proved > len(TARGETS)


@pytest.mark.parametrize("source", SOURCES)
def test_a_drawn_program_means_the_same_there(source):
    compared = 0
    pairs = [target for target in TARGETS if target != source]
    for seed in seeds_kit.some(6):
        for target in pairs:
            if "linuxcnc" in (source, target) and not rs274.available():
                continue
            if (pair := translated(seed, source, target)) is None:
                continue
            found = shop.differs(done(source, pair[0]), done(target, pair[1]))
            assert found is None, f"{target}: {found}\n{pair[0]}\n{pair[1]}"
            compared += 1
    assert compared >= len(pairs) // 2 or not rs274.available(), "nearly all was refused"


DIRECTIONS = [("linuxcnc", "siemens"), ("siemens", "linuxcnc")]
DIRECTIONS += [("linuxcnc", "fagor"), ("fagor", "linuxcnc")]
"""Those of Klartext are in `test_klartext_spelled.py`."""
FLOOR = (0.1, 2.54)
"""What LinuxCNC makes of slower feeds in G93, in mm and in inches: no other control does."""


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
@pytest.mark.parametrize(("source", "target"), DIRECTIONS)
@seeds_kit.shares(10_000 if seeds_kit.LONG else 20, 50)
def test_languages_say_what_words_say_and_words_what_they_say(
    source: str, target: str, seeds: range
) -> None:
    compared = 0
    for seed in seeds:
        if (pair := translated(seed, source, target)) is None:
            continue
        there, here = done(source, pair[0]), done(target, pair[1])
        moves = [move for move in (*there, *here) if isinstance(move, shop.Move)]
        if any(m.feed and m.feed[0] == 93 and round(m.feed[1], 9) in FLOOR for m in moves):
            continue
        found = shop.differs(there, here)
        assert found is None, f"{found}\n{pair[0]}\n{pair[1]}"
        compared += 1
    assert compared, "all was refused"
