"""Faults of several programs in one call, of what would change, and of the pipeline of a folder."""

from __future__ import annotations

from faults.mutation import Mutation

SEVERAL = "tests/test_several.py"

MUTATIONS = (
    Mutation(
        "several: one that fails ends the call",
        "gcxform/cli/common/several.py",
        'outcome = Outcome(job, "failed", exit_code=told(error, meta))',
        "raise error",
        SEVERAL,
    ),
    Mutation(
        "several: a failure is forgotten where others change",
        "gcxform/cli/common/several.py",
        "return max([CHANGES * changes, *(each.exit_code for each in outcomes)])",
        "return int(changes)",
        SEVERAL,
    ),
    Mutation(
        "several: two programs are written to one place",
        "gcxform/cli/common/jobs.py",
        "if first != job.file:",
        "if False:",
        SEVERAL,
    ),
    Mutation(
        "several: links of a folder are followed out of it",
        "gcxform/cli/common/programs.py",
        "if path.is_file() and lies_in(path, folder):",
        "if path.is_file():",
        SEVERAL,
    ),
    Mutation(
        "several: a pipeline is looked for beyond a repository",
        "gcxform/cli/common/discovery.py",
        "if os.path.realpath(each) == home or any((each / root).exists() for root in ROOTS):",
        "if os.path.realpath(each) == home:",
        SEVERAL,
    ),
    Mutation(
        "several: whose pipeline it is does not matter",
        "gcxform/cli/common/discovery.py",
        "if not is_trusted(found):",
        "if False:",
        SEVERAL,
    ),
    Mutation(
        "diff: moves that are others are not told of their step",
        "gcxform/pipeline/reasons.py",
        "yield from (line for line in {*old, *new} if old.get(line) != new.get(line))",
        "yield from ()",
        SEVERAL,
    ),
    Mutation(
        "diff: a line that stays is shown as new",
        "gcxform/cli/common/difference.py",
        'yield Line(" " if nth == kept else "+", each, number)',
        'yield Line("+", each, number)',
        SEVERAL,
    ),
    Mutation(
        "diff: the terminal takes commands of a program",
        "gcxform/cli/common/difference.py",
        'safe = _SENT.sub("?", text)',
        "safe = text",
        SEVERAL,
    ),
    Mutation(
        "several: what is named and lies where results go is left out in silence",
        "gcxform/cli/common/jobs.py",
        "if self.output is not None and lies_in(name, self.output):",
        "if False:",
        SEVERAL,
    ),
    Mutation(
        "several: a run without any program has done all",
        "gcxform/cli/common/jobs.py",
        "            if not jobs:\n",
        "            if False:\n",
        SEVERAL,
    ),
)
