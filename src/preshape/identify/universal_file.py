"""Universal files (UFF): time responses and power spectral densities in datasets 58, text or binary, through pyuff."""

from __future__ import annotations

import re
import warnings
from typing import Any

import numpy as np

from preshape.errors import MeasurementError
from preshape.identify.measurement import Measurement, Spectrum, TimeSeries
from preshape.identify.source_file import SourceFile
from preshape.identify.text import check_increasing, check_rate
from preshape.identify.time_column import uniform
from preshape.identify.wanted import Wanted, pick_part

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "universal file"
DATASET = 58
TIME_RESPONSE = 1
SPECTRA = (2, 9)
"""Auto-spectrum, and power spectral density: the same curve in another scale where the lines stand evenly."""

NAMES = {3: "cross spectra", 4: "frequency response functions", 6: "coherences", 12: "complex spectra"}
MINIMUM_ROWS = 8
MOST_DATASETS = 1000
_BEGIN = re.compile(rb"\s*-1[ \t]*\r?\n\s*(\d{1,6})[\sbB]")


def recognises(file: SourceFile) -> bool:
    """True for a line of `-1` and a line with the number of a dataset."""
    return bool(_BEGIN.match(file.begin[:400]))


def read(file: SourceFile, wanted: Wanted) -> Measurement:
    """Read the datasets 58 that stand on the same samples as the channels of one measurement."""
    groups = _groups(file)
    names = [f"set {numbers[0]}" for numbers, _ in groups]
    _, sets = groups[pick_part(names, wanted.part, file.name)]
    abscissa = np.asarray(sets[0]["x"], dtype=np.float64)
    values = np.array([np.asarray(one["data"], dtype=np.float64) for one in sets])
    units = {str(one.get("ordinate_axis_units_lab", "")).strip() for one in sets} - {"NONE"}
    unit = units.pop() if len(units) == 1 else ""
    channels = tuple(f"{one['rsp_node']}{_direction(one['rsp_dir'])}" for one in sets)
    if not (np.all(np.isfinite(values)) and np.all(np.isfinite(abscissa))):
        raise MeasurementError(f"{file.name}: the datasets hold NaN or infinity; export them again.")
    if sets[0]["func_type"] == TIME_RESPONSE:
        check_increasing(abscissa, "time", None, file.name)
        rate, values = uniform(abscissa, values, None, file.name)
        check_rate(wanted.sample_rate, rate, file.name)
        return TimeSeries(rate, float(abscissa[0]), values, channels, unit, file.name, FORMAT)
    if wanted.sample_rate is not None:
        raise MeasurementError(f"{file.name}: this is a spectrum, which has no sample rate; leave sample_rate out.")
    check_increasing(abscissa, "frequency", None, file.name)
    spacing = float(abscissa[-1] - abscissa[0]) / (len(abscissa) - 1)
    return Spectrum(
        abscissa, values, channels, unit=unit, window_duration=1.0 / spacing, source=file.name, format=FORMAT
    )


def _groups(file: SourceFile) -> list[tuple[list[int], list[dict[str, Any]]]]:
    """Numbers and contents of the datasets that can be read, those on the same samples together."""
    try:
        import pyuff
    except ImportError:
        raise MeasurementError(
            f"{file.name}: reading universal files needs the package pyuff; pip install 'preshape[formats]'."
        ) from None
    groups: dict[tuple[object, ...], tuple[list[int], list[dict[str, Any]]]] = {}
    others: set[str] = set()
    for number, one in _datasets(pyuff, file):
        kind = one["func_type"]
        points = len(one["data"])
        if kind not in (TIME_RESPONSE, *SPECTRA) or np.iscomplexobj(one["data"]):
            others.add(NAMES.get(kind, f"functions of type {kind}"))
            continue
        if points != one["num_pts"] or points < MINIMUM_ROWS:
            raise MeasurementError(
                f"{file.name}: dataset {number} says {one['num_pts']} points and has {points} (at least {MINIMUM_ROWS} "
                "are needed); the file is truncated, export it again."
            )
        same = groups.setdefault((kind, points, float(one["x"][0]), float(one["x"][-1])), ([], []))
        same[0].append(number)
        same[1].append(one)
    if not groups:
        there = ", ".join(sorted(others)) or "no dataset 58"
        raise MeasurementError(
            f"{file.name}: the universal file holds {there}; a measurement needs time responses or power spectra, "
            "export those."
        )
    return list(groups.values())


def _datasets(pyuff: Any, file: SourceFile) -> list[tuple[int, dict[str, Any]]]:
    """Each dataset 58 with its number, counted from 1."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            content = pyuff.UFF(file.name)
            picked = [index for index, kind in enumerate(content.get_set_types()) if int(kind) == DATASET]
            if len(picked) > MOST_DATASETS:
                raise MeasurementError(
                    f"{file.name}: the file holds {len(picked)} datasets and at most {MOST_DATASETS} are taken."
                )
            read = [(index + 1, content.read_sets(index)) for index in picked]
            return [(number, {**one, "func_type": int(one["func_type"])}) for number, one in read]
    except MeasurementError:
        raise
    except Exception as error:  # pyuff raises plain Exception for whatever is wrong
        words = (str(error).splitlines() or [type(error).__name__])[0][:80]
        raise MeasurementError(f"{file.name}: the universal file is damaged ({words}); export it again.") from None


def _direction(code: object) -> str:
    """x, y, z with its sign for the codes 1 to 3, as the universal file numbers directions."""
    number = int(code) if isinstance(code, int | np.integer | float) else 0
    name = {1: "x", 2: "y", 3: "z"}.get(abs(number), "")
    return f"-{name}" if number < 0 and name else name
