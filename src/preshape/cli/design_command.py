"""`preshape design --family ... --mode F[:Z] ...`"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from preshape import design
from preshape.band import Band
from preshape.cli.options import BandOption, mode_option, tolerance_option, typed
from preshape.design.families import OTHER_FAMILIES
from preshape.mode import Mode

__all__ = ["command"]


@click.command("design")
@click.option(
    "--family",
    type=click.Choice([*design.FAMILIES, *OTHER_FAMILIES]),
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
@click.option(
    "--report", type=click.Path(path_type=Path), metavar="FILE", help="Write a report: .html, or .pdf with Typst."
)
@click.pass_context
def command(
    context: click.Context,
    /,
    family: str,
    modes: tuple[Mode, ...],
    bands: tuple[Band, ...],
    json_file: str | None,
    report: Path | None,
    **wishes: Any,
) -> None:
    """Design a shaper for known modes, or for bands of frequencies.

    \b
    preshape design --family zvd --mode 47.3:0.05
    preshape design --family direct --mode 9.8 --mode 31.7:0.01 --json shaper.json
    preshape design --family ei --band 40:60 --tolerance 0.05
    preshape design --family si --band 0.9:1.1 --band 2.7:3.3:0.01:0.03 --tolerance 0.05
    """
    from preshape.cli.screens import shaper_screen
    from preshape.files import write_atomically
    from preshape.report import DesignJob, report_bytes, report_format
    from preshape.shaper_file import to_json
    from preshape.workflow import asked_design_report, designed

    job = DesignJob(
        family=family,
        modes=tuple((mode.frequency, mode.damping) for mode in modes),
        bands=tuple((band.low, band.high, band.least_damping, band.highest_damping) for band in bands),
        **wishes,
    )
    kind = None if report is None else report_format(report)
    shaper = designed(job)
    sheets = None if kind is None else report_bytes(asked_design_report(job, shaper, command_line=typed(context)), kind)
    if report is not None and sheets is not None:
        write_atomically(report, sheets)
    if json_file == "-":
        click.echo(to_json(shaper.to_dict()), nl=False)
        return
    saved = None if json_file is None else shaper.save(Path(json_file))
    shaper_screen(shaper)
    if saved is not None:
        click.echo(f"Shaper: {saved}")
    if report is not None:
        click.echo(f"Report: {report}")
