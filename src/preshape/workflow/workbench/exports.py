"""Every way out of the workbench: what each target takes, and a shaper in its words, to show and to save."""

from __future__ import annotations

from dataclasses import dataclass

from preshape.checks import positive
from preshape.errors import InputError
from preshape.export import TARGETS, Exported, SettingsTarget, Target, render
from preshape.export.fmu.archive import packed
from preshape.shaper import Shaper

__all__ = ["ExportFile", "ExportTarget", "Package", "export_targets", "packaged"]


@dataclass(frozen=True)
class ExportTarget:
    """What is asked for one target.

    Parameters
    ----------
    name, summary : str
        What it is called, and one line on what comes out.
    versions : tuple of str
        The default first.
    limits : tuple of str
        What each version holds, in a line.
    sampled : bool
        Whether it works on samples: then a sample rate is needed.
    precisions : tuple of str
        "double", "single" or both, the default first; empty without samples.
    axes : tuple of str
        Axes that have a setting each; empty where one serves all.
    """

    name: str
    summary: str
    versions: tuple[str, ...]
    limits: tuple[str, ...]
    sampled: bool
    precisions: tuple[str, ...] = ()
    axes: tuple[str, ...] = ()


@dataclass(frozen=True)
class ExportFile:
    """One file.

    Parameters
    ----------
    name : str
        May name a folder with a slash.
    content : bytes
        What it holds.
    text : str
        The same as text; empty if it is none.
    """

    name: str
    content: bytes
    text: str


@dataclass(frozen=True)
class Package:
    """What came out for a target.

    Parameters
    ----------
    files : tuple of ExportFile
        As the target takes them.
    name : str
        Of the file to save: the only one, or a zip file of all.
    content : bytes
        What that holds.
    shaper : Shaper
        What the controller will do.
    notes : tuple of str
        What was changed or chosen, a sentence each.
    next_step : tuple of str
        What to do with the files, a line each.
    """

    files: tuple[ExportFile, ...]
    name: str
    content: bytes
    shaper: Shaper
    notes: tuple[str, ...]
    next_step: tuple[str, ...]


def export_targets() -> tuple[ExportTarget, ...]:
    """All targets, in the order of :data:`preshape.export.TARGETS`.

    Examples
    --------
    >>> [target.name for target in export_targets()][:3]
    ['c', 'linuxcnc', 'st']
    """
    return tuple(_described(target) for target in TARGETS.values())


def packaged(
    shaper: Shaper,
    target: str,
    *,
    rate: float | None = None,
    name: str = "shaper",
    version: str | None = None,
    precision: str | None = None,
    grid: str | None = None,
    axis: str | None = None,
) -> Package:
    """A shaper for a target.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    target : str
        A name of :func:`export_targets`.
    rate : float, optional
        Samples per second of the controller [Hz], for a target that works on samples.
    name, version, precision, grid, axis
        As for :func:`preshape.export.render`.

    Raises
    ------
    InputError
        If the target is not known, the shaper does not fit it, or a setting is missing or not its.

    Examples
    --------
    >>> import preshape
    >>> shaper = preshape.design.zv((40.0, 0.0))
    >>> packaged(shaper, "klipper").name, packaged(shaper, "c", rate=1000.0).name
    ('shaper.cfg', 'shaper_c.zip')
    """
    dt = None if rate is None else 1.0 / positive("rate", rate, "Hz")
    if target in TARGETS and isinstance(TARGETS[target], Target) and dt is None:
        raise InputError(f"target {target} works on samples: give the controller's sample rate in hertz.")
    exported = render(shaper, target, dt=dt, name=name, version=version, precision=precision, grid=grid, axis=axis)
    files = tuple(_file(one, content) for one, content in exported.files.items())
    if len(files) == 1:
        saved, content = files[0].name.rsplit("/", 1)[-1], files[0].content
    else:
        saved, content = f"{name}_{target}.zip", packed(exported.files)
    # Both kinds of export keep their notes and the next step in their own place.
    if isinstance(exported, Exported):
        notes, steps = exported.notes, exported.target.next_step(exported.placed)
    else:
        notes, steps = exported.placed.notes, exported.target.next_step(exported.placed)
    return Package(files, saved, content, exported.placed.shaper, notes, steps)


def _described(target: Target | SettingsTarget) -> ExportTarget:
    if isinstance(target, Target):
        limits = (str(target.limits),) * len(target.versions)
        return ExportTarget(
            target.name, target.summary, target.versions, limits, True, precisions=target.limits.precisions
        )
    limits = tuple(str(target.limits_of(version)) for version in target.versions)
    return ExportTarget(target.name, target.summary, target.versions, limits, False, axes=target.axes)


def _file(name: str, content: str | bytes) -> ExportFile:
    if isinstance(content, str):
        return ExportFile(name, content.encode(), content)
    return ExportFile(name, content, "")
