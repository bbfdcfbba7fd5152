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
    Drive,
    ElasticInverse,
    FrequencyResponse,
    GeneratedCode,
    Impact,
    Linearization,
    Mode,
    Robot,
    __version__,
)
from .builder import RobotBuilder
from .errors import (
    ArgumentError,
    DivergedError,
    Error,
    FileError,
    FormatError,
    MissingExtraError,
    ModelError,
    NotFiniteError,
    RobotWarning,
    ScenarioError,
    ShapeError,
)
from .results import ContactImpact, SimulationResult, read_mcap
from .simulation import simulate
from .sweep import SweepResult, sweep

__all__ = [
    "ArgumentError",
    "ConstrainedMotion",
    "ConstrainedTorques",
    "Constraint",
    "ContactImpact",
    "DivergedError",
    "Drive",
    "ElasticInverse",
    "Error",
    "FileError",
    "FormatError",
    "FrequencyResponse",
    "GeneratedCode",
    "Impact",
    "Linearization",
    "MissingExtraError",
    "Mode",
    "ModelError",
    "NotFiniteError",
    "Robot",
    "RobotBuilder",
    "RobotWarning",
    "ScenarioError",
    "ShapeError",
    "SimulationResult",
    "SweepResult",
    "__version__",
    "read_mcap",
    "simulate",
    "sweep",
]
