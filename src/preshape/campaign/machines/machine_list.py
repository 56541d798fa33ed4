"""The machines there are: what a campaign file's [machine] says, as a Machine. A new one is a file and a line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Annotated, Any

import msgspec

from preshape.campaign.machines.linear import LinearMachine
from preshape.campaign.machines.mace import MaceMachine
from preshape.campaign.machines.machine import Machine
from preshape.campaign.machines.mode_table import ModeTable
from preshape.campaign.machines.pendulum import Pendulum
from preshape.campaign.machines.shuttle_arm import ShuttleArmMachine
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant import linear_mace
from preshape.plant.plant_file import plant_of

__all__ = ["NAMED_MACHINES", "MachineSettings", "machine_of"]

ModePairs = Annotated[list[tuple[float, float]], msgspec.Meta(min_length=1, max_length=100)]
"""(natural frequency [Hz], damping ratio [-])."""


class TableRow(msgspec.Struct, forbid_unknown_fields=True):
    """Modes at a configuration."""

    at: Annotated[list[float], msgspec.Meta(min_length=1, max_length=6)]
    modes: ModePairs


class MachineSettings(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """The [machine] of a campaign file: a plant, or modes, or a table of modes.

    Parameters
    ----------
    plant : str or mapping
        A name in `NAMED_MACHINES`, or the data of a plant file.
    modes : list of (float, float)
        [Hz], [-].
    table : list of TableRow
        Modes by configuration.
    parameters : mapping of str to str
        Names and units of the table's numbers.
    payload_at : int
        Coordinate of the plant's matrices that carries the payload.
    damping : float
        Of a pendulum [-].
    """

    plant: str | dict[str, Any] | None = None
    modes: ModePairs | None = None
    table: Annotated[list[TableRow], msgspec.Meta(min_length=1, max_length=100_000)] | None = None
    parameters: dict[str, str] | None = None
    payload_at: Annotated[int, msgspec.Meta(ge=0)] | None = None
    damping: float | None = None


NAMED_MACHINES: Mapping[str, Callable[[], Machine]] = MappingProxyType(
    {
        "mace-linear": lambda: LinearMachine(lambda _: linear_mace(), takes_payload=False),
        "mace": MaceMachine,
        "shuttle-arm": ShuttleArmMachine,
        "pendulum": Pendulum,
    }
)
"""Those that need no file."""


def machine_of(settings: MachineSettings) -> Machine:
    """The machine that the settings describe; InputError when they describe none, or two."""
    given = [name for name in ("plant", "modes", "table") if getattr(settings, name) is not None]
    if len(given) != 1:
        raise InputError(f"[machine] describes {len(given)} machines: give one of plant, modes and table.")
    if settings.parameters is not None and settings.table is None:
        raise InputError("machine.parameters name the numbers of a table: give machine.table too, or leave them out.")
    if settings.damping is not None and settings.plant != "pendulum":
        raise InputError('machine.damping is a pendulum\'s: give it with plant = "pendulum" only.')
    if settings.payload_at is not None and not isinstance(settings.plant, dict):
        raise InputError("machine.payload_at is a coordinate of matrices: give a plant file with these.")
    if settings.modes is not None:
        return ModeTable({}, {(): Modes(settings.modes)})
    if settings.table is not None:
        rows = {tuple(row.at): Modes(row.modes) for row in settings.table}
        if len(rows) != len(settings.table):
            raise InputError("machine.table names a configuration twice: give each once.")
        if not settings.parameters:
            raise InputError('machine.table needs machine.parameters, names with units, such as { length = "m" }.')
        return ModeTable(settings.parameters, rows)
    if isinstance(settings.plant, dict):
        data, at = settings.plant, settings.payload_at
        return LinearMachine(lambda payload: plant_of(data, {at: payload} if at is not None else None), at is not None)
    if settings.plant == "pendulum":
        return Pendulum(settings.damping or 0.0)
    assert settings.plant is not None
    return NAMED_MACHINES[settings.plant]()
