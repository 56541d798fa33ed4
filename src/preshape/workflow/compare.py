"""Every command for the same move of the same plant: how long, how much vibration, how far it bends, how robust."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from preshape.checks import nonzero, positive, tolerance_of
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.plant import ModalPlant, Motion, Output
from preshape.report import Comparison, Contender, LeftOut
from preshape.shaper import Shaper
from preshape.workflow.contenders import Entry, Limited, Move, entries

__all__ = ["compare"]

CURVE = 201
"""Frequencies at which the vibration is looked at, over twice the frequency error either way."""

ZOOMS, ZOOM_LOOKS = 3, 17
"""How often the worst frequency is looked for between its neighbours, and at how many."""

LONG_RING, HALVINGS = 1e4, 60
"""Vibration that takes more periods than this to decay is followed by its envelope, from which it then differs by less
than a period."""

NEGLIGIBLE = 1e-4
"""A filtered command has ended when this part of the way is left, as in :mod:`preshape.command.filtered`, or less than
the window in which the deflection counts as settled."""


def compare(
    modes: ModesLike,
    distance: float,
    *,
    maximum_acceleration: float,
    maximum_speed: float | None = None,
    maximum_jerk: float | None = None,
    gains: Sequence[float] | None = None,
    shapers: Mapping[str, Shaper] | None = None,
    tolerance: float = 0.02,
    within: float | None = None,
    frequency_error: float = 0.1,
    unit: str = "m",
) -> Comparison:
    """Compare every classical, shaped, filtered and rest-to-rest command for one move of a carriage.

    The carriage (a stage, a crane's trolley, a drive of a robot) follows the command exactly, and the modes ride on it:
    each deflection relative to the carriage obeys d'' + 2 z w d' + w^2 d = -(the carriage's acceleration). All commands
    cover the same distance within the same limits, each as fast as it can. What shapers and filters are given is the
    trapezoid, or with a jerk limit the S-curve; commands whose acceleration jumps are then left out, with that reason,
    as is everything that cannot make this move.

    For several modes, shapers of one mode are convolved and notches put in series; "direct" is the shortest shaper for
    all of them. Ramped sinusoid, band-limited pulse, period-matched trapezoid, and without a jerk limit the S-curve,
    spare the first mode only. The rest-to-rest commands are those for a free body with the force mass x acceleration;
    they take no speed limit, and are in the same table where they keep it by themselves.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]; name the most important first.
    distance : float
        How far [unit]; negative moves backwards.
    maximum_acceleration : float
        Limit [unit/s^2].
    maximum_speed, maximum_jerk : float, optional
        Limits [unit/s, unit/s^3]; none unless given.
    gains : sequence of float, shape (mode,), optional
        Share of each mode in the deflection that is looked at [-]; equal shares of 1 unless given.
    shapers : mapping of str to Shaper, optional
        What shapes the base move, instead of ZV, ZVD, EI, the shortest and SD-ZV with half of ZV's deflection.
    tolerance : float
        The deflection has settled when it stays within this part [-] of the vibration that a step leaves: to the
        maximum acceleration (the static deflection under it), to the maximum speed or over the whole way, whichever
        leaves least. What a move leaves would be no measure: it can be 0 by a lucky duration.
    within : float, optional
        The window itself [unit], instead of the tolerance.
    frequency_error : float
        By how much all frequencies together may be off, below 0.5 [-].
    unit : str
        Unit of length, for tables and figures.

    Returns
    -------
    Comparison

    Raises
    ------
    InputError
        If a value is out of range or the gains do not fit the modes.

    Examples
    --------
    >>> result = compare((1.2, 0.01), 0.5, maximum_speed=1.0, maximum_acceleration=5.0)
    >>> zv = result["trapezoid + ZV"]
    >>> round(zv.move_time, 4), zv.residual < 1e-12
    (1.1167, True)
    >>> result["trapezoid + ZVD"].worst_residual < 0.2 * zv.worst_residual
    True
    """
    wanted = Modes(modes)
    limited = Limited(
        nonzero("distance", distance, unit),
        positive("maximum_acceleration", maximum_acceleration, f"{unit}/s^2"),
        None if maximum_speed is None else positive("maximum_speed", maximum_speed, f"{unit}/s"),
        None if maximum_jerk is None else positive("maximum_jerk", maximum_jerk, f"{unit}/s^3"),
    )
    error = positive("frequency_error", frequency_error, "(a ratio)")
    if error >= 0.5:
        raise InputError(f"frequency_error is {error:g}: give a part of the frequency below 0.5, such as 0.1 for 10 %.")
    plant = ModalPlant(wanted, gains, drive="acceleration")
    if plant.gains.ndim != 1:
        raise InputError(f"gains have shape {plant.gains.shape}: give one share for each mode.")
    reference = float(np.abs(plant.gains) @ [limited.step_leaves(mode) for mode in wanted])
    window = tolerance_of(tolerance) * reference if within is None else positive("within", within, unit)
    if window == 0.0:
        raise InputError("all gains are 0, so nothing is looked at: give the share of each mode in the deflection.")
    measured = _Measured(plant, limited, window, error)
    contenders, left_out = [], []
    for entry in entries(wanted, limited, shapers, min(NEGLIGIBLE * abs(limited.distance), window)):
        try:
            contenders.append(measured.contender(entry, entry.make()))
        except InputError as problem:
            left_out.append(LeftOut(entry.name, str(problem)))
    contenders.sort(key=lambda c: (c.settling_time, c.residual, c.move_time))
    return Comparison(
        modes=wanted,
        gains=tuple(plant.gains.tolist()),
        distance=limited.distance,
        maximum_acceleration=limited.acceleration,
        maximum_speed=limited.speed,
        maximum_jerk=limited.jerk,
        within=window,
        reference=reference,
        frequency_error=error,
        frequency_ratios=measured.ratios,
        contenders=tuple(contenders),
        left_out=tuple(left_out),
        unit=unit,
    )


class _Measured:
    """What is measured of a move on a plant."""

    def __init__(self, plant: ModalPlant, limited: Limited, window: float, error: float) -> None:
        self.plant, self.limited, self.window, self.error = plant, limited, window, error
        self.ratios = np.linspace(1.0 - 2.0 * error, 1.0 + 2.0 * error, CURVE)

    def contender(self, entry: Entry, move: Move) -> Contender:
        """All measures; the plant's from its exact motion."""
        motion = self.plant.motion(move.acceleration)
        return Contender(
            name=entry.name,
            kind=entry.kind,
            acceleration=move.acceleration,
            exact=move.exact,
            move_time=move.move_time,
            settling_time=max(move.move_time, self.settled(motion)),
            residual=float(self.residuals(move, np.ones(1))[0]),
            worst_residual=self.worst(move),
            peak_deflection=motion.peak("output").value,
            peak_acceleration=motion.peak(Output(command=1.0)).value,
            residual_curve=self.residuals(move, self.ratios),
            note=move.note,
        )

    def settled(self, motion: Motion) -> float:
        """When the deflection stays within the window [s]: exact, or by the envelope after a very long ring-down."""
        amplitudes = np.abs(self.plant.gains) * motion.residual_amplitudes
        rates = np.array([mode.damping * mode.omega for mode in self.plant.modes])
        if amplitudes[rates == 0.0].sum() > self.window:
            return math.inf

        def excess(since: float) -> float:
            return float(amplitudes @ np.exp(-rates * since)) - self.window

        longest = LONG_RING / min(mode.frequency for mode in self.plant.modes)
        if excess(longest) <= 0.0:
            return motion.settling_time("output", self.window)
        low, high = longest, 2.0 * longest
        while excess(high) > 0.0:
            low, high = high, 2.0 * high
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if excess(middle) > 0.0 else (low, middle)
        return motion.end_time + high

    def residuals(self, move: Move, ratios: NDArray[np.float64]) -> NDArray[np.float64]:
        """Amplitude of the free vibration at the command's end, over the frequency ratios [unit], shape (ratio,)."""
        total = np.zeros(ratios.size)
        for gain, mode in zip(self.plant.gains, self.plant.modes, strict=True):
            total += abs(gain) * move.amplitude_left(mode.frequency * ratios, mode.damping)
        return total

    def worst(self, move: Move) -> float:
        """The largest amplitude over the frequency error: on a grid, then between the neighbours of its largest."""
        low, high = 1.0 - self.error, 1.0 + self.error
        looks = np.linspace(low, high, CURVE)
        worst = 0.0
        for _ in range(ZOOMS + 1):
            left = self.residuals(move, looks)
            at = int(np.argmax(left))
            worst = max(worst, float(left[at]))
            looks = np.linspace(looks[max(at - 1, 0)], looks[min(at + 1, looks.size - 1)], ZOOM_LOOKS)
        return worst
