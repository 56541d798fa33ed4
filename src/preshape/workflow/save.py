"""What a calibration leaves in a folder: shaper.json, the figure, the report. All of it, or a clear refusal."""

from __future__ import annotations

import os
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.report import Calibration, as_svg, calibration_figure, calibration_page

__all__ = ["SavedCalibration", "save_calibration"]


@dataclass(frozen=True)
class SavedCalibration:
    """Where the files are.

    Parameters
    ----------
    shaper, figure, report : Path
        shaper.json, calibration.svg, report.html.
    """

    shaper: Path
    figure: Path
    report: Path


def save_calibration(calibration: Calibration, folder: str | os.PathLike[str]) -> SavedCalibration:
    """Write the results into `folder`, which is made if it does not exist.

    Everything is rendered before the first file is written, and each file replaces an older one only when complete.

    Raises
    ------
    InputError
        If the folder cannot be made or written.
    """
    target = Path(folder)
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"cannot make the folder {target}: {error.strerror or error}; choose another with --out."
        ) from error
    figure = as_svg(calibration_figure(calibration))
    page = calibration_page(calibration, version("preshape"), figure)
    return SavedCalibration(
        shaper=calibration.shaper.save(target / "shaper.json"),
        figure=write_atomically(target / "calibration.svg", figure),
        report=write_atomically(target / "report.html", page),
    )
