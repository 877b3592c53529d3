"""Faults of macros: what they print, how they are called, what their conditions say."""

from __future__ import annotations

from faults.mutation import CORPUS, Mutation


def _macro(name: str, file: str, old: str, new: str, case: str) -> Mutation:
    return Mutation(f"macros: {name}", file, old, new, f"{CORPUS}[{case}]")


MUTATIONS = (
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
