"""Paths of several axes: shaped so that all are delayed alike, and how far they leave the curve they should follow."""

from preshape.command.path.contour import ContourError, contour_error
from preshape.command.path.shaped_path import ShapedPath, shaped_path
from preshape.command.path.shaped_trajectory import shaped_trajectory

__all__ = ["ContourError", "ShapedPath", "contour_error", "shaped_path", "shaped_trajectory"]
