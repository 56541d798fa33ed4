"""Run every benchmark, each in a fresh process."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

HELPERS = {"peers.py", "run_all.py", "timing.py"}


def main() -> None:
    """One after the other, never side by side."""
    for script in sorted(Path(__file__).parent.glob("*.py")):
        if script.name not in HELPERS:
            print(f"== {script.name}", flush=True)
            subprocess.run([sys.executable, str(script)], check=True)


if __name__ == "__main__":
    main()
