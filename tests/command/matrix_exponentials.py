"""Independent simulation of rest-to-rest forces: the equations of motion and matrix exponentials, nothing else."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

from preshape.command.rest_to_rest import RestToRest
from preshape.plant import FlexibleBody

Matrix = NDArray[np.float64]


def equations_of_two_masses(m1: float, m2: float, k: float, c: float = 0.0) -> tuple[Matrix, Matrix, Matrix]:
    """A, b and the deflection's row for the state x1, x2, x1', x2'."""
    a = np.zeros((4, 4))
    a[0, 2] = a[1, 3] = 1.0
    a[2] = np.array([-k, k, -c, c]) / m1
    a[3] = np.array([k, -k, c, -c]) / m2
    return a, np.array([0.0, 0.0, 1.0 / m1, 0.0]), np.array([[1.0, -1.0, 0.0, 0.0]])


def equations_of(body: FlexibleBody) -> tuple[Matrix, Matrix, Matrix]:
    """A, b and the deflections' rows for the state X, X', d1, d1', d2, d2', ..."""
    modes = len(body.modes)
    a, b, rows = np.zeros((2 + 2 * modes, 2 + 2 * modes)), np.zeros(2 + 2 * modes), np.zeros((modes, 2 + 2 * modes))
    a[0, 1], b[1] = 1.0, 1.0 / body.mass
    for j, (mode, gain) in enumerate(zip(body.modes, body.gains, strict=True)):
        at = 2 + 2 * j
        a[at, at + 1] = 1.0
        a[at + 1, at], a[at + 1, at + 1] = -(mode.omega**2), -2.0 * mode.damping * mode.omega
        b[at + 1], rows[j, at] = gain, 1.0
    return a, b, rows


def stepper(a: Matrix, b: Matrix, force: float, time: float) -> Matrix:
    """What takes (state, 1) to (state some time later, 1) under a constant force."""
    augmented = np.zeros((b.size + 1, b.size + 1))
    augmented[:-1, :-1], augmented[:-1, -1] = a * time, b * force * time
    return np.asarray(expm(augmented))


def final_state(a: Matrix, b: Matrix, move: RestToRest) -> Matrix:
    state = np.append(np.zeros(b.size), 1.0)
    for length, force in zip(np.diff(move.switch_times), move.levels, strict=True):
        state = stepper(a, b, force, length) @ state
    return state[:-1]


def largest(a: Matrix, b: Matrix, row: Matrix, move: RestToRest, samples: int = 48) -> float:
    """Maximum of |row state| during a move and a while after it: fine samples, then refined between them."""
    fastest = float(np.abs(np.linalg.eigvals(a)).max())
    state, most = np.append(np.zeros(b.size), 1.0), 0.0
    lengths = [*np.diff(move.switch_times), 2.0 * np.pi / fastest]
    for length, force in zip(lengths, [*move.levels, 0.0], strict=True):
        count = 2 + int(np.ceil(length * fastest * samples / (2.0 * np.pi)))
        dt = length / count
        step = stepper(a, b, force, dt)
        states = [state]
        for _ in range(count):
            states.append(step @ states[-1])
        values = np.abs(np.array(states)[:, :-1] @ row)
        k = int(np.argmax(values))
        begin, end = states[max(0, k - 1)], 2.0 * dt if 0 < k < count else dt

        def below(t: float, begin: Matrix = begin, force: float = force) -> float:
            return -abs(float(row @ (stepper(a, b, force, t) @ begin)[:-1]))

        near = minimize_scalar(below, bounds=(0.0, end), method="bounded", options={"xatol": 1e-7 * end})
        most = max(most, float(values[k]), -float(near.fun))
        state = states[-1]
    return most
