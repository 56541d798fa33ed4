"""Universal files (UFF): time responses and power spectral densities in datasets 58, text or binary, through pyuff."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.errors import MeasurementError
from preshape.identify.measurement import Measurement, Spectrum, TimeSeries
from preshape.identify.source_file import SourceFile
from preshape.identify.text import check_increasing, check_rate, printable
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


@dataclass(frozen=True)
class _Function:
    """What is used of a dataset 58; `number` counts the file's datasets from 1."""

    number: int
    kind: int
    abscissa: NDArray[np.float64]
    values: NDArray[Any]
    promised: int
    channel: str
    unit: str


def read(file: SourceFile, wanted: Wanted) -> Measurement:
    """Read the datasets 58 that stand on the same samples as the channels of one measurement."""
    groups = _groups(file)
    functions = groups[pick_part([f"set {group[0].number}" for group in groups], wanted.part, file.name)]
    abscissa = functions[0].abscissa
    values = np.array([one.values for one in functions], dtype=np.float64)
    units = {one.unit for one in functions}
    unit = units.pop() if len(units) == 1 else ""
    channels = tuple(one.channel for one in functions)
    if not (np.all(np.isfinite(values)) and np.all(np.isfinite(abscissa))):
        raise MeasurementError(f"{file.name}: the datasets hold NaN or infinity; export them again.")
    if functions[0].kind == TIME_RESPONSE:
        check_increasing(abscissa, "time", None, file.name)
        rate, values = uniform(abscissa, values, None, file.name)
        check_rate(wanted.sample_rate, rate, file.name)
        return TimeSeries(rate, float(abscissa[0]), values, channels, unit, file.name, FORMAT)
    if wanted.sample_rate is not None:
        raise MeasurementError(f"{file.name}: this is a spectrum, which has no sample rate; leave sample_rate out.")
    check_increasing(abscissa, "frequency", None, file.name)
    window = (len(abscissa) - 1) / float(abscissa[-1] - abscissa[0])
    return Spectrum(abscissa, values, channels, unit=unit, window_duration=window, source=file.name, format=FORMAT)


def _groups(file: SourceFile) -> list[list[_Function]]:
    """The functions that can be read, those on the same samples together."""
    groups: dict[tuple[object, ...], list[_Function]] = {}
    others: set[str] = set()
    for one in _functions(file):
        if one.kind not in (TIME_RESPONSE, *SPECTRA) or np.iscomplexobj(one.values):
            others.add(NAMES.get(one.kind, f"functions of type {one.kind}"))
            continue
        points = len(one.values)
        if points != one.promised or points != len(one.abscissa) or points < MINIMUM_ROWS:
            raise MeasurementError(
                f"{file.name}: dataset {one.number} says {one.promised} points and has {points} (at least "
                f"{MINIMUM_ROWS} are needed); the file is truncated, export it again."
            )
        key = (one.kind, points, float(one.abscissa[0]), float(one.abscissa[-1]))
        groups.setdefault(key, []).append(one)
    if not groups:
        there = ", ".join(sorted(others)) or "no dataset 58"
        raise MeasurementError(
            f"{file.name}: the universal file holds {there}; a measurement needs time responses or power spectra, "
            "export those."
        )
    return list(groups.values())


def _functions(file: SourceFile) -> list[_Function]:
    """Every dataset 58."""
    try:
        import pyuff
    except ImportError:
        raise MeasurementError(
            f"{file.name}: reading universal files needs the package pyuff; pip install 'preshape[formats]'."
        ) from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            content = pyuff.UFF(file.name)
            picked = [index for index, kind in enumerate(content.get_set_types()) if int(kind) == DATASET]
            if len(picked) > MOST_DATASETS:
                raise MeasurementError(
                    f"{file.name}: the file holds {len(picked)} datasets and at most {MOST_DATASETS} are taken."
                )
            return [_function(index + 1, content.read_sets(index)) for index in picked]
    except MeasurementError:
        raise
    except Exception as error:  # pyuff raises plain Exception for whatever is wrong, and leaves fields out
        words = printable((str(error).splitlines() or [type(error).__name__])[0][:80])
        raise MeasurementError(f"{file.name}: the universal file is damaged ({words}); export it again.") from None


def _function(number: int, content: dict[str, Any]) -> _Function:
    direction = int(content["rsp_dir"])
    axis = {1: "x", 2: "y", 3: "z"}.get(abs(direction), "")
    unit = printable(str(content["ordinate_axis_units_lab"]).strip())
    return _Function(
        number,
        int(content["func_type"]),
        np.asarray(content["x"], dtype=np.float64),
        np.asarray(content["data"]),
        int(content["num_pts"]),
        f"{int(content['rsp_node'])}{'-' if direction < 0 and axis else ''}{axis}",
        "" if unit == "NONE" else unit,
    )
