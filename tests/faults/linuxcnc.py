"""Faults of what LinuxCNC alone has: values that its machine knows, messages, O-words."""

from __future__ import annotations

from faults.mutation import Mutation


def _of(name: str, file: str, old: str, new: str, case: str) -> Mutation:
    return Mutation(f"linuxcnc: {name}", file, old, new, f"tests/test_corpus.py::test_case[{case}]")


RESIDUAL = "gcxform/flow/residual.py"
MUTATIONS = (
    _of(
        "what has no value stays beside what is lost",
        RESIDUAL,
        "        if not why.lost:\n            raise\n",
        "        del why\n",
        "flow/lost-beside-unset",
    ),
    _of(
        "a number in EXISTS",
        RESIDUAL,
        'if rule_of(node) == "parameter" or _asks(node):',
        'if rule_of(node) == "parameter":',
        "flow/lost-exists",
    ),
    _of(
        "a kept assignment beside a dropped one goes",
        "gcxform/flow/execution.py",
        "if isinstance(i, Word | Statement) and i.start not in gone]",
        "if isinstance(i, Word) and i.start not in gone]",
        "flow/lost-beside-dropped",
    ),
    _of(
        "a message of any length",
        "gcxform/flow/lasting_values.py",
        "if known is None or abs(known) < LONGEST:",
        "if known is None or math.isfinite(known):",
        "flow/message-too-long",
    ),
    _of(
        "a word of the machine counts from where it is written",
        "gcxform/emit/same_rows.py",
        "np.isnan(end) & np.isnan(old) & unshifted[:, k]",
        "np.isnan(end) & np.isnan(old)",
        "offsets/lost-word-shifted",
    ),
    _of(
        "a step that only the machine knows is lost for ever",
        "gcxform/modal/columns.py",
        "unknown = incremental & np.isnan(value)",
        "unknown = incremental & False",
        "offsets/lost-word",
    ),
    Mutation(
        "linuxcnc: the proof lets words of the machine count from elsewhere",
        "gcxform/proof/lost_words.py",
        "new.shift[k]) <= near:",
        "new.shift[k]) <= 1e9:",
        "tests/test_verify.py::test_a_word_of_the_machine_counts_from_where_it_did",
    ),
    Mutation(
        "linuxcnc: legs are chords of a tilted arc",
        "gcxform/modal/moves/tilted_arcs.py",
        " / np.cos(sweep / count / 2)",
        "",
        "tests/test_tilted_arcs.py",
    ),
    Mutation(
        "linuxcnc: a tilted arc turns the other way",
        "gcxform/modal/moves/tilted_arcs.py",
        "+ path.sense[row] * sweep * parts",
        "- path.sense[row] * sweep * parts",
        "tests/test_tilted_arcs.py",
    ),
    _of(
        "a tilted arc begins elsewhere",
        "gcxform/emit/copying.py",
        "IN_PLACE = (Form.NURBS, Form.PASSES, Form.TILTED)",
        "IN_PLACE = (Form.NURBS, Form.PASSES)",
        "dialects/linuxcnc/tilted-arc-start",
    ),
    _of(
        "tilted arcs of every control",
        "gcxform/modal/moves/tilted_arcs.py",
        " | (not dialect.offset_rule.g10_rotates)",
        "",
        "dialects/fanuc/tilted-arc",
    ),
    _of(
        "G28.1 takes a place that nobody knows",
        "gcxform/modal/frames/work_offsets.py",
        "known = [origin == state.first for origin",
        "known = [bool(origin) for origin",
        "dialects/linuxcnc/home-from-nowhere",
    ),
    _of(
        "G92 from nowhere shifts by nothing",
        "gcxform/modal/frame_state.py",
        "            origin[k] += name\n",
        "            del name\n",
        "dialects/linuxcnc/preset-from-nowhere",
    ),
    _of(
        "G92.3 brings another zero back",
        "gcxform/modal/frames/work_offsets.py",
        "preset=state.held, adrift=state.held_adrift)",
        "preset=state.held)",
        "offsets/preset-from-nowhere-restored",
    ),
    _of(
        "G92 from nowhere in turned coordinates",
        "gcxform/modal/frames/work_offsets.py",
        "if turned or moved or state.following",
        "if moved or state.following",
        "dialects/linuxcnc/preset-from-nowhere-turned",
    ),
    _of(
        "a word of the machine is no axis word of a cycle",
        "gcxform/modal/cycles/stretch.py",
        "has_axes = ~absent | calls.lost",
        "has_axes = ~absent",
        "flow/hole-at-x-of-the-machine",
    ),
    _of(
        "a motion code is in force as before behind a lathe cycle",
        "gcxform/modal/moves/kept_calls.py",
        'lost[call.line] |= group == "motion" and',
        "lost[call.line] |= False and",
        "dialects/linuxcnc/contour-motion",
    ),
    _of(
        "a contour that is called is changed",
        "gcxform/flow/owords.py",
        "if self.times[contour.lines[0] + 1 : contour.last].any():",
        "if False:",
        "dialects/linuxcnc/contour-called",
    ),
    _of(
        "strip makes one name of two",
        "plugins/gcxform_plugins/passes/strip.py",
        '" " * bool(found[1] and found[2])',
        '""',
        "text/strip-operators",
    ),
    Mutation(
        "linuxcnc: a remapped code is its own",
        "plugins/gcxform_plugins/controls/linuxcnc/ini.py",
        'if (section, key) == ("RS274NGC", "REMAP"):',
        "if False:",
        "tests/test_linuxcnc_ini.py::test_a_code_that_runs_a_program_is_refused_where_it_stands",
    ),
    Mutation(
        "linuxcnc: a tool change that moves axes does not",
        "plugins/gcxform_plugins/controls/linuxcnc/ini.py",
        '"M6": "moves"',
        '"M9": "moves"',
        "tests/test_linuxcnc_ini.py::test_a_tool_change_that_moves",
    ),
    Mutation(
        "linuxcnc: other modes at the start",
        "plugins/gcxform_plugins/controls/linuxcnc/ini.py",
        'if letter.upper() in "GM" and',
        'if letter.upper() in "M" and',
        "tests/test_linuxcnc_ini.py::test_words_and_modes_that_are_not_followed",
    ),
    Mutation(
        "linuxcnc: G90 is in force behind a branch that may say G91",
        "gcxform/flow/places.py",
        "open_ = math.nan if self.interpreter.undecided else known",
        "open_ = known",
        "tests/test_corpus.py::test_case[flow/units-behind-a-branch]",
    ),
)
