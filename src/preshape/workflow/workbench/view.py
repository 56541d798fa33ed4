"""View: a workbench as numbers to be drawn, every design beside the others; computed anew only where it changed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Mode
from preshape.shaper import Shaper
from preshape.vibration import ShaperZero, insensitivity, residual_vibration, zeros_near
from preshape.workflow.workbench.curves import STEP, Response, profile_of, read_only, response, times_until
from preshape.workflow.workbench.solve import misfit, solved
from preshape.workflow.workbench.state import AskedDesign, Workbench

__all__ = ["INSENSITIVITY_AT", "DesignView", "Drawn", "ModeView", "View", "view_of"]

INSENSITIVITY_AT = 0.05
"""Vibration [-] that is tolerated where a band of frequencies is shown."""

REMEMBERED = 64

HIGHEST, FREQUENCIES = 1.6, 600
"""The sensitivity curve runs from 0 to this multiple of the highest mode, in so many steps and at each mode."""


@dataclass(frozen=True)
class ModeView:
    """What a design does at one mode.

    Parameters
    ----------
    residual : float
        Residual vibration [-]: 0.05 is 5 % of the unshaped.
    low, high : float
        Band of natural frequencies [Hz] about the mode in which the residual stays within 5 %; both are the mode's own
        frequency if it does not even there. `high` is infinite if the band goes on beyond the view's frequencies.
    """

    residual: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Drawn:
    """A design that has a shaper.

    Parameters
    ----------
    shaper : Shaper
        The shaper itself: times [s], amplitudes [-], and where it comes from.
    status : str
        "exact", "optimal" or "feasible", as :class:`preshape.provenance.Design` says.
    proved : bool
        Whether it is proved that no shaper of its kind is shorter.
    vibration : ndarray, shape (frequency,)
        Residual vibration [-] at the view's frequencies, each at the view's damping ratio there.
    modes : tuple of ModeView
        One a mode, in their order.
    zeros : tuple of ShaperZero
        Zeros of the shaper about the poles [1/s].
    step, move : Response
        Motion under the shaped unit step and the shaped move.
    misfit : str
        Why the controller cannot hold it, as a sentence; empty if it can.
    """

    shaper: Shaper
    status: str
    proved: bool
    vibration: NDArray[np.float64]
    modes: tuple[ModeView, ...]
    zeros: tuple[ShaperZero, ...]
    step: Response
    move: Response
    misfit: str


@dataclass(frozen=True, eq=False)
class DesignView:
    """One design, drawn or not.

    Parameters
    ----------
    asked : AskedDesign
        What was asked for.
    drawn : Drawn or None
        None if there is no such shaper.
    trouble : str
        Why there is none, as a sentence; else empty.
    """

    asked: AskedDesign
    drawn: Drawn | None
    trouble: str = ""


@dataclass(frozen=True, eq=False)
class View:
    """Everything to be drawn.

    Parameters
    ----------
    workbench : Workbench
        Of what.
    frequencies : ndarray, shape (frequency,)
        Increasing natural frequencies [Hz] of the sensitivity curves; every mode's is among them.
    dampings : ndarray, shape (frequency,)
        Damping ratio [-] at which the curves are drawn: of the modes, and between two of them in proportion.
    poles : tuple of complex
        Of the modes, the upper ones [1/s].
    step_times, move_times : ndarray, shape (sample,)
        Times [s] of all step responses and of all moves.
    unshaped_step, unshaped_move : Response
        The motion without a shaper.
    designs : tuple of DesignView
        In the order of their names.
    """

    workbench: Workbench
    frequencies: NDArray[np.float64]
    dampings: NDArray[np.float64]
    poles: tuple[complex, ...]
    step_times: NDArray[np.float64]
    move_times: NDArray[np.float64]
    unshaped_step: Response
    unshaped_move: Response
    designs: tuple[DesignView, ...]


def view_of(workbench: Workbench) -> View:
    """What is drawn of a workbench.

    A design without a solution is data of the view, with its sentence; nothing is raised.

    Examples
    --------
    >>> view = view_of(Workbench((Mode(10.0, 0.0),), (AskedDesign("A", "zv"), AskedDesign("B", "sd_zv"))))
    >>> view.designs[0].drawn.shaper.duration, view.designs[1].trouble
    (0.05, 'family sd_zv needs deflection_ratio: give a number.')
    """
    modes, plant, move = workbench.modes, workbench.plant, workbench.move
    outcomes = [solved(asked, modes) for asked in workbench.designs]
    longest = max([one.shaper.duration for one in outcomes if one.shaper is not None], default=0.0)
    step_end, move_end = longest, longest + profile_of(move).end_time
    frequencies, dampings = _axis(modes)
    designs = []
    for asked, outcome in zip(workbench.designs, outcomes, strict=True):
        shaper, drawn = outcome.shaper, None
        if shaper is not None:
            drawn = Drawn(
                shaper=shaper,
                status=shaper.design.status,
                proved=_proved(shaper),
                vibration=_curve(shaper, modes),
                modes=tuple(_at_mode(shaper, mode, float(frequencies[-1])) for mode in modes),
                zeros=_zeros(shaper, modes),
                step=response(modes, plant, STEP, shaper, step_end),
                move=response(modes, plant, move, shaper, move_end),
                misfit=misfit(shaper, workbench.controller),
            )
        designs.append(DesignView(asked, drawn, outcome.trouble))
    return View(
        workbench=workbench,
        frequencies=frequencies,
        dampings=dampings,
        poles=tuple(mode.pole for mode in modes),
        step_times=times_until(step_end, modes),
        move_times=times_until(move_end, modes),
        unshaped_step=response(modes, plant, STEP, None, step_end),
        unshaped_move=response(modes, plant, move, None, move_end),
        designs=tuple(designs),
    )


def _proved(shaper: Shaper) -> bool:
    """Optimal with its proof: by a certificate, or on a grid by the search that left nothing shorter."""
    certificate = shaper.design.certificate
    return shaper.design.status == "optimal" and (certificate is None or certificate.holds)


@lru_cache(maxsize=REMEMBERED)
def _axis(modes: tuple[Mode, ...]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Frequencies [Hz] of the curves and the damping ratio [-] at each."""
    ordered = sorted(modes, key=lambda mode: mode.frequency)
    own = np.array([mode.frequency for mode in ordered])
    frequencies = np.union1d(np.linspace(0.0, HIGHEST * own[-1], FREQUENCIES + 1), own)
    dampings = np.interp(frequencies, own, [mode.damping for mode in ordered])
    return read_only(frequencies), read_only(dampings)


@lru_cache(maxsize=REMEMBERED)
def _curve(shaper: Shaper, modes: tuple[Mode, ...]) -> NDArray[np.float64]:
    return read_only(residual_vibration(shaper, *_axis(modes)))


@lru_cache(maxsize=REMEMBERED)
def _zeros(shaper: Shaper, modes: tuple[Mode, ...]) -> tuple[ShaperZero, ...]:
    return zeros_near(shaper, modes)


@lru_cache(maxsize=4 * REMEMBERED)
def _at_mode(shaper: Shaper, mode: Mode, highest: float) -> ModeView:
    band = insensitivity(shaper, mode, INSENSITIVITY_AT, highest=highest)
    return ModeView(float(residual_vibration(shaper, mode.frequency, mode.damping)), band.low, band.high)
