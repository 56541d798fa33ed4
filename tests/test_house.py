"""The rules of the house: who may import whom, how long a file is, what an __init__ holds."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SOURCES = sorted((ROOT / "src").rglob("*.py"))


def test_imports_go_down_late_imports_included() -> None:
    finished = subprocess.run(
        [Path(sys.executable).with_name("lint-imports"), "--no-cache"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert finished.returncode == 0, finished.stdout


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT / "src")))
def test_a_file_is_one_idea(path: Path) -> None:
    text = path.read_text()
    assert len(text.splitlines()) <= 300
    tree = ast.parse(text)
    assert ast.get_docstring(tree), "says what it is for in its first line"
    if path.name == "__init__.py":
        allowed = (ast.Expr, ast.Import, ast.ImportFrom, ast.Assign)
        assert all(isinstance(node, allowed) for node in tree.body), "re-exports and holds no logic"


OTHERS = [path for kind in ("c", "h", "in", "st", "xml") for path in sorted((ROOT / "src").rglob(f"*.{kind}"))]


@pytest.mark.parametrize("path", OTHERS, ids=lambda path: str(path.relative_to(ROOT / "src")))
def test_a_file_of_c_or_a_template_is_one_idea_too(path: Path) -> None:
    whole_kernel = path.name == "preshape_kernel.c"  # handed out as one source, to be compiled by others
    assert len(path.read_text().splitlines()) <= (450 if whole_kernel else 300)


def test_nothing_prints_outside_the_command_line() -> None:
    for path in SOURCES:
        if "cli" not in path.parts:
            calls = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]
            assert not any(isinstance(call.func, ast.Name) and call.func.id == "print" for call in calls), path
