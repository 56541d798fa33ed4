"""`preshape campaign FILE.toml [--scheduler ADDRESS]`"""

from __future__ import annotations

from pathlib import Path

import click

__all__ = ["command"]


@click.command("campaign")
@click.argument("file", metavar="FILE.toml", type=click.Path(path_type=Path))
@click.option(
    "--out", type=click.Path(path_type=Path), metavar="DIR", help="Folder of the results.  [default: campaign-FILE]"
)
@click.option("--workers", type=int, metavar="N", help="Processes on this machine; 0 for none.  [default: its cores]")
@click.option("--scheduler", metavar="ADDRESS", help="Of a Dask cluster instead, such as tcp://10.0.0.5:8786.")
@click.option(
    "--retries", type=int, default=0, show_default=True, metavar="N", help="How often failed points are tried again."
)
@click.pass_context
def command(
    context: click.Context, file: Path, out: Path | None, workers: int | None, scheduler: str | None, retries: int
) -> None:
    """Compute thousands of designs or simulations: robustness, a design map, a shaper table.

    What is done is kept, so that a run can be stopped at any time: the same command goes on, and tries again what
    failed. The exit code is 0 when every point has its result, 1 when points failed.

    \b
    preshape campaign gantry-robustness.toml
    preshape campaign arm-schedule.toml --out arm --scheduler tcp://10.0.0.5:8786
    """
    from preshape.campaign import run_campaign
    from preshape.cli.campaign_screen import campaign_screen, point_bar

    folder = Path(f"campaign-{file.stem}") if out is None else out
    with point_bar() as progress:
        run = run_campaign(file, folder, workers=workers, scheduler=scheduler, retries=retries, progress=progress)
    campaign_screen(run)
    context.exit(1 if run.summary.failed else 0)
