"""The loop of a watcher: looks, works, waits. It looks at times of its own, whatever wakes it.

Events of the file system (`watchdog`, of the extra `gcxform[watch]`) only make it look sooner: on
shares of a network there are none.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from typing import Any, Final

from gcxform.cli.watching.whole_files import Settling
from gcxform.cli.watching.work import Work
from gcxform.diagnostics import FileError
from gcxform.system.alone import is_there

PACE: Final = 0.05  # s between two looks, however many events there are
Wait = Callable[[float], object]


def watch(
    work: Work,
    settling: Settling,
    ready: Callable[[], bool],
    wait: Wait,
    every: float,
    lock: int,
    once: bool = False,
) -> None:
    """Do programs as they come, every so many seconds; `once`: those that are there, and end.

    `ready` prepares the pipelines before programs are done, and says whether that went well.
    Raises FileError if the folder has gone.
    """
    work.recover()
    while True:
        if not is_there(lock, work.folders.lock):
            raise FileError.one("GX901", f"the folder {settling.folder} is not there any more")
        names = settling.whole()
        if (names or work.waits) and ready():
            work.again()
            for name in names:
                work.take(name)
        if once and not _more(work, settling):
            return
        wait(min(every, max(settling.rest, PACE)))


def _more(work: Work, settling: Settling) -> bool:
    """Whether a file may still become whole that is not known to be left where it is."""
    known = {*work.left, *work.later, *work.complaints}
    settling.whole()
    return any(look.size and name not in known for name, (look, _) in settling.seen.items())


@contextmanager
def waker(folder: Path) -> Iterator[Wait]:
    """Give a function that waits some seconds, less if something happens in the folder."""
    try:
        from watchdog.events import FileSystemEvent, FileSystemEventHandler
        from watchdog.observers import Observer
    except ImportError:
        yield time.sleep
        return

    logging.getLogger("watchdog").setLevel(logging.CRITICAL)  # it tells of its own threads
    event = Event()

    class Wakes(FileSystemEventHandler):
        def on_any_event(self, _: FileSystemEvent) -> None:
            event.set()

    observer: Any = Observer()
    try:
        observer.schedule(Wakes(), str(folder))
        observer.start()
    except OSError:  # no more events are to be had: it looks all the same
        yield time.sleep
        return

    def wait(seconds: float) -> None:
        time.sleep(PACE)
        event.wait(max(seconds - PACE, 0.0))
        event.clear()

    try:
        yield wait
    finally:
        observer.stop()
        observer.join(1.0)
