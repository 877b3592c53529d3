"""The values that G65 and its relatives give to the variables of what they call.

List I has a variable for each letter (Fanuc 16i B-63684EN p. 278, Haas 96-8000 p. 93). List II has
A, B, C once and up to ten sets of I, J, K; a letter again, or out of the order of the alphabet,
opens the next set. A parameter of a Fanuc (6008#7) takes list II away, so that a program whose
meaning hangs on it is refused until `argument-list` says which list it is. What is written later
wins.
"""

from __future__ import annotations

from gcxform.dialect.arithmetic import Key
from gcxform.dialect.dialect import ROTARY
from gcxform.dialect.null import as_argument
from gcxform.flow.run_state import RunState
from gcxform.modal.numbers_without_point import hint_of_argument
from gcxform.syntax.tree import Expression, Word

NUMBERS = {
    **{letter: 1 + n for n, letter in enumerate("ABCIJKDEF")},
    **{letter: 11 + n for n, letter in enumerate("H?MNOPQRSTUVWXYZ") if letter not in "?NOP"},
}
"""The variable of each letter in list I."""
SETS = "IJK"
MOST_SETS = 10
COUNTS = "DHMST"
"""Letters whose values are whole numbers: their increment is 1."""
LISTS = "argument-list"
HOW_LISTS = (
    'argument-list = "II" in [control] of the machine file if parameter 6008#7 is 0, '
    'argument-list = "I" in [control] if it is 1'
)


def arguments(run: RunState, words: list[Word]) -> dict[Key, float]:
    """Return the variables that the words of a call set, with their values. Raises InputError."""
    found: dict[Key, float] = {}
    places: dict[int, str] = {}
    seen: set[str] = set()
    opened, last = 1, ""
    for word in words:
        letter = word.address
        if letter not in NUMBERS:
            place = (word.start, word.end)
            raise run.refusal("GX203", f"{letter} gives no value to a macro", place=place)
        if letter in SETS:
            if last and letter <= last:
                opened += _next_set(run, word)
            last = letter
        elif letter in seen:
            raise run.refusal("GX203", f"{letter} stands here twice", place=(word.start, word.end))
        seen.add(letter)
        number = NUMBERS[letter] + (3 * (opened - 1) if letter in SETS else 0)
        if number in places:
            taken = f"{places[number]} and {letter} are both #{number}: the later one counts"
            run.assumed[taken] = None
        places[number] = letter
        found[number] = _value(run, word)
    return found


def _next_set(run: RunState, word: Word) -> int:
    """Return 1 if a word opens the next set of list II, 0 if there is list I alone."""
    said = run.reading.control.get(LISTS) or run.dialect.flow_rule.argument_list
    if not said:
        message = f"{word.address} opens a second set of arguments, or replaces the first"
        raise run.refusal("GX210", message, HOW_LISTS, (word.start, word.end))
    return int(said == "II")


def _value(run: RunState, word: Word) -> float:
    """Return the value of an argument; one without a point counts increments of its letter."""
    if isinstance(word.value, Expression):
        return as_argument(run.value(word.value.tree))
    value, letter = word.value.value, word.address
    if word.value.decimals >= 0 or value == 0 or letter in COUNTS:
        return value
    if not run.dialect.point_rule.required:
        return value
    inch, said = run.in_inch(), run.reading.increments
    steps = None if said is None or letter in "EF" or said.calculator else _steps(run, letter)
    if steps is None:
        message = f"{letter} has no decimal point: what it counts depends on the control"
        hint = hint_of_argument(letter, inch) if said is None and letter not in "EF" else ""
        place = (word.start, word.end)
        raise run.refusal("GX205", message, hint or "write it with a point", place)
    return value / steps


def _steps(run: RunState, letter: str) -> float | None:
    """Return how many increments of a letter are 1 of its unit; None where that is not known."""
    said = run.reading.increments
    assert said is not None
    return said.per_unit(letter if letter in ROTARY else "X", run.in_inch())
