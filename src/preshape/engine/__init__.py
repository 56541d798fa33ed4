"""The shortest measure under convex constraints, and the certificate that it is."""

from preshape.engine.choice import preferred
from preshape.engine.constraints import (
    AtMostImpulses,
    Constraint,
    ImpulsesBetween,
    PartialSumsBetween,
    ResponseBetween,
    ServoGrid,
    VibrationAtMost,
    ZeroVibration,
    deflection_at_most,
)
from preshape.engine.edges import edges_of, largest_vibration
from preshape.engine.minimum import Outcome, minimum_duration
from preshape.engine.shortest import Shortest, shortest_positive
from preshape.engine.unresolved import convolved_positive
from preshape.engine.verify import is_proved_shortest
from preshape.engine.warm import shortest_from, shortest_near

__all__ = [
    "AtMostImpulses",
    "Constraint",
    "ImpulsesBetween",
    "Outcome",
    "PartialSumsBetween",
    "ResponseBetween",
    "ServoGrid",
    "Shortest",
    "VibrationAtMost",
    "ZeroVibration",
    "convolved_positive",
    "deflection_at_most",
    "edges_of",
    "is_proved_shortest",
    "largest_vibration",
    "minimum_duration",
    "preferred",
    "shortest_from",
    "shortest_near",
    "shortest_positive",
]
