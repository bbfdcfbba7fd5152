"""Constrained dynamics, impacts and constraints themselves, against the equations of motion in dense matrices."""

from __future__ import annotations

import warnings
from pathlib import Path

import gyroflex
import numpy as np
import pytest
from conftest import MODELS, random_state
from gyroflex import Constraint

STEP = 1e-6


@pytest.fixture(params=[False, True], ids=["fixed", "floating"])
def arm(arm_file: Path, request: pytest.FixtureRequest) -> gyroflex.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gyroflex.RobotWarning)
        return gyroflex.Robot.load(arm_file, floating=request.param)


def held(arm: gyroflex.Robot) -> list[Constraint]:
    """On a fixed base one direction more would leave nothing to move."""
    if arm.floating:
        at = {"at_xyz": (0.3, 0.1, 0.5), "at_rpy": (0.2, -0.1, 0.4)}
        return [
            Constraint.frame("tool", xyz=(0.01, 0.02, 0.03), rpy=(0.1, 0.2, 0.3), **at),
            Constraint.joints("elbow", "shoulder", ratio=-2.0, offset=0.1),
        ]
    return [Constraint.frame("tool", xyz=(0.01, 0.02, 0.03), at_rpy=(0.2, -0.1, 0.4), directions=["x", "rz"])]


@pytest.mark.parametrize("model", MODELS)
def test_accelerations_keep_the_constraints_and_balance_their_forces(arm: gyroflex.Robot, model: str) -> None:
    rng = np.random.default_rng(8)
    s, constraints, tau = random_state(arm, rng), held(arm), rng.normal(size=arm.nv)
    motion = arm.constrained_forward_dynamics(**s, tau=tau, constraints=constraints, model=model)
    _, _, jacobian = arm.constraint_motion(s["q"], s["qd"], constraints=constraints)
    # The constraints' forces are an external load.
    tau_j, motors = arm.inverse_dynamics(
        s["q"], s["qd"], motion.qdd, s["theta"], s["thetad"], motion.thetadd,
        tau_ext=jacobian.T @ motion.multipliers, model=model,
    )
    np.testing.assert_allclose(motors, tau, atol=1e-9)
    np.testing.assert_allclose(motion.tau_j, tau_j, atol=1e-9)
    assert (motion.dependent, motion.wrenches.shape) == (0, (len(constraints), 6))
    # J qdd + dJ/dt qd = 0, the second by a difference where the joints' positions are coordinates
    if not arm.floating:
        _, later, _ = arm.constraint_motion(s["q"] + STEP * s["qd"], s["qd"] + STEP * motion.qdd, constraints=constraints)
        _, sooner, _ = arm.constraint_motion(s["q"] - STEP * s["qd"], s["qd"] - STEP * motion.qdd, constraints=constraints)
        np.testing.assert_allclose((later - sooner) / (2 * STEP), 0.0, atol=1e-7)


def allowed_motion(
    arm: gyroflex.Robot, rng: np.random.Generator, model: str
) -> tuple[dict[str, np.ndarray], list[Constraint], np.ndarray, np.ndarray]:
    """A state, what is held, and accelerations of joints and motors that it allows."""
    s, constraints = random_state(arm, rng), held(arm)
    motion = arm.constrained_forward_dynamics(**s, tau=rng.normal(size=arm.nv), constraints=constraints, model=model)
    return s, constraints, motion.qdd, motion.thetadd


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("model", MODELS)
def test_forward_dynamics_of_the_inverse_give_the_motion_back(arm: gyroflex.Robot, model: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    s, constraints, qdd, thetadd = allowed_motion(arm, rng, model)
    inverse = arm.constrained_inverse_dynamics(
        s["q"], s["qd"], qdd, s["theta"], s["thetad"], thetadd, constraints=constraints, model=model
    )
    lead = arm.nv - len(arm.joint_names)
    assert inverse.unborne <= 1e-9 * (1 + np.abs(inverse.multipliers).max())

    def error(theta: np.ndarray) -> np.ndarray:
        """What springs exert beyond what the inverse asks of them."""
        state = s | {"theta": theta}
        return arm.constrained_forward_dynamics(**state, tau=inverse.tau, constraints=constraints, model=model).tau_j - inverse.tau_j

    # Springs that are asked for these torques: Newton's method, joint by joint, with differences for slopes.
    theta = s["theta"].copy()
    for _ in range(12):
        slope = (error(theta + STEP) - error(theta - STEP)) / (2 * STEP)
        theta = theta - np.divide(error(theta), slope, out=np.zeros(arm.nv), where=np.abs(slope) > 1.0)
    tau = np.concatenate([np.zeros(lead), inverse.tau[lead:]])
    motion = arm.constrained_forward_dynamics(**(s | {"theta": theta}), tau=tau, constraints=constraints, model=model)
    np.testing.assert_allclose(motion.qdd, qdd, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(motion.thetadd, thetadd, rtol=1e-6, atol=1e-5)
    np.testing.assert_allclose(motion.multipliers, inverse.multipliers, rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(motion.wrenches, inverse.wrenches, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("model", MODELS)
def test_distribution_has_the_least_weighted_norm(arm: gyroflex.Robot, model: str, seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    s, constraints, qdd, thetadd = allowed_motion(arm, rng, model)
    state = (s["q"], s["qd"], qdd, s["theta"], s["thetad"], thetadd)
    _, _, jacobian = arm.constraint_motion(s["q"], s["qd"], constraints=constraints)
    free, _ = arm.inverse_dynamics(*state, model=model)
    m, lead = len(jacobian), arm.nv - len(arm.joint_names)
    w, v, wanted = rng.uniform(0.1, 10.0, arm.nv), rng.uniform(0.01, 1.0, m), rng.normal(scale=20.0, size=m)
    for passive in ([], ["shoulder"]):
        found = arm.constrained_inverse_dynamics(
            *state, constraints=constraints, passive=passive, torque_weights=w, multiplier_weights=v, wanted=wanted, model=model
        )
        # min |diag(w)^½ (h - Jᵀ λ)|² + |diag(v)^½ (λ - λ*)|² over driven rows, with J_pᵀ λ = h_p: the conditions of Karush, Kuhn and Tucker
        idle = list(range(lead)) + [lead + arm.joint_names.index(name) for name in passive]
        driven = [k for k in range(arm.nv) if k not in idle]
        j, jp = jacobian[:, driven], jacobian[:, idle]
        kkt = np.block([[j * w[driven] @ j.T + np.diag(v), -jp], [jp.T, np.zeros((len(idle), len(idle)))]])
        right = np.concatenate([j @ (w[driven] * free[driven]) + v * wanted, free[idle]])
        multipliers = np.linalg.solve(kkt, right)[:m]
        np.testing.assert_allclose(found.multipliers, multipliers, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(found.tau_j, free - jacobian.T @ multipliers, rtol=1e-6, atol=1e-6)


def test_torques_are_of_least_norm_by_default(arm: gyroflex.Robot) -> None:
    rng = np.random.default_rng(21)
    s, constraints, qdd, thetadd = allowed_motion(arm, rng, "rigid")
    found = arm.constrained_inverse_dynamics(s["q"], s["qd"], qdd, constraints=constraints, model="rigid")
    _, _, jacobian = arm.constraint_motion(s["q"], s["qd"], constraints=constraints)
    free, _ = arm.inverse_dynamics(s["q"], s["qd"], qdd, model="rigid")
    lead = arm.nv - len(arm.joint_names)
    # All forces that bear the root's load, and of them those that leave the joints least.
    of_root, of_joints = jacobian[:, :lead].T, jacobian[:, lead:].T
    borne = np.linalg.lstsq(of_root, free[:lead], rcond=None)[0] if lead else np.zeros(len(jacobian))
    choice = np.linalg.svd(of_root)[2][lead:].T if lead else np.eye(len(jacobian))
    least = borne + choice @ np.linalg.lstsq(of_joints @ choice, free[lead:] - of_joints @ borne, rcond=None)[0]
    np.testing.assert_allclose(found.multipliers, least, rtol=1e-4, atol=1e-3)
    np.testing.assert_allclose(found.tau_j, free - jacobian.T @ least, rtol=1e-4, atol=1e-3)


def test_an_unloaded_foot_bears_nothing_and_the_others_all(arm: gyroflex.Robot) -> None:
    if not arm.floating:
        pytest.skip("stands on its feet only where its root is free")
    rng = np.random.default_rng(22)
    s = random_state(arm, rng)
    feet = [Constraint.frame("base", xyz=(0.1, 0.0, 0.0)), Constraint.frame("tool", directions="point")]
    motion = arm.constrained_forward_dynamics(**s, tau=rng.normal(size=arm.nv), constraints=feet, model="rigid")
    shared, alone, barely = (
        arm.constrained_inverse_dynamics(s["q"], s["qd"], motion.qdd, constraints=c, multiplier_weights=v, model="rigid")
        for c, v in ((feet, np.full(9, 1e-3)), (feet[:1], np.full(6, 1e-3)), (feet, [1e-3] * 6 + [1e9] * 3))
    )
    assert max(x.unborne for x in (shared, alone, barely)) < 1e-7
    assert np.abs(shared.wrenches[1, 3:]).max() > 1e-3
    # What costs much is left unloaded, as what is left out.
    assert np.abs(barely.wrenches[1]).max() < 1e-5
    np.testing.assert_allclose(barely.wrenches[0], alone.wrenches[0], rtol=1e-6, atol=1e-5)
    np.testing.assert_allclose(barely.tau, alone.tau, rtol=1e-6, atol=1e-5)


def test_a_load_that_nothing_bears_is_told(arm: gyroflex.Robot) -> None:
    s, rng = random_state(arm, np.random.default_rng(23)), np.random.default_rng(24)
    one = [Constraint.frame("tool", directions=["x"])]
    found = arm.constrained_inverse_dynamics(
        s["q"], s["qd"], rng.normal(size=arm.nv), constraints=one, passive=["shoulder", "elbow"], model="rigid"
    )
    assert found.unborne > 1e-2


def test_jacobian_is_that_of_the_errors(arm: gyroflex.Robot) -> None:
    s, constraints = random_state(arm, np.random.default_rng(9)), held(arm)
    if arm.floating:
        s["q"][:7] = [0.3, 0.1, 0.4, 0.0, 0.0, 0.0, 1.0]
    _, velocity, jacobian = arm.constraint_motion(s["q"], s["qd"], constraints=constraints)
    np.testing.assert_allclose(velocity, jacobian @ s["qd"], atol=1e-12)
    lead = arm.nq - len(arm.joint_names)
    point = [Constraint.frame("tool", xyz=(0.01, 0.02, 0.03), at_rpy=(0.2, -0.1, 0.4), directions="point")]
    _, _, jacobian = arm.constraint_motion(s["q"], s["qd"], constraints=point)
    for joint in range(len(arm.joint_names)):
        step = STEP * np.eye(arm.nq)[lead + joint]
        ends = [arm.constraint_motion(s["q"] + x, s["qd"], constraints=point)[0] for x in (step, -step)]
        column = jacobian[:, arm.nv - len(arm.joint_names) + joint]
        np.testing.assert_allclose((ends[0] - ends[1]) / (2 * STEP), column, atol=1e-8)


@pytest.mark.parametrize("model", MODELS)
def test_impact_stops_what_is_held_by_its_impulses(arm: gyroflex.Robot, model: str) -> None:
    s, constraints = random_state(arm, np.random.default_rng(10)), held(arm)
    after = arm.impact(s["q"], s["qd"], s["thetad"], constraints=constraints, model=model)
    _, velocity, jacobian = arm.constraint_motion(s["q"], after.qd, constraints=constraints)
    np.testing.assert_allclose(velocity, 0.0, atol=1e-12)
    jump = after.qd - s["qd"]
    motors = after.thetad - s["thetad"]
    m, coupling = arm.mass_matrix(s["q"], model=model), arm.coupling_matrix(s["q"], model=model)
    elastic = np.any(coupling != 0.0, axis=0)
    momentum = m @ jump + coupling @ np.where(elastic, motors, 0.0)
    np.testing.assert_allclose(momentum, jacobian.T @ after.multipliers, atol=1e-10)


def test_wrench_on_a_link_is_that_of_the_multipliers(arm: gyroflex.Robot) -> None:
    s = random_state(arm, np.random.default_rng(11))
    pose = arm.placement("tool", s["q"])
    turned = Constraint.frame("tool", at=pose, directions=["x", "rz"])
    motion = arm.constrained_forward_dynamics(**s, tau=np.zeros(arm.nv), constraints=[turned])
    moment, force = motion.multipliers
    np.testing.assert_allclose(motion.wrenches[0, :3], pose[:3, 2] * moment, atol=1e-10)
    np.testing.assert_allclose(motion.wrenches[0, 3:], pose[:3, 0] * force, atol=1e-10)


def test_pose_as_a_matrix_is_the_one_of_its_angles(arm: gyroflex.Robot) -> None:
    s = random_state(arm, np.random.default_rng(12))
    (cy, sy) = np.cos(0.4), np.sin(0.4)
    matrix = [[cy, -sy, 0, 0.1], [sy, cy, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]]
    two = [{"at": matrix}, {"at_xyz": (0.1, 0.2, 0.3), "at_rpy": (0.0, 0.0, 0.4)}]
    found = [arm.constraint_motion(s["q"], s["qd"], constraints=[Constraint.frame("tool", **at)])[0] for at in two]
    np.testing.assert_allclose(*found, atol=1e-14)
    # A link is held to another one as to the world, where that one stands.
    base = [Constraint.frame("tool", to="base"), Constraint.frame("tool", at=arm.placement("base", s["q"]))]
    found = [arm.constraint_motion(s["q"], s["qd"], constraints=[c])[0] for c in base]
    np.testing.assert_allclose(*found, atol=1e-12)


def test_errors_are_drawn_back(arm: gyroflex.Robot) -> None:
    s, rate = random_state(arm, np.random.default_rng(13)), 20.0
    free, drawn = (Constraint.frame("tool", directions="point", stabilisation=x) for x in (0.0, rate))
    error, velocity, jacobian = arm.constraint_motion(s["q"], s["qd"], constraints=[free])
    qdd = [arm.constrained_forward_dynamics(**s, tau=np.zeros(arm.nv), constraints=[c]).qdd for c in (free, drawn)]
    np.testing.assert_allclose(jacobian @ (qdd[1] - qdd[0]), -2 * rate * velocity - rate**2 * error, atol=1e-7)


def test_what_is_held_twice_is_told(arm: gyroflex.Robot) -> None:
    s = random_state(arm, np.random.default_rng(14))
    once = Constraint.frame("tool", directions=["x"])
    motion = arm.constrained_forward_dynamics(**s, tau=np.zeros(arm.nv), constraints=[once, once])
    assert motion.dependent == 1 and motion.contradiction < 1e-9 and motion.multipliers[1] == 0.0
    shared = arm.constrained_forward_dynamics(**s, tau=np.zeros(arm.nv), constraints=[once, once], damping=1e-6)
    assert shared.multipliers[0] == pytest.approx(shared.multipliers[1], rel=1e-5)
    nothing = arm.constrained_forward_dynamics(**s, tau=np.zeros(arm.nv), constraints=[])
    np.testing.assert_allclose(nothing.qdd, arm.forward_dynamics(**s, tau=np.zeros(arm.nv))[0], rtol=1e-12)


def test_contacts_rebound_and_let_go(arm: gyroflex.Robot) -> None:
    s = random_state(arm, np.random.default_rng(15))
    ball = Constraint.frame("tool", directions=["z"], contact="z", restitution=0.5)
    _, before, _ = arm.constraint_motion(s["q"], s["qd"], constraints=[ball])
    for sign in (1.0, -1.0):
        qd, thetad = sign * np.sign(before) * s["qd"], s["thetad"]
        hit = arm.impact(s["q"], qd, thetad, constraints=[ball], release=True)
        _, after, _ = arm.constraint_motion(s["q"], hit.qd, constraints=[ball])
        leaves = sign > 0
        np.testing.assert_allclose(after, abs(before) * (1.0 if leaves else 0.5), atol=1e-12)
        assert hit.released == int(leaves)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Constraint.frame("tool", directions="plane"), "`directions`.*known: all, point"),
        (lambda: Constraint.frame("tool", directions=["w"]), "`directions`.*known: rx, ry"),
        (lambda: Constraint.frame("tool", directions=[]), "`directions`.*nothing is held"),
        (lambda: Constraint.frame("tool", directions=["x"], contact="z"), "`contact`.*leaves the direction `z` free"),
        (lambda: Constraint.frame("tool", contact="z", restitution=2.0), "`restitution`.*0 to 1"),
        (lambda: Constraint.frame("tool", restitution=0.5), "`contact`.*no contact"),
        (lambda: Constraint.frame("tool", stabilisation=-1.0), "`stabilisation`.*rad/s"),
        (lambda: Constraint.frame("tool", xyz=(np.nan, 0, 0)), "`xyz`, entry 0"),
        (lambda: Constraint.frame("tool", at=np.eye(4), at_xyz=(0, 0, 0)), "`at`.*given twice"),
        (lambda: Constraint.frame("tool", at=np.eye(3)), "`at`.*shape"),
        (lambda: Constraint.frame("tool", at=2 * np.eye(4)), "`at`.*no rotation"),
        (lambda: Constraint.joints("elbow", "elbow"), "`follows`.*follows itself"),
    ],
)
def test_constraints_that_make_no_sense_are_refused(call, words: str) -> None:
    with pytest.raises(gyroflex.Error, match="(?s)" + words):
        call()


@pytest.mark.parametrize(
    ("constraint", "words"),
    [
        (Constraint.frame("tol"), "nearest known one is `tool`"),
        (Constraint.frame("tool", to="slider"), "`to`.*one body with"),
        (Constraint.joints("elbo", "shoulder"), "`joint`.*nearest known one is `elbow`"),
        (Constraint.joints("elbow", "mount"), "`follows`.*no joint `mount`"),
    ],
)
def test_constraints_that_do_not_fit_the_robot_are_refused(arm: gyroflex.Robot, constraint: Constraint, words: str) -> None:
    s = random_state(arm, np.random.default_rng(16))
    for call in (
        lambda: arm.constraint_motion(s["q"], s["qd"], constraints=[constraint]),
        lambda: arm.impact(s["q"], s["qd"], s["thetad"], constraints=[constraint]),
        lambda: arm.constrained_forward_dynamics(**s, tau=np.zeros(arm.nv), constraints=[constraint]),
    ):
        with pytest.raises(gyroflex.ArgumentError, match="(?s)" + words):
            call()


def test_what_a_file_holds_is_what_its_names_say(arm_file: Path) -> None:
    path = arm_file.parent / "held.yaml"
    path.write_text(
        arm_file.read_text()
        + """
constraints:
  wall: {link: tool, xyz: [0.01, 0.02, 0.03], rpy: [0.1, 0.2, 0.3], to: {link: base, xyz: [0.3, 0.1, 0.5]}, directions: [x, rz], stabilisation: 5}
  itself: {link: tool, to: {link: upper}, directions: [y]}
couplings:
  belt: {joint: elbow, follows: shoulder, ratio: -2.0, offset: 0.1}
"""
    )
    for floating in (False, True):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", gyroflex.RobotWarning)
            robot = gyroflex.Robot.load(path, floating=floating)
        written = {
            "wall": Constraint.frame(
                "tool", xyz=(0.01, 0.02, 0.03), rpy=(0.1, 0.2, 0.3), to="base", at_xyz=(0.3, 0.1, 0.5), directions=["x", "rz"]
            ),
            "itself": Constraint.frame("tool", to="upper", directions=["y"]),
            "belt": Constraint.joints("elbow", "shoulder", ratio=-2.0, offset=0.1),
        }
        assert robot.constraints.keys() == written.keys()
        s = random_state(robot, np.random.default_rng(18))
        for name, constraint in robot.constraints.items():
            of_file, of_names = (robot.constraint_motion(s["q"], s["qd"], constraints=[c]) for c in (constraint, written[name]))
            for a, b in zip(of_file, of_names, strict=True):
                np.testing.assert_allclose(a, b, atol=1e-12)


def test_calls_say_what_is_missing(arm: gyroflex.Robot) -> None:
    s, constraints = random_state(arm, np.random.default_rng(17)), held(arm)
    with pytest.raises(gyroflex.ArgumentError, match="`tau`"):
        arm.constrained_forward_dynamics(**s, constraints=constraints)
    with pytest.raises(gyroflex.ArgumentError, match="`threshold`"):
        arm.constrained_forward_dynamics(**s, tau=np.zeros(arm.nv), constraints=constraints, threshold=1.0)
    with pytest.raises(gyroflex.ArgumentError, match="`damping`"):
        arm.impact(s["q"], s["qd"], s["thetad"], constraints=constraints, damping=-1.0)
    rows = sum(c.rows for c in constraints)
    for wrong, words, error in (
        ({"passive": ["elbo"]}, "`passive`.*nearest known one is `elbow`", gyroflex.ArgumentError),
        ({"torque_weights": np.ones(arm.nv + 1)}, "`torque_weights`.*expected", gyroflex.ShapeError),
        ({"torque_weights": np.zeros(arm.nv)}, "`torque_weights`.*above zero", gyroflex.ArgumentError),
        ({"multiplier_weights": np.ones(rows + 1)}, "`multiplier_weights`.*expected", gyroflex.ShapeError),
        ({"multiplier_weights": -np.ones(rows)}, "`multiplier_weights`.*zero or more", gyroflex.ArgumentError),
        ({"wanted": np.ones((rows, 1))}, "`wanted`.*expected", gyroflex.ShapeError),
        ({"wanted": np.full(rows, np.nan)}, "`wanted`, entry 0", gyroflex.NotFiniteError),
    ):
        with pytest.raises(error, match="(?s)" + words):
            arm.constrained_inverse_dynamics(
                s["q"], s["qd"], s["qd"], s["theta"], s["thetad"], s["qd"], constraints=constraints, **wrong
            )
    slips = [Constraint.frame("tool", directions="point", contact="z", slip=(0.1, 0.0, 0.0))]
    with pytest.raises(gyroflex.ArgumentError, match="constraint 0 slips"):
        arm.constrained_inverse_dynamics(s["q"], s["qd"], s["qd"], constraints=slips, model="rigid")
