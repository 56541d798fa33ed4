"""G-code through shapers, executed again by a machine that knows nothing of them: constant speed from line to line."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from preshape import Profile, Shaper, design
from preshape.cli.main import main
from preshape.command import trapezoid
from preshape.command.path import contour_error
from preshape.errors import InputError
from preshape.plant import ModalPlant
from preshape.workflow import shape_gcode
from preshape.workflow.gcode.planned import planned
from preshape.workflow.gcode.program import Run, read_program

EXAMPLE = Path(__file__).parents[2] / "examples" / "data" / "part.gcode"
X, Y = design.zvd((38.0, 0.02)), design.zvd((61.0, 0.02))
ACCELERATION = 3000.0
SQUARE = "G21\nG90\nG92 X0 Y0\nG1 X30 F6000\nG1 Y30\nG1 X0\nG1 Y0\n"


class Executor:
    """Ten lines of a controller: every line at constant speed, without acceleration; E counts as X, Y and Z do."""

    def __init__(self, text: str) -> None:
        place, relative, relative_e, unit, feed = dict.fromkeys("XYZE", 0.0), False, False, 1.0, np.nan
        time, self.times, self.places, self.comments = 0.0, [0.0], [[0.0] * 4], []
        extruded = 0.0
        for line in text.splitlines():
            self.comments += [(time, line.partition(";")[2].strip())] if ";" in line else []
            words = {w[0]: float(w[1]) for w in re.findall(r"([A-Z])([-.0-9]+)", line.split(";")[0])}
            code, letter = words.pop("G", None), line[:1]
            if letter == "M":
                relative_e = {"M82": False, "M83": True}.get(line.split()[0], relative_e)
            elif code in (90, 91):
                relative = code == 91
            elif code in (20, 21):
                unit = 25.4 if code == 20 else 1.0
            elif code == 4:
                time += words["P"]
            elif code == 92:
                place.update({axis: value * unit for axis, value in words.items()})
                self.times.append(time)
                self.places.append([place["X"], place["Y"], place["Z"], extruded])
            elif code in (0, 1):
                feed = words.get("F", feed / unit) * unit
                before = dict(place)
                for axis in set(words) & set("XYZE"):
                    steps = relative_e if axis == "E" else relative
                    place[axis] = words[axis] * unit + (place[axis] if steps else 0.0)
                moved = np.linalg.norm([place[axis] - before[axis] for axis in "XYZ"])
                time += float(moved or abs(place["E"] - before["E"])) / (feed / 60.0)
                extruded += place["E"] - before["E"]
                self.times.append(time)
                self.places.append([place["X"], place["Y"], place["Z"], extruded])

    def axis(self, k: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return np.array(self.times), np.array(self.places)[:, k]

    def path(self) -> NDArray[np.float64]:
        return np.array(self.places)[:, :3].T

    def residual(self, k: int, mode: tuple[float, float]) -> float:
        """What is left of the vibration of an axis when the last line has ended, exactly [mm]."""
        times, places = self.axis(k)
        keep = np.append(True, np.diff(times) > 0.0)
        speeds = np.append(np.diff(places[keep]) / np.diff(times[keep]), 0.0)
        command = Profile.steps(times[keep], np.diff(speeds, prepend=0.0), order=1)
        return float(ModalPlant(mode).motion(command).residual_amplitudes[0])


def shaped(folder: Path, text: str, **options: Any) -> tuple[Executor, Any]:
    (folder / "in.gcode").write_text(text)
    wanted = {"acceleration": ACCELERATION, "start": {"x": 0.0, "y": 0.0, "z": 0.0}} | options
    done = shape_gcode(folder / "in.gcode", wanted.pop("shapers", {"x": X, "y": Y}), folder / "out.gcode", **wanted)
    return Executor((folder / "out.gcode").read_text()), done


NONE = Shaper([0.0], [1.0])


@pytest.mark.parametrize("tolerance", [0.001, 0.004])
def test_the_written_moves_leave_no_more_vibration_than_the_tolerance(tmp_path: Path, tolerance: float) -> None:
    """On both axes, for long and short moves, whose unshaped program leaves 0.14 and 0.023 mm."""
    unshaped, left = [], []
    for distance in (0.7, 3.1, 20.0, 47.3):
        text = f"G1 X{distance} Y{0.6 * distance:.3f} F4000\n"
        for kept, shapers in ((unshaped, {"x": NONE, "y": NONE}), (left, {"x": X, "y": Y})):
            run, _ = shaped(tmp_path, text, shapers=shapers, tolerance=tolerance, shortest=0.001)
            kept.append([run.residual(0, (38.0, 0.02)), run.residual(1, (61.0, 0.02))])
    before, after = np.max(unshaped, axis=0), np.max(left, axis=0)
    assert before[0] > 0.13 and before[1] > 0.02, before
    assert (after < 1.5 * tolerance).all(), (before, after)


def test_a_machine_beside_its_mode_is_shaken_as_the_shaper_says(tmp_path: Path) -> None:
    # Long enough ramps and a way that is no whole number of periods: nothing cancels by chance.
    run, _ = shaped(tmp_path, "G1 X30.37 F3000\n", tolerance=0.001, shortest=0.001)
    plain, _ = shaped(tmp_path, "G1 X30.37 F3000\n", shapers={"x": NONE}, tolerance=0.001, shortest=0.001)
    # An undamped mode keeps what it is given: the ratio is the shaper's gain there, whatever the move.
    for frequency in (30.0, 34.0, 45.0):
        gain = abs(np.sum(X.amplitudes * np.exp(-2j * np.pi * frequency * X.times)))
        before = plain.residual(0, (frequency, 0.0))
        assert run.residual(0, (frequency, 0.0)) / before == pytest.approx(gain, abs=0.002 / before) and before > 0.04


@pytest.mark.parametrize("tolerance", [0.002, 0.01, 0.1])
def test_the_written_motion_is_the_exact_shaped_one_within_the_tolerance_at_every_time(
    tmp_path: Path, tolerance: float
) -> None:
    run, done = shaped(tmp_path, "G1 X30 F6000\n", shapers={"x": X}, tolerance=tolerance, shortest=0.002)
    exact = trapezoid(30.0, maximum_speed=100.0, maximum_acceleration=ACCELERATION, dt=0.001).profile.shaped(X)
    t = np.linspace(0.0, exact.end_time, 20_001)
    times, places = run.axis(0)
    grid = ACCELERATION * 0.0005**2 / 8.0  # straight between the samples
    assert np.abs(np.interp(t, times, places) - exact(t)).max() < tolerance + 2.0 * grid
    assert done.deviation <= tolerance
    assert times[-1] == pytest.approx(exact.end_time, abs=0.003)
    assert done.duration == pytest.approx(times[-1], rel=1e-5)


def test_a_larger_tolerance_needs_fewer_lines(tmp_path: Path) -> None:
    lines = [shaped(tmp_path, SQUARE, tolerance=t, shortest=0.001)[1].lines_after for t in (0.001, 0.01, 0.1)]
    assert lines[0] > 1.5 * lines[1] > 2.0 * lines[2]


def test_straight_lines_stay_straight_and_corners_are_cut_as_little_as_the_shaper_cuts_them(tmp_path: Path) -> None:
    both = {"x": X, "y": X}
    line, _ = shaped(tmp_path, "G1 X30 Y20 F6000\n", shapers=both)
    assert contour_error(np.array([[0.0, 30.0], [0.0, 20.0], [0.0, 0.0]]), line.path()).bound < 2e-4
    square, _ = shaped(tmp_path, SQUARE, shapers=both)
    corners = np.array([[0.0, 30.0, 30.0, 0.0, 0.0], [0.0, 0.0, 30.0, 30.0, 0.0], [0.0] * 5])
    # Two moves overlap for the shaper's duration: neither is farther from the corner by then than its way from rest.
    assert 0.01 < contour_error(corners, square.path()).largest < 0.5 * ACCELERATION * X.duration**2


def test_extrusion_keeps_its_total_and_follows_the_way(tmp_path: Path) -> None:
    run, _ = shaped(tmp_path, EXAMPLE.read_text())
    plain = Executor(EXAMPLE.read_text())
    assert run.axis(3)[1][-1] == pytest.approx(plain.axis(3)[1][-1], abs=1e-9)
    np.testing.assert_allclose(run.path()[:, -1], plain.path()[:, -1], atol=1e-9)
    # On one slanted line, whatever the two shapers are, extrusion is in proportion to the way along it.
    line, _ = shaped(tmp_path, "M82\nG92 E5\nG1 X30 Y20 E7.5 F6000\nG1 F3000\n")
    along = line.path()[:2].T @ np.array([30.0, 20.0]) / (30.0**2 + 20.0**2)
    np.testing.assert_allclose(line.axis(3)[1], 2.5 * along, atol=2e-5)


def test_a_corner_speed_saves_stops_and_bounds_the_jump(tmp_path: Path) -> None:
    arc = np.linspace(0.0, np.pi, 40)
    text = "".join(f"G1 X{20 - 20 * np.cos(a):.3f} Y{20 * np.sin(a):.3f} F4800\n" for a in arc[1:])
    plain = {"x": NONE, "y": NONE}
    stops, _ = shaped(tmp_path, text, shapers=plain, tolerance=0.05)
    flowing, done = shaped(tmp_path, text, shapers=plain, corner_speed=8.0, tolerance=0.05)
    assert flowing.times[-1] < 0.7 * stops.times[-1]
    # 40 vertices turn by 0.08 rad each, at 80 mm/s by 6.4 mm/s: the whole arc at its feed but for the ends.
    assert flowing.times[-1] == pytest.approx(20.0 * np.pi / 80.0 + 80.0 / ACCELERATION, rel=0.01)
    assert 0.0 < done.speed_step < 2.5 * 8.0 + ACCELERATION * 0.02


def test_nearly_straight_vertices_are_no_corners(tmp_path: Path) -> None:
    one, _ = shaped(tmp_path, "G1 X30 Y10 F6000\n")
    many, _ = shaped(tmp_path, "F6000\n" + "".join(f"G1 X{3 * k} Y{k:.3f}\n" for k in range(1, 11)))
    assert many.times[-1] == pytest.approx(one.times[-1], abs=1e-3)


def test_inches_steps_and_absolute_places_are_the_same_motion(tmp_path: Path) -> None:
    metric, _ = shaped(tmp_path, "G21\nG90\nG1 X25.4 Y12.7 F6096\nG1 X0\n")
    inches, _ = shaped(tmp_path, "G20\nG90 G1 X1 Y.5 F240\nG1 X0\n")
    steps, _ = shaped(tmp_path, "G91\nG1 X25.4 Y12.7 F6096\nG1 X-25.4\n")
    t = np.linspace(0.0, metric.times[-1], 500)
    for other in (inches, steps):
        assert other.times[-1] == pytest.approx(metric.times[-1], abs=1e-4)
        for k in range(2):
            np.testing.assert_allclose(np.interp(t, *other.axis(k)), np.interp(t, *metric.axis(k)), atol=0.021)
            assert other.axis(k)[1][-1] == pytest.approx(metric.axis(k)[1][-1], abs=1e-9)


def test_other_lines_go_on_in_order_at_rest_with_the_feed_and_the_kind_of_motion_brought_back(tmp_path: Path) -> None:
    text = "M3 S1000 ; spindle\nG1 X10 F1200\n; first\nG1 Y20 ; second\nM7 (coolant)\nG0 Y5\nG4 P0.5\nX0\nM30\n"
    run, done = shaped(tmp_path, text, rapid=100.0)
    lines = (tmp_path / "out.gcode").read_text().splitlines()
    kept = [line for line in lines if line[:1] in "MG" and not re.match(r"G1 [XY]|G4 P0.00", line)]
    assert kept == ["M3 S1000 ; spindle", "G1 F1200", "M7 (coolant)", "G1 F1200", "G0", "G4 P0.5", "G1 F1200", "G0",
                    "M30"]  # fmt: skip
    assert [comment for _, comment in run.comments] == ["spindle", "first", "second"]
    before = lines[: lines.index("M7 (coolant)")]
    assert before[-2].startswith("G1 Y20 ")
    assert done.moves == 4 and done.unshaped_moves == 0
    first = next(time for time, comment in run.comments if comment == "first")
    assert 9.8 < np.interp(first, *run.axis(0)) < 10.5


def test_a_pause_of_the_shaped_motion_is_written_as_a_dwell_in_the_controllers_unit(tmp_path: Path) -> None:
    """A move of half a millisecond's worth of acceleration is over long before the shaper's second impulse."""
    seconds, done = shaped(tmp_path, "G1 X0.02 F6000\n", tolerance=0.001, shortest=0.001)
    pauses = re.findall(r"G4 P(\S+)", (tmp_path / "out.gcode").read_text())
    assert pauses and max(map(float, pauses)) < 0.02
    shaped(tmp_path, "G1 X0.02 F6000\n", tolerance=0.001, shortest=0.001, dwell="milliseconds")
    longer = re.findall(r"G4 P(\S+)", (tmp_path / "out.gcode").read_text())
    assert [float(pause) for pause in longer] == pytest.approx([1000.0 * float(pause) for pause in pauses])
    assert seconds.times[-1] <= done.duration * (1.0 + 1e-5)


def test_a_move_from_nowhere_is_passed_on_and_its_end_is_known(tmp_path: Path) -> None:
    text = "G28\nG1 X5 Y5 F3000\nG1 X25\nG28 X\nG1 X7\nG91\nG1 X2\n"
    _, done = shaped(tmp_path, text, start={})
    lines = (tmp_path / "out.gcode").read_text().splitlines()
    assert (done.moves, done.unshaped_moves) == (2, 2)
    assert lines[:2] == ["G28", "G1 X5 Y5 F3000"] and "G1 X7" in lines


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("G1 X1\n", "line 1 moves before any F"),
        ("X1 F100\n", "line 1 moves without G0 or G1"),
        ("G1 X1 F0\n", "line 1 has F0"),
        ("G1 X#3 F100\n", "line 1 is no G-code"),
        ("G1 X1 X2 F100\n", "line 1 has X twice"),
        ("G1 A1 X2 F100\n", "line 1 has A beside"),
        ("G1 X2 F100 S5\n", "line 1 has S beside"),
        ("M3 S100 G1 X4 F100\n", "line 1 has G words behind"),
        ("G93\n", "line 1 has G93"),
        ("N1 G1 X1 F100*33\n", "checksum"),
        ("M83\nG90\nG1 X1 E1 F100\n", "line 3 extrudes after G90"),
        ("G1 X" + 14 * "1" + " F1\n", "line 1 is no G-code"),
        ("G1 X" + "1" * 2000, "longer than 1000"),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_line(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        shaped(tmp_path, text)
    assert not (tmp_path / "out.gcode").exists()


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"tolerance": 0.0001, "shortest": 0.01}, "moves from line 1: segments of 20 samples leave"),
        ({"shapers": {"a": X}}, "x, y or z"),
        ({"shapers": {}}, "no axis"),
        ({"dwell": "hours"}, "dwell"),
        ({"acceleration": 0.0}, "acceleration"),
        ({"start": {"x": np.nan}}, "start"),
        ({"dt": 1e-9}, "larger dt"),
    ],
)
def test_options_out_of_range_are_refused(tmp_path: Path, options: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        shaped(tmp_path, "G1 X30 Y20 F6000\n", **options)


WORDS = st.sampled_from(
    "G0 G1 G90 G91 G20 G21 M82 M83 G92 X1 Y-2.5 Z.1 E1 F900 F60000 ;a (b) M3 T1 # G4 P1 N3 é %".split() + 4 * ["\n"]
)


@settings(max_examples=60, deadline=None)
@given(st.lists(WORDS, max_size=25))
def test_any_text_is_shaped_or_refused_in_a_sentence(
    tmp_path_factory: pytest.TempPathFactory, words: list[str]
) -> None:
    folder = tmp_path_factory.mktemp("any")
    try:
        (folder / "in.gcode").write_text(" ".join(words))
        shape_gcode(folder / "in.gcode", {"x": X}, folder / "out.gcode", acceleration=3000.0, dt=0.005, shortest=0.005,
                    tolerance=10.0, start={"x": 0.0})  # fmt: skip
    except InputError:
        assert not (folder / "out.gcode").exists()


@settings(max_examples=30, deadline=None)
@given(
    st.lists(st.tuples(*[st.integers(-3000, 3000)] * 3, st.integers(0, 500)), min_size=1, max_size=6),
    st.sampled_from([("G90", "M82"), ("G90", "M83"), ("G91", "M82"), ("G91", "M83")]),
    st.sampled_from([0.0, 5.0]),
)
def test_every_program_ends_where_it_ended_with_as_much_extruded(
    tmp_path_factory: pytest.TempPathFactory,
    moves: list[tuple[int, int, int, int]],
    modes: tuple[str, str],
    corner_speed: float,
) -> None:
    text = "\n".join([*modes, "G1 F6000"])
    for k, (x, y, z, e) in enumerate(moves):
        text += f"\nG1 X{x / 100} Y{y / 100} Z{z / 1000} E{e / 100}" + ("\nG92 E0" if k == 2 else "")
    run, _ = shaped(tmp_path_factory.mktemp("program"), text + "\n", corner_speed=corner_speed)
    plain = Executor(text)
    np.testing.assert_allclose(run.places[-1], plain.places[-1], atol=1e-9)


def test_the_command_says_what_was_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    X.save("x.json")
    Y.save("y.json")
    arguments = ["gcode", str(EXAMPLE), "--shaper", "x=x.json", "--shaper", "Y=y.json", "--acceleration", "3000"]
    with pytest.raises(SystemExit) as stop:
        main([*arguments, "--out", "shaped.gcode"])
    assert stop.value.code == 0
    text = capsys.readouterr().out
    assert "10 moves are shaped" in text and "2 moves are not" in text and "velocity steps" in text
    for wrong, says in ((["--shaper", "x=y.json"], "each axis once"), (["--start", "x=left"], "no number")):
        with pytest.raises(SystemExit) as stop:
            main([*arguments, *wrong, "--out", "other.gcode"])
        assert stop.value.code == 2 and says in capsys.readouterr().err


def test_what_a_planner_must_be_allowed(tmp_path: Path) -> None:
    """Its own acceleration limit twice the planned one and the velocity step that is reported keep the shaping; a stop
    at every line shakes more than no shaping."""
    text = "G1 X20 Y12 F4000\n"
    plain, _ = shaped(tmp_path, text, shapers={"x": NONE})
    _, done = shaped(tmp_path, text)
    items = read_program((tmp_path / "out.gcode").read_text(), start={"X": 0.0, "Y": 0.0})
    moves = next(item for item in items if isinstance(item, Run)).moves
    left = []
    for corner_speed in (done.speed_step, 0.0):
        rows, _ = planned(moves, 2.0 * ACCELERATION, corner_speed, 0.0002)
        speeds = np.append(np.diff(rows[0]) / 0.0002, 0.0)
        command = Profile.steps(np.arange(rows.shape[1]) * 0.0002, np.diff(speeds, prepend=0.0), order=1)
        left.append(float(ModalPlant((38.0, 0.02)).motion(command).residual_amplitudes[0]))
    before = plain.residual(0, (38.0, 0.02))
    assert left[0] < 1.5 * 0.004 < 0.15 * before < before < left[1]
