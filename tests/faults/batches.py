"""Faults of several programs in one call, of what would change, and of the pipeline of a folder."""

from __future__ import annotations

from faults.mutation import Mutation

BATCH = "tests/test_batch.py"

MUTATIONS = (
    Mutation(
        "batch: one that fails ends the call",
        "gcxform/cli/common/batch.py",
        'outcome = Outcome(job, "failed", exit_code=told(error, meta))',
        "raise error",
        BATCH,
    ),
    Mutation(
        "batch: a failure is forgotten where others change",
        "gcxform/cli/common/batch.py",
        "return max([CHANGES * changes, *(each.exit_code for each in outcomes)])",
        "return int(changes)",
        BATCH,
    ),
    Mutation(
        "batch: two programs are written to one place",
        "gcxform/cli/common/jobs.py",
        "if first != job.file:",
        "if False:",
        BATCH,
    ),
    Mutation(
        "batch: links of a folder are followed out of it",
        "gcxform/cli/common/programs.py",
        "if path.is_file() and inside:",
        "if path.is_file():",
        BATCH,
    ),
    Mutation(
        "batch: a pipeline is looked for beyond a repository",
        "gcxform/cli/common/discovery.py",
        "if os.path.realpath(each) == home or any((each / root).exists() for root in ROOTS):",
        "if os.path.realpath(each) == home:",
        BATCH,
    ),
    Mutation(
        "batch: whose pipeline it is does not matter",
        "gcxform/cli/common/discovery.py",
        "if owner not in (0, os.getuid()):",
        "if False:",
        BATCH,
    ),
    Mutation(
        "diff: moves that are others are not told of their step",
        "gcxform/pipeline/reasons.py",
        "yield from (line for line in {*old, *new} if old.get(line) != new.get(line))",
        "yield from ()",
        BATCH,
    ),
    Mutation(
        "diff: a line that stays is shown as new",
        "gcxform/cli/common/difference.py",
        'yield Line(" " if nth == kept else "+", each, number)',
        'yield Line("+", each, number)',
        BATCH,
    ),
    Mutation(
        "diff: the terminal takes commands of a program",
        "gcxform/cli/common/difference.py",
        'safe = _SENT.sub("?", text)',
        "safe = text",
        BATCH,
    ),
)
