"""The list of targets; adding one is adding a file and a line."""

from __future__ import annotations

from collections.abc import Iterable

from preshape.export.acs import ACS
from preshape.export.c import C
from preshape.export.fmu import FMU
from preshape.export.kalico import KALICO
from preshape.export.klipper.plugin import KLIPPER_PLUGIN
from preshape.export.klipper.settings import KLIPPER
from preshape.export.linuxcnc import LINUXCNC
from preshape.export.marlin import MARLIN, MARLIN_FT
from preshape.export.prusa import PRUSA
from preshape.export.python_control import PYTHON_CONTROL
from preshape.export.rrf import RRF
from preshape.export.settings_target import SettingsTarget
from preshape.export.st import ST
from preshape.export.table import CSV, JSON
from preshape.export.target import Target
from preshape.export.twincat import TWINCAT
from preshape.export.zaber import ZABER

__all__ = ["TARGETS"]


def _by_name(targets: Iterable[Target | SettingsTarget]) -> dict[str, Target | SettingsTarget]:
    return {target.name: target for target in targets}


TARGETS = _by_name(
    (
        C,
        LINUXCNC,
        ST,
        FMU,
        KLIPPER,
        KLIPPER_PLUGIN,
        KALICO,
        RRF,
        MARLIN,
        MARLIN_FT,
        PRUSA,
        ACS,
        TWINCAT,
        ZABER,
        PYTHON_CONTROL,
        CSV,
        JSON,
    )
)
"""Every target by the name that `preshape export` knows it by."""
