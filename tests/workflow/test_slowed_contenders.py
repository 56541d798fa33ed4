"""Commands that break a limit are slowed until they keep it; what that cannot help is left out, with the reason."""

import pytest

from preshape.errors import InputError
from preshape.profile import Profile
from preshape.shaper import Shaper
from preshape.workflow import compare
from preshape.workflow.contenders.limited import Limited, stretched


def _amplifying(size: float) -> Shaper:
    return Shaper([0.0, 0.4, 0.8], [size, 1.0 - 2.0 * size, size])


def test_what_cannot_be_slowed_enough_is_left_out_with_what_it_reaches() -> None:
    """Slowed in time by a factor, an acceleration falls with its square: to a 4096th at 64 times, and no further."""
    own = {"most": _amplifying(900.0), "too much": _amplifying(9000.0)}
    result = compare((1.2, 0.01), 0.1125, maximum_acceleration=5.0, shapers=own)
    slowed = result["trapezoid + most"]
    assert slowed.peak_acceleration <= 5.0 * (1.0 + 1e-9) and "slowed" in slowed.note
    (reason,) = [one.reason for one in result.left_out if one.name == "trapezoid + too much"]
    assert reason.startswith("it cannot be slowed enough to keep the limits: 64 times slower it still reaches accel")
    assert "where 5 is allowed; allow more" in reason


def test_every_limit_that_is_broken_is_named_and_no_other() -> None:
    """A command that does not become slower: levels 2 and 3 for a second each, so a speed of 5."""
    narrow = Limited(0.5, acceleration=1.0, speed=1.0, jerk=1.0)
    with pytest.raises(InputError, match=r"reaches speed 5 where 1 .* and acceleration 3 where 1 [^;]*allowed; allow"):
        stretched(lambda _: Profile.steps([0.0, 1.0, 2.0], [2.0, 1.0, -3.0]), narrow)
