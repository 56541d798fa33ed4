"""Fifty people at once in the studio: answer times of its page and its API, processes against threads.

Each client opens the page, then drags one of four modes: thinks for a while (exponentially distributed, two seconds in
the middle of work), sends the workbench, waits for the view. Every request has modes that were not seen before, so
nothing is remembered. The peer is the same server with the jobs in threads of its own process.

Clients and server share the computer's cores. Answer times are those of the clock, so run it alone.
"""

from __future__ import annotations

import asyncio
import random
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

import httpx

CLIENTS, SECONDS, THINKING, RAMP = 50, 30.0, 2.0, 5.0
"""How many, for how long [s], with what mean pause [s], all there after so long [s]."""

FAMILIES = ("direct", "zvd", "ei", "mzv")

T = TypeVar("T")


def main() -> None:
    """Both servers, one after the other."""
    for kind in ("processes", "threads"):
        server = subprocess.Popen([sys.executable, __file__, kind], stdout=subprocess.PIPE, text=True)
        try:
            assert server.stdout is not None
            address = server.stdout.readline().strip()
            pages, views, problems = asyncio.run(_crowd(address))
        finally:
            server.terminate()
            server.wait()
        page = f"page p50 {_percentile(pages, 50):.0f} ms, p99 {_percentile(pages, 99):.0f} ms" if pages else "no page"
        print(
            f"{CLIENTS} clients, {kind}: {len(views)} views, p50 {_percentile(views, 50):.0f} ms, p99 "
            f"{_percentile(views, 99):.0f} ms, worst {max(views):.0f} ms; {page}; {problems} refused (claim: p99 under "
            "500 ms, processes)",
            flush=True,
        )


async def _crowd(address: str) -> tuple[list[float], list[float], int]:
    """Answer times of pages and views [ms], and how many requests failed."""
    pages: list[float] = []
    views: list[float] = []
    problems = 0
    limits = httpx.Limits(max_connections=2 * CLIENTS, max_keepalive_connections=2 * CLIENTS)
    async with httpx.AsyncClient(base_url=address, timeout=60.0, limits=limits) as client:
        for _ in range(8):  # the workers have loaded
            await client.post("/api/view", json=_workbench(random.Random(0), "direct"))

        async def person(number: int) -> None:
            nonlocal problems
            rng = random.Random(number)
            await asyncio.sleep(rng.uniform(0.0, RAMP))
            ended = time.perf_counter() + SECONDS
            answer, took = await _timed(client.get("/"))
            if answer.status_code == 200:  # the API can be served without the page
                pages.append(took)
            family = FAMILIES[number % len(FAMILIES)]
            while time.perf_counter() < ended:
                await asyncio.sleep(rng.expovariate(1.0 / THINKING))
                answer, took = await _timed(client.post("/api/view", json=_workbench(rng, family)))
                views.append(took)
                problems += answer.status_code != 200

        await asyncio.gather(*(person(number) for number in range(CLIENTS)))
    return pages, views, problems


def _workbench(rng: random.Random, family: str) -> dict[str, Any]:
    modes = [(9.8, 0.02), (17.0, 0.01), (31.7, 0.015), (52.0, 0.03)]
    moved = [[frequency * rng.uniform(0.95, 1.05), damping] for frequency, damping in modes]
    return {"modes": moved, "designs": [{"name": "A", "family": family}]}


async def _timed(waiting: Any) -> tuple[httpx.Response, float]:
    start = time.perf_counter()
    answer: httpx.Response = await waiting
    return answer, 1e3 * (time.perf_counter() - start)


def _percentile(times: list[float], percent: int) -> float:
    return statistics.quantiles(times, n=100, method="inclusive")[percent - 1]


def serve(kind: str) -> None:
    """The server under test; prints its address when it answers."""
    from preshape.studio.guard import Rules
    from preshape.studio.server import Studio, create_app, free_socket
    from preshape.studio.server import serve as serve_app
    from preshape.studio.workers import Workers

    class Threads(Workers):
        """The same jobs in threads of this process."""

        def start(self) -> None:
            self._pool = ThreadPoolExecutor(self.count)

        def stop(self) -> None:
            self._pool.shutdown(wait=False)

        async def run(self, seconds: float, function: Callable[..., T], *args: Any, **kwargs: Any) -> T:
            loop = asyncio.get_running_loop()
            return await loop.run_in_executor(self._pool, lambda: function(*args, **kwargs))

    app = create_app(Studio(Workers() if kind == "processes" else Threads()), Rules())
    with free_socket("127.0.0.1", 0) as listening:
        port = listening.getsockname()[1]
        serve_app(app, listening, lambda: print(f"http://127.0.0.1:{port}", flush=True))


if __name__ == "__main__":
    main() if len(sys.argv) == 1 else serve(sys.argv[1])
