"""Where in the workspace the gyroscopics of the rotors can matter."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import _checks
from .._gyroflex import Robot
from ._figure import known, pyplot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

MOST_POINTS = 1000
"""Along each axis; a map takes its square of eigenvalue problems."""


def significance_map(
    robot: Robot,
    x: str,
    y: str,
    *,
    q: ArrayLike | None = None,
    x_range: tuple[float, float] = (-np.pi, np.pi),
    y_range: tuple[float, float] = (-np.pi, np.pi),
    points: int = 41,
) -> Axes:
    """Draws where the rotors' coupling can matter: the largest significance ratio of any velocity over two joints.

    The ratio is ``2 qdᵀ S qd / (qdᵀ M qd)`` (Zhao et al. 2015, eq. 12), so its extremes are eigenvalues. Far below 1 the reduced
    model will do; see ``docs/rotors.md``.

    Parameters
    ----------
    robot
        Any robot; its complete model is looked at.
    x, y
        Names of the joints along the axes. The ratio of a robot never depends on its first joint.
    q
        Positions of the other joints, shape ``(nq,)``, zero unless given.
    x_range, y_range
        From where to where the joints turn [rad or m].
    points
        How many positions of each, at least two.
    """
    _checks.of_kind("robot", robot, Robot)
    known("x", x, robot.joint_names)
    if known("y", y, robot.joint_names) == x:
        raise _checks.refused("y", f"it is `{y}` as well as `x`", "give another joint")
    x_range, y_range = _interval("x_range", x_range), _interval("y_range", y_range)
    points = _checks.count("points", points, 2, MOST_POINTS)
    first = robot.nq - len(robot.joint_names) - len(robot.mode_names)
    column, row = (first + robot.joint_names.index(joint) for joint in (x, y))
    if q is None:
        pose = np.zeros(robot.nq)
        pose[6 : 7 if robot.floating else 6] = 1.0
    else:
        given = _checks.numbers("q", q, *sorted({robot.nq, robot.nq - len(robot.mode_names)}))
        pose = np.zeros(robot.nq)
        pose[: len(given)] = given
    across, up = np.linspace(*x_range, points), np.linspace(*y_range, points)
    ratios = np.empty((points, points))
    for i, pose[row] in enumerate(up):
        for k, pose[column] in enumerate(across):
            ratios[i, k] = _largest_significance(robot, pose)
    ax: Axes
    _, ax = pyplot().subplots(figsize=(6.4, 5.2), layout="constrained")
    mesh = ax.pcolormesh(across, up, ratios, shading="gouraud", cmap="viridis", vmin=0.0)
    pyplot().colorbar(mesh, ax=ax, label="largest significance ratio of any velocity [-]")
    ax.set(xlabel=f"{x} [rad or m]", ylabel=f"{y} [rad or m]", title=robot.name)
    return ax


def _interval(argument: str, ends: tuple[float, float]) -> tuple[float, float]:
    low, high = _checks.numbers(argument, ends, 2)
    if not low < high:
        raise _checks.refused(argument, f"it goes from {low:g} to {high:g}", "give the smaller one first")
    return low, high


def _largest_significance(robot: Robot, q: NDArray[np.float64]) -> float:
    coupling = robot.coupling_matrix(q, model="complete")
    root = np.linalg.cholesky(robot.mass_matrix(q, model="complete"))
    # With M = L Lᵀ the eigenvalues are those of L⁻¹ (S + Sᵀ) L⁻ᵀ.
    half = np.linalg.solve(root, coupling + coupling.T)
    return float(np.abs(np.linalg.eigvalsh(np.linalg.solve(root, half.T))).max())
