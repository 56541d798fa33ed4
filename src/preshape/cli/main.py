"""The `preshape` command and its exit codes: 0 done, 2 the user's error in one sentence, 1 ours with a traceback."""

from __future__ import annotations

import sys
import traceback
from importlib import import_module
from typing import Any

import click

__all__ = ["main"]

COMMANDS = {
    "calibrate": "From vibration measurements to a shaper, with the reason and a report.",
    "design": "Design a shaper for known modes.",
    "analyze": "Show what a shaper does at its modes.",
    "shape": "Shape a command that lies in a CSV file.",
    "gcode": "Shape the moves of a G-code program, for a controller that cannot.",
    "stream": "Shape standard input into standard output, sample by sample.",
    "export": "Write a shaper for somebody else's controller: C, LinuxCNC ...",
    "studio": "Choose a shaper with your eyes, on a page in your browser.",
    "compare": "Compare every kind of command for one move of a flexible machine.",
    "move": "Move a flexible body from rest to rest, within a deflection.",
    "simulate": "Simulate your machine under a command, unshaped beside shaped.",
    "verify": "Compare recordings of a move without and with the shaper, or write the moves.",
    "rerun": "Run again what a report says it was made from, and compare.",
    "campaign": "Compute thousands of designs or simulations, here or on a cluster.",
    "reproduce": "Recompute what the papers print, with verdicts and figures.",
}
"""Each in a module of its own, imported when it is called: help stays fast."""

INTERRUPTED = 130


class _Commands(click.Group):
    def make_context(
        self, info_name: str | None, args: list[str], parent: click.Context | None = None, **extra: Any
    ) -> click.Context:
        """The context, which keeps what was typed: reports say it."""
        return super().make_context(info_name, args, parent, obj=list(args), **extra)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = import_module(f"preshape.cli.{cmd_name}_command").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


def _show_version(ctx: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value and not ctx.resilient_parsing:
        from importlib.metadata import version

        from preshape.kernel import active_kernel

        click.echo(f"preshape {version('preshape')}, {active_kernel()} kernel")
        ctx.exit()


@click.command(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--version", is_flag=True, is_eager=True, expose_value=False, callback=_show_version, help="Say which version."
)
def preshape() -> None:
    """Commands that do not shake machines.

    \b
    From a measurement:  preshape calibrate resonances_x.csv --out report
    From known modes:    preshape design --family direct --mode 9.8 --mode 31.7:0.01
    """


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and leave with its exit code."""
    from preshape.errors import InputError

    try:
        code = preshape.main(args=arguments, standalone_mode=False)
    except click.UsageError as error:
        error.show()
        code = 2
    except click.ClickException as error:
        error.show()
        code = 2
    except InputError as error:
        click.echo(f"Error: {error}", err=True)
        code = 2
    except (click.Abort, KeyboardInterrupt):
        click.echo("Interrupted; no file was left half written.", err=True)
        code = INTERRUPTED
    except BrokenPipeError:
        sys.stderr.close()
        code = 0
    except Exception:
        traceback.print_exc()
        click.echo("Error: this is a fault of preshape, not yours; please report the lines above.", err=True)
        code = 1
    sys.exit(code if isinstance(code, int) else 0)
