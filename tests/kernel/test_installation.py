"""An installation where no compiler is: it succeeds, says so, warns once, and gives the same bits."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

from preshape import design
from preshape.stream import Stream

ROOT = Path(__file__).resolve().parents[2]

PROGRAM = """
import numpy as np
from preshape import design
from preshape.kernel import active_kernel
from preshape.stream import Stream
assert active_kernel() == "NumPy", active_kernel()
for _ in range(3):
    stream = Stream(design.zvd((3.0, 0.02)), 0.01)
print(stream.push_block(np.linspace(-1.0, 2.0, 200)).tobytes().hex())
"""


def test_without_a_compiler_the_installation_succeeds_and_streams_give_the_same_bits(tmp_path: Path) -> None:
    sources = tmp_path / "sources"  # setuptools builds beside them
    keep = shutil.ignore_patterns("_compiled*", "__pycache__", "*.egg-info")
    shutil.copytree(ROOT / "src", sources / "src", ignore=keep)
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, sources)
    installed = tmp_path / "installed"
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--no-deps", "--no-build-isolation"]
    environment = {**os.environ, "CC": "/nowhere/cc"}
    done = subprocess.run(
        [*pip, "--no-index", "--target", installed, sources],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    environment["PYTHONPATH"] = str(installed)
    run = [sys.executable, "-W", "default::RuntimeWarning"]
    done = subprocess.run(
        [*run, "-c", PROGRAM], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("without a C compiler") == 1
    expected = Stream(design.zvd((3.0, 0.02)), 0.01).push_block(np.linspace(-1.0, 2.0, 200))
    assert bytes.fromhex(done.stdout.strip()) == expected.tobytes()
    version = subprocess.run(
        [*run, "-m", "preshape", "--version"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert "NumPy kernel" in version.stdout
