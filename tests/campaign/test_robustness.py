"""What remains of a move is what the residual-vibration law says, on linear plants; drawing is as asked for."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.campaign.campaigns import campaign, robustness

from preshape import Modes, design
from preshape.campaign.kind import random_of
from preshape.campaign.swing import swing
from preshape.errors import InputError
from preshape.plant import from_matrices
from preshape.vibration import residual_vibration


def row(data: dict[str, Any], point: int, *changes: tuple[str, Any]) -> dict[str, float]:
    return dict(campaign(data, *changes).kind().row(point))  # type: ignore[arg-type]


@pytest.mark.parametrize("point", range(6))
@pytest.mark.parametrize("family", ["zv", "zvd", "ei"])
def test_a_step_leaves_what_the_formula_says(family: str, point: int) -> None:
    """Robertson eq. 1-3, of the true frequency, through the shaper for the known one: an independent way to the number.

    Samples of a millisecond miss a peak of 1 Hz by at most (pi dt)^2 / 2 of it, impulses between them are split.
    """
    wish: dict[str, Any] = {"family": family, **({"tolerance": 0.05} if family == "ei" else {})}
    found = row(robustness(10), point, ("shaper", wish))
    shaper = design.FAMILIES[family]((1.0, 0.0), **{k: v for k, v in wish.items() if k != "family"})
    law = float(residual_vibration(shaper, found["frequency 1"]))
    assert found["unshaped"] == pytest.approx(1.0, rel=1e-5)
    assert found["remaining"] == pytest.approx(law, rel=1e-3, abs=1e-5)
    assert found["duration"] == shaper.duration


def test_damping_matters_as_the_formula_says() -> None:
    """A damped swing is seen at its first two turning points, which lie up to half a period later for one command than
    for the other: the ratio is that of the amplitudes within a factor exp(pi z)."""
    data = robustness(10)
    changes = (("machine.modes", [[1.0, 0.05]]), ("robustness.scatter", {"frequency": 0.1, "damping": 0.5}))
    for point in range(4):
        found = row(data, point, *changes)
        f, z = found["frequency 1"], 0.05 * found["damping 1"]
        law = float(residual_vibration(design.zvd((1.0, 0.05)), f, z))
        assert abs(math.log(found["remaining"] / law)) < math.pi * z


def test_the_scatter_has_the_asked_deviation_and_each_point_its_own() -> None:
    kind = campaign(robustness(400)).kind()
    factors = np.array([kind.row(point)["frequency 1"] for point in range(400)], dtype=float)
    assert np.unique(factors).size == 400
    # Of 400 normal numbers the mean is known to sd / 20 and the deviation to sd / 28: three times that.
    assert abs(np.log(factors).mean()) < 3.0 * 0.05 / 20.0
    assert np.log(factors).std() == pytest.approx(0.05, rel=3.0 / 28.0)


def test_a_point_has_the_random_numbers_of_its_child_of_the_seed() -> None:
    children = np.random.SeedSequence(4).spawn(3)
    expected = math.exp(0.05 * np.random.default_rng(children[2]).standard_normal())
    assert row(robustness(10), 2)["frequency 1"] == expected
    assert random_of(4, 1).random() == np.random.default_rng(children[1]).random()


MATRICES = {
    "matrices": {
        "mass": [[2.0, 0.0], [0.0, 1.0]],
        "stiffness": [[6.0, -6.0], [-6.0, 6.0]],
        "damping": [[0.0, 0.0], [0.0, 0.0]],
        "input": {"name": "force", "unit": "N", "coordinate": 0},
        "outputs": [{"name": "bend", "unit": "m", "weights": [-1.0, 1.0]}],
    }
}


def test_a_payload_on_matrices_is_mass_at_its_coordinate() -> None:
    data = robustness(10) | {"machine": {"plant": MATRICES, "payload_at": 1}}
    changes = (
        ("robustness.scatter", {}),
        ("robustness.ranges", {"payload": [0.5, 2.0]}),
        ("robustness.design", "each"),
    )
    dt = ("robustness.move", {"dt": 0.005, "times": [0.0, 1.0], "values": [1.0, 0.0]})
    found = row(data, 3, *changes, dt)
    heavy = from_matrices(
        [[2.0, 0.0], [0.0, 1.0 + found["payload"]]], 0.0, [[6.0, -6.0], [-6.0, 6.0]], input=0, outputs={"bend": [-1, 1]}
    )
    assert found["duration"] == pytest.approx(design.zvd(heavy.modes()).duration, rel=1e-12)
    assert found["remaining"] < 1e-4, "designed for the payload, nothing remains but what the samples split"
    once = [row(data, point, *changes, dt, ("robustness.design", "once"))["remaining"] for point in range(5)]
    assert max(once) > 0.01, "designed for the middle of the range, something does"


def test_state_space_and_modal_plants_with_the_same_modes_leave_the_same() -> None:
    """A damper in one place makes matrices a state space; the law is that of its poles, moved."""
    plant = {"matrices": {**MATRICES["matrices"], "damping": [[0.0, 0.0], [0.0, 0.05]]}}
    data = robustness(10) | {"machine": {"plant": plant}}
    move = ("robustness.move", {"dt": 0.005, "times": [0.0, 0.3], "values": [1.0, 0.0]})
    known = from_matrices(
        MATRICES["matrices"]["mass"], [[0.0, 0.0], [0.0, 0.05]], MATRICES["matrices"]["stiffness"],
        input=0, outputs={"bend": [-1, 1]},
    ).modes()  # fmt: skip
    assert len(known) == 1
    for point in range(3):
        found = row(data, point, move)
        law = float(residual_vibration(design.zvd(known), known[0].frequency * found["frequency 1"], known[0].damping))
        assert found["remaining"] == pytest.approx(law, rel=0.05, abs=2e-5)


def test_each_machine_gives_the_same_row_again() -> None:
    data = robustness(3) | {"machine": {"plant": "mace-linear"}}
    changes = (
        ("shaper", {"family": "direct", "count": 3}),
        ("robustness.output", "left"),
        ("robustness.move", {"dt": 0.001, "times": [0.0, 0.25, 0.75, 1.0], "values": [1.0, 0.0, -1.0, 0.0]}),
    )
    first, second = row(data, 1, *changes), row(data, 1, *changes)
    assert first == second
    assert 0.0 < first["remaining"] < 0.2


def test_the_non_linear_arm_swings_less_when_shaped() -> None:
    """Freeplay, friction and stiffening leave something; the shaper takes most."""
    data = robustness(1) | {"machine": {"plant": "shuttle-arm"}}
    found = row(
        data, 0,
        ("shaper", {"family": "direct", "count": 2}),
        ("robustness.scatter", {"stiffness": 0.05}),
        ("robustness.ranges", {"elbow pitch": [-1.0, -0.9]}),
        ("robustness.design", "each"),
        ("robustness.rest", 3.0),
        ("robustness.output", "end point y"),
        ("robustness.move", {"input": "shoulder yaw rate", "dt": 0.02, "times": [0.0, 2.0], "values": [0.02, 0.0]}),
    )  # fmt: skip
    assert found["unshaped"] > 0.002
    assert found["remaining"] < 0.3


def test_the_non_linear_mace_swings_less_when_shaped() -> None:
    pytest.importorskip("exudyn")
    data = robustness(1) | {"machine": {"plant": "mace"}}
    found = row(
        data, 0,
        ("shaper", {"family": "direct", "count": 2}),
        ("robustness.scatter", {"stiffness": 0.05}),
        ("robustness.ranges", {"angle": [-0.5, -0.4], "payload": [0.0, 0.5]}),
        ("robustness.design", "each"),
        ("robustness.wait", 0.5),
        ("robustness.rest", 3.0),
        ("robustness.output", "left end"),
        ("robustness.move", {"dt": 0.01, "times": [0.0, 0.4], "values": [0.0, 0.5], "between": "straight"}),
    )  # fmt: skip
    assert found["remaining"] < 0.3


def test_drift_and_what_else_coasts_is_no_swing() -> None:
    """Half of the swing of two modes over a parabola is their amplitudes' sum, where their peaks meet."""
    t = 0.001 * np.arange(4000)
    ringing = 2.0 * np.cos(2.0 * np.pi * t) + 0.5 * np.cos(2.0 * np.pi * 3.0 * t)
    modes = Modes([(1.0, 0.0), (3.0, 0.0)])
    assert swing(ringing, 0.001, modes) == pytest.approx(2.5, rel=1e-9)
    assert swing(ringing + 3.0 - 7.0 * t + 0.4 * t**2, 0.001, modes) == pytest.approx(2.5, rel=1e-6)
    with pytest.raises(InputError, match="samples of 0.001 s cannot show a mode of 1 Hz"):
        swing(ringing[:900], 0.001, modes)
