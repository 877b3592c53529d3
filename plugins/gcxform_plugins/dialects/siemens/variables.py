"""Variables of a program for a SINUMERIK: how they are defined, set, read and lost.

They live in cells (`cells.py`); what only the control knows is lost, and refused where it decides.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from lark import Token, Tree

from gcxform import vocabulary as v
from gcxform_plugins.dialects.siemens.blocks import Blocks
from gcxform_plugins.dialects.siemens.cells import LOST, Cell, Value, converted
from gcxform_plugins.dialects.siemens.expressions import PARAMETER, Expressions, number_text
from gcxform_plugins.dialects.siemens.nodes import Node, names_in, rule_of, span_of, type_of
from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY
from gcxform_plugins.dialects.siemens.structure import Structure, names_set

WORDS = re.compile(
    r"[XYZABCIJKFSTDM]|[IJK]1|CR|RPL|AR|AP|RP|ANG|TURN|RNDM?|CH[RF]|FRC|ADIS|ADISPOS|CTOL|OTOL|ATOL"
)
UNSET = "what is written sets no R parameter: what runs behind it, or calls it, may not read them"
STAYS: Value = float("nan")
"""What stands in SET(1, , 3) where a value is left out: the element keeps its own."""
QU = "QU"
"""`M=QU(8)` is M8, for which what follows does not wait."""
POSITIONS = frozenset(("$P_EP", "$AA_IW"))
AXES = frozenset(LINEAR + ROTARY)
NAME = re.compile(r"[A-Z_][A-Z0-9_]*", re.IGNORECASE)


@dataclass
class Call:
    """A subprogram that is executed: its lines, the line behind the call, how often it is due.

    saved  what was in force before it, where its PROC says SAVE;  drilling: the cycle of MCALL
    """

    lines: range
    back: int
    times: int = 1
    saved: Any = None
    drilling: Any = None


class Variables(Blocks):
    """Keeps the variables of a program.

    calls    those that are open;  main: the lines of the program that nothing has called
    r        R parameters;  levels: the variables of each call, by name in capitals
    given    variables of the control of which the user says what they are worth: those of all calls
    stopped  STOPRE has been, and nothing has moved since
    """

    def __init__(self, lines: list[str], file: str, dialect: Any, reading: Any) -> None:
        super().__init__(lines, file, dialect, reading)
        values = self.reading.parameters.items()
        self.r: dict[int, Value] = {int(n): float(x) for n, x in values if n.isdigit()}
        self.given = {
            name.strip("<>").upper(): Cell("REAL", (), [float(value)])
            for name, value in values
            if not name.isdigit()
        }
        self.levels: list[dict[str, Cell]] = [{}]
        self.calls: list[Call] = []
        self.main = range(self.own)
        self._structures: dict[int, Structure] = {}
        self.stopped = False
        self.worth = Expressions(self.r, self._cell, self._system)

    @property
    def part(self) -> range:
        """The lines of the file that is executed."""
        return self.calls[-1].lines if self.calls else self.main

    @property
    def structure(self) -> Structure:
        """The structures of the file that is executed. Raises StructureError."""
        part = self.part
        if part.start not in self._structures:
            self._structures[part.start] = Structure(self.lines, part.start, part.stop)
        return self._structures[part.start]

    # --- assignments ---

    def _assignment(self, node: Node, set_names: set[str]) -> Iterator[tuple[int, int, str]]:
        """Make an assignment, or yield the word with its number."""
        target, value = node.children
        assert isinstance(target, Tree)
        name = str(target.children[0]).upper()
        index: Any = target.children[1] if len(target.children) > 1 else None
        if self._is_variable(name, index):
            self._set(name, index, value)
            yield (*span_of(node), "")
            return
        if index is not None or not WORDS.fullmatch(name):
            self.refuse(f"{name} is neither a variable of the program nor a word that is read")
        if may_be_alike(set_names, {*names_in(value)}):
            self.refuse(
                "a variable is set, and read in a word of the same block", None, "part them"
            )
        way, number = self._worded(quickly(value) if name == "M" else value)
        text = f"{way}({number})" if way else number
        yield (*span_of(node), f" {name}={text} ")

    def _names_set(self, tree: Node) -> Iterator[str]:
        """Yield the names of variables that a line sets, in capitals."""
        nodes: list[Any] = tree.children
        for target in (node.children[0] for node in nodes if rule_of(node) == "assignment"):
            name, index = str(target.children[0]).upper(), target.children[1:]
            if self._is_variable(name, index[0] if index else None):
                yield name

    def _is_variable(self, name: str, index: Node | None) -> bool:
        return (
            bool(PARAMETER.fullmatch(name))
            or (name == "R" and index is not None)
            or (self._cell(name) is not None)
        )

    def _worded(self, value: Any) -> tuple[str, str]:
        """Return the way of a word (nothing, AC, IC ...), and its number or text."""
        if isinstance(value, Tree) and rule_of(value) == "axis_value":
            return str(value.children[0]).upper(), number_text(self.worth.number(value.children[1]))
        found = self.worth.of(value)
        return "", f'"{found}"' if isinstance(found, str) else number_text(self._finite(found))

    def _finite(self, value: Value) -> float:
        assert not isinstance(value, str)
        assert value is not None
        return self.worth.checked(value)

    def _set(self, name: str, index: Node | None, value: Any) -> None:
        """Set a variable; what only the control knows is lost with it."""
        try:
            given = [] if rule_of(value) == "repeated" else self._values(value)
        except v.NoValueError as why:
            if not why.lost:
                raise
            given = [LOST]
        if PARAMETER.fullmatch(name) or name == "R":
            numbers = self.worth.indices(index) if index is not None else (int(name[1:]),)
            if len(given) != 1 or len(numbers) != 1:
                raise v.NoValueError("R parameters take one number")
            self.r[numbers[0]] = converted("REAL", given[0])
            self.tell_of_parameters()
            return
        cell = self._cell(name)
        assert cell is not None
        if rule_of(value) == "repeated":
            self._fill_alike(cell, index, value)
            return
        # Of what type a variable of the control is nobody has said: what it makes of this is open.
        self._fill(cell, index, [LOST] if cell is self.given.get(name) else given)

    def tell_of_parameters(self) -> None:
        """Say that R parameters, which outlive the program, are set no more."""
        if self.reading.asides:
            self.told_anew(UNSET)

    def _fill_alike(self, cell: Cell, index: Node | None, node: Node) -> None:
        """Set elements of an array to one value: to its end, or as many as REP says."""
        _, value, *count = node.children
        if not cell.size:
            raise v.NoValueError("REP(...) fills an array of the program")
        at = cell.place(self.worth.indices(index)) if index is not None else 0
        try:
            rest = len(cell.values) - at
            many = self.worth.number(count[0]) if count else float(rest)
            worth = self.worth.of(value)
        except v.NoValueError as why:
            if not why.lost:
                raise
            cell.lose()
            return
        if many != int(many) or not 0 < many <= rest:
            raise v.NoValueError("REP(...) fills more elements than there are")
        for k in range(int(many)):
            cell.put(at + k, worth)

    def _fill(self, cell: Cell, index: Node | None, given: Sequence[Value]) -> None:
        """Set elements of an array from one on, or a single value."""
        many = len(given) > 1
        if cell.size and index is None and not many and given == [LOST]:
            cell.lose()
            return
        numbers = self.worth.indices(index) if index is not None else (0,) * len(cell.size)
        at = cell.place(numbers)
        if cell.size and index is None and not many:
            raise v.NoValueError("an array takes SET(...), REP(...) or an index")
        if at + len(given) > len(cell.values):
            raise v.NoValueError("more values than elements")
        for k, each in enumerate(given):
            if each is not STAYS:
                cell.put(at + k, each)

    def _values(self, node: Any) -> list[Value]:
        """Return the values of an assignment: several for SET and lists."""
        rule = rule_of(node) if isinstance(node, Tree) else ""
        if rule == "axis_value":
            self.refuse("ways of axes are not read in an assignment")
        if rule == "list":
            return [self.worth.of(each) for each in node.children]
        if rule == "set_of":
            slots = node.children[1:]
            return [self.worth.of(s.children[0]) if s.children else STAYS for s in slots]
        return [self.worth.of(node)]

    # --- variables ---

    def _cell(self, name: str) -> Cell | None:
        upper = name.upper()
        return self.levels[-1].get(upper) or self.given.get(upper)

    def _system(self, name: str, index: Sequence[Any]) -> Value:
        """Return what the control says of where an axis stands, if that is known."""
        alone = len(index) == 1 and isinstance(index[0], Tree) and rule_of(index[0]) == "variable"
        said = str(index[0].children[0]).upper() if alone else ""
        known = name in POSITIONS and (name == "$P_EP" or self.stopped)
        place = self.place.known(said) if known and said in AXES and self.unit != "G20" else None
        return LOST if place is None else float(place)

    def lose_set(self, first: int, last: int) -> None:
        """Forget what lines may have set."""
        for name in names_set(self.lines[first : last + 1]):
            if PARAMETER.fullmatch(name):
                self.r[int(name[1:])] = LOST
            elif name == "R":
                self.r.clear()
            elif (cell := self._cell(name)) is not None:
                cell.lose()

    def lose_called(self, text: str) -> None:
        """Forget what a call may have set: R parameters, and the variables that its line names."""
        self.r.clear()
        for each in self.given.values():
            each.lose()
        for name in NAME.findall(text):
            if (cell := self._cell(name)) is not None:
                cell.lose()

    def _def(self, node: Node) -> None:
        """Define variables."""
        kind, most = type_of(node), self.length_of(node)
        for each in (
            c for c in node.children if isinstance(c, Tree) and rule_of(c) == "definition"
        ):
            self._define(kind, most, each)

    def length_of(self, node: Node) -> int | None:
        """Return how long texts may be by a definition; None where it does not say."""
        found = next((c for c in node.children if rule_of(c) == "length"), None)
        return None if not isinstance(found, Tree) else self.worth.indices(found)[0]

    def _define(self, kind: str, most: int | None, node: Node) -> None:
        name, *rest = node.children
        index = next((c for c in rest if isinstance(c, Tree) and rule_of(c) == "index"), None)
        value = next((c for c in rest if c is not index), None)
        upper = str(name).upper()
        if WORDS.fullmatch(upper) or PARAMETER.fullmatch(upper):
            self.refuse(f"{name} is a word of the control, and no name for a variable")
        size = self.worth.indices(index) if index is not None else ()
        cell = self.levels[-1][upper] = Cell.new(kind, size)
        cell.most = most
        if value is None:
            return
        if isinstance(value, Tree) and rule_of(value) == "repeated":
            self._fill_alike(cell, None, value)
            return
        try:
            self._fill(cell, None, self._values(value))
        except v.NoValueError as why:
            if not why.lost:
                raise
            cell.lose()

    def _proc(self, node: Node) -> None:
        """Take the parameters of a program that nothing has called: nobody knows them."""
        for each in (c for c in node.children if isinstance(c, Tree) and rule_of(c) == "parameter"):
            tokens, kind = [c for c in each.children if isinstance(c, Token)], type_of(each)
            name = next(str(t).upper() for t in tokens if t.type.endswith("NAME"))
            cell = self.levels[-1][name] = Cell.new(kind)
            cell.lose()
            if any(isinstance(c, Tree) and rule_of(c) == "bounds" for c in each.children):
                del self.levels[-1][name]


def may_be_alike(one: set[str], other: set[str]) -> bool:
    """Whether names may name a variable of others: R1 is R01, and may be R[R2]."""
    numbers = [{int(n[1:]) for n in names if PARAMETER.fullmatch(n)} for names in (one, other)]
    computed = ["R" in names for names in (one, other)]
    if any(computed) and all(map(any, zip(computed, numbers, strict=True))):
        return True
    return bool(numbers[0] & numbers[1] or one & other)


def quickly(value: Any) -> Any:
    """Return the number in QU() of an M code, and what else stands there as it is."""
    quick = rule_of(value) == "function" and str(value.children[0]).upper() == QU
    slots: list[Any] = value.children[1].children if quick else []
    return slots[0].children[0] if len(slots) == 1 and slots[0].children else value
