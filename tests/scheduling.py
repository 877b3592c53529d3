"""Which process runs which tests: runs of neighbours, so what they share is made once.

xdist's own `loadgroup` hands out tests one by one and, before each, counts all that it has ever
handed out: a minute of a processor for 12,000 tests. Neighbours in a file share caches, modules and
fixtures, which two processes that take turns both make.
"""

from __future__ import annotations

from collections.abc import Sequence

from xdist.scheduler import LoadGroupScheduling
from xdist.workermanage import WorkerController

TOGETHER = 8  # tests of a file; more of them leave a process idle in the end


def runs_of(collection: Sequence[str]) -> dict[str, str]:
    """Return the run of each test: its group, or its file with the count of the eights before."""
    runs: dict[str, str] = {}
    counted: dict[str, int] = {}
    for test in collection:
        if test.rfind("@") > test.rfind("]"):  # as xdist writes a group behind a name
            runs[test] = test.rpartition("@")[2]
        else:
            file = test.partition("::")[0]
            counted[file] = counted.get(file, -1) + 1
            runs[test] = f"{file} {counted[file] // TOGETHER}"
    return runs


class Runs(LoadGroupScheduling):
    """Hands out runs and groups, longer ones first, and forgets what is done."""

    def add_node_collection(self, node: WorkerController, collection: Sequence[str]) -> None:
        """Learn what a process has found; all have found the same."""
        super().add_node_collection(node, collection)
        self.runs = runs_of(collection)

    def _split_scope(self, nodeid: str) -> str:
        return self.runs[nodeid]

    def mark_test_complete(
        self, node: WorkerController, item_index: int, duration: float = 0
    ) -> None:
        """Note that a test has ended, and perhaps its run."""
        super().mark_test_complete(node, item_index, duration)
        run = self.runs[self.registered_collections[node][item_index]]
        if all(self.assigned_work[node][run].values()):
            del self.assigned_work[node][run]
