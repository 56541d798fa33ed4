"""Workers: what is computed elsewhere comes back, what takes too long ends, and nobody waits for the dead."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from collections.abc import Iterator

import pytest

from preshape import design
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.studio.workers import Overdue, Workers
from preshape.workflow.workbench import AskedDesign, Workbench, view_of


def square(value: int) -> int:
    return value * value


def refuse() -> None:
    raise InputError("a sentence.")


def fail() -> None:
    raise ZeroDivisionError("ours")


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def who() -> tuple[int, str | None]:
    return os.getpid(), os.environ.get("OPENBLAS_NUM_THREADS")


@pytest.fixture(scope="module")
def workers() -> Iterator[Workers]:
    made = Workers(1)
    made.start()
    yield made
    made.stop()


def test_a_result_comes_back_and_linear_algebra_has_one_thread(workers: Workers) -> None:
    async def main() -> None:
        assert await asyncio.gather(*(workers.run(60.0, square, k) for k in range(20))) == [k * k for k in range(20)]
        process, threads = await workers.run(60.0, who)
        assert process != os.getpid() and threads == "1"

    asyncio.run(main())


def test_a_view_comes_back_whole(workers: Workers) -> None:
    bench = Workbench((Mode(10.0, 0.02),), (AskedDesign("A", "direct"),))
    there = asyncio.run(workers.run(60.0, view_of, bench))
    here = view_of(bench)
    assert there.designs[0].drawn is not None and here.designs[0].drawn is not None
    assert there.designs[0].drawn.shaper == here.designs[0].drawn.shaper == design.direct((10.0, 0.02))
    assert there.designs[0].drawn.shaper.design == here.designs[0].drawn.shaper.design


def test_a_refusal_stays_one_and_a_fault_stays_a_fault(workers: Workers) -> None:
    with pytest.raises(InputError, match=r"^a sentence\.$"):
        asyncio.run(workers.run(60.0, refuse))
    with pytest.raises(RuntimeError, match="ZeroDivisionError: ours"):
        asyncio.run(workers.run(60.0, fail))


def test_what_takes_too_long_is_ended_and_the_next_is_served(workers: Workers) -> None:
    before = asyncio.run(workers.run(60.0, who))[0]
    with pytest.raises(Overdue, match="longer than 0.2 s"):
        asyncio.run(workers.run(0.2, time.sleep, 600.0))
    after = asyncio.run(workers.run(60.0, who))[0]
    assert before != after
    with pytest.raises(ProcessLookupError):
        os.kill(before, 0)


def test_a_process_that_dies_is_replaced(workers: Workers) -> None:
    with pytest.raises(Overdue, match="more than the computer could hold"):
        asyncio.run(workers.run(60.0, die))
    assert asyncio.run(workers.run(60.0, square, 7)) == 49


def test_too_many_at_once_are_sent_away(workers: Workers, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("preshape.studio.workers.MOST_WAITING", 2)

    async def main() -> None:
        jobs = [asyncio.ensure_future(workers.run(60.0, square, k)) for k in range(3)]
        await asyncio.sleep(0)
        with pytest.raises(Overdue, match="too many"):
            await workers.run(60.0, square, 9)
        assert await asyncio.gather(*jobs) == [0, 1, 4]

    asyncio.run(main())
