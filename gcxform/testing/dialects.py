"""`check_dialect`: whether a dialect's tables fit together, and whether it reads what it writes."""

from __future__ import annotations

import re
from collections.abc import Iterator

from gcxform.contract.passes import Pass, PassContext
from gcxform.diagnostics import GcxformError
from gcxform.dialect.codes import ISO, Effect
from gcxform.dialect.dialect import INCH, Dialect
from gcxform.emit.numbers import MOST_DECIMALS
from gcxform.flow.translated import translated
from gcxform.flow.translation import Translator, translator_of
from gcxform.modal.meaning.meaning import Meaning
from gcxform.modal.meaning.sorting import meaning_of
from gcxform.modal.meaning.tables import COLUMNS, GROUPS, NUMBER
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.syntax.shapes import Shape, slots_of
from gcxform.syntax.source import Source
from gcxform.testing.behaviour import check_doing
from gcxform.testing.one_command import written_for
from gcxform.testing.tables import check_declared
from gcxform.toolpath.path import Plane, Toolpath
from gcxform.values import dataclass

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
SET_ASIDE = "GMO"  # addresses whose value is a code
ARCS = {
    "XY": "G17 G2 X40. Y15. I0. J-10. F100.",
    "ZX": "G18 G3 X50. Z-11.5 I0. K-10. F100.",
    "YZ": "G19 G2 Y25. Z-1.5 J10. K0. F100.",
}
"""An arc in each plane, from (30, 25, -1.5); each starts where the one before it ends."""


class Common(Dialect):
    """What programs are written in that a dialect has to refuse or to translate."""

    name = "common"


@dataclass(frozen=True)
class Same(Pass):
    """Leave the path as it is, so that the program is read, written and verified."""

    name = "same"

    def apply(self, path: Toolpath, context: PassContext) -> Toolpath:
        """Return the path."""
        return path


def check_dialect(dialect: type[Dialect]) -> None:
    """Hold a dialect to its contract.

    Documented, a grammar that loads, tables that fit together, every code of them read and
    understood, tables and small programs that agree with what controls agree on, two of everything
    that has a number kept apart, a program that is written and read again as the same path, and a
    refusal with a code for everything it does not have. Raises AssertionError.
    """
    _check_declaration(dialect)
    _check_tables(dialect)
    check_declared(dialect)
    for code in dialect.codes:
        _check_code(dialect, code)
    for number in dialect.m_codes:
        _check_m_code(dialect, number)
    _check_refusals(dialect)
    check_doing(dialect)
    if dialect.translator is not None:
        _check_translator(dialect, translator_of(dialect))
        return
    _check_program(dialect)
    _check_planes(dialect)


def _check_translator(dialect: type[Dialect], kind: type[Translator]) -> None:
    """Check that an empty line stands for nothing, and that noise is refused with a place."""
    here = f"the translator of {dialect.name}"
    source = Source.of_bytes(b"\n\n")
    assert not translated(source, dialect, Reading()).size, f"{here} makes blocks of nothing"
    assert not kind.signs.search(b"\n"), f"{here} finds its signs in an empty program"
    try:
        translated(Source.of_bytes(b"\n?\n"), dialect, Reading())
    except GcxformError as error:
        (found,) = error.diagnostics
        where = found.where
        good = found.code == "GX101" and where is not None and where.line == 2
        assert good, f"{here} refuses '?' with {found}, not with GX101 and its line"
    else:
        raise AssertionError(f"{here} takes '?'")


def _check_declaration(dialect: type[Dialect]) -> None:
    here = dialect.__name__
    assert issubclass(dialect, Dialect), f"{here} is not a Dialect"
    assert NAME.fullmatch(dialect.name), f"{here} has the name {dialect.name!r}"
    assert dialect.__dict__.get("__doc__"), f"{here} has no docstring: which control, which version"
    try:
        block = dialect.load_grammar().parse("")
    except Exception as error:
        message = f"the grammar {dialect.grammar} of {dialect.name} does not load: {error}"
        raise AssertionError(message) from error
    assert block.error is None, f"the grammar of {dialect.name} refuses an empty block"


def _check_tables(dialect: type[Dialect]) -> None:
    """Check that the tables speak of things that exist."""

    def check(good: bool, message: str) -> None:
        assert good, f"{dialect.name}: {message}"

    axes = dialect.axes
    check(axes.startswith("XYZ"), f"axes are {axes!r}; X, Y and Z come first")
    check(len(set(axes)) == len(axes), f"an axis stands twice in {axes!r}")
    check(not set(axes) & set(dialect.block_rule.words), "a letter is an axis and a word")
    for group in GROUPS:
        code = dialect.initial.get(group, "")
        good = code in NUMBER or _is_work(dialect, code)
        check(good, f"initial[{group!r}] is {code!r}, which is no code of that group")
    planes = {plane.name for plane in Plane}
    cut = dialect.arc_rule.planes
    check(cut <= planes, f"arc_rule.planes are {set(cut)}, not {planes}")
    begins, slashes = dialect.text_rule.comments, dialect.program_rule.block_delete
    check(set(begins) <= set("(;"), f"comments begin with {begins!r}")
    check(slashes in ("", "execute", "skip"), "block_delete is not one of its words")
    numbers = dialect.numbers
    for name in ("mm", "inch", "angle", "feed"):
        places = getattr(numbers, name)
        check(0 <= places <= MOST_DECIMALS, f"{places} decimals of {name}: 0 to {MOST_DECIMALS}")
    check(dialect.arc_rule.absolute > 0, "arc_rule.absolute is the tolerance of arcs, above 0 mm")
    step = 10.0**-numbers.mm
    check(step < INCH, "lengths are written in whole inches")


def _is_work(dialect: type[Dialect], name: str) -> bool:
    """Whether a work offset is named by a code of the dialect and a number: G15 H1."""
    code = dialect.codes.get(name.partition(" ")[0])
    return code is not None and code.act == "work" and " " in name


def _meaning(dialect: type[Dialect], text: str) -> Meaning:
    """Return what a block means."""
    block = dialect.load_grammar().parse(text)
    return meaning_of(Shape(block, tuple(slots_of(block)), False), dialect)


def _check_code(dialect: type[Dialect], name: str) -> None:
    """Check that a G code is read and does what the table says."""
    here = f"{dialect.name}: {name}"
    assert re.fullmatch(r"G[0-9]+(\.[1-9])?", name), f"{here} is not how codes are called: G5.1"
    code = dialect.codes[name]
    unknown = set(code.takes) - set(dialect.block_rule.words + dialect.axes + SET_ASIDE)
    assert not unknown, f"{here} takes {sorted(unknown)}, which are no words of the dialect"
    if code.effect is Effect.MODAL:
        assert code.group in COLUMNS, f"{here}: the core has no group {code.group!r}; use inert"
        assert name in NUMBER, f"{here} is a modal code that the core does not know"
    word = next(iter(dialect.point_rule.dwell), "P") + "1." if code.effect is Effect.DWELL else ""
    word = "P1" if code.effect is Effect.CALL else word
    meaning = _meaning(dialect, f"{name} {word}".strip())
    refusal = meaning.refusal
    if code.effect is Effect.BARRIER:
        assert refusal is not None, f"{here} is a barrier and is not refused"
        assert refusal.code == "GX210", f"{here} is refused otherwise: {refusal.message}"
        assert code.reason, f"{here} is a barrier without a reason"
    else:
        assert refusal is None, f"{here} is in the table and is refused: {refusal.message}"
        assert meaning.groups.get(code.group) == name, f"{here} is not understood"


def _check_m_code(dialect: type[Dialect], number: int) -> None:
    """Check that an M code is read and becomes an event."""
    here = f"{dialect.name}: M{number}"
    meaning = _meaning(dialect, f"M{number}")
    refusal = meaning.refusal
    if dialect.m_codes[number].barrier:
        assert refusal is not None, f"{here} is a barrier and is not refused"
        assert refusal.code == "GX210", f"{here} is refused otherwise: {refusal.message}"
    else:
        assert refusal is None, f"{here} is in the table and is refused: {refusal.message}"
        events = [event.what for event in meaning.events]
        assert events == [f"M{number}"], f"{here} is not understood"


# --- programs ---


def program(dialect: type[Dialect]) -> str:
    """Return a small program of what a dialect has, absolute and in the unit it starts in."""
    has = dialect.codes
    modes = [code for code in (dialect.initial["units"], "G90", "G94", "G17") if code in has]
    modes += ["G91.1"] * dialect.arc_rule.centres_open
    lines = [" ".join(modes), "G0 X10. Y20. Z5."]
    if 3 in dialect.m_codes and "S" in dialect.block_rule.words:
        lines.append("S1000 M3")
    lines += ["G1 Z-1.5 F100.", "X30. Y25."]
    for plane, code in (("XY", "G17"), ("ZX", "G18"), ("YZ", "G19")):
        if plane not in dialect.arc_rule.planes or code not in has or not {"G2", "G3"} <= set(has):
            break
        lines.append(ARCS[plane])
    for axis in dialect.axes[3:]:
        lines.append(f"G1 {axis}10. F100.")
    waits = "G4" in has and has["G4"].effect is Effect.DWELL
    if waits and dialect.point_rule.dwell:
        lines.append(f"G4 {next(iter(dialect.point_rule.dwell))}1.")
    lines.append("G1 X31.25 F200.")
    lines += [f"M{number}" for number in (5, 30) if number in dialect.m_codes]
    return "\n".join(line for line in lines if line) + "\n"


def _check_program(dialect: type[Dialect]) -> None:
    """Check that a program is written anew, verified, and written the same way again."""
    text = written_for(dialect, program(dialect)).encode()
    try:
        pipeline = Pipeline(dialect, dialect, (Same(),), words="all")
        first = pipeline.run(text, verify="full")
        second = pipeline.run(first.text, verify="full")
    except GcxformError as error:
        said = text.decode()
        raise AssertionError(f"{dialect.name}: this program fails:\n{said}\n{error}") from None
    written = first.text.decode("latin-1")
    assert first.text != text, f"{dialect.name}: nothing is written anew:\n{written}"
    assert second.text == first.text, f"{dialect.name}: what it writes changes again:\n{written}"


def _lacking(dialect: type[Dialect]) -> Iterator[str]:
    """Yield blocks of what a dialect does not have."""
    yield from (f"{code} P1" for code in ISO if code not in dialect.codes)
    yield "G987"
    if dialect.block_rule.unknown_m is None:
        yield from (f"M{n}" for n in (3, 6, 8, 987) if n not in dialect.m_codes)
    known = dialect.axes + dialect.block_rule.words + SET_ASIDE
    yield from (f"{chr(c)}1." for c in range(65, 91) if chr(c) not in known)
    if not dialect.program_rule.has_program_number:
        yield "O1000"
    if not dialect.program_rule.has_percent:
        yield "% G0" if dialect.program_rule.drops_percent else "%"


def _check_refusals(dialect: type[Dialect]) -> None:
    """Check that what a dialect does not have is refused, with a code and a place."""
    for text in _lacking(dialect):
        refusal = _meaning(dialect, text).refusal
        here = f"{dialect.name} does not have {text!r}"
        assert refusal is not None, f"{here} and takes it"
        assert refusal.code in ("GX101", "GX201"), f"{here}: {refusal.code}, not GX201"


def _check_planes(dialect: type[Dialect]) -> None:
    """Check that arcs in planes the control lacks are refused when they are written."""
    for plane, arc in ARCS.items():
        if plane in dialect.arc_rule.planes:
            continue
        start = "G21 G90 G94\nG0 X30. Y25. Z-1.5\n"
        move = {"ZX": "G1 X40. F100.\n", "YZ": "G1 X50. Y15. Z-11.5 F100.\n"}.get(plane, "")
        codes = _codes(Pipeline(Common, dialect), f"{start}{move}{arc}\n")
        message = f"{dialect.name} has no arcs in {plane}; for one the codes are {codes}, not GX501"
        assert codes == {"GX501"}, message


def _codes(pipeline: Pipeline, text: str) -> set[str]:
    """Return the codes with which a program is refused."""
    try:
        pipeline.run(text.encode())
    except GcxformError as error:
        return {diagnostic.code for diagnostic in error.diagnostics}
    return set()
