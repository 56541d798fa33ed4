"""Specified insensitivity: kept on the continuum, proved, as short as the literature's, monotone; and refusals."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Band, Mode, Shaper, design
from preshape.engine import PartialSumsBetween, ServoGrid, ZeroVibration, is_proved_shortest, minimum_duration
from preshape.errors import InputError
from preshape.plant import ModalPlant

TABLE = {0.1: 0.7422, 0.2: 0.8877, 0.3: 0.9415, 0.45: 1.149, 0.6: 1.3665, 0.75: 1.576, 0.9: 1.884, 1.0: 2.123, 1.1: 2.4}
"""Duration in periods over insensitivity at 5 %, one undamped mode; our literature notes, rounded to the last digit."""

TWO = [(0.9, 1.1), (2.7, 3.3)]


def largest(shaper: Shaper, bands: list[tuple[float, ...]], count: int = 400) -> float:
    """V on a fine grid of frequencies and dampings, by the formula written out anew."""
    worst = 0.0
    for low, high, *dampings in bands:
        ratios = np.linspace(dampings[0], dampings[-1], 15) if dampings else np.zeros(1)
        for z in ratios:
            w = 2.0 * math.pi * np.linspace(low, high, count)[:, None]
            lead = shaper.duration - shaper.times
            total = (shaper.amplitudes * np.exp(-(z + 1j * math.sqrt(1.0 - z**2)) * w * lead)).sum(axis=1)
            worst = max(worst, float(np.abs(total).max()))
    return worst


@pytest.mark.parametrize("insensitivity", TABLE)
def test_one_mode_takes_no_longer_than_the_literature_says(insensitivity: float) -> None:
    band = (1.0 - insensitivity / 2.0, 1.0 + insensitivity / 2.0)
    shaper = design.specified_insensitivity(band)
    assert shaper.design.status == "optimal" and is_proved_shortest(shaper)
    assert shaper.duration == pytest.approx(TABLE[insensitivity], abs=8e-4)
    assert largest(shaper, [band], 20_001) <= 0.05 * (1.0 + 1e-6)


@pytest.mark.parametrize(("humps", "insensitivity"), [(1, 0.39945), (2, 0.72454), (3, 0.96389)])
def test_the_ei_family_is_the_shortest_for_its_own_width(humps: int, insensitivity: float) -> None:
    x0 = math.cosh(math.acosh(20.0) / (humps + 1))
    exact = 4.0 / math.pi * math.asin(1.0 / x0)
    assert exact == pytest.approx(insensitivity, abs=1e-5)
    shaper = design.specified_insensitivity((1.0 - exact / 2.0, 1.0 + exact / 2.0))
    ei = design.k_hump_ei((1.0, 0.0), humps)
    assert shaper.duration == pytest.approx(ei.duration, abs=1e-6)
    np.testing.assert_allclose(shaper.amplitudes, ei.amplitudes, atol=1e-5)


@pytest.mark.parametrize("bands", [TWO, [(0.9, 1.1, 0.0, 0.1), (2.7, 3.3, 0.02, 0.05)], [(8.0, 12.0, 0.1)]])
def test_nothing_in_the_bands_exceeds_the_tolerance_and_a_plant_agrees(bands: list[tuple[float, ...]]) -> None:
    shaper = design.specified_insensitivity(bands)
    assert shaper.design.status == "optimal" and is_proved_shortest(shaper)
    assert largest(shaper, bands) <= 0.05 * (1.0 + 1e-6)
    assert shaper.design.residual == pytest.approx(0.05, rel=1e-6)
    low, high, *dampings = bands[0]
    for frequency in (low, 0.5 * (low + high), high):
        mode = (frequency, dampings[0] if dampings else 0.0)
        assert ModalPlant(mode).impulse_residual(shaper.times, shaper.amplitudes)[0] <= 0.05 * (1.0 + 1e-6)


def test_an_independent_linear_programme_finds_nothing_shorter() -> None:
    """Polygons around the discs allow more than the discs: where even they allow nothing, there is no shaper."""
    from scipy.optimize import linprog

    shaper = design.specified_insensitivity(TWO)
    least = {}
    for factor in (0.99, 1.01):
        duration = factor * shaper.duration
        leads = np.linspace(0.0, duration, 400)
        frequencies = np.concatenate([np.linspace(low, high, 25) for low, high in TWO])
        waves = np.exp(-2j * np.pi * np.multiply.outer(frequencies, leads))
        rows = np.concatenate([np.real(waves * np.exp(1j * angle)) for angle in np.linspace(0.0, 2.0 * np.pi, 32)])
        answer = linprog(
            np.append(np.zeros(leads.size), 1.0),
            A_ub=np.column_stack([rows, -np.ones(rows.shape[0])]),
            b_ub=np.zeros(rows.shape[0]),
            A_eq=np.append(np.ones(leads.size), 0.0)[None, :],
            b_eq=[1.0],
            method="highs-ipm",
            options={"time_limit": 20.0},
        )
        least[factor] = float(answer.fun)
    assert least[0.99] > 0.05 and least[1.01] < 0.05


def test_the_proof_survives_a_file_and_no_tampering() -> None:
    shaper = design.specified_insensitivity(TWO)
    proof = shaper.design.certificate
    assert proof is not None
    again = Shaper.from_dict(json.loads(json.dumps(shaper.to_dict())))
    assert again.design == shaper.design and is_proved_shortest(again)

    def with_proof(**changes: object) -> Shaper:
        return Shaper(shaper.times, shaper.amplitudes, replace(shaper.design, certificate=replace(proof, **changes)))

    first, *others = proof.points
    for point in (
        replace(first, multiplier=1.5 * first.multiplier),
        replace(first, multiplier=-first.multiplier),
        replace(first, tolerance=0.01),
        replace(first, frequency=0.5),
    ):
        assert not is_proved_shortest(with_proof(points=(point, *others)))
    assert not is_proved_shortest(with_proof(points=()))
    assert not is_proved_shortest(with_proof(bands=(Band(0.5, 1.1), Band(2.7, 3.3))))
    longer = design.specified_insensitivity(TWO, 0.04)
    assert not is_proved_shortest(Shaper(longer.times, longer.amplitudes, shaper.design))


@settings(max_examples=12)
@given(st.floats(0.05, 0.8), st.floats(0.0, 0.1), st.floats(0.02, 0.2))
def test_more_tolerance_or_less_band_is_never_longer(width: float, damping: float, tolerance: float) -> None:
    def duration(width: float, tolerance: float) -> float:
        band = (1.0 - width / 2.0, 1.0 + width / 2.0, damping)
        shaper = design.specified_insensitivity(band, tolerance)
        assert largest(shaper, [band]) <= tolerance * (1.0 + 1e-6)
        return shaper.duration

    here = duration(width, tolerance)
    assert duration(width, 1.3 * tolerance) <= here * (1.0 + 1e-6)
    assert duration(0.8 * width, tolerance) <= here * (1.0 + 1e-6)


@settings(max_examples=8)
@given(
    st.lists(st.tuples(st.floats(1.0, 4.0), st.floats(0.0, 0.1), st.floats(0.0, 0.08)), min_size=1, max_size=3),
    st.floats(0.02, 0.15),
)
def test_a_range_of_damping_or_another_band_is_never_shorter(
    modes: list[tuple[float, float, float]], tolerance: float
) -> None:
    """More to keep takes as long or longer, and what is kept is kept for any part of it."""
    bands = [(f, f * (1.0 + part), z, z + 0.05) for f, part, z in modes]
    whole = design.specified_insensitivity(bands, tolerance)
    assert largest(whole, bands) <= tolerance * (1.0 + 1e-6)
    for part in (
        bands[:1],
        [(low, high, z) for low, high, z, _ in bands],
        [(low, low, z, z) for low, _, z, _ in bands],
    ):
        shaper = design.specified_insensitivity(part, tolerance)
        # bands of a relative width below about 1e-7 are not proved; then the gap says by how much it may be too long
        gap = float(shaper.design.settings.get("gap", 0.0))
        assert gap < 1e-4 and shaper.duration * (1.0 - gap) <= whole.duration * (1.0 + 1e-6)


def test_the_same_band_twice_or_inside_another_changes_nothing() -> None:
    once = design.specified_insensitivity((0.9, 1.1, 0.0, 0.05))
    for again in ([(0.9, 1.1, 0.0, 0.05)] * 2, [(0.9, 1.1, 0.0, 0.05), (0.95, 1.05, 0.02)]):
        shaper = design.specified_insensitivity(again)
        assert is_proved_shortest(shaper) and shaper.duration == pytest.approx(once.duration, rel=1e-9)


def test_of_measured_sets_the_worst_counts() -> None:
    folded, stretched = [(5.3, 0.01), (12.5, 0.02)], [(4.1, 0.01), (11.0, 0.02)]
    shaper = design.specified_insensitivity(design.bands_of_sets([folded, stretched], spread=0.02))
    left = [largest(shaper, [(0.98 * f, 1.02 * f, z)]) for f, z in folded + stretched]
    assert max(left) == pytest.approx(0.05, rel=1e-4) and is_proved_shortest(shaper)
    one = design.specified_insensitivity(design.bands_of_sets([folded], spread=0.02))
    assert one.duration < shaper.duration and largest(one, [(4.1, 4.1, 0.01)]) > 0.05


def test_fewer_impulses_take_longer_and_say_what_the_optimum_is() -> None:
    optimum = design.specified_insensitivity(TWO)
    five = design.specified_insensitivity(TWO, at_most=5)
    assert len(optimum) == 6 and len(five) == 5 and five.design.status == "feasible"
    assert largest(five, TWO, 5001) <= 0.05 * (1.0 + 1e-6)
    assert five.design.settings["gap"] == pytest.approx(1.0 - optimum.duration / five.duration, rel=1e-9)
    assert design.specified_insensitivity(TWO, at_most=6) == optimum
    with pytest.raises(InputError, match="at most 3 impulses was found .* 6 impulses do it in 1.00322 s"):
        design.specified_insensitivity(TWO, at_most=3)


def test_on_a_grid_one_slot_fewer_is_impossible() -> None:
    from scipy.optimize import linprog

    dt, band = 0.02, (0.9, 1.1)
    shaper = design.specified_insensitivity(band, dt=dt)
    slots = round(shaper.duration / dt)
    np.testing.assert_allclose(shaper.times / dt, np.rint(shaper.times / dt), atol=1e-9)
    assert shaper.design.status == "optimal" and largest(shaper, [band], 4001) <= 0.05 * (1.0 + 1e-5)
    frequencies = np.linspace(*band, 60)
    for fewer, possible in ((slots, True), (slots - 1, False)):
        # undamped and symmetric about the middle, V is linear
        times = np.arange(fewer + 1) * dt - 0.5 * fewer * dt
        rows = np.cos(2.0 * np.pi * np.multiply.outer(frequencies, times))
        answer = linprog(
            np.append(np.zeros(times.size), 1.0),
            A_ub=np.block([[rows, -np.ones((60, 1))], [-rows, -np.ones((60, 1))]]),
            b_ub=np.zeros(120),
            A_eq=np.append(np.ones(times.size), 0.0)[None, :],
            b_eq=[1.0],
            method="highs-ipm",
        )
        assert (float(answer.fun) <= 0.05 * (1.0 + 1e-6)) is possible


@pytest.mark.parametrize(("levels", "shortest"), [((0.0, 1.0), 1.0 / 3.0), ((-1.0, 1.0), 0.290215)])
def test_levels_in_bounds_give_the_unity_magnitude_and_partial_sum_shapers_to_a_slot(
    levels: tuple[float, float], shortest: float
) -> None:
    """Zero vibration of 1 Hz with partial sums in [0, 1] or [-1, 1]: UM-ZV takes T/3, PS-ZV .290215 T."""
    dt = 0.005
    found = minimum_duration([ZeroVibration(Mode(1.0)), PartialSumsBetween(*levels), ServoGrid(dt)])
    sums = np.cumsum(found.amplitudes)
    assert found.status == "optimal" and levels[0] - 1e-6 <= sums.min() and sums.max() <= levels[1] + 1e-6
    assert shortest - 1e-6 <= found.times[-1] <= shortest + dt + 1e-9
    waves = np.exp(-2j * np.pi * (found.times[-1] - found.times))
    assert abs(waves @ found.amplitudes) < 1e-7
    shaper = design.specified_insensitivity((0.9, 1.1), dt=0.02, partial_sums=levels)
    assert largest(shaper, [(0.9, 1.1)]) <= 0.05 * (1.0 + 1e-5)
    assert shaper.design.settings["high_frequency_gain"] > 1.5


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"bands": (0.0, 1.1)}, "0 Hz"),
        ({"bands": (1.1, 0.9)}, "lower one first"),
        ({"bands": (math.nan, 1.0)}, "finite"),
        ({"bands": (0.9, 1.1, 0.5, 1.0)}, r"outside \[0, 1\)"),
        ({"bands": []}, "no band"),
        ({"bands": "x"}, "not a band"),
        ({"bands": (0.9, 1.1), "tolerance": 1.5}, "outside"),
        ({"bands": (0.1, 10.0)}, "too wide"),
        ({"bands": TWO, "dt": 0.3}, "coarser than half a period of 3.3 Hz: give dt below 0.1515"),
        ({"bands": TWO, "impulses": (-1.0, 1.0)}, "need a servo grid"),
        ({"bands": TWO, "impulses": (-1.0, -0.5), "dt": 0.01}, "cannot sum to 1"),
        ({"bands": TWO, "partial_sums": (0.0, 0.5), "dt": 0.01}, "cannot end at 1"),
        ({"bands": TWO, "at_most": 0}, "whole number"),
    ],
)
def test_what_cannot_be_done_is_said_in_one_sentence(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        design.specified_insensitivity(**arguments)  # type: ignore[arg-type]
