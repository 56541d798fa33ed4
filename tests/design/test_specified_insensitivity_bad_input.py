"""Asks for bands that cannot be met, or are none: one sentence, soon. Proofs that were changed: not believed."""

from __future__ import annotations

import json
import math
import time
from dataclasses import replace

import numpy as np
import pytest

from preshape import Shaper, design
from preshape.engine import is_proved_shortest
from preshape.errors import InputError

TWO = [(0.9, 1.1), (2.7, 3.3)]
SOON = 5.0
"""Seconds; an infeasible ask is not to be searched for long. Ten times what it takes, for busy machines."""


@pytest.mark.parametrize(
    ("wishes", "message"),
    [
        ({"bands": (0.0, 1.1)}, "a machine part that does not vibrate .0 Hz. needs no shaper"),
        ({"bands": (0.01, 50.0)}, "too wide to be solved soon: narrow them to a ratio of 12"),
        ({"bands": [(1.0, 1.1), (2000.0, 2200.0)]}, "too wide"),
        ({"dt": 0.2}, "0.2 s is coarser than half a period of 3.3 Hz: give dt below 0.1515"),
        ({"dt": 1e-6}, "up to 4000 slots of 1e-06 s, 0.004 s, meets these limits.*: give a coarser grid"),
        ({"dt": -0.01}, "dt is -0.01 s: give a value above 0 s"),
        ({"dt": "a"}, "dt must be a number"),
        ({"dt": math.nan}, "dt is nan"),
        ({"at_most": 1}, "at most 1 impulses .*; 6 impulses do it in 1.00322 s: allow as many"),
        ({"at_most": 2, "dt": 0.02}, "at most 2 impulses .*: allow as many"),
        ({"at_most": 2.5}, "whole number from 1"),
        ({"tolerance": 0.0}, r"outside \(0, 1\)"),
        ({"tolerance": "5 %"}, r"outside \(0, 1\)"),
        ({"tolerance": 1e-8}, "below 1e-05, too little for the conic solver: .* design.direct"),
        ({"impulses": (0.0, 0.5)}, "need a servo grid: give its dt"),
        ({"partial_sums": (0.0, 1.0)}, "need a servo grid: give its dt"),
        ({"impulses": (0.1, 0.5), "dt": 0.02}, "impulses of at least 0.1 are not convex"),
        ({"impulses": 1.0, "dt": 0.02}, "impulses is 1.0: give two numbers, the lower one first"),
        ({"impulses": (0.0,), "dt": 0.02}, r"impulses is \(0.0,\): give two numbers"),
        ({"partial_sums": ("a", 1.0), "dt": 0.02}, "partial_sums is .*: give two numbers"),
        ({"partial_sums": (0.0, 0.9), "dt": 0.02}, "cannot end at 1"),
    ],
)
def test_one_sentence_and_soon(wishes: dict[str, object], message: str) -> None:
    start = time.perf_counter()
    with pytest.raises(InputError, match=message) as raised:
        design.specified_insensitivity(**{"bands": TWO, **wishes})  # type: ignore[arg-type]
    assert time.perf_counter() - start < SOON and str(raised.value).endswith(".")


def changed(shaper: Shaper, *, settings: dict[str, object] | None = None, **changes: object) -> Shaper:
    """The same impulses with other settings or another certificate."""
    proof = replace(shaper.design.certificate, **changes)  # type: ignore[type-var]
    record = replace(shaper.design, certificate=proof, settings={**shaper.design.settings, **(settings or {})})
    return Shaper(shaper.times, shaper.amplitudes, record)


def test_a_proof_for_other_bands_or_another_tolerance_is_none() -> None:
    shaper = design.specified_insensitivity(TWO)
    proof = shaper.design.certificate
    assert proof is not None and is_proved_shortest(changed(shaper))
    wider = [[0.8, 1.2, 0.0, 0.0], [2.7, 3.3, 0.0, 0.0]]
    assert not is_proved_shortest(changed(shaper, settings={"bands": wider}))
    assert not is_proved_shortest(changed(shaper, settings={"bands": None}))
    assert not is_proved_shortest(changed(shaper, settings={"tolerance": 0.04}))
    assert not is_proved_shortest(changed(shaper, settings={"tolerance": 0.06}))
    assert not is_proved_shortest(changed(shaper, settings={"tolerance": "0.05"}))
    assert not is_proved_shortest(changed(shaper, bands=proof.bands[:1], settings={"bands": [[0.9, 1.1, 0.0, 0.0]]}))
    assert not is_proved_shortest(changed(shaper, bands=()))
    assert not is_proved_shortest(changed(shaper, duration=1.01 * proof.duration))
    # what it says of itself changes nothing
    assert is_proved_shortest(changed(shaper, minimum=-1.0, exclusion=0.0, contacts=()))


@pytest.mark.parametrize("multiplier", [0j, complex(math.nan, 0.0), complex(math.inf, 0.0), 1e-30 + 0j])
def test_multipliers_that_are_none_prove_nothing(multiplier: complex) -> None:
    shaper = design.specified_insensitivity((0.9, 1.1))
    points = shaper.design.certificate.points  # type: ignore[union-attr]
    assert not is_proved_shortest(changed(shaper, points=(replace(points[0], multiplier=multiplier), *points[1:])))
    assert not is_proved_shortest(changed(shaper, points=tuple(replace(p, multiplier=multiplier) for p in points)))


def test_bent_or_longer_impulses_are_not_covered_by_the_proof() -> None:
    shaper = design.specified_insensitivity(TWO)
    bent = shaper.amplitudes + 1e-5 * np.array([1, -1, 0, 0, 0, 0])
    assert not is_proved_shortest(Shaper(shaper.times, bent, shaper.design))
    moved = shaper.times + 1e-5 * np.array([0, 1, 0, 0, 0, 0])
    assert not is_proved_shortest(Shaper(moved, shaper.amplitudes, shaper.design))
    assert not is_proved_shortest(Shaper(1.001 * shaper.times, shaper.amplitudes, shaper.design))


@pytest.mark.parametrize(
    "wishes",
    [
        {},
        {"at_most": 5},
        {"dt": 0.05},
        {"dt": 0.05, "impulses": (0.0, math.inf)},
        {"dt": 0.05, "impulses": (-0.5, 1.0), "partial_sums": (-math.inf, 1.1)},
    ],
)
def test_whatever_was_asked_survives_a_file(wishes: dict[str, object]) -> None:
    shaper = design.specified_insensitivity(TWO, **wishes)  # type: ignore[arg-type]
    again = Shaper.from_dict(json.loads(json.dumps(shaper.to_dict(), allow_nan=False)))
    assert again == shaper and again.design == shaper.design
    assert is_proved_shortest(again) is (not wishes)
    assert shaper.design.residual is not None and shaper.design.residual <= 0.05 + 1e-8
    if wishes.get("impulses") == (0.0, math.inf):
        assert (shaper.amplitudes > 0.0).all()
