"""Best of several runs, one run, and one row of output; importing this leaves linear algebra one thread.

The matrices here are small: with several threads OpenBLAS is slower, and its times depend on what else the machine
does. It reads its setting when NumPy is first imported, so a script that was started without it is started again.
Times are processor time of that one thread: what a clock shows when nothing else runs, and nearly that when it does.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from typing import TypeVar

__all__ = ["best_of", "once", "row"]

if os.environ.get("OPENBLAS_NUM_THREADS") != "1":
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    os.execv(sys.executable, sys.orig_argv)

T = TypeVar("T")


def best_of(function: Callable[[], object], runs: int = 7, at_least: float = 0.05) -> float:
    """Seconds a call: the best of `runs` batches that each take `at_least` seconds."""
    function()
    start = time.process_time()
    function()
    count = max(1, int(at_least / max(time.process_time() - start, 1e-9)))
    best = float("inf")
    for _ in range(runs):
        start = time.process_time()
        for _ in range(count):
            function()
        best = min(best, (time.process_time() - start) / count)
    return best


def once(function: Callable[[], T]) -> tuple[T, float]:
    """What a call returns, and the seconds it took: for what takes long, or is wanted too."""
    start = time.process_time()
    value = function()
    return value, time.process_time() - start


def row(what: str, ours: float, peer: str, theirs: float, claim: str) -> None:
    """Print one comparison; times in milliseconds."""
    print(
        f"{what}: {1e3 * ours:.3f} ms; {peer}: {1e3 * theirs:.3f} ms; ratio {theirs / ours:.1f} ({claim})", flush=True
    )
