"""The shortest measure under convex constraints, and the certificate that it is."""

from preshape.engine.shortest import Shortest, shortest_positive
from preshape.engine.unresolved import convolved_positive

__all__ = ["Shortest", "convolved_positive", "shortest_positive"]
