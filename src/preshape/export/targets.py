"""The list of targets; adding one is adding a file and a line."""

from __future__ import annotations

from preshape.export.c import C
from preshape.export.fmu import FMU
from preshape.export.linuxcnc import LINUXCNC
from preshape.export.st import ST
from preshape.export.target import Target

__all__ = ["TARGETS"]

TARGETS: dict[str, Target] = {
    target.name: target
    for target in (
        C,
        LINUXCNC,
        ST,
        FMU,
    )
}
