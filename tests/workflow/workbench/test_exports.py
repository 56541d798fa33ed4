"""Every target of the export comes out of the workbench, as the export itself writes it."""

from __future__ import annotations

import io
import zipfile

import pytest

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.export import TARGETS, render
from preshape.workflow.workbench import export_targets, packaged

SHAPER = design.zv((40.0, 0.05))
RATES = {target.name: 1000.0 if target.sampled else None for target in export_targets()}


def test_every_target_is_listed_once() -> None:
    assert [target.name for target in export_targets()] == list(TARGETS)
    assert all(len(target.limits) == len(target.versions) for target in export_targets())


@pytest.mark.parametrize("name", TARGETS)
def test_what_is_saved_is_what_the_export_renders(name: str) -> None:
    rate = RATES[name]
    package = packaged(SHAPER, name, rate=rate)
    expected = render(SHAPER, name, dt=None if rate is None else 1.0 / rate)
    contents = {
        one: content.encode() if isinstance(content, str) else content for one, content in expected.files.items()
    }
    assert {one.name: one.content for one in package.files} == contents
    if len(contents) == 1:
        assert package.content == next(iter(contents.values()))
    else:
        with zipfile.ZipFile(io.BytesIO(package.content)) as archive:
            assert {one: archive.read(one) for one in archive.namelist()} == contents
    assert package.shaper == expected.placed.shaper
    assert isinstance(package.shaper, Shaper)


@pytest.mark.parametrize(
    ("target", "wishes", "sentence"),
    [
        ("c", {}, "give the controller's sample rate"),
        ("c", {"rate": -1.0}, "above 0"),
        ("c", {"rate": 1000.0, "axis": "x"}, "leave the axis out"),
        ("klipper", {"rate": 1000.0}, "no sample grid"),
        ("klipper", {"name": "../x"}, "cannot be used in every language"),
        ("nothing", {}, "not known"),
    ],
)
def test_what_does_not_go_together_is_said(target: str, wishes: dict[str, object], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        packaged(SHAPER, target, **wishes)  # type: ignore[arg-type]
