"""Beams: frequencies of the differential equation, static deflections, and the laws of any linear structure."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import eigh
from tests.plant.beams import EQUATIONS, SUPPORTS, carrying, frequency, payload_beam_frequency, unit_beam

from preshape.errors import InputError
from preshape.plant import Beam, HingedPayload, Lump
from preshape.profile import Profile

RIGID = {"free-free": 2, "pinned-free": 1}

OUTER, INNER = 0.0254, 0.01905
TUBE = {
    "bending_stiffness": 2.4e9 * math.pi / 64.0 * (OUTER**4 - INNER**4),
    "mass_per_length": 1200.0 * math.pi / 4.0 * (OUTER**2 - INNER**2),
}
"""A polycarbonate tube, 1 by 3/4 inch: 33.52 N m^2, 0.266 kg/m."""


# --- frequencies ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", EQUATIONS)
def test_frequencies_converge_to_the_differential_equation_s_with_the_fourth_power(kind: str) -> None:
    exact = np.array([frequency(kind, k) for k in (1, 2, 3, 4)])
    errors = np.array([unit_beam(kind, n).modes.frequencies[:4] / exact - 1.0 for n in (16, 32, 64)])
    assert (errors > 0.0).all()  # Ritz: a mesh is stiffer than the beam
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.abs(orders - 4.0).max() < 0.06
    assert np.abs(orders[1] - 4.0).max() < 0.015
    # Theory of the consistent mass: the square of a frequency is too high by (b h)^4 / 720 to leading order.
    wavenumber = np.sqrt(2.0 * math.pi * exact)
    np.testing.assert_allclose(errors[2], (wavenumber / 64) ** 4 / 1440.0, rtol=0.01)


@pytest.mark.parametrize("kind", EQUATIONS)
def test_rigid_motions_are_counted_and_strain_nothing(kind: str) -> None:
    beam = unit_beam(kind, 5)
    modes = beam.modes
    assert modes.rigid_shapes.shape[1] == RIGID.get(kind, 0)
    held = sum({"pinned": 1, "clamped": 2}[one] for one in SUPPORTS[kind].values())
    assert modes.frequencies.size == 12 - held - modes.rigid_shapes.shape[1]
    stiffest = np.abs(beam.stiffness_matrix).max()
    assert np.abs(beam.stiffness_matrix @ modes.rigid_shapes).max(initial=0.0) < 1e-14 * stiffest
    assert np.abs(beam.displacement(0.0).row @ modes.shapes).max() < 1e-15 or 0.0 not in SUPPORTS[kind]


def test_a_fine_mesh_keeps_the_digits_of_its_slow_modes() -> None:
    # The fastest mode is 2e5 times as fast as the slowest; the stiffness matrix's eigenvalues lose 1e-6 here.
    found = unit_beam("free-free", 400).modes.frequencies
    exact = np.array([frequency("free-free", k) for k in (1, 2, 3)])
    theory = (np.sqrt(2.0 * math.pi * exact) / 400) ** 4 / 1440.0
    np.testing.assert_allclose(found[:3] / exact - 1.0, theory, rtol=0, atol=2e-11)


def test_payloads_on_springs_against_the_roots_of_the_exact_equation() -> None:
    payload = (5.0, 0.06, 0.15, 6.8)
    reference = [1.497665, 1.966757, 8.814173, 32.225029, 71.39156, 126.24293]  # computed once elsewhere
    exact = [payload_beam_frequency(f, 1.5, *TUBE.values(), payload) for f in reference]
    np.testing.assert_allclose(exact, reference, rtol=3.5e-7)
    ends = [
        HingedPayload(x, payload[0], payload[1], along=sign * payload[2], stiffness=payload[3])
        for x, sign in ((0.0, -1.0), (1.5, 1.0))
    ]
    errors = [Beam(1.5, n, **TUBE, payloads=ends).modes.frequencies[:6] / exact - 1.0 for n in (16, 32)]
    assert (errors[1] > -1e-12).all() and errors[1].max() < 2e-5
    np.testing.assert_allclose(np.log2(errors[0][2:] / errors[1][2:]), 4.0, atol=0.05)


def test_simple_limits() -> None:
    stiff = {"bending_stiffness": 1e7, "mass_per_length": 1e-3}
    # A payload on its spring, the beam held: sqrt(k / J); across adds to J, along does while the hinge stays.
    held = Beam(1.0, 2, **stiff, supports={0.0: "clamped"}, payloads=[HingedPayload(1.0, 2.0, 0.1, 0.3, 0.2, 5.0)])
    inertia = 0.1 + 2.0 * (0.3**2 + 0.2**2)
    assert held.modes.frequencies[0] == pytest.approx(math.sqrt(5.0 / inertia) / (2 * math.pi), rel=1e-5)
    # A mass at the tip of a light cantilever: sqrt(3 E I / (m L^3)); two lumps on a light beam: a spring 3 E I / L.
    tip = Beam(2.0, 1, 7.0, 1e-9, supports={0.0: "clamped"}, lumps=[Lump(2.0, 3.0)])
    assert tip.modes.frequencies[0] == pytest.approx(math.sqrt(3 * 7.0 / (3.0 * 8.0)) / (2 * math.pi), rel=1e-8)
    # A rotary inertia at either end of a light beam on two pins, turning against each other: E I / L a radian, twice.
    ends = [Lump(0.0, 0.0, 0.4), Lump(2.0, 0.0, 0.4)]
    turning = Beam(2.0, 1, 7.0, 1e-9, supports={0.0: "pinned", 2.0: "pinned"}, lumps=ends)
    assert turning.modes.frequencies[0] == pytest.approx(math.sqrt(2 * 7.0 / 2.0 / 0.4) / (2 * math.pi), rel=1e-8)


# --- the laws of a linear structure ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "held", [{}, {"left": "pinned"}, {"middle": "clamped"}, {"left": "pinned", "middle": "pinned"}]
)
def test_shapes_are_orthonormal_and_solve_the_eigenproblem(held: dict[str, str]) -> None:
    beam = carrying(**held)
    modes, mass, stiffness = beam.modes, beam.mass_matrix, beam.stiffness_matrix
    both = np.hstack([modes.rigid_shapes, modes.shapes])
    np.testing.assert_allclose(both.T @ mass @ both, np.eye(both.shape[1]), atol=1e-12)
    squares = (2.0 * math.pi * modes.frequencies) ** 2
    np.testing.assert_allclose(modes.shapes.T @ stiffness @ modes.shapes, np.diag(squares), atol=1e-12 * squares[-1])
    free = np.flatnonzero(np.abs(both).sum(axis=1) > 0.0)
    plain = eigh(stiffness[np.ix_(free, free)], mass[np.ix_(free, free)], eigvals_only=True)
    assert free.size == both.shape[1]
    np.testing.assert_allclose(plain[modes.rigid_shapes.shape[1] :], squares, rtol=1e-7)
    np.testing.assert_allclose(plain[: modes.rigid_shapes.shape[1]], 0.0, atol=1e-12 * squares[-1])


@given(load=st.floats(0.0, 1.2), seen=st.floats(0.0, 1.2), at=st.floats(0.01, 3.0), pinned=st.booleans())
def test_reciprocity(load: float, seen: float, at: float, pinned: bool) -> None:
    beam = carrying(**({"left": "pinned"} if pinned else {}))
    push, turn = beam.displacement(load), beam.slope(seen)
    step = Profile.steps([0.0], [1.0])
    one = beam.plant(push, {"seen": turn}, damping=0.01).motion(step)("seen", at)
    other = beam.plant(turn, {"seen": push}, damping=0.01).motion(step)("seen", at)
    assert float(one) == pytest.approx(float(other), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("elements", [1, 3, 7])
def test_static_deflections_are_exact_at_the_nodes(elements: int) -> None:
    length, stiffness = 1.7, 23.0
    beam = Beam(length, elements, stiffness, 0.9, supports={0.0: "clamped"})
    tip, slope = beam.displacement(length), beam.slope(length)
    pushed = beam.plant(tip, {"tip": tip, "slope": slope})
    turned = beam.plant(slope, {"tip": tip, "slope": slope})
    assert pushed.static_deflections("tip", 2.0).sum() == pytest.approx(2.0 * length**3 / (3.0 * stiffness), rel=1e-12)
    assert pushed.static_deflections("slope").sum() == pytest.approx(length**2 / (2.0 * stiffness), rel=1e-12)
    assert turned.static_deflections("tip").sum() == pytest.approx(length**2 / (2.0 * stiffness), rel=1e-12)
    assert turned.static_deflections("slope").sum() == pytest.approx(length / stiffness, rel=1e-12)
    # What a damped structure settles on is the same.
    damped = beam.plant(tip, {"tip": tip}, damping=0.5)
    assert float(damped.motion(Profile.steps([0.0], [2.0]))("tip", 500.0)) == pytest.approx(
        2.0 * length**3 / (3.0 * stiffness), rel=1e-12
    )


def test_a_load_between_nodes_bends_the_beam_as_the_cubic_says() -> None:
    # Two spans of a cantilever: the tip for a force at x is x^2 (3 L - x) / (6 E I); the consistent load keeps it.
    beam = Beam(1.0, 3, 1.0, 1.0, supports={0.0: "clamped"})
    tip = beam.displacement(1.0)
    for x in (0.1, 0.45, 0.8, 1.0):
        moved = beam.plant(beam.displacement(x), {"tip": tip}).static_deflections("tip").sum()
        assert moved == pytest.approx(x**2 * (3.0 - x) / 6.0, rel=1e-12)
    simple = Beam(1.0, 4, 1.0, 1.0, supports={0.0: "pinned", 1.0: "pinned"})
    middle = simple.displacement(0.5)
    assert simple.plant(middle, {"y": middle}).static_deflections("y").sum() == pytest.approx(1.0 / 48.0, rel=1e-12)


@pytest.mark.parametrize("x", [0.07, 0.33, 0.55, 1.1])
def test_a_slope_is_the_derivative_of_the_displacement(x: float) -> None:
    # A cubic's central difference is its slope plus h^2 / 6 of its third derivative.
    beam, h = carrying(), 1e-5
    difference = (beam.displacement(x + h).row - beam.displacement(x - h).row) / (2.0 * h)
    np.testing.assert_allclose(beam.slope(x).row, difference, atol=1e-6)
    for node in range(beam.nodes.size):
        for k, coordinate in enumerate((beam.displacement, beam.slope)):
            np.testing.assert_allclose(coordinate(beam.nodes[node]).row, np.eye(16)[2 * node + k], atol=1e-13)


def test_momentum_follows_the_force_and_a_motor_in_a_hinge_changes_none() -> None:
    beam = carrying()
    centre = beam.centre_of_mass()
    total = 1.5 + 0.4 + 2.0 + 1.0 + float(beam.mass_per_length.sum()) * 0.2
    assert np.abs(centre.row @ beam.modes.shapes).max() < 1e-13
    times = np.linspace(0.0, 2.0, 41)
    pushed = beam.plant(beam.displacement(0.3), {"centre": centre, "tip": beam.displacement(1.2)})
    motion = pushed.motion(Profile.steps([0.0], [3.0]))
    # Payloads that hang outboard move with their angle: the mean of hinges' displacement is not all of it.
    spin = np.zeros(beam.mass_matrix.shape[0])
    spin[0:14:2] = 1.0
    assert spin @ beam.mass_matrix @ spin == pytest.approx(total, rel=1e-13)
    np.testing.assert_allclose(motion("centre", times), 1.5 / total * times**2, atol=1e-12)
    turned = beam.plant(beam.hinge_angle(0), {"centre": centre, "payload": beam.payload_angle(0)})
    moved = turned.motion(Profile.steps([0.0], [3.0]))
    assert np.abs(moved("centre", times)).max() < 1e-12 * np.abs(moved("payload", times)).max()
    # Angular momentum: the row of a rotation of everything, in the mass matrix.
    rotation = np.concatenate([np.column_stack([beam.nodes, np.ones(7)]).ravel(), [1.0, 1.0]])
    row = rotation @ beam.mass_matrix
    assert np.abs(row @ beam.modes.shapes).max() < 1e-12
    pushes = beam.modes.rigid_shapes.T @ beam.hinge_angle(0).row
    assert abs(row @ beam.modes.rigid_shapes @ pushes) < 1e-12


def test_energy_is_the_work_of_the_force() -> None:
    beam = carrying(left="pinned")
    here = beam.displacement(1.0)
    names = [f"c{k}" for k in range(beam.mass_matrix.shape[0])]
    rows = np.eye(len(names))
    coordinates = {name: type(here)(row, "m", "N") for name, row in zip(names, rows, strict=True)}
    structure = beam.plant(here, {**coordinates, "here": here})
    command = Profile([0.0, 0.1, 0.35], [40.0, -90.0, 50.0], [1, 1, 1])  # a force that ramps up and down
    motion = structure.motion(command)
    points, weights = np.polynomial.legendre.leggauss(8)
    work, before, panels = 0.0, 0.0, 1000  # a kilohertz in each interval's panels is a small part of a period
    for until in (0.1, 0.2, 0.35, 0.6):
        x, v = (np.array([motion(name, until, k) for name in names]) for k in (0, 1))
        stored = 0.5 * v @ beam.mass_matrix @ v + 0.5 * x @ beam.stiffness_matrix @ x
        half = 0.5 * (until - before) / panels
        times = np.add.outer(before + half * (2 * np.arange(panels) + 1), half * points)
        work += half * float((command(times) * motion("here", times, 1)).sum(axis=0) @ weights)
        before = until
        assert stored == pytest.approx(work, rel=1e-9)


# --- bad input ---------------------------------------------------------------------------------------------------

BEAM = Beam(1.0, 4, 1.0, 1.0)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Beam(0.0, 4, 1.0, 1.0), "length is 0 m"),
        (lambda: Beam(1.0, 0, 1.0, 1.0), "elements is 0: give a whole number from 1"),
        (lambda: Beam(1.0, 4, -1.0, 1.0), "bending_stiffness is -1 N m"),
        (lambda: Beam(1.0, 4, 1.0, [1.0, 2.0]), "mass_per_length has 2 values for 4 elements"),
        (lambda: Beam(1.0, 4, 1.0, 1.0, supports={0.0: "glued"}), "the support at 0 m is 'glued'"),
        (lambda: Beam(1.0, 4, 1.0, 1.0, supports={0.4: "pinned"}), "not at a node, the nearest is at 0.5 m"),
        (lambda: Beam(1.0, 4, 1.0, 1.0, lumps=[Lump(1.3, 1.0)]), "position 1.3 m is not on the beam"),
        (lambda: Beam(1.0, 1, 1.0, 1.0, supports={0.0: "clamped", 1.0: "clamped"}), "supports hold every node"),
        (lambda: Lump(0.0, -1.0), "mass is -1 kg"),
        (lambda: HingedPayload(0.0, 1.0), "no inertia of its own"),
        (lambda: HingedPayload(0.0, 1.0, 0.1, along=math.nan), "along and across holds nan"),
        (lambda: BEAM.displacement(1.1), "position 1.1 m is not on the beam"),
        (lambda: BEAM.hinge_angle(), "no hinged payload"),
        (lambda: BEAM.displacement(0.0) - BEAM.slope(0.0), "have no difference"),
        (lambda: BEAM.plant(BEAM.slope(0.0), {}), "no outputs"),
        (lambda: BEAM.plant(BEAM.slope(0.0), {"y": BEAM.slope(1.0)}, count=9), "count is 9: give a whole number"),
        (lambda: BEAM.plant(BEAM.slope(0.0), {"y": BEAM.slope(1.0)}, damping=[0.1]), "1 damping ratios for 8 modes"),
        (lambda: BEAM.plant(unit_beam("free-free", 5).slope(0.0), {"y": BEAM.slope(1.0)}), "of another beam"),
    ],
)
def test_wrong_input_is_answered_with_value_and_remedy(make, words: str) -> None:
    with pytest.raises(InputError, match=words):
        make()
