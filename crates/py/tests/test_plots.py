"""Pictures show the numbers they are of. What they look like was looked at; here it is whether they are drawn, and of what."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import gyroflex
import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import PROJECT
from gyroflex import plots
from gyroflex.plots.sticks import sticks_at

ROBOTS = PROJECT / "robots"
SCENARIO = """
robot: robot.yaml
duration: 0.2
reference: {default: {type: sine, amplitude: 0.05, frequency: 2.0}}
controller: {type: pd, rate: 1000, kp: 400, kd: 30}
integrator: {method: rk4, step: 1.0e-4}
log: {rate: 500}
"""


@pytest.fixture(scope="module")
def result(arm_file: Path) -> gyroflex.SimulationResult:
    path = arm_file.parent / "plots.yaml"
    path.write_text(SCENARIO)
    return gyroflex.simulate(path)


@pytest.fixture(autouse=True)
def closed() -> Iterator[None]:
    yield
    plt.close("all")


def curves(ax: plt.Axes) -> list[np.ndarray]:
    return [np.asarray(line.get_ydata()) for line in ax.lines if len(line.get_ydata())]


def test_every_panel_draws_its_arrays(result: gyroflex.SimulationResult) -> None:
    axes = dict(zip(plots.PANELS, result.plot(tuple(plots.PANELS)), strict=True))
    assert axes["significance"].get_xlabel() == "time [s]"
    shown = {
        "position": ["reference", "q", "theta"],
        "velocity": ["qd", "thetad"],
        "deflection": ["deflection"],
        "torque": ["tau_j", "tau"],
        "gyroscopic": ["gyroscopic"],
        "tracking_error": ["tracking_error"],
    }
    for panel, names in shown.items():
        drawn = curves(axes[panel])
        np.testing.assert_array_equal(drawn, [column for name in names for column in result[name].T])
    kinetic, gravity, elastic, total = curves(axes["energy"])
    np.testing.assert_allclose(kinetic + gravity + elastic, total)
    assert axes["position"].get_ylabel() == "position [rad, m]"
    axes["energy"].figure.canvas.draw()


def test_joints_are_chosen_by_name_and_keep_their_colour(result: gyroflex.SimulationResult) -> None:
    (everything,), (one,) = result.plot(["deflection"]), result.plot(["deflection"], joints=["elbow"])
    np.testing.assert_array_equal(curves(one), [result["deflection"][:, 1]])
    assert one.lines[0].get_color() == everything.lines[1].get_color()
    with pytest.raises(gyroflex.ArgumentError, match=r"argument `joints`: `wrist` is unknown.*\n.*shoulder, elbow, extend"):
        result.plot(joints=["wrist"])
    with pytest.raises(gyroflex.ArgumentError, match="tracking_error"):
        result.plot(["tracking"])


def test_frequency_responses_are_drawn_as_magnitude_and_phase(arm: gyroflex.Robot) -> None:
    responses = [arm.frequency_response(joint, points=50, friction="viscous") for joint in ("shoulder", "elbow")]
    magnitude, phase = plots.frequency_response(responses)
    drawn = [(r.motor, r.link) for r in responses]
    np.testing.assert_array_equal(curves(magnitude), np.abs(drawn).reshape(4, -1))
    turns = (np.array(curves(phase)) - np.rad2deg(np.angle(drawn).reshape(4, -1))) / 360.0
    np.testing.assert_allclose(turns, turns.round(), atol=1e-12)
    plots.frequency_response(responses[0])[0].figure.canvas.draw()
    with pytest.raises(gyroflex.ArgumentError, match="1 labels for 2"):
        plots.frequency_response(responses, labels=["one"])


def test_no_velocity_is_more_significant_than_the_map_says(arm: gyroflex.Robot) -> None:
    q = np.array([0.3, -0.2, 0.1])
    ax = plots.significance_map(arm, "shoulder", "elbow", q=q, x_range=(-1, 1), y_range=(-0.5, 0.5), points=5)
    mesh = ax.collections[0]
    ratios = np.asarray(mesh.get_array()).reshape(5, 5)
    np.testing.assert_allclose(ratios, np.broadcast_to(ratios[:, :1], (5, 5)), rtol=1e-9, err_msg="the first joint turns the whole robot")
    rng = np.random.default_rng(1)
    for i, elbow in enumerate(np.linspace(-0.5, 0.5, 5)):
        pose = np.array([0.0, elbow, 0.1])
        coupling, inertia = arm.coupling_matrix(pose, model="complete"), arm.mass_matrix(pose, model="complete")
        qd = rng.normal(size=(20_000, 3))
        met = np.abs(2 * np.einsum("ki,ij,kj->k", qd, coupling, qd) / np.einsum("ki,ij,kj->k", qd, inertia, qd))
        assert 0.9 * ratios[i, 0] < met.max() <= ratios[i, 0] * (1 + 1e-12)


@pytest.mark.parametrize("ending", ["gif", "html"])
def test_animations_are_written(arm: gyroflex.Robot, result: gyroflex.SimulationResult, tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"arm.{ending}"
    plots.animate(arm, result, path, fps=10)
    written = path.read_bytes()
    assert written.startswith(b"GIF89a") if ending == "gif" else b"<img" in written


def test_a_film_that_cannot_be_written_is_told(
    arm: gyroflex.Robot, result: gyroflex.SimulationResult, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(matplotlib.animation.writers, "is_available", lambda name: name != "ffmpeg")
    with pytest.raises(gyroflex.ArgumentError, match=r"ffmpeg.*\n.*\.gif"):
        plots.animate(arm, result, tmp_path / "arm.mp4")


def test_an_animation_is_of_its_own_robot(result: gyroflex.SimulationResult) -> None:
    with pytest.raises(gyroflex.ArgumentError, match="argument `robot`"):
        plots.animate(gyroflex.Robot.load(ROBOTS / "iiwa14" / "robot.yaml"), result)


def test_times_that_a_run_has_not_are_told(arm: gyroflex.Robot, result: gyroflex.SimulationResult) -> None:
    for times in ((0.0, 1.0), (-0.1, 0.1), (0.2, 0.1)):
        with pytest.raises(gyroflex.ArgumentError, match="from 0 s to 0.2 s"):
            plots.animate(arm, result, times=times)


# A published inertia of the PUMA is no body's.
@pytest.mark.filterwarnings("ignore:.*triangle inequality")
@pytest.mark.parametrize("robot", sorted(path.parent.name for path in ROBOTS.glob("*/robot.yaml")))
def test_sticks_meet_at_the_origins_of_links(robot: str) -> None:
    loaded = gyroflex.Robot.load(ROBOTS / robot / "robot.yaml")
    q = np.linspace(0.1, 0.4, loaded.nq)
    if loaded.floating:
        q[3:7] = [0.0, 0.0, 0.6, 0.8]
    sticks = sticks_at(loaded, q[None])[0]
    assert len(sticks) >= len(loaded.joint_names)
    origins = np.array([loaded.placement(link, q)[:3, 3] for link in loaded.link_names])
    for start, _ in sticks:
        assert np.abs(origins - start).max(axis=1).min() < 1e-12


def test_what_cannot_be_drawn_is_refused_by_name(arm: gyroflex.Robot, result: gyroflex.SimulationResult, tmp_path: Path) -> None:
    response = arm.frequency_response("elbow", points=5)
    chart, film, run = plots.significance_map, plots.animate, result.plot
    refused = [
        ("panels", lambda: run("position")),
        ("panels", lambda: run([])),
        ("joints", lambda: run(joints="elbow")),
        ("result", lambda: plots.run(arm)),
        ("responses", lambda: plots.frequency_response(5)),
        ("responses", lambda: plots.frequency_response([])),
        ("labels", lambda: plots.frequency_response([response] * 2, labels="ab")),
        ("y", lambda: chart(arm, "elbow", "elbow")),
        ("q", lambda: chart(arm, "elbow", "extend", q=[0.0])),
        ("points", lambda: chart(arm, "elbow", "extend", points=1)),
        ("points", lambda: chart(arm, "elbow", "extend", points=10**9)),
        ("x_range", lambda: chart(arm, "elbow", "extend", x_range=(1, 0))),
        ("fps", lambda: film(arm, result, fps=0)),
        ("speed", lambda: film(arm, result, speed=-1.0)),
        ("speed", lambda: film(arm, result, speed=1e-9)),
        ("times", lambda: film(arm, result, times=(0, np.nan))),
        ("view", lambda: film(arm, result, view=(20,))),
    ]
    for argument, draw in refused:
        with pytest.raises(gyroflex.ArgumentError) as caught:
            draw()  # type: ignore[no-untyped-call]
        assert caught.value.element == f"argument `{argument}`"
    with pytest.raises(gyroflex.FileError, match="folder"):
        film(arm, result, tmp_path / "nowhere" / "arm.gif")
