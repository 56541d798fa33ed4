"""The shaper at work, sample by sample and block by block."""

from preshape.stream.schedule import Schedule
from preshape.stream.schedule_file import load_schedule, schedule_json
from preshape.stream.stream import Stream
from preshape.stream.tracking import Tracked

__all__ = ["Schedule", "Stream", "Tracked", "load_schedule", "schedule_json"]
