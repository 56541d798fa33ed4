"""What the page on export says to a firmware engineer, compiled as it stands there and run."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from tests.export.exports import written
from tests.tools import STRICT, needed, succeeded

from preshape import design
from preshape.export import Exported, render
from preshape.export.target import EPSILON
from preshape.stream import Stream

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "how-to" / "export.md").read_text()
START = -1.5

MAIN = """
#include <stdio.h>

int main(void) {
    double given;
    preshape_real shaped;
    if (axis_start() != PRESHAPE_OK || scanf("%la", &given) != 1 || axis_rest((preshape_real)given) != PRESHAPE_OK) {
        return 1;
    }
    while (scanf("%la", &given) == 1) {
        if (axis_cycle((preshape_real)given, &shaped) != PRESHAPE_OK) {
            return 2;
        }
        printf("%a\\n", (double)shaped);
    }
    return 0;
}
"""


def block(language: str, beginning: str) -> str:
    """The only block of the page that begins so."""
    blocks = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, flags=re.MULTILINE | re.DOTALL)
    (found,) = (text for kind, text in blocks if kind == language and text.startswith(beginning))
    return str(found)


def on_the_page(precision: str) -> Exported:
    """The export that the page makes."""
    return render(design.zvd((8.7, 0.024)), "c", dt=0.001, name="gantry_x", precision=precision)


def shaped_in_c(precision: str, command: np.ndarray, folder: Path) -> np.ndarray:
    """What a program around the page's C gives for a command, shape (time,), from rest at START."""
    needed("gcc")
    written(on_the_page(precision), folder)
    (folder / "servo.c").write_text(block("c", '#include "gantry_x.h"') + MAIN)
    (folder / "command.txt").write_text("\n".join(value.hex() for value in [START, *command.tolist()]))
    single = ["-DPRESHAPE_SINGLE"] if precision == "single" else []
    flags = [*STRICT, "-ffp-contract=off", "-O2", *single]
    succeeded("gcc", *flags, "preshape_kernel.c", "gantry_x.c", "servo.c", "-o", "servo", cwd=folder)
    return np.array(
        [float.fromhex(line) for line in succeeded("sh", "-c", "./servo < command.txt", cwd=folder).split()]
    )


def test_the_servo_loop_of_the_page_gives_the_samples_of_a_stream(tmp_path: Path) -> None:
    placed = on_the_page("double").placed
    command = START + np.cumsum(np.random.default_rng(99).normal(size=400))
    stream = Stream(placed.shaper, placed.dt)
    stream.reset(START)
    assert shaped_in_c("double", command, tmp_path).tolist() == stream.push_block(command).tolist()


@pytest.mark.parametrize("precision", ["double", "single"])
def test_the_impulses_that_come_out_are_those_of_execute(precision: str, tmp_path: Path) -> None:
    """A step through the compiled program, its increments beside what the target says of its files."""
    exported = on_the_page(precision)
    does = exported.target.execute(exported.files)
    delays = np.rint(does.times / exported.placed.dt).astype(int)
    command = np.full(int(delays[-1]) + 10, START + 1.0)
    increments = np.diff(shaped_in_c(precision, command, tmp_path), prepend=START)
    np.testing.assert_array_equal(np.flatnonzero(increments), delays)
    rounding = 2.0 * abs(START) * len(does) * EPSILON[precision]  # of the sums, at this level of the command
    np.testing.assert_allclose(increments[delays], does.amplitudes, rtol=0, atol=rounding)


def test_the_line_that_compiles_the_self_test(tmp_path: Path) -> None:
    needed("gcc")
    written(on_the_page("double"), tmp_path)
    assert "every bit as in Python" in succeeded("sh", "-c", block("", "gcc "), cwd=tmp_path)
