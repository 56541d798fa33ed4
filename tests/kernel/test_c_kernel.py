"""The kernel's C source by itself: strict compilers, sanitizers, a checker, both precisions, sizes and refusals."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ROOT / "src" / "preshape" / "kernel" / "c"
STRICT = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror"]
COMPILERS = [name for name in ("gcc", "clang") if shutil.which(name)]
PRECISIONS = [pytest.param([], id="double"), pytest.param(["-DPRESHAPE_SINGLE"], id="float")]

needs_a_compiler = pytest.mark.skipif(not COMPILERS, reason="there is neither gcc nor clang here")


def compiled(*arguments: str | Path) -> None:
    finished = subprocess.run([*map(str, arguments)], capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stderr


@needs_a_compiler
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("level", ["-O0", "-O3"])
def test_strict_compilers_have_nothing_to_say(compiler: str, precision: list[str], level: str, tmp_path: Path) -> None:
    target = tmp_path / "kernel.o"
    compiled(compiler, *STRICT, *precision, level, "-c", SOURCES / "preshape_kernel.c", "-o", target)
    symbols = subprocess.run(["nm", "-u", target], capture_output=True, text=True, check=True).stdout.split()
    assert set(symbols) - {"U"} <= {"memcpy", "memset", "_GLOBAL_OFFSET_TABLE_"}, "no library but what gcc itself needs"


@needs_a_compiler
@pytest.mark.parametrize("precision", PRECISIONS)
def test_both_precisions_may_be_linked_together_and_sizes_are_constants(precision: list[str], tmp_path: Path) -> None:
    program = tmp_path / "sizes.c"
    program.write_text(
        """#include "preshape_kernel.h"
        typedef char gather_is_small[(sizeof(preshape_gather) <= 64u) ? 1 : -1];
        typedef char scatter_is_small[(sizeof(preshape_scatter) <= 64u) ? 1 : -1];
        typedef char rings[((PRESHAPE_RING(0) == 1u) && (PRESHAPE_RING(1) == 2u) && (PRESHAPE_RING(2) == 4u) &&
                            (PRESHAPE_RING(1023) == 1024u) && (PRESHAPE_RING(1024) == 2048u)) ? 1 : -1];
        static const uint32_t delays[2] = {0u, 5u};
        static const preshape_real weights[2] = {(preshape_real)0.5, (preshape_real)0.5};
        static const preshape_shaper shaper = {delays, weights, 2u};
        static preshape_real ring[PRESHAPE_RING(5)];
        int main(void) {
            preshape_gather g;
            preshape_real y;
            return (preshape_gather_configure(&g, &shaper, ring, PRESHAPE_RING(5)) != PRESHAPE_OK) ||
                   (preshape_gather_push(&g, (preshape_real)4.0, &y) != PRESHAPE_OK) || !(y >= (preshape_real)2.0);
        }"""
    )
    objects = []
    for name, flags in (("double", []), ("float", ["-DPRESHAPE_SINGLE"])):
        objects.append(tmp_path / f"{name}.o")
        compiled(COMPILERS[0], *STRICT, *flags, "-c", SOURCES / "preshape_kernel.c", "-o", objects[-1])
    compiled(COMPILERS[0], *STRICT, *precision, f"-I{SOURCES}", program, *objects, "-o", tmp_path / "sizes")
    assert subprocess.run([tmp_path / "sizes"], check=False).returncode == 0


@needs_a_compiler
@pytest.mark.parametrize("precision", PRECISIONS)
def test_a_second_of_random_use_under_the_sanitizers(precision: list[str], tmp_path: Path) -> None:
    """The harness that libFuzzer runs for longer: tests/fuzz/fuzz_kernel.c."""
    program = tmp_path / "fuzz"
    sanitizers = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    source = ROOT / "tests" / "fuzz" / "fuzz_kernel.c"
    flags = ["-std=c99", "-DSTANDALONE", *precision, "-g", "-O1", *sanitizers, f"-I{SOURCES}"]
    built = subprocess.run([COMPILERS[0], *flags, source, "-o", program], capture_output=True, text=True, check=False)
    if built.returncode != 0 and ("cannot find" in built.stderr or "unrecognized" in built.stderr):
        pytest.skip("this compiler has no sanitizers")
    assert built.returncode == 0, built.stderr
    finished = subprocess.run([program, "1", "1992"], capture_output=True, text=True, check=False)
    assert finished.returncode == 0 and "no finding" in finished.stdout, finished.stderr


@pytest.mark.skipif(not shutil.which("cppcheck"), reason="cppcheck is not installed")
@pytest.mark.parametrize("precision", PRECISIONS)
def test_cppcheck_finds_nothing(precision: list[str]) -> None:
    compiled(
        "cppcheck", "--enable=warning,performance,portability", "--std=c99", "--error-exitcode=1", "--quiet",
        *precision, SOURCES / "preshape_kernel.c",
    )  # fmt: skip


@needs_a_compiler
def test_float_does_in_float_what_double_does_in_double(tmp_path: Path) -> None:
    """Against the same operations in NumPy's float32, bit for bit."""

    class Shaper(ctypes.Structure):
        _fields_ = [("delays", ctypes.c_void_p), ("weights", ctypes.c_void_p), ("taps", ctypes.c_uint32)]

    class Gather(ctypes.Structure):
        _fields_ = [("shaper", ctypes.c_void_p), ("ring", ctypes.c_void_p), ("mask", ctypes.c_uint32),
                    ("at", ctypes.c_uint32)]  # fmt: skip

    path = tmp_path / "kernel.so"
    flags = ["-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-DPRESHAPE_SINGLE"]
    compiled(COMPILERS[0], *flags, SOURCES / "preshape_kernel.c", "-o", path)
    library = ctypes.CDLL(str(path))
    random = np.random.default_rng(0)
    delays = np.array([0, 3, 4, 9, 30], dtype=np.uint32)
    weights = np.array([0.25, -0.5, 0.75, 0.3, 0.2], dtype=np.float32)
    ring, command = np.zeros(64, dtype=np.float32), random.normal(size=500).astype(np.float32)
    shaper = Shaper(delays.ctypes.data, weights.ctypes.data, 5)
    gather = Gather()
    configure = library.preshape_gather_configure_f32
    sizes = {0: 2, 24: 2, 16: 3, 32: 0, 64: 0}  # status of each ring: no power of two, too small, right
    for size, status in sizes.items():
        code = configure(ctypes.byref(gather), ctypes.byref(shaper), ctypes.c_void_p(ring.ctypes.data), size)
        assert code == status
    shaped = np.zeros_like(command)
    block = library.preshape_gather_block_f32
    block.restype = ctypes.c_size_t
    block.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t]
    assert block(ctypes.addressof(gather), command.ctypes.data, shaped.ctypes.data, 500) == 500
    padded = np.concatenate([np.zeros(30, dtype=np.float32), command])
    reference, total = padded[:500], np.zeros(500, dtype=np.float32)
    for delay, weight in zip(delays[:-1].tolist(), weights[:-1], strict=True):
        total += weight * (padded[30 - delay : 530 - delay] - reference)
    np.testing.assert_array_equal(shaped, reference + total)
    command[200] = np.float32(1e19)  # beyond what float may take
    assert block(ctypes.addressof(gather), command.ctypes.data, shaped.ctypes.data, 500) == 200
