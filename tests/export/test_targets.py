"""The laws of every target on samples: what it writes is read back bit for bit, limits hold, garbage is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.export.exports import DT, NAMES, damaged, shaper_of

from preshape import Mode, Shaper, design
from preshape.errors import InputError
from preshape.export import TARGETS, Exported, Limits, Placed, Target, render
from preshape.provenance import Design
from preshape.vibration import residual_vibration

SAMPLED = {name: target for name, target in TARGETS.items() if isinstance(target, Target)}
EVERY = [
    pytest.param(target.name, version, precision, id=f"{target.name} {version} {precision}")
    for target in SAMPLED.values()
    for version in target.versions
    for precision in target.limits.precisions
]
SHAPER = design.zvd((8.7, 0.024))


def same(first: Shaper, second: Shaper) -> bool:
    return first.times.tobytes() == second.times.tobytes() and first.amplitudes.tobytes() == second.amplitudes.tobytes()


def as_asked(placed: Placed, on: Shaper) -> bool:
    """Every bit but the last weight's last: that weight is what the others leave of 1."""
    whole = [*on.amplitudes[:-1].tolist(), 1.0 - math.fsum(on.amplitudes[:-1])]
    return same(placed.shaper, Shaper(on.times, whole)) and abs(whole[-1] - on.amplitudes[-1]) < 1e-15


@pytest.mark.parametrize("family", NAMES)
@pytest.mark.parametrize(("target", "version", "precision"), EVERY)
def test_what_is_written_is_read_back_bit_for_bit(target: str, version: str, precision: str, family: str) -> None:
    exported = render(shaper_of(family), target, dt=DT, version=version, precision=precision, name="x_1")
    said, placed = exported.target.parse(exported.files), exported.placed
    assert (said.dt, said.precision) == (DT, precision)
    assert said.delays.tolist() == placed.delays.tolist() and said.weights.tobytes() == placed.weights.tobytes()
    assert same(exported.target.execute(exported.files, version), placed.shaper)


@pytest.mark.parametrize("grid", ["linear", "nearest", "exact", "optimised"])
def test_a_method_of_the_grid_can_be_chosen(grid: str) -> None:
    placed = render(SHAPER, "c", dt=DT, grid=grid).placed
    assert as_asked(placed, design.on_grid(SHAPER, DT, grid))
    assert placed.shaper.design.settings["grid_method"] == grid
    assert as_asked(render(SHAPER, "c", dt=DT).placed, design.on_grid(SHAPER, DT, "exact")), "the default"


def test_a_shaper_without_modes_is_split_linearly() -> None:
    given = Shaper([0.0, 0.0101], [0.5, 0.5])
    assert render(given, "c", dt=0.001).placed.shaper.design.settings["grid_method"] == "linear"
    text = str(render(given, "c", dt=0.001).files["shaper.h"])
    assert "not recorded" in text


@pytest.mark.parametrize("family", NAMES)
def test_in_single_precision_the_record_says_what_the_rounded_weights_leave(family: str) -> None:
    """Independent: the effective weights out of the table, their residual at each mode."""
    exported = render(shaper_of(family), "c", dt=DT, precision="single")
    placed = exported.placed
    np.testing.assert_array_equal(placed.weights, placed.weights.astype(np.float32))
    effective = exported.target.execute(exported.files)
    modes = placed.shaper.design.modes
    assert modes is not None
    left = residual_vibration(effective, [mode.frequency for mode in modes], [mode.damping for mode in modes])
    np.testing.assert_array_equal(placed.shaper.design.settings["residuals"], left)
    exact = render(shaper_of(family), "c", dt=DT).placed.shaper.design
    assert np.abs(left - exact.settings["residuals"]).max() < 1e-5 * placed.shaper.magnitude


def test_an_impulse_of_amplitude_zero_at_the_start_stays_the_start() -> None:
    shaper = Shaper([0.0, 0.01, 0.02], [0.0, 0.5, 0.5])
    for target in SAMPLED:
        exported = render(shaper, target, dt=0.01)
        assert exported.placed.delays.tolist() == [0, 1, 2]
        assert same(exported.target.execute(exported.files), shaper)


def test_memory_and_latency_are_those_of_the_ring() -> None:
    for latency, ring in ((0, 1), (1, 2), (7, 8), (8, 16), (1000, 1024)):
        shaper = Shaper([0.0, latency * 0.5], [0.5, 0.5]) if latency else Shaper([0.0], [1.0])
        placed = render(shaper, "c", dt=0.5).placed
        assert (placed.latency_samples, placed.latency, placed.ring) == (latency, 0.5 * latency, ring)
        assert placed.ring_bytes == 8 * ring
        assert render(shaper, "c", dt=0.5, precision="single").placed.ring_bytes == 4 * ring


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"target": "d"}, "target 'd' is not known: it is c, "),
        ({"version": "2.8", "target": "linuxcnc"}, "version '2.8' is not known for target linuxcnc: it is 2.9 or mast"),
        ({"precision": "half"}, "precision 'half' is not known for target c: it is double or single"),
        ({"precision": "single", "target": "linuxcnc"}, "precision 'single' is not known for target linuxcnc"),
        ({"name": "Gantry"}, "name 'Gantry' cannot be used"),
        ({"name": "x" * 32}, "cannot be used"),
        ({"name": "a/b"}, "cannot be used"),
        ({"name": ""}, "cannot be used"),
        ({"name": "x\n"}, "cannot be used"),
        ({"name": "preshape_kernel"}, "do not begin with preshape"),
        ({"name": 7}, "cannot be used"),
        ({"dt": None}, "target c works on samples of one axis: say the sample rate"),
        ({"axis": "x"}, "target c works on samples of one axis: say the sample rate, and leave the axis out"),
        ({"dt": 0.0}, "dt is 0 s"),
        ({"dt": float("nan")}, "dt is nan"),
        ({"dt": "fast"}, "dt must be a number"),
        ({"dt": 0.2}, "more than half a period"),
        ({"dt": 1e-8}, "samples long at dt = 1e-08 s and target c holds 1048576"),
        ({"dt": 1e-5, "target": "linuxcnc"}, "target linuxcnc holds 8191: sample less often"),
        ({"grid": "cubic"}, "method 'cubic' is not known"),
    ],
)
def test_what_cannot_be_exported_is_refused_in_a_sentence(options: dict[str, object], sentence: str) -> None:
    asked = {"target": "c", "dt": 0.001, **options}
    with pytest.raises(InputError, match=sentence):
        render(SHAPER, **asked)  # type: ignore[arg-type]


def test_limits_of_a_target_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    c = TARGETS["c"]
    monkeypatch.setitem(TARGETS, "c", replace(c, limits=Limits(taps=4, samples=1000, negative=False)))
    with pytest.raises(InputError, match="5 taps at dt = 0.001 s and target c holds 4: design one with fewer"):
        render(SHAPER, "c", dt=0.001)
    with pytest.raises(InputError, match="negative taps, which target c cannot hold"):
        render(Shaper([0.0, 1.0, 2.0], [1.0, -1.0, 1.0]), "c", dt=1.0)
    with pytest.raises(InputError, match="sum to 2e\\+06, and 1e\\+06 is the most"):
        monkeypatch.setitem(TARGETS, "c", c)
        render(Shaper([0.0, 1.0, 2.0], [1e6, 1.0, -1e6]), "c", dt=1.0)


@pytest.mark.parametrize("target", SAMPLED)
def test_text_of_the_shapers_file_stays_text(target: str) -> None:
    """A family's name may hold anything; it must not end a comment or a string."""
    evil = '*/ "; int x; """ \\ @name@ \n#error'
    exported = render(Shaper([0.0, 0.01], [0.5, 0.5], Design(evil)), target, dt=0.01)
    for name, text in exported.files.items():
        assert not name.startswith("shaper") or "#error\n" not in str(text) and "int x;" not in str(text)
    shaper = Shaper(SHAPER.times, SHAPER.amplitudes, Design(evil, design.zv(Mode(8.7, 0.024)).design.modes))
    exported = render(shaper, target, dt=0.001)
    assert same(exported.target.execute(exported.files), exported.placed.shaper)


FINISHED = {target: render(SHAPER, target, dt=0.001) for target in SAMPLED}


def refused_or_read(exported: Exported, files: dict[str, str | bytes]) -> None:
    """Whatever stands in the files: a shaper or a clear refusal, nothing else."""
    try:
        exported.target.execute(files)
    except InputError as error:
        assert str(error).endswith((".", ":", '"')) or len(str(error)) > 10


@pytest.mark.parametrize("target", SAMPLED)
@settings(max_examples=60)
@given(data=st.data())
def test_damaged_files_are_a_shaper_or_a_clear_refusal(target: str, data: st.DataObject) -> None:
    exported = FINISHED[target]
    files = dict(exported.files)
    name = data.draw(st.sampled_from(sorted(files)))
    content = files[name]
    raw = damaged(data, content, [b"{", b"}", b"0x1p9999,", b"nan,", b"-", b"/*", b"\xff", b"9" * 99], 400)
    files[name] = raw if data.draw(st.booleans()) else raw.decode("latin-1")
    refused_or_read(exported, files)


@pytest.mark.parametrize("target", SAMPLED)
@given(
    files=st.dictionaries(
        st.text(max_size=8) | st.sampled_from(["x.h", "x.c", "x.comp", "preshape_kernel.h", "x_selftest.c"]),
        st.text() | st.binary(),
        max_size=4,
    )
)
def test_garbage_is_refused(target: str, files: dict[str, str | bytes]) -> None:
    with pytest.raises(InputError):
        TARGETS[target].parse(files)
