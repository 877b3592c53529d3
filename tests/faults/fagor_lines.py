"""Faults of a Fagor's programs that come back in their own lines."""

from __future__ import annotations

from faults.mutation import Mutation

PLACE = "plugins/gcxform_plugins/dialects/fagor/"
WORDS, IN_PLACE, SETTING = (f"{PLACE}{name}.py" for name in ("words_moved", "in_place", "setting"))
SHARED = "plugins/gcxform_plugins/dialects/shared/words_moved.py"
CASE = "tests/test_corpus.py::test_case[dialects/fagor/own-lines"
STAMPS = "tests/test_fagor_own_lines.py::test_a_stamp_and_its_seal_stand_in_the_lines"


def _fagor(name: str, file: str, old: str, new: str, case: str) -> Mutation:
    return Mutation(f"fagor, own lines: {name}", file, old, new, case)


MUTATIONS = (
    _fagor(
        "a step that became a place is a step still",
        WORDS,
        'way = STEP if steps and word.way else ""',
        "way = word.way",
        f"{CASE}-steps]",
    ),
    _fagor(
        "what counts from where an axis stands stays",
        "gcxform/flow/translation.py",
        "self.counted.add(self.line)",
        "pass",
        f"{CASE}-polar]",
    ),
    _fagor(
        "a step from nowhere is written out",
        "gcxform/emit/own_lines.py",
        "if was == made and ahead == leads:",
        "if False:",
        f"{CASE}-steps]",
    ),
    _fagor(
        "polar words stay beside X and Y",
        WORDS,
        "if self.polar and word.name in POLAR:",
        "if False:",
        f"{CASE}-polar]",
    ),
    _fagor(
        "X and Y stand behind all that was beside polar words",
        WORDS,
        "places = [each for each in words if each[0] in self.axes] if first else []",
        "places = list[str]()",
        f"{CASE}-polar]",
    ),
    _fagor(
        "a centre that was the pole is none",
        WORDS,
        "self.straightened |= self.polar and self.was.bends",
        "pass",
        f"{CASE}-comp]",
    ),
    _fagor(
        "a centre from the work zero counts from the start",
        WORDS,
        'return ["G6"] if centred else []',
        "return []",
        f"{CASE}-comp]",
    ),
    _fagor(
        "what is put in the place of a word has a blank more",
        SHARED,
        '("" if blank else " ")',
        '" "',
        f"{CASE}-comp]",
    ),
    _fagor(
        "the levels of a cycle are words of a place",
        WORDS,
        "if self.drills and word.name in OF_DRILLING:",
        "if False:",
        f"{CASE}-drilled]",
    ),
    _fagor(
        "one line of a cycle is written out alone",
        IN_PLACE,
        ", *self._holes]",
        "]",
        f"{CASE}-holes]",
    ),
    _fagor(
        "a line under a cycle is said anew in its place",
        IN_PLACE,
        "return None if self.reading.asides and holes else",
        "return",
        f"{CASE}-levels]",
    ),
    _fagor(
        "what no block says is lost with a line",
        SETTING,
        "for item in items} & STAND",
        "for item in items} & frozenset[str]()",
        f"{CASE}-levels]",
    ),
    _fagor(
        "the centre of a turn has its places the other way round",
        f"{PLACE}lines.py",
        'zip("QIJ", "RXY", strict=True)',
        'zip("QIJ", "RYX", strict=True)',
        f"{CASE}-turned]",
    ),
    _fagor(
        "a pole that is computed is lost with its line",
        SETTING,
        "return [_without_head(code(text))] if alone else None",
        "return []",
        f"{CASE}-turned]",
    ),
    _fagor(
        "half of what begins with $IF is written out",
        "gcxform/emit/unrolling.py",
        "in self._parting[low:high, 1].tolist()}",
        "in ()}",
        f"{CASE}-loop]",
    ),
    _fagor(
        "what is written out has no number to jump to",
        IN_PLACE,
        'return f"{head[0].rstrip()} {text}" if head and head[0].strip() else text',
        "return text",
        f"{CASE}-loop]",
    ),
    _fagor(
        "lines of a subroutine are those of the program",
        IN_PLACE,
        "return self.begin <= line < self.own",
        "return line < self.own",
        f"{CASE}-called]",
    ),
    _fagor(
        "a subroutine's parameter stands in what is set for all",
        SETTING,
        "if made is not None and any(map(is_local, said)):",
        "if False:",
        f"{CASE}-called]",
    ),
    _fagor(
        "a subroutine has the parameters of the program",
        IN_PLACE,
        "shared = not at or self.sharing[at - 1][1]",
        "shared = True",
        f"{CASE}-called]",
    ),
    _fagor(
        "what a subroutine shares is not set",
        SETTING,
        '*([" ".join(said)] if said else [])',
        "",
        f"{CASE}-file]",
    ),
    _fagor(
        "$FOR counts up",
        SETTING,
        "{number[1] or '+'}",
        "+",
        f"{CASE}-counter]",
    ),
    _fagor(
        "what goes along has the names of its parameters",
        f"{PLACE}computing.py",
        "lambda found: self._value_of(found[0], item)",
        "lambda found: found[0]",
        f"{CASE}-valued]",
    ),
    _fagor(
        "stamps stand before the name of the program",
        IN_PLACE,
        'if text and text[0] != "%"',
        "if text",
        STAMPS,
    ),
)
