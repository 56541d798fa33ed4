"""The shared library in an FMU, when there is a C compiler to make it."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

__all__ = ["library"]

COMPILERS = ("cc", "gcc", "clang")
FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-fvisibility=hidden", "-shared", "-s", "-Wl,--build-id=none")
"""No fused multiplications, nothing exported but FMI's functions, and nothing that differs from run to run."""

ARCHITECTURES = {"x86_64": "x86_64", "amd64": "x86_64", "aarch64": "aarch64", "arm64": "aarch64"}
SECONDS = 120


def library(name: str, sources: Mapping[str, str], definitions: tuple[str, ...]) -> dict[str, bytes]:
    """Path in the FMU and content of the shared library for this machine; empty without a compiler that makes it.

    Only Linux is built for: other systems' importers compile the sources.
    """
    architecture = ARCHITECTURES.get(platform.machine().lower())
    compiler = next(filter(None, map(shutil.which, COMPILERS)), None)
    if compiler is None or architecture is None or not sys.platform.startswith("linux"):
        return {}
    with tempfile.TemporaryDirectory(prefix="preshape-fmu-") as folder:
        for file, text in sources.items():
            Path(folder, file).write_text(text, encoding="utf-8")
        units = sorted(file for file in sources if file.endswith(".c"))
        command = [compiler, *FLAGS, *(f"-D{one}" for one in definitions), *units, "-o", "library.so"]
        environment = {**os.environ, "LC_ALL": "C", "SOURCE_DATE_EPOCH": "315532800"}
        try:
            finished = subprocess.run(
                command, cwd=folder, env=environment, capture_output=True, timeout=SECONDS, check=False
            )
        except (OSError, subprocess.TimeoutExpired):
            return {}
        if finished.returncode != 0:
            return {}
        return {f"binaries/{architecture}-linux/{name}.so": Path(folder, "library.so").read_bytes()}
