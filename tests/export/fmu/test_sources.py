"""The C in the FMU: strict compilers, the official headers, every function of FMI, static linking, sanitizers."""

from __future__ import annotations

import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.build import build_platform_binary
from tests.export.fmu.slaves import DT, RANDOM, Slave, exported, written

from preshape.stream import Stream

COMPILERS = [name for name in ("gcc", "clang") if shutil.which(name)]
STRICT = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]
HEADERS = Path(fmpy.__file__).parent / "c-code"
PRECISIONS = [pytest.param("double", [], id="double"), pytest.param("single", ["-DPRESHAPE_SINGLE=1"], id="single")]

pytestmark = pytest.mark.skipif(not COMPILERS, reason="there is neither gcc nor clang here")


def sources(folder: Path, name: str = "two modes", precision: str = "double") -> list[Path]:
    with zipfile.ZipFile(written(exported(name, precision=precision), folder)) as archive:
        archive.extractall(folder)
    return sorted((folder / "sources").glob("*.c"))


def run(*command: str | Path) -> str:
    finished = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    return finished.stdout


@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize(("precision", "flags"), PRECISIONS)
@pytest.mark.parametrize("level", ["-O0", "-O3"])
def test_strict_compilers_have_nothing_to_say(
    compiler: str, precision: str, flags: list[str], level: str, tmp_path: Path
) -> None:
    for source in sources(tmp_path, precision=precision):
        run(compiler, *STRICT, *flags, level, "-c", source, "-o", tmp_path / "unit.o")


def test_our_declarations_are_those_of_the_standard(tmp_path: Path) -> None:
    """The wrapper compiled against the official headers, in which every function must be what it is here."""
    units = sources(tmp_path)
    (tmp_path / "sources" / "preshape_fmi3.h").write_text(
        '#include "fmi3Functions.h"\n#define FMI3(name) fmi3##name\n#define FMI3_API FMI3_Export\n'
    )
    for source in units:
        if source.name != "preshape_kernel.c":
            flags = ["-std=c99", "-Wall", "-Wextra", "-Wmissing-prototypes", "-Werror", f"-I{HEADERS}"]
            run(COMPILERS[0], *flags, "-c", source, "-o", tmp_path / "unit.o")


def test_the_binary_exports_every_function_of_fmi_and_nothing_else(tmp_path: Path) -> None:
    sources(tmp_path)
    (library,) = (tmp_path / "binaries").rglob("*.so")
    exported_names = set(re.findall(r" T (\w+)", run("nm", "-D", "--defined-only", library)))
    declared = re.findall(r"^FMI3_Export \w+\s+(\w+);", (HEADERS / "fmi3Functions.h").read_text(), re.MULTILINE)
    assert exported_names == set(declared)
    needed = set(re.findall(r" U (\w+)", run("nm", "-D", "--undefined-only", library)))
    assert needed <= {"calloc", "malloc", "free", "memcpy", "memset", "memcmp", "bcmp", "strcmp", "snprintf",
                      "__snprintf_chk", "__stack_chk_fail"}  # fmt: skip


def test_with_a_prefix_for_static_linking(tmp_path: Path) -> None:
    for source in sources(tmp_path):
        run(COMPILERS[0], *STRICT, "-DFMI3_FUNCTION_PREFIX=axis_", "-c", source, "-o", tmp_path / f"{source.stem}.o")
    names = re.findall(r" T (\w+)", run("nm", "--defined-only", *tmp_path.glob("*.o")))
    assert "axis_fmi3DoStep" in names and not any(name.startswith("fmi3") for name in names)


@pytest.mark.parametrize(("precision", "flags"), PRECISIONS)
def test_an_importer_in_c_under_the_sanitizers(precision: str, flags: list[str], tmp_path: Path) -> None:
    units = sources(tmp_path, precision=precision)
    sanitizers = ["-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all", "-g", "-O1"]
    command = [COMPILERS[0], *STRICT, *flags, *sanitizers, f"-I{tmp_path / 'sources'}", *map(str, units)]
    driver = [str(Path(__file__).with_name("driver.c")), "-lm", "-o", str(tmp_path / "driver")]
    built = subprocess.run([*command, *driver], capture_output=True, text=True, check=False)
    if built.returncode != 0 and ("cannot find" in built.stderr or "unrecognized" in built.stderr):
        pytest.skip("this compiler has no sanitizers")
    assert built.returncode == 0, built.stderr
    run(tmp_path / "driver")


@pytest.mark.parametrize("precision", ["double", "single"])
def test_an_importer_compiles_the_sources_by_the_build_description(precision: str, tmp_path: Path) -> None:
    """With fmpy's own build, through CMake, instead of the binary that came with it."""
    if not shutil.which("make"):
        pytest.skip("CMake needs make")
    sources(tmp_path, precision=precision)
    (library,) = (tmp_path / "binaries").rglob("*.so")
    ours = Slave(tmp_path).started().shape(RANDOM)
    library.unlink()
    build = tmp_path / "build"
    build.mkdir()
    build_platform_binary(tmp_path, build_dir=build, generator="Unix Makefiles")
    assert library.exists() and DT > 0.0
    assert Slave(tmp_path).started().shape(RANDOM) == ours


def test_a_damaged_weight_shows_in_the_samples(tmp_path: Path) -> None:
    """What the comparisons bit for bit would say to one wrong digit."""
    units = sources(tmp_path, "two modes")
    stream = Stream(exported("two modes").placed.shaper, DT)
    expected = stream.push_block(RANDOM).tolist()
    assert Slave(tmp_path).started().shape(RANDOM) == expected
    taps = tmp_path / "sources" / "preshape_taps.h"
    digits = f"{exported('two modes').placed.weights[3]:.16e}"
    assert digits in taps.read_text()
    taps.write_text(taps.read_text().replace(digits, f"{np.nextafter(float(digits), 2.0):.16e}"))
    (library,) = (tmp_path / "binaries").rglob("*.so")
    other = tmp_path / "damaged"
    shutil.copytree(library.parent, other / "binaries" / library.parent.name)
    shutil.copy(tmp_path / "modelDescription.xml", other)
    built = other / "binaries" / library.parent.name / "axis.so"
    built.unlink()
    run(COMPILERS[0], "-std=c99", "-O2", "-fPIC", "-shared", *units, "-o", built)
    assert Slave(other).started().shape(RANDOM) != expected
