"""Machines at work, shaken by what nobody measured: modes of all outputs together."""

import numpy as np
import pytest
from tests.identify.simulation import carried, working

from preshape.errors import InputError
from preshape.identify import TimeSeries, find_modes, operational_modes

MODES = [(1.5, 0.01), (4.2, 0.02), (8.8, 0.008)]
SHAPES = np.array([[0.33, 0.74, 0.59], [0.60, 0.33, -0.74], [0.74, -0.59, 0.33]])


def record(seed, modes=MODES, shapes=SHAPES, **settings):
    rng = np.random.default_rng(seed)
    values = working(modes, shapes, rng, **settings)
    return TimeSeries(50.0, 0.0, values, ("a", "b", "c"), "m/s")


def nearest(found, frequency):
    return min(found.modes, key=lambda mode: abs(mode.mode.frequency - frequency))


def test_three_modes_their_scatter_and_their_intervals():
    """Scatter within a third of the bound 1 / sqrt(2 pi z f T) for a damping ratio, and 95 % intervals that hold it."""
    covered, errors = [], []
    for seed in range(30):
        found = find_modes(record(seed))
        assert (found.method, found.clear) == ("operational", True)
        assert len(found.modes) == 3
        for frequency, damping in MODES:
            mode = nearest(found, frequency)
            covered.append(mode.frequency_interval[0] <= frequency <= mode.frequency_interval[1])
            covered.append(mode.damping_interval[0] <= damping <= mode.damping_interval[1])
            errors.append(np.log(mode.mode.damping / damping) * np.sqrt(2 * np.pi * damping * frequency * 600.0))
            assert abs(mode.mode.frequency / frequency - 1.0) < 0.01
    assert np.sqrt(np.mean(np.square(errors))) < 1.34
    assert 0.88 <= np.mean(covered) <= 0.995


def test_one_output_is_enough():
    values = carried(np.random.default_rng(9).normal(size=60_000), 1000.0, (40.0, 0.05))
    found = find_modes(TimeSeries(1000.0, 0.0, values[None, :], ("x",)))
    assert found.method == "operational"
    mode = found.modes[0]
    assert mode.mode.frequency == pytest.approx(40.0, rel=0.02)
    assert mode.damping_interval[0] <= 0.05 <= mode.damping_interval[1]


def test_the_order_is_found():
    """Six states are the truth: the lowest order at which all three columns stand is near it."""
    diagram = find_modes(record(0)).stabilisation
    assert 6 <= diagram.order <= 12
    assert diagram.orders.shape == diagram.frequencies.shape == diagram.stable.shape == diagram.chosen.shape
    assert set(diagram.orders[diagram.chosen]) == {diagram.order}
    assert diagram.stable[diagram.chosen].all()
    for frequency, _ in MODES:
        near = np.abs(diagram.frequencies / frequency - 1.0) < 0.02
        assert diagram.stable[near].sum() > 8


def test_near_modes_with_different_shapes_are_two():
    found = find_modes(record(1, modes=[(4.0, 0.01), (4.15, 0.01), (9.0, 0.01)]))
    assert [round(mode.mode.frequency, 1) for mode in sorted(found.modes, key=lambda m: m.mode.frequency)] in (
        [4.0, 4.1, 9.0],
        [4.0, 4.2, 9.0],
    )


def test_a_steady_line_is_no_mode():
    rng = np.random.default_rng(1)
    values = carried(rng.normal(size=120_000), 200.0, (12.0, 0.02))
    line = 0.8 * values.std() * np.sin(2 * np.pi * 24.7 * np.arange(values.size) / 200.0)
    found = find_modes(TimeSeries(200.0, 0.0, (values + line)[None, :], ("x",)))
    assert [round(mode.mode.frequency) for mode in found.modes] == [12]
    assert found.modes[0].damping_interval[0] <= 0.02 <= found.modes[0].damping_interval[1]


@pytest.mark.parametrize("seed", range(6))
def test_white_noise_has_no_modes(seed):
    values = np.random.default_rng(seed).normal(size=(1, 60_000))
    series = TimeSeries(1000.0, 0.0, values, ("x",))
    assert operational_modes(series).modes == ()
    assert not find_modes(series).clear


def test_a_short_record_says_so():
    few = operational_modes(record(0, samples=1500))
    assert few.modes == ()
    assert any("record at least" in sentence for sentence in few.trouble)
    short = find_modes(record(3, samples=5000))
    assert any("about" in sentence and "would give 20 %" in sentence for sentence in short.trouble)
    for mode in short.modes:
        truth = min(MODES, key=lambda each: abs(each[0] - mode.mode.frequency))
        assert mode.damping_interval[0] <= truth[1] <= mode.damping_interval[1]


def test_gravity_and_a_dead_channel_do_no_harm():
    series = record(4)
    values = np.concatenate([series.values + 9.81, np.full((1, series.values.shape[-1]), 3.0)])
    found = find_modes(TimeSeries(50.0, 0.0, values, ("a", "b", "c", "dead"), "m/s"))
    plain = find_modes(series)
    for mode, other in zip(found.modes, plain.modes, strict=True):
        assert mode.mode.frequency == pytest.approx(other.mode.frequency, rel=1e-6)


def test_the_fitted_density_is_the_measured_one():
    found = find_modes(record(5))
    inside = np.isfinite(found.fitted) & (found.spectrum.total > 0.01 * found.spectrum.total.max())
    assert np.abs(np.log(found.fitted[inside] / found.spectrum.total[inside])).mean() < 0.35


def test_several_measurements_are_one_machine():
    records = [record(seed) for seed in (6, 7)]
    joint = find_modes(records)
    single = [find_modes(each) for each in records]
    assert len(joint.each) == 2
    assert joint.method == "operational"
    for mode in joint.modes:
        parts = [nearest(each, mode.mode.frequency) for each in single]
        assert mode.damping_interval[0] == min(part.damping_interval[0] for part in parts)
        assert mode.damping_interval[1] == max(part.damping_interval[1] for part in parts)
    assert joint.fitted.shape == joint.spectrum.frequencies.shape


def test_several_of_different_units_and_none():
    with pytest.raises(InputError, match="different units"):
        find_modes([record(6), TimeSeries(50.0, 0.0, record(7).values, ("a", "b", "c"), "g")])
    with pytest.raises(InputError, match="at least one"):
        find_modes([])
