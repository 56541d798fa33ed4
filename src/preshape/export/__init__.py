"""From a shaper to somebody else's controller: one package or file a target."""

from preshape.export import klipper
from preshape.export.configure import ExportedSettings
from preshape.export.frequency_response import frequency_response
from preshape.export.paste_ready import PasteText, paste_ready
from preshape.export.render import render
from preshape.export.settings_target import Configured, SettingsTarget, Written
from preshape.export.target import Exported, Files, Limits, Placed, Target
from preshape.export.targets import TARGETS

__all__ = [
    "TARGETS",
    "Configured",
    "Exported",
    "ExportedSettings",
    "Files",
    "Limits",
    "PasteText",
    "Placed",
    "SettingsTarget",
    "Target",
    "Written",
    "frequency_response",
    "klipper",
    "paste_ready",
    "render",
]
