"""Which lines with O-words belong together: subprograms, branches and loops, by their labels."""

from __future__ import annotations

from dataclasses import field
from typing import Any

from lark import Token

from gcxform.flow.execution import HINT, Execution
from gcxform.flow.listing import bare
from gcxform.flow.run_state import whole_number
from gcxform.syntax.grammar import is_comment
from gcxform.syntax.tree import BLANKS, Block, Mark, Statement, Word
from gcxform.values import dataclass

ORDERS = {
    "sub": ("sub", "endsub"),
    "if": ("if", "elseif", "else", "endif"),
    "while": ("while", "break", "continue", "endwhile"),
    "do": ("do", "break", "continue", "while"),
    "repeat": ("repeat", "endrepeat"),
}
"""The keywords with the label of each construct: what opens it first, what closes it last."""


@dataclass(frozen=True, slots=True)
class OWord:
    """A line with an O-word: its label, its keyword, the values behind it, and its construct.

    `computed` is the expression that says the number of what is called, where `label` is "".
    """

    label: str
    keyword: str
    values: tuple[Any, ...]
    computed: Any = None


@dataclass(slots=True)
class Construct:
    """The lines with one label that belong together, in order; `kind` is the first keyword."""

    kind: str
    lines: list[int] = field(default_factory=list)

    @property
    def last(self) -> int:
        """The line that closes it."""
        return self.lines[-1]


class Constructs:
    """The O-words of a program of LinuxCNC.

    words      the O-word of each line that has one
    construct  what each of these lines belongs to
    subs       the subprograms, by the first line of their file and their labels
    labels     the lines of numbers that M98 calls
    """

    def __init__(self, program: Execution) -> None:
        self.program = program
        self.words: dict[int, OWord] = {}
        self.construct: dict[int, Construct] = {}
        self.subs: dict[tuple[int, str], Construct] = {}
        self.labels: dict[int, list[int]] = {}
        self.first = 0
        self._arrange()

    def _arrange(self) -> None:
        """Find the constructs of the listing. Raises InputError for what does not fit together."""
        scope = ""
        open_: dict[tuple[str, str], Construct] = {}
        for line in self.program.listing.special.tolist():
            self.program.line = line
            if line in self.program.listing.seams:
                self._refuse_open(open_)
                scope, open_, self.first = "", {}, line + 1
                continue
            block = self.program.listing.block(line)
            items = bare(block) if self.program.stands(block) else []
            if scope.startswith("sub ") and _is_name(block):
                raise self._misfit("the name of a program stands inside a subprogram")
            if len(items) == 1 and isinstance(items[0], Word) and items[0].address == "O":
                number = whole_number(items[0])
                self.labels.setdefault(-1 if number is None else number, []).append(line)
                scope = f"O{number}"
            elif items and isinstance(items[0], Statement) and items[0].kind == "flow":
                word = self._read(items[0])
                self.words[line] = word
                if word.keyword == "return" and not scope.startswith("sub "):
                    raise self._misfit("return outside a subprogram")
                if word.keyword not in ("call", "return"):
                    scope = self._place(line, word, scope, open_)
        self._refuse_open(open_)

    def _refuse_open(self, open_: dict[tuple[str, str], Construct]) -> None:
        """Refuse what is not closed in its file."""
        for (_, label), construct in open_.items():
            if construct.lines and ORDERS[construct.kind][-1] != self._keyword(construct.last):
                self.program.line = construct.lines[0]
                raise self._misfit(f"O{label} {construct.kind} is not closed")

    def _keyword(self, line: int) -> str:
        return self.words[line].keyword

    def _read(self, statement: Statement) -> OWord:
        _, label, keyword, *rest = statement.tree.children
        values = tuple(node for node in rest if not is_comment(node))
        if not isinstance(label, Token) and keyword.type == "CALL":
            return OWord("", "call", values, label)
        if not isinstance(label, Token):
            place = (statement.start, statement.end)
            message = "which label this is must be written: a parameter says it"
            raise self.program.refusal("GX206", message, HINT, place)
        text = str(label).translate(BLANKS).lower()
        name = text[1:-1] if text.startswith("<") else str(int(text))
        return OWord(name, str(keyword).lower(), values)

    def _place(
        self, line: int, word: OWord, scope: str, open_: dict[tuple[str, str], Construct]
    ) -> str:
        """Put a line into its construct; return the scope of the next line."""
        if word.keyword == "sub":
            if scope.startswith("sub "):
                raise self._misfit("a subprogram begins inside another")
            scope = f"sub {word.label}"
        inside = "" if word.keyword in ("sub", "endsub") else scope
        construct = open_.get((inside, word.label))
        if construct is None:
            if word.keyword not in ORDERS:
                raise self._misfit(f"{word.keyword} closes or leaves nothing with this label")
            construct = open_[inside, word.label] = Construct(word.keyword)
            if word.keyword == "sub":
                self.subs[self.first, word.label] = construct
        elif not self._goes_on(construct, word.keyword):
            place = f"{construct.kind} in line {construct.lines[0] + 1}"
            raise self._misfit(f"{word.keyword} does not go with what has this label, {place}")
        construct.lines.append(line)
        self.construct[line] = construct
        return "" if word.keyword == "endsub" else scope

    def _goes_on(self, construct: Construct, keyword: str) -> bool:
        """Whether a keyword may be the next one of a construct."""
        order = ORDERS[construct.kind]
        last = self._keyword(construct.last)
        closed = last == order[-1]
        after_else = last == "else" and keyword != "endif"
        return keyword in order[1:] and not closed and not after_else

    def _misfit(self, message: str) -> Exception:
        return self.program.refusal("GX223", message)


def _is_name(block: Block) -> bool:
    """Whether a line is an O-word with a name and nothing behind it."""
    return any(isinstance(i, Mark) and i.kind == "program_name" for i in block.items)
