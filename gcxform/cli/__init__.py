"""The command line: `gcxform VERB ...`, one file per verb.

A verb's file is imported when the verb is called, so that `gcxform --help` waits for click alone.
stdout carries data only; what is said to a person goes to stderr. Exit codes: 0 done; 1 findings;
2 usage, pipeline or machine file; 3 program refused; 4 verification failed; 5 input or output
failed; 70 a bug; 128 and the signal that ended it: 130 interrupted, 143 terminated.
"""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any, Final, NoReturn

from gcxform.cli.common import DEBUG
from gcxform.cli.common.signals import end_quietly

end_quietly()  # before the first import that takes time

import click  # noqa: E402

from gcxform.version import VERSION  # noqa: E402

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

VERBS: Final = {
    "run": "Transform a program, prove the result, and write it.",
    "post": "Transform a file in place: for CAM systems and slicers.",
    "hosts": "Print what a CAM system, a slicer or a control needs to call gcxform.",
    "batch": "Transform many programs for many machines, each once, on many processors.",
    "watch": "Transform what is dropped into a folder, each program once.",
    "check": "Show the chain of a pipeline, and what is wrong with a program.",
    "compare": "Say how far the paths of two programs are apart, and where.",
    "info": "Say what is in a program.",
    "resume": "Print the blocks that make a restart at a line safe.",
    "calibrate": "Turn measurements of a machine into its error model.",
    "simulate": "Test a machine with known errors, before and after compensation.",
    "machine": "Write a machine file for programs, show its rotary axes, or import them.",
    "show": "Draw an error model, or the error along the path of a program.",
    "view": "Write a page (HTML) that shows a program in 3-D, with its lines.",
    "table": "Convert error tables from one format to another, or show one.",
    "list": "List what is installed, or the options of one thing.",
    "explain": "Explain a diagnostic code, or what a block does.",
    "schema": "Print the JSON Schema of a kind of files, or name schemas in files.",
    "lsp": "Answer an editor about programs: a language server.",
    "completion": "Print what a shell needs to complete words of a command line.",
}
FILES: Final = {"list": "listing"}  # a module named `list` would hide the builtin in this one
COMPLETE: Final = "_GCXFORM_COMPLETE"
OBJECTS_BETWEEN: Final = 50_000  # new objects before garbage is looked for


class Verbs(click.Group):
    """The verbs by name; every failure becomes a message and an exit code."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the verbs in the order in which they are shown."""
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a verb."""
        if cmd_name not in VERBS:
            return None
        gc.disable()  # what is imported stays
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # its threads spin, and win nothing
        command: click.Command = import_module(
            f"gcxform.cli.{FILES.get(cmd_name, cmd_name)}"
        ).command
        gc.freeze()  # looking at modules again and again costs a twentieth of a run
        gc.set_threshold(OBJECTS_BETWEEN)
        gc.enable()
        equip(command)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the verb of a command line; the error for a misspelt one names the nearest."""
        if args[0] not in VERBS and not ctx.resilient_parsing:
            from difflib import get_close_matches

            if os.path.exists(args[0]):
                from gcxform.cli.common.first_steps import next_steps

                ctx.fail(next_steps(args[0]))
            if near := get_close_matches(args[0].lower(), VERBS, n=1):
                ctx.fail(f"there is no verb {args[0]!r}; did you mean {near[0]!r}?")
            if "." in args[0] or os.sep in args[0]:
                ctx.fail(f"there is no file {args[0]!r}, and no such verb")
        return super().resolve_command(ctx, args)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Return verbs and options that begin so, without importing any verb."""
        from click.shell_completion import CompletionItem

        found = [CompletionItem(n, help=h) for n, h in VERBS.items() if n.startswith(incomplete)]
        return [*found, *click.Command.shell_complete(self, ctx, incomplete)]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of verbs without importing any."""
        with formatter.section("Verbs"):
            formatter.write_dl(list(VERBS.items()))

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        windows_expand_args: bool = True,
        **extra: Any,
    ) -> NoReturn:
        """Run a command line and exit."""
        if COMPLETE in os.environ:
            super().main(args, prog_name, complete_var, **extra)
        from gcxform.cli.common.failures import guarded

        words = list(sys.argv[1:] if args is None else args)
        sys.exit(guarded(self, prog_name or "gcxform", words, extra))


def equip(command: click.Command) -> None:
    """Give a verb, and what stands under it, the options that every verb takes."""
    if not command.params or command.params[-1].name != DEBUG:
        from gcxform.cli.common.answer import option

        command.params += [option(), _limit_option(), _outside_option(), _debug_option()]
    for under in getattr(command, "commands", {}).values():
        equip(under)


def _limit_option() -> click.Option:
    """Return the option that raises a limit of what a run may take."""
    return click.Option(
        ["--limit", "limit"],
        metavar="KEY=N",
        multiple=True,
        expose_value=False,
        is_eager=True,
        help="Raise a limit that a message names; replaces [limits] of the pipeline.",
        callback=_set_limits,
    )


def _set_limits(ctx: click.Context, _: click.Parameter, given: Sequence[str]) -> None:
    if given:
        from gcxform.cli.common.derived_options import limits_of
        from gcxform.system.limits import in_force

        ctx.with_resource(in_force(limits_of(given)))


def _outside_option() -> click.Option:
    """Return the option that lets files name others anywhere."""
    return click.Option(
        ["--allow-outside"],
        is_flag=True,
        expose_value=False,
        is_eager=True,
        help="Let pipeline, machine and model files name files outside of their folder.",
        callback=_allow_outside,
    )


def _allow_outside(ctx: click.Context, _: click.Parameter, said: bool) -> None:
    if said:
        from gcxform.system.inputs import allow_outside

        allow_outside()


def _debug_option() -> click.Option:
    """Return the option that shows tracebacks; every verb takes it."""
    return click.Option(
        ["--debug", DEBUG],
        is_flag=True,
        expose_value=False,
        is_eager=True,
        help="Show the traceback of a bug.",
        callback=lambda ctx, _, value: ctx.meta.update({DEBUG: True}) if value else None,
    )


@click.group(
    "gcxform",
    cls=Verbs,
    params=[_debug_option()],
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(VERSION, package_name="gcxform", message="%(prog)s %(version)s")
def verbs() -> None:
    """Read a G-code program, change what must change, write a program that is proved right."""


def main() -> NoReturn:
    """Run the command line of the process."""
    verbs.main(prog_name="gcxform")
