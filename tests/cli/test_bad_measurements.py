"""Every bad measurement, given to the command: exit code 2, one sentence, nothing written."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.identify.test_bad_files import BAD

from preshape.cli.main import main
from preshape.identify import MAXIMUM_FILE_SIZE


@pytest.mark.parametrize("case", BAD)
def test_one_sentence_and_exit_code_2(case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    content, _ = BAD[case]
    path = tmp_path / "file.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(SystemExit) as stop:
        main(["calibrate", str(path), "--out", str(tmp_path / "report")])
    captured = capsys.readouterr()
    assert stop.value.code == 2
    assert captured.out == ""
    assert captured.err.startswith("Error: ") and captured.err.count("\n") == 1
    assert not (tmp_path / "report").exists()


def test_a_huge_file_is_refused_with_the_limit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "huge.csv"
    with path.open("wb") as stream:
        stream.truncate(MAXIMUM_FILE_SIZE + 1)
    with pytest.raises(SystemExit) as stop:
        main(["calibrate", str(path)])
    assert stop.value.code == 2
    assert "200 MB" in capsys.readouterr().err


def test_an_output_folder_that_cannot_be_written_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "report").write_text("a file where the folder should be")
    gantry = Path(__file__).resolve().parents[2] / "examples" / "data" / "ring_down.csv"
    with pytest.raises(SystemExit) as stop:
        main(["calibrate", str(gantry), "--out", str(tmp_path / "report")])
    assert stop.value.code == 2
    assert "--out" in capsys.readouterr().err
    assert (tmp_path / "report").read_text() == "a file where the folder should be"
