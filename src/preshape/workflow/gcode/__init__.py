"""G-code through shapers: read, planned, shaped, written again as short straight moves."""

from preshape.workflow.gcode.shape_gcode import ShapedGcode, shape_gcode

__all__ = ["ShapedGcode", "shape_gcode"]
