"""What two processes are given: groups whole, neighbours together, every test once."""

from collections import Counter

from scheduling import TOGETHER, runs_of

FILE = [f"tests/test_a.py::test_one[{n}]" for n in range(2 * TOGETHER + 1)]
GROUP = ["tests/test_a.py::test_two@wheel", "tests/test_b.py::test_three[x@y]@wheel"]
OTHER = ["tests/test_b.py::test_four[x@y]", "tests/test_b.py::test_five[a::b]"]


def test_groups_are_whole_and_neighbours_together():
    runs = runs_of([*FILE, *GROUP, *OTHER])
    assert sorted(runs) == sorted([*FILE, *GROUP, *OTHER])
    assert {runs[test] for test in GROUP} == {"wheel"}
    assert Counter(runs[test] for test in FILE) == {
        **{f"tests/test_a.py {n}": TOGETHER for n in range(2)},
        "tests/test_a.py 2": 1,
    }
    assert len({runs[test] for test in OTHER}) == 1
    assert not {runs[test] for test in OTHER} & {runs[test] for test in [*FILE, *GROUP]}
