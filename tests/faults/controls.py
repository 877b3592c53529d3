"""Faults in the tables of the controls that people have, and in telling them from their kin."""

from __future__ import annotations

from faults.mutation import Mutation

TABLES = "plugins/gcxform_plugins/dialects/controls"
TWO = "tests/test_more_controls.py"
CASE = "tests/test_corpus.py::test_case[dialects/controls/{}]"


def _table(case: str, name: str, old: str, new: str, file: str = "grbls") -> Mutation:
    return Mutation(f"controls: {name}", f"{TABLES}/{file}.py", old, new, CASE.format(case))


MUTATIONS = (
    _table(
        "fluidnc-semicolon-in-parentheses",
        "FluidNC reads on behind `;` in brackets",
        "        semicolon_ends=True,\n",
        "",
    ),
    _table("fluidnc-long-line", "FluidNC counts no comments", "line_length=127", "line_length=200"),
    _table("grblhal-more-than-grbl", "turns are not counted", 'turns="P"', 'turns=""'),
    _table("grblhal-refused", "a switch is taken for off", 'delete=""', 'delete="execute"'),
    _table("grblhal-more-than-grbl", "G49 takes axes", "g49_takes_axes=False, ", ""),
    Mutation(
        "controls: a Mach3 counts centres as others",
        f"{TABLES}/pc.py",
        "in_inch=2.54, centres_open=True",
        "in_inch=2.54",
        TWO,
    ),
    Mutation(
        "controls: a control is not told how centres count",
        "gcxform/emit/manner.py",
        "-1 if manner.target.arc_rule.centres_open else NUMBER",
        "NUMBER",
        TWO,
    ),
    Mutation(
        "controls: a dwell of an open unit is that of others",
        "gcxform/emit/expressible.py",
        'name == "G4" and code.effect is Effect.INERT',
        "False",
        TWO,
    ),
    Mutation(
        "controls: G4 with two times takes the first",
        "gcxform/modal/meaning/sorting.py",
        "elif taken[1:]:",
        "elif False:",
        CASE.format("two-times"),
    ),
    Mutation(
        "controls: E is left as G90 makes it",
        "gcxform/modal/columns.py",
        '"last": last,',
        '"last": own,',
        TWO,
    ),
    Mutation(
        "controls: E of a Klipper is a position in G91",
        "gcxform/modal/columns.py",
        "np.maximum(own, distance)",
        "own",
        TWO,
    ),
    Mutation(
        "controls: G91 becomes G90 where it says what E counts",
        "gcxform/emit/copying.py",
        'if rule in ("", "own") or EXTRUDER',
        "if True or EXTRUDER",
        CASE.format("klipper-not-absolute"),
    ),
    _table(
        "printers-no-radius",
        "a Klipper hears a radius",
        "words=NO_R)\n    codes",
        "words=NO_R + 'R')\n    codes",
        "printers",
    ),
    Mutation(
        "controls: a Centroid starts in mm",
        f"{TABLES}/pc.py",
        '"units": "G20"',
        '"units": "G21"',
        TWO,
    ),
    Mutation(
        "controls: any third centre is nothing",
        "gcxform/modal/moves/arcs.py",
        '(self.rule.third == "zero") & (self.words.offset[:, self.normal] == 0)',
        '(self.rule.third == "zero") & has[:, self.normal]',
        CASE.format("uccnc-third-centre"),
    ),
    Mutation(
        "controls: a UCCNC waits in seconds",
        f"{TABLES}/pc.py",
        'dwell={"P": 0.001}',
        'dwell={"P": 1.0}',
        TWO,
    ),
    Mutation(
        "controls: a dialect is named beside its kin",
        "gcxform/guess.py",
        "if n not in kin or scores[n] >= others + ALIKE]",
        "if True]",
        "tests/test_guess.py",
    ),
    _table(
        "tinyg-comments-of-another",
        "words stand behind the comment that ends a block of a TinyG",
        "        parenthesis_ends=True,\n",
        "",
        "tinygs",
    ),
    _table("tinyg-arcs", "a TinyG turns axes along arcs", "turns_axes=False", "", "tinygs"),
    _table("tinyg-arcs", "a TinyG cuts arcs in XZ", '{"XY", "YZ"}', '{"XY", "YZ", "ZX"}', "tinygs"),
    _table("tinyg-circles", "a TinyG cuts circles that name their end", '"none"', '""', "tinygs"),
    _table("tinyg-move-beside-a-dwell", "a TinyG dwells and moves", '"all"', '"axes"', "tinygs"),
    Mutation(
        "controls: behind the end of a TinyG G92 is in force",
        f"{TABLES}/tinygs.py",
        "        shift_ends=True,\n",
        "",
        TWO,
    ),
    Mutation(
        "controls: behind the end of a window G92 is in force",
        "gcxform/modal/interpreter.py",
        "self.state.frames.ended(code, ends)",
        "self.state.frames.ended(code, False)",
        TWO,
    ),
    Mutation(
        "controls: arcs are read in planes in which the control has none",
        "gcxform/modal/moves/arcs.py",
        "if self.plane not in self.rule.planes:",
        "if False:",
        CASE.format("tinyg-arcs"),
    ),
    Mutation(
        "controls: a piece of a block goes behind the comment that ends it",
        "gcxform/emit/templates.py",
        "or (ends and not crosses)",
        "or (ends and crosses)",
        CASE.format("tinyg-words-before-a-comment"),
    ),
    Mutation(
        "controls: a comment keeps the semicolon that ends a block",
        "gcxform/emit/expressible.py",
        'text = text.replace(";", ",")',
        "pass",
        CASE.format("fluidnc-comment-of-another"),
    ),
    Mutation(
        "controls: a tool of a printer as a mill leaves the axes where they are",
        "gcxform/modal/meaning/numbered.py",
        "meaning.changes_tool = meaning.loses_position = True",
        "meaning.changes_tool = True",
        CASE.format("rrf-cnc-tool"),
    ),
    Mutation(
        "controls: an offset of a tool that nobody knows is along Z alone",
        "gcxform/modal/frames/tool_lengths.py",
        "(np.nan, np.nan, np.nan) if tool is None",
        "(0.0, 0.0, 0.0) if tool is None",
        CASE.format("rrf-cnc-offset"),
    ),
    Mutation(
        "controls: a T that changes the tool is copied for a control on which it does not",
        "gcxform/emit/templates.py",
        'if word.address == "T" and self.source.tool_rule.t_changes != (',
        "if False and self.source.tool_rule.t_changes != (",
        CASE.format("rrf-cnc-for-another"),
    ),
    Mutation(
        "controls: a command behind a T is heard",
        "gcxform/modal/meaning/too_many.py",
        '"GMT" if dialect.tool_rule.t_changes else "GM"',
        '"GM"',
        CASE.format("rrf-cnc-one-command"),
    ),
    _table("centroid-returns", "M99 ends a program", "(m99_returns=True)", "()", "pc"),
    Mutation(
        "controls: G49 takes any H",
        "gcxform/modal/frames/tool_lengths.py",
        'if asked.words.get("H", 0.0) != 0:',
        "if False:",
        CASE.format("centroid-length"),
    ),
)
