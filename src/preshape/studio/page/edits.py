"""One edit of the page: a field's name and the text in it make a new workbench, or a sentence that says why not.

A field is named by where it stands: "mode.0.frequency", "design.A.option.tolerance", "move.speed".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from preshape.band import Band
from preshape.design import OPTIONS, needed_by, taken_by
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.workflow.workbench import DESIGN_NAMES, MOST_MODES, AskedDesign, Workbench

__all__ = ["edited", "fields_of", "with_mode", "with_more_designs", "without_design", "without_mode"]

LONGEST_TEXT = 400
"""Characters of a field; more was pasted by mistake."""

FIRST_WISHES: Mapping[str, float] = {
    "order": 1,
    "humps": 2,
    "negative_amplitude": 1.0,
    "deflection_ratio": 0.5,
    "dt": 0.001,
    "tolerance": 0.05,
}
"""Where a family cannot do without a wish, it begins with this one, so that there is something to see."""


def edited(workbench: Workbench, field: str, text: str) -> Workbench:
    """The workbench with one field changed; InputError if the text is not what the field takes."""
    if len(text) > LONGEST_TEXT:
        raise InputError(f"{len(text)} characters were given: a field takes at most {LONGEST_TEXT}.")
    kind, *names = field.split(".")
    change = _CHANGES.get(kind)
    try:
        if change is None:
            raise KeyError(field)
        return change(workbench, names, text.strip())
    except (KeyError, IndexError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"there is no field {field[:60]!r} any more: reload the page.") from None


def fields_of(workbench: Workbench) -> dict[str, str]:
    """Every field's name, and the text that stands in it."""
    texts: dict[str, str] = {}
    for index, mode in enumerate(workbench.modes):
        texts[f"mode.{index}.frequency"] = shown(mode.frequency)
        texts[f"mode.{index}.damping"] = shown(mode.damping)
    for design in workbench.designs:
        texts[f"design.{design.name}.family"] = design.family
        texts[f"design.{design.name}.band_width"] = shown(design.band_width)
        texts[f"design.{design.name}.bands"] = ", ".join(f"{band.low:.6g}:{band.high:.6g}" for band in design.bands)
        given = dict(design.options)
        for name in OPTIONS:
            texts[f"design.{design.name}.option.{name}"] = shown(given.get(name))
    texts["plant.kind"] = workbench.plant.kind
    for index in range(len(workbench.modes)):
        gains = workbench.plant.gains
        texts[f"plant.gain.{index}"] = shown(gains[index] if gains else None)
    for group in ("move", "controller"):
        for name in _members(workbench, group):
            texts[f"{group}.{name}"] = shown(getattr(getattr(workbench, group), name))
    return texts


def shown(value: float | str | bool | None) -> str:
    """A value as it stands in a field."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    return value if isinstance(value, str) else f"{value:.6g}"


def with_mode(workbench: Workbench) -> Workbench:
    """With one mode more, above the others."""
    if len(workbench.modes) >= MOST_MODES:
        raise InputError(f"there are {MOST_MODES} modes, and the workbench holds no more: delete one first.")
    highest = max(workbench.modes, key=lambda mode: mode.frequency)
    new = Mode(float(f"{1.6 * highest.frequency:.3g}"), highest.damping)
    gains = workbench.plant.gains
    plant = replace(workbench.plant, gains=(*gains, 1.0) if gains else ())
    return replace(workbench, modes=(*workbench.modes, new), plant=plant)


def without_mode(workbench: Workbench, index: int) -> Workbench:
    """Without one of the modes."""
    if len(workbench.modes) == 1:
        raise InputError("this is the only mode, and a shaper needs one: change it instead.")
    gains = workbench.plant.gains
    plant = replace(workbench.plant, gains=gains[:index] + gains[index + 1 :])
    return replace(workbench, modes=workbench.modes[:index] + workbench.modes[index + 1 :], plant=plant)


def with_more_designs(workbench: Workbench, like: str) -> tuple[Workbench, str]:
    """With one design more, a copy of one that is there, and its name."""
    taken = {design.name for design in workbench.designs}
    free = [name for name in DESIGN_NAMES if name not in taken]
    if not free:
        raise InputError("four designs stand side by side, and there is no room for more: remove one first.")
    model = next((design for design in workbench.designs if design.name == like), AskedDesign())
    return replace(workbench, designs=(*workbench.designs, replace(model, name=free[0]))), free[0]


def without_design(workbench: Workbench, name: str) -> Workbench:
    """Without one of the designs."""
    if len(workbench.designs) == 1:
        raise InputError("this is the only design: change it instead.")
    return replace(workbench, designs=tuple(design for design in workbench.designs if design.name != name))


def _change_mode(workbench: Workbench, names: list[str], text: str) -> Workbench:
    index, part = int(names[0]), names[1]
    old = workbench.modes[index]
    what = "the natural frequency" if part == "frequency" else "the damping ratio"
    value = _number(text, what, "47.3" if part == "frequency" else "0.02")
    new = {"frequency": lambda: Mode(value, old.damping), "damping": lambda: Mode(old.frequency, value)}[part]()
    modes = list(workbench.modes)
    modes[index] = new
    return replace(workbench, modes=tuple(modes))


def _change_design(workbench: Workbench, names: list[str], text: str) -> Workbench:
    name, part = names[0], names[1]
    old = {design.name: design for design in workbench.designs}[name]
    if part == "family":
        bare = replace(old, family=text, options=())  # refuses what is no family
        new = replace(bare, options=_kept(old, text))
    elif part == "band_width":
        new = replace(old, band_width=_number(text, "the band's width", "0.2"))
    elif part == "bands":
        new = replace(old, bands=_bands(text))
    else:
        new = _with_option(old, names[2], text)
    return replace(workbench, designs=tuple(new if one.name == name else one for one in workbench.designs))


def _with_option(old: AskedDesign, option: str, text: str) -> AskedDesign:
    given = dict(old.options)
    given.pop(option, None)
    kind = OPTIONS[option].kind
    if kind == "flag":
        if text == "true":
            given[option] = True
    elif kind == "choice":
        if text:
            given[option] = text
    elif text:
        given[option] = _number(text, f"the option {option}", "0.05" if kind == "number" else "2")
    new = replace(old, options=tuple(given.items()))
    return replace(new, options=_kept(new, new.family)) if option == "base" else new


def _kept(old: AskedDesign, family: str) -> tuple[tuple[str, Any], ...]:
    """The options that the family takes too, and those that it cannot do without."""
    base = {name: value for name, value in old.options if name == "base" and family == "convolved"}
    taken, needed = taken_by(family, base), needed_by(family, base)
    kept = {name: value for name, value in old.options if name in taken}
    return tuple({**{name: FIRST_WISHES[name] for name in needed if name in FIRST_WISHES}, **kept}.items())


def _change_plant(workbench: Workbench, names: list[str], text: str) -> Workbench:
    if names[0] == "kind":
        # The plant refuses kinds that are not its.
        return replace(workbench, plant=replace(workbench.plant, kind=text))  # type: ignore[arg-type]
    count = len(workbench.modes)
    gains = list(workbench.plant.gains or [1.0 / count] * count)
    index = int(names[1])
    gains[index] = _number(text, "the mode's share", "0.5") if text else 1.0 / count
    return replace(workbench, plant=replace(workbench.plant, gains=tuple(gains)))


def _change_member(group: str) -> Callable[[Workbench, list[str], str], Workbench]:
    def change(workbench: Workbench, names: list[str], text: str) -> Workbench:
        old = getattr(workbench, group)
        name = names[0]
        if name not in _members(workbench, group):
            raise KeyError(name)
        value: object
        if name == "kind":
            value = text
        elif name == "negative":
            value = text == "true"
        elif group == "controller" and not text:
            value = None
        else:
            value = _number(text, f"the {name.replace('_', ' ')}", "0.1")
        return replace(workbench, **{group: replace(old, **{name: value})})

    return change


def _members(workbench: Workbench, group: str) -> tuple[str, ...]:
    return tuple(getattr(workbench, group).__dataclass_fields__)


def _bands(text: str) -> tuple[Band, ...]:
    bands = []
    for part in filter(None, (one.strip() for one in text.split(","))):
        low, colon, high = part.partition(":")
        if not colon:
            raise InputError(f"{part[:30]!r} is not a band: write it as 8:12, and several as 8:12, 30:34.")
        bands.append(Band(_number(low, "a band's lower end", "8"), _number(high, "a band's upper end", "12")))
    return tuple(bands)


def _number(text: str, what: str, example: str) -> float:
    """A number as people write it; in a field that takes one number, a comma can only be the decimal sign."""
    if not text:
        raise InputError(f"{what} is missing: give a number, such as {example}.")
    try:
        value = float(text.replace(",", ".", 1))
    except ValueError:
        raise InputError(f"{text[:30]!r} is not a number: write {what} as {example}.") from None
    return value


_CHANGES: Mapping[str, Callable[[Workbench, list[str], str], Workbench]] = {
    "mode": _change_mode,
    "design": _change_design,
    "plant": _change_plant,
    "move": _change_member("move"),
    "controller": _change_member("controller"),
}
