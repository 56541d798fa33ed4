"""`preshape design --family ... --mode F[:Z] ...`"""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

import click

from preshape import design
from preshape.cli.options import RangeOption, mode_option, tolerance_option
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.shaper import Shaper

__all__ = ["command"]


@click.command("design")
@click.option(
    "--family", type=click.Choice([*design.FAMILIES, "convolved"]), required=True, help="Which kind of shaper."
)
@mode_option("Natural frequency [Hz] and damping ratio; once for each mode.")
@tolerance_option("Height of the humps of an EI shaper.", None)
@click.option(
    "--band", type=RangeOption(), help="Band of frequencies [Hz] that an EI shaper must cover, instead of modes."
)
@click.option("--order", type=int, metavar="Q", help="Vanishing derivatives (zvdk, direct).")
@click.option("--humps", type=int, metavar="K", help="Number of humps (k_hump_ei).")
@click.option(
    "--base", type=click.Choice(list(design.CLOSED_FAMILIES)), help="Family that is convolved.  [default: zvd]"
)
@click.option("--damping", type=float, metavar="Z", help="Damping ratio in the band.  [default: 0]")
@click.option("--dt", type=float, metavar="S", help="Sample time of the controller: put the impulses on its grid.")
@click.option(
    "--json", "json_file", metavar="FILE|-", help="Write the shaper as JSON; - for standard output and nothing else."
)
def command(family: str, modes: tuple[Mode, ...], dt: float | None, json_file: str | None, **wishes: Any) -> None:
    """Design a shaper for known modes, or an EI shaper for a band of frequencies.

    \b
    preshape design --family zvd --mode 47.3:0.05
    preshape design --family direct --mode 9.8 --mode 31.7:0.01 --json shaper.json
    preshape design --family ei --band 40:60 --tolerance 0.05
    """
    from preshape.cli.screens import shaper_screen
    from preshape.shaper_file import to_json

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
    band = wishes.pop("band", None)
    if band is not None:
        if family != "ei" or modes:
            raise InputError(
                "--band goes with --family ei and without --mode: an EI shaper is tuned to the band itself."
            )
        _refuse(wishes, {"tolerance", "damping"}, "--family ei --band")
        return design.ei_for_band(*band, **wishes)
    if not modes:
        raise InputError("no mode was given: name at least one, such as --mode 47.3:0.05.")
    if family == "convolved":
        base = wishes.pop("base", "zvd")
        _refuse(wishes, _takes(base), f"--family convolved --base {base}")
        return design.convolved(list(modes), base, **wishes)
    _refuse(wishes, _takes(family), f"--family {family}")
    missing = _takes(family, needed=True) - wishes.keys()
    if missing:
        raise InputError(f"--family {family} needs --{min(missing)}: say how many.")
    return design.FAMILIES[family](list(modes), **wishes)


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
        allowed = ", ".join(f"--{name}" for name in sorted(taken)) or "no such option"
        raise InputError(f"{what} does not take --{surplus[0]}: it takes {allowed}.")
