"""Every code block of README and docs runs, and every docstring example; what is public is documented."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pkgutil
import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest
from click.testing import CliRunner
from tests.workflow.recordings import klipper_text, recording

import preshape
import preshape.export
import preshape.workflow
from preshape.cli.main import preshape as command_line
from preshape.report import DesignJob, as_html
from preshape.workflow import asked_design_report, designed

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
MODULES = sorted(
    m.name for m in pkgutil.walk_packages(preshape.__path__, "preshape.") if not m.name.endswith("__main__")
)


CELL_SETTINGS = re.compile(r"\A(?:---\n.*?^---\n|(?::[\w-]+:.*\n)+)", flags=re.MULTILINE | re.DOTALL)
"""What says how a cell is shown: not part of its code."""


def blocks(page: Path, language: str) -> list[str]:
    """The blocks of a language, in order; the cells of a page that is a notebook are Python too."""
    fence = rf"(?:{language}|\{{code-cell\}} python)" if language == "python" else language
    found = re.findall(rf"^```{fence}\n(.*?)^```$", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    return [CELL_SETTINGS.sub("", block) for block in found]


@pytest.mark.parametrize(
    "page", [page for page in PAGES if blocks(page, "python")], ids=lambda page: str(page.relative_to(ROOT))
)
def test_python_blocks_run_one_after_the_other(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(page.parent if "{code-cell}" in page.read_text() else ROOT)  # a notebook runs where it lies
    names: dict[str, object] = {}
    for block in blocks(page, "python"):
        exec(compile(block, str(page), "exec"), names)


def console_lines() -> list[str]:
    lines = [line for page in PAGES for block in blocks(page, "console") for line in block.splitlines()]
    return sorted({line.removeprefix("$ ") for line in lines if line.startswith("$ preshape ")})


@pytest.mark.parametrize("line", console_lines())
def test_console_lines_are_accepted(line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """File names in the docs stand for the user's; here they are files of that kind."""
    monkeypatch.chdir(tmp_path)
    for name, file in (
        ("resonances_x.csv", "gantry_x.csv"),
        *(
            (one, one)
            for one in (
                "machine.toml",
                "move.csv",
                "part.csv",
                "part.gcode",
                "printer.cfg",
                "config.g",
                "crane-map.toml",
                "gantry-robustness.toml",
                "ring_down.csv",
            )
        ),
    ):
        (tmp_path / name).write_bytes((ROOT / "examples" / "data" / file).read_bytes())
    (tmp_path / "examples").symlink_to(ROOT / "examples")  # lines to be typed in the project's folder
    for name, frequency in (("shaper.json", 8.7), ("x.json", 38.0), ("y.json", 61.0)):
        preshape.design.zvd((frequency, 0.024)).save(tmp_path / name)
    exported = preshape.export.render(preshape.design.zvd((8.7, 0.024)), "c", dt=0.001, name="gantry_x")
    preshape.workflow.save_export(exported, tmp_path / "firmware")
    job = DesignJob(family="zvd", modes=((47.3, 0.05),))
    (tmp_path / "report.html").write_text(as_html(asked_design_report(job, designed(job))))
    for name, shaper in (("before.csv", None), ("after.csv", preshape.design.zvd((46.0, 0.06)))):
        (tmp_path / name).write_text(klipper_text(recording(shaper)[0]))
    monkeypatch.setattr("preshape.studio.server.serve", lambda app, listening, opened: None)  # for ever otherwise
    result = CliRunner().invoke(command_line, shlex.split(line)[1:], catch_exceptions=False)
    assert result.exit_code == 0, result.output


@pytest.mark.parametrize("name", MODULES)
def test_docstring_examples(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    failures, _ = doctest.testmod(importlib.import_module(name), optionflags=doctest.NORMALIZE_WHITESPACE)
    assert failures == 0


def public_functions() -> Iterator[tuple[str, object]]:
    for name in MODULES:
        module: ModuleType = importlib.import_module(name)
        for public in getattr(module, "__all__", []):
            thing = getattr(module, public)
            if getattr(thing, "__module__", None) == name and (inspect.isfunction(thing) or inspect.isclass(thing)):
                yield f"{name}.{public}", thing


@pytest.mark.parametrize(("name", "thing"), [pytest.param(*pair, id=pair[0]) for pair in public_functions()])
def test_everything_public_is_documented(name: str, thing: object) -> None:
    text = inspect.getdoc(thing)
    assert text, f"{name} has no docstring"
    assert len(text.splitlines()[0]) <= 120
    if inspect.isfunction(thing) and "Parameters\n---" in text:
        section = text.split("Parameters\n---")[1].split("\n\nReturns")[0].split("\n\nRaises")[0]
        missing = [p for p in inspect.signature(thing).parameters if not re.search(rf"\b{p}\b", section)]
        assert not missing, f"{name} does not document {missing}"


def test_the_readme_names_the_two_commands_that_ci_runs() -> None:
    readme, ci = (ROOT / "README.md").read_text(), (ROOT / ".ci" / "run").read_text()
    for command in ("make demo", "make test"):
        assert command in readme
        assert command in ci
