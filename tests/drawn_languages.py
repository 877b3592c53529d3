"""Draw many programs of a language of its own and compare them with its reference reader.

    python tests/drawn_languages.py siemens|fagor [COUNT] [--from SEED]

It prints how many were drawn, compared and refused by which code, and each seed of a program that
does something else than the reference says; then it returns 1. The programs and the readers are
those of `properties/test_siemens_flow.py` and `test_fagor_reference.py`.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import test_fagor_reference as fagor
from properties import test_siemens_flow as siemens

import gcxform as gx


def of_siemens(seed: int, folder: Path) -> str:
    """Compare a program for a SINUMERIK; return the code by which it was refused, or nothing."""
    return "" if siemens.check(seed, folder) else "GX210"


def of_fagor(seed: int, folder: Path) -> str:
    """Compare a program for a Fagor; return the code by which it was refused, or nothing."""
    del folder
    try:
        fagor.check(fagor.Writer(seed).program())
    except gx.InputError as error:
        if error.diagnostics[0].code not in fagor.OPEN:
            raise
        return error.diagnostics[0].code
    return ""


LANGUAGES: dict[str, Callable[[int, Path], str]] = {"siemens": of_siemens, "fagor": of_fagor}


def main() -> int:
    """Draw, compare, print; return 1 if something differs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("language", choices=LANGUAGES)
    parser.add_argument("count", nargs="?", type=int, default=1000)
    parser.add_argument("--from", dest="first", type=int, default=1_000_000)
    options = parser.parse_args()
    refused, wrong = Counter[str](), []
    with tempfile.TemporaryDirectory() as place:
        siemens.write_files(Path(place))
        for seed in range(options.first, options.first + options.count):
            try:
                refused[LANGUAGES[options.language](seed, Path(place))] += 1
            except Exception as error:
                wrong.append(seed)
                print(f"seed {seed}: {type(error).__name__} {str(error)[:2000]}", flush=True)
    compared = refused.pop("", 0)
    print(f"{options.language}: {options.count} drawn from {options.first}, {compared} compared")
    print(f"refused: {dict(refused)}; {len(wrong)} disagree: {wrong[:20]}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
