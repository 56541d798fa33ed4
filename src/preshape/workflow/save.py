"""What a calibration leaves in a folder: shapers, figures, report, settings to paste. All of it, or a clear refusal."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from preshape.errors import InputError
from preshape.export import TARGETS, SettingsTarget
from preshape.export.klipper import OPTIMUM
from preshape.export.settings_target import MARK
from preshape.files import write_atomically
from preshape.report import (
    TRADE_OFF_TITLE,
    Calibration,
    as_svg,
    calibration_figure,
    calibration_page,
    trade_off_figure,
)
from preshape.shaper import Shaper
from preshape.shaper_file import to_json

__all__ = ["SavedCalibration", "save_calibration"]

SETTINGS = "settings"
"""The folder below which each firmware has its own."""

TRADE_OFF = "trade_off.svg"
PICKS = ("performance", "quality", "improved")

LARGEST = 1_000_000
"""Bytes; an older file with more is none of ours."""


@dataclass(frozen=True)
class SavedCalibration:
    """Where the files are.

    Parameters
    ----------
    shaper, figure, report : Path
        shaper.json, calibration.svg, report.html.
    trade_off : Path or None
        trade_off.svg, if there is a trade-off.
    picks : tuple of Path
        performance.json, quality.json, improved.json, those that exist.
    settings : tuple of Path
        Of every firmware that holds the chosen shaper, each in a folder of its name under settings.
    """

    shaper: Path
    figure: Path
    report: Path
    trade_off: Path | None = None
    picks: tuple[Path, ...] = ()
    settings: tuple[Path, ...] = ()


def save_calibration(calibration: Calibration, folder: str | os.PathLike[str]) -> SavedCalibration:
    """Write the results into `folder`, which is made if it does not exist.

    Everything is rendered before the first file is written, and each file replaces an older one only when complete.

    Raises
    ------
    InputError
        If the folder cannot be made or written.
    """
    target = Path(folder)
    trade = calibration.trade_off
    figure = as_svg(calibration_figure(calibration))
    second = None if trade is None else as_svg(trade_off_figure(trade))
    page = calibration_page(calibration, version("preshape"), figure, second)
    settings = {target / SETTINGS / name: content for text in calibration.texts for name, content in text.files.items()}
    _make_folders([target, *sorted({path.parent for path in settings})])
    saved = SavedCalibration(
        shaper=calibration.shaper.save(target / "shaper.json"),
        figure=write_atomically(target / "calibration.svg", figure),
        report=write_atomically(target / "report.html", page),
        trade_off=None if second is None else write_atomically(target / TRADE_OFF, second),
        picks=() if trade is None else tuple(pick.shaper.save(target / f"{pick.name}.json") for pick in trade.picks),
        settings=tuple(write_atomically(path, content) for path, content in settings.items()),
    )
    _remove_outdated(target, saved)
    return saved


def _make_folders(folders: Iterable[Path]) -> None:
    for folder in folders:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(
                f"cannot make the folder {folder}: {error.strerror or error}; choose another with --out."
            ) from error


def _remove_outdated(target: Path, saved: SavedCalibration) -> None:
    """What an earlier run left and this one does not have: nobody should paste or export it. A file that does not bear
    our mark stays."""
    folders = [target / SETTINGS / name for name, one in TARGETS.items() if isinstance(one, SettingsTarget)]
    old = {path: _is_settings for folder in folders for path in folder.glob("*")}
    old |= {target / f"{name}.json": _is_pick for name in PICKS}
    old[target / TRADE_OFF] = _is_trade_off
    for path in old.keys() - {*saved.settings, *saved.picks, saved.trade_off}:
        try:
            if path.is_file() and path.stat().st_size < LARGEST and old[path](path):
                path.unlink()
        except (OSError, UnicodeDecodeError, InputError):
            continue  # not of a calibration, or not ours to remove


def _is_settings(path: Path) -> bool:
    """Settings bear the mark; Klipper's module does not, and may stay, for it holds no impulses."""
    return MARK.search(path.read_text()[:200]) is not None


def _is_pick(path: Path) -> bool:
    """A pick as it was saved, to the letter; one that somebody has changed is no longer ours."""
    shaper = Shaper.load(path)
    return shaper.design.family == OPTIMUM and path.read_text() == to_json(shaper.to_dict())


def _is_trade_off(path: Path) -> bool:
    text = path.read_text()
    return text.startswith("<svg") and f"<!-- {TRADE_OFF_TITLE}" in text
