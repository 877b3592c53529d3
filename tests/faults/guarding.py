"""Faults of what guards a run: limits, the door for files, copies of programs, settings."""

from __future__ import annotations

from faults.mutation import Mutation

HOSTILE = "tests/test_hostile.py"
BESIDE = "tests/test_interference.py"


def _door(name: str, old: str, new: str, test: str) -> Mutation:
    return Mutation(f"door: {name}", "gcxform/system/inputs.py", old, new, test)


def _source(name: str, old: str, new: str, test: str) -> Mutation:
    return Mutation(f"source: {name}", "gcxform/syntax/source.py", old, new, test)


MUTATIONS = (
    _door("what is read is not known", "    now.read.add(", "    set().add(", BESIDE),
    _door(
        "links are not seen through",
        "if not any(lies_in(path, root) for root in now.roots):",
        "if not any(root in os.path.abspath(path) for root in now.roots):",
        HOSTILE,
    ),
    _door(
        "a file is what it was",
        "    return not same or size != after.st_size",
        "    return False",
        BESIDE,
    ),
    _source(
        "a line may have a byte more",
        "while len(text) - at > most:",
        "while len(text) - at > most + 1:",
        HOSTILE,
    ),
    _source(
        "a copy is never compared",
        "if before is not None and is_changed(",
        "if False and is_changed(",
        BESIDE,
    ),
    Mutation(
        "rows: no window is too large",
        "gcxform/toolpath/path.py",
        "int(counts.sum()) > limits().rows",
        "False",
        f"{HOSTILE}::test_a_limit_of_the_command_line_replaces_that_of_the_file",
    ),
    Mutation(
        "grammar: a tree may be as deep as its text",
        "gcxform/syntax/grammar.py",
        "        if level:\n",
        "        if False:\n",
        f"{HOSTILE}::test_expressions_without_end",
    ),
    Mutation(
        "models: parts of parts are not counted",
        "gcxform/errormodel/model_file.py",
        "        self.files += 1\n",
        "",
        f"{HOSTILE}::test_a_sum_of_sums_of_sums",
    ),
    Mutation(
        "worker: it goes on without the one that waits",
        "gcxform/system/worker.py",
        "    _end_with(parent)\n",
        "",
        f"{BESIDE}::test_a_worker_ends_with_the_one_that_waits_whatever_it_is_at",
    ),
    Mutation(
        "files: any may be replaced",
        "gcxform/system/files.py",
        "    _check_replaceable(path)\n",
        "",
        BESIDE,
    ),
    Mutation(
        "control: what nobody has declared is taken",
        "gcxform/machine/control.py",
        "if name != INERT and name not in _KNOWN:",
        "if False:",
        "tests/test_corpus.py::test_case",
    ),
)
