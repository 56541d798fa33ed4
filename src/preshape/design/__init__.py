"""Modes and wishes in, a Shaper out; one family a file."""

from preshape.design.antiperiod import AntiperiodAnalysis, antiperiod, antiperiod_analysis
from preshape.design.asked import ASKED_FAMILIES, designed, needed_by, taken_by
from preshape.design.band import ei_for_band
from preshape.design.convolved import convolved
from preshape.design.deflection_limited import deflection_limited
from preshape.design.derivative import zv, zvd, zvdd, zvdk
from preshape.design.direct import direct, direct_near
from preshape.design.ei import ei, k_hump_ei, three_hump_ei, two_hump_ei
from preshape.design.families import CLOSED_FAMILIES, FAMILIES
from preshape.design.mesh import interpreted, mesh, rounded, solved_from, squashed
from preshape.design.mzv import mzv
from preshape.design.on_grid import on_grid
from preshape.design.options import OPTIONS, Option
from preshape.design.partial_sum import ps_zv, ps_zvd
from preshape.design.specified_deflection import sd_zv
from preshape.design.specified_insensitivity import bands_of_sets, specified_insensitivity
from preshape.design.specified_negative_amplitude import sna_zv
from preshape.design.symmetric import symmetric_three_modes, symmetric_two_modes
from preshape.design.synchronised import delayed, synchronised
from preshape.design.unity_magnitude import um_ei, um_zv, um_zvd

__all__ = [
    "ASKED_FAMILIES",
    "CLOSED_FAMILIES",
    "FAMILIES",
    "OPTIONS",
    "AntiperiodAnalysis",
    "Option",
    "antiperiod",
    "antiperiod_analysis",
    "bands_of_sets",
    "convolved",
    "deflection_limited",
    "delayed",
    "designed",
    "direct",
    "direct_near",
    "ei",
    "ei_for_band",
    "interpreted",
    "k_hump_ei",
    "mesh",
    "mzv",
    "needed_by",
    "on_grid",
    "ps_zv",
    "ps_zvd",
    "rounded",
    "sd_zv",
    "sna_zv",
    "solved_from",
    "specified_insensitivity",
    "squashed",
    "symmetric_three_modes",
    "symmetric_two_modes",
    "synchronised",
    "taken_by",
    "three_hump_ei",
    "two_hump_ei",
    "um_ei",
    "um_zv",
    "um_zvd",
    "zv",
    "zvd",
    "zvdd",
    "zvdk",
]
