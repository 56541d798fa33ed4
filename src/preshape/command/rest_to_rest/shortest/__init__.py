"""The engine of time_optimal: the shortest move within limits, and the proof that it is."""

from preshape.command.rest_to_rest.shortest.motion import Motion
from preshape.command.rest_to_rest.shortest.problem import Problem
from preshape.command.rest_to_rest.shortest.search import PROVED, Found, shortest_move

__all__ = ["PROVED", "Found", "Motion", "Problem", "shortest_move"]
