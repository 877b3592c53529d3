"""Faults of Klartext that comes back in its own lines, by what is read and compared, and cases."""

from __future__ import annotations

from faults.mutation import Mutation

HEIDENHAIN = "plugins/gcxform_plugins/dialects/heidenhain"
WORDS = f"{HEIDENHAIN}/words_moved.py"
PLACE = f"{HEIDENHAIN}/in_place.py"
SETTING = f"{HEIDENHAIN}/setting.py"
OWN_LINES = "gcxform/emit/own_lines.py"
REFOLDING = "gcxform/emit/refolding.py"
UNROLLING = "gcxform/emit/unrolling.py"
BLOCKS = "gcxform/flow/block_words.py"
TESTS = "tests/test_refolded_klartext.py"
CASES = "tests/test_corpus.py::test_case[dialects/heidenhain/own-lines"


def _own(name: str, file: str, old: str, new: str, tests: str) -> Mutation:
    return Mutation(f"own lines of Klartext: {name}", file, old, new, tests)


MUTATIONS = (
    _own(
        "a step says where it leads",
        WORDS,
        "word.saying(new - stands)",
        "word.saying(new)",
        f"{CASES}]",
    ),
    _own(
        "a step by a parameter is one from where the axis stands now",
        WORDS,
        "said = self.old[axis] - stood",
        "said = self.old[axis] - stands",
        f"{TESTS}::test_steps_by_a_parameter_stay_where_they_are_the_same",
    ),
    _own(
        "a feed of a program in inches is in inches",
        WORDS,
        "value.scaleb(-1 if down else 1) if self.place.inch else value",
        "value",
        f"{CASES}-inches]",
    ),
    _own(
        "an arc that became a line is one still",
        WORDS,
        'self.made.append((*self.path.place, "L"))',
        "self.made.append((*self.path.place, self.path.name))",
        f"{CASES}-cut]",
    ),
    _own(
        "the side of a contour that is offset stays",
        WORDS,
        'self.change.modes.get("side", "") in OFF:',
        "False:",
        f"{CASES}-contour]",
    ),
    _own(
        "axes stand in no order",
        WORDS,
        "ORDER.index(w.name[-1]) > ORDER.index(axis)",
        "ORDER.index(w.name[-1]) < ORDER.index(axis)",
        f"{CASES}]",
    ),
    _own(
        "a line whose axes stand where they are to go has none",
        WORDS,
        "for axis in moving if moving or named else lacking:",
        "for axis in moving:",
        f"{CASES}-polar]",
    ),
    _own(
        "steps behind a corner count from where its rounding ends",
        PLACE,
        "counts=not CORNER.match(before)",
        "counts=True",
        f"{CASES}-corners]",
    ),
    _own(
        "lines beside a corner do not hang on it",
        PLACE,
        "return [*found, *beside, *aside, *open_]",
        "return [*aside, *open_]",
        f"{CASES}-corners]",
    ),
    _own(
        "lines that only say a side are not asked",
        PLACE,
        "return [*found, *beside, *aside, *open_]",
        "return [*found, *beside, *open_]",
        f"{CASES}-contour]",
    ),
    _own(
        "a part of polar coordinates stays behind a line",
        PLACE,
        "return [*found, *beside, *aside, *open_]",
        "return [*found, *beside, *aside]",
        f"{CASES}-polar]",
    ),
    _own(
        "nobody sees that the line beside another changed",
        OWN_LINES,
        "beside = self._differs(first - 1) or self._differs(stop)",
        "beside = False",
        f"{CASES}-corners]",
    ),
    _own(
        "words of a line are those of its last block",
        OWN_LINES,
        "if was == made and ahead == leads:",
        "if False:",
        f"{CASES}-contour]",
    ),
    _own(
        "words of a shift are where the axes stand",
        OWN_LINES,
        "block.positions if block.moves else ()",
        "block.positions",
        f"{CASES}-datum]",
    ),
    _own(
        "a motion that an alike line says is not known",
        OWN_LINES,
        "self.now.say(block_of(now))",
        "pass",
        f"{TESTS}::test_what_is_alike_is_spelled_as_word_by_word",
    ),
    _own(
        "numbers of alike lines have no plus",
        BLOCKS,
        'plus = self.signed and letter != "F"',
        'plus = False and letter != "F"',
        f"{TESTS}::test_what_is_alike_is_spelled_as_word_by_word",
    ),
    _own(
        "block numbers stay where a line became several",
        REFOLDING,
        "if of != [*range(line + 1)]:",
        "if False:",
        f"{CASES}-cut]",
    ),
    _own(
        "lines are written out where others call them as well",
        UNROLLING,
        "return bool(unit.begin <= self.own[first] and self.own[last] <= unit.end)",
        "return True",
        f"{CASES}-calls]",
    ),
    _own(
        "a loop that calls is written out with the label",
        UNROLLING,
        "level = begin + np.flatnonzero(self.depth[begin:stop] == self.depth[at])",
        "level = np.arange(len(self.own))",
        f"{TESTS}::test_a_loop_that_calls_is_written_out_without_what_it_calls",
    ),
    _own(
        "what is written out within another is written out twice",
        UNROLLING,
        "if unit.begin > behind]",
        "]",
        f"{TESTS}::test_what_is_within_what_is_written_out_is_so_with_it",
    ),
    _own(
        "where a call ends is not noted",
        f"{HEIDENHAIN}/labels.py",
        """        call = self.calls.pop()
        self.deep.append((self.visit, len(self.calls)))""",
        "        call = self.calls.pop()",
        f"{CASES}-calls]",
    ),
    _own(
        "a cycle that is defined where lines are written out is lost",
        SETTING,
        "{*HOLES, TAP, *KEPT, *IN_LINES}",
        "IN_LINES",
        f"{CASES}-loop]",
    ),
    _own(
        "statements before the last of a shift are lost",
        SETTING,
        "{*HOLES, TAP, *KEPT, *IN_LINES}",
        "{*HOLES, TAP, *KEPT}",
        f"{CASES}-frames]",
    ),
    _own(
        "a shift by steps is said anew",
        PLACE,
        "if not goes and change.was == change.now:",
        "if False:",
        f"{CASES}-frames]",
    ),
    _own(
        "what a line sets that stands as it did is set twice",
        REFOLDING,
        "if run is not None and self.translator.stands_alone(line):",
        "if False:",
        f"{CASES}-loop]",
    ),
    _own(
        "a pattern that became moves sets nothing",
        SETTING,
        "for each in found if each[2] or each[3]]",
        "for each in found if each[1] == each[2]]",
        f"{CASES}-holes]",
    ),
    _own(
        "parameters of a program that is called are set by who calls",
        SETTING,
        'stays = (target and target[1].upper() == "QL") or CENTRE.match(text)',
        "return said",
        f"{CASES}-programs]",
    ),
    _own(
        "a hole that is written out is moves, where its cycle says it",
        PLACE,
        "return own and FLOW.match(text) is None and not goes_on(text)",
        "return False",
        f"{CASES}-loop]",
    ),
    _own(
        "Q parameters are left to nobody",
        PLACE,
        'if key[:2] != "QL"}',
        "if False}",
        f"{TESTS}::test_what_came_back_is_read_and_compared",
    ),
    _own(
        "what outlives the program a block says, or nobody",
        PLACE,
        "visit in self.unsaid",
        "False",
        f"{CASES}-outlives]",
    ),
    _own(
        "QL that is sent is one of who calls",
        SETTING,
        "in {*PRINTS, *STANDS, WRITES}",
        "in ()",
        f"{CASES}-tells-local]",
    ),
    _own(
        "QL that a form prints is one of who calls",
        PLACE,
        "and self._has_local:",
        "and False:",
        f"{CASES}-prints-local]",
    ),
    Mutation(
        "refolding: a line with a slash may become another",
        "gcxform/emit/refolding.py",
        "if self.new.get(line, stays) != stays:",
        "if False:",
        "tests/test_corpus.py::test_case[dialects/heidenhain/slash-of-a-line-that-changes]",
    ),
)
