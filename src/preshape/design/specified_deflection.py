"""SD-ZV: zero vibration, and while moving no more than a given part of the deflection that an unshaped start causes.

d'' + 2 z w d' + w^2 d = r'' is the deflection of a payload behind its trolley, of an arm behind its drive. Setting
off at speed v it peaks at (v/w) exp(-s phi); s = z/sqrt(1 - z^2), cos(phi) = z. The first impulse R starts a wave of R
times that peak; each further one comes when the wave falls, and lifts it onto the path of a new wave of the same
height; the last one, K R, meets the zero of the last wave and stops it. With tau = m + e the phase of the falling wave
and v = m - e that of the new one, lifting by q asks  exp((-s + i) v) - exp((-s + i) tau) = q / R,  that is
  m = arg sinh((s + i) e),   2 |sinh((s + i) e)| = exp(s m) q / R.
Infinitely many, infinitely small lifts are a box that holds the deflection at its limit: the shortest of all.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from numbers import Real
from typing import Literal

from preshape.design.each_mode import convolve_each, recorded
from preshape.engine import ImpulsesBetween, ServoGrid, ZeroVibration, deflection_at_most, minimum_duration
from preshape.errors import InputError
from preshape.mode import Mode, Modes, ModesLike
from preshape.provenance import Design
from preshape.shaper import Shaper
from preshape.vibration import deflection_ratio as measured_ratio

__all__ = ["sd_zv"]

Form = Literal["impulses", "box"]

ROUNDING = 1e-12
"""A ratio this close to one where a wave fewer suffices, relatively, is that one."""

MOST_WAVES = 1000
"""More impulses than this are a box in all but name."""

LOOKS_PER_PERIOD = 150
"""How often in a period of a mode the deflection is looked at on a grid: between two looks it can bulge by a part of
2e-4, by which the limit is lowered first."""


def sd_zv(modes: ModesLike, deflection_ratio: float, form: Form = "impulses", *, dt: float | None = None) -> Shaper:
    """Zero vibration, with the deflection while moving at most a part of that of an unshaped start.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]. For several modes the shapers are convolved, which never raises the
        deflection of one of them; with `dt` the shortest for all of them together is found.
    deflection_ratio : float
        R [-]: peak deflection after a step of speed, relative to the unshaped peak; of one mode, after a step of
        position too. Above 0, and up to 1/(1 + K), which zero vibration (ZV) has by itself. Other commands may bend it
        further: steady acceleration holds the static deflection whatever the shaper; for a known command take
        :func:`deflection_limited`.
    form : {"impulses", "box"}
        ``"impulses"``: n + 1 of them, n the least whole number of at least 1/(R (1 + K)). ``"box"``: two impulses with
        a part of constant density between them, the shortest there is; for one mode.
    dt : float, optional
        Servo period [s]: impulses at its multiples only, the fewest periods that do it, found by the engine. With it
        `form` stays what it is by default.

    Returns
    -------
    Shaper
        ``design.settings["deflection_ratio"]`` is R, ``["ratio_range"]`` the ratios that so many impulses can have
        (for several modes: that all of them can have), ``["deflection_reached"]`` the exact peak of each mode.

    Raises
    ------
    InputError
        If R is at or below 0, or above 1/(1 + K) of a mode, where there is nothing to limit; or if `dt` is too coarse,
        or a box is asked for where none is possible.

    References
    ----------
    Robertson, section III; the closed forms are derived from its description, the box is the limit of many impulses.

    Examples
    --------
    >>> shaper = sd_zv((1.0, 0.1), 0.4)
    >>> shaper.times.round(5).tolist(), shaper.amplitudes.round(6).tolist()
    ([0.0, 0.3101, 0.64994], [0.4, 0.308301, 0.291699])
    >>> round(sd_zv((1.0, 0.0), 0.3, form="box").duration, 4)
    0.7122
    """
    wanted = Modes(modes)
    ratio = _ratio_of(deflection_ratio, wanted)
    if form not in ("impulses", "box"):
        raise InputError(f"form is {form!r}: give 'impulses' or 'box'.")
    if form == "box" and (dt is not None or len(wanted) > 1):
        raise InputError(
            "a box is for one mode and no sample grid: leave form out, and give dt for the shortest shaper on a grid."
        )
    settings: dict[str, object] = {"deflection_ratio": ratio, "form": form}
    if dt is not None:
        return _reached(_on_grid(wanted, ratio, dt, {**settings, "form": "grid"}))
    if form == "box":
        settings["ratio_range"] = [0.0, _highest(wanted[0])]
        return _reached(recorded(_box(wanted[0], ratio), Design("sd_zv", wanted, settings, "exact")))
    ranges = [_range(mode, _waves(mode, ratio)) for mode in wanted]
    settings["ratio_range"] = [max(low for low, _ in ranges), min(high for _, high in ranges)]
    return _reached(convolve_each(wanted, "sd_zv", lambda mode: _impulses(mode, ratio), settings))


def _ratio_of(value: object, modes: Modes) -> float:
    """The ratio, if it is above 0 and no more than what ZV has."""
    number = math.nan if isinstance(value, bool) or not isinstance(value, Real) else float(value)
    if not 0.0 < number < math.inf:
        raise InputError(
            f"deflection_ratio is {value!r}: give a part of the unshaped deflection above 0, such as 0.4; at 0 nothing "
            "could move."
        )
    for mode in modes:
        if number > _highest(mode) * (1.0 + ROUNDING):
            raise InputError(
                f"deflection_ratio is {number:g}, but no limiting is needed at {mode}: zero vibration (zv) has "
                f"{_highest(mode):.6g} by itself, so use zv, or give a ratio up to that."
            )
    return number


def _highest(mode: Mode) -> float:
    """1/(1 + K), the ratio of ZV."""
    return 1.0 / (1.0 + mode.decay_per_half_period)


def _waves(mode: Mode, ratio: float) -> int:
    """n, how many waves of deflection of this height it takes."""
    count = math.ceil(_highest(mode) / ratio * (1.0 - ROUNDING))
    if count > MOST_WAVES:
        raise InputError(
            f"deflection_ratio {ratio:g} takes {count} impulses: use form='box', which is what so many amount to."
        )
    return max(1, count)


def _range(mode: Mode, waves: int) -> tuple[float, float]:
    """The ratios that n waves can have."""
    return _highest(mode) / waves, _highest(mode) / max(1, waves - 1)


def _impulses(mode: Mode, ratio: float) -> Shaper:
    """n + 1 impulses: R, n - 1 equal ones, K R."""
    waves, kept = _waves(mode, ratio), mode.decay_per_half_period
    if waves == 1:
        return Shaper([0.0, mode.damped_period / 2.0], [_highest(mode), kept * _highest(mode)])
    lift = (1.0 - (1.0 + kept) * ratio) / (waves - 1)
    middle, half = _phases(mode, lift / ratio)
    phases = [middle + (2 * k + 1) * half for k in range(waves - 1)]
    # The last lift leaves the wave at phase middle - half; it is zero at pi.
    phases.append(phases[-1] + math.pi - (middle - half))
    times = [0.0, *(phase / mode.omega_d for phase in phases)]
    return Shaper.normalised(times, [ratio, *[lift] * (waves - 1), kept * ratio])


def _phases(mode: Mode, lift: float) -> tuple[float, float]:
    """m and e of a lift by q / R."""
    from scipy.optimize import brentq

    turn = complex(mode.damping / math.sqrt(1.0 - mode.damping**2), 1.0)

    def missing(half: float) -> float:
        lifted = cmath.sinh(turn * half)
        return 2.0 * abs(lifted) - lift * math.exp(turn.real * cmath.phase(lifted))

    # At pi/2 a lift is from the end of a wave to the start of the next, the largest: q / R = 1 + K.
    end = math.pi / 2.0
    half = end if missing(end) <= 0.0 else brentq(missing, 0.0, end, xtol=1e-16, rtol=8.9e-16)
    lifted = cmath.sinh(turn * half)
    return (cmath.phase(lifted), half) if half > 0.0 else (math.acos(mode.damping), 0.0)


def _box(mode: Mode, ratio: float) -> Shaper:
    """R at once; when the deflection peaks, a density that holds it there; K R half a period after R and the hold."""
    kept, peak = mode.decay_per_half_period, math.acos(mode.damping)
    density = mode.omega * ratio * math.exp(-mode.damping / math.sqrt(1.0 - mode.damping**2) * peak)
    held = (1.0 - (1.0 + kept) * ratio) / density
    begin, end = peak / mode.omega_d, mode.damped_period / 2.0
    if held <= ROUNDING * end:
        return Shaper([0.0, end], [_highest(mode), kept * _highest(mode)])
    return Shaper.normalised([0.0, end + held], [ratio, kept * ratio], boxes=[(begin, begin + held, density)])


def _on_grid(modes: Modes, ratio: float, dt: float, settings: dict[str, object]) -> Shaper:
    """The shortest with impulses at multiples of dt, for all modes together."""
    grid = ServoGrid(dt)
    limits = []
    for mode in modes:
        looks = max(1, math.ceil(dt * LOOKS_PER_PERIOD / mode.damped_period))
        # Between two looks, and no impulse, a free wave rises above both by no more than 1 / cos of half the angle.
        room = math.cos(mode.omega * dt / looks / 2.0)
        limits.append(deflection_at_most(mode, ratio * room, dt / looks))
    found = minimum_duration([*(ZeroVibration(mode) for mode in modes), ImpulsesBetween(0.0, 1.0), *limits, grid])
    if found.status == "infeasible":
        raise InputError(found.reason)
    settings |= {"dt": dt, "ratio_range": [0.0, min(_highest(mode) for mode in modes)]}
    if found.status == "optimal":
        settings["proved"] = "on this grid, fewer periods cannot keep this ratio less a part of 2e-4"
    design = Design("sd_zv", modes, settings, found.status)
    return recorded(Shaper.normalised(found.times, found.amplitudes), design)


def _reached(shaper: Shaper) -> Shaper:
    """The shaper, with the exact peak of each mode in its settings."""
    modes: Sequence[Mode] = shaper.design.modes or ()
    peaks = [measured_ratio(shaper, mode) for mode in modes]
    return shaper.with_design(replace(shaper.design, settings={**shaper.design.settings, "deflection_reached": peaks}))
