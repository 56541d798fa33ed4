"""What a report was made from: the job and its options, the inputs themselves, versions; schema ``preshape/report/1``.

It is plain data. What is read from a report is checked against these types and never evaluated.
"""

from __future__ import annotations

from typing import Any

import msgspec

from preshape.shaper import Shaper

__all__ = ["REPORT_SCHEMA", "CalibrationJob", "DesignJob", "GivenJob", "Job", "Record", "RecordedFile"]

REPORT_SCHEMA = "preshape/report/1"


class _Strict(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Fields that are not known are refused."""


class RecordedFile(_Strict, frozen=True):
    """An input.

    Attributes
    ----------
    name : str
        Without its folder.
    size : int
        Bytes.
    sha256 : str
        Of the bytes, in hexadecimal digits.
    packed : bytes or None
        The bytes, compressed by zlib; None of a file that is too large to travel in a report.
    """

    name: str
    size: int
    sha256: str
    packed: bytes | None


class CalibrationJob(_Strict, frozen=True, tag="calibrate", tag_field="job"):
    """The options of :func:`preshape.workflow.calibrate`."""

    maximum_impulses: int | None = None
    tolerance: float = 0.05
    damping: float | None = None
    sample_rate: float | None = None
    part: str | None = None
    excitation: str | None = None
    mixed: bool = False
    axis: str | None = None


class DesignJob(_Strict, frozen=True, tag="design", tag_field="job"):
    """The options of ``preshape design``; None where they were not given."""

    family: str
    modes: tuple[tuple[float, float], ...] = ()
    bands: tuple[tuple[float, float, float, float], ...] = ()
    dt: float | None = None
    tolerance: float | None = None
    order: int | None = None
    humps: int | None = None
    negative_amplitude: float | None = None
    deflection_ratio: float | None = None
    form: str | None = None
    base: str | None = None
    impulses: str | None = None
    frequency_tolerance: float | None = None
    damping: float | None = None
    duration: float | None = None
    cost: str | None = None
    fewest: bool | None = None
    at_most: int | None = None
    prefer: str | None = None


class GivenJob(_Strict, frozen=True, tag="given", tag_field="job"):
    """A shaper that was handed over as it is: there is nothing to run again."""


Job = CalibrationJob | DesignJob | GivenJob


class Record(_Strict, frozen=True):
    """What a report was made from.

    Attributes
    ----------
    schema : str
        "preshape/report/1".
    job : CalibrationJob, DesignJob or GivenJob
        What was done.
    command_line : str
        As it was typed; empty when it was not the command line.
    made : str
        When, UTC: "2026-11-25T13:00:17Z".
    versions : dict of str to str
        Of preshape, Python and what it computes with.
    inputs : tuple of RecordedFile
        In the order given.
    shaper : dict
        The outcome, in the schema preshape/shaper/1.
    """

    job: Job
    command_line: str
    made: str
    versions: dict[str, str]
    inputs: tuple[RecordedFile, ...]
    shaper: dict[str, Any]
    schema: str = REPORT_SCHEMA

    def json(self) -> str:
        """As JSON, the packed inputs in base64."""
        return msgspec.json.encode(self).decode()

    def found(self) -> Shaper:
        """The shaper; InputError if it is none."""
        return Shaper.from_dict(self.shaper)
