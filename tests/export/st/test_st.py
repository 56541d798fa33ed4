"""The structured text: parsed by blark, executed from its tree, and the same samples as in Python, bit for bit."""

from __future__ import annotations

import math
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from blark.parse import parse as parse_twincat
from hypothesis import given, settings
from hypothesis import strategies as st_random
from tests.export.st.interpreter import Instance, Machine, parsed

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.export import render, st
from preshape.export.target import Exported
from preshape.stream import Stream

DT = 0.004
SHAPERS = {
    "zvd": design.zvd((8.7, 0.024)),
    "negative": design.um_zv((8.7, 0.024)),
    "two modes": design.direct([(3.1, 0.01), (8.7, 0.05)]),
    "nothing": Shaper([0.0], [1.0]),
    "a delay": Shaper([0.0, 0.02], [0.001, 0.999]),
    "boxes": Shaper([0.0], [0.5], boxes=[(0.01, 0.06, 10.0)]),
}


def exported(shaper: Shaper, **wishes: str) -> Exported:
    return render(shaper, "st", dt=DT, **wishes)


def block(export: Exported) -> Instance:
    return Machine(str(export.files["FB_Shaper.st"])).instance("FB_Shaper")


def shaped(instance: Instance, command: np.ndarray) -> list[float]:
    return [float(instance.call(Enable=True, Command=u).Shaped) for u in command.tolist()]


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", SHAPERS)
def test_blark_parses_every_file(name: str, precision: str) -> None:
    for file, text in exported(SHAPERS[name], precision=precision).files.items():
        (unit,) = parsed(str(text))
        assert file == f"{unit.name}.st"
        assert str(text).isascii() and max(map(len, str(text).splitlines())) <= 140


def test_names_become_names_of_a_plc() -> None:
    files = exported(SHAPERS["zvd"], name="x_axis_2").files
    assert sorted(files) == ["FB_XAxis2.st", "PRG_XAxis2Test.st"]
    assert [str(parsed(str(files[file]))[0].name) for file in sorted(files)] == ["FB_XAxis2", "PRG_XAxis2Test"]


@pytest.mark.parametrize("name", SHAPERS)
def test_the_samples_are_those_of_a_stream(name: str) -> None:
    export = exported(SHAPERS[name])
    random = np.random.default_rng(61131)
    start = 20.0
    command = start + np.concatenate([np.zeros(3), np.cumsum(random.normal(size=300)), 1e9 * random.normal(size=50)])
    stream = Stream(export.placed.shaper, DT)
    stream.reset(start)
    instance = block(export)
    assert shaped(instance, command) == stream.push_block(command).tolist()
    assert instance.Valid and not instance.Error
    offline = export.placed.shaper.shape(command, DT, initial=start)[: command.size]
    assert shaped(block(export), command) == offline.tolist()


@pytest.mark.parametrize("name", SHAPERS)
def test_in_single_every_operation_is_rounded_to_real(name: str) -> None:
    """Against the definition in NumPy's float32."""
    export = exported(SHAPERS[name], precision="single")
    command = np.random.default_rng(1).normal(size=200).astype(np.float32)
    delays, weights = export.placed.delays.astype(int), export.placed.weights.astype(np.float32)
    padded = np.concatenate([np.full(delays[-1], command[0]), command])
    past = [padded[delays[-1] - delay : padded.size - delay] for delay in delays]
    total = np.zeros(command.size, dtype=np.float32)
    for weight, u in zip(weights[:-1], past[:-1], strict=True):
        total += weight * (u - past[-1])
    assert shaped(block(export), command) == (past[-1] + total).tolist()


@pytest.mark.parametrize(("precision", "damage"), [("double", 1e-12), ("single", 1e-5)])
@pytest.mark.parametrize("name", SHAPERS)
def test_the_self_test_passes_and_notices_a_damaged_weight(name: str, precision: str, damage: float) -> None:
    export = exported(SHAPERS[name], precision=precision)
    text, program = (str(export.files[file]) for file in ("FB_Shaper.st", "PRG_ShaperTest.st"))
    assert passes(text, program, export)
    values = list(re.finditer(r"-?\d\.\d{16}E[+-]\d\d", text[text.index("WEIGHTS : ARRAY") :]))
    assert len(values) == export.placed.weights.size
    if len(values) > 1:  # the last one is not used: it is what the others leave of 1
        smallest = min((value[0] for value in values[:-1]), key=lambda digits: abs(float(digits)))
        assert text.count(smallest) == 1
        assert not passes(text.replace(smallest, f"{float(smallest) + damage:.16E}"), program, export)


def passes(block_text: str, program_text: str, export: Exported) -> bool:
    program = Machine(block_text, program_text).instance("PRG_ShaperTest")
    for _ in range(int(export.placed.delays[-1]) + 16):
        assert not program.Done
        program.call()
    assert program.Done
    return bool(program.Passed)


def test_it_starts_at_rest_holds_a_constant_and_says_when_all_has_arrived() -> None:
    instance = block(exported(SHAPERS["zvd"]))
    longest = 29
    assert exported(SHAPERS["zvd"]).placed.delays[-1] == longest
    assert instance.call(Enable=True, Command=0.1).Shaped == 0.1 and instance.Settled
    assert instance.call(Command=0.3).Shaped < 0.3 and not instance.Settled
    for _ in range(longest - 1):
        assert not instance.call().Settled
    assert instance.call().Settled and instance.Shaped == 0.3


def test_disabled_it_passes_and_is_enabled_without_a_bump() -> None:
    instance = block(exported(SHAPERS["zvd"]))
    for u in (5.0, -3.0, 7.5):
        instance.call(Enable=False, Command=u)
        assert (instance.Shaped, instance.Valid, instance.Settled, instance.Error) == (u, False, True, False)
    assert instance.call(Enable=True).Shaped == 7.5 and instance.Valid
    assert instance.call(Command=8.5).Shaped not in (7.5, 8.5)
    instance.call(Enable=False, Command=9.0)
    assert instance.call(Enable=True, Command=11.0).Shaped == 11.0, "the past is forgotten"


def test_reset_is_rest_at_the_command() -> None:
    export = exported(SHAPERS["negative"])
    instance, stream = block(export), Stream(export.placed.shaper, DT)
    shaped(instance, np.random.default_rng(2).normal(size=40))
    assert instance.call(Reset=True, Command=4.0).Shaped == 4.0 and instance.Settled
    stream.reset(4.0)
    instance.call(Reset=False, Command=4.0)
    ramp = 4.0 + 0.1 * np.arange(60)
    assert shaped(instance, ramp) == stream.push_block(ramp).tolist()


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, "large"])
def test_what_is_not_finite_is_refused_and_poisons_nothing(bad: float | str, precision: str) -> None:
    export = exported(SHAPERS["zvd"], precision=precision)
    value = (1.1e250 if precision == "double" else 1.1e18) if bad == "large" else float(bad)
    command = np.random.default_rng(3).normal(size=120)
    clean = shaped(block(export), command)
    instance = block(export)
    assert instance.call(Enable=True, Command=value).Shaped == 0.0, "refused before the first good one: nothing started"
    assert instance.Error and not instance.Valid
    first = shaped(instance, command[:50])
    for _ in range(3):
        instance.call(Command=value)
        assert (instance.Shaped, instance.Error, instance.ErrorID, instance.Valid) == (first[-1], True, 1, False)
    assert first + shaped(instance, command[50:]) == clean
    assert not instance.Error and instance.ErrorID == 0
    instance.call(Enable=False, Command=value)
    assert (instance.Shaped, instance.ErrorID) == (clean[-1], 1)
    assert (instance.call(Command=5.0).Shaped, instance.ErrorID) == (5.0, 0)
    instance.call(Command=value)
    assert instance.call(Enable=True, Command=6.0).Shaped == 6.0, "disabled while refused is disabled"


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", SHAPERS)
def test_what_was_written_reads_back(name: str, precision: str) -> None:
    export = exported(SHAPERS[name], precision=precision)
    said = st.ST.parse(export.files)
    np.testing.assert_array_equal(said.delays, export.placed.delays)
    np.testing.assert_array_equal(said.weights, export.placed.weights)
    assert (said.dt, said.precision) == (DT, precision)
    encoded: dict[str, str | bytes] = {file: str(text).encode() for file, text in export.files.items()}
    assert st.ST.execute(encoded) == export.placed.shaper


def test_what_cannot_be_read_is_refused_with_a_sentence() -> None:
    files = {file: str(text) for file, text in exported(SHAPERS["zvd"]).files.items()}
    good = files["FB_Shaper.st"]
    damaged = {
        "0 of 0 files": {},
        "0 of 1 files are named": {"FB_Shaper.txt": good},
        "2 of 2 files": {"a.st": good, "b.st": good},
        "has no table": {"a.st": good.replace("DELAYS", "LATENESSES")},
        "not numbers": {"a.st": good.replace("        0, ", "        0, __import__('os'), ")},
        "delays and": {"a.st": good.replace("        0, ", "        ")},
        "larger than 20 MB": {"a.st": good + " " * 20_000_000},
        "not 1": {"a.st": re.sub(r"(\d\.\d+E-01)", "5.0E-01", good)},
        "above 0": {"a.st": good.replace("4.0000000000000001E-03", "0.0E+00")},
    }
    for sentence, content in damaged.items():
        with pytest.raises(InputError, match=sentence):
            st.ST.parse(content)


def test_a_family_from_a_file_cannot_leave_its_comment() -> None:
    record = design.zv((5.0, 0.0)).design
    shaper = SHAPERS["zvd"].with_design(type(record)(family="*) PROGRAM evil (*\n", modes=record.modes))
    text = str(exported(shaper).files["FB_Shaper.st"])
    assert "evil" in text and len(parsed(text)) == 1


@pytest.mark.parametrize("precision", ["double", "single"])
def test_the_files_of_twincat_hold_the_same_text(precision: str, tmp_path: Path) -> None:
    plain = exported(SHAPERS["zvd"], precision=precision)
    export = exported(SHAPERS["zvd"], precision=precision, version="twincat3")
    assert sorted(export.files) == ["FB_Shaper.TcPOU", "PRG_ShaperTest.TcPOU"]
    numbers = set()
    for file, text in export.files.items():
        (tmp_path / file).write_text(str(text))
        (unit,) = ElementTree.fromstring(str(text).encode()).iter("POU")
        declaration, body = unit.findtext("Declaration") or "", unit.findtext("Implementation/ST") or ""
        whole = str(plain.files[f"{unit.get('Name')}.st"])
        assert whole == f"{declaration}\n{body}{whole.splitlines()[-1]}\n" and file == f"{unit.get('Name')}.TcPOU"
        numbers.add(unit.get("Id"))
        results = list(parse_twincat(tmp_path / file))
        assert len(results) == 2 and all(result.exception is None for result in results)
    assert len(numbers) == 2
    assert st.ST.execute(export.files) == st.ST.execute(plain.files)


@given(st_random.data())
@settings(max_examples=60, deadline=None)
def test_whatever_the_file_holds_it_is_a_shaper_or_an_input_error(data: st_random.DataObject) -> None:
    good = str(exported(SHAPERS["zvd"]).files["FB_Shaper.st"])
    first = good.index("VAR CONSTANT")
    at = data.draw(st_random.integers(first, good.index("VAR\n", first)))
    piece = data.draw(st_random.text("0123456789.,-+E[]();:=* \n", max_size=6) | st_random.binary(max_size=4))
    cut = data.draw(st_random.integers(0, 6))
    insert = piece.encode() if isinstance(piece, str) else piece
    content = good[:at].encode() + insert + good[at + cut :].encode()
    try:
        assert isinstance(st.ST.execute({"a.st": content}), Shaper)
    except InputError:
        pass
