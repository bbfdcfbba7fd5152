"""Simulations: a scenario in, arrays by name out."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from . import _gyroflex
from .errors import DivergedError, RobotWarning

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["ContactImpact", "SimulationResult", "simulate"]


@dataclass(frozen=True, eq=False)
class ContactImpact:
    """An impact of a robot with the ground: positions stay, velocities jump. Arrays have a row a contact, in world axes."""

    time: float
    """Simulated time [s]."""
    energy_lost: float
    """Kinetic energy before less that after [J]."""
    contacts: tuple[str, ...]
    """Names of the points that took part, those that were on the ground already among them."""
    impulse: NDArray[np.float64]
    """Impulses of the ground, shape ``(contacts, 3)`` [N s]."""
    velocity_before: NDArray[np.float64]
    """Velocities of the points before, shape ``(contacts, 3)`` [m/s]."""
    velocity_after: NDArray[np.float64]
    """Velocities of the points after, shape ``(contacts, 3)`` [m/s]."""


class SimulationResult(Mapping[str, "NDArray[np.float64]"]):
    """What a simulation recorded: arrays by name, one row a sample, and not to be written to.

    ======================================================  ====================  ==========================================
    name                                                    shape                 meaning
    ======================================================  ====================  ==========================================
    ``time``                                                ``(samples,)``        simulated time [s]
    ``q``, ``qd``, ``qdd``                                  ``(samples, joints)`` links [rad or m, per s, per s²]
    ``theta``, ``thetad``, ``thetadd``                      ``(samples, joints)`` motors, seen from the link side
    ``deflection``                                          ``(samples, joints)`` of the transmissions [rad or m]
    ``tau_j``, ``tau``                                      ``(samples, joints)`` of transmissions and of motors [N m or N]
    ``gyroscopic``, ``friction``                            ``(samples, joints)`` torques on the joints [N m or N]
    ``reference``, ``tracking_error``                       ``(samples, joints)`` [rad or m]
    ``kinetic_energy``, ``gravity_energy``, …               ``(samples,)``        [J]
    ``power_in``, ``dissipation``                           ``(samples,)``        [W]
    ``significance``                                        ``(samples,)``        of the rotors' coupling [-]
    ``eta``, ``etad``, ``etadd``                            ``(samples, modes)``  links that bend, by `Robot.mode_names` [m or rad]
    ``tip``                                                 ``(samples, 6 n)``     displacement and rotation vector of the tips beside
                                                                                  the rigid link [m, rad]
    ``base``                                                ``(samples, 13)``     floating root: ``x y z qx qy qz qw`` in the
                                                                                  world, twist in its own frame, angular first
    ``contact.<name>.force``                                ``(samples, 3)``      of the ground on a contact, world axes [N]; these
                                                                                  and the next only where something holds the robot
    ``contact.<name>.gap``, ``contact.<name>.mode``         ``(samples,)``        height above the ground [m]; 0 off it, 1 held by
                                                                                  it, 2 slipping
    ``center_of_mass``                                      ``(samples, 3)``      of the whole robot in the world [m]
    ``zero_moment_point``                                   ``(samples, 2)``      of the ground's forces, along the ground [m]
    ``constraint_drift``                                    ``(samples,)``        largest error of what is held so far [m or rad]
    ======================================================  ====================  ==========================================

    Joints are those of ``joint_names``, the ones of one degree of freedom in coordinate order. ``units`` has the unit of each
    column of each array.
    """

    __slots__ = ("_arrays", "impacts", "joint_names", "log", "metadata", "units", "warnings")

    def __init__(
        self,
        arrays: Mapping[str, NDArray[np.float64]],
        units: Mapping[str, tuple[str, ...]],
        joint_names: tuple[str, ...],
        metadata: Mapping[str, str],
        messages: tuple[str, ...],
        impacts: tuple[ContactImpact, ...],
        log: str | None,
    ) -> None:
        self._arrays = dict(arrays)
        for array in self._arrays.values():
            array.setflags(write=False)
        self.units = dict(units)
        """Unit of each column of each array, by the array's name."""
        self.joint_names = joint_names
        """Names of the joints behind the columns."""
        self.metadata = dict(metadata)
        """Parameters and versions of the run."""
        self.warnings = messages
        """What was ignored or assumed, and what speaks against the step size."""
        self.impacts = impacts
        """Impacts with the ground, in order of time."""
        self.log = log
        """Path of the MCAP log, if one was asked for."""

    @property
    def t(self) -> NDArray[np.float64]:
        """Simulated time, shape ``(samples,)`` [s]."""
        return self._arrays["time"]

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def __repr__(self) -> str:
        end = f" up to {self.t[-1]:g} s" if self.t.size else ""
        return f"<SimulationResult: {self.t.size} samples of {len(self.joint_names)} joints{end}>"


def simulate(
    scenario: str | os.PathLike[str],
    *,
    log: str | os.PathLike[str] | None = None,
    set: Mapping[str, object] | None = None,
) -> SimulationResult:
    """Runs a scenario YAML and returns what it recorded. Other threads go on meanwhile; Ctrl-C stops it.

    Parameters
    ----------
    scenario
        The scenario's file; the robot it names is looked for beside it.
    log
        Where to write an MCAP log as well. It is complete also after a run that diverged or was stopped.
    set
        Other values of keys, such as ``{"controller.kp": 400, "drives.joint2.transmission.stiffness": 1e4}``: keys of the
        scenario, else of its robot's YAML (``robot.gravity`` where both have one), and anything that could be written there.

    Raises
    ------
    DivergedError
        With joint and time; its ``result`` is what was recorded up to there.
    ScenarioError, FormatError, ModelError, FileError
        What is wrong with which file, before anything runs.

    What was ignored or assumed is issued as ``RobotWarning`` and kept in the result's ``warnings``.
    """
    result, error = record(scenario, log, set)
    for message in result.warnings:
        warnings.warn(message, RobotWarning, stacklevel=2)
    if error is not None:
        raise error
    return result


def record(
    scenario: str | os.PathLike[str],
    log: str | os.PathLike[str] | None,
    set: Mapping[str, object] | None,
) -> tuple[SimulationResult, DivergedError | None]:
    """A run, and its error if it diverged; says nothing by itself."""
    arrays, units, joint_names, metadata, messages, impacts, error = _gyroflex.run_scenario(scenario, log, set)
    path = None if log is None else os.fspath(log)
    struck = tuple(ContactImpact(*impact) for impact in impacts)
    result = SimulationResult(arrays, units, joint_names, metadata, tuple(messages), struck, path)
    if error is not None:
        error.result = result
    return result, error
