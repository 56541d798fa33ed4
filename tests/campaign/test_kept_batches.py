"""Batches, folders and runs: any size, any order, any interruption gives the same; changed inputs are not mixed."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow.parquet
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.campaign.campaigns import campaign, mode_map, robustness

from preshape.campaign import Campaign, CampaignRun, run_campaign
from preshape.campaign.design_map import DesignMap
from preshape.campaign.sizes import BatchSizes
from preshape.errors import InputError


def table(folder: Path) -> Any:
    return pyarrow.parquet.read_table(folder / "results.parquet")


def run(asked: Campaign, folder: Path, **options: Any) -> CampaignRun:
    return run_campaign(asked, folder, workers=0, **options)


@pytest.fixture(autouse=True, scope="module")
def no_figures() -> Iterator[None]:
    """None is looked at here, and drawing takes longer than all the rest."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("preshape.campaign.run.figure_bytes", lambda figure, kind: b"")
        patch.setattr("preshape.campaign.run.campaign_figure", lambda summary: None)
        yield


class Stop(Exception):
    """Stands for whatever ends a run."""


@settings(max_examples=12)
@given(sizes=st.lists(st.integers(1, 30), min_size=1, max_size=8), stops=st.sets(st.integers(1, 6), max_size=3))
def test_any_batches_and_any_interruptions_give_the_same(
    sizes: list[int], stops: set[int], tmp_path_factory: pytest.TempPathFactory
) -> None:
    asked = campaign(robustness(40))
    folder, whole = tmp_path_factory.mktemp("parts"), tmp_path_factory.mktemp("whole")
    with pytest.MonkeyPatch.context() as patch:
        turns = itertools.cycle(sizes)
        patch.setattr(BatchSizes, "next", lambda self, left: min(next(turns), left))
        calls = 0

        def interrupt(done: int, failed: int, points: int) -> None:
            nonlocal calls
            calls += 1
            if calls in stops:
                raise Stop

        kept = 0
        for _ in range(len(stops) + 1):
            try:
                last = run(asked, folder, progress=interrupt)
                break
            except Stop:
                continue
        kept = last.kept
    assert last.summary.done == 40 and last.computed == 40 - kept
    run(asked, whole)
    assert table(folder).equals(table(whole))


def test_a_second_run_computes_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = campaign(mode_map(12))
    first = run(asked, tmp_path)
    monkeypatch.setattr(DesignMap, "row", lambda self, point: pytest.fail("it was computed again"))
    second = run(asked, tmp_path)
    assert (first.computed, second.computed, second.kept) == (12, 0, 12)
    assert first.summary.numbers == second.summary.numbers


def test_more_random_points_go_on_from_those_there_are(tmp_path: Path) -> None:
    run(campaign(robustness(20)), tmp_path)
    more = run(campaign(robustness(50)), tmp_path)
    assert (more.kept, more.computed) == (20, 30)
    run(campaign(robustness(50)), tmp_path / "whole")
    assert table(tmp_path).equals(table(tmp_path / "whole"))
    fewer = run(campaign(robustness(20)), tmp_path)
    assert (fewer.computed, fewer.summary.done) == (0, 20)
    assert table(tmp_path)["point"].to_pylist() == list(range(20))


@pytest.mark.parametrize(
    "change",
    [
        ("robustness.seed", 5),
        ("robustness.scatter", {"frequency": 0.06}),
        ("machine.modes", [[1.0, 1e-9]]),
        ("shaper.family", "zv"),
        ("robustness.move.dt", 0.002),
    ],
)
def test_changed_inputs_start_anew_and_lose_nothing(change: tuple[str, Any], tmp_path: Path) -> None:
    old = campaign(robustness(10))
    run(old, tmp_path)
    before = table(tmp_path)
    kept = {path: path.read_bytes() for path in tmp_path.glob("batches-*/*")}
    changed = run(campaign(robustness(10), change), tmp_path)
    assert (changed.kept, changed.computed) == (0, 10)
    assert any("the inputs have changed since an earlier run" in note for note in changed.summary.notes)
    assert not table(tmp_path).equals(before)
    assert all(path.read_bytes() == content for path, content in kept.items())
    back = run(old, tmp_path)
    assert (back.kept, back.computed) == (10, 0)
    assert table(tmp_path).equals(before)


def test_a_changed_plant_file_is_noticed(tmp_path: Path) -> None:
    source = (Path(__file__).parents[2] / "examples" / "data" / "machine.toml").read_text()
    (tmp_path / "machine.toml").write_text(source)
    from preshape.campaign import campaign_of

    data = robustness(5) | {"machine": {"plant": "machine.toml"}}
    first = campaign_of(data, tmp_path)
    (tmp_path / "machine.toml").write_text(source.replace("3.0, 0.0], [0.0, 0.0, 1.2]", "3.0, 0.0], [0.0, 0.0, 1.3]"))
    assert campaign_of(data, tmp_path).digest != first.digest
    (tmp_path / "machine.toml").write_text("# another comment\n" + source)
    assert campaign_of(data, tmp_path).digest == first.digest, "a comment is no input"


def failing(bad: set[int], monkeypatch: pytest.MonkeyPatch, error: Exception) -> list[int]:
    """Design maps fail at some points; gives the list of those that were tried."""
    right, tried = DesignMap.row, []

    def row(self: DesignMap, point: int) -> Any:
        tried.append(point)
        if point in bad:
            raise error
        return right(self, point)

    monkeypatch.setattr(DesignMap, "row", row)
    return tried


@pytest.mark.parametrize(
    ("error", "text"),
    [(InputError("too soft."), "too soft."), (ZeroDivisionError("by 0"), "ZeroDivisionError: by 0")],
)
def test_failed_points_are_recorded_and_tried_again(
    error: Exception, text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = campaign(mode_map(12))
    bad = {3, 7}
    tried = failing(bad, monkeypatch, error)
    first = run(asked, tmp_path, retries=2)
    assert sorted(tried) == sorted([*range(12), 3, 3, 7, 7]), "twice more in this run, the others once"
    assert (first.summary.done, first.summary.failures) == (10, ((text, 2),))
    rows = table(tmp_path).to_pylist()
    assert [row["point"] for row in rows] == list(range(12))
    assert {row["point"]: (row["error"], row["attempt"]) for row in rows if row["error"]} == {
        3: (text, 3),
        7: (text, 3),
    }
    bad.discard(3)
    tried.clear()
    second = run(asked, tmp_path)
    assert sorted(tried) == [3, 7], "the next run tries what failed, and nothing else"
    assert (second.summary.done, second.summary.failed, second.kept) == (11, 1, 10)
    bad.clear()
    assert run(asked, tmp_path).summary.failed == 0
    undisturbed = campaign(mode_map(12))
    run(undisturbed, tmp_path / "other")
    drop = ["attempt"]
    assert table(tmp_path).drop(drop).equals(table(tmp_path / "other").drop(drop))


def test_all_points_failed_is_no_crash(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    failing(set(range(5)), monkeypatch, InputError("no."))
    nothing = run(campaign(mode_map(5)), tmp_path)
    assert (nothing.summary.done, nothing.summary.failures) == (0, (("no.", 5),))
    assert [path.name for path in nothing.files] == ["results.parquet"]


def test_a_full_disk_is_one_sentence_and_keeps_what_is_done(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = campaign(mode_map(60))
    right, calls = os.fsync, 0

    def full(descriptor: int) -> None:
        nonlocal calls
        calls += 1
        if calls > 3:
            raise OSError(28, "No space left on device")
        right(descriptor)

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(InputError, match=r"cannot write .*No space left.* 2 of 60 points are kept; the same command"):
        run(asked, tmp_path)
    monkeypatch.undo()
    assert not list(tmp_path.rglob("*.part"))
    rest = run(asked, tmp_path)
    assert (rest.kept, rest.computed) == (2, 58)


def test_a_damaged_batch_is_set_aside_and_computed_again(tmp_path: Path) -> None:
    asked = campaign(mode_map(12))
    run(asked, tmp_path)
    right = table(tmp_path)
    largest = max(tmp_path.glob("batches-*/*.parquet"), key=lambda path: path.stat().st_size)
    largest.write_bytes(largest.read_bytes()[:-40])
    again = run(asked, tmp_path)
    assert again.computed > 0 and again.summary.done == 12
    assert any("was damaged and is set aside" in note for note in again.summary.notes)
    assert table(tmp_path).equals(right)
    assert largest.with_name(largest.name + ".damaged").exists()


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot make the folder .*file"):
        run(campaign(mode_map(3)), tmp_path / "file" / "out")


@given(st.integers(1, 2000), st.integers(1, 10**7), st.floats(1e-5, 1e3), st.lists(st.floats(1e-5, 1e3), max_size=5))
def test_batches_are_long_enough_for_their_overhead_and_end_together(
    cores: int, left: int, first: float, more: list[float]
) -> None:
    sizes = BatchSizes(cores)
    assert sizes.next(left) == 1, "nothing is known yet"
    for seconds in [first, *more]:
        sizes.learn(1, seconds)
    size = sizes.next(left)
    assert 1 <= size <= left
    slowest, fastest = max([first, *more]), min([first, *more])
    if size > 1:
        assert size * fastest <= max(1.0, 0.02 * cores) * 1.001, "a killed worker loses no more than this"
    if size < left:
        assert (size + 1) * slowest >= max(0.2, 0.01 * cores) * 0.999, "and its scheduling is 5 % of it at most"
