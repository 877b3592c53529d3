"""Presets of machines: what the file says wins, what was taken is shown, and the source agrees."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from cli_kit import call, workplace

import gcxform as gx
from gcxform.config.quantities import LENGTH
from gcxform.machine.file import load_machine
from gcxform.machine.schema import schema
from gcxform.plugin.registry import default_registry

SAMPLES = Path("/usr/share/doc/linuxcnc/examples/sample-configs")
PRESETS = default_registry().presets
FILE = """format = 1
[control]
like = "tormach-pcnc-770"
user-codes = "keep"
[axis.X]
max-speed = 1000.0
[axis.Y]
limits = [-10.0, 10.0]
"""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    workplace(tmp_path, monkeypatch)
    (tmp_path / "m.toml").write_text(FILE)
    return tmp_path


def test_what_the_file_says_wins(here: Path) -> None:
    machine = load_machine(here / "m.toml", default_registry().machines)
    assert machine.axes["X"].max_speed == 1000.0
    assert machine.axes["X"].limits == (0.0, pytest.approx(355.6))
    assert machine.axes["Z"].limits == (pytest.approx(-336.55), 0.0)
    assert machine.axes["Z"].max_speed == 2538.984
    assert machine.axes["Y"].limits == (-10.0, 10.0)
    assert machine.control == {"user-codes": "keep"}


def test_check_and_the_certificate_say_what_was_taken(here: Path) -> None:
    source = "LinuxCNC 2.9, by_machine/tormach/pcnc-770.ini"
    found = call("check", "-p", "job.toml", "-m", "m.toml", "part.nc")
    line = f'axis.X.limits = ["0 in", "14 in"] of tormach-pcnc-770 ({source})'
    assert found.stdout.count(line) == 1
    assert found.stdout.startswith(f"preset {line}\n")
    assert "axis.X.max-speed" not in found.stdout
    pipeline = gx.Pipeline.load("job.toml")
    assert not any("tormach" in each for each in pipeline.run(Path("part.nc")).certificate.assumed)
    (here / "job.toml").write_text(f'{Path("job.toml").read_text()}[machine]\nfile = "m.toml"\n')
    run = gx.Pipeline.load("job.toml").run(Path("part.nc"))
    assert line in run.certificate.assumed


def test_a_preset_that_is_not_there(here: Path) -> None:
    (here / "m.toml").write_text('format = 1\n[control]\nlike = "tormach-pcnc-77"\n')
    found = call("check", "-p", "job.toml", "-m", "m.toml")
    assert found.exit_code == 2
    assert "m.toml:3:1" in found.stderr
    assert "tormach-pcnc-770" in found.stderr


def test_the_schema_has_it_and_the_list_shows_it() -> None:
    assert "like" in schema()["$defs"]["MachineFile"]["properties"]["control"]["properties"]
    found = call("list", "presets", "tormach-pcnc-770").stdout
    assert "source: LinuxCNC 2.9" in found
    assert 'axis.Z.limits = ["-13.25 in", "0 in"]' in found


@pytest.mark.parametrize("name", list(PRESETS))
def test_every_preset_is_a_machine_file(name: str, here: Path) -> None:
    (here / "p.toml").write_text(f'format = 1\n[control]\nlike = "{name}"\n')
    assert load_machine(here / "p.toml", default_registry().machines).taken


@pytest.mark.parametrize("name", list(PRESETS))
def test_the_values_are_those_of_the_source(name: str) -> None:
    file = SAMPLES / PRESETS[name].source.split(", ")[1]
    if not file.exists():
        pytest.skip("the sample configurations of LinuxCNC are not installed")
    sections = dict(re.findall(r"^\[(AXIS_.)\][ \t]*\n((?:(?!\[).*\n)*)", file.read_text(), re.M))
    for letter, axis in PRESETS[name].values["axis"].items():
        said = dict(re.findall(r"^(\w+)\s*=\s*(\S+)", sections[f"AXIS_{letter}"], re.M))
        for key, limit in zip(("MIN_LIMIT", "MAX_LIMIT"), axis["limits"], strict=True):
            assert LENGTH.parse(limit) == pytest.approx(25.4 * float(said[key]), abs=1e-4)
        assert axis["max-speed"] == pytest.approx(1524.0 * float(said["MAX_VELOCITY"]))
