"""The target "fmu": an FMI 3.0 co-simulation unit, in source and, where a C compiler is, compiled."""

from __future__ import annotations

import hashlib
import re
from importlib.resources import files as resources
from string import Template

from preshape.errors import InputError
from preshape.export.arithmetic import as_kernel
from preshape.export.fmu.archive import names_in, packed, unpacked
from preshape.export.fmu.binary import library
from preshape.export.read_back import numbers_in, taps_in
from preshape.export.target import Files, Limits, Placed, Taps, Target

__all__ = ["FMU"]

KERNEL = ("preshape_kernel.h", "preshape_kernel.c")
WRAPPER = ("preshape_fmi3.h", "preshape_fmu.h", "preshape_fmu.c", "preshape_fmu_rest.c", "preshape_fmu_state.c")
SINGLE = "PRESHAPE_SINGLE"
LIMIT = {"double": "1e250", "single": "1e18"}

NUMBER = r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
DT = re.compile(rf"#define PRESHAPE_TABLE_DT ({NUMBER}) /\* \[s\] \*/")
DELAYS = re.compile(r"\bDELAYS\[PRESHAPE_TABLE_TAPS\] = \{ /\* \[samples\] \*/([^}]*)\};")
WEIGHTS = re.compile(r"\bWEIGHTS\[PRESHAPE_TABLE_TAPS\] = \{ /\* \[-\], of sum 1 \*/([^}]*)\};")


def _render(placed: Placed) -> Files:
    """The FMU."""
    definitions = (f"{SINGLE}=1",) if placed.precision == "single" else ()
    sources = {name: _resource("preshape.kernel", "c", name) for name in KERNEL}
    sources |= {name: _resource("preshape.export.fmu", "c", name) for name in WRAPPER}
    values: dict[str, object] = {
        "name": placed.name,
        "precision": placed.precision,
        "dt": f"{placed.dt:.16e}",
        "seconds": repr(float(placed.dt)),
        "taps": placed.delays.size,
        "longest": int(placed.delays[-1]),
        "limit": LIMIT[placed.precision],
        "delays": _wrapped([f"{delay}u" for delay in placed.delays.tolist()]),
        "weights": _wrapped([f"{weight:.16e}" for weight in placed.weights.tolist()]),
        "definition": "".join(f'\n      <PreprocessorDefinition name="{one[:-2]}" value="1"/>' for one in definitions),
        "token": "$token",
    }
    filled = {file: _filled(file, values) for file in ("modelDescription.xml", "buildDescription.xml")}
    filled |= {file: _filled(file, values) for file in ("preshape_table.h", "preshape_taps.h")}
    token = _token({**sources, **filled})
    filled = {file: text.replace("$token", token) for file, text in filled.items()}
    sources |= {file: text for file, text in filled.items() if file.endswith(".h")}
    entries: dict[str, str | bytes] = {f"sources/{file}": text for file, text in sources.items()}
    entries["sources/buildDescription.xml"] = filled["buildDescription.xml"]
    entries["modelDescription.xml"] = filled["modelDescription.xml"]
    entries |= library(placed.name, sources, definitions)
    return {f"{placed.name}.fmu": packed(entries)}


def _parse(files: Files) -> Taps:
    """The taps in an FMU that :func:`_render` wrote, from its source."""
    found = [content for name, content in files.items() if name.lower().endswith(".fmu")]
    if len(found) != 1 or isinstance(found[0], str):
        raise InputError(f"{len(found)} of {len(files)} files are an FMU: give one, as bytes.")
    table, taps, build = unpacked(
        found[0], "sources/preshape_table.h", "sources/preshape_taps.h", "sources/buildDescription.xml"
    )
    dt, delays, weights = DT.search(table), DELAYS.search(taps), WEIGHTS.search(taps)
    if dt is None or delays is None or weights is None:
        raise InputError("the table in this FMU is not preshape's: give the FMU that it wrote, unchanged.")
    precision = "single" if SINGLE in build else "double"
    listed = numbers_in(delays[1].replace("u", ""), "delays")
    return taps_in(float(dt[1]), listed, numbers_in(weights[1], "weights"), precision)


def _notes(files: Files) -> tuple[str, ...]:
    """That there is no binary, if there is none."""
    names = [name for content in files.values() if isinstance(content, bytes) for name in names_in(content)]
    if any(name.startswith("binaries/") for name in names):
        return ()
    return (
        "the FMU holds sources only, as no C compiler made a binary here: let the simulation tool compile it, or "
        "export it on Linux with gcc or clang.",
    )


def _next_step(placed: Placed) -> tuple[str, ...]:
    return (
        f"Import it, and step it by {1e3 * placed.dt:.6g} ms or whole multiples: other steps are refused.",
        "Command in, shaped out; set the parameter initial to where the machine rests.",
    )


def _token(content: dict[str, str]) -> str:
    """A name for exactly this content, which FMI asks for."""
    digest = hashlib.sha256()
    for name in sorted(content):
        digest.update(f"{name}\0{content[name]}\0".encode())
    return f"{{preshape-{digest.hexdigest()[:32]}}}"


def _wrapped(words: list[str]) -> str:
    """A list in lines of four."""
    return ",\n    ".join(", ".join(words[first : first + 4]) for first in range(0, len(words), 4))


def _resource(package: str, folder: str, name: str) -> str:
    return (resources(package) / folder / name).read_text(encoding="utf-8")


def _filled(name: str, values: dict[str, object]) -> str:
    return Template(_resource("preshape.export.fmu", "templates", name)).substitute(values)


FMU = Target(
    name="fmu",
    summary="FMI 3.0 co-simulation unit for simulation tools",
    versions=("3.0",),
    limits=Limits(taps=10_000, samples=1_000_000, precisions=("double", "single")),
    render=_render,
    parse=_parse,
    run=as_kernel,
    next_step=_next_step,
    notes=_notes,
)
