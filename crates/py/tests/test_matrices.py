"""Matrices, derivatives, regressor and frames: against each other and against differences."""

from __future__ import annotations

import warnings
from pathlib import Path

import gyroflex
import numpy as np
import pytest
from conftest import MODELS, random_state

STEP = 1e-6


@pytest.fixture
def arm(arm_file: Path) -> gyroflex.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gyroflex.RobotWarning)
        return gyroflex.Robot.load(arm_file)


@pytest.mark.parametrize("model", MODELS)
def test_rates_of_inertia_are_the_symmetric_part_of_coriolis(arm: gyroflex.Robot, model: str) -> None:
    s = random_state(arm, np.random.default_rng(3))
    c, c1, c2 = arm.coriolis_matrices(s["q"], s["qd"], s["thetad"], model=model)
    dm, ds = arm.inertia_rates(s["q"], s["qd"], model=model)
    np.testing.assert_allclose(c + c.T, dm, atol=1e-12)
    np.testing.assert_allclose(c1 + c2.T, ds, atol=1e-12)
    later = arm.mass_matrix(s["q"] + STEP * s["qd"], model=model)
    sooner = arm.mass_matrix(s["q"] - STEP * s["qd"], model=model)
    np.testing.assert_allclose((later - sooner) / (2 * STEP), dm, atol=1e-8)


@pytest.mark.parametrize("model", MODELS)
def test_bias_is_made_of_coriolis_and_gravity(arm: gyroflex.Robot, model: str) -> None:
    s = random_state(arm, np.random.default_rng(4))
    c, c1, c2 = arm.coriolis_matrices(s["q"], s["qd"], s["thetad"], model=model)
    link, motor = arm.bias(s["q"], s["qd"], s["thetad"], model=model)
    np.testing.assert_allclose(link, c @ s["qd"] + c1 @ s["thetad"] + arm.gravity_torques(s["q"]), atol=1e-12)
    np.testing.assert_allclose(motor, c2 @ s["qd"], atol=1e-12)


@pytest.mark.parametrize("model", MODELS)
def test_derivatives_equal_differences(arm: gyroflex.Robot, model: str) -> None:
    rng = np.random.default_rng(5)
    s = random_state(arm, rng)
    tau, qdd, thetadd = rng.normal(size=(3, arm.nv))
    forward = s | {"tau": tau}
    inverse = {key: s[key] for key in ("q", "qd")} | {"qdd": qdd, "theta": s["theta"], "thetad": s["thetad"]}
    inverse |= {"thetadd": thetadd}
    for call, derivatives, arguments in (
        (arm.forward_dynamics, arm.forward_derivatives, forward),
        (arm.inverse_dynamics, arm.inverse_derivatives, inverse),
    ):
        blocks = derivatives(**arguments, model=model)
        assert [b.shape for b in blocks] == [(len(arguments), arm.nv, arm.nv)] * 2
        for at, key in enumerate(["q", "qd", *list(arguments)[2:]]):
            for column in range(arm.nv):
                there, back = dict(arguments), dict(arguments)
                there[key] = arguments[key] + STEP * np.eye(arm.nv)[column]
                back[key] = arguments[key] - STEP * np.eye(arm.nv)[column]
                ends = zip(call(**there, model=model), call(**back, model=model), strict=True)
                for block, (a, b) in zip(blocks, ends, strict=True):
                    scale = max(1.0, np.abs(block[at]).max())
                    np.testing.assert_allclose(block[at][:, column], (a - b) / (2 * STEP), atol=1e-6 * scale)


@pytest.mark.parametrize("model", MODELS)
def test_regressor_times_parameters_is_inverse_dynamics(arm: gyroflex.Robot, model: str) -> None:
    rng = np.random.default_rng(6)
    s = random_state(arm, rng)
    qdd, thetadd = rng.normal(size=(2, arm.nv))
    motion = (s["q"], s["qd"], qdd, s["theta"], s["thetad"], thetadd)
    link, _, motor = arm.regressor(*motion, model=model)
    parameters = arm.parameters(model=model)
    tau_j, tau = arm.inverse_dynamics(*motion, model=model)
    np.testing.assert_allclose(link @ parameters, tau_j, atol=1e-10)
    # The arm's gears are free of transmission errors.
    np.testing.assert_allclose(tau_j + motor @ parameters, tau, atol=1e-10)


def test_force_on_a_frame_accelerates_it_as_its_inertia_says(arm: gyroflex.Robot) -> None:
    s = random_state(arm, np.random.default_rng(7))
    still = np.zeros(arm.nv)
    space = arm.operational_space("tool", s["q"], still, still, directions=["x", "y", "z"], model="rigid")
    force = np.array([1.0, -2.0, 3.0])
    torque = arm.gravity_torques(s["q"]) + space["jacobian"].T @ force
    qdd, _ = arm.forward_dynamics(s["q"], still, tau=torque, model="rigid")
    np.testing.assert_allclose(space["inertia"] @ space["jacobian"] @ qdd, force, atol=1e-9)
    np.testing.assert_allclose(space["jacobian"] @ space["inverse"], np.eye(3), atol=1e-12)
    np.testing.assert_allclose(space["gravity_force"], space["inverse"].T @ arm.gravity_torques(s["q"]), atol=1e-10)
    assert 0 < space["smallest"] <= space["largest"]


def test_frames_that_do_not_exist_or_move_are_refused(arm: gyroflex.Robot) -> None:
    still = np.zeros(arm.nv)
    with pytest.raises(gyroflex.ArgumentError, match="nearest known one is `tool`"):
        arm.operational_space("tol", still, still, still)
    with pytest.raises(gyroflex.ArgumentError, match="does not move"):
        arm.operational_space("base", still, still, still)
    with pytest.raises(gyroflex.ArgumentError, match="directions"):
        arm.operational_space("tool", still, still, still, directions=["w"])
