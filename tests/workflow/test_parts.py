"""The parts of the calibration, each by itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from preshape import Mode, Modes, Shaper, design, identify
from preshape.export import klipper
from preshape.identify import Identification, IdentifiedMode, Spectrum, merged_modes
from preshape.workflow import calibrate
from preshape.workflow.remaining import lines_of_modes, lines_of_spectra, remaining_amplitude
from preshape.workflow.simulate import simulate_move
from preshape.workflow.spectra import scored_spectrum

GANTRY = Path(__file__).resolve().parents[2] / "examples" / "data" / "gantry_x.csv"
HEADER = "freq,psd_x,psd_y,psd_z,psd_xyz"


def found(frequency: float, damping: float = 0.05, share: float = 1.0) -> IdentifiedMode:
    mode = Mode(frequency, damping)
    return IdentifiedMode(mode, (0.99 * frequency, 1.01 * frequency), (0.9 * damping, 1.1 * damping), share)


def identification(*modes: IdentifiedMode) -> Identification:
    empty = Spectrum(np.array([0.0, 1.0]), np.ones((1, 2)), ("sum",))
    return Identification(modes, empty, np.ones(2), "ring-down", (), True)


def test_near_modes_of_two_files_are_one_with_joined_intervals() -> None:
    merged = merged_modes([identification(found(50.0, 0.04)), identification(found(51.0, 0.06))])
    assert len(merged) == 1
    assert merged[0].mode.frequency == pytest.approx(50.5)
    assert merged[0].mode.damping == pytest.approx(0.05)
    assert merged[0].frequency_interval == (pytest.approx(49.5), pytest.approx(51.51))
    assert merged[0].share == pytest.approx(1.0)


def test_shares_are_averages_over_all_files() -> None:
    files = [identification(found(50.0)), identification(found(50.5)), identification()]
    assert merged_modes(files)[0].share == pytest.approx(2.0 / 3.0)


def test_near_modes_of_one_file_stay_two_and_far_ones_of_two_files_too() -> None:
    assert len(merged_modes([identification(found(50.0, share=0.6), found(51.0, share=0.4))])) == 2
    two = merged_modes([identification(found(50.0)), identification(found(80.0, share=0.3))])
    assert [round(mode.mode.frequency) for mode in two] == [50, 80]


def test_modes_without_weight_are_left_out() -> None:
    assert len(merged_modes([identification(found(50.0, share=0.995), found(90.0, share=0.005))])) == 1


def test_what_remains_of_one_mode_is_v_in_the_worst_case() -> None:
    shaper, mode = design.zv((50.0, 0.05)), found(50.0, 0.05)
    left = remaining_amplitude(shaper, lines_of_modes([mode]))
    shifts = 50.0 * (1.0 + 0.05 * np.array([-1.0, -0.5, 0.0, 0.5, 1.0]))
    from preshape.vibration import residual_vibration

    worst = max(float(residual_vibration(shaper, shifts, damping).max()) for damping in (0.045, 0.05, 0.055))
    assert left == pytest.approx(worst, rel=1e-12)


def test_what_remains_of_a_spectrum_ignores_its_floor() -> None:
    frequencies = np.arange(1.0, 100.0)
    quiet = np.where(frequencies == 50.0, 1.0, 0.04)
    lines = lines_of_spectra([klipper.Spectrum(frequencies, quiet)], 0.05)
    assert len(lines) == 1 and lines[0].frequencies.tolist() == [50.0]


def test_a_tuned_candidate_is_as_fast_as_the_tolerance_allows() -> None:
    calibration = calibrate(GANTRY)
    lines = lines_of_modes(calibration.modes)
    tuned = [one for one in calibration.candidates if one.name.split()[0] in ("two_hump_ei", "three_hump_ei")]
    assert len(tuned) == 2
    for candidate in tuned:
        assert candidate.left <= calibration.tolerance
        faster = Shaper(candidate.shaper.times / 1.01, candidate.shaper.amplitudes)
        assert remaining_amplitude(faster, lines) > calibration.tolerance


def test_the_simulated_move_agrees_with_a_stepwise_integration() -> None:
    """Deflection of each mode under the base's acceleration, by scipy.signal.lsim on a fine grid."""
    from scipy.signal import lsim

    modes, shaper = [found(40.0, 0.03, 0.8), found(70.0, 0.06, 0.2)], design.mzv((40.0, 0.03))
    move = simulate_move(shaper, Modes([one.mode for one in modes]), [one.share for one in modes])
    times = np.linspace(0.0, float(move.times[-1]), 60_001)
    period = 1.0 / 40.0
    switches = np.cumsum([0.0, 0.3, 1.15, 0.3]) * period
    heights = np.array([1.0, -1.0, -1.0, 1.0])

    def vibration(step_times: np.ndarray, steps: np.ndarray) -> tuple[np.ndarray, float]:
        acceleration = sum(h * (times >= t) for t, h in zip(step_times, steps, strict=True))
        total, left = np.zeros(times.size), 0.0
        for mode in modes:
            w, z = mode.mode.omega, mode.mode.damping
            system = ([[0.0, 1.0], [-(w**2), -2.0 * z * w]], [[0.0], [-1.0]], np.eye(2), np.zeros((2, 1)))
            _, state, _ = lsim(system, acceleration, times, interp=False)
            weight = np.sqrt(mode.share) * w**2
            total += weight * state[:, 0]
            d, v = state[np.searchsorted(times, step_times.max()) + 1]
            left += weight * np.hypot(d, (v + z * w * d) / mode.mode.omega_d)
        return total, float(left)

    plain, left_plain = vibration(switches, heights)
    shaped, left_shaped = vibration(
        np.add.outer(switches, shaper.times).ravel(), np.multiply.outer(heights, shaper.amplitudes).ravel()
    )
    assert np.abs(np.interp(move.times, times, plain / left_plain) - move.unshaped).max() < 5e-3
    assert np.abs(np.interp(move.times, times, shaped / left_plain) - move.shaped).max() < 5e-3
    assert left_shaped / left_plain == pytest.approx(move.left, abs=5e-3)
    assert move.left > 0.01  # MZV for one mode leaves something of the other


def spectrum_file(path: Path, *, shapers: bool, level: float = 1e4) -> Path:
    """A Klipper spectrum with one peak at 50 Hz; psd_xyz is deliberately not quite the sum of the axes."""
    frequencies = np.arange(0.0, 201.0, 1.6)
    ratio = frequencies / 50.0
    power = level * ratio**2 * (1 + (0.1 * ratio) ** 2) / ((1 - ratio**2) ** 2 + (0.1 * ratio) ** 2) + 1.0
    lines = [HEADER + (",shapers:,mzv(50.0)" if shapers else "")]
    for f, p in zip(frequencies, power, strict=True):
        lines.append(f"{f:.1f},{p:.3e},1.000e+00,1.000e+00,{1.01 * p:.3e}" + (",,0.5" if shapers else ""))
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("shapers", [False, True])
def test_a_spectrum_file_is_scored_as_it_is_printed_and_normalised_once(tmp_path: Path, shapers: bool) -> None:
    path = spectrum_file(tmp_path / "resonances_x.csv", shapers=shapers)
    table = np.array([line.split(",")[:5] for line in path.read_text().splitlines()[1:]], dtype=float)
    measurement = identify.read(path)
    scored = scored_spectrum(measurement, identify.find_modes(measurement))
    printed = table[:, 4]
    expected = printed if shapers else klipper.normalise_to_frequencies(table[:, 0], printed)
    np.testing.assert_array_equal(scored.frequencies, table[:, 0])
    np.testing.assert_allclose(scored.power, expected[None, :], rtol=1e-12)


def test_trouble_is_said_with_the_file_it_comes_from(tmp_path: Path) -> None:
    good = spectrum_file(tmp_path / "good.csv", shapers=False)
    rng = np.random.default_rng(0)
    rows = [f"{1.6 * k:.1f},{x:.3e},{x:.3e},{x:.3e},{3 * x:.3e}" for k, x in enumerate(10.0 + 9.0 * rng.random(120))]
    bad = tmp_path / "bad.csv"
    bad.write_text("\n".join([HEADER, *rows]) + "\n")
    alone, both = calibrate(bad), calibrate([good, bad])
    assert not alone.clear and alone.trouble and "see to the machine" in alone.reason
    assert not both.clear and all(sentence.startswith("bad.csv: ") for sentence in both.trouble)
    assert calibrate(good).clear and calibrate(good).trouble == ()
