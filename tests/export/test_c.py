"""`preshape export c`: strict compilers, sanitizers, a self-test that passes, and that fails on any damage."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from tests.export.exports import DT, NAMES, shaper_of, written
from tests.tools import SANITIZERS, STRICT, needed, ran, succeeded, unable

from preshape import Shaper, design
from preshape.export import render
from preshape.export.c.golden import START, Golden

ROOT = Path(__file__).resolve().parents[2]
SHAPER = design.zvd([(8.7, 0.024), (31.0, 0.01)])
SIGNED = design.um_zvd((8.7, 0.024))
ONE = Shaper([0.0], [1.0])
LONG = Shaper([0.0, 3.0, 6.001], [0.25, 0.5, 0.25])
PRECISIONS = ["double", "single"]


def built(folder: Path, precision: str, *flags: str, compiler: str = "gcc") -> Path:
    """The self-test of the export in `folder`."""
    single = ["-DPRESHAPE_SINGLE"] if precision == "single" else []
    sources = sorted(path.name for path in folder.glob("*.c"))
    succeeded(compiler, *STRICT, *single, *flags, *sources, "-o", "selftest", cwd=folder)
    return folder / "selftest"


def test_the_kernel_is_the_file_that_python_runs() -> None:
    files = render(SHAPER, "c", dt=0.001).files
    for name in ("preshape_kernel.h", "preshape_kernel.c"):
        assert files[name] == (ROOT / "src" / "preshape" / "kernel" / "c" / name).read_bytes()


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("shaper", [SHAPER, SIGNED, ONE, LONG], ids=["zvd", "um_zvd", "one", "long"])
def test_the_self_test_compiles_without_a_word_and_passes(
    shaper: Shaper, precision: str, compiler: str, tmp_path: Path
) -> None:
    needed(compiler)
    exported = render(shaper, "c", dt=0.001, name="gantry_x", precision=precision)
    program = built(written(exported, tmp_path), precision, "-O2", compiler=compiler)
    assert f"{Golden(exported.placed).total} samples, every bit as in Python" in succeeded(program)


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("family", NAMES[::4])
def test_it_passes_under_the_sanitizers(family: str, precision: str, tmp_path: Path) -> None:
    needed("gcc")
    if ran("gcc", *SANITIZERS, "-xc", "/dev/null", "-c", "-o", tmp_path / "nothing.o").returncode != 0:
        unable("this gcc has no sanitizers")
    folder = written(render(shaper_of(family), "c", dt=DT, precision=precision), tmp_path)
    succeeded(built(folder, precision, "-O1", *SANITIZERS))


@pytest.mark.parametrize("precision", PRECISIONS)
def test_cppcheck_finds_nothing(precision: str, tmp_path: Path) -> None:
    needed("cppcheck")
    written(render(SHAPER, "c", dt=0.001, precision=precision), tmp_path)
    single = ["-DPRESHAPE_SINGLE"] if precision == "single" else []
    quiet = ["--enable=warning,performance,portability", "--std=c99", "--error-exitcode=1", "--quiet"]
    succeeded("cppcheck", *quiet, *single, *sorted(tmp_path.glob("*.c")))


def damaged_weight(folder: Path) -> None:
    """The last bit of one weight."""
    path = folder / "shaper.c"
    weights = re.findall(r"0x1\.[0-9a-f]{12}[0-9a-f]p-?[0-9]+", path.read_text())
    low = "0" if weights[2].split("p")[0][-1] != "0" else "1"
    path.write_text(path.read_text().replace(weights[2], re.sub(r".(p-?[0-9]+)$", rf"{low}\1", weights[2]), 1))


def damaged_delay(folder: Path) -> None:
    path = folder / "shaper.c"
    delays = re.findall(r"([0-9]+)u,", path.read_text())
    path.write_text(path.read_text().replace(f" {delays[1]}u,", f" {int(delays[1]) - 1}u,", 1))


def damaged_golden(folder: Path) -> None:
    path = folder / "shaper_selftest.c"
    head, tail = path.read_text().split("golden[", 1)
    path.write_text(head + "golden[" + re.sub(r"p([-+])", r"p\g<1>1", tail, count=1))


def damaged_sum(folder: Path) -> None:
    """A weight with the other sign: the sum is not 1, which the kernel refuses."""
    path = folder / "shaper.c"
    path.write_text(path.read_text().replace("    0x1.", "    -0x1.", 1))


def damaged_kernel(folder: Path) -> None:
    path = folder / "preshape_kernel.c"
    path.write_text(path.read_text().replace("return reference + sum;", "return sum + reference + ZERO * u;"))
    path.write_text(path.read_text().replace("(at - delays[k]) & mask", "(at - delays[k] + 1u) & mask"))


def damaged_latency(folder: Path) -> None:
    path = folder / "shaper.h"
    path.write_text(re.sub(r"_LATENCY [0-9]+u", "_LATENCY 3u", path.read_text(), count=1))


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        (damaged_weight, "push, sample"),
        (damaged_delay, "push, sample"),
        (damaged_golden, "push, sample 0: "),
        (damaged_sum, "the table is not accepted"),
        (damaged_kernel, "push, sample"),
        (damaged_latency, "the table is not accepted"),
    ],
)
@pytest.mark.parametrize("shaper", [SHAPER, LONG], ids=["short", "long"])
def test_the_self_test_fails_when_anything_is_damaged(
    damage: object, sentence: str, shaper: Shaper, tmp_path: Path
) -> None:
    needed("gcc")
    written(render(shaper, "c", dt=0.001, grid="linear"), tmp_path)
    succeeded(built(tmp_path, "double"))
    damage(tmp_path)  # type: ignore[operator]
    done = ran(built(tmp_path, "double"))
    assert done.returncode == 1 and sentence in done.stdout


def test_fast_math_and_the_wrong_precision_do_not_compile(tmp_path: Path) -> None:
    needed("gcc")
    for precision, flag, sentence in (
        ("double", "-DPRESHAPE_SINGLE", "double precision was exported: compile without PRESHAPE_SINGLE"),
        ("single", "-O1", "single precision was exported: compile everything with PRESHAPE_SINGLE"),
        ("double", "-ffast-math", "must not be reordered"),
    ):
        folder = written(render(SHAPER, "c", dt=0.001, precision=precision), tmp_path / precision)
        done = ran("gcc", "-std=c99", flag, *sorted(folder.glob("*.c")), "-o", tmp_path / "selftest")
        assert done.returncode != 0 and sentence in done.stderr


def test_the_self_test_may_be_called_from_other_code(tmp_path: Path) -> None:
    needed("gcc")
    written(render(SHAPER, "c", dt=0.001), tmp_path)
    (tmp_path / "firmware.c").write_text("int check(void);\nint main(void) { return check(); }\n")
    succeeded(built(tmp_path, "double", "-DPRESHAPE_SELFTEST=check"))


@pytest.mark.parametrize("precision", PRECISIONS)
def test_two_shapers_share_a_program_and_take_the_memory_that_is_said(precision: str, tmp_path: Path) -> None:
    """The table's constants are in read-only memory: nothing of it is in .data or .bss."""
    needed("gcc", "size")
    single = ["-DPRESHAPE_SINGLE"] if precision == "single" else []
    for name in ("gantry_x", "gantry_y"):
        exported = render(SHAPER, "c", dt=0.001, name=name, precision=precision)
        written(exported, tmp_path)
        (tmp_path / f"{name}_selftest.c").unlink()
    (tmp_path / "firmware.c").write_text(
        f"""#include "gantry_x.h"
        #include "gantry_y.h"
        static preshape_real ring[GANTRY_X_RING];
        typedef char ring_is_as_said[(sizeof ring == {exported.placed.ring_bytes}u) ? 1 : -1];
        typedef char state_is_small[(sizeof(preshape_gather) < 64u) ? 1 : -1];
        int main(void) {{
            preshape_gather axis;
            return (preshape_gather_configure(&axis, &gantry_x_table, ring, GANTRY_X_RING) != PRESHAPE_OK)
                || (preshape_gather_configure(&axis, &gantry_y_table, ring, GANTRY_Y_RING / 2u)
                    != PRESHAPE_RING_TOO_SMALL);
        }}"""
    )
    succeeded(built(tmp_path, precision))
    succeeded("gcc", "-std=c99", *single, "-c", "gantry_x.c", "-o", "table.o", cwd=tmp_path)
    sections = dict(re.findall(r"^(\.data|\.bss)\s+([0-9]+)", succeeded("size", "-A", tmp_path / "table.o"), re.M))
    assert sections == {".data": "0", ".bss": "0"}


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_no_multiplication_is_fused_on_a_processor_that_could(compiler: str, tmp_path: Path) -> None:
    """With the options of the compile line, or with C99 alone; when fusing is asked for, there is something to fuse."""
    needed(compiler)
    if "x86_64" not in succeeded(compiler, "-dumpmachine"):
        pytest.skip("the option is for x86-64")
    folder = written(render(SHAPER, "c", dt=0.001), tmp_path)
    line = render(SHAPER, "c", dt=0.001).target.next_step(render(SHAPER, "c", dt=0.001).placed)[1].split()
    for flags, fused in ((line[1:4], False), (["-std=c99", "-O2"], False), (["-ffp-contract=fast", "-O2"], True)):
        if compiler == "clang" and fused:
            source = folder / "preshape_kernel.c"
            source.write_text(source.read_text().replace("#pragma STDC", "/* #pragma STDC"))
        succeeded(compiler, *flags, "-march=haswell", "-S", "preshape_kernel.c", "-o", "kernel.s", cwd=folder)
        assert ("vfmadd" in (folder / "kernel.s").read_text()) == fused, flags


def test_golden_samples_are_those_of_a_plain_convolution() -> None:
    """Independent of the kernel: numpy.convolve in double, to rounding; in single to its rounding."""
    for shaper in (SHAPER, SIGNED, LONG, ONE):
        for precision, tolerance in (("double", 1e-13), ("single", 1e-5)):
            placed = render(shaper, "c", dt=0.001, precision=precision).placed
            golden = Golden(placed)
            command, last = golden.command(), placed.latency_samples
            taps = np.zeros(last + 1)
            taps[placed.delays] = placed.weights
            padded = np.concatenate([np.full(last, START), command])
            plain = np.convolve(padded, taps)[last : last + golden.total]
            left = np.abs(np.array(golden.shaped()) - plain[:: golden.every]).max()
            assert left < tolerance * np.abs(command).max()
            assert len(golden.shaped()) <= 257 and (command.astype(np.float32) == command).all()
            assert golden.total > 3 * last and (command[-last - 1 :] == command[-1]).all()


def test_the_longest_shaper_is_exported_in_small_files(tmp_path: Path) -> None:
    needed("gcc")
    longest = Shaper([0.0, 2.0**20 * 0.001], [0.5, 0.5])
    exported = render(longest, "c", dt=0.001, precision="single")
    assert exported.placed.latency_samples == 1 << 20
    assert (Golden(exported.placed).command().astype(np.float32) == Golden(exported.placed).command()).all()
    assert sum(map(len, exported.files.values())) < 60_000
    succeeded(built(written(exported, tmp_path), "single", "-O2"))


def test_nothing_is_left_behind_of_a_template() -> None:
    for precision in PRECISIONS:
        for text in render(SHAPER, "c", dt=0.001, precision=precision).files.values():
            assert b"@" not in (text if isinstance(text, bytes) else text.encode())


def test_the_line_on_the_screen_is_the_line_in_the_file(tmp_path: Path) -> None:
    needed("gcc")
    for precision in PRECISIONS:
        exported = render(SHAPER, "c", dt=0.001, name="gantry_x", precision=precision)
        _, line, run, *_ = exported.target.next_step(exported.placed)
        assert line.strip() in str(exported.files["gantry_x_selftest.c"])
        written(exported, tmp_path)
        succeeded("sh", "-c", f"{line} && {run}", cwd=tmp_path)
