"""Faults of the account of what a program holds, and of what its file lacks for another control."""

from __future__ import annotations

from faults.mutation import CORPUS, Mutation

PLANTED = "tests/test_planted_inventory.py"
MESSAGES = "tests/test_corpus.py::test_case"


def _proof(
    name: str, old: str, new: str = "if False:", file: str = "gcxform/proof/inventory.py"
) -> Mutation:
    return Mutation(f"inventory: {name}", file, old, new, PLANTED)


MUTATIONS = (
    _proof(
        "other values are ignored",
        "if not same or not close:",
    ),
    _proof(
        "which parameter is set is not looked at",
        "        and np.array_equal(new.named_by(old.names), old.which)\n",
        "",
    ),
    _proof(
        "values of assignments in columns are not looked at",
        "        close.all()\n        and np",
        "        np",
    ),
    _proof("missing assignments are ignored", "if len(old) == len(new):", "if True:"),
    _proof("kinds need not balance", "            if count:", "            if count > 99:"),
    _proof(
        "what is behind the end is ignored",
        "if not self.crossing and output.behind != self.text_behind.hexdigest():",
    ),
    _proof(
        "what loops have set is ignored",
        "if self.executed is not None and not self.executed.agrees(self.assigned):",
    ),
    _proof(
        "the end is ignored",
        "if found.file.no_end and not faulty:",
        file="gcxform/pipeline/run.py",
    ),
    _proof(
        "lines need not be written out",
        "plain & (times != _written(program))",
        "plain & (times < 0)",
        "gcxform/flow/line_account.py",
    ),
    _proof(
        "lines need not follow",
        "plain & (behind < times)",
        "plain & (behind < 0)",
        "gcxform/flow/line_account.py",
    ),
    _proof(
        "loops need not go on",
        "and not times[last + 1]:",
        "and False:",
        "gcxform/flow/line_account.py",
    ),
    _proof(
        "M codes are not counted",
        "ends, others, modes]",
        "ends, 0, modes]",
        "gcxform/modal/inventory.py",
    ),
    Mutation(
        "inventory: path modes are not counted",
        "gcxform/modal/inventory.py",
        "others, modes]",
        "others, 0]",
        "tests/test_path_modes.py",
    ),
    Mutation(
        "inventory: other programs may move",
        "gcxform/pipeline/run.py",
        "if self.marks.changes:\n                    self",
        "if True:\n                    self",
        CORPUS,
    ),
    Mutation(
        "inventory: what moves before is another program",
        "gcxform/proof/inventory.py",
        "moves > begins[0]",
        "moves > -1",
        CORPUS,
    ),
    Mutation(
        "inventory: no percent signs",
        "gcxform/modal/program_end.py",
        "behind=True)",
        "behind=False)",
        CORPUS,
    ),
    Mutation(
        "messages: what is small is printed",
        "gcxform/flow/messages.py",
        "ZERO = 1e-4",
        "ZERO = 1e-9",
        MESSAGES,
    ),
    Mutation(
        "messages: %f has six decimals",
        "gcxform/flow/messages.py",
        "DECIMALS, OF_F = 6, 4",
        "DECIMALS, OF_F = 6, 6",
        MESSAGES,
    ),
)
