"""What the API answers, for its description; the numbers are those of the workbench's plain data."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import BaseModel, Field

from preshape.studio.requests import WorkbenchModel

__all__ = [
    "DesignAnswer",
    "ExportAnswer",
    "FamiliesAnswer",
    "MeasurementAnswer",
    "Problem",
    "TargetsAnswer",
    "TradeOffAnswer",
    "VersionAnswer",
    "ViewAnswer",
]

Curve = list[float]
GappedCurve = list[float | None]


class Problem(BaseModel):
    """What is wrong, in a sentence."""

    detail: str


class ShaperAnswer(BaseModel):
    """A shaper, schema preshape/shaper/1 (docs/reference/shaper-file.md)."""

    schema_: Literal["preshape/shaper/1"] = Field(alias="schema")
    times: list[float] = Field(description="[s], increasing from 0.")
    amplitudes: list[float] = Field(description="[-]; they sum to 1, with the boxes' shares.")
    boxes: list[dict[str, float]] | None = Field(None, description="start [s], end [s], density [1/s].")
    duration: float = Field(description="[s]")
    design: dict[str, Any] = Field(description="Where it comes from: family, modes, settings, status, certificate.")


class AtMode(BaseModel):
    """What is left at a mode, and how far it may be off."""

    residual: float = Field(description="Residual vibration [-]: 0.05 is 5 % of the unshaped.")
    low: float = Field(description="From here [Hz] the residual stays within 5 % up to `high`.")
    high: float | None = Field(description="[Hz]; null if there is no end in sight.")


class DesignAnswer(BaseModel):
    """A design's shaper and what it leaves."""

    shaper: ShaperAnswer
    proved: bool = Field(description="Whether no shaper of its kind is shorter.")
    modes: list[AtMode]


class ResponseAnswer(BaseModel):
    """A motion, at the view's times."""

    command: Curve
    position: Curve
    deflection: Curve = Field(description="Position less command.")
    peak_deflection: float | None = Field(description="Over all time, between the samples too.")
    residual: float | None = Field(description="Largest amplitude that is left after the command.")
    end_time: float = Field(description="When the command ends [s].")


class DrawnAnswer(BaseModel):
    """A design that has a shaper."""

    times: list[float] = Field(description="Of the impulses [s].")
    amplitudes: list[float] = Field(description="[-]")
    boxes: list[list[float]] = Field(description="Start [s], end [s], density [1/s] of each.")
    duration: float = Field(description="[s]")
    status: str
    proved: bool
    vibration: Curve = Field(description="Residual [-] at the view's frequencies.")
    modes: list[AtMode]
    zeros: list[tuple[float, float, int]] = Field(description="Real and imaginary part [1/s], and order.")
    step: ResponseAnswer
    move: ResponseAnswer
    misfit: str = Field(description="Why the controller cannot hold it; empty if it can.")


class DesignViewAnswer(BaseModel):
    """A design, drawn or not."""

    name: str
    family: str
    trouble: str = Field(description="Why there is no shaper; empty if there is one.")
    drawn: DrawnAnswer | None


class ViewAnswer(BaseModel):
    """Everything that is drawn of a workbench."""

    workbench: WorkbenchModel
    link: str = Field(description="The workbench as text for a link: /?w=...")
    frequencies: Curve = Field(description="[Hz]")
    dampings: Curve = Field(description="[-], at each frequency.")
    poles: list[tuple[float, float]] = Field(description="Real and imaginary part [1/s].")
    step_times: Curve = Field(description="[s]")
    move_times: Curve = Field(description="[s]")
    unshaped_step: ResponseAnswer
    unshaped_move: ResponseAnswer
    designs: list[DesignViewAnswer]


class TradePointAnswer(BaseModel):
    """A shaper of the trade-off."""

    name: str
    duration: float = Field(description="[s]")
    left: float = Field(description="Largest residual of any mode [-] when every frequency is off by up to 5 %.")
    impulses: int
    proved: bool


class TradeOffAnswer(BaseModel):
    """Families, designs and the optimum."""

    families: list[TradePointAnswer]
    designs: list[TradePointAnswer]
    optimum: list[TradePointAnswer]
    remarks: list[str]


class FoundMode(BaseModel):
    """A mode that was found, with 95 % intervals."""

    frequency: float = Field(description="[Hz]")
    damping: float
    frequency_interval: list[float | None] = Field(description="[Hz]")
    damping_interval: list[float | None]
    share: float | None = Field(description="Part of the vibration's energy.")


class MeasurementAnswer(BaseModel):
    """A measurement's spectrum and its modes."""

    name: str
    format: str
    frequencies: Curve = Field(description="[Hz]")
    density: GappedCurve = Field(description="Power spectral density, summed over the channels, in `unit`.")
    fitted: GappedCurve = Field(description="The modes' own; null where nothing was fitted.")
    unit: str
    modes: list[FoundMode]
    method: str
    clear: bool = Field(description="Whether the modes can be trusted.")
    trouble: list[str]


class ExportedFile(BaseModel):
    """A file of an export."""

    name: str
    text: str | None = Field(description="Null if it is not text.")
    base64: str = Field(description="The file itself.")


class ExportAnswer(BaseModel):
    """What came out for a target."""

    files: list[ExportedFile]
    download: ExportedFile = Field(description="The only file, or a zip file of all.")
    duration: float = Field(description="Of what the controller will do [s].")
    notes: list[str]
    next_step: list[str]


class OptionAnswer(BaseModel):
    """A wish."""

    name: str
    kind: Literal["number", "whole", "choice", "flag"]
    summary: str
    choices: list[str]


class FamilyAnswer(BaseModel):
    """A family and the wishes it takes."""

    name: str
    options: list[str]
    needed: list[str] = Field(description="Wishes that it cannot do without.")


class FamiliesAnswer(BaseModel):
    """All families, and all wishes by their names."""

    families: list[FamilyAnswer]
    options: list[OptionAnswer]


class TargetAnswer(BaseModel):
    """A target of the export."""

    name: str
    summary: str
    versions: list[str]
    limits: list[str] = Field(description="What each version holds.")
    sampled: bool = Field(description="Whether it needs a sample rate.")
    precisions: list[str]
    axes: list[str]


class TargetsAnswer(BaseModel):
    """All targets."""

    targets: list[TargetAnswer]


class VersionAnswer(BaseModel):
    """Of this preshape."""

    version: str
    kernel: str
