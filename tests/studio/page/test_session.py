"""A session: the latest state wins, what cannot be changes nothing, and what takes too long is told."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any, ParamSpec, TypeVar

import pytest
from nicegui import background_tasks

from preshape.mode import Mode
from preshape.studio.page.measurements import Measurements
from preshape.studio.page.session import Session
from preshape.studio.page.shared import Shared
from preshape.studio.workers import Overdue
from preshape.workflow.workbench import AskedDesign, Workbench, from_text, view_of

P = ParamSpec("P")
T = TypeVar("T")

BENCH = Workbench((Mode(10.0, 0.02),), (AskedDesign("A", "ei"),))


class Computer:
    """Computes here, once the gate is open, and remembers what it was asked."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.gate = asyncio.Event()
        self.gate.set()
        self.failure: Exception | None = None

    async def run(self, seconds: float, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """What the function returns."""
        assert seconds > 0.0
        self.asked.append(function.__name__)
        await self.gate.wait()
        if self.failure is not None:
            raise self.failure
        return function(*args, **kwargs)


Play = Callable[[Session, Computer, list[dict[str, Any]]], Coroutine[Any, Any, None]]


def played(play: Play, bench: Workbench = BENCH) -> tuple[Session, Computer, list[dict[str, Any]]]:
    """A session that was opened, and then played with."""

    async def playing() -> tuple[Session, Computer, list[dict[str, Any]]]:
        computer = Computer()
        session = Session(bench, Shared(computer, Measurements(computer, 1000)))
        told: list[dict[str, Any]] = [session.first(view_of(bench))]
        session.say = told.append
        await play(session, computer, told)
        return session, computer, told

    return asyncio.run(playing())


@pytest.fixture(autouse=True)
def _tasks_of_this_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(background_tasks, "create", asyncio.ensure_future)


def test_of_many_edits_the_last_is_drawn_and_most_are_not() -> None:
    async def play(session: Session, computer: Computer, _: list[dict[str, Any]]) -> None:
        computer.gate.clear()
        for tenth in range(1, 31):
            await session.edit("mode.0.frequency", f"{10 + tenth / 10:.1f}")
            await asyncio.sleep(0)
        computer.gate.set()
        await asyncio.sleep(0.2)

    session, computer, told = played(play)
    assert session.workbench.modes == (Mode(13.0, 0.02),)
    assert computer.asked.count("view_of") == 2
    last = [message for message in told if "link" in message][-1]
    assert from_text(last["link"]) == session.workbench
    assert last["handles"] == [13.0]
    assert session.view is not None
    assert session.view.workbench == session.workbench


def test_what_cannot_be_changes_nothing_and_is_told_at_its_field() -> None:
    async def play(session: Session, _: Computer, told: list[dict[str, Any]]) -> None:
        await session.edit("mode.0.frequency", "-1")
        await session.edit("design.A.option.tolerance", "-0.5")

    session, computer, told = played(play)
    assert session.workbench == BENCH
    assert "view_of" not in computer.asked
    assert {"mode.0.frequency", "design.A.option.tolerance"} <= told[-1]["errors"].keys()
    assert "charts" not in told[-1]


@pytest.mark.parametrize(
    ("failure", "said"),
    [
        (Overdue("this took longer than it may."), "This took longer than it may."),
        (RuntimeError("Traceback: zero-size array"), "This failed within preshape"),
    ],
)
def test_a_picture_that_does_not_come_is_told_and_the_state_is_kept(failure: Exception, said: str) -> None:
    async def play(session: Session, computer: Computer, _: list[dict[str, Any]]) -> None:
        computer.failure = failure
        await session.edit("mode.0.frequency", "12")
        await asyncio.sleep(0.1)

    session, _, told = played(play)
    assert told[-1]["status"].startswith(said)
    assert from_text(told[-1]["link"]).modes[0].frequency == 12.0
    assert session.view is not None
    assert session.view.workbench == BENCH


def test_a_drag_is_one_step_of_undo() -> None:
    async def play(session: Session, _: Computer, told: list[dict[str, Any]]) -> None:
        for frequency in ("11", "12", "13"):
            await session.edit("mode.0.frequency", frequency, "held")
        session.release()
        await session.edit("mode.0.frequency", "14", "held")
        session.release()
        session.step(back=True)
        assert session.workbench.modes[0].frequency == 13.0
        session.step(back=True)
        assert session.workbench == BENCH
        session.step(back=True)
        assert told[-1] == {"say": "Nothing to undo"}

    played(play)


@pytest.mark.parametrize("frequency", [0.013, 0.99, 1.0, 7.77, 47.3, 620.0, 9.99e4])
def test_axes_end_at_a_round_number_that_the_curves_reach(frequency: float) -> None:
    async def play(session: Session, _: Computer, told: list[dict[str, Any]]) -> None:
        end = told[0]["charts"]["sensitivity"]["option"]["xAxis"][0]["max"]
        assert session.view is not None
        assert frequency * 1.1 < end <= session.view.frequencies[-1] * (1.0 + 1e-12)
        assert end == float(f"{end:.2g}")

    played(play, Workbench((Mode(frequency, 0.02),)))
