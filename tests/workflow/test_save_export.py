"""Files of an export: written whole or not at all, written anew with ease, and nothing of the user's lost."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from preshape import design
from preshape.errors import InputError
from preshape.export import Exported, render
from preshape.workflow import save_export

SHAPER = design.zvd((8.7, 0.024))
MEMORY = "preshape-export.json"


def exported(rate: float = 1000.0, name: str = "shaper") -> Exported:
    return render(SHAPER, "c", dt=1.0 / rate, name=name)


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_files_are_what_was_rendered_in_a_folder_that_is_made(tmp_path: Path) -> None:
    one = exported()
    saved = save_export(one, tmp_path / "a" / "b")
    assert [path.name for path in saved.files] == list(one.files)
    there = contents(tmp_path / "a" / "b")
    assert there.pop(MEMORY)
    assert there == {name: text if isinstance(text, bytes) else text.encode() for name, text in one.files.items()}


def test_an_export_replaces_an_earlier_one_and_shares_the_folder_with_another(tmp_path: Path) -> None:
    save_export(exported(), tmp_path)
    save_export(exported(name="other"), tmp_path)
    first = contents(tmp_path)
    save_export(exported(500.0), tmp_path)
    save_export(exported(500.0), tmp_path)
    second = contents(tmp_path)
    assert second.keys() == first.keys() and second["shaper.h"] != first["shaper.h"]
    assert second["other.h"] == first["other.h"]


def test_the_kernel_of_an_older_preshape_is_replaced(tmp_path: Path) -> None:
    one = exported()
    old = Exported(one.target, one.placed, {**one.files, "preshape_kernel.c": "/* of an older version */\n"})
    save_export(old, tmp_path)
    save_export(one, tmp_path)
    assert (tmp_path / "preshape_kernel.c").read_bytes() == one.files["preshape_kernel.c"]


@pytest.mark.parametrize("known", [True, False])
def test_a_file_of_the_users_is_not_overwritten_but_with_force(tmp_path: Path, known: bool) -> None:
    if known:
        save_export(exported(), tmp_path)
    (tmp_path / "shaper.h").write_text("/* mine */\n")
    before = contents(tmp_path)
    with pytest.raises(
        InputError, match="shaper.h is there already and not as preshape export left it: nothing was wr"
    ):
        save_export(exported(500.0), tmp_path)
    assert contents(tmp_path) == before
    save_export(exported(500.0), tmp_path, force=True)
    assert (tmp_path / "shaper.h").read_bytes() != b"/* mine */\n"
    save_export(exported(), tmp_path)


def test_a_file_that_is_there_and_the_same_is_no_hindrance(tmp_path: Path) -> None:
    (tmp_path / "preshape_kernel.h").write_bytes(bytes(exported().files["preshape_kernel.h"]))  # type: ignore[arg-type]
    save_export(exported(), tmp_path)


@pytest.mark.parametrize(
    ("memory", "sentence"),
    [
        (b"not JSON", "is not of preshape export"),
        (b"\xff\xfe", "is not of preshape export"),
        (b"[1, 2]", "is not of preshape export"),
        (b'{"schema": "another/1", "files": {}}', "is not of preshape export"),
        (b'{"schema": "preshape/export/1", "files": {"a": 7}}', "is not of preshape export"),
        (b" " * 1_000_001, "larger than a megabyte"),
    ],
)
def test_a_memory_of_somebody_else_is_refused(tmp_path: Path, memory: bytes, sentence: str) -> None:
    (tmp_path / MEMORY).write_bytes(memory)
    with pytest.raises(InputError, match=sentence):
        save_export(exported(), tmp_path)
    assert contents(tmp_path) == {MEMORY: memory}


def test_a_place_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot write into .*file"):
        save_export(exported(), tmp_path / "file")
    (tmp_path / "shaper.c").mkdir()
    with pytest.raises(InputError, match="cannot read .*shaper.c"):
        save_export(exported(), tmp_path)
    (tmp_path / MEMORY).mkdir()
    with pytest.raises(InputError, match="cannot read .*preshape-export.json"):
        save_export(exported(), tmp_path)


STEPS = [(False, step) for step in range(1, 13)] + [(True, step) for step in range(1, 19)]
"""Six files are made beside their places, then put there; those of before are put aside first."""


@pytest.mark.parametrize(("before", "failing"), STEPS)
@pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt()])
def test_when_it_fails_in_the_middle_everything_is_what_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, before: bool, failing: int, error: BaseException
) -> None:
    folder = tmp_path / "out"
    if before:
        save_export(exported(), folder)
    was = contents(tmp_path)
    real, calls = os.replace, 0

    def replace(*places: object) -> None:
        nonlocal calls
        calls += 1
        if calls == failing:
            raise error
        real(*places)  # type: ignore[arg-type]

    monkeypatch.setattr(os, "replace", replace)
    with pytest.raises(KeyboardInterrupt if isinstance(error, KeyboardInterrupt) else InputError):
        save_export(exported(500.0), folder)
    assert contents(tmp_path) == was and folder.exists() == before
