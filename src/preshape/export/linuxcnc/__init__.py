"""A HAL component for LinuxCNC."""

from preshape.export.linuxcnc.target import LINUXCNC

__all__ = ["LINUXCNC"]
