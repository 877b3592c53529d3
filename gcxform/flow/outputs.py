"""What DPRNT and its relatives print has to be there where calls and loops are written out.

A block that prints stands as it is. Common variables are set in what is written anyway. A local one
whose value is known is set in front of the block: what has set it, or the call that has given it,
may not be written. Whose value only the machine knows has to be set by its own assignment.
"""

from __future__ import annotations

from gcxform.dialect.arithmetic import Key
from gcxform.dialect.null import MAYBE
from gcxform.flow.run_state import RunState, differs
from gcxform.flow.text import assignment
from gcxform.modal.expressions.value import DOUBTFUL, written
from gcxform.modal.meaning.printed import is_output, parameters_printed
from gcxform.syntax.tree import Block


class Outputs:
    """The prints of one run, and the local variables that the written blocks set.

    assigned  the parameters that the blocks set, with the line that set each, and its value
    stands    what local variables are worth in the blocks that were written
    levels    those whose own assignments are written, with the call that they belong to
    placed    those that were set for a print, with the call that they belong to
    """

    def __init__(self, program: RunState) -> None:
        self.program = program
        self.assigned: list[tuple[int, Key, float]] = []
        self.stands: dict[Key, float] = {}
        self.levels: dict[Key, int] = {}
        self.placed: dict[Key, int] = {}

    def assign(self, key: Key, value: float) -> None:
        """Take account of an assignment that is written."""
        self.stands[key] = value
        self.assigned.append((self.program.line, key, value))

    def assign_all(self, made: list[tuple[int, Key, float]]) -> None:
        """Take account of assignments that are written, each with its line."""
        self.stands.update((key, value) for _, key, value in made)
        self.assigned += made

    def refuse_levels(self, key: Key) -> None:
        """Refuse to write parameters of two calls that have one name: they would become one."""
        if self.program.arithmetic.outlives(key):
            return
        level = self.program.level()
        if {self.levels.setdefault(key, level), self.placed.get(key, level)} != {level}:
            message = f"{written(key)} is not known, and calls have it that are written out"
            raise self.program.refusal("GX220", message)

    def before(self, block: Block) -> None:
        """Set what a block prints, where that is to be done. Raises InputError, Again."""
        for item in block.items:
            if is_output(item):
                for key in parameters_printed(block.text[item.start : item.end]):
                    self._one(key, (item.start, item.end))

    def _one(self, key: Key | None, place: tuple[int, int]) -> None:
        program = self.program
        if key is None:
            message = "which variable this prints is computed"
            raise program.refusal("GX206", message, place=place)
        if program.arithmetic.outlives(key):
            return
        value = program.parameters.get(key)
        if value is MAYBE or value == DOUBTFUL:
            message = f"{written(key)}, which this prints, is known in two ways here"
            raise program.refusal("GX220", message, place=place)
        if value is None or value != value:
            self._left_to_machine(key)
        elif differs(self.stands.get(key), value):
            self._place(key, value)

    def _left_to_machine(self, key: Key) -> None:
        """See to it that a variable has what the machine alone knows."""
        self.program.needs({key})
        self.refuse_levels(key)

    def _place(self, key: Key, value: float) -> None:
        """Set a variable in front of the block that prints it."""
        program, level = self.program, self.program.level()
        if self.levels.get(key, level) != level or program.is_jumped_to():
            message = f"{written(key)} would have to be set for this print, and cannot be here"
            raise program.refusal("GX220", message)
        program.write_line(assignment(key, value, program.arithmetic))
        self.assign(key, value)
        self.placed[key] = level
