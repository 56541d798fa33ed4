"""What `import preshape` adds to `import numpy`, and how long `preshape --help` takes, as whole processes."""

from __future__ import annotations

import subprocess
import sys
import time


def best(arguments: list[str], runs: int = 9) -> float:
    """Best wall time of a process [s]."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL)
        times.append(time.perf_counter() - start)
    return min(times)


def main() -> None:
    """Print the three numbers."""
    bare = best([sys.executable, "-c", "pass"])
    numpy = best([sys.executable, "-c", "import numpy"])
    ours = best([sys.executable, "-c", "import preshape"])
    help_text = best([sys.executable, "-m", "preshape", "--help"])
    print(
        f"import preshape: {1e3 * (ours - numpy):.0f} ms on top of import numpy ({1e3 * (numpy - bare):.0f} ms), "
        f"ratio to it {(ours - bare) / (numpy - bare):.2f} (claim: < 100 ms on top)"
    )
    print(
        f"preshape --help: {1e3 * help_text:.0f} ms; bare python: {1e3 * bare:.0f} ms; "
        f"ratio {help_text / bare:.1f} (claim: < 300 ms)"
    )


if __name__ == "__main__":
    main()
