"""Outputs of driven phasors: the bounds hold, and the short way for staircases is the general one."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from preshape.kernel import DrivenOutput, driven_phasors

poles = st.lists(st.builds(complex, st.floats(-5.0, 0.0), st.floats(0.01, 40.0)), min_size=1, max_size=3)
pieces = st.lists(
    st.tuples(st.floats(0.01, 1.5), st.lists(st.floats(-3.0, 3.0), min_size=6, max_size=6)), min_size=1, max_size=4
)


def output_of(s: list[complex], rows: list[tuple[float, list[float]]], order: int) -> DrivenOutput:
    """`order` columns of input; the polynomial part is another of five columns, the weights turn with the index."""
    starts = np.cumsum([gap for gap, _ in rows])
    taylor = np.array([row for _, row in rows])
    run = driven_phasors(np.array(s), starts, taylor[:, :order])
    return DrivenOutput(run, (1.0 + 0.5j) ** np.arange(len(s)), taylor[:, ::-1][:, :5])


@given(poles, pieces, st.integers(1, 6), st.floats(0.0, 1.0), st.floats(0.01, 2.0))
def test_no_derivative_exceeds_its_bound(
    s: list[complex], rows: list[tuple[float, list[float]]], order: int, since: float, width: float
) -> None:
    output = output_of(s, rows, order)
    for k in range(len(rows)):
        look = output.looked(np.array([k]), np.array([since]), np.array([width]))
        within = since + np.linspace(0.0, width, 101)
        values = output.values(np.full(101, k), within, 3)
        np.testing.assert_allclose([look.value, look.slope, look.curvature], values[:3, :1], rtol=1e-13)
        assert np.abs(values[2]).max() <= look.most_curvature[0] * (1 + 1e-12)
        assert np.abs(values[3]).max() <= look.most_third[0] * (1 + 1e-12)


@given(poles, pieces)
def test_bounds_are_reached_by_one_pole_without_input(s: list[complex], rows: list[tuple[float, list[float]]]) -> None:
    # A bound that is far too large would only make the search slow; for free vibration it is the envelope.
    run = driven_phasors(np.array([s[0].imag * 1j]), np.zeros(1), np.zeros((1, 1)), np.array([[1.0 + 1.0j]]))
    output = DrivenOutput(run, np.array([1.0 + 0.0j]), np.zeros((1, 0)))
    look = output.looked(np.zeros(1, dtype=int), np.zeros(1), np.array([10.0]))
    assert np.isclose(look.most_curvature[0], s[0].imag ** 2 * np.sqrt(2.0))
    assert np.isclose(look.most_third[0], s[0].imag ** 3 * np.sqrt(2.0))


@given(poles, pieces)
def test_the_short_way_for_staircases_is_the_general_one(
    s: list[complex], rows: list[tuple[float, list[float]]]
) -> None:
    short, general = output_of(s, rows, 1), output_of(s, rows, 1)
    general._staircase = False
    segment = np.repeat(np.arange(len(rows)), 9)
    since = np.tile(np.linspace(0.0, 1.5, 9), len(rows))
    width = np.full(since.size, 0.1)
    one, other = short.values(segment, since, 3), general.values(segment, since, 3)
    scale = np.abs(s).max() ** np.arange(4)[:, np.newaxis] * (10.0 + 10.0 / np.abs(s).min())
    assert (np.abs(one - other) <= 1e-12 * scale).all()
    a, b = short.looked(segment, since, width), general.looked(segment, since, width)
    np.testing.assert_allclose(a.most_curvature, b.most_curvature, rtol=1e-9, atol=1e-12 * float(scale[2, 0]))
    for x, y in zip(short.ending(), general.ending(), strict=True):
        np.testing.assert_allclose(x[: y.size], y[: x.size], rtol=1e-9, atol=1e-12 * float(scale[0, 0]))


def test_slow_poles_keep_their_digits_under_a_staircase() -> None:
    # In a millionth of a radian a mode is pushed like a free mass, x = t^2 / 2, far below its resting place 1/w^2.
    run = driven_phasors(np.array([1e-6j]), np.array([0.0, 1.0, 2.0]), np.array([[1.0], [-1.0], [0.0]]))
    output = DrivenOutput(run, np.array([-1j / 1e-6]), np.zeros((3, 0)))
    values = output.values(np.array([0, 0, 1, 1]), np.array([0.25, 0.5, 0.5, 1.0]))[0]
    np.testing.assert_allclose(values, [0.03125, 0.125, 0.875, 1.0], rtol=2e-12)
