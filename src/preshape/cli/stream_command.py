"""`preshape stream SHAPER.json --rate HZ < command > shaped`"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import click

__all__ = ["command"]

EVERY = 0.5
"""Seconds between two lines of throughput."""


@click.command("stream")
@click.argument("shaper", type=click.Path(path_type=Path), metavar="SHAPER.json")
@click.option("--rate", type=float, required=True, metavar="HZ", help="Samples per second.")
@click.option("--raw", is_flag=True, help="Little-endian float64 instead of lines of numbers.")
@click.option("--axes", type=int, metavar="N", help="Numbers a sample.  [default: raw 1, text as the first line has]")
@click.option("--unbuffered", is_flag=True, help="Write each sample before the next one is read.")
@click.option("--rest", is_flag=True, help="At the end write also what is still on its way.")
@click.option(
    "--not-finite",
    type=click.Choice(["refuse", "pass"]),
    default="refuse",
    show_default=True,
    help="Stop at NaN and infinity, or let them through.",
)
def command(
    shaper: Path, rate: float, raw: bool, axes: int | None, unbuffered: bool, rest: bool, not_finite: str
) -> None:
    """Shape standard input into standard output, as it comes: one sample a line, or raw.

    \b
    preshape stream shaper.json --rate 1000 < command.csv > shaped.csv
    trajectory | preshape stream shaper.json --rate 1000 --raw --unbuffered | drive
    """
    from preshape.shaper import Shaper
    from preshape.workflow import stream_pipe

    shown = _Throughput() if sys.stderr.isatty() else None
    try:
        done = stream_pipe(
            Shaper.load(shaper),
            sys.stdin.buffer,
            sys.stdout.buffer,
            rate=rate,
            raw=raw,
            axes=axes,
            unbuffered=unbuffered,
            not_finite=not_finite,
            rest=rest,
            progress=None if shown is None else shown.update,
        )
    except BrokenPipeError:  # whoever reads has gone: nothing is left to say, nor to write at the exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return
    if shown is not None:
        shown.update(done.samples, last=True)


class _Throughput:
    """A line on the terminal that is written anew."""

    def __init__(self) -> None:
        self._start = self._told = time.monotonic()

    def update(self, samples: int, last: bool = False) -> None:
        """Show how many samples have gone through, and how many a second."""
        now = time.monotonic()
        if last or now - self._told >= EVERY:
            self._told = now
            speed = samples / max(now - self._start, 1e-9)
            click.echo(f"\r{samples} samples, {speed:.3g} a second", err=True, nl=last)
