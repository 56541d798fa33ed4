"""Two masses and a spring: the equations of the masses, energy, momentum, and Robertson's bang-bang moves."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from preshape.errors import InputError
from preshape.mode import Mode
from preshape.plant import FloatingOscillator
from preshape.profile import Profile

masses = st.floats(0.2, 5.0)
plants = st.builds(
    lambda m1, m2, f, z: FloatingOscillator.from_mode(m1, m2, Mode(f, z)),
    masses,
    masses,
    st.floats(0.05, 3.0),
    st.floats(0.0, 0.5),
)
staircases = st.lists(
    st.tuples(st.floats(0.05, 2.0), st.floats(0.01, 3.0) | st.floats(-3.0, -0.01)), min_size=1, max_size=6
)


def staircase(rows: list[tuple[float, float]]) -> Profile:
    gaps, jumps = zip(*rows, strict=True)
    return Profile.steps(np.cumsum(gaps), np.array(jumps))


def bang_bang(distance: float, acceleration: float = 0.5) -> Profile:
    switch = math.sqrt(distance / acceleration)
    return Profile.steps([0.0, switch, 2 * switch], [1.0, -2.0, 1.0])


def test_the_equations_of_the_masses_integrated_numerically() -> None:
    m1, m2, k, c = 2.0, 0.5, 3.0, 0.2
    plant = FloatingOscillator(m1, m2, k, c)
    force = Profile(
        np.array([0.0, 0.0, 0.8, 1.5, 2.5]), np.array([1.0, 2.0, -4.0, -1.0, 2.0]), np.array([0, 1, 0, 1, 0])
    )
    motion = plant.motion(force)

    def rates(t: float, y: np.ndarray) -> list[float]:
        spring = k * (y[0] - y[1]) + c * (y[2] - y[3])
        return [y[2], y[3], (float(force(t)) - spring) / m1, spring / m2]

    state, edges = np.zeros(4), [0.0, 0.8, 1.5, 2.5, 6.0]
    for low, high in zip(edges, edges[1:], strict=False):
        # The half-open segment: at its very end the force has already stepped.
        run = solve_ivp(
            lambda t, y, high=high: rates(min(t, high * (1 - 1e-15)), y),
            (low, high), state, "DOP853", rtol=1e-13, atol=1e-14, dense_output=True,
        )  # fmt: skip
        looks = np.linspace(low, high, 7)
        x1, x2, v1, v2 = run.sol(looks)
        state = run.y[:, -1]
        for name, expected in [("deflection", x1 - x2), ("first_position", x1), ("second_position", x2)]:
            np.testing.assert_allclose(motion(name, looks), expected, rtol=0, atol=2e-11 * (1 + np.abs(x1).max()))
        np.testing.assert_allclose(motion("first_position", looks, 1), v1, rtol=0, atol=2e-10)
        np.testing.assert_allclose(motion("centre", looks), (m1 * x1 + m2 * x2) / (m1 + m2), rtol=0, atol=1e-10)


@given(plants, staircases)
def test_work_of_the_force_is_the_energy_and_its_impulse_the_momentum(
    plant: FloatingOscillator, rows: list[tuple[float, float]]
) -> None:
    undamped = plant.retuned(1.0, 0.0)
    force = staircase(rows)
    motion = undamped.motion(force)
    edges = np.array([*np.unique(force.times), motion.end_time + 3.0])
    levels = force(edges)
    at = edges[-1]
    work = (levels[:-1] * np.diff(motion("first_position", edges))).sum()
    v1, v2 = motion("first_position", at, 1), motion("second_position", at, 1)
    m1, m2, k = undamped.first_mass, undamped.second_mass, undamped.stiffness
    energy = 0.5 * (m1 * v1**2 + m2 * v2**2 + k * motion("deflection", at) ** 2)
    largest = np.abs(levels[:-1] * np.diff(motion("first_position", edges))).sum()
    assert energy == pytest.approx(work, abs=1e-11 * max(largest, energy, 1e-12))
    impulse = (levels[:-1] * np.diff(edges)).sum()
    assert m1 * v1 + m2 * v2 == pytest.approx(impulse, abs=1e-11 * (1.0 + np.abs(levels).max() * at))


@given(plants, st.floats(0.1, 10.0))
def test_a_steady_force_settles_on_the_static_deflection_and_overshoots_by_the_decay(
    plant: FloatingOscillator, force: float
) -> None:
    peak = plant.motion(Profile.steps([0.0], [force])).peak("deflection")
    overshoot = 1.0 + plant.mode.decay_per_half_period
    assert peak.value == pytest.approx(plant.static_deflection(force) * overshoot, rel=1e-12)
    assert peak.time == pytest.approx(math.pi / plant.mode.omega_d, rel=1e-7)
    assert plant.static_deflection(force) == pytest.approx(force / plant.first_mass / plant.mode.omega**2, rel=1e-13)


@pytest.mark.parametrize(
    ("distance", "deflection", "residual"),
    [(5.0, 1.7198, 2.4759), (10.0, 1.0009, 0.0017), (15.0, 1.5687, 1.7844), (20.0, 1.9618, 3.7735)],
)
def test_bang_bang_on_the_benchmark(distance: float, deflection: float, residual: float) -> None:
    # Robertson's m1 = m2 = k = 1; the numbers by hand from the phasors of the three steps.
    plant = FloatingOscillator(1.0, 1.0, 1.0)
    motion = plant.motion(bang_bang(distance))
    assert round(motion.peak("deflection").value, 4) == deflection
    assert round(motion.residual("deflection") / plant.static_deflection(1.0), 4) == residual
    assert motion("centre", 100.0) == pytest.approx(distance, rel=1e-12)


@pytest.mark.parametrize("n", [1, 2, 3])
def test_bang_bang_leaves_nothing_at_whole_periods(n: int) -> None:
    distance = (n * math.pi) ** 2
    motion = FloatingOscillator(1.0, 1.0, 1.0).motion(bang_bang(distance))
    assert motion.residual("deflection") < 1e-13
    assert motion("second_position", motion.end_time) == pytest.approx(distance, rel=1e-13)
    assert motion.peak("second_position").value == pytest.approx(distance, rel=1e-13)
    # The paper's 9.868, 39.472, 88.811 come from a rounded period: nearly nothing, but not nothing.
    printed = {1: 9.868, 2: 39.472, 3: 88.811}[n]
    assert 1e-9 < FloatingOscillator(1.0, 1.0, 1.0).motion(bang_bang(printed)).residual("deflection") < 1e-5


def test_retuning_keeps_the_masses() -> None:
    plant = FloatingOscillator(2.0, 3.0, 5.0, 0.4)
    stiff = plant.retuned(1.2, 0.3)
    assert (stiff.first_mass, stiff.second_mass) == (2.0, 3.0)
    assert stiff.mode.frequency == pytest.approx(1.2 * plant.mode.frequency, rel=1e-14)
    assert stiff.mode.damping == pytest.approx(0.3, rel=1e-14)
    assert plant.retuned(2.0).mode.damping == pytest.approx(plant.mode.damping, rel=1e-14)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ((0.0, 1.0, 1.0), "first_mass is 0 kg"),
        ((1.0, -2.0, 1.0), "second_mass is -2 kg"),
        ((1.0, 1.0, math.inf), "stiffness is inf"),
        ((1.0, 1.0, 1.0, -0.1), "damping is -0.1 N s/m"),
        ((1.0, 1.0, 1.0, 1.5), "from 1.41421 N s/m on this oscillator does not vibrate"),
        ((1.0, "1", 1.0), "second_mass must be a number"),
    ],
)
def test_wrong_masses_are_named(arguments: tuple[float, ...], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        FloatingOscillator(*arguments)
