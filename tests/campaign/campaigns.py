"""Small campaigns for the tests, as the data of a campaign file."""

from __future__ import annotations

from typing import Any

from preshape.campaign import Campaign, campaign_of

__all__ = ["FOUR_MODES", "campaign", "mode_map", "robustness"]

SCHEMA = "preshape/campaign/1"

FOUR_MODES = [[0.20, 0.01], [0.26, 0.01], [0.45, 0.01], [0.59, 0.01]]


def campaign(data: dict[str, Any], *changes: tuple[str, Any]) -> Campaign:
    """The campaign, with settings changed by their dotted names; None takes one out."""
    changed = _copied(data)
    for name, value in changes:
        *path, last = name.split(".")
        table = changed
        for part in path:
            table = table.setdefault(part, {})
        if value is None:
            table.pop(last, None)
        else:
            table[last] = value
    return campaign_of(changed, ".")


def mode_map(count: int) -> dict[str, Any]:
    """`count` designs for four modes that move with one number, s, from 1 to 1.3."""
    return {
        "schema": SCHEMA,
        "machine": {
            "parameters": {"s": ""},
            "table": [
                {"at": [s], "modes": [[f * s ** (k + 1), z] for k, (f, z) in enumerate(FOUR_MODES)]} for s in (1.0, 1.3)
            ],
        },
        "shaper": {"family": "direct", "order": 1},
        "map": {"axes": {"s": {"low": 1.0, "high": 1.3, "count": count}}},
    }


def robustness(points: int, frequency: float = 1.0) -> dict[str, Any]:
    """A step of a machine with one undamped mode, known to 5 %."""
    return {
        "schema": SCHEMA,
        "machine": {"modes": [[frequency, 0.0]]},
        "shaper": {"family": "zvd"},
        "robustness": {
            "points": points,
            "seed": 4,
            "scatter": {"frequency": 0.05},
            "move": {"dt": 0.001, "times": [0.0], "values": [1.0]},
        },
    }


def _copied(data: dict[str, Any]) -> dict[str, Any]:
    return {key: _copied(value) if isinstance(value, dict) else value for key, value in data.items()}
