"""Who does the tasks: processes of this machine, or the workers of a scheduler of Dask.

Both yield rows as they come, in any order, and both outlive workers that die: a task whose process
has ended is tried again, and one that ends every process that tries it is given up by itself.
"""

from __future__ import annotations

import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from itertools import islice
from multiprocessing import get_context, parent_process
from typing import Any, Final

from gcxform.cli.plant.rows import Row
from gcxform.cli.plant.tasks import Task
from gcxform.cli.plant.work import died, done
from gcxform.diagnostics import FileError, UsageError
from gcxform.plugin.registry import versions

AHEAD: Final = 3  # tasks that a process has before it, so that it never waits
AT_ONCE: Final = 2000  # tasks that a scheduler knows of
TRIES: Final = 2
REACHED: Final = "20 s"  # within which a scheduler must answer
DIED: Final = "the process that worked on it was ended each time; was there enough memory?"
Rows = Iterator[tuple[Task, Row]]
Do = Callable[[Task], Row]


def here(tasks: Iterable[Task], count: int, do: Do = done) -> Rows:
    """Yield what processes of this machine make of tasks. Raises OSError."""
    waiting = iter(tasks)
    while True:
        with _pool(count) as pool:
            suspects = yield from _until_broken(pool, waiting, AHEAD * count, do)
        if not suspects:
            return
        yield from _one_by_one(suspects, do)  # one has ended its process, or somebody else has


def _until_broken(pool: ProcessPoolExecutor, tasks: Iterator[Task], most: int, do: Do) -> Any:
    """Yield what a pool makes of tasks; return those that were begun when a process ended."""
    begun: dict[Future[Row], Task] = {}
    while True:
        try:
            for task in islice(tasks, most - len(begun)):
                begun[_sent(pool, task, do)] = task
            if not begun:
                return []
            for future in wait(begun, return_when=FIRST_COMPLETED).done:
                row = future.result()
                yield begun.pop(future), row
        except BrokenProcessPool:
            return list(begun.values())


def _sent(pool: ProcessPoolExecutor, task: Task, do: Do) -> Future[Row]:
    """Give a task to a pool; one that is broken says so when the result is asked for."""
    try:
        return pool.submit(do, task)
    except BrokenProcessPool as error:
        future: Future[Row] = Future()
        future.set_exception(error)
        return future


def _one_by_one(tasks: Iterable[Task], do: Do) -> Rows:
    """Yield what becomes of tasks, one at a time: which of them ends its process is known then."""
    left, tries = deque(tasks), 0
    while left:
        with _pool(1) as pool:
            try:
                while left:
                    row = pool.submit(do, left[0]).result()
                    yield left.popleft(), row
                    tries = 0
            except BrokenProcessPool:
                tries += 1
        if tries == TRIES:
            yield left[0], died(left.popleft(), DIED)
            tries = 0


def _pool(count: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(count, get_context("spawn"), _begin)


def _begin() -> None:
    """Prepare a process of a pool: it ends with its parent, however that ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # that is for the one who waits
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def scheduled(tasks: Iterable[Task], address: str, do: Do = done) -> Rows:
    """Yield what the workers of a scheduler make of tasks. Raises FileError and UsageError."""
    try:
        from distributed import Client, as_completed
    except ImportError:
        message = "a scheduler is asked by Dask, which is not installed"
        raise UsageError.one("GX752", message, hint="pip install 'gcxform[dask]'") from None
    try:
        client = Client(address, timeout=REACHED, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise FileError.one("GX901", f"cannot reach the scheduler {address}: {error}") from None
    with client, client.as_current():
        tasks = iter(tasks)
        submit = _submitter(client, do)
        begun = {submit(task): task for task in islice(tasks, AT_ONCE)}
        coming = as_completed(begun)
        for future in coming:
            task = begun.pop(future)
            yield task, _answer(future, task, address)
            for other in islice(tasks, 1):
                begun[new := submit(other)] = other
                coming.add(new)


def _submitter(client: Any, do: Do) -> Callable[[Task], Any]:
    def submit(task: Task) -> Any:
        return client.submit(do, task, pure=False, retries=TRIES)

    return submit


def _answer(future: Any, task: Task, address: str) -> Row:
    """Return what a worker has made of a task. Raises FileError if the scheduler has gone."""
    from distributed import KilledWorker

    try:
        row: Row = future.result()
    except KilledWorker:
        return died(task, DIED)
    except Exception as error:
        if future.status in ("lost", "cancelled"):
            message = f"the scheduler {address} has gone; call again when it is there"
            raise FileError.one("GX903", message) from None
        return died(task, f"{type(error).__name__}: {error}".partition("\n")[0])
    if row.version and row.version != versions():
        return died(task, f"a worker has {row.version}, and this is {versions()}")
    return row
