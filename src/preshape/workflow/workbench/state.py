"""Workbench: everything that a session of choosing a shaper holds, as one frozen value.

A change makes a new one (``dataclasses.replace``); undo is a list of them. What cannot be a state is refused here, with
a sentence; a design that is a state but has no solution is data of its view (view.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from numbers import Real
from typing import Literal

from preshape.band import Band
from preshape.checks import nonzero, positive, whole_number
from preshape.design import ASKED_FAMILIES, OPTIONS
from preshape.errors import InputError
from preshape.mode import Mode, Modes

__all__ = ["DESIGN_NAMES", "MOST_BANDS", "MOST_MODES", "AskedDesign", "Controller", "Move", "Plant", "Workbench"]

MOST_MODES = 12
MOST_BANDS = 12

DESIGN_NAMES = ("A", "B", "C", "D")
"""Designs stand side by side under these names."""

LARGEST = 1e9
"""Larger distances, speeds, accelerations, weights and options are refused: they are slips."""

HIGHEST_FREQUENCY, LOWEST_FREQUENCY = 1e5, 1e-3
"""Of a mode on the workbench [Hz]."""

WIDEST_SPAN = 1000.0
"""Highest frequency over the lowest: of a wider span the fast mode could not be seen beside the slow one."""

WIDEST_BAND = 1.5
"""Full width of a band around a mode, relative to its frequency."""

LONGEST_MOVE = 1e5
"""Periods of the fastest mode that a move may take; a longer one can neither be drawn nor computed soon."""


@dataclass(frozen=True, slots=True)
class AskedDesign:
    """A design that is asked for.

    Parameters
    ----------
    name : str
        "A" to "D".
    family : str
        One of :data:`preshape.design.ASKED_FAMILIES`.
    options : tuple of (str, value) pairs
        Wishes by the names of :data:`preshape.design.OPTIONS`, in any order; kept sorted.
    bands : tuple of Band
        For the family "si": what it must cover in place of bands around the modes.
    band_width : float
        Full width of the band around each mode, relative to its frequency [-], for "si" without bands.

    Raises
    ------
    InputError
        If the name, the family or an option is not known, or a value is not of its kind.

    Examples
    --------
    >>> AskedDesign("A", "zvdk", (("order", 2),)).options
    (('order', 2),)
    """

    name: str = "A"
    family: str = "zvd"
    options: tuple[tuple[str, float | int | str | bool], ...] = ()
    bands: tuple[Band, ...] = ()
    band_width: float = 0.2

    def __post_init__(self) -> None:
        if self.name not in DESIGN_NAMES:
            raise InputError(f"design {self.name!r} is not known: designs are {', '.join(DESIGN_NAMES)}.")
        if self.family not in ASKED_FAMILIES:
            raise InputError(f"there is no family {self.family!r}: choose one of {', '.join(ASKED_FAMILIES)}.")
        given = dict(self.options)
        if len(given) != len(self.options):
            raise InputError("an option is given twice: give each once.")
        checked = tuple((name, _option(name, given[name])) for name in sorted(given))
        object.__setattr__(self, "options", checked)
        if len(self.bands) > MOST_BANDS:
            raise InputError(f"{len(self.bands)} bands were given: the workbench holds {MOST_BANDS} a design.")
        object.__setattr__(self, "bands", tuple(self.bands))
        width = positive("band_width", self.band_width, "times the frequency")
        if width > WIDEST_BAND:
            raise InputError(f"band_width is {width:g}: give at most {WIDEST_BAND:g} times the frequency.")
        object.__setattr__(self, "band_width", width)


@dataclass(frozen=True, slots=True)
class Plant:
    """What vibrates, driven by a position command.

    Parameters
    ----------
    kind : {"driven", "carried"}
        "driven": each modal coordinate x obeys x'' + 2 z w x' + w^2 x = w^2 u and settles on the command u, as the tip
        of a servo axis. "carried": a load on a carrier that moves as the command says, with the deflection d of each
        mode d'' + 2 z w d' + w^2 d = -u''.
    gains : tuple of float
        Weight of each mode in the output [-]; empty for equal shares of 1.
    """

    kind: Literal["driven", "carried"] = "driven"
    gains: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if self.kind not in ("driven", "carried"):
            raise InputError(f"plant {self.kind!r} is not known: it is driven or carried.")
        object.__setattr__(self, "gains", tuple(_number("gain", gain, "") for gain in self.gains))


@dataclass(frozen=True, slots=True)
class Move:
    """The command that is shaped: a rest-to-rest move of trapezoidal velocity; beside it a step is always drawn.

    Parameters
    ----------
    distance : float
        [m], not 0.
    speed, acceleration : float
        Limits [m/s, m/s^2], above zero. Any other unit of length will do if all are in it.
    kind : {"trapezoid", "step"}
        "step" commands `distance` at once.
    """

    distance: float = 0.1
    speed: float = 0.5
    acceleration: float = 5.0
    kind: Literal["trapezoid", "step"] = "trapezoid"

    def __post_init__(self) -> None:
        if self.kind not in ("trapezoid", "step"):
            raise InputError(f"move {self.kind!r} is not known: it is trapezoid or step.")
        for name, unit in (("distance", "m"), ("speed", "m/s"), ("acceleration", "m/s^2")):
            value = _number(name, getattr(self, name), unit)
            check = nonzero if name == "distance" else positive
            object.__setattr__(self, name, check(name, value, unit))

    @property
    def duration(self) -> float:
        """Without a shaper [s]."""
        if self.kind == "step":
            return 0.0
        size = abs(self.distance)
        if size < self.speed**2 / self.acceleration:
            return 2.0 * math.sqrt(size / self.acceleration)
        return size / self.speed + self.speed / self.acceleration


@dataclass(frozen=True, slots=True)
class Controller:
    """What the controller can hold; None is no limit.

    Parameters
    ----------
    most_impulses : int or None
        How many impulses.
    longest : float or None
        Duration of the shaper [s].
    negative : bool
        Whether impulses may be negative.
    """

    most_impulses: int | None = None
    longest: float | None = None
    negative: bool = True

    def __post_init__(self) -> None:
        if self.most_impulses is not None:
            count = whole_number("most_impulses", self.most_impulses, 2, 1_000_000)
            object.__setattr__(self, "most_impulses", count)
        if self.longest is not None:
            object.__setattr__(self, "longest", positive("longest", self.longest, "s"))
        if not isinstance(self.negative, bool):
            raise InputError(f"negative is {self.negative!r}: give true or false.")


@dataclass(frozen=True, slots=True)
class Workbench:
    """Modes, designs for them, and what they are tried on.

    Parameters
    ----------
    modes : tuple of Mode
        At least one and at most twelve: natural frequencies [Hz] and damping ratios [-].
    designs : tuple of AskedDesign
        At most four, each of another name; kept in the order of their names.
    plant : Plant
        What vibrates.
    move : Move
        What it is told to do.
    controller : Controller
        What shaper it can take.

    Raises
    ------
    InputError
        If there are too many modes or designs, one is given twice, or the plant's gains do not fit the modes.

    Examples
    --------
    >>> workbench = Workbench((Mode(10.0, 0.02), Mode(31.0, 0.01)))
    >>> [design.family for design in workbench.designs]
    ['zvd']
    """

    modes: tuple[Mode, ...] = (Mode(10.0, 0.02),)
    designs: tuple[AskedDesign, ...] = (AskedDesign(),)
    plant: Plant = field(default_factory=Plant)
    move: Move = field(default_factory=Move)
    controller: Controller = field(default_factory=Controller)

    def __post_init__(self) -> None:
        modes = tuple(self.modes)
        if len(modes) > MOST_MODES:
            raise InputError(
                f"{len(modes)} modes were given: the workbench holds {MOST_MODES}; keep those that vibrate most."
            )
        object.__setattr__(self, "modes", tuple(Modes(modes)))
        for mode in self.modes:
            if not LOWEST_FREQUENCY <= mode.frequency <= HIGHEST_FREQUENCY:
                raise InputError(
                    f"frequency {mode.frequency:g} Hz is outside the workbench's {LOWEST_FREQUENCY:g} to "
                    f"{HIGHEST_FREQUENCY:g} Hz: check its unit."
                )
        slowest, fastest = (choose(mode.frequency for mode in self.modes) for choose in (min, max))
        if fastest > WIDEST_SPAN * slowest:
            raise InputError(
                f"the modes from {slowest:g} to {fastest:g} Hz are too far apart: the workbench holds a ratio of "
                f"{WIDEST_SPAN:g}; leave the fastest out, which such a shaper can hardly excite."
            )
        names = [design.name for design in self.designs]
        if len(set(names)) != len(names):
            raise InputError(f"design {max(names, key=names.count)} is given twice: designs are A to D, each once.")
        object.__setattr__(self, "designs", tuple(sorted(self.designs, key=lambda design: design.name)))
        gains = self.plant.gains
        if gains and len(gains) != len(modes):
            raise InputError(f"{len(gains)} gains for {len(modes)} modes: give one a mode, or none for equal shares.")
        if self.move.duration * fastest > LONGEST_MOVE:
            raise InputError(
                f"the move takes {self.move.duration:.3g} s, more than {LONGEST_MOVE:g} periods of the fastest mode: "
                "raise its speed or acceleration, or shorten the distance."
            )


def _option(name: str, value: object) -> float | int | str | bool:
    """The value, if it is of the option's kind; whether it is in range is the family's to say."""
    if name not in OPTIONS:
        raise InputError(f"there is no option {name!r}: choose one of {', '.join(OPTIONS)}.")
    option = OPTIONS[name]
    if option.kind == "flag":
        if not isinstance(value, bool):
            raise InputError(f"option {name} is {value!r}: give true or false.")
        return value
    if option.kind == "choice":
        if not isinstance(value, str) or value not in option.choices:
            raise InputError(f"option {name} is {value!r}: choose one of {', '.join(option.choices)}.")
        return value
    number = _number(f"option {name}", value, "")
    if option.kind == "number":
        return number
    if not number.is_integer():
        raise InputError(f"option {name} is {number:g}: give a whole number.")
    return int(number)


def _number(name: str, value: object, unit: str) -> float:
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"{name} is {value!r}: give a number{' in ' * bool(unit)}{unit}.")
    number = float(value)
    if not abs(number) <= LARGEST:
        raise InputError(f"{name} is {number:g}: give a finite number of at most {LARGEST:g}{' ' * bool(unit)}{unit}.")
    return number
