"""Memory is given back when a run takes more than it did at first, and not otherwise."""

import ctypes
import itertools
import os
import subprocess
import sys

import pytest

from gcxform.system import heap


def test_more_than_at_first_is_given_back(monkeypatch):
    sizes = iter([90, *[100] * (heap.FIRST - 1), 100, 102, 110, 99, 120])
    monkeypatch.setattr(heap, "_resident", lambda: next(sizes))
    given = []
    watched = heap.Heap()
    watched._trim = lambda room: given.append((watched.windows, room))
    for _ in range(heap.FIRST + 5):
        watched.give_back()
    assert given == [(heap.FIRST + 3, 0), (heap.FIRST + 5, 0)]


HOLDS_MORE = """
from gcxform.system import heap
before = heap._resident()
held = b"1" * (40 << 20)
print(heap._resident() - before)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux says it")
def test_what_a_process_has_is_known():
    """In a process of its own: what others gave back here before would be taken again."""
    pages = subprocess.check_output([sys.executable, "-c", HOLDS_MORE], text=True)
    assert 20 << 20 < int(pages) * os.sysconf("SC_PAGE_SIZE") < 80 << 20


@pytest.mark.parametrize("error", [AttributeError, OSError, TypeError])
def test_another_c_library_is_left_alone(monkeypatch, error):
    def refuse(_):
        raise error

    sizes = itertools.count(100, 100)
    monkeypatch.setattr(heap, "_resident", lambda: next(sizes))
    monkeypatch.setattr(ctypes, "CDLL", refuse)
    heap.keep()
    watched = heap.Heap()
    for _ in range(heap.FIRST + 2):  # more and more: each of the last two is to be given back
        watched.give_back()
    assert next(sizes) == 100 * (heap.FIRST + 3)
