"""`preshape export linuxcnc`: built with halcompile, run in halrun, its samples compared with Python's bit for bit.

Debian's LinuxCNC is 2.9. What is written for master runs behind a stand-in for halcompile's macros (stand_in.py),
through the same tests: its C is compiled and gives the same samples, but master's own halcompile has not seen it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.export import hal
from tests.export.exports import NAMES, shaper_of
from tests.export.stand_in import run_master
from tests.tools import needed, succeeded

from preshape import Shaper, design
from preshape.export import render
from preshape.export.linuxcnc.target import PERIOD_TOLERANCE
from preshape.stream import Stream

DT = 0.001
SHAPER = design.zvd((47.3, 0.05))
RANDOM = np.random.default_rng(1992)
WALK = 3.0 + np.cumsum(RANDOM.normal(size=600))

Samples = NDArray[np.float64]
Flags = NDArray[np.bool_]


class Run(Protocol):
    """A component's samples: from a shaper, a command and its switches to what comes out."""

    def __call__(
        self, shaper: Shaper, command: Samples, switches: Flags | None = None, period: int = 1_000_000
    ) -> tuple[Samples, Flags, str]: ...


@pytest.fixture(params=["2.9", "master"])
def run(request: pytest.FixtureRequest, tmp_path: Path) -> Run:
    version = request.param

    def runs(
        shaper: Shaper, command: Samples, switches: Flags | None = None, period: int = 1_000_000
    ) -> tuple[Samples, Flags, str]:
        exported = render(shaper, "linuxcnc", dt=DT, name="gantry_x", version=version)
        text = str(exported.files["gantry_x.comp"])
        if version == "master":
            on = np.tile([True, False], (command.size, 1)) if switches is None else switches
            return run_master(text, command, on, period, tmp_path)
        (tmp_path / "gantry_x.comp").write_text(text)
        return hal.run(hal.build(tmp_path / "gantry_x.comp"), command, tmp_path, period=period, switches=switches)

    return runs


def streamed(shaper: Shaper, command: Samples) -> Samples:
    """What Python gives, at rest at the first sample."""
    stream = Stream(render(shaper, "linuxcnc", dt=DT).placed.shaper, DT)
    stream.reset(command[0])
    return stream.push_block(command)


def switches(size: int, **parts: tuple[str, slice]) -> Flags:
    """enable 1 and bypass 0, but for parts."""
    table = np.tile([True, False], (size, 1))
    for pin, part in parts.values():
        table[part, 0 if pin == "enable" else 1] = pin != "enable"
    return table


@pytest.mark.parametrize("family", NAMES[::5])
def test_samples_are_those_of_python_to_the_last_bit(run: Run, family: str) -> None:
    shaper = shaper_of(family)
    out, pins, _ = run(shaper, WALK)
    assert out.tobytes() == streamed(shaper, WALK).tobytes() and pins.all()


def test_one_impulse_changes_nothing(run: Run) -> None:
    assert run(Shaper([0.0], [1.0]), WALK)[0].tobytes() == WALK.tobytes()


def test_off_it_follows_and_on_it_begins_at_rest_where_the_joint_is(run: Run) -> None:
    off = switches(600, first=("enable", slice(0, 100)), again=("enable", slice(300, 350)))
    out, pins, _ = run(SHAPER, WALK, off)
    assert (pins[:, 0] == off[:, 0]).all()
    expected = WALK.copy()
    expected[100:300] = streamed(SHAPER, WALK[100:300])
    expected[350:] = streamed(SHAPER, WALK[350:])
    assert out.tobytes() == expected.tobytes()


def test_bypass_lets_what_was_commanded_arrive_and_nothing_jumps(run: Run) -> None:
    """Each increment goes through the shaper in force when it is commanded; steps are at most twice the command's."""
    latency = render(SHAPER, "linuxcnc", dt=DT).placed.latency_samples
    moving = np.clip(np.arange(600) * 0.05, 0.0, 20.0)
    bypassed = switches(600, once=("bypass", slice(200, 380)))
    out, pins, _ = run(SHAPER, moving, bypassed)
    before, after = moving.copy(), moving.copy()
    before[200:] = moving[199]
    after[:200] = moving[199]
    expected = streamed(SHAPER, before) + (after - moving[199])
    np.testing.assert_allclose(out[:380], expected[:380], rtol=0.0, atol=1e-12)
    assert (out[200 + latency : 380] == moving[200 + latency : 380]).all(), "exact as soon as everything has arrived"
    assert out[380:].tobytes() == streamed(SHAPER, moving[380:]).tobytes(), "shaped again, from rest"
    assert np.abs(np.diff(out)).max() <= 2.0 * 0.05 + 1e-12
    assert pins[:200, 0].all() and not pins[200:380, 0].any() and pins[380:, 0].all()


def test_a_bypass_shorter_than_the_shaper_is_left_to_the_end(run: Run) -> None:
    latency = render(SHAPER, "linuxcnc", dt=DT).placed.latency_samples
    moving = np.arange(600) * 0.05
    out, pins, _ = run(SHAPER, moving, switches(600, once=("bypass", slice(200, 203))))
    assert not pins[200 : 200 + latency, 0].any() and pins[200 + latency + 2 :, 0].all()
    assert np.abs(np.diff(out)).max() <= 2.0 * 0.05 + 1e-12


def test_what_is_not_finite_is_not_taken(run: Run) -> None:
    command = WALK.copy()
    command[[100, 101, 250]] = np.nan, np.inf, -1e300
    good = np.abs(command) < 1e250
    out, _, _ = run(SHAPER, command)
    assert out[good].tobytes() == streamed(SHAPER, command[good]).tobytes()
    assert (out[[100, 101, 250]] == out[[99, 99, 249]]).all()


@pytest.mark.parametrize("relative", [-3.0, -0.9, 0.9, 3.0])
def test_another_period_is_said_and_nothing_is_shaped(run: Run, relative: float) -> None:
    period = round(1e6 * (1.0 + relative * PERIOD_TOLERANCE))
    out, pins, said = run(SHAPER, WALK[:50], period=period)
    if abs(relative) < 1.0:
        assert pins.all() and out.tobytes() == streamed(SHAPER, WALK[:50]).tobytes()
    else:
        assert not pins.any() and out.tobytes() == WALK[:50].tobytes()
    sentence = f"gantry_x: the thread's period is {period} ns, and the shaper is for 1000000 ns"
    assert said.count(sentence) == (abs(relative) > 1.0)


def test_nine_joints_with_the_longest_shaper_fit_into_the_memory_of_hal(tmp_path: Path) -> None:
    longest = Shaper([0.0, 8.191], [0.5, 0.5])
    exported = render(longest, "linuxcnc", dt=DT, name="gantry_x")
    assert exported.placed.ring_bytes == 1 << 16
    (tmp_path / "gantry_x.comp").write_text(str(exported.files["gantry_x.comp"]))
    out, pins, _ = hal.run(hal.build(tmp_path / "gantry_x.comp"), WALK, tmp_path, others=8)
    assert out.tobytes() == streamed(longest, WALK).tobytes() and pins.all()


def test_several_joints_share_a_module(tmp_path: Path) -> None:
    """Each instance has its own past; halcompile knows the pins by their names."""
    needed("halcompile")
    path = tmp_path / "gantry_x.comp"
    path.write_text(str(render(SHAPER, "linuxcnc", dt=DT, name="gantry_x").files["gantry_x.comp"]))
    succeeded("halcompile", "--preprocess", path.name, cwd=tmp_path)
    text = path.with_suffix(".c").read_text()
    assert "names=" in text and "static double" in text
    state = text.split("struct __comp_state {")[1].split("};")[0]
    assert "double ring[32];" in state, "each joint has a ring of its own"


def test_no_multiplication_is_fused_on_a_processor_that_could(tmp_path: Path) -> None:
    """gcc fuses by default where the processor can, and samples would differ; without the pragma it does."""
    needed("halcompile", "gcc")
    path = tmp_path / "gantry_x.comp"
    path.write_text(str(render(SHAPER, "linuxcnc", dt=DT, name="gantry_x").files["gantry_x.comp"]))
    succeeded("halcompile", "--preprocess", path.name, cwd=tmp_path)
    source = path.with_suffix(".c")
    flags = ["-O2", "-march=haswell", "-DRTAPI", "-DUSPACE", "-D__MODULE__", "-I/usr/include/linuxcnc", "-S"]
    fused = {}
    for kept in (True, False):
        if not kept:
            source.write_text(source.read_text().replace("#pragma GCC optimize", "// "))
        succeeded("gcc", *flags, source.name, "-o", "part.s", cwd=tmp_path)
        fused[kept] = "vfmadd" in (tmp_path / "part.s").read_text()
    if "x86-64" in succeeded("gcc", "-dumpmachine").replace("_", "-"):
        assert fused == {True: False, False: True}


def test_notes_say_what_the_machine_sees() -> None:
    exported = render(SHAPER, "linuxcnc", dt=DT, name="gantry_x")
    text, placed = str(exported.files["gantry_x.comp"]), exported.placed
    assert f"altogether after {placed.latency_samples} samples, {1e3 * placed.latency:.6g} ms" in text
    assert f"speed times\n{placed.shaper.centroid:.4g} s" in text and "FERROR" in text and "home switch" in text
    assert "@" not in text and "\r" not in text
    assert "pin in float in" in text and "out = " in text and "_set(" not in text
    master = str(render(SHAPER, "linuxcnc", dt=DT, name="gantry_x", version="master").files["gantry_x.comp"])
    assert "pin in real in" in master and "out_set(" in master and "did not" in master
