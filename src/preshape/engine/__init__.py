"""The shortest measure under convex constraints, and the certificate that it is.

The way through the room: `constraints` say what is asked; `minimum` is the door that picks the way;

- zero vibration, positive impulses anywhere: `basis` (the functions) -> `projection` (how far from feasible) ->
  `shortest` (the search) -> `newton`, `repair` (the exact optimum) -> `certify`; `warm` starts from a known shaper,
  `unresolved` says what is left when doubles do not suffice;
- vibration tolerated in bands: `edges` (where it is largest) -> `tolerant_search` -> `tolerant`, `tolerant_newton`;
- a servo grid, limits of size, level or response: `programme` (Clarabel) -> `gridded`; the number of impulses: `fewest`
  (with `integers`, `windows`, `silence`), `limited`; second objectives: `choice`, `flattest`;
- `polynomial` is the separating polynomial of all of them, `verify` checks a proof that comes from elsewhere.
"""

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
