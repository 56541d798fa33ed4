"""What the API is asked, with limits: everything else is refused before anything is computed."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StrictBool, StrictFloat, StrictInt, StrictStr

from preshape.band import Band
from preshape.errors import InputError
from preshape.mode import Mode, Modes
from preshape.shaper import Shaper
from preshape.workflow.workbench import MOST_MODES, AskedDesign, Workbench, from_plain
from preshape.workflow.workbench.solve import MOST_IMPULSES
from preshape.workflow.workbench.state import HIGHEST_FREQUENCY, LOWEST_FREQUENCY, MOST_BANDS

__all__ = ["DesignRequest", "ExportRequest", "ReportRequest", "ShaperModel", "WorkbenchModel"]

Number = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Frequency = Annotated[
    float,
    Field(ge=LOWEST_FREQUENCY, le=HIGHEST_FREQUENCY, allow_inf_nan=False, strict=True, description="[Hz]"),
]
Damping = Annotated[float, Field(ge=0.0, lt=1.0, allow_inf_nan=False, strict=True, description="Ratio [-].")]
ModePair = Annotated[tuple[Frequency, Damping], Field(description="Natural frequency [Hz] and damping ratio [-].")]
ModeList = Annotated[list[ModePair], Field(min_length=1, max_length=MOST_MODES)]
BandRow = Annotated[
    tuple[Frequency, Frequency, Damping, Damping],
    Field(description="Lowest and highest frequency [Hz], lowest and highest damping ratio [-]."),
]
Wish = (
    StrictBool
    | StrictInt
    | Annotated[StrictFloat, Field(allow_inf_nan=False)]
    | Annotated[StrictStr, Field(max_length=40)]
)
Wishes = Annotated[
    dict[Annotated[str, Field(max_length=40)], Wish],
    Field(max_length=20, description="By the names that GET /api/families lists."),
]
Short = Annotated[str, Field(max_length=40)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid")


class AskedModel(_Strict):
    """A design that is asked for."""

    family: Short = Field("zvd", description="A name that GET /api/families lists.")
    options: Wishes = {}
    bands: list[BandRow] = Field([], max_length=MOST_BANDS, description="For the family si.")
    band_width: float = Field(
        0.2, gt=0.0, le=1.5, strict=True, description="For si without bands: full width about each mode, relative [-]."
    )

    def asked(self, name: str) -> AskedDesign:
        """As the workbench takes it."""
        bands = tuple(Band(*band) for band in self.bands)
        return AskedDesign(name, self.family, tuple(self.options.items()), bands, self.band_width)


class DesignRequest(AskedModel):
    """One design for some modes."""

    modes: ModeList

    def workbench(self) -> Workbench:
        """With this one design, A."""
        return Workbench(tuple(Mode(*pair) for pair in self.modes), (self.asked("A"),))


class NamedDesign(AskedModel):
    """One of up to four designs."""

    name: Literal["A", "B", "C", "D"]


class PlantModel(_Strict):
    """What vibrates: driven by the command, or carried by what moves as the command says."""

    kind: Literal["driven", "carried"] = "driven"
    gains: list[Number] = Field([], max_length=MOST_MODES, description="Weight of each mode [-]; none: equal shares.")


class MoveModel(_Strict):
    """The command: a move of trapezoidal velocity, or a step."""

    distance: Number = Field(0.1, description="[m], not 0.")
    speed: Number = Field(0.5, description="[m/s], above 0.")
    acceleration: Number = Field(5.0, description="[m/s^2], above 0.")
    kind: Literal["trapezoid", "step"] = "trapezoid"


class ControllerModel(_Strict):
    """What the controller can hold; null is no limit."""

    most_impulses: Annotated[int, Field(ge=2, le=1_000_000, strict=True)] | None = None
    longest: Annotated[float, Field(gt=0.0, allow_inf_nan=False, strict=True)] | None = Field(None, description="[s]")
    negative: StrictBool = True


class WorkbenchModel(_Strict):
    """A workbench, schema preshape/workbench/1: what a link of the studio holds."""

    schema_: Literal["preshape/workbench/1"] = Field("preshape/workbench/1", alias="schema")
    modes: ModeList
    designs: list[NamedDesign] = Field([], max_length=4)
    plant: PlantModel = PlantModel()  # type: ignore[call-arg]
    move: MoveModel = MoveModel()  # type: ignore[call-arg]
    controller: ControllerModel = ControllerModel()  # type: ignore[call-arg]

    def workbench(self) -> Workbench:
        """As the workflow takes it; InputError where it cannot be one."""
        return from_plain(self.model_dump(by_alias=True))


class ShaperModel(_Strict):
    """A shaper: what POST /api/design answered, or impulses of your own."""

    times: list[Number] = Field(min_length=1, max_length=MOST_IMPULSES, description="[s], increasing from 0.")
    amplitudes: list[Number] = Field(min_length=1, max_length=MOST_IMPULSES, description="[-]; they sum to 1.")

    def shaper(self) -> Shaper:
        """As everything takes it; InputError where the impulses are none."""
        return Shaper(self.times, self.amplitudes)


class _Chosen(_Strict):
    modes: ModeList | None = Field(None, description="With `design`: what it is for.")
    design: AskedModel | None = Field(None, description="What to design, in place of `shaper`.")
    shaper: ShaperModel | None = Field(None, description="What was designed, in place of `modes` and `design`.")

    def chosen(self) -> Workbench | Shaper:
        """A workbench with the design A, or the shaper itself."""
        if self.shaper is not None:
            if self.design is not None:
                raise InputError("both a design and a shaper were given: give one of them.")
            return self.shaper.shaper()
        if self.design is None or self.modes is None:
            raise InputError("no shaper was given: give modes and design, or shaper.")
        return Workbench(tuple(Mode(*pair) for pair in self.modes), (self.design.asked("A"),))


class ExportRequest(_Chosen):
    """A shaper and what a target asks of it."""

    rate: Annotated[float, Field(gt=0.0, allow_inf_nan=False, strict=True)] | None = Field(
        None, description="Samples per second of the controller [Hz], for a target that works on samples."
    )
    name: Short = Field("shaper", description="Of files and identifiers.")
    version: Short | None = Field(None, description="Of the target; its first unless given.")
    precision: Short | None = Field(None, description="double or single; the target's first unless given.")
    grid: Short | None = Field(None, description="exact, linear, nearest or optimised.")
    axis: Short | None = Field(None, description="x, y or z, for a target with settings for each.")

    def settings(self) -> dict[str, float | str | None]:
        """What the export takes by name."""
        return self.model_dump(include={"rate", "name", "version", "precision", "grid", "axis"})


class ReportRequest(_Chosen):
    """A shaper and the modes it is judged at."""

    modes: ModeList
    remarks: list[Annotated[str, Field(max_length=500)]] = Field([], max_length=20, description="Shown at the top.")

    def judged_at(self) -> Modes:
        """The modes."""
        return Modes([Mode(*pair) for pair in self.modes])
