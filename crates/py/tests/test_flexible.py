"""Links that bend: names, lengths, and what Python computes of them."""

from __future__ import annotations

from pathlib import Path

import gyroflex
import numpy as np
import pytest
from conftest import PROJECT

ARM = PROJECT / "robots/book_two_link/robot.yaml"


@pytest.fixture
def arm() -> gyroflex.Robot:
    return gyroflex.Robot.load(ARM)


def test_modes_follow_the_joints(arm: gyroflex.Robot) -> None:
    assert arm.mode_names == ["upper.bending_y1", "upper.bending_y2", "lower.bending_y1", "lower.bending_y2"]
    assert (arm.nq, arm.nv, len(arm.joint_names)) == (6, 6, 2)
    joints = np.array([0.3, -0.4])
    straight = np.concatenate([joints, np.zeros(4)])
    np.testing.assert_array_equal(arm.mass_matrix(joints), arm.mass_matrix(straight))


def test_inverse_dynamics_returns_what_forward_dynamics_was_given(arm: gyroflex.Robot) -> None:
    rng = np.random.default_rng(3)
    q, qd, tau = rng.normal(size=(3, arm.nv)) * np.array([1, 1, 0.02, 0.02, 0.02, 0.02])
    qdd, _ = arm.forward_dynamics(q, qd, tau=tau)
    _, back = arm.inverse_dynamics(q, qd, qdd)
    np.testing.assert_allclose(back, tau, atol=1e-9)


def test_the_inertia_matrix_and_the_coriolis_matrix_belong_together(arm: gyroflex.Robot) -> None:
    rng = np.random.default_rng(4)
    q, qd = rng.normal(size=(2, arm.nv)) * np.array([1, 1, 0.02, 0.02, 0.02, 0.02])
    rate, _ = arm.inertia_rates(q, qd)
    c, _, _ = arm.coriolis_matrices(q, qd)
    np.testing.assert_allclose(c + c.T, rate, atol=1e-12 * np.abs(rate).max())
    link, _ = arm.bias(q, qd)
    np.testing.assert_allclose(c @ qd + arm.gravity_torques(q), link, atol=1e-10)


def test_a_linear_model_names_its_modes(arm: gyroflex.Robot) -> None:
    linear = arm.linearize([0.2, 0.1])
    assert linear.states[:3] == ["q.joint1", "q.joint2", "eta.upper.bending_y1"]
    swings = [mode for mode in arm.modes([0.2, 0.1]) if mode.kind == "oscillation"]
    assert len(swings) == 4


def test_a_simulation_has_modes_and_tips(tmp_path: Path) -> None:
    scenario = tmp_path / "swing.yaml"
    scenario.write_text(
        f"robot: {ARM}\nduration: 0.02\ninitial: {{qd: {{joint1: 1.0}}}}\n"
        "log: {rate: 1000}\nintegrator: {method: rk4, step: 1.0e-4}\n"
    )
    result = gyroflex.simulate(scenario)
    samples = len(result["time"])
    assert result["eta"].shape == result["etadd"].shape == (samples, 4)
    assert result["tip"].shape == (samples, 12)
    assert result.units["tip"][:4] == ("m", "m", "m", "rad")


def test_what_knows_rigid_links_only_says_so(arm: gyroflex.Robot) -> None:
    rest = np.zeros(arm.nv)
    for call in (
        lambda: arm.forward_derivatives(rest, rest, tau=rest),
        lambda: arm.parameters(),
        lambda: arm.smoothness(),
        lambda: arm.analyze(),
    ):
        with pytest.raises(gyroflex.ModelError, match="flexible_links.upper: the link bends"):
            call()
