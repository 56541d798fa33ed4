"""`preshape gcode IN.gcode --shaper x=SHAPER.json --acceleration A --out OUT.gcode`"""

from __future__ import annotations

from pathlib import Path

import click

from preshape.errors import InputError

__all__ = ["command"]


@click.command("gcode")
@click.argument("program", type=click.Path(path_type=Path), metavar="IN.gcode")
@click.option("--shaper", "shapers", multiple=True, required=True, metavar="AXIS=FILE", help="Of x, y or z; repeat.")
@click.option("--acceleration", type=float, required=True, metavar="A", help="Of the planned moves [mm/s^2].")
@click.option("--out", type=click.Path(path_type=Path), required=True, metavar="OUT.gcode", help="Where it goes.")
@click.option(
    "--corner-speed", type=float, default=0.0, show_default=True, metavar="V",
    help="By how much the velocity may jump at a corner [mm/s]; 0 stops at each.",
)  # fmt: skip
@click.option("--rapid", type=float, metavar="V", help="Speed of G0 [mm/s]; the feed in force unless given.")
@click.option("--start", "starts", multiple=True, metavar="AXIS=MM", help="Where an axis stands at first; repeat.")
@click.option(
    "--tolerance", type=float, default=0.004, show_default=True, metavar="MM",
    help="How far the segments may leave the shaped motion.",
)  # fmt: skip
@click.option("--dt", type=float, default=0.0005, show_default=True, metavar="S", help="Sample time.")
@click.option("--shortest", type=float, default=0.002, show_default=True, metavar="S", help="The shortest segment.")
@click.option(
    "--dwell", type=click.Choice(["seconds", "milliseconds"]), default="seconds", show_default=True,
    help="What G4 P counts.",
)  # fmt: skip
def command(
    program: Path,
    shapers: tuple[str, ...],
    acceleration: float,
    out: Path,
    corner_speed: float,
    rapid: float | None,
    starts: tuple[str, ...],
    tolerance: float,
    dt: float,
    shortest: float,
    dwell: str,
) -> None:
    """Shape the moves of a G-code program for a controller without input shaping.

    \b
    preshape gcode part.gcode --shaper x=x.json --shaper y=y.json --acceleration 3000 --out shaped.gcode
    """
    from preshape.shaper import Shaper
    from preshape.workflow import shape_gcode

    done = shape_gcode(
        program,
        {axis: Shaper.load(path) for axis, path in _pairs("--shaper", shapers, "x=x.json").items()},
        out,
        acceleration=acceleration,
        corner_speed=corner_speed,
        rapid=rapid,
        start={axis: _number(place) for axis, place in _pairs("--start", starts, "x=0").items()},
        tolerance=tolerance,
        dt=dt,
        shortest=shortest,
        dwell=dwell,
    )
    click.echo(f"{done.path}: {done.lines_before} lines became {done.lines_after}; {done.moves} moves are shaped")
    if done.unshaped_moves:
        click.echo(
            f"{done.unshaped_moves} moves are not: they begin where the program does not say (see --start), or move "
            "the extruder alone"
        )
    click.echo(
        f"the moves took {done.duration_before:.3f} s and take {done.duration:.3f} s; late at constant speed: "
        f"{1e3 * done.delay:.4g} ms"
    )
    click.echo(
        f"segments leave the shaped motion by {done.deviation:.3g} mm at most; the shortest lasts "
        f"{1e3 * done.shortest:.3g} ms"
    )
    click.echo(f"the controller must make velocity steps of {done.speed_step:.3g} mm/s at once: see the how-to")


def _pairs(option: str, given: tuple[str, ...], example: str) -> dict[str, str]:
    """AXIS=VALUE, each axis once."""
    pairs: dict[str, str] = {}
    for text in given:
        name, equals, value = text.partition("=")
        if not (name and equals and value) or name.lower() in pairs:
            raise InputError(f"{option} {text} is not AXIS=VALUE, each axis once: write {option} {example}.")
        pairs[name.lower()] = value
    return pairs


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"--start has {text!r}, which is no number: write --start x=0.") from None
