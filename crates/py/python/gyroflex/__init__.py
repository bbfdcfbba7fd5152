"""Exact and fast dynamics of robots with geared, elastic drives.

Units are SI. Every six-vector has its angular part first. ``theta`` and ``tau`` are motor positions and torques seen from the
link side of the gear.

>>> import numpy as np, gyroflex
>>> robot = gyroflex.Robot.load("robots/puma560/robot.yaml")
>>> q = theta = np.zeros(robot.nq)
>>> still = tau = np.zeros(robot.nv)
>>> qdd, thetadd = robot.forward_dynamics(q, still, theta, still, tau)
"""

from ._gyroflex import (
    ConstrainedMotion,
    ConstrainedTorques,
    Constraint,
    ElasticInverse,
    FrequencyResponse,
    GeneratedCode,
    Impact,
    Linearization,
    Mode,
    Robot,
    __version__,
)
from .errors import (
    ArgumentError,
    DivergedError,
    Error,
    FileError,
    FormatError,
    ModelError,
    NotFiniteError,
    RobotWarning,
    ScenarioError,
    ShapeError,
)
from .simulation import ContactImpact, SimulationResult, simulate

__all__ = [
    "ArgumentError",
    "ConstrainedMotion",
    "ConstrainedTorques",
    "Constraint",
    "ContactImpact",
    "DivergedError",
    "ElasticInverse",
    "Error",
    "FileError",
    "FormatError",
    "FrequencyResponse",
    "GeneratedCode",
    "Impact",
    "Linearization",
    "Mode",
    "ModelError",
    "NotFiniteError",
    "Robot",
    "RobotWarning",
    "ScenarioError",
    "ShapeError",
    "SimulationResult",
    "__version__",
    "simulate",
]
