"""MACE once more, by another method: a floating frame with five assumed shapes of the bus, for tests.

The frame rides on the middle node. In it the bus bends linearly, in its first two free-free modes and three attachment
shapes (the static answers to what loads it: force and moment at the right end, moment in the middle); it does not
stretch, and its deflection takes no part in the length (no geometric stiffening). Masses are points and rigid bodies;
everything else is exact in the rotations.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

from preshape.plant.mace import MaceGains, MaceStructure
from preshape.plant.mace.linear import Linearised, bending_damping, lumps
from preshape.plant.mace.structure import LENGTH

ELEMENTS = 4


class FloatingFrame:
    """Coordinates: frame x, y, angle; shapes of the bus; payload angle."""

    def __init__(self, structure: MaceStructure, gains: MaceGains | None, damping: float) -> None:
        self.s, self.gains, self.size = structure, gains, 9
        nodes = 4 * ELEMENTS + 1
        self.places = np.linspace(-0.5 * LENGTH, 0.5 * LENGTH, nodes)
        bending = [3 * k + i for k in range(nodes) for i in (1, 2)]
        model = Linearised(structure, elements=ELEMENTS)
        stiffness = model.stiffness[np.ix_(bending, bending)]
        mass = model.mass[np.ix_(bending, bending)]
        _, free = eigh(stiffness, mass)
        # Attachment: the load at the end balanced by the inertia of rigid motion, so that the free bus can carry it.
        middle = 4 * ELEMENTS
        loads = np.zeros((len(bending), 3))
        loads[-2, 0] = loads[-1, 1] = loads[middle + 1, 2] = 1.0
        rigid = free[:, :2]
        static = np.linalg.lstsq(stiffness, loads - mass @ rigid @ (rigid.T @ loads), rcond=None)[0]
        shapes = np.column_stack([free[:, 2:4], static / np.abs(static).max(axis=0)])
        unit = np.zeros((len(bending), 2))
        unit[0::2, 0], unit[0::2, 1], unit[1::2, 1] = 1.0, self.places, 1.0
        shapes = shapes - unit @ shapes[[middle, middle + 1]]
        self.across, self.slope = shapes[0::2], shapes[1::2]
        self.stiffness = shapes.T @ stiffness @ shapes
        damper = bending_damping(structure, ELEMENTS, damping) if damping else np.zeros_like(stiffness)
        self.damper = shapes.T @ damper @ shapes
        bus = np.full(nodes, structure.bus_density * LENGTH / (nodes - 1))
        bus[[0, -1]] *= 0.5
        bodies = [(k, float(m), 0.0, 0.0) for k, m in enumerate(bus)]
        bodies += [(lump.node, lump.mass, lump.height, lump.inertia) for lump in lumps(structure, ELEMENTS)]
        # The last one is the payload's hinge: its mass is that of the payload.
        bodies.append((nodes - 1, structure.turning_mass, structure.axis_height, 0.0))
        node, self.masses, self.heights, self.inertias = (np.array(row) for row in zip(*bodies, strict=True))
        self.x, self.v, self.w = self.places[node], self.across[node], self.slope[node]
        self.turns = np.zeros((len(node), self.size))
        self.turns[:, 2], self.turns[:, 3:-1] = 1.0, self.w

    def acceleration(self, q: NDArray, v: NDArray, gimbal: float, attitude: float) -> NDArray:
        """Second derivative of the coordinates under torques."""
        turn, rate, eta, eta_rate = q[2], v[2], q[3:-1], v[3:-1]
        x_axis, y_axis = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        off, off_rate = self.v @ eta, self.v @ eta_rate
        lean, lean_rate = turn + self.w @ eta, rate + self.w @ eta_rate
        up = np.column_stack([-np.sin(lean), np.cos(lean)])
        turned = self.heights[:, np.newaxis] * np.column_stack([-np.cos(lean), -np.sin(lean)])
        # Each body's point: its Jacobian, and what of its acceleration the rates alone make.
        jacobian = np.zeros((len(self.x), 2, self.size))
        jacobian[:, 0, 0] = jacobian[:, 1, 1] = 1.0
        jacobian[:, :, 2] = np.outer(self.x, y_axis) - np.outer(off, x_axis) + turned
        jacobian[:, :, 3:-1] = (
            y_axis[:, np.newaxis] * self.v[:, np.newaxis] + turned[:, :, np.newaxis] * self.w[:, np.newaxis]
        )
        free = -(rate**2) * (np.outer(self.x, x_axis) + np.outer(off, y_axis)) - 2.0 * rate * np.outer(off_rate, x_axis)
        free -= (self.heights * lean_rate**2)[:, np.newaxis] * up
        arm, theta = self.s.arm, q[-1]
        jacobian[-1, :, -1] = arm * np.array([-np.cos(theta), -np.sin(theta)])
        free[-1] -= arm * v[-1] ** 2 * np.array([-np.sin(theta), np.cos(theta)])
        weighted = jacobian * self.masses[:, np.newaxis, np.newaxis]
        mass = np.tensordot(weighted, jacobian, axes=([0, 1], [0, 1])) + (self.turns.T * self.inertias) @ self.turns
        mass[-1, -1] += self.s.payload_inertia
        force = -np.tensordot(weighted, free, axes=([0, 1], [0, 1]))
        force[3:-1] -= self.stiffness @ eta + self.damper @ eta_rate + gimbal * self.slope[-1]
        force[-1] += gimbal
        force[2] += attitude - gimbal
        return np.linalg.solve(mass, force)

    def slew(self, angle: float, command: object, times: NDArray) -> NDArray:
        """Coordinates, shape (coordinate, time), from rest under a torque of the gimbal, or with gains an angle."""
        gains = self.gains

        def rates(t: float, state: NDArray) -> NDArray:
            q, v = state[: self.size], state[self.size :]
            wanted = command(t)  # type: ignore[operator]
            if gains is None:
                gimbal, attitude = wanted, 0.0
            else:
                gimbal = gains.gimbal_stiffness * (wanted - q[-1]) - gains.gimbal_damping * v[-1]
                attitude = -gains.attitude_stiffness * q[2] - gains.attitude_damping * v[2]
            return np.concatenate([v, self.acceleration(q, v, gimbal, attitude)])

        start = np.zeros(2 * self.size)
        start[self.size - 1] = angle
        solved = solve_ivp(
            rates, (times[0], times[-1]), start, method="LSODA", t_eval=times, rtol=1e-7, atol=1e-10, max_step=0.01
        )
        return solved.y[: self.size]

    def off_line(self, node: int, q: NDArray) -> NDArray:
        """Of a node, across the bus relative to its middle and the slope there [m], shape (time,)."""
        return self.across[node] @ q[3:-1]
