"""`preshape studio`: it says where it is, what is in its way, and ends when it is told to."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from preshape import design
from preshape.cli import main
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.studio.server import free_socket
from preshape.workflow.workbench import AskedDesign, opened_file

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "data"


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str]:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    return int(ended.value.code or 0), capsys.readouterr().err


def test_a_port_that_is_taken_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    with free_socket("127.0.0.1", 0) as other:
        port = other.getsockname()[1]
        code, said = run(capsys, "studio", "--no-browser", "--port", str(port))
    assert code == 2 and f"port {port} is taken" in said and "Traceback" not in said


@pytest.mark.parametrize("port", [-1, 70_000])
def test_a_port_that_is_none_is_said(port: int) -> None:
    with pytest.raises(InputError, match="0 for any"):
        free_socket("127.0.0.1", port)


def test_the_next_free_port_is_taken_where_none_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    with free_socket("127.0.0.1", 0) as other:
        taken = other.getsockname()[1]
        monkeypatch.setattr("preshape.studio.server.DEFAULT_PORT", taken)
        with free_socket("127.0.0.1", None) as found:
            assert taken < found.getsockname()[1] < taken + 20


def test_an_address_of_another_computer_is_said() -> None:
    with pytest.raises(InputError, match="address of this computer"):
        free_socket("192.0.2.1", 0)
    with pytest.raises(InputError, match="not known|address of this computer"):
        free_socket("no-such-host.invalid", 0)


def test_a_missing_package_is_said() -> None:
    without = (
        "import sys; sys.modules['fastapi'] = None; from preshape.cli import main; main(['studio', '--no-browser'])"
    )
    ended = subprocess.run([sys.executable, "-c", without], capture_output=True, text=True, check=False)
    assert ended.returncode == 2, ended.stderr
    assert "pip install 'preshape[studio]'" in ended.stderr and "Traceback" not in ended.stderr


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("missing.csv", None, "no such file"),
        ("empty.csv", b"", "empty"),
        ("noise.bin", bytes(range(256)) * 4, "binary"),
        ("broken.json", b"{", "broken.json"),
        ("other.json", b'{"schema": "something"}', "schema"),
    ],
)
def test_a_file_that_opens_nothing_is_said(
    name: str, content: bytes | None, sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    code, said = run(capsys, "studio", str(path), "--no-browser")
    assert code == 2 and sentence in said and "Traceback" not in said


def test_a_shaper_opens_with_its_modes_and_its_design(tmp_path: Path) -> None:
    path = design.zvdk([(10.0, 0.02), (31.0, 0.01)], 2).save(tmp_path / "shaper.json")
    bench = opened_file(path).workbench
    assert bench.modes == (Mode(10.0, 0.02), Mode(31.0, 0.01))
    assert bench.designs == (AskedDesign("A", "zvdk", (("order", 2),)),)


def test_a_shaper_for_no_modes_opens_nothing(tmp_path: Path) -> None:
    from preshape import Shaper

    with pytest.raises(InputError, match="does not say its modes"):
        opened_file(Shaper([0.0, 0.5], [0.5, 0.5]).save(tmp_path / "shaper.json"))


def test_a_measurement_opens_with_its_modes_and_itself() -> None:
    opened = opened_file(EXAMPLES / "gantry_x.csv")
    assert [round(mode.frequency) for mode in opened.workbench.modes] == [47, 79]
    assert opened.dropped == ("gantry_x.csv", (EXAMPLES / "gantry_x.csv").read_bytes())


@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0"])
def test_it_serves_and_ends_when_told_to(host: str) -> None:
    """The whole program: address printed once, answers on it, other computers need the token, Ctrl+C ends it."""
    process = subprocess.Popen(
        [sys.executable, "-m", "preshape", "studio", "--no-browser", "--port", "0", "--host", host],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        match = re.search(r"(http://127\.0\.0\.1:(\d+)/)(?:\?token=(\S+))?", line)
        assert match is not None, line
        address, port, token = match.groups()
        assert (token is None) == (host == "127.0.0.1")
        headers = {} if token is None else {"Authorization": f"Bearer {token}"}
        request = urllib.request.Request(f"{address}api/version", headers=headers)
        with urllib.request.urlopen(request, timeout=60) as answer:
            assert json.load(answer)["version"]
        if token is not None:
            with pytest.raises(urllib.error.HTTPError, match="401"):
                urllib.request.urlopen(f"{address}api/version", timeout=60)
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(
                urllib.request.Request(f"{address}api/version", headers={**headers, "Host": "evil.example"}), timeout=60
            )
        if host == "127.0.0.1":
            others = {info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)}
            for other in others - {"127.0.0.1"}:
                with pytest.raises(OSError):
                    socket.create_connection((str(other), int(port)), timeout=2).close()
    finally:
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert process.returncode in (0, 130) and "Traceback" not in errors, errors
