from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.vibration import residual_vibration

IMPULSE = '{"schema": "preshape/shaper/1", "times": [0], "amplitudes": [1], '
amplitudes = st.lists(st.floats(0.01, 1.0), min_size=1, max_size=8)
gaps = st.lists(st.floats(0.01, 1.0), min_size=8, max_size=8)


def shaper_of(weights: list[float], steps: list[float]) -> Shaper:
    return Shaper.normalised(np.concatenate([[0.0], np.cumsum(steps)])[: len(weights)], weights)


def naive_shape(
    command: list[float], times: list[float], weights: list[float], dt: float, initial: float
) -> list[float]:
    """Six lines: each output sample asks each impulse where in the command it looks, linearly between samples."""
    end = len(command) + math.ceil(times[-1] / dt - 1e-9)
    history = [initial, *command, *([command[-1]] * (end + 2))]
    out = []
    for n in range(end):
        positions = [n - t / dt for t in times]
        looks = [np.interp(p, np.arange(-1, len(history) - 1), history) if p > -1 else initial for p in positions]
        out.append(float(np.dot(weights, looks)))
    return out


@given(amplitudes, gaps, amplitudes, gaps, st.floats(0.1, 4.0), st.floats(0.0, 0.5))
def test_convolution_multiplies_the_transfer_functions(
    a: list[float], s: list[float], b: list[float], t: list[float], frequency: float, damping: float
) -> None:
    first, second = shaper_of(a, s), shaper_of(b, t)
    both = first * second
    assert both.amplitudes.sum() == pytest.approx(1.0, abs=1e-12)
    assert both.duration == pytest.approx(first.duration + second.duration)
    assert both.centroid == pytest.approx(first.centroid + second.centroid)
    product = residual_vibration(first, frequency, damping) * residual_vibration(second, frequency, damping)
    assert residual_vibration(both, frequency, damping) == pytest.approx(float(product), rel=1e-9, abs=1e-12)


def test_coincident_impulses_merge_and_near_ones_do_not() -> None:
    zvd = Shaper([0.0, 0.1], [0.5, 0.5]) * Shaper([0.0, 0.1], [0.5, 0.5])
    assert len(zvd) == 3
    assert len(Shaper([0.0, 0.1], [0.5, 0.5]) * Shaper([0.0, 0.1 + 1e-7], [0.5, 0.5])) == 4


def test_times_that_differ_by_rounding_are_one() -> None:
    first, second = Shaper([0.0, 0.1, 0.3], [0.25, 0.25, 0.5]), Shaper([0.0, 0.2], [0.5, 0.5])
    assert 0.1 + 0.2 != 0.3
    assert len(first * second) == 5


def test_merging_keeps_the_centroid() -> None:
    times, weights = [0.0, 0.5, 0.5 + 4e-10, 1.0], [0.25, 0.25, 0.25, 0.25]
    merged = Shaper.normalised(times, weights)
    assert len(merged) == 3
    assert merged.centroid == pytest.approx(float(np.dot(times, weights)), abs=1e-15)


def test_merging_a_vanishing_impulse_does_not_lose_its_time() -> None:
    assert Shaper.normalised([0.0, 0.001], [1.0, 5e-324]).duration == 0.001


@given(amplitudes, gaps, st.floats(0.003, 0.7), st.lists(st.floats(-5, 5), min_size=1, max_size=30), st.floats(-2, 2))
def test_shaping_agrees_with_the_naive_reference(
    a: list[float], s: list[float], dt: float, command: list[float], initial: float
) -> None:
    shaper = shaper_of(a, s)
    expected = naive_shape(command, shaper.times.tolist(), shaper.amplitudes.tolist(), dt, initial)
    np.testing.assert_allclose(shaper.shape(command, dt, initial=initial), expected, atol=1e-7)


def test_shape_works_along_any_axis_and_over_many_blocks() -> None:
    rng = np.random.default_rng(1)
    shaper = design.zvd((3.0, 0.1))
    command = rng.normal(size=(2, 20_000, 3))
    along = shaper.shape(command, 0.01, axis=1)
    for i in range(2):
        for j in range(3):
            np.testing.assert_array_equal(along[i, :, j], shaper.shape(command[i, :, j], 0.01))
    delays, weights = shaper.taps(0.01)
    kernel = np.zeros(delays.max() + 1)
    kernel[delays] = weights
    np.testing.assert_allclose(along[0, :20_000, 0], np.convolve(command[0, :, 0], kernel)[:20_000], atol=1e-13)


def test_taps_keep_the_sum_and_the_mean_delay() -> None:
    shaper = design.direct([(1.0, 0.02), (2.7, 0.0)])
    delays, weights = shaper.taps(0.0131)
    assert weights.sum() == pytest.approx(1.0, abs=1e-14)
    assert delays @ weights * 0.0131 == pytest.approx(shaper.centroid, rel=1e-13)


def test_splitting_between_samples_costs_what_the_docstring_says() -> None:
    frequency, dt = 20.0, 0.001
    shaper = design.zv((frequency, 0.0))
    shifted = Shaper([0.0, shaper.duration], shaper.amplitudes)
    bound = (math.pi * frequency * dt) ** 2 / 2.0
    worst = 0.0
    for offset in np.linspace(0.0, dt, 11):
        delays, weights = Shaper([0.0, shaper.duration + offset], shifted.amplitudes).taps(dt)
        grid, exact = Shaper(delays * dt, weights), Shaper([0.0, shaper.duration + offset], shifted.amplitudes)
        worst = max(worst, abs(float(residual_vibration(grid, frequency) - residual_vibration(exact, frequency))))
    assert worst <= bound


@pytest.mark.parametrize(
    ("times", "weights", "sentence"),
    [
        ([0.0, 1.0], [0.5], "one of each an impulse"),
        ([], [], "at least one impulse"),
        ([0.1, 1.0], [0.5, 0.5], "at 0"),
        ([0.0, 1.0, 1.0], [0.5, 0.25, 0.25], "times must increase"),
        ([0.0, 2.0, 1.0], [0.5, 0.25, 0.25], "times must increase"),
        ([0.0, math.nan], [0.5, 0.5], "NaN or infinity at impulse 2"),
        ([0.0, 1.0], [math.inf, 0.5], "NaN or infinity at impulse 1"),
        ([0.0, 1.0], [0.5, 0.6], "sum to 1.1"),
        (["a", 1.0], [0.5, 0.5], "must be numbers"),
        ([[0.0, 1.0]], [[0.5, 0.5]], "flat list"),
    ],
)
def test_what_is_no_shaper_is_refused_with_the_rule(times: list[float], weights: list[float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        Shaper(times, weights)


def test_normalising_refuses_a_sum_of_zero() -> None:
    with pytest.raises(InputError, match="above zero"):
        Shaper.normalised([0.0, 1.0], [1.0, -1.0])


def test_a_shaper_cannot_be_changed() -> None:
    shaper = Shaper([0.0, 1.0], [0.5, 0.5])
    with pytest.raises(ValueError, match="read-only"):
        shaper.times[0] = 3.0
    with pytest.raises(AttributeError):
        shaper.times = np.zeros(2)


@pytest.mark.parametrize(
    ("dt", "command"), [(0.0, [1.0]), (-1.0, [1.0]), (math.nan, [1.0]), (0.1, []), (0.1, [math.nan])]
)
def test_bad_commands_and_sample_times_are_refused(dt: float, command: list[float]) -> None:
    with pytest.raises(InputError):
        Shaper([0.0, 1.0], [0.5, 0.5]).shape(command, dt)


def test_a_saved_shaper_comes_back_with_its_proof(tmp_path: Path) -> None:
    shaper = design.direct([(1.0, 0.02), (2.7, 0.0)])
    path = shaper.save(tmp_path / "shaper.json")
    again = Shaper.load(path)
    assert again == shaper
    certificate = again.design.certificate
    assert certificate is not None and certificate.holds
    times = np.linspace(0.0, shaper.duration, 500)
    np.testing.assert_array_equal(certificate.polynomial(times), shaper.design.certificate.polynomial(times))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "is not JSON"),
        ("{", "is not JSON"),
        ("\x00\xff", "is not JSON"),
        ("[1, 2]", "schema None"),
        ('{"schema": "preshape/shaper/9"}', "schema 'preshape/shaper/9'"),
        ('{"schema": "preshape/shaper/1"}', "at least one impulse"),
        ('{"schema": "preshape/shaper/1", "times": [0, 1], "amplitudes": [0.5, "x"]}', "must be numbers"),
        (
            IMPULSE + '"design": {"modes": [{"frequency": -1}]}}',
            "0 Hz",
        ),
        (IMPULSE + '"design": {"status": "best"}}', "not known"),
        (IMPULSE + '"design": []}', "not a preshape/shaper/1"),
    ],
)
def test_a_broken_shaper_file_is_named_with_its_fault(tmp_path: Path, text: str, sentence: str) -> None:
    path = tmp_path / "broken.json"
    path.write_text(text, encoding="latin-1")
    with pytest.raises(InputError, match=sentence) as caught:
        Shaper.load(path)
    assert "broken.json" in str(caught.value)


def test_a_missing_or_huge_shaper_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read"):
        Shaper.load(tmp_path / "nothing.json")
    huge = tmp_path / "huge.json"
    with open(huge, "wb") as stream:
        stream.truncate(10_000_001)
    with pytest.raises(InputError, match="larger than 10 MB"):
        Shaper.load(huge)


def test_printing_shows_every_impulse_with_units() -> None:
    text = str(design.zvd((10.0, 0.1)))
    assert "time [s]" in text and "amplitude [-]" in text and "10 Hz, damping 0.1" in text
    assert text.count("+0.") == 3


def test_the_file_format_is_the_documented_one() -> None:
    data = json.loads(json.dumps(design.zv((10.0, 0.0)).to_dict()))
    assert set(data) == {"schema", "times", "amplitudes", "duration", "design"}
    assert data["schema"] == "preshape/shaper/1"
    assert data["duration"] == data["times"][-1] == 0.05
