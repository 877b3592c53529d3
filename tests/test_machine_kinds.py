"""Machine files that name their kinematics, and the chains that are made of machine files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import gcxform as gx
from gcxform.diagnostics import UsageError
from gcxform.machine.chain import Chain, Rotary, chain_of
from gcxform.machine.file import load_machine
from gcxform.machine.formats import Known
from gcxform.machine.machine import Machine, Tool
from gcxform.plugin.registry import default_registry

KNOWN = default_registry().machines
SHORT = """format = 1
kinematics = "ac-trunnion"
gauge-point = [0.0, 0.0, 10.0]
[axis.X]
limits = [-300.0, 300.0]
[axis.A]
point = [5.0, -32.0, -95.0]
limits = [-30.0, 110.0]
[axis.C]
point = [5.0, -20.0, -60.0]
wrap = 360.0
max-speed = 7200.0
"""
LONG = """format = 1
table = ["A", "C"]
gauge-point = [0.0, 0.0, 10.0]
[axis.X]
limits = [-300.0, 300.0]
[axis.A]
direction = [1.0, 0.0, 0.0]
sign = -1
point = [5.0, -32.0, -95.0]
limits = [-30.0, 110.0]
[axis.C]
direction = [0.0, 0.0, 1.0]
sign = -1
point = [5.0, -20.0, -60.0]
wrap = 360.0
max-speed = 7200.0
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "mill.toml"


def loaded(file: Path, text: str) -> Machine:
    file.write_text(text, encoding="utf-8")
    return load_machine(file, KNOWN)


def test_a_kind_says_what_else_the_file_says(file: Path) -> None:
    assert loaded(file, SHORT) == loaded(file, LONG)


def test_the_chain_of_a_machine_file(file: Path) -> None:
    machine = loaded(file, SHORT)
    chain = chain_of(machine, Tool(length=120.0, x=1.5, y=-2.0))
    a = Rotary("A", (1.0, 0.0, 0.0), (5.0, -32.0, -95.0), -1, (-30.0, 110.0))
    c = Rotary("C", (0.0, 0.0, 1.0), (5.0, -20.0, -60.0), -1, None, 360.0, 7200.0)
    free = (-np.inf, np.inf)
    assert chain == Chain((a, c), (), (-1.5, 2.0, -110.0), ((-300.0, 300.0), free, free))
    assert chain_of(machine).tip == (0.0, 0.0, 10.0)


@pytest.mark.parametrize("kind", KNOWN.kinematics)
def test_every_kind_makes_a_machine(file: Path, kind: str) -> None:
    letters = KNOWN.kinematics[kind].table + KNOWN.kinematics[kind].head
    points = "".join(f"[axis.{a}]\npoint = [1.0, 2.0, {k}.0]\n" for k, a in enumerate(letters))
    chain = chain_of(loaded(file, f'format = 1\nkinematics = "{kind}"\n{points}'))
    assert [a.letter for a in chain.table] == [*KNOWN.kinematics[kind].table]
    assert [a.letter for a in chain.head] == [*KNOWN.kinematics[kind].head]
    assert {a.sign for a in chain.table} <= {-1}
    assert {a.sign for a in chain.head} <= {1}


def test_the_tool_axis_of_iso_841(file: Path) -> None:
    """With ISO signs the tool axis is the same function of the angles whatever carries them."""
    angles = np.array([[30.0, 50.0]])
    a, c = np.radians(angles[0])
    for kind, order in (("ac-trunnion", 1), ("ca-fork", -1), ("c-table-a-head", -1)):
        text = f'format = 1\nkinematics = "{kind}"\n'
        text += "[axis.A]\npoint = [0.0, 0.0, 0.0]\n[axis.C]\npoint = [0.0, 0.0, 0.0]\n"
        axis = chain_of(loaded(file, text)).tool_axis(angles[:, ::order])
        wanted = [[np.sin(a) * np.sin(c), -np.sin(a) * np.cos(c), np.cos(a)]]
        assert axis == pytest.approx(np.array(wanted))


def test_a_calibrated_direction_and_a_sign_replace_those_of_the_kind(file: Path) -> None:
    text = SHORT.replace("[axis.A]\n", "[axis.A]\ndirection = [1.0, -0.00011, 0.00023]\nsign = 1\n")
    axis = loaded(file, text).axes["A"]
    assert axis.direction == pytest.approx((1.0, -0.00011, 0.00023), abs=1e-7)
    assert axis.direction is not None
    assert np.linalg.norm(axis.direction) == pytest.approx(1.0, abs=1e-15)
    assert axis.sign == 1


@pytest.mark.parametrize("text", [SHORT, LONG])
@pytest.mark.parametrize("way", ["1.0, -0.00011, 0.00023", "-1.0, 0.00011, -0.00023"])
def test_an_axis_may_be_given_either_way_round(file: Path, text: str, way: str) -> None:
    """C8: V and -V (and for what states a sign, its opposite) are the same machine."""
    text = text.replace("direction = [1.0, 0.0, 0.0]\n", "")
    text = text.replace("[axis.A]\n", f"[axis.A]\ndirection = [{way}]\n")
    if way.startswith("-"):
        text = text.replace("sign = -1\npoint = [5.0, -32", "sign = 1\npoint = [5.0, -32")
    axis = loaded(file, text).axes["A"]
    assert axis.direction == pytest.approx((1.0, -0.00011, 0.00023), abs=1e-7)
    assert axis.sign == -1


def test_an_inclination_of_any_angle(file: Path) -> None:
    text = 'format = 1\nkinematics = "nutating-head"\ninclination = "0.5 rad"\n'
    text += "[axis.B]\npoint = [0.0, 0.0, 0.0]\n[axis.C]\npoint = [0.0, 0.0, 0.0]\n"
    wanted = (0.0, np.sin(0.5), np.cos(0.5))
    assert loaded(file, text).axes["B"].direction == pytest.approx(wanted)
    half = loaded(file, text.replace('inclination = "0.5 rad"\n', "")).axes["B"].direction
    assert half == pytest.approx((0.0, np.sqrt(0.5), np.sqrt(0.5)))


@pytest.mark.parametrize(
    ("old", "new", "code", "line", "column", "message", "hint"),
    [
        ('"ac-', '"ac', "GX450", 2, 1, "no kinematics 'actrunnion'", "did you mean 'ac-trunnion'"),
        ("gauge", 'table = ["C", "A"]\ngauge', "GX451", 3, 1, "table of ac-trunnion is", "leave"),
        ("gauge", 'head = ["C"]\ngauge', "GX451", 3, 1, "head of ac-trunnion is [], not", "leave"),
        ("[axis.C]", "[axis.B]", "GX451", 9, 1, "ac-trunnion has no axis B", ""),
        ("gauge", "inclination = 45.0\ngauge", "GX451", 3, 1, "has no nutating axis", ""),
        (
            "[axis.C]\n",
            "[axis.C]\ndirection = [1.0, 0.0, 5.0]\n",
            "GX451",
            10,
            1,
            "axis C is 11.3 degrees off that of ac-trunnion",
            "fraction",
        ),
        ("[axis.C]\n", "[axis.C]\ndirection = [0, 0, 0]\n", "GX432", 10, 1, "C is zero", ""),
        ("[axis.C]\n", "[axis.C]\nsign = 2\n", "GX433", 10, 1, "C is 2", "ISO"),
        ("point = [5.0, -20.0, -60.0]\n", "", "GX452", 9, 1, "point of axis C is missing", "line"),
        ('kinematics = "ac-trunnion"', "inclination = 45.0", "GX451", 2, 1, "is that of", "nut"),
    ],
)
def test_what_is_refused(
    file: Path, old: str, new: str, code: str, line: int, column: int, message: str, hint: str
) -> None:
    assert old in SHORT
    with pytest.raises(UsageError) as caught:
        loaded(file, SHORT.replace(old, new))
    found = caught.value.diagnostics[0]
    assert found.where is not None
    assert (found.code, found.where.line, found.where.column) == (code, line, column)
    assert message in found.message
    assert hint in found.hint


def test_an_axis_of_the_kind_that_is_not_there(file: Path) -> None:
    with pytest.raises(UsageError, match="the point of axis C is missing") as caught:
        loaded(file, SHORT[: SHORT.index("[axis.C]")])
    where = caught.value.diagnostics[0].where
    assert where is not None
    assert where.line == 2


@pytest.mark.parametrize("inclination", ["0.0", "180.0", "-45.0"])
def test_an_inclination_out_of_range(file: Path, inclination: str) -> None:
    text = f'format = 1\nkinematics = "nutating-head"\ninclination = {inclination}\n'
    text += "[axis.B]\npoint = [0.0, 0.0, 0.0]\n[axis.C]\npoint = [0.0, 0.0, 0.0]\n"
    with pytest.raises(UsageError, match="between 0 and 180 degrees") as caught:
        loaded(file, text)
    assert caught.value.diagnostics[0].code == "GX434"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('table = ["A", "C"]', 'table = ["A"]', "the axis C turns neither the table nor the head"),
        ("[axis.X]", "[axis.X]\ndirection = [1.0, 0.001, 0.0]", "direction of axis X is not X"),
        ("[axis.X]", "[axis.W]\n[axis.X]", "the axis W is not followed"),
    ],
)
def test_axes_that_no_chain_follows(file: Path, old: str, new: str, message: str) -> None:
    machine = loaded(file, LONG.replace(old, new))
    with pytest.raises(UsageError, match=message) as caught:
        chain_of(machine)
    assert caught.value.diagnostics[0].code == "GX452"


def test_a_plugin_offers_a_kind(file: Path) -> None:
    class Tilting(gx.Kinematics):
        """A head that tilts about X."""

        name = "tilting"
        head = ("A",)

    file.write_text('format = 1\nkinematics = "tilting"\n[axis.A]\npoint = [0.0, 0.0, 90.0]\n')
    machine = load_machine(file, Known({"tilting": Tilting}))
    assert machine.head == ("A",)
    assert (machine.axes["A"].direction, machine.axes["A"].sign) == ((1.0, 0.0, 0.0), 1)
