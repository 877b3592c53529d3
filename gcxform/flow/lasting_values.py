"""What a program that is executed leaves behind: parameters that last, messages with values."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

from gcxform.dialect.arithmetic import Key, NoValueError
from gcxform.dialect.null import MAYBE
from gcxform.flow.messages import LONGEST, told
from gcxform.flow.outputs import Outputs
from gcxform.flow.residual import Edit
from gcxform.flow.run_state import RunState
from gcxform.flow.text import assignment
from gcxform.flow.walk import Made
from gcxform.modal.expressions.value import DOUBTFUL, written
from gcxform.modal.meaning.printed import prints_values
from gcxform.syntax.tree import Block, Comment


class Lasting:
    """Keeps account of one execution.

    locals_set  how often a parameter was set that ends with its call, or with the program
    made        all assignments, with the step that made each
    outputs     what the written blocks set, for those that last and for blocks that print
    """

    def __init__(self, program: RunState) -> None:
        self.program = program
        self.locals_set = 0
        self.made: list[Made] = []
        self.outputs = Outputs(program)

    def account(self, key: Key, value: float, kept: str = "") -> str:
        """Return an assignment as it is written: nothing for a parameter that ends with the run.

        `kept` is what stays of one whose value only the machine knows, or the control's own.
        """
        self.made.append(Made(len(self.program.walked) - 1, key, value))
        if kept:
            self.outputs.refuse_levels(key)
            self.outputs.assign(key, value)
            return kept
        if not self.says(key):
            self._drop(key, 1)
            return ""
        self.outputs.refuse_levels(key)
        if value is MAYBE:
            message = f"whether {written(key)} becomes 0 or null is not certain"
            raise self.program.refusal("GX221", message)
        self.outputs.assign(key, value)
        return assignment(key, value, self.program.arithmetic)

    def says(self, key: Key) -> bool:
        """Whether the assignments of a parameter are written whose values are known."""
        return self.program.keeps and not self._is_dropped(key)

    def _is_dropped(self, key: Key) -> bool:
        local = not self.program.arithmetic.outlives(key)
        return local and key not in self.program.settled.needed

    def _drop(self, key: Key, times: int) -> None:
        """Count assignments that are not written, of a parameter that ends with the run."""
        if self._is_dropped(key):
            self.program.dropped.add(key)
            self.locals_set += times

    def account_all(self, made: Sequence[tuple[int, Made]]) -> None:
        """Account for assignments of many rounds, each with its line; their values are known."""
        self.made += [each for _, each in made]
        times = Counter(each.key for _, each in made)
        said = frozenset(filter(self.says, times))
        for key in times.keys() - said:
            self._drop(key, times[key])
        self.outputs.assign_all([(line, e.key, e.value) for line, e in made if e.key in said])

    def messages(self, block: Block) -> list[Edit]:
        """Return the executed comments that print values, with the values in them.

        The control prints what parameters are worth behind the assignments of the block.
        Raises InputError.
        """
        edits: list[Edit] = []
        for item in block.items:
            text = block.text[item.start : item.end]
            executed = isinstance(item, Comment) and self.program.dialect.text_rule.executes(text)
            if not executed or not prints_values(text):
                continue
            place = item.start, item.end
            try:
                edits.append((*place, told(text, self._printed)))
            except NoValueError as why:
                raise self.program.refusal(why.code, why.message, why.hint, place) from None
        return edits

    def _printed(self, key: Key) -> float | None:
        """Return what a message prints for a parameter; None where the control knows it as well."""
        known, arithmetic = self.program.parameters.get(key), self.program.arithmetic
        if known is None or abs(known) < LONGEST:
            return known
        if known != known:
            self.program.needs({key})
        doubtful = key in self.program.dropped - self.program.settled.needed
        if known == DOUBTFUL or (arithmetic.owns(key) and doubtful):
            long = math.isfinite(known)
            why = "has more digits than a message takes" if long else "is not known here"
            message = f"{written(key)}, which this message prints, {why}"
            raise NoValueError(message, code="GX220")
        return None
