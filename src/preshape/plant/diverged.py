"""Diverged: a simulation that ran away, with the time it happened and what was computed before."""

from __future__ import annotations

from preshape.errors import InputError
from preshape.plant.simulation import Simulation

__all__ = ["Diverged"]


class Diverged(InputError):
    """A plant ran away, or its equations could not be followed any further.

    Parameters
    ----------
    reason : str
        What happened, and what to do; the time is put before it.
    time : float
        When [s].
    partial : Simulation
        The samples before that time; there may be none.

    Examples
    --------
    >>> import numpy as np
    >>> partial = Simulation(np.zeros(0), np.zeros((1, 0)), {"angle": np.zeros(0)}, {"angle": "rad"})
    >>> str(Diverged("the angle is not finite: check the gains.", 1.5, partial))
    'diverged at 1.5 s: the angle is not finite: check the gains.'
    """

    def __init__(self, reason: str, time: float, partial: Simulation) -> None:
        super().__init__(f"diverged at {time:.6g} s: {reason}")
        self.reason = reason
        self.time = time
        self.partial = partial

    def __reduce__(self) -> tuple[type[Diverged], tuple[str, float, Simulation]]:
        return type(self), (self.reason, self.time, self.partial)
