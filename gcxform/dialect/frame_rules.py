"""How codes change what words count from: work offsets, shifts, tool lengths, the tip."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class OffsetRule:
    """Work offsets, and what shifts them: G10, G52, G92, mirrors.

    known_at_start    the work offset of `initial` is in force for certain when a program starts
    names             work offsets that have a second code: the code, and the name of the offset
    g10_offsets       the work offsets that P1, P2 ... of G10 L2 name
    g10_tools         the L of G10 that write lengths and radii into the control's tool table
    g10_p0            what P0 of G10 names: the work offset in force ("active"), or a shift of all
                      of them ("all"); "": nothing
    g10_needs_p       G10 without P names none; otherwise it is as with P0
    g10_l20           what G10 L20 sets: "here" makes the present position read what is given; a
                      code, such as "G54.1", names the work offsets that are meant; "": nothing
    g10_ignores_g91   under G91, G10, G52 and G92 set what they set under G90
    g10_rotates       R in G10 L2 turns the work offset about Z
    g52_is_g92        G52 and G92 set one and the same shift
    g52_known         G52 and G92 mean what they mean on most controls; otherwise a setting decides
    mirrors_at_zero   a mirror stands at the zero of the work offset; other places are refused
    """

    known_at_start: bool = False
    names: Mapping[str, str] = field(default_factory=dict)
    g10_offsets: tuple[str, ...] = ("G54", "G55", "G56", "G57", "G58", "G59")
    g10_tools: frozenset[int] = frozenset()
    g10_p0: str = ""
    g10_needs_p: bool = True
    g10_l20: str = ""
    g10_ignores_g91: bool = False
    g10_rotates: bool = False
    g52_is_g92: bool = False
    g52_known: bool = True
    mirrors_at_zero: bool = False


@dataclass(frozen=True, slots=True)
class ToolRule:
    """Tools and their lengths.

    in_table               a tool that the tool table does not have is refused where it is named
    lengths_aside          the control's tool table has lengths along X and Y too
    length_axes            the axes along which G43.1 gives a length
    g43_takes_spindle_tool G43 without H takes the length of the tool in the spindle
    h_stays                H stays in force: G43 without H takes it, and an H by itself is another,
                           or the number of a radius, as a parameter says
    g49_takes_axes         G49 takes the axis words of its block, and leaves them out
    length_may_move        another length may move the axis by itself; where it stands is then not
                           known
    units_spoil_length     a length in force keeps its number when the unit changes, so that it is
                           another one
    t_changes              T by itself changes the tool: programs of the control run, and another
                           offset of the tool is in force, along any axis
    t_selects              T says which tool is next, and moves nothing; False: it is refused where
                           no other code takes it
    """

    in_table: bool = False
    lengths_aside: bool = False
    length_axes: str = "XYZ"
    g43_takes_spindle_tool: bool = False
    h_stays: bool = False
    g49_takes_axes: bool = False
    length_may_move: bool = False
    units_spoil_length: bool = False
    t_changes: bool = False
    t_selects: bool = True


@dataclass(frozen=True, slots=True)
class TipRule:
    """How the control is told to follow the tip of the tool itself.

    codes            codes from which on it does, each with the one that only takes the tool length
                     into account
    vector_codes     the same of codes with which I, J and K of lines are the tool axis, from tip to
                     holder
    takes_vectors    what is left of such codes is in the program: see
                     `gcxform/contract/tip_codes.py`
    switches         M codes that follow the tip, and leave it, on every machine with this control:
                     "tip-on" and "tip-off", as in the machine file
    spelled          what these are called where programs are not written in words: `M128` may be
                     `TRAORI`
    follows_at_start whether it follows the tip when a program starts; None where that is not known
    unfollowed       codes of tilted planes and tips that are not followed, with what they do:
                     "plane", "no-plane" or "tip"; see `gcxform/contract/tilted_planes.py`
    planes           codes of tilted planes and tips that are followed on a machine whose tables are
                     known, with what they do: "define-plane", "orient", "swivel",
                     "turn-to" or "follow-tip"
    """

    codes: Mapping[str, str] = field(default_factory=dict)
    vector_codes: Mapping[str, str] = field(default_factory=dict)
    takes_vectors: bool = False
    switches: Mapping[str, str] = field(default_factory=dict)
    spelled: Mapping[str, str] = field(default_factory=dict)
    follows_at_start: bool | None = None
    unfollowed: Mapping[str, str] = field(default_factory=dict)
    planes: Mapping[str, str] = field(default_factory=dict)
