"""From a shaper to somebody else's controller: one package or file a target."""

from preshape.export import klipper
from preshape.export.configure import ExportedSettings
from preshape.export.frequency_response import frequency_response
from preshape.export.paste_ready import PasteText, paste_ready
from preshape.export.render import render
from preshape.export.settings_target import Configured, Settings, SettingsTarget, Written
from preshape.export.target import AnyTarget, Exported, Files, Limits, Placed, Taps, Target
from preshape.export.targets import TARGETS

__all__ = [
    "TARGETS",
    "AnyTarget",
    "Configured",
    "Exported",
    "ExportedSettings",
    "Files",
    "Limits",
    "PasteText",
    "Placed",
    "Settings",
    "SettingsTarget",
    "Taps",
    "Target",
    "Written",
    "frequency_response",
    "klipper",
    "paste_ready",
    "render",
]
