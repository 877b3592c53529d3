"""What written-out lines leave in parameters, for lines behind them that are not written out.

Where a loop is written out its assignments are gone with it. A parameter that the same call reads
afterwards is set behind it, to what the loop has left in it. Parameters that outlive the program
are set in what is written out anyway.
"""

from __future__ import annotations

from bisect import bisect_left
from math import isnan

from gcxform.dialect.arithmetic import Key
from gcxform.dialect.null import Null
from gcxform.emit.spelled import Text
from gcxform.flow.text import assignment
from gcxform.flow.walk import Walk

Run = tuple[int, int]
"""Steps: the first, and the one behind the last."""


class Values:
    """Knows who reads which parameter in an execution."""

    def __init__(self, walk: Walk) -> None:
        self.walk = walk

    def one(self, lines: range, runs: list[Run], texts: list[Text]) -> Text | None:
        """Return what stands in place of lines each time, with the values that they leave.

        `texts` is what they became in each run. None: that is not always the same, or a value has
        no exact text.
        """
        left = [self._left(*run) for run in runs]
        read = {key for values in left for key in values if self._reads(key, lines, runs)}
        found = []
        for (begin, _), text, values in zip(runs, texts, left, strict=True):
            line = self.walk.steps[begin].first
            for key in sorted(read & values.keys(), key=str):
                if isnan(values[key]):
                    return None
                said = assignment(key, values[key], self.walk.arithmetic)
                null = isinstance(values[key], Null)
                if not null and float(said.partition("=")[2]) != values[key]:
                    return None
                end = self.walk.listing.line_end(line)
                text += Text(said.encode("latin-1") + end, (line,))
            found.append(text)
        same = {text.text for text in found}
        return found[0] if len(same) == 1 else None

    def _left(self, begin: int, end: int) -> dict[Key, float]:
        """Return the values that steps of one call leave in parameters of its own, unsaid."""
        steps, level = self.walk.steps, self.walk.steps[begin].level
        outlives, said = self.walk.arithmetic.outlives, self.walk.said
        return {
            made.key: made.value
            for made in self.walk.made_by(begin, end)
            if steps[made.step].level == level and not outlives(made.key) and made.key not in said
        }

    def _reads(self, key: Key, lines: range, runs: list[Run]) -> bool:
        """Whether a call reads a parameter behind one of the runs, outside of these lines."""
        for line, named in self.walk.reads.items():
            if line in lines or not (key in named or None in named):
                continue
            steps = self.walk.readers.get(line, [])
            for begin, end in runs:
                at = bisect_left(steps, end)
                if at < len(steps) and steps[at] < self.walk.left(begin):
                    return True
        return False
