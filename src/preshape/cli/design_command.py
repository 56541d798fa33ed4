"""`preshape design --family ... --mode F[:Z] ...`"""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

import click

from preshape import design
from preshape.band import Band
from preshape.cli.options import BandOption, mode_option, tolerance_option
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.shaper import Shaper

__all__ = ["command"]


@click.command("design")
@click.option(
    "--family",
    type=click.Choice([*design.FAMILIES, "convolved", "antiperiod", "mesh", "si"]),
    required=True,
    help="Which kind of shaper.",
)
@mode_option("Natural frequency [Hz] and damping ratio; once for each mode.")
@tolerance_option("Vibration tolerated: height of the humps (EI), everywhere in the bands (si).", None)
@click.option(
    "--band",
    "bands",
    type=BandOption(),
    multiple=True,
    help="Band of frequencies [Hz], with damping ratios if you like, that the shaper must cover instead of modes: one "
    "for ei, any number for si.",
)
@click.option("--order", type=int, metavar="Q", help="Vanishing derivatives (zvdk, direct, mesh).")
@click.option("--humps", type=int, metavar="K", help="Number of humps (k_hump_ei).")
@click.option("--negative-amplitude", type=float, metavar="B", help="Size of the negative impulse (sna_zv), as 0.5.")
@click.option("--deflection-ratio", type=float, metavar="R", help="Deflection while moving, of the unshaped (sd_zv).")
@click.option("--form", type=click.Choice(["impulses", "box"]), help="Kind of sd_zv shaper.  [default: impulses]")
@click.option(
    "--base", type=click.Choice(list(design.CLOSED_FAMILIES)), help="Family that is convolved.  [default: zvd]"
)
@click.option(
    "--impulses",
    type=click.Choice(["exact", "exact_robust", "two", "three"]),
    help="Which antiperiod shaper.  [default: exact]",
)
@click.option(
    "--frequency-tolerance",
    type=float,
    metavar="E",
    help="Relative error allowed on each frequency, to make it a multiple of a common one (antiperiod).  "
    "[default: 0.001]",
)
@click.option("--damping", type=float, metavar="Z", help="Damping ratio in the band.  [default: 0]")
@click.option("--duration", type=float, metavar="S", help="Longest duration [s] (mesh).  [default: the shortest]")
@click.option("--cost", type=click.Choice(["zero", "second_derivative"]), help="Any solution, or the flattest (mesh).")
@click.option("--fewest", is_flag=True, default=None, help="Look for the fewest impulses, for some seconds (mesh).")
@click.option("--at-most", type=int, metavar="N", help="Most impulses allowed (mesh, si).")
@click.option("--dt", type=float, metavar="S", help="Sample time of the controller: put the impulses on its grid.")
@click.option(
    "--json", "json_file", metavar="FILE|-", help="Write the shaper as JSON; - for standard output and nothing else."
)
def command(family: str, modes: tuple[Mode, ...], dt: float | None, json_file: str | None, **wishes: Any) -> None:
    """Design a shaper for known modes, or for bands of frequencies.

    \b
    preshape design --family zvd --mode 47.3:0.05
    preshape design --family direct --mode 9.8 --mode 31.7:0.01 --json shaper.json
    preshape design --family ei --band 40:60 --tolerance 0.05
    preshape design --family si --band 0.9:1.1 --band 2.7:3.3:0.01:0.03 --tolerance 0.05
    """
    from preshape.cli.screens import shaper_screen
    from preshape.shaper_file import to_json

    if family in ("mesh", "si", "sd_zv"):
        wishes["dt"], dt = dt, None
    shaper = _designed(family, modes, {name: value for name, value in wishes.items() if value is not None})
    if dt is not None:
        shaper = design.on_grid(shaper, dt)
    if json_file == "-":
        click.echo(to_json(shaper.to_dict()), nl=False)
        return
    saved = None if json_file is None else shaper.save(Path(json_file))
    shaper_screen(shaper)
    if saved is not None:
        click.echo(f"Shaper: {saved}")


def _designed(family: str, modes: tuple[Mode, ...], wishes: dict[str, Any]) -> Shaper:
    """Call the family with what it takes; say so when it does not take a wish."""
    bands = wishes.pop("bands", ())
    if bands or family == "si":
        return _for_bands(family, modes, bands, wishes)
    if not modes:
        raise InputError("no mode was given: name at least one, such as --mode 47.3:0.05.")
    if family == "convolved":
        base = wishes.pop("base", "zvd")
        _suits(wishes, base, f"--family convolved --base {base}")
        return design.convolved(list(modes), base, **wishes)
    if family == "antiperiod":
        _refuse(wishes, {"impulses", "frequency_tolerance"}, "--family antiperiod")
        return design.antiperiod(list(modes), **wishes)
    if family == "mesh":
        _refuse(wishes, {"dt", "duration", "order", "cost", "fewest", "at_most"}, "--family mesh")
        if "dt" not in wishes:
            raise InputError("--family mesh needs --dt: give the servo period in seconds, such as --dt 0.001.")
        return design.mesh(list(modes), **wishes)
    _suits(wishes, family, f"--family {family}")
    return design.FAMILIES[family](list(modes), **wishes)


def _for_bands(family: str, modes: tuple[Mode, ...], bands: tuple[Band, ...], wishes: dict[str, Any]) -> Shaper:
    """The families that are tuned to bands themselves."""
    if family not in ("ei", "si") or modes:
        raise InputError(
            "--band goes with --family ei or si and without --mode: these shapers are tuned to the bands themselves."
        )
    if not bands:
        raise InputError("--family si needs --band: name each band of frequencies in hertz, such as --band 8:12.")
    if family == "si":
        _refuse(wishes, {"tolerance", "at_most", "dt"}, "--family si --band")
        return design.specified_insensitivity(bands, **wishes)
    _refuse(wishes, {"tolerance", "damping"}, "--family ei --band")
    band, *others = bands
    if others or band.highest_damping > 0.0:
        raise InputError(
            "--family ei takes one band LO:HI, its damping ratio in --damping: use --family si for several bands or a "
            "range of damping ratios."
        )
    return design.ei_for_band(band.low, band.high, **wishes)


def _suits(wishes: dict[str, Any], family: str, what: str) -> None:
    """Refuse a wish that the family does not take, and one that it cannot do without."""
    _refuse(wishes, _takes(family), what)
    missing = _takes(family, needed=True) - wishes.keys()
    if missing:
        raise InputError(f"{what} needs {_option(min(missing))}: give a number.")


def _takes(family: str, needed: bool = False) -> set[str]:
    """What a family's function takes beside the modes, or only what it cannot do without."""
    parameters = inspect.signature(design.FAMILIES[family]).parameters
    return {
        name
        for name, parameter in parameters.items()
        if name != "modes" and (not needed or parameter.default is inspect.Parameter.empty)
    }


def _refuse(wishes: dict[str, Any], taken: set[str], what: str) -> None:
    surplus = sorted(wishes.keys() - taken)
    if surplus:
        allowed = ", ".join(_option(name) for name in sorted(taken)) or "no such option"
        raise InputError(f"{what} does not take {_option(surplus[0])}: it takes {allowed}.")


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")
