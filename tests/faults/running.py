"""Faults of a run: of its windows, and of the processes that take part in it."""

from __future__ import annotations

from faults.mutation import Mutation


def _worker(name: str, old: str, new: str) -> Mutation:
    return Mutation(f"worker: {name}", "gcxform/system/worker.py", old, new, "tests/test_worker.py")


MUTATIONS = (
    Mutation(
        "run: nothing is said of a program in which nothing moves",
        "gcxform/cli/run.py",
        'found.checked.get("moves") == 0',
        'found.checked.get("moves") == -1',
        "tests/test_cli_verbs.py::test_a_program_in_which_nothing_moves_is_said_to_be_one",
    ),
    Mutation(
        "run: the last window is not proved",
        "gcxform/pipeline/run.py",
        "            while proof.busy and not",
        "            while False and not",
        "tests/test_verify.py",
    ),
    _worker("what was raised is lost", "if error is not None:", "if False:"),
    _worker("one after the other becomes one less", "    while reader.busy:\n", "    if False:\n"),
    _worker(
        "an error hides that of a window before",
        "            while self.busy:\n",
        "            while False:\n",
    ),
    _worker(
        "all pieces of work have one place",
        "_lay_down(self.shared[self.begun % DEPTH], given)",
        "_lay_down(self.shared[0], given)",
    ),
    _worker(
        "what is wrong with a text hides what is wrong before it",
        "    except GcxformError as error:\n        wrong.append(error)\n",
        "    except KeyError as error:\n        wrong.append(error)\n",
    ),
    _worker(
        "what is read again is not waited for",
        "        self.first.begun += 1  # by the one that waits for both\n"
        "        return self.first.end()\n",
        "        self.first.begun += 1\n        self.first.ended += 1\n        return (1, 1)\n",
    ),
    _worker(
        "one stays behind where there is no second",
        "            self.first.__exit__()\n",
        "            pass\n",
    ),
    _worker("who stands beside threads is copied", "threading.active_count() == 1", "True"),
    _worker(
        "every column has one value throughout",
        "slice(None) if stride else slice(1)",
        "slice(1)",
    ),
    _worker("parts lie upon each other", "        place += size\n", ""),
    _worker(
        "what could not be begun is waited for",
        "        self._begin(given)\n        self.begun += 1",
        "        self.begun += 1\n        self._begin(given)",
    ),
    _worker(
        "what the system did not take is left out",
        "part, place = part[done:], place + done",
        "part, place = part[:0], place + part.nbytes",
    ),
    Mutation(
        "run: a pass can end it before its program",
        "gcxform/pipeline/run.py",
        "            for apart, first, last in with_ends(windows, self.frame.behind):\n"
        "                one = self._transform(apart)\n",
        "            first = last = False\n"
        "            for one in map(self._transform, windows):\n                apart = None\n",
        "tests/test_worker.py",
    ),
    Mutation(
        "records: fields arrive in another order",
        "gcxform/system/records.py",
        "(each.name for each in fields(kind))",
        "sorted(each.name for each in fields(kind))",
        "tests/test_worker.py",
    ),
    Mutation(
        "reader: a table that was begun anew is gone on with",
        "gcxform/modal/reader.py",
        "        if not known:\n            self.table = new_table(self.dialect)\n",
        "",
        "tests/test_worker.py",
    ),
    Mutation(
        "source: a sign in small letters is not seen",
        "gcxform/syntax/source.py",
        "letter in text or letter.lower() in text",
        "letter in text",
        "tests/properties/test_reading.py",
    ),
    Mutation(
        "heap: nothing is given back",
        "gcxform/system/heap.py",
        "elif _resident() > MORE * self.needed:",
        "elif False:",
        "tests/test_heap.py",
    ),
)
