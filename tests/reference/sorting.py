"""The words of a block by what they are: modal codes, dwell, M codes, values."""

from dataclasses import dataclass, field

from reference.model import FANUCS, GROUPS, M_GROUPS, Dialect
from reference.words import Block, Refused, Word


@dataclass
class Sorted:
    """One block: G codes (times ten) by modal group, G4, M codes, and the other letters."""

    codes: dict[str, int] = field(default_factory=dict)
    dwell: bool = False
    ms: list[int] = field(default_factory=list)
    values: dict[str, Word] = field(default_factory=dict)


def sort(block: Block, dialect: Dialect) -> Sorted:
    """Sort the words; refuse unknown codes, repeated words and clashes within a group."""
    said = Sorted()
    for word in block.words:
        if word.letter == "G":
            _add_code(said.codes, _g_code(word, dialect, block.line), dialect, block.line)
        elif word.letter == "M":
            said.ms.append(_m_code(word, dialect, block.line))
        elif word.letter in said.values:
            raise Refused(block.line, f"repeated {word.letter} word")
        else:
            said.values[word.letter] = word
    groups = [M_GROUPS[m] for m in said.ms]
    if len(said.ms) > dialect.many_m or len(set(groups)) < len(groups):
        raise Refused(block.line, "M codes clash")
    said.dwell = said.codes.pop("dwell", None) is not None
    return said


def _g_code(word: Word, dialect: Dialect, line: int) -> int:
    """Return the code times ten."""
    code = round(word.value * 10)
    if abs(word.value * 10 - code) > 0.01 or code in dialect.missing:
        raise Refused(line, f"G{word.value:g}")
    if code not in GROUPS:
        raise Refused(line, f"G{word.value:g} is not in this language")
    return code


def _m_code(word: Word, dialect: Dialect, line: int) -> int:
    code = round(word.value)
    if abs(word.value - code) > 1e-4 or code in dialect.missing_m:
        raise Refused(line, f"M{word.value:g}")
    if code not in M_GROUPS:
        raise Refused(line, f"M{word.value:g} is not in this language")
    return code


def _add_code(codes: dict[str, int], code: int, dialect: Dialect, line: int) -> None:
    """Enter a code; a second one of its group wins (Fanuc), or is refused."""
    group = GROUPS[code]
    if dialect.name in FANUCS:
        if code != 800:  # cycles are a group of their own there: G80 leaves motion alone
            codes[group] = code
        return
    if group in codes:
        if dialect.name != "linuxcnc" or 800 not in (codes[group], code):
            raise Refused(line, "two codes of one modal group")
        code = min(codes[group], code)  # beside another motion code G80 does nothing
    codes[group] = code
