"""Modes that change with time, against SciPy's solvers, the pendulum of a hoisting crane, and an invariant."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from preshape.errors import InputError
from preshape.plant import ChangingModes, ModalPlant

DT = 0.02
COMMAND = np.repeat([0.4, 0.9, 1.3, 1.0], 60)


def swept(t: float) -> list[tuple[float, float]]:
    """Two modes, up and down by 20 %."""
    s = math.sin(1.7 * t)
    return [(1.0 + 0.2 * s, 0.01 + 0.005 * s), (2.6 - 0.5 * s, 0.03)]


def integrated(command: np.ndarray, method: str) -> np.ndarray:
    """Both modal coordinates at the samples, by a solver that knows nothing of the plant."""
    state, found = np.zeros(4), [np.zeros(2)]
    for n, u in enumerate(command[:-1].tolist()):

        def slope(t: float, y: np.ndarray, u: float = u) -> list[float]:
            made = []
            for k, (f, z) in enumerate(swept(t)):
                w = 2.0 * math.pi * f
                made += [y[2 * k + 1], -2.0 * z * w * y[2 * k + 1] - w * w * (y[2 * k] - u)]
            return made

        state = solve_ivp(slope, (n * DT, (n + 1) * DT), state, method=method, rtol=1e-12, atol=1e-13).y[:, -1]
        found.append(state[[0, 2]])
    return np.array(found)


def test_it_is_what_a_runge_kutta_solver_of_eighth_order_finds() -> None:
    expected = integrated(COMMAND, "DOP853") @ [0.7, 0.3]
    found = ChangingModes(swept, [0.7, 0.3]).simulate(COMMAND, DT).outputs["output"]
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-8)


def test_halving_the_step_changes_it_by_the_fourth_power(monkeypatch: pytest.MonkeyPatch) -> None:
    expected = integrated(COMMAND[:120], "DOP853").mean(axis=1)
    errors = []
    for longest in (0.4, 0.2, 0.1):
        monkeypatch.setattr("preshape.plant.changing_modes.LONGEST", longest)
        found = ChangingModes(swept).simulate(COMMAND[:120], DT).outputs["output"]
        errors.append(np.abs(found - expected).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 3.5).all() and (orders < 4.6).all(), orders


def test_modes_that_stay_are_the_modal_plant() -> None:
    modes = [(1.0, 0.02), (3.3, 0.0)]
    expected = ModalPlant(modes).response(COMMAND, DT).output
    found = ChangingModes(lambda t: modes).simulate(COMMAND, DT).outputs["output"]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)


def test_many_short_stretches_of_modes_that_stay_tend_to_it() -> None:
    """Piecewise constant modes, each stretch exact by the modal plant: they err by the square of a stretch."""
    command, whole = COMMAND[:61], ChangingModes(lambda t: swept(t)[:1]).simulate(COMMAND[:61], DT)
    errors = []
    for parts in (1, 2, 4):
        h = DT / parts
        x, v = np.zeros(1), np.zeros(1)
        for n in range(60 * parts):
            plant = ModalPlant(swept((n + 0.5) * h)[:1])
            u = command[n // parts]
            response = plant.response([0.0, 0.0], h, displacement=x - u, velocity=v)
            mode = plant.modes[0]
            s = -mode.damping * mode.omega
            turn, decay = mode.omega_d * h, math.exp(s * h)
            v = decay * (v * math.cos(turn) + (s * v - mode.omega**2 * (x - u)) * math.sin(turn) / mode.omega_d)
            x = response.output[-1:] + u
        errors.append(abs(float(x[0]) - whole.outputs["output"][-1]))
    assert np.log2(errors[0] / errors[2]) == pytest.approx(4.0, abs=0.3)


def test_a_crane_that_hoists_while_it_drives_is_such_a_plant() -> None:
    """The pendulum's own equation, l a'' + 2 l' a' + g a = -u'' with a rope l(t), for a trolley that moves smoothly."""
    g, dt = 9.81, 0.01

    def rope(t: float) -> tuple[float, float, float]:
        return 3.0 + math.cos(0.8 * t), -0.8 * math.sin(0.8 * t), -0.64 * math.cos(0.8 * t)

    def frequency(t: float) -> tuple[float, float]:
        length, _, bent = rope(t)
        return math.sqrt((g - bent) / length) / (2.0 * math.pi), 0.0

    times = dt * np.arange(601)
    trolley = np.array([t - math.sin(t) for t in times])  # from rest, u'' = sin t

    def pendulum(t: float, y: np.ndarray) -> list[float]:
        length, change, _ = rope(t)
        return [y[1], -(2.0 * change * y[1] + g * y[0] + math.sin(t)) / length]

    angle = solve_ivp(pendulum, (0.0, 6.0), [0.0, 0.0], "DOP853", times, rtol=1e-11, atol=1e-13).y[0]
    expected = trolley + np.array([rope(t)[0] for t in times]) * angle
    errors = []
    for finer in (1, 2):  # the held command is half a sample late on average: the error of both falls with the sample
        fine = np.linspace(0.0, 6.0, 600 * finer + 1)
        held = (fine + 0.5 * dt / finer) - np.sin(fine + 0.5 * dt / finer)
        found = ChangingModes(frequency).simulate(held, dt / finer).outputs["output"][::finer]
        errors.append(np.abs(found - expected).max())
    assert errors[0] < 5e-5 * np.ptp(expected)
    assert errors[0] / errors[1] > 3.5


def test_a_slow_change_keeps_energy_over_frequency() -> None:
    """The adiabatic invariant: a free swing whose frequency doubles slowly ends with twice the energy."""
    plant = ChangingModes(lambda t: (1.0 + min(t / 100.0, 1.0), 0.0))
    command = np.zeros(11001)
    command[:50] = 1.0  # half a period: a swing of twice the step
    found = plant.simulate(command, 0.01).outputs["output"]
    early, late = np.abs(found[50:250]).max(), np.abs(found[10500:]).max()
    assert (2.0 * late / early) ** 2 == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: ChangingModes(lambda t: "soft"), "is not a mode"),
        (lambda: ChangingModes(lambda t: (1.0, 0.0), [1.0, 2.0]), "gains have shape"),
        (lambda: ChangingModes(lambda t: (1.0, 0.0), [[1.0], [2.0]]), "for the one output"),
        (lambda: ChangingModes(swept).modes(-1.0), "give 0 s or more"),
        (lambda: ChangingModes(lambda t: swept(t)[: 1 + (t < 0.1)]).simulate(np.ones(9), 0.05), "2 at 0 s"),
        (lambda: ChangingModes(lambda t: (0.1 - t, 0.0)).simulate(np.ones(9), 0.05), "not a natural frequency"),
    ],
)
def test_what_is_no_such_plant_is_refused(make, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        make()
