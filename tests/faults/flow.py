"""Faults of subprograms, loops and jumps."""

from __future__ import annotations

from faults.mutation import FACTS, Mutation

CASES = "tests/test_corpus.py::test_case"
AGREES = "tests/properties/test_flow.py"


def _flow(name: str, file: str, old: str, new: str, tests: str = CASES) -> Mutation:
    return Mutation(f"flow: {name}", file, old, new, tests)


MUTATIONS = (
    _flow(
        "a file of a name is not asked for what it begins",
        "gcxform/flow/named_files.py",
        "if file is not None and here is not None:",
        "if False:",
    ),
    _flow(
        "what stands before a call in a file is found",
        "gcxform/flow/named_files.py",
        "if behind is None or (first and behind < line):",
        "if behind is None:",
    ),
    _flow(
        "what was passed over is forgotten in a file",
        "gcxform/flow/owords.py",
        "met.setdefault(word.label, self.line)",
        "met.get(word.label, self.line)",
    ),
    _flow(
        "a caller finds other modes behind a subprogram",
        "gcxform/pipeline/subprogram.py",
        "if codes := _left_otherwise(run):",
        "if codes := ():",
    ),
    _flow(
        "a caller finds another motion behind a subprogram",
        "gcxform/pipeline/subprogram.py",
        "if lost:",
        "if False:",
    ),
    _flow(
        "the modes of a caller are taken for the usual ones",
        "gcxform/pipeline/subprogram.py",
        "if uses.any():",
        "if False:",
    ),
    _flow(
        "[entry] is not read",
        "gcxform/pipeline/subprogram.py",
        "{**dialect.initial, **groups}",
        "dialect.initial",
    ),
    _flow(
        "a file with another number is taken",
        "gcxform/flow/numbered_files.py",
        "number in numbers or (",
        "True or (",
    ),
    _flow(
        "of two files the first is taken", "gcxform/flow/lookup.py", "found}) > 1:", "found}) > 9:"
    ),
    _flow(
        "a link leads out of its folder",
        "gcxform/flow/lookup.py",
        "if os.path.commonpath([real, root]) != root:",
        "if False:",
        "tests/test_lookup.py",
    ),
    _flow(
        "the end of a file is a return",
        "gcxform/flow/execution.py",
        "if self.at > self.listing.own:",
        "if False:",
    ),
    _flow(
        "a jump leads into another file",
        "gcxform/flow/macros.py",
        "self.bounds = [*(self.bounds or [0]), line + 1]",
        "pass",
    ),
    _flow(
        "lines of a file are those of the program",
        "gcxform/flow/listing.py",
        "return file.name, line - file.first + 1",
        "return self.file, line + 1",
    ),
    _flow(
        "a call keeps the values of its caller", "gcxform/flow/owords.py", "if k not in own}", "}"
    ),
    _flow("what is not given is one", "gcxform/flow/owords.py", "*[0.0] *", "*[1.0] *", AGREES),
    _flow(
        "names are not local", "gcxform/flow/owords.py", "not RS274.outlives(key)", "key in LOCALS"
    ),
    _flow(
        "nothing lasts", "gcxform/flow/lasting_values.py", "if not self.program.keeps:", "if True:"
    ),
    _flow(
        "a message counts from before its block",
        "gcxform/flow/execution.py",
        "self.set(dict(changes))\n        for",
        "for",
    ),
    _flow(
        "a subprogram that is called is kept",
        "gcxform/flow/uncalled_subprograms.py",
        "or not program.times[each.lines].any()",
        "or True",
    ),
    _flow(
        "what a skipped block calls is gone",
        "gcxform/flow/uncalled_subprograms.py",
        "each.name in skipped or ",
        "",
    ),
    _flow(
        "what is kept calls what is gone",
        "gcxform/flow/uncalled_subprograms.py",
        "each not in keeps]",
        "False]",
    ),
    _flow(
        "a count hides what is called",
        "gcxform/flow/macros.py",
        "numbers[0] % PACKED",
        "numbers[0]",
    ),
    _flow("M98 is no call", "gcxform/flow/owords.py", "in (98, None) for w", "in (None,) for w"),
    _flow("a count is cut", "gcxform/flow/owords.py", "times = round(", "times = int(", AGREES),
    _flow(
        "a loop ends a round late",
        "gcxform/flow/owords.py",
        "self.counters[first] > 0",
        "self.counters[first] >= 0",
    ),
    _flow("M98 runs once more", "gcxform/flow/owords.py", "int(times), {}", "int(times) + 1, {}"),
    _flow(
        "a value does not return",
        "gcxform/flow/owords.py",
        "self.returned(value)",
        "self.returned()",
        FACTS,
    ),
    _flow("else is always taken", "gcxform/flow/owords.py", "self._truth(other)", "True", AGREES),
    _flow(
        "M73 is forgotten",
        "gcxform/flow/modes.py",
        "level.comes_back |= STORE_FOR_CALL in asked",
        "pass",
    ),
    _flow(
        "F does not come back",
        "gcxform/flow/modes.py",
        "(FEED, SPEED) if a in differ",
        "(SPEED,) if a in differ",
    ),
    _flow(
        "units come back last",
        "gcxform/flow/modes.py",
        "(units, feed, codes,",
        "(feed, codes, units,",
    ),
    _flow(
        "F comes back as it was",
        "gcxform/flow/modes.py",
        "{FEED: 1, SPEED: 0}",
        "{FEED: 9, SPEED: 9}",
    ),
    _flow("the offset of G92 stays", "gcxform/flow/modes.py", "[stored[PRESET]] if", "[] if"),
    _flow("G52 is no offset", "gcxform/flow/modes.py", '"G52": COUNTS,', "", AGREES),
    _flow(
        "F is restored although it is the same",
        "gcxform/flow/modes.py",
        "float(now) == float(stored)",
        "now == stored",
        "tests/test_corpus.py::test_case[flow/m72-rounds-feed]",
    ),
    _flow(
        "break behind continue leaves its loop",
        "gcxform/flow/owords.py",
        'self._refuse_after_continue("may go on with this loop")',
        "pass",
        "tests/test_corpus.py::test_case[flow/do-continue-next-break]",
    ),
    _flow("a coolant stays on", "gcxform/flow/modes.py", "off = any(", "off = not any("),
    _flow(
        "polar words turn the wrong way",
        "gcxform/flow/places.py",
        "math.cos(turned), radius * math.sin(turned)\n",
        "math.cos(turned), -radius * math.sin(turned)\n",
    ),
    _flow(
        "polar words in G91 forget the angle of here",
        "gcxform/flow/places.py",
        "turned = math.atan2(y, x) + math.radians",
        "turned = math.radians",
    ),
    _flow(
        "polar words in G91 lead to a point",
        "gcxform/flow/places.py",
        "radius * math.sin(turned) - y",
        "radius * math.sin(turned)",
    ),
    _flow(
        "the name of a program stands in a subprogram",
        "gcxform/flow/constructs.py",
        'if scope.startswith("sub ") and _is_name(block):',
        "if False:",
        "tests/test_corpus.py::test_case[flow/name-in-sub]",
    ),
    _flow(
        "positions are always mm",
        "gcxform/flow/places.py",
        'INCH if state.groups["units"] else 1.0',
        "1.0",
        AGREES,
    ),
    _flow(
        "a jump goes behind its label",
        "gcxform/flow/macro_words.py",
        "self.at = target",
        "self.at = target + 1",
    ),
    _flow(
        "END leaves the loop",
        "gcxform/flow/macro_words.py",
        "self.back_to(self.loops[self.line].first)",
        "self.at = self.loops[self.line].last + 1",
    ),
    _flow(
        "P is never packed",
        "gcxform/flow/macros.py",
        "packed = number >= PACKED",
        "packed = number < 0",
    ),
    _flow(
        "LT is LE",
        "gcxform/flow/relations.py",
        '"LT": lambda a, b: float(not same(a, b) and a < b)',
        '"LT": lambda a, b: float(a <= b)',
    ),
    _flow(
        "a macro keeps the variables of its caller",
        "gcxform/flow/macro_calls.py",
        "self.run.parameters |= fresh(call.given or {})",
        "self.run.parameters |= call.given or {}",
    ),
    _flow(
        "a caller does not get its variables back",
        "gcxform/flow/macro_calls.py",
        "self.run.parameters = kept | call.locals",
        "self.run.parameters = kept",
    ),
    _flow(
        "I opens no set",
        "gcxform/flow/macro_arguments.py",
        "if last and letter <= last",
        "if last and letter < last",
    ),
    _flow(
        "J out of its order opens no set",
        "gcxform/flow/macro_arguments.py",
        "if last and letter <= last",
        "if last == letter",
    ),
    _flow(
        "an argument without a point counts units",
        "gcxform/flow/macro_arguments.py",
        "return value / steps",
        "return value",
    ),
    _flow("null is 0", "gcxform/flow/relations.py", "nulls[0].certain or float(a)", "float(a)"),
    _flow(
        "a word of null is 0",
        "gcxform/flow/run_state.py",
        "if isinstance(value, Null):\n                return",
        "if False:\n                return",
    ),
    _flow(
        "null in brackets is null",
        "gcxform/modal/expressions/value.py",
        "return as_argument(self.value(children[0]))",
        "return self.value(children[0])",
    ),
    _flow(
        "a second run begins with what the first was given",
        "gcxform/flow/macro_calls.py",
        "call.given is None or keeps",
        "True",
    ),
    _flow(
        "a distance is not rounded",
        "gcxform/flow/run_state.py",
        "math.floor(abs(value) * steps + 0.5)",
        "abs(value) * steps",
        "tests/test_flow.py",
    ),
    _flow(
        "lines are those that were executed",
        "gcxform/flow/executed.py",
        "int(self.origin[line - 1]) + 1 if inside else line",
        "line",
        "tests/test_flow.py",
    ),
    _flow(
        "a loop behind break is run as it says",
        "gcxform/flow/owords.py",
        'self.broken |= self._has(construct, "break")\n        if not again',
        "if not again",
        "tests/test_corpus.py::test_case[flow/break-do]",
    ),
    _flow(
        "continue in a do loop forgets a break that is passed",
        "gcxform/flow/owords.py",
        'self.broken |= self._has(construct, "break")\n        self._note_left',
        "self._note_left",
        "tests/test_corpus.py::test_case[flow/do-continue-break]",
    ),
    _flow(
        "repeat behind continue is run as it says",
        "gcxform/flow/owords.py",
        'self.continued |= construct.kind == "do"\n',
        "self.continued = False\n",
        "tests/test_corpus.py::test_case[flow/do-continue-repeat]",
    ),
    _flow(
        "the number of a call is cut off, not rounded",
        "gcxform/flow/owords.py",
        "str(whole(value, self.arithmetic.whole_slip))",
        "str(int(value))",
        "tests/test_corpus.py::test_case[flow/call-by-a-value]",
    ),
    Mutation(
        "branches: what a jump may leave out is not lost",
        "gcxform/flow/branches.py",
        "            self.lost[here] = found.letters",
        "            pass",
        CASES,
    ),
    Mutation(
        "branches: what a jump may leave out is still known",
        "gcxform/flow/branches.py",
        "run.parameters = {**first, **dict.fromkeys(lost, UNKNOWN)}",
        "run.parameters = dict(first)",
        CASES,
    ),
    Mutation(
        "branches: modes may be those of one way",
        "gcxform/flow/branches.py",
        "if (other := other_modes(run, origin, self.joins)) is not None:",
        "if False:",
        CASES,
    ),
    Mutation(
        "branches: loops that the machine ends may move",
        "gcxform/flow/branches.py",
        "if not flow and not is_still(run.listing.meaning(run.line), block):",
        "if False:",
        CASES,
    ),
    Mutation(
        "branches: labels may stand twice",
        "gcxform/flow/branches.py",
        "if number is not None and written.get(number) != 1:",
        "if False:",
        CASES,
    ),
    Mutation(
        "branches: what stands behind the end may move",
        "gcxform/flow/branches.py",
        "if meaning.refusal is not None or not is_still(meaning, block):",
        "if False:",
        CASES,
    ),
    Mutation(
        "branches: tools may change in what is left out",
        "gcxform/flow/skipped_stretches.py",
        'if meaning.changes_tool or "T" in meaning.slots:',
        "if False:",
        CASES,
    ),
    Mutation(
        "branches: what kept text reads may be left out",
        "gcxform/flow/run_state.py",
        "if self.keeps and not reads <= self.settled.needed:",
        "if False:",
        CASES,
    ),
    Mutation(
        "branches: who reads the text does not forget",
        "gcxform/modal/expressions/assignments.py",
        "self.lines.parameters |= dict.fromkeys(undecided.forgets.get(place, ()), UNKNOWN)",
        "pass",
        CASES,
    ),
)
