"""Band-limited pulses (Aspinwall): an acceleration of a few sines whose spectrum is least over a band of frequencies.

a(t) = sum over odd n of b_n sin(n pi t / tau) on [0, tau] to speed up, the same mirrored to slow down; of all b that
give the pulse its area the one with the least mean power over the band.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.band import Band, BandsLike, bands_of
from preshape.checks import nonzero, positive, whole_number
from preshape.command.command import Command
from preshape.command.shape import Limits, MoveShape, shaped_move, shortest_of
from preshape.errors import InputError

__all__ = ["band_limited", "band_limited_shape"]

FREQUENCIES = 41
"""Frequencies at which the power of the pulse is summed."""

SAMPLES = 2001


def band_limited_shape(band: Band, duration: float, terms: int = 3) -> MoveShape:
    """The form of the move of `duration` [s]: two opposite pulses of half of it each."""
    tau = 0.5 * positive("duration", duration, "s")
    orders = 2 * np.arange(whole_number("terms", terms, 1, 6)) + 1
    omega = 2.0 * np.pi * np.linspace(band.low, band.high, FREQUENCIES) * tau
    # transform of sin(n pi x) on [0, 1] at omega, with its limit j / 2 where omega = n pi
    rate = np.pi * orders[:, None]
    gap = rate**2 - omega**2
    near = np.abs(gap) < 1e-9
    waves = np.where(near, 0.5j, rate * (1.0 + np.exp(1j * omega)) / np.where(near, 1.0, gap))
    power = np.real(waves @ waves.conj().T) / FREQUENCIES
    area = 2.0 / (np.pi * orders)
    b = np.linalg.lstsq(power, area, rcond=1e-12)[0]
    b = b / (area @ b)  # a pulse of area one over [0, 1]

    def pulse(x: NDArray[np.float64], integrals: int) -> NDArray[np.float64]:
        """The pulse, its integral or its second integral from 0, x in [0, 1]."""
        angle = np.pi * np.multiply.outer(x, orders)
        rate = np.pi * orders
        terms = (np.sin(angle), (1.0 - np.cos(angle)) / rate, (angle - np.sin(angle)) / rate**2)[integrals]
        summed: NDArray[np.float64] = terms @ b
        return summed

    def folded(u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Both halves of the move as times within the pulse: the second one is the first backwards."""
        return np.where(u < 0.5, 2.0 * u, 2.0 * (1.0 - u))

    samples = np.linspace(0.0, 1.0, SAMPLES)
    first = np.abs(pulse(samples, 0))
    slope = np.abs(np.cos(np.pi * np.multiply.outer(samples, orders)) @ (np.pi * orders * b))
    return MoveShape(
        position=lambda u: np.where(u < 0.5, pulse(folded(u), 2), 1.0 - pulse(folded(u), 2)),
        velocity=lambda u: 2.0 * pulse(folded(u), 1),
        acceleration=lambda u: np.where(u < 0.5, 4.0, -4.0) * pulse(folded(u), 0),
        peak_velocity=2.0 * float(np.abs(pulse(samples, 1)).max()),
        peak_acceleration=4.0 * float(first.max()),
        peak_jerk=8.0 * float(slope.max()),
    )


def band_limited(
    distance: float,
    band: BandsLike,
    *,
    duration: float | None = None,
    maximum_speed: float | None = None,
    maximum_acceleration: float | None = None,
    maximum_jerk: float | None = None,
    terms: int = 3,
    dt: float,
    rest: float = 0.0,
    quantity: str = "position [m]",
) -> Command:
    """A move of two opposite pulses that have little power in a band of frequencies.

    Parameters
    ----------
    distance : float
        Where the move ends [m]; negative moves backwards, 0 is refused.
    band : Band or (low, high)
        What it spares [Hz].
    duration : float, optional
        [s]; about the shortest within the limits unless given (the form depends on it).
    maximum_speed, maximum_acceleration, maximum_jerk : float, optional
        Limits [m/s, m/s^2, m/s^3].
    terms : int
        Sines in the pulse, 1 to 6; with many the coefficients oscillate.
    dt, rest, quantity
        As for :func:`preshape.command.cycloidal`.

    Raises
    ------
    InputError
        As for :func:`preshape.command.cycloidal`.

    References
    ----------
    Aspinwall (1980), as quoted by Singer & Seering.

    Examples
    --------
    >>> move = band_limited(1.0, (0.8, 1.2), duration=3.0, dt=0.001)
    >>> round(float(move.values[1500]), 9), round(float(move.values[-1]), 9)
    (0.5, 1.0)
    """
    limits = Limits(maximum_speed, maximum_acceleration, maximum_jerk)
    size = nonzero("distance", distance, "m")
    (wanted,) = _one_band(band)
    time = shortest_of(lambda t: band_limited_shape(wanted, t, terms), size, limits) if duration is None else duration
    shape = band_limited_shape(wanted, time, terms)
    return shaped_move(shape, size, time, limits, dt=dt, rest=rest, quantity=quantity)


def _one_band(band: BandsLike) -> tuple[Band]:
    bands = bands_of(band)
    if len(bands) != 1:
        raise InputError(f"{len(bands)} bands were given where one is expected: give (low, high) in hertz.")
    return (bands[0],)
