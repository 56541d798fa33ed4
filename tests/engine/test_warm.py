"""Starting from a known shaper: the same optimum as from scratch, verified, and it says when it had to search."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import design
from preshape.engine import is_proved_shortest
from preshape.errors import InputError

SETS = [
    [(1.65, 0.01), (5.42, 0.01), (6.90, 0.01), (19.08, 0.01)],
    [(0.20, 0.0), (0.26, 0.0), (0.45, 0.0), (0.59, 0.0)],
    [(1.0, 0.02), (2.7, 0.05), (4.1, 0.0)],
]


@pytest.mark.parametrize("modes", SETS)
@pytest.mark.parametrize("change", [0.99, 1.01])
def test_modes_that_move_together_need_no_search(modes: list[tuple[float, float]], change: float) -> None:
    moved = [(change * f, z) for f, z in modes]
    warm = design.direct(moved, near=design.direct(modes))
    assert warm.design.settings["start"] == "near"
    assert warm.design.status == "optimal" and is_proved_shortest(warm)
    assert warm.duration == pytest.approx(design.direct(moved).duration, rel=1e-10)


@pytest.mark.parametrize("modes", SETS)
def test_modes_that_move_apart_give_the_same_optimum_with_or_without_a_search(modes: list[tuple[float, float]]) -> None:
    random, shaper, near = np.random.default_rng(6), design.direct(modes), 0
    for _ in range(6):
        moved = [(f * (1.0 + 0.01 * random.uniform(-1.0, 1.0)), z) for f, z in modes]
        warm = design.direct(moved, near=shaper)
        near += warm.design.settings["start"] == "near"
        assert warm.design.status == "optimal" and is_proved_shortest(warm)
        assert warm.duration == pytest.approx(design.direct(moved).duration, rel=1e-10)
    assert near > 0


def test_far_modes_fall_back_to_the_search_and_say_so() -> None:
    shaper = design.direct([(1.0, 0.0), (2.3, 0.0), (3.1, 0.0)])
    again = design.direct([(1.0, 0.0), (7.9, 0.0), (30.0, 0.0)], near=shaper)
    assert again.design.settings["start"] in ("full", "near") and is_proved_shortest(again)
    assert again.duration == pytest.approx(design.direct([(1.0, 0.0), (7.9, 0.0), (30.0, 0.0)]).duration, rel=1e-10)


@settings(max_examples=20)
@given(st.lists(st.floats(-0.01, 0.01), min_size=4, max_size=4), st.integers(0, 1), st.sampled_from(SETS))
def test_warm_and_cold_agree_to_nine_digits(changes: list[float], order: int, modes: list[tuple[float, float]]) -> None:
    moved = [(f * (1.0 + change), z) for (f, z), change in zip(modes, changes, strict=False)]
    warm, cold = design.direct(moved, order, near=design.direct(modes, order)), design.direct(moved, order)
    assert warm.duration == pytest.approx(cold.duration, rel=1e-9)
    assert warm.design.residual is not None and warm.design.residual < 1e-11
    np.testing.assert_allclose(warm.times, cold.times, atol=1e-6 * cold.duration)


def test_a_chain_of_starts_does_not_drift() -> None:
    """Each from the one before, along a slow change there and back: the last is the first again."""
    shaper = first = design.direct(SETS[0])
    for step in (*range(1, 11), *range(9, -1, -1)):
        moved = [(f * (1.0 + 0.003 * step * (-1) ** i), z) for i, (f, z) in enumerate(SETS[0])]
        shaper = design.direct(moved, near=shaper)
        assert shaper.design.status == "optimal" and is_proved_shortest(shaper)
    assert shaper.duration == pytest.approx(first.duration, rel=1e-10)


def test_another_order_is_searched_for_and_said() -> None:
    shaper = design.direct(SETS[2], 0)
    other = design.direct(SETS[2], 1, near=shaper)
    assert other.design.settings["start"] == "full" and other.duration == design.direct(SETS[2], 1).duration


def test_a_start_that_is_none_is_refused() -> None:
    with pytest.raises(InputError, match="without a certificate"):
        design.direct([(1.0, 0.0)], near=design.zv((1.0, 0.0)))
    with pytest.raises(InputError, match="designed for 1 modes, not 2"):
        design.direct([(1.0, 0.0), (2.0, 0.0)], near=design.direct((1.0, 0.0)))
    for nothing in (design.specified_insensitivity((0.9, 1.1)), "shaper", 1.0):
        with pytest.raises(InputError, match="without a certificate for modes: give a shaper of design.direct"):
            design.direct([(1.0, 0.0)], near=nothing)  # type: ignore[arg-type]
