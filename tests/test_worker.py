"""Long programs are read and proved by processes of their own, which changes only the time."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from itertools import count
from pathlib import Path

import numpy as np
import pytest
from test_corpus import PLACES, all_cases, joins, name

import gcxform as gx
from gcxform.cli import main
from gcxform.cli.common.failures import FAILED, INTERRUPTED
from gcxform.diagnostics import FileError, InputError, Location
from gcxform.emit.emitter import Emitter
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.line_notes import Assigned
from gcxform.proof.verify import Verifier
from gcxform.system.records import Records
from gcxform.system.worker import DIED, Here, Process, Relay, _may_copy, ahead, relay, worker
from gcxform.testing.cases import check_outcome, outcome
from gcxform.toolpath.path import Event

pytestmark = pytest.mark.skipif(not hasattr(os, "memfd_create"), reason="no processes here")


class Adding:
    """Remembers what it was given."""

    def __init__(self):
        self.total = 0

    def add(self, number):
        self.total += number
        return self.total, os.getpid()


EVENTS = (Event(3, "G54"), Event(4, "DWELL", (("seconds", 0.5),), 7, True), Event(0, "M3", (), -1))


@pytest.mark.parametrize("made", [(), EVENTS, (Assigned(4, 1, 2.5), Assigned(6, "<a>", 0.0, "#1"))])
def test_records_arrive_as_they_were_given(made):
    given = Records(made)
    with Process(lambda *records: records) as one:
        one.begin(given, made)
        assert one.end() == (given, made) == (made, made)
    arrived = pickle.loads(pickle.dumps(given))
    assert type(arrived) is Records
    assert [type(each) for each in arrived] == [type(each) for each in made]


@pytest.mark.parametrize("kind", [Here, Process])
def test_work_remembers(kind):
    adding = Adding()
    with kind(adding.add) as one:
        found = list(ahead(one, [1, 2, 3]))
    assert [total for total, _ in found] == [1, 3, 6]
    assert {pid == os.getpid() for _, pid in found} == {kind is Here}
    assert adding.total == (6 if kind is Here else 0)


@pytest.mark.parametrize("kind", [Here, Process])
def test_the_first_error_is_raised(kind):
    """What is wrong with an item is said after the item before it was handed on."""

    def refuse(number):
        if number == 2:
            raise InputError.one("GX213", "two", Location("a.nc", 2, 1, "G1", 2), "hint", "context")
        return number

    with kind(refuse) as one:
        found = ahead(one, [1, 2, 3])
        assert next(found) == 1
        with pytest.raises(InputError) as caught:
            next(found)
    assert caught.value.diagnostics[0].where == Location("a.nc", 2, 1, "G1", 2)
    assert caught.value.render().count("two") == 1


@pytest.mark.parametrize("kind", [Here, Process])
def test_what_is_wrong_with_an_item_comes_behind_what_was_made_before(kind):
    """However far ahead one is at work: of several errors the first in a program is told."""

    def items(bad):
        yield from range(bad)
        raise InputError.one("GX761", "too long")

    with kind(lambda number: [1, 2, 3][number]) as one:
        found = ahead(one, items(2))
        assert [next(found), next(found)] == [1, 2]
        with pytest.raises(InputError, match="too long"):
            next(found)
    with kind(lambda number: [1, 2][number]) as one, pytest.raises((IndexError, RuntimeError)):
        list(ahead(one, items(3)))


def test_pieces_of_work_wait_in_their_order():
    """Each is kept as it was given, and nobody hears of those behind one that has failed."""

    def positive(column):
        if column[0] < 0:
            raise InputError.one("GX213", f"{column[0]:g}")
        return column

    columns = [np.full(size, float(size)) for size in (1000, 1, 500)]
    with Process(positive) as one:
        for column in columns:
            one.begin(column)
        assert one.full
        for column in columns:
            np.testing.assert_array_equal(one.end(), column)
        for value in (-1.0, -2.0, 3.0):
            one.begin(np.array([value]))
        with pytest.raises(InputError, match="-1"):
            one.end()
        assert not one.busy
        one.begin(np.array([5.0]))
        assert one.end() == 5.0


def test_what_nobody_foresaw_keeps_its_trace():
    with Process(lambda: {}["missing"]) as one:
        one.begin()
        with pytest.raises(RuntimeError, match=r"^KeyError: 'missing'\nTraceback"):
            one.end()
        one.begin()  # it goes on
        with pytest.raises(RuntimeError):
            one.end()


@pytest.mark.parametrize("long", [False, True])
def test_one_works_on_what_another_has_made(long):
    """Each remembers what it was given, and what was made does not come back in between."""
    first, second = Adding(), Adding()

    def times(made, factor):
        total, pid = made
        return (*second.add(total * factor), pid)

    with relay(first.add, times, long) as both:
        assert isinstance(both, Relay if long else Here)
        found = []
        for number in (1, 2, 3, 4, 5):
            if both.full:
                found.append(both.end())
            both.begin(number, 10)
        while both.busy:
            found.append(both.end())
    assert [total for total, _, _ in found] == [10, 40, 100, 200, 350]
    assert len({os.getpid(), *(pid for one in found for pid in one[1:])}) == (3 if long else 1)


@pytest.mark.parametrize("who", [0, 1])
@pytest.mark.parametrize("how", ["refuses", "dies"])
def test_either_of_two_may_fail(who, how):
    def fail(number, *rest):
        if number == 2 and how == "dies":
            os.kill(os.getpid(), signal.SIGKILL)
        if number == 2:
            raise InputError.one("GX213", "two")
        return number

    works = [lambda number, *rest: number, lambda number, *rest: number]
    works[who] = fail
    with relay(*works, True) as both:
        for number in (1, 2, 3):
            both.begin(number)
        assert both.end() == 1
        with pytest.raises((InputError, FileError), match=DIED if how == "dies" else "two"):
            both.end()
        assert not both.busy
        if how == "refuses":
            both.begin(4)
            assert both.end() == 4


def test_where_the_system_has_no_second_process_all_is_done_here(monkeypatch):
    done, fork = count(), os.fork

    def second_refused():
        if next(done):
            raise BlockingIOError("too many processes")
        return fork()

    monkeypatch.setattr(os, "fork", second_refused)
    with relay(lambda number: number + 1, lambda number, by: number * by, True) as both:
        assert isinstance(both, Here)
        both.begin(2, 5)
        assert both.end() == 15
    assert not [at for at in Path("/proc/self/fd").iterdir() if "memfd" in os.path.realpath(at)]


def columns():
    """Return arrays of all layouts that toolpaths have."""
    return {
        "rows": np.arange(12.0).reshape(4, 3),
        "columns": np.arange(12.0).reshape(3, 4).T,
        "part": np.arange(24.0)[::2],
        "constant": np.broadcast_to(np.float64(np.nan), (5, 2, 3)),
        "one row": np.broadcast_to(np.arange(3.0), (4, 3)),
        "one value": np.broadcast_to(np.int8(7), 3),
        "none": np.empty((0, 3)),
        "flags": np.array([True, False]),
        "number": np.array(4.0),
    }


def test_columns_arrive_as_they_are():
    given = columns()
    with Process(lambda columns: columns) as one:
        for _ in range(2):
            one.begin(given)
            there = one.end()
            assert there.keys() == given.keys()
            for key, column in given.items():
                np.testing.assert_array_equal(there[key], column)
                assert there[key].dtype == column.dtype
                still = [stride == 0 for stride in column.strides]
                assert not column.size or [s == 0 for s in there[key].strides] == still


def test_what_arrived_is_not_changed_by_what_comes_next():
    kept = []

    def keep(column):
        kept.append(column)
        return [float(one.sum()) for one in kept]

    with Process(keep) as one:
        found = list(ahead(one, [np.full(1000, number) for number in (1.0, 2.0, 3.0)]))
    assert found[-1] == [1000.0, 2000.0, 3000.0]
    assert kept == []


def test_a_process_that_dies_is_told():
    with Process(lambda: os.kill(os.getpid(), signal.SIGKILL)) as one:
        one.begin()
        with pytest.raises(FileError, match=DIED):
            one.end()
        one.begin()
        with pytest.raises(FileError, match=DIED):
            one.end()


def test_a_process_that_dies_while_it_answers_is_told():
    def half():
        there = sys._getframe(2).f_locals["there"]
        os.write(there.fileno(), b"\0\0\1\0half")
        os._exit(1)

    with Process(half) as one:
        one.begin()
        with pytest.raises(FileError, match=DIED):
            one.end()


def test_what_could_not_be_begun_is_not_waited_for():
    """As a run does when something cannot be handed over, or is interrupted on the way."""
    with Process(lambda given: given) as one:
        with pytest.raises((AttributeError, pickle.PicklingError)):
            one.begin(lambda: "has no copy")
        assert not one.busy
        one.begin(5)
        assert one.end() == 5


def test_an_error_that_has_no_copy_is_told():
    class Local(InputError):
        """Of a function: it cannot be found by its name."""

    def refuse():
        raise Local.one("GX213", "two")

    with Process(refuse) as one:
        for _ in range(2):
            one.begin()
            with pytest.raises(RuntimeError, match="two"):
                one.end()


def limited(size):
    """Let this process write files no longer than that."""
    import resource

    resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))


def test_what_has_no_room_is_told():
    """The system writes what there is room for, and says nothing but how much that was."""
    column = np.ones(1000)
    with Process(lambda given: limited(5000) or given) as one:
        one.begin(column)
        with pytest.raises(FileError, match="too large"):
            one.end()
    with Process(len) as one, Process(lambda: limited(5000) or one.begin(column)) as outer:
        outer.begin()
        with pytest.raises(RuntimeError, match="too large"):
            outer.end()


def test_large_columns_go_piece_by_piece(monkeypatch):
    """The system takes and gives less than two GiB at once, and may take less than it is given."""
    pwrite, pread, most = os.pwrite, os.pread, 1000
    monkeypatch.setattr("gcxform.system.worker.PIECE", 3000)
    monkeypatch.setattr(os, "pwrite", lambda file, part, at: pwrite(file, part[:most], at))
    monkeypatch.setattr(os, "pread", lambda file, size, at: pread(file, min(size, 3000), at))
    given = np.arange(10_000.0)
    with Process(lambda column: column) as one:
        one.begin([given, given[:1]])
        there = one.end()
    np.testing.assert_array_equal(there[0], given)
    assert there[1] == given[:1]


@pytest.mark.parametrize("missing", ["fork", "memfd"])
def test_without_a_process_the_work_is_done_here(monkeypatch, missing):
    def refuse():
        raise BlockingIOError("too many processes")

    if missing == "fork":
        monkeypatch.setattr(os, "fork", refuse)
    else:
        monkeypatch.delattr(os, "memfd_create")
    with worker(lambda number: number, True) as one:
        assert isinstance(one, Here)
        one.begin(5)
        assert one.end() == 5
    assert not signal.pthread_sigmask(signal.SIG_BLOCK, [])
    assert not [at for at in Path("/proc/self/fd").iterdir() if "memfd" in os.path.realpath(at)]


def test_no_process_is_copied_beside_threads():
    ready = threading.Event()
    thread = threading.Thread(target=ready.wait)
    with worker(count, True) as one:
        assert isinstance(one, Process)
    thread.start()
    try:
        with worker(count, True) as one:
            assert isinstance(one, Here)
    finally:
        ready.set()
        thread.join()
    with worker(count, False) as one:
        assert isinstance(one, Here)


def test_a_process_of_a_pool_is_not_copied():
    with Process(lambda: isinstance(worker(count, True), Here)) as one:
        one.begin()
        assert one.end()


SOME = [case for case in all_cases()[::40] if not case.xfail]


@pytest.mark.parametrize("case", SOME, ids=lambda case: name(case.path))
def test_processes_make_no_difference(case, tmp_path, monkeypatch):
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 1)
    assert _may_copy()
    found = outcome(case, tmp_path, PLACES)
    if case.diagnostics:
        assert found.places[0] == case.diagnostics[0]
    elif joins(case):
        assert not found.diagnostics
    else:
        check_outcome(case, found)


@pytest.mark.parametrize("verify", ["on", "full", "off"])
def test_a_certificate_is_the_same(verify, monkeypatch):
    text = b"G21 G90 G94 G17\nG0 X0 Y0 Z5\n" + b"".join(
        b"G1 X%d. Y%d. F%d (%d)\n" % (n, -n, 100 + n % 7, n) for n in range(300)
    )
    pipeline = gx.Pipeline.parse("metric | absolute", "linuxcnc")
    here = pipeline.run(text, verify)
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 700)
    there = pipeline.run(text, verify)
    assert there.text == here.text
    assert there.certificate.to_json() == here.certificate.to_json()


def test_shapes_begin_anew_in_both(monkeypatch):
    """Every executed comment is a shape of its own; a table that is full is begun anew."""
    monkeypatch.setattr("gcxform.modal.reader.SHAPES_AT_MOST", 50)
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 300)
    text = b"G21 G91 G94 G17\n" + b"".join(
        b"G1 X%d. Y1. F%d (MSG, %d)\nG4 P%d (MSG, TWO%d)\n" % (n, 100 + n, n, n, n)
        for n in range(1, 200)
    )
    pipeline = gx.Pipeline.parse("absolute", "linuxcnc")
    there = pipeline.run(b"G0 X0 Y0 Z0\n" + text)
    monkeypatch.setattr("gcxform.system.worker.LINUX", False)
    assert pipeline.run(b"G0 X0 Y0 Z0\n" + text).text == there.text


def test_a_wrong_output_is_found_there(monkeypatch):
    """The proof sees what it would see here, and names the same line."""
    emit = Emitter.emit

    def wrong(self, window, *given):
        made = emit(self, window, *given)
        return replace(made, text=made.text.replace(b"X7.", b"X7.5"))

    monkeypatch.setattr(Emitter, "emit", wrong)
    text = b"G21 G90 G94\nG0 X0. Y0. Z0.\n" + b"".join(b"G1 X%d. F100.\n" % n for n in range(20))
    pipeline = gx.Pipeline.parse("absolute", "linuxcnc")
    said = []
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 20)
    for copies in (True, False):
        monkeypatch.setattr("gcxform.system.worker.LINUX", copies)
        with pytest.raises(gx.VerificationError) as caught:
            pipeline.run(text)
        said.append(caught.value.diagnostics[0].render().splitlines()[0])
    assert said[0] == said[1]


@pytest.mark.parametrize("copies", [True, False])
@pytest.mark.parametrize("what", ["interpret", "check"])
def test_nothing_ends_a_run_before_its_program(monkeypatch, copies, what):
    """Python takes StopIteration for the end of a loop; a plugin that raises it must not be."""
    kind = {"interpret": Interpreter, "check": Verifier}[what]
    done, calls = getattr(kind, what), count()

    def stop(self, *given):
        if next(calls) >= 4:
            raise StopIteration
        return done(self, *given)

    monkeypatch.setattr(kind, what, stop)
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 20)
    monkeypatch.setattr("gcxform.system.worker.LINUX", copies)
    text = b"G21 G90 G94\nG0 X0. Y0. Z0.\n" + b"".join(b"G1 X%d. F100.\n" % n for n in range(20))
    with pytest.raises((RuntimeError, StopIteration)):
        gx.Pipeline.parse("absolute", "linuxcnc").run(text)


def test_the_command_line_says_that_one_has_died(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 20)
    monkeypatch.setattr(Verifier, "check", lambda *_: os.kill(os.getpid(), signal.SIGKILL))
    program = tmp_path / "a.nc"
    program.write_bytes(b"G21 G90 G94\nG0 X0. Y0. Z0.\nG1 X5. F100.\nM2\n")
    out = tmp_path / "b.nc"
    monkeypatch.setattr(
        "sys.argv",
        ["gcxform", "run", "-f", "linuxcnc", "-x", "absolute", str(program), "-o", str(out)],
    )
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == FAILED
    assert "GX903" in capsys.readouterr().err
    assert not out.exists()


@pytest.fixture(scope="module")
def long_program(tmp_path_factory):
    moves = (b"G1 X%d.5 Y%d.25 F%d\n" % (n % 977, n % 613, 100 + n % 7) for n in range(400_000))
    file = tmp_path_factory.mktemp("long") / "a.nc"
    file.write_bytes(b"G21 G90 G94 G17\nG0 X0. Y0. Z5.\n" + b"".join(moves))
    return file


def started(program, out):
    """Return a run of its own process group, and the processes that it has copied itself to."""
    words = ["run", "-q", "-f", "linuxcnc", "-x", "metric", str(program), "-o", str(out)]
    command = [sys.executable, "-c", "from gcxform.cli import main; main()", *words]
    run = subprocess.Popen(command, stderr=subprocess.PIPE, process_group=0)
    children = Path(f"/proc/{run.pid}/task/{run.pid}/children")
    deadline = time.monotonic() + 30
    while len(children.read_text().split()) < 2:
        assert run.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.01)
    return run, [int(pid) for pid in children.read_text().split()]


def all_gone(pids):
    deadline = time.monotonic() + 30
    while any(Path(f"/proc/{pid}/statm").exists() for pid in pids):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    return True


@pytest.mark.xdist_group("long program")
def test_an_interrupted_run_leaves_nothing(long_program, tmp_path):
    run, others = started(long_program, tmp_path / "b.nc")
    os.killpg(run.pid, signal.SIGINT)
    _, said = run.communicate(timeout=30)
    assert (run.returncode, said) == (INTERRUPTED, b"interrupted\n")
    assert all_gone(others)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.xdist_group("long program")
def test_a_killed_run_leaves_no_process(long_program, tmp_path):
    run, others = started(long_program, tmp_path / "b.nc")
    run.kill()
    assert all_gone(others)
    assert run.communicate(timeout=30)[1] == b""
    assert not (tmp_path / "b.nc").exists()
