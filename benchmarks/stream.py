"""Streams: a block against memory, NumPy and SciPy, one sample against a ring in Python, a change of the shaper."""

from __future__ import annotations

import timeit
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.signal import oaconvolve
from timing import best_of, row

from preshape import Shaper, design
from preshape.kernel import active_kernel
from preshape.stream import Stream

SAMPLES = 10_000_000
LONGEST = 2000
DT = 0.001


def shaper_of(impulses: int) -> Shaper:
    """Impulses on the grid, unevenly over 2000 samples: as many taps as impulses."""
    random = np.random.default_rng(impulses)
    delays = np.unique(
        np.concatenate([[0, LONGEST], random.choice(np.arange(1, LONGEST), impulses - 2, replace=False)])
    )
    return Shaper.normalised(delays * DT, random.uniform(0.5, 1.5, impulses))


def slices(
    command: NDArray[np.float64], delays: NDArray[np.intp], weights: NDArray[np.float64], out: NDArray[np.float64]
) -> None:
    """One pass an impulse, as anybody would write it."""
    out[:] = 0.0
    for delay, weight in zip(delays.tolist(), weights.tolist(), strict=True):
        out[delay:] += weight * command[: command.size - delay]


def blocks() -> None:
    """9 and 27 impulses over 10^7 samples, the result into an array that is there."""
    command = np.cumsum(np.random.default_rng(0).normal(size=SAMPLES)) * DT
    out = np.empty_like(command)
    for impulses, of_memory, of_slices in ((9, 3, 6), (27, 6, 10)):
        shaper = shaper_of(impulses)
        delays, weights = shaper.taps(DT)
        assert delays.size == impulses
        stream, kernel = Stream(shaper, DT), np.zeros(LONGEST + 1)
        kernel[delays] = weights
        stream.push_block(command, out=out)
        assert np.abs(out - oaconvolve(command, kernel)[:SAMPLES]).max() < 1e-9
        ours = best_of(partial(stream.push_block, command, out=out))
        what = f"{impulses} impulses, 1e7 samples"
        copied = best_of(lambda: np.copyto(out, command))
        row(what, ours, "memcpy", copied, f"at least 1/{of_memory}, which is {1 / of_memory:.2f}")
        sliced = best_of(partial(slices, command, delays, weights, out), runs=2)
        row(what, ours, "NumPy slices", sliced, f"{of_slices} x faster")
        folded = best_of(partial(oaconvolve, command, kernel), runs=2)
        row(what, ours, "scipy.signal.oaconvolve", folded, "3 x faster with 9")


def ring(delays: list[int], weights: list[float]) -> Callable[[float], float]:
    """What anybody would write in Python."""
    past, taps, at = [0.0] * (delays[-1] + 1), list(zip(delays, weights, strict=True)), 0

    def push(sample: float) -> float:
        nonlocal at
        past[at] = sample
        total = 0.0
        for delay, weight in taps:
            total += weight * past[at - delay]
        at = (at + 1) % len(past)
        return total

    return push


def per_call(function: Callable[[float], object], calls: int = 200_000) -> float:
    """Seconds a call, the loop included."""
    return min(timeit.repeat("f(1.5)", globals={"f": function}, number=calls, repeat=7)) / calls


def per_sample(function: Callable[[float], object]) -> float:
    """Seconds a call with another sample each time: one that stays is cheaper once a stream scatters."""
    command = np.random.default_rng(1).normal(size=200_000).tolist()
    run = "for u in command: f(u)"
    return min(timeit.repeat(run, globals={"f": function, "command": command}, number=1, repeat=7)) / len(command)


def samples() -> None:
    """One sample at a time, nanoseconds; `push = stream.push` before the loop, as one does."""
    empty = per_call(lambda sample: sample)
    for impulses in (9, 27):
        shaper = shaper_of(impulses)
        delays, weights = shaper.taps(DT)
        stream = Stream(shaper, DT)
        ours, theirs = per_call(stream.push), per_call(ring(delays.tolist(), weights.tolist()), 20_000)
        attribute = min(timeit.repeat("s.push(1.5)", globals={"s": stream}, number=200_000, repeat=7)) / 200_000
        print(
            f"{impulses} impulses, one sample: {1e9 * ours:.0f} ns ({1e9 * attribute:.0f} as stream.push(u)); ring in "
            f"Python: {1e9 * theirs:.0f} ns; ratio {theirs / ours:.0f} (under 60 ns, 20 x faster; an empty function: "
            f"{1e9 * empty:.0f} ns)",
            flush=True,
        )


def changes() -> None:
    """A retune of four modes, the design included: warm, the modes moved by a per cent."""
    modes = [(1.65, 0.01), (5.42, 0.01), (6.90, 0.01), (19.08, 0.01)]
    shaper = design.direct(modes)
    moved = [(frequency * 1.01, damping) for frequency, damping in modes]
    stream = Stream(shaper, DT)
    stream.retune(shaper)
    only = best_of(lambda: stream.retune(shaper))
    with_design = best_of(lambda: stream.retune(design.direct(moved, near=shaper)))
    scattered = per_sample(stream.push)
    print(
        f"retune of four modes: {1e3 * with_design:.3f} ms with the warm design, {1e6 * only:.0f} us without; one "
        f"sample after it, {len(shaper.taps(DT)[0])} taps: {1e9 * scattered:.0f} ns (under 1 ms)",
        flush=True,
    )


def main() -> None:
    """All of it."""
    print(f"kernel: {active_kernel()}")
    blocks()
    samples()
    changes()


if __name__ == "__main__":
    main()
