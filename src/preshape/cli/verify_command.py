"""`preshape verify --before a.csv --after b.csv`, and `preshape verify --recipe klipper ...`"""

from __future__ import annotations

import json
from pathlib import Path

import click

from preshape.errors import InputError

__all__ = ["command"]


@click.command("verify")
@click.option("--before", multiple=True, metavar="FILE", help="A recording without the shaper; once for each repeat.")
@click.option("--after", multiple=True, metavar="FILE", help="A recording with the shaper; once for each repeat.")
@click.option("--shaper", metavar="SHAPER.json", help="What the machine was told to execute: for the prediction.")
@click.option("--stop", metavar="S[:S]", help="When the move stops [s], or before:after.  [default: found]")
@click.option("--lasting", type=float, metavar="S", help="How long the unshaped move takes [s]: see the recipe.")
@click.option("--window", type=float, metavar="S", help="Time after the stop for the root mean square [s].")
@click.option("--below", type=float, metavar="HZ", help="Frequency up to which it is taken.")
@click.option("--figure", type=click.Path(path_type=Path), metavar="FILE", help="Draw it: .svg, .png or .pdf.")
@click.option("--json", "json_file", metavar="FILE|-", help="Write all numbers; - for standard output, nothing else.")
@click.option("--recipe", "target", metavar="klipper|rrf|csv", help="Write the moves to run on the machine instead.")
@click.option("--axis", default="x", show_default=True, metavar="x|y|z", help="Of the recipe.")
@click.option("--distance", type=float, metavar="MM", help="Of the recipe's move [mm].")
@click.option("--speed", type=float, metavar="V", help="[mm/s]")
@click.option("--acceleration", type=float, metavar="A", help="[mm/s²]")
@click.option("--repeats", type=int, default=3, show_default=True, metavar="N", help="Recordings of each kind.")
@click.option("--out", type=click.Path(path_type=Path), metavar="FILE", help="For the recipe; else it is printed.")
def command(
    before: tuple[str, ...],
    after: tuple[str, ...],
    shaper: str | None,
    stop: str | None,
    lasting: float | None,
    window: float | None,
    below: float | None,
    figure: Path | None,
    json_file: str | None,
    target: str | None,
    axis: str,
    distance: float | None,
    speed: float | None,
    acceleration: float | None,
    repeats: int,
    out: Path | None,
) -> None:
    """Did the shaper do on the machine what was predicted?

    \b
    preshape verify --recipe klipper --axis x --distance 100 --speed 200 --acceleration 5000
    preshape verify --before before.csv --after after.csv --shaper shaper.json --figure verify.svg
    """
    from preshape.cli.screens import console
    from preshape.files import write_atomically
    from preshape.report import figure_bytes, figure_format, verification_figure
    from preshape.shaper import Shaper
    from preshape.workflow import recipe, verify

    told = None if shaper is None else Shaper.load(shaper)
    if target is not None:
        if before or after:
            raise InputError(
                "--recipe writes what to run, --before and --after compare what was recorded: give either."
            )
        if distance is None or speed is None or acceleration is None:
            raise InputError("a recipe needs --distance, --speed and --acceleration.")
        text = recipe(
            target, axis=axis, distance=distance, speed=speed, acceleration=acceleration, shaper=told, repeats=repeats
        )
        click.echo(text, nl=False) if out is None else click.echo(f"Recipe: {write_atomically(out, text)}")
        return
    if not before or not after:
        raise InputError("give a recording without the shaper, --before, and one with it, --after; or --recipe.")
    kind = None if figure is None else figure_format(figure)
    progress = console(stderr=True)
    with progress.status("reading, finding the stop and the modes ..."):
        verification = verify(before, after, shaper=told, stop=_stop(stop), lasting=lasting, window=window, below=below)
    written = []
    if figure is not None and kind is not None:
        with progress.status("drawing ..."):
            written.append(f"Figure: {write_atomically(figure, figure_bytes(verification_figure(verification), kind))}")
    text = json.dumps(verification.to_dict(), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    if json_file == "-":
        click.echo(text, nl=False)
        return
    if json_file is not None:
        written.append(f"Numbers: {write_atomically(json_file, text)}")
    from preshape.cli.verification_screen import verification_screen

    verification_screen(verification)
    for line in written:
        click.echo(line)


def _stop(text: str | None) -> float | tuple[float, float] | None:
    if text is None:
        return None
    try:
        numbers = [float(part) for part in text.split(":")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2):
        raise InputError(f"--stop {text!r} is no time: write 0.61, or 0.61:0.66 for before and after.")
    return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])
