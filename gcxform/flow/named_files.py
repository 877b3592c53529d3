"""Where LinuxCNC finds what a block calls.

First among the subprograms that it has met: those it has passed over or called, in whatever file.
Then in the file of that name, from its begin; then in the rest of the file that runs. All of it was
executed with the stand-alone interpreter. Which folders it searches its INI says; a file that is
beside the program and has the name of what stands behind the call may be meant or not.
"""

from __future__ import annotations

from gcxform.flow.constructs import Constructs
from gcxform.flow.execution import MISSING, Execution
from gcxform.flow.lookup import Found


class Subprograms:
    """What a run can call; `met` are the lines of the subprograms that it knows, by label."""

    def __init__(self, program: Execution) -> None:
        self.program = program
        self.arranged = Constructs(program)
        self.met: dict[str, int] = {}

    def arrange(self) -> None:
        """Find again which lines belong together."""
        self.arranged = Constructs(self.program)

    def line_of(self, label: str) -> int:
        """Return the line in which a subprogram begins that is called. Raises InputError."""
        if label not in self.met:
            self.met[label] = self._begin(label)
        return self.met[label]

    def line_of_number(self, number: int) -> int:
        """Return the line of the number that M98 calls. Raises InputError."""
        line, (first, end) = self.program.line, self.program.listing.part(self.program.line)
        lines = self.arranged.labels.get(number, [])
        behind = next((each for each in lines if line < each < end), None)
        if not self._adds_file(str(number), behind, first):
            if behind is None:
                message = f"the subprogram O{number} is neither behind this block nor in a file"
                raise self.program.refusal("GX210", message, MISSING)
            return behind
        start = self.program.listing.files[-1].first
        found = [each for each in self.arranged.labels.get(number, []) if each >= start]
        return found[0] if found else self._not_there(f"O{number}")

    def _begin(self, label: str) -> int:
        line, (first, _) = self.program.line, self.program.listing.part(self.program.line)
        here = self.arranged.subs.get((first, label))
        behind = here.lines[0] if here is not None else None
        if not self._adds_file(label, behind, first):
            if behind is None or (first and behind < line):
                message = f"the subprogram {label} is not in this file, and in no file beside it"
                raise self.program.refusal("GX210", message, MISSING)
            return behind
        found = self.arranged.subs.get((self.program.listing.files[-1].first, label))
        return found.lines[0] if found is not None else self._not_there(f"o<{label}>")

    def _adds_file(self, label: str, here: int | None, first: int) -> bool:
        """Add the file of a label, and return whether there is one; not that which runs."""
        program = self.program
        found = program.found(program.listing.folders.of_name(label), label)
        file = program.only([each for each in found if not self._runs(each, first)], label)
        if file is not None and here is not None:
            where = program.listing.place(here)[1]
            message = f"{label} stands in line {where} and in {file.name}: either may be called"
            raise program.refusal("GX227", message, "take one of them away")
        return program.add_file(file)

    def _runs(self, file: Found, first: int) -> bool:
        """Whether a file is the one that runs, whose first line is given."""
        listing = self.program.listing
        own = next((each.text for each in listing.files if each.first == first), None)
        text = listing.raw(0, listing.own) if own is None else own
        return file.text.rstrip(b"\r\n") == text.rstrip(b"\r\n")

    def _not_there(self, what: str) -> int:
        file = self.program.listing.files[-1].name
        raise self.program.refusal("GX223", f"{file} does not begin {what}, which is called here")
