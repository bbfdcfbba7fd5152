# Arrays of float32 are array-like, too: which overload is meant is the first that fits.
# mypy: disable-error-code="overload-overlap"
"""The compiled half of the package; `gyroflex` exports what users need of it."""

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, Literal, TypeAlias, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .builder import RobotBuilder
from .errors import DivergedError

__all__ = [
    "ConstrainedMotion",
    "ConstrainedTorques",
    "Constraint",
    "Drive",
    "ElasticInverse",
    "FrequencyResponse",
    "GeneratedCode",
    "Impact",
    "Linearization",
    "Mode",
    "Record",
    "Robot",
    "measure_scenario",
    "read_log",
    "run_scenario",
    "__version__",
]

__version__: str

_Model: TypeAlias = Literal["complete", "reduced", "rigid", "rigid_reflected"]
_Friction: TypeAlias = Literal["all", "viscous", "none"]
_Quantity: TypeAlias = Literal[
    "all",
    "forward",
    "inverse",
    "mass-matrix",
    "coupling",
    "reflected-inertia",
    "coriolis",
    "gravity",
    "bias",
    "stiffness",
    "energy",
    "regressor",
    "placements",
    "jacobian",
    "forward-derivatives",
    "inverse-derivatives",
    "linearization",
    "elastic-inverse",
]
_Direction: TypeAlias = Literal["rx", "ry", "rz", "x", "y", "z"]
_Point: TypeAlias = tuple[float, float, float]
_Vector: TypeAlias = NDArray[np.float64]
_Matrix: TypeAlias = NDArray[np.float64]
_Single: TypeAlias = NDArray[np.float32]
_Blocks: TypeAlias = NDArray[np.float64]
_Complexes: TypeAlias = NDArray[np.complex128]

@final
class Linearization:
    """A linear model `x' = A x + B u, y = C x + D u`, or, sampled, `x[k+1] = A x[k] + B u[k]`; all are deviations.

    Of a batch of operating points it is all of their models: arrays lead with the batch, and entries are one model each.
    """

    @property
    def A(self) -> NDArray[np.float64]:
        """`A`, shape `([batch,] states, states)`."""

    @property
    def B(self) -> NDArray[np.float64]:
        """`B`, shape `([batch,] states, inputs)`."""

    @property
    def C(self) -> NDArray[np.float64]:
        """`C`, shape `([batch,] outputs, states)`."""

    @property
    def D(self) -> NDArray[np.float64]:
        """`D`, shape `([batch,] outputs, inputs)`."""

    @property
    def states(self) -> list[str]:
        """Names of the states, as `q.joint1`, `theta.joint1`, `qd.joint1`, `thetad.joint1`."""

    @property
    def inputs(self) -> list[str]:
        """Names of the inputs, as `tau.joint1`."""

    @property
    def outputs(self) -> list[str]:
        """Names of the outputs, as `motor_position.joint1` or `pose.tool.x`."""

    @property
    def q(self) -> _Vector:
        """Joint positions at the operating point, shape `([batch,] nq)`."""

    @property
    def qd(self) -> _Vector:
        """Joint velocities there, shape `([batch,] nv)`."""

    @property
    def theta(self) -> _Vector:
        """Motor positions there, seen from the link side, shape `([batch,] nv)`."""

    @property
    def thetad(self) -> _Vector:
        """Motor velocities there, seen from the link side, shape `([batch,] nv)`."""

    @property
    def tau(self) -> _Vector:
        """Motor torques there, seen from the link side, shape `([batch,] nv)`."""

    @property
    def step(self) -> float | None:
        """Sampling time [s]; `None` in continuous time."""

    @property
    def eigenvalues(self) -> _Complexes:
        """Eigenvalues of `A`, by size, shape `([batch,] states)`."""

    def __bool__(self) -> Literal[True]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> Linearization: ...
    def __iter__(self) -> Iterator[Linearization]: ...
    def zero_order_hold(self, step: float) -> Linearization:
        """The model sampled exactly, with inputs held between samples."""

    def modes(self) -> list[Mode]:
        """The modes of a model in continuous time, from the slowest to the fastest; not of a batch."""

@final
class Mode:
    """One way a robot moves by itself."""

    @property
    def kind(self) -> Literal["oscillation", "decay", "growth", "rigid"]:
        """What kind of motion it is; `rigid` stays wherever it is put."""

    @property
    def frequency(self) -> float:
        """Size of the eigenvalue over 2π [Hz]."""

    @property
    def damping_ratio(self) -> float | None:
        """Damping ratio; `None` of a rigid motion."""

    @property
    def eigenvalue(self) -> complex:
        """The eigenvalue [1/s]; of a pair the one above the real axis."""

    @property
    def moves_most(self) -> str:
        """Name of the position that moves most, as `theta.joint1`."""

    @property
    def shape(self) -> _Complexes:
        """How far each position moves relative to the one that moves most, in the order of the states."""

@final
class FrequencyResponse:
    """Response of a joint to its own motor; motor quantities are seen from the link side.

    Of a batch of poses it is the responses at all of them: arrays lead with the batch, and entries are one response each.
    """

    @property
    def joint(self) -> str:
        """Name of the joint."""

    @property
    def frequency(self) -> _Vector:
        """Frequencies [Hz], shape `([batch,] points)`."""

    @property
    def motor(self) -> _Complexes:
        """Motor position per motor torque at each frequency [rad/(N m), or m/N], shape `([batch,] points)`."""

    @property
    def link(self) -> _Complexes:
        """Link position per motor torque at each frequency [rad/(N m), or m/N], shape `([batch,] points)`."""

    @property
    def resonances(self) -> _Vector:
        """Frequencies of the peaks of the motor's response [Hz]; not of a batch."""

    @property
    def antiresonances(self) -> _Vector:
        """Frequencies of the dips of the motor's response [Hz]; not of a batch."""

    def __bool__(self) -> Literal[True]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> FrequencyResponse: ...
    def __iter__(self) -> Iterator[FrequencyResponse]: ...

@final
class GeneratedCode:
    """Code or equations of one robot."""

    @property
    def files(self) -> dict[str, str]:
        """Texts by the names of their files."""

    @property
    def report(self) -> dict[str, Any]:
        """What was generated: functions with their arguments, results and operation counts."""

    def write(self, folder: str | os.PathLike[str]) -> list[Path]:
        """Writes the files into a folder, which is made if it does not exist; returns their paths."""

    def module(self) -> ModuleType:
        """The functions as a Python module that is ready to use; of code in Python only."""

@final
class ElasticInverse:
    """What the motors must do for a motion of the links, at one moment or over time."""

    @property
    def theta(self) -> _Vector:
        """Motor positions seen from the link side, shape `(nv,)` or `(times, nv)`."""

    @property
    def thetad(self) -> _Vector:
        """Motor velocities seen from the link side, shape `(nv,)` or `(times, nv)`."""

    @property
    def thetadd(self) -> _Vector:
        """Motor accelerations seen from the link side, shape `(nv,)` or `(times, nv)`."""

    @property
    def tau_j(self) -> _Vector:
        """Torques that the transmissions exert on the joints, shape `(nv,)` or `(times, nv)` [N m or N]."""

    @property
    def tau(self) -> _Vector:
        """Motor torques seen from the link side, shape `(nv,)` or `(times, nv)` [N m or N]."""

    @property
    def tau_j_derivatives(self) -> _Matrix:
        """Time derivatives of `tau_j` from the first on, shape `(torque_derivatives, nv)`, over time with the times first."""

    @property
    def tau_derivatives(self) -> _Matrix:
        """Time derivatives of `tau` from the first on, shape `(torque_derivatives, nv)`, over time with the times first."""

    @property
    def deflection(self) -> _Vector:
        """Deflections of the transmissions after the step, shape `(nv,)` or `(times, nv)`: the last is the `deflection` of the next call."""

    @property
    def deflection_rate(self) -> _Vector:
        """Their rates before the step, shape `(nv,)` or `(times, nv)`."""

@final
class Constraint:
    """Something held: a frame of a link to the world or to another link, or a joint to another one."""

    @staticmethod
    def frame(
        link: str,
        *,
        xyz: _Point = (0.0, 0.0, 0.0),
        rpy: _Point = (0.0, 0.0, 0.0),
        to: str | None = None,
        at_xyz: _Point | None = None,
        at_rpy: _Point | None = None,
        at: ArrayLike | None = None,
        directions: Literal["all", "point"] | Sequence[_Direction] | None = None,
        stabilisation: float = 0.0,
        contact: Literal["x", "y", "z"] | None = None,
        restitution: float = 0.0,
        slip: _Point | None = None,
    ) -> Constraint:
        """Holds a frame of a link at `at_xyz`, `at_rpy` or `at` of the world or of the link `to`, in whose axes the directions are."""

    @staticmethod
    def joints(
        joint: str, follows: str, *, ratio: float = 1.0, offset: float = 0.0, stabilisation: float = 0.0
    ) -> Constraint:
        """Lets a joint follow another one: `q = ratio q_follows + offset`."""

    @property
    def rows(self) -> int:
        """How many directions it constrains: as many multipliers it has."""

@final
class ConstrainedMotion:
    """Accelerations of a robot with something held, and the forces of it."""

    @property
    def qdd(self) -> _Vector:
        """Accelerations of the joints, shape `([batch,] nv)`."""

    @property
    def thetadd(self) -> _Vector:
        """Accelerations of the motors seen from the link side, shape `([batch,] nv)`."""

    @property
    def tau_j(self) -> _Vector:
        """Torques that the transmissions exert on the joints, shape `([batch,] nv)` [N m or N]."""

    @property
    def multipliers(self) -> _Vector:
        """Forces along the constrained directions, constraint by constraint [N or N m]."""

    @property
    def wrenches(self) -> _Matrix:
        """Moment and force of each constraint on its link, about its frame's origin in world axes, shape `([batch,] constraints, 6)`."""

    @property
    def dependent(self) -> Any:
        """How many directions were left out because others say the same: an `int`, of a batch an array of shape `(batch,)`."""

    @property
    def contradiction(self) -> Any:
        """The largest acceleration that those ask for and do not get: a `float`, of a batch an array of shape `(batch,)`."""

    @property
    def independence(self) -> Any:
        """The smallest part of a direction's own mobility that the ones before it leave it, 0 to 1: a `float`, of a batch an array of shape `(batch,)`."""

@final
class ConstrainedTorques:
    """Torques of a motion with something held, and the forces of it."""

    @property
    def tau_j(self) -> _Vector:
        """Torques that the transmissions must exert on the joints, shape `([batch,] nv)` [N m or N]."""

    @property
    def tau(self) -> _Vector:
        """Torques that the motors must exert, seen from the link side, shape `([batch,] nv)` [N m or N]."""

    @property
    def multipliers(self) -> _Vector:
        """Forces along the constrained directions, constraint by constraint [N or N m]."""

    @property
    def wrenches(self) -> _Matrix:
        """Moment and force of each constraint on its link, as those of `ConstrainedMotion`."""

    @property
    def dependent(self) -> Any:
        """How many directions were left out because others say the same: an `int`, of a batch an array of shape `(batch,)`."""

    @property
    def unborne(self) -> Any:
        """The largest load at a passive joint, or on a floating root, that no constraint bears [N m or N]: a `float`, of a batch an array of shape `(batch,)`."""

@final
class Impact:
    """Velocities after an impact, and the impulses of it."""

    @property
    def qd(self) -> _Vector:
        """Velocities of the joints afterwards, shape `([batch,] nv)`."""

    @property
    def thetad(self) -> _Vector:
        """Velocities of the motors afterwards seen from the link side, shape `([batch,] nv)`."""

    @property
    def gears(self) -> _Vector:
        """Impulses that rigid gears exert on their joints, shape `([batch,] nv)` [N m s or N s]."""

    @property
    def multipliers(self) -> _Vector:
        """Impulses along the constrained directions, constraint by constraint [N s or N m s]."""

    @property
    def wrenches(self) -> _Matrix:
        """Angular and linear impulse of each constraint on its link, as those of `ConstrainedMotion`."""

    @property
    def dependent(self) -> Any:
        """How many directions were left out because others say the same: an `int`, of a batch an array of shape `(batch,)`."""

    @property
    def contradiction(self) -> Any:
        """The largest jump of velocity that those ask for and do not get: a `float`, of a batch an array of shape `(batch,)`."""

    @property
    def independence(self) -> Any:
        """The smallest part of a direction's own mobility that the ones before it leave it, 0 to 1: a `float`, of a batch an array of shape `(batch,)`."""

    @property
    def released(self) -> Any:
        """How many contacts were released because they would have pulled: an `int`, of a batch an array of shape `(batch,)`."""

@final
class Drive:
    """The motor of a joint with its gear and transmission."""

    @property
    def rotor_inertia(self) -> float:
        """Inertia of the rotor about its spin axis, motor side [kg m²]."""

    @property
    def ratio(self) -> float:
        """Rotor turns per joint turn, or rotor radians per metre."""

    @property
    def stiffness(self) -> float | None:
        """Stiffness of the transmission without deflection [N m/rad or N/m]; `None` of a rigid one, or one given by a table."""

    @property
    def damping(self) -> float | None:
        """Damping of the transmission [N m s/rad or N s/m]; `None` of a rigid one."""

    @property
    def friction(self) -> dict[str, float]:
        """Friction on the motor side: `viscous` [N m s/rad], `coulomb` [N m], `smoothing_velocity` [rad/s]."""

@final
class Robot:
    """A robot with its drives, loaded from files.

    Where a method takes `out`, its arrays may also be of shape `(batch, n)`, any of them; results lead with that axis. All in float32
    gives float32, else float64; derivatives, the regressor and what has to do with constraints are in float64 always.
    """

    @staticmethod
    def load(
        path: str | os.PathLike[str],
        *,
        floating: bool = False,
        model: _Model | None = None,
        mimic: Literal["refuse", "independent"] | None = None,
        set: Mapping[str, object] | None = None,
    ) -> Robot:
        """Loads a robot YAML or a URDF."""

    @property
    def name(self) -> str:
        """The robot's name."""

    @property
    def joint_names(self) -> list[str]:
        """Names of the joints of one degree of freedom, in coordinate order: all but a floating root."""

    @property
    def mode_names(self) -> list[str]:
        """Names of the modes of links that bend. Their coordinates follow those of the joints in every array."""

    @property
    def link_names(self) -> list[str]:
        """Names of all links of the URDF, those fused by fixed joints included."""

    @property
    def link_parents(self) -> dict[str, str | None]:
        """Name of every link's parent in the URDF; `None` of the root."""

    @property
    def centers_of_mass(self) -> dict[str, list[float] | None]:
        """Centre of mass of every link that moves by itself, in the link's axes [m]; `None` of one without mass."""

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

    @overload
    def forward_dynamics(
        self,
        q: _Single,
        qd: _Single,
        theta: _Single | None = None,
        thetad: _Single | None = None,
        tau: _Single | None = None,
        *,
        model: _Model | None = None,
        tau_ext: _Single | None = None,
        out: Sequence[_Single] | None = None,
    ) -> tuple[_Single, _Single]:
        """The same in float32."""

    @overload
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
        out: Sequence[_Matrix] | None = None,
    ) -> tuple[_Vector, _Vector]:
        """Accelerations `(qdd, thetadd)` of links and motors, shape `(nv,)` each."""

    @overload
    def inverse_dynamics(
        self,
        q: _Single,
        qd: _Single,
        qdd: _Single,
        theta: _Single | None = None,
        thetad: _Single | None = None,
        thetadd: _Single | None = None,
        *,
        model: _Model | None = None,
        tau_ext: _Single | None = None,
        out: Sequence[_Single] | None = None,
    ) -> tuple[_Single, _Single]:
        """The same in float32."""

    @overload
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
        out: Sequence[_Matrix] | None = None,
    ) -> tuple[_Vector, _Vector]:
        """Torques `(tau_j, tau)` of transmissions and motors that a motion asks for, shape `(nv,)` each [N m or N]."""

    @overload
    def mass_matrix(self, q: _Single, *, model: _Model | None = None, out: _Single | None = None) -> _Single:
        """The same in float32."""

    @overload
    def mass_matrix(self, q: ArrayLike, *, model: _Model | None = None, out: _Matrix | None = None) -> _Matrix:
        """Inertia matrix `M(q)` of the link side, shape `(nv, nv)`."""

    @overload
    def coupling_matrix(self, q: _Single, *, model: _Model | None = None, out: _Single | None = None) -> _Single:
        """The same in float32."""

    @overload
    def coupling_matrix(self, q: ArrayLike, *, model: _Model | None = None, out: _Matrix | None = None) -> _Matrix:
        """Inertial coupling `S(q)` of links (rows) and motors (columns), shape `(nv, nv)`."""

    @overload
    def placement(self, frame: str, q: _Single, *, out: _Single | None = None) -> _Single:
        """The same in float32."""

    @overload
    def placement(self, frame: str, q: ArrayLike, *, out: _Matrix | None = None) -> _Matrix:
        """Pose of a link in the world, shape `(4, 4)`."""

    @overload
    def energy(
        self,
        q: _Single,
        qd: _Single,
        theta: _Single | None = None,
        thetad: _Single | None = None,
        *,
        model: _Model | None = None,
        out: Sequence[_Single] | None = None,
    ) -> tuple[_Single, _Single, _Single]:
        """The same in float32."""

    @overload
    def energy(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        theta: ArrayLike | None = None,
        thetad: ArrayLike | None = None,
        *,
        model: _Model | None = None,
        out: Sequence[_Vector] | None = None,
    ) -> tuple[Any, Any, Any]:
        """Energies `(kinetic, gravity, elastic)` [J]: numbers of one state, arrays of shape `(batch,)` of many, `()` with `out`."""

    @overload
    def jacobian(
        self,
        frame: str,
        q: _Single,
        *,
        axes: Literal["world", "local"] = "world",
        out: _Single | None = None,
    ) -> _Single:
        """The same in float32."""

    @overload
    def jacobian(
        self,
        frame: str,
        q: ArrayLike,
        *,
        axes: Literal["world", "local"] = "world",
        out: _Matrix | None = None,
    ) -> _Matrix:
        """Jacobian of a link's frame, shape `(6, nv)` or `(batch, 6, nv)`, angular rows first."""

    @overload
    def rollout(
        self,
        q0: _Single,
        qd0: _Single,
        tau: _Single,
        dt: float,
        *,
        theta0: _Single | None = None,
        thetad0: _Single | None = None,
        steps: int | None = None,
        integrator: Literal["semi_implicit_euler", "rk4"] = "semi_implicit_euler",
        model: _Model | None = None,
    ) -> tuple[_Single, _Single, _Single, _Single]:
        """The same in float32."""

    @overload
    def rollout(
        self,
        q0: ArrayLike,
        qd0: ArrayLike,
        tau: ArrayLike,
        dt: float,
        *,
        theta0: ArrayLike | None = None,
        thetad0: ArrayLike | None = None,
        steps: int | None = None,
        integrator: Literal["semi_implicit_euler", "rk4"] = "semi_implicit_euler",
        model: _Model | None = None,
    ) -> tuple[_Blocks, _Blocks, _Blocks, _Blocks]:
        """States `(q, qd, theta, thetad)` of many motions with fixed steps of `dt` [s], shape `(batch, steps + 1, n)` each, or `(steps + 1, n)` of one."""

    @property
    def drives(self) -> dict[str, Drive]:
        """The drives by the names of their joints."""

    @staticmethod
    def from_urdf(
        urdf: str | os.PathLike[str],
        drives: str | Mapping[str, Any] | None = None,
        *,
        floating: bool = False,
        model: _Model | None = None,
        set: Mapping[str, Any] | None = None,
    ) -> Robot:
        """Makes a robot from a URDF, its text or its path, and its drives by joint or as the text of a robot YAML."""

    @staticmethod
    def from_builder(
        builder: RobotBuilder,
        *,
        floating: bool = False,
        model: _Model | None = None,
        set: Mapping[str, Any] | None = None,
    ) -> Robot:
        """Makes a robot from links, joints and drives given one by one."""

    def with_(
        self,
        *,
        stiffness: Mapping[str, float] | None = None,
        damping: Mapping[str, float] | None = None,
        ratio: Mapping[str, float] | None = None,
        rotor_inertia: Mapping[str, float] | None = None,
        friction: Mapping[str, Mapping[str, Any]] | None = None,
        model: _Model | None = None,
        gravity: ArrayLike | None = None,
        payload: Mapping[str, Any] | None = None,
        set: Mapping[str, Any] | None = None,
    ) -> Robot:
        """A copy of the robot with other numbers, validated: of drives by the names of their joints, or of any key of its YAML."""

    @overload
    def coriolis_matrices(
        self,
        q: _Single,
        qd: _Single,
        thetad: _Single | None = None,
        *,
        model: _Model | None = None,
        out: Sequence[_Single] | None = None,
    ) -> tuple[_Single, _Single, _Single]:
        """The same in float32."""

    @overload
    def coriolis_matrices(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        thetad: ArrayLike | None = None,
        *,
        model: _Model | None = None,
        out: Sequence[_Matrix] | None = None,
    ) -> tuple[_Matrix, _Matrix, _Matrix]:
        """Blocks `(C, C1, C2)` of the Coriolis matrix in Christoffel form, shape `(nv, nv)` each."""

    @overload
    def inertia_rates(
        self,
        q: _Single,
        qd: _Single,
        *,
        model: _Model | None = None,
        out: Sequence[_Single] | None = None,
    ) -> tuple[_Single, _Single]:
        """The same in float32."""

    @overload
    def inertia_rates(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        *,
        model: _Model | None = None,
        out: Sequence[_Matrix] | None = None,
    ) -> tuple[_Matrix, _Matrix]:
        """Time derivatives of `mass_matrix` and `coupling_matrix` along a motion, shape `(nv, nv)` each."""

    @overload
    def bias(
        self,
        q: _Single,
        qd: _Single,
        thetad: _Single | None = None,
        *,
        model: _Model | None = None,
        out: Sequence[_Single] | None = None,
    ) -> tuple[_Single, _Single]:
        """The same in float32."""

    @overload
    def bias(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        thetad: ArrayLike | None = None,
        *,
        model: _Model | None = None,
        out: Sequence[_Matrix] | None = None,
    ) -> tuple[_Vector, _Vector]:
        """What links and motors need at zero acceleration, beside friction, springs and loads, shape `(nv,)` each."""

    @overload
    def gravity_torques(self, q: _Single, *, out: _Single | None = None) -> _Single:
        """The same in float32."""

    @overload
    def gravity_torques(self, q: ArrayLike, *, out: _Matrix | None = None) -> _Vector:
        """Generalised forces that hold the links against gravity, shape `(nv,)`."""

    def forward_derivatives(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        theta: ArrayLike | None = None,
        thetad: ArrayLike | None = None,
        tau: ArrayLike | None = None,
        *,
        model: _Model | None = None,
        tau_ext: ArrayLike | None = None,
        out: Sequence[_Blocks] | None = None,
    ) -> tuple[_Blocks, _Blocks]:
        """Derivatives of `qdd` and `thetadd` by `q, qd, theta, thetad, tau`, shape `(5, nv, nv)` or `(batch, 5, nv, nv)` each."""

    def inverse_derivatives(
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
        out: Sequence[_Blocks] | None = None,
    ) -> tuple[_Blocks, _Blocks]:
        """Derivatives of `tau_j` and `tau` by `q, qd, qdd, theta, thetad, thetadd`, shape `(6, nv, nv)` or `(batch, 6, nv, nv)` each."""

    def regressor(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        qdd: ArrayLike,
        theta: ArrayLike | None = None,
        thetad: ArrayLike | None = None,
        thetadd: ArrayLike | None = None,
        *,
        model: _Model | None = None,
        out: Sequence[_Matrix] | None = None,
    ) -> tuple[_Matrix, _Matrix, _Matrix]:
        """Matrices of links, transmissions and motors that `parameters` enter linearly, shape `(nv, 20 bodies)` each; or batches."""

    def parameters(self, *, model: _Model | None = None) -> _Vector:
        """The parameters that `regressor` belongs to, twenty for each body."""

    def operational_space(
        self,
        frame: str,
        q: ArrayLike,
        qd: ArrayLike,
        thetad: ArrayLike | None = None,
        *,
        directions: Sequence[_Direction] | None = None,
        rotation: Literal["geometric", "rpy", "zyz"] = "geometric",
        point: ArrayLike | None = None,
        threshold: float = 1e-6,
        model: _Model | None = None,
    ) -> dict[str, Any]:
        """The dynamics that a link feels: Jacobian, inertia, consistent inverse, velocity and gravity forces, singular values."""

    @property
    def constraints(self) -> dict[str, Constraint]:
        """The constraints and couplings of the robot's file by name: what always holds it in simulations."""

    def constrained_forward_dynamics(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        theta: ArrayLike | None = None,
        thetad: ArrayLike | None = None,
        tau: ArrayLike | None = None,
        *,
        constraints: Sequence[Constraint],
        model: _Model | None = None,
        tau_ext: ArrayLike | None = None,
        threshold: float = 1e-9,
        damping: float = 0.0,
    ) -> ConstrainedMotion:
        """Accelerations of links and motors with something held, and the forces that hold it."""

    def constrained_inverse_dynamics(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        qdd: ArrayLike,
        theta: ArrayLike | None = None,
        thetad: ArrayLike | None = None,
        thetadd: ArrayLike | None = None,
        *,
        constraints: Sequence[Constraint],
        passive: Sequence[str] | None = None,
        torque_weights: ArrayLike | None = None,
        multiplier_weights: ArrayLike | None = None,
        wanted: ArrayLike | None = None,
        model: _Model | None = None,
        tau_ext: ArrayLike | None = None,
        threshold: float = 1e-9,
        damping: float = 0.0,
    ) -> ConstrainedTorques:
        """Torques that a motion asks for with something held: of all that make it those that weigh least."""

    def impact(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        thetad: ArrayLike | None = None,
        *,
        constraints: Sequence[Constraint],
        release: bool = False,
        model: _Model | None = None,
        threshold: float = 1e-9,
        damping: float = 0.0,
    ) -> Impact:
        """Velocities after everything in `constraints` is caught at once, and the impulses of it."""

    def constraint_motion(
        self, q: ArrayLike, qd: ArrayLike, *, constraints: Sequence[Constraint], out: Sequence[NDArray[np.float64]] | None = None
    ) -> tuple[_Vector, _Vector, _Matrix]:
        """Errors of position and of velocity of constraints, shape `([batch,] m)`, and their Jacobian, shape `([batch,] m, nv)`."""

    def smoothness(
        self, model: _Model | None = None, torque_derivatives: int = 0, *, damping: float | None = None
    ) -> dict[str, int]:
        """How many derivatives of every joint's position `elastic_inverse` needs, by name of the joint."""

    def elastic_inverse(
        self,
        q: ArrayLike,
        derivatives: ArrayLike,
        *,
        deflection: ArrayLike | None = None,
        step: float = 0.0,
        model: _Model | None = None,
        tau_ext: ArrayLike | None = None,
        torque_derivatives: int = 0,
        damping: float | None = None,
    ) -> ElasticInverse:
        """Motions and torques of the motors that make the links move as asked, at one moment or over time.

        `q` has shape `(nq,)` or `(times, nq)`, `derivatives` `(order, nv)` or `(times, order, nv)`, `tau_ext` `(nv,)`, or with its time
        derivatives `(rows, nv)`, or over time `(times, nv)` or `(times, rows, nv)`.
        """

    def linearize(
        self,
        q: ArrayLike | None = None,
        qd: ArrayLike | None = None,
        theta: ArrayLike | None = None,
        thetad: ArrayLike | None = None,
        tau: ArrayLike | None = None,
        *,
        outputs: str | Sequence[str] | None = None,
        model: _Model | None = None,
        friction: _Friction = "all",
    ) -> Linearization:
        """Linear model about the equilibrium at `q`, about that under `tau`, or, with `qd`, about any state; of batches one for each row."""

    def modes(
        self,
        q: ArrayLike | None = None,
        *,
        model: _Model | None = None,
        friction: _Friction = "all",
    ) -> list[Mode]:
        """How the robot swings by itself about the equilibrium at a pose, from the slowest mode to the fastest."""

    def frequency_response(
        self,
        joint: str,
        q: ArrayLike | None = None,
        *,
        start: float | None = None,
        stop: float | None = None,
        points: int = 500,
        model: _Model | None = None,
        friction: _Friction = "all",
    ) -> FrequencyResponse:
        """From the torque of a joint's motor to the positions of motor and link, about the equilibrium at a pose, or at each of a batch."""

    def analyze(
        self,
        *,
        scenario: str | os.PathLike[str] | None = None,
        log: str | os.PathLike[str] | None = None,
        samples: int = 2000,
        seed: int = 0,
        speed: float | None = None,
        rise: float = 0.25,
        threshold: float = 1.0,
        bounds: bool = False,
    ) -> dict[str, Any]:
        """When do the rotors matter: torque errors of the reduced model, as `gyroflex analyze --json` prints them."""

    def codegen(
        self,
        what: _Quantity | Sequence[_Quantity] = ("forward", "inverse"),
        *,
        lang: Literal["python", "rust", "c", "json", "latex"] = "python",
        model: _Model | None = None,
        scalar: Literal["f64", "f32"] = "f64",
        lanes: int | None = None,
        keep_symbol: Sequence[str] = (),
        link: str | None = None,
        simplify_to: float | None = None,
        along: str | os.PathLike[str] | None = None,
        split: int | None = None,
        name: str | None = None,
    ) -> GeneratedCode:
        """Straight-line code of this robot's equations, or the equations themselves, as `gyroflex codegen` writes them."""

_Named: TypeAlias = tuple[dict[str, NDArray[np.float64]], dict[str, tuple[str, ...]], dict[str, tuple[str, ...]]]
_Impacts: TypeAlias = tuple[tuple[float, float, tuple[str, ...], _Matrix, _Matrix, _Matrix], ...]

@final
class Record:
    """All that a run recorded, poses of the links and files included: what a log is written of."""

    def write_mcap(self, path: str | os.PathLike[str]) -> None:
        """Writes the MCAP log that the run would have written."""

def run_scenario(
    scenario: str | os.PathLike[str],
    log: str | os.PathLike[str] | None,
    set: Mapping[str, object] | None,
) -> tuple[_Named, tuple[str, ...], dict[str, str], list[str], _Impacts, Record, DivergedError | None]:
    """Arrays, units and columns by name; names of the joints, metadata, warnings, impacts, record, and the error of a run that diverged."""

def measure_scenario(scenario: str | os.PathLike[str], set: Mapping[str, object] | None) -> dict[str, float]:
    """Numbers of a run by name, as `gyroflex sweep` writes them."""

def read_log(path: str | os.PathLike[str]) -> tuple[_Named, tuple[str, ...], dict[str, str], _Impacts, bool]:
    """Arrays, units and columns by name; names of the joints, metadata, impacts, and whether the log was finished."""
