"""A module for klippy/extras that gives Klipper any impulses."""

from preshape.export.klipper.plugin.target import PLUGIN

__all__ = ["PLUGIN"]
