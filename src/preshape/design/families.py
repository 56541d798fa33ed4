"""The list of families: adding one is a file of its own and a line here; the laws in tests/laws.py then run on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from preshape.design.derivative import zv, zvd, zvdd, zvdk
from preshape.design.direct import direct
from preshape.design.ei import ei, k_hump_ei, three_hump_ei, two_hump_ei
from preshape.design.mzv import mzv
from preshape.design.partial_sum import ps_zv, ps_zvd
from preshape.design.specified_deflection import sd_zv
from preshape.design.specified_negative_amplitude import sna_zv
from preshape.design.unity_magnitude import um_ei, um_zv, um_zvd
from preshape.errors import InputError
from preshape.shaper import Shaper

__all__ = ["CLOSED_FAMILIES", "FAMILIES", "OTHER_FAMILIES", "family_named"]

CLOSED_FAMILIES: Mapping[str, Callable[..., Shaper]] = MappingProxyType(
    {
        "zv": zv,
        "zvd": zvd,
        "zvdd": zvdd,
        "zvdk": zvdk,
        "mzv": mzv,
        "ei": ei,
        "two_hump_ei": two_hump_ei,
        "three_hump_ei": three_hump_ei,
        "k_hump_ei": k_hump_ei,
        "um_zv": um_zv,
        "um_zvd": um_zvd,
        "um_ei": um_ei,
        "ps_zv": ps_zv,
        "ps_zvd": ps_zvd,
        "sna_zv": sna_zv,
        "sd_zv": sd_zv,
    }
)
"""One mode at a time; several modes by convolution."""

FAMILIES: Mapping[str, Callable[..., Shaper]] = MappingProxyType({**CLOSED_FAMILIES, "direct": direct})
"""Every family that takes modes and returns a shaper."""


OTHER_FAMILIES = ("convolved", "antiperiod", "mesh", "si")
"""What else ``preshape design --family`` takes: designs that are called in another way."""


def family_named(name: str) -> Callable[..., Shaper]:
    """The design function of a closed family; InputError naming the families there are."""
    try:
        return CLOSED_FAMILIES[name]
    except KeyError:
        raise InputError(f"there is no family {name!r}: choose one of {', '.join(CLOSED_FAMILIES)}.") from None
