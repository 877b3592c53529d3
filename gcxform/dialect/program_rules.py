"""What a program may look like to a control: as a whole, as text, and block by block."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from gcxform.dialect.arithmetic import Arithmetic
from gcxform.dialect.codes import MCode
from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class ProgramRule:
    """Where programs begin and end, and which of their blocks are executed.

    has_percent        a percent sign may stand around a program
    has_title          what stands behind it in its line is not read; otherwise it is refused
    drops_percent      where it may not: a line of one does nothing, wherever it stands
    has_program_number an O number may stand at its head
    number_digits      how many digits such a number may have; 0: any number
    spindle_stands     the spindle stands still, as far as the control knows, when a program starts
    unit_is_set        a setting of the control decides in which unit a program begins
    block_delete       what is done with `/` blocks: "execute", "skip", or "": a switch decides
    needs_end          a file without M2 or M30, and not between two percent signs, is refused
    stops_at_end       M2 and M30 stop the control
    resets_at_end      where they do not: the modes they leave behind
    shift_ends         where they do not: the shift of G92 ends there
    """

    has_percent: bool = True
    has_title: bool = False
    drops_percent: bool = False
    has_program_number: bool = True
    number_digits: int = 0
    spindle_stands: bool = False
    unit_is_set: bool = False
    block_delete: str = ""
    needs_end: bool = False
    stops_at_end: bool = True
    resets_at_end: Mapping[str, str] = field(default_factory=dict)
    shift_ends: bool = False


@dataclass(frozen=True, slots=True)
class TextRule:
    """Characters, lines and comments.

    lower_case            words may be written in small letters
    lone_cr_is_blank      a CR without LF is a blank inside a block, and no line end
    line_length           the longest block the control takes, in characters; 0: no limit
    length_without_blanks that limit counts neither blanks nor comments
    largest_number        the largest sequence number the control takes; 0: no limit
    comments              how a comment may begin: any of "(" and ";"
    active_comments       how comments begin that the control executes, in capitals
    telling_comments      which of these only show or log something
    asides                a slash within a block: the switch decides on the M codes behind it alone
    acts_anywhere         characters on which it acts as they come in, also in a comment
    semicolon_ends        `;` ends a block also inside a comment in parentheses
    parenthesis_ends      so does the parenthesis that begins one: nothing behind it is read
    """

    lower_case: bool = True
    lone_cr_is_blank: bool = False
    line_length: int = 0
    length_without_blanks: bool = False
    largest_number: int = 0
    comments: str = "("
    active_comments: tuple[str, ...] = ()
    telling_comments: tuple[str, ...] = ()
    asides: bool = False
    acts_anywhere: str = ""
    semicolon_ends: bool = False
    parenthesis_ends: bool = False

    def executes(self, comment: str) -> bool:
        """Whether the control does something when it reads a comment."""
        return comment.lstrip("(; \t").upper().startswith(self.active_comments)

    def tells(self, comment: str) -> bool:
        """Whether all that the control does with a comment is to show or to log it."""
        return comment.lstrip("(; \t").upper().startswith(self.telling_comments)


@dataclass(frozen=True, slots=True)
class BlockRule:
    """Which words a block may have, and in what order they act.

    words             addresses the control knows, besides its axes and G, M, O
    number_first      a sequence number anywhere but at the head of its block is refused
    last_code_wins    of two codes of one group the last is taken; otherwise the block is refused
    one_action        what else may not stand beside a motion code: "axes", codes that take the axis
                      words for themselves (G92, G28); "all", any code that is not modal but G53
                      (G4, G92.1), with or without a motion code: the control leaves the move out
    g80_beside_motion G80 beside another motion code says nothing, and beside G92 or G28 leaves it
                      the axis words; otherwise the block is refused
    most_m_words      how many M words a block may have; 0: any number
    unknown_m         what an M code outside `m_codes` is; None: it is refused
    m_first           M codes that may move axes do so before the motion of their block, for certain
    m_order_chosen    the machine decides when an M code beside a move acts, so that it is assumed
    mill              blocks that only lathes have, such as G50 S or G71 P Q, are refused as such
    one_command       a block is one command, G or M with its words, or T where that changes the
                      tool: a second one is refused, and a motion code holds for its block alone
    spindle_words     codes, and S, beside which a word `$` says which spindle is meant
    """

    words: str = "DEFHIJKLNPQRST"
    number_first: bool = False
    last_code_wins: bool = False
    one_action: str = ""
    g80_beside_motion: bool = True
    most_m_words: int = 0
    unknown_m: MCode | None = None
    m_first: bool = False
    m_order_chosen: bool = False
    mill: bool = False
    one_command: bool = False
    spindle_words: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class LookupRule:
    """What the files of subprograms are called that a program calls and does not hold.

    numbers    the name of the file of a program number n, as `str.format` takes it: "O{n:04}"
    names      the same of a subprogram that is called by a name: "{name}"
    endings    what may stand behind, with its point; "" for nothing
    own_ending so may the ending of the program that calls
    any_case   small letters and capitals are the same in names of files
    by_name    a file without an O number has the number that its name says: an assumption
    """

    numbers: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    endings: tuple[str, ...] = ("",)
    own_ending: bool = False
    any_case: bool = False
    by_name: bool = False


@dataclass(frozen=True, slots=True)
class FlowRule:
    """How programs compute, call and repeat.

    language        how subprograms and loops are written: "o-words", "macro-b", or "": there are
                    none
    arithmetic      how the control computes expressions; None: they are refused
    calls_own_lines M97 calls lines of the same program, up to M99
    m99_jumps       M99 P goes to a line of the program that it stands in, and returns nowhere
    lookup          in which files subprograms are looked up
    macro_levels    how many calls with values may be inside each other; 0: there are none
    repeats_keep    variables keep what a call did to them when L calls again; None: not known
    argument_list   "II" if I, J, K may come again; "" where a parameter decides
    kept_codes      codes of the machine file whose blocks are kept as calls
    m99_returns     a file that ends with M99 is a subprogram by itself, where no language is read
    words_first     what stands beside M98 or M99 is executed before it calls or returns
    null_compare    whether null is equal to 0: "distinct", "zero", or "" where that is not known
    """

    language: str = ""
    arithmetic: Arithmetic | None = None
    calls_own_lines: bool = False
    m99_jumps: bool = False
    lookup: LookupRule = field(default_factory=LookupRule)
    macro_levels: int = 0
    repeats_keep: bool | None = None
    argument_list: str = ""
    null_compare: str = ""
    kept_codes: frozenset[str] = frozenset()
    m99_returns: bool = False
    words_first: bool = False
