"""Programs that tests need and a machine may lack: there the test is skipped, but in CI that is an error.

CI sets PRESHAPE_REQUIRE_TOOLS; tests/conftest.py then refuses to begin without one of TOOLS.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

TOOLS = ("gcc", "clang", "cppcheck", "halcompile", "halrun", "unshare", "chromium")
REQUIRED = bool(os.environ.get("PRESHAPE_REQUIRE_TOOLS"))

STRICT = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror"]
SANITIZERS = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g"]


def missing() -> list[str]:
    """Those of TOOLS that are not there."""
    return [name for name in TOOLS if shutil.which(name) is None]


def needed(*names: str) -> None:
    """Skip this test where one of these programs is missing."""
    absent = [name for name in names if shutil.which(name) is None]
    if absent:
        unable(f"{' and '.join(absent)} is not installed here")


def unable(reason: str) -> None:
    """Skip this test, or fail where nothing may be skipped."""
    if REQUIRED:
        pytest.fail(f"PRESHAPE_REQUIRE_TOOLS is set, and {reason}")
    pytest.skip(reason)


def ran(*arguments: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """What a program said."""
    return subprocess.run([*map(str, arguments)], cwd=cwd, capture_output=True, text=True, check=False, timeout=120)


def succeeded(*arguments: str | Path, cwd: Path | None = None) -> str:
    """What a program that must succeed wrote."""
    done = ran(*arguments, cwd=cwd)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout
