"""The options that several verbs share, as click declares them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, TypeVar

import click

from gcxform.diagnostics import Location
from gcxform.system.option_mark import Option

ENVIRONMENT: Final = "GCXFORM_PIPELINE"
Command = TypeVar("Command", bound=Callable[..., Any])


class Typed(click.ParamType[Any]):
    """A type of `gcxform.contract.options`, by its name, for an option that click declares."""

    def __init__(self, metavar: str, kind: str, mark: Option | None = None) -> None:
        self.name, self.kind, self.mark = metavar, kind, mark or Option()

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return what a word is worth. Raises UsageError. What options need is loaded here."""
        from gcxform.contract import options

        where = Location(max(param.opts, key=len)) if param else None
        is_word = isinstance(value, str)
        return options.read_word(self.kind, self.mark, value, where) if is_word else value


LENGTH: Final = Typed("LENGTH", "Length")
ABOVE_NOTHING: Final = Typed("LENGTH", "Length", Option(above=0))
SCATTER: Final = Typed("LENGTH", "Length", Option(at_least=0))
TWO_LENGTHS: Final = Typed("X,Y", "Pair")
THREE_LENGTHS: Final = Typed("X,Y,Z", "Vector")


def above_nothing(name: str, default: str, help: str) -> Callable[[Command], Command]:
    """Return an option for a length above nothing that need not be given."""
    return click.option(name, type=ABOVE_NOTHING, default=default, show_default=True, help=help)


def one_of(*names: str, words: Sequence[str], help: str) -> Callable[[Command], Command]:
    """Return an option for one of some words, of which the first is the default."""
    kind = click.Choice(words)
    return click.option(*names, type=kind, default=words[0], show_default=True, help=help)


FROM = click.option("-f", "--from", "dialect", metavar="DIALECT", help="Dialect of the program.")
TO = click.option("-t", "--to", metavar="DIALECT", help="Dialect to write.  [default: as read]")
VERIFY = click.option(
    "--verify",
    type=click.Choice(["off", "on", "full"]),
    default="on",
    show_default=True,
    help="Read the output again and compare; full: also check the facts after each pass.",
)
QUIET = click.option("-q", "--quiet", is_flag=True, help="Say nothing unless something is wrong.")
CERTIFICATE = click.option("--certificate", metavar="FILE", help="Write the certificate (JSON).")
MAP = click.option("--map", "source_map", metavar="FILE", help="Write the source map (JSON).")
FILE = click.argument("file", metavar="FILE")
FILES = click.argument("files", metavar="FILE...", nargs=-1, required=True)

_PIPELINE = (
    click.option(
        "-p", "--pipeline", metavar="FILE", help=f"Pipeline (TOML).  [env: {ENVIRONMENT}]"
    ),
    click.option("-x", "--chain", metavar="CHAIN", help="Passes: 'absolute | metric'."),
    click.option("--budget", metavar="LENGTH", help="What all steps together may deviate."),
    click.option("--growth", metavar="NUMBER", help="Blocks that may be written for each one."),
    click.option("--decimals", metavar="X=4,A=3", help="Decimals of numbers, or one for all."),
)
_READING = (
    click.option("-m", "--machine", metavar="FILE", help="Machine file (TOML)."),
    click.option("--start", metavar="X=4,Y=-2", help="Where axes stand before the first block."),
    click.option(
        "--increment",
        metavar="IS-B",
        help="What 1 means in a distance without point: IS-A to IS-E, calculator, or a length.",
    ),
    click.option(
        "--feed-increment",
        metavar="NUMBER",
        help="What 1 means in an F without point: a number a minute, calculator, or IS-B.",
    ),
    click.option(
        "--block-delete",
        type=click.Choice(["execute", "skip"]),
        help="What the control does with / blocks.",
    ),
    click.option("--feed", metavar="NUMBER", help="The feed before the first F word, a minute."),
    click.option(
        "--tool", metavar="NUMBER", help="The tool in the spindle before the first block."
    ),
    click.option(
        "--units", type=click.Choice(["mm", "in"]), help="Units before the first G20 or G21."
    ),
    click.option("--parameters", metavar="100=1.5", help="Values that the program does not set."),
    click.option(
        "--subprograms",
        metavar="DIR",
        multiple=True,
        help="Where subprograms lie, besides beside the program.",
    ),
)


ENTRY = click.option(
    "--entry", metavar="CODES", help="Modes in which a subprogram is called: 'G91 G21'."
)
_STAMPS = (
    click.option("--no-stamp", is_flag=True, help="Write no comment that says what was done."),
    click.option("--again", is_flag=True, help="Run on stamped programs too."),
)


def reading_options(command: Command) -> Command:
    """Add the options about what a program does not say of itself."""
    for option in reversed(_READING):
        command = option(command)
    return command


def pipeline_options(command: Command) -> Command:
    """Add the options that make a pipeline."""
    command = reading_options(command)
    for option in (*reversed(_STAMPS), ENTRY, TO, FROM, *reversed(_PIPELINE)):
        command = option(command)
    return command
