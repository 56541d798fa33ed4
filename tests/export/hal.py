"""LinuxCNC's HAL without a machine: build components, run a servo thread over samples, read what comes out bit for bit.

Each run has shared memory, processes and a folder of modules of its own (unshare), so that runs do not meet, and
nothing is installed. halsampler prints reals with six decimals; a component of ours passes their bits on as integers.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tests.tools import needed, ran, unable

__all__ = ["build", "run"]

MODULES = Path("/usr/lib/linuxcnc/modules")
PERIOD = 1_000_000
"""Of the servo thread [ns]."""

BITS_OF = """component bits_of "The bits of a real, as integers.";
pin in float in;
pin out unsigned low;
pin out unsigned high;
option period no;
function _;
license "GPL";
;;
FUNCTION(_) {
    union { double real; unsigned half[2]; } both;
    both.real = in;
    low = both.half[0];
    high = both.half[1];
}
"""

NOBODY = 65534
"""rtapi_app asks root for another user to run as."""


def build(component: Path) -> Path:
    """The module of a .comp file."""
    needed("halcompile")
    done = ran("halcompile", "--compile", component.name, cwd=component.parent)
    assert done.returncode == 0 and "arning" not in done.stderr, done.stdout + done.stderr
    return component.with_suffix(".so")


def run(
    module: Path,
    command: NDArray[np.float64],
    folder: Path,
    *,
    period: int = PERIOD,
    switches: NDArray[np.bool_] | None = None,
    others: int = 0,
) -> tuple[NDArray[np.float64], NDArray[np.bool_], str]:
    """A component in a servo thread: what comes out, the pins active and period-ok, and what was said.

    `command` has shape (time,); `switches`, shape (time, 2), are what enable and bypass are set to, by default 1 and 0.
    So many `others` of the component are loaded beside it. The result has the pins in shape (time, 2).
    """
    needed("halrun", "unshare")
    shape, place = module.stem, Path(tempfile.mkdtemp(prefix="hal", dir="/tmp"))  # the path of a socket must be short
    try:
        place.chmod(0o777)
        (place / "bits_of.comp").write_text(BITS_OF)
        modules = place / "modules"
        modules.mkdir()
        for path in (build(place / "bits_of.comp"), module, *(MODULES / f"{name}.so" for name in NEEDED)):
            shutil.copy(path, modules)
        on = np.tile([True, False], (command.size, 1)) if switches is None else switches
        rows = zip(command.tolist(), on.astype(int).tolist(), strict=True)
        (place / "in.txt").write_text("".join(f"{u!r} {enable} {bypass}\n" for u, (enable, bypass) in rows))
        (place / "run.hal").write_text(_hal_file(shape, command.size, period, others))
        script = f"mount --bind {modules} {MODULES} && cd {place} && halrun -f run.hal < in.txt"
        environment = [f"RTAPI_UID={NOBODY}", f"RTAPI_FIFO_PATH={place}/fifo", f"HOME={place}"]
        privately = [
            "unshare",
            "--ipc",
            "--mount",
            "--pid",
            "--fork",
            "--mount-proc",
            "--kill-child",
            "env",
            *environment,
            "sh",
            "-c",
            script,
        ]
        if os.geteuid() != 0:
            if ran("sudo", "-n", "true").returncode != 0:
                unable("halrun needs modules of its own, which only root may mount")
            privately = ["sudo", "-n", *privately]
        done = ran(*privately, cwd=place)
        assert done.returncode == 0, done.stdout + done.stderr
        lines = (place / "out.txt").read_text().splitlines()
    finally:
        shutil.rmtree(place, ignore_errors=True)
    assert "overrun" not in lines and len(lines) == command.size, done.stdout + done.stderr
    table = np.array([line.split() for line in lines], dtype=np.uint64)
    bits = table[:, 0] | (table[:, 1] << np.uint64(32))
    return bits.view(np.float64), table[:, 2:] != 0, done.stdout + done.stderr


NEEDED = ("hal_lib", "threads", "streamer", "sampler")


def _hal_file(shape: str, samples: int, period: int, others: int) -> str:
    """Samples are in the first FIFO before the thread starts; the second one is read until there are as many."""
    names = ",".join(["shape.x", *(f"shape.{joint}" for joint in range(others))])
    return f"""
loadrt threads name1=servo period1={period}
loadrt streamer depth={samples + 8} cfg=fbb
loadrt {shape} names={names}
loadrt bits_of
loadrt sampler depth={samples + 8} cfg=uubb
addf streamer.0 servo
addf shape.x servo
addf bits-of.0 servo
addf sampler.0 servo
net command streamer.0.pin.0 => shape.x.in
net enable streamer.0.pin.1 => shape.x.enable
net bypass streamer.0.pin.2 => shape.x.bypass
net shaped shape.x.out => bits-of.0.in
net low bits-of.0.low => sampler.0.pin.0
net high bits-of.0.high => sampler.0.pin.1
net active shape.x.active => sampler.0.pin.2
net right shape.x.period-ok => sampler.0.pin.3
loadusr -w halstreamer in.txt
start
loadusr -w halsampler -n {samples} out.txt
"""
