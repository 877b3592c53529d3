"""Values of an axis are replaced in a machine file, however TOML lets a person spell them."""

from __future__ import annotations

import json
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcxform.diagnostics import UsageError
from gcxform.machine import axis_text
from gcxform.machine.axis_text import MARK, with_axis
from gcxform.machine.machine import Axis

KEYS = ("direction", "point", "sign")
FOUND = Axis(direction=(0.0, 0.6, -0.8), point=(1.5, -2e-5, 300.0), sign=-1)
STATED = {"direction": [0.0, 0.6, -0.8], "point": [1.5, -2e-5, 300.0], "sign": -1}


class Writer:
    """Spells machine files; `rest` collects the texts that an edit of the axis B must keep."""

    def __init__(self, data: st.DataObject) -> None:
        self.data = data
        self.count = 0
        self.rest: list[str] = []

    def draw(self, *choices):
        return self.data.draw(st.sampled_from(choices))

    def remark(self) -> str:
        """Return a remark that stands once in the file, or nothing."""
        self.count += 1
        return self.draw("", f" # remark {self.count}", f"\t#{self.count}")

    def key(self, *parts: str) -> str:
        dot = self.draw(".", " . ")
        return dot.join(self.draw(part, f'"{part}"', f"'{part}'") for part in parts)

    def value(self, value: object) -> str:
        if not isinstance(value, list):
            return json.dumps(value)
        items = [json.dumps(item) for item in value]
        lines = "[ # of many\n  " + ", # one\n ".join(items) + ",\n\n]"
        return self.draw(f"[{', '.join(items)}]", f"[ {','.join(items)} ,]", lines)

    def pair(self, key: str, value: object) -> str:
        return f"{key}{self.draw(' = ', '=')}{self.value(value)}"

    def table(self, axis: dict[str, object], *path: str) -> str:
        """Return an inline table, with keys that begin with a path."""
        pairs = [self.pair(self.key(*path, key), value) for key, value in axis.items()]
        return "{" + self.draw("", " ") + ", ".join(pairs) + self.draw("", " ") + "}"

    def line(self, letter: str, text: str) -> str:
        """Return a line, which is to be kept if it is not of the axis B."""
        line = self.draw("", "  ") + text + self.remark()
        if letter != "B":
            self.rest.append(line)
        elif "#" in line.split("\n")[-1]:
            self.rest.append(line[line.rindex("#") :])
        return line

    def above(self) -> list[str]:
        self.count += 1
        lines = self.draw([], [""], ["", f"# above {self.count}"])
        self.rest += [line for line in lines if line]
        return lines

    # --- the ways of TOML ---

    def own_tables(self, axes):
        for letter, axis in axes.items():
            if self.draw(True, False):
                yield from [*self.above(), self.line("", f"[tool.{self.count}]")]
                yield self.line("", f"length = {self.count}.0")
            yield from self.above()
            header = self.line("", f"[{self.draw('', ' ')}{self.key('axis', letter)}]")
            yield header
            for key, value in axis.items():
                yield self.line(letter * (key in KEYS), self.pair(self.key(key), value))

    def dotted(self, axes, *path):
        pairs = [(letter, key) for letter, axis in axes.items() for key in axis]
        for letter, key in self.data.draw(st.permutations(pairs)):
            text = self.pair(self.key(*path, letter, key), axes[letter][key])
            yield self.line(letter * (key in KEYS), text)

    def inline(self, axes, *path):
        for letter, axis in axes.items():
            yield from self.above()
            yield self.line(letter, f"{self.key(*path, letter)} = {self.table(axis)}")

    def one_inline(self, axes):
        if self.draw(True, False):
            tables = [f"{self.key(letter)} = {self.table(axis)}" for letter, axis in axes.items()]
        else:
            tables = [self.table(axis, letter)[1:-1] for letter, axis in axes.items() if axis]
        yield self.line("B", "axis = {" + ", ".join(tables) + "}")

    def file(self, axes) -> str:
        lines = [self.line("", "format = 1"), self.line("", 'table = ["A"]')]
        way = self.draw("own", "dotted", "inline", "one", "axis dotted", "axis inline", "mixed")
        if way == "own":
            lines += self.own_tables(axes)
        elif way == "dotted":
            lines += self.dotted(axes, "axis")
        elif way == "inline":
            lines += self.inline(axes, "axis")
        elif way == "one":
            lines += self.one_inline(axes)
        elif way == "mixed":  # the table above stands below those in it
            lines += self.own_tables({"B": axes["B"]})
            others = {letter: axis for letter, axis in axes.items() if letter != "B"}
            lines += [self.line("", "[axis]"), *self.inline(others)]
        else:
            lines += [*self.above(), self.line("", "[axis]")]
            lines += (self.dotted if way == "axis dotted" else self.inline)(axes)
        lines += [*self.above(), self.line("", "[home.1]"), self.line("", "X = 0.0")]
        return "\n".join(lines) + self.draw("", "\n", "\n\n")


NUMBER = st.sampled_from([0.0, -1.0, 12.5, 1e-7, "5 mm", "-0.1 in"])
AXIS = st.fixed_dictionaries(
    {},
    optional={
        "direction": st.lists(st.sampled_from([0.0, 1.0, -0.6]), min_size=3, max_size=3),
        "limits": st.lists(NUMBER, min_size=2, max_size=2),
        "point": st.lists(NUMBER, min_size=3, max_size=3),
        "sign": st.sampled_from([1, -1]),
        "wrap": st.just(360.0),
    },
)


@given(data=st.data(), a=AXIS, b=AXIS.filter(bool), c=AXIS.filter(bool))
def test_every_spelling_is_edited_and_all_else_stays(data, a, b, c):
    order = data.draw(st.permutations(["A", "B", "C"]))
    axes = {letter: {"A": a, "B": b, "C": c}[letter] for letter in order}
    writer = Writer(data)
    text = writer.file(axes)
    end = writer.draw("\n", "\r\n")
    text = writer.draw("", "\ufeff") + text.replace("\n", end)
    before = tomllib.loads(text.removeprefix("\ufeff"))
    written = with_axis(text, "B", FOUND, ["first", "second"], "m.toml")
    after = tomllib.loads(written.removeprefix("\ufeff"))
    before["axis"]["B"].update(STATED)
    assert after == before
    at = 0
    for kept in writer.rest:
        at = written.index(kept.replace("\n", end), at) + 1
    assert written.startswith("\ufeff") == text.startswith("\ufeff")
    assert ("\r" in text) == ("\r" in written)
    assert "\n" not in written.replace("\r\n", "") or end == "\n"
    again = with_axis(written, "B", FOUND, ["third"], "m.toml")
    comments = [line for line in again.splitlines() if line.startswith(MARK)]
    assert comments == [f"{MARK} third"]
    assert again.replace("third", "first") == written.replace(f"{MARK} second{end}", "")


def test_comments_of_other_axes_stay():
    text = "[axis]\n# calibrated: A\nA.sign = 1\n# of B\n# calibrated: old\nB.sign = 1\n"
    written = with_axis(text, "B", Axis(sign=-1), ["new"], "m.toml")
    assert written == text.replace("old", "new").replace("B.sign = 1", "B.sign = -1")


def test_what_reads_otherwise_is_refused(monkeypatch):
    monkeypatch.setattr(axis_text, "_with_values", lambda text, letter, stated: text)
    with pytest.raises(UsageError, match="the axis A is spelled in a way") as caught:
        with_axis("axis.A.sign = 1", "A", Axis(sign=-1), [], "m.toml")
    assert caught.value.diagnostics[0].code == "GX435"
