"""Faults of parameters and expressions."""

from __future__ import annotations

from faults.mutation import CORPUS, Mutation


def _computed(name: str, file: str, old: str, new: str) -> Mutation:
    tests = "tests/test_expressions.py"
    return Mutation(f"computing: {name}", file, old, new, tests)


MUTATIONS = (
    _computed(
        "relations are as close as sums",
        "gcxform/dialect/arithmetic.py",
        "EQUAL = 1e-4",
        "EQUAL = 1e-9",
    ),
    _computed(
        "fractions are cut towards zero",
        "gcxform/dialect/arithmetic.py",
        "float(math.floor(a))",
        "float(int(a))",
    ),
    _computed(
        "MOD keeps the sign",
        "gcxform/dialect/arithmetic.py",
        "rest if rest >= 0 else rest + abs(b)",
        "rest",
    ),
    _computed(
        "XOR is OR", "gcxform/dialect/arithmetic.py", "(a != 0) != (b != 0)", "a != 0 or b != 0"
    ),
    _computed(
        "angles are in radians", "gcxform/dialect/arithmetic.py", "np.longdouble(a) * PI / 180", "a"
    ),
    _computed(
        "a sign is lost",
        "gcxform/modal/expressions/value.py",
        "-value if sign",
        "value if sign",
    ),
    _computed(
        "operands are swapped",
        "gcxform/modal/expressions/value.py",
        "(left), self",
        "(right), self",
    ),
    _computed(
        "names have their case", "gcxform/modal/expressions/value.py", "BLANKS).lower()", "BLANKS)"
    ),
    _computed(
        "what nobody set is zero",
        "gcxform/modal/expressions/value.py",
        "value = self.parameters.get(key)\n",
        "value = self.parameters.get(key, 0.0)\n",
    ),
    _computed(
        "assignments act at once",
        "gcxform/modal/expressions/assignments.py",
        "            made = [(key, result(lines.parameters, row)) "
        "for key, result in functions.assigned]",
        "            made = []\n"
        "            for key, result in functions.assigned:\n"
        "                made.append((key, result(lines.parameters, row)))\n"
        "                lines.parameters.update(made)",
    ),
    _computed(
        "parameters end with their window",
        "gcxform/modal/interpreter.py",
        "self.state.parameters = lines.parameters",
        "pass",
    ),
    Mutation(
        "an assignment stands in every piece of its block",
        "gcxform/emit/templates.py",
        "elif self.key.role not in (Role.MIDDLE, Role.LAST):\n            self._statement",
        "else:\n            self._statement",
        "tests/test_corpus.py",
    ),
    Mutation(
        "what a macro may have set is still known",
        "gcxform/modal/expressions/assignments.py",
        "if self.meaning.runs_macro and",
        "if False and",
        "tests/test_corpus.py",
    ),
    Mutation(
        "computed distances are not rounded to the increment",
        "gcxform/modal/numbers_without_point.py",
        "np.where(computed, rounded, np",
        "np.where(computed, value, np",
        "tests/test_expressions.py",
    ),
    Mutation(
        "what only the machine knows is taken for zero",
        "gcxform/modal/expressions/assignments.py",
        "            return value\n        return UNKNOWN",
        "            return value\n        return 0.0",
        "tests/test_expressions.py",
    ),
    Mutation(
        "words of arcs may be unknown",
        "gcxform/modal/expressions/assignments.py",
        "if why.lost and may_be_unknown(word.address, self.meaning):",
        "if why.lost:",
        CORPUS,
    ),
    Mutation(
        "what the machine computes may be in another unit",
        "gcxform/emit/depending.py",
        "if each.hangs_on and now.inch[line] != old.inch[line]:",
        "if False:",
        CORPUS,
    ),
    Mutation(
        "what the machine computes may be read elsewhere",
        "gcxform/emit/depending.py",
        "return not bool(self.same.modes()[line]) or self._stands_elsewhere(line)",
        "return False",
        CORPUS,
    ),
    Mutation(
        "texts of what the machine computes are not compared",
        "gcxform/modal/events.py",
        "events.append(Event(row, each.text, (), each.line + first_line))",
        'events.append(Event(row, "?", (), each.line + first_line))',
        "tests/test_planted_inventory.py",
    ),
    Mutation(
        "a feed that only the machine knows is in force no more",
        "gcxform/modal/lines.py",
        "self.state.feed_lost = bool(self.feed_lost[-1])",
        "pass",
        "tests/test_corpus.py::test_windows_make_no_difference[expressions/lost-feed]",
    ),
    Mutation(
        "a feed that is not known is left out",
        "gcxform/emit/needed_modes.py",
        "        kept |= unknown\n",
        "",
        CORPUS,
    ),
    Mutation(
        "cycles may go where only the machine knows",
        "gcxform/modal/moves/cycle_patterns.py",
        "if self.modes.cycle[line] == CYCLE_OFF or address not in self.track.axes:",
        "if True:",
        CORPUS,
    ),
    Mutation(
        "straight: a line reads what it sets",
        "gcxform/modal/expressions/straight.py",
        "np.searchsorted(setting, lines) - 1",
        'np.searchsorted(setting, lines, "right") - 1',
        "tests/properties/test_straight.py",
    ),
    Mutation(
        "straight: assignments of a block in any order",
        "gcxform/modal/expressions/straight.py",
        "np.lexsort((places, lines))",
        "np.argsort(lines[::-1])",
        "tests/properties/test_straight.py",
    ),
    Mutation(
        "straight: the first value is that before the window",
        "gcxform/modal/expressions/straight.py",
        "np.where(last >= 0, values[last], start)",
        "values[last]",
        "tests/properties/test_straight.py",
    ),
    Mutation(
        "straight: lines of two outlines are not put in order",
        "gcxform/modal/expressions/straight.py",
        'np.argsort(every, kind="stable")',
        "np.arange(len(every))",
        "tests/properties/test_straight.py",
    ),
    Mutation(
        "outlines: what nobody set is zero",
        "gcxform/modal/expressions/compiled.py",
        "parameters.get(key, np.nan)",
        "parameters.get(key, 0.0)",
        "tests/properties/test_outlines.py",
    ),
    Mutation(
        "outlines: parameters that a line sets count for lines before it",
        "gcxform/modal/expressions/assignments.py",
        "np.flatnonzero(writes[self.lines.shape[self.having]]).tolist()",
        "np.flatnonzero(writes[self.lines.shape[self.having]]).tolist()[::2]",
        "tests/properties/test_outlines.py",
    ),
    Mutation(
        "outlines: signs are lost",
        "gcxform/syntax/layout.py",
        "found.value[at] * self.signs[has]",
        "found.value[at]",
        "tests/properties/test_reading.py",
    ),
    Mutation(
        "scan: numbers of many digits are what their last digits say",
        "gcxform/syntax/scan.py",
        "    _read_long(value, runs, text)\n",
        "",
        "tests/properties/test_reading.py::test_numbers_are_those_of_python",
    ),
    Mutation(
        "outlines: numbers of many digits are what their last digits say",
        "gcxform/syntax/outlines.py",
        "np.flatnonzero(long & ~wrong)",
        "np.flatnonzero(long & wrong)",
        "tests/properties/test_reading.py::test_outlines_say_what_the_grammar_says",
    ),
    Mutation(
        "outlines: executed comments are text",
        "gcxform/syntax/outlines.py",
        "[at for at in signs.tolist() if self.looks.match(text, at)]",
        "[]",
        "tests/properties/test_outlines.py::test_a_comment_that_is_executed_is_no_slot_of_one_that_is_not",
    ),
    Mutation(
        "outlines: a comment that is executed begins with a capital letter",
        "gcxform/syntax/outlines.py",
        "letters.upper() + letters.lower() +",
        "letters.upper() +",
        "tests/properties/test_outlines.py",
    ),
    Mutation(
        "outlines: a comment that is executed has no blank before its name",
        "gcxform/syntax/outlines.py",
        '+ "(; \\t")',
        '+ "(;")',
        "tests/properties/test_outlines.py",
    ),
    Mutation(
        "outlines: comments to the end of a line are like those in brackets",
        "gcxform/syntax/outlines.py",
        "np.where(self.raw[start] == 40, COMMENT, TAIL)",
        "COMMENT",
        "tests/properties/test_reading.py",
    ),
    Mutation(
        "outlines: a block written anew has the comment of the first of its outline",
        "gcxform/emit/templates.py",
        "return -1 if layout is None else layout",
        "return -1 if layout is not None else layout",
        "tests/properties/test_outlines.py",
    ),
    Mutation(
        "outlines: a line that is not clear gives its outline to the next",
        "gcxform/syntax/outlines.py",
        "keys if len(clear) == len(keys) else",
        "keys if True else",
        "tests/properties/test_reading.py",
    ),
    Mutation(
        "shapes: a number with two points is one",
        "gcxform/syntax/scan.py",
        "owner[1:][owner[1:] == owner[:-1]]",
        "owner[:0]",
        "tests/properties/test_reading.py::test_outlines_say_what_the_grammar_says",
    ),
    Mutation(
        "outlines: a line that has none has the last shape there is",
        "gcxform/syntax/scan.py",
        "np.where(outlined >= 0, outlined, shape[found.lines])",
        "outlined",
        "tests/properties/test_reading.py",
    ),
    Mutation(
        "outlines: columns may be infinite",
        "gcxform/modal/expressions/compiled.py",
        "    if not np.isfinite(result).all():\n        raise NoColumnError\n    return result",
        "    return np.nan_to_num(result)",
        "tests/properties/test_outlines.py",
    ),
    Mutation(
        "computing: a half below zero is rounded",
        "gcxform/dialect/arithmetic.py",
        "and (off or a < 0):",
        "and off:",
        "tests/test_corpus.py::test_case[expressions/fanuc-doubtful]",
    ),
    Mutation(
        "computing: what is nearly a half is rounded",
        "gcxform/dialect/arithmetic.py",
        "and (off or a < 0):",
        "and a < 0:",
        "tests/test_corpus.py::test_case[expressions/fanuc-doubtful]",
    ),
    Mutation(
        "computing: a place that is 0 has the sign of a plus",
        "gcxform/flow/owords.py",
        "if any(found.get(key) == 0 for key in POSITIONS):",
        "if False:",
        "tests/test_corpus.py::test_case[flow/zero-of-a-place]",
    ),
    Mutation(
        "computing: the angle of a zero hangs on no sign",
        "gcxform/flow/places.py",
        "if y == 0 and x <= 0:",
        "if y == 0 and x == 0:",
        "tests/test_corpus.py::test_case[flow/zero-of-a-place]",
    ),
)
