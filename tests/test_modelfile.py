"""Error-model files: what is read, what is written and what is refused, with code and place."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

from gcxform.catalogue import CATALOGUE
from gcxform.config.toml_text import locate_key
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.errormodel.formats import ErrorFormat
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model import ErrorModel
from gcxform.errormodel.model_file import load_model
from gcxform.errormodel.model_text import to_toml

EXAMPLE = Path(__file__).parents[1] / "examples" / "lddm" / "model.toml"
SHARED = Path(__file__).parents[2] / "shared" / "data" / "lddm"

HEAD = """\
format = 1
kind = "axis-functions"
values = "error"
convention = "relative"
"""
X = """\
[X]
position = [0, 10.0, 30]
EXX = [0.0, 0.001, 0.003]
EYX = [0, 0, 0]
EZX = [0, 0, 0]
"""
Z = """\
[Z]
position = [0, 100]
EXZ = [0, 0]
EYZ = [0, 0]
EZZ = [0, 0.005]
"""


def load(tmp_path: Path, text: str | bytes) -> ErrorModel:
    path = tmp_path / "model.toml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return load_model(path)


def refused(tmp_path: Path, text: str | bytes) -> tuple[Diagnostic, ...]:
    with pytest.raises(UsageError) as caught:
        load(tmp_path, text)
    assert all(d.code in CATALOGUE for d in caught.value.diagnostics)
    return caught.value.diagnostics


# --- what is read ----------------------------------------------------------------------------


def test_the_model_in_the_file(tmp_path):
    model = load(tmp_path, HEAD + X)
    assert isinstance(model, AxisFunctions)
    assert model.order == "XYZ"
    assert model.axes[1] is None
    assert model.error(np.array([[5.0, 1.0, 1.0]]))[0] == pytest.approx((0.0005, 0, 0))


def test_corrections_are_negated(tmp_path):
    model = load(tmp_path, HEAD.replace('"error"', '"correction"') + X)
    assert model.error(np.array([[5.0, 1.0, 1.0]]))[0] == pytest.approx((-0.0005, 0, 0))


def test_squareness_is_folded_in(tmp_path):
    y = X.replace("[X]", "[Y]").replace("X =", "Y =")
    square = "[squareness]\nC0Y = 1e-5\nB0Z = 2e-5\nA0Z = 4e-5\n"
    plain, bent = load(tmp_path, HEAD + y + Z), load(tmp_path, HEAD + y + Z + square)
    points = np.array([[0.0, 20.0, 50.0]])
    expected = (-1e-5 * 20 + 2e-5 * 50, -4e-5 * 50, 0)
    assert (bent.error(points) - plain.error(points))[0] == pytest.approx(expected, abs=1e-15)


def test_angular_functions_of_zero_are_taken(tmp_path):
    load(tmp_path, HEAD + X + "EAX = [0, 0.0, 0]\n")


def test_a_byte_order_mark_and_crlf_are_taken(tmp_path):
    load(tmp_path, b"\xef\xbb\xbf" + (HEAD + X).replace("\n", "\r\n").encode())


@pytest.mark.skipif(not SHARED.is_dir(), reason="the shared data is not beside the checkout")
def test_the_example_is_the_published_table():
    one, other = load_model(EXAMPLE), load_model(SHARED / "model.toml")
    assert isinstance(one, AxisFunctions)
    assert isinstance(other, AxisFunctions)
    assert to_toml(one) == to_toml(other)


# --- what is written -------------------------------------------------------------------------


def test_what_is_written_reads_back_to_the_bit(tmp_path):
    rng = np.random.default_rng(3)
    function = AxisFunction(np.cumsum(rng.uniform(0.1, 50, 9)), rng.normal(size=(9, 3)) * 1e-3)
    tiny = AxisFunction(np.array([-1e-7, 1e6]), np.array([[1e-320, -0.0, 1e-5], [0.1, 1, 2]]))
    model = AxisFunctions((function, None, tiny), "ZYX")
    text = to_toml(model)
    again = load(tmp_path, text)
    assert isinstance(again, AxisFunctions)
    assert again.order == "ZYX"
    assert to_toml(again) == text
    for one, other in zip(model.axes, again.axes, strict=True):
        if one is not None and other is not None:
            assert one.position.tobytes() == other.position.tobytes()
            assert np.array_equal(one.values, other.values)


def test_the_example_is_in_canonical_numbers():
    rows = [line for line in EXAMPLE.read_text().splitlines() if line[:3] in ("EXX", "pos", "EYZ")]
    model = load_model(EXAMPLE)
    assert isinstance(model, AxisFunctions)
    assert set(rows) <= set(to_toml(model).splitlines())


# --- what is refused -------------------------------------------------------------------------

DEFECTS = {
    "not toml": (HEAD + X.replace("[0, 0, 0]", "[0, 0", 1), "GX402", 9, ""),
    "cut off": (HEAD + "[X", "GX402", 5, ""),
    "not utf-8": (HEAD.encode() + b"# caf\xe9\n[X]\n", "GX402", 5, "UTF-8"),
    "unknown key": (HEAD + 'valuse = "x"\n' + X, "GX403", 5, "'values'"),
    "unknown function": (HEAD + X + "EYY = [0, 0, 0]\n", "GX403", 10, "'EYX'"),
    "wrong case": (HEAD + X.replace("EXX", "exx") + "EXX = [0]", "GX403", 7, "'EXX'"),
    "unknown squareness": (HEAD + X + "[squareness]\nC0X = 0\n", "GX403", 11, "'C0Y'"),
    "missing function": (HEAD + X.replace("EZX", "EAX"), "GX404", 5, "EZX"),
    "missing position": (HEAD + X.replace("position", "EAX"), "GX404", 5, "position"),
    "missing values": (HEAD.replace('values = "error"\n', "") + X, "GX404", 0, "values"),
    "missing kind": ("format = 1\n", "GX404", 0, "kind"),
    "missing format": ('kind = "axis-functions"\n', "GX404", 0, "format"),
    "text for a number": (HEAD + X.replace("0.001", '"0.001"'), "GX405", 7, "EXX[2]"),
    "true for a number": (HEAD + X.replace("0.001", "true"), "GX405", 7, "a number"),
    "number for a list": (HEAD + X.replace("[0, 0, 0]", "0", 1), "GX405", 8, "a list"),
    "number for a table": (HEAD + "X = 3\n", "GX405", 5, "a table"),
    "wrong choice": (HEAD.replace('"error"', '"errors"') + X, "GX405", 3, "mean 'error'?"),
    "format 2": (HEAD.replace("1", "2") + X, "GX406", 1, "2"),
    "format true": (HEAD.replace("1", "true") + X, "GX406", 1, "True"),
    "unknown kind": (HEAD.replace("axis-functions", "axis-function"), "GX407", 2, "did you mean"),
    "later kind": (HEAD.replace("axis-functions", "rubber"), "GX407", 2, "known: axis-functions"),
    "kind 3": (HEAD.replace('"axis-functions"', "3"), "GX407", 2, "3"),
    "unsorted": (HEAD + X.replace("30", "5"), "GX408", 6, "5.0 comes after 10.0"),
    "twice": (HEAD + X.replace("30", "10"), "GX409", 6, "10.0 stands twice"),
    "short": (HEAD + X.replace("[0, 0, 0]", "[0, 0]", 1), "GX410", 8, "2 values for 3 positions"),
    "short angular": (HEAD + X + "EAX = [0]\n", "GX410", 10, "1 value for 3 positions"),
    "one node": (HEAD + "[X]\nposition=[0]\nEXX=[0]\nEYX=[0]\nEZX=[0]", "GX411", 6, "1 node"),
    "no node": (HEAD + "[X]\nposition=[]\nEXX=[]\nEYX=[]\nEZX=[]", "GX411", 6, "0 nodes"),
    "nan": (HEAD + X.replace("0.001", "nan"), "GX412", 7, "nan"),
    "inf position": (HEAD + X.replace("30", "inf"), "GX412", 6, "inf"),
    "nan squareness": (HEAD + Z + "[squareness]\nA0Z = nan", "GX412", 11, "nan"),
    "carriage": (HEAD.replace("relative", "carriage") + X, "GX413", 4, "which axes"),
    "angular": (HEAD + X + "ECX = [0, 0, 1e-6]\n", "GX414", 10, "no table [Y]"),
    "angular without tool": (HEAD + Z + "ECZ = [0, 1e-6]\n", "GX414", 10, "which point"),
    "in micrometres": (HEAD + X.replace("0.003", "3.0"), "GX415", 0, "mm per mm"),
    "square without table": (HEAD + X + "[squareness]\nC0Y = 1e-5", "GX420", 11, "[Y]"),
    "square of corrections": (
        HEAD.replace('"error"', '"correction"') + Z + "[squareness]\nA0Z = 1e-5",
        "GX420",
        11,
        "sign",
    ),
    "order": (HEAD + 'order = "XYY"\n' + X, "GX421", 5, "XYY"),
    "no table": (HEAD, "GX422", 0, "no table"),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_defects(tmp_path, name):
    text, code, line, words = DEFECTS[name]
    first = refused(tmp_path, text)[0]
    assert first.code == code
    assert first.where is not None
    assert first.where.file.endswith("model.toml")
    assert first.where.line == line, first.render()
    assert words in first.render()


def test_the_column_of_an_element_is_shown(tmp_path):
    (found,) = refused(tmp_path, HEAD + X.replace("0.001", "nan"))
    assert found.where is not None
    assert found.where.text[found.where.column - 1 :].startswith("nan")


def test_all_defects_of_the_tables_are_told(tmp_path):
    tables = X.replace("30", "5").replace("0.003", "nan") + "EAX=[0,1,0]\n"
    found = refused(tmp_path, HEAD + "tool = [0, 0, 0]\n" + tables)
    assert [d.code for d in found] == ["GX408", "GX412", "GX414"]


def test_every_code_of_this_file_is_tried():
    tried = {code for _, code, _, _ in DEFECTS.values()} | {"GX401", "GX416"}
    ours = {code for code in CATALOGUE if "GX401" <= code <= "GX422"} - {"GX417", "GX418", "GX419"}
    assert tried == ours


@pytest.mark.parametrize("name", ["missing.toml", "directory.toml", "missing.txt", "nul\0.toml"])
def test_files_which_cannot_be_read(tmp_path, name):
    (tmp_path / "directory.toml").mkdir()
    with pytest.raises(UsageError) as caught:
        load_model(tmp_path / name)
    assert caught.value.diagnostics[0].code == "GX401"
    assert caught.value.exit_code == 2


# --- foreign formats -------------------------------------------------------------------------


class Tab(ErrorFormat):
    """A format for this test."""

    name: ClassVar[str] = "tab"
    suffixes: ClassVar[tuple[str, ...]] = (".tab", ".dat")

    @classmethod
    def recognises(cls, path):
        return path.suffix in cls.suffixes

    @classmethod
    def read(cls, path):
        slope = float(path.read_text())
        return AxisFunctions(
            (AxisFunction(np.array([0.0, 1.0]), np.array([[0, 0, 0], [slope, 0, 0]])), None, None)
        )


def test_a_foreign_format_is_asked(tmp_path):
    path = tmp_path / "machine.dat"
    path.write_text("0.001")
    assert load_model(path, [Tab]).lipschitz() == pytest.approx(0.001)


def test_a_foreign_model_is_checked_too(tmp_path):
    path = tmp_path / "machine.dat"
    path.write_text("0.1")
    with pytest.raises(UsageError, match="GX415"):
        load_model(path, [Tab])


def test_what_no_format_knows_is_refused(tmp_path):
    (tmp_path / "machine.xyz").write_text("0.001")
    for path, noun in ((tmp_path / "machine.xyz", "file"), (tmp_path, "directory")):
        with pytest.raises(UsageError) as caught:
            load_model(path, [Tab])
        (found,) = caught.value.diagnostics
        assert found.code == "GX416"
        assert f"this {noun}" in found.message
        assert found.hint == "known: TOML (.toml), tab (.tab, .dat)"


# --- places in TOML --------------------------------------------------------------------------

PIPELINE = '''\
format = 1   # a [comment] = 2
text = """a
[not.a.table] = "x" \\" """
"quoted \\u0061.b" = 'lit\\' # '
point.x = 1
point . y = [ 1, [2, 3],   # ] comment
  "]", { a = 1, b = [4] } ]
when = 1979-05-27 07:32:00
[[pass]]
use = "absolute"
[pass.deep]
k = 1
[[pass]]
  use = "segment"
[[pass.list]]
n = 1
[[pass.list]]
n = 2
[ a . "b c" ]
inline = { x = 1, y = { z = "}" } }
'''


@pytest.mark.parametrize(
    ("keys", "place"),
    [
        ((), (0, 1)),
        (("format",), (1, 1)),
        (("text",), (2, 1)),
        (("quoted a.b",), (4, 1)),
        (("point",), (5, 1)),
        (("point", "x"), (5, 7)),
        (("point", "y"), (6, 9)),
        (("point", "y", 0), (6, 15)),
        (("point", "y", 1, 1), (6, 22)),
        (("point", "y", 2), (7, 3)),
        (("point", "y", 3, "b"), (7, 17)),
        (("point", "y", 3, "b", 0), (7, 22)),
        (("when",), (8, 1)),
        (("pass",), (9, 1)),
        (("pass", 0), (9, 1)),
        (("pass", 0, "use"), (10, 1)),
        (("pass", 0, "deep"), (11, 1)),
        (("pass", 0, "deep", "k"), (12, 1)),
        (("pass", 1), (13, 1)),
        (("pass", 1, "use"), (14, 3)),
        (("pass", 1, "missing"), (13, 1)),
        (("pass", 1, "list", 0, "n"), (16, 1)),
        (("pass", 1, "list", 1, "n"), (18, 1)),
        (("a", "b c"), (19, 1)),
        (("a", "b c", "inline", "y", "z"), (20, 25)),
        (("nothing",), (0, 1)),
    ],
)
def test_places_of_keys(keys, place):
    assert locate_key(PIPELINE, keys) == place


def test_places_with_passes_as_inline_tables():
    text = 'pass = [ { use = "a" },\n  { use = "b", chord-error = 2 } ]'
    assert locate_key(text, ("pass", 1, "chord-error")) == (2, 16)
    assert locate_key(text, ("pass", 1)) == (2, 3)


def test_places_behind_a_blank_before_a_comma():
    assert locate_key("a = {b = [0.0] , c = 2}", ("a", "c")) == (1, 18)
