"""Faults in how blocks of a Fagor are read, and in the shapes of languages that are translated."""

from __future__ import annotations

from faults.mutation import Mutation

LANGUAGES = "plugins/gcxform_plugins/languages"
BLOCKS = "plugins/gcxform_plugins/dialects/fagor/blocks.py"
PLACES = "plugins/gcxform_plugins/dialects/fagor/places.py"
TABLES = "plugins/gcxform_plugins/dialects/fagor/tables.py"
TRANSLATION = "gcxform/flow/translation.py"
SHAPES = "gcxform/flow/line_shapes.py"
CASE = "tests/test_corpus.py::test_case[dialects/fagor/"
READS = "tests/test_fagor.py::test_it_reads_what_another_reader_reads"
WALK = "tests/test_translation.py"
RUNS = "tests/test_translated_runs.py"

FLOW = "plugins/gcxform_plugins/dialects/fagor/flow.py"
COMPUTING = "plugins/gcxform_plugins/dialects/fagor/computing.py"
STRUCTURE = "plugins/gcxform_plugins/dialects/fagor/structure.py"
PROGRAMS = "plugins/gcxform_plugins/dialects/fagor/programs.py"
FLOWS = "tests/test_fagor_flow.py"

LINES = "plugins/gcxform_plugins/dialects/fagor/lines.py"
SAID = "tests/test_fagor_written.py"

POLAR = "plugins/gcxform_plugins/dialects/fagor/polar.py"
SECOND = "tests/test_fagor_reference.py"

MUTATIONS = (
    Mutation(
        "translation: a run of plain lines goes on over one that is none",
        TRANSLATION,
        "            if shape is None or not shape.template:\n                break",
        "            if shape is None or not shape.template:\n                continue",
        WALK,
    ),
    Mutation(
        "translation: a run without some blocks is for the lines before",
        TRANSLATION,
        "            begin = end + 1",
        "            begin = end",
        "tests/test_klartext_runs.py",
    ),
    Mutation(
        "fagor: a value in brackets does not count from where an axis stands",
        "plugins/gcxform_plugins/dialects/fagor/spelling.py",
        "[IiGg](?:(?<=[0-9.\\]][Ii])",
        "[IiGg](?:(?<=[0-9.][Ii])",
        f"{CASE}steps-in-brackets]",
    ),
    Mutation(
        "fagor: what says how near to a corner is left out for the same control",
        BLOCKS,
        "if head in tables.INERT and self.reading.asides:",
        "if False:",
        f"{CASE}compensated-with-asides]",
    ),
    Mutation(
        "fagor: a slash stands for what computes",
        "grammars/gcxform_grammars/fagor_computed.lark",
        "_head: _SLASH | sequence | label\n",
        "_head: slash | sequence | label\nslash: _SLASH\n",
        f"{CASE}slash-computed]",
    ),
    Mutation(
        "fagor: half a structure is skipped",
        FLOW,
        ".upper() in HALVES:",
        ".upper() in ():",
        f"{CASE}slash-of-a-structure]",
    ),
    Mutation(
        "fagor: G50 beside an arc becomes G5",
        "plugins/gcxform_plugins/dialects/fagor/programs.py",
        "or line in self.frozen or half:",
        "or line in self.frozen:",
        "tests/test_corpus.py::test_case[segment/fagor-own-arcs-blend]",
    ),
    Mutation(
        "fagor: corners half rounded are rounded",
        BLOCKS,
        'words.append(gx.Speller.aside("G50"))',
        "pass",
        f"{CASE}compensated-with-asides]",
    ),
    Mutation(
        "fagor: what nobody has read is made of lines",
        PROGRAMS,
        "self.kept_lines[-1][0] + 1 if self.tied else self.own, self.own",
        "self.own, self.own",
        f"{CASE}segment-of-a-kept-arc]",
    ),
    Mutation(
        "fagor: a tool that is fetched is not said",
        "plugins/gcxform_plugins/dialects/fagor/lines.py",
        'elif "T" in values:',
        "elif False:",
        "tests/test_corpus.py::test_case[dialects/across/tools-fetched-for-fagor]",
    ),
    Mutation(
        "fagor: a polar word may stand twice",
        "plugins/gcxform_plugins/dialects/fagor/polar.py",
        'if sum(i.kind in ("word", "incremental") for i in items) > len(named):',
        "if False:",
        "tests/test_corpus.py::test_case[dialects/fagor/polar-twice]",
    ),
    Mutation(
        "fagor: G53 says nothing to the same control",
        PROGRAMS,
        'code == "G53" or code in tables.COMP',
        "code in tables.COMP",
        f"{CASE}kept-coordinates]",
    ),
    Mutation(
        "fagor: the end of other coordinates says nothing to the same control",
        PROGRAMS,
        'self.reading.stays and head in tables.OFF | {"#KIN"}',
        'self.reading.stays and head == "#TOOL"',
        f"{CASE}kept-coordinates]",
    ),
    Mutation(
        "fagor: places of the machine have the tool length in them",
        BLOCKS,
        "if on and (not self.bare or",
        "if on and (",
        f"{CASE}refused-mcs-on]",
    ),
    Mutation(
        "fagor: behind a tool change D0 is in force",
        BLOCKS,
        "            self.bare = False\n",
        "            self.bare = True\n",
        "tests/test_fagor.py::test_a_tool_change_takes_d0_away",
    ),
    Mutation(
        "fagor: places of the machine are those of the program",
        BLOCKS,
        'return f"G53 {said}" if',
        "return said if",
        f"{CASE}machine-coordinates]",
    ),
    Mutation(
        "fagor: compensation takes the radius of no tool",
        BLOCKS,
        "if not self.long or self.following or any(",
        "if self.following or any(",
        f"{CASE}cutter-comp-of-no-tool]",
    ),
    Mutation(
        "fagor: behind a place of the machine no length is in force",
        LINES,
        'self.bare, self.waits = True, self.length != "0"',
        "self.bare, self.waits = True, False",
        f"{SAID}::test_places_of_the_machine_are_said",
    ),
    Mutation(
        "fagor: Q420 is no Q60",
        POLAR,
        "if abs(angle) > TURN else angle",
        "if abs(angle) > 4 * TURN else angle + TURN / 8 * (abs(angle) > TURN)",
        f"{CASE}polar]",
    ),
    Mutation(
        "fagor: polar steps count from zero",
        POLAR,
        "return before + (float(item.numbers[0]) if item is not None else 0.0)",
        "return float(item.numbers[0]) if item is not None else before",
        SECOND,
    ),
    Mutation(
        "fagor: a coordinate and an angle are mixed up",
        POLAR,
        "found = step * other / by",
        "found = step * by / other",
        f"{CASE}polar]",
    ),
    Mutation(
        "fagor: polar places are kept behind others",
        POLAR,
        '        elif named.keys() & {*"XYIJR"}:\n            self.polar = None',
        '        elif named.keys() & {*"XYIJR"}:\n            pass',
        f"{CASE}refused-polar-first]",
    ),
    Mutation(
        "fagor: one axis is told behind a turn",
        POLAR,
        "if (mine or arc) and (len(mine) < len(self.untold) or steps or arc):",
        "if mine and steps:",
        f"{CASE}refused-turn-one-axis]",
    ),
    Mutation(
        "fagor: turns of turned coordinates",
        POLAR,
        "if (self.turned and words) or self.pole != (0.0, 0.0):",
        "if self.pole != (0.0, 0.0):",
        f"{CASE}refused-turn-twice]",
    ),
    Mutation(
        "fagor: what is written for it has no length behind a tool change",
        LINES,
        "if moves or before != self.length or not",
        "if not",
        SAID,
    ),
    Mutation(
        "fagor: the length of another tool is said as D1",
        LINES,
        'if self.length not in ("0", self.in_spindle):',
        "if not self.length:",
        SAID,
    ),
    Mutation(
        "fagor: $FOR always runs for its last value",
        FLOW,
        'return chosen == "included"',
        "return True",
        FLOWS,
    ),
    Mutation(
        "fagor: the parameter of $FOR is known behind it",
        FLOW,
        "        else:\n            self.known[name] = None",
        "        else:\n            pass",
        FLOWS,
    ),
    Mutation(
        "fagor: #PCALL has the parameters of the caller",
        FLOW,
        'kind = "own" if way == "#PCALL" else',
        'kind = "shared" if way == "#PCALL" else',
        FLOWS,
    ),
    Mutation(
        "fagor: what a subroutine sets is never the caller's",
        FLOW,
        "if not call.kind:",
        "if call.kind is None:",
        FLOWS,
    ),
    Mutation(
        "fagor: a parameter is set and used in one block",
        COMPUTING,
        "if names & set(self._names_in(node)):",
        "if not names:",
        FLOWS,
    ),
    Mutation(
        "fagor: a sign binds before a power",
        COMPUTING,
        'if rule == "power" and rule_of(node.children[0]) == "negated":',
        'if rule == "powers":',
        FLOWS,
    ),
    Mutation(
        "fagor: lines of a loop that goes on are changed",
        PROGRAMS,
        "return None if self.tied or line in self.frozen else spelled",
        "return None if line in self.frozen else spelled",
        FLOWS,
    ),
    Mutation(
        "fagor: a structure that was executed before is only kept",
        PROGRAMS,
        " or self.line in self.ran:",
        ":",
        FLOWS,
    ),
    Mutation(
        "fagor: lines of a subroutine that may be called again are changed",
        PROGRAMS,
        "return None if self.tied or line in self.frozen else spelled",
        "return None if self.tied else spelled",
        FLOWS,
    ),
    Mutation(
        "fagor: a subroutine above a structure that is kept is kept with it",
        PROGRAMS,
        "self.maybe, self.why = range(self.line, until + 1), why",
        "self.maybe, self.why = range(until + 1), why",
        FLOWS,
    ),
    Mutation(
        "fagor: moves behind a cycle that is kept are changed",
        PROGRAMS,
        "        if self.modal:",
        "        if not self.modal and self.tied:",
        FLOWS,
    ),
    Mutation(
        "fagor: moves beside a rounding are changed",
        PROGRAMS,
        "if beside or (self.hangs and self._next_hangs()):",
        "if self.tied:",
        FLOWS,
    ),
    Mutation(
        "fagor: a program that is called may leave G91 behind",
        PROGRAMS,
        '            self.unsaid = {"distance", "motion"}',
        "            self.unsaid = set()",
        FLOWS,
    ),
    Mutation(
        "fagor: X10I counts from zero",
        PLACES,
        "self.at[item.name] + Decimal(item.numbers[0])",
        "Decimal(item.numbers[0])",
        READS,
    ),
    Mutation(
        "fagor: what was incremental before does not count",
        PLACES,
        "self.at[item.name] += value",
        "pass",
        READS,
    ),
    Mutation(
        "fagor: the coordinate before holds over another work offset",
        PLACES,
        "        if not quiet(items):",
        "        if not items:",
        f"{CASE}incremental-from-nowhere]",
    ),
    Mutation(
        "fagor: incremental blocks stay so",
        BLOCKS,
        'if word != "G90")], ["G90"]',
        'if word != "G90")], []',
        READS,
    ),
    Mutation(
        "fagor: X10I in G91 is absolute",
        BLOCKS,
        "if not marked or self.incremental:",
        "if not marked:",
        READS,
    ),
    Mutation(
        "fagor: centres stay absolute behind G6",
        BLOCKS,
        '["G90.1", *words], ["G91.1", *after]',
        '["G90.1", *words], after',
        READS,
    ),
    Mutation(
        "fagor: G6 says nothing",
        BLOCKS,
        '["G90.1", *words], ["G91.1", *after]',
        '["G91.1", *words], ["G91.1", *after]',
        READS,
    ),
    Mutation(
        "fagor: millimetres are inches",
        TABLES,
        '"G71": "G21"',
        '"G71": "G20"',
        READS,
    ),
    Mutation(
        "fagor: D0 takes a length",
        BLOCKS,
        '        if edge == "0":\n            return "G49"\n',
        "",
        READS,
    ),
    Mutation(
        "fagor: the length is that of the tool that was called first",
        BLOCKS,
        "self.in_spindle, self.tool, self.changing = self.tool",
        "self.in_spindle, self.tool, self.changing = self.in_spindle or self.tool",
        READS,
    ),
    Mutation(
        "fagor: moves between a tool change and D",
        BLOCKS,
        '                self.bars["length"] = NO_EDGE, "write D1 behind the tool change"\n',
        "                pass\n",
        f"{CASE}tool-without-edge]",
    ),
    Mutation(
        "fagor: moves behind G53",
        BLOCKS,
        '        if "G53" in codes:',
        '        if "G530" in codes:',
        f"{CASE}g53]",
    ),
    Mutation(
        "fagor: plain blocks are not looked at while nothing may move",
        BLOCKS,
        "        self.plainly = not self.bars and not self.machine\n",
        "",
        f"{CASE}g53]",
    ),
    Mutation(
        "fagor: off is on",
        BLOCKS,
        'return "M128" if on else "M129"',
        'return "M129" if on else "M128"',
        READS,
    ),
    Mutation(
        "fagor: G159 counts from nought",
        BLOCKS,
        'f"{k + 1}": f"G{54 + k}"',
        'f"{k}": f"G{54 + k}"',
        f"{CASE}g159]",
    ),
    Mutation(
        "fagor: what stands behind M30 is read",
        BLOCKS,
        "            self.at = len(self.lines)",
        "            pass",
        READS,
    ),
    Mutation(
        "translation: a shape holds for lines with numbers in comments",
        SHAPES,
        "        if numbers == found:",
        "        if numbers is not None:",
        WALK,
    ),
    Mutation(
        "translation: a sign of programs stands for numbers in shapes",
        "gcxform/flow/tree_shapes.py",
        'SLOT = "\\uffff"',
        'SLOT = "#"',
        WALK,
    ),
    Mutation(
        "translation: carets stand where the first line of a shape has them",
        TRANSLATION,
        "place = self._parsed(self.line)[1][same[0]].place if same else item.place",
        "place = item.place",
        WALK,
    ),
    Mutation(
        "translation: a percent sign of a comment is a place for a number",
        SHAPES,
        'comments.replace("%", "%%")',
        "comments",
        WALK,
    ),
    Mutation(
        "translation: long programs are loops",
        TRANSLATION,
        "        left = most = QUICK * limits().steps + len(self.lines)",
        "        left = most = QUICK * limits().steps",
        WALK,
    ),
    Mutation(
        "translation: maps tell of blocks",
        "gcxform/pipeline/run.py",
        "lines = [self.source.line_of(k + 1) - 1 for k in lines]",
        "pass",
        RUNS,
    ),
    Mutation(
        "translation: errors show the block",
        "gcxform/flow/translated.py",
        "column=start + 1, text=text, width=width)",
        "column=start + 1)",
        RUNS,
    ),
    Mutation(
        "fagor: a pole is as many inches away as it was mm",
        POLAR,
        '{"G53", "G70", "G71", "G92"',
        '{"G53", "G92"',
        "tests/test_corpus.py::test_case[dialects/fagor/pole-of-another-unit]",
    ),
    Mutation(
        "fagor: behind a work offset axes are where they were",
        "plugins/gcxform_plugins/dialects/fagor/programs.py",
        'if shifted or "M6" in codes',
        'if "M6" in codes',
        "tests/test_fagor_flow.py::test_steps_behind_a_work_offset_stay",
    ),
)
