"""`preshape analyze SHAPER.json`, or the settings of a machine with `--as`"""

from __future__ import annotations

from pathlib import Path

import click

from preshape.cli.options import mode_option, tolerance_option
from preshape.mode import Mode

__all__ = ["command"]


@click.command("analyze")
@click.argument("file", type=click.Path(path_type=Path), metavar="FILE")
@click.option(
    "--as",
    "target",
    metavar="TARGET",
    help="FILE holds settings of this firmware, such as klipper or rrf, or FILE or folder is an export to this target, "
    "as export --list shows.  [default: it is a SHAPER.json]",
)
@click.option(
    "--target-version", metavar="VERSION", help="Of the target, as export --list shows.  [default: its first]"
)
@click.option("--axis", type=click.Choice(["x", "y", "z"]), help="Where the axes have different settings.")
@mode_option("Modes to look at, instead of those it was designed or set for.")
@click.option(
    "--spectrum",
    "spectra",
    type=click.Path(path_type=Path),
    multiple=True,
    metavar="MEASUREMENT",
    help="What of it is left.",
)
@tolerance_option("Residual vibration that counts as tolerable.", 0.05)
def command(
    file: Path,
    target: str | None,
    target_version: str | None,
    axis: str | None,
    modes: tuple[Mode, ...],
    spectra: tuple[Path, ...],
    tolerance: float,
) -> None:
    """Impulses, residual vibration, insensitivity, duration and delay of a shaper, or of what a machine makes of its
    settings.

    \b
    preshape analyze shaper.json
    preshape analyze printer.cfg --as klipper --axis x --spectrum resonances_x.csv
    preshape analyze config.g --as rrf --target-version 3.5 --mode 47.3:0.05
    """
    from preshape.cli.screens import analysis_screen, shaper_screen, spectrum_screen
    from preshape.errors import InputError
    from preshape.mode import Modes
    from preshape.shaper import Shaper
    from preshape.workflow import analyze, executed_shaper, left_of_spectrum

    if target is None and (target_version is not None or axis is not None):
        raise InputError("--target-version and --axis belong to settings: say whose they are with --as.")
    shaper = Shaper.load(file) if target is None else executed_shaper(file, target, version=target_version, axis=axis)
    left = [left_of_spectrum(shaper, path) for path in spectra]
    if modes or shaper.design.modes is not None or not left:
        analysis_screen(analyze(shaper, Modes(modes) if modes else None, tolerance))
    else:
        shaper_screen(shaper)
    spectrum_screen(left)
