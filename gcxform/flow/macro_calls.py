"""Calls with values: G65 makes new local variables, and M99 gives the caller its own back.

They are null but for those that the call gives (Fanuc 16i B-63684EN p. 278). On a Haas the
repetitions of L keep what the first has done to them (96-8000 p. 93); of a Fanuc that is not known,
so that a setting says it.
"""

from __future__ import annotations

from gcxform.dialect.arithmetic import MACRO_B, Key
from gcxform.dialect.null import NULL
from gcxform.flow.detection import aliases
from gcxform.flow.listing import code_name
from gcxform.flow.macro_arguments import arguments
from gcxform.flow.run_state import Call, RunState, differs
from gcxform.modal.expressions.value import DOUBTFUL
from gcxform.syntax.tree import Word

LOCALS = MACRO_B.local
LOCALS_AT_START, REPEATS = "local-variables", "macro-repeat"
BY = " by "
T_VALUE = 149
"""The variable that has the value of a T that calls (6001#5, executor B-62093E-1 p. 32)."""
NO_VALUES = "PL"
"""Addresses of a call that give no values: what is called, and how often."""


class ValueCalls:
    """The calls with values of a program that runs."""

    def __init__(self, run: RunState) -> None:
        self.run = run
        self.levels = run.dialect.flow_rule.macro_levels
        self.aliases = aliases(run.reading.control)
        if run.reading.control.get(LOCALS_AT_START) == "null":
            run.parameters = fresh(run.parameters)

    def made_by(self, name: str, words: list[Word], times: int, back: int) -> Call:
        """Return the call that words make. Raises InputError for more of them than may be open."""
        for word in words:
            if word.address in NO_VALUES and [w.address for w in words].count(word.address) > 1:
                place = (word.start, word.end)
                raise self.run.refusal("GX203", f"{word.address} stands here twice", place=place)
        given = arguments(self.run, [w for w in words if w.address not in NO_VALUES])
        return self.with_values(name, given, times, back)

    def with_values(self, name: str, given: dict[Key, float], times: int, back: int) -> Call:
        """Return a call that is given values. Raises InputError for more than may be open."""
        self._refuse_deeper(name)
        before = {k: v for k, v in self.run.parameters.items() if k in LOCALS}
        return Call(name, back, times=times, locals=before, given=given)

    def _refuse_deeper(self, name: str) -> None:
        if sum(call.given is not None for call in self.run.calls) >= self.levels:
            message = f"{name}: {self.levels} calls with values are inside each other"
            raise self.run.refusal("GX224", message)

    def alias(self, words: list[Word]) -> tuple[str, int] | None:
        """Return a code of a block that calls a program, as the machine file says, and its number.

        Raises InputError where it does not begin its block, and where the same kind of code is
        open: whether it calls again there is a setting of some controls.
        """
        for nth, word in enumerate(words):
            name = code_name(word)
            if name not in self.aliases:
                continue
            inside = any(call.name.rpartition(BY)[2] in self.aliases for call in self.run.calls)
            if nth or inside:
                what = "behind other words" if nth else "inside a program that such a code calls"
                place = (word.start, word.end)
                raise self.run.refusal(
                    "GX210", f"what {name} does {what} is not certain", "", place
                )
            return name, self.aliases[name]
        return None

    def shares(self, name: str) -> bool:
        """Whether a code calls a program that has the variables of its caller."""
        return f"shared {name}" in self.run.reading.control

    def give(self, call: Call) -> None:
        """Make the variables of a call."""
        self.run.parameters |= fresh(call.given or {})
        self.run.changes += 1

    def take_back(self, call: Call) -> None:
        """Give the caller its variables back."""
        kept = {k: v for k, v in self.run.parameters.items() if k not in LOCALS}
        self.run.parameters = kept | call.locals

    def again(self, call: Call) -> None:
        """Begin another repetition: what the one before has changed may have no known value."""
        said = self.run.reading.control.get(REPEATS)
        keeps = self.run.dialect.flow_rule.repeats_keep if said is None else said == "keep"
        if call.given is None or keeps:
            return
        first = fresh(call.given)
        changed = [k for k, v in first.items() if differs(self.run.parameters.get(k), v)]
        self.run.parameters |= first if said else dict.fromkeys(changed, DOUBTFUL)


def fresh(given: dict[Key, float]) -> dict[Key, float]:
    """Return the local variables of a call: null but for those that are given."""
    return {**dict.fromkeys(LOCALS, NULL), **given}
