"""Can `preshape verify` be believed? Fresh random machines; stops found, counted from the beginning, or given.

No timed claim: each row is a count against the truth, which the simulation knows. The peer is the stop given exactly.
A stop is off by the worse of the two recordings. `--seed S --pairs N --noise X`.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any

import timing  # noqa: F401  (linear algebra on one thread)

from preshape.errors import InputError
from preshape.report import DOUBTFUL, LESS, MORE
from preshape.workflow import verify

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))
machines = importlib.import_module("tests.workflow.random_machines")


def option(name: str, default: float) -> float:
    """A number from the command line."""
    return float(sys.argv[sys.argv.index(name) + 1]) if name in sys.argv else default


def study(kind: str, noise: float, seed: int, pairs: int, obeys: bool) -> str:
    """One row."""
    held = judged = false = wrong = outside = failed = 0
    for number in range(pairs):
        pair = machines.draw(seed, number, noise, obeys=obeys)
        known: dict[str, Any] = {"given": {"stop": pair.stops}, "lasting": {"lasting": pair.lasting}}.get(kind, {})
        try:
            result = verify(pair.before, pair.after, shaper=pair.told, **known)
        except InputError:
            failed += 1
            continue
        off = max(abs(result.unshaped[0].stop - pair.stops[0]), abs(result.shaped[0].stop - pair.stops[1]))
        wrong += off > 1e-3
        outside += off > 2.0 * max(result.unshaped[0].stop_spread, result.shaped[0].stop_spread)
        for one in result.modes:
            mode = pair.nearest(one.mode.mode.frequency)
            if one.new or mode is None or one.verdict == DOUBTFUL:
                continue
            judged += 1
            held += one.ratio.low <= pair.truth(mode) <= one.ratio.high
            false += one.verdict in (LESS, MORE)
    verdicts = f"; less or more than predicted {false}" if obeys else ""
    return (
        f"{kind:8} noise {noise:.3g} {'obeys' if obeys else 'other shaper':12} pairs {pairs} ({failed} refused): "
        f"stop off by over 1 ms in {wrong}, by over two stated "
        f"standard deviations in {outside}; intervals hold {held} of {judged}{verdicts}"
    )


def main() -> None:
    """The table."""
    pairs, seed = int(option("--pairs", 100)), int(option("--seed", 2))
    for noise in [option("--noise", 0.0)] if "--noise" in sys.argv else [0.003, 0.01, 0.03]:
        for kind, obeys in (("given", True), ("found", True), ("lasting", True), ("found", False)):
            print(study(kind, noise, seed, pairs, obeys), flush=True)


if __name__ == "__main__":
    main()
