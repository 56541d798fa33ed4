"""The page itself: its route, its frame, and which event does what."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from functools import partial
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from preshape.errors import InputError
from preshape.studio.page import frame
from preshape.studio.page.compute import FAILURES, VIEW_TIME, told
from preshape.studio.page.deeds import DEEDS
from preshape.studio.page.fields import sentence
from preshape.studio.page.measurements import Measurements
from preshape.studio.page.panels import PANELS, written
from preshape.studio.page.plots import CHARTS, TRADE_OFF
from preshape.studio.page.session import Session
from preshape.studio.page.shared import Shared
from preshape.studio.workers import Overdue
from preshape.workflow.workbench import from_text, view_of

if TYPE_CHECKING:
    from fastapi import FastAPI
    from nicegui import Client

    from preshape.studio.server import Studio

__all__ = ["STATIC", "build"]

STATIC = "/page/static"
"""Where the page's own scripts and styles are."""

FIRST_PICTURE = 1.5
"""Seconds that a new page waits for its first picture; a design that takes longer is drawn when it is there."""


def build(app: FastAPI, studio: Studio) -> None:
    """Put the page on a server, at "/".

    Parameters
    ----------
    app : FastAPI
        Whose other routes stay.
    studio : Studio
        Who computes, what a page without a link shows, and how large a file may be.
    """
    from fastapi.staticfiles import StaticFiles
    from nicegui import background_tasks, ui

    shared = Shared(studio.workers, Measurements(studio.workers, studio.largest_upload))
    shared.measurements.serve(app)
    app.mount(STATIC, StaticFiles(directory=str(files("preshape.studio.page") / "static")))

    @ui.page("/", title="preshape studio", favicon=frame.ICON, response_timeout=60.0)
    async def page(client: Client, s: str = "", m: str = "") -> None:
        bench, trouble = studio.workbench, ""
        if s:
            try:
                bench = from_text(s)
            except InputError as error:
                trouble = sentence(str(error))
        session = Session(bench, shared, m[:64])
        await _open(client, session, trouble)
        if not s and studio.dropped is not None:
            # Its modes are the workbench's already; its spectrum comes when it is read.
            background_tasks.create(_show_dropped(session, *studio.dropped))

    ui.run_with(app, title="preshape studio", tailwind=False, show_welcome_message=False, reconnect_timeout=30.0)


async def _open(client: Client, session: Session, trouble: str) -> None:
    """Write the page, tell it its first picture, and listen to it."""
    from nicegui import background_tasks, ui

    drawing = asyncio.ensure_future(session.shared.compute.run(VIEW_TIME, view_of, session.workbench))
    done, _ = await asyncio.wait([drawing], timeout=FIRST_PICTURE)
    message: dict[str, Any] = {}
    if done and drawing.exception() is None:
        message = session.first(drawing.result())
    charts = {}
    ui.add_head_html(frame.head(STATIC))
    with ui.element("div").classes("page"):
        ui.html(frame.top(trouble), sanitize=False, tag="header").classes("top")
        with ui.element("div").classes("bench"):
            with ui.element("section").classes("controls").props('aria-label="Modes and designs"'):
                for name in frame.CONTROLS:
                    _panel(session, name, tag="section")
            with (
                ui.element("section")
                .classes("results")
                .props('id="results" tabindex="-1" aria-label="Charts, numbers and export"')
            ):
                with ui.element("div").classes("row"):
                    _panel(session, "legend", classes="legend")
                    ui.html(frame.STATUS, sanitize=False, tag="span").classes("status")
                with ui.element("div").classes("charts"):
                    for chart in (*CHARTS, TRADE_OFF):
                        charts[chart.name] = _chart(chart.name, chart.title, chart.option)
                _panel(session, "numbers", tag="section")
                with ui.element("section").classes("export").props('aria-labelledby="export-title"'):
                    _panel(session, "export")
                    _panel(session, "preview")
        ui.html(frame.SAYING, sanitize=False)
    ui.add_body_html(frame.first(charts, message))
    session.say = partial(_say, client)
    for event, deed in DEEDS.items():
        ui.on(f"studio_{event}", partial(_heard, session, deed))
    if message:
        background_tasks.create(_later(session))
    else:
        session.become(session.workbench)


def _panel(session: Session, name: str, *, tag: str = "div", classes: str = "") -> None:
    from nicegui import ui

    assert name in PANELS
    ui.html(written(session, name), sanitize=False, tag=tag).props(f'id="panel-{name}"').classes(classes)


def _chart(name: str, title: str, option: Any) -> int:
    """A chart in its box; the number by which the browser finds it."""
    from nicegui import ui

    with ui.element("figure").classes("chart").props(f'id="chart-{name}"'):
        ui.html(frame.chart_title(title), sanitize=False)
        with ui.element("div").classes("drawing"):
            made = ui.echart(json.loads(json.dumps(option)))
            ui.html(frame.chart_over(name), sanitize=False)
        ui.html(frame.chart_foot(title), sanitize=False)
    return made.id


def _say(client: Client, message: dict[str, Any]) -> None:
    if client.is_deleted:
        return
    client.run_javascript(f"preshapeStudio.receive({json.dumps(message, allow_nan=False)})")


async def _heard(session: Session, deed: Callable[..., Awaitable[None]], event: Any) -> None:
    """An event of the page; what it carries is text."""
    values = event.args if isinstance(event.args, list) else []
    try:
        await deed(session, *(str(value) for value in values))
    except FAILURES as error:
        session.say({"say": told(error)})


async def _show_dropped(session: Session, name: str, content: bytes) -> None:
    """Show the measurement that the studio was opened with."""
    try:
        session.show_measurement(await session.shared.measurements.read(content, name))
    except (InputError, Overdue) as error:
        session.show_measurement("", str(error))


async def _later(session: Session) -> None:
    await session.show_export()
    await session.draw_trade_off()
