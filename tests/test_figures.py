"""The figures of the theory page draw, and say what they claim."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType

import pytest

from preshape.report.figures import as_svg

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def figures() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_figures", ROOT / "docs" / "figures" / "make_figures.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("name", "page"),
    [
        ("certificate", "theory/shortest"),
        ("growth", "theory/shortest"),
        ("insensitivity", "theory/shortest"),
        ("which-shaper", "how-to/which-shaper"),
    ],
)
def test_every_figure_draws_and_stands_in_the_documentation(figures: ModuleType, name: str, page: str) -> None:
    assert as_svg(figures.FIGURES[name]()).startswith("<svg")
    assert (ROOT / "docs" / "images" / f"{name}.svg").is_file()
    assert f"../images/{name}.svg" in (ROOT / "docs" / f"{page}.md").read_text()


def test_the_growth_is_that_of_proved_designs_unless_it_says_otherwise() -> None:
    found = json.loads((ROOT / "docs" / "figures" / "growth.json").read_text())
    assert set(found) == {"evenly spaced", "log-spaced", "random", "peer"}
    del found["peer"]
    for rows in found.values():
        assert [row["modes"] for row in rows] == sorted(row["modes"] for row in rows)
        assert all(row["status"] == "optimal" and row["impulses"] > row["modes"] for row in rows if row["modes"] <= 10)
