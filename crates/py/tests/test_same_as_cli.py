"""Python and `gyroflex eval` give the same numbers, to the last bit."""

from __future__ import annotations

import json
import subprocess
import warnings
from pathlib import Path

import gyroflex
import numpy as np
import pytest
from conftest import MODELS, PROJECT, random_state

ROBOTS = sorted(PROJECT.glob("robots/*/robot.yaml"))
STATES = 10


def run_eval(binary: Path, robot: Path, text: str, *options: str) -> subprocess.CompletedProcess[str]:
    command = [binary, "eval", robot, "--state", "-", *options]
    return subprocess.run(command, input=text, capture_output=True, text=True, check=False)


def load(path: Path, *, floating: bool = False) -> gyroflex.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gyroflex.RobotWarning)
        return gyroflex.Robot.load(path, floating=floating)


def evaluate(binary: Path, robot: Path, lines: list[dict[str, object]], *options: str) -> list[dict[str, list]]:
    """What `gyroflex eval` answers to each line."""
    done = run_eval(binary, robot, "".join(json.dumps(line) + "\n" for line in lines), *options)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def assert_same_bits(ours: np.ndarray, theirs: list) -> None:
    theirs_array = np.array(theirs, dtype=float)
    assert ours.shape == theirs_array.shape
    assert ours.tobytes() == theirs_array.tobytes()


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("path", ROBOTS, ids=[p.parent.name for p in ROBOTS])
def test_eval_gives_the_same_bits(binary: Path, path: Path, model: str) -> None:
    compare(binary, path, load(path), model)


@pytest.mark.parametrize("model", MODELS)
def test_eval_gives_the_same_bits_of_a_floating_robot(binary: Path, arm_file: Path, model: str) -> None:
    compare(binary, arm_file, load(arm_file, floating=True), model, "--floating")


def compare(binary: Path, path: Path, robot: gyroflex.Robot, model: str, *options: str) -> None:
    rng = np.random.default_rng(11)
    states = [random_state(robot, rng) for _ in range(STATES)]
    tau, qdd, thetadd, tau_ext = rng.normal(size=(4, STATES, robot.nv))
    forward = [s | {"tau": tau[i], "tau_ext": tau_ext[i]} for i, s in enumerate(states)]
    inverse = [s | {"qdd": qdd[i], "thetadd": thetadd[i]} for i, s in enumerate(states)]

    n = len(robot.mode_names)
    tau_ext[:, robot.nv - n :] = 0.0
    # Python's calls without constraints are of the tree of joints alone.
    lines = [
        {key: value.tolist() for key, value in apart(query, n).items()} | {"held": []} for query in forward + inverse
    ]
    answers = evaluate(binary, path, lines, "--model", model, "--matrices", *options)
    assert len(answers) == 2 * STATES
    for query, answer in zip(forward, answers[:STATES], strict=True):
        result = robot.forward_dynamics(**query, model=model)
        assert_same_bits(result[0], answer["qdd"] + answer.get("etadd", []))
        assert_same_bits(result[1][: robot.nv - n], answer["thetadd"])
        assert_same_bits(robot.mass_matrix(query["q"], model=model), answer["M"])
        assert_same_bits(robot.coupling_matrix(query["q"], model=model), answer["S"])
    for query, answer in zip(inverse, answers[STATES:], strict=True):
        result = robot.inverse_dynamics(**query, model=model)
        assert_same_bits(result[0][: robot.nv - n], answer["tau_j"])
        assert_same_bits(result[1], answer["tau"] + answer.get("tau_eta", []))


def apart(query: dict[str, np.ndarray], modes: int) -> dict[str, np.ndarray]:
    """`eval` has keys of their own for the modes of links that bend."""
    if modes == 0:
        return query
    own = {"q": "eta", "qd": "etad", "qdd": "etadd", "tau": "tau_eta"}
    return {key: value[:-modes] for key, value in query.items()} | {
        own[key]: value[-modes:] for key, value in query.items() if key in own
    }


def test_eval_gives_the_same_numbers_of_a_robot_that_is_held(binary: Path) -> None:
    path = PROJECT / "robots" / "biped5_elastic" / "robot.yaml"
    robot, rng = load(path), np.random.default_rng(12)
    feet = ["left_foot", "right_foot"]
    passive = ["hip_x", "hip_z", "trunk_pitch"]
    for _ in range(STATES):
        s = random_state(robot, rng)
        tau, qdd, thetadd = rng.normal(size=(3, robot.nv))
        weights, wanted = rng.uniform(0.5, 2.0, robot.nv), rng.normal(size=6)
        held = [
            gyroflex.Constraint.frame(foot, at_xyz=tuple(robot.placement(foot, s["q"])[:3, 3]), directions="point", stabilisation=100.0)
            for foot in feet
        ]
        state = {key: value.tolist() for key, value in s.items()} | {"held": feet}
        share = {"torques": weights.tolist(), "multipliers": [1e-3] * 6, "wanted": wanted.tolist(), "passive": passive}
        forward, inverse = evaluate(
            binary,
            path,
            [
                state | {"tau": tau.tolist()},
                state | {"qdd": qdd.tolist(), "thetadd": thetadd.tolist(), "distribution": share},
            ],
        )
        motion = robot.constrained_forward_dynamics(**s, tau=tau, constraints=held)
        np.testing.assert_allclose(forward["qdd"], motion.qdd, rtol=1e-6, atol=1e-4)
        # What moves sideways in no direction depends on nothing that could bear it.
        assert forward["dependent"] == motion.dependent == 2
        torques = robot.constrained_inverse_dynamics(
            s["q"], s["qd"], qdd, s["theta"], s["thetad"], thetadd,
            constraints=held, passive=passive, torque_weights=weights, multiplier_weights=np.full(6, 1e-3), wanted=wanted,
        )
        assert inverse["unborne"] == pytest.approx(torques.unborne, rel=1e-6, abs=1e-9)
        np.testing.assert_allclose(inverse["tau"], torques.tau, rtol=1e-9, atol=1e-9)
        for k, told in enumerate(inverse["held"]):
            np.testing.assert_allclose(told["moment"] + told["force"], torques.wrenches[k], rtol=1e-9, atol=1e-9)


def test_eval_holds_what_the_file_of_the_robot_holds(binary: Path) -> None:
    path = PROJECT / "robots" / "four_bar" / "robot.yaml"
    robot, rng = load(path), np.random.default_rng(13)
    assert list(robot.constraints) == ["loop"]
    for _ in range(STATES):
        s, tau = random_state(robot, rng), rng.normal(size=robot.nv)
        line = {key: value.tolist() for key, value in (s | {"tau": tau}).items()}
        motion = robot.constrained_forward_dynamics(**s, tau=tau, constraints=list(robot.constraints.values()))
        (answer,) = evaluate(binary, path, [line])
        assert_same_bits(motion.qdd, answer["qdd"])
        assert_same_bits(motion.multipliers, answer["held"][0]["multipliers"])


def test_there_are_robots_to_compare() -> None:
    assert len(ROBOTS) >= 5


def test_python_names_joints_as_info_does(binary: Path) -> None:
    for path in ROBOTS:
        done = subprocess.run([binary, "info", path, "--json"], capture_output=True, text=True, check=True)
        assert [joint["name"] for joint in json.loads(done.stdout)["joints"]] == list(load(path).joint_names)


def test_both_refuse_a_robot_in_the_same_words(binary: Path, arm_file: Path, tmp_path: Path) -> None:
    path = tmp_path / "robot.urdf"
    urdf = (arm_file.parent / "elastic_arm.urdf").read_text()
    path.write_text(urdf.replace('<mass value="0.6"/>', '<mass value="-0.6"/>'))
    with pytest.raises(gyroflex.ModelError) as caught:
        load(path)
    done = run_eval(binary, path, "")
    assert done.returncode == 1
    assert caught.value.problem in done.stderr
