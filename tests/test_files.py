from __future__ import annotations

import os
from pathlib import Path

import pytest

from preshape.errors import InputError
from preshape.files import write_atomically


def test_the_old_file_survives_an_interruption(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "result.txt"
    target.write_text("old")

    def interrupted(descriptor: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_atomically(target, "new")
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["result.txt"]


def test_a_full_disk_is_one_sentence_and_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(InputError, match="cannot write .*No space left"):
        write_atomically(tmp_path / "result.txt", "new")
    assert os.listdir(tmp_path) == []


def test_a_folder_that_does_not_exist_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot write"):
        write_atomically(tmp_path / "missing" / "result.txt", "new")


def test_text_and_bytes_arrive_as_they_are(tmp_path: Path) -> None:
    assert write_atomically(tmp_path / "a", "µ\n").read_bytes() == "µ\n".encode()
    assert write_atomically(tmp_path / "b", b"\x00\x01").read_bytes() == b"\x00\x01"
