"""Unshaped commands, one kind a file, each returned as a :class:`Command`; moves from rest to rest, commands known in
advance and paths have folders of their own."""

from preshape.command.band_limited import band_limited
from preshape.command.bang_bang import bang_bang
from preshape.command.command import Command
from preshape.command.cycloidal import cycloidal
from preshape.command.filtered import low_pass_filtered, notch_filtered
from preshape.command.period_matched import period_matched
from preshape.command.posicast import posicast
from preshape.command.pulse import pulse
from preshape.command.ramped_sinusoid import ramped_sinusoid
from preshape.command.s_curve import s_curve
from preshape.command.step import step
from preshape.command.trapezoid import trapezoid
from preshape.command.versine import versine
from preshape.command.versine_force import versine_force

__all__ = [
    "Command",
    "band_limited",
    "bang_bang",
    "cycloidal",
    "low_pass_filtered",
    "notch_filtered",
    "period_matched",
    "posicast",
    "pulse",
    "ramped_sinusoid",
    "s_curve",
    "step",
    "trapezoid",
    "versine",
    "versine_force",
]
