"""The compiled half of the package; `gyroflex` exports what users need of it."""

import os
from typing import Literal, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import DivergedError

__all__ = ["Robot", "run_scenario", "__version__"]

__version__: str

_Model: TypeAlias = Literal["complete", "reduced", "rigid", "rigid_reflected"]
_Vector: TypeAlias = NDArray[np.float64]

@final
class Robot:
    """A robot with its drives, loaded from files."""

    @staticmethod
    def load(
        path: str | os.PathLike[str],
        *,
        floating: bool = False,
        model: _Model | None = None,
        mimic: Literal["refuse", "independent"] | None = None,
    ) -> Robot:
        """Loads a robot YAML or a URDF."""

    @property
    def name(self) -> str:
        """The robot's name."""

    @property
    def joint_names(self) -> list[str]:
        """Names of the joints of one degree of freedom, in coordinate order: all but a floating root."""

    @property
    def link_names(self) -> list[str]:
        """Names of all links of the URDF, those fused by fixed joints included."""

    @property
    def nq(self) -> int:
        """Number of entries of `q`."""

    @property
    def nv(self) -> int:
        """Number of entries of `qd` and of every other array over the joints."""

    @property
    def floating(self) -> bool:
        """Whether the root moves freely."""

    @property
    def gravity(self) -> _Vector:
        """Acceleration of gravity in world axes, shape `(3,)` [m/s²]."""

    @property
    def model(self) -> _Model:
        """The model used unless a call says otherwise."""

    @property
    def warnings(self) -> list[str]:
        """What of the robot's files was ignored or assumed."""

    def forward_dynamics(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        theta: ArrayLike | None = None,
        thetad: ArrayLike | None = None,
        tau: ArrayLike | None = None,
        *,
        model: _Model | None = None,
        tau_ext: ArrayLike | None = None,
    ) -> tuple[_Vector, _Vector]:
        """Accelerations `(qdd, thetadd)` of links and motors, shape `(nv,)` each."""

    def inverse_dynamics(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        qdd: ArrayLike,
        theta: ArrayLike | None = None,
        thetad: ArrayLike | None = None,
        thetadd: ArrayLike | None = None,
        *,
        model: _Model | None = None,
        tau_ext: ArrayLike | None = None,
    ) -> tuple[_Vector, _Vector]:
        """Torques `(tau_j, tau)` of transmissions and motors that a motion asks for, shape `(nv,)` each [N m or N]."""

    def mass_matrix(self, q: ArrayLike, *, model: _Model | None = None) -> NDArray[np.float64]:
        """Inertia matrix `M(q)` of the link side, shape `(nv, nv)`."""

    def coupling_matrix(self, q: ArrayLike, *, model: _Model | None = None) -> NDArray[np.float64]:
        """Inertial coupling `S(q)` of links (rows) and motors (columns), shape `(nv, nv)`."""

    def placement(self, frame: str, q: ArrayLike) -> NDArray[np.float64]:
        """Pose of a link in the world, shape `(4, 4)`."""

def run_scenario(
    scenario: str | os.PathLike[str],
    log: str | os.PathLike[str] | None,
) -> tuple[
    dict[str, NDArray[np.float64]],
    dict[str, tuple[str, ...]],
    tuple[str, ...],
    dict[str, str],
    list[str],
    DivergedError | None,
]:
    """Arrays and units by name, names of the joints, metadata, warnings, and the error of a run that diverged."""
