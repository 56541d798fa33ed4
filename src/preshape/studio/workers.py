"""Processes that compute for the studio, so that its page answers while they do, each job for a limited time."""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import os
import queue
import traceback
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from multiprocessing.connection import Connection
from typing import Any, ParamSpec, TypeVar

from preshape.errors import InputError

__all__ = ["Overdue", "Workers"]

P = ParamSpec("P")
T = TypeVar("T")

MOST_WAITING = 200
"""Jobs that may wait; more are sent away at once."""

TO_LEAVE = 2.0
"""Time [s] that a process has to end by itself."""

TO_LOAD = 120.0
"""Time [s] that a process may take to begin, on a computer that is busy with other things."""

ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
"""The matrices here are small: with several threads linear algebra is slower, the more so with many clients."""


class Overdue(Exception):
    """A job took too long, was too large for the machine, or too many wait; a sentence to show."""


class Workers:
    """Some processes; each job runs in one that is free, and one that is overdue ends with its process.

    Parameters
    ----------
    count : int, optional
        How many; one a core, at most four, unless given.

    Examples
    --------
    ``await workers.run(20.0, view_of, workbench)``
    """

    def __init__(self, count: int | None = None) -> None:
        self.count = max(1, min(4, os.cpu_count() or 1)) if count is None else count
        # A thread a process: whoever has a thread finds a process free.
        self._threads = ThreadPoolExecutor(self.count, thread_name_prefix="preshape-worker")
        self._processes = [_Process() for _ in range(self.count)]
        self._free: queue.SimpleQueue[_Process] = queue.SimpleQueue()
        self._jobs = 0

    def start(self) -> None:
        """Start the processes; they load while the first page is drawn."""
        for process in self._processes:
            process.start()
            self._free.put(process)

    def stop(self) -> None:
        """End the processes, whatever they do."""
        self._threads.shutdown(wait=False, cancel_futures=True)
        for process in self._processes:
            process.end()

    async def run(self, seconds: float, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """What a function returns, computed in another process.

        Parameters
        ----------
        seconds : float
            How long it may take [s], once it has begun.
        function : callable
            A module's function; it, its arguments and what it returns are sent by pickle.

        Raises
        ------
        Overdue
            If it took longer, its process died, or too many jobs wait.
        InputError
            As the function does.
        """
        if self._jobs >= self.count + MOST_WAITING:
            raise Overdue("too many requests wait at once: try again in a moment.")
        self._jobs += 1
        try:
            loop = asyncio.get_running_loop()
            result: T = await loop.run_in_executor(self._threads, self._run, seconds, function, args, kwargs)
            return result
        finally:
            self._jobs -= 1

    def _run(self, seconds: float, function: Callable[..., Any], args: Any, kwargs: Any) -> Any:
        process = self._free.get()
        try:
            return process.call(seconds, function, args, kwargs)
        finally:
            self._free.put(process)


class _Process:
    """One process and the pipe to it; started again after it was ended or has died."""

    def __init__(self) -> None:
        self._context = multiprocessing.get_context("spawn")
        self._process: multiprocessing.process.BaseProcess | None = None
        self._pipe: Connection | None = None
        self._ready = False

    def start(self) -> None:
        here, there = self._context.Pipe()
        process = self._context.Process(target=_work, args=(there,), daemon=True)
        before = {name: os.environ.get(name) for name in ONE_THREAD}
        os.environ.update(ONE_THREAD)  # read when the process first imports NumPy
        try:
            process.start()
        finally:
            for name, value in before.items():
                if value is None:
                    del os.environ[name]
                else:
                    os.environ[name] = value
        there.close()
        self._process, self._pipe = process, here

    def end(self) -> None:
        process, pipe = self._process, self._pipe
        self._process, self._pipe, self._ready = None, None, False
        if pipe is not None:
            pipe.close()
        if process is not None:
            process.kill()
            process.join(TO_LEAVE)

    def call(self, seconds: float, function: Callable[..., Any], args: Any, kwargs: Any) -> Any:
        """Run in the process and wait; in a thread of ours."""
        if self._process is None or not self._process.is_alive():
            self.end()
            self.start()
        assert self._pipe is not None
        try:
            if not self._ready:  # to load is not the job's time
                if not self._pipe.poll(TO_LOAD):
                    self.end()
                    raise Overdue("the computer is too busy to begin: try again in a moment.")
                self._ready = self._pipe.recv() == "ready"
            self._pipe.send((function, args, kwargs))
            if not self._pipe.poll(seconds):
                self.end()
                raise Overdue(
                    f"this took longer than {seconds:g} s and was stopped: give fewer modes, narrower bands or a lower "
                    "order."
                )
            kind, value = self._pipe.recv()
        except (EOFError, OSError):
            self.end()
            raise Overdue("this was more than the computer could hold: give fewer modes or a smaller file.") from None
        if kind == "refused":
            raise InputError(value)
        if kind == "failed":
            raise RuntimeError(value)
        return value


def _work(pipe: Connection) -> None:
    """The life of a process: jobs, one after the other, until the pipe closes."""
    _prepare()
    with contextlib.suppress(EOFError, OSError, KeyboardInterrupt):
        pipe.send("ready")
        while True:
            function, args, kwargs = pipe.recv()
            pipe.send(_outcome(function, args, kwargs))


def _outcome(function: Callable[..., Any], args: Any, kwargs: Any) -> tuple[str, Any]:
    try:
        return "done", function(*args, **kwargs)
    except InputError as error:
        return "refused", str(error)
    except Exception:
        return "failed", traceback.format_exc()


def _prepare() -> None:
    """Load what every job needs, so that the first does not wait for it."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server ends its processes itself
    from preshape.workflow.workbench import AskedDesign, Workbench, view_of

    view_of(Workbench(designs=(AskedDesign("A", "direct"), AskedDesign("B", "si"))))
