"""C: the kernel's own source, a table of the shaper, and a self-test with golden samples."""

from __future__ import annotations

from importlib.metadata import version
from importlib.resources import files as resources

from preshape.export.arithmetic import as_kernel
from preshape.export.c.golden import MULTIPLIER, OFFSET, START, UNIT, Golden
from preshape.export.c_source import (
    delay_rows,
    filled,
    modes_left,
    real,
    taps_of_source,
    title,
    weight_rows,
)
from preshape.export.read_back import MOST_TAPS, only_text
from preshape.export.target import Files, Limits, Placed, Taps, Target

__all__ = ["C"]

KERNEL = ("preshape_kernel.h", "preshape_kernel.c")

LONGEST = 1 << 20
"""Samples; the self-test's command of such a length is still exact in single precision."""


def _render(placed: Placed) -> Files:
    golden = Golden(placed)
    single = placed.precision == "single"
    shaped = golden.shaped()
    entry = 4 if single else 8
    values = {
        "name": placed.name,
        "NAME": placed.name.upper(),
        "title": title(placed),
        "notes": "\n".join(f" * {line}" for line in modes_left(placed)),
        "version": version("preshape"),
        "taps": placed.delays.size,
        "latency": placed.latency_samples,
        "milliseconds": f"{1e3 * placed.latency:.6g}",
        "ring": placed.ring,
        "bytes": placed.ring_bytes,
        "period": f"{placed.dt:.9g}",
        "sample_time": f"((preshape_real){placed.dt.hex()})",
        "precision": placed.precision,
        "guard": "#ifndef PRESHAPE_SINGLE" if single else "#ifdef PRESHAPE_SINGLE",
        "remedy": "everything with" if single else "without",
        "flags": _flags(placed),
        "compile": _compile_line(placed),
        "delays": delay_rows(placed),
        "weights": weight_rows(placed),
        "start": START,
        "ramp": golden.ramp,
        "hold": golden.hold,
        "total": golden.total,
        "every": golden.every,
        "multiplier": MULTIPLIER,
        "offset": f"{OFFSET}.0",
        "unit": UNIT.hex(),
        "count": len(shaped),
        "golden": "\n".join(f"    {real(value, placed.precision)}," for value in shaped),
        "memory": 3 * placed.ring_bytes + entry * len(shaped),
    }
    package = "preshape.export.c"
    kernel = {name: resources("preshape.kernel").joinpath("c", name).read_bytes() for name in KERNEL}
    return {
        **kernel,
        f"{placed.name}.h": filled(package, "table.h.in", **values),
        f"{placed.name}.c": filled(package, "table.c.in", **values),
        f"{placed.name}_selftest.c": filled(package, "selftest.c.in", **values),
    }


def _parse(files: Files) -> Taps:
    tables = {name: text for name, text in files.items() if not name.startswith("preshape_kernel.")}
    header = only_text(tables, ".h")
    source = only_text({name: text for name, text in tables.items() if not name.endswith("_selftest.c")}, ".c")
    return taps_of_source(f"{header}\n{source}", "single" if '#error "single precision' in header else "double")


def _flags(placed: Placed) -> str:
    return "-std=c99 -ffp-contract=off" + (" -DPRESHAPE_SINGLE" if placed.precision == "single" else "")


def _compile_line(placed: Placed) -> str:
    return (
        f"gcc {_flags(placed)} -O2 preshape_kernel.c {placed.name}.c {placed.name}_selftest.c -o {placed.name}_selftest"
    )


def _next_step(placed: Placed) -> tuple[str, ...]:
    return (
        "Run the self-test, with your compiler and on your processor:",
        f"  {_compile_line(placed)}",
        f"  ./{placed.name}_selftest",
        f"Then compile preshape_kernel.c and {placed.name}.c into your firmware; {placed.name}.h shows what to call.",
        f"Its ring takes {placed.ring_bytes} bytes of memory.",
    )


C = Target(
    "c",
    "C99 for any controller: kernel, table for flash, self-test",
    ("c99",),
    Limits(taps=MOST_TAPS, samples=LONGEST, precisions=("double", "single")),
    _render,
    _parse,
    as_kernel,
    _next_step,
)
