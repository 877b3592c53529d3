"""What decides in a Fagor program where it goes on: structures, jumps, and calls of subroutines.

Local subroutines stand before the program, behind `%L` and a name; others in files beside it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.fagor.arithmetic import NEAR
from gcxform_plugins.dialects.fagor.computing import LOCALS, Computing
from gcxform_plugins.dialects.fagor.places import code_of
from gcxform_plugins.dialects.fagor.structure import (
    ENDS,
    HEAD,
    INNER,
    LOOPS,
    OPENS,
    Part,
    Structure,
    StructureError,
    code,
    sections,
)
from gcxform_plugins.dialects.fagor.tables import AXES

HALVES = frozenset((*OPENS, *INNER, *ENDS))
DEEPEST = 20  # calls inside of each other
RETURNS = frozenset(("M17", "M29", "#RET"))
CALL = re.compile(r"(LL|L|#CALL|#PCALL)[ \t]+\[?(.*?)\]?", re.IGNORECASE | re.DOTALL)
FLOWS = re.compile(
    r"^[/N0-9:\[\]A-Z_ \t]*(?:\$|#P?CALL|#RET|LL?[ \t]+[^0-9 \t\n])", re.IGNORECASE | re.MULTILINE
)
FLOW_LETTERS = frozenset("$#L")
"""One of these is in what `FLOWS` finds."""
END_OPEN = 'say for-end = "included" in [control], or for-end = "excluded" in [control]'


@dataclass(slots=True)
class Call:
    """A call: where it goes back to, the lines that are called, and the parameters of the caller.

    `kind` is "own" where the subroutine has parameters of its own, "shared" where it has those of
    the caller, "" where that is not known: then `inside` are those that it has set itself.
    """

    back: int
    lines: range
    kind: str
    saved: dict[str, float | None] = field(default_factory=dict)
    doubtful: frozenset[str] = frozenset()


class Flow(Computing):
    """Executes what decides and calls.

    sharing  behind which executions of a line the parameters are those of the program, or not
    made     what was set by executions where they are not
    """

    def __init__(self, *given: object) -> None:
        super().__init__(*given)
        self.calls: list[Call] = []
        self.sharing: list[tuple[int, bool]] = []
        self.made: dict[int, dict[str, float | None]] = {}
        self.counting: dict[int, tuple[float, float]] = {}
        self._structures: dict[int, Structure] = {}
        self.local, self.at, self.wrong = self._sections()
        self.begin = self.at
        self._text = code("\n".join(self.lines))
        capitals = self._text.upper()
        self.letters = frozenset(each for each in FLOW_LETTERS | AXES if each in capitals)
        may = not self.letters.isdisjoint(FLOW_LETTERS)
        self.decides = bool(self.local) or (may and FLOWS.search(self._text) is not None)
        self.plainly = not self.decides
        self.does: Mapping[str, Callable[[Any], None]] = {
            "if": self._if,
            "elseif": lambda _: self._go(self._part().last + 1),
            "else": lambda _: self._go(self._part().last + 1),
            "endif": lambda _: None,
            "for": self._for,
            "endfor": lambda _: self._next(),
            "while": self._while,
            "endwhile": lambda _: self._go(self._part().first),
            "do": lambda _: None,
            "enddo": self._enddo,
            "switch": self._switch,
            "case": lambda _: self._falls(),
            "default": lambda _: self._falls(),
            "endswitch": lambda _: None,
            "break": lambda _: self._leave("SWITCH"),
            "continue": lambda _: self._continue(),
            "goto": self._goto,
            "call": self._call,
        }

    def _sections(self) -> tuple[dict[str, range], int, StructureError | None]:
        try:
            return *sections(self.lines), None
        except StructureError as why:
            return {}, 0, why

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a line. Raises InputError."""
        if self.wrong is not None:
            raise self.refusal("GX223", self.wrong.message)
        codes = {code_of(item) or item.name for item in items}
        if self.calls and codes & {"M2", "M30"}:
            self.refuse("a subroutine that ends the program")
        returns = next((i for i in items if (code_of(i) or i.name) in RETURNS), None)
        if returns is None:
            return self._after(super().blocks(items))
        if len([i for i in items if i.name != "N" and i.kind not in ("label", "colon")]) > 1:
            self.refuse(f"{returns.name} beside other words", returns)
        if not self.calls:
            self.refuse(f"{returns.name} ends a subroutine, and none was called", returns)
        self._return()
        return []

    def _after(self, blocks: Iterable[str]) -> Iterable[str]:
        found = [*blocks]
        watched = self.decides or self.polar is not None or self.untold
        self.plainly = self.plainly and not watched
        return found

    def flow(self, rule: str, node: Any) -> None:
        """Take what decides or calls. Raises NoValueError or StructureError."""
        self.does[rule](node)

    # --- lines ---

    @property
    def part(self) -> range:
        """The lines of the program or the subroutine that is executed."""
        if self.calls:
            return self.calls[-1].lines
        return range(self.begin, self.own)

    @property
    def structure(self) -> Structure:
        """The structures of these lines. Raises StructureError."""
        lines = self.part
        if lines.start not in self._structures:
            self._structures[lines.start] = Structure(self.lines, lines.start, lines.stop)
        return self._structures[lines.start]

    def _part(self) -> Part:
        return self.structure.at[self.line]

    def _skips(self, items: Any) -> bool:
        """Whether the line is skipped. Raises InputError for half a structure that is."""
        skipped = super()._skips(items)
        found = HEAD.match(code(self.lines[self.line])) if skipped else None
        if found is not None and (found["word"] or "").upper() in HALVES:
            self.refuse("what of a structure is executed of which this line is skipped", items[0])
        return skipped

    def _go(self, line: int) -> None:
        self.at = line
        self.places.jumped()

    # --- structures ---

    def _if(self, node: Any) -> None:
        part = self._part()
        if self.values.holds(node.children[1]):
            return
        for word, line in part.inner:
            if word == "ELSE" or self.values.holds(self._head(line).children[1]):
                self._go(line + 1)
                return
        self._go(part.last + 1)

    def _head(self, line: int) -> Any:
        """Return the statement that a line has."""
        return self.tree_of(self.lines[line]).children[-1]

    def _while(self, node: Any) -> None:
        part = self._part()
        if not self.values.holds(node.children[1]):
            self._go(part.last + 1)

    def _enddo(self, node: Any) -> None:
        part = self._part()
        if self.values.holds(node.children[1]):
            self._go(part.first + 1)

    def _for(self, node: Any) -> None:
        part = self._part()
        _, target, sign, first, last, step = node.children
        start, end, by = (self.values.value(each) for each in (first, last, step))
        name = self.values.name(target)
        if str(sign) != "=" or by == 0 or (end - start) * by < 0 or name[0] != "P":
            raise v.NoValueError("$FOR that leads away from its end, or has no step", code="GX210")
        self.known[name] = start
        self.counting[part.first] = end, by
        if not self._goes_on(start, end, by):
            self.known[name] = None
            self._go(part.last + 1)

    def _goes_on(self, value: float, end: float, by: float) -> bool:
        """Whether $FOR runs for a value of its parameter. Raises NoValueError."""
        if value == end:
            chosen = self.reading.control.get("for-end")
            if chosen is None:
                message = "whether $FOR runs for its last value is not certain"
                raise v.NoValueError(message, END_OPEN, "GX220", True)
            return chosen == "included"
        if abs(value - end) <= NEAR * max(1.0, abs(end)):
            raise v.NoValueError("$FOR comes next to its end, and not to it: a last run or none")
        return (end - value) * by > 0

    def _next(self) -> None:
        """Count on at $ENDFOR, and go back or on."""
        part = self._part()
        _, target, _, _, last, step = self._head(part.first).children
        name = self.values.name(target)
        end, by = self.counting[part.first]
        if (self.values.value(last), self.values.value(step)) != (end, by):
            raise v.NoValueError("the end or the step of $FOR changes in its loop")
        value = self.values.read(name) + by
        self.known[name] = value
        if self._goes_on(value, end, by):
            self._go(part.first + 1)
        else:
            self.known[name] = None

    def _switch(self, node: Any) -> None:
        part, value = self._part(), self.values.value(node.children[1])
        for word, line in part.inner:
            if word == "DEFAULT" or self._is(value, self._head(line).children[1]):
                self._go(line + 1)
                return
        self._go(part.last + 1)

    def _is(self, value: float, node: Any) -> bool:
        other = self.values.value(node)
        if value != other and abs(value - other) <= NEAR * max(1.0, abs(value)):
            raise v.NoValueError("a value next to that of $CASE, and not the same")
        return value == other

    def _falls(self) -> None:
        message = "whether a case without $BREAK goes on with the next one is not certain"
        raise v.NoValueError(message, "end it with $BREAK", "GX210")

    def _around(self, *kinds: str) -> Part:
        part = next((p for p in self.structure.around(self.line) if p.kind in kinds), None)
        if part is None:
            raise StructureError(self.line, "this stands in no structure that it could leave")
        return part

    def _leave(self, *kinds: str) -> None:
        self._go(self._around(*kinds, *LOOPS).last + 1)

    def _continue(self) -> None:
        self._go(self._around(*LOOPS).last)

    def _goto(self, node: Any) -> None:
        _, target, *computed = node.children
        name = re.sub(r"[ \t:\[\]]", "", str(target).upper())
        if computed:
            number = self.values.value(computed[0])
            if number != int(number) or number < 0:
                raise v.NoValueError("a jump to a number that is not whole")
            name = f"N{int(number)}"
        elif name[0] == "N" and name[1:].isdigit():
            name = f"N{int(name[1:])}"
        self._go(self.structure.target(name, self.line))

    # --- calls ---

    def _call(self, node: Any) -> None:
        match = CALL.fullmatch(str(node.children[0]).strip())
        assert match is not None
        way = match[1].upper()
        name = re.split(r"[\\/:]", match[2].strip())[-1].upper()
        lines = self._called(way, name)
        if len(self.calls) >= DEEPEST or any(call.lines == lines for call in self.calls):
            raise v.NoValueError(f"{name} calls itself, or calls are too deep", code="GX223")
        given = self._arguments(way, node.children[1:])
        self._enter(way, lines, given)

    def _called(self, way: str, name: str) -> range:
        local = self.local.get(name) if way != "L" and self._in_program else None
        stem = name.rpartition(".")[0] or name
        other = self.called_file(stem) if way != "LL" and self.reading.subprograms else None
        found = local if local is not None else other
        if local is not None and other is not None:
            raise v.NoValueError(f"{name} is a subroutine here, and a file beside it", code="GX223")
        if found is None:
            raise v.NoValueError(f"there is no subroutine {name}", code="GX210")
        return found

    @property
    def _in_program(self) -> bool:
        """Whether the file of the program is executed, and none that it calls."""
        return self.line < self.own

    def _arguments(self, way: str, nodes: Sequence[Any]) -> dict[str, float | None]:
        """Return what a call gives to parameters. Raises NoValueError."""
        given: dict[str, float | None] = {}
        for node in nodes:
            target, sign, value = node.children
            name = self.values.name(target)
            if way != "#PCALL" or str(sign) != "=" or not _is_local(name) or name in given:
                raise v.NoValueError("only #PCALL gives values, each to a local parameter")
            try:
                given[name] = self.values.value(value)
            except v.NoValueError as why:
                if not why.lost:
                    raise
                given[name] = None
        return given

    def _enter(self, way: str, lines: range, given: dict[str, float | None]) -> None:
        """Begin a subroutine."""
        kind = "own" if way == "#PCALL" else str(self.reading.control.get("subroutine-locals", ""))
        mine = {name: value for name, value in self.known.items() if _is_local(name)}
        self.calls.append(Call(self.at, lines, kind, mine, frozenset(self.doubtful)))
        self._share()
        if kind != "shared":
            self.known = {n: value for n, value in self.known.items() if n not in mine} | given
            self.doubtful = set() if kind == "own" else {*mine, *self.doubtful}
        self._go(lines.start)

    def _share(self) -> None:
        self.sharing.append((self.visit, all(call.kind == "shared" for call in self.calls)))

    def _set(self, node: Any) -> str:
        name = super()._set(node)
        if self.sharing and not self.sharing[-1][1]:
            self.made.setdefault(self.visit, {})[name] = self.known[name]
        return name

    def _return(self) -> None:
        """Go back to what has called."""
        call = self.calls.pop()
        self._share()
        if call.kind != "shared":
            inside = {name: value for name, value in self.known.items() if _is_local(name)}
            self.known = {n: value for n, value in self.known.items() if n not in inside}
            self.known |= call.saved
            if not call.kind:  # those that it has set may be the caller's
                same = {n for n, value in inside.items() if call.saved.get(n, value) == value}
                self.known |= {n: None for n in inside if n not in same or n not in call.saved}
            self.doubtful = set(call.doubtful)
        self._go(call.back)

    def at_end(self) -> None:
        """Come to the end of a file. Raises InputError where that of a subroutine has no end."""
        if self.calls:
            self.line = self.calls[-1].lines.stop - 1
            self.refuse("a subroutine that does not end with #RET, M17 or M29")
        super().at_end()

    def _without_header(self, items: list[gx.Item]) -> list[gx.Item]:
        """Leave the name of the program out, behind its subroutines as well."""
        if self.local and self.line == self.begin and not self.calls:
            return items[1:]
        if self.calls:
            self.refuse("a subroutine that does not end with #RET, M17 or M29", items[0])
        return super()._without_header(items)


def _is_local(name: str) -> bool:
    return name[0] == "P" and int(name[1:]) in LOCALS
