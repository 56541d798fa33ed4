"""Modes and wishes in, a Shaper out; one family a file."""

from preshape.design.band import ei_for_band
from preshape.design.convolved import convolved
from preshape.design.derivative import zv, zvd, zvdd, zvdk
from preshape.design.direct import direct
from preshape.design.ei import ei, k_hump_ei, three_hump_ei, two_hump_ei
from preshape.design.families import CLOSED_FAMILIES, FAMILIES
from preshape.design.mzv import mzv
from preshape.design.on_grid import on_grid

__all__ = [
    "CLOSED_FAMILIES",
    "FAMILIES",
    "convolved",
    "direct",
    "ei",
    "ei_for_band",
    "k_hump_ei",
    "mzv",
    "on_grid",
    "three_hump_ei",
    "two_hump_ei",
    "zv",
    "zvd",
    "zvdd",
    "zvdk",
]
