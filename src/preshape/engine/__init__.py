"""The shortest measure under convex constraints, and the certificate that it is."""

from preshape.engine.shortest import Shortest, shortest_positive

__all__ = ["Shortest", "shortest_positive"]
