"""Feed the readers of measurement files whatever comes, guided by coverage; stop at the first broken promise.

    pip install atheris 'preshape[formats]'
    python tests/fuzz/fuzz_readers.py CORPUS -max_total_time=600 -timeout=10 -rss_limit_mb=2000

CORPUS is a folder; a valid file of each format is put into it first. The promise: a measurement, or a MeasurementError
of one sentence, in ten seconds and two gigabytes. Atheris is not in the lock files: it has no wheels for every Python
and system that preshape supports. tests/identify/test_fuzz_readers.py fuzzes in every test run, without it.
"""

from __future__ import annotations

import os
import sys
import tempfile
import warnings
from pathlib import Path

import atheris

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

with atheris.instrument_imports(include=["preshape.identify", "pyuff", "scipy.io"]):
    import pyuff  # noqa: F401
    import scipy.io.wavfile  # noqa: F401
    import zstandard

    from preshape.errors import MeasurementError
    from preshape.identify import read

from tests.identify.valid_files import valid_files  # noqa: E402

FOLDER = Path(tempfile.mkdtemp(dir="/dev/shm" if Path("/dev/shm").is_dir() else None))


def one_input(data: bytes) -> None:
    """One file: its first byte says whether a rate and a part are given, and whether the rest is to be compressed."""
    if not data:
        return
    path = FOLDER / "file"
    path.write_bytes(zstandard.compress(data[1:]) if data[0] & 4 else data[1:])
    try:
        read(path, sample_rate=1000.0 if data[0] & 1 else None, part="axis" if data[0] & 2 else None)
    except MeasurementError as error:
        assert str(error).endswith("."), error
        assert str(error).isprintable(), error


def main() -> None:
    """Fill the corpus, then run."""
    folders = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
    if folders:
        os.makedirs(folders[0], exist_ok=True)
        for name, content in valid_files().items():
            (Path(folders[0]) / name.replace(" ", "_")).write_bytes(b"\0" + content)
            if name.startswith("stdata"):  # the lines of JSON themselves
                (Path(folders[0]) / f"{name}_unpacked").write_bytes(b"\6" + zstandard.decompress(content))
    warnings.simplefilter("error")
    atheris.Setup(sys.argv, one_input)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
