"""For who has no pipeline yet: what a program is likely to be in, and what to type next."""

from __future__ import annotations

import shlex
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gcxform.guess import Guess


def guessed(file: str) -> Guess | None:
    """Return in which dialects a program, or the first of a folder, may be; None: nothing fits."""
    from gcxform.diagnostics import GcxformError
    from gcxform.guess import guess_dialect

    path = Path(file)
    with suppress(GcxformError, OSError, ValueError):
        if path.is_dir():
            path = next(iter(sorted(each for each in path.iterdir() if each.is_file())), path)
        guess = guess_dialect(path) if path.is_file() else None
        return guess if guess and guess.dialects else None
    return None


def next_steps(file: str) -> str:
    """Return what to type for a program, or for a folder of them, that is named without a verb."""
    guess, name = guessed(file), shlex.quote(file)
    dialect = guess.dialects[0] if guess else "DIALECT"
    looks = f"it looks like {guess}" if guess else "gcxform list dialects has the names of dialects"
    what = "a folder" if Path(file).is_dir() else "a program"
    lines = _of_folder if Path(file).is_dir() else _of_program
    return "\n".join(
        [f"{file} is {what}; a verb comes before it, and {looks}:", *lines(dialect, name)]
    )


def _of_program(dialect: str, name: str) -> list[str]:
    page = shlex.quote(f"{Path(shlex.split(name)[0]).stem}.html")
    return [
        f"  gcxform check -f {dialect} {name}    what is wrong with it, and what it needs",
        f"  gcxform view -f {dialect} -o {page} {name}    a page that shows it",
        f"  gcxform run -f {dialect} -x absolute -o out.nc {name}    changed, and proved",
    ]


def _of_folder(dialect: str, name: str) -> list[str]:
    return [
        f"  gcxform machine new -f {dialect} -o machine.toml -p gcxform.toml {name}"
        "    what its programs leave to the machine",
        f"  gcxform run -f {dialect} -x absolute -o out {name}    changed, and proved",
    ]
