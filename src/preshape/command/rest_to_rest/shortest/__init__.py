"""The engine of time_optimal: the shortest move within limits, and the proof that it is."""

from preshape.command.rest_to_rest.shortest.motion import Motion
from preshape.command.rest_to_rest.shortest.polish import polish
from preshape.command.rest_to_rest.shortest.problem import Problem
from preshape.command.rest_to_rest.shortest.search import PROVED, Found, shortest_move
from preshape.command.rest_to_rest.shortest.structure import Arc, Structure

__all__ = ["PROVED", "Arc", "Found", "Motion", "Problem", "Structure", "polish", "shortest_move"]
