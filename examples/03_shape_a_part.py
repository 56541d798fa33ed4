"""Example 3: a part of lines, corners and a circle, shaped in three ways; how far each leaves the curve.

The x axis vibrates at 38 Hz, the y axis at 61 Hz. The path is data/part.csv: 100 mm/s, 3000 mm/s^2, a stop at each
corner. The shapers of both axes and the figure go into a folder:

    python examples/03_shape_a_part.py             # into part/
    python examples/03_shape_a_part.py --out DIR
    python examples/03_shape_a_part.py --make      # writes data/part.csv again

The same, but for the one shaper for both axes, as

    preshape shape part/x.json examples/data/part.csv --column y=part/y.json --contour --figure part/part.svg \\
        --out part/shaped.csv
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from preshape import design, identify
from preshape.command import trapezoid
from preshape.command.path import shaped_path
from preshape.files import write_atomically
from preshape.report import as_svg, contour_figure

PART = Path(__file__).parent / "data" / "part.csv"

X, Y = (38.0, 0.05), (61.0, 0.05)
DT = 0.001


def main() -> None:
    """Shape, measure, draw."""
    parser = argparse.ArgumentParser(description="The path of a part, shaped in three ways.")
    parser.add_argument("--out", type=Path, default=Path("part"), help="folder to write into")
    parser.add_argument("--make", action="store_true", help="only write data/part.csv")
    asked = parser.parse_args()
    if asked.make:
        print(write_atomically(PART, part()))
        return
    folder: Path = asked.out
    folder.mkdir(parents=True, exist_ok=True)
    series = identify.read(PART)
    assert isinstance(series, identify.TimeSeries)
    x, y, both = design.zvd(X), design.zvd(Y), design.direct([X, Y])
    paths = {
        "equal delays": shaped_path(series.values, [x, y], DT),
        "own delays": shaped_path(series.values, [x, y], DT, delays="own"),
        "one shaper": shaped_path(series.values, both, DT),
    }
    for label, path in paths.items():
        error = path.contour_error()
        end = 1e3 * (path.shaped.shape[1] - path.commanded.shape[1]) * DT
        print(f"{label}: at most {error.largest:.3f} mm beside the curve, RMS {error.rms:.3f} mm, {end:.0f} ms longer")
    print(x.save(folder / "x.json"), y.save(folder / "y.json"))
    print(write_atomically(folder / "part.svg", as_svg(contour_figure(paths, names=series.channels, unit=series.unit))))


def part() -> str:
    """A table of time [s], x and y [mm]: a slanted line, two straight ones, a circle of radius 8 mm."""
    legs = [np.zeros((2, 1))]
    for across, up in ((30.0, 18.0), (0.0, 14.0), (-22.0, 0.0)):
        length = float(np.hypot(across, up))
        legs.append(legs[-1][:, -1:] + np.outer([across, up], _way(length) / length))
    angle = _way(2.0 * np.pi * 8.0) / 8.0
    legs.append(legs[-1][:, -1:] + 8.0 * np.stack([-np.sin(angle), 1.0 - np.cos(angle)]))
    rows = enumerate(np.concatenate(legs, axis=1).T)
    return "time [s],x [mm],y [mm]\n" + "".join(f"{DT * n:.3f},{x:.6f},{y:.6f}\n" for n, (x, y) in rows)


def _way(length: float) -> NDArray[np.float64]:
    """Samples of the way along a leg [mm]."""
    return trapezoid(length, maximum_speed=100.0, maximum_acceleration=3000.0, dt=DT).values[1:]


if __name__ == "__main__":
    main()
