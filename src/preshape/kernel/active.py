"""Which kernel runs: the C one, when a compiler was there at the installation, or its twin in NumPy."""

from __future__ import annotations

from importlib import import_module
from typing import Any

__all__ = ["active_kernel", "compiled"]


def _found() -> Any:
    try:
        return import_module("preshape.kernel._compiled")
    except ImportError:
        return None


compiled: Any = _found()
"""The module in C (c/extension.c), or None."""


def active_kernel() -> str:
    """What `preshape --version` says: "C", or "NumPy" when no compiler was there at the installation."""
    return "NumPy" if compiled is None else "C"
