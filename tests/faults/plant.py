"""Faults of a batch: what is done twice, or lost, or taken for done."""

from __future__ import annotations

from faults.mutation import Mutation

PLANT = "tests/test_plant.py"

MUTATIONS = (
    Mutation(
        "batch: a program that has changed is taken for done",
        "gcxform/cli/plant/rests.py",
        "return all(self.digest(name) == was for name, was in rests.files.items()) and all(",
        "return True or all(",
        PLANT,
    ),
    Mutation(
        "batch: a subprogram that was not there is not looked for again",
        "gcxform/flow/lookup.py",
        "            inputs.note_search(folder, wanted)\n",
        "",
        PLANT,
    ),
    Mutation(
        "batch: files that a run reads are no part of what its result rests on",
        "gcxform/system/inputs.py",
        "    if now.kept:\n        from hashlib",
        "    if False:\n        from hashlib",
        PLANT,
    ),
    Mutation(
        "batch: a result that is gone or changed is taken for there",
        "gcxform/cli/plant/results.py",
        "return not row.through or digest_of.digest(place(task.root, row)) == row.output_sha256",
        "return True",
        PLANT,
    ),
    Mutation(
        "batch: a receipt is believed without its result",
        "gcxform/cli/plant/work.py",
        "if digest(store.read(row.output)) == row.output_sha256:",
        "if True:",
        PLANT,
    ),
    Mutation(
        "batch: what has a receipt is not published",
        "gcxform/cli/plant/work.py",
        'store.move(f"{STAGED}/{staged.decode()}", row.output)',
        "pass",
        PLANT,
    ),
    Mutation(
        "batch: a result of before stays where its program is refused now",
        "gcxform/cli/plant/batch_run.py",
        "if before is not None and before.through and not row.through:",
        "if False:",
        PLANT,
    ),
    Mutation(
        "batch: what is not ours is taken away",
        "gcxform/cli/plant/batch_run.py",
        "if Present().digest(name) == row.output_sha256:",
        "if True:",
        PLANT,
    ),
    Mutation(
        "batch: a pipeline that has changed is not built anew",
        "gcxform/cli/plant/work.py",
        "if found.looks != _looks(found.rests):",
        "if False:",
        PLANT,
    ),
    Mutation(
        "batch: two results have one place",
        "gcxform/cli/plant/tasks.py",
        "if same is not task:",
        "if False:",
        PLANT,
    ),
    Mutation(
        "batch: a program is replaced by its result",
        "gcxform/cli/plant/tasks.py",
        "if os.path.realpath(task.program) == os.path.realpath(os.path.join(root, task.below)):",
        "if False:",
        PLANT,
    ),
    Mutation(
        "batch: a process that dies takes what others have begun with it",
        "gcxform/cli/plant/pools.py",
        "            return list(begun.values())\n",
        "            return []\n",
        PLANT,
    ),
    Mutation(
        "batch: what a program is called is a formula of a spreadsheet",
        "gcxform/cli/plant/results.py",
        'if isinstance(value, str) and value[:1] in ("=", "+", "-", "@"):',
        "if False:",
        PLANT,
    ),
)
