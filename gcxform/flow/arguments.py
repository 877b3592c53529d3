"""The arguments of a subprogram by itself: the parameters of its call that nobody says."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from gcxform.diagnostics import InputError, Location
from gcxform.dialect.arithmetic import Key
from gcxform.dialect.dialect import Dialect
from gcxform.modal.expressions.value import parameter_key, parameter_of, parameters_in
from gcxform.syntax.source import Source
from gcxform.syntax.tree import Block, Expression, Statement, Word

OPEN_BY = frozenset({"GX220", "GX311"})
"""What a value that is not known leads to, where it is read or behind that."""


def asked(why: InputError, source: Source, dialect: type[Dialect], said: Iterable[str]) -> None:
    """Raise InputError for an argument that a refusal comes from; `said` are those with values."""
    first = why.diagnostics[0]
    if first.code not in OPEN_BY or first.where is None or first.where.file != source.name:
        return
    lines = b"".join(source.windows()).splitlines(keepends=True)
    if found := dict(unsaid(lines[: first.where.line], dialect, said)):
        raise unknown(source.name, lines, found) from why


def unknown(
    name: str, lines: Sequence[bytes], found: Mapping[int, int], more: str = ""
) -> InputError:
    """Return the error about arguments, each with its first line, from 0; `more` is its hint's."""
    line = min(found.values())
    text = lines[line].rstrip(b"\r\n").decode("latin-1")
    where = Location(name, line + 1, text=text, width=max(1, len(text)))
    values = ", ".join(f'"{key}" = ...' for key in sorted(found))
    names = ", ".join(f"#{key}" for key in sorted(found))
    message = f"what its call gives as {names} is not said"
    hint = f"parameters = {{ {values} }} in [entry]{more}"
    return InputError.one("GX228", message, where, hint)


def unsaid(
    lines: Sequence[bytes], dialect: type[Dialect], said: Iterable[str]
) -> Iterator[tuple[int, int]]:
    """Yield the numbered parameters of a call that lines read, each once, with its first line.

    These are those that are not said, and that no line before sets.
    """
    arithmetic, known = dialect.flow_rule.arithmetic, set(map(parameter_key, said))
    for line, text in enumerate(lines):
        if b"#" in text and arithmetic is not None:
            block = dialect.load_grammar().parse(text.rstrip(b"\r\n").decode("latin-1"))
            read, made = _named(block)
            numbers = sorted(key for key in read - known if isinstance(key, int) and key)
            yield from ((key, line) for key in numbers if not arithmetic.outlives(key))
            known |= read | made


def _named(block: Block) -> tuple[set[Key], set[Key]]:
    """Return the parameters that a block reads, and those that it sets."""
    read, made = set[Key](), set[Key]()
    for item in block.items:
        if isinstance(item, Word) and isinstance(item.value, Expression):
            read.update(parameters_in(item.value.tree))
        elif isinstance(item, Statement) and item.kind == "assignment":
            target, value = item.tree.children
            key = parameter_of(target)
            read.update(parameters_in(value), () if key is not None else parameters_in(target))
            made.update(() if key is None else (key,))
        elif isinstance(item, Statement):
            read.update(parameters_in(item.tree))
    return read, made
