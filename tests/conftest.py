"""Profiles of the property tests, and the folder of data that is not part of the repository.

`HYPOTHESIS_PROFILE` chooses a profile: `dev` while writing, `ci` (the default, the same examples
on every run), `long` over night; `faults` is `ci` for `tests/mutations.py`.
"""

import gc
import itertools
import os
from pathlib import Path
from zlib import crc32

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # processes have the processors; before numpy

import pytest
from hypothesis import HealthCheck, Phase, settings

SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much]
settings.register_profile("dev", max_examples=30, deadline=None, suppress_health_check=SLOW)
settings.register_profile(
    "ci", max_examples=50, deadline=None, derandomize=True, suppress_health_check=SLOW
)
settings.register_profile(  # that it fails is enough: the least example is not looked for
    "faults",
    settings.get_profile("ci"),
    phases=(Phase.explicit, Phase.generate),
    report_multiple_bugs=False,
)
settings.register_profile("long", max_examples=20_000, deadline=None, suppress_health_check=SLOW)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))

BY_TURNS = "by_turns"  # the mark of a test with hundreds of cases that others mostly cover
COUNT = itertools.count()  # of folders of tests
GARBAGE = (
    20_000,
    20,
    20,
)  # objects made before garbage is looked for; Python's own are 700, 10, 10


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add `--turn N/M`: the Nth of M shares of the cases of tests that are marked `by_turns`."""
    parser.addoption("--turn", default="0/1", help="N/M: a share of the cases of dear tests")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the cases whose turn it is not, by their names: every process leaves out the same.

    Tests without cases are always run.
    """
    turn, shares = map(int, config.getoption("turn").split("/"))
    left = {
        item
        for item in items
        if item.get_closest_marker(BY_TURNS)
        and (crc32(item.name.encode()) - turn) % shares
        and "[" in item.name
    }
    if left:
        config.hook.pytest_deselected(items=[*left])
        items[:] = [item for item in items if item not in left]


def pytest_collection_finish() -> None:
    """Look for garbage seldom, and not among the thousands of tests, which stay to the end.

    A twentieth of the processor's seconds of a whole run went into that.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(*GARBAGE)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> object:
    """Hand out runs of tests where `./run-tests` asks for groups; else what xdist would do."""
    if config.getoption("dist") != "loadgroup":
        return None
    from scheduling import Runs  # xdist's schedulers are no part of a process that runs one test

    return Runs(config, log)


SHARED = Path(__file__).parents[2] / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """Return the folder of published data; skip, visibly, where it is not beside the repository."""
    if not SHARED.is_dir():
        pytest.skip(f"{SHARED} is not here: published data not compared")
    return SHARED


@pytest.fixture
def one_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Read and prove in this process: to copy one in which thousands of tests wait takes 50 ms.

    `test_worker.py` has processes.
    """
    monkeypatch.setattr("gcxform.system.worker.LINUX", False)


@pytest.fixture
def tmp_path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an empty folder; pytest's own looks for its number among those of all tests before."""
    return tmp_path_factory.mktemp(f"test{next(COUNT)}", numbered=False)
