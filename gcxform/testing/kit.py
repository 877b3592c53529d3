"""`check_pass`: whether a pass keeps its contract.

    def test_shift():
        check_pass(Shift, Shift(by=(1.0, 0.0, 0.0)))

It raises AssertionError with a sentence that says what is wrong, and on which path.
Passes are tried on small toolpaths between 0 and 200 mm: lines, rapids, arcs in all planes,
helices, full circles, inches, inverse time, rotary axes, an unknown start, one row and no row.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from gcxform.contract.options import build, describe, to_toml
from gcxform.contract.passes import Pass, PassContext, TextPass
from gcxform.deviations.runs import Runs, deviation_of_runs, runs_of
from gcxform.diagnostics import GcxformError, InputError, Location
from gcxform.machine.machine import Machine
from gcxform.pipeline.text_passes import TextRun
from gcxform.plugin.registry import default_registry
from gcxform.system.arrays import Flags, Ints
from gcxform.testing.paths import (
    PROGRAMS,
    Plain,
    PlainXY,
    differs,
    differs_joined,
    halves,
    locked,
    paths,
)
from gcxform.toolpath.circles import radius_and_angle
from gcxform.toolpath.columns import COLUMNS
from gcxform.toolpath.facts import Fact
from gcxform.toolpath.path import FeedMode, Kind, Toolpath
from gcxform.toolpath.travel import lengths
from gcxform.values import dataclass

SLACK = 1e-7  # mm and degrees; what arithmetic may add to a promise
ON_CIRCLE = 1e-6  # mm
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


def check_pass(
    pass_class: type[Pass] | type[TextPass],
    *instances: Pass | TextPass,
    machine: Machine | None = None,
) -> None:
    """Hold a pass to its contract; without instances, the one with all defaults is tried.

    Declared and documented, options that survive TOML, no change of what it is given, the facts
    it ensures, source lines and events kept, windows of any size, and the law
    deviation(before, undo(after)) <= promise.
    """
    _check_declaration(pass_class)
    if not instances:
        try:
            instances = (pass_class(),)
        except TypeError:
            raise AssertionError(
                f"{pass_class.__name__} has mandatory options: give check_pass an instance"
            ) from None
    for instance in instances:
        assert type(instance) is pass_class, f"{instance!r} is not a {pass_class.__name__}"
        _check_options(instance)
        if isinstance(instance, TextPass):
            _check_text(instance)
        else:
            for target in (Plain, PlainXY):
                context = PassContext(Plain, target, target.numbers, machine)
                _PathCheck(instance, context).run()


def _check_declaration(pass_class: type[Pass] | type[TextPass]) -> None:
    name = pass_class.__name__
    assert issubclass(pass_class, Pass | TextPass), f"{name} is not a Pass"
    assert NAME.fullmatch(pass_class.name), f"{name} has the name {pass_class.name!r}"
    text = pass_class.__dict__.get("__doc__") or f"{name}("
    assert not text.startswith(f"{name}("), f"{name} has no docstring"
    parameters = pass_class.__dict__.get("__dataclass_params__")
    frozen = parameters is not None and parameters.frozen
    assert frozen, f"{name} is not a frozen dataclass: @dataclass(frozen=True)"
    describe(pass_class)
    if issubclass(pass_class, Pass):
        for group in ("requires", "ensures", "clears"):
            facts = getattr(pass_class, group)
            good = isinstance(facts, frozenset) and all(isinstance(f, Fact) for f in facts)
            assert good, f"{name}.{group} is not a frozenset of facts"


def _check_options(instance: Pass | TextPass) -> None:
    """Check that the options come back from what a TOML file would say."""
    raw = to_toml(instance)
    formats = default_registry().formats.values()
    try:
        again = build(type(instance), raw, Path.cwd(), formats, lambda key: Location("kit"))
    except GcxformError as error:
        raise AssertionError(f"{instance!r}: its options {raw} are refused: {error}") from None
    assert again == instance, f"{instance!r} comes back from TOML as {again!r}"


def _check_text(instance: TextPass) -> None:
    """Try a text pass on the programs: it may change no word, and the same one always alike."""
    for label, program in PROGRAMS.items():
        text = (program or "\n").encode()
        lines = list(range(text.count(b"\n")))
        found = []
        for _ in range(2):
            run = TextRun((instance,), Plain, "-")
            try:
                found.append(run.edit(text, lines))
            except InputError:
                found.append((b"", []))
            except Exception as error:
                raise AssertionError(f"{instance.name} on {label!r}: {error}") from error
        assert found[0] == found[1], f"{instance.name} edits {label!r} differently the second time"


@dataclass
class _Trial:
    """One path given to a pass, and what came back."""

    label: str
    before: Toolpath
    after: Toolpath


class _PathCheck:
    """The checks of one instance of a pass in one context."""

    def __init__(self, step: Pass, context: PassContext) -> None:
        self.step = step
        self.context = context

    def run(self) -> None:
        promise = self.step.promise
        assert promise >= 0.0, f"{self.step.name} promises {promise!r}, which is no distance"
        try:
            self.step.begin(self.context)
        except GcxformError as error:
            message = f"{self.step.name} does not begin; give another instance: {error}"
            raise AssertionError(message) from None
        trials = [
            _Trial(label, path, after)
            for label, path in paths()
            if all(fact.check(path) for fact in self.step.requires)
            and (after := self._apply(label, path)) is not None
        ]
        moved = any(len(trial.before) for trial in trials)
        assert moved, f"{self.step.name} refuses every path; give another instance"
        for trial in reversed(trials):
            again = self._apply(trial.label, trial.before)
            same = again is not None and differs(trial.after, again, 0.0) == ""
            self._assert(same, trial, "gives another path the second time: it keeps something")
        for trial in trials:
            self._check(trial)

    def _assert(self, good: bool, trial: _Trial, message: str) -> None:
        assert good, f"{self.step.name} on {trial.label!r}: {message}"

    # --- calls ---

    def _apply(self, label: str, path: Toolpath) -> Toolpath | None:
        """Return the changed path, None if it is refused with a code."""
        return self._call(self.step.apply, "apply", label, path)

    def _undo(self, label: str, path: Toolpath) -> Toolpath:
        undone = self._call(self.step.undo, "undo", label, path)
        assert undone is not None, f"{self.step.name}.undo refuses its own output on {label!r}"
        return undone

    def _call(
        self,
        function: Callable[[Toolpath, PassContext], Toolpath],
        name: str,
        label: str,
        path: Toolpath,
    ) -> Toolpath | None:
        given = locked(path)
        here = f"{self.step.name}.{name} on {label!r}"
        try:
            result = function(given, self.context)
        except GcxformError as error:
            if not error.diagnostics:
                raise AssertionError(f"{here} refuses without a code") from error
            return None
        except Exception as error:
            change = "changes what it was given" if "read-only" in str(error) else "fails"
            raise AssertionError(f"{here} {change}: {type(error).__name__}: {error}") from error
        changed = differs(given, path, 0.0)
        assert not changed, f"{here} changes what it was given: {changed}"
        assert isinstance(result, Toolpath), f"{here} returns {type(result).__name__}"
        sizes = {len(getattr(result, column)) for column in COLUMNS}
        assert len(sizes) == 1, f"{here} returns columns of {sorted(sizes)} rows"
        return result

    # --- what must hold ---

    def _check(self, trial: _Trial) -> None:
        self._facts(trial)
        runs = self._runs(trial, trial.after)
        self._kinds(trial, runs.owner)
        self._arcs(trial)
        self._events(trial, runs)
        undone = self._law(trial)
        self._windows(trial, undone)

    def _facts(self, trial: _Trial) -> None:
        step = self.step
        for fact in step.ensures:
            self._assert(
                fact.check(trial.after), trial, f"ensures {fact}, and the path does not have it"
            )
        for fact in default_registry().facts.values():
            if fact not in step.clears and fact.check(trial.before):
                message = f"loses {fact}, and does not say so in `clears`"
                self._assert(fact.check(trial.after), trial, message)

    def _runs(self, trial: _Trial, path: Toolpath) -> Runs:
        """Return the rows of the source that each row stands for, after checking `source`."""
        before = trial.before.source
        known = bool(np.isin(path.source, before).all())
        self._assert(known, trial, "loses `source`: a row belongs to no line of the program")
        ordered = bool((np.diff(path.source) >= 0).all())
        self._assert(ordered, trial, "loses the order of `source`")
        runs = runs_of(trial.before, np.searchsorted(before, path.source))
        joined = len(runs.joined) == 0 or self.step.demands.joins
        self._assert(joined, trial, "leaves a move out, and does not say `joins` in its demands")
        start, end = trial.before.start[runs.left], trial.before.end[runs.left]
        way = np.where(np.isnan(start) & np.isnan(end), 0.0, np.nan_to_num(end - start, nan=np.inf))
        short = np.sqrt((way**2).sum(axis=1)) <= self.step.promise + SLACK
        curved = trial.before.is_arc | trial.before.is_spline
        gone = bool((short & ~curved[runs.left]).all())
        self._assert(gone, trial, "leaves a move out: a line of the program has no row")
        return runs

    def _kinds(self, trial: _Trial, owner: Ints) -> None:
        before, after = trial.before, trial.after
        rapid = (before.kind == Kind.RAPID)[owner]
        same = bool((rapid == (after.kind == Kind.RAPID)).all())
        self._assert(same, trial, "makes a rapid of a feed move, or the reverse")
        other = before.feed_mode[owner] != after.feed_mode
        wanted = self.step.demands.feed_mode
        meant = wanted is not None
        mode = not other.any() or (meant and (after.feed_mode[other] == wanted).all())
        self._assert(bool(mode), trial, "changes the feed mode")
        self._converted(trial, owner, other & ~rapid)
        rapid = rapid | other
        timed = ~rapid & (after.feed_mode == FeedMode.INVERSE_TIME)
        plain = ~rapid & ~timed
        kept = np.allclose(after.feed[plain], before.feed[owner[plain]], rtol=1e-9, equal_nan=True)
        self._assert(kept, trial, "changes the feed")
        self._times(trial, after, owner, timed)

    def _times(self, trial: _Trial, path: Toolpath, owner: Ints, timed: Flags) -> None:
        """Check that rows in G93 share the time of the row that they come from."""
        time = np.bincount(owner[timed], 1 / path.feed[timed], len(trial.before))
        used = np.unique(owner[timed])
        good = np.allclose(time[used], 1 / trial.before.feed[used], rtol=1e-6)
        self._assert(good, trial, "changes the time of a move in G93: its pieces share it")

    def _converted(self, trial: _Trial, owner: Ints, rows: Flags) -> None:
        """Check feeds in another mode: the way that is gone in the same time."""
        before, after = trial.before, trial.after
        way, old = lengths(after), lengths(before)
        inverse = after.feed_mode == FeedMode.INVERSE_TIME
        time = np.where(inverse, 1.0, way.most) / after.feed
        total = np.bincount(owner[rows], time[rows], len(before))
        timed = before.feed_mode == FeedMode.INVERSE_TIME
        gone = total * before.feed * np.where(timed, old.most, 1.0)
        used = np.unique(owner[rows])
        good = np.allclose(gone[used], old.most[used], rtol=1e-6)
        self._assert(good, trial, "converts a feed by another length than that of its move")

    def _arcs(self, trial: _Trial) -> None:
        """Check that both ends of every arc are on its circle, where no pass says otherwise."""
        rows = np.flatnonzero(trial.after.is_arc)
        if not len(rows) or not trial.after.refit_centres:
            return
        first, last, _ = radius_and_angle(trial.after, rows)
        off = float(np.abs(first - last).max())
        message = f"an arc ends {off:g} mm off its circle: move `centre` along with `end`"
        self._assert(off <= ON_CIRCLE, trial, message)

    def _events(self, trial: _Trial, runs: Runs) -> None:
        before, after = trial.before.events, trial.after.events
        same = [replace(e, row=0) for e in before] == [replace(e, row=0) for e in after]
        self._assert(same, trial, "changes events: spindle, coolant, dwell, stops")
        for old, new in zip(before, after, strict=True):
            earlier = new.row == 0 or int(runs.through[new.row - 1]) < old.row
            later = new.row >= len(runs.owner) or int(runs.owner[new.row]) >= old.row
            self._assert(earlier and later, trial, f"moves the event {old.what}; use with_rows")

    def _law(self, trial: _Trial) -> Toolpath:
        """Check deviation(before, undo(after)) <= promise, from the first point on.

        Return undo(after).
        """
        promise = self.step.promise
        undone = self._undo(trial.label, trial.after)
        runs = self._runs(trial, undone)
        owner = runs.owner
        timed = (undone.feed_mode == FeedMode.INVERSE_TIME) & (undone.kind != Kind.RAPID)
        timed &= trial.before.feed_mode[owner] == FeedMode.INVERSE_TIME
        self._times(trial, undone, owner, timed)
        along = np.isfinite(promise) and type(self.step).undo is not Pass.undo
        off = deviation_of_runs(trial.before, undone, runs, promise if along else 0.0)
        if not np.isfinite(promise):
            return undone
        worst = float(off.distance.max(initial=0.0))
        message = f"undo(after) is {worst:g} mm from before; the promise is {promise:g} mm"
        self._assert(worst <= promise + SLACK, trial, message)
        turned = float(off.angle.max(initial=0.0))
        allowed = 10.0**-self.context.numbers.angle
        self._assert(turned <= allowed, trial, f"undo(after) is {turned:g} degrees from before")
        gap = float(np.nan_to_num(np.abs(undone.entry - trial.before.entry)).max(initial=0.0))
        message = f"undo(after) begins {gap:g} mm off: apply and undo change `entry` as well"
        self._assert(gap <= promise + SLACK, trial, message)
        return undone

    def _parts(self, trial: _Trial, line: int) -> None:
        """Check that a pass that joins rows keeps its law in each of two windows."""
        for nth, part in enumerate(halves(trial.before, line)):
            after = self._apply(trial.label, part)
            self._assert(after is not None, trial, "refuses a part of a path it takes as a whole")
            if after is not None and len(part):
                half = _Trial(f"{trial.label}, part {nth}", part, after)
                self._events(half, self._runs(half, after))
                self._law(half)

    def _windows(self, trial: _Trial, undone: Toolpath) -> None:
        """Check that a program in two windows gives what it gives in one."""
        if len(trial.before) < 2:
            return
        lines = trial.before.source
        if self.step.demands.joins:
            self._parts(trial, int(lines[len(lines) // 2]))
            return
        ways = (trial.before, self._apply, trial.after), (trial.after, self._undo, undone)
        for line in {int(lines[1]), int(lines[len(lines) // 2])}:
            for whole, call, both in ways:
                first, second = halves(whole, line)
                parts = [call(trial.label, first), call(trial.label, second)]
                message = "refuses a part of a path that it takes as a whole"
                self._assert(None not in parts, trial, message)
                said = differs_joined(both, parts, SLACK)
                self._assert(
                    not said, trial, f"a program in two windows comes out otherwise: {said}"
                )
