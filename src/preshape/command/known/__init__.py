"""Commands known in advance: rescaled to the actuator's limit, made as fast as limits allow, started ahead of time."""

from preshape.command.known.advanced import Advanced, acceleration_error, advanced
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
    "rescaled",
    "through_samples",
]
