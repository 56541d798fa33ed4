"""The optimiser under Klipper's measures: its formulas, its bounds, and a search that knows nothing of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Modes, Shaper
from preshape.export import klipper
from preshape.export.klipper import Asked, Optimiser, Room
from preshape.export.klipper.measure import VibrationMeasure, corner_deviations, slownesses
from preshape.export.klipper.mesh_programme import least_on_mesh
from preshape.export.klipper.polish import Pulses, reduced

FREQUENCIES = np.arange(5.0, 130.0, 1.25)
MODES = Modes([(55.0, 0.05)])
ANYWHERE = Room(5, 0.01, 0.0, math.inf, math.inf)


def spectrum(*peaks: tuple[float, float], damping: float = 0.05) -> klipper.Spectrum:
    """Peaks at frequencies [Hz] of a height."""
    psd = sum(
        height / ((1.0 - (FREQUENCIES / f) ** 2) ** 2 + (2.0 * damping * FREQUENCIES / f) ** 2) for f, height in peaks
    )
    return klipper.Spectrum(FREQUENCIES, psd)


TWO_PEAKS = (spectrum((48.0, 1.0), (79.0, 0.6)), spectrum((52.0, 1.0)))

pulses = st.integers(2, 6).flatmap(
    lambda n: st.tuples(
        st.lists(st.floats(0.001, 0.006), min_size=n - 1, max_size=n - 1),
        st.lists(st.floats(0.1, 1.0), min_size=n, max_size=n),
    )
)


def made(drawn: tuple[list[float], list[float]]) -> tuple[np.ndarray, np.ndarray]:
    amplitudes = np.array(drawn[1])
    return np.concatenate([[0.0], np.cumsum(drawn[0])]), amplitudes / amplitudes.sum()


@given(pulses)
@settings(max_examples=40, deadline=None)
def test_the_measures_are_klipper_s(drawn: tuple[list[float], list[float]]) -> None:
    """Against the scoring, which is checked against Klipper's own numbers."""
    times, amplitudes = made(drawn)
    shaper = Shaper(times, amplitudes)
    left = VibrationMeasure.of(TWO_PEAKS).left(times, amplitudes).values
    assert left.shape == (6,)  # two datasets, three damping ratios
    assert left.max() == pytest.approx(klipper.remaining_vibration(shaper, TWO_PEAKS), abs=1e-12)
    assert corner_deviations(times, amplitudes).values.max() == pytest.approx(klipper.smoothing(shaper), rel=1e-12)
    if (limit := klipper.maximum_acceleration(shaper)) > 100.0:
        assert 1.0 / slownesses(times, amplitudes).values.max() == pytest.approx(limit, rel=1e-9)


@given(pulses)
@settings(max_examples=25, deadline=None)
def test_the_derivatives_are_those_of_the_measures(drawn: tuple[list[float], list[float]]) -> None:
    """Along a small change that keeps the sum of the amplitudes; kinks are skipped by comparing both sides."""
    times, amplitudes = made(drawn)
    rng = np.random.default_rng(len(drawn[0]))
    dt, da = 1e-3 * rng.normal(size=times.size), rng.normal(size=times.size)
    dt[0], da = 0.0, da - da.mean()
    step = 1e-7
    measure = VibrationMeasure.of(TWO_PEAKS)
    for quantity in (measure.left, corner_deviations, slownesses):
        here = quantity(times, amplitudes)
        ahead, behind = (quantity(times + s * dt, amplitudes + s * da).values for s in (step, -step))
        forward, backward = (ahead - here.values) / step, (here.values - behind) / step
        smooth = np.abs(forward - backward) < 1e-4 * (np.abs(forward) + np.abs(backward) + 1e-6)
        slope = here.by_time @ dt + here.by_amplitude @ da
        scale = np.abs(here.values).max() + np.abs(slope).max()
        assert slope[smooth] == pytest.approx(0.5 * (forward + backward)[smooth], abs=1e-4 * scale)


@given(pulses, st.floats(0.02, 0.3))
@settings(max_examples=25, deadline=None)
def test_a_shaper_scaled_to_a_smoothing_has_it(drawn: tuple[list[float], list[float]], wanted: float) -> None:
    scaled = klipper.scaled_to_smoothing(Shaper(*made(drawn)), wanted)
    assert klipper.smoothing(scaled) == pytest.approx(wanted, rel=1e-12)


def test_the_mesh_programme_bounds_every_shaper_on_its_mesh() -> None:
    """No shaper drawn on the mesh with this centroid and smoothing leaves less than the bound says."""
    measure = VibrationMeasure.of(TWO_PEAKS)
    duration, points, smoothing = 0.014, 21, 0.05
    optimum = least_on_mesh(measure, duration, 0.5 * duration, smoothing, points)
    assert optimum is not None and 0.0 < optimum.bound <= optimum.left <= 1.1 * optimum.bound + 1e-4
    times, rng, tried = np.linspace(0.0, duration, points), np.random.default_rng(3), 0
    for _ in range(3000):
        half = rng.dirichlet(np.full(points, 0.2))
        amplitudes = 0.5 * (half + half[::-1])  # symmetric: the centroid is in the middle
        if corner_deviations(times, amplitudes).values.max() <= smoothing:
            tried += 1
            assert measure.left(times, amplitudes).values.max() >= optimum.bound * (1.0 - 1e-9)
    assert tried > 50


def test_two_impulses_are_as_fast_as_a_search_over_all_of_them() -> None:
    """Two impulses have two numbers: all are tried on a fine grid, scored by Klipper's formula."""
    spectra = (spectrum((55.0, 1.0)),)
    allowed = 0.08
    best = 0.0
    for duration in np.linspace(0.005, 0.012, 71):
        for first in np.linspace(0.4, 0.7, 61):
            shaper = Shaper([0.0, duration], [first, 1.0 - first])
            if klipper.remaining_vibration(shaper, spectra) <= allowed:
                best = max(best, klipper.maximum_acceleration(shaper))
    room = Room(2, 0.01, 0.0, math.inf, math.inf)
    found = Optimiser(spectra, room, MODES).best(Asked(allowed, math.inf), [klipper.zv(50.0), klipper.zv(60.0)])
    assert found is not None and best > 0.0
    assert found.score.remaining_vibration <= allowed * (1.0 + 1e-9)
    assert found.score.maximum_acceleration >= best
    assert found.score.maximum_acceleration <= 1.02 * best  # the grid's own step


def test_what_is_asked_is_met_by_the_independent_score() -> None:
    stock = klipper.recommend(TWO_PEAKS).chosen
    room = Room(4, 0.02, 0.001, 0.03, stock.shaper.duration - stock.shaper.centroid)
    found = Optimiser(TWO_PEAKS, room, MODES).best(Asked(None, stock.score.smoothing), [stock.shaper])
    assert found is not None and found.score == klipper.score(found.shaper, TWO_PEAKS)
    assert found.score.remaining_vibration <= stock.score.remaining_vibration
    assert found.score.smoothing <= stock.score.smoothing * (1.0 + 1e-9)
    assert len(found.shaper) <= 4 and found.shaper.amplitudes.min() >= 0.02 * (1.0 - 1e-9)
    assert found.shaper.duration - found.shaper.centroid <= room.tail * (1.0 + 1e-9)
    assert found.shaper.design.modes == MODES and found.shaper.design.status == "feasible"


def test_nothing_is_found_where_nothing_can_be() -> None:
    assert Optimiser(TWO_PEAKS, ANYWHERE, MODES).best(Asked(1e-6, 0.001), [klipper.zv(50.0)]) is None


@given(pulses, st.integers(2, 4))
@settings(max_examples=40, deadline=None)
def test_fewer_impulses_keep_the_centroid(drawn: tuple[list[float], list[float]], most: int) -> None:
    times, amplitudes = made(drawn)
    fewer = reduced(Pulses(times, amplitudes), most, 0.0)
    assert fewer.times.size == min(most, times.size) and fewer.times[0] == 0.0
    assert (np.diff(fewer.times) > 0.0).all() and fewer.amplitudes.sum() == pytest.approx(1.0)
    if times.size == most + 1 and fewer.times[-1] == pytest.approx(times[-1]):  # the first one was kept
        assert fewer.amplitudes @ fewer.times == pytest.approx(amplitudes @ times)
