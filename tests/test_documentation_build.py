"""The pages load nothing from outside, and the reference leaves nothing public out."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

DOCS = Path(__file__).resolve().parent.parent / "docs"


def extension(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, DOCS / "extensions" / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    "text",
    [
        '<script src="https://cdn.example/mathjax.js"></script>',
        '<script>require.config({paths: {a: "https://cdn.example/a"}})</script>',
        '<link rel="stylesheet" href="//fonts.example/css">',
        '<link rel="preconnect" href="https://fonts.example">',
        '<img alt="" src="http://shields.example/badge.svg">',
        '<img alt="" srcset="small.png 1x, https://cdn.example/large.png 2x">',
        '<svg><image xlink:href="https://cdn.example/a.png"/></svg>',
        "<style>@import 'https://fonts.example/css';</style>",
        '<p style="background: url(https://cdn.example/a.png)">',
    ],
)
def test_what_a_page_loads_from_outside_is_seen(text: str) -> None:
    assert len(extension("nothing_from_outside").loaded_by_page(text)) == 1


@pytest.mark.parametrize(
    "text",
    [
        '<a href="https://github.com/Klipper3d/klipper">Klipper</a>',
        '<script src="../_static/furo.js"></script>',
        '<img alt="" src="data:image/png;base64,AAAA">',
        '<link rel="canonical" href="https://docs.example/">',
        "<code>https://example.org/a.css</code>",
    ],
)
def test_links_to_follow_and_own_files_are_not(text: str) -> None:
    assert extension("nothing_from_outside").loaded_by_page(text) == []


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The reference alone, built as `make docs` builds it: with the same settings, warnings being errors."""
    folder = tmp_path_factory.mktemp("reference")
    (folder / "index.md").write_text("# Reference\n\n```{toctree}\n:glob:\n\nreference/python/*\n```\n")
    (folder / "reference").mkdir()
    (folder / "reference" / "python").symlink_to(DOCS / "reference" / "python")
    arguments = ["-W", "-q", "-b", "html", "-c", str(DOCS), str(folder), str(folder / "built")]
    finished = subprocess.run([sys.executable, "-m", "sphinx", *arguments], capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stderr
    return folder / "built"


def test_every_public_name_is_in_the_reference(reference: Path) -> None:
    from sphinx.util.inventory import InventoryFile

    whole = extension("whole_reference")
    names = list(whole.public_names())
    assert len(names) > 250 and ("preshape", "Mode") in names and ("preshape.plant", "ModalPlant") in names
    inventory = InventoryFile.loads((reference / "objects.inv").read_bytes(), uri="")
    documented = [name for kind in inventory.data if kind.startswith("py:") for name in inventory.data[kind]]
    assert whole.left_out(documented) == []
    assert whole.left_out([name for name in documented if name != "preshape.design.zvd"]) == ["preshape.design.zvd"]
    page = (reference / "reference" / "python" / "design.html").read_text()
    assert "preshape.design.zvd" in page and "ZVD" in page
