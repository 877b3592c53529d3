"""What the lines of an outline compute, as functions: made once, and kept with the meanings."""

from __future__ import annotations

from typing import Any

import numpy as np

from gcxform.dialect.arithmetic import Key, NoValueError, whole
from gcxform.modal.expressions.compiled import (
    NO_VALUE,
    Compiled,
    Compiler,
    NoColumnError,
    Operands,
    Parameters,
)
from gcxform.modal.expressions.value import parameter_of, settable
from gcxform.modal.meaning.meaning import Meaning
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.syntax.tree import CODES, Block, Expression, Statement, Word
from gcxform.system.arrays import Floats, Ints
from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class Functions:
    """The words of an outline that are computed, by slot, and the parameters that it sets.

    `slots` is how many slots its lines have; `columns` are the words for many lines at once, and
    `assigned_columns` the parameters.
    """

    slots: int
    words: tuple[tuple[int, Compiled], ...]
    columns: tuple[tuple[int, Compiled], ...]
    assigned: tuple[tuple[Key, Compiled], ...]
    assigned_columns: tuple[tuple[Key, Compiled], ...]


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


def whole_columns(
    functions: Functions | None, parameters: Parameters, value: Floats, first: Ints
) -> list[tuple[int, Any]]:
    """Return the values of the words of lines of one outline, by slot.

    `value` are number columns, `first` (n,) is the first number of each line. Raises NoColumnError.
    """
    if functions is None:
        raise NoColumnError
    operands = [value[first + slot] for slot in range(functions.slots)]
    try:
        found = [(slot, word(parameters, operands)) for slot, word in functions.columns]
    except NO_VALUE:
        raise NoColumnError from None
    if not all(np.isfinite(computed).all() for _, computed in found):
        raise NoColumnError
    return found


def _made(table: MeaningTable, shape: int) -> Functions | None:
    arithmetic, layout = table.dialect.flow_rule.arithmetic, table.shapes.shapes[shape].layout
    meaning = table.meanings[shape]
    if arithmetic is None or layout is None or meaning.runs_macro:
        return None
    first = iter(layout.operands)
    words, columns = [], []
    for slot, word in meaning.expressions:
        operand = next(first)
        words.append((slot, _word(word, meaning, Compiler(arithmetic, operand, in_word=True))))
        many = Compiler(arithmetic, operand, in_word=True, columns=True)
        columns.append((slot, _word(word, meaning, many)))
    assigned, many_assigned = [], []
    for statement in meaning.assignments:
        operand = next(first)
        compiler = Compiler(arithmetic, operand, in_word=False)
        many = Compiler(arithmetic, operand, in_word=False, columns=True)
        parameter, expression = statement.tree.children
        key = parameter_of(parameter)
        try:
            if key is None or (isinstance(key, str) and not arithmetic.named):
                return None
            key = settable(arithmetic, arithmetic.cell(key))
            assigned.append((key, compiler.compiled(expression)))
            many_assigned.append((key, many.compiled(expression)))
        except NoValueError:
            return None
    made = tuple(words), tuple(columns), tuple(assigned), tuple(many_assigned)
    return Functions(len(layout), *made)


def _word(word: Word, meaning: Meaning, compiler: Compiler) -> Compiled:
    """Return the function of the value of a word."""
    assert isinstance(word.value, Expression)
    value, arithmetic = compiler.compiled(word.value.tree), compiler.arithmetic
    if word.address not in arithmetic.whole or meaning.is_length(word.address):
        return value
    slip = arithmetic.whole_slip
    if not compiler.columns:
        return lambda parameters, operands: float(whole(value(parameters, operands), slip))

    def rounded(parameters: Parameters, operands: Operands) -> Any:
        found = np.atleast_1d(value(parameters, operands))
        return np.array([float(whole(each, slip)) for each in found.tolist()])

    return rounded
