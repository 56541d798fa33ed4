"""Every plant that is simulated, with what the laws need to know of it. A new plant is a line here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.util import find_spec

import numpy as np
import pytest

from preshape.plant import (
    ChangingModes,
    FlexibleBody,
    FloatingOscillator,
    FunctionPlant,
    LinearPlant,
    ModalPlant,
    PositionedMass,
    SampledPlant,
    ShuttleArm,
    SimulatedPlant,
    SimulatorPlant,
    from_matrices,
    linear_mace,
)
from preshape.plant.mace import CALIBRATED_GAINS, Mace
from preshape.plant.shuttle_arm import CALIBRATED_JOINTS

MASS = np.diag([2.0, 1.0, 0.5])
STIFFNESS = np.array([[900.0, -400.0, 0.0], [-400.0, 600.0, -200.0], [0.0, -200.0, 200.0]])
LOCAL_DAMPER = np.diag([0.0, 0.0, 1.5])
FLOATING = np.array([[400.0, -400.0, 0.0], [-400.0, 600.0, -200.0], [0.0, -200.0, 200.0]])
ENDS = {"first": 0, "last": 2}


@dataclass(frozen=True)
class Simulated:
    """A plant, and which laws it obeys.

    Parameters
    ----------
    make : function
        Makes it.
    dt : float
        A step that suits it [s].
    linear : bool
        Whether outputs add up as commands do.
    static : mapping of str to float
        Where outputs settle under a constant unit of the first input, for plants that do.
    tolerance : float
        Of its simulation, relative.
    rest : mapping of str to float
        Where outputs are at rest, for those that are not at 0.
    still : float
        How far rounding may move an output of a plant at rest, in its unit.
    spared : mapping of str to str
        The tests of laws that do not hold for it, each with the reason, which is shown where it is skipped.
    needs : str
        The package that it is simulated with, if it is no part of all installations.
    """

    make: Callable[[], SimulatedPlant]
    dt: float = 0.01
    linear: bool = True
    static: dict[str, float] | None = None
    tolerance: float = 1e-11
    rest: dict[str, float] = field(default_factory=dict)
    still: float = 0.0
    spared: dict[str, str] = field(default_factory=dict)
    needs: str = ""


def those(law: str, *, which: Callable[[Simulated], bool] = lambda one: True) -> list:
    """The names of the plants that a law's test runs on; those that are spared are skipped with their reason."""
    found = []
    for name, one in PLANTS.items():
        if not which(one):
            continue
        missing = f"{one.needs} is not installed" if one.needs and find_spec(one.needs) is None else ""
        reason = one.spared.get(law, missing)
        found.append(pytest.param(name, marks=pytest.mark.skip(reason=reason) if reason else ()))
    return found


def two_inputs() -> LinearPlant:
    """Three masses in state space, pushed at both ends, sprung and damped, with a force that passes through."""
    inverse = np.linalg.inv(MASS)
    damper = 2.0 * LOCAL_DAMPER + 0.002 * STIFFNESS
    a = np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ STIFFNESS, -inverse @ damper]])
    b = np.concatenate([np.zeros((3, 2)), inverse[:, [0, 2]]])
    c = np.concatenate([np.eye(3)[[0, 2]], np.zeros((2, 3))], axis=1)
    return LinearPlant(
        a, b, c, [[0.0, 0.0], [0.0, 0.1]], inputs={"left": "N", "right": "N"}, outputs=dict.fromkeys(ENDS, "m")
    )


def sampled() -> LinearPlant:
    """An oscillator that is known at samples only, behind a delay of two of them."""
    turn = 0.99 * np.exp(0.3j)
    a = np.array([[turn.real, turn.imag, 1.0, 0.0], [-turn.imag, turn.real, 0.0, 0.0], [0, 0, 0, 1.0], [0, 0, 0, 0]])
    return LinearPlant(a, [0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], sample_time=0.01)


def spring(t: float, x: np.ndarray, u: np.ndarray) -> list[float]:
    return [x[1], 100.0 * (u[0] - x[0]) - x[1]]


def hardening(t: float, x: np.ndarray, u: np.ndarray) -> list[float]:
    return [x[1], u[0] - 100.0 * x[0] - 4000.0 * x[0] ** 3 - x[1]]


def recursion(u: np.ndarray, dt: float) -> dict[str, np.ndarray]:
    return {"way": np.asarray(ModalPlant((1.0, 0.2)).response(u[0], dt).output)}


def statically(place: int) -> dict[str, float]:
    """Where both ends of the sprung masses settle under a newton at one of them."""
    bent = np.linalg.solve(STIFFNESS, np.eye(3)[place])
    return {name: float(bent[at]) for name, at in ENDS.items()}


def reach() -> dict[str, float]:
    """Where the end point of the stretched arm is."""
    return {f"end point {axis}": float(at) for axis, at in zip("xyz", ShuttleArm().end_point(), strict=True)}


SUDDEN = "test_even_a_step_at_once_has_the_same_effect_later"
LATER = "test_a_later_command_has_a_later_effect"

PLANTS: dict[str, Simulated] = {
    "changing modes": Simulated(
        lambda: ChangingModes(lambda t: [(1.0 + 0.2 * float(np.sin(t)), 0.1), (2.5, 0.1)]),
        static={"output": 1.0},
        spared=dict.fromkeys((LATER, SUDDEN), "its modes depend on the time"),
    ),
    "linear MACE": Simulated(linear_mace, dt=1e-3, tolerance=1e-9),
    "matrices, modes apart": Simulated(
        lambda: from_matrices(MASS, 0.03, STIFFNESS, input=0, outputs=ENDS), static=statically(0)
    ),
    "matrices, damper in one place": Simulated(
        lambda: from_matrices(MASS, LOCAL_DAMPER, STIFFNESS, input=0, outputs=ENDS), static=statically(0)
    ),
    "matrices, floating": Simulated(lambda: from_matrices(MASS, 0.01, FLOATING, input=0, outputs=ENDS)),
    "matrices, floating and braked": Simulated(
        lambda: from_matrices(MASS, LOCAL_DAMPER, FLOATING, input=0, outputs=ENDS)
    ),
    "state space, two inputs": Simulated(two_inputs, static=statically(0)),
    "state space, sampled": Simulated(sampled),
    "function, linear": Simulated(
        lambda: FunctionPlant(spring, [0.0, 0.0], {"x": 0, "twice": lambda x, u: 2.0 * x[0]}),
        static={"x": 1.0, "twice": 2.0},
        tolerance=1e-6,
    ),
    "function, hardening spring": Simulated(
        lambda: FunctionPlant(hardening, [0.0, 0.0], {"x": 0}, scale=[0.01, 0.1]),
        linear=False,
        static={"x": 0.00996055},
        tolerance=1e-6,
    ),
    "simulator": Simulated(
        lambda: SimulatorPlant(recursion, inputs={"u": "m"}, outputs={"way": "m"}, modes=(1.0, 0.2)),
        static={"way": 1.0},
    ),
    "sampled floating oscillator": Simulated(
        lambda: SampledPlant(FloatingOscillator(1.0, 2.0, 30.0, 0.4), "force", "N")
    ),
    "sampled flexible body": Simulated(
        lambda: SampledPlant(FlexibleBody(2.0, [(1.0, 0.02), (3.0, 0.01)], [1.0, 0.4]), "force", "N")
    ),
    "sampled positioned mass": Simulated(
        lambda: SampledPlant(PositionedMass((1.0, 0.1)), "position", "m"), static={"deflection": 0.0}
    ),
    "sampled modal plant": Simulated(
        lambda: SampledPlant(ModalPlant([(1.0, 0.1), (2.5, 0.1)]), "position", "m"), static={"output": 1.0}
    ),
    "MACE": Simulated(
        lambda: Mace(CALIBRATED_GAINS, elements=1),
        linear=False,
        static={"payload angle": 1.0},
        tolerance=1e-10,
        still=1e-8,
        spared={SUDDEN: "a step at time 0 acts at once, a later one over a step: the same to second order"},
        needs="exudyn",
    ),
    "Shuttle arm": Simulated(
        ShuttleArm,
        linear=False,
        rest=reach(),
        spared=dict.fromkeys((SUDDEN, LATER), "its joints look at the command at moments of their own, by chance"),
    ),
    "Shuttle arm, linear joints": Simulated(
        lambda: ShuttleArm(joints=CALIBRATED_JOINTS.only()),
        linear=False,  # the links turn far
        rest=reach(),
        tolerance=1e-5,  # the mass matrix is renewed every 40 ms, at times that the command does not know
        spared={SUDDEN: "the leapfrog takes a step at time 0 half a step of the simulation later than others"},
    ),
}
