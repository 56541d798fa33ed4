"""A small valid file of each format, as bytes: what the fuzzers start from."""

import io
import json
import struct
from importlib.util import find_spec

import numpy as np
from scipy.io import savemat, wavfile

__all__ = ["valid_files"]

ROWS = 40


def valid_files():
    """Name and content; formats whose package is missing are left out."""
    rng = np.random.default_rng(0)
    rows = [[k / 1000.0, *row] for k, row in enumerate(rng.normal(0.0, 9.0, (ROWS, 3)).tolist())]
    numbers = "".join("{:.6f},{:.6f},{:.6f},{:.6f}\n".format(*row) for row in rows)
    axes = "freq,psd_x,psd_y,psd_z,psd_xyz"
    psd = "".join(f"{1.6 * k:.1f},1.0e+00,1.000e+00,1.000e+00,3.000e+00" + "{}\n" for k in range(ROWS))
    capture = "".join(f"{k},0.1{k % 7},0.2{k % 5},1.0{k % 3}\n" for k in range(ROWS))
    report = "".join(f"{5 + k:.2f},1.00000,0.50000,0.10000,1.60000\n" for k in range(ROWS))
    files = {
        "klipper raw": f"#time,accel_x,accel_y,accel_z\n{numbers}",
        "klipper resonances": f"{axes}\n{psd.replace('{}', '')}",
        "klipper calibration": f"{axes},shapers:,zv(57.8)\n{psd.replace('{}', ',,1.000')}",
        "klipper datasets": 'freq,"a, b","c"\n' + "".join(f"{0.2 * k:.1f},{k}.5,{k}.25\n" for k in range(ROWS)),
        "prusa": f"{axes},mzv\nSample freq: 1344.2\n{report}ok\n",
        "rrf": f"Sample,X,Y,Z\n{capture}Rate 1391, overflows 0\n",
        "csv": f"time [ms];x [g]\n{''.join(f'{2 * k};{k % 7}.5{chr(10)}' for k in range(ROWS))}",
        "csv with rate": f"# a comment\n# sample_rate: 500\nx\n{''.join(f'{k % 7}.5{chr(10)}' for k in range(ROWS))}",
    }
    binary = {name: text.encode() for name, text in files.items()}
    values = np.array(rows)[:, 1:]
    for name, save in {
        "npy": lambda stream: np.save(stream, np.array(rows)),
        "npz": lambda stream: np.savez(stream, x=values, fs=1000.0),
        "npz compressed": lambda stream: np.savez_compressed(stream, x=values, t=np.array(rows)[:, 0]),
        "mat": lambda stream: savemat(stream, {"x": values, "fs": 1000.0, "note": "bump", "s": {"a": 1.0}}),
        "mat compressed": lambda stream: savemat(stream, {"x": values, "dt": 0.001}, do_compression=True),
        "wav": lambda stream: wavfile.write(stream, 1000, (1000 * values).astype(np.int16)),
        "wav float": lambda stream: wavfile.write(stream, 1000, values.astype(np.float32)),
    }.items():
        stream = io.BytesIO()
        save(stream)
        binary[name] = stream.getvalue()
    if find_spec("pyuff"):
        binary["uff"] = universal(values[:, 0], False)
        binary["uff binary"] = universal(values[:, 0], True)
    try:
        import zstandard
    except ImportError:
        return binary
    lines = "".join(json.dumps({"name": name, "samples": rows}) + "\n" for name in ("axis_X", "axis_Y")).encode()
    binary["stdata"] = zstandard.ZstdCompressor().compress(lines[: lines.index(b"\n")])
    binary["stdata of two"] = zstandard.ZstdCompressor().compress(lines)
    return binary


def universal(values, binary):
    """A dataset 58 of a time response in double precision, by hand (the format's own description)."""
    first = "    58"
    if binary:
        first += f"b     1     2          11{8 * len(values):12d}     0     0           0           0"
    lines = [
        "    -1", first, "bump", "NONE", "NONE", "NONE", "NONE",
        "    1         0    0         0       NONE        11   3       NONE         1   1",
        f"         4{len(values):10d}         1  0.00000e+00  1.00000e-03  0.00000e+00",
        "        17    0    0    0                 NONE                    s",
        "        12    0    0    0                 NONE                m/s^2",
        "         0    0    0    0                 NONE                 NONE",
        "         0    0    0    0                 NONE                 NONE",
    ]  # fmt: skip
    head = "".join(line + "\n" for line in lines).encode()
    if binary:
        body = struct.pack(f"<{len(values)}d", *values)
    else:
        cells = [f"{value:20.11e}" for value in values]
        body = "".join("".join(cells[i : i + 4]) + "\n" for i in range(0, len(cells), 4)).encode()
    return head + body + (b"\n" if binary else b"") + b"    -1\n"
