"""Direct multi-mode shapers: the shortest positive impulses with zero vibration at all modes, proved shortest.

Hyde (ch. 3) solved the zero-vibration equations of all modes at once instead of convolving a shaper a mode, and saved
16-25 % of the duration, without knowing whether a shorter one exists. The engine finds the shortest and proves it.
"""

from __future__ import annotations

from collections.abc import Iterable

from preshape.checks import whole_number
from preshape.design.each_mode import recorded
from preshape.design.symmetric import symmetric_two_modes
from preshape.engine import (
    Shortest,
    convolved_positive,
    preferred,
    shortest_from,
    shortest_near,
    shortest_positive,
)
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.provenance import Certificate, Design
from preshape.shaper import Shaper

__all__ = ["direct", "direct_near"]

HIGHEST_ORDER = 6

DISTINCT, REACH = 1.01, 2.99
"""Ratios of two frequencies between which the symmetric closed form is taken; at 1 and 3 its equations degenerate."""


def direct(
    modes: ModesLike, order: int | Iterable[int] = 1, *, near: Shaper | None = None, prefer: str | None = None
) -> Shaper:
    """The shortest positive shaper with zero vibration, and `order` vanishing derivatives, at every mode.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-].
    order : int or one a mode
        0: zero vibration only (as ZV), 1: and zero slope (as ZVD, Hyde's choice), 2: as ZVDD ...
    near : Shaper, optional
        A direct shaper for modes that were nearly these, in the same order: Newton's method alone from there, verified,
        in half a millisecond. Where that fails the full search follows; ``design.settings["start"]`` says "near" or
        "full".
    prefer : str, optional
        Which of several equally short shapers: "flattest" (least next derivative, Hyde 3.2) or "fewest" impulses.

    Returns
    -------
    Shaper
        ``design.status`` is "optimal" with ``design.certificate`` proving that no positive shaper is shorter, or
        "feasible" when the proof did not succeed: the constraints hold all the same, and ``design.settings["gap"]`` is
        the fraction of the duration that a shorter one could save at most.

    Raises
    ------
    InputError
        If a mode or an order is out of range.

    References
    ----------
    Hyde, chapter 3; the optimality system is in the engine's documentation.

    Examples
    --------
    >>> shaper = direct([(0.20, 0.0), (0.26, 0.0), (0.45, 0.0), (0.59, 0.0)])
    >>> round(shaper.duration, 6), len(shaper), shaper.design.status
    (10.674024, 9, 'optimal')
    """
    wanted = Modes(modes)
    given = [order] * len(wanted) if isinstance(order, int) else list(order)
    if len(given) != len(wanted):
        raise InputError(f"{len(given)} orders for {len(wanted)} modes: give one number, or one a mode.")
    orders = tuple(whole_number("order", value, 0, HIGHEST_ORDER) for value in given)
    settings: dict[str, object] = {"order": _short(orders)}
    found = None
    if near is not None:
        _proof_of(near, wanted)
        found = shortest_near(wanted, orders, near)
        settings["start"] = "full" if found is None else "near"
    closed_form = None if found is not None else _closed_form(wanted, orders)
    if closed_form is not None:
        found = shortest_from(wanted, orders, closed_form)
    if found is None:
        found = shortest_positive(wanted, orders)
    return _recorded(found, wanted, settings, prefer)


def direct_near(near: Shaper, modes: ModesLike) -> Shaper | None:
    """The direct shaper for modes that have moved a little, by Newton's method alone: bounded work, no search.

    Parameters
    ----------
    near : Shaper
        A direct shaper for as many modes, in the same order; its orders and its preference are kept.
    modes : Mode, (frequency, damping) or several
        The modes now: natural frequencies [Hz], damping ratios [-].

    Returns
    -------
    Shaper or None
        Proved shortest as any other; None when Newton's method does not lead to it, as where impulses appear, vanish or
        merge: then ``direct(modes, order, near=near)`` searches.

    Raises
    ------
    InputError
        If `near` has no certificate for modes, is for another number of them, or a mode is out of range.

    Examples
    --------
    >>> shaper = direct([(1.0, 0.0), (2.7, 0.01)])
    >>> moved = direct_near(shaper, [(1.001, 0.0), (2.703, 0.01)])
    >>> moved.design.status, moved.design.settings["start"]
    ('optimal', 'near')
    """
    wanted = Modes(modes)
    orders = _proof_of(near, wanted).orders
    found = shortest_near(wanted, orders, near)
    if found is None:
        return None
    return _recorded(found, wanted, {"order": _short(orders), "start": "near"}, near.design.settings.get("prefer"))


def _short(orders: tuple[int, ...]) -> int | list[int]:
    return orders[0] if len(set(orders)) == 1 else list(orders)


def _recorded(found: Shortest, modes: Modes, settings: dict[str, object], prefer: str | None) -> Shaper:
    """The shaper with what is known of it."""
    if prefer is not None:
        found = preferred(found, prefer)
        settings["prefer"] = prefer
    if found.certificate is None:
        settings["gap"] = found.gap
    status = "feasible" if found.certificate is None else "optimal"
    shaper = Shaper.normalised(found.times, found.amplitudes)
    return recorded(shaper, Design("direct", modes, settings, status, certificate=found.certificate))


def _closed_form(modes: Modes, orders: tuple[int, ...]) -> Shaper | None:
    """What is known to be the shortest without a search, still to be proved: one mode; two that are near enough."""
    if len(modes) == 1:
        return convolved_positive(modes, orders)
    if len(modes) == 2 and orders in ((0, 0), (1, 1)) and modes[0].damping == modes[1].damping == 0.0:
        low, high = sorted(mode.frequency for mode in modes)
        if DISTINCT * low <= high < REACH * low:
            return symmetric_two_modes(modes, orders[0])
    return None


def _proof_of(near: Shaper, modes: Modes) -> Certificate:
    """The certificate of a shaper that Newton's method can start from, or a clear refusal."""
    proof = near.design.certificate if isinstance(near, Shaper) else None
    if proof is None or proof.modes is None:
        raise InputError(f"near is {near!r}, without a certificate for modes: give a shaper of design.direct.")
    if len(proof.modes) != len(modes):
        raise InputError(f"near was designed for {len(proof.modes)} modes, not {len(modes)}: give one for as many.")
    return proof
