"""A program of a user, checked by `mypy --strict` and run by the tests."""

from __future__ import annotations

import sys
from pathlib import Path

import gyroflex
import matplotlib.pyplot as plt
import numpy as np
from gyroflex import plots
from numpy.typing import NDArray


def holding_torques(robot: gyroflex.Robot, q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Motor torques that hold the links still at `q`, whatever the transmissions are."""
    still = np.zeros(robot.nv)
    _, tau = robot.inverse_dynamics(q, still, still, model="rigid")
    return tau


def main(path: Path) -> None:
    robot = gyroflex.Robot.load(path)
    q = np.zeros(robot.nq)
    for joint, torque in zip(robot.joint_names, holding_torques(robot, q), strict=True):
        print(f"{joint}: {torque:.3f}")
    linear = robot.linearize(q, outputs="joint_torque")
    print(linear.zero_order_hold(1e-3).A.shape, [mode.frequency for mode in linear.modes() if mode.kind == "oscillation"])
    print(robot.frequency_response(robot.joint_names[0], q, points=10).resonances)
    still = np.zeros(robot.nv)
    tip = robot.link_names[-1]
    hold = gyroflex.Constraint.frame(tip, at=robot.placement(tip, q), directions=["x", "z"])
    print(robot.constrained_forward_dynamics(q, still, q, still, still, constraints=[hold]).multipliers)
    try:
        robot.placement("no such link", q)
    except gyroflex.ArgumentError as error:
        print(error.remedy)


def look(scenario: Path, folder: Path) -> None:
    """Runs a scenario, keeps its log, table, curves and film, and reads the log again."""
    run = gyroflex.simulate(scenario)
    run.to_mcap(folder / "run.mcap")
    again = gyroflex.read_mcap(folder / "run.mcap")
    print(again, again.to_pandas().shape)
    robot = gyroflex.Robot.load(scenario.parent / "robot.yaml")
    run.plot(["position", "energy"], joints=run.joint_names[:1])
    plt.savefig(folder / "run.png")
    plots.frequency_response(robot.frequency_response(robot.joint_names[0]), labels=["first"])
    plots.significance_map(robot, *robot.joint_names[:2], points=3).set_title("significance")
    plots.animate(robot, run, folder / "run.gif", fps=5)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
