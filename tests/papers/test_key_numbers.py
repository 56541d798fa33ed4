"""The numbers that matter most, once more and without the rows: by arithmetic of this file and exact simulation."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from preshape import Mode, Shaper, design
from preshape.papers import PAPERS, Row
from preshape.papers.hyde.lengths import CASES, Case
from preshape.papers.misprint import constraint
from preshape.papers.singh.signals import DAMPED, ENVELOPED, envelope, example_modes, response, signal
from preshape.plant import ModalPlant


def row_of(paper: str, start: str) -> Row:
    rows = next(one for one in PAPERS if one.name == paper).reproduce().rows
    return next(row for row in rows if row.what.startswith(start))


@pytest.mark.parametrize(("damping", "expected"), [(0.01, 9.6e-4), (0.05, 0.0212), (0.1, 0.0733), (0.2, 0.2241)])
def test_hyde_s_printed_equation_is_not_zero_for_his_own_closed_form(damping: float, expected: float) -> None:
    root = math.sqrt(1.0 - damping**2)
    k, half = math.exp(-damping * math.pi / root), math.pi / root  # w = 1 rad/s
    weights = [1.0, 2.0 * k, k * k]
    sums = [
        abs(sum(a * cmath.exp((sign * damping + 1j * root) * i * half) for i, a in enumerate(weights))) / sum(weights)
        for sign in (-1, +1)
    ]
    assert sums[0] == pytest.approx(expected, rel=5e-3)
    assert sums[1] < 1e-12
    mode = Mode(1.0 / (2.0 * math.pi), damping)
    assert constraint(design.zvd(mode), mode, sign=-1) == pytest.approx(sums[0], abs=1e-12)


def test_what_solves_the_printed_equations_leaves_27_percent() -> None:
    mode = Mode(1.0, 0.1)
    right = design.zv(mode)
    backwards = Shaper(right.times, right.amplitudes[::-1])
    assert constraint(backwards, mode, sign=-1) < 1e-12
    left = ModalPlant(mode).step_train(backwards.times, backwards.amplitudes).residual_amplitudes[0]
    unshaped = ModalPlant(mode).step_train([0.0], [1.0]).residual_amplitudes[0]
    assert left / unshaped == pytest.approx(0.2708, abs=5e-5)
    assert "27.1 %" in row_of("hyde", "vibration left by the two impulses").computed


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_certified_lengths_leave_nothing_and_are_not_beaten(case: Case) -> None:
    shaper = design.direct(case.modes)
    assert ModalPlant(case.modes).impulse_residual(shaper.times, shaper.amplitudes).max() < 1e-9
    assert shaper.duration == pytest.approx(case.certified, abs=2e-8)
    assert len(shaper) == case.impulses
    # The certificate, by this file's own arithmetic: a polynomial that vanishes for every solution of the constraints
    # and is nowhere negative, so that impulses can only be where it is zero.
    certificate = shaper.design.certificate
    assert certificate is not None
    times = np.linspace(0.0, shaper.duration, 20001)
    value = certificate.polynomial(times)
    assert value.min() > -1e-6 * value.max()
    assert certificate.polynomial(shaper.times).max() < 1e-6 * value.max()


def test_singh_s_two_impulses_leave_8_percent_of_the_lower_mode() -> None:
    decay = [0.01 * 2.0, 0.01 * 14.0]
    spacing = math.pi / 2.0
    first = 8.0 / (math.exp(-decay[0] * spacing) + 7.0 * math.exp(-decay[1] * spacing))
    a = [first / (1.0 + first), 1.0 / (1.0 + first)]
    assert a == pytest.approx([0.5484, 0.4516], abs=5e-5)
    left = [
        abs(a[0] * math.exp(-d * spacing) * cmath.exp(1j * w * spacing) + a[1])
        for d, w in zip(decay, (2.0, 14.0), strict=True)
    ]
    assert left == pytest.approx([0.0799, 0.0114], abs=1e-4)
    row = row_of("singh", "two impulses eliminate all the modes")
    assert row.verdict == "differs" and row.computed == "7.99, 1.14 %"
    simulated = ModalPlant(example_modes(DAMPED)).impulse_residual([0.0, spacing], a)
    assert simulated == pytest.approx(left, abs=1e-9)


def test_singh_s_signals() -> None:
    times = np.linspace(0.0, 9.0, 901)
    y = np.exp(-0.1 * times) * np.sin(times) + np.exp(-1.2 * times) * np.sin(3.0 * times) / 3.0
    assert np.abs(signal(ENVELOPED, 1.0, times) - y).max() < 1e-14
    assert np.abs(np.sin(times) * envelope(ENVELOPED, 1.0, times) - y).max() < 1e-12
    formula = sum(np.exp(-0.01 * w * times) * np.sin(w * times) for w in (2.0, 14.0))
    assert np.abs(response(Shaper([0.0], [1.0]), DAMPED, times) - formula).max() < 1e-10


def test_singer_s_bands_need_damping() -> None:
    for z, fits in ((0.0, False), (0.2, True)):
        for shape, low, high in ((design.zv, 5.0, 5.0), (design.zvd, 20.0, 20.0), (design.zvdd, 30.0, 40.0)):
            shaper = shape((1.0, z))
            edges = [-0.85 * low, 0.85 * high, -1.15 * low, 1.15 * high]
            v = [
                float(ModalPlant((1.0 + e / 100.0, z)).impulse_residual(shaper.times, shaper.amplitudes)[0])
                for e in edges
            ]
            assert (max(v[:2]) <= 0.05 <= min(v[2:])) == fits
