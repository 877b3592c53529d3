"""Passes that change text and no meaning, and the check that they do not."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from gcxform.contract.passes import TextPass
from gcxform.diagnostics import InputError, Location, VerificationError
from gcxform.dialect.dialect import Dialect
from gcxform.modal.control_limits import without_blanks
from gcxform.modal.meaning.printed import is_output
from gcxform.pipeline.reasons import Told
from gcxform.proof.references import first_other
from gcxform.stamps.comment import is_stamp
from gcxform.syntax.scan import scan
from gcxform.syntax.shapes import ShapeTable, instantiate
from gcxform.syntax.tree import BLANKS, Block, Number, Statement, Word


class TextRun:
    """Edits the texts of one run in order."""

    def __init__(
        self,
        passes: Sequence[TextPass],
        dialect: type[Dialect],
        file: str,
        told: Told | None = None,
    ) -> None:
        self.told = told or (lambda name, lines: None)
        self.passes = passes
        self.dialect = dialect
        self.file = file
        self.counts = [0] * len(passes)

    def edit(self, text: bytes, lines: list[int], whole: bool = False) -> tuple[bytes, list[int]]:
        """Return the edited text of whole lines, and the source lines of those that stay.

        `whole`: these are all lines of the program.
        """
        for index, step in enumerate(self.passes):
            if whole and self._asks(step, text):
                text = self._rewritten(step, text, lines)
            else:
                text, lines = self._one(index, step, text, lines)
        return text, lines

    def gathered(self, windows: Callable[[], Iterator[bytes]]) -> tuple[Iterator[bytes], bool]:
        """Return the windows of a program, one for all if a pass asks for that; and whether."""
        steps = [step for step in self.passes if type(step).asks is not TextPass.asks]
        whole = any(self._asks(step, text) for step in steps for text in windows())
        return (iter([b"".join(windows())]) if whole else windows()), whole

    def _asks(self, step: TextPass, text: bytes) -> bool:
        """Whether a pass has to see a program as a whole that has these lines."""
        if type(step).asks is TextPass.asks:
            return False
        table = ShapeTable(self.dialect.load_grammar())
        scan(text, 0, table)
        return any(step.asks(shape.block) for shape in table.shapes)

    def _rewritten(self, step: TextPass, text: bytes, lines: list[int]) -> bytes:
        """Return the text of a whole program after checking that it says the same."""
        window = scan(text, 0, ShapeTable(self.dialect.load_grammar()))
        parse = self.dialect.load_grammar().parse
        blocks = [parse(window.line(n).decode("latin-1")) for n in range(len(window))]
        if (wrong := step.refused(blocks, self.dialect)) is not None:
            nth, why = wrong
            where = self._where(blocks[nth], lines[nth])
            raise InputError.one("GX212", f"{step.name}: {why}", where)
        given = [
            block.text if _stays(block) else new
            for block, new in zip(blocks, step.rewritten(blocks, self.dialect), strict=True)
        ]
        other = first_other(blocks, [parse(new) for new in given])
        if other is not None:
            where = self._where(blocks[other], lines[other])
            raise VerificationError.one("GX603", f"{step.name} changed what a block says", where)
        parts = []
        for line, (block, new) in enumerate(zip(blocks, given, strict=True)):
            if new != block.text:
                self.told(step.name, [lines[line]])
                self._check_limits(step, block.text, new, self._where(block, lines[line]))
            end = text[int(window.end[line]) : int(window.next[line])]
            parts.append(new.encode("latin-1") + end)
        return b"".join(parts)

    def _where(self, block: Block, line: int) -> Location:
        return Location(self.file, line + 1, 1, block.text, max(1, len(block.text)))

    def _one(
        self, index: int, step: TextPass, text: bytes, lines: list[int]
    ) -> tuple[bytes, list[int]]:
        if not text:
            return text, lines
        parts, kept = [], []
        table = ShapeTable(self.dialect.load_grammar())
        window = scan(text, 0, table)
        for line in range(len(window)):
            old = window.line(line).decode("latin-1")
            shape = table.shapes[int(window.shape[line])]
            first, start = int(window.first_number[line]), int(window.start[line])
            spans = [
                (int(window.number_start[n]) - start, int(window.number_end[n]) - start)
                for n in range(first, first + len(shape.slots))
            ]
            block = instantiate(shape, old, spans)
            new = self._edited(step, block, self.counts[index], lines[line])
            if new != block.text:
                self.told(step.name, [lines[line]])
            if new is None:
                continue
            end = text[int(window.end[line]) : int(window.next[line])]
            parts.append(new.encode("latin-1") + end)
            kept.append(lines[line])
            self.counts[index] += step.counts(block)
        return b"".join(parts), kept

    def _edited(self, step: TextPass, block: Block, number: int, line: int) -> str | None:
        """Return a block's new text after checking that its words are the same."""
        where = self._where(block, line)
        why = step.refuse(block)
        if why:
            raise InputError.one("GX212", f"{step.name}: {why}", where)
        if _stays(block):
            return block.text
        new = step.edit(block, number)
        if new == block.text:
            return new
        after = [] if new is None else _meaning(self.dialect.load_grammar().parse(new))
        if after != _meaning(block):
            raise VerificationError.one("GX603", f"{step.name} changed the words of a block", where)
        if new is not None:
            self._check_limits(step, block.text, new, where)
        return new

    def _check_limits(self, step: TextPass, old: str, new: str, where: Location) -> None:
        """Refuse blocks and sequence numbers that are new, and that the control does not take."""
        size = without_blanks if self.dialect.text_rule.length_without_blanks else len
        long, limit = size(new.encode("latin-1")), self.dialect.text_rule.line_length
        if limit and long > max(limit, size(old.encode("latin-1"))):
            message = f"{step.name}: the block would have {long} characters"
            message += f"; {self.dialect.name} takes {limit}"
            raise InputError.one("GX502", message, where)
        most, none = self.dialect.text_rule.largest_number, "N" not in self.dialect.block_rule.words
        for word in self.dialect.load_grammar().parse(new).words if most or none else ():
            number = word.value
            if word.address == "N" and none:
                message = f"{step.name}: {self.dialect.name} has no word N"
                raise InputError.one("GX201", message, where)
            if word.address == "N" and isinstance(number, Number) and number.value > most:
                message = f"{step.name}: the sequence number is larger than {most}"
                raise InputError.one("GX219", message, where)

    def finish(self) -> None:
        """End the run."""


def _stays(block: Block) -> bool:
    """Whether a block is no pass's to edit."""
    return block.error is not None or is_stamp(block.text)


def _meaning(block: Block) -> list[str]:
    """Return the words and statements of a block, but N words, without blanks."""
    return [
        block.text[item.start : item.end].translate(BLANKS).upper()
        for item in block.items
        if (isinstance(item, Word) and item.address != "N")
        or isinstance(item, Statement)
        or is_output(item)
    ]
