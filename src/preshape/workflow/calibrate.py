"""The main job: from vibration measurements to a shaper that can be trusted, with the reason."""

from __future__ import annotations

import os
from collections.abc import Iterable

import numpy as np

from preshape import identify
from preshape.checks import tolerance_of
from preshape.errors import InputError
from preshape.export import klipper, paste_ready
from preshape.mode import Mode, Modes
from preshape.report import Calibration, CalibrationJob, MeasuredFile
from preshape.workflow.candidates import designed_candidates
from preshape.workflow.choose import choose, ranked
from preshape.workflow.design_within import room_of
from preshape.workflow.mixed_files import mixed_up
from preshape.workflow.record import recorded_files
from preshape.workflow.remaining import lines_to_still
from preshape.workflow.simulate import simulate_move
from preshape.workflow.spectra import scored_spectrum
from preshape.workflow.trade_off import found_trade_off

__all__ = ["calibrate"]

PRINTERS = ("Klipper", "RepRapFirmware", "Prusa")
"""Formats that come from 3D printers begin with these words."""

KLIPPER_RANGE = (10.0, 200.0)
"""Frequencies [Hz] at which Klipper looks for resonances: below it fades the spectrum out, above it looks away."""


def calibrate(
    files: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    *,
    maximum_impulses: int | None = None,
    tolerance: float = 0.05,
    damping: float | None = None,
    sample_rate: float | None = None,
    part: str | None = None,
    excitation: str | None = None,
    mixed: bool = False,
    axis: str | None = None,
) -> Calibration:
    """Read measurements of one axis, find its modes, design the candidates, and choose.

    Parameters
    ----------
    files : path or several
        Measurements in any format that :func:`preshape.identify.read` knows; several count as one machine, of which
        the worst case must be served.
    maximum_impulses : int, optional
        How many impulses the controller holds; no limit unless given.
    tolerance : float
        Part of the measured vibration that may remain [-], between 0 and 1, with all frequencies 5 % off.
    damping : float, optional
        Damping ratio [-] of the modes, when it is known better than the measurement shows it.
    sample_rate : float, optional
        Samples per second [Hz], for tables without a time column.
    part : str, optional
        Name of the measurement, or its beginning, in files that hold several.
    excitation : str, optional
        Name of the column or array that holds the input (a force, a command) beside the outputs.
    axis : str, optional
        "x", "y" or "z": which axis the texts for firmwares set; x and y alike unless given.
    mixed : bool
        True when files of several axes or machines are meant to have one shaper; otherwise `trouble` says so.

    Returns
    -------
    Calibration
        Everything that the report shows; the shaper is ``calibration.shaper``.

    Raises
    ------
    InputError
        If a file cannot be used (MeasurementError), a value is out of range, or no candidate fits the controller.

    Examples
    --------
    >>> calibration = calibrate("examples/data/gantry_x.csv")
    >>> [round(mode.mode.frequency) for mode in calibration.modes]
    [47, 79]
    """
    paths = [files] if isinstance(files, str | os.PathLike) else list(files)
    if not paths:
        raise InputError("no measurement was given: name at least one file.")
    tolerance_of(tolerance)
    if maximum_impulses is not None and maximum_impulses < 2:
        raise InputError(f"{maximum_impulses} impulses cannot shape anything: the shortest shaper has 2.")
    if damping is not None:
        Mode(1.0, damping)  # says what is wrong with it
    measurements = [identify.read(path, sample_rate=sample_rate, part=part) for path in paths]
    inputs = recorded_files(paths)
    names = [one.name for one in inputs]
    measured = tuple(_measured(name, one, damping, excitation) for name, one in zip(names, measurements, strict=True))
    modes = identify.merged_modes([file.identification for file in measured])
    spectra = klipper.as_spectra([(file.scored.frequencies, file.scored.power) for file in measured])
    advice = klipper.recommend(spectra) if _klipper_applies(measured) else None
    stock = None if advice is None else advice.chosen
    clear = all(file.identification.clear for file in measured)
    candidates = ranked(
        designed_candidates(
            spectra,
            modes,
            stock,
            tolerance=tolerance,
            clear=clear,
            damping=damping,
            maximum_impulses=maximum_impulses,
        ),
        tolerance,
        clear,
    )
    chosen, reason = choose(candidates, tolerance, clear)
    trade_off = None
    if advice is not None:
        trade_off = found_trade_off(
            spectra,
            candidates,
            advice,
            room_of(maximum_impulses=maximum_impulses),
            modes=Modes([mode.mode for mode in modes]) if modes else None,
            lines=lines_to_still(spectra, modes, clear, damping),
            remaining=tolerance,
        )
    several = len(measured) > 1
    trouble = () if mixed or not several else mixed_up(names, measurements)
    trouble += tuple(
        f"{file.name}: {sentence}" if several else sentence
        for file in measured
        for sentence in file.identification.trouble
    )
    return Calibration(
        files=measured,
        modes=modes,
        candidates=candidates,
        chosen=chosen,
        reason=reason,
        klipper=stock,
        trouble=trouble,
        clear=clear,
        move=simulate_move(chosen.shaper, Modes([one.mode for one in modes]), [one.share for one in modes])
        if modes
        else None,
        tolerance=tolerance,
        maximum_impulses=maximum_impulses,
        job=CalibrationJob(
            maximum_impulses=maximum_impulses,
            tolerance=tolerance,
            damping=damping,
            sample_rate=sample_rate,
            part=part,
            excitation=excitation,
            mixed=mixed,
            axis=axis,
        ),
        inputs=inputs,
        trade_off=trade_off,
        texts=() if advice is None else paste_ready(chosen.shaper, axis),
    )


def _klipper_applies(files: tuple[MeasuredFile, ...]) -> bool:
    """Whether these are from a printer, or vibrate where Klipper looks: for a crane its measures would only mislead."""
    loudest = [float(file.scored.frequencies[np.argmax(row)]) for file in files for row in file.scored.power]
    printer = any(file.format.startswith(PRINTERS) for file in files)
    return printer or (min(loudest) >= KLIPPER_RANGE[0] and max(loudest) <= KLIPPER_RANGE[1])


def _measured(
    name: str, measurement: identify.Measurement, damping: float | None, excitation: str | None
) -> MeasuredFile:
    identification = identify.find_modes(measurement, damping=damping, excitation=excitation)
    return MeasuredFile(name, measurement.format, identification, scored_spectrum(measurement, identification))
