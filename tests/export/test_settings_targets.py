"""The laws of every target that takes settings: what is written is executed to the same impulses, limits hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.export.exports import assert_executed_as_asked, damaged
from tests.laws import FAMILIES

from preshape import Modes, Shaper, design
from preshape.errors import InputError
from preshape.export import TARGETS, ExportedSettings, SettingsTarget, render
from preshape.export.klipper.versions import VERSIONS
from preshape.export.marlin import FAMILIES as FIXED_TIME
from preshape.export.marlin import OLD as CLASSIC
from preshape.export.nearest import EQUAL
from preshape.export.prusa import FAMILIES as PRUSA
from preshape.provenance import Design
from preshape.vibration import residual_vibration

WORDED = {name: target for name, target in TARGETS.items() if isinstance(target, SettingsTarget)}
EVERY = [(target.name, version) for target in WORDED.values() for version in target.versions]

IMPULSES = [(name, version) for name, version in EVERY if WORDED[name].limits_of(version).taps is not None]
"""Those that hold impulses."""

FIRMWARE = {
    ("klipper", "2026-03"): VERSIONS["2026-03"],
    ("klipper", "2025-09"): VERSIONS["2025-09"],
    ("klipper", "old"): VERSIONS["old"],
    ("kalico", "main"): VERSIONS["old"],
    ("prusa", "buddy"): PRUSA,
    ("prusa", "mini"): PRUSA,
    ("marlin", "2.1"): CLASSIC,
    ("marlin-ft", "2.1"): FIXED_TIME,
}
"""What the others can do."""


def test_every_target_is_one_or_the_other() -> None:
    assert sorted([*IMPULSES, *FIRMWARE]) == sorted(EVERY)


@pytest.mark.parametrize(("target", "version"), IMPULSES)
@given(
    family=st.sampled_from(FAMILIES),
    modes=st.lists(st.tuples(st.floats(12.0, 150.0), st.floats(0.0, 0.2)), min_size=1, max_size=2),
)
@settings(max_examples=30)
def test_impulses_are_executed_within_the_targets_resolution(
    target: str, version: str, family: object, modes: list[tuple[float, float]]
) -> None:
    assume(len(modes) == 1 or 1.2 < max(modes)[0] / min(modes)[0] < 5.0)
    try:
        shaper = family.build(Modes(modes))  # type: ignore[attr-defined]
    except InputError:
        assume(False)
    limits = WORDED[target].limits_of(version)
    if (limits.taps or 0) < len(shaper):
        with pytest.raises(InputError, match=f"holds {limits.taps}: design one with at most so many"):
            render(shaper, target, version=version)
        return
    if (shaper.amplitudes < 0.0).any() and not limits.negative:
        with pytest.raises(InputError, match="design a positive one"):
            render(shaper, target, version=version)
        return
    if abs(shaper.amplitudes).min() < limits.smallest:
        with pytest.raises(InputError, match="fewer impulses"):
            render(shaper, target, version=version)
        return
    exported = render(shaper, target, version=version)
    assert WORDED[target].execute(exported.files) == exported.placed.shaper
    assert_executed_as_asked(exported.placed.shaper, shaper, limits)
    for mode, (left, _) in zip(shaper.design.modes or (), exported.placed.residuals, strict=True):
        again = float(residual_vibration(exported.placed.shaper, mode.frequency, mode.damping))
        assert left == pytest.approx(again, abs=1e-14)


@pytest.mark.parametrize(("target", "version"), FIRMWARE)
@given(data=st.data())
@settings(max_examples=12)
def test_a_firmwares_own_pulses_are_found_and_executed_again(target: str, version: str, data: st.DataObject) -> None:
    """Whatever the firmware can execute is written as that, or as a shorter setting that leaves at most 1 % more."""
    families = FIRMWARE[target, version]
    family = data.draw(st.sampled_from(sorted(families)))
    frequency = data.draw(st.integers(2000, 9000)) / 100.0
    damping = data.draw(st.integers(100, 1900)) / 1e4
    asked = families[family].pulses(frequency, damping)
    placed = render(asked, target, version=version, axis="x").placed
    if placed.shaper.design.family == family:
        np.testing.assert_allclose(placed.shaper.times, asked.times, atol=1e-15)
        np.testing.assert_allclose(placed.shaper.amplitudes, asked.amplitudes, atol=1e-12)
    else:
        assert placed.shaper.duration <= asked.duration
    around = np.linspace(0.9, 1.1, 5) * frequency
    more = residual_vibration(placed.shaper, around, damping) - residual_vibration(asked, around, damping)
    assert more.max() <= EQUAL


@pytest.mark.parametrize(("target", "version"), EVERY)
def test_what_is_written_is_what_is_executed(target: str, version: str) -> None:
    """The shaper of the export, the files read back, and each axis of them, are one."""
    exported = render(design.zvd((41.3, 0.06)), target, version=version, name="gantry_x")
    chosen, does = WORDED[target], exported.placed.shaper
    assert f"gantry_x{chosen.ending}" in exported.files
    assert chosen.execute(exported.files) == does
    assert does.design.modes == Modes((41.3, 0.06)) and does.design.residual == exported.placed.residuals[0][0]
    for axis in exported.placed.axes:
        assert chosen.execute(exported.files, axis=axis) == does
        assert render(design.zvd((41.3, 0.06)), target, version=version, axis=axis).placed.shaper == does
    assert exported.placed.axes == (chosen.axes[:2] if chosen.axes else ())


@pytest.mark.parametrize(("target", "version"), list(FIRMWARE))
def test_the_gap_of_the_nearest_setting_is_stated(target: str, version: str) -> None:
    shaper = design.direct([(40.0, 0.05), (63.0, 0.04)], order=0)
    exported = render(shaper, target, version=version)
    text = str(next(iter(exported.files.values())))
    for mode, (left, asked) in zip(shaper.design.modes or (), exported.placed.residuals, strict=True):
        line = f"{mode}: {100.0 * left:.2g} % of the vibration is left"
        assert line in text and asked < 1e-9
        assert left == pytest.approx(float(residual_vibration(exported.placed.shaper, mode.frequency, mode.damping)))
    assert any("nearest setting" in note and note in text for note in exported.placed.notes)


def test_a_search_over_everything_finds_nothing_better() -> None:
    """Independent: Klipper's fixed families at every tenth of a hertz, on the criterion that the module states."""
    shaper = design.direct([(44.0, 0.05), (61.0, 0.05)], order=0)
    around = np.array([0.9, 0.95, 1.0, 1.05, 1.1])
    allowed = [residual_vibration(shaper, f * around, 0.05) for f in (44.0, 61.0)]

    def excess(one: Shaper) -> float:
        left = [residual_vibration(one, f * around, 0.05) for f in (44.0, 61.0)]
        return max(float((more - most).max()) for more, most in zip(left, allowed, strict=True))

    does = render(shaper, "klipper", version="old").placed.shaper
    found = excess(does)
    tried = [
        (excess(one), one.duration)
        for family in VERSIONS["old"].values()
        for one in (family.pulses(f, 0.05) for f in np.arange(39.0, 68.0, 0.1))
    ]
    if found <= EQUAL:
        assert does.duration <= 1.002 * min(duration for more, duration in tried if more <= EQUAL)
    else:
        assert found <= min(more for more, _ in tried) + 1e-4


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"target": "rrf", "dt": 0.001}, "target rrf has no sample grid: leave the sample rate"),
        ({"target": "rrf", "grid": "exact"}, "has no sample grid"),
        ({"target": "rrf", "precision": "single"}, "has no sample grid"),
        ({"target": "rrf", "axis": "x"}, "one shaper for everything: leave the axis out"),
        ({"target": "klipper", "axis": "e"}, "axis 'e' is not known for target klipper: it is x, y, z"),
        ({"target": "klipper", "version": "2020"}, "version '2020' is not known for target klipper"),
        ({"target": "klipper", "name": "../x"}, "cannot be used"),
    ],
)
def test_what_does_not_go_together_is_refused(options: dict[str, str], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        render(design.zvd((40.0, 0.1)), **options)  # type: ignore[call-overload]


def test_what_a_target_cannot_hold_is_refused_with_a_remedy() -> None:
    many = design.zvd([(20.0, 0.05), (52.0, 0.05)])
    with pytest.raises(
        InputError, match="9 impulses and target rrf \\(3.6\\) holds 5: .* preshape calibrate --max-imp"
    ):
        render(many, "rrf")
    assert len(render(many, "klipper-plugin").placed.shaper) == 9
    with pytest.raises(InputError, match="9 impulses and target klipper-plugin \\(old\\) holds 5"):
        render(many, "klipper-plugin", version="old")
    with pytest.raises(
        InputError, match="takes 0.0005 s, and target kalico \\(bleeding-edge-v2\\) takes 0.001 to 0.2 s"
    ):
        render(Shaper([0.0, 0.0005], [0.5, 0.5]), "kalico")
    with pytest.raises(InputError, match="an impulse of 0.0005, and target kalico"):
        render(Shaper([0.0, 0.01, 0.02], [0.0005, 0.5, 0.4995]), "kalico")
    with pytest.raises(InputError, match="negative impulses, which target rrf \\(3.5\\)"):
        render(design.um_zv((40.0, 0.1)), "rrf", version="3.5")
    with pytest.raises(InputError, match="does not say its modes, and Prusa's firmware takes families"):
        render(Shaper([0.0, 0.01], [0.5, 0.5]), "prusa")
    with pytest.raises(InputError, match="takes frequencies from 10 to 100 Hz, and none of its settings there fits"):
        render(design.zv((3.0, 0.1)), "prusa")
    with pytest.raises(InputError, match="takes impulses only"):
        render(design.sd_zv((40.0, 0.01), 0.3, form="box"), "rrf")


def test_a_shaper_without_modes_goes_where_impulses_go() -> None:
    given = Shaper([0.0, 0.0101], [0.5, 0.5])
    for target, version in IMPULSES:
        exported = render(given, target, version=version)
        assert exported.placed.residuals == () and len(exported.placed.shaper) == 2
    assert "not recorded" in str(render(given, "rrf").files["shaper.g"])


@pytest.mark.parametrize(("target", "version"), EVERY)
def test_a_familys_name_stays_in_its_comment(target: str, version: str) -> None:
    evil = 'x\nM593 P"none"\n[input_shaper]\n"""\nimport os'
    shaper = design.zvd((41.3, 0.06))
    shaper = shaper.with_design(replace(shaper.design, family=evil))
    exported = render(shaper, target, version=version)
    assert WORDED[target].execute(exported.files) == exported.placed.shaper
    comment = WORDED[target].comment
    head = str(next(iter(exported.files.values()))).splitlines()[:3]
    assert not comment or all(line.startswith(comment) for line in head)


def test_files_of_another_target_are_refused() -> None:
    files = render(design.zv((40.0, 0.1)), "kalico").files
    with pytest.raises(InputError, match="the file is for target kalico bleeding-edge-v2: give one for target klipper"):
        WORDED["klipper"].parse(files)


FINISHED = {pair: render(design.zvd((41.3, 0.06)), pair[0], version=pair[1]) for pair in EVERY}


@pytest.mark.parametrize("pair", EVERY)
@settings(max_examples=60)
@given(data=st.data())
def test_damaged_settings_are_a_shaper_or_a_clear_refusal(pair: tuple[str, str], data: st.DataObject) -> None:
    exported: ExportedSettings = FINISHED[pair]
    name = next(iter(exported.files))
    inserts = [b"nan", b"-", b":", b"1e999", b"[", b'"', b"\xff", b"9" * 99, b"\n"]
    raw = damaged(data, exported.files[name], inserts, 60)
    try:
        exported.target.execute({name: raw})
    except InputError as error:
        assert len(str(error)) > 10


@pytest.mark.parametrize("target", WORDED)
@given(text=st.text() | st.binary())
def test_garbage_is_refused(target: str, text: str | bytes) -> None:
    with pytest.raises(InputError):
        WORDED[target].execute({f"x{WORDED[target].ending}": text})


def test_no_record_is_needed_of_how_a_shaper_came_about() -> None:
    shaper = Shaper([0.0, 0.0101], [0.5, 0.5], Design("measured", Modes((49.5, 0.0))))
    assert render(shaper, "klipper").placed.shaper.design.family == "zv"
