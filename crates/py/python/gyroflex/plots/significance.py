"""Where in the workspace the gyroscopics of the rotors can matter."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._figure import known, pyplot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from .._gyroflex import Robot


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
        How many positions of each.
    """
    known("x", (x,), robot.joint_names)
    known("y", (y,), robot.joint_names)
    first = robot.nq - len(robot.joint_names) - len(robot.mode_names)
    column, row = (first + robot.joint_names.index(joint) for joint in (x, y))
    if q is None:
        pose = np.zeros(robot.nq)
        pose[6 : 7 if robot.floating else 6] = 1.0
    else:
        pose = np.array(q, dtype=float)
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


def _largest_significance(robot: Robot, q: NDArray[np.float64]) -> float:
    coupling = robot.coupling_matrix(q, model="complete")
    root = np.linalg.cholesky(robot.mass_matrix(q, model="complete"))
    # With M = L Lᵀ the eigenvalues are those of L⁻¹ (S + Sᵀ) L⁻ᵀ.
    half = np.linalg.solve(root, coupling + coupling.T)
    return float(np.abs(np.linalg.eigvalsh(np.linalg.solve(root, half.T))).max())
