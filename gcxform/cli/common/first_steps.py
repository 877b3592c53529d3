"""For who has no pipeline yet: what a program is likely to be in, and what to type next."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gcxform.guess import Guess


LOOKED_AT = 12  # of the programs of a folder


def guessed(file: str) -> Guess | None:
    """Return in which dialects a program may be, or one like most of a folder; None: none fits."""
    from gcxform.cli.common.programs import files_of
    from gcxform.diagnostics import GcxformError

    with suppress(GcxformError):
        found = [each for each in map(_guess, files_of([file])[:LOOKED_AT]) if each is not None]
        return max(found, key=_alike(found), default=None)
    return None


def _guess(path: Path) -> Guess | None:
    """Return in which dialects a program may be; None if it cannot be read, or nothing fits."""
    from gcxform.diagnostics import GcxformError
    from gcxform.guess import guess_dialect

    with suppress(GcxformError, OSError, ValueError):
        guess = guess_dialect(path) if path.is_file() else None
        return guess if guess and guess.dialects else None
    return None


def _alike(found: list[Guess]) -> Callable[[Guess], float]:
    """Return how well what is guessed of one program fits all of them."""

    def fits(guess: Guess) -> float:
        name = guess.dialects[0]
        return sum(each.score(name) for each in found if name in each.evidence)

    return fits


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
