"""The campaign file ``preshape/campaign/1``: TOML, read with limits, never evaluated; the files it names are taken in.

What is taken in stands in for the file from here on: its digest is the campaign's, and any process can rebuild the
campaign from it. The fields are documented in docs/how-to/campaign.md and stable.
"""

from __future__ import annotations

import hashlib
import math
import os
import stat
import tomllib
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import msgspec

from preshape.campaign.kind import Kind
from preshape.campaign.kinds import KINDS, CampaignSettings
from preshape.campaign.machines import NAMED_MACHINES, machine_of
from preshape.errors import InputError
from preshape.plant.plant_file import PLANT_SCHEMA, read_plant_data
from preshape.shaper_file import read_json

__all__ = ["CAMPAIGN_SCHEMA", "Campaign", "campaign_of", "read_campaign"]

CAMPAIGN_SCHEMA = "preshape/campaign/1"

LARGEST_FILE = 10_000_000
"""Bytes; a table of ten thousand configurations takes one million."""


@dataclass(frozen=True)
class Campaign:
    """A campaign that is complete: nothing outside it matters.

    Attributes
    ----------
    inputs : bytes
        All of it as JSON, files that it names included.
    digest : str
        SHA-256 of the inputs and of this version of preshape, but without the number of random points: more of them
        are more of the same.
    """

    inputs: bytes
    digest: str

    def kind(self) -> Kind:
        """Ready to compute; InputError if its parts do not fit each other."""
        settings = msgspec.json.decode(self.inputs, type=CampaignSettings)
        for name, build in KINDS.items():
            if (own := getattr(settings, name)) is not None:
                settings.shaper.check()
                built: Kind = build(own, machine_of(settings.machine), settings.shaper)
                return built
        raise AssertionError("read_campaign lets no campaign without a kind pass")


def read_campaign(path: str | os.PathLike[str]) -> Campaign:
    """The campaign in a TOML file.

    Parameters
    ----------
    path : path-like
        Files it names are looked for beside it.

    Raises
    ------
    InputError
        If it or a file that it names cannot be read, or does not describe a campaign; one sentence says where and why.

    Examples
    --------
    >>> read_campaign("examples/data/crane-map.toml").kind().count
    60
    """
    source = Path(path)
    data = _toml(source)
    try:
        return campaign_of(data, source.parent)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None


def campaign_of(data: Any, folder: str | os.PathLike[str] = ".") -> Campaign:
    """The campaign that the data of a file describe, as :func:`read_campaign`.

    Parameters
    ----------
    data : mapping
        What the TOML file holds.
    folder : path-like
        Where files are that it names.

    Raises
    ------
    InputError
        If the data do not describe a campaign.
    """
    if not isinstance(data, dict):
        raise InputError(f"a campaign is a table of settings, not {type(data).__name__}.")
    found = _with_files(data, Path(folder))
    _check_finite(found, "")
    schema = found.pop("schema", None)
    if schema != CAMPAIGN_SCHEMA:
        raise InputError(f"its schema is {schema!r}: write schema = {CAMPAIGN_SCHEMA!r}, the one this version reads.")
    try:
        settings = msgspec.convert(found, CampaignSettings)
    except msgspec.ValidationError as error:
        raise InputError(f"not a {CAMPAIGN_SCHEMA} file: {error}.") from None
    given = [name for name in KINDS if getattr(settings, name) is not None]
    if len(given) != 1:
        raise InputError(
            f"it describes {len(given)} campaigns: give one of {', '.join(f'[{name}]' for name in KINDS)}."
        )
    encoder = msgspec.json.Encoder(order="sorted")
    hashed = msgspec.to_builtins(settings)
    hashed[given[0]].pop("points", None)
    digest = hashlib.sha256(encoder.encode([CAMPAIGN_SCHEMA, version("preshape"), hashed])).hexdigest()
    campaign = Campaign(encoder.encode(settings), digest)
    campaign.kind()
    return campaign


def _check_finite(data: Any, where: str) -> None:
    """JSON, as which the inputs are kept, has no word for NaN and infinity, and no setting needs them."""
    if isinstance(data, dict):
        for key, value in data.items():
            _check_finite(value, f"{where}.{key}" if where else str(key))
    elif isinstance(data, list | tuple):
        for value in data:
            _check_finite(value, where)
    elif isinstance(data, float) and not math.isfinite(data):
        raise InputError(f"{where} holds {data:g}: give finite numbers.")


def _with_files(data: dict[str, Any], folder: Path) -> dict[str, Any]:
    """The data with the content of plant and shaper files in their places."""
    found = dict(data)
    machine, shaper = found.get("machine"), found.get("shaper")
    if isinstance(machine, dict) and isinstance(machine.get("plant"), str):
        name = machine["plant"]
        if name not in NAMED_MACHINES:
            if not name.endswith((".toml", ".json")):
                known = ", ".join(NAMED_MACHINES)
                raise InputError(f"machine.plant is {name!r}: give a plant file, .toml or .json, or one of {known}.")
            found["machine"] = {**machine, "plant": read_plant_data(folder / name)}
    elif isinstance(machine, dict) and isinstance(machine.get("plant"), dict):
        found["machine"] = {**machine, "plant": {"schema": PLANT_SCHEMA, **machine["plant"]}}
    if isinstance(shaper, dict) and "file" in shaper:
        if not isinstance(shaper["file"], str):
            raise InputError(f"shaper.file is {shaper['file']!r}: give the name of a shaper.json.")
        rest = {key: value for key, value in shaper.items() if key != "file"}
        found["shaper"] = {**rest, "given": read_json(folder / shaper["file"])}
    return found


def _toml(source: Path) -> Any:
    try:
        status = source.stat()
        if not stat.S_ISREG(status.st_mode):
            raise InputError(f"{source} is not a regular file: give a campaign file, .toml.")
        if status.st_size > LARGEST_FILE:
            raise InputError(
                f"{source} has {status.st_size / 1e6:.0f} MB and a campaign file at most {LARGEST_FILE / 1e6:.0f} MB."
            )
        return tomllib.loads(source.read_bytes().decode())
    except (OSError, ValueError, RecursionError) as error:
        if isinstance(error, InputError):
            raise
        if isinstance(error, OSError):
            raise InputError(f"cannot read {source}: {error.strerror or error}; give a campaign file, .toml.") from None
        raise InputError(f"{source} is not TOML ({error}): it is truncated or misspelt; correct it.") from None
