"""Settings for all tests."""

from __future__ import annotations

import os

from hypothesis import settings

# Workers of the test runner share the cores; linear algebra on small matrices must not start threads of its own.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

settings.register_profile("preshape", derandomize=True, deadline=None)
settings.load_profile("preshape")
