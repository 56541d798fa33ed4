"""The [shaper] of a campaign file: which family for which modes; or a shaper that is there."""

from __future__ import annotations

import inspect
from typing import Annotated, Any

import msgspec

from preshape import design
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.shaper import Shaper

__all__ = ["ShaperWish"]

BANDS = "si"
"""Family that is designed for bands around the modes."""


class ShaperWish(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """Which shaper.

    Parameters
    ----------
    family : str
        A key of ``preshape.design.FAMILIES``, or "si".
    count : int, optional
        How many modes it is for, from the slowest; all unless given.
    order, humps, tolerance, negative_amplitude, deflection_ratio : optional
        As the family takes them.
    width : float, optional
        Of the bands of "si", as a part of each mode's frequency [-].
    given : mapping, optional
        The data of a shaper file, instead of a family.
    """

    family: str | None = None
    count: Annotated[int, msgspec.Meta(ge=1, le=100)] | None = None
    order: Annotated[int, msgspec.Meta(ge=0, le=6)] | None = None
    humps: Annotated[int, msgspec.Meta(ge=1, le=20)] | None = None
    tolerance: float | None = None
    negative_amplitude: float | None = None
    deflection_ratio: float | None = None
    width: float | None = None
    given: dict[str, Any] | None = None

    def check(self) -> None:
        """InputError when the family is unknown or does not take what is given."""
        if (self.family is None) == (self.given is None):
            raise InputError("[shaper] needs one of family and file: say which shaper.")
        if self.given is not None:
            if self._settings() or self.count is not None:
                raise InputError("shaper.file is a shaper as it is: leave out what a design would take.")
            return
        assert self.family is not None
        if self.family not in (*design.FAMILIES, BANDS):
            raise InputError(f"shaper.family is {self.family!r}: choose one of {', '.join([*design.FAMILIES, BANDS])}.")
        taken = {"tolerance", "width"} if self.family == BANDS else set(
            inspect.signature(design.FAMILIES[self.family]).parameters
        )  # fmt: skip
        for name in self._settings():
            if name not in taken:
                raise InputError(f"shaper.family {self.family} takes no {name}: leave it out.")
        if self.family == BANDS and self.width is None:
            raise InputError("shaper.family si needs width: give 0.2 for bands of 20 % around the modes.")

    def known(self, modes: Modes) -> Modes:
        """Those of the modes that it is for, the slowest first; InputError if there are too few."""
        ordered = sorted(modes, key=lambda mode: mode.frequency)
        if self.count is not None and len(ordered) < self.count:
            raise InputError(f"the machine has {len(ordered)} mode(s) here, and shaper.count asks for {self.count}.")
        return Modes(ordered[: self.count])

    def designed(self, modes: Modes) -> Shaper:
        """The shaper for these modes."""
        if self.given is not None:
            return Shaper.from_dict(self.given)
        wanted, settings = self.known(modes), self._settings()
        if self.family == BANDS:
            half = 0.5 * settings.pop("width")
            if not 0.0 < half < 1.0:
                raise InputError(f"shaper.width is {2.0 * half:g}: give a part of the frequency above 0 and below 2.")
            bands = [((1.0 - half) * m.frequency, (1.0 + half) * m.frequency, m.damping) for m in wanted]
            return design.specified_insensitivity(bands, **settings)
        assert self.family is not None
        return design.FAMILIES[self.family](wanted, **settings)

    def _settings(self) -> dict[str, Any]:
        names = ("order", "humps", "tolerance", "negative_amplitude", "deflection_ratio", "width")
        return {name: value for name in names if (value := getattr(self, name)) is not None}
