"""Faults of the hot folder: what is done twice, too early, or not at all."""

from __future__ import annotations

from faults.mutation import Mutation

WATCH = "tests/test_watch.py"
FOLDERS = "gcxform/cli/watching/folders.py"
WORK = "gcxform/cli/watching/work.py"
SETTLING = "gcxform/cli/watching/whole_files.py"

MUTATIONS = (
    Mutation(
        "watch: what was published is published again",
        WORK,
        "            if note is None:\n                self._run(name)",
        "            if True:\n                self._run(name)",
        WATCH,
    ),
    Mutation(
        "watch: what was being filed is filed twice",
        FOLDERS,
        "while os.path.lexists(folder / free) and not same_file(folder / free, source):",
        "while os.path.lexists(folder / free):",
        WATCH,
    ),
    Mutation(
        "watch: a file that grows is taken",
        SETTLING,
        "(look, since if look == before else now)",
        "(look, now if before is None else since)",
        WATCH,
    ),
    Mutation(
        "watch: a file that is open is taken",
        SETTLING,
        "return [n for _, n in sorted(rested) if not is_being_written(self.folder / n)]",
        "return [n for _, n in sorted(rested)]",
        WATCH,
    ),
    Mutation(
        "watch: what was written meanwhile is lost",
        WORK,
        "if Look.at(claimed) != before:",
        "if False:",
        WATCH,
    ),
    Mutation(
        "watch: two watchers work in one folder",
        "gcxform/cli/watch.py",
        "if lock is None:",
        "if False:",
        WATCH,
    ),
    Mutation(
        "watch: a program of those done is overwritten",
        FOLDERS,
        "        if not same_file(source, target):\n            return False",
        "        pass",
        WATCH,
    ),
    Mutation(
        "watch: a full disk is the program's fault",
        WORK,
        "            if not _is_its_own(error):\n                raise\n",
        "",
        WATCH,
    ),
    Mutation(
        "watch: programs stamped by others are left alone as well",
        WORK,
        "            return error.diagnostics[0].code == DONE\n        return False",
        "            return True\n        return False",
        WATCH,
    ),
    Mutation(
        "answer: what is not known is no JSON",
        "gcxform/cli/common/answer.py",
        "return value if math.isfinite(value) else None",
        "return value",
        "tests/test_answers.py",
    ),
)
