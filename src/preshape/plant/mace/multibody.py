"""MACE as a flexible multibody system: absolute nodal coordinate beams between rigid bodies, in Exudyn.

The struts are ANCF cable elements (large rotations, exact Bernoulli-Euler bending). Nodes with what is mounted on them
are rigid bodies, joined to the beams; the payload hangs on a hinge. Lumped on the beam nodes' slope vectors instead,
they would need no joints, but an offset mass then also stretches the slope vector: 47 Hz became 43 Hz with finer
elements.
Everything of Exudyn's is imported, silenced and called here.
"""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.plant.mace.linear import bending_damping, lumps
from preshape.plant.mace.structure import LENGTH, MaceGains, MaceStructure

__all__ = ["MaceBody", "lump_heights", "quiet_exudyn"]

NEWTON = 1e-6
"""Newton's tolerances. Exudyn's own 1e-8 is below what these residuals reach: its steps crawl or fail."""

Matrix = NDArray[np.float64]
Step = Callable[[int, Matrix, Matrix, Matrix], "tuple[float, float] | None"]


@contextlib.contextmanager
def quiet_exudyn() -> Iterator[tuple[Any, Any]]:
    """Exudyn and its items: nothing printed, its deprecation warnings left to whoever raises its pinned version.

    Raises
    ------
    InputError
        If it is not installed.
    """
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")
        try:
            import exudyn
            from exudyn import itemInterface
        except ImportError:
            raise InputError(
                "the non-linear MACE model needs Exudyn, which is not installed: pip install 'preshape[plants]'."
            ) from None
        yield exudyn, itemInterface


def lump_heights(structure: MaceStructure, elements: int) -> dict[int, tuple[float, float, float]]:
    """The rigid body on each node that has one: mass [kg], height above the bus [m], inertia about itself [kg m^2]."""
    bodies: dict[int, tuple[float, float, float]] = {}
    for lump in lumps(structure, elements):
        mass, height, inertia = bodies.get(lump.node, (0.0, 0.0, 0.0))
        total = mass + lump.mass
        centre = (mass * height + lump.mass * lump.height) / total
        about = inertia + mass * (height - centre) ** 2 + lump.inertia + lump.mass * (lump.height - centre) ** 2
        bodies[lump.node] = (total, centre, about)
    return bodies


class MaceBody:
    """The system at rest with the payload at an angle.

    Parameters
    ----------
    structure : MaceStructure
    angle : float
        Of the right payload [rad].
    elements : int
        A strut.
    damping : float
        Ratio of the bus's bending modes [-].
    gains : MaceGains, optional
        The attitude loop among them becomes part of the system; the gimbal's is up to the torques.

    Attributes
    ----------
    coordinates : int
        How many: x, y, slope x, slope y of every beam node; x, y [m] and angle [rad] of the five rigid bodies on the
        bus, the left first, and of the payload. All relative to where they start.
    """

    def __init__(
        self, structure: MaceStructure, angle: float, *, elements: int, damping: float, gains: MaceGains | None
    ) -> None:
        with quiet_exudyn() as (exudyn, items):
            self._container = exudyn.SystemContainer()
            self._system = self._container.AddSystem()
            self._build(items, structure, angle, elements, damping, gains)
            self._system.Assemble()
        self.coordinates = len(self._system.systemData.GetODE2Coordinates())

    def natural_frequencies(self) -> Matrix:
        """From Exudyn's own linearisation, dampers left out, the four rigid motions first [Hz]."""
        with quiet_exudyn():
            squared = self._system.ComputeODE2Eigenvalues(useAbsoluteValues=True)[0]
        return np.asarray(np.sqrt(np.abs(squared)) / (2.0 * np.pi))

    def run(self, step: float, count: int, torques: Step) -> tuple[Matrix, Matrix, str]:
        """Integrate by the trapezoidal rule (index 2: it takes and adds no energy of its own).

        Parameters
        ----------
        step : float
            [s].
        count : int
            How many steps.
        torques : callable
            Called as ``torques(k, q, v, a)`` with the coordinates and their derivatives at step k; returns the gimbal's
            and the attitude unit's torque [N m] at the end of that step, or None to stop. At k = -1: those at time 0.

        Returns
        -------
        positions, velocities : ndarray, shape (time, coordinate)
            At 0, step, ..., as far as it came: count + 1 if it was not stopped.
        failure : str
            Why it came no further; empty if it did.
        """
        positions, velocities = np.empty((2, count + 1, self.coordinates))
        data = self._system.systemData
        done, stopped = 0, False
        raised: BaseException | None = None

        def before(system: Any, _time: float) -> bool:
            nonlocal done, stopped, raised
            q, v = data.GetODE2Coordinates(), data.GetODE2Coordinates_t()
            positions[done], velocities[done] = q, v
            try:
                wanted = torques(done, q, v, data.GetODE2Coordinates_tt())
            except BaseException as error:  # must not pass through Exudyn, which would hide it
                raised, wanted = error, None
            if wanted is None:
                stopped = True
                return False
            done += 1
            self._load(*wanted)
            return True

        first = torques(-1, np.zeros(self.coordinates), np.zeros(self.coordinates), np.zeros(self.coordinates))
        assert first is not None
        failure = ""
        if count == 0:
            return np.zeros((1, self.coordinates)), np.zeros((1, self.coordinates)), failure
        with quiet_exudyn() as (exudyn, _):
            self._load(*first)
            self._system.SetPreStepUserFunction(before)
            exudyn.config.printToConsole = False
            try:
                self._system.SolveDynamic(
                    self._settings(exudyn, step, count), solverType=exudyn.DynamicSolverType.TrapezoidalIndex2
                )
            except Exception as error:  # Exudyn's own SolverError
                failure = f"the solver found no next step ({type(error).__name__})"
            finally:
                exudyn.config.printToConsole = True
        if raised is not None:
            raise raised
        if stopped:
            return positions[:done], velocities[:done], "stopped"
        if failure:
            return positions[: max(done, 1)], velocities[: max(done, 1)], failure
        positions[count], velocities[count] = data.GetODE2Coordinates(), data.GetODE2Coordinates_t()
        return positions, velocities, ""

    def _load(self, gimbal: float, attitude: float) -> None:
        for load, torque in zip(self._loads, (gimbal, -gimbal, attitude), strict=True):
            self._system.SetLoadParameter(load, "loadVector", [0.0, 0.0, torque])

    def _settings(self, exudyn: Any, step: float, count: int) -> Any:
        settings = exudyn.SimulationSettings()
        integration = settings.timeIntegration
        integration.numberOfSteps, integration.endTime = count, step * count
        integration.verboseMode = 0
        integration.newton.relativeTolerance = integration.newton.absoluteTolerance = NEWTON
        integration.newton.useModifiedNewton = True
        integration.adaptiveStep = False
        settings.solution.file.write = False
        return settings

    def _rigid(self, items: Any, mass: float, height: float, inertia: float, place: list[float]) -> Any:
        node = self._system.AddNode(items.NodeRigidBody2D(referenceCoordinates=[place[0], place[1] + height, 0.0]))
        return self._system.AddObject(items.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node)), node

    def _build(
        self, items: Any, s: MaceStructure, angle: float, elements: int, damping: float, gains: MaceGains | None
    ) -> None:
        system, last = self._system, 4 * elements
        length = LENGTH / last
        places = np.linspace(-0.5 * LENGTH, 0.5 * LENGTH, last + 1)
        nodes = [system.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[x, 0.0, 1.0, 0.0])) for x in places]
        for pair in zip(nodes, nodes[1:], strict=False):
            system.AddObject(
                items.ObjectANCFCable2D(
                    length=length,
                    massPerLength=s.bus_density,
                    bendingStiffness=s.bending_stiffness,
                    axialStiffness=s.axial_stiffness,
                    nodeNumbers=list(pair),
                )
            )
        system.AddObject(
            items.ObjectGenericODE2(
                nodeNumbers=nodes,
                massMatrix=np.zeros((4 * len(nodes),) * 2),
                stiffnessMatrix=np.zeros((4 * len(nodes),) * 2),
                dampingMatrix=node_damping(s, elements, damping),
            )
        )
        heights = lump_heights(s, elements)
        bodies = {k: self._rigid(items, *body, [places[k], 0.0]) for k, body in heights.items()}
        on_nodes = {k: system.AddMarker(items.MarkerNodeRigid(nodeNumber=nodes[k])) for k in bodies}
        for k, (body, _) in bodies.items():
            at = system.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[0.0, -heights[k][1], 0.0]))
            system.AddObject(
                items.ObjectJointGeneric(markerNumbers=[on_nodes[k], at], constrainedAxes=[1, 1, 0, 0, 0, 1])
            )
        hinge = np.array([0.5 * LENGTH, s.axis_height])
        centre = hinge + s.arm * np.array([-np.sin(angle), np.cos(angle)])
        carried = system.AddNode(items.NodeRigidBody2D(referenceCoordinates=[*centre, angle]))
        payload = system.AddObject(
            items.ObjectRigidBody2D(mass=s.turning_mass, inertia=s.payload_inertia, nodeNumber=carried)
        )
        axis = [
            system.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=[0.0, place, 0.0]))
            for body, place in ((bodies[last][0], s.axis_height - heights[last][1]), (payload, -s.arm))
        ]
        system.AddObject(items.ObjectJointRevolute2D(markerNumbers=axis))
        pushed = [
            system.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[0.0, 0.0, 0.0]))
            for body in (payload, bodies[last][0], bodies[last // 2][0])
        ]
        self._loads = [
            system.AddLoad(items.LoadTorqueVector(markerNumber=marker, loadVector=[0.0, 0.0, 0.0])) for marker in pushed
        ]
        if gains is not None:
            ground = system.AddObject(items.ObjectGround())
            still = system.AddMarker(items.MarkerBodyRigid(bodyNumber=ground))
            system.AddObject(
                items.ObjectConnectorTorsionalSpringDamper(
                    markerNumbers=[still, pushed[2]],
                    stiffness=gains.attitude_stiffness,
                    damping=gains.attitude_damping,
                )
            )


def node_damping(structure: MaceStructure, elements: int, ratio: float) -> Matrix:
    """`bending_damping` on the four coordinates a node of the cable elements: position across, slope across."""
    nodes = 4 * elements + 1
    damping = np.zeros((4 * nodes,) * 2)
    bending = [4 * k + i for k in range(nodes) for i in (1, 3)]
    if ratio > 0.0:
        damping[np.ix_(bending, bending)] = bending_damping(structure, elements, ratio)
    return damping
