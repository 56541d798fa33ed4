"""Impulses on a controller's servo grid: Hyde's way (chapter 3.4), complete, and what he wanted and could not."""

from preshape.design.mesh.exact import solved_from
from preshape.design.mesh.interpret import interpreted
from preshape.design.mesh.mesh import mesh
from preshape.design.mesh.rounding import rounded
from preshape.design.mesh.squash import squashed

__all__ = ["interpreted", "mesh", "rounded", "solved_from", "squashed"]
