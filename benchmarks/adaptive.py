"""Following four modes that move by 0.1 % a call: `Stream.track`, warm design and change, against the cold design."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from timing import once

from preshape import design
from preshape.kernel import active_kernel
from preshape.stream import Stream

MODES = [(1.65, 0.01), (5.42, 0.01), (6.90, 0.01), (19.08, 0.01)]
"""Hyde's MACE, open loop."""

DT, CALLS, COLD = 0.001, 400, 20
STEP, SPREAD = 1e-3, 0.2

ModesAt = Callable[[int], list[tuple[float, float]]]


def together(k: int) -> list[tuple[float, float]]:
    """All by the same part, up and down again."""
    return [(f * (1.0 + STEP) ** min(k, CALLS - k), z) for f, z in MODES]


def apart(k: int) -> list[tuple[float, float]]:
    """Each to +-20 % and back in its own time, by 0.1 % a call at most."""
    swings = [math.sin(STEP / SPREAD * k * (1.0 - 0.15 * i)) for i in range(len(MODES))]
    return [(f * (1.0 + SPREAD * swing), z) for (f, z), swing in zip(MODES, swings, strict=True)]


def follow(what: str, modes_at: ModesAt, order: int) -> None:
    """Every call timed, the cold design at every twentieth; both must be proved and equally long."""
    stream = Stream(design.direct(modes_at(0), order), DT)
    stream.push(1.0)
    stream.retune(design.direct(modes_at(0), order))  # the first change fills the ring; later ones do not
    warm: list[float] = []
    searched: list[float] = []
    cold: list[float] = []
    for k in range(1, CALLS + 1):
        modes = modes_at(k)
        found, seconds = once(partial(stream.track, modes))
        assert found.changed and found.shaper.design.status == "optimal"
        (warm if found.start == "near" else searched).append(seconds)
        if k % (CALLS // COLD) == 0:
            again, longer = once(partial(design.direct, modes, order))
            assert abs(found.shaper.duration / again.duration - 1.0) < 1e-9
            cold.append(longer)
    median, slow, longer = (1e3 * float(value) for value in (np.median(warm), np.quantile(warm, 0.99), np.median(cold)))
    rest = f"the others up to {1e3 * max(searched):.0f} ms" if searched else "no search"
    print(
        f"order {order}, {what}: median {median:.2f} ms, 99 % below {slow:.2f} ms; cold design {longer:.1f} ms; ratio "
        f"{longer / median:.1f}; {100.0 * len(warm) / CALLS:.1f} % warm, {rest} (under 1 ms)",
        flush=True,
    )


def main() -> None:
    """Modes that move together, as with a payload; modes that move apart, as with a pose."""
    print(f"kernel: {active_kernel()}")
    for order in (0, 1, 2):
        follow("all moved together", together, order)
        follow("each on its own", apart, order)


if __name__ == "__main__":
    main()
