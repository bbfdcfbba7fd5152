"""Batches of what has no lanes: robots whose links bend, robots with something held, and linear models."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import gyroflex
import gyroflex.plots
import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from batches import CALLS, agree, batch_of, results
from conftest import MODELS, PROJECT
from gyroflex import Constraint

ROWS = 70
BENDING = [PROJECT / f"robots/book_two_link/{name}.yaml" for name in ("robot", "elastic")]
STATE = ("q", "qd", "theta", "thetad")


@pytest.fixture(params=BENDING, ids=["rigid joints", "elastic joints"])
def bending(request: pytest.FixtureRequest) -> gyroflex.Robot:
    return gyroflex.Robot.load(request.param)


@pytest.mark.parametrize("name", [name for name in CALLS if "derivatives" not in name and name != "regressor"])
def test_a_batch_of_bending_links_is_the_single_calls(bending: gyroflex.Robot, name: str) -> None:
    call, names = CALLS[name]
    if name in ("placement", "jacobian"):
        def call(robot: gyroflex.Robot, q: Any) -> Any:
            return getattr(robot, name)("lower", q)
    batch = {n: a for n, a in batch_of(bending, ROWS).items() if n in names}
    one = [results(call(bending, **{n: a[i] for n, a in batch.items()})) for i in range(ROWS)]
    agree(call(bending, **batch), one, tolerance=0.0)
    single = call(bending, **{n: a.astype(np.float32) for n, a in batch.items()})
    assert all(a.dtype == np.float32 for a in results(single))


def test_modes_may_be_left_out_of_batches(bending: gyroflex.Robot) -> None:
    joints = len(bending.joint_names)
    q = batch_of(bending, ROWS)["q"]
    q[:, joints:] = 0.0
    np.testing.assert_array_equal(bending.mass_matrix(q[:, :joints]), bending.mass_matrix(q))


def test_the_jacobian_of_a_bending_link_is_how_its_frame_moves(bending: gyroflex.Robot) -> None:
    batch = batch_of(bending, 5)
    step = 1e-6
    for q, qd in zip(batch["q"], batch["qd"], strict=True):
        later, sooner = (bending.placement("lower", q + s * step * qd) for s in (1, -1))
        rate = (later - sooner) / (2 * step)
        pose = bending.placement("lower", q)
        angular, linear = np.split(bending.jacobian("lower", q) @ qd, 2)
        np.testing.assert_allclose(rate[:3, 3], linear, atol=1e-7)
        turn = rate[:3, :3] @ pose[:3, :3].T
        np.testing.assert_allclose([turn[2, 1], turn[0, 2], turn[1, 0]], angular, atol=1e-7)
        local = bending.jacobian("lower", q, axes="local") @ qd
        np.testing.assert_allclose(local, np.concatenate([pose[:3, :3].T @ angular, pose[:3, :3].T @ linear]), atol=1e-12)


def test_a_rollout_of_bending_links_is_steps_one_after_the_other(bending: gyroflex.Robot) -> None:
    rng, rows, steps, dt = np.random.default_rng(5), 6, 9, 1e-5
    state = {name: a for name, a in batch_of(bending, rows).items() if name in STATE}
    tau = rng.normal(size=(rows, steps, bending.nv))
    start = {f"{name}0": a for name, a in state.items()}
    found = dict(zip(STATE, bending.rollout(**start, tau=tau, dt=dt), strict=True))
    elastic = np.zeros(bending.nv, dtype=bool)
    elastic[: len(bending.joint_names)] = [name in bending.drives for name in bending.joint_names]
    for k in range(steps):
        qdd, thetadd = bending.forward_dynamics(**state, tau=tau[:, k])
        state["qd"] = state["qd"] + dt * qdd
        state["q"] = state["q"] + dt * state["qd"]
        state["thetad"] = np.where(elastic, state["thetad"] + dt * thetadd, state["qd"])
        state["theta"] = np.where(elastic, state["theta"] + dt * state["thetad"], state["q"])
        for name in STATE:
            expected = state[name]
            np.testing.assert_allclose(found[name][:, k + 1], expected, rtol=0, atol=1e-12 * max(1, np.abs(expected).max()))


@pytest.fixture(params=[False, True], ids=["fixed", "floating"])
def robot(arm_file: Path, request: pytest.FixtureRequest) -> gyroflex.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gyroflex.RobotWarning)
        return gyroflex.Robot.load(arm_file, floating=request.param)


HELD = [
    Constraint.frame("tool", xyz=(0.01, 0.02, 0.03), at_rpy=(0.2, -0.1, 0.4), directions=["x", "rz"]),
    Constraint.joints("elbow", "shoulder", ratio=-2.0, offset=0.1),
]
CONSTRAINED: dict[str, tuple[str, ...]] = {
    "constrained_forward_dynamics": (*STATE, "tau", "tau_ext"),
    "constrained_inverse_dynamics": (*STATE, "qdd", "thetadd", "tau_ext"),
    "impact": ("q", "qd", "thetad"),
}
FORCES = ["multipliers", "wrenches", "dependent"]
FOUND = {
    "constrained_forward_dynamics": ["qdd", "thetadd", "tau_j", "contradiction", "independence", *FORCES],
    "constrained_inverse_dynamics": ["tau_j", "tau", "unborne", *FORCES],
    "impact": ["qd", "thetad", "gears", "contradiction", "independence", "released", *FORCES],
}


@pytest.mark.parametrize("held", [HELD, HELD[:1], []], ids=["two", "one", "none"])
@pytest.mark.parametrize("name", CONSTRAINED)
def test_a_batch_with_something_held_is_the_single_calls(robot: gyroflex.Robot, name: str, held: list[Constraint]) -> None:
    call = getattr(robot, name)
    batch = {n: a for n, a in batch_of(robot, ROWS).items() if n in CONSTRAINED[name]}
    # One row stands for all.
    batch["qd"] = batch["qd"][0]
    many = call(**batch, constraints=held)
    for i in range(ROWS):
        one = call(**{n: a if n == "qd" else a[i] for n, a in batch.items()}, constraints=held)
        for field in FOUND[name]:
            array = getattr(many, field)
            assert array.shape == (ROWS, *np.shape(getattr(one, field)))
            np.testing.assert_array_equal(array[i], getattr(one, field), err_msg=field)
    assert many.dependent.dtype == np.int64
    assert isinstance(one.dependent, int)


def test_the_motion_of_constraints_comes_in_batches_and_goes_where_out_says(robot: gyroflex.Robot) -> None:
    batch = batch_of(robot, ROWS)
    room = tuple(np.full((ROWS, *shape), np.nan) for shape in ((3,), (3,), (3, robot.nv)))
    many = robot.constraint_motion(batch["q"], batch["qd"], constraints=HELD, out=room)
    for i in range(ROWS):
        one = robot.constraint_motion(batch["q"][i], batch["qd"][i], constraints=HELD)
        for given, array, expected in zip(room, many, one, strict=True):
            assert given is array
            np.testing.assert_array_equal(array[i], expected)


@pytest.mark.parametrize("model", MODELS)
def test_a_batch_of_linear_models_is_one_after_the_other(robot: gyroflex.Robot, model: Any) -> None:
    batch = {n: a for n, a in batch_of(robot, 9).items() if n in (*STATE, "tau")}
    linear = robot.linearize(**batch, model=model)
    assert len(linear) == 9
    assert "batch of 9" in repr(linear)
    sampled = linear.zero_order_hold(1e-3)
    for i in range(9):
        one = robot.linearize(**{n: a[i] for n, a in batch.items()}, model=model)
        for field in ("A", "B", "C", "D", "q", "qd", "theta", "thetad", "tau", "eigenvalues"):
            np.testing.assert_array_equal(getattr(linear, field)[i], getattr(one, field), err_msg=field)
            np.testing.assert_array_equal(getattr(linear[i], field), getattr(one, field))
        np.testing.assert_array_equal(sampled.A[i], one.zero_order_hold(1e-3).A)
        assert (linear.states, linear.inputs, linear.outputs) == (one.states, one.inputs, one.outputs)


def test_eigenvalues_are_those_of_the_matrix(arm: gyroflex.Robot) -> None:
    linear = arm.linearize(batch_of(arm, 4)["q"], friction="viscous")
    found, expected = linear.eigenvalues, np.linalg.eigvals(linear.A)
    assert (np.diff(np.abs(found), axis=1) >= -1e-9 * np.abs(found).max()).all()
    for a, b in zip(found, expected, strict=True):
        # Double eigenvalues at zero have the root of rounding for an error.
        assert all(np.abs(b - x).min() <= 1e-5 * np.abs(b).max() for x in a)
        assert all(np.abs(a - x).min() <= 1e-5 * np.abs(b).max() for x in b)
        pairs = a[np.abs(a.imag) > 1e-5 * np.abs(b).max()]
        np.testing.assert_array_equal(pairs[::2], pairs[1::2].conj())
        assert (pairs[1::2].imag > 0).all()


def test_frequency_responses_of_many_poses(arm: gyroflex.Robot) -> None:
    q = batch_of(arm, 5)["q"]
    many = arm.frequency_response("elbow", q, start=1.0, stop=100.0, points=50)
    assert len(many) == 5
    for i, one in enumerate(arm.frequency_response("elbow", pose, start=1.0, stop=100.0, points=50) for pose in q):
        for field in ("frequency", "motor", "link"):
            np.testing.assert_array_equal(getattr(many, field)[i], getattr(one, field))
        np.testing.assert_array_equal(many[i].resonances, one.resonances)
    assert len(list(many)) == 5


def test_what_differs_from_pose_to_pose_is_asked_for_one_by_one(arm: gyroflex.Robot) -> None:
    q = batch_of(arm, 3)["q"]
    linear = arm.linearize(q)
    with pytest.raises(gyroflex.ArgumentError, match=r"(?s)batch of 3.*one.modes\(\)"):
        linear.modes()
    with pytest.raises(gyroflex.ArgumentError, match="(?s)argument `q`: several poses.*one.modes"):
        arm.modes(q)
    assert [len(one.modes()) for one in linear] == [len(arm.modes(pose)) for pose in q]
    with pytest.raises(gyroflex.ArgumentError, match="one.resonances for one in"):
        _ = arm.frequency_response("elbow", q).resonances
    with pytest.raises(IndexError):
        linear[3]
    with pytest.raises(TypeError, match="single linear model"):
        len(linear[-1])
    assert linear and linear[0]
    with pytest.raises(gyroflex.ArgumentError, match="batch of 1"):
        arm.linearize(q[:1]).modes()
    with pytest.raises(gyroflex.ShapeError, match="a batch of nothing"):
        arm.linearize(q[:0])
    q[1, 2] = np.nan
    with pytest.raises(gyroflex.NotFiniteError, match=r"entry \[1, 2\]"):
        arm.linearize(q)


def test_messages_name_the_argument_and_the_entry(arm: gyroflex.Robot) -> None:
    zero, held = np.zeros(3), [Constraint.frame("tooool")]
    torques = np.zeros((4, 5, 3))
    torques[2, 1, 0] = np.inf
    many = np.zeros((2, 3))
    start = {"q0": zero, "qd0": zero, "theta0": zero, "thetad0": zero, "dt": 1e-4}
    for match, call in (
        (r"argument `tau`, entry \[2, 1, 0\]", lambda: arm.rollout(**start, tau=torques)),
        (r"\(3,\) or \(\[batch,\] steps, 3\) is expected", lambda: arm.rollout(**start, tau=np.zeros((4, 5, 2)))),
        ("argument `link`.*no link `tooool`", lambda: arm.constraint_motion(zero, zero, constraints=held)),
        ("argument `to`", lambda: arm.impact(zero, zero, zero, constraints=[Constraint.frame("tool", to="bas")])),
        ("argument `points`", lambda: arm.frequency_response("elbow", points=1)),
        ("argument `start`", lambda: arm.frequency_response("elbow", start=-1.0)),
        ("argument `stop`", lambda: arm.frequency_response("elbow", start=1.0, stop=np.nan)),
        ("argument `outputs`: none is asked for", lambda: arm.linearize(np.zeros((2, 3)), outputs=[])),
        (r"argument `qd`: an array of shape \(\) is given beside", lambda: arm.bias(np.zeros((2, 3)), 0.0, zero)),
        ("argument `out`: it shares memory with an argument", lambda: arm.bias(many, many, zero, out=(many, many.copy()))),
        ("kinetic", lambda: arm.energy(zero, zero + 1e200, zero, zero)),
        ("nearest known one is `motor_position`", lambda: arm.linearize(outputs=["motor_positio"])),
        (r"row 1: .*", lambda: arm.linearize(np.zeros((3, 3)), tau=np.array([[0, 0, 0], [1e9, 1e9, 1e9], [0, 0, 0]]))),
    ):
        with pytest.raises(gyroflex.Error, match=match):
            call()


def test_a_root_and_as_many_modes_are_not_taken_for_each_other(tmp_path: Path) -> None:
    folder = PROJECT / "robots/book_two_link"
    urdf = (folder / "book_two_link.urdf").read_text().replace('<link name="base">', BASE)
    (tmp_path / "book_two_link.urdf").write_text(urdf)
    (tmp_path / "robot.yaml").write_text((folder / "elastic.yaml").read_text().replace("modes: 2", "modes: 3"))
    arm = gyroflex.Robot.load(tmp_path / "robot.yaml", floating=True)
    assert (arm.nv, len(arm.mode_names)) == (14, 6)
    assert arm.gravity_torques(np.array([0, 0, 0, 0, 0, 0, 1, 0, 0])).shape == (14,)
    q, qd, eight = np.zeros(15), np.zeros(14), np.zeros(8)
    q[6] = 1.0
    for state in (q, np.tile(q, (2, 1))):
        arm.forward_dynamics(state, qd, np.zeros(2), np.zeros(2), np.zeros(2))
        with pytest.raises(gyroflex.ShapeError, match="`theta`.*the root's six can be missing or the modes"):
            arm.forward_dynamics(state, qd, eight, eight, eight)


BASE = """<link name="base"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"""


def test_plots_take_batches_apart(arm: gyroflex.Robot) -> None:
    matplotlib.use("Agg")
    responses = arm.frequency_response("elbow", np.zeros((3, 3)), points=20)
    try:
        for given in (responses, [responses]):
            magnitude, _ = gyroflex.plots.frequency_response(given)
            assert [line.get_label() for line in magnitude.lines[::2]] == [f"elbow[{k}], motor" for k in range(3)]
            assert all(len(line.get_xdata()) == 20 for line in magnitude.lines)
    finally:
        plt.close("all")
