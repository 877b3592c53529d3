"""Is a file a subprogram by itself, that another program calls? Asked before it is executed.

On controls whose programs have numbers it is one whose first program has M99, with or without P,
and neither M2 nor M30. Such a file may be a program that begins anew as well: both begin in a state
that something else has left, and leave one. A file with O-words is one if nothing but an end stands
outside of what they define.

Where such a file neither moves anything nor says or asks where anything is, no error of a machine
is to be taken off it, wherever it is called. The same holds where it moves in rapids to points of
the machine alone, off which no error is taken anywhere, or in what is not of this file: another one
that it calls, or a code that the control does not have, which the machine must have of its own.
"""

from __future__ import annotations

import re
from collections.abc import Collection

from gcxform.dialect.dialect import Dialect
from gcxform.flow.listing import Listing, bare
from gcxform.flow.lookup import Folders, LookupFailedError
from gcxform.flow.numbered_files import begins_program
from gcxform.flow.oword_names import name_of
from gcxform.flow.run_state import whole_number
from gcxform.modal.meaning.meaning import OWN_MOVES, PRESETS, Meaning
from gcxform.syntax.source import Source
from gcxform.syntax.tree import Block, Expression, Number, Statement, Word
from gcxform.values import dataclass

PLACES = re.compile(
    rb"#[ \t]*(?:[\[#]|50[0-9]{2}(?![0-9])|542|<[ \t]*_[xyzabcuvw][ \t]*>)", re.IGNORECASE
)
"""Parameters that say where axes stand or were touched, and those whose number is computed."""
NO_SUCH_CODE = "GX201"
TAKEN = frozenset("NPQLS")
"""Words that a code of the machine's own may take; none of them says where an axis goes."""
ELSEWHERE = frozenset({"G65", "G66", "G66.1", "M96", "M97", "M98", "M198"})
"""Codes that lead to other lines, or to other programs."""


def only_returns(source: Source, dialect: type[Dialect]) -> bool:
    """Whether a program that has the sign of it returns to what has called it, and ends nothing."""
    listing = _listing(source, dialect)
    if dialect.flow_rule.language == "o-words":
        return _only_defines(listing)
    first = _first_program(listing)
    special = [line for line in listing.special.tolist() if line in first]
    back = [line for line in special if returns(listing.block(line))]
    return bool(back) and not any(listing.meaning(n).ends for n in special if n not in back)


@dataclass(frozen=True)
class Still:
    """Looks for what moves in a file, or says or asks where something is.

    calling   codes that call programs on this machine, besides those of the control
    folders   where files are looked up that are called
    rapids    whether rapids to points of the machine are left to it by all that is done
    """

    dialect: type[Dialect]
    calling: Collection[str] = ()
    folders: Folders | None = None
    rapids: bool = False

    def but_for(self, source: Source, known: frozenset[str] = frozenset()) -> list[str] | None:
        """Return in what a file moves that is left to itself, in words; None if in more than that.

        `known` are the files that are being looked at already, by what they are called by.
        """
        listing = _listing(source, self.dialect)
        if PLACES.search(listing.window.text):
            return None
        found: dict[str, None] = {}
        for shape, meaning in zip(listing.table.shapes.shapes, listing.table.meanings, strict=True):
            own = self._left(shape.block, meaning)
            if not own and _goes(shape.block, meaning, self.dialect, self._leads):
                return None
            found |= {own: None} if own else {}
        for label in _called(listing) - known:
            more = self._in_file(label, known | {label})
            if more is None:
                return None
            found |= dict.fromkeys(more)
        return list(found)

    @property
    def _leads(self) -> frozenset[str]:
        """The codes that lead to other lines or programs on this machine."""
        return ELSEWHERE.union(self.calling)

    def _left(self, block: Block, meaning: Meaning) -> str:
        """Return as what a block is left to itself, whatever it does; nothing if it is not."""
        if self.rapids and _to_the_machine(block, meaning):
            return "rapids to points of the machine"
        refused = meaning.refusal is not None and meaning.refusal.code == NO_SUCH_CODE
        codes = [f"M{whole_number(word)}" for word in block.words if word.address == "M"]
        takes = {word.address for word in block.words if word.address != "M"}
        leads = not self._leads.isdisjoint(codes)
        own = refused and len(codes) == 1 and takes <= TAKEN and not leads
        return f"{codes[0]}, which the machine has of its own" if own else ""

    def _in_file(self, label: str, known: frozenset[str]) -> list[str] | None:
        """Return in what a file that is called moves, as `but_for` does; by itself if not at hand.

        One whose name is computed may be any, so something may move.
        """
        if "[" in label:
            return None
        name = label.strip("<>")
        try:
            files = [*self.folders.of_name(name)] if self.folders is not None else []
        except LookupFailedError:
            return None
        inside = [self.but_for(Source.of_bytes(file.text, file.name), known) for file in files]
        if any(each is None for each in inside):
            return None
        more = [word for each in inside if each is not None for word in each]
        return more if files else [f"{name_of(name)}, which is not at hand"]


def _called(listing: Listing) -> set[str]:
    """Return what a file calls that it does not define."""
    blocks = [listing.block(line) for line in listing.special.tolist()]
    flow = [item for block in blocks for item in block.items if _keyword_of(item)]
    named = {key: {label(i) for i in flow if _keyword_of(i) == key} for key in ("SUB", "CALL")}
    return named["CALL"] - named["SUB"]


def _to_the_machine(block: Block, meaning: Meaning) -> bool:
    """Whether a block is a rapid to a point of the machine, by whatever way its caller stands.

    A way home over a point that is given counts in coordinates of the caller, but for a step of
    nothing.
    """
    codes = {f"G{whole_number(word)}" for word in block.words if word.address == "G"}
    values = [word.value for word in block.words if word.address in meaning.axes]
    acts = [act.name for act in meaning.acts]
    if meaning.refusal is not None or block.error is not None:
        return False
    stays = "G91" in codes and all(isinstance(v, Number) and not v.value for v in values)
    return (acts == ["machine"] and "G0" in codes) or (acts == ["home"] and (stays or not values))


def _goes(block: Block, meaning: Meaning, dialect: type[Dialect], codes: frozenset[str]) -> bool:
    """Whether a block moves, says where something is, or leads elsewhere; or may do so."""
    words = [*block.words]
    placed = not meaning.dwell and any(word.address in dialect.axes for word in words)
    placed |= bool(meaning.centres) or any(word.address in "IJKR@^" for word in words)
    computed = any(word.address in "GM" and isinstance(word.value, Expression) for word in words)
    leads = any(f"{word.address}{word.value.value:g}" in codes for word in words)
    done = bool(meaning.call) or any(act.name in OWN_MOVES | PRESETS for act in meaning.acts)
    flows = any(isinstance(item, Statement) for item in block.items)
    unread = block.error is not None or (meaning.refusal is not None and not flows)
    return placed or computed or leads or done or unread


def _listing(source: Source, dialect: type[Dialect]) -> Listing:
    text, folders = b"".join(source.windows()), Folders((), dialect.flow_rule.lookup)
    return Listing(text, dialect, source.name, folders)


def _only_defines(listing: Listing) -> bool:
    """Whether nothing but ends stands outside of `sub` and `endsub`."""
    special, inside = set(listing.special.tolist()), False
    shapes = listing.table.shapes.shapes
    plain = [not bare(shape.block) for shape in shapes]
    for line in range(len(listing)):
        if line in special:
            items = bare(listing.block(line))
            word = keyword(items[0]) if items else ""
            if not inside and items and word != "SUB" and not _is_end(items):
                return False
            inside = word == "SUB" or (inside and word != "ENDSUB")
        elif not inside and not plain[int(listing.window.shape[line])]:
            return False
    return True


def _keyword_of(item: object) -> str:
    """Return the keyword of an O-word in capitals; nothing for all else that stands in a block."""
    return keyword(item) if isinstance(item, Statement) else ""


def label(item: object) -> str:
    """Return what an O-word is called by."""
    assert isinstance(item, Statement)
    return str(item.tree.children[1]).lower()


def keyword(item: Word | Statement) -> str:
    """Return the keyword of an O-word in capitals; nothing for what is none."""
    if not isinstance(item, Statement) or item.kind != "flow":
        return ""
    return str(item.tree.children[2]).upper()


def _is_end(items: list[Word | Statement]) -> bool:
    """Whether a block is an end and nothing else."""
    one = items[0]
    ends = isinstance(one, Word) and one.address == "M" and whole_number(one) in (2, 30)
    return ends and len(items) == 1


def _first_program(listing: Listing) -> range:
    """Return the lines of the program that runs: up to where the second one begins."""
    special = listing.special.tolist()
    lines = [line for line in special if begins_program(listing.block(line))]
    if lines and not any(bare(listing.block(line)) for line in range(lines[0])):
        lines = lines[1:]
    return range(lines[0] if lines else len(listing))


def returns(block: Block) -> bool:
    """Whether a block has M99."""
    return any(word.address == "M" and whole_number(word) == 99 for word in block.words)
