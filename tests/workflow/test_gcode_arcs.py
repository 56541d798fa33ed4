"""G2 and G3 against the geometry of circles and helices, and against the same arcs written as lines."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from preshape import Shaper, design
from preshape.command.path import contour_error
from preshape.errors import InputError
from preshape.workflow import shape_gcode
from preshape.workflow.gcode.planned import planned
from preshape.workflow.gcode.program import Move, Run, read_program

ZERO = {"X": 0.0, "Y": 0.0, "Z": 0.0}
NONE = Shaper([0.0], [1.0])


def moves_of(text: str, tolerance: float = 0.004) -> tuple[Move, ...]:
    runs = [item for item in read_program(text, start=ZERO, tolerance=tolerance) if isinstance(item, Run)]
    return tuple(move for run in runs for move in run.moves)


def vertices(move: Move) -> NDArray[np.float64]:
    """Places of the chords' ends from the start of the arc, shape (chord + 1, 3)."""
    assert move.arc is not None
    return np.vstack([np.zeros(3), np.cumsum(move.arc.chords, axis=0)])


@settings(max_examples=80, deadline=None)
@given(
    centre=st.tuples(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0)),
    turn=st.floats(0.01, 6.27),
    climb=st.floats(-20.0, 20.0),
    clockwise=st.booleans(),
    by_radius=st.booleans(),
    tolerance=st.sampled_from([0.0004, 0.004, 0.1]),
)
def test_chords_lie_on_the_circle_within_the_tolerance_and_end_where_the_line_says(
    centre: tuple[float, float], turn: float, climb: float, clockwise: bool, by_radius: bool, tolerance: float
) -> None:
    radius = float(np.hypot(*centre))
    assume(radius > 1.0 and (not by_radius or abs(turn - np.pi) > 0.05))
    angle = np.arctan2(-centre[1], -centre[0]) + (-turn if clockwise else turn)
    end = np.array([centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle), climb])
    said = np.round(end, 9)
    how = f"R{radius * (1 if turn < np.pi else -1):.9f}" if by_radius else f"I{centre[0]:.9f} J{centre[1]:.9f}"
    x, y, z = (f"{value:.9f}" for value in said)
    (move,) = moves_of(f"G{2 if clockwise else 3} X{x} Y{y} Z{z} {how} F600\n", tolerance)
    places = vertices(move)
    assert places[-1] == pytest.approx(said, rel=0.0, abs=1e-12)
    from_centre = places[:, :2] - np.asarray(centre)
    assert np.abs(np.hypot(*from_centre.T) - radius).max() < 1e-5 * radius
    middles = 0.5 * (from_centre[1:] + from_centre[:-1])  # of a chord: where it is farthest from the circle
    assert 0.0 <= radius - np.hypot(*middles.T).min() < tolerance / 10.0
    around = np.unwrap(np.arctan2(from_centre[:, 1], from_centre[:, 0]))
    assert abs(abs(around[-1] - around[0]) - turn) < 1e-4 and (around[-1] < around[0]) == clockwise
    # A helix climbs in proportion to the angle, and its length is that of the unrolled triangle.
    np.testing.assert_allclose(places[:, 2], climb * (around - around[0]) / (around[-1] - around[0]), atol=1e-6)
    length = np.linalg.norm(np.diff(places, axis=0), axis=1).sum()
    assert length == pytest.approx(np.hypot(radius * turn, climb), rel=1e-3)
    assert length <= np.hypot(radius * turn, climb) * (1.0 + 1e-6)


@pytest.mark.parametrize(("line", "sense"), [("G2 I5 F600", -1.0), ("G3 J-5 X0 Y0 F600", 1.0), ("G3 I3 J4 Z2", 1.0)])
def test_an_arc_that_ends_where_it_begins_is_a_full_circle(line: str, sense: float) -> None:
    (move,) = moves_of(f"F600\n{line}\n")
    places = vertices(move)
    assert places[-1, :2].tolist() == [0.0, 0.0]
    area = 0.5 * np.sum(places[:-1, 0] * places[1:, 1] - places[1:, 0] * places[:-1, 1])
    assert area == pytest.approx(sense * np.pi * 25.0, rel=1e-3)


@pytest.mark.parametrize(
    ("line", "left", "turn"),
    [("G3 X10 R10", True, np.pi / 3), ("G2 X10 R10", False, np.pi / 3), ("G3 X10 R-10", False, 5 * np.pi / 3),
     ("G2 X10 R-10", True, 5 * np.pi / 3), ("G3 X10 R5", None, np.pi), ("G2 X10 R-5", None, np.pi)],
)  # fmt: skip
def test_a_radius_means_the_short_arc_and_a_negative_one_the_long(line: str, left: bool | None, turn: float) -> None:
    """Counter-clockwise on the short way the centre is on the left of the way, and so on."""
    (move,) = moves_of(f"F600\n{line}\n")
    places = vertices(move)
    length = np.linalg.norm(np.diff(places, axis=0), axis=1).sum()
    assert length == pytest.approx(abs(float(line.split("R")[1])) * turn, rel=1e-3)
    sense = 1.0 if line.startswith("G3") else -1.0
    # Counter-clockwise the way bulges to the right of the chord, clockwise to the left.
    assert np.sign(places[len(places) // 2, 1]) == -sense
    if left is not None:
        a, b, c = places[0, :2], places[len(places) // 2, :2], places[-1, :2]
        system = 2.0 * np.array([b - a, c - a])
        centre = np.linalg.solve(system, [b @ b - a @ a, c @ c - a @ a])
        assert (centre[1] > 0.0) == left


def test_inches_and_steps_are_the_same_arc() -> None:
    (metric,) = moves_of("G21\nG3 X25.4 Y25.4 I0 J25.4 F600\n")
    (inches,) = moves_of("G20\nG91\nG3 X1 Y1 J1 F24\n")
    np.testing.assert_allclose(vertices(metric), vertices(inches), atol=1e-12)


def test_the_plan_goes_round_at_the_feed_or_what_the_acceleration_across_allows() -> None:
    """Uniform motion on a circle: v^2 / r is the acceleration, exactly; the extrusion follows the way."""
    dt = 0.0002
    for feed, radius in ((20.0, 30.0), (400.0, 30.0)):
        moves = moves_of(f"M83\nG3 I{radius} E4 F{60 * feed}\n")
        rows, _ = planned(moves, 3000.0, 0.0, dt)
        speed = np.linalg.norm(np.diff(rows[:3], axis=1), axis=0) / dt
        assert speed.max() == pytest.approx(min(feed, np.sqrt(3000.0 * radius)), rel=2e-3)
        along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(rows[:3], axis=1), axis=0)))
        np.testing.assert_allclose(rows[3:].sum(axis=0), 4.0 * along / (2.0 * np.pi * radius), atol=4e-3)
        np.testing.assert_allclose(rows[:, -1], [0.0, 0.0, 0.0, *rows[3:, -1]], atol=1e-9)
        assert rows[3:, -1].sum() == pytest.approx(4.0, abs=1e-12)


def test_an_arc_that_continues_a_line_is_no_corner_and_one_that_does_not_is() -> None:
    smooth = moves_of("G1 X20 F1200\nG3 X30 Y10 J10\nG1 Y30\n")
    corner = moves_of("G1 X20 F1200\nG2 X30 Y10 I10\nG1 Y30\n")
    lasts = [planned(moves, 3000.0, 0.0, 0.0005)[0].shape[1] * 0.0005 for moves in (smooth, corner)]
    way = 20.0 + 5.0 * np.pi + 20.0
    assert lasts[0] == pytest.approx(way / 20.0 + 20.0 / 3000.0, abs=0.002)
    stops = 2 * 20.0 / 3000.0  # each stop costs v / a
    assert lasts[1] == pytest.approx(lasts[0] + stops, abs=0.002)


def shaped(folder: Path, text: str, shaper: Shaper, **options: Any) -> NDArray[np.float64]:
    """The vertices that were written, shape (axis, vertex)."""
    (folder / "in.gcode").write_text(text)
    shape_gcode(folder / "in.gcode", {"x": shaper, "y": shaper}, folder / "out.gcode",
                acceleration=3000.0, start={"x": 0.0, "y": 0.0, "z": 0.0}, **options)  # fmt: skip
    runs = [one for one in read_program((folder / "out.gcode").read_text(), start=ZERO) if isinstance(one, Run)]
    ways = [move.way for run in runs for move in run.moves]
    return np.vstack([np.zeros(3), np.cumsum(ways, axis=0)]).T


@pytest.mark.parametrize("tolerance", [0.004, 0.02])
def test_what_is_written_stays_on_the_arc_within_the_tolerance(tmp_path: Path, tolerance: float) -> None:
    """Without a shaper nothing else moves it off the circle; it goes round once, in G1 alone."""
    path = shaped(tmp_path, "G3 I15 F3000\n", NONE, tolerance=tolerance)
    angle = np.linspace(0.0, 2.0 * np.pi, 20_001)
    circle = np.array([15.0 - 15.0 * np.cos(angle), -15.0 * np.sin(angle), 0.0 * angle])
    assert contour_error(circle, path).bound < 1.2 * tolerance
    assert "G3" not in (tmp_path / "out.gcode").read_text() and np.abs(path[:, -1]).max() < 1e-9


def test_arcs_and_the_same_arcs_as_lines_are_shaped_alike(tmp_path: Path) -> None:
    shaper = design.zvd((38.0, 0.02))
    arcs = shaped(tmp_path, "G1 X20 F2400\nG3 X30 Y10 J10\nG1 Y30\n", shaper)
    angle = np.linspace(0.0, np.pi / 2.0, 2000)[1:]
    text = "G1 X20 F2400\n"
    text += "".join(f"G1 X{20.0 + 10.0 * np.sin(a):.7f} Y{10.0 - 10.0 * np.cos(a):.7f}\n" for a in angle)
    lines = shaped(tmp_path, text + "G1 Y30\n", shaper)
    assert contour_error(lines, arcs).bound < 0.01 and contour_error(arcs, lines).bound < 0.01
    np.testing.assert_allclose(arcs[:, -1], [30.0, 30.0, 0.0], atol=1e-9)


def test_an_arc_from_a_place_that_is_not_known_goes_on_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "in.gcode").write_text("G28\nG2 X5 Y5 I5 F600\nG1 X9\n")
    done = shape_gcode(tmp_path / "in.gcode", {"x": NONE}, tmp_path / "out.gcode", acceleration=3000.0)
    assert (done.moves, done.unshaped_moves) == (1, 1)
    assert (tmp_path / "out.gcode").read_text().splitlines()[1] == "G2 X5 Y5 I5 F600"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("G2 X10 I4", "line 2 has an arc that begins 4 mm and ends 6 mm from its centre"),
        ("G2 X10 I0 J0", "begins 0 mm"),
        ("G2 X10", "line 2 has an arc without I, J or R"),
        ("G2 X10 R4", "a radius of at least 5 mm"),
        ("G2 X10 R5 I5", "R beside I or J"),
        ("G2 R5", "line 2 has R and ends where it begins"),
        ("G2 X0 Y0 R5", "any circle"),
        ("G18\nG2 X10 I5", "line 3 has an arc under G18"),
        ("G19 G3 X10 I5", "line 2 has an arc under G19"),
        ("G90.1\nG2 X10 I5", "under G90.1"),
        ("G2 X10 I5 K1", "line 2 has K beside a move"),
        ("G2 X10 I5 P2", "line 2 has P beside a move"),
        ("G2 X10 I5\nX20", "line 3 goes on after an arc without G word"),
        ("G1 X10 I5", "line 2 has I beside a move"),
        ("G2 X10 R900000000000", "too large to be told from a line"),
    ],
)
def test_what_is_no_arc_is_refused_with_its_line(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        moves_of(f"F600\n{text}\n")


def test_the_plane_is_the_one_in_force() -> None:
    assert len(moves_of("G18\nG17\nG90.1\nG91.1\nG2 X10 I5 F600\n")) == 1
