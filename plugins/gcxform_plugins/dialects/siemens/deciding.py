"""What decides in a program for a SINUMERIK where it goes on: structures and jumps.

Where only the machine knows it, all that it may execute is kept as it stands.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, NoReturn

from lark import Token, Tree

from gcxform import vocabulary as v
from gcxform_plugins.dialects.siemens.cells import LOST, Value, converted
from gcxform_plugins.dialects.siemens.expressions import PARAMETER, lost
from gcxform_plugins.dialects.siemens.nodes import Node, rule_of, span_of
from gcxform_plugins.dialects.siemens.structure import HEAD, Part, StructureError, code
from gcxform_plugins.dialects.siemens.variables import Variables

REPEATS = "section-repeats"
REPEAT_HINT = (
    f'{REPEATS} = "further" in [control], or {REPEATS} = "in-all" in [control], as it counts P'
)
PLAINLY = "let the CAM write plain moves in its place"
MOST = 9999  # times that one REPEAT may ask for


class Deciding(Variables):
    """Executes what decides.

    kept_until   lines up to this one are kept: only the machine decides on them, `kept_why`
    perhaps      those that are kept may be executed, and nothing else is done among them
    decides      something has decided where to go on;  loops_on: a loop may go on at its end
    repeating    of each REPEAT of a label that is under way, how often it goes back yet
    """

    def __init__(self, lines: list[str], file: str, dialect: Any, reading: Any) -> None:
        super().__init__(lines, file, dialect, reading)
        self.counting: dict[int, float] = {}
        self.repeating: dict[int, float] = {}
        self.kept_until, self.kept_why = 0, ""
        self.decides = self.loops_on = self.perhaps = False
        self.flow: Mapping[str, Callable[[Node], None]] = {
            "if": self._if,
            "loop": lambda _: self._check(self._part()),
            "endif": lambda _: self._check(self._part()),
            "else": lambda _: self._go(self._part().last + 1),
            "while": self._while,
            "endwhile": lambda _: self._go(self._part().first),
            "for": self._for,
            "endfor": lambda _: self._next(),
            "endloop": lambda _: self._go(self._part().first),
            "until": self._until,
            "repeat": self._repeat,
            "jump": lambda node: self._jump(str(node.children[0]), node.children[1]),
            "case": self._case,
            "def": self._def,
            "proc": self._proc,
            "return": self._return,
        }

    @cached_property
    def grammar_of_expressions(self) -> Any:
        """The grammar of lines that compute."""
        return self.grammar_named("gcxform_grammars", "siemens_computed")

    # --- structures ---

    def tree_of(self, text: str) -> Any:
        """Return the tree of a line that computes. Raises UnexpectedInput."""
        return self.grammar_of_expressions.parse(text)

    def _part(self) -> Part:
        part = self.structure.at.get(self.line)
        if part is None:
            raise StructureError(self.line, "this belongs to no structure")
        return part

    def part_here(self) -> Part | None:
        """Return the structure that the line begins or ends, if it does. Raises InputError."""
        try:
            return self.structure.at.get(self.line)
        except StructureError as why:
            self.line = why.line
            raise self.refusal("GX223", why.message) from None

    def _skips(self, items: Any) -> bool:
        """Whether the line is skipped. Raises InputError for half a structure that is."""
        skipped = super()._skips(items)
        if skipped and any(i.kind == "flow" for i in items) and self.part_here() is not None:
            self.refuse("what of a structure is executed of which this line is skipped", items[0])
        return skipped

    def _check(self, part: Part) -> None:
        """Take a line that only begins or ends a structure."""

    def _go(self, line: int) -> None:
        self.at = line

    def _decided(self, node: Any) -> bool | None:
        """Return whether a condition holds; None where only the control knows."""
        try:
            value = self.worth.of(node)
        except v.NoValueError as why:
            if not why.lost or not self.reading.stays:
                raise
            return None
        return bool(value)

    def _if(self, node: Node) -> None:
        if len(node.children) == 2:
            self._if_structure(node.children[1])
            return
        parts = node.children
        for k in range(0, len(parts), 4):
            holds = self._decided(parts[k + 1])
            if holds is None:
                self._undecided(None)
                return
            if holds:
                self._jump(str(parts[k + 2]), parts[k + 3])
                return

    def _if_structure(self, condition: Any) -> None:
        part, holds = self._part(), self._decided(condition)
        if holds is None:
            self._undecided(part)
        elif not holds:
            self._go((part.last if part.other < 0 else part.other) + 1)

    def _while(self, node: Node) -> None:
        part, holds = self._part(), self._decided(node.children[1])
        if holds is None:
            self._undecided(part)
        elif not holds:
            self._go(part.last + 1)

    def _for(self, node: Node) -> None:
        _, name, first, _, last = node.children
        part = self._part()
        try:
            start, end = self.worth.number(first), self.worth.number(last)
        except v.NoValueError as why:
            if not why.lost or not self.reading.stays:
                raise
            self._undecided(part)
            return
        self._count(str(name).upper(), start)
        self.counting[part.first] = end
        if start > end:
            self._leave_for(part, str(name).upper())

    def _count(self, name: str, value: Value) -> None:
        if PARAMETER.fullmatch(name):
            self.r[int(name[1:])] = value
            return
        cell = self._cell(name)
        if cell is None or cell.size or cell.kind not in ("INT", "REAL"):
            self.refuse(f"FOR counts in {name}, which is no INT or REAL of the program")
        cell.values[0] = converted(cell.kind, value)

    def _next(self) -> None:
        """Count on at ENDFOR, and go back or on."""
        part = self._part()
        head = self.tree_of(self.lines[part.first]).children[-1]
        _, name, _, _, last = head.children
        upper = str(name).upper()
        end = self.counting[part.first]
        if self.worth.number(last) != end:
            raise v.NoValueError("the end of FOR changes in its loop: which holds is not known")
        cell = self._cell(upper)
        value = cell.values[0] if cell is not None else self.r.get(int(upper[1:]), LOST)
        if not isinstance(value, float):
            raise lost(f"the value of {upper}")
        self._count(upper, value + 1)
        if value + 1 <= end:
            self._go(part.first + 1)
        else:
            self._leave_for(part, upper)

    def _leave_for(self, part: Part, name: str) -> None:
        """Go on behind a loop that counts; what its variable is worth there no manual says."""
        self._count(name, LOST)
        self._go(part.last + 1)

    def _until(self, node: Node) -> None:
        part, holds = self._part(), self._decided(node.children[1])
        if holds is None:
            self.again |= {*range(part.first, part.last + 1)}
            self.forget(range(part.first, part.last + 1))
            self.loops_on = True
            raise lost("whether this loop is over")
        if not holds:
            self._go(part.first)

    def _repeat(self, node: Node) -> None:
        """Take REPEAT of UNTIL, and go back to the label of another as often as its P says."""
        if len(node.children) == 1:
            self._check(self._part())
            return
        counts = self.reading.control.get(REPEATS)
        if counts is None:
            self._elsewhere("how often REPEAT executes a section is said by no manual", REPEAT_HINT)
        first = self._section(node)
        if self.line not in self.repeating:
            self.repeating[self.line] = self._times(node) - (counts != "further")
        if self.repeating[self.line] > 0:
            self.repeating[self.line] -= 1
            self._go(first)
        else:
            del self.repeating[self.line]

    def _section(self, node: Node) -> int:
        """Return the first line of what a REPEAT repeats: up to its own, with nothing that leaves.

        Raises InputError, StructureError.
        """
        word, name, *others = node.children
        text = code(self.lines[self.line]).rstrip()
        only = HEAD.match(text)
        alone = only is not None and (only["word"] or "").upper() == "REPEAT"
        if str(word).upper() != "REPEAT" or not isinstance(name, Token) or not alone:
            self._elsewhere("of the ways of REPEAT the one with a label before it is followed")
        if len(text) > span_of(node)[1] or any(isinstance(each, Token) for each in others):
            self._elsewhere("of the ways of REPEAT the one with a label before it is followed")
        (first, *more) = (*self.structure.places(str(name)), len(self.lines))
        if first >= self.line or len(more) > 1:
            self._elsewhere(f"there is no {name} before this REPEAT, or several")
        if not self.structure.is_whole(first, self.line):
            self._elsewhere("a section that is repeated, and left or entered on the way")
        return first

    def _times(self, node: Node) -> float:
        """Return what P of a REPEAT says. Raises InputError, NoValueError."""
        nodes: list[Any] = node.children
        said = next((each for each in nodes if rule_of(each) == "times"), None)
        if said is None and self.reading.control.get(REPEATS) != "further":
            self._elsewhere(
                "REPEAT without P, which may be once more or once in all", "write its P"
            )
        number = 1.0 if said is None else self._whole(said.children[-1], "P")
        if not 1 <= number <= MOST:
            self.refuse(f"REPEAT for {number:g} times")
        return number

    def _jump(self, way: str, destination: Any) -> None:
        """Go to a label or a block number."""
        way = way.upper()
        child = destination.children[0]
        if isinstance(child, Tree) and rule_of(child) == "variable" and len(child.children) == 1:
            name = str(child.children[0])
            if self._cell(name) is not None:
                name = self.worth.text(self.worth.of(child))
        elif isinstance(child, Token):
            name = str(child).translate({32: None, 9: None})
            name = name.strip('"')
        else:
            name = self.worth.text(self.worth.of(child))
        if way == "GOTOS":
            self._elsewhere("GOTOS goes to the start only where the PLC asks for it")
            return
        line = self.structure.target(way, name, self.line)
        if line is None and way != "GOTOC":
            raise self.refusal("GX223", f"there is no {name} that {way} leads to")
        if line is not None:
            self._go(line)

    def _case(self, node: Node) -> None:
        parts = [c for c in node.children if not (isinstance(c, Token) and c.type.endswith("CASE"))]
        value = self._whole(parts[0], "CASE")
        for each in parts[1:]:
            if isinstance(each, Tree) and rule_of(each) == "choice":
                if self._whole(each.children[0], "CASE") == value:
                    self._jump(str(each.children[1]), each.children[2])
                    return
            elif isinstance(each, Tree) and rule_of(each) == "destination":
                self._jump(str(parts[parts.index(each) - 1]), each)
                return

    def _whole(self, node: Any, what: str) -> float:
        """Return a number that is whole. Raises NoValueError for what would be rounded."""
        value = self.worth.number(node)
        if value != int(value):
            raise v.NoValueError(f"{what} of a number that is not whole", "write ROUND(...)")
        return value

    def _return(self, node: Node) -> None:
        """Leave the program that nothing has called."""
        if len(node.children) > 1:
            self._elsewhere("RET(...) goes on where the caller says")
            return
        if not self.calls and self.reading.crosses:
            self.refuse("RET returns to a program that is not here")
        self.at = self.part.stop if self.calls else len(self.lines)

    # --- what only the machine decides ---

    def _undecided(self, part: Part | None) -> None:
        """Keep what only the control decides on: a structure, what is jumped over, or the rest."""
        first, last = (self.line, self.line) if part is None else (part.first, part.last)
        self.keep_perhaps(first, last)
        self.refuse(self.kept_why)

    def keep_perhaps(self, first: int, last: int) -> None:
        """Keep lines that may be executed, and all that a jump among them leads over.

        Where they lead back, what was read already may be executed again: it stays, too.
        """
        where = self.structure.reach(first, last, bool(self.calls), self._is_text)
        if where is None:
            self.keep_rest("only the control knows where this goes on")
            return
        self.keep_on(where.stop, "only the control knows whether this is executed")
        self.perhaps = True
        if where.start < first:
            self.again |= {*where}
            self.forget(range(where.start, first))

    def _is_text(self, name: str) -> bool:
        """Whether a jump to a name leads to what a variable says."""
        return self._cell(name) is not None

    def forget(self, lines: range) -> None:
        """Forget what lines may change that are executed again."""
        raise NotImplementedError

    def _elsewhere(self, why: str, hint: str = PLAINLY) -> NoReturn:
        """Keep all that follows, and all lines that may be executed once more."""
        if self.reading.stays:
            self.keep_rest(why)
        self.refuse(why, None, hint)

    def keep_rest(self, why: str) -> None:
        """Keep all that follows; and lines before, where it may lead back to them.

        In a subprogram, which is not written, only what it has done is not known behind it.
        """
        self.keep_on(self.part.stop, why)
        try:
            back = self.structure.may_go_back(self.line)
        except StructureError:
            back = True
        if back and not self.calls:
            self.again |= {*range(self.line)}

    def keep_on(self, until: int, why: str) -> None:
        """Keep lines from this one up to another."""
        self.kept_until, self.kept_why, self.perhaps = until, why, False
