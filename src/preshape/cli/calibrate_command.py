"""`preshape calibrate FILE...`"""

from __future__ import annotations

from pathlib import Path

import click

from preshape.cli.options import sample_rate_option, tolerance_option, typed

__all__ = ["command"]


@click.command("calibrate")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option(
    "--max-impulses",
    "maximum_impulses",
    type=click.IntRange(min=2),
    metavar="N",
    help="Most impulses the controller holds.",
)
@tolerance_option("Part of the measured vibration that may remain.", 0.05)
@click.option(
    "--damping",
    type=float,
    metavar="Z",
    help="Damping ratio of the modes, if you know it better than the file shows it.",
)
@sample_rate_option()
@click.option("--part", metavar="NAME", help="Which measurement, or how its name begins, in files that hold several.")
@click.option("--input", "excitation", metavar="COLUMN", help="Which column holds the input, if the file has it.")
@click.option("--axis", type=click.Choice(["x", "y", "z"]), help="That the settings are for.  [default: x and y alike]")
@click.option("--mixed", is_flag=True, help="The files are of several axes or machines on purpose.")
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="DIR",
    help="Folder for the shapers, the figures, the report and the settings of each firmware.",
)
@click.option(
    "--pdf/--no-pdf", default=None, help="Write report.pdf too.  [default: where Typst is installed: preshape[pdf]]"
)
@click.pass_context
def command(
    context: click.Context,
    files: tuple[str, ...],
    maximum_impulses: int | None,
    tolerance: float,
    damping: float | None,
    sample_rate: float | None,
    part: str | None,
    excitation: str | None,
    axis: str | None,
    mixed: bool,
    out: Path | None,
    pdf: bool | None,
) -> None:
    """From vibration measurements of one axis to a shaper: modes, candidates, choice and reason.

    FILE is a Klipper raw_data, resonances or calibration_data file, a Shake&Tune .stdata, a RepRapFirmware capture, a
    Prusa M958 report, a universal file, NumPy, MATLAB, WAV, or a CSV table with a time column; several files of one
    axis are served by one shaper.
    """
    from preshape.cli.screens import calibration_screen, console
    from preshape.cli.settings_screen import settings_screen
    from preshape.workflow import calibrate, save_calibration

    progress = console(stderr=True)
    with progress.status("reading, finding the modes, designing ..."):
        calibration = calibrate(
            files,
            maximum_impulses=maximum_impulses,
            tolerance=tolerance,
            damping=damping,
            sample_rate=sample_rate,
            part=part,
            excitation=excitation,
            mixed=mixed,
            axis=axis,
        )
    calibration_screen(calibration)
    if out is None:
        settings_screen(calibration, None)
        click.echo("Nothing was written; --out DIR writes the shapers, the figures, the report and these settings.")
        return
    with progress.status("drawing the report ..."):
        saved = save_calibration(calibration, out, command_line=typed(context), pdf=pdf)
    settings_screen(calibration, saved)
    sheets = "" if saved.pdf is None else f"\nPDF: {saved.pdf}"
    click.echo(f"Report: {saved.report}{sheets}\nFigure: {saved.figure}\nShaper: {saved.shaper}")
    if saved.picks:
        click.echo(f"Picks:  {', '.join(str(path) for path in saved.picks)}")
