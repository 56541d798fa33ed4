"""A workbench in a link: what goes in comes out, and nothing else gets in."""

from __future__ import annotations

import base64
import json
import zlib
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape.band import Band
from preshape.design import ASKED_FAMILIES
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.workflow.workbench import (
    AskedDesign,
    Controller,
    Move,
    Plant,
    Workbench,
    from_plain,
    from_text,
    to_plain,
    to_text,
)

FREQUENCIES = st.floats(0.5, 400.0)
DAMPINGS = st.floats(0.0, 0.9)
MODES = st.lists(
    st.builds(Mode, FREQUENCIES, DAMPINGS), min_size=1, max_size=12, unique_by=lambda mode: round(mode.frequency, 3)
)
OPTIONS = st.dictionaries(
    st.sampled_from(["tolerance", "order", "humps", "base", "fewest", "dt"]), st.just(0), max_size=4
).map(
    lambda chosen: tuple(
        (name, {"base": "zvd", "fewest": True, "order": 2, "humps": 3}.get(name, 0.01)) for name in chosen
    )
)
BANDS = st.lists(st.builds(lambda low, wide, z: Band(low, low * (1.0 + wide), z), FREQUENCIES, DAMPINGS, DAMPINGS))


@st.composite
def workbenches(draw: st.DrawFn) -> Workbench:
    modes = tuple(draw(MODES))
    names = draw(st.lists(st.sampled_from("ABCD"), unique=True))
    designs = tuple(
        AskedDesign(
            name,
            draw(st.sampled_from(ASKED_FAMILIES)),
            draw(OPTIONS),
            tuple(draw(BANDS)[:4]),
            draw(st.floats(0.01, 1.0)),
        )
        for name in names
    )
    gains = draw(st.sampled_from([(), tuple(0.1 * (k + 1) for k in range(len(modes)))]))
    move = Move(draw(st.floats(0.001, 10.0)), draw(st.floats(0.1, 10.0)), draw(st.floats(0.1, 100.0)))
    controller = Controller(
        draw(st.sampled_from([None, 2, 500])), draw(st.sampled_from([None, 0.3])), draw(st.booleans())
    )
    return Workbench(modes, designs, Plant(draw(st.sampled_from(["driven", "carried"])), gains), move, controller)


@given(workbenches())
def test_what_goes_into_a_link_comes_out_to_the_last_bit(workbench: Workbench) -> None:
    text = to_text(workbench)
    assert from_text(text) == workbench
    assert set(text) <= set("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_")
    assert from_plain(json.loads(json.dumps(to_plain(workbench)))) == workbench


@given(
    st.one_of(st.text(max_size=300), st.binary(max_size=300).map(lambda raw: base64.urlsafe_b64encode(raw).decode()))
)
def test_no_text_does_more_than_be_refused_in_a_sentence(text: str) -> None:
    with pytest.raises(InputError, match=r"^.+\.$"):
        from_text(text)


@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(), lambda one: st.lists(one) | st.dictionaries(st.text(), one)
    )
)
def test_no_data_do_more_than_be_refused_in_a_sentence(data: Any) -> None:
    with pytest.raises(InputError):
        from_plain(data)


def packed(data: object) -> str:
    return base64.urlsafe_b64encode(zlib.compress(json.dumps(data).encode(), 9)).rstrip(b"=").decode()


PLAIN = to_plain(Workbench())


@pytest.mark.parametrize(
    "data",
    [
        {**PLAIN, "more": 1},
        {**PLAIN, "schema": "preshape/workbench/2"},
        {**PLAIN, "modes": []},
        {**PLAIN, "modes": [[10.0, 0.0]] * 2},
        {**PLAIN, "modes": [[float(k), 0.0] for k in range(1, 14)]},
        {**PLAIN, "modes": [[-3.0, 0.0]]},
        {**PLAIN, "modes": [[0.01, 0.0], [20.0, 0.0]]},
        {**PLAIN, "modes": [[3.0, 1.0]]},
        {**PLAIN, "plant": {"kind": "rocket", "gains": []}},
        {**PLAIN, "plant": {"kind": "driven", "gains": [1.0, 2.0]}},
        {**PLAIN, "move": {**PLAIN["move"], "distance": 0.0}},
        {**PLAIN, "move": {**PLAIN["move"], "speed": 1e-12}},
        {**PLAIN, "controller": {**PLAIN["controller"], "most_impulses": 1}},
        {**PLAIN, "designs": [{**PLAIN["designs"][0], "family": "magic"}]},
        {**PLAIN, "designs": [{**PLAIN["designs"][0], "name": "E"}]},
        {**PLAIN, "designs": [PLAIN["designs"][0]] * 2},
        {**PLAIN, "designs": [{**PLAIN["designs"][0], "options": {"order": "two"}}]},
        {**PLAIN, "designs": [{**PLAIN["designs"][0], "options": {"wings": 2}}]},
    ],
    ids=str,
)
def test_a_changed_link_is_refused(data: object) -> None:
    with pytest.raises(InputError, match=r"^.+\.$"):
        from_text(packed(data))


def test_a_bomb_is_not_unpacked() -> None:
    bomb = packed({**PLAIN, "schema": "x" * 5_000_000})
    assert len(bomb) < 8_000
    with pytest.raises(InputError, match="does not hold a workbench"):
        from_text(bomb)


def test_a_long_text_is_not_even_looked_at() -> None:
    with pytest.raises(InputError, match="at most 8000"):
        from_text("A" * 100_000)


def test_a_full_workbench_fits_into_a_link() -> None:
    modes = tuple(Mode(10.123456789 * 1.3**k, 0.0123456789 + 0.001 * k) for k in range(12))
    options = (("tolerance", 0.0512345), ("at_most", 20), ("dt", 0.000125))
    bands = tuple(Band(0.9 * mode.frequency, 1.1 * mode.frequency, mode.damping) for mode in modes)
    full = Workbench(modes, tuple(AskedDesign(name, "si", options, bands) for name in "ABCD"))
    assert len(to_text(full)) < 4000
    assert from_text(to_text(full)) == full
