"""Band and what counts as one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape import Band, design
from preshape.band import bands_of
from preshape.errors import InputError


def test_the_damping_may_be_left_out_given_once_or_twice() -> None:
    assert Band(8, 12) == Band(8.0, 12.0, 0.0, 0.0)
    assert Band(8.0, 12.0, 0.02) == Band(8.0, 12.0, 0.02, 0.02)
    assert Band(8.0, 12.0, 0.01, 0.03).middle == (10.0, 0.02)
    assert Band(8.0, 12.0).highest_damping == 0.0


@given(st.floats(0.1, 100.0), st.floats(0.0, 100.0), st.floats(0.0, 0.4), st.floats(0.0, 0.5))
def test_the_middle_lies_inside_and_the_corners_are_kept(low: float, width: float, damping: float, more: float) -> None:
    band = Band(low, low + width, damping, damping + more)
    frequency, ratio = band.middle
    assert band.low <= frequency <= band.high and band.least_damping <= ratio <= band.highest_damping
    assert all(isinstance(getattr(band, name), float) for name in ("low", "high", "least_damping", "most_damping"))


def test_numbers_of_numpy_are_numbers() -> None:
    assert Band(np.float32(0.5), np.int64(2)) == Band(0.5, 2.0)
    assert bands_of(np.array([9, 11])) == (Band(9.0, 11.0),)


@pytest.mark.parametrize(
    ("given_bands", "expected"),
    [
        (Band(1.0, 2.0), (Band(1.0, 2.0),)),
        ((1.0, 2.0), (Band(1.0, 2.0),)),
        ([1.0, 2.0, 0.1], (Band(1.0, 2.0, 0.1),)),
        ((1, 2, 0.1, 0.2), (Band(1.0, 2.0, 0.1, 0.2),)),
        ([(1.0, 2.0), [3.0, 4.0, 0.1], Band(5.0, 5.0)], (Band(1.0, 2.0), Band(3.0, 4.0, 0.1), Band(5.0, 5.0))),
        (iter([(1.0, 2.0)]), (Band(1.0, 2.0),)),
    ],
)
def test_what_counts_as_bands(given_bands: object, expected: tuple[Band, ...]) -> None:
    assert bands_of(given_bands) == expected  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("numbers", "sentence"),
    [
        ((0.0, 1.0), "needs no shaper"),
        ((-1.0, 1.0), "above 0 Hz"),
        ((2.0, 1.0), "the lower one first"),
        ((math.nan, 1.0), "low is nan: give a finite number"),
        ((1.0, math.inf), "high is inf"),
        ((True, 2.0), "low is True"),
        (("1", 2.0), "low is '1'"),
        ((1.0, 2.0, -0.1), r"outside \[0, 1\)"),
        ((1.0, 2.0, 0.1, 1.0), r"outside \[0, 1\)"),
        ((1.0, 2.0, 0.2, 0.1), "wrong order"),
    ],
)
def test_what_is_no_band_is_refused(numbers: tuple[float, ...], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        Band(*numbers)


@pytest.mark.parametrize("nothing", [5.0, "8:12", None, [(1.0,)], [(1.0, 2.0, 0.0, 0.0, 0.0)], [["a", "b"]], [None]])
def test_what_is_no_bands_is_refused_in_one_sentence(nothing: object) -> None:
    with pytest.raises(InputError, match="give (a finite number|.*low, high.)"):
        bands_of(nothing)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="no band was given"):
        bands_of([])


def test_it_reads_like_a_sentence() -> None:
    assert str(Band(8.0, 12.0)) == "8 to 12 Hz, damping 0"
    assert str(Band(8.0, 8.0, 0.01, 0.03)) == "8 Hz, damping 0.01 to 0.03"


def test_measured_sets_become_one_band_a_mode() -> None:
    near, far = [(4.0, 0.01), (10.0, 0.02)], [(5.0, 0.01), (10.0, 0.02)]
    assert design.bands_of_sets([near, far], spread=0.1) == (
        Band(4.0 * 0.9, 4.0 * 1.1, 0.01),
        Band(9.0, 11.0, 0.02),
        Band(4.5, 5.5, 0.01),
    )
    assert design.bands_of_sets([near])[0] == Band(4.0, 4.0, 0.01)
    for spread, sentence in ((-0.1, "0 .a fraction. or more"), (1.0, "would reach 0 Hz"), ("x", "must be a number")):
        with pytest.raises(InputError, match=sentence):
            design.bands_of_sets([near], spread=spread)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="no set of modes"):
        design.bands_of_sets([])
