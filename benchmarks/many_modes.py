"""Time to design and prove over the number of modes; with `--write` it is kept for the documentation's figure."""

from __future__ import annotations

import json
import sys
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from peers import interior_point_bisection
from timing import once

from preshape import Modes, design

FAMILIES = ("evenly spaced", "log-spaced", "random")
COUNTS = (1, 2, 3, 4, 6, 8, 10, 14, 20, 28, 40)
REACH = {10: 0.08, 20: 0.4, 40: 4.0}
"""What is claimed [s]."""

PEER_COUNTS = (5, 10)
DAMPING = 0.01
OUT = Path(__file__).resolve().parent.parent / "docs" / "figures" / "growth.json"

GIVEN_UP = 30.0
"""A family is not continued beyond a set that took longer than this [s]."""


def modes_of(family: str, count: int) -> Modes:
    """`count` modes from 1 to 20 Hz."""
    if count == 1:
        return Modes([(1.0, DAMPING)])
    frequencies: NDArray[np.float64] = {
        "evenly spaced": np.linspace(1.0, 20.0, count),
        "log-spaced": np.geomspace(1.0, 20.0, count),
        "random": np.sort(np.random.default_rng(count).uniform(1.0, 20.0, count)),
    }[family]
    return Modes([(float(frequency), DAMPING) for frequency in frequencies])


def measured(modes: Modes) -> dict[str, Any]:
    """One design, the best of three where that does not take long."""
    shaper, seconds = once(lambda: design.direct(modes))
    for _ in range(0 if seconds > 2.0 else 2 if seconds > 0.1 else 6):
        seconds = min(seconds, once(lambda: design.direct(modes))[1])
    made = shaper.design
    gap = float(made.settings.get("gap", 0.0))
    return {
        "modes": len(modes),
        "seconds": float(f"{seconds:.3g}"),
        "status": made.status,
        "impulses": len(shaper),
        "duration": round(shaper.duration, 9),
        "gap": round(gap, 4),
    }


def main() -> None:
    """One line a set; order 1, cold, with certificate."""
    found: dict[str, list[dict[str, Any]]] = {}
    design.direct([(1.0, 0.0), (10.0, 0.0)])  # imports what it needs
    for family in FAMILIES:
        found[family] = []
        for count in COUNTS:
            one = measured(modes_of(family, count))
            found[family].append(one)
            reach = f" (claim: {REACH[count]:g} s)" if count in REACH else ""
            gap = f", gap {100.0 * one['gap']:.0f} %" if one["status"] == "feasible" else ""
            print(
                f"{family}, {count} modes: {one['seconds']:.4f} s{reach}, {one['impulses']} impulses, "
                f"{one['status']}{gap}",
                flush=True,
            )
            if one["seconds"] > GIVEN_UP:
                break
    found["peer"] = []
    for count in PEER_COUNTS:
        modes = modes_of("log-spaced", count)
        ours = measured(modes)
        duration, seconds = once(partial(interior_point_bisection, modes))
        found["peer"].append({"modes": count, "seconds": float(f"{seconds:.3g}"), "duration": round(duration, 9)})
        print(
            f"log-spaced, {count} modes: {ours['seconds']:.4f} s, {ours['duration']:.5f} s long; HiGHS interior-point "
            f"bisection to 1e-3: {seconds:.3f} s, {duration:.5f} s long; ratio {seconds / ours['seconds']:.0f}",
            flush=True,
        )
    if sys.argv[1:] == ["--write"]:
        lines = ",\n".join(
            f' "{name}": [\n' + ",\n".join(f"  {json.dumps(one)}" for one in rows) + "\n ]"
            for name, rows in found.items()
        )
        OUT.write_text("{\n" + lines + "\n}\n")


if __name__ == "__main__":
    main()
