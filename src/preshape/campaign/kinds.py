"""The kinds of campaign there are, by their table in a campaign file. A new one is a file and a line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import msgspec

from preshape.campaign.design_map import DesignMap, DesignMapSettings
from preshape.campaign.kind import Kind
from preshape.campaign.machines import MachineSettings
from preshape.campaign.robustness import Robustness, RobustnessSettings
from preshape.campaign.schedule_table import ScheduleSettings, ScheduleTable
from preshape.campaign.wish import ShaperWish

__all__ = ["KINDS", "CampaignSettings"]


class CampaignSettings(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """A campaign file: a machine, a shaper, and one of the kinds.

    Parameters
    ----------
    machine : MachineSettings
        What varies.
    shaper : ShaperWish
        What is designed for it.
    robustness, map, schedule : optional
        What is computed.
    """

    machine: MachineSettings
    shaper: ShaperWish
    robustness: RobustnessSettings | None = None
    map: DesignMapSettings | None = None
    schedule: ScheduleSettings | None = None


KINDS: Mapping[str, Callable[..., Kind]] = MappingProxyType(
    {"robustness": Robustness, "map": DesignMap, "schedule": ScheduleTable}
)
"""Each takes its own settings, a machine and a shaper's wish. The order is that of the documentation."""
