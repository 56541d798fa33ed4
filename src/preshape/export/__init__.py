"""From a shaper to somebody else's controller: one package or file a target."""

from preshape.export import klipper
from preshape.export.render import render
from preshape.export.target import Exported, Files, Limits, Placed, Target
from preshape.export.targets import TARGETS

__all__ = ["TARGETS", "Exported", "Files", "Limits", "Placed", "Target", "klipper", "render"]
