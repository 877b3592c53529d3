"""`gcxform machine`: what a machine file says, to be seen before it is believed."""

from __future__ import annotations

import inspect
import math
from math import isnan
from pathlib import Path
from typing import Any

import click

from gcxform import plot
from gcxform.cli import VERBS, equip
from gcxform.cli.common import options
from gcxform.cli.common.derived_options import built, help_of, metavar_of
from gcxform.cli.common.failures import warn
from gcxform.cli.common.outputs import STDOUT, check_places, destination
from gcxform.cli.common.request import Asked
from gcxform.cli.program.new_machine import Places, Wanted, write_new
from gcxform.contract.options import OptionDoc, describe
from gcxform.diagnostics import Location, UsageError
from gcxform.machine.chain import Chain, chain_of
from gcxform.machine.formats import ControlFiles
from gcxform.machine.jog import jog_test
from gcxform.machine.machine import Machine
from gcxform.machine.text import to_toml
from gcxform.plugin.registry import default_registry


@click.group("machine", help=VERBS["machine"], short_help=VERBS["machine"])
def command() -> None:
    """Choose what to do."""


_TOOL = click.option("--tool", metavar="N", type=int, help="A tool of the machine file.")
_MACHINE = click.argument("machine", metavar="MACHINE")


@command.command("jog")
@_TOOL
@click.option("--start", metavar="A=30,C=0", help="Where axes stand.  [default: all at 0]")
@click.option(
    "--step", metavar="DEGREES", type=float, default=10.0, show_default=True, help="The jog."
)
@_MACHINE
def jog(machine: str, tool: int | None, start: str | None, step: float) -> None:
    """Say of each rotary axis which way + turns, and where the tip goes.

    Jog the axes of the machine one by one and compare: a wrong sign or point shows here.
    """
    asked = Asked(machine=machine, start=start)
    chain, loaded = _chain(asked, tool)
    if not chain.axes:
        raise UsageError.one("GX452", "this machine has no rotary axis", Location(machine))
    if not math.isfinite(step):
        raise UsageError.one("GX706", f"{step} is not finite", Location("--step"))
    position = asked.input().start
    for letter in position:
        if letter not in (*"XYZ", *chain.letters):
            message = f"{loaded.name} has no axis {letter}"
            raise UsageError.one("GX707", message, Location("--start"))
    click.echo("\n".join([loaded.name, *jog_test(chain, position, step)]))


@command.command("draw")
@_TOOL
@click.option("-o", "--output", metavar="FILE", required=True, help="The picture: SVG or PNG.")
@_MACHINE
def draw(machine: str, tool: int | None, output: str) -> None:
    """Draw the rotary axes of a machine, all at 0, with the senses of +."""
    plot.check(output, "-o")
    check_places({"-o": output}, [machine])
    chain, loaded = _chain(Asked(machine=machine), tool)
    with destination(output) as put:
        put(plot.rendered(plot.chain(chain, loaded.name), output))


def _chain(asked: Asked, number: int | None) -> tuple[Chain, Machine]:
    """Return the chain of a machine, with the tip of a tool if one is named."""
    machine = asked.loaded_machine
    assert machine is not None
    if number is None:
        return chain_of(machine), machine
    if number not in machine.tools:
        known = ", ".join(map(str, sorted(machine.tools))) or "none"
        message = f"{machine.name} has no tool {number}"
        raise UsageError.one("GX707", message, Location("--tool"), f"known: {known}")
    if isnan(float(machine.tools[number].length)):
        hint = f"give [tool.{number}] length in the machine file"
        message = f"the length of tool {number} is not known"
        raise UsageError.one("GX707", message, Location("--tool"), hint)
    return chain_of(machine, machine.tools[number]), machine


# --- from programs ---


@command.command("new")
@options.FROM
@options.TO
@click.option("-x", "--chain", metavar="CHAIN", help="What is to be done.  [default: any passes]")
@click.option(
    "-o", "--output", metavar="FILE", default=STDOUT, help="The machine file.  [default: stdout]"
)
@click.option("-p", "--pipeline", metavar="FILE", help="A pipeline file for the rest.")
@click.argument("programs", metavar="PROGRAM...", nargs=-1, required=True)
def new(
    programs: tuple[str, ...],
    dialect: str | None,
    to: str | None,
    chain: str | None,
    output: str,
    pipeline: str | None,
) -> None:
    """Write a machine file with what programs need, to be filled in.

    Programs are files, or folders of them. Each setting says how many programs need it; "?" stands
    for what is to be filled in. Where FILE is there already, what is new is added to it.
    """
    write_new(programs, dialect, Wanted(chain, to), Places(output, pipeline))


# --- from controls ---


class Controls(click.Group):
    """The controls whose kinematics plugins read, each with a command made of its options."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the controls."""
        for control in default_registry().controls.values():
            if control.reads("kinematics") and control.name not in self.commands:
                self.add_command(_import_command(control))
        equip(self)
        return super().list_commands(ctx)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command of a control; where there is none a plugin may have failed."""
        if cmd_name not in self.list_commands(ctx):
            warn(default_registry().diagnostics)
        return super().get_command(ctx, cmd_name)


@command.group("import", cls=Controls)
def taken_over() -> None:
    """Turn the kinematics of a control into a machine file."""


def _import_command(control: type[ControlFiles]) -> click.Command:
    """Return the command that takes over the kinematics of a control."""

    def take_over(file: str, output: str, **options: Any) -> None:
        reader = built(control, options, f"the control {control.name!r}")
        _write(reader.kinematics(Path(file)), file, output)

    output = click.Option(
        ["-o", "--output"],
        metavar="FILE",
        default=STDOUT,
        help="The machine file.  [default: stdout]",
    )
    file = click.Argument(["file"], metavar=control.file)
    parameters = [*map(_option, describe(control)), output, file]
    text = inspect.getdoc(control.kinematics)
    return click.Command(control.name, callback=take_over, params=parameters, help=text)


def _option(doc: OptionDoc) -> click.Option:
    """Return the option of a command for a field of a control."""
    return click.Option(
        [f"--{doc.name}"],
        type=click.Choice(doc.choices) if doc.choices else None,
        metavar=None if doc.choices else metavar_of(doc),
        required=doc.mandatory,
        help=help_of(doc),
    )


def _write(machine: Machine, file: str, output: str) -> None:
    check_places({"-o": output}, [file])
    said = [f"From {Path(file).name}. Compare with the machine: gcxform machine jog"]
    with destination(output) as put:
        put(to_toml(machine, said).encode())
