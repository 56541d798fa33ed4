"""A module for klippy/extras that gives Klipper any impulses."""

from preshape.export.klipper.plugin.target import KLIPPER_PLUGIN

__all__ = ["KLIPPER_PLUGIN"]
