"""One page that is open: its state, and what it must be told after a change; the latest state wins."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable
from typing import Any

from preshape.studio.page import panels
from preshape.studio.page.axis import axis_end
from preshape.studio.page.compute import (
    EXPORT_TIME,
    FAILURES,
    TRADE_OFF_PATIENCE,
    TRADE_OFF_TIME,
    VIEW_TIME,
    told,
)
from preshape.studio.page.edits import edited, fields_of
from preshape.studio.page.export_panel import ExportChoice, export_preview
from preshape.studio.page.history import History
from preshape.studio.page.plots import TRADE_OFF, Picture
from preshape.studio.page.shared import Shared
from preshape.studio.page.wire import Sent
from preshape.workflow.workbench import (
    Measured,
    View,
    Workbench,
    WorkbenchTradeOff,
    shaper_named,
    to_text,
    trade_off_of,
    view_of,
)

__all__ = ["Session"]

SLOW = 0.4
"""Seconds after which a page says that it computes."""

SHORT_QUIET, QUIET = 0.25, 1.0
"""Seconds without a change after which the export is written, and the trade-off computed."""

TOGETHER = 2.0
"""Edits of one field within so many seconds are one step of undo."""

Message = dict[str, Any]


class Session:
    """The state behind one open page.

    Parameters
    ----------
    workbench : Workbench
        What the link held, or the first one.
    shared : Shared
        What all pages of the server share.
    measurement : str
        Key of the measurement in the link; empty if there is none.
    """

    def __init__(self, workbench: Workbench, shared: Shared, measurement: str = "") -> None:
        self.shared = shared
        self.history = History(workbench)
        self.measurement = measurement
        self.export = ExportChoice(design=workbench.designs[0].name)
        self.active = workbench.designs[0].name
        self.errors: dict[str, str] = {}
        self.view: View | None = None
        self.trade_off: WorkbenchTradeOff | None = None
        self.drop_trouble = ""
        if measurement and self.measured is None:
            self.measurement = ""
            self.drop_trouble = "The measurement of this link is no longer on the server: drop its file again."
        self.say: Callable[[Message], None] = lambda message: None
        self._sent = Sent()
        self._shapes = panels.shapes(self)
        self._top = 0.0
        self._drawing = self._forced = False
        self._last_edit = ("", -math.inf)
        self._changed_at = -math.inf

    @property
    def workbench(self) -> Workbench:
        """The present state."""
        return self.history.present

    @property
    def measured(self) -> Measured | None:
        """What was dropped, while the server holds it."""
        return self.shared.measurements.get(self.measurement) if self.measurement else None

    def first(self, view: View) -> Message:
        """What a new page is told: everything that its HTML does not hold."""
        self.view = view
        self._top = self._axis_end()
        return {
            "charts": {**self._sent.changes(self._picture()), **self._sent.trade_off(self._picture())},
            "handles": [mode.frequency for mode in view.workbench.modes],
            **self._around(),
        }

    async def edit(self, field: str, text: str, how: str = "") -> None:
        """Take what was typed into a field, chosen or dragged; if it cannot be, say so there and keep the rest."""
        now = time.monotonic()
        self._last_edit = (field, now)
        try:
            if field.startswith("export."):
                self.export = self.export.changed(field.removeprefix("export."), text)
                self.errors.pop(field, None)
                self._tell(forced=False, redrawn=False)
                return await self.show_export()
            new = edited(self.workbench, field, text)
            if field.startswith("design.") and not field.endswith(".family"):
                # A wish that no shaper can meet is refused like a wrong number: the last good design stays.
                await self.shared.compute.run(VIEW_TIME, shaper_named, new, field.split(".")[1])
                if self._last_edit != (field, now):
                    return None
                new = edited(self.workbench, field, text)
        except FAILURES as error:
            self.errors[field] = told(error)
            return self.say({"errors": {**self.errors, **panels.troubles(self.view)}})
        self.errors.pop(field, None)
        same = now - self._changed_at < TOGETHER or how == "held"
        if not same:
            self.history.seal()
        self.become(new, label=f"{field} {how}", held=how == "held", forced=how != "" and how != "held")
        return None

    def become(self, new: Workbench, *, label: str = "", held: bool = False, forced: bool = False) -> None:
        """Go to a new state."""
        self.history.change(new, label)
        self._moved_on(held=held, forced=forced)

    def step(self, back: bool) -> None:
        """Undo, or redo."""
        moved = self.history.undo() if back else self.history.redo()
        if not moved:
            return self.say({"say": "Nothing to undo" if back else "Nothing to redo"})
        self.errors.clear()
        return self._moved_on(held=False, forced=True)

    def release(self) -> None:
        """A handle was let go: the axes may move again, and the next drag is a step of its own."""
        self.history.seal()
        self._moved_on(held=False, forced=True)

    def take_measurement(self, key: str) -> None:
        """Show a measurement that has come, and take its modes if they are clear."""
        if self.shared.measurements.get(key) is None:
            return
        self.measurement, self.drop_trouble = key, ""
        self.take_modes(only_clear=True)

    def show_measurement(self, key: str, trouble: str = "") -> None:
        """Show a measurement, or none and why; the modes stay."""
        self.measurement, self.drop_trouble = key, trouble
        self._moved_on(held=False, forced=True)

    def take_modes(self, *, only_clear: bool = False) -> None:
        """Make the measured modes the workbench's; undo brings the old ones back."""
        self.errors = {field: said for field, said in self.errors.items() if not field.startswith("mode.")}
        self.history.seal()
        self.history.change(panels.with_measured(self.workbench, self.measured, only_clear=only_clear))
        self._moved_on(held=False, forced=True)

    def show_design(self, name: str) -> None:
        """Bring a design's fields to the front."""
        self.active = name
        self._tell(forced=True, redrawn=False)

    def _moved_on(self, *, held: bool, forced: bool) -> None:
        self._changed_at = time.monotonic()
        self.trade_off = None
        if not held:
            self._top = self._axis_end()
        names = [design.name for design in self.workbench.designs]
        if self.active not in names:
            self.active = names[0]
        if self.export.design not in names:
            self.export = self.export.changed("design", names[0])
        known = fields_of(self.workbench)
        self.errors = {
            field: said for field, said in self.errors.items() if field in known or field.startswith("export.")
        }
        self._forced = forced
        if not self._drawing:
            self._drawing = True
            _soon(self._draw())
            _soon(self._tell_if_slow())

    async def _draw(self) -> None:
        """Draw the latest state; what came in between is drawn once, with it."""
        try:
            while True:
                wanted, since = self.workbench, self._changed_at
                try:
                    self.view = await self.shared.compute.run(VIEW_TIME, view_of, wanted)
                except FAILURES as error:
                    self.say({"status": told(error), "link": to_text(wanted)})
                    if self._changed_at == since:
                        return
                    continue
                if self._changed_at == since:
                    break
                self._tell(forced=False, redrawn=True, behind=True)
            self._tell(forced=self._forced, redrawn=True)
        finally:
            self._drawing = False
        _soon(self.show_export())
        _soon(self.draw_trade_off())

    async def _tell_if_slow(self) -> None:
        await asyncio.sleep(SLOW)
        if self._drawing:
            self.say({"status": "Computing …"})

    async def show_export(self) -> None:
        """Write the export's preview anew; some targets take longer than a picture."""
        wanted = (self.workbench, self.export)
        await asyncio.sleep(SHORT_QUIET)
        async with self.shared.slow:
            if wanted != (self.workbench, self.export):
                return
            try:
                html = await self.shared.compute.run(EXPORT_TIME, panels.preview, *wanted)
            except FAILURES as error:
                html = export_preview(None, told(error))
        if wanted == (self.workbench, self.export):
            self.say({"html": {"preview": html}})

    async def draw_trade_off(self) -> None:
        """Draw what takes longer, once nothing has changed for a while."""
        since = self._changed_at
        await asyncio.sleep(QUIET)
        if self._changed_at != since:
            return
        async with self.shared.slow:
            if self._changed_at != since:
                return
            try:
                found = await self.shared.compute.run(
                    TRADE_OFF_TIME, trade_off_of, self.workbench, patience=TRADE_OFF_PATIENCE
                )
            except FAILURES as error:
                return self.say({"charts": {TRADE_OFF.name: {"note": told(error)}}})
        if self._changed_at == since:
            self.trade_off = found
            self.say({"charts": self._sent.trade_off(self._picture())})

    def _tell(self, *, forced: bool, redrawn: bool, behind: bool = False) -> None:
        message: Message = {}
        if redrawn and self.view is not None:
            message["charts"] = {**self._sent.changes(self._picture()), **self._sent.trade_off(self._picture())}
        if not behind:
            shapes = panels.shapes(self)
            message["html"] = panels.changed(self, self._shapes, shapes, redrawn)
            self._shapes = shapes
            message["fields"] = fields_of(self.workbench)
            message["forced"] = forced
            message["handles"] = [mode.frequency for mode in self.workbench.modes]
            message.update(self._around())
        self.say(message)

    def _around(self) -> Message:
        return {
            "link": to_text(self.workbench),
            "measurement": self.measurement,
            "status": "",
            "summary": panels.summary(self.view, self.active),
            "can": {"undo": self.history.can_undo, "redo": self.history.can_redo},
            "errors": {**self.errors, **panels.troubles(self.view)},
        }

    def _axis_end(self) -> float:
        return axis_end(max(mode.frequency for mode in self.workbench.modes), self._top)

    def _picture(self) -> Picture:
        assert self.view is not None  # nothing is drawn before the first view
        return Picture(self.view, self._top, self.measured, self.trade_off)


def _soon(work: Any) -> None:
    from nicegui import background_tasks

    background_tasks.create(work)
