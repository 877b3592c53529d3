"""A batch: what is not done yet is done, and written down as it comes."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import field
from typing import Final

from gcxform.cli.plant.pools import Rows
from gcxform.cli.plant.rests import Present
from gcxform.cli.plant.results import Results, place
from gcxform.cli.plant.rows import Row
from gcxform.cli.plant.stores import Store
from gcxform.cli.plant.tasks import Task
from gcxform.cli.plant.work import RECEIPTS, STAGED, finished
from gcxform.values import dataclass

PACE: Final = 0.5  # s between two times at which rows are written down


@dataclass
class Batch:
    """Tasks, the table of their results, and the store in which these lie."""

    tasks: Sequence[Task]
    results: Results
    store: Store
    waiting: dict[str, Row] = field(default_factory=dict)
    written: float = 0.0

    def recover(self) -> None:
        """Write down what was published by who did not come to write it down. Raises OSError."""
        for key in self.store.names(RECEIPTS):
            row = finished(self.store, key)
            if row is not None:
                self._note(key, row)
        self._write()

    def sweep(self) -> None:
        """Take away results that never became whole; nobody else may be at work. Raises OSError."""
        for name in self.store.names(STAGED):
            self.store.drop(f"{STAGED}/{name}")

    def left(self) -> list[Task]:
        """Return what is to be done, because it never was or what it rests on has changed."""
        present, digests = Present(), Present()
        return [each for each in self.tasks if not self.results.stands(each, present, digests)]

    def do(self, rows: Rows, told: Callable[[Row], None]) -> None:
        """Write down what becomes of tasks, as it comes."""
        try:
            for task, row in rows:
                self._note(task.key, row)
                told(row)
                if time.monotonic() > self.written + PACE:
                    self._write()
        finally:
            self._write()

    def rows(self) -> list[Row]:
        """Return the rows of the tasks that are known, in their order."""
        found = (self.results.row(task.key) for task in self.tasks)
        return [row for row in found if row is not None]

    def _note(self, key: str, row: Row) -> None:
        """Take a row; the result of an earlier one that this one does not have is withdrawn."""
        before = self.results.row(key)
        if before is not None and before.through and not row.through:
            self._withdraw(before)
        self.waiting[key] = row

    def _withdraw(self, row: Row) -> None:
        """Take away a result that its program does not give any more, if it is still ours."""
        name = place(str(getattr(self.store, "root", "")), row)
        if Present().digest(name) == row.output_sha256:
            self.store.drop(row.output)

    def _write(self) -> None:
        self.results.put(self.waiting)
        for key in self.waiting:
            self.store.drop(f"{RECEIPTS}/{key}")
        self.waiting, self.written = {}, time.monotonic()
