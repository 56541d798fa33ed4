"""What the tests of streams share: shapers of every family, commands, and streams on either kernel."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import strategies as st
from numpy.typing import NDArray
from tests.laws import FAMILIES, Family

from preshape import Modes, Shaper
from preshape.kernel import EngineLike, ReferenceEngine, Taps, compiled

MODES = Modes([(1.0, 0.02), (2.7, 0.05), (4.1, 0.0)])

ENGINES = [
    pytest.param(ReferenceEngine, id="NumPy"),
    pytest.param(
        None if compiled is None else compiled.Engine,
        id="C",
        marks=pytest.mark.skipif(compiled is None, reason="no compiler was there at the installation"),
    ),
]

NAMES = [family.name for family in FAMILIES]


@cache
def shaper_of(name: str) -> Shaper:
    """The family's shaper for three modes, made once."""
    family: Family = next(family for family in FAMILIES if family.name == name)
    return family.build(MODES)


def taps_of(shaper: Shaper, dt: float) -> Taps:
    delays, weights = shaper.taps(dt)
    return delays.astype(np.uint32), weights


def run(engine: EngineLike, command: NDArray[np.float64]) -> NDArray[np.float64]:
    """One block of one axis."""
    shaped = np.empty_like(command)
    engine.block(command, shaped)
    return shaped


def bits(values: object) -> bytes:
    """The values to the last bit."""
    return np.asarray(values, dtype=float).tobytes()


@st.composite
def commands(draw: st.DrawFn, least: int = 1, most: int = 600) -> NDArray[np.float64]:
    """Steps, ramps, holds and noise at scales from micrometres to kilometres, offset or not."""
    size = draw(st.integers(least, most))
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    kind = draw(st.sampled_from(["noise", "walk", "steps", "ramp", "hold"]))
    scale = 10.0 ** draw(st.integers(-9, 6))
    noise = random.normal(size=size)
    values = {
        "noise": noise,
        "walk": np.cumsum(noise),
        "steps": np.cumsum(noise * (random.random(size) < 0.02)),
        "ramp": np.linspace(0.0, 1.0, size),
        "hold": np.full(size, noise[0]),
    }[kind]
    return np.asarray(scale * (values + draw(st.sampled_from([0.0, 1.0, -1e3]))))
