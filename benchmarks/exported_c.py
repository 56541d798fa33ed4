"""Exported C on this processor: one sample through 9 and 27 impulses, against a ring as anybody would write it."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

import numpy as np

from preshape import Shaper
from preshape.export import Exported, render

DT = 0.001
LONGEST = 2000

PEER = """#include "peer.h"
#include "shaper.h"

/* Weights and delays in a loop, the ring of just the length, its index by the remainder. */
static preshape_real past[SHAPER_LATENCY + 1u];
static uint32_t at;

preshape_real peer(preshape_real u) {
    preshape_real sum = 0;
    uint32_t k;
    past[at] = u;
    for (k = 0u; k < SHAPER_TAPS; ++k) {
        sum += shaper_table.weights[k] *
               past[(at + SHAPER_LATENCY + 1u - shaper_table.delays[k]) % (SHAPER_LATENCY + 1u)];
    }
    at = (at + 1u) % (SHAPER_LATENCY + 1u);
    return sum;
}
"""

MAIN = """#define _POSIX_C_SOURCE 199309L
#include "peer.h"
#include "shaper.h"
#include <math.h>
#include <stdio.h>
#include <time.h>

#define SAMPLES 1000000u
#define RUNS 15

static preshape_real ring[SHAPER_RING];
static preshape_real command[4096];

static double now(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(void) {
    preshape_gather axis;
    preshape_real y = 0, checked = 0;
    double ours = 1e9, theirs = 1e9, apart = 0.0;
    uint32_t i;
    int run;
    for (i = 0u; i < 4096u; ++i) {
        command[i] = (preshape_real)((i * i * 2654435761u) >> 20) / 4096;
    }
    if (preshape_gather_configure(&axis, &shaper_table, ring, SHAPER_RING) != PRESHAPE_OK) {
        return 1;
    }
    for (i = 0u; i < 20000u; ++i) {
        (void)preshape_gather_push(&axis, command[i & 4095u], &y);
        apart = fmax(apart, fabs((double)(y - peer(command[i & 4095u]))));
    }
    if (apart > TOLERANCE) {
        return 2;
    }
    for (run = 0; run < RUNS; ++run) {
        double start = now(), each;
        for (i = 0u; i < SAMPLES; ++i) {
            (void)preshape_gather_push(&axis, command[i & 4095u], &y);
            checked += y;
        }
        each = (now() - start) / SAMPLES;
        ours = (each < ours) ? each : ours;
        start = now();
        for (i = 0u; i < SAMPLES; ++i) {
            checked += peer(command[i & 4095u]);
        }
        each = (now() - start) / SAMPLES;
        theirs = (each < theirs) ? each : theirs;
    }
    printf("%.17g %.17g %u %u %g\\n", ours, theirs, (unsigned)sizeof axis, (unsigned)sizeof ring, (double)checked);
    return 0;
}
"""


def shaper_of(impulses: int) -> Shaper:
    """Impulses on the grid, unevenly over 2000 samples: as many taps as impulses."""
    random = np.random.default_rng(impulses)
    inner = random.choice(np.arange(1, LONGEST), impulses - 2, replace=False)
    return Shaper.normalised(np.unique([0, *inner, LONGEST]) * DT, random.uniform(0.5, 1.5, impulses))


def measured(exported: Exported) -> list[float]:
    """Seconds a sample, ours and the peer's, and bytes of state and ring."""
    single = exported.placed.precision == "single"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, content in exported.files.items():
            (folder / file).write_bytes(content if isinstance(content, bytes) else content.encode())
        (folder / "peer.h").write_text('#include "preshape_kernel.h"\npreshape_real peer(preshape_real u);\n')
        (folder / "peer.c").write_text(PEER)
        (folder / "main.c").write_text(MAIN)
        flags = ["-std=c99", "-O2", f"-DTOLERANCE={1e-5 if single else 1e-12}"] + ["-DPRESHAPE_SINGLE"] * single
        sources = ["preshape_kernel.c", "shaper.c", "peer.c", "main.c"]
        subprocess.run(["gcc", *flags, *sources, "-lm", "-o", "run"], cwd=folder, check=True)
        done = subprocess.run([folder / "run"], capture_output=True, text=True, check=True)
    return [float(word) for word in done.stdout.split()]


def main() -> None:
    """Both precisions, 9 and 27 impulses."""
    for impulses in (9, 27):
        for precision in ("double", "single"):
            exported = render(shaper_of(impulses), "c", dt=DT, precision=precision)
            assert exported.placed.delays.size == impulses
            ours, theirs, state, ring, _ = measured(exported)
            print(
                f"exported C, {precision}, {impulses} impulses, one sample: {1e9 * ours:.1f} ns; ring with remainder: "
                f"{1e9 * theirs:.1f} ns; ratio {theirs / ours:.1f}; state {state:.0f} bytes, ring {ring:.0f} bytes "
                "(9 impulses under 20 ns; state under 64 bytes)",
                flush=True,
            )


if __name__ == "__main__":
    main()
