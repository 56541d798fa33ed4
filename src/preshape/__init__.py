"""Commands that do not shake machines: the public names, re-exported; nothing else."""

from preshape import design, vibration
from preshape.band import Band
from preshape.mode import Mode, Modes
from preshape.profile import Profile
from preshape.provenance import Certificate, Design
from preshape.shaper import Shaper

__all__ = [
    "Band",
    "Certificate",
    "Design",
    "Mode",
    "Modes",
    "Profile",
    "Shaper",
    "design",
    "vibration",
]
