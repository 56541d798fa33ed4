"""The shortest measure under convex constraints, and the certificate that it is."""

from preshape.engine.shortest import Shortest, shortest_positive
from preshape.engine.unresolved import convolved_positive
from preshape.engine.verify import is_proved_shortest

__all__ = ["Shortest", "convolved_positive", "is_proved_shortest", "shortest_positive"]
