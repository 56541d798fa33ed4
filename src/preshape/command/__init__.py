"""Unshaped commands, one kind a file, each returned as a :class:`Command`."""

from preshape.command.command import Command
from preshape.command.pulse import pulse
from preshape.command.s_curve import s_curve
from preshape.command.step import step
from preshape.command.trapezoid import trapezoid

__all__ = ["Command", "pulse", "s_curve", "step", "trapezoid"]
