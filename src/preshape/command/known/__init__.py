"""Commands known in advance: rescaled to the actuator's limit, made as fast as limits allow, started ahead of time."""

from preshape.command.known.advanced import Advanced, acceleration_error, advanced, late_samples, samples_ahead
from preshape.command.known.fastest_within import FastestWithin, fastest_within
from preshape.command.known.rescaled import Rescaled, rescaled
from preshape.command.known.through_samples import through_samples

__all__ = [
    "Advanced",
    "FastestWithin",
    "Rescaled",
    "acceleration_error",
    "advanced",
    "fastest_within",
    "late_samples",
    "rescaled",
    "samples_ahead",
    "through_samples",
]
