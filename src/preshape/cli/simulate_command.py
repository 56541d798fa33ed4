"""`preshape simulate PLANT --shaper SHAPER.json --command COMMAND.csv`"""

from __future__ import annotations

from pathlib import Path

import click

from preshape.cli.options import mode_option, sample_rate_option
from preshape.errors import InputError
from preshape.mode import Mode

__all__ = ["command"]


@click.command("simulate")
@click.argument("plant", metavar="PLANT")
@click.option("--shaper", type=click.Path(path_type=Path), required=True, metavar="SHAPER.json", help="What shapes it.")
@click.option(
    "--command",
    "command_file",
    type=click.Path(path_type=Path),
    required=True,
    metavar="COMMAND.csv",
    help="A time column [s] and one column an input of the plant, held from row to row.",
)
@click.option(
    "--dt", type=float, metavar="S", help="Step of the simulation [s]: a whole part of the command's, or that."
)
@click.option("--rest", type=float, metavar="S", help="Time simulated after the command [s]; six periods unless given.")
@mode_option("Natural frequency [Hz] and damping ratio to look for afterwards, instead of the plant's own modes.")
@click.option("--out", type=click.Path(path_type=Path), metavar="OUT.csv", help="Write commands and outputs.")
@click.option("--figure", type=click.Path(path_type=Path), metavar="FIGURE", help="Draw them: .svg, .png or .pdf.")
@sample_rate_option()
def command(
    plant: str,
    shaper: Path,
    command_file: Path,
    dt: float | None,
    rest: float | None,
    modes: tuple[Mode, ...],
    out: Path | None,
    figure: Path | None,
    sample_rate: float | None,
) -> None:
    """Simulate PLANT under a command, unshaped beside shaped, and measure what is left of the vibration.

    PLANT is a file (.json or .toml) with mass, damping and stiffness matrices, with A, B, C, D, or with modes; or the
    name of a plant that comes along: mace-linear, mace or shuttle-arm.

    \b
    preshape simulate machine.toml --shaper shaper.json --command move.csv --figure simulation.svg
    """
    from preshape.cli.simulation_screen import progress_bar, simulation_screen
    from preshape.files import write_atomically
    from preshape.plant import Diverged, load_plant
    from preshape.report import figure_bytes, figure_format, simulation_figure
    from preshape.shaper import Shaper
    from preshape.workflow import read_command, save_partial, save_simulation, simulate_plant

    kind = None if figure is None else figure_format(figure)
    sources = [Path(plant), shaper, command_file]
    for target in (out, figure):
        if target is not None and any(_same_file(target, source) for source in sources):
            raise InputError(f"{target} is what is read from: choose another name, so that nothing is lost.")
    machine, found = load_plant(plant), Shaper.load(shaper)
    rows, step = read_command(command_file, machine.inputs, dt=dt, sample_rate=sample_rate)
    try:
        with progress_bar("Simulating") as tell:
            result = simulate_plant(machine, rows, step, found, modes=modes or None, rest=rest, progress=tell)
    except Diverged as problem:
        if out is not None and problem.partial.times.size:
            click.echo(f"Until then: {save_partial(problem.partial, machine.inputs, out)}", err=True)
        raise
    simulation_screen(result)
    if out is not None:
        click.echo(f"Table: {save_simulation(result, out)}")
    if figure is not None and kind is not None:
        click.echo(f"Figure: {write_atomically(figure, figure_bytes(simulation_figure(result), kind))}")


def _same_file(one: Path, other: Path) -> bool:
    return one.exists() and other.exists() and one.samefile(other)
