"""Modes too near for the arithmetic: what is promised then is met, and what is left open is admitted."""

from __future__ import annotations

import math

import numpy as np
import pytest

from preshape import Modes, design
from preshape.engine import convolved_positive, is_proved_shortest, shortest_positive
from preshape.engine.basis import Basis
from preshape.engine.unresolved import halves, is_resolved, thinned
from preshape.errors import InputError
from preshape.vibration import residual_vibration

SEVERAL = Modes([(3.0, 0.1), (1.0, 0.0), (2.0, 0.05), (1.1, 0.0), (5.0, 0.2)])

UNRESOLVED = {
    "three, order 6": ([(1.0, 0.0), (1.0005, 0.0), (1.001, 0.0)], 6),
    "ten in a thousandth": ([(1.0 + 1e-4 * i, 0.0) for i in range(10)], 1),
    "ten, order 2": ([(1.0 + 0.01 * i, 0.0) for i in range(10)], 2),
}
"""Undamped clusters: n constraints in all on nearly one mode need n / 2 of its periods."""


def zeros(modes: Modes, orders: tuple[int, ...], times: np.ndarray, amplitudes: np.ndarray) -> np.ndarray:
    """sum a (t/T)^k exp(s (t - T)), written out anew."""
    sums = []
    for mode, order in zip(modes, orders, strict=True):
        w = 2.0 * math.pi * mode.frequency
        s = complex(mode.damping * w, w * math.sqrt(1.0 - mode.damping**2))
        wave = amplitudes * np.exp(s * (times - times[-1]))
        sums += [abs((wave * (times / times[-1]) ** k).sum()) for k in range(order + 1)]
    return np.array(sums)


@pytest.mark.parametrize("orders", [(0, 0, 0, 0, 0), (1, 1, 1, 1, 1), (2, 0, 3, 1, 0)])
def test_the_convolved_shaper_meets_every_order_and_is_as_long_as_its_half_periods(orders: tuple[int, ...]) -> None:
    shaper = convolved_positive(SEVERAL, orders)
    assert (shaper.amplitudes > 0.0).all()
    assert zeros(SEVERAL, orders, shaper.times, shaper.amplitudes).max() < 1e-14
    half_periods = [0.5 / (mode.frequency * math.sqrt(1.0 - mode.damping**2)) for mode in SEVERAL]
    wanted = sum((order + 1) * half for order, half in zip(orders, half_periods, strict=True))
    assert shaper.duration == pytest.approx(wanted, rel=1e-12)


def test_halves_take_every_other_mode_with_its_order() -> None:
    (first, first_orders), (second, second_orders) = halves(SEVERAL, (0, 1, 2, 3, 4))
    assert [mode.frequency for mode in first] == [1.0, 2.0, 5.0] and first_orders == (1, 2, 4)
    assert [mode.frequency for mode in second] == [1.1, 3.0] and second_orders == (3, 0)


@pytest.mark.parametrize("name", UNRESOLVED)
def test_thinned_constraints_are_some_of_the_constraints_and_can_be_told_apart(name: str) -> None:
    modes, order = Modes(UNRESOLVED[name][0]), UNRESOLVED[name][1]
    orders = (order,) * len(modes)
    duration = len(modes) * (order + 1) / 2.0 / modes[0].frequency
    assert not is_resolved(Basis(modes, orders, duration))
    fewer, lower = thinned(modes, orders, duration)
    assert is_resolved(Basis(fewer, lower, duration))
    assert sum(lower) + len(lower) < sum(orders) + len(orders)
    asked = {mode: order for mode, order in zip(modes, orders, strict=True)}
    assert all(mode in asked and found <= asked[mode] for mode, found in zip(fewer, lower, strict=True))


def test_what_can_be_told_apart_is_not_thinned() -> None:
    assert is_resolved(Basis(SEVERAL, (1,) * 5, 2.0))
    assert thinned(SEVERAL, (1,) * 5, 2.0) == (SEVERAL, (1,) * 5)


@pytest.mark.parametrize("name", UNRESOLVED)
def test_nothing_is_promised_that_is_not_so(name: str) -> None:
    modes, order = UNRESOLVED[name]
    shaper = design.direct(modes, order)
    count = len(modes) * (order + 1)
    low, high = count / 2.0 / modes[-1][0], count / 2.0 / modes[0][0]
    assert (shaper.amplitudes > 0.0).all()
    assert zeros(Modes(modes), (order,) * len(modes), shaper.times, shaper.amplitudes).max() < 1e-13
    assert low * (1.0 - 1e-9) <= shaper.duration <= design.zvdk(modes, order).duration * (1.0 + 1e-9)
    if shaper.design.status == "optimal":
        assert is_proved_shortest(shaper) and shaper.duration <= high * (1.0 + 1e-9)
    else:
        assert shaper.design.status == "feasible" and shaper.design.certificate is None
        assert not is_proved_shortest(shaper)
        gap = shaper.design.settings["gap"]
        assert 0.0 < gap < 1.0 and shaper.duration * (1.0 - gap) <= high * (1.0 + 1e-9)


@pytest.mark.parametrize("ratio", [1.0 + 1e-8, 1.0 + 1e-6, 1.0005, 1.01])
@pytest.mark.parametrize("order", [0, 1, 3, 6])
def test_two_modes_are_never_too_near(ratio: float, order: int) -> None:
    """Hyde's rule for two undamped modes, (order + 1) 2 / (f1 + f2): found and proved at any distance."""
    found = shortest_positive(Modes([(1.0, 0.0), (ratio, 0.0)]), (order, order))
    assert found.certificate is not None and found.certificate.holds and found.gap == 0.0
    assert found.times[-1] == pytest.approx((order + 1) * 2.0 / (1.0 + ratio), rel=1e-8)


@pytest.mark.parametrize("seed", [4])
def test_modes_that_floating_point_does_not_hold_together_are_solved_apart(seed: int) -> None:
    """Ten modes of 150 Hz to 90 kHz, damped up to 0.9: the fast ones fall by more than 300 orders of magnitude."""
    rng = np.random.default_rng(seed)
    pairs = list(zip(np.geomspace(150.0, 90e3, 10), rng.uniform(0.3, 0.9, 10), strict=True))
    shaper = design.direct(pairs, 1)
    assert shaper.duration < design.zvd(pairs).duration
    assert max(residual_vibration(shaper, *pair) for pair in pairs) < 1e-12


def test_functions_that_floating_point_does_not_hold_are_refused_in_a_sentence() -> None:
    pairs = zip(np.geomspace(150.0, 90e3, 10), np.random.default_rng(4).uniform(0.3, 0.9, 10), strict=True)
    modes = Modes(list(pairs))
    basis = Basis(modes, (1,) * 10, 0.05, ())
    assert basis.size == 0 and not is_resolved(basis)
    with pytest.raises(InputError, match="floating point holds: leave out the fastest"):
        basis(np.zeros(1))
