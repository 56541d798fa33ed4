"""Shapers that are held back: the delay is theirs everywhere, and nothing else changes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.laws import FAMILIES, Family

from preshape import Modes, Shaper, design
from preshape.engine import is_proved_shortest
from preshape.errors import InputError
from preshape.plant import ModalPlant
from preshape.profile import Profile
from preshape.stream import Stream
from preshape.vibration import residual_vibration

MODE = (3.0, 0.05)
BOX = design.sd_zv(MODE, 0.3, "box")


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_a_delay_changes_neither_residual_nor_command(family: Family) -> None:
    shaper = family.build(Modes([MODE]))
    later = design.delayed(shaper, 0.123)
    assert later.centroid == pytest.approx(shaper.centroid + 0.123, abs=1e-15 + 1e-15 * shaper.magnitude)
    frequencies = np.linspace(0.5, 9.0, 41)
    np.testing.assert_allclose(
        residual_vibration(later, frequencies, 0.05), residual_vibration(shaper, frequencies, 0.05), atol=1e-12
    )
    move = Profile.steps([0.0, 0.2, 0.5, 0.7], [2.0, -2.0, -2.0, 2.0], order=2)
    looks = np.linspace(0.0, 4.0, 301)
    np.testing.assert_allclose(later.shape(move)(looks), shaper.shape(move).delayed(0.123)(looks), atol=1e-13)
    assert later.design.settings["delay"] == 0.123 and later.design.status != "optimal"
    assert later.design.certificate is None and not is_proved_shortest(later)
    assert Shaper.from_dict(later.to_dict()) == later


def test_a_delay_survives_saving_convolution_the_grid_and_another_delay() -> None:
    plain = design.zvd(MODE)
    for shaper in (plain, BOX):
        later = design.delayed(shaper, 0.05)
        twice = design.delayed(later, 0.07)
        assert twice == design.delayed(shaper, 0.12) or np.allclose(
            twice.times, design.delayed(shaper, 0.12).times, rtol=1e-15
        )
        assert twice.design.settings["delay"] == pytest.approx(0.12)
        other = design.zv((7.0, 0.0))
        for product in (later * other, other * later):
            assert product.centroid == pytest.approx(shaper.centroid + other.centroid + 0.05, abs=1e-14)
    later = design.delayed(plain, 0.0505)
    for method in ("linear", "nearest", "exact"):
        placed = design.on_grid(later, 0.001, method)
        assert placed.centroid == pytest.approx(later.centroid, abs=1e-3)
        assert placed.times[0] == 0.0 and placed.amplitudes[0] == 0.0
        assert np.allclose(placed.times / 0.001, np.rint(placed.times / 0.001))
        delays, weights = placed.taps(0.001)  # what an export writes and reads again
        assert Shaper(delays * 0.001, weights) == placed
    assert design.on_grid(later, 0.001, "exact").design.residual < 1e-12
    assert design.on_grid(later, 0.001).centroid == pytest.approx(later.centroid, abs=1e-15)


def test_a_delay_of_rounding_is_none() -> None:
    shaper = design.zvd(MODE)
    assert design.delayed(shaper, 0.0) is shaper and design.delayed(shaper, 1e-17) is shaper


@given(st.lists(st.floats(0.5, 80.0), min_size=1, max_size=4), st.sampled_from(["zv", "zvd", "ei", "um_zv"]))
def test_all_centroids_are_the_latest(frequencies: list[float], family: str) -> None:
    shapers = [design.FAMILIES[family]((frequency, 0.03)) for frequency in frequencies]
    together = design.synchronised(shapers)
    latest = max(one.centroid for one in shapers)
    for one, held in zip(shapers, together, strict=True):
        assert held.centroid == pytest.approx(latest, rel=1e-13)
        assert held.duration == pytest.approx(one.duration + latest - one.centroid, rel=1e-13)


def test_streams_of_two_axes_stay_on_a_line_at_constant_speed_and_the_plants_at_rest() -> None:
    """The same objects in a controller's loop: one stream an axis."""
    modes, dt = ((3.0, 0.05), (5.0, 0.02)), 0.001
    x, y = (Stream(one, dt) for one in design.synchronised([design.zvd(mode) for mode in modes]))
    ramp = np.arange(3000) * 0.0002
    line = np.stack([x.push_block(2.0 * ramp), y.push_block(ramp)])
    after = int(1.0 / dt)
    assert np.abs(line[0] - 2.0 * line[1])[after:].max() < 1e-12
    own = [Stream(design.zvd(mode), dt).push_block(ramp) for mode in modes]
    assert np.abs(own[0] - own[1])[after:].min() > 1e-3  # what it is without
    move = Profile.steps([0.0, 0.2, 0.5, 0.7], [2.0, -2.0, -2.0, 2.0], order=2)
    for mode, one in zip(modes, design.synchronised([design.zvd(mode) for mode in modes]), strict=True):
        assert ModalPlant(mode).motion(one.shape(move)).residual("output") < 1e-13


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda: design.delayed(design.zv(MODE), -0.1), "0 s or more"),
        (lambda: design.delayed(design.zv(MODE), float("nan")), "finite"),
        (lambda: design.synchronised([]), "one an axis"),
        (lambda: design.synchronised(design.zv(MODE)), "list of Shaper"),  # type: ignore[arg-type]
        (lambda: design.synchronised([design.zv(MODE), 3.0]), "number 2"),  # type: ignore[list-item]
    ],
)
def test_wrong_input_gets_a_sentence(wrong: object, words: str) -> None:
    with pytest.raises(InputError, match=words):
        wrong()  # type: ignore[operator]
