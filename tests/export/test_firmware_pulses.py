"""What each firmware executes, against closed forms and every number that is known of it (ECOSYSTEM 1 and 2)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.export.exports import executed

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.export import klipper
from preshape.export.klipper.versions import VERSIONS
from preshape.export.marlin import FAMILIES as FIXED_TIME
from preshape.export.marlin import classic_zv
from preshape.export.prusa import FAMILIES as PRUSA
from preshape.export.rrf import STEP_CLOCK, named
from preshape.vibration import residual_vibration


def left(shaper: Shaper, frequency: float, damping: float) -> float:
    """Per cent of the vibration, with one digit."""
    return round(100.0 * float(residual_vibration(shaper, frequency, damping)), 1)


# ---- the table "same name, different pulses"


@pytest.mark.parametrize("version", ["3.5", "3.6"])
@pytest.mark.parametrize(("damping", "percent"), [(0.0, 0.0), (0.05, 8.8), (0.1, 16.2), (0.15, 22.9)])
def test_mzv_of_reprapfirmware_is_mirrored(version: str, damping: float, percent: float) -> None:
    shaper = executed("rrf", f'M593 P"mzv" F50 S{damping}', version)
    assert left(shaper, 50.0, damping) == percent
    right = design.mzv((50.0, damping))
    np.testing.assert_allclose(shaper.amplitudes, right.amplitudes[::-1], rtol=1e-12)
    np.testing.assert_allclose(shaper.times, right.times, atol=2.0 / STEP_CLOCK)


def test_a_later_reprapfirmware_has_mended_it() -> None:
    assert left(named("mzv", 50.0, 0.1, "later"), 50.0, 0.1) == 0.0


@pytest.mark.parametrize(("damping", "percent"), [(0.05, 1.4), (0.1, 2.5), (0.15, 3.2)])
def test_mzv_of_marlins_fixed_time_motion(damping: float, percent: float) -> None:
    """Where taps fall on samples, so that the family is seen without rounding; ECOSYSTEM prints 3.3 for 3.246."""
    frequency = 375.0 / 20.0 / math.sqrt(1.0 - damping**2)
    shaper = FIXED_TIME["mzv"].pulses(frequency, damping)
    assert shaper.times.tolist() == [0.0, 0.02, 0.04]
    assert left(shaper, frequency, damping) == percent


@pytest.mark.parametrize("family", [PRUSA["mzv"], VERSIONS["old"]["mzv"], VERSIONS["2026-03"]["mzv"]])
def test_mzv_of_klipper_and_prusa_leaves_nothing(family: object) -> None:
    assert left(family.pulses(50.0, 0.1), 50.0, 0.1) == 0.0  # type: ignore[attr-defined]


def test_ei_of_kalico_prusa_and_marlin_is_the_scaled_one() -> None:
    """3.6 % are left at a damping of 0.1, where the design says 5; with no damping they are one."""
    df = math.sqrt(0.99)
    for shaper, frequency in (
        (executed("kalico", "shaper_type_x: ei\nshaper_freq_x: 50", "main"), 50.0),
        (executed("klipper", "shaper_type_x: ei\nshaper_freq_x: 50", "old"), 50.0),
        (executed("prusa", "M593 X T3 F50"), 50.0),
        (executed("marlin-ft", f"M493 X C5 A{500 / 10 / df:.9f} I0.1"), 50.0 / df),
    ):
        assert 100.0 * residual_vibration(shaper, frequency, 0.1) == pytest.approx(3.55, abs=0.05)
    assert 4.88 <= 100.0 * residual_vibration(klipper.ei(50.0, 0.1), 50.0, 0.1) <= 5.065, "ECOSYSTEM: .0488 to .0506"
    for name, humps in (("ei", 1), ("2hump_ei", 2), ("3hump_ei", 3)):
        exact = design.k_hump_ei((50.0, 0.0), humps)
        for families in (VERSIONS["old"], PRUSA):
            scaled = families[name].pulses(50.0, 0.0)
            np.testing.assert_allclose(scaled.amplitudes, exact.amplitudes, atol=1e-9)
            np.testing.assert_allclose(scaled.times, exact.times, atol=1e-9)


@pytest.mark.parametrize(("damping", "slipped", "mended"), [(0.1, 0.057, 0.055), (0.15, 0.067, 0.056)])
def test_the_comma_that_was_missing(damping: float, slipped: float, mended: float) -> None:
    """ECOSYSTEM 1.1: largest residual in 0.6 to 1.5 f; timing up to 0.5 ms off at 50 Hz and a damping of 0.1."""
    ratio = np.linspace(0.6, 1.5, 3601)
    wrong, right = (VERSIONS[version]["3hump_ei"].pulses(1.0, damping) for version in ("2025-09", "2026-03"))
    assert round(float(residual_vibration(wrong, ratio, damping).max()), 3) == slipped
    assert round(float(residual_vibration(right, ratio, damping).max()), 3) == mended
    if damping == 0.1:
        assert round(1e3 * float(abs(wrong.times - right.times).max()) / 50.0, 1) == 0.5
    assert executed("kalico", "shaper_type: 3hump_ei\nshaper_freq_x: 1\ndamping_ratio_x: " + str(damping)) == wrong


# ---- RepRapFirmware


def test_the_two_syntaxes_of_custom_are_one_shaper() -> None:
    """ECOSYSTEM 2.1."""
    old = executed("rrf", 'M593 P"custom" H0.300:0.700 T0.0120:0.0120', "3.5")
    new = executed("rrf", 'M593 P"custom" H0.300:0.400 T0.0120:0.0240', "3.6")
    for shaper in (old, new):
        np.testing.assert_allclose(shaper.amplitudes, [0.3, 0.4, 0.3], atol=1e-12)
        np.testing.assert_allclose(shaper.times, [0.0, 0.012, 0.024], atol=1e-12)


def test_the_example_of_its_manual_means_something_else_in_3_6() -> None:
    example = 'M593 P"custom" H0.4:0.7 T0.0135:0.0135'
    np.testing.assert_allclose(executed("rrf", example, "3.5").amplitudes, [0.4, 0.3, 0.3], atol=1e-12)
    wrong = executed("rrf", example, "3.6")
    np.testing.assert_allclose(wrong.times, [0.0, 0.0135], atol=1 / STEP_CLOCK)
    np.testing.assert_allclose(wrong.amplitudes, [0.4, 0.6], atol=1e-12)


def test_defaults_of_reprapfirmware() -> None:
    assert executed("rrf", "M593 F40", "3.6") == named("zvd", 40.0, 0.05, "3.6")
    assert executed("rrf", "m593 s0.1", "3.5") == named("zvd", 40.0, 0.1, "3.5")
    assert executed("rrf", 'M593 P"ZVDDD" F50\nM593 S0.2 ; later', "3.5") == named("zvddd", 50.0, 0.2, "3.5")
    half = executed("rrf", 'M593 P"custom" F25 S0 H0.5', "3.6")
    assert half.times.tolist() == [0.0, 0.02]
    assert executed("rrf", 'M593 P"custom" F25 S0 H0.25:0.75 T0.01', "3.5").times.tolist() == [0.0, 0.01, 0.02]


@given(
    frequency=st.floats(6.0, 200.0),
    damping=st.floats(0.0, 0.2),
    name=st.sampled_from(["zvd", "zvdd", "zvddd", "ei2", "ei3"]),
)
def test_named_shapers_of_reprapfirmware(frequency: float, damping: float, name: str) -> None:
    """Binomials exactly; ei2 and ei3 are Klipper's tables, counted in damped periods; 3.6 has whole step clocks."""
    continuous, clocked = (named(name, frequency, damping, version) for version in ("3.5", "3.6"))
    clocks = clocked.times * STEP_CLOCK
    np.testing.assert_allclose(clocks, np.rint(clocks), atol=1e-6)
    np.testing.assert_allclose(clocked.times, continuous.times, atol=2.6 / STEP_CLOCK)
    np.testing.assert_allclose(clocked.amplitudes, continuous.amplitudes, rtol=1e-12)
    if name.startswith("zv"):
        exact = design.zvdk((frequency, damping), len(name) - 2)
        np.testing.assert_allclose(continuous.times, exact.times, rtol=1e-12)
        np.testing.assert_allclose(continuous.amplitudes, exact.amplitudes, rtol=1e-12)
    else:
        same = klipper.FAMILIES[f"{name[-1]}hump_ei"].pulses(frequency * math.sqrt(1.0 - damping**2), damping)
        np.testing.assert_allclose(continuous.times, same.times, rtol=1e-9)
        np.testing.assert_allclose(continuous.amplitudes, same.amplitudes, atol=1e-3)


# ---- Marlin


@given(damping=st.floats(0.0, 0.7), frequency=st.floats(10.0, 200.0))
def test_marlins_classic_zv(damping: float, frequency: float) -> None:
    """Half of the undamped period; amplitudes in 1/128 near K / (1 + K), rounded down from a fit."""
    shaper = classic_zv(frequency, damping)
    assert shaper.duration == pytest.approx(0.5 / frequency, rel=1e-14)
    counted = shaper.amplitudes * 128
    np.testing.assert_allclose(counted, np.rint(counted), atol=1e-9)
    decay = math.exp(-math.pi * damping / math.sqrt(1.0 - damping**2))
    assert -1.7 <= counted[1] - 128.0 * decay / (1.0 + decay) <= 0.7


@given(
    frequency=st.floats(15.0, 120.0),
    damping=st.floats(0.01, 0.25),
    name=st.sampled_from(["zv", "zvd", "zvdd", "zvddd"]),
)
def test_taps_of_fixed_time_motion_lie_on_milliseconds(frequency: float, damping: float, name: str) -> None:
    shaper = FIXED_TIME[name].pulses(frequency, damping)
    milliseconds = 1e3 * shaper.times
    np.testing.assert_allclose(milliseconds, np.rint(milliseconds), atol=1e-9)
    np.testing.assert_allclose(np.diff(milliseconds), milliseconds[1])
    exact = design.zvdk((frequency, damping), len(shaper) - 2)
    assert abs(milliseconds[1] - 1e3 * exact.times[1]) <= 0.5001
    np.testing.assert_allclose(shaper.amplitudes, exact.amplitudes, rtol=1e-12)


def test_rounding_of_fixed_time_motion() -> None:
    """ECOSYSTEM 2.2: at 120 Hz the tap of mzv at 3.14 ms becomes 3 ms; half a sample is rounded up (40 Hz: 12.5)."""
    assert FIXED_TIME["mzv"].pulses(120.0, 0.1).times[1] == 0.003
    assert 1e3 * design.mzv((120.0, 0.1)).times[1] == pytest.approx(3.14, abs=0.005)
    assert FIXED_TIME["zv"].pulses(39.998, 0.01).times[1] == 0.013


def test_lines_of_marlin() -> None:
    text = "M493 S1 D0\nM493 X C8 A37.5 I0.15\nM493 Y C5 A28 Q0.1 ; belt"
    assert executed("marlin-ft", text, axis="x") == FIXED_TIME["mzv"].pulses(37.5, 0.15)
    assert executed("marlin-ft", text, axis="y") == FIXED_TIME["ei"].pulses(28.0, 0.1, Q=0.1)
    assert executed("marlin-ft", "M493 C1 A30") == FIXED_TIME["zv"].pulses(30.0, 0.1)
    assert executed("marlin", "M593 F31.25 D0.2") == classic_zv(31.25, 0.2)
    assert executed("marlin", "M593 X F31\nM593 Y F0") == classic_zv(31.0)


# ---- Prusa, Klipper


def test_lines_of_prusa() -> None:
    assert executed("prusa", "M593 T2 F35.8", axis="y") == PRUSA["mzv"].pulses(35.8, 0.1)
    text = "M593 X T1 F50.7 D0.05\nM593 Y T3 F40.6 R10\nM593 Z F0 W"
    assert executed("prusa", text, axis="x") == PRUSA["zvd"].pulses(50.7, 0.05)
    assert executed("prusa", text, axis="y") == PRUSA["ei"].pulses(40.6, 0.1, R=10.0)
    assert executed("prusa", "M593 T0 F118") == PRUSA["zv"].pulses(100.0, 0.1), "moved into 10 to 100 Hz"
    assert executed("prusa", "M593 T0 F118", "mini") == PRUSA["zv"].pulses(118.0, 0.1)


def test_a_whole_configuration_of_klipper() -> None:
    text = """
[stepper_x]
rotation_distance: 40
[gcode_macro TEST]
gcode:
  {% set x = params.X|default(1) %}
  G1 X{x} ; move
[input_shaper]
shaper_type: zv   # for all
shaper_freq_x: 41.0
shaper_type_y: mzv(n=5, t=1.1)
shaper_freq_y = 56.2
damping_ratio_y: 0.083
#*# <---------------------- SAVE_CONFIG ---------------------->
#*# DO NOT EDIT THIS BLOCK OR BELOW. The contents are auto-generated.
#*#
#*# [bed_mesh default]
#*# version = 1
#*# points =
#*#   0.005, 0.010
#*# [input_shaper]
#*# shaper_type_x = 2hump_ei
#*# shaper_freq_x = 61.4
"""
    assert executed("klipper", text, axis="x") == klipper.two_hump_ei(61.4, 0.1)
    assert executed("klipper", text, axis="y") == klipper.mzv(56.2, 0.083, impulses=5, periods=1.1)
    with pytest.raises(InputError, match="the shapers of x and y differ: say which axis"):
        executed("klipper", text)
    with pytest.raises(InputError, match="axis z: no shaper is set"):
        executed("klipper", text, axis="z")


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        ("mzv", klipper.mzv(50.0, 0.1)),
        ("MZV(4,0.9)", klipper.mzv(50.0, 0.1, impulses=4, periods=0.9)),
        ("mzv(t=0.9,n=4)", klipper.mzv(50.0, 0.1, impulses=4, periods=0.9)),
        ("mzv(n=4,tau=1.5)", klipper.mzv(50.0, 0.1, impulses=4, periods=0.9)),
        ("ei(v_tol=0.02)", klipper.ei(50.0, 0.1, tolerance=0.02)),
        ("ei(.02)", klipper.ei(50.0, 0.1, tolerance=0.02)),
    ],
)
def test_parameters_of_klippers_families(kind: str, expected: Shaper) -> None:
    found = executed("klipper", f"shaper_type_x: {kind}\nshaper_freq_x: 50")
    np.testing.assert_allclose(found.times, expected.times, rtol=1e-12)
    np.testing.assert_allclose(found.amplitudes, expected.amplitudes, rtol=1e-12)
