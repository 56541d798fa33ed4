"""Time to design and prove, over the number of modes; `make figures` draws what this writes to docs/figures."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from timing import once

from preshape import design

COUNTS = (1, 2, 3, 4, 6, 8, 10, 14, 20, 28, 40)
REACH = {10: 0.08, 20: 0.4, 40: 4.0}
OUT = Path(__file__).resolve().parent.parent / "docs" / "figures" / "growth.json"
GIVEN_UP = 20.0
"""A family is not continued beyond a set that took longer than this [s]."""


def frequencies(kind: str, count: int) -> NDArray[np.float64]:
    """1 to 20 Hz, in one of three ways."""
    if kind == "evenly spaced":
        return np.linspace(1.0, 20.0, count) if count > 1 else np.ones(1)
    if kind == "log-spaced":
        return np.geomspace(1.0, 20.0, count) if count > 1 else np.ones(1)
    return np.sort(np.random.default_rng(count).uniform(1.0, 20.0, count))


def main() -> None:
    """One row a set; damping 0.01, order 1, cold, with certificate."""
    found: dict[str, list[dict[str, object]]] = {}
    design.direct([(1.0, 0.0), (10.0, 0.0)])
    for kind in ("evenly spaced", "log-spaced", "random"):
        rows: list[dict[str, object]] = []
        for count in COUNTS:
            modes = [(float(f), 0.01) for f in frequencies(kind, count)]
            shaper, seconds = once(lambda modes=modes: design.direct(modes))  # type: ignore[misc]
            for _ in range(0 if seconds > 1.0 else 3):
                seconds = min(seconds, once(lambda modes=modes: design.direct(modes))[1])  # type: ignore[misc]
            status = shaper.design.status
            rows.append({"modes": count, "seconds": seconds, "status": status, "impulses": len(shaper)})
            reach = f" (reach {REACH[count]:g} s)" if count in REACH else ""
            gap = f", gap {100.0 * shaper.design.settings['gap']:.0f} %" if status == "feasible" else ""
            print(f"{kind}, {count} modes: {seconds:.4f} s{reach}, {len(shaper)} impulses, {status}{gap}", flush=True)
            if seconds > GIVEN_UP:
                break
        found[kind] = rows
    OUT.parent.mkdir(exist_ok=True)
    OUT.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
