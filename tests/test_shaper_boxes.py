"""Shapers with parts of constant density, against quadrature, dense impulses and an exact simulation."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from preshape import Shaper, design
from preshape.cli.main import main
from preshape.engine import is_proved_shortest
from preshape.errors import InputError
from preshape.export import klipper
from preshape.kernel import box_exponentials
from preshape.plant import ModalPlant
from preshape.profile import Profile
from preshape.shaper_parts import Box
from preshape.vibration import (
    deflection_ratio,
    high_frequency_gain,
    insensitivity,
    residual_vibration,
    tolerated_bands,
)
from preshape.workflow import analyze

boxed = st.builds(
    lambda weights, steps, shares: Shaper.normalised(
        np.concatenate([[0.0], np.cumsum(steps[:2])]),
        weights,
        boxes=[
            (steps[0] / 2, steps[0], shares[0] / steps[0]),
            (steps[0] + steps[1], sum(steps), shares[1] / steps[2]),
        ],
    ),
    st.lists(st.floats(0.05, 1.0), min_size=3, max_size=3),
    st.lists(st.floats(0.05, 1.0), min_size=3, max_size=3),
    st.lists(st.floats(0.05, 1.0), min_size=2, max_size=2),
)
ONE = Shaper([0.0, 0.7], [0.3, 0.2], boxes=[(0.2, 0.5, 1.0), (0.5, 1.1, 1.0 / 3.0)])


def by_quadrature(shaper: Shaper, frequency: float, damping: float) -> float:
    """V from its definition, the boxes by numerical integration."""
    rate = 2.0 * math.pi * frequency * complex(damping, math.sqrt(1.0 - damping**2))
    value = complex(shaper.amplitudes @ np.exp(rate * (shaper.times - shaper.duration)))
    for start, end, density in shaper.boxes:
        for part, unit in ((np.real, 1.0), (np.imag, 1j)):
            area, _ = quad(lambda t: float(part(np.exp(rate * (t - shaper.duration)))), start, end, epsabs=1e-13)  # noqa: B023
            value += density * area * unit
    return abs(value)


def dense(shaper: Shaper, pieces: int) -> Shaper:
    """Every box as so many impulses at the middles of its parts."""
    times, amplitudes = [*shaper.times], [*shaper.amplitudes]
    for box in shaper.boxes:
        times += list(box.start + (np.arange(pieces) + 0.5) / pieces * (box.end - box.start))
        amplitudes += [box.mass / pieces] * pieces
    return Shaper.normalised(times, amplitudes)


@given(boxed, st.floats(0.0, 4.0), st.floats(0.0, 0.4))
def test_residual_vibration_is_the_integral(shaper: Shaper, frequency: float, damping: float) -> None:
    value = float(residual_vibration(shaper, frequency, damping))
    assert value == pytest.approx(by_quadrature(shaper, frequency, damping), abs=1e-12)


@given(boxed, st.floats(0.1, 4.0), st.floats(0.0, 0.4))
def test_the_plant_keeps_what_the_formula_says(shaper: Shaper, frequency: float, damping: float) -> None:
    plant, step = ModalPlant((frequency, damping)), Profile.steps([0.0], [1.0])
    unshaped = plant.motion(step).residual_amplitudes[0]
    shaped = plant.motion(shaper.shape(step)).residual_amplitudes[0]
    assert shaped / unshaped == pytest.approx(float(residual_vibration(shaper, frequency, damping)), abs=1e-12)


def test_the_integral_keeps_its_digits_where_the_rate_vanishes() -> None:
    boxes = np.array([[-3.0, -1.0, 0.25], [-1.0, 0.0, 0.5]])
    for rate in (0.0, 1e-300, 1e-17, 1e-9, 1e-5j, -1e-7 + 1e-7j):
        for moment in (0, 1):
            powers = [0.25 * ((-1.0) ** k - (-3.0) ** k) / k - 0.5 * (-1.0) ** k / k for k in range(1, 5)][moment:]
            found = complex(box_exponentials(boxes, np.array([rate], dtype=complex), moment)[0])
            series = powers[0] + rate * powers[1] + rate**2 * powers[2] / 2.0
            assert abs(found - series) < 1e-15 + abs(rate) ** 3 * 10.0
    assert float(residual_vibration(ONE, 0.0)) == pytest.approx(1.0, abs=1e-15)
    uniform = residual_vibration(ONE, np.linspace(0.0, 3.0, 301), 0.1)
    one_by_one = [float(residual_vibration(ONE, f, 0.1)) for f in np.linspace(0.0, 3.0, 301)]
    np.testing.assert_allclose(uniform, one_by_one, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_band_edges_are_where_the_vibration_is_the_tolerance(damping: float) -> None:
    shaper = design.sd_zv((1.0, damping), 0.3, "box")
    for low, high in tolerated_bands(shaper, 0.05, damping, 0.2, 6.0)[:-1]:
        assert [by_quadrature(shaper, f, damping) for f in (low, high)] == pytest.approx([0.05, 0.05], abs=1e-12)
    found = insensitivity(shaper, (1.0, damping))
    inside = residual_vibration(shaper, np.linspace(found.low, found.high, 501), damping)
    assert inside.max() <= 0.05 * (1.0 + 1e-8)
    assert found.low < 1.0 < found.high


@given(boxed, st.floats(0.01, 0.3))
def test_taps_are_the_linear_split_of_the_density(shaper: Shaper, dt: float) -> None:
    delays, weights = shaper.taps(dt)
    assert (np.diff(delays) > 0).all()
    assert delays[-1] == math.ceil(shaper.duration / dt * (1.0 - 1e-9))
    assert weights.sum() == pytest.approx(1.0, abs=1e-12)
    assert dt * (weights @ delays) == pytest.approx(shaper.centroid, abs=1e-12)
    fine = dense(shaper, 1000).taps(dt)
    spread = np.zeros(delays[-1] + 1)
    spread[fine[0]] = fine[1]
    np.testing.assert_allclose(weights, spread[delays], rtol=0.0, atol=1e-5)


def test_a_box_shorter_than_rounding_is_an_impulse_on_the_grid() -> None:
    delays, weights = Shaper.normalised([0.0], [0.5], boxes=[(0.3, 0.3 + 1e-12, 0.5e12)]).taps(0.1)
    assert delays.tolist() == [0, 3]
    np.testing.assert_allclose(weights, [0.5, 0.5], rtol=1e-4)


@given(boxed, st.lists(st.floats(0.05, 1.0), min_size=3, max_size=3), st.floats(0.1, 4.0), st.floats(0.0, 0.4))
def test_convolution_with_impulses_multiplies(shaper: Shaper, steps: list[float], f: float, z: float) -> None:
    other = Shaper.normalised(np.cumsum(steps), [0.3, 0.5, 0.2])
    both, same = shaper * other, other * shaper
    assert both.duration == pytest.approx(shaper.duration + other.duration)
    assert both.centroid == pytest.approx(shaper.centroid + other.centroid)
    product = float(residual_vibration(shaper, f, z) * residual_vibration(other, f, z))
    for one in (both, same):
        assert float(residual_vibration(one, f, z)) == pytest.approx(product, abs=1e-12)
        assert all(a.end <= b.start for a, b in zip(one.boxes, one.boxes[1:], strict=False))


def test_what_has_no_boxes_is_refused_with_a_remedy() -> None:
    with pytest.raises(InputError, match=r"both shapers have boxes.*on_grid"):
        ONE.convolve(ONE)
    assert float(residual_vibration(ONE * design.on_grid(ONE, 0.01), 1.0)) < float(residual_vibration(ONE, 1.0))
    modes = design.sd_zv((1.0, 0.1), 0.3, "box")
    for refused in (
        lambda: design.squashed(ONE, 0.1),
        lambda: design.interpreted(modes, 0.1),
        lambda: design.solved_from(modes),
        lambda: design.rounded(modes, 0.01),
    ):
        with pytest.raises(InputError, match=r"impulses only.*on_grid"):
            refused()
    assert design.rounded(modes, 0.01, order=0, neighbours=True).design.residual < 1e-9
    assert not is_proved_shortest(modes)


def test_the_file_keeps_the_boxes(tmp_path: Path) -> None:
    again = Shaper.load(ONE.save(tmp_path / "shaper.json"))
    assert again == ONE and hash(again) == hash(ONE) and again.boxes == ONE.boxes
    assert json.loads((tmp_path / "shaper.json").read_text())["boxes"][0] == {"start": 0.2, "end": 0.5, "density": 1.0}
    assert "boxes" not in design.zv((1.0, 0.0)).to_dict()
    other = Shaper(ONE.times, ONE.amplitudes, boxes=[(0.2, 0.7, 1.0)])
    assert other != ONE and hash(other) != hash(ONE)
    data = ONE.to_dict()
    for wrong in ([1], [{"start": 0.0}], {"start": 0.0}, [{"start": 0.0, "end": 1.0, "density": 0.5, "more": 1.0}]):
        with pytest.raises(InputError, match=r"preshape/shaper/1"):
            Shaper.from_dict({**data, "boxes": wrong})


@pytest.mark.parametrize(
    ("boxes", "words"),
    [
        ([(0.5, 0.2, 1.0)], "begin at or after 0 s and end later"),
        ([(0.0, 0.5, 0.6), (0.4, 0.8, 0.5)], "split those that overlap"),
        ([(-0.5, 0.5, 0.5)], "begin at or after 0 s"),
        ([(0.0, 1.0)], "three numbers each"),
        ([(0.0, 1.0, math.nan)], "NaN or infinity"),
        (["abc"], "three numbers each"),
        ([(0.0, 1.0, 0.4)], "boxes' shares sum to 0.9, not 1"),
    ],
)
def test_wrong_boxes_get_a_sentence(boxes: list[tuple[float, float, float]], words: str) -> None:
    with pytest.raises(InputError, match=words):
        Shaper([0.0, 0.7], [0.3, 0.2], boxes=boxes)


def test_normalising_counts_the_boxes_and_moves_them_with_the_impulses() -> None:
    shaper = Shaper.normalised([2.0, 1.0], [3.0, 1.0], boxes=[(1.5, 2.5, 4.0)])
    assert shaper.times.tolist() == [0.0, 1.0] and shaper.amplitudes.tolist() == [0.125, 0.375]
    assert shaper.boxes == (Box(0.5, 1.5, 0.5),)
    assert shaper.duration == 1.5 and shaper.centroid == pytest.approx(0.375 + 0.5)
    average = Shaper.normalised([0.0], [0.0], boxes=[(0.0, 2.0, 3.0)])
    assert average.boxes == (Box(0.0, 2.0, 0.5),) and average.centroid == 1.0
    twice = average * design.zv((1.0, 0.0))
    assert [tuple(box) for box in twice.boxes] == [(0.0, 0.5, 0.25), (0.5, 2.0, 0.5), (2.0, 2.5, 0.25)]
    with pytest.raises(InputError, match="sum must be above zero"):
        Shaper.normalised([0.0], [1.0], boxes=[(0.0, 1.0, -1.0)])


def test_it_says_what_it_is_made_of() -> None:
    assert "2 impulses and 2 boxes in 1.1 s" in repr(ONE)
    assert "0.200000000   0.500000000   +1.000000000" in str(ONE)
    assert "box" not in str(design.zv((1.0, 0.0)))


def test_a_command_arrives_and_a_function_is_averaged() -> None:
    assert ONE.shape(np.full(9, 2.5), 0.01, initial=2.5) == pytest.approx(np.full(9 + 110, 2.5), rel=1e-14)
    assert ONE.shape(np.ones((2, 5)), 0.013)[:, -1] == pytest.approx([1.0, 1.0], abs=1e-14)
    with pytest.raises(InputError, match="antiderivative"):
        ONE.shape_function(np.sin)
    looks = np.array([0.0, 1.3, 2.9])
    shaped = ONE.shape_function(np.sin, lambda t: -np.cos(t))(looks)
    np.testing.assert_allclose(shaped, dense(ONE, 4000).shape_function(np.sin)(looks), atol=1e-8)


def test_measures_of_a_shaper_are_those_of_dense_impulses() -> None:
    many = dense(ONE, 4000)
    assert ONE.magnitude == pytest.approx(1.0, abs=1e-15)
    assert klipper.smoothing(ONE) == pytest.approx(klipper.smoothing(many), rel=1e-6)
    assert klipper.maximum_acceleration(ONE) == pytest.approx(klipper.maximum_acceleration(many), rel=1e-6)
    lines = np.linspace(0.5, 3.0, 40)
    spectrum = (lines, 1.0 / (1.0 + 40.0 * (lines - 1.4) ** 2))
    scores = [klipper.remaining_vibration(one, spectrum) for one in (ONE, many)]
    assert scores[0] == pytest.approx(scores[1], rel=2e-4)  # V counts from the last impulse, here earlier by as much
    few = dense(ONE, 200)
    for mode in ((0.8, 0.0), (1.3, 0.1)):
        assert deflection_ratio(ONE, mode) == pytest.approx(deflection_ratio(few, mode), rel=1e-3)
    signed = Shaper([0.0, 0.4], [1.0, 0.5], boxes=[(0.1, 0.3, -2.5)])
    gain = high_frequency_gain(signed, 0.5)
    assert signed.magnitude == gain.bound == pytest.approx(2.0)
    searched = np.linspace(0.5, 5.0, 1001)
    found = dense(signed, 500)
    dft = np.abs(np.exp(-2j * np.pi * np.outer(searched, found.times)) @ found.amplitudes)
    assert gain.value == pytest.approx(dft.max(), rel=1e-4)


def test_on_a_grid_little_is_left() -> None:
    shaper = design.sd_zv((1.0, 0.1), 0.3, "box")
    assert shaper.design.residual < 1e-15
    for dt in (0.02, 0.01):
        coarse = design.on_grid(shaper, dt)
        assert coarse.boxes == () and coarse.centroid == pytest.approx(shaper.centroid, abs=1e-12)
        assert coarse.design.residual < (math.pi * dt) ** 2 / 2.0


def test_the_command_line_takes_such_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, command, out = tmp_path / "shaper.json", tmp_path / "command.csv", tmp_path / "out.csv"
    command.write_text("time,x\n" + "".join(f"{k / 100},{min(k, 50) / 50}\n" for k in range(80)))
    for line in (
        f"design --family sd_zv --mode 1:0.1 --deflection-ratio 0.3 --form box --json {file}",
        f"analyze {file}",
        f"shape {file} {command} --out {out}",
    ):
        with pytest.raises(SystemExit) as ended:
            main(line.split())
        shown = capsys.readouterr().out
        assert ended.value.code in (0, None), shown
        assert line.startswith("shape") or ("2 impulses and 1 box" in shown and "box from 0.235237000 s" in shown)
    assert float(out.read_text().splitlines()[-1].split(",")[1]) == pytest.approx(1.0, abs=1e-12)
    assert analyze(Shaper.load(file)).modes[0].residual < 1e-12
