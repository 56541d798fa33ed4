"""The Shuttle's arm: pose and payload are known, the stiffness of each joint is not exactly so."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from preshape.campaign.machines.machine import Factors, Instance, Values
from preshape.checks import not_negative
from preshape.mode import Modes
from preshape.plant import ShuttleArm
from preshape.plant.shuttle_arm import CALIBRATED_JOINTS, JOINTS, Payload

__all__ = ["ShuttleArmMachine"]

RATE = " rate"
"""Ends the name of an input: what of its joint is commanded."""


class ShuttleArmMachine:
    """With its servos and all imperfections of its joints; the inputs are the joints' rates."""

    @property
    def parameters(self) -> Mapping[str, str]:
        return {**dict.fromkeys(JOINTS, "rad"), "payload": "kg"}

    @property
    def scatters(self) -> Mapping[str, int]:
        return {"stiffness": len(JOINTS)}

    def known_modes(self, values: Values) -> Modes:
        return self._arm(values, {}).modes()

    def after(self, values: Values, name: str, command: NDArray[np.float64], dt: float) -> Values:
        joint = name.removesuffix(RATE)
        return {**values, joint: values.get(joint, 0.0) + dt * float(command.sum())}

    def instance(self, values: Values, end: Values, factors: Factors) -> Instance:
        arm = self._arm(values, factors)
        return Instance(arm, arm.modes([end.get(joint, 0.0) for joint in JOINTS]))

    def _arm(self, values: Values, factors: Factors) -> ShuttleArm:
        joints = CALIBRATED_JOINTS
        if "stiffness" in factors:
            joints = replace(joints, stiffness=joints.stiffness * factors["stiffness"])
        mass = not_negative("payload", values.get("payload", 0.0), "kg")
        return ShuttleArm(
            tuple(values.get(joint, 0.0) for joint in JOINTS),
            Payload(mass) if mass else None,
            joints,
        )
