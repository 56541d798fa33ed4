"""The pages on targets and firmwares say what the code does."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from preshape.cli.export_screen import held_by
from preshape.export import TARGETS, SettingsTarget
from preshape.vibration import residual_vibration

DOCS = Path(__file__).resolve().parents[2] / "docs"

SETTINGS = {
    "Klipper since 2026-03": ("klipper", "2026-03", "shaper_type_x: {}\nshaper_freq_x: 50"),
    "Klipper before 2025-09, Kalico main": ("klipper", "old", "shaper_type_x: {}\nshaper_freq_x: 50"),
    "RepRapFirmware 3.5 and 3.6": ("rrf", "3.6", 'M593 P"{}" F50 S0.1'),
    "Prusa Buddy": ("prusa", "buddy", "M593 T{} F50"),
    "Marlin, fixed-time motion": ("marlin-ft", "2.1", "M493 C{} A50 I0.1"),
    "Marlin, standard motion": ("marlin", "2.1", "M593 F50 D0.1{}"),
}
KLIPPER = ["zv", "mzv", "zvd", "ei", "2hump_ei", "3hump_ei"]
NAMES = {
    "klipper": KLIPPER,
    "rrf": [None, "mzv", "zvd", None, "ei2", "ei3"],
    "prusa": [0, 2, 1, 3, 4, 5],
    "marlin-ft": [1, 8, 2, 5, 6, 7],
    "marlin": ["", None, None, None, None, None],
}


def rows(page: str) -> list[list[str]]:
    lines = [line for line in (DOCS / page).read_text().splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def test_the_table_of_targets_is_the_list() -> None:
    expected = [
        [f"`{target.name}`", target.summary, ", ".join(target.versions), held_by(target)] for target in TARGETS.values()
    ]
    assert rows("reference/targets.md")[1:] == expected


@pytest.mark.parametrize("machine", SETTINGS)
def test_same_name_different_pulses(machine: str) -> None:
    """At 50 Hz and a damping of 0.1, what exactly that setting leaves."""
    name, version, text = SETTINGS[machine]
    target = TARGETS[name]
    assert isinstance(target, SettingsTarget)
    expected = [
        "-"
        if kind is None
        else f"{100.0 * residual_vibration(target.execute(text.format(kind), version), 50.0, 0.1):.2f}"
        for kind in NAMES[name]
    ]
    assert [machine, *expected] in rows("how-to/firmware.md")


def test_versions_of_the_page_on_firmwares() -> None:
    listed = {row[0]: row[1] for row in rows("how-to/firmware.md") if row[0].strip("`") in TARGETS}
    worded = {n: t for n, t in TARGETS.items() if isinstance(t, SettingsTarget) and n not in ("zaber", "csv", "json")}
    assert {f"`{name}`" for name in worded} == set(listed)
    for name, target in worded.items():
        assert re.findall(r"`([^`]+)`", listed[f"`{name}`"]) == list(target.versions)
