"""Try random programs and ask LinuxCNC: how many, and what came of them.

    python tests/fuzz.py 20000 [--flow] [--from SEED] [--show]

draws programs under random chains; with --flow programs with calls, macros, loops and lost values,
read, and written by `absolute`. It says every 500 programs what must not be: disagreements,
refusals without need, failed verifications and bugs, each with its seed; and at the end how many
were drawn, compared and refused, by code. Exit code 1 if there is any.
"""

from __future__ import annotations

import argparse
import os
import sys

os.environ.setdefault("HYPOTHESIS_PROFILE", "long")  # what is asked once is not kept

from oracles import rs274
from properties import chains, executed
from properties.figures import Figures, Judged


def _line(job: Judged) -> str:
    return f"seed {job.seed}: {job.kind}: {job.chain}: {job.said[:200]}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int, nargs="?", default=20_000)
    parser.add_argument("--flow", action="store_true", help="programs with calls and loops")
    parser.add_argument("--from", type=int, default=0, dest="first")
    parser.add_argument("--show", action="store_true", help="print programs and outputs as well")
    chosen = parser.parse_args()
    if not rs274.available():
        sys.exit("rs274 (LinuxCNC) is not installed")
    total = Figures()
    campaign = executed.campaign if chosen.flow else chains.campaign
    for figures in campaign(range(chosen.first, chosen.first + chosen.count)):
        total += figures
        print(f"{total.counts['programs']:7} tried, {len(total.wrong)} wrong", flush=True)
        for job in figures.wrong:
            print(job if chosen.show else _line(job), flush=True)
    print(total)
    return int(bool(total.wrong))


if __name__ == "__main__":
    sys.exit(main())
