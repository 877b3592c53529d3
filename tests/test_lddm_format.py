"""LDDM's text tables."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from gcxform_plugins.formats.lddm import Lddm

from gcxform.catalogue import CATALOGUE
from gcxform.diagnostics import UsageError
from gcxform.errormodel.functions import AxisFunctions
from gcxform.errormodel.model_file import load_model
from gcxform.errormodel.model_text import to_toml

EXAMPLE = Path(__file__).parents[1] / "examples" / "lddm"
SHARED = Path(__file__).parents[2] / "shared" / "data" / "lddm"


def native() -> str:
    model = load_model(EXAMPLE / "model.toml")
    assert isinstance(model, AxisFunctions)
    return to_toml(model)


@pytest.fixture
def tables(tmp_path):
    for axis in "xyz":
        shutil.copy(EXAMPLE / f"table_{axis}.txt", tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", ["", "table_x.txt", "table_z.txt"])
def test_the_published_tables_are_the_native_model(name):
    model = load_model(EXAMPLE / name, [Lddm])
    assert isinstance(model, AxisFunctions)
    assert to_toml(model) == native()


@pytest.mark.skipif(not SHARED.is_dir(), reason="the shared data is not beside the checkout")
@pytest.mark.parametrize("axis", "xyz")
def test_the_examples_are_the_published_files(axis):
    name = f"table_{axis}.txt"
    assert (EXAMPLE / name).read_bytes() == (SHARED / name).read_bytes()


def test_the_order_of_columns_their_case_and_blank_lines_are_free(tables):
    path = tables / "table_y.txt"
    rows = [line.split() for line in path.read_text().splitlines()]
    text = "\r\n\r\n".join(f" {d}  {c}\t{a} {b} " for a, b, c, d in rows)
    path.write_bytes(b"\xef\xbb\xbf" + text.upper().encode())
    model = load_model(tables, [Lddm])
    assert isinstance(model, AxisFunctions)
    assert to_toml(model) == native()


def test_headings_of_the_instrument_in_italian(tables):
    for axis in "xyz":
        path = tables / f"table_{axis}.txt"
        header, rows = path.read_text().split("\n", 1)
        path.write_text(header.lower().replace("position", "Posizione") + "\n" + rows)
    assert "Posizione" in path.read_text()
    assert to_toml(Lddm().read(tables)) == native()


def test_what_is_recognised(tables):
    assert Lddm.recognises(tables)
    assert Lddm.recognises(tables / "table_x.txt")
    assert not Lddm.recognises(tables / "table_a.txt")
    assert not Lddm.recognises(tables / "other")
    for axis in "xyz":
        (tables / f"table_{axis}.txt").unlink()
    assert not Lddm.recognises(tables)
    assert not Lddm.recognises(tables / "table_x.txt")


HEADER = "Position\tdyx\tdyy\tdyz"

DEFECTS = {
    "empty": ("", "GX417", 0, 1),
    "no rows": (f"{HEADER}\n", "GX411", 1, 1),
    "one row": (f"{HEADER}\n0 0 0 0\n", "GX411", 1, 1),
    "no header": ("0 0 0 0\n1 0 0 0\n", "GX417", 1, 1),
    "header of another axis": ("Position dxx dxy dxz\n0 0 0 0\n1 0 0 0", "GX417", 1, 10),
    "missing column": ("Position dyx dyz\n0 0 0\n1 0 0", "GX417", 1, 1),
    "column twice": ("Position dyx dyy dyy\n0 0 0 0\n1 0 0 0", "GX417", 1, 18),
    "column too many": (f"{HEADER} dya\n0 0 0 0 0\n1 0 0 0 0", "GX417", 1, 22),
    "short row": (f"{HEADER}\n0 0 0 0\n1 0 0\n2 0 0 0", "GX418", 3, 6),
    "long row": (f"{HEADER}\n0 0 0 0\n1 0 0 0 7\n2 0 0 0", "GX418", 3, 9),
    "word": (f"{HEADER}\n0 0 0 0\n1 0 - 0", "GX419", 3, 5),
    "comma": (f"{HEADER}\n0 0 0 0\n1 0,001 0 0", "GX419", 3, 3),
    "grouped": (f"{HEADER}\n0 0 0 0\n1_000 0 0 0", "GX419", 3, 1),
    "foreign digits": (f"{HEADER}\n0 0 0 0\n١ 0 0 0", "GX419", 3, 1),
    "nan": (f"{HEADER}\n0 0 0 0\n\n1 0 nan 0", "GX412", 4, 5),
    "overflow": (f"{HEADER}\n0 0 0 0\n1 0 1e999 0", "GX412", 3, 5),
    "unsorted": (f"{HEADER}\n0 0 0 0\n2 0 0 0\n1 0 0 0", "GX408", 4, 1),
    "twice": (f"{HEADER}\n0 0 0 0\n2 0 0 0\n2 0 0 0", "GX409", 4, 1),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_defects(tables, name):
    text, code, line, column = DEFECTS[name]
    (tables / "table_y.txt").write_text(text, encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        load_model(tables, [Lddm])
    first = caught.value.diagnostics[0]
    assert first.code == code
    assert first.code in CATALOGUE
    assert first.where is not None
    assert first.where.file.endswith("table_y.txt")
    assert (first.where.line, first.where.column) == (line, column), first.render()


def test_all_bad_rows_are_told(tables):
    (tables / "table_y.txt").write_text(f"{HEADER}\n0 0 x 0\n1 0\n2 0 0 y\n")
    with pytest.raises(UsageError) as caught:
        load_model(tables, [Lddm])
    lines = [d.where.line for d in caught.value.diagnostics if d.where]
    assert lines == [2, 3, 4]


def test_a_missing_file_is_named(tables):
    (tables / "table_z.txt").unlink()
    with pytest.raises(UsageError) as caught:
        load_model(tables / "table_x.txt", [Lddm])
    (found,) = caught.value.diagnostics
    assert found.code == "GX401"
    assert str(found.where).endswith("table_z.txt")


def test_text_in_another_encoding_is_refused(tables):
    (tables / "table_y.txt").write_bytes(HEADER.encode() + b"\n0 0 0 0\n1 0 0 \xb5\n")
    with pytest.raises(UsageError) as caught:
        load_model(tables, [Lddm])
    found = caught.value.diagnostics[0]
    assert (found.code, found.where and found.where.line) == ("GX419", 3)
