"""The page at the end of a batch: how many came through, why the others did not, how far off."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from string import Template
from typing import Final

from gcxform.catalogue import CATALOGUE
from gcxform.cli.plant.rows import STATES, Row
from gcxform.diagnostics import shown
from gcxform.notebook.page import escaped

WORST: Final = 25
BINS: Final = 20
PAGE: Final = Template("""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>gcxform: $through of $count programs</title>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<style>
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 70rem; padding: 0 1rem; }
table { border-collapse: collapse; margin: .5rem 0 2rem; }
th, td { text-align: left; padding: .2rem .8rem .2rem 0; border-bottom: 1px solid #8884;
  vertical-align: top; overflow-wrap: anywhere; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
svg { display: block; max-width: 100%; } rect { fill: #3778b5; } text { fill: currentColor; }
</style></head><body>
<h1>$through of $count programs came through</h1>
<p>$said</p>
<h2>By pipeline and machine</h2>
$ways
<h2>Why programs did not come through</h2>
$reasons
<h2>Largest deviations</h2>
$histogram
$worst
</body></html>
""")


def page(rows: Sequence[Row]) -> str:
    """Return the page, which loads nothing; what a program says is never markup."""
    through = [row for row in rows if row.through]
    states = Counter(row.state for row in rows)
    said = ", ".join(f"{states[state]} {state}" for state in STATES if states[state])
    seconds = sum(row.seconds for row in rows)
    checked = sum(row.verified for row in through)
    return PAGE.substitute(
        through=len(through),
        count=len(rows),
        said=escaped(f"{said}; {checked} verified; {seconds:.1f} s of work"),
        ways=_table(("pipeline", "machine", *STATES), _ways(rows), numbers=2),
        reasons=_table(
            ("code", "programs", "what", "the first"), _reasons(rows), numbers=1, upto=2
        ),
        histogram=_histogram(through),
        worst=_table(
            ("um", "of um", "line", "program", "pipeline", "machine"), _worst(through), 0, 3
        ),
    )


def _ways(rows: Sequence[Row]) -> Iterator[tuple[object, ...]]:
    found: dict[tuple[str, str], Counter[str]] = defaultdict(Counter)
    for row in rows:
        found[row.pipeline, row.machine][row.state] += 1
    for way, counts in found.items():
        yield (*(shown(each) for each in way), *(counts[state] for state in STATES))


def _reasons(rows: Iterable[Row]) -> Iterator[tuple[object, ...]]:
    """Yield the codes of what did not come through, the most frequent first."""
    found: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        if not row.through:
            found[row.codes.partition(" ")[0]].append(row)
    for code, those in sorted(found.items(), key=lambda each: -len(each[1])):
        first = those[0]
        where = shown(first.place or first.program)
        yield (
            code or "?",
            len(those),
            CATALOGUE[code][0] if code in CATALOGUE else "",
            f"{where}: {first.reason}",
        )


def _worst(rows: Sequence[Row]) -> Iterator[tuple[object, ...]]:
    known = [row for row in rows if row.deviation is not None]
    for row in sorted(known, key=lambda row: -(row.deviation or 0.0))[:WORST]:
        yield (
            f"{1000 * (row.deviation or 0.0):.3f}",
            f"{1000 * (row.budget or 0.0):.3f}",
            row.source_line or "",
            shown(row.program),
            shown(row.pipeline),
            shown(row.machine),
        )


def _histogram(rows: Sequence[Row]) -> str:
    """Return a picture (SVG) of the largest deviations, in shares of what they may be."""
    shares = [
        row.deviation / row.budget for row in rows if row.budget and row.deviation is not None
    ]
    if not shares:
        return ""
    counts = Counter(min(BINS - 1, int(BINS * share)) for share in shares)
    most, wide, tall = max(counts.values()), 30, 160
    bars = [
        f'<rect x="{wide * k + 1}" y="{tall - tall * n / most:.1f}" width="{wide - 2}" '
        f'height="{tall * n / most:.1f}"><title>{n} programs, {100 * k // BINS} to '
        f"{100 * (k + 1) // BINS} % of the budget</title></rect>"
        for k, n in sorted(counts.items())
    ]
    size = f"0 0 {wide * BINS} {tall + 24}"
    label = (
        f'<text x="0" y="{tall + 18}">0</text><text x="{wide * BINS}" y="{tall + 18}" '
        f'text-anchor="end">100 % of the budget</text>'
    )
    return f'<svg viewBox="{size}" width="{wide * BINS}" role="img">{"".join(bars)}{label}</svg>'


def _table(
    heads: Sequence[str], rows: Iterable[Sequence[object]], numbers: int, upto: int | None = None
) -> str:
    """Return a table; the columns from `numbers` up to `upto` are numbers."""
    last = len(heads) if upto is None else upto
    marks = [' class="n"' if numbers <= k < last else "" for k in range(len(heads))]
    lines = ["".join(f"<th{m}>{escaped(h)}</th>" for m, h in zip(marks, heads, strict=True))]
    for row in rows:
        lines.append(
            "".join(f"<td{m}>{escaped(each)}</td>" for m, each in zip(marks, row, strict=True))
        )
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"
