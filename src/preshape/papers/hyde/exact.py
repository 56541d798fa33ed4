"""Hyde, sections 3.3 and 3.4.3: sequences without a mesh, their lengths and impulses, and where his solver failed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from preshape import Mode, Shaper, design
from preshape.papers.hyde.convolution import SHUTTLE, TWO
from preshape.papers.hyde.mesh import SHUTTLE_DT, Meshed
from preshape.papers.misprint import constraint, printed_zero
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, Because, beyond, claim, difference, number, shown
from preshape.plant import ModalPlant
from preshape.vibration import residual_vibration

__all__ = ["SOLVED", "Interpretation", "interpretation", "rows"]

SOLVED = 1e-9
"""Vibration left by a sequence that solves the equations."""

NEWTON = 1e-6
"""Two solutions of one Newton iteration or another whose times differ by less [s] are one."""

MESHES = (0.1, 0.02, 0.005)
"""Finer and finer meshes for the Shuttle arm [s]."""


@dataclass(frozen=True)
class Interpretation:
    """Figures 3.17 and 3.18: the interpreted sequence, and the exact one that Newton's method makes of it."""

    guess: Shaper
    solved: Shaper


def interpretation(sequence: Shaper) -> Interpretation:
    """Two-phase interpretation of a sequence of the mesh (figure 3.14), and the exact solution from it."""
    guess = design.interpreted(sequence, SHUTTLE_DT)
    return Interpretation(guess, design.solved_from(guess))


def rows(meshed: Meshed) -> list[Row]:
    """Every statement of the sections that can be checked."""
    steps = interpretation(meshed.shuttle)
    return [
        *_equations(),
        *_interpreted(meshed, steps),
        *_two_mode_rule(),
        *_limits(),
        *_symmetric(),
    ]


def _equations() -> list[Row]:
    """(3.1) and (3.2) as printed."""
    modes = [Mode(1.0, 0.1), Mode(10.0, 0.1)]
    singles, shaper = [design.zvd(mode) for mode in modes], design.convolved(modes)
    cases = []
    for i, mode in enumerate(modes):
        # The sum over a convolution is the product of the sums; over the mode's own shaper it is (1 - K)^2.
        cases.append(
            (shaper, mode, (1.0 - mode.decay_per_half_period) ** 2 * constraint(singles[1 - i], mode, sign=-1))
        )
    one = modes[0]
    four, k = design.zvdd(one), one.decay_per_half_period
    second = four.times[1] ** 2 * abs(3.0 * k**2 * (1.0 - k**2) * (1.0 - 3.0 * k**2)) / (1.0 + k) ** 3
    return [
        printed_zero("(3.1)", "the printed sums at 1 and 10 Hz for figure 3.5, z = 0.1", cases),
        printed_zero(
            "(3.2)",
            "the printed second-derivative sum for four impulses at 1 Hz, z = 0.1",
            [(four, one, second)],
            power=2,
            unit="s^2",
        ),
    ]


def _interpreted(meshed: Meshed, steps: Interpretation) -> list[Row]:
    guess, solved = steps.guess, steps.solved
    convolved, certified = design.convolved(SHUTTLE), design.direct(SHUTTLE)
    left = float(ModalPlant(SHUTTLE).impulse_residual(solved.times, solved.amplitudes).max())
    rough = float(residual_vibration(guess, [f for f, _ in SHUTTLE]).max())
    shift = difference(solved.times, guess.times)
    saved = 100.0 * (1.0 - solved.duration / convolved.duration)
    return [
        number("fig. 3.17", "two-phase interpretation: 2 m + 1 impulses", "9", float(len(guess)), digits=0),
        claim(
            "fig. 3.18",
            "exact solution from it: vibration left at the four modes",
            "exact",
            f"{shown(left) if left > SOLVED else '0'} (simulated); {100.0 * rough:.1f} % before",
            left < SOLVED < rough,
        ),
        claim(
            "fig. 3.17, 3.18",
            "guess and solution differ slightly: times of impulses",
            "slightly",
            f"by {1000.0 * shift:.0f} ms of {solved.duration:.2f} s at most",
            shift < 0.02 * solved.duration,
        ),
        claim(
            "fig. 3.18",
            "virtually the same length as figure 3.14",
            "10.70 s",
            f"{solved.duration:.4f} s against {meshed.shuttle.duration:.2f} s",
            abs(solved.duration - meshed.shuttle.duration) < 0.005 * meshed.shuttle.duration,
        ),
        number("fig. 3.18", "saving of 16 % retained", "16 %", saved, "%"),
        beyond(
            "fig. 3.18",
            "shortest positive sequence for the Shuttle arm, certified",
            f"{certified.duration:.8f} s, {len(certified)} impulses",
            certified.design.status == "optimal"
            and abs(certified.duration - 10.67402391) < 1e-8
            and len(certified) == 9,
            printed="10.70 s",
            note=f"The exact sequence found from figure 3.17 is within {shown(_apart(solved, certified))} s of it."
            if _apart(solved, certified) > NEWTON
            else "The exact sequence found from figure 3.17 is this one.",
        ),
    ]


def _two_mode_rule() -> list[Row]:
    ratios, wide = (1.2, 1.5, 2.0, 2.5, 3.0), (3.5, 4.0, 5.0, 10.0)
    near = [design.direct([(1.0, 0.0), (r, 0.0)]) for r in ratios]
    gap = max(abs(s.duration - 4.0 / (1.0 + r)) for s, r in zip(near, ratios, strict=True))
    far = [design.direct([(1.0, 0.0), (r, 0.0)]) for r in wide]
    left = max(
        float(ModalPlant([(1.0, 0.0), (r, 0.0)]).impulse_residual(s.times, s.amplitudes).max())
        for s, r in zip(far, wide, strict=True)
    )
    proved = all(s.design.status == "optimal" for s in [*near, *far])
    shortest = min(s.duration for s in [*near, *far])
    return [
        claim(
            "3.4.3.c",
            "length of two-mode sequences, f2/f1 = 1.2, 1.5, 2, 2.5, 3",
            "R = 4/(f1 + f2)",
            "R, proved shortest" if gap < 1e-7 and proved else f"off by {gap:.1e} s",
            gap < 1e-7 and proved,
            note="Found by the engine without the rule. Closed form: 1, -4c, 2 + 4c^2, -4c, 1 at multiples of R/4.",
        ),
        claim(
            "3.4.3.c",
            "f2 > 3 f1 (f2/f1 = 3.5, 4, 5, 10): no exact solution is found",
            "none found",
            ", ".join(f"{s.duration:.4f}" for s in far) + " s found",
            left > SOLVED,
            because=Because(
                "A limit of his five impulses, not of the problem: beyond 3 f1 positive impulses need another pattern. "
                "Ours leave no vibration and are proved shortest.",
                proved and left < SOLVED,
            ),
        ),
        claim(
            "3.4.3.c",
            "a sequence is at least as long as the period of the lowest mode (the nine cases above)",
            "at least 1/f1",
            f"shortest {shortest:.4f} of 1 s",
            proved and shortest >= 1.0 - 1e-9,
        ),
    ]


def _limits() -> list[Row]:
    ten = [(0.6 + 0.37 * i + 0.013 * i * i, 0.01) for i in range(10)]
    shaper = design.direct(ten)
    left = float(ModalPlant(ten).impulse_residual(shaper.times, shaper.amplitudes).max())
    exact = design.direct(SHUTTLE)
    fine = [design.mesh(SHUTTLE, dt, cost="second_derivative") for dt in MESHES]
    combined = [design.squashed(s, dt, keep_grid=False) for s, dt in zip(fine, MESHES, strict=True)]
    late = [s.duration - exact.duration for s in fine]
    away = [float(np.abs(np.subtract.outer(s.times, exact.times)).min(axis=1).max()) for s in combined]
    return [
        claim(
            "3.4.3.c",
            "exact sequences for up to five modes; here ten, 0.6 to 5 Hz, z = 0.01",
            "five at most",
            f"ten: {shaper.duration:.4f} s, {len(shaper)} impulses",
            left > SOLVED,
            because=Because(
                "A limit of his Newton search. Ours starts nearer, and is checked by simulation: nothing is left.",
                left < SOLVED and len(shaper) <= 41,
            ),
        ),
        claim(
            "3.4.3.c",
            "finer meshes (0.1, 0.02, 0.005 s) keep about 4 M impulses; second-derivative cost",
            "about 16",
            ", ".join(str(len(s)) for s in fine),
            all(abs(len(s) - 16) <= 3 for s in fine),
        ),
        claim(
            "3.4.3.c",
            "finer meshes come no nearer to the exact sequence: excess length, and distance of combined impulses",
            "no nearer",
            ", ".join(f"{1000.0 * s:.0f}" for s in late) + "; " + ", ".join(f"{1000.0 * s:.0f}" for s in away) + " ms",
            not (late[0] > late[1] > late[2] and away[0] > away[1] > away[2]),
            because=Because(
                "They do come nearer. What stays is their number: a pair of neighbours for each exact impulse, "
                f"{len(combined[-1])} after combining.",
                0.0 < late[2] < MESHES[2] and away[2] < 0.1 and len(combined[-1]) <= len(exact) + 1,
            ),
        ),
    ]


def _symmetric() -> list[Row]:
    closed = design.symmetric_two_modes([(1.0, 0.0), (2.0, 0.0)])
    direct = design.direct([(1.0, 0.0), (2.0, 0.0)])
    gap = difference(closed.times, direct.times) + difference(closed.amplitudes, direct.amplitudes)
    arm, damped = design.direct(SHUTTLE), design.direct([(f, 0.05) for f, _ in TWO])
    return [
        claim(
            "3.4.3.d",
            "symmetric sequences in closed form for two modes (1 and 2 Hz), against the direct solution",
            "exact",
            f"difference {shown(gap) if gap > 1e-7 else '0'}",
            len(closed) == len(direct) and gap < 1e-7,
        ),
        claim(
            "3.4.3.d",
            "many exact sequences are symmetric, not all: Shuttle arm; 1 and 10 Hz with z = 0.05",
            "many; not all",
            f"{'symmetric' if _lopsided(arm) < ROUNDING else 'not'}; off by {_lopsided(damped):.2f}",
            _lopsided(arm) < 1e-9 < 0.01 < _lopsided(damped),
        ),
    ]


def _apart(one: Shaper, other: Shaper) -> float:
    """Largest difference of impulse times [s]."""
    return difference(one.times, other.times)


def _lopsided(shaper: Shaper) -> float:
    """Largest difference between an amplitude and its mirror image [-]."""
    return difference(shaper.amplitudes, shaper.amplitudes[::-1])
