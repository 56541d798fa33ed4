"""FMI 3.0: a co-simulation unit with the kernel's own source, for simulation tools."""

from preshape.export.fmu.target import FMU

__all__ = ["FMU"]
