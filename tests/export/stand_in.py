"""A stand-in for halcompile's macros, so that a component's C part runs without LinuxCNC.

It knows what the documentation of LinuxCNC's master says of them: a pin is read by its name, which cannot be assigned,
and set by name_set(value). It is not halcompile: that master takes the file is not shown by it.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tests.tools import STRICT, needed, succeeded

__all__ = ["run_master"]

PIN = re.compile(r'^pin (in|out) (real|bool) ([a-z_]+)(?: = (true|false))? "[^"\\]*";$', re.MULTILINE)
VARIABLE = re.compile(r"^variable (double|unsigned) ([a-z]+)(\[[0-9]+\])?;$", re.MULTILINE)

MAIN = """
int main(void) {
    char line[200];
    while (fgets(line, sizeof line, stdin) != NULL) {
        char *rest = line;
        joint_.in_ = strtod(rest, &rest);
        joint_.enable_ = strtol(rest, &rest, 10) != 0;
        joint_.bypass_ = strtol(rest, &rest, 10) != 0;
        _(&joint_, strtol(rest, &rest, 10));
        printf("%a %d %d %a\\n", joint_.out_, joint_.active_, joint_.period_ok_, joint_.latency_);
    }
    return 0;
}
"""


def run_master(
    text: str, command: NDArray[np.float64], switches: NDArray[np.bool_], period: int, folder: Path
) -> tuple[NDArray[np.float64], NDArray[np.bool_], str]:
    """The C part of a component for master over samples; arguments and results as :func:`tests.export.hal.run`."""
    needed("gcc")
    declared, code = text.split("\n;;\n", 1)
    pins, variables = PIN.findall(declared), VARIABLE.findall(declared)
    assert len(pins) == len(re.findall("^pin ", declared, re.MULTILINE))
    assert len(variables) == len(re.findall("^variable ", declared, re.MULTILINE))
    c = {"real": "double", "bool": "bool"}
    lines = ["#include <stdbool.h>", "#include <stdio.h>", "#include <stdlib.h>", "struct held_ {"]
    lines += [f"    {c[kind]} {name}_;" for _, kind, name, _ in pins]
    lines += [f"    {kind} {name}_{size};" for kind, name, size in variables]
    given = ", ".join(f".{name}_ = {value}" for _, _, name, value in pins if value)
    lines += ["};", f"static struct held_ joint_ = {{{given}}};"]
    lines += [f"#define {name} ({'0.0 + ' if kind == 'real' else '!!'}inst->{name}_)" for _, kind, name, _ in pins]
    lines += [f"#define {name}_set(value) (inst->{name}_ = (value))" for way, _, name, _ in pins if way == "out"]
    lines += [f"#define {name} (inst->{name}_)" for _, name, _ in variables]
    lines += ["#define FUNCTION(name) static void name(struct held_ *inst, long period)"]
    lines += ["#define fperiod ((double)period * 1e-9)", "#define RTAPI_MSG_ERR stderr"]
    lines += ["#define rtapi_print_msg (void)fprintf"]
    (folder / "part.c").write_text("\n".join([*lines, code, MAIN]))
    quiet = ["-Wno-conversion", "-Wno-unknown-pragmas", "-Wno-shadow"]  # of a file that is included, not ours to choose
    succeeded("gcc", *STRICT, *quiet, "-fsanitize=undefined,address", "-O1", "part.c", "-o", "part", cwd=folder)
    rows = zip(command.tolist(), switches.astype(int).tolist(), strict=True)
    samples = "".join(f"{u!r} {enable} {bypass} {period}\n" for u, (enable, bypass) in rows)
    done = subprocess.run([folder / "part"], input=samples, capture_output=True, text=True, check=True)
    table = [line.split() for line in done.stdout.splitlines()]
    shaped = np.array([float.fromhex(row[0]) for row in table])
    return shaped, np.array([[row[1] != "0", row[2] != "0"] for row in table]), done.stderr
