"""What the lines of an outline compute, as functions: made once, and kept with the meanings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gcxform.dialect.arithmetic import Arithmetic, Key, NoValueError, whole
from gcxform.modal.expressions.compiled import Compiled, Compiler, NoColumnError, Operands
from gcxform.modal.expressions.value import Parameters, parameter_of, settable
from gcxform.modal.meaning.meaning import Meaning
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.syntax.tree import CODES, Block, Expression, Statement, Word


@dataclass(frozen=True, slots=True)
class Functions:
    """The words of an outline that are computed, by slot, and the parameters that it sets.

    `slots` is how many slots its lines have.
    """

    slots: int
    words: tuple[tuple[int, Compiled], ...]
    assigned: tuple[tuple[Key, Compiled], ...]


def computed_in(block: Block) -> tuple[list[tuple[int, Word]], list[Statement]]:
    """Return the words of a block that are expressions, by slot, and its assignments."""
    words = [word for word in block.words if word.address not in CODES]
    computed = [(k, word) for k, word in enumerate(words) if isinstance(word.value, Expression)]
    return computed, [item for item in block.items if isinstance(item, Statement)]


def functions_of(table: MeaningTable, shape: int) -> Functions | None:
    """Return the functions of a shape; None where its lines have to be computed one by one."""
    if shape not in table.functions:
        table.functions[shape] = _made(table, shape)
    found: Functions | None = table.functions[shape]
    return found


def _made(table: MeaningTable, shape: int) -> Functions | None:
    arithmetic, layout = table.dialect.flow_rule.arithmetic, table.shapes.shapes[shape].layout
    meaning = table.meanings[shape]
    if arithmetic is None or layout is None or meaning.runs_macro:
        return None
    words = [
        (slot, _word(word, meaning, arithmetic, layout.slot_of))
        for slot, word in meaning.expressions
    ]
    compiler = Compiler(arithmetic, layout.slot_of, in_word=False)
    assigned = []
    for statement in meaning.assignments:
        parameter, expression = statement.tree.children
        key = parameter_of(parameter)
        try:
            if key is None or (isinstance(key, str) and not arithmetic.named):
                return None
            assigned.append((settable(arithmetic, key), compiler.compiled(expression)))
        except NoValueError:
            return None
    return Functions(len(layout), tuple(words), tuple(assigned))


def _word(
    word: Word, meaning: Meaning, arithmetic: Arithmetic, slot_of: dict[tuple[int, int], int]
) -> Compiled:
    """Return the function of the value of a word."""
    assert isinstance(word.value, Expression)
    value = Compiler(arithmetic, slot_of, in_word=True).compiled(word.value.tree)
    if word.address not in arithmetic.whole or meaning.is_length(word.address):
        return value

    def rounded(parameters: Parameters, operands: Operands) -> Any:
        found = value(parameters, operands)
        try:
            if isinstance(found, np.ndarray):
                slip = arithmetic.whole_slip
                return np.array([float(whole(each, slip)) for each in found.tolist()])
            return float(whole(found, arithmetic.whole_slip))
        except NoValueError:
            raise NoColumnError from None

    return rounded
