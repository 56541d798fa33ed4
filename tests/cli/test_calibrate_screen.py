"""What a calibration shows: on a narrow terminal too, and with the price of each pick beside its gain."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path

import pytest

from preshape.cli import screens
from preshape.cli.main import main

GANTRY = Path(__file__).resolve().parents[2] / "examples" / "data" / "gantry_x.csv"
PICKS = ("performance", "quality", "improved")


@pytest.fixture(scope="module", params=[80, 120])
def shown(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[int, Path, list[str]]:
    """Columns of the screen, the folder, and the lines."""
    folder, out = tmp_path_factory.mktemp("screen") / "report", io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(out), pytest.raises(SystemExit) as stop:
        patch.setattr(screens, "FULL_WIDTH", request.param)
        main(["calibrate", str(GANTRY), "--out", str(folder)])
    assert not stop.value.code
    return request.param, folder, [line.rstrip() for line in out.getvalue().splitlines()]


def test_only_what_is_to_be_copied_is_longer_than_the_screen(shown: tuple[int, Path, list[str]]) -> None:
    columns, folder, lines = shown
    folded = [line for line in lines if str(folder) not in line and not line.startswith("    ")]
    assert max(map(len, folded)) <= columns
    # A sentence under a heading stays indented where it is folded: nothing between the picks begins at the margin.
    sentences = lines[next(k for k, line in enumerate(lines) if line.startswith("  Performance, ")) :]
    sentences = sentences[: next(k for k, line in enumerate(sentences) if line.startswith("!"))]
    assert len(sentences) >= 3 and all(line.startswith("  ") for line in sentences)


def test_each_pick_shows_what_it_leaves_beside_what_it_gains(shown: tuple[int, Path, list[str]]) -> None:
    _, _, lines = shown
    rows = {line.split()[0]: line.split() for line in lines if line.startswith(("stock:", *PICKS))}
    assert rows.keys() == {"stock:", *PICKS}
    stock = float(rows["stock:"][-1])
    assert all(float(rows[name][-1]) > 1.5 * stock for name in PICKS)  # 18 to 24 % where stock leaves 9 %
    warning = " ".join(lines[next(k for k, line in enumerate(lines) if line.startswith("! With all frequencies")) :])
    assert all(f"{name} {float(rows[name][-1]):.0f} %" in warning for name in PICKS)


def test_it_is_said_where_the_number_of_impulses_comes_from(shown: tuple[int, Path, list[str]]) -> None:
    assert "at most 5 impulses: what every firmware that takes impulses holds; --max-impulses" in " ".join(shown[2])


def test_the_files_of_the_picks_are_named(shown: tuple[int, Path, list[str]]) -> None:
    _, folder, lines = shown
    assert all(str(folder / f"{name}.json") in lines[-1] and (folder / f"{name}.json").exists() for name in PICKS)
