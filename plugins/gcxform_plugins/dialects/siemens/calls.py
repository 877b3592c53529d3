"""Subprograms of a SINUMERIK: by their names, by L and a number, with parameters.

They stand in files beside the program, `NAME.SPF` or `NAME.MPF`, or in folders that the user names.
CALL, PCALL and EXTCALL name one by a text or a path, of which the last part counts here.
What they set of modes stays set behind them, but for one that says SAVE (`saving.py`); one that is
not there is not followed.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from lark import Token, Tree
from lark.exceptions import UnexpectedInput

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.siemens.asides import QUIET, TELLING
from gcxform_plugins.dialects.siemens.cells import LOST, Cell, Value, converted, initial
from gcxform_plugins.dialects.siemens.computing import Computing
from gcxform_plugins.dialects.siemens.expressions import PARAMETER
from gcxform_plugins.dialects.siemens.line import FRAMES
from gcxform_plugins.dialects.siemens.nodes import Node, rule_of, type_of
from gcxform_plugins.dialects.siemens.reading import ORIENTATION, WHY
from gcxform_plugins.dialects.siemens.saving import other_mode, saved
from gcxform_plugins.dialects.siemens.structure import code
from gcxform_plugins.dialects.siemens.variables import WORDS, Call

LEVELS = 8  # calls inside each other, on the smallest of these controls
MOST = 9999  # times that one call may ask for
CALLED = re.compile(r"([A-Z_][A-Z0-9_]*)", re.IGNORECASE)
INDIRECT = re.compile(
    r"(?:CALL[ \t]+|EXTCALL[ \t]*\([ \t]*)(?:\"(?P<text>[^\"]*)\"|(?P<variable>[A-Z_][A-Z0-9_]*))"
    r"[ \t]*\)?|PCALL[ \t]+(?P<path>[A-Z0-9_/.]+)[ \t]*(?P<given>\(.*\))?",
    re.IGNORECASE,
)
"""Calls by a text, a variable that has one, or a path (Job planning 07/2010; 840Di sl K1)."""
KIND = re.compile(r"[._](?:SPF|MPF)$", re.IGNORECASE)
BY_PATH = "programs that are called by a path are those of that name in the folders of subprograms"
OUTSIDE = frozenset(("sequence", "label"))
MODAL = "mcall-in-subprograms"
ACTS = "which may drill behind its moves, too"
ACTS_HINT = f'{MODAL} = "acts" in [control], if it does; or write its moves in the program itself'


class Calls(Computing):
    """Executes calls; `saving`: the PROC that was read last says SAVE."""

    saving = False

    def executed(self, items: Sequence[gx.Item]) -> list[str]:
        """Return the blocks of a line; none of one that calls. Raises InputError."""
        if self._returns(items):
            self._leave()
            return []
        name, text = self._name_of(items), ""
        if not name:
            name, text = self._indirect(items)
        if name and (lines := self.called_file(name)) is not None:
            self._enter(name, lines, text or self.lines[self.line])
            return []
        return super().executed(items)

    def _name_of(self, items: Sequence[gx.Item]) -> str:
        """Return the name that a line calls, if it may be one; nothing for all else."""
        bare = [i for i in items if i.kind not in ("label", "main_number") and i.name != "N"]
        item = bare[0] if bare else None
        if item is None or not self.finds_programs:
            return ""
        if item.kind == "word" and item.name == "L":
            return f"L{item.numbers[0]}"
        if item.kind == "command" and all(i.kind == "word" and i.name == "P" for i in bare[1:]):
            return "" if self.knows(item.name) else item.name
        found = CALLED.match(item.name) if item.kind == "call" else None
        return "" if found is None or self.knows(found[1]) else found[1]

    def _indirect(self, items: Sequence[gx.Item]) -> tuple[str, str]:
        """Return the name that CALL, PCALL or EXTCALL says, and the call by it; or nothing."""
        bare = [i for i in items if i.kind not in ("label", "main_number") and i.name != "N"]
        if len(bare) != 1 or bare[0].kind not in ("flow", "call") or not self.finds_programs:
            return "", ""
        found = INDIRECT.fullmatch(self.text_in(self.line, bare[0]).strip())
        if found is None:
            return "", ""
        path = found["text"] or found["path"] or ""
        if found["variable"]:
            cell = self._cell(found["variable"])
            value = cell.values[0] if cell is not None and not cell.size else LOST
            path = value if isinstance(value, str) else ""
        if "/" in path:
            self.assumed[BY_PATH] = None
        name = KIND.sub("", path.rpartition("/")[2]).upper().removeprefix("_N_")
        return name, f"{name}{found['given'] or '()'}"

    @property
    def finds_programs(self) -> bool:
        """Whether there is a place where subprograms may be."""
        return bool(self.reading.subprograms)

    def knows(self, name: str) -> bool:
        """Whether a name is one of the language, or of a cycle of Siemens, and no subprogram's."""
        said = {*QUIET, *TELLING, *ORIENTATION, *FRAMES, *WHY, "SUPA", "CIP", "TRAFOOF", "MCALL"}
        return name.upper() in said or re.fullmatch(r"CYCLE[0-9]+", name.upper()) is not None

    # --- in and out ---

    def _enter(self, name: str, lines: range, text: str) -> None:
        """Begin a subprogram. Raises InputError."""
        if len(self.calls) >= LEVELS or any(call.lines == lines for call in self.calls):
            self.refuse(f"{name} calls itself, or {LEVELS} calls are inside each other")
        if self.comp:
            self.refuse(f"{name} is called under compensation")
        if self.drilling is not None and self.reading.control.get(MODAL) != "acts":
            self.refuse(f"{name} is called under MCALL, {ACTS}", None, ACTS_HINT)
        self.look_for_tangents(self.lines[lines.start : lines.stop])
        if any(call.saved for call in self.calls):
            self.refuse(f"{name} is called in a subprogram that says SAVE")
        self.saving = False
        proc = self._proc_of(name, lines)
        try:
            times, given = self._given(text)
            level = self._bound(proc, given)
        except v.NoValueError as why:
            raise self.refusal(why.code, why.message, None, why.hint) from None
        self.decides = True
        before = saved(self) if self.saving else None
        self.calls.append(Call(lines, self.at, times, before, self.drilling))
        self.levels.append(level)
        self.at = lines.start

    def _proc_of(self, name: str, lines: range) -> Node | None:
        """Return the first block of a subprogram, if it names parameters. Raises InputError."""
        first = next((self.lines[n] for n in lines if code(self.lines[n]).strip()), "")
        if not re.match(r"[ \t]*(?:N[0-9]+[ \t]*)?PROC(?![A-Z0-9_])", first, re.IGNORECASE):
            return None
        try:
            node: Node = self.tree_of(first).children[-1]
        except UnexpectedInput:
            self.refuse(f"{name}: its PROC is not read")
        tokens = [str(c).upper() for c in node.children if isinstance(c, Token)]
        bare = [c for c in node.children if isinstance(c, Tree) and rule_of(c) == "bare"]
        words = [str(c.children[0]).upper() for c in bare]
        if name.upper() not in tokens:
            self.refuse(f"the file of {name} has a PROC of another name")
        saves = "SAVE" in words and not self.reading.stays
        if other := {*words} - {"DISPLOF", "SBLOF", *(["SAVE"] if saves else [])}:
            self.refuse(f"{name} says {min(other)} behind PROC")
        if saves and (mode := other_mode(self.lines[lines.start : lines.stop])):
            self.refuse(f"{name} says SAVE, and {mode} in it is not followed up to its end")
        self.saving = saves
        return node

    def _given(self, text: str) -> tuple[int, list[Any]]:
        """Return how often a line calls, and its arguments: None for one that is left out."""
        try:
            tree = self.tree_of(text)
        except UnexpectedInput:
            self.refuse("this call is not read")
        (node, *others) = [c for c in tree.children if rule_of(c) not in OUTSIDE]
        count = [str(o.children[0])[1:] for o in others if rule_of(o) == "word"]
        if rule_of(node) == "call":
            times = next((c for c in node.children if rule_of(c) == "times"), None)
            slots: list[Any] = next(
                (c.children for c in node.children if rule_of(c) == "arguments"), []
            )
            given = [slot.children[0] if slot.children else None for slot in slots]
            number = self.worth.number(times.children[1]) if times is not None else 1.0
            return self._often(number), [] if given == [None] else given
        return self._often(float(count[0]) if count else 1.0), []

    def _often(self, number: float) -> int:
        if number != int(number) or not 1 <= number <= MOST:
            self.refuse(f"a call for {number:g} times")
        return int(number)

    def _bound(self, proc: Node | None, given: Sequence[Any]) -> dict[str, Cell]:
        """Return the variables of a call: its parameters. Raises InputError."""
        nodes: list[Any] = [] if proc is None else proc.children
        wanted = [c for c in nodes if rule_of(c) == "parameter"]
        if len(given) > len(wanted):
            self.refuse("this call has more values than its PROC")
        level = {}
        for k, parameter in enumerate(wanted):
            value = given[k] if k < len(given) else None
            tokens = [t for t in parameter.children if isinstance(t, Token)]
            name = next(str(t).upper() for t in tokens if t.type.endswith("NAME"))
            if WORDS.fullmatch(name) or PARAMETER.fullmatch(name):
                self.refuse(f"{name} is a word of the control, and no name for a parameter")
            shared = any(t.type.endswith("VAR") for t in tokens)
            level[name] = self._shared(parameter, value) if shared else self._own(parameter, value)
        return level

    def _shared(self, parameter: Node, value: Any) -> Cell:
        """Return the variable of the caller that a parameter with VAR is."""
        cell = None
        if rule_of(value) == "variable" and len(value.children) == 1:
            cell = self._cell(str(value.children[0]))
        nodes: list[Any] = parameter.children
        bounds: list[Any] = next((c.children for c in nodes if rule_of(c) == "bounds"), [])
        if cell is None or cell.kind != type_of(parameter) or len(cell.size) != len(bounds):
            self.refuse("a parameter with VAR takes a variable of its type, and of its dimensions")
        return cell

    def _own(self, parameter: Node, value: Any) -> Cell:
        """Return a parameter that has a value of its own."""
        kind = type_of(parameter)
        if any(rule_of(c) == "bounds" for c in parameter.children):
            self.refuse("an array is handed on with VAR alone")
        default = [c for c in parameter.children if _is_value(c)]
        node = value if value is not None else (default[-1] if default else None)
        found: Value = initial(kind)
        if node is not None:
            try:
                found = converted(kind, self.worth.of(node))
            except v.NoValueError as why:
                if not why.lost:
                    raise
                found = LOST
        cell = Cell(kind, (), [LOST], self.length_of(parameter))
        cell.put(0, found)
        return cell

    def _proc(self, node: Node) -> None:
        """Take parameters: those of a call are known already."""
        if not self.calls and self.reading.asides:
            self.refuse("PROC begins a program that others call: they find what it leaves to them")
        if not self.calls:
            super()._proc(node)

    def _return(self, node: Node) -> None:
        """Leave a program, or go back to what has called it."""
        if not self.calls or len(node.children) > 1:
            super()._return(node)
        else:
            self._leave()

    def _returns(self, items: Sequence[gx.Item]) -> bool:
        """Whether M17 in a line goes back to what has called. Raises InputError for other ends."""
        numbers = [i.numbers[0] for i in items if i.kind == "word" and i.name == "M"]
        codes = {int(number) for number in numbers if number.isdigit()}
        if not self.calls or not codes & {2, 17, 30}:
            return False
        if codes != {17} or len([i for i in items if i.name != "N" and i.kind != "label"]) > 1:
            self.refuse("a subprogram ends here with other words, or ends the program")
        return True

    def _leave(self) -> None:
        """Go back, or begin a subprogram once more."""
        call = self.calls[-1]
        if call.saved is not None:
            self._put_back(*call.saved)
        if self.drilling != call.drilling:
            self.refuse("a subprogram ends with another MCALL in force than it began with")
        call.times -= 1
        if call.times:
            self.at = call.lines.start
            return
        self.calls.pop()
        self.levels.pop()
        self.at = call.back

    def _put_back(self, modes: tuple[Any, ...], others: tuple[Any, ...]) -> None:
        """Take what was in force before a subprogram that says SAVE. Raises InputError."""
        if saved(self)[1] != others:
            self.refuse("a subprogram that says SAVE ends in another plane, zero, unit or mode")
        old = self.frame
        self.motion, self.steps, self.frame = modes
        if self.frame != old:
            self.place.seen_anew(lambda point: self.frame.inside(old.point(point)))
            self.lose_pole()

    def at_end(self) -> None:
        """Come to the end of a file. Raises InputError where that of a subprogram has no M17."""
        if not self.calls:
            super().at_end()
            return
        if not self.kept_until:
            self.refuse("the file of a subprogram ends here, without M17 or RET")
        self._leave()
        self.kept_until = 0


def _is_value(node: Any) -> bool:
    """Whether a part of a parameter is its default."""
    if isinstance(node, Token):
        return node.type.rsplit("__", 1)[-1] in ("NUMBER", "STRING", "HEX")
    return isinstance(node, Tree) and rule_of(node) not in ("bounds", "length")
