"""Recordings laid over each other tell the stops, also where the machine executed another shaper than it was told."""

from __future__ import annotations

import numpy as np
import pytest
from tests.workflow.random_machines import draw

from preshape.workflow.same_move import overlaid


@pytest.mark.parametrize("obeys", [True, False])
def test_the_stop_follows_from_the_other_recording(obeys: bool) -> None:
    """Machines that nothing was chosen on; alone, a stop is typically half a millisecond off."""
    noise = np.full(3, 0.01)
    for number in range(8):
        pair = draw(7, number, 0.01, obeys=obeys)
        found = overlaid(pair.before, pair.after, pair.told, (noise, noise))
        assert found.later == pytest.approx(pair.stops[1] - pair.stops[0], abs=5e-4)
        assert found.unexplained < 0.12
        assert (found.stretch == 1.0) if obeys else (found.stretch == pytest.approx(pair.stretch, rel=0.05))


def test_another_move_is_no_shaped_one() -> None:
    noise = np.full(3, 0.01)
    one, other = draw(7, 0, 0.01), draw(7, 1, 0.01)
    assert overlaid(one.before, other.after, one.told, (noise, noise)).unexplained > 0.12
