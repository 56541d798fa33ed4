"""Edits of the page: what a field shows can be typed into it, undo goes back, every family has something to show."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape.design import ASKED_FAMILIES, OPTIONS
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.studio.page.edits import (
    edited,
    fields_of,
    with_mode,
    with_more_designs,
    without_design,
    without_mode,
)
from preshape.studio.page.history import History
from preshape.workflow.workbench import MOST_MODES, AskedDesign, Controller, Move, Plant, Workbench, view_of

MODES = (Mode(9.8, 0.02), Mode(17.0, 0.01), Mode(31.7, 0.015))

FULL = Workbench(
    MODES,
    (AskedDesign("A", "si", (("tolerance", 0.04),), band_width=0.3), AskedDesign("B", "convolved", (("base", "ei"),))),
    Plant("carried", (0.5, 0.25, 0.125)),
    Move(0.2, 0.4, 3.0),
    Controller(40, 0.5, False),
)

frequencies = st.floats(1e-3, 1e5).map(lambda value: float(f"{value:.6g}"))


@pytest.mark.parametrize("field", sorted(fields_of(FULL)))
def test_what_a_field_shows_can_be_typed_into_it(field: str) -> None:
    assert edited(FULL, field, fields_of(FULL)[field]) == FULL


@given(frequencies, st.sampled_from(range(3)))
def test_a_typed_frequency_is_that_mode_s_and_nothing_else_s(frequency: float, index: int) -> None:
    try:
        new = edited(FULL, f"mode.{index}.frequency", repr(frequency))
    except InputError:
        return  # two modes that are one, or a move that is too long for it
    assert new.modes[index] == Mode(frequency, MODES[index].damping)
    assert [mode for at, mode in enumerate(new.modes) if at != index] == [
        mode for at, mode in enumerate(MODES) if at != index
    ]
    assert (new.designs, new.plant, new.move, new.controller) == (
        FULL.designs,
        FULL.plant,
        FULL.move,
        FULL.controller,
    )


def test_a_comma_is_a_decimal_sign() -> None:
    assert edited(FULL, "mode.0.frequency", "10,5").modes[0].frequency == 10.5


@pytest.mark.parametrize("family", ASKED_FAMILIES)
@pytest.mark.parametrize("before", ["zv", "sd_zv", "si", "convolved"])
def test_every_family_can_be_chosen_and_shows_a_shaper(family: str, before: str) -> None:
    bench = edited(Workbench((Mode(10.0, 0.02),)), "design.A.family", before)
    design = view_of(edited(bench, "design.A.family", family)).designs[0]
    assert design.drawn is not None, design.trouble


@pytest.mark.parametrize(
    ("field", "text", "said"),
    [
        ("mode.0.frequency", "-1", "-1 Hz"),
        ("mode.0.frequency", "", "is missing"),
        ("mode.0.damping", "much", "'much' is not a number"),
        ("mode.7.frequency", "1", "reload"),
        ("mode.0.colour", "1", "reload"),
        ("design.D.family", "zv", "reload"),
        ("design.A.family", "zzz", "no family 'zzz'"),
        ("design.A.bands", "8-12", "write it as 8:12"),
        ("design.A.option.nothing", "1", "reload"),
        ("plant.kind", "plane", "'plane'"),
        ("move.colour", "red", "reload"),
        ("nothing", "1", "reload"),
        ("move.speed", "9" * 500, "500 characters"),
    ],
)
def test_what_cannot_be_is_a_sentence(field: str, text: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        edited(FULL, field, text)


def test_options_that_a_family_does_not_take_are_left_behind() -> None:
    bench = edited(Workbench(MODES[:1]), "design.A.family", "ei")
    bench = edited(bench, "design.A.option.tolerance", "0.03")
    bench = edited(bench, "design.A.option.dt", "0.002")
    assert dict(edited(bench, "design.A.family", "zvd").designs[0].options) == {"dt": 0.002}
    assert dict(edited(bench, "design.A.family", "two_hump_ei").designs[0].options) == {"dt": 0.002, "tolerance": 0.03}
    emptied = edited(bench, "design.A.option.tolerance", "")
    assert dict(emptied.designs[0].options) == {"dt": 0.002}
    assert set(dict(bench.designs[0].options)) <= set(OPTIONS)


def test_modes_and_designs_come_and_go() -> None:
    assert without_mode(with_mode(FULL), 3) == FULL
    more, name = with_more_designs(FULL, "B")
    assert name == "C"
    assert more.designs[2].family == "convolved"
    assert without_design(more, "C") == FULL
    with pytest.raises(InputError, match="only mode"):
        without_mode(Workbench(), 0)
    with pytest.raises(InputError, match="only design"):
        without_design(Workbench(), "A")
    many = Workbench()
    for _ in range(MOST_MODES - 1):
        many = with_mode(many)
    with pytest.raises(InputError, match="no more"):
        with_mode(many)
    four = more
    four, _ = with_more_designs(four, "A")
    with pytest.raises(InputError, match="no room"):
        with_more_designs(four, "A")


@given(st.lists(st.tuples(st.sampled_from(["a", "b", ""]), st.integers(1, 50)), max_size=20))
def test_undo_goes_back_to_the_first_state_and_redo_to_the_last(changes: list[tuple[str, int]]) -> None:
    first = Workbench()
    history = History(first)
    for label, frequency in changes:
        history.change(Workbench((Mode(float(frequency), 0.02),)), label)
    last = history.present
    steps = 0
    while history.undo():
        steps += 1
    assert history.present == first
    assert not history.can_undo
    assert steps <= len(changes)
    while history.redo():
        steps -= 1
    assert history.present == last
    assert steps == 0


def test_edits_under_one_label_are_one_step() -> None:
    history = History(Workbench())
    for frequency in (11.0, 12.0, 13.0):
        history.change(Workbench((Mode(frequency, 0.02),)), "drag")
    history.seal()
    history.change(Workbench((Mode(14.0, 0.02),)), "drag")
    assert history.undo()
    assert history.present.modes[0].frequency == 13.0
    assert history.undo()
    assert history.present == Workbench()
