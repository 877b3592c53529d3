"""Every way out that a hint offers is gone to the letter: in the files, and as options."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Mapping
from contextlib import chdir
from dataclasses import replace
from pathlib import Path
from typing import Any

import tomlkit
from cli_kit import call
from missing_kit import filled, pasted

from gcxform.catalogue.questions import questions
from gcxform.catalogue.remedies import Edit, Offer, StepBefore, ways
from gcxform.catalogue.settings import ON_COMMAND_LINE, Setting, for_chain
from gcxform.cli.program.machine_needs import used_by
from gcxform.contract.options import describe
from gcxform.diagnostics import Diagnostic
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.testing.cases import Case, Outcome, outcome

MACHINE = "machine.toml"
OF_MACHINE = ("control", "tool", "work-offset", "home")
OPEN = 'fill in what is "?"'
TYPED: set[str] = set()
"""The ways that have been typed: each kind of them once."""


NEEDED = (
    ("G40 before", "again"),
    ("with G40", "lead the tool off the contour"),
    ("G15 before", "G16"),
    ("it in G90", "G91"),
    ("it (in|under) G90", "with"),
    ("G49 before", "draw the tool back"),
    ("G43 .*before", "clear"),
    ("write G0 in this block", "clear"),
)
"""What advice needs beside it, so that the tool stays where it may be: without, a contour is left
by a radius, numbers are taken for others, a length is gone, a feed becomes a rapid."""


def key(found: Diagnostic) -> tuple[str, int, int, str]:
    """Return what a diagnostic is known by: its code, its place and what it says."""
    where = found.where
    return found.code, where.line if where else 0, where.column if where else 0, found.message


def do_no_harm(found: Outcome) -> None:
    """Look for advice that, followed to the letter, lets the tool go where it must not.

    A block that is taken out, a mode that stays another one, axes that turn and lengths that end
    with the tool in the part.
    """
    for hint in (each.hint for each in found.diagnostics):
        assert not re.search(r"out of the program|block out, or|or the call$|--again", hint), hint
        if re.search(r"\bturn (it|them|the axes)\b.*\b0|end G43\.5", hint):
            assert "draw" in hint, hint
        for begun, needed in NEEDED:
            assert not re.search(begun, hint) or needed in hint, hint


def go_out(case: Case, found: Outcome, folder: Path, places: Mapping[str, Path]) -> int:
    """Go each way out of a refused case, and return how many; AssertionError where one does not."""
    one_of_each = {_shape(each): each for each in reversed(found.diagnostics)}.values()
    tried = {(key(each), way): each for each in one_of_each for way in ways(each.hint)}
    for number, ((known, way), diagnostic) in enumerate(tried.items()):
        trial = folder / f"way{number}"
        trial.mkdir()
        left = outcome(followed(case, way, diagnostic), trial, places).diagnostics
        said = "\n".join(each.render() for each in left)
        assert known not in map(key, left), f"{way} does not lead out of {known}:\n{said}"
        if (words := typed(case, way)) is not None:
            _type(words, case.sections["input.nc"], trial, diagnostic, way)
    return len(tried)


def one_round(case: Case, found: Outcome, folder: Path) -> bool:
    """Fill in what `check` asks for, and check again: nothing that a setting helps may be left.

    Return whether there was anything to ask.
    """
    asked = [each for each in found.diagnostics if [*questions(each.hint)]]
    if not asked or "pipeline.toml" not in case.sections:
        return False
    is_open = b'"?"' in case.sections["pipeline.toml"]
    (folder / "input.nc").write_bytes(case.sections["input.nc"])
    with chdir(folder):
        first = call("check", "-p", "pipeline.toml", "input.nc")
        if is_open:  # what stands there to be filled in is asked for at its place
            assert "fill in   pipeline.toml:" in first.stdout, first.stdout
            return True
        assert OPEN in first.stdout, f"nothing is asked for:\n{first.stdout}\n{first.stderr}"
        _fill_in(filled(pasted(first.stdout)))
        again = call("check", "-p", "pipeline.toml", "input.nc")
    assert OPEN not in again.stdout, f"asked for in a second round:\n{again.stdout}"
    assert again.exit_code in (0, 1), again.stderr
    return True


def _fill_in(answers: dict[str, Any]) -> None:
    """Write answers into the pipeline file and the machine file of the folder."""
    pipeline = tomlkit.parse(Path("pipeline.toml").read_text())
    _deepen(pipeline.setdefault("input", {}), answers.pop("input", {}))
    if answers:
        name = pipeline.setdefault("machine", {}).setdefault("file", MACHINE)
        file = Path(name)
        machine = tomlkit.parse(file.read_text() if file.exists() else "format = 1\n")
        _deepen(machine, answers)
        file.write_text(tomlkit.dumps(machine))
    Path("pipeline.toml").write_text(tomlkit.dumps(pipeline))


def _deepen(table: Any, more: dict[str, Any]) -> None:
    for name, value in more.items():
        if isinstance(value, dict) and name in table:
            _deepen(table[name], value)
        else:
            table[name] = value


def _shape(found: Diagnostic) -> tuple[str, str]:
    """Return what findings have in common of which one is tried."""
    return found.code, re.sub(r"\d+|\b[A-Z]\b", "#", found.hint)


def followed(case: Case, way: tuple[Offer, ...], found: Diagnostic) -> Case:
    """Return a case in which a way has been taken, in its files."""
    sections = dict(case.sections)
    for offer in way:
        if isinstance(offer, Setting):
            _set(sections, offer, found)
        elif isinstance(offer, StepBefore):
            _put(sections, offer)
        else:
            _edit(sections, offer, found)
    return replace(case, sections=sections)


# --- settings ---


def _set(sections: dict[str, bytes], offer: Setting, found: Diagnostic) -> None:
    pipeline = tomlkit.parse(sections["pipeline.toml"].decode())
    steps = [step for step in pipeline.get("pass", []) if has(step["use"], offer.key)]
    file = found.where.file if found.where else ""
    if offer.section.partition(".")[0] in OF_MACHINE:
        _set_machine(sections, pipeline, offer)
    elif offer.section:
        _merge(pipeline.setdefault(offer.section, {}), offer.key, offer.worth())
    elif steps:
        for step in steps:
            step[offer.key] = offer.worth()
    else:  # at the head of the file that the diagnostic is about
        name = Path(file).name
        head = f"{offer.key} = {offer.value}\n".replace("x, y, z", "0.0, 0.0, 0.0")
        text = re.sub(rf"(?m)^{offer.key} = .*\n", "", sections[name].decode())
        sections[name] = (head + text).encode()
    if "pipeline.toml" not in file:
        sections["pipeline.toml"] = tomlkit.dumps(pipeline).encode()


def has(name: str, option: str) -> bool:
    """Whether a pass has an option."""
    known = default_registry().passes
    return name in known and option in {each.name for each in describe(known[name])}


def _merge(table: Any, key: str, value: Any) -> None:
    if isinstance(value, dict) and isinstance(table.get(key), dict):
        table[key].update(value)
    else:
        table[key] = value


def _set_machine(sections: dict[str, bytes], pipeline: Any, offer: Setting) -> None:
    name = pipeline.setdefault("machine", {}).setdefault("file", MACHINE)
    machine = tomlkit.parse(sections.get(name, b"format = 1\n").decode())
    for question in _questions(sections, pipeline["input"]["dialect"], offer):
        *tables, last = question
        node: Any = machine
        for each in tables:
            node = node.setdefault(each, {})
        node[last] = 0.001 if last == "radius" else offer.worth()
    sections[name] = tomlkit.dumps(machine).encode()


def _questions(
    sections: Mapping[str, bytes], dialect: str, offer: Setting
) -> Iterator[tuple[str, ...]]:
    """Yield the keys in a machine file that a setting stands for: `*` is each that is used."""
    table, *name = offer.section.split(".", 1)
    keys = (table, *(part.strip('"') for part in name), offer.key)
    source = Source.of_bytes(sections["input.nc"])
    used = used_by(source, default_registry().dialects[dialect], Reading())
    yield from used.named(keys) if len(keys) == 3 else [keys]


# --- passes and edits ---


def _put(sections: dict[str, bytes], offer: StepBefore) -> None:
    pipeline = tomlkit.parse(sections["pipeline.toml"].decode())
    steps = with_step([dict(step) for step in pipeline.pop("pass", [])], offer)
    text = tomlkit.dumps(pipeline) + tomlkit.dumps({"pass": steps})
    sections["pipeline.toml"] = text.encode()


def with_step(given: list[dict[str, Any]], offer: StepBefore) -> list[dict[str, Any]]:
    """Return the steps of a chain, with one put, or moved, before another."""
    options = dict(each.split("=", 1) for each in offer.options.split())
    moved = [step for step in given if step["use"] == offer.name]
    rest = [step for step in given if step["use"] != offer.name]
    at = next((k for k, step in enumerate(rest) if step["use"] == offer.step), 0)
    return [*rest[:at], *(moved or [{"use": offer.name, **options}]), *rest[at:]]


def _edit(sections: dict[str, bytes], offer: Edit, found: Diagnostic) -> None:
    where = found.where
    assert where is not None, found
    name = "input.nc" if where.file in ("", "-") else Path(where.file).name
    lines = sections[name].decode("latin-1").splitlines(keepends=True)
    line = lines[where.line - 1]
    if offer.how == "replace":
        at = line.index(offer.instead, where.column - 1)
        lines[where.line - 1] = line[:at] + offer.text + line[at + len(offer.instead) :]
    else:
        del lines[where.line - 1]
    sections[name] = "".join(lines).encode("latin-1")


# --- as options ---


def typed(case: Case, way: tuple[Offer, ...]) -> list[str] | None:
    """Return the words of a command line that goes a way; None where none can say the case."""
    offer, *more = way
    if more or isinstance(offer, Edit):
        return None
    try:
        pipeline = tomlkit.parse(case.text("pipeline.toml")).unwrap()
    except ValueError:
        return None
    steps, words = pipeline.pop("pass", []), []
    if isinstance(offer, StepBefore):
        steps = with_step(steps, offer)
    elif not offer.section:
        own = [step for step in steps if has(step["use"], offer.key)]
        for step in own:
            step[offer.key] = for_chain(f"{offer.key} = {offer.value}").partition("=")[2]
        if not own:
            return None
    elif (offer.section, offer.key) in ON_COMMAND_LINE:
        said = for_chain(f"{offer.key} = {offer.value} in [{offer.section}]")
        words = shlex.split(said.replace("...", "0"))
    kind = f"{type(offer).__name__} {offer[:2]}"
    given = list(_options(pipeline))
    if kind in TYPED or None in given or not (words or not getattr(offer, "section", "")):
        return None
    TYPED.add(kind)
    chain = " | ".join(" ".join(_words(step)) for step in steps)
    return ["run", "-q", "--no-stamp", "-x", chain, *(w for w in given if w is not None), *words]


def _options(pipeline: dict[str, Any]) -> Iterator[str | None]:
    """Yield what a pipeline file says as options; None for what no option says."""
    pipeline.pop("format", None)
    for section, table in pipeline.items():
        for name, value in table.items():
            option = ON_COMMAND_LINE.get((section, name))
            if option is None and (section, name) != ("output", "stamp"):
                yield None
            elif option is not None:
                yield option
                yield _word(value)


def _words(step: dict[str, Any]) -> Iterator[str]:
    yield step["use"]
    yield from (f"{name}={shlex.quote(_word(v))}" for name, v in step.items() if name != "use")


def _word(value: Any) -> str:
    if isinstance(value, dict):
        return ",".join(f"{k}={v}" for k, v in value.items())
    if isinstance(value, bool):
        return str(value).lower()
    return ",".join(map(str, value)) if isinstance(value, list) else str(value)


def _type(
    words: list[str], program: bytes, folder: Path, found: Diagnostic, way: tuple[Offer, ...]
) -> None:
    with chdir(folder):
        Path("input.nc").write_bytes(program)
        done = call(*words, "input.nc", "-o", "output.nc")
    again = f"error[{found.code}]: {found.message}" in done.stderr
    assert not again, f"{way}, typed as {words}, does not lead out:\n{done.stderr}"
    assert done.exit_code in (0, 2, 3, 4), done.stderr
