"""Faults of translation: what one control says otherwise than another."""

from __future__ import annotations

from faults.mutation import Mutation

SAYING, OWN = "gcxform/dialect/saying.py", "gcxform/emit/own_blocks.py"
LEFT = "tests/test_left_out_across.py::"
LENGTHS = "tests/test_lengths_across.py::"
HERE = "tests/test_said_otherwise.py"

ACROSS = "tests/test_corpus.py::test_case"

MUTATIONS = (
    Mutation(
        "saying: a slash is kept that another control asks a switch for",
        "gcxform/emit/manner.py",
        "return one.block_delete == other.block_delete",
        "return True",
        ACROSS,
    ),
    Mutation(
        "saying: blocks that are skipped are written for another control",
        "gcxform/emit/copying.py",
        "self.lines &= ~skipped",
        "self.lines |= skipped",
        ACROSS,
    ),
    Mutation(
        "saying: G10 L20 of another control is as good",
        "gcxform/emit/zeros_said.py",
        "if kind == 20 and one.g10_l20 != other.g10_l20:",
        "if kind == 20 and False:",
        ACROSS,
    ),
    Mutation(
        "saying: P0 of G10 is the same everywhere",
        "gcxform/emit/zeros_said.py",
        "if kind == 2 and not number > 0 and one.g10_p0 != other.g10_p0:",
        "if kind == 2 and number > 9:",
        ACROSS,
    ),
    Mutation(
        "saying: R of G10 turns on every control",
        "gcxform/emit/zeros_said.py",
        'if kind == 2 and "R" in slots and one.g10_rotates != other.g10_rotates:',
        "if kind > 20:",
        ACROSS,
    ),
    Mutation(
        "saying: an exact path stands for an exact stop",
        SAYING,
        "{EXACT_PATH: EXACT_STOP}",
        "{EXACT_STOP: EXACT_PATH, EXACT_PATH: EXACT_STOP}",
        HERE,
    ),
    Mutation(
        "saying: an exact stop is needless",
        SAYING,
        "frozenset({BLEND, LOOK_AHEAD, RPM, CANCEL})\nENDS",
        "frozenset({BLEND, EXACT_STOP, LOOK_AHEAD, RPM, CANCEL})\nENDS",
        HERE,
    ),
    Mutation(
        "saying: G64 is written without its tolerance",
        SAYING,
        'return "" if act == BLEND and self._unbounded(what) else what',
        "return what",
        HERE,
    ),
    Mutation(
        "saying: comments that act are left out",
        SAYING,
        "tells = self.source.text_rule.tells(what)",
        "tells = self.source.text_rule.executes(what)",
        HERE,
    ),
    Mutation(
        "saying: the end of a program may be dropped",
        SAYING,
        'return code is not None and not (code.ends or code.barrier or code.act == "tip-on")',
        "return code is not None",
        HERE,
    ),
    Mutation(
        "saying: M codes stand on the other side of the move",
        OWN,
        "texts[code.after].append",
        "texts[not code.after].append",
        HERE,
    ),
    Mutation(
        "saying: a dwell keeps its number",
        "gcxform/emit/writing.py",
        "words = [dwell_word(seconds, target)",
        "words = [dwell_word(1000 * seconds, target)",
        HERE,
    ),
    Mutation(
        "saying: a cycle that is another one stays",
        "gcxform/emit/expressible.py",
        'if source.codes.get(f"G{number}") != target.codes.get(f"G{number}")',
        'if f"G{number}" not in target.codes',
        HERE,
    ),
    Mutation(
        "saying: cycles are rounded under G64",
        "gcxform/emit/path_modes.py",
        "if not any(code.act == BLEND for code in manner.target.codes.values()):",
        "if manner.crossing:",
        HERE,
    ),
    Mutation(
        "saying: a way home by way of a point is one by G53",
        "gcxform/modal/moves/home.py",
        "if not (still or not words) or not np.isfinite(home[named]).all():",
        "if not np.isfinite(home[named]).all():",
        HERE,
    ),
    Mutation(
        "saying: a way home that lets go of the length there stays one",
        "gcxform/dialect/saying.py",
        "unknown |= called and there.g28_ends_length and not here.g28_ends_length",
        "unknown |= False",
        HERE,
    ),
    Mutation(
        "saying: ways home are moves before a step resolves compensation",
        "gcxform/pipeline/said_in_moves.py",
        "    if done != resolved(plan.path_passes):",
        "    if done:",
        HERE,
    ),
    Mutation(
        "saying: what stands behind an end and acts is taken for another end",
        "gcxform/emit/expressible.py",
        "or word.value.value not in ends",
        "or False",
        "tests/test_left_out_across.py",
    ),
    Mutation(
        "saying: a cycle waits where a setting says how long",
        "gcxform/emit/expressible.py",
        'if "G4" not in target.codes or target.codes["G4"].effect is not Effect.DWELL:',
        'if "G4" not in target.codes:',
        HERE,
    ),
    Mutation(
        "saying: a program's name stays spelled as it was",
        "gcxform/emit/expressible.py",
        'return f"O{bare}" if target.flow_rule.language == "o-words" else bare',
        "return text",
        "tests/test_left_out_across.py",
    ),
    Mutation(
        "saying: a bare way home is not listed",
        "gcxform/proof/inventory.py",
        "if way is not None and way.code == event.what and saying.moves_home(*way.asked):",
        "if False:",
        HERE,
    ),
    Mutation(
        "saying: a way home is said in distances",
        "gcxform/pipeline/said_in_moves.py",
        "incremental[lines] = False",
        "incremental[lines] = incremental[lines]",
        HERE,
    ),
    Mutation(
        "saying: home counts from the work offset",
        "gcxform/modal/moves/home.py",
        "shift = tuple(np.nan_to_num(frames.machine).tolist())",
        "shift = tuple(0.0 * np.nan_to_num(frames.machine))",
        HERE,
    ),
    Mutation(
        "saying: words that the target does not take are left in",
        "gcxform/emit/expressible.py",
        "if words & (set(code.takes) ^ set(other.takes)):",
        "if code.takes[:0] and words:",
        HERE,
    ),
    Mutation(
        "saying: a tool length keeps its millimetres in inches",
        OWN,
        "vector[2] / (INCH if inch else 1.0)",
        "vector[2]",
        f"{LENGTHS}test_a_length_is_said_by_its_value_where_numbers_are_not_taken",
    ),
    Mutation(
        "saying: a tool length is written without its unit",
        OWN,
        "{STATED['units'][1][inch]} {manner",
        "{manner",
        f"{LENGTHS}test_a_length_is_said_by_its_value_where_numbers_are_not_taken",
    ),
    Mutation(
        "saying: G41 without D is of the same tool everywhere",
        "gcxform/emit/expressible.py",
        "if sides and stored[0] != stored[1]:",
        "if False:",
        f"{LENGTHS}test_a_side_without_d_is_another_tool_on_another_control",
    ),
    Mutation(
        "saying: every code may be called inert",
        "gcxform/contract/inert_codes.py",
        "names - known",
        "set()",
        f"{LENGTHS}test_what_cannot_be_inert",
    ),
    Mutation(
        "saying: inert codes of one machine are those of another",
        "gcxform/pipeline/plan.py",
        "reading = replace(reading, inert_m=frozenset())",
        "pass",
        f"{LENGTHS}test_what_is_inert_on_one_machine_is_not_said_of_another",
    ),
    Mutation(
        "saying: a program that is ended by a comment goes on",
        SAYING,
        "EXECUTED in self.drop and ABORT not in what.upper()",
        "EXECUTED in self.drop",
        f"{LEFT}test_a_comment_that_ends_the_program_stays",
    ),
    Mutation(
        "saying: numbers that stand keep no point",
        "gcxform/emit/templates.py",
        "pointed &= crosses and not self.source.point_rule.required",
        "pointed = False",
        f"{LEFT}test_numbers_that_stand_have_points_where_they_count_steps_without",
    ),
    Mutation(
        "saying: a way home of no axis is written for who refuses it",
        SAYING,
        "(unknown and bool(self.machine))",
        "False",
        f"{LEFT}test_a_way_home_of_all_axes_names_them_where_it_has_to",
    ),
)
