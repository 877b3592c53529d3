"""Faults planted in the tables of real dialects, and in the core: `check_dialect` finds each."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

import gcxform as gx
from gcxform import vocabulary as v
from gcxform.modal.frames import acts
from gcxform.modal.meaning import tables
from gcxform.plugin.registry import default_registry
from gcxform.testing import check_dialect
from gcxform.testing.behaviour import check_doing

DIALECTS = default_registry().dialects
FANUC, HAAS, NGC, GRBL, FAGOR, KLARTEXT = (
    DIALECTS[name] for name in ("fanuc", "haas", "linuxcnc", "grbl", "fagor", "heidenhain")
)
Kind = type[gx.Dialect]


def changed(base: Kind, **values: Any) -> Kind:
    """Return a dialect with other tables."""
    return type("Acme", (base,), {"__doc__": "Acme.", "name": "acme", **values})


def codes(base: Kind, **changes: gx.Code | None) -> Kind:
    """Return a dialect with other codes; `G54_1` is G54.1, None: it is missing."""
    table = dict(base.codes)
    for name, code in changes.items():
        table.pop(name.replace("_", "."), None)
        if code is not None:
            table[name.replace("_", ".")] = code
    return changed(base, codes=table)


def ms(base: Kind, change: dict[int, gx.MCode | None]) -> Kind:
    """Return a dialect with other M codes."""
    table = {**base.m_codes, **change}
    return changed(base, m_codes={n: code for n, code in table.items() if code is not None})


def swapped(base: Kind, one: str, two: str) -> Kind:
    """Return a dialect in which two codes have each other's meaning."""
    table = base.codes
    return changed(base, codes={**table, one: table[two], two: table[one]})


def cycles(base: Kind, name: str, **changes: Any) -> Kind:
    """Return a dialect with changes in what is said of its cycles, by number: `_83="P"`."""
    rule = base.cycle_rule
    assert rule is not None
    table = dict(rule.cycles)
    for key, value in changes.items():
        table[int(key[1:])] = replace(table[int(key[1:])], **{name: value})
    return changed(base, cycle_rule=replace(rule, cycles=table))


def ended(**changes: str | None) -> Kind:
    """Return GRBL with another state behind M2."""
    changed_modes = {k.replace("_", "-"): c for k, c in changes.items()}
    table = {**GRBL.program_rule.resets_at_end, **changed_modes}
    resets = {k: c for k, c in table.items() if c is not None}
    return changed(GRBL, program_rule=replace(GRBL.program_rule, resets_at_end=resets))


def starting(base: Kind, **changes: str) -> Kind:
    """Return a dialect whose programs start in other modes."""
    modes = {key.replace("_", "-"): code for key, code in changes.items()}
    return changed(base, initial={**base.initial, **modes})


def arcs(base: Kind, **changes: Any) -> Kind:
    return changed(base, arc_rule=replace(base.arc_rule, **changes))


def offsets(base: Kind, **changes: Any) -> Kind:
    return changed(base, offset_rule=replace(base.offset_rule, **changes))


def points(base: Kind, **changes: Any) -> Kind:
    return changed(base, point_rule=replace(base.point_rule, **changes))


def letters(words: str) -> Kind:
    return changed(GRBL, block_rule=replace(GRBL.block_rule, words=words))


def tips(base: Kind, **changes: Any) -> Kind:
    return changed(base, tip_rule=replace(base.tip_rule, **changes))


G41 = FANUC.codes["G41"]

# name: the dialect with the fault, and a part of what is said of it
PLANTED: dict[str, tuple[Callable[[], Kind], str]] = {
    # what codes are
    "G43 and G49 swapped": (lambda: swapped(FANUC, "G43", "G49"), "G49 is 'act length'"),
    "G43 and G44 swapped": (lambda: swapped(FANUC, "G43", "G44"), "G43 is 'act length-negative'"),
    "G15 and G16 swapped": (lambda: swapped(FANUC, "G15", "G16"), "'act polar'"),
    "G68 and G69 swapped": (lambda: swapped(FANUC, "G68", "G69"), "G68 is 'act no-rotate'"),
    "G50 and G51 swapped": (lambda: swapped(FANUC, "G50", "G51"), "is 'act scale'"),
    "G52 and G92 swapped": (lambda: swapped(FANUC, "G52", "G92"), "G52 is 'act preset'"),
    "G28 and G53 swapped": (lambda: swapped(FANUC, "G28", "G53"), "G28 is 'act machine'"),
    "G90 and G20 swapped": (lambda: swapped(FANUC, "G90", "G20"), "'modal units'"),
    "G92.1 and G92.3 merged": (
        lambda: codes(NGC, G92_3=NGC.codes["G92.1"]),
        "G92.3 is 'act preset-clear'",
    ),
    "G43.2 as G43": (lambda: codes(NGC, G43_2=NGC.codes["G43"]), "G43.2 is 'act length'"),
    "G1 inert": (lambda: codes(FANUC, G1=v.inert("motion")), "G1 is inert and would replace"),
    "G91 inert": (lambda: codes(FANUC, G91=v.inert("distance")), "G91 is inert and would replace"),
    "G55 inert": (lambda: codes(GRBL, G55=v.inert("frame")), "G55 is inert and would replace"),
    "G41 inert": (
        lambda: codes(FANUC, G41=v.inert("cutter-comp", "D")),
        "G41 is inert and would replace",
    ),
    "G28 inert": (lambda: codes(FANUC, G28=v.inert("non-modal")), "G28 is 'inert'"),
    "G4 inert": (lambda: codes(FANUC, G4=v.inert("non-modal", "PX")), "G4 is 'inert'"),
    "G31 a plain move": (
        lambda: codes(FANUC, G31=v.inert("non-modal", "PQ")),
        "G31 is an act on other controls",
    ),
    "G43 in a language": (
        lambda: codes(FAGOR, G43=v.inert("tool-length", "H")),
        "G43 is an act on other controls",
    ),
    "G52 in a language": (
        lambda: codes(KLARTEXT, G52=v.frame("non-modal", "preset", v.AXES)),
        "G52 is 'act preset'",
    ),
    # groups
    "G18 of another group": (lambda: codes(FANUC, G18=gx.Code("distance")), "'modal distance'"),
    "G93 of the units": (lambda: codes(FANUC, G93=gx.Code("units")), "G93 is 'modal units'"),
    "G44 of a group of its own": (
        lambda: codes(FANUC, G44=v.frame("length", "length-negative", "H")),
        "what it does belongs to 'tool-length'",
    ),
    "G54.1 of a group of its own": (
        lambda: codes(FANUC, G54_1=v.frame("more", "work", "P")),
        "what it does belongs to 'frame'",
    ),
    "G69 of another group": (
        lambda: codes(FANUC, G69=v.frame("turn", "no-rotate")),
        "G68 begins what no code",
    ),
    "G10 modal": (
        lambda: codes(FANUC, G10=v.frame("data", "set-work", v.AXES + "LPR")),
        "what it does belongs to 'non-modal'",
    ),
    "G80 outside its group": (lambda: codes(FANUC, G80=v.inert("end")), "G80 does not replace"),
    "G64 apart from G61": (lambda: codes(FANUC, G64=v.inert("corner")), "replace each other"),
    "G98 apart from G99": (lambda: codes(FANUC, G98=v.inert("level")), "belongs to 'retract'"),
    "an inert code among the planes": (
        lambda: codes(FANUC, G300=v.inert("plane")),
        "would replace the codes",
    ),
    "G64 at the end": (lambda: codes(FANUC, G64=v.at_end("path")), "does not act at the end"),
    # missing members
    "no G18": (lambda: codes(FANUC, G18=None), "no G18"),
    "no G21": (lambda: codes(FANUC, G21=None), "no G21"),
    "no G90": (lambda: codes(FANUC, G90=None), "no G90"),
    "no G40": (lambda: codes(FANUC, G40=None), "no G40"),
    "no G42": (lambda: codes(NGC, G42=None), "no G42"),
    "no G57": (lambda: codes(GRBL, G57=None), "no G57"),
    "no G69": (lambda: codes(FANUC, G69=None), "G68 begins what no code"),
    "no G49": (lambda: codes(GRBL, G49=None), "G43.1 begins what no code"),
    "no G80": (lambda: codes(FANUC, G80=None), "G80 does not replace"),
    "no G98": (lambda: codes(NGC, G98=None), "no G98"),
    # takes
    "an act without its words": (
        lambda: codes(FANUC, G43=v.frame("tool-length", "length")),
        "does not take ['H']",
    ),
    "a tool length by another word": (
        lambda: codes(FANUC, G43=v.frame("tool-length", "length", "HD")),
        "takes ['D'], of which its act knows nothing",
    ),
    "G54.1 without P": (
        lambda: codes(FANUC, G54_1=v.frame("frame", "work")),
        "takes no word that says",
    ),
    "G54.1 with axes": (
        lambda: codes(FANUC, G54_1=v.frame("frame", "work", "PX")),
        "takes axis words away",
    ),
    "G28 takes the axes": (
        lambda: codes(FANUC, G28=v.frame("non-modal", "home", v.AXES)),
        "takes axis words away",
    ),
    "G53 takes the axes": (
        lambda: codes(NGC, G53=v.frame("non-modal", "machine", "XYZ")),
        "takes axis words away",
    ),
    "G10 without P": (
        lambda: codes(FANUC, G10=v.frame("non-modal", "set-work", v.AXES + "LR")),
        "does not take ['P']",
    ),
    "G68 without R": (
        lambda: codes(FANUC, G68=v.frame("rotation", "rotate", "XYZ")),
        "does not take ['R']",
    ),
    "G92 without Z": (
        lambda: codes(GRBL, G92=v.frame("non-modal", "preset", "XY")),
        "does not take ['Z']",
    ),
    "G43.1 without Z": (
        lambda: codes(GRBL, G43_1=v.frame("tool-length", "length-vector", "XY")),
        "does not take ['Z']",
    ),
    "G1 takes X": (lambda: codes(FANUC, G1=gx.Code("motion", takes="X")), "takes words away"),
    "G41 takes H": (lambda: codes(FANUC, G41=gx.Code("cutter-comp", takes="H")), "and not D"),
    "G41 D as a length": (
        lambda: codes(FANUC, G41=gx.Code("cutter-comp", takes="D", lengths="D")),
        "G41 has the lengths 'D'",
    ),
    "G41.1 D as a number": (lambda: codes(NGC, G41_1=G41), "G41.1 has the lengths ''"),
    "G64 P as a number": (lambda: codes(NGC, G64=v.inert("path", "PQ")), "they are 'PQ'"),
    "axis words of an inert code": (
        lambda: codes(FANUC, G22=v.inert("stroke", "XYZIJK")),
        "which are lengths, and does not say so",
    ),
    "a code takes what is no word": (lambda: codes(GRBL, G300=v.inert("own", "Q")), "no words"),
    # numbered things
    "an act that is none": (lambda: codes(FANUC, G16=v.frame("polar", "pole")), "'act pole'"),
    "an own act that is none": (lambda: codes(FANUC, G301=v.frame("own", "pole")), "not exist"),
    "two names in one": (
        lambda: offsets(HAAS, names={**HAAS.offset_rule.names, "G111": "G154 P1"}),
        "G110 and G111 are both G154 P1",
    ),
    "G54 and G55 swapped": (
        lambda: offsets(FANUC, names={"G54": "G55", "G55": "G54"}),
        "G54 has the name G55",
    ),
    "a name of nothing": (
        lambda: offsets(HAAS, names={**HAAS.offset_rule.names, "G110": "G159 P1"}),
        "one of them is no work offset",
    ),
    "G10 P1 and P2 are one": (
        lambda: offsets(FANUC, g10_offsets=("G54", "G54", "G56")),
        "name G54 G54 G56",
    ),
    "G10 P1 and P2 swapped": (
        lambda: offsets(FANUC, g10_offsets=("G55", "G54", "G56", "G57", "G58", "G59")),
        "and not G54 G55",
    ),
    "G10 sets what is not there": (
        lambda: offsets(GRBL, g10_offsets=NGC.offset_rule.g10_offsets),
        "sets G59.1",
    ),
    "a length along X alone": (
        lambda: changed(GRBL, tool_rule=gx.ToolRule(length_axes="X")),
        "not along Z",
    ),
    # dwell
    "P of Fanuc in seconds": (lambda: points(FANUC, dwell={"P": 1.0, "X": 1.0}), "1 s here"),
    "P of Haas in seconds": (lambda: points(HAAS, dwell={"P": 1.0}), "P of G4 is 1 s here"),
    "P of LinuxCNC in ms": (lambda: points(NGC, dwell={"P": 0.001}), "P of G4 is 0.001 s here"),
    "P in hundredths": (lambda: points(GRBL, dwell={"P": 0.01}), "it is 1 s, or 0.001 s"),
    "X in ms": (lambda: points(FANUC, dwell={"X": 0.001, "P": 0.001}), "X of G4 is in seconds"),
    "a dwell by no word": (lambda: points(GRBL, dwell={"U": 1.0}), "no word of the dialect"),
    "no dwell word": (lambda: points(GRBL, dwell={}), "no word for its time"),
    "a point that is nothing": (
        lambda: points(GRBL, dwell_in_seconds=True),
        "in seconds, as without",
    ),
    # at the start and at the end
    "starts in G91": (lambda: starting(FANUC, distance="G91"), "starts in G91"),
    "starts in G20": (lambda: starting(GRBL, units="G20"), "starts in G20"),
    "starts in G18": (lambda: starting(NGC, plane="G18"), "starts in G18"),
    "starts in G41": (lambda: starting(NGC, cutter_comp="G41"), "starts in G41"),
    "starts in G55": (lambda: starting(NGC, frame="G55"), "starts in G55"),
    "starts in G2": (lambda: starting(FANUC, motion="G2"), "starts in G2"),
    "starts in a code of another group": (lambda: starting(NGC, plane="G90"), "no code of that"),
    "the end leaves the plane": (lambda: ended(plane=None), "in the group 'plane'"),
    "the end leaves G91": (lambda: ended(distance="G91"), "in the group 'distance'"),
    "the end leaves no motion": (lambda: ended(motion=None), "in the group 'motion'"),
    "the end leaves the work offset": (lambda: ended(frame="G55"), "in the group 'frame'"),
    "resets that nobody sees": (
        lambda: changed(
            NGC, program_rule=replace(GRBL.program_rule, stops_at_end=NGC.program_rule.stops_at_end)
        ),
        "nobody sees",
    ),
    # M codes
    "M8 and M9 swapped": (
        lambda: ms(FANUC, {8: FANUC.m_codes[9], 9: FANUC.m_codes[8]}),
        "M8 acts before",
    ),
    "M3 and M5 swapped": (
        lambda: ms(FANUC, {3: FANUC.m_codes[5], 5: FANUC.m_codes[3]}),
        "M3 acts before",
    ),
    "M1 and M2 swapped": (
        lambda: ms(GRBL, {1: GRBL.m_codes[2], 2: GRBL.m_codes[1]}),
        "M1 ends",
    ),
    "M3 and M8 swapped": (
        lambda: ms(GRBL, {3: GRBL.m_codes[8], 8: GRBL.m_codes[3]}),
        "M3 is of the group 'coolant'",
    ),
    "M0 before the motion": (lambda: ms(NGC, {0: gx.MCode("stop")}), "M0 acts after"),
    "M6 after the motion": (lambda: ms(NGC, {6: gx.MCode("tool", after=True)}), "M6 acts before"),
    "M30 does not end": (lambda: ms(FANUC, {30: gx.MCode("stop", after=True)}), "M30 does not end"),
    "M98 a plain code": (lambda: ms(FANUC, {98: gx.MCode("stop", takes="PL")}), "calls a program"),
    "M6 without loss": (lambda: ms(FANUC, {6: gx.MCode("tool")}), "loses no position"),
    "unknown M without loss": (
        lambda: changed(FANUC, block_rule=gx.BlockRule(unknown_m=gx.MCode("user"))),
        "unknown_m",
    ),
    "no M5": (lambda: ms(GRBL, {5: None}), "there is M3 and no M5"),
    "no M9": (lambda: ms(GRBL, {9: None}), "there is M7 and no M9"),
    "M61 without Q": (
        lambda: ms(NGC, {61: gx.MCode("tool", act="set-tool")}),
        "does not take Q",
    ),
    "an M code takes what is no word": (
        lambda: ms(GRBL, {62: gx.MCode("output", takes="Q")}),
        "M62 takes ['Q']",
    ),
    "an M code with the act of a G code": (
        lambda: ms(NGC, {6: gx.MCode("tool", act="length")}),
        "which M codes do not have",
    ),
    # arcs and numbers
    "arcs of a millimetre": (lambda: arcs(FANUC, absolute=1.0), "radii may differ by 1 mm"),
    "arcs of a tenth": (lambda: arcs(GRBL, relative=0.1), "by 0.1 of the radius"),
    "arcs without a largest": (lambda: arcs(GRBL, largest=float("inf")), "by inf mm"),
    "arcs in inches the other way": (lambda: arcs(NGC, in_inch=1 / 25.4), "times as much"),
    "an R that falls far short": (lambda: arcs(NGC, r_short=1.0), "fall short of"),
    "turns counted by R": (lambda: arcs(NGC, turns="R"), "counts the turns"),
    "whole millimetres": (lambda: changed(FANUC, numbers=gx.NumberFormat(mm=1)), "are coarse"),
    "inches coarser": (
        lambda: changed(NGC, numbers=gx.NumberFormat(mm=4, inch=3)),
        "fewer decimals in inches",
    ),
    # letters
    "Z before Y": (lambda: changed(FANUC, axes="XZYABC"), "X, Y and Z come first"),
    "an axis that is no axis": (lambda: changed(GRBL, axes="XYZQ"), "letters of"),
    "B before A": (lambda: changed(HAAS, axes="XYZBAC"), "in the order"),
    "an axis missing": (lambda: changed(NGC, axes="XYZABC"), "no words of the dialect"),
    "an axis and a word": (lambda: letters(GRBL.block_rule.words + "X"), "an axis and a word"),
    "a word twice": (lambda: letters(GRBL.block_rule.words + "F"), "stands twice"),
    "no J": (lambda: letters(GRBL.block_rule.words.replace("J", "")), "want ['J']"),
    # cycles
    "Q and P swapped in G83": (lambda: cycles(FANUC, "needs", _83="P"), "needs of G83"),
    "G82 needs no P": (lambda: cycles(FANUC, "needs", _82=""), "needs of G82"),
    "G83 breaks chips only": (lambda: cycles(FANUC, "pecks", _83="break"), "pecks of G83"),
    "G73 and G83 swapped": (
        lambda: cycles(NGC, "pecks", _73="clear", _83="break"),
        "pecks of G73",
    ),
    "G81 is G85": (lambda: cycles(FANUC, "steps", _81=FANUC.cycle_rule.cycles[85].steps), "of G81"),
    "G82 does not wait": (lambda: cycles(FANUC, "steps", _82=v.DRILL), "steps of G82"),
    "G84 turns as G74": (
        lambda: cycles(FANUC, "steps", _84=FANUC.cycle_rule.cycles[74].steps),
        "steps of G84",
    ),
    "G84 wants M4": (lambda: cycles(NGC, "spindle", _84=(-1,)), "turn the other way"),
    "G83 does not take Q": (lambda: cycles(NGC, "takes", _83="L"), "G83 needs Q"),
    "P counts holes": (
        lambda: changed(FANUC, cycle_rule=replace(FANUC.cycle_rule, repeats="P")),
        "counts the holes",
    ),
    "a cycle without steps": (lambda: cycles(FANUC, "steps", _81=()), "G81 has no steps"),
    # tips
    "M128 and M129 swapped": (
        lambda: tips(FAGOR, switches={"tip-on": "M129", "tip-off": "M128"}),
        "M129 is tip-on",
    ),
    "G43.4 for a code that sets no length": (
        lambda: tips(FANUC, codes={"G43.4": "G49"}),
        "takes no tool length",
    ),
}


@pytest.mark.parametrize("name", PLANTED)
def test_planted(name):
    build, said = PLANTED[name]
    with pytest.raises(AssertionError, match=re.escape(said)):
        check_dialect(build())


def test_a_hundred_tables_have_an_error_each():
    """Each another one: of its control, what stands in it is no other's."""
    built = [build() for build, _ in PLANTED.values()]
    wrong = [
        (kind.__mro__[1].__name__, {k: repr(v) for k, v in vars(kind).items()}) for kind in built
    ]
    assert len({repr(each) for each in wrong}) == len(PLANTED) >= 100


def test_an_own_work_offset_by_a_word():
    """What the tables of Okuma have: G15 H1 and G15 H2, on purpose."""
    kind = codes(FANUC, G16=None, G15=v.frame("frame", "work", "H"))
    with pytest.raises(AssertionError, match=r"G15 is 'act work'.*say in differs\['G15'\]"):
        check_dialect(kind)
    check_dialect(changed(kind, differs={"G15": "Okuma, OSP-P300: a work offset by its number"}))


def test_what_differs_must_say_why_and_of_what():
    for differs, said in (({"G15": " "}, "does not say why"), ({"what": "so"}, "does not have")):
        with pytest.raises(AssertionError, match=said):
            check_dialect(changed(FANUC, differs=differs))


# --- faults in the core: the tables are right, and what is read is not ---

SWAPPED = [
    *(("G17", "G18"), ("G18", "G19"), ("G20", "G21"), ("G90", "G91"), ("G2", "G3"), ("G0", "G1")),
    *(("G93", "G94"), ("G41", "G42"), ("G40", "G41"), ("G98", "G99"), ("G90.1", "G91.1")),
    *(("G80", "G1"), ("G1", "G2")),
]


@pytest.mark.parametrize("pair", SWAPPED, ids="-".join)
@pytest.mark.parametrize("dialect", [FANUC, NGC], ids=["fanuc", "linuxcnc"])
def test_swapped_numbers(pair, dialect, monkeypatch):
    if any(code not in dialect.codes for code in pair):
        dialect = NGC
    one, two = (tables.NUMBER[code] for code in pair)
    monkeypatch.setitem(tables.NUMBER, pair[0], two)
    monkeypatch.setitem(tables.NUMBER, pair[1], one)
    with pytest.raises(AssertionError, match=r"ends with|is refused|do the same|does not replace"):
        check_doing(dialect)


def p_alone(state, asked):
    """Name a work offset by P alone: G15 H1 and G15 H2 are one."""
    name = asked.dialect.offset_rule.names.get(asked.code, asked.code)
    return state.in_work(f"{name} P{asked.words['P']:g}" if "P" in asked.words else name)


ACTS = {
    "work": p_alone,
    "length": lambda state, asked: state.with_tool((0.0, 0.0, 50.0), "H1"),
    "local": lambda state, asked: replace(state, local=(3.0, 2.0, 0.0, 0.0, 0.0, 0.0)),
    "rotate": lambda state, asked: acts.ACTS["no-rotate"](state, asked),
    "no-length": lambda state, asked: state,
    "no-rotate": lambda state, asked: state,
    "no-mirror": lambda state, asked: state,
    "mirror": lambda state, asked: state,
    "preset": lambda state, asked: state,
    "set-work": lambda state, asked: state.with_zero("G54", (30.0, *[0.0] * (len(state.axes) - 1))),
}


@pytest.mark.parametrize("act", ACTS)
def test_wrong_acts(act, monkeypatch):
    """An act that does something else, or the same for two numbers."""
    kind = codes(HAAS, G15=v.frame("frame", "work", "H"))
    monkeypatch.setitem(acts.ACTS, act, ACTS[act])
    with pytest.raises(AssertionError, match=r"ends with|one and the same"):
        check_doing(kind)
