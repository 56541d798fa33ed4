"""The direct shapers of NUMBERS.md, their certificates, and what an independent solver says of shorter ones."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Modes, Shaper, design
from preshape.engine import is_proved_shortest
from preshape.errors import InputError
from preshape.vibration import residual_vibration

TABLE = [
    ("1 and 10 Hz", [(1.0, 0.0), (10.0, 0.0)], 1.05120780, 7),
    ("Shuttle arm", [(0.20, 0.0), (0.26, 0.0), (0.45, 0.0), (0.59, 0.0)], 10.67402391, 9),
    ("linear MACE", [(9.8, 0.0), (31.7, 0.0), (66.1, 0.0)], 0.11922900, 8),
    ("MACE open loop", [(f, 0.01) for f in (1.65, 5.42, 6.90, 19.08)], 0.73805696, 10),
    ("MACE outboard", [(f, 0.01) for f in (2.18, 14.25, 15.25, 15.90)], 0.54012401, 10),
    ("MACE inboard", [(f, 0.01) for f in (1.88, 13.40, 14.20, 15.90)], 0.61102962, 9),
    ("inboard and 1.50", [(f, 0.01) for f in (1.50, 1.88, 13.40, 14.20, 15.90)], 1.22387732, 13),
    ("inboard, 1.50, 2.00", [(f, 0.01) for f in (1.50, 1.88, 2.00, 13.40, 14.20, 15.90)], 1.68510414, 15),
]
"""The eight rows of NUMBERS.md. The sixth and last durations are ours: 3e-7 and 4.2e-5 below the reference value there,
which was no certified one; each is met by a feasible shaper and by a certificate, so it is the shortest."""


def constraint_rows(modes: Modes, order: int, times: np.ndarray) -> np.ndarray:
    """t^k exp(s t), written out anew here, each row scaled to its largest value."""
    rows = []
    for mode in modes:
        for k in range(order + 1):
            wave = (times / times[-1]) ** k * np.exp(-np.conj(mode.pole) * (times - times[-1]))
            rows += [wave.real, wave.imag]
    return np.array(rows)


@pytest.mark.parametrize(("modes", "duration", "impulses"), [row[1:] for row in TABLE], ids=[row[0] for row in TABLE])
def test_the_table_is_met_and_proved(modes: list[tuple[float, float]], duration: float, impulses: int) -> None:
    shaper = design.direct(modes)
    assert shaper.design.status == "optimal"
    assert shaper.duration == pytest.approx(duration, rel=1e-6)
    assert len(shaper) == impulses
    assert shaper.duration < design.zvd(modes).duration
    for frequency, damping in modes:
        assert residual_vibration(shaper, frequency, damping) < 1e-12
        near = residual_vibration(shaper, frequency * (1.0 + np.array([-1e-5, 1e-5])), damping)
        assert near.max() < 1e-6  # quadratic in the frequency error: the slope at the mode is zero


@pytest.mark.parametrize(("modes", "duration"), [row[1:3] for row in TABLE], ids=[row[0] for row in TABLE])
def test_the_certificate_excludes_everything_shorter(modes: list[tuple[float, float]], duration: float) -> None:
    """Checked with the certificate's own data only: p is built of the rows, p >= 0, zero at the impulses."""
    shaper = design.direct(modes)
    certificate = shaper.design.certificate
    assert certificate is not None and certificate.holds
    times = np.linspace(0.0, shaper.duration, 40_001)
    p = certificate.polynomial(times)
    assert p.min() >= -1e-9 * np.abs(p).max()
    assert np.abs(certificate.polynomial(shaper.times)).max() < 1e-9 * np.abs(p).max()
    np.testing.assert_allclose(certificate.contacts, shaper.times, atol=1e-6 * shaper.duration)
    rows = constraint_rows(Modes(modes), 1, times)
    remainder = p - np.linalg.lstsq(rows.T, p, rcond=None)[0] @ rows
    assert np.abs(remainder).max() < 1e-9 * np.abs(p).max()


@pytest.mark.parametrize(("modes", "duration"), [row[1:3] for row in TABLE], ids=[row[0] for row in TABLE])
def test_an_independent_solver_finds_nothing_shorter_and_something_slightly_longer(
    modes: list[tuple[float, float]], duration: float
) -> None:
    """Interior-point linear programme on a fine mesh, rows orthonormalised: least L1 miss of positive impulses."""
    from scipy.optimize import linprog

    misses = {}
    for factor in (0.995, 1.005):
        fastest = max(frequency for frequency, _ in modes)
        times = np.linspace(0.0, factor * duration, int(60 * fastest * duration) + 200)
        q, _ = np.linalg.qr(constraint_rows(Modes(modes), 1, times).T)
        rows = q.T * np.sqrt(times.size)
        m, n = rows.shape
        answer = linprog(
            np.concatenate([np.zeros(n), np.ones(2 * m)]),
            A_eq=np.block([[rows, np.eye(m), -np.eye(m)], [np.ones((1, n)), np.zeros((1, 2 * m))]]),
            b_eq=np.append(np.zeros(m), 1.0),
            method="highs-ipm",
            options={"time_limit": 20.0},
        )
        assert answer.status == 0
        misses[factor] = answer.fun
    assert misses[0.995] > 1e-3
    assert misses[1.005] < 1e-8


@pytest.mark.parametrize(("modes"), [row[1] for row in TABLE], ids=[row[0] for row in TABLE])
def test_every_proof_survives_a_file_and_is_checked_anew(modes: list[tuple[float, float]]) -> None:
    assert is_proved_shortest(Shaper.from_dict(json.loads(json.dumps(design.direct(modes).to_dict()))))


def test_one_mode_gives_the_closed_forms() -> None:
    for damping in (0.0, 0.05, 0.3):
        for order, family in enumerate((design.zv, design.zvd, design.zvdd)):
            found, known = design.direct((3.0, damping), order), family((3.0, damping))
            np.testing.assert_allclose(found.times, known.times, atol=1e-10)
            np.testing.assert_allclose(found.amplitudes, known.amplitudes, atol=1e-10)


def test_odd_harmonics_cost_nothing() -> None:
    """ZVD for 1 Hz is zero at 3 and 9 Hz by itself when nothing is damped."""
    shaper = design.direct([(1.0, 0.0), (3.0, 0.0), (9.0, 0.0)])
    assert shaper.duration == pytest.approx(1.0, rel=1e-9)
    assert shaper.design.status == "optimal"


@pytest.mark.parametrize(("low", "high"), [(0.20, 0.26), (1.0, 1.1), (1.0, 2.5)])
def test_two_modes_need_four_over_the_sum_of_the_frequencies(low: float, high: float) -> None:
    """Hyde's two-mode rule, R = 4 / (f1 + f2) while f2 <= 3 f1, undamped."""
    shaper = design.direct([(low, 0.0), (high, 0.0)])
    assert shaper.duration == pytest.approx(4.0 / (low + high), rel=1e-9)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(1.0, 8.0), st.floats(0.0, 0.2)), min_size=1, max_size=4, unique_by=lambda m: round(m[0], 6)
    ),
    st.integers(0, 1),
)
def test_random_modes_are_always_proved_and_never_longer_than_convolved(
    modes: list[tuple[float, float]], order: int
) -> None:
    shaper = design.direct(modes, order)
    assert (shaper.amplitudes > 0.0).all()
    assert shaper.design.residual is not None and shaper.design.residual < 1e-12
    assert shaper.duration <= design.zvdk(modes, order).duration * (1.0 + 1e-9)
    assert shaper.design.status == "optimal" and is_proved_shortest(shaper)


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("ratio", [1.0 + 1e-6, 1.0002, 1.0005, 1.001, 1.005, 1.02, 1.05])
def test_near_modes_are_told_apart(ratio: float, order: int) -> None:
    """Two undamped modes need (order + 1) 2 / (f1 + f2), as for one mode between them; searches find less when
    rounding hides the constraints."""
    shaper = design.direct([(1.0, 0.0), (ratio, 0.0)], order)
    assert shaper.design.status == "optimal" and is_proved_shortest(shaper)
    assert shaper.duration == pytest.approx((order + 1) * 2.0 / (1.0 + ratio), rel=1e-9)
    assert shaper.design.residual < 1e-12


def test_near_modes_with_many_derivatives_still_leave_nothing() -> None:
    """Scaled rows would have a condition of 1e8 here; the residual must not show it."""
    shaper = design.direct(TABLE[-1][1], order=2)
    assert shaper.design.status == "optimal"
    assert shaper.design.residual < 1e-12


def test_mixed_orders_lie_between() -> None:
    modes = [(1.0, 0.02), (2.7, 0.01)]
    low, mixed, high = (design.direct(modes, order) for order in (0, [1, 0], 1))
    assert low.duration < mixed.duration < high.duration
    assert mixed.design.status == "optimal"


@pytest.mark.parametrize(
    ("order", "sentence"), [(-1, "from 0 to 6"), (7, "from 0 to 6"), ([1], "1 orders for 2 modes")]
)
def test_impossible_orders_are_refused(order: object, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        design.direct([(1.0, 0.0), (2.0, 0.0)], order)
