"""Batches say row by row what single calls say, in any memory layout, and rollouts are steps one after the other."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import gyroflex
import numpy as np
import pytest
from batches import CALLS, ROWS, agree, batch_of, results
from conftest import MODELS, random_state

@pytest.fixture(params=["fixed", "floating"])
def robot(request: pytest.FixtureRequest, arm_file: Path) -> gyroflex.Robot:
    return gyroflex.Robot.load(arm_file, floating=request.param == "floating")


@pytest.mark.parametrize("name", CALLS)
def test_a_batch_is_the_single_calls_row_by_row(robot: gyroflex.Robot, name: str) -> None:
    call, names = CALLS[name]
    batch = {n: a for n, a in batch_of(robot).items() if n in names}
    one = [results(call(robot, **{n: a[i] for n, a in batch.items()})) for i in range(ROWS)]
    agree(call(robot, **batch), one)
    strided = {n: np.asfortranarray(np.repeat(a, 2, axis=0)[::2]) for n, a in batch.items()}
    agree(call(robot, **strided), one)


@pytest.mark.parametrize("name", CALLS)
def test_results_go_where_out_says(arm: gyroflex.Robot, name: str) -> None:
    call, names = CALLS[name]
    batch = {n: a for n, a in batch_of(arm, 20).items() if n in names}
    for given in (batch, {n: a[0] for n, a in batch.items()}):
        expected = call(arm, **given)
        room = [np.full_like(a, np.nan) for a in results(expected)]
        out = tuple(room) if isinstance(expected, tuple) else room[0]
        answer = call(arm, **given, out=out)
        for a, b, given_array in zip(results(expected), results(answer), room, strict=True):
            np.testing.assert_array_equal(a, b)
            np.testing.assert_array_equal(a, given_array)


@pytest.mark.parametrize("model", MODELS)
def test_one_row_stands_for_all(arm: gyroflex.Robot, model: Any) -> None:
    batch = batch_of(arm)
    given = {n: batch[n] for n in ("q", "qd", "theta", "thetad", "tau")}
    for name in given:
        mixed = {n: a if n == name else a[0] for n, a in given.items()}
        whole = {n: np.broadcast_to(a, (ROWS, arm.nv)) for n, a in mixed.items()}
        for a, b in zip(
            arm.forward_dynamics(**mixed, model=model), arm.forward_dynamics(**whole, model=model), strict=True
        ):
            np.testing.assert_array_equal(a, b)


def test_single_precision_stays_single_precision(arm: gyroflex.Robot) -> None:
    batch = {n: batch_of(arm)[n] for n in ("q", "qd", "qdd")}
    single = {n: a.astype(np.float32) for n, a in batch.items()}
    exact = arm.inverse_dynamics(**{n: a.astype(np.float64) for n, a in single.items()}, model="rigid")
    for a, b in zip(arm.inverse_dynamics(**single, model="rigid"), exact, strict=True):
        assert a.dtype == np.float32
        np.testing.assert_allclose(a, b, rtol=0, atol=3e-5 * np.abs(b).max())
    mixed = single | {"qd": batch["qd"]}
    assert arm.inverse_dynamics(**mixed, model="rigid")[0].dtype == np.float64
    row = {n: a[0] for n, a in single.items()}
    assert arm.inverse_dynamics(**row, model="rigid")[0].dtype == np.float32


def test_eight_threads_get_the_same_bits_of_a_batch(arm: gyroflex.Robot) -> None:
    batch = {n: batch_of(arm)[n] for n in ("q", "qd", "theta", "thetad", "tau")}

    def run(_: int) -> bytes:
        return np.asarray(arm.forward_dynamics(**batch)).tobytes()

    with ThreadPoolExecutor(8) as threads:
        assert set(threads.map(run, range(32))) == {run(0)}


def test_an_empty_batch_has_empty_results(arm: gyroflex.Robot) -> None:
    assert arm.mass_matrix(np.empty((0, 3))).shape == (0, 3, 3)


def test_mistakes_in_batches_are_named(arm: gyroflex.Robot) -> None:
    z, many = np.zeros(3), np.zeros((5, 3))
    with pytest.raises(gyroflex.ShapeError, match=r"argument `qd`.*4 rows, but `q` has 5"):
        arm.inertia_rates(many, np.zeros((4, 3)))
    with pytest.raises(gyroflex.ShapeError, match=r"argument `q`.*\(5, 4\).*\(3,\) or \(batch, 3\)"):
        arm.mass_matrix(np.zeros((5, 4)))
    bad = many.copy()
    bad[2, 1] = np.nan
    with pytest.raises(gyroflex.NotFiniteError, match=r"argument `q`, entry \[2, 1\]"):
        arm.mass_matrix(bad)
    for value in (many.astype(complex), many.astype(object), many.astype(str)):
        with pytest.raises(gyroflex.ArgumentError, match="argument `q`"):
            arm.mass_matrix(value)
    with pytest.raises(gyroflex.ArgumentError, match="argument `theta`: it is missing"):
        arm.forward_dynamics(many, z, tau=z)
    with pytest.raises(gyroflex.ArgumentError, match="no link `toool`"):
        arm.jacobian("toool", many)
    with pytest.raises(gyroflex.DivergedError, match=r"`tau_j\[3\]`"):
        arm.inverse_dynamics(z, np.where(np.arange(5) == 3, 1e200, 0.0)[:, None] * np.ones(3), z, model="rigid")


def test_mistakes_in_out_are_named(arm: gyroflex.Robot) -> None:
    many, right = np.zeros((5, 3)), np.empty((5, 3, 3))
    for q, shape in ((many, (5, 3, 3)), (np.zeros(3), (3, 3))):
        locked = np.empty(shape)
        locked.setflags(write=False)
        for out in (np.empty(shape, dtype=np.float32), [1.0], locked):
            with pytest.raises(gyroflex.ArgumentError, match="argument `out`"):
                arm.mass_matrix(q, out=out)  # type: ignore[arg-type]
        with pytest.raises(gyroflex.ShapeError, match=r"argument `out`.*shape \(4,\)"):
            arm.mass_matrix(q, out=np.empty(4))
    with pytest.raises(gyroflex.ArgumentError, match="argument `out`: it is not a tuple of 2 arrays"):
        arm.bias(many, many, many, out=right)
    with pytest.raises(gyroflex.ArgumentError, match="argument `out`"):
        arm.gravity_torques(many, out=many)


def test_the_jacobian_moves_the_frame(robot: gyroflex.Robot) -> None:
    q = random_state(robot, np.random.default_rng(2))["q"]
    h, joint = 1e-6, robot.nv - 1
    step = np.zeros(robot.nq)
    step[-1] = h
    moved = (robot.placement("tool", q + step) - robot.placement("tool", q - step))[:3, 3] / (2 * h)
    np.testing.assert_allclose(robot.jacobian("tool", q)[3:, joint], moved, rtol=0, atol=1e-8)


@pytest.mark.parametrize("integrator", ["semi_implicit_euler", "rk4"])
def test_a_rollout_is_its_steps(arm: gyroflex.Robot, integrator: Any) -> None:
    batch, dt, steps = batch_of(arm, 20), 1e-4, 5
    tau = np.random.default_rng(3).normal(size=(20, steps, arm.nv))
    start = {f"{n}0": batch[n] for n in ("q", "qd", "theta", "thetad")}
    run = arm.rollout(**start, tau=tau, dt=dt, integrator=integrator)
    assert [a.shape for a in run] == [(20, steps + 1, 3)] * 4
    for k in range(steps):
        q, qd, theta, thetad = (a[:, k] for a in run)

        def slope(*x: np.ndarray, k: int = k) -> list[np.ndarray]:
            qdd, thetadd = arm.forward_dynamics(*x, tau[:, k])
            return [x[1], qdd, x[3], thetadd]

        x = [q, qd, theta, thetad]
        # The motor of the sliding joint, which has no drive, turns with it.
        x[2][:, 2], x[3][:, 2] = q[:, 2], qd[:, 2]
        if integrator == "rk4":
            k1 = slope(*x)
            k2 = slope(*(a + 0.5 * dt * b for a, b in zip(x, k1, strict=True)))
            k3 = slope(*(a + 0.5 * dt * b for a, b in zip(x, k2, strict=True)))
            k4 = slope(*(a + dt * b for a, b in zip(x, k3, strict=True)))
            new = [a + dt / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(x, k1, k2, k3, k4, strict=True)]
        else:
            _, qdd, _, thetadd = slope(*x)
            qd, thetad = x[1] + dt * qdd, x[3] + dt * thetadd
            new = [x[0] + dt * qd, qd, x[2] + dt * thetad, thetad]
        for a, b in zip(run, new, strict=True):
            np.testing.assert_allclose(a[:, k + 1], b, rtol=1e-10, atol=1e-10)


def test_a_rollout_that_diverges_leaves_the_others_alone(arm: gyroflex.Robot) -> None:
    z = np.zeros(3)
    tau = np.zeros((4, 50, 3))
    tau[2] = 1e300
    q, *_ = arm.rollout(z, z, tau, 1e-3, theta0=z, thetad0=z)
    assert not np.isfinite(q[2, -1]).all()
    alone, *_ = arm.rollout(z, z, z, 1e-3, theta0=z, thetad0=z, steps=50)
    assert alone.shape == (51, 3)
    np.testing.assert_array_equal(q[3], alone)


def test_mistakes_in_rollouts_are_named(arm: gyroflex.Robot) -> None:
    z = np.zeros(3)
    with pytest.raises(gyroflex.ArgumentError, match="argument `theta0`"):
        arm.rollout(z, z, z, 1e-3, steps=3)
    with pytest.raises(gyroflex.ArgumentError, match="argument `dt`"):
        arm.rollout(z, z, z, 0.0, steps=3)
    with pytest.raises(gyroflex.ArgumentError, match="argument `steps`"):
        arm.rollout(z, z, z, 1e-3)
    with pytest.raises(gyroflex.ShapeError, match="argument `tau`"):
        arm.rollout(z, z, np.zeros((4, 3)), 1e-3, steps=3, model="rigid")
    with pytest.raises(gyroflex.ShapeError, match="argument `tau`.*7 rows"):
        arm.rollout(np.zeros((6, 3)), z, np.zeros((7, 4, 3)), 1e-3, model="rigid")


def test_a_changed_copy_is_the_robot_of_the_changed_file(arm: gyroflex.Robot, arm_file: Path, tmp_path: Path) -> None:
    changed = arm.with_(
        stiffness={"shoulder": 1e4}, ratio={"elbow": 50.0}, rotor_inertia={"elbow": 3e-4}, damping={"shoulder": 7.0}
    )
    text = arm_file.read_text().replace("stiffness: 8.0e3, damping: 4.0", "stiffness: 1e4, damping: 7.0")
    text = text.replace("-80.0", "50.0").replace("inertia: 1.0e-4", "inertia: 3e-4")
    other = gyroflex.Robot.from_urdf((arm_file.parent / "elastic_arm.urdf").read_text(), text)
    batch = {n: a[0] for n, a in batch_of(arm).items() if n in CALLS["forward_dynamics"][1]}
    for a, b in zip(changed.forward_dynamics(**batch), other.forward_dynamics(**batch), strict=True):
        np.testing.assert_array_equal(a, b)
    drives = changed.drives
    assert (drives["shoulder"].stiffness, drives["shoulder"].damping, drives["elbow"].ratio) == (1e4, 7.0, 50.0)
    assert arm.drives["shoulder"].stiffness == 8e3
    assert list(drives) == ["shoulder", "elbow"]


def test_a_changed_copy_may_have_other_gravity_model_and_load(arm: gyroflex.Robot) -> None:
    q = np.array([0.1, 0.2, 0.3])
    assert not arm.with_(gravity=(0.0, 0.0, 0.0)).gravity_torques(q).any()
    assert arm.with_(model="reduced").model == "reduced"
    load = {"link": "tool", "mass": 2.0}
    g, loaded = arm.gravity_torques(q), arm.with_(payload=load).gravity_torques(q)
    weight = np.array([0.0, 0.0, 2.0 * 9.81])
    np.testing.assert_allclose(loaded - g, arm.jacobian("tool", q)[3:].T @ weight, rtol=0, atol=1e-12)
    twice = arm.with_(stiffness={"shoulder": 1e4}).with_(stiffness={"elbow": 2e4}).drives
    assert (twice["shoulder"].stiffness, twice["elbow"].stiffness) == (1e4, 2e4)


def test_a_copy_that_cannot_be_is_refused(arm: gyroflex.Robot) -> None:
    with pytest.raises(gyroflex.Error, match="stiffness"):
        arm.with_(stiffness={"shoulder": -1.0})
    with pytest.raises(gyroflex.Error, match="shoulder"):
        arm.with_(stiffness={"shoulde": 1.0})


def test_what_a_frame_feels_is_a_batch_of_what_it_feels(arm: gyroflex.Robot) -> None:
    batch = {n: batch_of(arm, 20)[n] for n in ("q", "qd", "thetad")}
    many = arm.operational_space("tool", **batch, directions=["x", "y"])
    for k in range(20):
        one = arm.operational_space("tool", **{n: a[k] for n, a in batch.items()}, directions=["x", "y"])
        assert isinstance(one["smallest"], float)
        for name, value in one.items():
            np.testing.assert_array_equal(many[name][k], value, err_msg=name)


def test_a_motion_over_time_is_inverted_moment_by_moment(arm: gyroflex.Robot) -> None:
    robot = arm.with_(model="complete")
    order, step = max(robot.smoothness().values()), 1e-3
    t = step * np.arange(200)[:, None]
    speeds = np.array([1.0, 2.0, 3.0])
    q = np.sin(t * speeds)
    derivatives = np.stack([speeds**k * np.sin(t * speeds + k * np.pi / 2) for k in range(1, order + 1)], axis=1)
    many = robot.elastic_inverse(q, derivatives, step=step, torque_derivatives=0)
    deflection = None
    for k in range(len(t)):
        one = robot.elastic_inverse(q[k], derivatives[k], deflection=deflection, step=step)
        deflection = one.deflection
        for name in ("theta", "thetad", "thetadd", "tau_j", "tau", "deflection", "deflection_rate"):
            np.testing.assert_array_equal(getattr(many, name)[k], getattr(one, name), err_msg=name)
    with pytest.raises(gyroflex.ShapeError, match="200 times"):
        robot.elastic_inverse(q, derivatives[:-1], step=step)
    with pytest.raises(gyroflex.ShapeError, match="shape"):
        robot.elastic_inverse(q, derivatives[0], step=step)


@pytest.mark.parametrize("name", ["forward_dynamics", "mass_matrix", "forward_derivatives"])
def test_out_in_another_order_is_refused(arm: gyroflex.Robot, name: str) -> None:
    call, names = CALLS[name]
    batch = {n: a for n, a in batch_of(arm, 20).items() if n in names}
    room = tuple(np.empty(a.shape, order="F") for a in results(call(arm, **batch)))
    with pytest.raises(gyroflex.ArgumentError, match="C order"):
        call(arm, **batch, out=room if len(room) > 1 else room[0])


def test_out_of_one_state_does_not_overlap(arm: gyroflex.Robot) -> None:
    one = {n: a[0] for n, a in batch_of(arm, 1).items() if n in CALLS["forward_dynamics"][1]}
    room = np.empty(arm.nv)
    with pytest.raises(gyroflex.ArgumentError, match="overlap"):
        arm.forward_dynamics(**one, out=(room, room))


def test_more_than_fits_is_an_error_of_python(arm: gyroflex.Robot) -> None:
    zeros = np.zeros(3)
    start = {"q0": zeros, "qd0": zeros, "theta0": zeros, "thetad0": zeros, "tau": zeros, "dt": 1e-3}
    with pytest.raises((MemoryError, gyroflex.ArgumentError)):
        arm.rollout(**start, steps=10**12)
    with pytest.raises(gyroflex.ArgumentError, match="steps"):
        arm.rollout(**start, steps=2**63 - 1)


def test_the_last_word_on_gravity_and_model_counts(arm: gyroflex.Robot, arm_file: Path) -> None:
    changed = arm.with_(gravity=(0.0, 0.0, -1.0), model="rigid").with_(set={"gravity": [0, 0, -5], "model": "reduced"})
    assert changed.gravity.tolist() == [0, 0, -5] and changed.model == "reduced"
    loaded = gyroflex.Robot.load(arm_file, model="rigid").with_(stiffness={"shoulder": 1e4})
    assert loaded.model == "rigid"
    again = loaded.with_(model="complete").with_(gravity=(0.0, 0.0, 1.0))
    assert again.gravity.tolist() == [0, 0, 1] and again.model == "complete"


def test_loads_over_time_are_those_of_each_time(arm: gyroflex.Robot) -> None:
    order = max(arm.smoothness().values())
    q, derivatives = np.full((5, 3), 0.2), np.zeros((5, order, 3))
    loads = np.arange(15.0).reshape(5, 3)
    many = arm.elastic_inverse(q, derivatives, tau_ext=loads, step=1e-3)
    rows = arm.elastic_inverse(q, derivatives, tau_ext=loads[:, None], step=1e-3)
    deflection = None
    for k in range(5):
        one = arm.elastic_inverse(q[k], derivatives[k], tau_ext=loads[k], deflection=deflection, step=1e-3)
        deflection = one.deflection
        np.testing.assert_array_equal(many.tau[k], one.tau)
        np.testing.assert_array_equal(rows.tau[k], one.tau)
    with pytest.raises(gyroflex.ShapeError, match="5 times"):
        arm.elastic_inverse(q, derivatives, tau_ext=loads[:2], step=1e-3)
    with pytest.raises(gyroflex.ArgumentError, match="`step`.*from each time to the next"):
        arm.elastic_inverse(q, derivatives)
