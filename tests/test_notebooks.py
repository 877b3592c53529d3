"""What notebooks show and run: cells, tables, passes of a cell, and the notebooks of the docs."""

from __future__ import annotations

import ast
import json
import sys
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import gcxform as gx

ROOT = Path(__file__).parents[1]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
PART = b"""(<b>bold</b></pre></script><script>alert</script> & "q")
G21 G90 G94 G17
G0 X0 Y0 Z5
G1 Z0 F100
G2 X10 Y0 I5 J0
G5 I0 J3 P0 Q-3 X20 Y1
G0 Z5
M2
"""
TAGS = {"div", "b", "table", "tr", "th", "td", "svg", "path", "pre"}


class Seen(HTMLParser):
    """Which elements a page has, and what of it is text."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.bold: list[str] = []
        self.text = ""
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        assert not [name for name, _ in attrs if name.startswith("on") or name in ("href", "src")]

    def handle_data(self, data: str) -> None:
        self.text += data


def seen(page: str) -> Seen:
    found = Seen(page)
    assert set(found.tags) <= TAGS
    assert found.tags.count("b") == 1  # the heading
    return found


# --- what is shown ---


def test_a_comment_is_no_markup() -> None:
    program = gx.read(PART, "linuxcnc")
    found = seen(program._repr_html_())
    assert "</pre></script><script>alert</script>" in found.text
    assert "moves5" in found.text


def test_a_name_and_a_refusal_are_no_markup(tmp_path: Path) -> None:
    file = tmp_path / "<b>part.nc"
    file.write_bytes(b"G21 (<i>)\nG1 X1 <script>\n")
    found = seen(gx.read(file, "linuxcnc")._repr_html_())
    assert "<b>part.nc" in found.text
    assert "GX" in found.text


def test_controls_of_the_text_are_dots() -> None:
    found = seen(gx.read(b"G21 (a\x1b[31m\x00b)\nG0 X1\n", "linuxcnc")._repr_html_())
    assert "\x1b" not in found.text
    assert "\x00" not in found.text


def picture(page: str) -> list[list[tuple[float, float]]]:
    """Return the points of each stroke of the picture in a page."""
    svg = ElementTree.fromstring(page[page.index("<svg") : page.index("</svg>") + 6])
    strokes = []
    for path in svg:
        pairs = path.attrib["d"].replace("M", "L").split("L")[1:]
        strokes.append([(float(a), float(b)) for a, b in map(str.split, pairs)])
    return strokes


def test_the_picture_is_the_path() -> None:
    square = b"G21 G90 G94 G17\nG0 X0 Y0\nG1 X10 F99\nY10\nX0\nY0\nM2\n"
    feed = picture(gx.read(square, "linuxcnc")._repr_html_())
    (corners,) = [each for each in feed if len(each) > 2]
    side = corners[1][0] - corners[0][0]
    assert side > 100
    shape = np.array([(0, 0), (1, 0), (1, -1), (0, -1), (0, 0)])  # y of a picture goes down
    assert np.allclose(corners, np.array(corners[0]) + side * shape, atol=0.2)


def test_the_picture_of_an_arc_is_round() -> None:
    text = b"G21 G90 G94 G17\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 F99\nM2\n"
    (circle,) = (s for s in picture(gx.read(text, "linuxcnc")._repr_html_()) if len(s) > 20)
    points = np.array(circle)
    middle = (points.max(axis=0) + points.min(axis=0)) / 2
    radii = np.linalg.norm(points - middle, axis=1)
    assert radii.max() - radii.min() < 1.5
    assert radii.max() > 100


def test_a_long_program_is_a_small_cell() -> None:
    lines = b"".join(b"G1 X%d Y%d\n" % (n, n % 7) for n in range(50_000))
    text = b"G21 G90 G94 G17\nG0 X0 Y0 Z0\nF99\n" + lines + b"M2\n"
    page = gx.read(text, "linuxcnc")._repr_html_()
    assert len(page) < 100_000
    assert (
        max(max(p[0] for p in stroke) for stroke in picture(page) if stroke) > 340
    )  # its end is there


def test_a_certificate_says_what_it_proves() -> None:
    result = gx.Pipeline.parse("absolute", "linuxcnc").run(PART.replace(b"G5 I0 J3 P0 Q-3", b"G1"))
    found = seen(result._repr_html_())
    assert "verifiedyes" in found.text
    assert "absolute" in found.text
    assert seen(result.certificate._repr_html_()).text == found.text


def test_a_model_is_drawn_with_its_error() -> None:
    model = gx.read_model(ROOT / "examples" / "lddm" / "model.toml")
    page = model._repr_html_()
    seen(page)
    nominal, actual = picture(page)
    assert nominal != actual
    low, high = model.range_of(0)
    assert f"{low:g} to {high:g} mm" in page


# --- tables ---


def test_a_path_is_an_array_of_records() -> None:
    path = gx.read(PART, "linuxcnc").path
    table = path.to_numpy()
    assert table["line"].tolist() == [3, 4, 5, 6, 7]
    assert table["X"].tolist() == [0, 0, 10, 20, 20]
    assert table["kind"].tolist() == path.kind.tolist()
    assert np.isnan(table["feed"][0]) or table["feed"][0] == 0


def test_frames_have_words_for_kinds() -> None:
    pandas = pytest.importorskip("pandas", reason="the extra pandas is not installed")
    frame = gx.read(PART, "linuxcnc").path.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert frame["kind"].tolist() == ["rapid", "line", "arc-cw", "line", "rapid"]
    assert frame["form"].tolist()[3] == "spline"
    assert frame["feed_mode"].tolist()[1] == "per-minute"


def test_polars_has_null_for_what_is_not_known() -> None:
    pytest.importorskip("polars", reason="the extra polars is not installed")
    frame = gx.read(b"G21 G90 G94\nG1 X1 F9\nM2\n", "linuxcnc").path.to_polars()
    assert frame["Z"].to_list() == [None]
    assert frame["kind"].to_list() == ["line"]


def test_an_extra_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gcxform.toolpath.table.find_spec", lambda name: None)
    with pytest.raises(gx.UsageError, match=r"gcxform\[pandas\]"):
        gx.read(PART, "linuxcnc").path.to_pandas()


# --- passes of a cell ---


@dataclass(frozen=True)
class Higher(gx.Pass):
    """Lift all by a millimetre, and say nothing of it."""

    name = "higher"

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        return path.replace(end=path.end + np.array([0.0, 0.0, 1.0]))


@dataclass(frozen=True)
class Same(gx.Pass):
    """Change nothing."""

    name = "same"

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        return path


def test_a_pass_of_a_cell_is_proved_as_any_other() -> None:
    text = b"G21 G90 G94 G17\nG0 X0 Y0 Z5\nG1 Z0 F100\nM2\n"
    chain = gx.Pipeline.parse("absolute | same", "linuxcnc", passes=[Same])
    assert chain.run(text).text.endswith(text)
    with pytest.raises(gx.VerificationError, match="GX601"):
        gx.Pipeline.parse("higher", "linuxcnc", passes=[Higher]).run(text)
    with pytest.raises(gx.UsageError, match="GX704"):
        gx.Pipeline.parse("same", "linuxcnc")  # what a cell hands over stays there


def test_a_pipeline_file_may_name_a_pass_of_a_cell(tmp_path: Path) -> None:
    file = tmp_path / "p.toml"
    file.write_text("format = 1\n[input]\ndialect = 'linuxcnc'\n[[pass]]\nuse = 'same'\n")
    assert gx.Pipeline.load(file, passes=[Same]).passes[0].name == "same"


@pytest.mark.parametrize("wrong", [object, 3, type("P", (gx.Pass,), {})])
def test_what_is_no_pass_is_refused(wrong: Any) -> None:
    with pytest.raises(gx.UsageError, match="GX702"):
        gx.Pipeline.parse("absolute", "linuxcnc", passes=[wrong])


def test_a_name_that_is_taken_is_refused() -> None:
    taken = dataclass(frozen=True)(type("Absolute", (Same,), {"name": "absolute"}))
    with pytest.raises(gx.UsageError, match="GX801"):
        gx.Pipeline.parse("absolute", "linuxcnc", passes=[taken])


# --- the notebooks of the docs ---


def cells(file: Path) -> list[str]:
    found = json.loads(file.read_text("utf-8"))["cells"]
    assert not any(cell.get("outputs") for cell in found), "outputs are not committed"
    return ["".join(cell["source"]) for cell in found if cell["cell_type"] == "code"]


def executed(file: Path) -> list[Any]:
    """Run the cells of a notebook as a kernel does; return what each shows at its end."""
    module = ModuleType("__main__")
    before, sys.modules["__main__"] = sys.modules["__main__"], module
    try:
        return [_cell(text, module.__dict__) for text in cells(file)]
    finally:
        sys.modules["__main__"] = before


def _cell(text: str, names: dict[str, Any]) -> Any:
    tree = ast.parse(text)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    if last is None:
        return None
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names)  # type: ignore[attr-defined]


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_a_notebook_runs(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if "pandas" in file.read_text("utf-8"):
        pytest.importorskip("pandas", reason="the extra pandas is not installed")
    monkeypatch.chdir(file.parent)
    shown = [each for each in executed(file) if hasattr(each, "_repr_html_")]
    pages = [each._repr_html_() for each in shown]
    assert any("<svg" in page or "verified" in page for page in pages)


def test_there_are_three_notebooks() -> None:
    assert len(NOTEBOOKS) == 3


def test_a_kernel_shows_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A real kernel, once: a pass of its cell runs, and its last value is HTML."""
    nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed")
    nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed")
    pytest.importorskip("ipykernel", reason="ipykernel is not installed")
    book = nbformat.read(ROOT / "docs" / "notebooks" / "own-pass.ipynb", as_version=4)
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3").execute()
    outputs = [each for cell in book.cells for each in cell.get("outputs", [])]
    assert any("GX601" in each.get("text", "") for each in outputs)
    assert any("verified" in each.get("data", {}).get("text/html", "") for each in outputs)
