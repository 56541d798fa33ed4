"""`preshape move --two-masses M1:M2:K --distance D --force U`"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from preshape.band import Band
from preshape.cli.options import BandOption, mode_option, tolerance_option
from preshape.command import rest_to_rest
from preshape.command.rest_to_rest import RestToRest
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.plant import FlexibleBody, FloatingOscillator

__all__ = ["command"]

KINDS = ("time-optimal", "deflection-limiting", "on-off", "bang-bang")


class TwoMasses(click.ParamType[FloatingOscillator]):
    """M1:M2:K, with the damper behind."""

    name = "M1:M2:K[:C]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> FloatingOscillator:
        if isinstance(value, FloatingOscillator):
            return value
        try:
            numbers = [float(part) for part in str(value).split(":")]
        except ValueError:
            numbers = []
        if len(numbers) not in (3, 4):
            self.fail(f"{value!r} is not MASS:MASS:STIFFNESS[:DAMPER]: write 1:1:1 or 20:5:300:2.", param, ctx)
        try:
            return FloatingOscillator(*numbers)
        except InputError as error:
            self.fail(str(error), param, ctx)


@click.command("move")
@click.option(
    "--two-masses", type=TwoMasses(), help="Masses [kg], the force on the first, spring [N/m], damper [N s/m]."
)
@click.option("--mass", type=float, metavar="M", help="Instead: mass of the whole [kg], with --mode and --gain.")
@mode_option("Natural frequency [Hz] and damping ratio; once for each mode, with --mass.")
@click.option("--gain", "gains", type=float, multiple=True, metavar="G", help="How the force drives each mode [1/kg].")
@click.option("--distance", type=float, required=True, metavar="D", help="Where the move ends [m].")
@click.option("--force", "maximum_force", type=float, required=True, metavar="U", help="Largest force, both ways [N].")
@click.option("--command", "kind", type=click.Choice(KINDS), default=KINDS[0], show_default=True, help="Which command.")
@click.option(
    "--limit",
    "limits",
    type=float,
    multiple=True,
    metavar="D",
    help="Largest deflection [m]; one, or one for each mode.",
)
@click.option("--fuel-lean", is_flag=True, help="Coast instead of braking at the start (deflection-limiting).")
@click.option(
    "--band", "bands", type=BandOption(), multiple=True, help="Where else vibration is kept down (time-optimal)."
)
@tolerance_option("Vibration tolerated in the bands, of what one step of the force leaves.", None)
@click.option("--on-off", is_flag=True, help="The actuator has no levels between (time-optimal).")
@click.option("--out", type=click.Path(path_type=Path), metavar="FORCE.csv", help="Write the sampled force, with --dt.")
@click.option("--dt", type=float, metavar="S", help="Sample interval [s].")
@click.option("--figure", type=click.Path(path_type=Path), metavar="FIGURE", help="Draw the move: .svg, .png or .pdf.")
def command(out: Path | None, dt: float | None, figure: Path | None, **asked: Any) -> None:
    """Move a flexible body from rest to rest with a force, without vibration and within a deflection.

    \b
    preshape move --two-masses 1:1:1 --distance 10 --force 1
    preshape move --two-masses 1:1:1 --distance 10 --force 1 --limit 0.3 --figure move.svg
    preshape move --mass 2 --mode 0.2 --mode 0.5:0.01 --gain 1 --gain 0.7 --distance 10 --force 1
    """
    from preshape.cli.screens import console
    from preshape.files import write_atomically
    from preshape.report import figure_bytes, figure_format, move_figure
    from preshape.workflow import save_force

    if (out is None) != (dt is None):
        raise InputError("--out and --dt go together: the file, and the sample interval [s] of its rows.")
    drawn_as = None if figure is None else figure_format(figure)
    progress = console(stderr=True)
    with progress.status("computing the command ..."):
        move = _made(**asked)
    console().print(str(move))
    if out is not None and dt is not None:
        click.echo(f"Force: {save_force(move, out, dt)}")
    if figure is not None and drawn_as is not None:
        with progress.status("drawing ..."):
            drawn = figure_bytes(move_figure(move), drawn_as)
        click.echo(f"Figure: {write_atomically(figure, drawn)}")


def _made(
    two_masses: FloatingOscillator | None,
    mass: float | None,
    modes: tuple[Mode, ...],
    gains: tuple[float, ...],
    distance: float,
    maximum_force: float,
    kind: str,
    limits: tuple[float, ...],
    fuel_lean: bool,
    bands: tuple[Band, ...],
    tolerance: float | None,
    on_off: bool,
) -> RestToRest:
    """The plant and the command that the options ask for."""
    if (two_masses is None) == (mass is None):
        raise InputError("name the plant once: --two-masses M1:M2:K, or --mass M with --mode and --gain for each mode.")
    if two_masses is not None and (modes or gains):
        raise InputError("--mode and --gain go with --mass: two masses and a spring have the mode that follows.")
    plant = two_masses or FlexibleBody(mass or 0.0, modes, gains)
    wishes = {
        "--limit": bool(limits) and kind in ("on-off", "bang-bang"),
        "--fuel-lean": fuel_lean and kind != "deflection-limiting",
        "--band": bool(bands) and kind != "time-optimal",
        "--tolerance": tolerance is not None and not bands,
        "--on-off": on_off and kind != "time-optimal",
    }
    if surplus := [name for name, idle in wishes.items() if idle]:
        raise InputError(
            f"{surplus[0]} does not go with --command {kind} here: leave it out, see preshape move --help."
        )
    if kind == "bang-bang":
        return rest_to_rest.bang_bang(plant, distance, maximum_force=maximum_force)
    if kind == "on-off":
        return rest_to_rest.on_off(plant, distance, maximum_force=maximum_force)
    if kind == "deflection-limiting":
        if len(limits) != 1:
            raise InputError(f"--command deflection-limiting takes one --limit [m], and {len(limits)} were given.")
        return rest_to_rest.deflection_limiting(
            plant, distance, maximum_force=maximum_force, deflection_limit=limits[0], fuel_lean=fuel_lean
        )
    robust: dict[str, Any] = {"bands": bands, "tolerance": 0.05 if tolerance is None else tolerance} if bands else {}
    wanted = limits[0] if len(limits) == 1 else limits or None
    return rest_to_rest.time_optimal(
        plant, distance, maximum_force=maximum_force, deflection_limits=wanted, on_off=on_off, **robust
    )
