"""`preshape analyze SHAPER.json`"""

from __future__ import annotations

from pathlib import Path

import click

from preshape.cli.options import mode_option, tolerance_option
from preshape.mode import Mode

__all__ = ["command"]


@click.command("analyze")
@click.argument("shaper", type=click.Path(path_type=Path), metavar="SHAPER.json")
@mode_option("Modes to look at, instead of those it was designed for.")
@tolerance_option("Residual vibration that counts as tolerable.", 0.05)
def command(shaper: Path, modes: tuple[Mode, ...], tolerance: float) -> None:
    """Impulses, residual vibration, insensitivity, duration and delay of a shaper file."""
    from preshape.cli.screens import analysis_screen
    from preshape.mode import Modes
    from preshape.shaper import Shaper
    from preshape.workflow import analyze

    analysis_screen(analyze(Shaper.load(shaper), Modes(modes) if modes else None, tolerance))
