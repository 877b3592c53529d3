"""`compare` of a program and what a chain made of it says what the certificate says, and not less.

Programs are engravings: moves and arcs of hundredths of a millimetre and of ten, rapids between.
Their compensated twins are off by about what shortest moves are long, along the way and across it.
"""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
from seeds_kit import DRAWN, shares

import gcxform as gx
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model_text import to_toml

COUNT = DRAWN
SIZE = 0.008  # mm, of the errors of an axis in each direction
MOST = 3 * SIZE * np.sqrt(3)  # mm, of three axes together
SLIP = 0.002  # mm: decimals of both programs, and what pairing adds
CHAINS = {
    "absolute": "absolute",
    "segment": "segment chord-error=5um",
    "lines": "segment arcs=lines chord-error=2um max-length=0.4",
    "arcs": "arcs tolerance=5um",
    "both": "segment chord-error=1um | arcs tolerance=4um",
    "volumetric": "absolute | volumetric model={model} part-origin=0,0,0 tolerance=1um",
}


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a small model: waves of each axis in each direction."""
    place = np.linspace(-500.0, 500.0, 21)
    waves = [SIZE * np.sin(place / (60.0 + 9 * k) + 2.0 * k) for k in range(9)]
    axes = [AxisFunction(place, np.stack(waves[3 * k : 3 * k + 3], axis=1)) for k in range(3)]
    file = tmp_path_factory.mktemp("twins") / "model.toml"
    file.write_text(to_toml(AxisFunctions((axes[0], axes[1], axes[2]))))
    return file


def engraving(seed: int) -> str:
    """Return a program of short moves, arcs and rapids."""
    rng = random.Random(seed)
    x, y, z = 3.0, 4.0, 2.0
    blocks = [f"G90 G0 X{x} Y{y} Z{z}", "F300"]
    for _ in range(40):
        size = rng.choice((0.012, 0.03, 0.2, 3.0, 12.0))
        dx, dy, dz = (round(rng.uniform(-size, size), 4) for _ in range(3))
        kind = rng.choice(("G0", "G1", "G1", "G1", "G1", "G2", "G3"))
        if kind in ("G0", "G1"):
            x, y, z = round(x + dx, 4), round(y + dy, 4), round(z + dz, 4)
            named = rng.choice((f"X{x} Y{y}", f"X{x}", f"Y{y}", f"Z{z}", f"X{x} Y{y} Z{z}"))
            x, y, z = stood(named, blocks)
            blocks.append(f"{kind} {named}")
        elif size >= 0.2:
            blocks.append(f"{kind} X{x + dx:.4f} Y{y + dy:.4f} R{size * 1.5:.4f}")
            x, y = round(x + dx, 4), round(y + dy, 4)
    return "\n".join([*blocks, "M2", ""])


def stood(named: str, blocks: list[str]) -> tuple[float, float, float]:
    """Return where axes are after a block that names some of them."""
    place = {}
    for block in [*blocks, named]:
        place |= {word[0]: float(word[1:]) for word in block.split() if word[0] in "XYZ"}
    return place["X"], place["Y"], place["Z"]


@pytest.mark.parametrize("chain", CHAINS)
@shares(COUNT, 30)
def test_a_twin_is_as_far_as_its_certificate_says(chain: str, seeds: range, model: Path) -> None:
    passed = 0
    for seed in seeds:
        text = engraving(seed).encode()
        try:
            done = gx.Pipeline.parse(CHAINS[chain].format(model=model), "linuxcnc").run(text)
        except gx.InputError:
            continue
        passed += 1
        limit = SLIP + done.certificate.largest["deviation"]
        limit += MOST if chain == "volumetric" else 0.0
        one, other = gx.read(text, "linuxcnc"), gx.read(done.text, "linuxcnc")
        for a, b in ((one, other), (other, one)):
            found = gx.compare(a, b, limit)
            assert found.same, (seed, found)
            plain = gx.compare(a, b)
            assert plain.parted is None, (seed, plain)
            assert plain.deviation <= limit
    assert passed >= 0.9 * len(seeds)


@pytest.mark.parametrize("moved", [0.0025, 0.01, 0.3])
def test_what_goes_aside_is_never_the_same(moved: float) -> None:
    """Somewhere one path goes aside and back: half of that is the least it is from the other.

    No other way goes there: that much is shorter than most moves, or than what they make up.
    """
    for seed in range(COUNT):
        lines, rng = engraving(seed).splitlines(), random.Random(-seed - 1)
        at = rng.choice([k for k, line in enumerate(lines) if line.startswith("G1")])
        axis = rng.choice("XYZ")
        place = dict(zip("XYZ", stood("", lines[: at + 1]), strict=True))[axis]
        aside = [f"{axis}{place + moved:.4f}", f"{axis}{place:.4f}"]
        other = "\n".join([*lines[: at + 1], *aside, *lines[at + 1 :], ""])
        one, two = (gx.read(t.encode(), "linuxcnc") for t in ("\n".join([*lines, ""]), other))
        for a, b in ((one, two), (two, one)):
            found = gx.compare(a, b)
            assert not found.same, (seed, found)
            assert found.deviation >= 0.49 * min(moved, 0.01)
            assert found.deviation <= 2.0 * moved + SLIP
