"""Faults of what goes along as it stands in its own line, or may not."""

from __future__ import annotations

from faults.mutation import Mutation

SIEMENS = "plugins/gcxform_plugins/dialects/siemens/"
HEIDENHAIN = "plugins/gcxform_plugins/dialects/heidenhain/"
BORED = "plugins/gcxform_plugins/passes/volumetric/bored.py"
KLARTEXT = "tests/test_corpus.py::test_case[dialects/heidenhain/"
CASES = "tests/test_corpus.py::test_case[dialects/siemens/"


def _called(name: str, old: str, new: str, case: str) -> Mutation:
    file = f"{HEIDENHAIN}kept_cycles.py"
    return Mutation(f"kept calls: {name}", file, old, new, f"{KLARTEXT}{case}]")


def _kept(name: str, file: str, old: str, new: str, case: str) -> Mutation:
    return Mutation(f"kept calls: {name}", file, old, new, f"{CASES}{case}]")


MUTATIONS = (
    Mutation(
        "kept calls: a pocket that is declared is compensated by nobody",
        "gcxform/contract/own_codes.py",
        'known.reason if known and cuts else ""',
        '""',
        "tests/test_corpus.py::test_case[volumetric/pocket-that-is-declared]",
    ),
    Mutation(
        "kept calls: a pocket sets offsets",
        "gcxform/modal/frames/work_offsets.py",
        "(code is not None and code.reason)",
        "False",
        "tests/test_corpus.py::test_case[dialects/haas/round-pocket-and-offsets]",
    ),
    _kept(
        "lines of what is compensated may shift, where frames are folded",
        "gcxform/emit/respelling.py",
        "[translator.against[name] for name in sorted(names)]",
        "[]",
        "offsets-compensated",
    ),
    _kept(
        "lines that are executed may shift, where frames are folded",
        "gcxform/proof/refolded.py",
        "{*found.executed_lines()[1:].tolist()} if against else ()",
        "()",
        "offsets-compensated",
    ),
    _kept(
        "where one has led an axis a pass has corrected it",
        "gcxform/modal/moves/kept_calls.py",
        "led[call.line] = sum(1 << axes.index(axis) for axis in named)",
        "led[call.line] = 0",
        "own-lines-level-kept",
    ),
    _kept(
        "one of the same language is of another dialect",
        "gcxform/dialect/dialect.py",
        "one.translator is other.translator",
        "one.translator is None",
        "own-lines-holes-kept",
    ),
    _kept(
        "AXN of a cycle is not looked at",
        f"{SIEMENS}cycles.py",
        'if (along and values[along] not in ("", "0")) or (',
        "if (",
        "kept-hole-along-another",
    ),
    _kept(
        "a frame that tilts a cycle is none",
        f"{SIEMENS}blocks.py",
        "if [word for word in words if word[0] != hole.axis]:",
        "if False:",
        "kept-hole-tilted",
    ),
    _kept(
        "F is known behind one",
        f"{SIEMENS}blocks.py",
        "self.feed_open |= not hole.of_before",
        "self.feed_open = False",
        "kept-hole-no-feed",
    ),
    _kept(
        "a stroke that is slowed is none",
        f"{SIEMENS}cycles.py",
        'and values[FRF] in ("", "0", "1")',
        "",
        "kept-hole-slower",
    ),
    _kept(
        "a contour of the program is that of another",
        f"{SIEMENS}cycle_calls.py",
        "return any(label.upper() in named or number in named for label, number in said)",
        "return False",
        "kept-path-of-a-label",
    ),
    _kept(
        "two labels in one text are none",
        f"{SIEMENS}cycle_calls.py",
        'for each in name.split(":")',
        "for each in [name]",
        "kept-path-of-two-labels",
    ),
    _kept(
        "numbers of blocks are no labels",
        f"{SIEMENS}cycle_calls.py",
        " or number in named",
        "",
        "kept-path-of-numbers",
    ),
    _kept(
        "a name is a number",
        f"{SIEMENS}cycles.py",
        "if any(WORDY.search(each) for each in given if not each.startswith('\"')):",
        "if False:",
        "kept-path-of-a-name",
    ),
    _kept(
        "what a cycle that mills is handed on stays R parameters",
        f"{SIEMENS}computing.py",
        "POCKET[1-4]|",
        "",
        "kept-path-computed",
    ),
    _kept(
        "behind one that was written as moves F is as in the program",
        f"{SIEMENS}blocks.py",
        "self.feed_other = hole.own_feed",
        "self.feed_other = False",
        "kept-hole-other-feed",
    ),
    _kept(
        "behind one F is another",
        f"{SIEMENS}blocks.py",
        "(self.feed_other if hole.kept else self.feed_open)",
        "self.feed_open",
        "kept-holes-of-f",
    ),
    _kept(
        "a frame is there wherever one is called",
        f"{SIEMENS}blocks.py",
        "if self.frame != Frame():\n            self.in_place",
        "if False:\n            self.in_place",
        "kept-hole-frame-anew",
    ),
    _kept(
        "an axis of the machine is one of a frame that turns",
        f"{SIEMENS}computing.py",
        "self.place.lose(self.moved_inside(found.axes))",
        "self.place.lose(found.axes)",
        "along-turned",
    ),
    _kept(
        "rapids that are left alone lead where they should",
        "gcxform/emit/bored_places.py",
        "return not (spared and path.kind[row] == Kind.RAPID)",
        "return True",
        "kept-hole-uncorrected",
    ),
    _kept(
        "a place that is lost is one",
        "gcxform/emit/bored_places.py",
        "return not (known and _is_corrected(task, believed, own))",
        "return not _is_corrected(task, believed, own)",
        "kept-hole-place-lost",
    ),
    _kept(
        "the own ways of one are corrected",
        "gcxform/emit/depending.py",
        "if manner.compensates and self._cuts(line):",
        "if False:",
        "kept-path-uncorrected",
    ),
    _kept(
        "one that mills knows where it ends",
        f"{SIEMENS}blocks.py",
        "self.loses |= {*gone}",
        "self.loses |= set()",
        "kept-path-lost",
    ),
    _kept(
        "axes that are led to points are where they were",
        f"{SIEMENS}computing.py",
        "self.lose_axes(found.axes)",
        "self.lose_pole()",
        "along-lost",
    ),
    _kept(
        "a cycle does not drill where axes are led to a point",
        f"{SIEMENS}computing.py",
        "(self.following or self.comp or self.drilling)",
        "(self.following or self.comp)",
        "along-under-mcall",
    ),
    _kept(
        "a limit counts anywhere",
        "gcxform/pipeline/written_back.py",
        "self._refuse_apart()\n        lines",
        "lines",
        "along-nowhere-else",
    ),
    _kept(
        "lines call cycles that became moves",
        "gcxform/emit/respelling.py",
        "executed if name in IN_LINES else ()",
        "executed if name is None else ()",
        "cycles-expanded",
    ),
    _kept(
        "moves of cycles become cycles again",
        f"{SIEMENS}lines.py",
        "gathered(lines) if self.drills else iter(lines)",
        "gathered(lines)",
        "cycles-stay-moves",
    ),
    _kept(
        "a kept level is the same in another frame",
        f"{SIEMENS}blocks.py",
        "self.in_place[self.line] = UNITS",
        "pass",
        "kept-hole-apart",
    ),
    _called(
        "behind a cycle beside its hole the tool is over that",
        "if number in BESIDE:",
        "if False:",
        "kept-hole-beside",
    ),
    _called("F is known behind a thread", "self.feed_lost = True", "pass", "kept-hole-feed"),
    _called(
        "a cycle ends as high as Q200 says", "max(clear, high)", "clear", "own-lines-level-kept"
    ),
    _called(
        "what is called as it stands is written anew",
        "self.in_place[self.line] = IN_PLACE",
        "pass",
        "kept-hole-apart",
    ),
    Mutation(
        "kept calls: a thread is one of moves where positions are corrected",
        f"{HEIDENHAIN}kept_cycles.py",
        "tied = number == RIGID and not self.reading.compensates",
        "tied = number == RIGID",
        f"{KLARTEXT}own-lines-holes-kept]",
    ),
    _kept(
        "one has no number",
        f"{SIEMENS}lines.py",
        """{' '.join(asides)}" if "N" in values""",
        """{' '.join(asides)}" if "P" in values""",
        "kept-hole-numbered",
    ),
    _kept(
        "X in a mirror is like X without",
        "gcxform/emit/own_lines.py",
        'enumerate("XYZ", 1)',
        'enumerate("XYZ")',
        "own-lines-mirrored",
    ),
    _kept(
        "inches in a frame that turns are as coarse as mm",
        f"{SIEMENS}frames.py",
        'FINE = Decimal("1e-7")',
        'FINE = Decimal("1e-6")',
        "own-lines-inches-turned",
    ),
    _kept(
        "a line says what MCALL has said",
        f"{SIEMENS}in_place.py",
        "if called is None or not {HOLE, PATH} & {*block.codes}:",
        "if called:",
        "own-lines-pattern-kept",
    ),
    _kept(
        "what a subprogram calls MCALL has said",
        "gcxform/emit/refolding.py",
        "own = frozenset(map(int, walk.lines[unit.begin : unit.end + 1]))",
        "own = frozenset((unit.first,))",
        "own-lines-pattern-kept",
    ),
    _kept(
        "CYCLE840 has a feed of its own",
        f"{SIEMENS}cycles.py",
        'own_feed = name == "CYCLE84"',
        'own_feed = name.startswith("CYCLE84")',
        "kept-tap-other-feed",
    ),
    _kept(
        "what goes along sets a variable as well",
        f"{SIEMENS}in_place.py",
        "if goes_along(bare_line(self.lines[line])) is not None:",
        "if False:",
        "along-in-a-loop",
    ),
    _kept(
        "MCALL that a subprogram ends is in force behind it",
        f"{SIEMENS}calls.py",
        "if self.drilling != call.drilling:",
        "if False:",
        "mcall-left-in-a-subprogram",
    ),
    Mutation(
        "kept calls: Q203 that is set behind the definition changes nothing",
        f"{HEIDENHAIN}cycles.py",
        "return self.levels()",
        "return ()",
        f"{KLARTEXT}kept-hole-level-set]",
    ),
    Mutation(
        "kept calls: what a call hangs on is how long it waits",
        f"{HEIDENHAIN}cycles.py",
        "return self.levels()",
        "return (*self.levels(), 211)",
        f"{KLARTEXT}kept-hole-level-of]",
    ),
    Mutation(
        "kept calls: in turned coordinates nothing is known of an axis that stays as it is",
        "gcxform/toolpath/frames.py",
        "self.matrix[axis][k] == self.matrix[k][axis] == float(k == axis)",
        "False",
        f"{KLARTEXT}kept-hole-turned]",
    ),
    Mutation(
        "kept calls: in turned coordinates X is where its word says",
        "gcxform/toolpath/frames.py",
        "self.matrix[axis][k] == self.matrix[k][axis] == float(k == axis)",
        "True",
        "tests/test_corpus.py::test_case[flow/kept-call-at-turned]",
    ),
    Mutation(
        "kept calls: the ground of a hole is where its call ends",
        BORED,
        "ground[np.arange(len(ground)), self.along] -= self.depth",
        "ground[np.arange(len(ground)), self.along] -= 0.0",
        f"{KLARTEXT}kept-hole-leans]",
    ),
    Mutation(
        "kept calls: a hole leans from where its call ends",
        BORED,
        "np.where(np.isnan(began), called[each, self.along], began)",
        "called[each, self.along]",
        "tests/test_corpus.py::test_case[dialects/siemens/kept-hole-leans-less]",
    ),
    Mutation(
        "kept calls: a ground in inches is one in mm",
        BORED,
        "np.where(path.blocks.inch[path.block[rows]], 25.4, 1.0)",
        "1.0",
        "tests/test_kept_holes.py::test_grounds_in_inches",
    ),
    Mutation(
        "kept calls: along the tool a ground is off by as much as across",
        BORED,
        "along = np.abs(lean[each, self.along])",
        "along = np.abs(lean[each, self.along - 1])",
        "tests/test_kept_holes.py::test_the_certificate_says_how_far_grounds_are_off",
    ),
    Mutation(
        "kept calls: a ground is in any table",
        BORED,
        "beyond = np.flatnonzero(beyond_tables(step, grounds))",
        "beyond = np.zeros(0, np.int64)",
        "tests/test_corpus.py::test_case[dialects/siemens/kept-hole-below-the-tables]",
    ),
    _kept(
        "a depth of steps is an absolute one",
        f"{SIEMENS}cycles.py",
        "if mode[-1:] not in AS_EVER:",
        "if False:",
        "kept-hole-of-steps",
    ),
    _called(
        "back boring turns back where it begins to bore",
        "DEPTHS = 204, (250, 252, 200)",
        "DEPTHS = 204, (250, 252)",
        "kept-hole-from-below",
    ),
    _called(
        "how deep one is does not count",
        "return (*LEVELS, *deep) if self.reading.compensates else LEVELS",
        "return LEVELS",
        "kept-hole-depth-of",
    ),
    _called(
        "a diameter is a depth",
        "if number == CENTRING and told.get(BY_DIAMETER):",
        "if False:",
        "kept-hole-by-diameter",
    ),
)
