"""The inverse of elastic robots: against forward dynamics, against integration, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import gyroflex
import numpy as np
import pytest
from conftest import MODELS, YAML, random_state

ELASTIC = MODELS[:2]


@pytest.fixture(params=[False, True], ids=["fixed", "floating"])
def robot(request: pytest.FixtureRequest, arm_file: Path) -> gyroflex.Robot:
    return gyroflex.Robot.load(arm_file, floating=request.param)


@pytest.fixture(scope="session")
def undamped(arm_file: Path) -> gyroflex.Robot:
    file = arm_file.parent / "undamped.yaml"
    file.write_text(YAML.replace(", damping: 4.0", "").replace(", damping: 2.0", ""))
    return gyroflex.Robot.load(file)


def motion(robot: gyroflex.Robot, rng: np.random.Generator, **wanted: object) -> tuple[np.ndarray, np.ndarray]:
    """Random positions, and as many random derivatives as the inverse needs."""
    order = max(robot.smoothness(**wanted).values())  # type: ignore[arg-type]
    return random_state(robot, rng)["q"], rng.normal(size=(order, robot.nv))


def assert_forward_dynamics_returns(
    robot: gyroflex.Robot,
    q: np.ndarray,
    derivatives: np.ndarray,
    found: gyroflex.ElasticInverse,
    **options: object,
) -> None:
    state = {"theta": found.theta, "thetad": found.thetad, "tau": found.tau}
    qdd, thetadd = robot.forward_dynamics(q, derivatives[0], **state, **options)  # type: ignore[arg-type]
    for got, want in ((qdd, derivatives[1]), (thetadd, found.thetadd)):
        np.testing.assert_allclose(got, want, rtol=0, atol=1e-9 * max(1.0, np.abs(want).max()))


@pytest.mark.parametrize("model", MODELS)
def test_forward_dynamics_returns_the_accelerations(robot: gyroflex.Robot, model: str) -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        q, derivatives = motion(robot, rng, model=model)
        load = rng.normal(size=robot.nv)
        found = robot.elastic_inverse(q, derivatives, model=model, tau_ext=load)
        assert_forward_dynamics_returns(robot, q, derivatives, found, model=model, tau_ext=load)


@pytest.mark.parametrize("model", ELASTIC)
def test_forward_dynamics_returns_the_accelerations_without_damping(undamped: gyroflex.Robot, model: str) -> None:
    rng = np.random.default_rng(2)
    for _ in range(20):
        q, derivatives = motion(undamped, rng, model=model)
        found = undamped.elastic_inverse(q, derivatives, model=model)
        assert_forward_dynamics_returns(undamped, q, derivatives, found, model=model)


def test_reduced_and_damped_models_need_fewer_derivatives(arm: gyroflex.Robot, undamped: gyroflex.Robot) -> None:
    assert list(arm.smoothness()) == arm.joint_names
    assert set(arm.smoothness("reduced").values()) == {3}
    assert set(undamped.smoothness("reduced").values()) == {4}
    for model in ("rigid", "rigid_reflected"):
        assert set(undamped.smoothness(model).values()) == {2}
    for robot in (arm, undamped):
        assert max(robot.smoothness().values()) > max(robot.smoothness("reduced").values())
    assert max(undamped.smoothness().values()) > max(arm.smoothness().values())
    assert undamped.smoothness(damping=3.0) == arm.smoothness()
    assert all(more == less + 2 for more, less in zip(arm.smoothness(None, 2).values(), arm.smoothness().values()))


def test_a_floating_root_is_among_the_joints(arm_file: Path) -> None:
    robot = gyroflex.Robot.load(arm_file, floating=True)
    assert list(robot.smoothness()) == ["root", *robot.joint_names]


def test_derivatives_of_torques_are_their_rates(undamped: gyroflex.Robot) -> None:
    q, derivatives = motion(undamped, np.random.default_rng(3), torque_derivatives=2)
    found = undamped.elastic_inverse(q, derivatives, torque_derivatives=2)
    assert found.tau.shape == (3,)
    assert found.tau_derivatives.shape == found.tau_j_derivatives.shape == (2, 3)

    def later(t: float) -> gyroflex.ElasticInverse:
        """The inverse on the polynomial that has these derivatives now."""
        rows = np.array([q, *derivatives])
        powers = [t**k / np.prod(np.arange(1.0, k + 1)) for k in range(len(rows))]
        moved = [sum(p * row for p, row in zip(powers, rows[k:])) for k in range(len(rows))]
        return undamped.elastic_inverse(moved[0], moved[1:], torque_derivatives=2)

    h = 1e-4
    there, back = later(h), later(-h)
    for value, rates in (("tau", "tau_derivatives"), ("tau_j", "tau_j_derivatives")):
        rows = [np.vstack([getattr(at, value), getattr(at, rates)]) for at in (there, back)]
        differences = (rows[0] - rows[1])[:2] / (2 * h)
        exact = getattr(found, rates)
        np.testing.assert_allclose(differences, exact, atol=1e-5 * np.abs(exact).max())


def test_the_deflection_is_a_state_that_follows_its_own_rate(arm: gyroflex.Robot) -> None:
    q, derivatives = motion(arm, np.random.default_rng(4))
    start = np.array([1e-3, -2e-3, 0.0])
    step = 1e-6
    now = arm.elastic_inverse(q, derivatives, deflection=start)
    np.testing.assert_array_equal(now.deflection, start)
    np.testing.assert_allclose(now.theta[:2], q[:2] + start[:2], rtol=0, atol=1e-15)
    after = arm.elastic_inverse(q, derivatives, deflection=start, step=step).deflection
    rate = now.deflection_rate
    np.testing.assert_allclose((after - start) / step, rate, rtol=1e-2, atol=1e-12)
    # D δ̇ = τ_J − k(δ), with the numbers of the arm's file.
    spring = np.array([8e3, 3e3]) * start[:2] + np.array([0.0, 1e5]) * start[:2] ** 3
    np.testing.assert_allclose(np.array([4.0, 2.0]) * rate[:2], now.tau_j[:2] - spring, atol=1e-9)


def test_without_a_deflection_the_transmissions_are_at_rest(arm: gyroflex.Robot) -> None:
    q = np.array([0.3, -0.5, 0.1])
    load = np.array([1.0, -2.0, 0.5])
    order = max(arm.smoothness().values())
    still = arm.elastic_inverse(q, np.zeros((order, 3)), tau_ext=load)
    np.testing.assert_allclose(still.deflection_rate, 0.0, atol=1e-12)
    np.testing.assert_allclose(still.tau_j, arm.gravity_torques(q) - load, atol=1e-12)
    np.testing.assert_allclose(still.thetadd, 0.0, atol=1e-9)


def test_damping_that_is_added_is_in_the_torques(undamped: gyroflex.Robot, arm_file: Path) -> None:
    file = arm_file.parent / "damped.yaml"
    file.write_text(YAML.replace("damping: 4.0", "damping: 3.0").replace("damping: 2.0", "damping: 3.0"))
    damped = gyroflex.Robot.load(file)
    q, derivatives = motion(damped, np.random.default_rng(5))
    added = undamped.elastic_inverse(q, derivatives, damping=3.0)
    np.testing.assert_array_equal(added.tau, damped.elastic_inverse(q, derivatives).tau)
    with pytest.raises(gyroflex.ShapeError):
        undamped.elastic_inverse(q, derivatives)


def test_loads_may_come_with_their_rates(undamped: gyroflex.Robot) -> None:
    rng = np.random.default_rng(6)
    q, derivatives = motion(undamped, rng)
    load = rng.normal(size=3)
    held = undamped.elastic_inverse(q, derivatives, tau_ext=load)
    rows = undamped.elastic_inverse(q, derivatives, tau_ext=np.array([load, np.zeros(3)]))
    np.testing.assert_array_equal(held.tau, rows.tau)
    changing = undamped.elastic_inverse(q, derivatives, tau_ext=np.array([load, [1.0, 0.0, 0.0]]))
    # θ̇ is q̇ plus the rate of τ_J / K, here by a load that grows.
    np.testing.assert_allclose((changing.thetad - held.thetad)[0], -1.0 / 8e3, rtol=1e-9)


def test_calls_leave_nothing_behind(arm: gyroflex.Robot) -> None:
    rng = np.random.default_rng(7)
    q, derivatives = motion(arm, rng)
    first = arm.elastic_inverse(q, derivatives).tau
    arm.elastic_inverse(*motion(arm, rng), deflection=rng.normal(size=3), step=1e-3)
    with pytest.raises(gyroflex.DivergedError, match="joint `"):
        arm.elastic_inverse(q, np.full_like(derivatives, 1e200))
    for damping in np.linspace(0.0, 1.0, 20):
        arm.elastic_inverse(q, derivatives, damping=damping)
    np.testing.assert_array_equal(arm.elastic_inverse(q, derivatives).tau, first)


def test_too_few_derivatives_are_listed_joint_by_joint(undamped: gyroflex.Robot) -> None:
    needed = undamped.smoothness()
    with pytest.raises(gyroflex.ShapeError) as caught:
        undamped.elastic_inverse(np.zeros(3), np.zeros((3, 3)))
    assert caught.value.element == "argument `derivatives`"
    for joint, order in needed.items():
        assert (f"`{joint}` needs {order} and has 3" in caught.value.problem) == (order > 3)
    assert f"shape ({max(needed.values())}, 3)" in caught.value.remedy
    with pytest.raises(gyroflex.ShapeError, match="has 0"):
        undamped.elastic_inverse(np.zeros(3), np.zeros((0, 3)))


@pytest.mark.parametrize(
    ("value", "given"), [(np.zeros(9), "(9,)"), (np.zeros((8, 2)), "(8, 2)"), (np.zeros((2, 2, 2, 3)), "(2, 2, 2, 3)")]
)
def test_derivatives_of_the_wrong_shape_are_named(arm: gyroflex.Robot, value: np.ndarray, given: str) -> None:
    with pytest.raises(gyroflex.ShapeError) as caught:
        arm.elastic_inverse(np.zeros(3), value)
    assert caught.value.element == "argument `derivatives`"
    assert f"shape {given} is given, but (any number, 3) is expected" in caught.value.problem


def test_arguments_without_meaning_are_named(arm: gyroflex.Robot) -> None:
    q, derivatives = np.zeros(3), np.zeros((8, 3))
    for name, value in (("step", -1e-3), ("step", np.nan), ("damping", -1.0), ("damping", np.inf)):
        with pytest.raises(gyroflex.ArgumentError, match=f"argument `{name}`"):
            arm.elastic_inverse(q, derivatives, **{name: value})  # type: ignore[arg-type]
    with pytest.raises(gyroflex.ShapeError, match="argument `deflection`"):
        arm.elastic_inverse(q, derivatives, deflection=np.zeros(4))
    with pytest.raises(gyroflex.ShapeError, match="argument `tau_ext`"):
        arm.elastic_inverse(q, derivatives, tau_ext=np.zeros((2, 4)))
    derivatives[2, 1] = np.nan
    with pytest.raises(gyroflex.NotFiniteError, match=r"argument `derivatives`, entry \[2, 1\]"):
        arm.elastic_inverse(q, derivatives)
    with pytest.raises(gyroflex.ModelError, match="coefficients"):
        arm.elastic_inverse(q, np.zeros((8, 3)), torque_derivatives=100)


def test_messages_over_time_name_the_time(arm: gyroflex.Robot) -> None:
    order = max(arm.smoothness().values())

    def spoiled(shape: tuple[int, ...], value: float) -> np.ndarray:
        array = np.zeros(shape)
        array[2] = value
        return array

    right = {"q": np.zeros((4, 3)), "derivatives": np.zeros((4, order, 3))}
    for name, shape in (("q", (4, 3)), ("derivatives", (4, order, 3)), ("tau_ext", (4, 3)), ("tau_ext", (4, 2, 3))):
        with pytest.raises(gyroflex.NotFiniteError, match=rf"argument `{name}\[2\]`, entry "):
            arm.elastic_inverse(**(right | {name: spoiled(shape, np.nan)}), step=1e-3)
    with pytest.raises(gyroflex.DivergedError, match="joint `.*`: at time 2: "):
        arm.elastic_inverse(right["q"], spoiled((4, order, 3), 1e200), step=1e-3)
    with pytest.raises(gyroflex.ShapeError, match=rf"shape \(4, {order}, 3\)"):
        arm.elastic_inverse(right["q"], np.zeros((4, 1, 3)), step=1e-3)
    with pytest.raises(gyroflex.ShapeError, match=r"\(3,\) or \(times, 3\) is expected"):
        arm.elastic_inverse(np.zeros(4), np.zeros((order, 3)))


def test_more_derivatives_than_are_counted_are_refused(arm: gyroflex.Robot) -> None:
    fewest = min(arm.smoothness(torque_derivatives=100).values())
    assert fewest >= 100
    for many in (250, 255, 300, 10**30, -1):
        if many == 250:
            assert max(arm.smoothness(torque_derivatives=many).values()) < 255
            continue
        with pytest.raises(gyroflex.ArgumentError, match="argument `torque_derivatives`"):
            arm.smoothness(torque_derivatives=many)
        with pytest.raises(gyroflex.ArgumentError, match="argument `torque_derivatives`"):
            arm.elastic_inverse(np.zeros(3), np.zeros((8, 3)), torque_derivatives=many)
