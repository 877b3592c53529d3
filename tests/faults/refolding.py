"""Faults of programs that come back in their own lines, by what is read and compared, and cases."""

from __future__ import annotations

from faults.mutation import Mutation

OWN_LINES = "gcxform/emit/own_lines.py"
ALIKE = "gcxform/emit/alike_lines.py"
ALIKE_TESTS = "tests/test_alike_lines.py"
PROOF = "gcxform/proof/refolded.py"
BLOCKS = "gcxform/flow/block_words.py"
FRAMES = "plugins/gcxform_plugins/dialects/siemens/frames.py"
UNROLLING = "gcxform/emit/unrolling.py"
TRANSLATION = "gcxform/flow/translation.py"
SETTING = "plugins/gcxform_plugins/dialects/siemens/setting.py"
PLACE = "plugins/gcxform_plugins/dialects/siemens/in_place.py"
WORDS = "plugins/gcxform_plugins/dialects/siemens/words_moved.py"
MOVED = "plugins/gcxform_plugins/dialects/shared/words_moved.py"
COMPARED = "tests/test_refolded.py::test_what_came_back_is_read_and_compared"
CASES = "tests/test_corpus.py::test_case[dialects/siemens/own-lines"


def _own(name: str, file: str, old: str, new: str, tests: str) -> Mutation:
    return Mutation(f"own lines: {name}", file, old, new, tests)


MUTATIONS = (
    _own(
        "of alike lines words are written anew that say the same",
        ALIKE,
        "old is not None and new is not None and _same(before.get(letter), new)",
        "False",
        f"{ALIKE_TESTS}::test_a_form_is_filled_and_told",
    ),
    _own(
        "where axes stand behind alike lines is not known",
        ALIKE,
        "AXES & words.keys()",
        "frozenset[str]()",
        f"{ALIKE_TESTS}::test_a_form_is_filled_and_told",
    ),
    _own(
        "lines in a shifted frame are alike as well",
        OWN_LINES,
        "frame, frame is None or inside == named",
        "frame, True",
        f"{ALIKE_TESTS}::test_what_is_alike_is_spelled_as_word_by_word",
    ),
    _own(
        "comments are not compared",
        PROOF,
        "_comments(blocks) != _comments(found.text)",
        "_comments(blocks) is None",
        COMPARED,
    ),
    _own(
        "what is left to others is not compared",
        PROOF,
        "now.get(name) != value for name",
        "False for name",
        COMPARED,
    ),
    _own(
        "words count outside of the shift",
        FRAMES,
        "v if steps else v - zero[axis]",
        "v if steps else v + zero[axis]",
        f"{CASES}]",
    ),
    _own(
        "steps are shifted",
        FRAMES,
        "{axis: v if steps else v - zero[axis]",
        "{axis: v - zero[axis]",
        f"{CASES}-steps]",
    ),
    _own(
        "steps in a turn count from its zero",
        FRAMES,
        "(Frame(frame.matrix) if steps else frame).inside(known)",
        "frame.inside(known)",
        f"{CASES}-turned]",
    ),
    _own(
        "a step that stays a step is not one any more",
        WORDS,
        'self._number(word, new, "IC" if word.way == "IC" else "")',
        'self._number(word, new, "")',
        f"{CASES}-steps]",
    ),
    _own(
        "words that an arc had stay in its lines",
        MOVED,
        "self.straightened = self.was.bends and not self._same_arc()",
        "self.straightened = False",
        f"{CASES}-cut]",
    ),
    _own(
        "words beside IC are positions",
        WORDS,
        '("IC" if self.change.steps else "AC") if {"AC"',
        '("AC") if {"AC"',
        f"{CASES}-steps]",
    ),
    _own(
        "lines that count from where an axis stands stay",
        OWN_LINES,
        "was == made and line not in self.counting",
        "was == made",
        f"{CASES}-steps]",
    ),
    _own(
        "where axes stand is not added up",
        BLOCKS,
        'return said[-1] == "G91" if said else before',
        'return said[-1] == "G91" if said else False',
        f"{CASES}-steps]",
    ),
    _own(
        "a loop that its last line ends is written out without its head",
        UNROLLING,
        "self._loops[(begins <= last) & (first <= ends)]",
        "self._loops[:0]",
        f"{CASES}-loop]",
    ),
    _own(
        "what a jump out of a loop passes over is executed",
        UNROLLING,
        "(first, behind - 1)",
        "(first, last)",
        f"{CASES}-jumps]",
    ),
    _own(
        "a jump into a loop stays",
        UNROLLING,
        "if begin and lines[begin] != first:",
        "if False:",
        "tests/test_corpus.py::test_case[dialects/fagor/own-lines-jumps]",
    ),
    _own(
        "half of IF with ELSE is written out",
        PLACE,
        '(part for part in self._parts() if part.kind == "IF")',
        "()",
        f"{CASES}-jumps]",
    ),
    _own(
        "what is written out has no label",
        PLACE,
        'return f"{head[0].rstrip()} {text}" if head and head[0].strip() else text',
        "return text",
        f"{CASES}-jumps]",
    ),
    _own(
        "what is called behind a line is not written out with it",
        UNROLLING,
        "self.own[behind[0]] - 1 if",
        "self.own[behind[0] - 1] if",
        f"{CASES}-called]",
    ),
    _own(
        "another call than that of the line is written out",
        UNROLLING,
        'np.searchsorted(self.own, visit, "right")) - 1',
        'np.searchsorted(self.own, visit, "right")) - 2',
        f"{CASES}-called]",
    ),
    _own(
        "a jump is noted a line late",
        TRANSLATION,
        "self.jumps.append((self.visit + 1, self.at))",
        "self.jumps.append((self.visit + 1, self.at + 1))",
        f"{CASES}-loop]",
    ),
    _own(
        "what is written out sets nothing",
        SETTING,
        'return [" ".join(said)] if said else []',
        "return []",
        f"{CASES}-loop]",
    ),
    _own(
        "a loop that is written out counts nothing",
        SETTING,
        'return [f"{name}={first}" if begins else f"{name}={name}+1"]',
        "return []",
        f"{CASES}-counter]",
    ),
    _own(
        "R by an index is set by no call",
        SETTING,
        '"R[0-9]|R[ \\t]*\\["',
        '"R[0-9]"',
        f"{CASES}-counter]",
    ),
    _own(
        "words without blanks are where the first of their shape has them",
        PLACE,
        "computed = self.placed_items(line)",
        "computed = self.items(line)",
        f"{CASES}-glued]",
    ),
    _own(
        "variables of a call are set by who called",
        SETTING,
        """    if not own:
        said""",
        """    if False:
        said""",
        f"{CASES}-called]",
    ),
    _own(
        "nobody is told what a loop counted",
        PROOF,
        "if now.get(name, left) is not None",
        "if now.get(name, left) is None",
        f"{CASES}-loop]",
    ),
    _own(
        "a distance that what is written out left in force stays",
        OWN_LINES,
        "self.owed = self.translator.lasting",
        "self.owed = MOTIONS & self.translator.lasting",
        f"{CASES}-owed]",
    ),
    _own(
        "a distance that pieces of a step left in force stays",
        OWN_LINES,
        "self.owed |= DISTANCES",
        "self.owed |= NOTHING",
        f"{CASES}-owed]",
    ),
    Mutation(
        "own lines: a cycle may be called behind each piece of a line",
        "gcxform/emit/refolding.py",
        "if not why and len(text or ()) > 1 and visit in self.translator.called_behind:",
        "if False:",
        "tests/test_corpus.py::test_case[dialects/siemens/own-lines-holes-lean]",
    ),
    Mutation(
        "own lines: what MCALL drills goes without it",
        "plugins/gcxform_plugins/dialects/siemens/in_place.py",
        "return [*loops, *self._holes_of_mcall()]",
        "return [*loops]",
        "tests/test_corpus.py::test_case[dialects/siemens/own-lines-holes-lean]",
    ),
    Mutation(
        "own lines: MCALL of another cycle goes with the one before",
        "plugins/gcxform_plugins/dialects/siemens/in_place.py",
        "yield first, behind - (not ends)",
        "yield first, min(behind, self.main.stop - 1)",
        "tests/test_corpus.py::test_case[dialects/siemens/own-lines-holes-lean-again]",
    ),
)
