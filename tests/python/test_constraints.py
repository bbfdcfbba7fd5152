"""Constrained dynamics and impacts agree with Pinocchio: a humanoid on two feet, and a four-bar linkage with an elastic drive.

Two oracles: Pinocchio's own `constraintDynamics` and `impulseDynamics`, and the dense equations

    [ M  -Jᵀ ] [ a ]   [ τ - h  ]
    [ J   0  ] [ λ ] = [ -J̇ q̇  ]

from Pinocchio's matrices, solved by NumPy. The first ones take a velocity that keeps the constraints for granted; the second one does not.
Run with `-s`, the tests print the largest differences.
"""

from __future__ import annotations

import sysconfig
import warnings
from pathlib import Path

import gyroflex
import numpy as np
import pinocchio as pin
import pytest
from gyroflex import Constraint
from pinocchio_twin import PinocchioTwin, quiet_stderr

TOLERANCE = 1e-8
STATES = 20
WORLD = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
ROBOTS = Path(sysconfig.get_path("purelib"), "cmeel.prefix", "share", "example-robot-data", "robots")
# File, soles, and angles of the legs of a robot that stands.
HUMANOIDS = {
    "talos": (
        "talos_data/robots/talos_reduced.urdf",
        ("left_sole_link", "right_sole_link"),
        {"leg_left_3_joint": -0.41, "leg_left_4_joint": 0.86, "leg_left_5_joint": -0.45,
         "leg_right_3_joint": -0.41, "leg_right_4_joint": 0.86, "leg_right_5_joint": -0.45},
    ),
    "romeo": (
        "romeo_description/urdf/romeo_small.urdf",
        ("l_sole", "r_sole"),
        {"LHipPitch": -0.4, "LKneePitch": 0.8, "LAnklePitch": -0.4, "RHipPitch": -0.4, "RKneePitch": 0.8, "RAnklePitch": -0.4},
    ),
}


def difference(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Largest difference over the largest entry."""
    return float(np.abs(ours - theirs).max() / np.abs(theirs).max())


def report(**worst: float | None) -> None:
    """Prints the largest differences, of what was compared, and holds them to the tolerance."""
    compared = {name: value for name, value in worst.items() if value is not None}
    print("\nlargest differences: " + ", ".join(f"{name} {value:.1e}" for name, value in compared.items()))
    assert max(compared.values()) <= TOLERANCE


def proximal() -> pin.ProximalSettings:
    """Iterations until the constraints are kept to rounding."""
    return pin.ProximalSettings(1e-14, 1e-14, 1e-12, 50)


class Oracle:
    """Constraints in Pinocchio: rows of a Jacobian, what velocities add to its accelerations, and models for its own solvers."""

    def __init__(self, twin: PinocchioTwin, models: list[pin.RigidConstraintModel]) -> None:
        self.twin = twin
        self.models = models
        self.datas = [model.createData() for model in models]
        pin.initConstraintDynamics(twin.model, twin.data, models, self.datas)

    def solver(self, q: np.ndarray, qd: np.ndarray, tau: np.ndarray) -> np.ndarray:
        """Accelerations by `constraintDynamics`."""
        twin = self.twin
        call = (twin.model, twin.data, twin.q(q), twin.v(qd), twin.v(tau - twin.friction(qd)), self.models, self.datas)
        return np.array(pin.constraintDynamics(*call, proximal()))[twin.velocities]

    def blow(self, q: np.ndarray, qd: np.ndarray) -> np.ndarray:
        """Velocities by `impulseDynamics`."""
        call = (self.twin.model, self.twin.data, self.twin.q(q), self.twin.v(qd), self.models, self.datas)
        return np.array(pin.impulseDynamics(*call, 0.0, proximal()))[self.twin.velocities]

    def dense(self, q: np.ndarray, qd: np.ndarray, tau: np.ndarray, rows: np.ndarray, drift: np.ndarray):
        """Accelerations and multipliers by the dense equations."""
        h = self.twin.inverse_dynamics(q, qd, np.zeros(len(qd)))
        return saddle(self.twin.mass_matrix(q), rows, tau - h, -drift)


def saddle(m: np.ndarray, rows: np.ndarray, top: np.ndarray, bottom: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """`a` and `λ` of the dense equations, with one step of iterative refinement."""
    nv, k = len(m), len(rows)
    kkt = np.block([[m, -rows.T], [rows, np.zeros((k, k))]])
    right = np.concatenate([top, bottom])
    found = np.linalg.solve(kkt, right)
    found += np.linalg.solve(kkt, right - kkt @ found)
    return found[:nv], found[nv:]


def frame_motion(twin: PinocchioTwin, q: np.ndarray, qd: np.ndarray, frames: list[int]):
    """Of each frame, linear part first and in world axes: Jacobian, velocity, and acceleration of a point without joint accelerations."""
    model, data, still = twin.model, twin.data, np.zeros(len(qd))
    pin.forwardKinematics(model, data, twin.q(q), twin.v(qd), still)
    pin.updateFramePlacements(model, data)
    pin.computeJointJacobians(model, data, twin.q(q))
    jacobians = [pin.getFrameJacobian(model, data, frame, WORLD)[:, twin.velocities] for frame in frames]
    velocities = [pin.getFrameVelocity(model, data, frame, WORLD).vector.copy() for frame in frames]
    drifts = [pin.getFrameClassicalAcceleration(model, data, frame, WORLD).vector.copy() for frame in frames]
    return jacobians, velocities, drifts


class Humanoid:
    """A humanoid whose soles stay where they are."""

    def __init__(self, name: str) -> None:
        file, self.soles, self.stance = HUMANOIDS[name]
        with warnings.catch_warnings(), quiet_stderr():
            warnings.simplefilter("ignore", gyroflex.RobotWarning)
            self.robot = gyroflex.Robot.load(ROBOTS / file, floating=True)
            self.twin = PinocchioTwin(ROBOTS / file, True)
        self.twin.order_as(self.robot.joint_names)
        self.frames = [self.twin.model.getFrameId(sole) for sole in self.soles]

    def oracle(self, kind: pin.ContactType) -> Oracle:
        frames = [self.twin.model.frames[frame] for frame in self.frames]
        return Oracle(self.twin, [pin.RigidConstraintModel(kind, self.twin.model, f.parentJoint, f.placement) for f in frames])

    def feet(self, q: np.ndarray, directions: str) -> list[Constraint]:
        return [Constraint.frame(s, at=self.robot.placement(s, q), directions=directions) for s in self.soles]

    def state(self, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A pose near standing, any velocity, and torques at the joints."""
        joints = len(self.robot.joint_names)
        stance = np.array([self.stance.get(name, 0.0) for name in self.robot.joint_names])
        quaternion = np.array([0.0, 0.0, 0.0, 1.0]) + rng.normal(scale=0.05, size=4)
        root = np.concatenate([[0.0, 0.0, 1.0] + rng.normal(scale=0.05, size=3), quaternion / np.linalg.norm(quaternion)])
        q = np.concatenate([root, stance + rng.normal(scale=0.1, size=joints)])
        return q, rng.normal(size=self.robot.nv), np.concatenate([np.zeros(6), rng.normal(scale=20.0, size=joints)])


@pytest.fixture(scope="module", params=list(HUMANOIDS))
def humanoid(request: pytest.FixtureRequest) -> Humanoid:
    return Humanoid(request.param)


@pytest.mark.parametrize(("directions", "kind", "rows"), [("all", "CONTACT_6D", 6), ("point", "CONTACT_3D", 3)])
@pytest.mark.parametrize("keeps", [True, False], ids=["feet at rest", "feet moving"])
def test_humanoid_on_two_feet(humanoid: Humanoid, directions: str, kind: str, rows: int, keeps: bool) -> None:
    robot, oracle = humanoid.robot, humanoid.oracle(getattr(pin.ContactType, kind))
    rng, worst = np.random.default_rng(20150101), np.zeros(3)
    for _ in range(STATES):
        q, qd, tau = humanoid.state(rng)
        jacobians, *_ = frame_motion(humanoid.twin, q, qd, humanoid.frames)
        jacobian = np.vstack([j[:rows] for j in jacobians])
        if keeps:
            qd = qd - np.linalg.pinv(jacobian) @ (jacobian @ qd)
        _, _, drifts = frame_motion(humanoid.twin, q, qd, humanoid.frames)
        drift = np.concatenate([d[:rows] for d in drifts])
        motion = robot.constrained_forward_dynamics(q, qd, tau=tau, constraints=humanoid.feet(q, directions))
        qdd, forces = oracle.dense(q, qd, tau, jacobian, drift)
        # Force first in Pinocchio; of a point, without a moment.
        wrenches = motion.wrenches[:, [3, 4, 5, 0, 1, 2]]
        assert rows == 6 or np.abs(wrenches[:, 3:]).max() < 1e-9
        found = [difference(motion.qdd, qdd), difference(wrenches[:, :rows].ravel(), forces)]
        # For feet that turn away from where they are held, Pinocchio's 6D constraint is another one.
        solver = keeps or rows == 3
        found.append(difference(motion.qdd, oracle.solver(q, qd, tau)) if solver else 0.0)
        worst = np.maximum(worst, found)
        assert motion.dependent == 0
        _, speeds, own = robot.constraint_motion(q, qd, constraints=humanoid.feet(q, directions))
        assert (np.abs(speeds).max() < 1e-12) == keeps
        assert np.linalg.matrix_rank(np.vstack([own, jacobian]), tol=1e-9) == len(jacobian)
    report(dense=worst[0], forces=worst[1], constraintDynamics=worst[2] if keeps or rows == 3 else None)


def test_humanoid_that_lands_on_two_feet(humanoid: Humanoid) -> None:
    robot, oracle = humanoid.robot, humanoid.oracle(pin.ContactType.CONTACT_6D)
    rng, worst = np.random.default_rng(20150102), np.zeros(3)
    for _ in range(STATES):
        q, qd, _ = humanoid.state(rng)
        jacobians, *_ = frame_motion(humanoid.twin, q, qd, humanoid.frames)
        jacobian = np.vstack(jacobians)
        after = robot.impact(q, qd, constraints=humanoid.feet(q, "all"))
        m = humanoid.twin.mass_matrix(q)
        dense, impulses = saddle(m, jacobian, m @ qd, np.zeros(len(jacobian)))
        found = [difference(after.qd, dense), difference(after.wrenches[:, [3, 4, 5, 0, 1, 2]].ravel(), impulses)]
        worst = np.maximum(worst, [*found, difference(after.qd, oracle.blow(q, qd))])
    report(dense=worst[0], impulses=worst[1], impulseDynamics=worst[2])


GEAR, ROTOR, STIFFNESS, DAMPING = 50.0, 3.0e-5, 800.0, 1.5
CLOSING = (0.8, 0.0, 0.05)  # on the coupler; (0, 0, 0.6) on the rocker
FOUR_BAR = """<robot name="four_bar">
  <link name="ground"/>
  {}
  <joint name="drive" type="continuous"><parent link="ground"/><child link="crank"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/></joint>
  <joint name="pin" type="continuous"><parent link="crank"/><child link="coupler"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/></joint>
  <joint name="pivot" type="continuous"><parent link="ground"/><child link="rocker"/><origin xyz="0.7 0 0"/><axis xyz="0 -1 0"/></joint>
</robot>"""
LINK = """<link name="{}"><inertial><origin xyz="{}"/><mass value="{}"/>
    <inertia ixx="0.02" ixy="0.001" ixz="0.002" iyy="0.03" iyz="0" izz="0.01"/></inertial></link>"""
LINKS = [("crank", "0.01 0 0.15", 1.2), ("coupler", "0.4 0.02 0", 2.1), ("rocker", "0.02 -0.01 0.3", 1.6)]
DRIVE = f"""
urdf: four_bar.urdf
drives:
  drive:
    rotor: {{inertia: {ROTOR}, mass: 0.4}}
    gear_ratio: {GEAR}
    transmission: {{stiffness: {STIFFNESS}, damping: {DAMPING}}}
"""


@pytest.fixture(scope="module")
def four_bar(tmp_path_factory: pytest.TempPathFactory) -> tuple[gyroflex.Robot, PinocchioTwin]:
    """A crank whose rotor is on the ground, so that the complete and the reduced model are the same."""
    folder = tmp_path_factory.mktemp("four_bar")
    (folder / "four_bar.urdf").write_text(FOUR_BAR.format("\n  ".join(LINK.format(*link) for link in LINKS)))
    (folder / "robot.yaml").write_text(DRIVE)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gyroflex.RobotWarning)
        robot = gyroflex.Robot.load(folder / "robot.yaml")
    twin = PinocchioTwin(folder / "four_bar.urdf", False)
    twin.order_as(robot.joint_names)
    return robot, twin


def closed(robot: gyroflex.Robot, q: np.ndarray, loop: list[Constraint], crank: int) -> np.ndarray:
    """The pose near `q` with the same crank angle in which the loop is closed, by Newton's method."""
    q, others = q.copy(), [i for i in range(robot.nv) if i != crank]
    for _ in range(20):
        error, _, jacobian = robot.constraint_motion(q, np.zeros(robot.nv), constraints=loop)
        q[others] -= np.linalg.solve(jacobian[:, others], error)
    assert np.abs(error).max() < 1e-14
    return q


@pytest.mark.parametrize("model", ["complete", "reduced"])
@pytest.mark.parametrize("directions", [["x", "z"], "point"], ids=["planar", "a point"])
@pytest.mark.parametrize("keeps", [True, False], ids=["closed", "coming apart"])
def test_four_bar_with_an_elastic_drive(four_bar, model: str, directions: list[str] | str, keeps: bool) -> None:
    robot, twin = four_bar
    rng, worst = np.random.default_rng(20150103), np.zeros(3)
    crank = robot.joint_names.index("drive")
    planar = [Constraint.frame("coupler", xyz=CLOSING, to="rocker", at_xyz=(0.0, 0.0, 0.6), directions=["x", "z"])]
    held = [Constraint.frame("coupler", xyz=CLOSING, to="rocker", at_xyz=(0.0, 0.0, 0.6), directions=directions)]
    # The closing point as a frame of each of the two links, and the constraint between them.
    ends = []
    for link, point in (("coupler", CLOSING), ("rocker", (0.0, 0.0, 0.6))):
        body = twin.model.frames[twin.model.getFrameId(link)]
        pose = body.placement * pin.SE3(np.eye(3), np.array(point))
        name = f"{link} end"
        if not twin.model.existFrame(name):
            twin.model.addFrame(pin.Frame(name, body.parentJoint, pose, pin.FrameType.OP_FRAME))
        ends.append((twin.model.getFrameId(name), body.parentJoint, pose))
    twin.data = twin.model.createData()
    (coupler, joint, pose), (rocker, other, at) = ends
    oracle = Oracle(twin, [pin.RigidConstraintModel(pin.ContactType.CONTACT_3D, twin.model, joint, pose, other, at)])
    guess = dict(zip(("drive", "pin", "pivot"), (0.0, -0.2, -0.1), strict=True))
    for _ in range(STATES):
        q = np.array([guess[name] for name in robot.joint_names])
        q[crank] = rng.uniform(-0.4, 0.4)
        q, qd = closed(robot, q, planar, crank), rng.normal(size=robot.nv)
        if keeps:
            _, _, own = robot.constraint_motion(q, qd, constraints=planar)
            qd -= np.linalg.pinv(own) @ (own @ qd)
        (ja, jb), (va, vb), (da, db) = frame_motion(twin, q, qd, [coupler, rocker])
        # d/dt of the relative velocity in the rocker's axes; the y-direction is free in a plane.
        axes = twin.data.oMf[rocker].rotation[:, [0, 2]].T
        jacobian = axes @ (ja - jb)[:3]
        drift = axes @ ((da - db)[:3] - 2 * np.cross(vb[3:], (va - vb)[:3]))
        tau, theta, thetad = rng.normal(scale=5.0, size=robot.nv), q.copy(), qd.copy()
        theta[crank] += rng.normal(scale=5e-3)
        thetad[crank] += rng.normal(scale=0.1)
        through = tau.copy()
        through[crank] = STIFFNESS * (theta - q)[crank] + DAMPING * (thetad - qd)[crank]
        motion = robot.constrained_forward_dynamics(q, qd, theta, thetad, tau, constraints=held, model=model)
        qdd, _ = oracle.dense(q, qd, through, jacobian, drift)
        rotor = (tau - through)[crank] / (GEAR**2 * ROTOR)
        # The solver of the others takes relative velocities in other axes: the same where there are none.
        solver = difference(motion.qdd, oracle.solver(q, qd, through)) if keeps else 0.0
        worst = np.maximum(worst, [difference(motion.qdd, qdd), abs(motion.thetadd[crank] / rotor - 1), solver])
        assert motion.dependent == (directions == "point")
    report(dense=worst[0], rotor=worst[1], constraintDynamics=worst[2] if keeps else None)
