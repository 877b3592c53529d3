"""What the lines of a loop do in every round, made once: functions, steps, and the text."""

from __future__ import annotations

import operator
from dataclasses import field
from typing import Any

import numpy as np
from lark import Token

from gcxform.dialect.arithmetic import Arithmetic, Key, whole
from gcxform.flow.execution import Execution
from gcxform.flow.listing import bare, code_name, decides
from gcxform.flow.run_state import computed
from gcxform.modal.expressions.compiled import Compiled, Compiler, NoColumnError
from gcxform.modal.expressions.value import parameter_of, settable
from gcxform.syntax.grammar import rule_of
from gcxform.syntax.tree import Block, Comment, Statement, Word
from gcxform.system.arrays import Ints
from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class Repeated:
    """What is repeated: lines from `begin` to `last`, of which `flow` only decide.

    It goes on while `condition` is not 0: `behind` the other lines or before them; None: always.
    """

    begin: int
    last: int
    flow: frozenset[int]
    condition: Any = None
    behind: bool = False


@dataclass(frozen=True, slots=True)
class Put:
    """A parameter that a line sets: how it is computed, and what is added to it where it is."""

    line: int
    key: Key
    value: Compiled
    added: tuple[Compiled, float] | None
    place: tuple[int, int]


@dataclass(slots=True)
class Body:
    """What the lines of a loop do in every round.

    steps   (s, 5) steps of a round, whose blocks count from 0
    blocks  the lines of the blocks of a round
    words   what is computed in words: line, word, function
    puts    the assignments in order
    parts   the text of a round: pieces, words and assignments, by their number
    """

    steps: Ints
    blocks: list[int]
    special: int
    condition: Compiled | None
    words: list[tuple[int, Word, Compiled]] = field(default_factory=list)
    puts: list[Put] = field(default_factory=list)
    parts: list[str | Word | Put] = field(default_factory=list)


def made(run: Execution, loop: Repeated) -> Body:
    """Return the body of a loop. Raises NoColumnError."""
    condition = None
    if loop.condition is not None:
        condition = _function(run.conditions, loop.condition)
    lines = range(loop.begin, loop.last + 1)
    special = set(run.listing.special.tolist()).intersection(lines)
    body = Body(np.empty((0, 5), np.int64), [], len(special), condition)
    steps: list[tuple[int, int, int, int, int]] = []
    line = loop.begin
    while line <= loop.last:
        stop = line + 1
        while line not in special and stop <= loop.last and stop not in special:
            stop += 1
        steps.append((line, stop, len(body.blocks), 0, 0))
        if line not in special:
            body.blocks += range(line, stop)
            body.parts.append(run.listing.raw(line, stop).decode("latin-1"))
        elif line not in loop.flow:
            _add(run, body, line)
        line = stop
    _check(run, body, lines)
    body.steps = np.array(steps, np.int64)
    return body


def _check(run: Execution, body: Body, lines: range) -> None:
    """Raise NoColumnError for units that change, and parameters that are set in two places."""
    keys = [put.key for put in body.puts]
    if (run.listing.units[lines.start : lines.stop] >= 0).any() or len(keys) != len(set(keys)):
        raise NoColumnError


def _add(run: Execution, body: Body, line: int) -> None:
    """Add a line that computes something. Raises NoColumnError where it may do anything else."""
    block = run.listing.block(line)
    if not _is_simple(run, line, block):
        raise NoColumnError
    edits: list[tuple[int, int, str | Word | Put]] = []
    for item in block.items:
        if isinstance(item, Word) and computed(item):
            function = _of_word(run, line, item)
            body.words.append((line, item, function))
            edits.append((item.value.start, item.end, item))
        elif isinstance(item, Statement):
            put = _put(run.arithmetic, line, item)
            body.puts.append(put)
            edits.append((item.start, item.end, put if run.lasting.says(put.key) else ""))
    _spell(run, body, block, line, edits)


def _is_simple(run: Execution, line: int, block: Block) -> bool:
    """Whether a line computes words and sets parameters, and nothing else."""
    listing, meaning = run.listing, run.listing.meaning(line)
    odd = meaning.refusal or meaning.runs_macro or meaning.ends or meaning.percent or meaning.call
    if block.error is not None or odd or run.decides(line):
        return False
    if run.dialect.text_rule.lone_cr_is_blank and listing.line_end(line) == b"\r":
        return False
    return not any(_is_odd(run, block, item) for item in block.items)


def _is_odd(run: Execution, block: Block, item: Any) -> bool:
    if isinstance(item, Statement):
        return item.kind != "assignment"
    if isinstance(item, Comment):
        return run.dialect.text_rule.executes(block.text[item.start : item.end])
    if not isinstance(item, Word):
        return True
    if computed(item):
        return item.address in "GMNO@^"
    return decides(item) or code_name(item) in run.listing.codes


def _spell(
    run: Execution,
    body: Body,
    block: Block,
    line: int,
    edits: list[tuple[int, int, str | Word | Put]],
) -> None:
    """Add the text of a line, if it is written: see `Execution.write`."""
    words = any(isinstance(item, Word) for item in bare(block))
    if not words and not any(new for _, _, new in edits):
        return
    if not any(isinstance(new, Word) or not new for _, _, new in edits):
        raise NoColumnError  # it may stay as it stands, with the blanks at its end
    at, parts = 0, list[str | Word | Put]()
    for start, end, new in sorted(edits, key=lambda edit: edit[0]):
        parts += [block.text[at:start], new]
        at = end
    parts.append(block.text[at:])
    while isinstance(last := parts[-1], str) and not last.rstrip():
        parts.pop()
    if isinstance(last, str):
        parts[-1] = last.rstrip()
    body.parts += [*parts, run.listing.line_end(line).decode("latin-1")]
    body.blocks.append(line)


def _of_word(run: Execution, line: int, word: Word) -> Compiled:
    """Return the function of a word, for columns."""
    value = _function(run.arithmetic, word.value.tree, in_word=True)  # type: ignore[union-attr]
    if word.address not in run.arithmetic.whole or run.listing.meaning(line).is_length(
        word.address
    ):
        return value
    slip = run.arithmetic.whole_slip

    def rounded(parameters: Any, operands: Any) -> Any:
        found = np.atleast_1d(value(parameters, operands))
        return np.array([float(whole(each, slip)) for each in found.tolist()])

    return rounded


def _function(arithmetic: Arithmetic, node: Any, in_word: bool = False) -> Compiled:
    return Compiler(arithmetic, None, in_word, columns=True).compiled(node)


def _put(arithmetic: Arithmetic, line: int, statement: Statement) -> Put:
    parameter, expression = statement.tree.children
    named = parameter_of(parameter)
    key = named if named is None else arithmetic.cell(named)
    if key is None or (isinstance(key, str) and not arithmetic.named) or not arithmetic.owns(key):
        raise NoColumnError
    added = _added(arithmetic, settable(arithmetic, key), expression)
    place = statement.start, statement.end
    return Put(line, key, _function(arithmetic, expression), added, place)


def _added(arithmetic: Arithmetic, key: Key, node: Any) -> tuple[Compiled, float] | None:
    """Return what an expression adds to a parameter, with its sign; None where it does not."""
    while not isinstance(node, Token) and rule_of(node) == "bracketed":
        node = node.children[0]
    if (
        isinstance(node, Token)
        or len(node.children) != 3
        or rule_of(node) in ("call", "arctangent")
    ):
        return None
    left, name, right = node.children
    function = arithmetic.operators.get(str(name).upper())
    if function is operator.add and _is(key, left):
        return _function(arithmetic, right), 1.0
    if function is operator.add and _is(key, right):
        return _function(arithmetic, left), 1.0
    if function is operator.sub and _is(key, left):
        return _function(arithmetic, right), -1.0
    return None


def _is(key: Key, node: Any) -> bool:
    """Whether a node is a parameter, and that one."""
    return (
        not isinstance(node, Token) and rule_of(node) == "parameter" and parameter_of(node) == key
    )
