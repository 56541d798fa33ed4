"""Many designs and simulations: robustness, design maps, shaper tables; on the cores of one machine or a cluster."""

from preshape.campaign.campaign_file import CAMPAIGN_SCHEMA, Campaign, campaign_of, read_campaign
from preshape.campaign.kind import Column, Kind, Results, Told
from preshape.campaign.kinds import KINDS
from preshape.campaign.run import CampaignRun, run_campaign

__all__ = [
    "CAMPAIGN_SCHEMA",
    "KINDS",
    "Campaign",
    "CampaignRun",
    "Column",
    "Kind",
    "Results",
    "Told",
    "campaign_of",
    "read_campaign",
    "run_campaign",
]
