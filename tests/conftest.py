"""Settings for all tests."""

from __future__ import annotations

import os

import pytest
from hypothesis import settings
from tests.tools import REQUIRED, missing

# Workers of the test runner share the cores; linear algebra on small matrices must not start threads of its own.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

settings.register_profile("preshape", derandomize=True, deadline=None)
settings.load_profile("preshape")


def pytest_configure() -> None:
    """In CI a test must not be skipped because a program is missing."""
    if REQUIRED and (absent := missing()):
        raise pytest.UsageError(f"PRESHAPE_REQUIRE_TOOLS is set and these are not installed: {', '.join(absent)}.")
