"""The table of results: SQLite, so that every result is known as soon as it is there.

`results.sqlite` has a row for each task that was ever done for a folder of results; other tables
(CSV, Parquet) are made of it, without the certificates.
"""

from __future__ import annotations

import csv
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, astuple
from pathlib import Path
from typing import Final

from gcxform.cli.plant.rests import Present
from gcxform.cli.plant.rows import COLUMNS, LONG, Row
from gcxform.cli.plant.tasks import Task
from gcxform.diagnostics import FileError, UsageError
from gcxform.plugin.registry import versions
from gcxform.system.files import write_atomically

NUMBERS: Final = {
    "exit_code": "INTEGER",
    "deviation": "REAL",
    "budget": "REAL",
    "source_line": "INTEGER",
    "output_line": "INTEGER",
    "blocks_in": "INTEGER",
    "blocks_out": "INTEGER",
    "verified": "INTEGER",
    "seconds": "REAL",
}
SHORT: Final = tuple(name for name in COLUMNS if name not in LONG)
KINDS: Final = (".csv", ".parquet")


class Results:
    """The rows of a folder of results, by the keys of their tasks."""

    def __init__(self, base: sqlite3.Connection) -> None:
        self.base = base
        kinds = ", ".join(f"{name} {NUMBERS.get(name, 'TEXT')}" for name in COLUMNS)
        base.execute(f"CREATE TABLE IF NOT EXISTS results (key TEXT PRIMARY KEY, {kinds})")

    def row(self, key: str) -> Row | None:
        """Return the row of a task, None if there is none."""
        names = ", ".join(COLUMNS)
        found = self.base.execute(f"SELECT {names} FROM results WHERE key = ?", (key,)).fetchone()
        return None if found is None else _row(found)

    def put(self, rows: Mapping[str, Row]) -> None:
        """Write rows down, all or none."""
        marks = ", ".join("?" * (1 + len(COLUMNS)))
        with self.base:
            self.base.executemany(
                f"REPLACE INTO results VALUES ({marks})",
                [(key, *astuple(row)) for key, row in rows.items()],
            )

    def stands(self, task: Task, present: Present, digest_of: Present) -> bool:
        """Whether a task is done: all that its result rests on is as it was, and the result too.

        What failed is tried again; what was refused is not, as long as the reason is there.
        `digest_of` knows the results, by their places.
        """
        row = self.row(task.key)
        if row is None or row.state == "failed" or row.version != versions():
            return False
        if not present.carries(row.stands_on):
            return False
        return not row.through or digest_of.digest(place(task.root, row)) == row.output_sha256


def place(root: str, row: Row) -> str:
    """Return where a result lies."""
    return f"{root.rstrip('/')}/{row.output}"


def _row(values: Sequence[object]) -> Row:
    said = dict(zip(COLUMNS, values, strict=True))
    return Row(**{**said, "verified": bool(said["verified"])})  # type: ignore[arg-type]


@contextmanager
def opened(path: Path) -> Iterator[Results]:
    """Give the table in a file, which is made if it is not there. Raises FileError."""
    base: sqlite3.Connection | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        base = sqlite3.connect(path)
        base.execute("PRAGMA journal_mode = WAL")
        yield Results(base)
    except (sqlite3.Error, OSError) as error:
        raise FileError.one("GX903", f"{path}: {error}") from None
    finally:
        if base is not None:
            base.close()


def write_table(path: Path, rows: Iterable[Row]) -> None:
    """Write the table as CSV or Parquet, by the ending of the file. Raises FileError, UsageError.

    Parquet is written by pandas and pyarrow.
    """
    rows = list(rows)
    if path.suffix == ".csv":
        text = _Lines()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(SHORT)
        writer.writerows([[_cell(asdict(row)[name]) for name in SHORT] for row in rows])
        data = "".join(text).encode("utf-8", "backslashreplace")
    elif path.suffix == ".parquet":
        data = _parquet(rows)
    else:
        kinds = " or ".join(KINDS)
        raise UsageError.one("GX702", f"{path}: a table is a file *{kinds}")
    with write_atomically(path) as put:
        put(data)


class _Lines(list[str]):
    """Takes what `csv` writes."""

    def write(self, text: str) -> None:
        self.append(text)


def _cell(value: object) -> object:
    """Return a value as a spreadsheet has it; a text that it would compute is quoted."""
    if isinstance(value, str) and value[:1] in ("=", "+", "-", "@"):
        return "'" + value
    return value


def _parquet(rows: Sequence[Row]) -> bytes:
    try:
        import pandas

        table = pandas.DataFrame([asdict(row) for row in rows], columns=list(SHORT))
        data: bytes = table.to_parquet(index=False)
    except ImportError:
        hint = "pip install 'gcxform[batch]', or a table *.csv"
        raise UsageError.one("GX752", "Parquet needs pandas and pyarrow", hint=hint) from None
    return data
