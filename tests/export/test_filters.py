"""What comes out for a PLC, a drive and other Python, run by something that is not ours."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from preshape import Shaper, design
from preshape.export import render

SHAPER = design.zvd([(41.0, 0.05), (66.0, 0.04)])
DT = 0.0013


def test_twincats_arrays_are_a_fir_filter() -> None:
    """Its b and a, read as IEC writes repeated values, in SciPy's filter: the shaped command."""
    exported = render(SHAPER, "twincat", dt=DT)
    text = str(exported.files["shaper.txt"])

    def array(name: str) -> list[float]:
        body = text.split(f"a_shaper_{name} :")[1].split("[", 2)[2].split("]")[0]
        values: list[float] = []
        for item in (word.strip() for word in body.split(",")):
            count, _, value = item.partition("(")
            values += [float(value.rstrip(")"))] * int(count) if value else [float(item)]
        return values

    a, b = array("a"), array("b")
    command = np.minimum(np.arange(200) * 0.02, 1.0)
    shaped = exported.placed.shaper.shape(command, DT)[:200]
    assert len(a) == len(b) == exported.placed.latency_samples + 1
    np.testing.assert_allclose(lfilter(b, a, command), shaped, atol=1e-14)
    assert f"n_shaper_order : UINT := {len(b) - 1};" in text
    assert exported.target.execute({"x.txt": text.encode()}) == exported.placed.shaper


def test_acs_gets_milliseconds_on_its_cycle_and_amplitudes_made_for_them() -> None:
    """ECOSYSTEM 2.7: multiples of the cycle, amplitudes that sum to 1, nothing left; plain rounding leaves some."""
    for grid in ("exact", "optimised"):
        exported = render(SHAPER, "acs", dt=0.0005, grid=grid)
        rows = [line for line in str(exported.files["shaper.prg"]).splitlines() if line.startswith("shaperT(")]
        products = [row.split("=")[1].split(";")[0].split("*") for row in rows]  # such as 17*0.5
        times = [float(cycles) * float(cycle) for cycles, cycle in products]
        amplitudes = [float(row.split("=")[2]) for row in rows]
        np.testing.assert_allclose(np.array(times) / 0.5, np.rint(np.array(times) / 0.5), atol=1e-9)
        assert sum(amplitudes) == pytest.approx(1.0, abs=1e-14)
        assert max(exported.placed.shaper.design.settings["residuals"]) < 1e-12
        assert f"global real shaperT({len(rows)}), shaperA({len(rows)})" in str(exported.files["shaper.prg"])
    rounded = render(SHAPER, "acs", dt=0.0005, grid="nearest").placed
    assert max(rounded.shaper.design.settings["residuals"]) > 1e-4


def names_of(source: str) -> dict[str, Any]:
    """What a written module holds, run."""
    names: dict[str, Any] = {}
    exec(compile(source, "shaper.py", "exec"), names)
    return names


def test_python_control_has_the_same_response_twice() -> None:
    """The transfer function's own evaluation, the FRD, and the sum over the impulses."""
    exported = render(SHAPER, "python-control", dt=DT)
    names = names_of(str(exported.files["shaper.py"]))
    fir = names["fir"]()
    omega = np.linspace(1.0, 0.9 * np.pi / DT, 60)
    taps = exported.placed.shaper
    expected = np.exp(-1j * np.multiply.outer(omega, taps.times)) @ taps.amplitudes
    np.testing.assert_allclose(fir(np.exp(1j * omega * DT)), expected, atol=1e-12)
    frd = names["response"](omega)
    np.testing.assert_allclose(np.squeeze(frd.frdata), expected, atol=1e-12)
    assert fir.dt == DT and fir.dcgain() == pytest.approx(1.0)


def test_zabers_generator_gets_the_impulses(monkeypatch: pytest.MonkeyPatch) -> None:
    """A base class that convolves steps of acceleration, as zaber-examples does; the move against the exact Profile."""
    plant, base = ModuleType("plant"), ModuleType("zero_vibration_stream_generator")

    class Plant:
        def __init__(self, frequency: float, damping: float) -> None:
            self.frequency = frequency

    class Generator:
        def __init__(self, plant: Plant) -> None:
            self.plant = plant

        def steps(self, times: list[float], changes: list[float]) -> list[tuple[float, float]]:
            return sorted(
                (start + t, change * a)
                for start, change in zip(times, changes, strict=True)
                for t, a in zip(self.get_impulse_times(), self.get_impulse_amplitudes(), strict=True)  # type: ignore[attr-defined]
            )

    plant.Plant, base.ZeroVibrationStreamGenerator = Plant, Generator  # type: ignore[attr-defined]
    for name, module in (("plant", plant), ("zero_vibration_stream_generator", base)):
        monkeypatch.setitem(sys.modules, name, module)
    exported = render(SHAPER, "zaber")
    names = names_of(str(exported.files["shaper.py"]))
    steps = names["PreshapeStreamGenerator"]().steps([0.0, 0.1, 0.3, 0.4], [5.0, -5.0, -5.0, 5.0])
    at = np.linspace(0.0, 0.6, 500)
    acceleration = sum(change * (at >= time) for time, change in steps)
    unshaped = SHAPER.shape_function(lambda t: 5.0 * ((t >= 0) & (t < 0.1)) - 5.0 * ((t >= 0.3) & (t < 0.4)))
    np.testing.assert_allclose(acceleration, unshaped(at), atol=1e-9)


def test_tables_hold_every_bit() -> None:
    shaper = Shaper([0.0, 0.1 + 0.2], [1.0 / 3.0, 2.0 / 3.0])
    assert str(render(shaper, "csv").files["shaper.csv"]).splitlines()[-1] == "0.30000000000000004,0.6666666666666666"
    for target in ("csv", "json", "zaber"):
        assert render(shaper, target).placed.shaper == shaper
