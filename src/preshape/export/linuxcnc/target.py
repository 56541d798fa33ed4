"""LinuxCNC: a HAL component for one joint, for version 2.9 and for what comes after it.

Master calls pins real and bool where 2.9 says float and bit, and sets them by out_set(x) where 2.9 assigns. The
template is written for master; :func:`_for_2_9` turns it back.
"""

from __future__ import annotations

import re
from importlib.metadata import version

from preshape.export.arithmetic import as_kernel
from preshape.export.c_source import delay_rows, filled, modes_left, taps_of_source, title, weight_rows
from preshape.export.read_back import only_text
from preshape.export.target import Files, Limits, Placed, Taps, Target

__all__ = ["LINUXCNC"]

LONGEST = (1 << 13) - 1
"""Samples; the ring, 64 kB then, lies in HAL's shared memory, which is a megabyte for everything."""

MOST_TAPS = 1 << 12

PERIOD_TOLERANCE = 1e-3
"""How far the thread's period may be from the shaper's, relative: what that detunes no shaper notices."""

TESTED = {
    "2.9": "preshape's tests build it with halcompile 2.9, run it in halrun, and compare every bit with Python.",
    "master": (
        "preshape's tests run its C part behind a stand-in for halcompile's macros; LinuxCNC's own master did not "
        "build it yet."
    ),
}


def _render(placed: Placed) -> Files:
    centroid = placed.shaper.centroid
    master = filled(
        "preshape.export.linuxcnc",
        "component.comp.in",
        name=placed.name,
        title=title(placed),
        modes="\n".join(modes_left(placed)),
        version=placed.version,
        tested=TESTED[placed.version],
        preshape=version("preshape"),
        taps=placed.delays.size,
        latency=placed.latency_samples,
        milliseconds=f"{1e3 * placed.latency:.6g}",
        centroid=f"{1e3 * centroid:.4g}",
        lag=f"{centroid:.4g}",
        period=f"{placed.dt:.9g}",
        nanoseconds=f"{1e9 * placed.dt:.0f}",
        percent=f"{100.0 * PERIOD_TOLERANCE:g}",
        tolerance=PERIOD_TOLERANCE,
        sample_time=placed.dt.hex(),
        ring=placed.ring,
        mask=placed.ring - 1,
        delays=delay_rows(placed),
        weights=weight_rows(placed),
        real="real" if placed.version == "master" else "float",
        bit="bool" if placed.version == "master" else "bit",
    )
    return {f"{placed.name}.comp": master if placed.version == "master" else _for_2_9(master)}


def _for_2_9(text: str) -> str:
    """Pins assigned instead of set."""
    return re.sub(r"\b(\w+)_set\((.*)\);", r"\1 = \2;", text)


def _parse(files: Files) -> Taps:
    return taps_of_source(only_text(files, ".comp"), "double")


def _next_step(placed: Placed) -> tuple[str, ...]:
    return (
        f"Install it:  sudo halcompile --install {placed.name}.comp",
        "The file begins with the lines for your HAL file; its notes say what following error and homing see.",
    )


LINUXCNC = Target(
    "linuxcnc",
    "HAL component for a joint, between its command and the drive",
    ("2.9", "master"),
    Limits(taps=MOST_TAPS, samples=LONGEST),
    _render,
    _parse,
    as_kernel,
    _next_step,
)
