"""What a shaper does at its modes: the numbers an engineer asks for first."""

from __future__ import annotations

from dataclasses import dataclass

from preshape.errors import InputError
from preshape.export import klipper
from preshape.mode import Mode, Modes
from preshape.shaper import Shaper
from preshape.vibration import Insensitivity, insensitivity, residual_vibration, total_insensitivity

__all__ = ["Analysis", "ModeAnalysis", "analyze"]


@dataclass(frozen=True)
class ModeAnalysis:
    """A shaper at one mode.

    Parameters
    ----------
    mode : Mode
        Frequency [Hz] and damping ratio [-].
    residual : float
        V at the mode [-].
    insensitivity : Insensitivity
        Band around the mode in which V stays within the tolerance.
    total_insensitivity : float
        Area in relative frequency (0.5 to 1.5) x damping (0 to 0.2) within the tolerance [-].
    """

    mode: Mode
    residual: float
    insensitivity: Insensitivity
    total_insensitivity: float


@dataclass(frozen=True)
class Analysis:
    """A shaper at all its modes.

    Parameters
    ----------
    shaper : Shaper
        What was analysed.
    tolerance : float
        For the insensitivities [-].
    modes : tuple of ModeAnalysis
        In the order of the design.
    smoothing, maximum_acceleration : float
        Klipper's measures [mm at 5000 mm/s^2, mm/s^2].
    """

    shaper: Shaper
    tolerance: float
    modes: tuple[ModeAnalysis, ...]
    smoothing: float
    maximum_acceleration: float


def analyze(shaper: Shaper, modes: Modes | None = None, tolerance: float = 0.05) -> Analysis:
    """Residual vibration and insensitivity at `modes`, those of the design unless given.

    Raises
    ------
    InputError
        If the shaper does not say for which modes it was designed and none are given, or the tolerance is not in
        (0, 1).

    Examples
    --------
    >>> import preshape
    >>> found = analyze(preshape.design.zvd((10.0, 0.0)))
    >>> round(found.modes[0].insensitivity.value, 4)
    0.2871
    """
    wanted = modes if modes is not None else shaper.design.modes
    if wanted is None:
        raise InputError("this shaper does not say for which modes it was designed: name them with --mode F:Z.")
    return Analysis(
        shaper=shaper,
        tolerance=tolerance,
        modes=tuple(
            ModeAnalysis(
                mode,
                float(residual_vibration(shaper, mode.frequency, mode.damping)),
                insensitivity(shaper, mode, tolerance),
                total_insensitivity(shaper, mode, tolerance),
            )
            for mode in wanted
        ),
        smoothing=klipper.smoothing(shaper),
        maximum_acceleration=klipper.maximum_acceleration(shaper),
    )
