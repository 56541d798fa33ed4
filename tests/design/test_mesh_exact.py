"""From the mesh to few impulses: squashing, interpretation, the exact solution; and rounding back to a grid."""

from __future__ import annotations

import math

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


def largest(shaper: Shaper, modes: list[tuple[float, float]]) -> float:
    return max(float(residual_vibration(shaper, *mode)) for mode in modes)


def largest_slope(shaper: Shaper, modes: list[tuple[float, float]]) -> float:
    """|dV / d ln f| where V = 0, from V itself a little beside the mode (both sides: the even part cancels)."""
    slopes = []
    for f, z in modes:
        s = 2.0 * math.pi * f * complex(z, math.sqrt(1.0 - z * z))
        lead = shaper.duration - shaper.times
        slopes.append(abs(np.sum(shaper.amplitudes * s * lead * np.exp(-s * lead))))
    return max(slopes)


def test_squashing_takes_the_shortest_flattest_sequence_to_seven_impulses() -> None:
    """Figures 3.12 and 3.15: Hyde has 11 impulses and 7. Ours are 12, two of them 0.0003, and the same 7."""
    shaper = design.mesh(TWO, 0.005, cost="second_derivative")
    assert len(shaper) == 12 and int((shaper.amplitudes > 0.001).sum()) == 10
    squashed = design.squashed(shaper, 0.005)
    assert len(squashed) == 7 and squashed.duration == shaper.duration
    np.testing.assert_allclose(squashed.times / 0.005, np.rint(squashed.times / 0.005), atol=1e-9)
    assert squashed.amplitudes.sum() == pytest.approx(1.0, abs=1e-12)
    assert 0.0 < squashed.design.residual < 0.05  # "slight" degradation: 4.6 % at 10 Hz
    assert squashed.design.status == "given" and squashed.design.settings["squashed"] == "on the grid"


def test_squashing_rules() -> None:
    pair_and_one = Shaper([0.0, 0.1, 0.2, 0.5], [0.1, 0.3, 0.2, 0.4])
    on_grid = design.squashed(pair_and_one, 0.1)
    np.testing.assert_allclose(on_grid.times, [0.0, 0.1, 0.4], atol=1e-12)  # 0 and 0.1 stand at 0.1, the larger
    np.testing.assert_allclose(on_grid.amplitudes, [0.4, 0.2, 0.4])
    halfway = design.squashed(pair_and_one, 0.1, keep_grid=False)
    np.testing.assert_allclose(halfway.times, [0.0, 0.15, 0.45], atol=1e-12)
    alone = Shaper([0.0, 0.2], [0.5, 0.5])
    assert design.squashed(alone, 0.1) is alone


@settings(max_examples=50)
@given(st.lists(st.tuples(st.integers(0, 30), st.floats(0.01, 1.0)), min_size=2, max_size=12, unique_by=lambda p: p[0]))
def test_squashing_keeps_the_sum_and_halfway_moves_no_more_than_half_a_slot(impulses: list[tuple[int, float]]) -> None:
    shaper = Shaper.normalised([0.01 * k for k, _ in impulses], [a for _, a in impulses])
    for keep_grid in (True, False):
        squashed = design.squashed(shaper, 0.01, keep_grid=keep_grid)
        assert squashed.amplitudes.sum() == pytest.approx(1.0, abs=1e-12)
        assert (len(shaper) + 1) // 2 <= len(squashed) <= len(shaper)
    # A mode sees an impulse that moves by half a slot turn by at most pi f dt.
    change = residual_vibration(squashed, [1.0, 3.0]) - residual_vibration(shaper, [1.0, 3.0])
    assert np.abs(change).max() <= 0.01 * math.pi * 3.0


@pytest.mark.parametrize("dt", [0.1, 0.05])
@pytest.mark.parametrize("cost", ["zero", "second_derivative"])
def test_the_shuttle_arm_from_mesh_to_exact(dt: float, cost: str) -> None:
    """Figures 3.14, 3.17 and 3.18. The exact one turns out to be the certified shortest."""
    guess = design.interpreted(design.mesh(ARM, dt, cost=cost), dt)
    assert len(guess) == 9 and guess.design.status == "given"
    exact = design.solved_from(guess)
    assert exact.design.status == "exact" and len(exact) == 9
    assert largest(exact, ARM) < 1e-12 and largest_slope(exact, ARM) < 1e-10
    assert exact.duration == pytest.approx(design.direct(ARM).duration, rel=1e-9)
    assert exact.amplitudes[0] / exact.amplitudes.sum() > 0.0
    assert np.abs(ModalPlant(ARM).step_train(exact.times, exact.amplitudes).residual_amplitudes).max() < 1e-11


def test_two_modes_below_three_to_one_give_hydes_rule() -> None:
    for high in (1.3, 2.0, 2.9):
        modes = [(1.0, 0.0), (high, 0.0)]
        exact = design.solved_from(design.interpreted(design.mesh(modes, 0.01), 0.01))
        assert exact.duration == pytest.approx(4.0 / (1.0 + high), rel=1e-9) and len(exact) == 5


@pytest.mark.parametrize(("modes", "dt"), [(TWO, 0.005), ([(1.0, 0.0), (3.1, 0.0)], 0.01)])
def test_hydes_routine_fails_above_three_to_one_and_says_so(modes: list[tuple[float, float]], dt: float) -> None:
    guess = design.interpreted(design.mesh(modes, dt, cost="second_derivative"), dt)
    with pytest.raises(InputError, match="f2 > 3 f1.*design.direct"):
        design.solved_from(guess)
    assert design.direct(modes).design.status == "optimal"


def test_one_and_ten_hertz_have_an_exact_five_impulse_shaper_all_the_same() -> None:
    """From the zero-cost guess Newton finds one on elevenths of a second, longer than the certified 1.0512 s."""
    exact = design.solved_from(design.interpreted(design.mesh(TWO, 0.005), 0.005))
    assert exact.duration == pytest.approx(12.0 / 11.0, rel=1e-12) and len(exact) == 5
    assert largest(exact, TWO) < 1e-12 and (exact.amplitudes > 0.0).all()
    np.testing.assert_allclose(exact.times, np.array([0, 5, 6, 11, 12]) / 11.0, atol=1e-12)


def test_linear_mace_with_seven_impulses_is_longer_than_the_certified_eight() -> None:
    exact = design.solved_from(design.interpreted(design.mesh(MACE, 0.002), 0.002))
    shortest = design.direct(MACE)
    assert (len(exact), len(shortest)) == (7, 8)
    assert 0.0 < exact.duration - shortest.duration < 5e-5
    assert largest(exact, MACE) < 1e-12


def test_seven_modes_are_solved_where_hyde_stopped_at_five() -> None:
    modes = [(1.0 + 0.2 * i, 0.0) for i in range(7)]
    exact = design.solved_from(design.interpreted(design.mesh(modes, 0.005), 0.005))
    assert len(exact) == 15 and largest(exact, modes) < 1e-12
    assert exact.duration == pytest.approx(design.direct(modes).duration, rel=1e-9)


def test_an_odd_harmonic_needs_no_impulses_of_its_own() -> None:
    modes = [(1.0, 0.0), (7.0, 0.0)]
    exact = design.solved_from(design.interpreted(design.mesh(modes, 0.005), 0.005))
    assert len(exact) == 3 and exact.duration == pytest.approx(1.0, rel=1e-12)


def test_more_impulses_than_equations_take_the_smallest_step() -> None:
    mesh = design.mesh(ARM, 0.1)
    exact = design.solved_from(design.interpreted(mesh, 0.1, impulses=11))
    assert len(exact) == 11 and largest(exact, ARM) < 1e-12


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: design.squashed(design.direct(TWO), 0.005), "not on a grid"),
        (lambda: design.squashed(Shaper([0.0, 0.1, 0.2], [0.6, -0.2, 0.6]), 0.1), "only positive"),
        (lambda: design.interpreted(Shaper([0.0, 0.1], [0.5, 0.5]), 0.1), "how many"),
        (lambda: design.solved_from(Shaper([0.0, 0.1], [0.5, 0.5])), "does not know its modes"),
        (lambda: design.solved_from(design.zv(TWO[0])), "2 impulses are too few.*give a guess of 3"),
        (lambda: design.rounded(Shaper([0.0, 0.1], [0.5, 0.5]), 0.1), "does not know its modes"),
        (lambda: design.rounded(design.zv(TWO[0]), 0.6), "at most 0.5 s"),
        (lambda: design.rounded(design.um_zv(TWO[0]), 0.01), "on_grid"),
    ],
)
def test_what_cannot_be_done_says_so(call: object, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        call()


def plainly_rounded(shaper: Shaper, dt: float) -> Shaper:
    return Shaper.normalised(np.rint(shaper.times / dt) * dt, shaper.amplitudes)


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.tuples(st.floats(1.0, 8.0), st.floats(0.0, 0.2)), min_size=1, max_size=3),
    st.integers(0, 1),
    st.floats(0.02, 0.2),
)
def test_rounding_is_never_worse_than_what_it_starts_from(
    modes: list[tuple[float, float]], order: int, fraction: float
) -> None:
    apart = sorted(frequency for frequency, _ in modes)
    if any(b < 1.02 * a for a, b in zip(apart, apart[1:], strict=False)):
        return
    dt = fraction / apart[-1]
    exact = design.direct(modes, order)
    near, both = (design.rounded(exact, dt, order=order, neighbours=value) for value in (False, True))
    highest = max(2.0 * math.pi * f * z for f, z in modes)
    for shaper, before in ((near, plainly_rounded(exact, dt)), (both, design.on_grid(exact, dt))):
        np.testing.assert_allclose(shaper.times / dt, np.rint(shaper.times / dt), atol=1e-9)
        assert (shaper.amplitudes > 0.0).all() and len(shaper) <= len(before)
        assert shaper.design.residual == pytest.approx(largest(shaper, modes), abs=1e-15)
        # Both at the same time: a shaper that does without the last slot is measured earlier, before the decay.
        earlier = math.exp(highest * (before.duration - shaper.duration))
        assert shaper.design.residual <= largest(before, modes) * earlier + 1e-9
        if shaper.design.status == "feasible":
            assert shaper.design.residual < 1e-12 and shaper.design.settings["slope"] < 1e-9


def test_both_neighbours_make_zero_possible_on_every_grid_of_the_papers_cases() -> None:
    for modes, dt in ((ARM, 0.1), (ARM, 0.05), (TWO, 0.005), (MACE, 0.001)):
        shaper = design.rounded(design.direct(modes), dt, neighbours=True)
        assert shaper.design.status == "feasible" and shaper.design.residual < 1e-12
        assert len(shaper) < len(design.on_grid(design.direct(modes), dt)) + 1
        assert np.abs(ModalPlant(modes).step_train(shaper.times, shaper.amplitudes).residual_amplitudes).max() < 1e-11


@pytest.mark.parametrize(("modes", "dt"), [(ARM, 0.1), (MACE, 0.001), ([(40.0, 0.05)], 0.001)])
def test_the_least_residual_is_least_says_a_linear_programme(modes: list[tuple[float, float]], dt: float) -> None:
    """Order 0, zero impossible: least largest |V| over the same slots, discs as polygons of 720 sides around them."""
    from scipy.optimize import linprog

    exact = design.direct(modes)
    shaper = design.rounded(exact, dt, order=0)
    places = np.unique(np.rint(exact.times / dt))
    leads = (places[-1] - places) * dt
    poles = np.array([mode.pole.conjugate() for mode in Modes(modes)])
    waves = np.exp(np.multiply.outer(poles, leads))
    sides = np.concatenate([(turn * waves).real for turn in np.exp(2j * np.pi * np.arange(720) / 720)])
    least = linprog(
        np.append(np.zeros(leads.size), 1.0),
        A_ub=np.column_stack([sides, -np.ones(len(sides))]),
        b_ub=np.zeros(len(sides)),
        A_eq=[[1.0] * leads.size + [0.0]],
        b_eq=[1.0],
    )
    assert shaper.design.status == "given" and least.fun > 1e-3
    at_last_slot = [
        residual_vibration(shaper, f, z) * math.exp(-2.0 * math.pi * f * z * (leads[0] - shaper.duration))
        for f, z in modes
    ]
    assert max(at_last_slot) == pytest.approx(least.fun, rel=2e-5, abs=2e-7)  # HiGHS meets rows to 1e-7
    assert design.rounded(exact, dt).design.settings["slope"] <= largest_slope(plainly_rounded(exact, dt), modes) + 1e-3


def test_zero_residual_comes_with_the_least_slope() -> None:
    shaper = design.rounded(design.direct(TWO), 0.005)
    assert shaper.design.residual < 1e-12 and shaper.design.status == "given"
    assert shaper.design.settings["slope"] == pytest.approx(largest_slope(shaper, TWO), rel=1e-9)
    assert shaper.design.settings["slope"] < 0.2 * largest_slope(plainly_rounded(design.direct(TWO), 0.005), TWO)


def test_rounding_a_shaper_that_is_on_the_grid_keeps_it() -> None:
    shaper = design.zvd((10.0, 0.0))
    again = design.rounded(shaper, 0.01)
    np.testing.assert_allclose(again.times, shaper.times, atol=1e-12)
    np.testing.assert_allclose(again.amplitudes, shaper.amplitudes, atol=1e-9)
    assert again.design.status == "feasible"
