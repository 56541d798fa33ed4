"""The law of every target on the list: rendered, parsed, executed, it is the shaper that was asked for.

How near, the target says: its limits in numbers, and for a firmware that only has families the excess that its export
states. A target that is added to the list is tested here without a further line.
"""

from __future__ import annotations

import pytest
from tests.export.exports import DT, assert_executed_as_asked

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.export import TARGETS, AnyTarget, Exported, ExportedSettings, Limits, Target, render, targets
from preshape.export.nearest import EQUAL
from preshape.export.target import EPSILON
from preshape.vibration import residual_vibration

EVERY = [
    pytest.param(target, version, precision, id=f"{target.name} {version} {precision}")
    for target in TARGETS.values()
    for version in target.versions
    for precision in target.limits.precisions
]
MODE = (41.3, 0.06)
SHAPERS = {
    "zv": design.zv(MODE),
    "zvd": design.zvd(MODE),
    "mzv": design.mzv(MODE),
    "ei": design.ei(MODE),
    "two modes": design.direct([(41.3, 0.06), (66.0, 0.04)], order=0),
    "many impulses": design.zvd([(41.3, 0.06), (66.0, 0.04)]),
    "negative": design.um_zvd(MODE),
}

HELD = 1e-11
"""How well the grid holds the residual at the modes [-], see preshape.design.grid_split."""


def exported(target: AnyTarget, version: str, precision: str, asked: Shaper) -> Exported | ExportedSettings:
    grid = {"dt": DT, "precision": precision} if isinstance(target, Target) else {}
    return render(asked, target.name, version=version, **grid)  # type: ignore[arg-type]


def held(shaper: Shaper, limits: Limits) -> bool:
    """Whether it is within them."""
    return (limits.taps is None or len(shaper) <= limits.taps) and (
        limits.negative or float(shaper.amplitudes.min()) >= 0.0
    )


@pytest.mark.parametrize("name", SHAPERS)
@pytest.mark.parametrize(("target", "version", "precision"), EVERY)
def test_rendered_parsed_and_executed_it_is_the_shaper_that_was_asked_for(
    target: AnyTarget, version: str, precision: str, name: str
) -> None:
    asked, limits = SHAPERS[name], target.limits_of(version)
    if not held(asked, limits):
        with pytest.raises(InputError, match="design"):
            exported(target, version, precision, asked)
        return
    export = exported(target, version, precision, asked)
    does = target.execute(export.files)
    assert does == export.placed.shaper, "what the screen and the notes speak of"
    assert target.execute(export.files, version) == does
    if isinstance(export, Exported):
        said, placed = export.target.parse(export.files), export.placed
        assert (said.dt, said.delays.tolist(), said.precision) == (DT, placed.delays.tolist(), precision)
        assert said.weights.tobytes() == placed.weights.tobytes()
        on = design.on_grid(asked, DT, "exact")
        assert_executed_as_asked(does, on, limits, precision)
        for mode in asked.design.modes or ():  # the grid costs nothing there, the precision what it must
            left, wanted = (float(residual_vibration(one, mode.frequency, mode.damping)) for one in (does, asked))
            assert left <= wanted + HELD + len(on) ** 2 * on.magnitude * EPSILON[precision]
    else:
        assert export.target.parse(export.files).version == version
        assert_executed_as_asked(does, asked, limits, excess=export.placed.excess)


@pytest.mark.parametrize(("target", "version", "precision"), EVERY)
def test_what_is_executed_is_executed_the_same_again(target: AnyTarget, version: str, precision: str) -> None:
    """An export of what a controller does, executed: nothing changes any more but last digits."""
    once = exported(target, version, precision, SHAPERS["zvd"]).placed.shaper
    again = exported(target, version, precision, once)
    assert_executed_as_asked(again.placed.shaper, once, target.limits_of(version), precision, EQUAL)


@pytest.mark.parametrize("target", TARGETS.values(), ids=list(TARGETS))
def test_every_target_says_what_it_is(target: AnyTarget) -> None:
    assert getattr(targets, target.name.upper().replace("-", "_")) is target, "called as it is named"
    assert target.summary and target.versions and all(str(target.limits_of(version)) for version in target.versions)
    with pytest.raises(InputError, match=f"version '0' is not known for target {target.name}: it is"):
        target.execute({}, "0")
    with pytest.raises(InputError):
        target.execute({})
