"""Faults of the commands `info` and `resume`, and of how a dialect tells times."""

from __future__ import annotations

from faults.mutation import Mutation

MUTATIONS = (
    Mutation(
        "info: the feed per turn forgets the spindle",
        "gcxform/cli/times.py",
        "speed[event.row :] = self.spindle",
        "speed[event.row :] = 1.0",
        "tests/test_info.py",
    ),
    Mutation(
        "info: rapids take as long as the fastest axis",
        "gcxform/cli/times.py",
        "each.max(axis=1, initial=0.0)",
        "each.min(axis=1)",
        "tests/test_info.py",
    ),
    Mutation(
        "resume: the feed is stated in the wrong unit",
        "gcxform/cli/preamble.py",
        "feed_inch = self.state.feed_unit == INCH",
        "feed_inch = self.state.feed_unit != INCH",
        "tests/test_resume.py",
    ),
    Mutation(
        "resume: the coolant stays on",
        "gcxform/cli/memory.py",
        "off = COOLANT_OFF.get(code)",
        "off = ()",
        "tests/test_resume.py",
    ),
    Mutation(
        "haas: a dwell with a point is in milliseconds",
        "gcxform/modal/events.py",
        "lines.window.decimals[number] >= 0:",
        "lines.window.decimals[number] >= 9:",
        "tests/test_info.py",
    ),
)
