"""What circular tests found of a machine: lines for a person, comments, and a report.

The table of causes is that of a ballbar's sheet: each with its size, and the range of what it does
to the radius as a share of the circular deviation. Shares do not add to 100 %, because what one
cause adds another may take away.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

from gcxform.calibrate.circles.circles import Fitted, Size, left_out
from gcxform.calibrate.circles.machine import Identified
from gcxform.calibrate.circles.scales import BAR, NONE, Told
from gcxform.calibrate.rotary.axis import REJECTED
from gcxform.calibrate.rotary.check import two_digits
from gcxform.calibrate.solution import Scatter
from gcxform.version import VERSION

WIDTH: Final = 98
UM: Final = 1e3  # per mm
POOR: Final = 30.0  # condition above which a test is worth a warning
LARGE: Final = 0.2  # of G: the largest cause is worth a word above it
CLOSING: Final = 3.0  # tests that differ by more than so many deviations are worth a warning


class Line(NamedTuple):
    """A line of the sheet: a group of causes, its sizes in words, its effect in mm, its share.

    The share is nan for what the pivot is off the middle: G does not have it.
    """

    group: str
    sizes: str
    effect: float
    share: float


def sheet(test: Fitted) -> list[Line]:
    """Return the causes of a test, the one with the largest effect first."""
    whole = test.deviation
    found = [
        Line(group, _sizes(test, group), effect, effect / whole if whole > 0.0 else 0.0)
        for group, effect in test.effects.items()
    ]
    return [*found, Line("centre", _sizes(test, "centre"), _eccentric(test), math.nan)]


def _eccentric(test: Fitted) -> float:
    """Return how far the pivot is off the middle of the circle, mm."""
    return math.hypot(test.size("centre 1").value, test.size("centre 2").value) / UM


def share_words(share: float) -> str:
    """Return a share of G in words."""
    return "set-up" if math.isnan(share) else f"{100 * share:.0f} %"


def _sizes(test: Fitted, group: str) -> str:
    """Return the sizes of a group in words."""
    if group == "reversal spikes":
        return _spikes(test)
    own = [
        size for size, cause in zip(test.sizes, test.causes, strict=True) if cause.group == group
    ]
    if any(math.isnan(size.value) for size in own):
        return "not told"
    if group.startswith("cyclic"):
        amplitude = math.hypot(*(size.value for size in own))
        return f"{amplitude:.2f} +- {two_digits(max(size.deviation for size in own))} um"
    if group == "centre":
        named = zip(test.setup.letters, own, strict=True)
        return ", ".join(f"{letter} {_pair(size)}" for letter, size in named) + " um"
    short = (f"{size.name.removeprefix(group).replace(' at ', '')} {_pair(size)}" for size in own)
    return ", ".join(text.strip() for text in short) + f" {own[0].unit}"


def _pair(size: Size) -> str:
    digits = 3 if size.unit == "ms" else 2
    return f"{size.value:+.{digits}f} +- {two_digits(size.deviation)}"


def _spikes(test: Fitted) -> str:
    """Return the largest spike of each end in um, of those that are seen."""
    found: dict[str, float] = {}
    for spike in test.spikes:
        if spike.seen and abs(spike.height) > abs(found.get(spike.end, 0.0)):
            found[spike.end] = spike.height
    seen = f"{UM * test.scatter.effective * 3.0:.2g} um"
    return ", ".join(f"{end} {UM * height:+.2f}" for end, height in found.items()) + (
        " um" if found else f"none above {seen}"
    )


# --- for a person ---


def lines(found: Identified) -> list[str]:
    """Return what was found, for a person."""
    said = []
    for number, test in enumerate(found.tests, 1):
        said += [headline(test, number), f"  {_figures(test)}"]
        said += [
            f"  {group:18}{sizes:42}{UM * effect:8.2f} um{share_words(share):>8}"
            for group, sizes, effect, share in sheet(test)
        ]
        said += [f"  {line}" for line in _looked(test)]
    return [
        *said,
        *machine(found),
        *(f"warning: {line}" for line in warnings(found)),
        *(f"next: {line}" for line in advice(found)),
    ]


def headline(test: Fitted, number: int) -> str:
    """Return what a test was, in a line."""
    setup = test.setup
    parts = [f"test {number}: {setup.plane}, radius {setup.radius:.6g} mm"]
    if setup.feed is not None:
        parts.append(f"feed {60.0 * setup.feed:.6g} mm/min")
    if setup.centre is not None:
        words = zip("XYZ", setup.centre, strict=True)
        parts.append("about " + " ".join(f"{a}{v:.6g}" for a, v in words))
    runs = ", ".join(f"{len(run.readings)} {run.name}" for run in test.runs)
    known = math.isfinite(test.condition)
    condition = f"condition {test.condition:.1f}" if known else "not all causes told"
    parts += [f"{runs}", f"arc {test.arc:.4g} degrees", condition]
    return "; ".join([", ".join(parts), f"residuals {UM * test.scatter.observed:.3g} um"])


def _looked(test: Fitted) -> Iterator[str]:
    """Yield what a search for pitches has found, in words."""
    if test.looked is None:
        return
    found, shortest, longest = test.looked
    for letter, pitch, chance in found:
        often = f"once in {1.0 / max(chance, 1e-99):.1g} times" if chance > 1e-99 else "never"
        yield f"cyclic error {letter}: a period of {pitch:.4g} mm, as noise has one {often}"
    rest = ", ".join(letter for letter in test.setup.letters if letter not in test.looked.pitches)
    if rest:
        span = f"{shortest:.3g} to {longest:.3g} mm"
        yield f"no cyclic error of {rest} is seen with a period of {span}"


def _figures(test: Fitted) -> str:
    return "  ".join(f"{name} {UM * value:.2f}" for name, value in test.figures.items()) + " um"


def machine(found: Identified) -> Iterator[str]:
    """Yield the squareness, the scales and the bows of the machine, in words."""
    for name, told in found.squareness.items():
        yield f"{name}: {_told(told)} urad"
    for plane, told in found.mismatches.items():
        yield f"scale {plane[0]} - scale {plane[1]}: {_told(told)} ppm"
    for letter, told in found.scales.items():
        beside = "" if found.scale_from == BAR else f", that of {found.scale_from} taken to be 0"
        yield f"scale {letter}: {_told(told)} ppm{beside}"
    for bow in found.bows:
        value, deviation = UM * bow.told.value, UM * bow.told.deviation
        yield (
            f"{bow.name}: a bow of {value:+.2f} +- {two_digits(deviation)} um over "
            f"{2.0 * bow.span.half:.6g} mm, if pitches are even"
        )
    if found.scales and found.network.radii:
        yield _rests(found.network.radii)


def _rests(radii: list[float]) -> str:
    """Return in words what scales by a bar rest on."""
    said = ", ".join(f"{radius:.6g}" for radius in radii)
    many = len(radii) > 1
    return (
        f"the scales rest on the stated radi{'i' if many else 'us'} of {said} mm: "
        f"1 um of {f'{radii[0]:.6g} mm' if many else 'it'} is {UM / radii[0]:.3g} ppm of all scales"
    )


def _told(told: Told) -> str:
    return f"{1e6 * told.value:+.2f} +- {two_digits(1e6 * told.deviation)}"


def comments(found: Identified, file: str) -> str:
    """Return what stands above a model file."""
    name = "".join(c if c.isprintable() else "?" for c in Path(file).name)
    said = [f"by circular tests of {name}, gcxform {VERSION}"]
    said += [headline(test, number) for number, test in enumerate(found.tests, 1)]
    said += [*machine(found), *(f"warning: {line}" for line in warnings(found))]
    said.append(
        "no error in the middle of the circles; what depends on direction or feed is no part of "
        "this model, and what was not measured is 0 in it"
    )
    pieces = (piece for line in said for piece in textwrap.wrap(line, WIDTH))
    return "".join(f"# {piece}\n" for piece in pieces)


# --- what is to be said ---


def warnings(found: Identified) -> Iterator[str]:
    """Yield what whoever believes the result has to know."""
    for number, test in enumerate(found.tests, 1):
        yield from (f"test {number}: {line}" for line in _warnings(test))
    agreeing = {**found.squareness, **{f"scales in {p}": t for p, t in found.mismatches.items()}}
    for name, told in agreeing.items():
        if told.agree > CLOSING:
            yield (
                f"{name}: the tests differ by {told.agree:.1f} times their deviations, which are "
                "those of the machine: it is not the same everywhere"
            )
    if _closing(found) > CLOSING:
        yield (
            f"the differences of scale in the three planes do not close, by {_closing(found):.1f} "
            "times their deviations: a scale is not the same everywhere"
        )
    if found.network.doubt is not None:
        yield found.network.doubt[1]
    if found.scale_from == NONE and found.mismatches:
        yield (
            "scales are not in the model: circles tell how they differ, and not which is wrong "
            "(--scale-from)"
        )


def _closing(found: Identified) -> float:
    """Return by how many deviations the differences of three planes do not close."""
    if len(found.mismatches) < 3:
        return 0.0
    told = found.mismatches.values()
    return abs(sum(t.value for t in told)) / math.hypot(*(t.deviation for t in told))


def _warnings(test: Fitted) -> Iterator[str]:
    if words := left_out(test):
        yield words
    untold = [size.name for size in test.sizes if math.isnan(size.value)]
    if untold:
        why = "they have one sense alone" if test.one_sense else "they are too few, or too near"
        yield f"the readings do not tell {', '.join(untold)}: {why}"
    if test.condition > POOR and not untold:
        yield f"badly conditioned: {test.condition:.0f} (above {POOR:.0f} is poor)"
    if test.scatter.ratio > REJECTED:
        yield (
            f"what is left is {UM * test.scatter.observed:.3g} um rms where a noise of "
            f"{UM * test.asked.noise:.3g} um is stated: deviations are those of what is left"
        )
    else:
        yield from _scattered(test.scatter)
    if test.correlation > 0.0 and test.factor > 1.0:
        yield (
            f"what is left is smooth (neighbours correlated {test.correlation:.2f}): there are "
            "causes that the table does not have"
        )
    if test.setup.feed is None and test.sense.any():
        yield "the feed is not known: servo mismatch is a length, and no time (--feed)"


def _scattered(scatter: Scatter) -> list[str]:
    return scatter.warnings


def advice(found: Identified) -> Iterator[str]:
    """Yield what makes the next measurement better, or the machine."""
    for test in found.tests:
        if not test.sense.any():
            yield (
                "turn the ring by 90 degrees, probe it again, and give both as tests: the mean "
                "does not have what the ring is not round"
            )
            break
    for test in found.tests:
        group, effect = next(iter(test.effects.items()))
        if group in _CURES and effect > LARGE * test.deviation:
            yield f"{test.setup.plane}: {_CURES[group]}"


_CURES: Final = {
    "servo mismatch": "match the position gains or feed forward of both axes; no model holds it",
    "reversal spikes": "tune the friction compensation of the control; no model holds it",
    "squareness": "squareness is in the model (-o), for `volumetric` or a table of the control",
    "scale mismatch": "scales are in the model (-o) with --scale-from",
}


# --- the report ---


def report(found: Identified, file: str, conditions: Mapping[str, Any]) -> dict[str, Any]:
    """Return all that was found, as plain values."""
    return {
        "method": "circular tests of linear axes",
        "gcxform": VERSION,
        "units": "mm, rad, s; scales mm per mm; sizes of causes in the unit that stands by them",
        "file": file,
        "tests": [_reported(test) for test in found.tests],
        "squareness": {name: _plain(told) for name, told in found.squareness.items()},
        "scale-differences": {plane: _plain(told) for plane, told in found.mismatches.items()},
        "scale-from": found.scale_from,
        "radii": found.network.radii,
        "scales": {letter: _plain(told) for letter, told in found.scales.items()},
        "bows": {bow.name: {**_plain(bow.told), **bow.span._asdict()} for bow in found.bows},
        "warnings": [*warnings(found)],
        "advice": [*advice(found)],
        "conditions": dict(conditions),
    }


def _plain(told: Told) -> dict[str, float | None]:
    return {"value": told.value, "sd": told.deviation}


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _reported(test: Fitted) -> dict[str, Any]:
    setup = test.setup
    return {
        "plane": setup.plane,
        "test": setup.name,
        "radius": setup.radius,
        "feed": setup.feed,
        "centre": None if setup.centre is None else list(setup.centre),
        "readings": {run.name: len(run.readings) for run in test.runs},
        "arc": test.arc,
        "cyclic": [period._asdict() for period in test.looked.found] if test.looked else [],
        "condition": _number(test.condition),
        "noise": test.asked.noise,
        "scatter": test.scatter.report(),
        "correlation": test.correlation,
        "figures": {name: _number(value) for name, value in test.figures.items()},
        "causes": {
            size.name: {
                "value": _number(size.value),
                "sd": _number(size.deviation),
                "unit": size.unit,
                "effect": _number(size.effect),
            }
            for size in test.sizes
        },
        "shares": {line.group: _number(line.share) for line in sheet(test)},
        "spikes": [
            {"end": s.end, "sense": s.sense, "height": s.height, "seen": s.seen}
            for s in test.spikes
        ],
        "covariance": {
            "meaning": "of the sizes of the causes in mm",
            "order": [cause.name for cause in test.causes],
            "matrix": test.covariance.tolist(),
        },
    }
