"""The kit: every registered pass keeps its contract, and broken ones are caught."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import gcxform as gx
from gcxform.contract.options import ModelFile
from gcxform.machine.file import load_machine
from gcxform.plugin.registry import default_registry
from gcxform.testing import check_pass
from gcxform.testing.paths import paths

MODEL = Path(__file__).parents[1] / "examples" / "lddm" / "model.toml"
HERE = (0.0, 0.0, 0.0)
TURNING_PASSES = {"rtcp", "to-tip", "repost", "retarget"}
TURNING = """\
format = 1
kinematics = "ac-trunnion"
[axis.X]
[axis.Y]
[axis.Z]
[axis.A]
point = [0.0, 3.0, -60.0]
[axis.C]
point = [7.0, 3.0, 0.0]
[work-offset.G54]
X = 4.0
"""


PARTS = {"volumetric": 4}  # of the instances; the others have one


@cache
def passes() -> Mapping[str, type]:
    return default_registry().passes


def instances(name: str) -> list[gx.Pass | gx.TextPass]:
    """Return instances of a pass that between them use all of its ways."""
    made = passes()[name]
    if name == "segment":
        return [
            made(chord_error=0.002),
            made(chord_error=50.0, max_length=7.0),
            made(arcs="split", arc_step=10.0),
            made(arc_step=30.0),
        ]
    if name == "volumetric":
        model = ModelFile.load(MODEL)
        return [
            made(model=model, part_origin=HERE),
            made(model=model, part_origin=HERE, tolerance=0.001),
            made(model=model, part_origin=(10.0, 5.0, 1.0), table_origin=HERE, split="nodes"),
            made(model=model, part_origin=HERE, split="none", iterations=1),
            made(model=model, part_origin=(-100.0, 0.0, 0.0), outside=gx.Outside.CLAMP),
            made(model=model, part_origin=HERE, inverse=True),
            made(model=model, part_origin=HERE, tolerance=0.003, inverse=True),
            made(model=model, part_origin=HERE, outside=gx.Outside.CLAMP, inverse=True),
        ]
    if name == "arcs":
        return [
            made(tolerance=0.12),
            made(tolerance=0.4, min_lines=2, max_sweep=100.0),
            made(tolerance=0.0001),
        ]
    if name == "feed":
        return [made(mode="inverse-time"), made(mode="per-minute")]
    if name == "strip":
        return [made(), made(blanks=False), made(comments=False, empty=False)]
    return [made()]


def in_parts(names):
    """Yield passes with a part of their instances each: two cores share those of a dear one."""
    for name in sorted(names):
        count = PARTS.get(name, 1)
        for nth in range(count):
            own_id = name if count == 1 else f"{name}-{nth}"
            yield pytest.param(name, slice(nth, None, count), id=own_id)


@pytest.mark.by_turns
@pytest.mark.parametrize(("name", "part"), [*in_parts({*passes()} - TURNING_PASSES)])
def test_registered_passes(name, part):
    check_pass(passes()[name], *instances(name)[part])


@pytest.mark.parametrize("name", ["rtcp", "to-tip"])
def test_passes_that_need_a_machine(tmp_path, name):
    """The law on the path that tilts, there and back; test_rtcp.py has all kinds of machines."""
    file = tmp_path / "machine.toml"
    file.write_text(TURNING)
    machine = load_machine(file, default_registry().machines)
    made = passes()[name]
    steps = [made(tolerance=t, rapids="ends") for t in (0.3, 0.01)]
    check_pass(made, *steps, machine=machine)


def test_volumetric_without_rapids():
    made = passes()["volumetric"]
    check_pass(made, made(model=ModelFile.load(MODEL), part_origin=HERE, rapids="skip"))
    check_pass(
        made, made(model=ModelFile.load(MODEL), part_origin=HERE, rapids="skip", inverse=True)
    )


def test_the_paths_cover_what_there_is():
    every = [path for _, path in paths()]
    assert {0, 1} <= {len(path) for path in every}
    arcs = {(int(p), int(k)) for path in every for p, k in zip(path.plane, path.kind, strict=True)}
    assert {(plane, kind) for plane in gx.Plane for kind in gx.Kind if kind >= 2} <= arcs
    assert any(np.isnan(path.end).any() for path in every)
    assert any(path.blocks.inch.any() for path in every)
    assert any(path.blocks.incremental.any() for path in every)
    assert any((path.feed_mode == gx.FeedMode.INVERSE_TIME).any() for path in every)


# --- broken passes ---


@dataclass(frozen=True)
class Shift(gx.Pass):
    """Move every point by a constant vector."""

    name = "shift"
    by: gx.Vector = (1.0, 2.0, 3.0)

    def apply(self, path, context):
        return self._moved(path, 1.0)

    def undo(self, path, context):
        return self._moved(path, -1.0)

    def _moved(self, path, sign):
        end, entry = path.end.copy(), path.entry.copy()
        end[:, :3] += sign * np.array(self.by)
        entry[:3] += sign * np.array(self.by)
        return path.replace(end=end, entry=entry, centre=path.centre + sign * np.array(self.by))


@dataclass(frozen=True)
class WrongUndo(Shift):
    """Undo half of it."""

    def undo(self, path, context):
        return self._moved(path, -0.5)


@dataclass(frozen=True)
class NoUndo(Shift):
    """Undo nothing."""

    def undo(self, path, context):
        return path


@dataclass(frozen=True)
class WrongCentre(Shift):
    """Leave the centres of arcs where they are."""

    def apply(self, path, context):
        return super().apply(path, context).replace(centre=path.centre)

    def undo(self, path, context):
        return super().undo(path, context).replace(centre=path.centre)


@dataclass(frozen=True)
class ForgetsEntry(Shift):
    """Leave the entry of a window where it is."""

    def _moved(self, path, sign):
        return super()._moved(path, sign).replace(entry=path.entry)


@dataclass(frozen=True)
class Mutates(Shift):
    """Write into the path it is given."""

    def apply(self, path, context):
        path.end[:, :3] += 1.0
        return path


@dataclass(frozen=True)
class MutatesByForce(Shift):
    """Write into the path it is given, read-only or not."""

    def apply(self, path, context):
        path.end.flags.writeable = True
        path.end[:, :3] += 1.0
        path.end.flags.writeable = False
        return path


@dataclass(frozen=True)
class LosesSource(Shift):
    """Forget which line a row came from."""

    def apply(self, path, context):
        return super().apply(path, context).replace(source=np.zeros(len(path), np.int64))


@dataclass(frozen=True)
class LosesRows(Shift):
    """Leave the second row out."""

    def apply(self, path, context):
        return super().apply(path, context).take(np.arange(len(path)) != 1)


@dataclass(frozen=True)
class LosesEvents(Shift):
    """Forget the events."""

    def apply(self, path, context):
        return super().apply(path, context).replace(events=())


@dataclass(frozen=True)
class MovesEvents(Shift):
    """Let all events happen at the start."""

    def apply(self, path, context):
        path = super().apply(path, context)
        return path.replace(events=tuple(replace(e, row=0) for e in path.events))


@dataclass(frozen=True)
class MakesRapids(Shift):
    """Make rapids of lines."""

    def apply(self, path, context):
        kind = np.where(path.kind == 1, 0, path.kind).astype(np.int8)
        return super().apply(path, context).replace(kind=kind)


@dataclass(frozen=True)
class Hurries(Shift):
    """Double the feeds."""

    def apply(self, path, context):
        return super().apply(path, context).replace(feed=path.feed * 2)


@dataclass(frozen=True)
class Boasts(Shift):
    """Ensure that there are no arcs, and do nothing about it."""

    ensures = frozenset({gx.LINEAR_ONLY})


@dataclass(frozen=True)
class MakesInches(Shift):
    """Write inches, and not say so."""

    def apply(self, path, context):
        path = super().apply(path, context)
        inch = np.ones(len(path.blocks.inch), np.bool_)
        return path.replace(blocks=replace(path.blocks, inch=inch))


CALLS: list[int] = []


@dataclass(frozen=True)
class Remembers(Shift):
    """Move a little farther each time."""

    def apply(self, path, context):
        CALLS.append(1)
        return self._moved(path, float(len(CALLS)))


@dataclass(frozen=True)
class Stumbles(Shift):
    """Fail on a path without rows."""

    def apply(self, path, context):
        return self._moved(path, float(path.end[0, 0] > -1e9))


@dataclass(frozen=True)
class Refuses(Shift):
    """Refuse everything."""

    def apply(self, path, context):
        raise gx.InputError.one("GX999", "no")


@dataclass(frozen=True)
class RefusesWithoutCode(Shift):
    """Refuse without saying why."""

    def apply(self, path, context):
        raise gx.InputError(())


@dataclass(frozen=True)
class Silent(gx.Pass):
    name = "silent"

    def apply(self, path, context):
        return path


class Thawed(gx.TextPass):
    """Be no frozen dataclass."""

    name = "thawed"


@dataclass(frozen=True)
class DropsWords(gx.TextPass):
    """Drop the first word of every block."""

    name = "drops"

    def edit(self, block, number):
        return " ".join(block.text.split()[1:])


def test_a_good_pass():
    check_pass(Shift)
    check_pass(Shift, Shift((0.0, 0.0, 0.0)), Shift((-1.5, 0.0, 20.0)))


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        (WrongUndo, "undo(after) is"),
        (NoUndo, "undo(after) is"),
        (WrongCentre, "off its circle"),
        (ForgetsEntry, "two windows"),
        (Mutates, "apply on 'no block' changes what it was given"),
        (MutatesByForce, "changes what it was given: end"),
        (LosesSource, "loses `source`"),
        (LosesRows, "leaves a move out"),
        (LosesEvents, "changes events"),
        (MovesEvents, "moves the event"),
        (MakesRapids, "makes a rapid of a feed move"),
        (Hurries, "changes the feed"),
        (Boasts, "ensures LINEAR_ONLY"),
        (MakesInches, "loses METRIC"),
        (Remembers, "the second time"),
        (Stumbles, "apply on 'no block' fails: IndexError"),
        (Refuses, "refuses every path"),
        (RefusesWithoutCode, "without a code"),
        (Silent, "has no docstring"),
        (DropsWords, "changed the words"),
    ],
    ids=lambda value: value.__name__ if isinstance(value, type) else "",
)
def test_broken_passes(broken, said):
    with pytest.raises(AssertionError, match=re.escape(said)):
        check_pass(broken)


def test_a_pass_that_is_not_frozen():
    with pytest.raises(AssertionError, match="not a frozen dataclass"):
        check_pass(Thawed)


def test_mandatory_options_need_an_instance():
    with pytest.raises(AssertionError, match="give check_pass an instance"):
        check_pass(passes()["volumetric"])


def test_a_pass_that_does_not_begin():
    model = ModelFile.load(MODEL)
    with pytest.raises(AssertionError, match=r"(?s)does not begin.*GX721"):
        check_pass(passes()["volumetric"], passes()["volumetric"](model=model))
