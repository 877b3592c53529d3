"""Case files: one page that says what goes in, what comes out, and why.

A case is a text with prose on top and sections below:

    Incremental moves become absolute ones without drift.
    -- pipeline.toml --
    format = 1
    ...
    -- input.nc --
    G91 G1 X0.1 F100
    -- expected.nc --
    G90 G1 X0.1 F100

`diagnostics` takes the place of `expected.nc` where the program or a file is refused; each of its
lines is a place and a code, `2:8 GX101`, with the name of the file in front if it is not the
program, `pipeline.toml:3:1 GX701`. With neither, the output is the input. Further sections:

    certificate   lines like `deviation <= 0.001` about deviation, angle, lines_in, lines_out, moves
    assumed       lines that the certificate has among what was assumed, or not: `- line`, `! line`
    words         a length: the output is compared word by word, numbers may differ by so much
    xfail         why the case is known to fail
    any other     a file beside the pipeline

A pipeline that says nothing of `stamp` in [output] writes no stamps here, because a stamp has a
digest of all options, and few cases are about it. One that says nothing of `structure` writes calls
and loops out: what is executed shows in no other way.

Where every byte matters (line ends, encodings) a case is a directory with these files in it, the
prose in `prose.txt`.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from gcxform.diagnostics import Diagnostic, GcxformError
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.testing.hints import try_hint
from gcxform.values import dataclass

SPECIAL = frozenset(
    {"input.nc", "expected.nc", "diagnostics", "certificate", "assumed", "words", "xfail"}
)
PROSE = "prose.txt"
_SECTION = re.compile(rb"^-- (\S+) --\n", re.MULTILINE)
_CLAIM = re.compile(r"(\w+) (<=|>=|==|<|>) (\S+)")
_COMPARISONS = {
    "<=": operator.le,
    ">=": operator.ge,
    "==": operator.eq,
    "<": operator.lt,
    ">": operator.gt,
}
_WORD = re.compile(rb"([A-Z])[ \t]*([-+]?[0-9.]+)", re.IGNORECASE)


@dataclass(frozen=True)
class Case:
    """A case as read: its sections by name."""

    path: Path
    prose: str
    sections: Mapping[str, bytes]

    def text(self, name: str) -> str:
        """Return a section as text, empty if it is not there."""
        return self.sections.get(name, b"").decode("utf-8")

    @property
    def xfail(self) -> str:
        """Why the case is known to fail; empty if it is not."""
        return " ".join(self.text("xfail").split())

    @property
    def diagnostics(self) -> tuple[str, ...]:
        """The places and codes of the refusal that is expected."""
        return tuple(self.text("diagnostics").split("\n")[:-1])


@dataclass(frozen=True)
class Outcome:
    """What a run gave: a program and its certificate, or diagnostics."""

    text: bytes = b""
    certificate: Certificate | None = None
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def places(self) -> tuple[str, ...]:
        """The diagnostics as a case states them."""
        return tuple(_place(diagnostic) for diagnostic in self.diagnostics)


def read_case(path: Path) -> Case:
    """Return the case of a file or a directory. Raises ValueError if it is not one."""
    if path.is_dir():
        sections = {file.name: file.read_bytes() for file in sorted(path.iterdir())}
        prose = sections.pop(PROSE, b"")
    else:
        prose, *rest = _SECTION.split(path.read_bytes())
        sections = dict(zip(map(bytes.decode, rest[0::2]), rest[1::2], strict=True))
        if len(sections) < len(rest) // 2:
            raise ValueError(f"{path}: a section stands twice")
    if not prose.strip():
        raise ValueError(f"{path}: a case begins with prose that says what it is for")
    if missing := {"pipeline.toml", "input.nc"} - set(sections):
        raise ValueError(f"{path}: there is no section {' and '.join(sorted(missing))}")
    if {"expected.nc", "diagnostics"} <= set(sections):
        raise ValueError(f"{path}: a case expects a program or diagnostics, not both")
    return Case(path, prose.decode("utf-8").strip(), sections)


def outcome(case: Case, folder: Path, places: Mapping[str, Path] | None = None) -> Outcome:
    """Run a case in an empty folder and return what came out.

    `places` are files that cases call by a name: `model = "lddm"`.
    """
    for name, content in case.sections.items():
        if name not in SPECIAL:
            (folder / name).write_bytes(content)
    text = case.sections["pipeline.toml"]
    for name, path in (places or {}).items():
        text = text.replace(f'= "{name}"'.encode(), f"= '{path}'".encode())
    (folder / "pipeline.toml").write_bytes(text)
    try:
        pipeline = Pipeline.load(folder / "pipeline.toml")
        if b"stamp = " not in case.sections["pipeline.toml"]:
            pipeline = replace(pipeline, stamp=False)
        if b"structure = " not in case.sections["pipeline.toml"]:
            pipeline = replace(pipeline, structure="written-out")
        result = pipeline.run(case.sections["input.nc"], verify="full")
    except GcxformError as error:
        return Outcome(diagnostics=error.diagnostics)
    return Outcome(result.text, result.certificate)


def run_case(case: Case, folder: Path, places: Mapping[str, Path] | None = None) -> Outcome:
    """Run a case and return what came out; AssertionError if that is not what it says."""
    found = outcome(case, folder, places)
    check_outcome(case, found)
    return found


def check_outcome(case: Case, found: Outcome) -> None:
    """Raise AssertionError if what came out of a case is not what it says."""
    for diagnostic in found.diagnostics:
        try_hint(diagnostic.hint, default_registry())
    said = "\n".join(diagnostic.render() for diagnostic in found.diagnostics)
    if "diagnostics" in case.sections:
        message = f"expected {case.diagnostics}, got {found.places}\n{said}"
        assert found.places == case.diagnostics, message
        return
    assert not found.diagnostics, f"refused: {found.places}\n{said}"
    assert found.certificate is not None
    for claim in case.text("certificate").splitlines():
        _check_claim(claim, found.certificate)
    for line in case.text("assumed").splitlines():
        there = line[2:] in found.certificate.assumed
        assert there == line.startswith("- "), f"{line}: assumed is {found.certificate.assumed}"
    if "expected.nc" in case.sections or "certificate" not in case.sections:
        expected = case.sections.get("expected.nc", case.sections["input.nc"])
        if "words" in case.sections:
            _check_words(found.text, expected, float(case.text("words")))
        else:
            assert found.text == expected, _difference(found.text, expected)


def _place(diagnostic: Diagnostic) -> str:
    """Return a diagnostic as `2:8 GX101`, `pipeline.toml:3:1 GX701` or `GX722`."""
    where = diagnostic.where
    if where is None:
        return diagnostic.code
    file = Path(where.file).name
    parts = [] if file in ("", "-") else [file]
    parts += [str(where.line), str(where.column)] if where.line else []
    return f"{':'.join(parts)} {diagnostic.code}"


def _check_claim(claim: str, certificate: Certificate) -> None:
    """Check a line of the section `certificate`."""
    parsed = _CLAIM.fullmatch(claim)
    assert parsed, f"not a claim about a certificate: {claim!r}"
    known = {
        "deviation": certificate.largest.get("deviation"),
        "angle": certificate.largest.get("angle"),
        "moves": certificate.checked.get("moves"),
        "lines_in": certificate.source.get("lines"),
        "lines_out": certificate.output.get("lines"),
    }
    value = known[parsed[1]]
    assert isinstance(value, int | float), f"the certificate states no {parsed[1]}"
    compare = _COMPARISONS[parsed[2]]
    assert compare(value, float(parsed[3])), f"{claim}: it is {value!r}"


def _check_words(got: bytes, expected: bytes, allowed: float) -> None:
    """Compare two programs word by word; numbers but those of codes may differ by `allowed`."""
    ours, theirs = got.splitlines(), expected.splitlines()
    assert len(ours) == len(theirs), _difference(got, expected)
    for number, (mine, wanted) in enumerate(zip(ours, theirs, strict=True), 1):
        pairs = [_words(mine), _words(wanted)]
        same = [a for a, _ in pairs[0]] == [a for a, _ in pairs[1]]
        assert same, f"line {number}: {mine!r} for {wanted!r}"
        for (address, a), (_, b) in zip(*pairs, strict=True):
            limit = 0.0 if address in "GMNOT" else allowed * (1 + 1e-6)
            assert abs(a - b) <= limit, f"line {number}: {address}{a:g} for {address}{b:g}"


def _words(line: bytes) -> list[tuple[str, float]]:
    return [(a.decode().upper(), float(value)) for a, value in _WORD.findall(line)]


def _difference(got: bytes, expected: bytes) -> str:
    """Return both programs, for a person."""
    return f"expected\n{_shown(expected)}\ngot\n{_shown(got)}"


def _shown(text: bytes) -> str:
    return "\n".join(f"    {line!r}"[:120] for line in text.splitlines(keepends=True))
