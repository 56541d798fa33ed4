"""What a calibration has to show: the measurement, its modes, the candidates, the choice, and the simulated move."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.export import PasteText
from preshape.export.klipper import KlipperFit, KlipperScore
from preshape.identify import Identification, IdentifiedMode, PrintedSpectrum
from preshape.mode import Modes
from preshape.report.record import CalibrationJob, RecordedFile
from preshape.report.trade_off import FREQUENCY_ERROR, TradeOff
from preshape.shaper import Shaper

__all__ = ["FREQUENCY_ERROR", "Calibration", "Candidate", "MeasuredFile", "SimulatedMove"]


@dataclass(frozen=True)
class MeasuredFile:
    """One measurement and what was found in it.

    Parameters
    ----------
    name : str
        The file's name without its folder.
    format : str
        Its format, as the reader calls it.
    identification : Identification
        Modes, fitted curve, troubles.
    scored : PrintedSpectrum
        On which shapers are scored; a sweep's divided by frequency as Klipper does.
    """

    name: str
    format: str
    identification: Identification
    scored: PrintedSpectrum


@dataclass(frozen=True)
class Candidate:
    """A shaper that was considered.

    Parameters
    ----------
    name : str
        Family and, for a tuned family, its frequency: "mzv 57.02 Hz".
    shaper : Shaper
        The impulses.
    left : float
        Amplitude that remains [-] of what rings on after a move (the modes, by their shares; on a measurement that is
        not clear everything loud in it), when all frequencies are off by up to :data:`FREQUENCY_ERROR`, in the worst
        case.
    score : KlipperScore
        By Klipper's own measures: remaining vibration [-], smoothing [mm], maximum acceleration [mm/s^2].
    excluded : bool
        Whether the controller cannot hold it.
    """

    name: str
    shaper: Shaper
    left: float
    score: KlipperScore
    excluded: bool = False


@dataclass(frozen=True)
class SimulatedMove:
    """The identified modes during a point-to-point move, unshaped and shaped.

    Parameters
    ----------
    times : ndarray, shape (time,)
        [s] from the start of the move.
    unshaped, shaped : ndarray, shape (time,)
        Vibration, relative to the largest that the unshaped move leaves behind.
    end_unshaped, end_shaped : float
        When the commands end [s].
    left : float
        Largest vibration that the shaped move leaves, relative to the unshaped one [-].
    modes : Modes
        What was simulated.
    errors : ndarray, shape (error,)
        By what part the natural frequencies of the machine are off [-]: low, not at all, high.
    predicted : ndarray, shape (mode, error)
        Part of each mode's amplitude that the shaper leaves at the end [-]: its residual vibration V, by formula.
    simulated : ndarray, shape (mode, error)
        The same by the simulation: the amplitude after the shaped move over that after the unshaped one [-]; NaN for a
        mode that the unshaped move leaves at rest.
    """

    times: NDArray[np.float64]
    unshaped: NDArray[np.float64]
    shaped: NDArray[np.float64]
    end_unshaped: float
    end_shaped: float
    left: float
    modes: Modes
    errors: NDArray[np.float64]
    predicted: NDArray[np.float64]
    simulated: NDArray[np.float64]


@dataclass(frozen=True)
class Calibration:
    """The outcome of :func:`preshape.workflow.calibrate`.

    Parameters
    ----------
    files : tuple of MeasuredFile
        In the order given.
    modes : tuple of IdentifiedMode
        Merged over the files, the most important first; empty when none was found.
    candidates : tuple of Candidate
        The best first.
    chosen : Candidate
        One of them.
    reason : str
        One sentence why.
    klipper : KlipperFit or None
        What Klipper itself would recommend on the same spectra, for comparison; None for a machine that vibrates where
        Klipper does not look, for which its measures mean nothing either.
    trouble : tuple of str
        What is wrong with the machine or the measurement, as sentences; empty when healthy.
    clear : bool
        False when the measurement is no ground to tune a shaper on; the choice is then the least bad.
    move : SimulatedMove or None
        None when no mode was found.
    tolerance : float
        Remaining vibration that was allowed [-].
    maximum_impulses : int or None
        Limit of the controller.
    trade_off : TradeOff or None
        What smoothing buys, and the picks within the controller's limits; None where Klipper's measures mean nothing.
    texts : tuple of PasteText
        The chosen shaper for each firmware that takes settings, or why it does not fit; empty as above.
    job : CalibrationJob
        The options.
    inputs : tuple of RecordedFile
        The files as they were read, for whoever wants to run it again.
    """

    files: tuple[MeasuredFile, ...]
    modes: tuple[IdentifiedMode, ...]
    candidates: tuple[Candidate, ...]
    chosen: Candidate
    reason: str
    klipper: KlipperFit | None
    trouble: tuple[str, ...]
    clear: bool
    move: SimulatedMove | None
    tolerance: float
    maximum_impulses: int | None
    job: CalibrationJob
    inputs: tuple[RecordedFile, ...]
    trade_off: TradeOff | None = None
    texts: tuple[PasteText, ...] = ()

    @property
    def shaper(self) -> Shaper:
        """The chosen shaper."""
        return self.chosen.shaper
