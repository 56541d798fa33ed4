"""Hyde's mesh: shortest on the grid and proved so, flattest, fewest; and the asks that end with a sentence."""

from __future__ import annotations

import json
import math
import time
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Modes, Shaper, design
from preshape.errors import InputError
from preshape.plant import ModalPlant
from preshape.vibration import residual_vibration

TWO = [(1.0, 0.0), (10.0, 0.0)]
ARM = [(0.20, 0.0), (0.26, 0.0), (0.45, 0.0), (0.59, 0.0)]
MACE = [(9.8, 0.0), (31.7, 0.0), (66.1, 0.0)]
OPEN_LOOP = [(f, 0.01) for f in (1.65, 5.42, 6.90, 19.08)]

TABLE = [
    ("Shuttle arm, 0.1 s", ARM, 0.1, 10.70, 17),
    ("Shuttle arm, 0.05 s", ARM, 0.05, 10.70, 17),
    ("1 and 10 Hz", TWO, 0.005, 1.055, 9),
    ("linear MACE, 1 kHz", MACE, 0.001, 0.120, 13),
    ("MACE open loop, 200 Hz", OPEN_LOOP, 0.005, 0.740, 17),
]
"""Durations [s] and numbers of impulses; the first three are Hyde's (3.4.2)."""


def equations(modes: list[tuple[float, float]], order: int, leads: np.ndarray) -> np.ndarray:
    """u^k exp(-s u), orthonormalised on these leads: rows written out anew."""
    rows = []
    for frequency, damping in modes:
        w = 2.0 * math.pi * frequency
        wave = np.exp(-w * (damping + 1j * math.sqrt(1.0 - damping**2)) * leads)
        for k in range(order + 1):
            rows += [((leads / leads[-1]) ** k * wave).real, ((leads / leads[-1]) ** k * wave).imag]
    q, _ = np.linalg.qr(np.array(rows).T)
    return q.T * math.sqrt(leads.size)


def least_miss(modes: list[tuple[float, float]], order: int, slots: int, dt: float) -> float:
    """Least L1 miss of the equations by positive impulses on slots 0 ... `slots`, by an interior-point solver."""
    from scipy.optimize import linprog

    rows = equations(modes, order, np.arange(slots + 1) * dt)
    m, n = rows.shape
    answer = linprog(
        np.concatenate([np.zeros(n), np.ones(2 * m)]),
        A_eq=np.block([[rows, np.eye(m), -np.eye(m)], [np.ones((1, n)), np.zeros((1, 2 * m))]]),
        b_eq=np.append(np.zeros(m), 1.0),
        method="highs-ipm",
        options={"time_limit": 20.0},
    )
    assert answer.status == 0
    return float(answer.fun)


def assert_rests(shaper: Shaper, modes: list[tuple[float, float]]) -> None:
    """Zero by the formula, and by exact simulation of each mode."""
    for frequency, damping in modes:
        assert residual_vibration(shaper, frequency, damping) < 1e-12
        train = ModalPlant((frequency, damping)).step_train(shaper.times, shaper.amplitudes)
        assert np.abs(train.residual_amplitudes).max() < 1e-11


@pytest.mark.parametrize(
    ("modes", "dt", "duration", "impulses"), [row[1:] for row in TABLE], ids=[row[0] for row in TABLE]
)
def test_the_shortest_on_the_grid_is_proved_and_another_solver_agrees(
    modes: list[tuple[float, float]], dt: float, duration: float, impulses: int
) -> None:
    shaper = design.mesh(modes, dt)
    assert shaper.duration == pytest.approx(duration, abs=1e-12) and len(shaper) == impulses
    assert shaper.design.status == "optimal" and "shorter" in shaper.design.settings["proved"]
    assert shaper.design.certificate is None
    assert (shaper.amplitudes > 0.0).all()
    np.testing.assert_array_equal(shaper.times, np.rint(shaper.times / dt) * dt)
    assert_rests(shaper, modes)
    slots = round(duration / dt)
    assert shaper.design.settings["slots"] == slots
    assert least_miss(modes, 1, slots - 1, dt) > 1e-4
    assert least_miss(modes, 1, slots, dt) < 1e-8
    assert 0.0 <= shaper.duration - design.direct(modes).duration < 2.0 * dt


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.tuples(st.floats(1.0, 8.0), st.floats(0.0, 0.2)), min_size=1, max_size=4),
    st.integers(0, 1),
    st.floats(0.05, 0.45),
    st.sampled_from(["zero", "second_derivative"]),
)
def test_random_modes_rest_and_are_never_shorter_than_the_certified_optimum(
    modes: list[tuple[float, float]], order: int, fraction: float, cost: str
) -> None:
    apart = sorted(frequency for frequency, _ in modes)
    if any(b < 1.02 * a for a, b in zip(apart, apart[1:], strict=False)):
        return
    dt = fraction / apart[-1]
    shaper = design.mesh(modes, dt, order=order, cost=cost)
    assert (shaper.amplitudes > 0.0).all()
    np.testing.assert_array_equal(shaper.times, np.rint(shaper.times / dt) * dt)
    assert_rests(shaper, modes)
    assert len(shaper) <= 2 * len(modes) * (order + 1) + 1 + (2 * len(modes) if cost == "second_derivative" else 0)
    exact = design.direct(modes, order)
    if exact.design.status == "optimal":
        assert shaper.duration >= exact.duration * (1.0 - 1e-9)
    for frequency, damping in modes if order == 1 else []:
        near = residual_vibration(shaper, frequency * (1.0 + np.array([-1e-5, 1e-5])), damping)
        assert near.max() < 1e-6  # quadratic in the frequency error: the slope is zero


def test_a_given_duration_is_hydes_first_example() -> None:
    """t_N = 1.1 s, dt = 0.005 s, zero cost: nine impulses (figure 3.8)."""
    shaper = design.mesh(TWO, 0.005, duration=1.1)
    assert len(shaper) == 9 and shaper.duration <= 1.1 + 1e-12
    assert shaper.design.status == "feasible"
    assert_rests(shaper, TWO)


@pytest.mark.parametrize("duration", [1.1, None])
def test_the_second_derivative_cost_is_flatter_at_ten_hertz(duration: float | None) -> None:
    """Figures 3.9 and 3.11; V is c (f / 10 Hz - 1)^2 near 10 Hz, so 3 % away it measures the second derivative."""
    rough = design.mesh(TWO, 0.005, duration=duration)
    flat = design.mesh(TWO, 0.005, duration=duration, cost="second_derivative")
    near = 10.0 * np.array([0.97, 1.03])
    assert residual_vibration(flat, near).max() < residual_vibration(rough, near).max()
    assert hyde_cost(flat) < hyde_cost(rough)
    assert_rests(flat, TWO)


def hyde_cost(shaper: Shaper) -> float:
    """Equation (3.2) as printed; undamped modes, where its sign of the exponent does not matter."""
    turns = 2.0 * math.pi * np.multiply.outer([1.0, 10.0], shaper.times)
    weights = shaper.amplitudes * shaper.times**2
    return float(((np.sin(turns) @ weights) ** 2 + (np.cos(turns) @ weights) ** 2).sum())


def test_the_flattest_is_flatter_than_any_mixture_of_solutions() -> None:
    """All solutions are mixtures of basic ones; a hundred random mixtures of a few, and single ones."""
    flat = hyde_cost(design.mesh(TWO, 0.005, duration=1.1, cost="second_derivative"))
    random = np.random.default_rng(5)
    leads = np.arange(221) * 0.005
    rows = np.vstack([equations(TWO, 1, leads), np.ones(221)])
    from scipy.optimize import linprog

    corners = []
    for _ in range(6):
        found = linprog(random.normal(size=221), A_eq=rows, b_eq=np.eye(9)[-1], method="highs-ipm").x
        corners.append(found)
    for _ in range(100):
        mixture = random.dirichlet(np.full(6, 0.5)) @ np.array(corners)
        used = mixture > 1e-12
        times = (leads[-1] - leads)[used][::-1]
        assert hyde_cost(Shaper.normalised(times, mixture[used][::-1])) >= flat * (1.0 - 1e-6)


def test_fewest_equals_every_set_tried_in_turn() -> None:
    """1 and 2 Hz, order 0, on 16 slots a second: 2 Hz is an even harmonic, and the grid fits both."""
    from scipy.optimize import nnls

    modes = [(1.0, 0.0), (2.0, 0.0)]
    shaper = design.mesh(modes, 1.0 / 16.0, order=0, duration=0.875, fewest=True)
    plain = design.mesh(modes, 1.0 / 16.0, order=0, duration=0.875)
    assert shaper.design.status == "optimal" and "fewer" in shaper.design.settings["proved"]
    assert len(shaper) <= len(plain)
    rows = np.vstack([equations(modes, 0, np.arange(15) / 16.0), np.ones(15)])
    target = np.eye(5)[-1]
    smaller = combinations(range(15), len(shaper) - 1)
    assert all(nnls(rows[:, chosen], target)[1] > 1e-6 for chosen in smaller)
    assert_rests(shaper, modes)


def test_harmonics_on_the_grid_need_fewer_impulses_than_equations() -> None:
    shaper = design.mesh(TWO, 0.05, fewest=True)
    assert shaper.duration == pytest.approx(1.1) and shaper.design.status == "optimal"
    assert len(shaper) == 7 == shaper.design.settings["impulses_at_least"]
    assert_rests(shaper, TWO)


def test_at_most_lengthens_until_so_few_are_enough() -> None:
    """One mode, half a period 5/3 slots: five impulses at once, three only where the grid fits the mode again."""
    mode, dt = (1.0, 0.0), 0.3
    assert len(design.mesh(mode, dt)) == 5
    three = design.mesh(mode, dt, at_most=3)
    assert three.design.status == "optimal" and "at most 3 impulses" in three.design.settings["proved"]
    np.testing.assert_allclose(three.times, [0.0, 1.5, 3.0])  # 1, 2, 1 at three half periods each, which are 5 slots
    np.testing.assert_allclose(three.amplitudes, [0.25, 0.5, 0.25])
    assert three.duration > design.mesh(mode, dt).duration
    assert_rests(three, [mode])


def test_a_design_survives_a_file() -> None:
    shaper = design.mesh([(1.0, 0.0), (2.0, 0.02)], 0.05, order=[1, 0], cost="second_derivative")
    again = Shaper.from_dict(json.loads(json.dumps(shaper.to_dict())))
    assert again == shaper and again.design == shaper.design


@pytest.mark.parametrize(
    ("modes", "wishes", "sentence"),
    [
        (
            TWO,
            {"dt": 0.005, "duration": 1.0},
            r"within 1 s on a grid of 0\.005 s: give a duration of at least 1\.055 s",
        ),
        (TWO, {"dt": 0.005, "duration": 1e-4}, r"at least 1\.055 s"),
        (TWO, {"dt": 0.06}, r"coarser than half a period of the fastest mode \(10 Hz, damping 0\).*at most 0\.05 s"),
        (TWO, {"dt": 1e-6}, "slots, more than 100000: give a servo period of at least 1.1e-05 s"),
        (TWO, {"dt": 0.005, "duration": 1e9}, "more than 100000"),
        (TWO, {"dt": 0.05, "at_most": 2}, "needs at least 3; give at_most=3"),
        (TWO, {"dt": 0.05, "at_most": 6, "duration": 1.1}, "at least 7 are needed there; give at_most=7"),
        (TWO, {"dt": -1.0}, "dt is -1 s"),
        (TWO, {"dt": math.nan}, "finite"),
        (TWO, {"dt": 0.005, "duration": 0.0}, "above 0 s"),
        (TWO, {"dt": 0.005, "cost": "third"}, "zero or second_derivative"),
        (TWO, {"dt": 0.005, "order": 7}, "from 0 to 6"),
        (TWO, {"dt": 0.005, "order": [1]}, "1 orders for 2 modes"),
        (TWO, {"dt": 0.005, "at_most": 0}, "from 1 to 10000"),
    ],
)
def test_impossible_asks_end_quickly_and_name_what_would_do(
    modes: list[tuple[float, float]], wishes: dict[str, object], sentence: str
) -> None:
    begin = time.monotonic()
    with pytest.raises(InputError, match=sentence):
        design.mesh(modes, **wishes)
    assert time.monotonic() - begin < 12.0


def test_the_nearest_values_named_are_accepted() -> None:
    assert design.mesh(TWO, 0.005, duration=1.055).duration == pytest.approx(1.055)
    assert design.mesh([(3.0, 0.0)], 0.166666).design.residual < 1e-12  # half a period is 0.1666666...
    assert len(design.mesh(TWO, 0.05, at_most=7, duration=1.1)) <= 7


@pytest.mark.parametrize("ratio", [1.0 + 1e-8, 1.0001, 1.01])
@pytest.mark.parametrize("order", [1, 3, 6])
def test_near_modes_are_met_or_refused(ratio: float, order: int) -> None:
    modes = Modes([(1.0, 0.0), (ratio, 0.0), (1.5, 0.1), (1.5 * ratio, 0.1)])
    shaper = design.mesh(modes, 0.02, order=order)
    assert shaper.design.residual is not None and shaper.design.residual < 1e-12
    assert shaper.design.status == "optimal" or 0.0 < shaper.design.settings["gap"] < 1.0
    assert (shaper.amplitudes > 0.0).all()
