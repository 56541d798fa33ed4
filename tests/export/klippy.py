"""A stand-in for Klipper's host, as far as a module in klippy/extras sees it.

The kernel's rules (ECOSYSTEM 1.2): at most `most` impulses, times that increase strictly, amplitudes divided by their
sum; what it does not take is an error and the axis is not shaped.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Refused(Exception):
    """What Klipper raises."""


class AxisShaper:
    """One axis of [input_shaper]."""

    def __init__(self, axis: str) -> None:
        self.axis = axis
        self.n, self.A, self.T = 2, [1.0, 0.7], [0.0, 0.01]


class InputShaper:
    """[input_shaper] and the kernel behind it."""

    def __init__(self, most: int, axes: str) -> None:
        self.most, self.shapers = most, [AxisShaper(axis) for axis in axes]
        self.kernel: dict[str, tuple[list[float], list[float]]] = {}

    def get_shapers(self) -> list[AxisShaper]:
        return self.shapers

    def _update_input_shaping(self) -> None:
        for shaper in self.shapers:
            a, t = list(shaper.A), list(shaper.T)
            if not (len(a) == len(t) == shaper.n <= self.most) or any(x >= y for x, y in zip(t, t[1:], strict=False)):
                raise Refused(f"Failed to configure shaper(s) shaper_{shaper.axis} with given parameters")
            self.kernel[shaper.axis] = ([value / sum(a) for value in a], t)


class Printer:
    """The host: events, objects, commands."""

    command_error = Refused

    def __init__(self, input_shaper: InputShaper | None) -> None:
        self.objects: dict[str, Any] = {"gcode": self, "input_shaper": input_shaper}
        self.events: dict[str, Callable[[], None]] = {}
        self.commands: dict[str, Callable[[Any], None]] = {}
        self.said: list[str] = []

    def lookup_object(self, name: str, default: Any = None) -> Any:
        return self.objects.get(name, default)

    def register_event_handler(self, event: str, handler: Callable[[], None]) -> None:
        self.events[event] = handler

    def register_command(self, name: str, handler: Callable[[Any], None], desc: str) -> None:
        self.commands[name] = handler

    def respond_info(self, text: str) -> None:
        self.said.append(text)


class Config:
    """A section of printer.cfg."""

    error = Refused

    def __init__(self, printer: Printer, settings: dict[str, str]) -> None:
        self.printer, self.settings = printer, settings

    def get_printer(self) -> Printer:
        return self.printer

    def getfloatlist(self, name: str, default: Any) -> Any:
        if name not in self.settings:
            return default
        return tuple(float(word) for word in self.settings[name].split(","))
