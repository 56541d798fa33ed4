"""Starting from a known shaper: the same optimum as from scratch, verified, and it says when it had to search."""

from __future__ import annotations

import numpy as np
import pytest

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


def test_a_start_that_is_none_is_refused() -> None:
    with pytest.raises(InputError, match="without a certificate"):
        design.direct([(1.0, 0.0)], near=design.zv((1.0, 0.0)))
    with pytest.raises(InputError, match="designed for 1 modes, not 2"):
        design.direct([(1.0, 0.0), (2.0, 0.0)], near=design.direct((1.0, 0.0)))
