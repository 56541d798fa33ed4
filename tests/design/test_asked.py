"""Families by their names: each is designed with what it needs, and refuses by name what it does not take."""

from __future__ import annotations

import pytest

from preshape.band import Band
from preshape.design import ASKED_FAMILIES, OPTIONS, designed, needed_by, taken_by
from preshape.errors import InputError
from preshape.mode import Mode

MODES = [Mode(10.0, 0.02)]

VALUES = {
    "tolerance": 0.06,
    "order": 1,
    "humps": 2,
    "negative_amplitude": 0.5,
    "deflection_ratio": 0.4,
    "form": "impulses",
    "base": "zv",
    "impulses": "exact",
    "frequency_tolerance": 0.001,
    "damping": 0.01,
    "duration": 0.2,
    "cost": "zero",
    "prefer": "flattest",
    "fewest": False,
    "at_most": 9,
    "dt": 0.001,
}
"""One of each option, which every family that takes it can meet."""


def targets(family: str) -> tuple[list[Mode], list[Band]]:
    return ([], [Band(9.5, 10.5, 0.02)]) if family == "si" else (MODES, [])


@pytest.mark.parametrize("family", ASKED_FAMILIES)
def test_a_family_is_designed_with_what_it_needs_and_without_it_says_so(family: str) -> None:
    needed = {name: VALUES[name] for name in needed_by(family)}
    assert designed(family, *targets(family), needed).duration > 0.0
    for name in needed:
        rest = {other: value for other, value in needed.items() if other != name}
        with pytest.raises(InputError, match=f"needs {name}"):
            designed(family, *targets(family), rest)


@pytest.mark.parametrize("family", ASKED_FAMILIES)
def test_a_family_takes_what_it_says_and_nothing_else(family: str) -> None:
    needed = {name: VALUES[name] for name in needed_by(family)}
    for name in OPTIONS:
        wishes = {**needed, name: VALUES[name]}
        if name in taken_by(family, wishes):
            assert designed(family, *targets(family), wishes).duration > 0.0
        else:
            with pytest.raises(InputError, match=rf"does not take {name}: it takes"):
                designed(family, *targets(family), wishes)


def test_every_option_is_of_use() -> None:
    used = {name for family in ASKED_FAMILIES for name in taken_by(family)} | {"damping"}  # of ei for a band
    assert used == set(OPTIONS) == set(VALUES)
    assert designed("ei", [], [Band(9.0, 11.0)], {"damping": 0.01}).duration > 0.0


def test_a_sample_time_puts_any_family_on_the_grid() -> None:
    for family in ASKED_FAMILIES:
        needed = {name: VALUES[name] for name in needed_by(family)}
        shaper = designed(family, *targets(family), {**needed, "dt": 0.001})
        slots = shaper.times / 0.001
        assert abs(slots - slots.round()).max() < 1e-9, family


@pytest.mark.parametrize("family", ["magic", "", "ZV"])
def test_there_is_no_other_family(family: str) -> None:
    with pytest.raises(InputError, match="choose one of zv, zvd"):
        designed(family, MODES)
