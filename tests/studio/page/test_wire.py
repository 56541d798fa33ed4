"""What is told of the charts: everything once, then only what changed; and nothing from outside as HTML."""

from __future__ import annotations

import base64
import json
from dataclasses import replace

import numpy as np
import pytest

from preshape.mode import Mode
from preshape.studio.page.edits import edited
from preshape.studio.page.export_panel import ExportChoice, export_panel, export_preview, packaged_for
from preshape.studio.page.modes_panel import drop_zone
from preshape.studio.page.numbers_panel import numbers_panel
from preshape.studio.page.panels import preview
from preshape.studio.page.plots import CHARTS, TRADE_OFF, Picture
from preshape.studio.page.wire import Sent
from preshape.workflow.workbench import (
    AskedDesign,
    Measured,
    Workbench,
    export_targets,
    measured,
    trade_off_of,
    view_of,
)

BENCH = Workbench(
    (Mode(10.0, 0.02), Mode(31.0, 0.01)), (AskedDesign("A", "zvd"), AskedDesign("B", "direct"), AskedDesign("C", "si"))
)


def _picture(bench: Workbench) -> Picture:
    return Picture(view_of(bench), 50.0)


def test_the_same_picture_is_told_once() -> None:
    sent = Sent()
    first = sent.changes(_picture(BENCH))
    assert set(first) == {chart.name for chart in CHARTS}
    assert sent.changes(_picture(BENCH)) == {}


def test_of_a_changed_design_only_its_own_curves_are_told() -> None:
    sent = Sent()
    sent.changes(_picture(BENCH))
    told = sent.changes(_picture(edited(BENCH, "design.A.family", "zv")))
    assert set(told["sensitivity"]["series"]) == {"A"}
    assert {name.split(".")[0] for name in told["impulses"]["series"]} == {"A"}
    assert {name.split(".")[0] for name in told["poles"]["series"]} == {"A"}


def test_numbers_arrive_as_they_were() -> None:
    picture = _picture(BENCH)
    told = Sent().changes(picture)["sensitivity"]["series"]["B"]
    x, y = (np.frombuffer(base64.b64decode(part), "<f4") for part in told)
    drawn = picture.view.designs[1].drawn
    assert drawn is not None
    np.testing.assert_allclose(x, picture.view.frequencies, rtol=1e-7)
    np.testing.assert_allclose(y, 100.0 * drawn.vibration, rtol=1e-6)


def test_messages_are_json_and_every_series_is_in_its_frame() -> None:
    picture = replace(_picture(BENCH), trade_off=trade_off_of(BENCH, patience=1.0))
    sent = Sent()
    told = {**sent.changes(picture), **sent.trade_off(picture)}
    json.dumps(told, allow_nan=False)
    for chart in (*CHARTS, TRADE_OFF):
        known = {series["id"] for series in chart.option["series"]}
        assert set(told[chart.name]["series"]) <= known
        assert len(told[chart.name]["label"]) > 30


def test_a_design_without_a_shaper_empties_its_curves() -> None:
    sent = Sent()
    sent.changes(_picture(BENCH))
    broken = replace(BENCH, designs=(AskedDesign("A", "sd_zv"), *BENCH.designs[1:]))
    told = sent.changes(_picture(broken))
    assert told["sensitivity"]["series"] == {"A": None}
    assert "needs deflection_ratio" in numbers_panel(view_of(broken))


def test_names_from_outside_stay_text() -> None:
    nasty = "<img src=x onerror=alert(1)>"
    assert nasty not in drop_zone(_measured(nasty), "a", 1)
    assert nasty not in drop_zone(None, "a", 1, trouble=nasty)
    assert nasty not in export_panel(BENCH, ExportChoice(name=nasty))
    assert nasty not in export_preview(None, nasty)


@pytest.mark.parametrize("target", [target.name for target in export_targets()])
def test_every_target_has_its_fields_and_a_preview_or_a_reason(target: str) -> None:
    choice = ExportChoice(design="B").changed("target", target)
    described = next(one for one in export_targets() if one.name == target)
    form = export_panel(BENCH, choice)
    assert ('data-field="export.rate"' in form) == described.sampled
    assert ('data-field="export.axis"' in form) == bool(described.axes)
    package = packaged_for(Workbench(designs=(AskedDesign("B", "zv"),)), choice)
    shown = export_preview(package, "")
    assert package.name in shown
    assert all(file.name in shown for file in package.files)


def test_a_target_that_cannot_hold_the_shaper_says_so_in_place_of_its_text() -> None:
    shown = preview(BENCH, ExportChoice(design="A").changed("target", "rrf"))
    assert "the shaper has 9 impulses" in shown.lower()
    assert "Download" not in shown


def _measured(name: str) -> Measured:
    times = np.arange(1000) / 1000.0
    decay = np.exp(-8.0 * times) * np.sin(2 * np.pi * 30.0 * times)
    rows = "".join(f"{t:.3f},{x:.9f}\n" for t, x in zip(times, decay, strict=True))
    return measured(("time,x [g]\n" + rows).encode(), name)
