"""Whether a dialect's tables say what they must: each is held to what controls agree on.

These checks read the tables alone; `behaviour.py` runs programs. A message says what the table
says, what was expected, and how to say that a control differs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations

from gcxform.dialect.code_translation import SPOKEN
from gcxform.dialect.codes import Code, Effect, MCode
from gcxform.dialect.cycle_rule import Cycle
from gcxform.dialect.dialect import EXTRUDER, LINEAR, ROTARY, Dialect
from gcxform.dialect.program_rules import ProgramRule
from gcxform.modal.frames.acts import WORDS
from gcxform.modal.meaning.meaning import ACT_ORDER
from gcxform.modal.meaning.tables import FAMILIES as OF_GROUP
from gcxform.modal.meaning.tables import GROUPS, NUMBER
from gcxform.testing import canon
from gcxform.testing.merging import merged

SECONDS, MILLISECONDS = 1.0, 0.001
NO_CYCLE = Cycle()
Complaints = Iterator[tuple[str, str]]
"""What a table is blamed for: the code or attribute, by which `differs` excuses it, and a text."""


def check_declared(dialect: type[Dialect]) -> None:
    """Hold a dialect's tables to what controls agree on. Raises AssertionError."""
    for key, reason in dialect.differs.items():
        rule, _, fact = key.partition(".")
        has = hasattr(dialect, rule) and (not fact or hasattr(getattr(dialect, rule), fact))
        known = key in dialect.codes or has or key[1:].isdigit()
        assert known, f"{dialect.name}: differs names {key}, which the dialect does not have"
        assert reason.strip(), f"{dialect.name}: differs[{key!r}] does not say why"
    for message in merged(dialect):
        raise AssertionError(f"{dialect.name}: {message}")
    for check in CHECKS:
        for key, message in check(dialect):
            assert key in dialect.differs, (
                f"{dialect.name}: {message}; if the control does so, say in differs[{key!r}] "
                f"from where that is known"
            )


def _meanings(dialect: type[Dialect]) -> Complaints:
    for name, code in dialect.codes.items():
        expected = canon.MEANINGS.get(name)
        if code.effect is Effect.BARRIER or expected is None:
            continue
        if canon.said_of(code) not in expected:
            wanted = " or ".join(repr(one) for one in expected)
            yield name, f"{name} is {canon.said_of(code)!r}; controls agree on {wanted}"


def _groups(dialect: type[Dialect]) -> Complaints:
    for name, code in dialect.codes.items():
        group = canon.GROUP_OF_ACT.get(code.act, code.group)
        if code.group != group:
            yield name, f"{name} is of the group {code.group!r}; what it does belongs to {group!r}"
        known = code.group in OF_GROUP and name not in OF_GROUP[code.group]
        if code.effect is Effect.MODAL and known:
            yield name, f"{name} is no code of the group {code.group!r}"
        if code.effect is Effect.INERT and name in ("G98", "G99") and code.group != "retract":
            yield name, f"{name} is of the group {code.group!r}; what it does belongs to 'retract'"
        if code.after and (
            code.effect is not Effect.INERT or name in canon.MEANINGS.keys() - {"G9"}
        ):
            yield name, f"{name} does not act at the end of its block"
    cycles = {c.group for n, c in dialect.codes.items() if n in canon.CYCLES and _done(c)}
    if len(cycles) > 1 or (cycles and _group(dialect, "G80") not in cycles):
        yield "G80", f"the cycles are of {sorted(cycles)}, and G80 does not replace them all"
    paths = {c.group for n, c in dialect.codes.items() if n in ("G61", "G61.1", "G64")}
    if len(paths) > 1:
        yield "G64", f"G61 and G64 replace each other, and are of {sorted(paths)}"


def _group(dialect: type[Dialect], name: str) -> str:
    return dialect.codes[name].group if name in dialect.codes else ""


def _done(code: Code) -> bool:
    return code.effect is not Effect.BARRIER


def _acts(dialect: type[Dialect]) -> Complaints:
    for name, code in dialect.codes.items():
        if code.effect is not Effect.FRAME:
            spoken = code.effect is Effect.INERT and code.act in SPOKEN
            if code.act and code.effect is not Effect.CALL and not spoken:
                yield name, f"{name} has the act {code.act!r} and does not change frames"
            continue
        if code.act not in ACT_ORDER:
            yield name, f"{name} has the act {code.act!r}, which does not exist"
        yield from _act_words(dialect, name, code)
        end = canon.ENDED.get(code.act)
        ends = [c for c in dialect.codes.values() if c.act == end]
        if end and not any(c.group == code.group for c in ends):
            yield name, f"{name} begins what no code with the act {end!r} of its group ends"


def _act_words(dialect: type[Dialect], name: str, code: Code) -> Complaints:
    numbers, axes = set(code.takes) - set(dialect.axes), set(code.takes) & set(dialect.axes)
    numbers -= set(LINEAR + ROTARY)
    heard = code.takes if code.act == "work" else WORDS.get(code.act, "")
    heard += "P" if code.act == "home" else "PQ" if code.act == "probe" else ""
    if numbers - set(heard):
        yield name, f"{name} takes {sorted(numbers - set(heard))}, of which its act knows nothing"
    needed = canon.NEEDED.get(code.act, "")
    needed += "P" if name in ("G54.1", "G154") and code.act == "work" else ""
    needed += dialect.tool_rule.length_axes if code.act == "length-vector" else ""
    if lacks := sorted(set(needed) - set(code.takes)):
        yield name, f"{name} does not take {lacks}, by which its act is told what to do"
    if axes and code.act in canon.MOVING | {"work", "length", "length-negative", "no-length"}:
        yield name, f"{name} takes axis words away from the motion of its block"


def _words_of_codes(dialect: type[Dialect]) -> Complaints:
    """Check the words of codes without an act, and which of them are lengths."""
    for name, code in dialect.codes.items():
        if code.effect in (Effect.BARRIER, Effect.FRAME, Effect.CALL):
            continue
        if set(code.lengths) - set(code.takes):
            yield name, f"{name} has lengths among words that it does not take"
        if code.group == "cutter-comp" and name != "G40" and code.takes != "D":
            yield name, f"{name} takes {code.takes!r}, and not D, by which it knows the tool"
        elif code.effect is Effect.MODAL and code.group != "cutter-comp" and code.takes.strip("EH"):
            yield name, f"{name} takes words away from the motion of its block"
        lengths = {"G41": "", "G42": "", "G41.1": "D", "G42.1": "D"}.get(name, code.lengths)
        if name in ("G61", "G61.1", "G64"):
            lengths = "".join(a for a in code.takes if a in "PQ")
        if code.lengths != lengths:
            yield name, f"{name} has the lengths {code.lengths!r}; they are {lengths!r}"
        own = LINEAR.replace(EXTRUDER, "") + "IJK" + ("E" if code.act == "look-ahead" else "")
        if bare := set(code.takes) & set(own) - {*code.lengths}:
            yield name, f"{name} takes {sorted(bare)}, which are lengths, and does not say so"


def _families(dialect: type[Dialect]) -> Complaints:
    has = dialect.codes
    for family in canon.FAMILIES:
        family = tuple(code for code in family if code not in dialect.differs)
        lacking = [code for code in family if code not in has and code not in canon.LOOSE]
        if lacking and any(code in has for code in family if code not in canon.LOOSE):
            others = " ".join(code for code in family if code in has)
            yield lacking[0], f"there is {others} and no {lacking[0]}"
    if "G40" not in has and {"G41", "G42"} & set(has):
        yield "G40", "there is G41 and no G40"
    codes = {"XY": "G17", "ZX": "G18", "YZ": "G19"}
    for plane in sorted(dialect.arc_rule.planes):
        code = has.get(codes[plane])
        if code is None or not _done(code):
            yield "arc_rule.planes", f"there are arcs in {plane} and no {codes[plane]}"


def _m_codes(dialect: type[Dialect]) -> Complaints:
    for number, code in dialect.m_codes.items():
        name = f"M{number}"
        for message in _m_code(number, code):
            yield name, f"{name} {message}"
        unknown = set(code.takes) - set(dialect.block_rule.words + dialect.axes)
        if unknown:
            yield name, f"{name} takes {sorted(unknown)}, which are no words of the dialect"
        yield from _m_act(name, code)
        other = canon.STOPPED_BY.get(number, number)
        if other not in dialect.m_codes:
            yield name, f"there is {name} and no M{other}"


def _m_code(number: int, code: MCode) -> Iterator[str]:
    group = canon.GROUP_OF_M.get(number, code.group)
    if code.group != group:
        yield f"is of the group {code.group!r}; it is one of {group!r}"
    if code.after != canon.AFTER_M.get(number, code.after):
        yield f"acts {'before' if code.after else 'after'} the motion of its block on all controls"
    if code.ends != (number in canon.ENDS) and number not in canon.RETURNS:
        yield f"{'ends' if code.ends else 'does not end'} the program here, as nowhere else"
    if number in canon.CALLS and not (code.barrier or code.ends):
        yield "calls a program and is no barrier"


def _other_m(dialect: type[Dialect]) -> Complaints:
    user, change = dialect.block_rule.unknown_m, dialect.m_codes.get(6)
    if user is not None and not user.loses_position:
        text = "an M code that nobody knows may move axes; let unknown_m lose positions"
        yield "block_rule.unknown_m", text
    if user is not None and change is not None and not change.loses_position:
        yield "M6", "M6 runs a program of the machine here, as other M codes, and loses no position"
    if not canon.ENDS & set(dialect.m_codes):
        yield "m_codes", "no program ends: there is neither M2 nor M30"


def _m_act(name: str, code: MCode) -> Complaints:
    if not code.act:
        return
    if code.act not in canon.ACTS_OF_M:
        yield name, f"{name} has the act {code.act!r}, which M codes do not have"
        return
    group, needed = canon.ACTS_OF_M[code.act]
    if code.group != group:
        yield name, f"{name} has the act {code.act!r}, of {group!r}, and the group {code.group!r}"
    if set(needed) - set(code.takes):
        yield name, f"{name} has the act {code.act!r} and does not take {needed}"


def _starts(dialect: type[Dialect]) -> Complaints:
    """Check what a program starts in."""
    for group, code in dialect.initial.items():
        if group not in GROUPS:
            yield "initial", f"initial names the group {group!r}, which the core does not have"
            continue
        if group in OF_GROUP and code not in OF_GROUP[group]:
            yield "initial", f"initial[{group!r}] is {code!r}, which is no code of that group"
        if code not in canon.AT_START[group]:
            yield "initial", f"a program starts in {code}, and not in {canon.AT_START[group][0]}"
        has = {name for name, one in dialect.codes.items() if one.group == group}
        default = code == canon.AT_START[group][0] and group in ("arc-distance", "motion")
        if has and code not in dialect.codes and not default:
            yield "initial", f"initial[{group!r}] is {code}, which the dialect does not have"


def _ends(dialect: type[Dialect]) -> Complaints:
    """Check what the end of a program leaves behind."""
    for text in _left_at_end(dialect, dialect.program_rule):
        yield "program_rule.resets_at_end", text


def _left_at_end(dialect: type[Dialect], rule: ProgramRule) -> Iterator[str]:
    if rule.stops_at_end:
        if rule.resets_at_end:
            yield "the control stops at M2 and M30: nobody sees resets_at_end"
        return
    for group, code in canon.AT_END.items():
        left = rule.resets_at_end.get(group)
        if left != code:
            yield f"M2 and M30 leave {left} behind in the group {group!r}: {code}"
    for group, code in rule.resets_at_end.items():
        if group not in GROUPS or code not in dialect.codes or code not in NUMBER:
            yield f"M2 and M30 leave {code} behind, which the dialect lacks"


def _dwell(dialect: type[Dialect]) -> Complaints:
    rule = dialect.point_rule
    for text in _dwell_words(dialect, rule.dwell):
        yield "point_rule.dwell", text
    if rule.dwell_in_seconds and MILLISECONDS not in rule.dwell.values():
        yield "point_rule.dwell_in_seconds", "a dwell with a point is in seconds, as without one"


def _dwell_words(dialect: type[Dialect], units: Mapping[str, float]) -> Iterator[str]:
    if "G4" in dialect.codes and _done(dialect.codes["G4"]) and not units:
        yield "there is G4 and no word for its time"
    for word, unit in units.items():
        if word not in dialect.block_rule.words + dialect.axes:
            yield f"G4 takes {word}, which is no word of the dialect"
        if unit not in (SECONDS, MILLISECONDS):
            yield f"one unit of {word} in G4 is {unit:g} s; it is 1 s, or 0.001 s"
        if word in "XU" and unit != SECONDS:
            yield f"{word} of G4 is in seconds wherever it is known"
        for kin in (c for c in dialect.__mro__[1:] if issubclass(c, Dialect) and c.name):
            known = kin.point_rule.dwell.get(word, unit)
            if known != unit:
                yield f"{word} of G4 is {unit:g} s here and {known:g} s in {kin.name}"
    wanted = MILLISECONDS if _of_macros(dialect) else SECONDS if _of_ngc(dialect) else None
    if wanted is not None and units.get("P", wanted) != wanted:
        yield f"P of G4 is {wanted:g} s on the relatives of this control"


def _of_macros(dialect: type[Dialect]) -> bool:
    """Whether the control is a relative of Fanuc's, by its language and its words."""
    times = {"X", "U"} & set(dialect.point_rule.dwell)
    return dialect.flow_rule.language == "macro-b" or bool(times)


def _of_ngc(dialect: type[Dialect]) -> bool:
    """Whether the control is a relative of NIST's interpreter."""
    return dialect.flow_rule.language == "o-words" or "G38.2" in dialect.codes


def _offsets(dialect: type[Dialect]) -> Complaints:
    order = (*canon.WORK, *canon.MORE_WORK)
    rule, along = dialect.offset_rule, dialect.tool_rule.length_axes
    named = rule.g10_offsets
    if named != order[: len(named)]:
        text = f"P1, P2 ... of G10 name {' '.join(named)}, and not G54 G55 ..."
        yield "offset_rule.g10_offsets", text
    lacking = [c for c in named if c not in dialect.codes or dialect.codes[c].act != "work"]
    if lacking:
        text = f"G10 sets {lacking[0]}, which is no work offset of the dialect"
        yield "offset_rule.g10_offsets", text
    for one, two in combinations(sorted(rule.names), 2):
        if rule.names[one] == rule.names[two]:
            yield "offset_rule.names", f"{one} and {two} are both {rule.names[one]}"
    for code, name in rule.names.items():
        if code in order:
            yield "offset_rule.names", f"{code} has the name {name}; it is the one that others are"
        first = dialect.codes.get(name.split(" ", maxsplit=1)[0])
        if first is None or first.act != "work" or dialect.codes[code].act != "work":
            yield "offset_rule.names", f"{code} is called {name}, and one of them is no work offset"
    if set(along) - set(dialect.axes) or not along.endswith("Z"):
        yield "tool_rule.length_axes", f"a tool length lies along {along!r}, not along Z"


def _letters(dialect: type[Dialect]) -> Complaints:
    words, axes = dialect.block_rule.words, dialect.axes
    if len(set(words)) != len(words):
        yield "block_rule.words", f"a letter stands twice in words, {words!r}"
    if set(axes) - set(LINEAR + ROTARY):
        yield "axes", f"axes are {axes!r}; they are letters of {LINEAR + ROTARY}"
    order = ROTARY + "UVW" + EXTRUDER
    if list(axes[3:]) != sorted(axes[3:], key=order.find):
        yield "axes", f"axes are {axes!r}; behind XYZ they stand in the order {order}"
    wanted = "F" + ("IJK" if {"G2", "G3"} <= set(dialect.codes) else "")
    wanted += "S" * (3 in dialect.m_codes) + "T" * (6 in dialect.m_codes)
    if lacks := sorted(set(wanted) - set(words)):
        yield "block_rule.words", f"there are codes that want {lacks}, and no such words"
    turns = dialect.arc_rule.turns
    if turns and (turns not in words or turns in "FIJKRSTN"):
        yield "arc_rule.turns", f"{turns!r} counts the turns of arcs, and is another word"
    for begin in dialect.text_rule.active_comments:
        if begin != begin.upper().strip():
            text = f"{begin!r} is compared with capitals, and never found"
            yield "text_rule.active_comments", text


def _numbers(dialect: type[Dialect]) -> Complaints:
    numbers, rule = dialect.numbers, dialect.arc_rule
    for name, least in (("mm", 2), ("inch", 3), ("angle", 2)):
        if getattr(numbers, name) < least:
            yield "numbers", f"{getattr(numbers, name)} decimals of {name} are coarse: {least}"
    if numbers.inch < numbers.mm:
        yield "numbers", "a number has fewer decimals in inches than in mm, where it counts more"
    if not 0.0 < rule.absolute <= 0.1:
        yield "arc_rule", f"radii may differ by {rule.absolute:g} mm: 0.1 mm is much"
    if not 0.0 <= rule.relative <= 0.01:
        yield "arc_rule", f"radii may differ by {rule.relative:g} of the radius: 0.01 is much"
    if rule.relative and not rule.absolute < rule.largest <= 5.0:
        yield "arc_rule", f"radii may differ by {rule.largest:g} mm at most: 5 mm is much"
    if not 0.0 <= rule.smallest <= 0.1 or not 0.0 <= rule.r_short <= 0.1:
        yield "arc_rule", "the least radius, or what an R may fall short of, is above 0.1 mm"
    if not 1.0 <= rule.in_inch <= 25.4:
        yield "arc_rule", f"in inches radii may differ {rule.in_inch:g} times as much: 1 to 25.4"


def _cycles(dialect: type[Dialect]) -> Complaints:
    rule = dialect.cycle_rule
    if rule is None:
        return
    for name, code in dialect.codes.items():
        cycle = rule.cycles.get(int(float(name[1:])), NO_CYCLE)
        if name in canon.CYCLES and _done(code) and not (cycle.steps or cycle.refused):
            yield "cycle_rule", f"{name} has no steps and is not refused"
    if rule.repeats not in ("K", "L"):
        yield "cycle_rule", f"{rule.repeats!r} counts the holes of a cycle: K or L"
    for number, cycle in rule.cycles.items():
        for text in _cycle(number, cycle, dialect.block_rule.words):
            yield "cycle_rule", text


def _cycle(number: int, cycle: Cycle, words: str) -> Iterator[str]:
    """Yield what speaks against what is said of one cycle."""
    for name, known in (("pecks", canon.PECKS), ("needs", canon.CYCLE_NEEDS)):
        said = getattr(cycle, name)
        if cycle.steps and said != known.get(number, said):
            yield f"{name} of G{number} is {said!r}, not {known[number]!r}"
    if set(cycle.needs) - set(cycle.takes):
        yield f"G{number} needs {cycle.needs} and does not take it"
    if set(cycle.takes) - set(words):
        yield f"G{number} takes {cycle.takes}, which are not all words of the dialect"
    if cycle.spindle and cycle.spindle != canon.TURNING.get(number, cycle.spindle):
        yield f"G{number} wants the spindle to turn the other way"
    if cycle.steps and not canon.STEPS.get(number, bool)(cycle.steps):
        yield f"the steps of G{number} are those of another cycle"


def _tips(dialect: type[Dialect]) -> Complaints:
    rule = dialect.tip_rule
    tables = (("tip_rule.codes", rule.codes), ("tip_rule.vector_codes", rule.vector_codes))
    for table, codes in tables:
        for code, plain in codes.items():
            if code not in dialect.codes or _done(dialect.codes[code]):
                yield table, f"{code} follows the tip, and is no barrier of the dialect"
            if plain not in dialect.codes or dialect.codes[plain].act != "length":
                yield table, f"{plain} stands for {code}, and takes no tool length"
    switches = {kind: int(code[1:]) for kind, code in rule.switches.items()}
    if switches and set(switches) != {"tip-on", "tip-off"}:
        yield "tip_rule.switches", "there are two switches, tip-on and tip-off"
    for kind, number in switches.items():
        code_of = dialect.m_codes.get(number)
        if code_of is None or bool(code_of.barrier) != (kind == "tip-on"):
            text = f"M{number} is {kind}: M codes must have it, tip-on as a barrier"
            yield "tip_rule.switches", text


CHECKS = (
    _meanings, _groups, _acts, _words_of_codes, _families, _m_codes, _other_m, _starts, _ends,
    _dwell, _offsets, _letters, _numbers, _cycles, _tips,
)  # fmt: skip
