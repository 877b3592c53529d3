"""Faults of macros: what they print, how they are called, what their conditions say."""

from __future__ import annotations

from faults.mutation import CORPUS, Mutation


def _macro(name: str, file: str, old: str, new: str, case: str) -> Mutation:
    return Mutation(f"macros: {name}", file, old, new, f"{CORPUS}[{case}]")


RENUMBER = "plugins/gcxform_plugins/passes/renumber.py"
MUTATIONS = (
    _macro(
        "a jump names a line of another program",
        RENUMBER,
        "return self.labels.get((self.program[nth], number), [])",
        "return self.labels.get((self.program[0], number), [])",
        "text/renumber-goto",
    ),
    _macro(
        "numbers that begin again are named",
        RENUMBER,
        "if named and counted >",
        "if False and counted >",
        "text/renumber-goto-wraps",
    ),
    _macro(
        "of two lines of one number the first is taken",
        RENUMBER,
        "if len(found) != 1:",
        "if not found:",
        "text/renumber-goto-twice",
    ),
    _macro(
        "a program of another file comes back to no number",
        RENUMBER,
        "if codes & CALLS and there.labels and not _is_here(block, there):",
        "if False:",
        "text/renumber-other-file",
    ),
    _macro(
        "a block that reads its number has another one",
        RENUMBER,
        'map("#{}".format, EXECUTED_NUMBER)',
        'map("#{}".format, ())',
        "text/renumber-number-read",
    ),
    Mutation(
        "macros: where jumps lead is not compared",
        "gcxform/proof/references.py",
        'said.append(f"to {places.get((programs[nth], number), number)}")',
        'said.append("to")',
        "tests/test_textpasses.py",
    ),
    _macro(
        "a code that the control has is declared",
        "gcxform/contract/own_codes.py",
        "if taken or not dialect.flow_rule.macro_levels:",
        "if not dialect.flow_rule.macro_levels:",
        "flow/own-code-of-the-control",
    ),
    _macro(
        "where a declared code ends is not asked",
        "gcxform/modal/lines.py",
        'ends = self.reading.control.get(f"macro {name}", code.act if code else "")',
        'ends = code.act if code else ""',
        "flow/own-code",
    ),
    _macro(
        "a tool that is measured leaves the axes where they were",
        "gcxform/dialect/codes.py",
        'return Code("non-modal", Effect.CALL, takes, act="unknown")',
        'return Code("non-modal", Effect.CALL, takes, act="unchanged")',
        "hazards/measure-lost",
    ),
    _macro(
        "all codes of a range call the first program",
        "gcxform/machine/macro_tables.py",
        'yield from ((f"{letter}{n}", program + n - first)',
        'yield from ((f"{letter}{n}", program)',
        "flow/own-codes-in-a-row",
    ),
    _macro(
        "a program of a code has variables of its own",
        "gcxform/flow/macro_calls.py",
        'return f"shared {name}" in self.run.reading.control',
        'return name == "T"',
        "flow/own-code-shared",
    ),
    _macro(
        "null is no 0 on a Haas, whatever is said",
        "gcxform/flow/relations.py",
        "if said == ZERO:",
        "if False:",
        "flow/haas-null-said",
    ),
    _macro(
        "null is no 0 on a Haas, though nobody says so",
        "gcxform/flow/relations.py",
        "if said == DISTINCT:",
        "if said in (DISTINCT, ''):",
        "flow/haas-null-compared",
    ),
    _macro(
        "a call may not begin where a compensated axis stands",
        "gcxform/emit/copying.py",
        "if not manner.compensates and self._stands_elsewhere(line, stays):",
        "if self._stands_elsewhere(line, stays):",
        "flow/kept-call-on-machine",
    ),
    _macro(
        "a call has to begin where it did to the last bit",
        "gcxform/emit/copying.py",
        "stays = EXACT + manner.promised + manner.rounding(bool(now.inch[line]))",
        "stays = EXACT",
        "flow/kept-call-rounded",
    ),
    _macro(
        "the block of G66 calls behind what moves nothing",
        "gcxform/flow/modal_calls.py",
        "if not active or not (moves or _may_move(meaning)):",
        "if not active:",
        "flow/g66",
    ),
    _macro(
        "moves of a modal program call it again",
        "gcxform/flow/modal_calls.py",
        "active = self._inside() - 1 if self._inside() else len(self.open)",
        "active = len(self.open)",
        "flow/g66",
    ),
    _macro(
        "an arc calls for G66",
        "gcxform/flow/modal_calls.py",
        'if self.codes["motion"] not in STRAIGHT or any(',
        "if any(",
        "flow/g66-arc",
    ),
    _macro(
        "a cycle calls for G66",
        "gcxform/flow/modal_calls.py",
        'if self.codes["cycle"] not in (-1, NUMBER["G80"]):',
        "if False:",
        "flow/g66-cycle",
    ),
    _macro(
        "a program that is not at hand moves without G66",
        "gcxform/flow/modal_calls.py",
        "return meaning.runs_macro or any(",
        "return any(",
        "flow/g66-and-kept-call",
    ),
    _macro(
        "what M98 calls moves for G66",
        "gcxform/flow/modal_calls.py",
        'return "" if depth == len(run.calls) else',
        'return "" if depth + 1 else',
        "flow/g66-and-m98",
    ),
    _macro(
        "G66 in a branch of the machine counts",
        "gcxform/flow/macros.py",
        'if self.branches.open:\n            message = f"only the machine knows whether this',
        'if False:\n            message = f"only the machine knows whether this',
        "flow/g66-perhaps",
    ),
    _macro(
        "a block of null calls for G66",
        "gcxform/flow/macros.py",
        "or self.blocks == before or self.ended:",
        "or self.ended:",
        "flow/g66-vanished",
    ),
    _macro(
        "a local variable that is printed is not set",
        "gcxform/flow/outputs.py",
        "elif differs(self.stands.get(key), value):",
        "elif False:",
        "flow/dprnt",
    ),
    _macro(
        "what was set for a print in a branch counts behind it",
        "gcxform/flow/branches.py",
        "run.lasting.outputs.stands.clear()",
        "run.lasting.outputs.stands.copy()",
        "flow/dprnt-behind-branch",
    ),
    _macro(
        "a jump passes what is set for a print",
        "gcxform/flow/outputs.py",
        "!= level or program.is_jumped_to():",
        "!= level:",
        "flow/dprnt-jumped-to",
    ),
    _macro(
        "an assignment that feeds a print is left out",
        "gcxform/flow/outputs.py",
        "self.program.needs({key})",
        "self.program.needs(set())",
        "flow/dprnt-behind-branch",
    ),
    _macro(
        "what a print of the machine hangs on is forgotten",
        "gcxform/modal/meaning/printed.py",
        "meaning.sends, meaning.prints = True, print_hangs_on(text, dialect)",
        "meaning.sends = True",
        "flow/dprnt-position",
    ),
    _macro(
        "what a message of the machine hangs on is forgotten",
        "gcxform/modal/meaning/sorting.py",
        "meaning.prints = meaning.prints or print_hangs_on(text, dialect)",
        'meaning.prints = ""',
        "flow/message-position",
    ),
    _macro(
        "words beside what is sent out are taken",
        "gcxform/modal/meaning/printed.py",
        'message = "when this is sent out, beside other words, is not certain"\n        yield',
        'message = "when this is sent out, beside other words, is not certain"\n        _ =',
        "flow/dprnt-beside-words",
    ),
)
