"""Shapers that use the antiperiod of several modes: one delay after which every mode is its own negative."""

from preshape.design.antiperiod.analysis import AntiperiodAnalysis, antiperiod_analysis
from preshape.design.antiperiod.common_frequency import CommonFrequency, common_frequency
from preshape.design.antiperiod.existence import all_odd, diophantine_divisors
from preshape.design.antiperiod.printed import PaperConditions, paper_conditions
from preshape.design.antiperiod.shaper import antiperiod

__all__ = [
    "AntiperiodAnalysis",
    "CommonFrequency",
    "PaperConditions",
    "all_odd",
    "antiperiod",
    "antiperiod_analysis",
    "common_frequency",
    "diophantine_divisors",
    "paper_conditions",
]
