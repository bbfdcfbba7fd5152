"""Linear models, modes and frequency responses: the numbers of the command line, and what NumPy and SciPy make of them."""

from __future__ import annotations

import json
import subprocess
import warnings
from pathlib import Path
from typing import Any

import gyroflex
import numpy as np
import pytest
import scipy.linalg
from conftest import MODELS, PROJECT, random_state

ROBOTS = sorted(PROJECT.glob("robots/*/robot.yaml"))
NAMES = [path.parent.name for path in ROBOTS]


def load(path: Path, *, floating: bool = False) -> gyroflex.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gyroflex.RobotWarning)
        return gyroflex.Robot.load(path, floating=floating)


def pose(robot: gyroflex.Robot) -> np.ndarray:
    return random_state(robot, np.random.default_rng(5))["q"]


def ask(binary: Path, *arguments: object) -> Any:
    command = [str(binary), *map(str, arguments), "--json", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def listed(numbers: np.ndarray) -> str:
    return ",".join(repr(x) for x in numbers.tolist())


@pytest.mark.parametrize("path", ROBOTS, ids=NAMES)
def test_the_command_line_gives_the_same_bits(binary: Path, path: Path) -> None:
    compare(binary, path, load(path))


def test_the_command_line_gives_the_same_bits_of_a_floating_robot(binary: Path, arm_file: Path) -> None:
    compare(binary, arm_file, load(arm_file, floating=True), "--floating")


def compare(binary: Path, path: Path, robot: gyroflex.Robot, *options: str) -> None:
    q = pose(robot)
    outputs = ["motor_velocity", "joint_torque", f"pose:{robot.link_names[-1]}"]
    ours = robot.linearize(q, outputs=outputs)
    theirs = ask(binary, "linearize", path, "--q", listed(q), "--output", ",".join(outputs), *options)
    for name in "ABCD":
        np.testing.assert_array_equal(getattr(ours, name), theirs[name])
    assert [ours.states, ours.inputs, ours.outputs] == [theirs["states"], theirs["inputs"], theirs["outputs"]]
    for name in ("q", "qd", "theta", "thetad", "tau"):
        np.testing.assert_array_equal(getattr(ours, name), theirs[name])

    modes = robot.modes(q, friction="viscous")
    theirs = ask(binary, "modes", path, "--q", listed(q), "--friction", "viscous", *options)["modes"]
    assert [(m.kind, m.frequency, m.damping_ratio, m.moves_most) for m in modes] == [
        (m["kind"], m["frequency"], m["damping_ratio"], m["moves_most"]) for m in theirs
    ]
    for mode, their in zip(modes, theirs, strict=True):
        assert [mode.eigenvalue.real, mode.eigenvalue.imag] == their["eigenvalue"]
        np.testing.assert_array_equal(mode.shape, np.array(their["shape"]) @ [1.0, 1.0j])

    joint = robot.joint_names[-1]
    response = robot.frequency_response(joint, q, start=0.5, stop=300.0, points=40)
    sweep = ["--from", 0.5, "--to", 300.0, "--points", 40]
    theirs = ask(binary, "frf", path, "--joint", joint, "--q", listed(q), *sweep, *options)
    np.testing.assert_array_equal(response.frequency, theirs["frequency"])
    for side in ("motor", "link"):
        polar = theirs[side]
        z = np.array(polar["magnitude"]) * np.exp(1j * np.array(polar["phase"]))
        np.testing.assert_allclose(getattr(response, side), z, rtol=1e-12)
    np.testing.assert_array_equal(response.resonances, [e["frequency"] for e in theirs["resonances"]])
    np.testing.assert_array_equal(response.antiresonances, [e["frequency"] for e in theirs["antiresonances"]])


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("path", ROBOTS, ids=NAMES)
def test_zero_order_hold_is_the_matrix_exponential_of_scipy(path: Path, model: str) -> None:
    robot = load(path)
    linear = robot.linearize(pose(robot), model=model, friction="viscous")
    n, m = linear.B.shape
    for step in (1e-4, 1e-3, 1e-2):
        block = np.zeros((n + m, n + m))
        block[:n] = np.hstack([linear.A, linear.B]) * step
        exact = scipy.linalg.expm(block)
        sampled = linear.zero_order_hold(step)
        assert sampled.step == step
        np.testing.assert_allclose(sampled.A, exact[:n, :n], rtol=0, atol=1e-12 * np.abs(exact).max())
        np.testing.assert_allclose(sampled.B, exact[:n, n:], rtol=0, atol=1e-12 * np.abs(exact[:n, n:]).max())
        np.testing.assert_array_equal(sampled.C, linear.C)


@pytest.mark.parametrize("path", ROBOTS, ids=NAMES)
def test_modes_are_the_eigenvalues_numpy_finds(path: Path) -> None:
    robot = load(path)
    linear = robot.linearize(pose(robot), friction="viscous")
    ours = [m.eigenvalue for m in linear.modes() if m.kind != "rigid"]
    ours += [z.conjugate() for z in ours if z.imag > 0.0]
    theirs = np.linalg.eigvals(linear.A)
    # The rest are zeros, which rounding scatters.
    theirs = theirs[np.argsort(-np.abs(theirs))]
    size = np.abs(theirs).max()
    assert np.abs(theirs[len(ours) :]).max(initial=0.0) < 1e-6 * size
    for z in ours:
        assert np.abs(theirs - z).min() < 1e-9 * size


@pytest.mark.parametrize("path", ROBOTS, ids=NAMES)
def test_a_response_is_that_of_the_linear_model(path: Path) -> None:
    robot = load(path)
    q = pose(robot)
    linear = robot.linearize(q, outputs=["motor_position", "link_position"], friction="viscous")
    joints = len(robot.joint_names)
    for i, joint in enumerate(robot.joint_names):
        response = robot.frequency_response(joint, q, start=0.3, stop=400.0, points=20, friction="viscous")
        for f, motor, link in zip(response.frequency, response.motor, response.link, strict=True):
            shifted = 2j * np.pi * f * np.eye(len(linear.states)) - linear.A
            y = linear.C @ np.linalg.solve(shifted, linear.B[:, i].astype(complex)) + linear.D[:, i]
            np.testing.assert_allclose([motor, link], [y[i], y[joints + i]], rtol=1e-7, atol=1e-9 * abs(motor))


@pytest.mark.parametrize("floating", [False, True], ids=["fixed", "floating"])
def test_a_moving_state_is_linearized_as_forward_dynamics_changes(arm_file: Path, floating: bool) -> None:
    robot = load(arm_file, floating=floating)
    rng = np.random.default_rng(6)
    state = random_state(robot, rng)
    tau = rng.normal(size=robot.nv)
    linear = robot.linearize(**state, tau=tau, outputs="link_velocity")
    half = len(linear.states) // 2
    step = 1e-6
    for k in range(robot.nv):
        after, before = (
            robot.forward_dynamics(**(state | {"qd": state["qd"] + sign * step * np.eye(robot.nv)[k]}), tau=tau)[0]
            for sign in (1.0, -1.0)
        )
        column = linear.A[half : half + robot.nv, half + k]
        np.testing.assert_allclose(column, (after - before) / (2.0 * step), rtol=1e-5, atol=1e-5 * np.abs(linear.A).max())


def test_the_pose_that_torques_hold_is_found(arm: gyroflex.Robot) -> None:
    there = arm.linearize([0.4, 0.3, 0.1])
    found = arm.linearize([0.41, 0.29, 0.11], tau=there.tau)
    np.testing.assert_allclose(found.tau, there.tau, rtol=1e-9, atol=1e-9)
    qdd, thetadd = arm.forward_dynamics(found.q, found.qd, found.theta, found.thetad, found.tau)
    np.testing.assert_allclose(np.concatenate([qdd, thetadd]), 0.0, atol=1e-6)


def test_bad_arguments_are_named(arm: gyroflex.Robot) -> None:
    def problem(call: Any, *arguments: Any, **named: Any) -> tuple[str, str]:
        with pytest.raises(gyroflex.Error) as caught:
            call(*arguments, **named)
        assert caught.value.remedy
        return caught.value.element, f"{caught.value.problem} {caught.value.remedy}"

    q = np.zeros(arm.nq)
    for named, words in [
        ({"outputs": ["motor_positon"]}, ("outputs", "motor_position")),
        ({"outputs": []}, ("outputs", "at least one")),
        ({"outputs": [1, 2]}, ("outputs", "names")),
        ({"outputs": "pose:tol"}, ("outputs", "tool")),
        ({"friction": "dry"}, ("friction", "viscous")),
        ({"model": "spong"}, ("model", "complete")),
        ({"theta": q}, ("theta", "qd")),
        ({"qd": q}, ("theta", "missing")),
        ({"qd": q, "theta": q, "thetad": q}, ("tau", "missing")),
        ({"tau": [1e9, 0, 0]}, ("tau", "shoulder")),
        ({"q": [0.0, np.nan, 0.0]}, ("q", "finite")),
    ]:
        element, text = problem(arm.linearize, **named)
        assert words[0] in element and words[1] in text, (named, element, text)
    assert "shoulder" in problem(arm.frequency_response, "sholder")[1]
    for named in ({"points": 1}, {"points": 10**12}, {"start": -1.0}, {"start": 5.0, "stop": 2.0}, {"stop": np.inf}):
        problem(arm.frequency_response, "shoulder", **named)
    linear = arm.linearize()
    for step in (0.0, -1.0, np.nan):
        assert "step" in problem(linear.zero_order_hold, step)[0]
    sampled = linear.zero_order_hold(1e-3)
    problem(sampled.modes)
    problem(sampled.zero_order_hold, 1e-3)
