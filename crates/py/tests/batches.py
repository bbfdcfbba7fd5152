"""Batches of random states, and the calls that take them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gyroflex
import numpy as np
from conftest import random_state

ROWS = 300  # more than one task, and no multiple of the lanes
Call = Callable[..., Any]


def batch_of(robot: gyroflex.Robot, rows: int = ROWS) -> dict[str, np.ndarray]:
    """States, torques and accelerations, one a row."""
    rng = np.random.default_rng(1)
    states = [random_state(robot, rng) for _ in range(rows)]
    batch = {name: np.array([state[name] for state in states]) for name in states[0]}
    return batch | {name: rng.normal(size=(rows, robot.nv)) for name in ("qdd", "thetadd", "tau", "tau_ext")}


CALLS: dict[str, tuple[Call, tuple[str, ...]]] = {
    "forward_dynamics": (gyroflex.Robot.forward_dynamics, ("q", "qd", "theta", "thetad", "tau", "tau_ext")),
    "inverse_dynamics": (gyroflex.Robot.inverse_dynamics, ("q", "qd", "qdd", "theta", "thetad", "thetadd", "tau_ext")),
    "mass_matrix": (gyroflex.Robot.mass_matrix, ("q",)),
    "coupling_matrix": (gyroflex.Robot.coupling_matrix, ("q",)),
    "coriolis_matrices": (gyroflex.Robot.coriolis_matrices, ("q", "qd", "thetad")),
    "inertia_rates": (gyroflex.Robot.inertia_rates, ("q", "qd")),
    "bias": (gyroflex.Robot.bias, ("q", "qd", "thetad")),
    "gravity_torques": (gyroflex.Robot.gravity_torques, ("q",)),
    "energy": (gyroflex.Robot.energy, ("q", "qd", "theta", "thetad")),
    "placement": (lambda robot, **a: robot.placement("tool", **a), ("q",)),
    "jacobian": (lambda robot, **a: robot.jacobian("tool", **a), ("q",)),
    "forward_derivatives": (
        gyroflex.Robot.forward_derivatives,
        ("q", "qd", "theta", "thetad", "tau", "tau_ext"),
    ),
    "inverse_derivatives": (
        gyroflex.Robot.inverse_derivatives,
        ("q", "qd", "qdd", "theta", "thetad", "thetadd", "tau_ext"),
    ),
    "regressor": (gyroflex.Robot.regressor, ("q", "qd", "qdd", "theta", "thetad", "thetadd")),
}


def results(answer: object) -> list[np.ndarray]:
    return [np.asarray(a) for a in (answer if isinstance(answer, tuple) else (answer,))]


def agree(many: object, one: list[list[np.ndarray]], tolerance: float = 1e-12) -> None:
    for i, array in enumerate(results(many)):
        expected = np.array([answer[i] for answer in one])
        np.testing.assert_allclose(array, expected, rtol=0, atol=tolerance * max(1.0, np.abs(expected).max()))
