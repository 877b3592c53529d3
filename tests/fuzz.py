"""Try random programs under random chains and ask LinuxCNC: how many, and what came of them.

    python tests/fuzz.py 20000 [--from SEED] [--show]

prints figures every 500 programs, and at the end what must not be: disagreements, verifications
that failed and bugs, each with its seed. Exit code 1 if there is any.
"""

from __future__ import annotations

import argparse
import sys

from oracles import rs274
from properties import chains


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int, nargs="?", default=20_000)
    parser.add_argument("--from", type=int, default=0, dest="first")
    parser.add_argument("--show", action="store_true", help="print programs and outputs as well")
    chosen = parser.parse_args()
    if not rs274.available():
        sys.exit("rs274 (LinuxCNC) is not installed")
    total = chains.Figures()
    for figures in chains.campaign(range(chosen.first, chosen.first + chosen.count)):
        total += figures
        print(f"{total.counts['programs']:7} tried, {len(total.wrong)} wrong", flush=True)
    print(total)
    for job in total.wrong:
        print(job if chosen.show else f"seed {job.seed}: {job.kind}: {job.chain}: {job.said[:200]}")
    return int(bool(total.wrong))


if __name__ == "__main__":
    sys.exit(main())
