"""What campaigns vary, one kind of machine a file."""

from preshape.campaign.machines.factors import drawn_factors
from preshape.campaign.machines.machine import Factors, Instance, Machine, Values
from preshape.campaign.machines.machine_list import NAMED_MACHINES, MachineSettings, machine_of

__all__ = [
    "NAMED_MACHINES",
    "Factors",
    "Instance",
    "Machine",
    "MachineSettings",
    "Values",
    "drawn_factors",
    "machine_of",
]
