"""Work done beside a run: by processes of its own for a long program, here for a short one.

Two threads of one process take turns at Python's lock, and lose a third of their time to it; two
processes do not. A process begins as a copy of this one, so nothing has to be said twice, and what
it is given later goes through memory that both can see. Where a process cannot be copied safely
(another system than Linux, other threads, a process of a pool) the work is done here, when its
result is needed.

While a window is transformed and written, one process reads the next ones, and two prove those
before: one reads what was written, the other compares. Up to `DEPTH` windows wait for each, so that
nobody waits because one takes longer than another. A worker ends with its parent.
"""

from __future__ import annotations

import ctypes
import io
import os
import pickle
import signal
import sys
import threading
import traceback
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from itertools import cycle
from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar

import numpy as np

from gcxform.diagnostics import FileError, GcxformError
from gcxform.system.heap import Heap

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

Result = TypeVar("Result")
Work = Callable[..., Result]
DEPTH = 3  # pieces of work that a process may have before it; each takes the memory of a window
LATER = 5  # niceness: the process that waits for all others goes first
LINUX = sys.platform == "linux"
PIECE = 1 << 30  # bytes; the system writes and reads less than two of these at once
ENDING = (signal.SIGTERM, *((signal.SIGHUP,) if hasattr(signal, "SIGHUP") else ()))
SET_DEATH_SIGNAL = 1  # of `prctl`: what this process gets when its parent ends
STOP: list[int] = []  # no sizes: nothing more is to be done
DIED = "a process that took part in this run has been ended"
HINT = "was there enough memory? A long program is read and proved by processes of their own"


class Worker(ABC, Generic[Result]):
    """Does one piece of work after another, in order; `begun` and `ended` count them."""

    depth = 1

    def __init__(self) -> None:
        self.begun = self.ended = 0

    @property
    def busy(self) -> bool:
        """Whether there is work that was begun and not ended."""
        return self.begun > self.ended

    @property
    def full(self) -> bool:
        """Whether a piece has to be ended before the next can be begun."""
        return self.begun - self.ended == self.depth

    def begin(self, *given: object) -> None:
        """Begin a piece of work."""
        assert not self.full
        self._begin(given)
        self.begun += 1  # not before: nobody would ever end what could not be begun

    def end(self) -> Result:
        """Wait for the first piece not ended; return what it gave, or raise what it raised.

        Nobody hears of what was begun behind a piece that has failed.
        """
        assert self.busy
        self.ended += 1
        try:
            return self._end()
        except Exception:
            while self.busy:
                self.ended += 1
                with suppress(Exception):
                    self._end()
            raise

    @abstractmethod
    def _begin(self, given: tuple[object, ...]) -> None: ...

    @abstractmethod
    def _end(self) -> Result: ...

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Do no more work."""


def worker(work: Work[Result], long: bool) -> Worker[Result]:
    """Return who is to do some work: a process of its own if it is long and the system has one."""
    if long and _may_copy():
        with suppress(OSError):
            return Process(work)
    return Here(work)


def relay(first: Work[Any], second: Work[Result], long: bool) -> Worker[Result]:
    """Return who is to do some work on what another makes of the first thing that is given.

    Each is done by a process of its own if it is long and the system has two.
    """
    if long and _may_copy():
        with suppress(OSError):
            return Relay(first, second)
    return Here(lambda item, *rest: second(first(item), *rest))


def _may_copy() -> bool:
    """Whether this process may be copied: one of a pool has no processes of its own."""
    if not LINUX or not hasattr(os, "memfd_create"):  # Python built for an old system lacks it
        return False
    from multiprocessing import parent_process

    return threading.active_count() == 1 and parent_process() is None


def ahead(reader: Worker[Result], items: Iterable[object]) -> Iterator[Result]:
    """Yield what a worker makes of the items, in order; it is at work on the next ones meanwhile.

    What is wrong with the items themselves is raised behind what was made of those before, so that
    how far a worker is ahead makes no difference.
    """
    wrong: list[GcxformError] = []
    for item in _until_wrong(items, wrong):
        done = [reader.end()] if reader.full else []
        reader.begin(item)
        while done:
            yield done.pop()
    while reader.busy:
        yield reader.end()
    for error in wrong:
        raise error


def _until_wrong(items: Iterable[object], wrong: list[GcxformError]) -> Iterator[object]:
    try:
        yield from items
    except GcxformError as error:
        wrong.append(error)


class Here(Worker[Result]):
    """Does its work when the result is asked for."""

    def __init__(self, work: Work[Result]) -> None:
        super().__init__()
        self.work = work
        self.given: tuple[object, ...] = ()

    def _begin(self, given: tuple[object, ...]) -> None:
        self.given = given

    def _end(self) -> Result:
        given, self.given = self.given, ()
        return self.work(*given)


class Process(Worker[Result]):
    """Has its work done by a copy of this process, which keeps what the work remembers.

    Arrays arrive there, and come back, as copies that cannot be changed. Each piece of work has a
    place in memory that both see, for what is given and then for what is answered.
    """

    depth = DEPTH

    def __init__(self, work: Work[Result]) -> None:
        from multiprocessing import get_context

        super().__init__()
        context = get_context("fork")
        self.shared = [os.memfd_create("gcxform") for _ in range(DEPTH)]
        self.here, there = context.Pipe()
        given = work, there, self.here, self.shared, os.getpid()
        self.process = context.Process(target=_serve, args=given, daemon=True)
        # what ends a run is for the one who waits: an interrupt stays blocked in the copy
        ours = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, *ENDING})
        try:
            self.process.start()
        except OSError:
            self._close_shared()
            raise
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, ours)
        there.close()

    def _begin(self, given: tuple[object, ...]) -> None:
        with suppress(ConnectionError):  # that it has died is said when it is waited for
            self.here.send(_lay_down(self.shared[self.begun % DEPTH], given))

    def _end(self) -> Result:
        try:
            sizes = self.here.recv()
            error, result = _pick_up(self.shared[(self.ended - 1) % DEPTH], sizes)
        except (EOFError, OSError):  # the latter if it died in the middle of what it said
            raise FileError.one("GX903", DIED, hint=HINT) from None
        if error is not None:
            raise error
        found: Result = result
        return found

    def __exit__(self, *raised: object) -> None:
        """End the process; at once, whatever it is at, if the run has been ended."""
        if any(isinstance(one, KeyboardInterrupt) for one in raised):
            self.process.kill()
        with suppress(ConnectionError):
            self.here.send(STOP)
        self.here.close()
        self._close_shared()
        self.process.join()

    def _close_shared(self) -> None:
        for place in self.shared:
            os.close(place)


class Relay(Worker[Result]):
    """Two processes: what one makes of a thing goes to the other without coming back here."""

    depth = DEPTH

    def __init__(self, first: Work[Any], second: Work[Result]) -> None:
        super().__init__()
        self.first = Process(first)
        try:
            self.second = Process(lambda *rest: second(self._handed_on(), *rest))
        except OSError:
            self.first.__exit__()
            raise

    def _handed_on(self) -> Any:
        """Wait, in the second process, for what the first has made of the next thing."""
        self.first.begun += 1  # by the one that waits for both
        return self.first.end()

    def _begin(self, given: tuple[object, ...]) -> None:
        self.first.begin(given[0])
        self.second.begin(*given[1:])

    def _end(self) -> Result:
        self.first.ended += 1  # the second has picked it up before it answers
        return self.second.end()

    def __exit__(self, *raised: object) -> None:
        """End both processes."""
        self.second.__exit__(*raised)
        self.first.__exit__(*raised)


def _serve(
    work: Work[Any], there: Connection, here: Connection, shared: list[int], parent: int
) -> None:
    """Do what is asked for, until nobody is left who could ask."""
    here.close()
    _end_with(parent)
    os.nice(LATER)
    heap = Heap()
    with suppress(EOFError, ConnectionError):
        for place in cycle(shared):
            if (sizes := there.recv()) == STOP:
                break
            there.send(_answer(place, _done(work, _pick_up(place, sizes))))
            heap.give_back()


def _end_with(parent: int) -> None:
    """Let this process end when the one that waits for it does, whatever it is at then.

    It would notice by itself, but not before it is done with a window. Signals that end a run are
    for the other one, which has to clean up; here they do what they do by themselves.
    """
    for number in ENDING:
        signal.signal(number, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
    with suppress(AttributeError, OSError):
        ctypes.CDLL(None).prctl(SET_DEATH_SIGNAL, signal.SIGKILL, 0, 0, 0)
    if os.getppid() != parent:  # it had ended before
        os._exit(1)


def _done(work: Work[Any], given: tuple[object, ...]) -> tuple[BaseException | None, Any]:
    """Return what was raised, or what the work gave."""
    try:
        return None, work(*given)
    except GcxformError as error:
        return error, None
    except Exception as error:
        return _unforeseen(error), None


def _answer(shared: int, done: tuple[BaseException | None, Any]) -> list[int]:
    """Lay down what was done, or why it cannot be: there is no room, or it is of a kind unknown."""
    why: BaseException
    try:
        return _lay_down(shared, done)
    except OSError as error:
        why = FileError.one("GX903", str(error), hint=HINT)
    except Exception as error:  # a plugin may raise what cannot be copied
        why = _unforeseen(done[0] or error)
    return _lay_down(shared, (why, None))


def _unforeseen(error: BaseException) -> RuntimeError:
    """Return an error as one that can be copied: what it says comes first, for who reports it."""
    said = traceback.format_exception_only(error)
    return RuntimeError("".join([*said, *traceback.format_exception(error)]))


# --- what goes from one to the other ---


class _Pickler(pickle.Pickler):
    """Hands over a column that has one value throughout as that value."""

    def reducer_override(self, value: object) -> Any:
        if type(value) is not np.ndarray or all(value.strides) or not value.size:
            return NotImplemented
        one = tuple(slice(None) if stride else slice(1) for stride in value.strides)
        return np.broadcast_to, (value[one].copy(), value.shape)


def _lay_down(shared: int, given: object) -> list[int]:
    """Write something into shared memory; return the sizes of its parts."""
    arrays: list[pickle.PickleBuffer] = []
    first = io.BytesIO()
    _Pickler(first, protocol=5, buffer_callback=arrays.append).dump(given)
    sizes: list[int] = []
    place = 0
    for part in (first.getbuffer(), *(array.raw() for array in arrays)):
        sizes.append(part.nbytes)
        place = _write(shared, part, place)
    return sizes


def _write(shared: int, part: memoryview, place: int) -> int:
    """Write all of a part; return where it ends. The system may take less than it is given."""
    while part.nbytes:
        done = os.pwrite(shared, part[:PIECE], place)
        part, place = part[done:], place + done
    return place


def _pick_up(shared: int, sizes: list[int]) -> Any:
    """Return what is in shared memory, as a copy that only this process has."""
    parts, place = [], 0
    for size in sizes:
        pieces = [(place + done, min(PIECE, size - done)) for done in range(0, size, PIECE)]
        parts.append(b"".join([os.pread(shared, most, at) for at, most in pieces]))
        place += size
    return pickle.loads(parts[0], buffers=parts[1:])
