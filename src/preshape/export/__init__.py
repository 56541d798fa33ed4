"""From a shaper to somebody else's controller: one package or file a target."""

from preshape.export import klipper

__all__ = ["klipper"]
