"""What must hold for every robot, through the eyes of Python."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import gyroflex
import numpy as np
import pytest
from conftest import MODELS, random_state


@pytest.fixture(params=[False, True], ids=["fixed", "floating"])
def robot(request: pytest.FixtureRequest, arm_file: Path) -> gyroflex.Robot:
    return gyroflex.Robot.load(arm_file, floating=request.param)


@pytest.mark.parametrize("model", MODELS)
def test_inverse_of_forward_is_the_identity(robot: gyroflex.Robot, model: str) -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        state = random_state(robot, rng)
        tau, tau_ext = rng.normal(size=(2, robot.nv))
        qdd, thetadd = robot.forward_dynamics(**state, tau=tau, model=model, tau_ext=tau_ext)
        again = robot.inverse_dynamics(**state, qdd=qdd, thetadd=thetadd, model=model, tau_ext=tau_ext)[1]
        # At a joint without a drive the torque acts on the joint itself, in both directions.
        np.testing.assert_allclose(again, tau, rtol=1e-10, atol=1e-10 * np.abs(tau).max() + 1e-9)


def test_mass_matrix_is_symmetric_and_positive(robot: gyroflex.Robot) -> None:
    q = random_state(robot, np.random.default_rng(2))["q"]
    m = robot.mass_matrix(q)
    np.testing.assert_array_equal(m, m.T)
    assert np.linalg.eigvalsh(m).min() > 0.0


@pytest.mark.parametrize("model", ["rigid", "rigid_reflected"])
def test_mass_matrix_columns_are_torques_of_unit_accelerations(robot: gyroflex.Robot, model: str) -> None:
    q = random_state(robot, np.random.default_rng(3))["q"]
    still = np.zeros(robot.nv)
    at_rest = robot.inverse_dynamics(q, still, still, model=model)[1]
    columns = [robot.inverse_dynamics(q, still, unit, model=model)[1] - at_rest for unit in np.eye(robot.nv)]
    m = robot.mass_matrix(q, model=model)
    np.testing.assert_allclose(np.transpose(columns), m, rtol=0, atol=1e-12 * np.abs(m).max() + 1e-12)


def test_motor_accelerations_push_links_through_the_coupling(robot: gyroflex.Robot) -> None:
    state = random_state(robot, np.random.default_rng(4))
    qdd = np.zeros(robot.nv)
    at_rest = robot.inverse_dynamics(**state, qdd=qdd, thetadd=qdd)[0]
    pushed = [robot.inverse_dynamics(**state, qdd=qdd, thetadd=unit)[0] - at_rest for unit in np.eye(robot.nv)]
    s = robot.coupling_matrix(state["q"])
    assert np.abs(s).max() > 0.0
    np.testing.assert_allclose(np.transpose(pushed), s, rtol=0, atol=1e-12)


@pytest.mark.parametrize("model", MODELS[1:])
def test_coupling_vanishes_in_all_but_the_complete_model(robot: gyroflex.Robot, model: str) -> None:
    q = random_state(robot, np.random.default_rng(5))["q"]
    assert not robot.coupling_matrix(q, model=model).any()


def test_placement_of_the_tool_is_the_product_of_the_joints(arm: gyroflex.Robot) -> None:
    def pose(xyz: tuple[float, ...], axis: str, angle: float) -> np.ndarray:
        i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
        t = np.eye(4)
        t[:3, 3] = xyz
        t[i, i] = t[j, j] = np.cos(angle)
        t[i, j], t[j, i] = -np.sin(angle), np.sin(angle)
        return t

    none = (0.0, 0.0, 0.0)
    q = np.array([0.7, -1.1, 0.25])
    steps = [
        pose((0, 0, 0.3), "x", 0.3) @ pose(none, "z", q[0]),
        pose((0.4, 0, 0), "y", 0.5) @ pose(none, "y", q[1]),
        pose((0.3, 0, 0), "z", 0.2) @ pose((q[2], 0, 0), "x", 0.0),
        pose((0.1, 0, 0.05), "y", np.pi / 2),
    ]
    expected = np.eye(4)
    np.testing.assert_array_equal(arm.placement("base", q), expected)
    for link, step in zip(("upper", "fore", "slider", "tool"), steps, strict=True):
        expected = expected @ step
        np.testing.assert_allclose(arm.placement(link, q), expected, rtol=0, atol=1e-14)


def test_floating_root_stands_where_its_coordinates_say(arm_file: Path) -> None:
    robot = gyroflex.Robot.load(arm_file, floating=True)
    half = np.sqrt(0.5)
    pose = robot.placement("base", [1.0, 2.0, 3.0, 0.0, 0.0, half, half, 0.1, 0.2, 0.3])
    quarter_turn = [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
    np.testing.assert_allclose(pose, quarter_turn, rtol=0, atol=1e-15)


def test_motors_of_a_floating_robot_need_no_root(arm_file: Path) -> None:
    robot = gyroflex.Robot.load(arm_file, floating=True)
    state = random_state(robot, np.random.default_rng(6))
    tau = np.concatenate([np.zeros(6), [1.0, 2.0, 3.0]])
    whole = robot.forward_dynamics(**state, tau=tau)
    state |= {"theta": state["theta"][6:], "thetad": state["thetad"][6:]}
    for a, b in zip(whole, robot.forward_dynamics(**state, tau=tau[6:]), strict=True):
        np.testing.assert_array_equal(a, b)


def test_eight_threads_get_the_same_bits(arm: gyroflex.Robot) -> None:
    rng = np.random.default_rng(7)
    states = [random_state(arm, rng) for _ in range(50)]
    tau = rng.normal(size=arm.nv)

    def run(_: int) -> bytes:
        numbers = [arm.forward_dynamics(**s, tau=tau, model=model) for s in states for model in MODELS]
        return np.asarray(numbers).tobytes()

    alone = run(0)
    with ThreadPoolExecutor(8) as threads:
        assert set(threads.map(run, range(32))) == {alone}


def test_an_earlier_call_changes_nothing(arm: gyroflex.Robot) -> None:
    rng = np.random.default_rng(8)
    state, tau = random_state(arm, rng), rng.normal(size=arm.nv)
    first = np.asarray(arm.forward_dynamics(**state, tau=tau)).tobytes()
    arm.forward_dynamics(**random_state(arm, rng), tau=1e3 * tau, tau_ext=tau)
    with pytest.raises(gyroflex.NotFiniteError):
        arm.forward_dynamics(**state, tau=np.full(arm.nv, np.nan))
    assert np.asarray(arm.forward_dynamics(**state, tau=tau)).tobytes() == first


def test_arrays_are_taken_in_any_form_and_left_alone(arm: gyroflex.Robot) -> None:
    q, qd, qdd = np.array([1.0, 0.0, 2.0]), np.array([0.5, -0.25, 4.0]), np.array([3.0, 2.0, 1.0])
    expected = arm.inverse_dynamics(q, qd, qdd, model="rigid")
    strided = np.zeros((3, 5))
    strided[:, 2] = qd
    locked = qd.copy()
    locked.setflags(write=False)
    forms = [list(qd), tuple(qd), qd.astype(np.float32), qd.astype(">f8"), strided[:, 2], qd[::-1].copy()[::-1], locked]
    for form in forms:
        for a, b in zip(arm.inverse_dynamics([1, 0, 2], form, qdd, model="rigid"), expected, strict=True):
            np.testing.assert_array_equal(a, b)
    np.testing.assert_array_equal(qd, [0.5, -0.25, 4.0])


def test_results_belong_to_the_caller(arm: gyroflex.Robot) -> None:
    state = random_state(arm, np.random.default_rng(9))
    first, _ = arm.forward_dynamics(**state, tau=np.zeros(3))
    kept = first.copy()
    arm.forward_dynamics(**state, tau=np.ones(3))
    np.testing.assert_array_equal(first, kept)
    first[:] = 0.0
    assert first.dtype == np.float64


def test_robot_describes_itself(arm: gyroflex.Robot, arm_file: Path) -> None:
    assert (arm.name, arm.nq, arm.nv, arm.floating, arm.model) == ("elastic_arm", 3, 3, False, "complete")
    assert list(arm.joint_names) == ["shoulder", "elbow", "extend"]
    assert list(arm.link_names) == ["base", "upper", "fore", "slider", "tool"]
    np.testing.assert_array_equal(arm.gravity, [0.0, 0.0, -9.81])
    floating = gyroflex.Robot.load(arm_file, floating=True, model="reduced")
    assert (floating.nq, floating.nv, floating.floating, floating.model) == (10, 9, True, "reduced")
    assert list(floating.joint_names) == list(arm.joint_names)
    assert "elastic_arm" in repr(arm)
