"""Faults of the translator for a SINUMERIK: ways, distances, arcs, tools, cycles, the tip."""

from __future__ import annotations

from faults.mutation import Mutation

PLACE = "plugins/gcxform_plugins/dialects/siemens/place.py"
MOVES = "plugins/gcxform_plugins/dialects/siemens/moves.py"
ARCS = "plugins/gcxform_plugins/dialects/siemens/arcs.py"
BLOCKS = "plugins/gcxform_plugins/dialects/siemens/blocks.py"
READING = "plugins/gcxform_plugins/dialects/siemens/reading.py"
CYCLES = "plugins/gcxform_plugins/dialects/siemens/cycles.py"
DECIDING = "plugins/gcxform_plugins/dialects/siemens/deciding.py"
FRAMES = "plugins/gcxform_plugins/dialects/siemens/frames.py"
FRAMING = "plugins/gcxform_plugins/dialects/siemens/framing.py"
FLOW = "tests/properties/test_siemens_flow.py"
STRUCTURE = "plugins/gcxform_plugins/dialects/siemens/structure.py"
EFFECTS = "plugins/gcxform_plugins/dialects/siemens/effects.py"
PROGRAMS = "plugins/gcxform_plugins/dialects/siemens/programs.py"
EXPRESSIONS = "plugins/gcxform_plugins/dialects/siemens/expressions.py"
ARITHMETIC = "plugins/gcxform_plugins/dialects/siemens/arithmetic.py"
RANDOM = "tests/test_siemens.py::test_it_reads_what_the_reference_reads"
CASES = "tests/test_corpus.py::test_case"
TIPS = "tests/test_siemens.py::test_five_axes_become_what_the_same_program_by_hand_becomes"
POLAR = "plugins/gcxform_plugins/dialects/siemens/polar.py"
LINES = "plugins/gcxform_plugins/dialects/siemens/lines.py"
SPELLED = "gcxform/proof/spelled_out.py"
WRITTEN = "tests/test_siemens_written.py::test_words_become_lines_in_its_idiom"
COMPARED = "tests/test_siemens_written.py::test_what_is_written_is_read_and_compared"

MUTATIONS = (
    Mutation(
        "siemens: a step of a loop stays what it was the first time",
        "gcxform/emit/respelling.py",
        "            new[line] = raw\n",
        "            pass\n",
        f"{CASES}[dialects/siemens/step-beside-a-parameter]",
    ),
    Mutation(
        "siemens: CYCLE89 comes out in rapid",
        CYCLES,
        'return (*_with_dwell(rest, at), ("1", at.start, ""))',
        'return (*_with_dwell(rest, at), ("0", at.start, ""))',
        f"{CASES}[dialects/siemens/cycles-of-steps]",
    ),
    Mutation(
        "siemens: strokes of CYCLE83 count from the start",
        CYCLES,
        "end, top = Decimal(at.bottom), Decimal(at.plane)",
        "end, top = Decimal(at.bottom), Decimal(at.start)",
        f"{CASES}[dialects/siemens/pecks]",
    ),
    Mutation(
        "siemens: HOLES1 begins at the end that is farther",
        CYCLES,
        "if len(places) > 1 and not ends[0] < ends[1] - CLEARLY:",
        "if False:",
        f"{CASES}[dialects/siemens/holes-from-either-end]",
    ),
    Mutation(
        "siemens: the feed of CYCLE85 stays",
        BLOCKS,
        'self.said, self.feed_open = "0", hole.own_feed',
        'self.said, self.feed_open = "0", False',
        f"{CASES}[dialects/siemens/feed-behind-a-cycle]",
    ),
    Mutation(
        "siemens: polar angles count from the second axis",
        POLAR,
        "return float(radius) * math.cos(at), float(radius) * math.sin(at)",
        "return float(radius) * math.sin(at), float(radius) * math.cos(at)",
        f"{CASES}[dialects/siemens/polar]",
    ),
    Mutation(
        "siemens: G112 counts from zero",
        POLAR,
        "            return self._pole(item)\n",
        "            return 0.0, 0.0\n",
        f"{CASES}[dialects/siemens/polar]",
    ),
    Mutation(
        "siemens: a pole stays where another zero begins",
        FRAMING,
        "        self.lose_pole()\n",
        "",
        f"{CASES}[dialects/siemens/polar-refused]",
    ),
    Mutation(
        "siemens written: TURN counts the arc as well",
        LINES,
        'yield f"TURN={int(text) - 1}"',
        'yield f"TURN={int(text)}"',
        WRITTEN,
    ),
    Mutation(
        "siemens written: no length is said behind a tool change",
        LINES,
        'counts = "Z" in values or not {"G41", "G42"}.isdisjoint(names)',
        "counts = False",
        "tests/test_siemens_written.py::"
        "test_a_length_that_stays_in_force_is_said_before_the_next_move",
    ),
    Mutation(
        "siemens written: behind SUPA there is no length",
        LINES,
        "self.waits = bool(self.length)\n",
        "self.waits = False\n",
        "tests/test_siemens_written.py::"
        "test_a_length_ends_for_a_move_in_the_machine_and_is_in_force_again",
    ),
    Mutation(
        "written in a language: by which offset words count is not compared",
        SPELLED,
        "np.flatnonzero((frames[0] != frames[1]) & ~counts)",
        "np.flatnonzero((frames[0] != frames[0]) & ~counts)",
        f"{COMPARED}[G55-G56-a work offset, or a length]",
    ),
    Mutation(
        "written in a language: places in the machine are not compared",
        SPELLED,
        "if _words(one[line]) != _words(other[there]):",
        "if False:",
        f"{COMPARED}[SUPA G0 Z0 D0-SUPA G0 Z5 D0-a place in the machine]",
    ),
    Mutation(
        "siemens: DC goes the longer way",
        PLACE,
        "return up if up * 2 < TURN else up - TURN",
        "return up if up * 2 > TURN else up - TURN",
        RANDOM,
    ),
    Mutation(
        "siemens: half a turn goes up",
        PLACE,
        'if way != "DC" or up * 2 == TURN:',
        'if way != "DC":',
        f"{CASES}[dialects/siemens/half-a-turn]",
    ),
    Mutation(
        "siemens: ACN goes up",
        PLACE,
        "        return up - TURN\n    if way",
        "        return up\n    if way",
        RANDOM,
    ),
    Mutation(
        "siemens: plain words behind whole turns are taken as they are",
        PLACE,
        "(self.unwound.add if end != wanted else self.unwound.discard)(axis)",
        "self.unwound.discard(axis)",
        f"{CASES}[dialects/siemens/plain-behind-turns]",
    ),
    Mutation(
        "siemens: plain lines that were passed are not looked at",
        BLOCKS,
        "if self.line > self.last + 1:",
        "if self.line > self.last + 9999:",
        RANDOM,
    ),
    Mutation(
        "siemens: words of passed lines are older than what was told before",
        PLACE,
        "if line > self.at.get(axis, (-1,))[0]:",
        "if line < self.at.get(axis, (-1,))[0]:",
        RANDOM,
    ),
    Mutation(
        "siemens: IC is absolute in G90",
        MOVES,
        "        return way == STEP or (not way and self.steps)\n\n    def _words",
        "        return not way and self.steps\n\n    def _words",
        RANDOM,
    ),
    Mutation(
        "siemens: AC is a step in G91",
        MOVES,
        "        return way == STEP or (not way and self.steps)\n\n    def _words",
        "        return way == STEP or self.steps\n\n    def _words",
        RANDOM,
    ),
    Mutation(
        "siemens: TURN counts the arc as well",
        ARCS,
        'return f"P{int(number) + 1}"',
        'return f"P{max(1, int(number))}"',
        RANDOM,
    ),
    Mutation(
        "siemens: a centre in AC is a distance",
        ARCS,
        "start = starts[letter] if way == ABSOLUTE else None",
        "start = None",
        RANDOM,
    ),
    Mutation(
        "siemens: the opening angle lies on the other side",
        ARCS,
        "side = sense / (2 * math.tan(angle / 2))",
        "side = -sense / (2 * math.tan(angle / 2))",
        RANDOM,
    ),
    Mutation(
        "siemens: CIP goes the other way round",
        ARCS,
        'return ("3" if bend > 0 else "2"), centre',
        'return ("2" if bend > 0 else "3"), centre',
        RANDOM,
    ),
    Mutation(
        "siemens: which edge is in force behind M6 is not asked",
        MOVES,
        "if self.changed and self.edge is None and self._counts_length(line):",
        "if self.changed and self.edge is None and not self.tool:",
        f"{CASES}[dialects/siemens/edge-not-said]",
    ),
    Mutation(
        "siemens: a length is across the plane in every plane",
        MOVES,
        'across = self.plane == "XY" or',
        "across = self.plane or",
        f"{CASES}[dialects/siemens/edge-in-another-plane]",
    ),
    Mutation(
        "siemens: a length is along Z in a frame that tilts",
        MOVES,
        "return across and self.keeps_radii and not self.following",
        "return across and not self.following",
        f"{CASES}[dialects/siemens/edge-in-a-tilted-frame]",
    ),
    Mutation(
        "spelled: a length that counts in no word counts in all",
        SPELLED,
        "named = [k for k, axis in enumerate(a.axes) if axis in words]",
        "named = [*range(len(a.axes))]",
        "tests/test_siemens_written.py::test_across_the_tool_its_length_need_not_be_said",
    ),
    Mutation(
        "spelled: no length counts in any word",
        SPELLED,
        "named = [k for k, axis in enumerate(a.axes) if axis in words]",
        "named = []",
        COMPARED,
    ),
    Mutation(
        "siemens: the tool of the last T is the one in the spindle",
        BLOCKS,
        'yield f"G43 H{self.tool}" if number == "1" else "G49"',
        'yield f"G43 H{self.waiting}" if number == "1" else "G49"',
        f"{CASES}[dialects/siemens/tool]",
    ),
    Mutation(
        "siemens: SUPA with a tool length",
        BLOCKS,
        'if self.edge != "0" or self.following:',
        "if self.following:",
        f"{CASES}[dialects/siemens/machine-with-a-length]",
    ),
    Mutation(
        "siemens: steps behind another work offset are taken",
        BLOCKS,
        "        if name != self.work and (self.work or self.place.moved):\n",
        "        if name != self.work and not self.work:\n",
        f"{CASES}[dialects/siemens/steps-behind-an-offset]",
    ),
    Mutation(
        "siemens: frames with words are taken for their ends",
        READING,
        "        elif name in FRAMES:\n            line.alone = item\n",
        "        elif name in FRAMES:\n            pass\n",
        f"{CASES}[dialects/siemens/frame]",
    ),
    Mutation(
        "siemens: DPR is a level",
        CYCLES,
        'return format(level - abs(Decimal(_number(below, names[1]))), "f")',
        'return format(-abs(Decimal(_number(below, names[1]))), "f")',
        RANDOM,
    ),
    Mutation(
        "siemens: a cycle starts at the reference plane",
        CYCLES,
        'start = format(level + abs(Decimal(gap)), "f")',
        'start = format(level, "f")',
        RANDOM,
    ),
    Mutation(
        "siemens: behind a cycle the code before it is taken to hold",
        BLOCKS,
        'self.said, self.feed_open = "0", hole.own_feed',
        "self.feed_open = hole.own_feed",
        RANDOM,
    ),
    Mutation(
        "siemens: TRAFOOF follows the tip",
        BLOCKS,
        'self.following = line.act[0] == "M128"',
        "self.following = True",
        RANDOM,
    ),
    Mutation(
        "siemens: cuts that turn axes are taken whatever turns them",
        MOVES,
        'return said == "ORIAXES" and reference != "ORIWKS"',
        "return True",
        "tests/test_siemens.py::test_what_turns_between_ends_is_said",
    ),
    Mutation(
        "siemens: a jump back looks ahead first",
        "plugins/gcxform_plugins/dialects/siemens/structure.py",
        '"GOTOB": (back,)',
        '"GOTOB": (ahead, back)',
        f"{CASES}[dialects/siemens/jump-back]",
    ),
    Mutation(
        "siemens: FOR does not come to its end",
        DECIDING,
        "if value + 1 <= end:",
        "if value + 1 < end:",
        f"{CASES}[dialects/siemens/loop-for]",
    ),
    Mutation(
        "siemens: what a kept line has set is known behind it",
        PROGRAMS,
        "        self.lose_set(self.line, self.line)\n        if opaque",
        "        if opaque",
        f"{CASES}[dialects/siemens/kept-value]",
    ),
    Mutation(
        "siemens: lines that only the machine repeats are changed",
        PROGRAMS,
        "if self.line in self.stay and",
        "if not self.stay and self.stay and",
        f"{CASES}[dialects/siemens/kept-loop]",
    ),
    Mutation(
        "siemens: a call that is not here leaves G90 in force",
        PROGRAMS,
        'if opaque or (self.perhaps and "distance" in line.groups):',
        'if self.perhaps and "distance" in line.groups:',
        f"{CASES}[dialects/siemens/kept-modes]",
    ),
    Mutation(
        "siemens: AND binds behind comparisons, unasked",
        EXPRESSIONS,
        "if found != self._joined(values, AS_USUAL):",
        "if False:",
        f"{CASES}[dialects/siemens/logic-without-brackets]",
    ),
    Mutation(
        "siemens: DIV rounds",
        ARITHMETIC,
        "return float(math.trunc(found))",
        "return float(round(found))",
        f"{CASES}[dialects/siemens/functions]",
    ),
    Mutation(
        "siemens: what is kept may be executed in other modes",
        "gcxform/proof/respelled.py",
        "return [(old, new) for old, new in zip(one[2], other[2], strict=True) if old != new]",
        "return []",
        f"{CASES}[dialects/siemens/kept-in-steps]",
    ),
    Mutation(
        "siemens: what was spelled is not read again",
        "gcxform/proof/respelled.py",
        "        if one != other:\n            raise _wrong(found, at)\n",
        "",
        f"{CASES}[dialects/siemens/spelled-otherwise]",
    ),
    Mutation(
        "siemens: VAR is a copy",
        "plugins/gcxform_plugins/dialects/siemens/calls.py",
        "        return cell\n\n    def _own(",
        "        return Cell(cell.kind, cell.size, [*cell.values])\n\n    def _own(",
        f"{CASES}[dialects/siemens/call-parameters]",
    ),
    Mutation(
        "siemens: P calls once",
        "plugins/gcxform_plugins/dialects/siemens/calls.py",
        "        if call.times:\n",
        "        if call.times > 9:\n",
        f"{CASES}[dialects/siemens/call-times]",
    ),
    Mutation(
        "siemens: a line of another file is changed in silence",
        "gcxform/emit/respelling.py",
        "        if text != raw and line >= translator.own:\n",
        "        if text is None and line >= translator.own:\n",
        f"{CASES}[dialects/siemens/call-kept]",
    ),
    Mutation(
        "siemens: where an axis is behind a line that stays is taken as before",
        PROGRAMS,
        '        self.place.lose([axis for axis in axes if axis != "F"])',
        "        self.place.lose([])",
        f"{CASES}[dialects/siemens/stands-by-its-words]",
    ),
    Mutation(
        "siemens: what a jump leads over is executed",
        STRUCTURE,
        "low, high = min(low, target), max(high, target - 1)",
        "low, high = min(low, target), max(high, line)",
        f"{CASES}[dialects/siemens/perhaps-jumped-over]",
    ),
    Mutation(
        "siemens: lines that may be executed again become positions",
        DECIDING,
        "            self.again |= {*where}\n",
        "",
        f"{CASES}[dialects/siemens/perhaps-back]",
    ),
    Mutation(
        "siemens: a mode that may have been set is in force",
        PROGRAMS,
        'if opaque or (self.perhaps and "distance" in line.groups):',
        "if opaque:",
        f"{CASES}[dialects/siemens/perhaps-a-mode]",
    ),
    Mutation(
        "siemens: G90 that may be executed is in force for the lines that stay",
        PROGRAMS,
        'if self.perhaps and "distance" in line.groups:  # it may',
        'if False and "distance" in line.groups:  # it may',
        f"{CASES}[dialects/siemens/perhaps-in-steps]",
    ),
    Mutation(
        "siemens: data of tools lose no axis",
        EFFECTS,
        "return LINEAR if OF_TOOLS.fullmatch(name)",
        'return "" if OF_TOOLS.fullmatch(name)',
        f"{CASES}[dialects/siemens/stands-a-variable]",
    ),
    Mutation(
        "siemens: words of a spline are those of a line",
        PROGRAMS,
        "                line.motion = OTHER\n",
        "                pass\n",
        f"{CASES}[dialects/siemens/stands-a-path]",
    ),
    Mutation(
        "siemens: a hole leaves the axis of the tool where it was",
        PROGRAMS,
        "return axes + LINEAR if DRILLING.search",
        "return axes if DRILLING.search",
        f"{CASES}[dialects/siemens/stands-a-hole]",
    ),
    Mutation(
        "siemens: ROT turns about X before Y and Z",
        FRAMES,
        'about("Z", z) @ about("Y", y) @ about("X", x)',
        'about("X", x) @ about("Y", y) @ about("Z", z)',
        "tests/test_siemens.py::test_a_frame_turns_about_x_before_y_and_z",
    ),
    Mutation(
        "siemens: what is added to a frame acts outside of it",
        FRAMING,
        "made = self.frame @ made",
        "made = made @ self.frame",
        f"{CASES}[dialects/siemens/frame]",
    ),
    Mutation(
        "siemens: arcs of a mirrored frame turn as they say",
        FRAMING,
        "if growth < 0 else motion",
        "if growth is None else motion",
        f"{CASES}[dialects/siemens/frame]",
    ),
    Mutation(
        "siemens: axes stand in another frame where they stood in the one before",
        FRAMING,
        "made.inside(old.point(point))",
        "point",
        f"{CASES}[dialects/siemens/frame-stands]",
    ),
    Mutation(
        "siemens: plain lines know no frame",
        BLOCKS,
        "if self.feed_open or self.length_is_elsewhere or self.frame != Frame():",
        "if self.feed_open or self.length_is_elsewhere:",
        f"{CASES}[dialects/siemens/frame]",
    ),
    Mutation(
        "siemens: holes on a circle stand one step on",
        CYCLES,
        "first + k * (step",
        "first + (k + 1) * (step",
        f"{CASES}[dialects/siemens/frame]",
    ),
    Mutation(
        "siemens: words behind a value that is not known are none",
        PROGRAMS,
        "            return [*words_of(self.tree_of(text), text)]\n",
        "            return items\n",
        f"{CASES}[dialects/siemens/stands-by-all-its-words]",
    ),
)
