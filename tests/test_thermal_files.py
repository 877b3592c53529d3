"""Files of thermal models: the state at a time, limits (T2), readings that are none (T5)."""

from __future__ import annotations

import numpy as np
import pytest
from thermal_kit import (
    COLD,
    LOG,
    SCREW,
    WARM,
    along,
    csv,
    growth,
    place,
    refused,
    row,
    text,
    written,
)

import gcxform as gx
from gcxform.errormodel.model_file import load_model, schema


@pytest.mark.parametrize(
    ("time", "taken"),
    [
        ("", "2026-03-04T10:00:00"),
        ("time = 2026-03-04T10:00:00", "2026-03-04T10:00:00"),
        ("time = 2026-03-04T09:59:59\nmax-age = 3600", "2026-03-04T09:00:00"),
        ('time = "2026-03-04T09:10:00"', "2026-03-04T09:00:00"),
        ("time = 2030-03-04T09:10:00\nmax-age = inf", "2026-03-04T10:00:00"),
    ],
)
def test_the_state_is_the_last_one_at_or_before_the_time(tmp_path, time, taken):
    model = load_model(written(tmp_path, text(general=time), LOG))
    assert [state.time for state in model.states] == [taken]
    hours = int(taken[11:13])
    temperatures = {9: WARM - 4, 10: WARM}[hours]
    wanted = 1000 * (growth(700.0, temperatures) - growth(200.0, temperatures))
    assert along(model, 500.0) == pytest.approx(wanted, abs=1e-3)


@pytest.mark.parametrize(
    "time",
    [
        "time = 2026-03-04T07:59:59",
        "time = 2026-03-04T10:10:01",
        "time = 2026-03-04T09:59:00\nmax-age = 3539",
        "time = 2026-03-04T10:00:00Z",
    ],
)
def test_no_state_for_the_time(tmp_path, time):
    (found,) = refused(written(tmp_path, text(general=time), LOG))
    assert place(found) == ("model.toml", 6, 1, "GX426")


def test_times_with_an_offset_are_compared_as_instants(tmp_path):
    log = csv(row("2026-03-04T09:00:00+01:00", WARM - 4), row("2026-03-04T09:00:00Z"))
    model = load_model(written(tmp_path, text(general="time = 2026-03-04T08:05:00Z"), log))
    assert model.states[0].time == "2026-03-04T09:00:00+01:00"


def test_the_state_of_the_geometry_is_subtracted_once(tmp_path):
    """A number and a row that says the same are the same; as warm as then there is no error."""
    by_row = text(reference="2026-03-04T08:00:00")
    one = load_model(written(tmp_path, by_row, LOG))
    other = load_model(written(tmp_path, text(), LOG))
    x = np.linspace(0, 520, 50)
    assert along(one, x) == pytest.approx(along(other, x), abs=1e-12)
    then = load_model(written(tmp_path, by_row, LOG)).at_time("2026-03-04T08:00:00")
    assert not along(then, x).any()


def test_kelvin_semicolons_and_remarks(tmp_path):
    rows = [row("2026-03-04T10:00:00", WARM + 273.15)]
    log = "# logger 7\n\n" + csv(*rows, unit="K").replace(",", " ; ") + "# end\n"
    model = load_model(written(tmp_path, text(), log))
    plain = load_model(written(tmp_path, text()))
    assert along(model, 500.0) == pytest.approx(along(plain, 500.0), abs=1e-9)


def test_t2_the_limit(tmp_path):
    """Warmer by a third, the axis is off by 0.22 mm at the end of its travel."""
    hot = COLD + 1.33 * (WARM - COLD)
    path = written(tmp_path, text(), csv(row("2026-03-04T10:00:00", hot)))
    (found,) = refused(path)
    assert place(found) == ("model.toml", 7, 1, "GX425")  # [X], as the limit is not written
    worst = 1.33 * 1000 * (growth(720.0) - growth(200.0))
    assert worst > 200
    assert f"{worst:.1f} um at 2026-03-04T10:00:00" in found.message
    for limit, holds in ((worst + 0.01, True), (worst - 0.01, False)):
        path.write_text(text(general=f"limit = {limit / 1000}"))
        if holds:
            assert 1000 * load_model(path).largest() == pytest.approx(worst, abs=1e-3)
        else:
            assert place(refused(path)[0]) == ("model.toml", 6, 1, "GX425")


def test_t2_the_limit_holds_between_the_nodes(tmp_path):
    """Cold at one end and warm at the other: the largest error is where no node is."""
    cold = np.linspace(-20, 31, 12) + COLD
    path = written(tmp_path, text(), csv(row("2026-03-04T10:00:00", cold)))
    model = load_model(path.parent / path.name)
    fine = np.abs(along(model, np.linspace(0, 520, 52_001)))
    at_nodes = np.abs(along(model, model.nodes[0]))
    assert 1000 * model.largest() == pytest.approx(fine.max(), abs=1e-6)
    assert fine.max() > at_nodes.max() + 0.01


@pytest.mark.parametrize(
    ("cell", "code"),
    [
        ("", "GX427"),
        ("nan", "GX427"),
        ("-inf", "GX427"),
        ("80.1", "GX427"),
        ("-0.1", "GX427"),
        ("fault", "GX419"),
        ("3_1", "GX419"),
    ],
)
def test_t5_readings_that_are_none(tmp_path, cell, code):
    good = row("2026-03-04T09:00:00")
    bad = row("2026-03-04T10:00:00").replace(",57,", f",{cell},")
    (found,) = refused(written(tmp_path, text(), csv(good, bad)))
    assert place(found) == ("readings.csv", 3, bad.index(f",{cell},55") + 2, code)
    assert "T5" in found.message
    model = load_model(
        written(tmp_path, text(general="time = 2026-03-04T09:00:00"), csv(good, bad))
    )
    with pytest.raises(gx.UsageError, match=code):
        model.at_time("2026-03-04T10:00:00")


def test_t5_every_sensor_is_named_and_a_reference_is_checked_too(tmp_path):
    bad = row("2026-03-04T08:00:00", [22.0] * 12).replace(",22", ",", 2)
    log = csv(bad, row("2026-03-04T10:00:00"))
    found = refused(written(tmp_path, text(reference="2026-03-04T08:00:00"), log))
    assert [place(f)[1:] for f in found] == [(2, 21, "GX427"), (2, 22, "GX427")]


@pytest.mark.parametrize(
    ("log", "expected"),
    [
        (csv(row("2026-03-04T10:00:00")).replace("time", "when", 1), (1, 1, "GX417")),
        (csv(row("2026-03-04T10:00:00"), unit="F"), (1, 6, "GX417")),
        (csv(row("2026-03-04T10:00:00"), names=["T0"] * 12), (1, 16, "GX417")),
        (csv(row("yesterday")), (2, 1, "GX419")),
        (csv("2026-03-04T10:00:00,31"), (2, 23, "GX418")),
        # 33,5 with a comma: all behind it would be the temperature of the sensor before
        (csv(row("2026-03-04T10:00:00").replace("33.5", "33,5")), (2, 56, "GX418")),
        (csv(row("2026-03-04T10:00:00"), row("2026-03-04T10:00:00")), (3, 1, "GX409")),
        (csv(row("2026-03-04T10:00:00"), row("2026-03-04T09:00:00")), (3, 1, "GX408")),
        (csv(row("2026-03-04T10:00:00"), row("2026-03-04T11:00:00Z")), (3, 1, "GX426")),
        (csv(), (0, 1, "GX411")),
    ],
)
def test_files_of_readings_that_are_none(tmp_path, log, expected):
    (found,) = refused(written(tmp_path, text(), log))
    assert place(found) == ("readings.csv", *expected)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("'T11']", "'T12']", "GX427"),
        ("1221.0]", "700.0]", "GX408"),
        (", 1221.0]", "]", "GX410"),
        ("[0.0, 520.0]", "[0.0, 1022.0]", "GX428"),
        ("[0.0, 520.0]", "[-201.0, 520.0]", "GX428"),
        ("homed-at = 0.0", "homed-at = 1500.0", "GX428"),
        ("[0.0, 520.0]", "[520.0, 0.0]", "GX429"),
        ("11.5e-6", "0.0", "GX429"),
        ("11.5e-6", "inf", "GX429"),
        ("nut = 200.0", "nut = nan", "GX429"),
        ("reference = 22.0", "reference = -5.0", "GX429"),
        ("[0.0, 80.0]", "[80.0, 0.0]", "GX429"),
        ("reference = 22.0", "reference = 22.0\nmax-age = 0.0", "GX429"),
        ("reference = 22.0", "reference = 22.0\nlimit = nan", "GX429"),
        ("[X.screw]", "[X.scale]\nfixed-at = 0.0\n[X.screw]", "GX429"),
        (f"[X.screw]\n{SCREW}", "", "GX429"),
        ("direction = 1", "direction = 2", "GX405"),
        ("direction = 1\n", "", "GX404"),
        ("homed-at = 0.0", "homed-at = 0.0\nfixed-at = 0.0", "GX403"),
        ("readings.csv", "none.csv", "GX401"),
    ],
)
def test_models_that_contradict_themselves(tmp_path, old, new, expected):
    model = text()
    assert old in model
    assert refused(written(tmp_path, model.replace(old, new)))[0].code == expected


def test_where_it_is_said_which_file_is_not_there(tmp_path):
    found = refused(written(tmp_path, text().replace("readings.csv", "none.csv")))
    assert [place(f) for f in found] == [("model.toml", 3, 1, "GX401")]
    assert "'none.csv'" in found[0].message
    both = tmp_path / "both.toml"
    both.write_text('format = 1\nkind = "sum"\nmodels = ["model.toml",\n  "geometry.toml"]\n')
    (tmp_path / "model.toml").write_text(text())
    (found,) = refused(both)
    assert (place(found), "geometry.toml" in found.message) == (("both.toml", 4, 3, "GX401"), True)


def test_a_held_screw_needs_its_temperature_from_bearing_to_bearing(tmp_path):
    ends = "\n[X.screw.held]\nkA = 200.0\nkB = inf\nEA = 2.6e8\nlength = 1300.0\n"
    path = written(tmp_path, text(f"[X.screw]\n{SCREW}{ends}"))
    assert refused(path)[0].code == "GX428"
    for name in ("kA", "EA"):
        value = {"kA": "200.0", "EA": "2.6e8"}[name]
        path.write_text(
            text(f"[X.screw]\n{SCREW}{ends}").replace(f"{name} = {value}", f"{name} = 0.0")
        )
        assert "GX429" in [f.code for f in refused(path)]


def test_no_axis_at_all(tmp_path):
    assert refused(written(tmp_path, text().partition("[X]")[0]))[0].code == "GX422"


def test_the_kind_has_a_schema():
    parts = schema()["$defs"]
    assert {"ThermalScrewFile", "ThermalAxis", "ScrewFile", "HeldFile", "ScaleFile"} <= set(parts)


def test_the_fingerprint_is_that_of_the_readings(tmp_path):
    """What is elsewhere the same, but for a reading, is another model; the folder is no matter."""
    prints = []
    for k, log in enumerate(
        [LOG, LOG, LOG.replace(",57,", ",57.01,"), LOG.replace("T10:", "T11:")]
    ):
        folder = tmp_path / str(k)
        folder.mkdir()
        prints.append(gx.ModelFile.load(written(folder, text(), log)).sha256)
    assert prints[0] == prints[1]
    assert len(set(prints)) == 3
    whole = gx.ModelFile.load(written(tmp_path, text(), LOG))
    earlier = whole.at_time("2026-03-04T09:00:00")
    assert earlier.sha256 != whole.sha256
    assert earlier.at_time("2026-03-04T09:05:00").sha256 == earlier.sha256
