"""Singh & Heppler, ASME Journal of Dynamic Systems, Measurement, and Control 115 (1993)."""

from preshape.papers.singh.paper import SINGH

__all__ = ["SINGH"]
