"""The paper's two- and three-impulse shapers as printed, and its conditions for any impulses.

The paper writes the response y = sum A_i exp(-sigma_i t) sin(m_i w t) as sin(w t) E(t) and asks that the components of
the impulses' phasors vanish at the last impulse. That is one condition on the sum of all modes, sum A_i m_i V_i = 0
with signed V_i: with different decay rates no single mode comes to rest. With spacing T = pi / w and

    M_k = sum A_i m_i exp(-k sigma_i T),    L_k = sum A_i m_i sigma_i exp(-k sigma_i T)

the two-impulse shaper (32), (34) is M_0 / M_1 : 1. Of the four conditions (35)-(38) for three impulses, (36) holds at
0, T, 2T; (35) is I_1 M_2 - I_2 M_1 + M_0 = 0; and (38), the derivative with the exponent included, is
2 I_1 L_2 = I_2 L_1. (With the exponent frozen (38) is empty; without damping it is empty too, and its limit
L_2 / L_1 = 1 gives the paper's 1 : 2 : 1.) Condition (37) then does not hold, which the conditions below show.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import nonzero, positive
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike

__all__ = ["PaperConditions", "checked_amplitudes", "paper_conditions", "three_impulses", "two_impulses"]

PRINTED = "the paper's {count}-impulse condition gives no positive impulses for these modes: use impulses='exact'."


@dataclass(frozen=True)
class PaperConditions:
    """Left sides of the paper's conditions; zero where one holds.

    Parameters
    ----------
    in_phase : float
        (35), and (30) for two impulses: sum I_k cos(w (t - t_k)) E(t - t_k), at the last impulse [-].
    quadrature : float
        (36), and (31) for two impulses: sum I_k sin(w (t - t_k)) E(t - t_k), at the last impulse [-].
    quadrature_slope : float
        (37), the derivative of `quadrature` by w [s].
    in_phase_slope : float
        (38), the derivative of `in_phase` by w [s].
    """

    in_phase: float
    quadrature: float
    quadrature_slope: float
    in_phase_slope: float


def two_impulses(
    modes: Modes, integers: Sequence[int], amplitudes: Sequence[float], spacing: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times [s] and amplitudes (relative to the last, as the paper has it) of (32) and (34)."""
    sums = [_sum(modes, integers, amplitudes, spacing, k) for k in range(2)]
    return _positive(spacing, [sums[0], sums[1]], "two")


def three_impulses(
    modes: Modes, integers: Sequence[int], amplitudes: Sequence[float], spacing: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times [s] and amplitudes of (35), (36) and (38) at 0, T and 2 T, T the spacing [s]."""
    m0, m1, m2 = (_sum(modes, integers, amplitudes, spacing, k) for k in range(3))
    rates = [a * mode.damping * mode.omega for a, mode in zip(amplitudes, modes, strict=True)]
    l1, l2 = (_sum(modes, integers, rates, spacing, k) for k in (1, 2))
    if all(mode.damping == 0.0 for mode in modes):
        l1 = l2 = 1.0
    # I_1 = M_0 / (2 M_1 L_2 / L_1 - M_2), I_2 = 2 I_1 L_2 / L_1, I_3 = 1, all multiplied by the denominator.
    return _positive(spacing, [m0 * l1, 2.0 * m0 * l2, 2.0 * m1 * l2 - m2 * l1], "three")


def paper_conditions(
    times: ArrayLike,
    amplitudes: ArrayLike,
    modes: ModesLike,
    common_frequency: float,
    integers: Sequence[int],
    mode_amplitudes: Sequence[float] | None = None,
) -> PaperConditions:
    """How well impulses satisfy the paper's conditions, the last impulse scaled to 1 as in the paper.

    Parameters
    ----------
    times, amplitudes : array_like, shape (impulse,)
        The impulses [s] and [-].
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]; of them the decay rates are used.
    common_frequency : float
        w / (2 pi), the common damped frequency [Hz].
    integers : sequence of int
        m_i, one a mode.
    mode_amplitudes : sequence of float, optional
        A_i, the amplitude of each mode in the response to an impulse [-]; all 1 unless given.

    Raises
    ------
    InputError
        If the numbers of modes, integers and amplitudes differ, or one is out of range.

    References
    ----------
    Singh & Heppler (1993), eq. 27-38.

    Examples
    --------
    >>> conditions = paper_conditions([0.0, 0.5], [0.5, 0.5], [(1.0, 0.0), (3.0, 0.0)], 1.0, [1, 3])
    >>> abs(conditions.in_phase) < 1e-12, abs(conditions.quadrature_slope) > 1.0
    (True, True)
    """
    wanted = Modes(modes)
    weights = checked_amplitudes(mode_amplitudes, len(wanted))
    if len(integers) != len(wanted):
        raise InputError(f"{len(integers)} integers for {len(wanted)} modes: give one a mode.")
    omega = 2.0 * np.pi * positive("common_frequency", common_frequency, "Hz")
    t, a = np.asarray(times, dtype=float), np.asarray(amplitudes, dtype=float)
    if t.ndim != 1 or t.shape != a.shape or t.size == 0 or a[-1] == 0.0:
        raise InputError("times and amplitudes must be flat lists of the same length, the last amplitude not zero.")
    left, phase = t[-1] - t, omega * (t[-1] - t)
    # E in the angle w t: sin(m x) / sin(x) = sum of cos((m - 1 - 2 j) x), which has no pole where sin(x) = 0.
    envelope, envelope_slope = np.zeros(t.size), np.zeros(t.size)
    for weight, m, mode in zip(weights, integers, wanted, strict=True):
        decay = mode.damping * mode.omega / omega
        order = np.arange(m - 1, -m, -2)[:, np.newaxis]
        kernel, kernel_slope = np.cos(order * phase).sum(axis=0), (-order * np.sin(order * phase)).sum(axis=0)
        share = weight * np.exp(-decay * phase)
        envelope += share * kernel
        envelope_slope += share * (kernel_slope - decay * kernel)
    cosine, sine = np.cos(phase), np.sin(phase)
    impulses = a / a[-1]
    return PaperConditions(
        in_phase=float(impulses @ (cosine * envelope)),
        quadrature=float(impulses @ (sine * envelope)),
        quadrature_slope=float((impulses * left) @ (cosine * envelope + sine * envelope_slope)),
        in_phase_slope=float((impulses * left) @ (cosine * envelope_slope - sine * envelope)),
    )


def checked_amplitudes(mode_amplitudes: Sequence[float] | None, count: int) -> list[float]:
    """A_i [-], one a mode, all 1 by default."""
    if mode_amplitudes is None:
        return [1.0] * count
    values = [nonzero("a mode's amplitude", value, "(relative)") for value in mode_amplitudes]
    if len(values) != count:
        raise InputError(f"{len(values)} mode amplitudes for {count} modes: give one a mode.")
    return values


def _sum(modes: Modes, integers: Sequence[int], weights: Sequence[float], spacing: float, k: int) -> float:
    """sum A_i m_i exp(-k sigma_i T)."""
    left = [np.exp(-k * mode.damping * mode.omega * spacing) for mode in modes]
    return float(sum(a * m * e for a, m, e in zip(weights, integers, left, strict=True)))


def _positive(
    spacing: float, amplitudes: Sequence[float], count: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    impulses = np.array(amplitudes)
    if impulses.sum() < 0.0:
        impulses = -impulses
    if not (impulses > 0.0).all():
        raise InputError(PRINTED.format(count=count))
    return spacing * np.arange(impulses.size, dtype=float), impulses / impulses[-1]
