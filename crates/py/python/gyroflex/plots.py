"""Pictures of runs and robots with matplotlib (``pip install gyroflex[plots]``).

Functions draw with ``matplotlib.pyplot`` and return the axes; ``axes[0].figure.savefig("run.png")`` keeps a picture, and
``plt.show()`` opens a window.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._extras import extra
from .errors import ArgumentError

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from . import FrequencyResponse, Robot
    from .results import SimulationResult

__all__ = ["PANELS", "animate", "frequency_response", "run", "significance_map"]

# Colours that everybody can tell apart (Okabe, Ito), those of `gyroflex --plot`; joints beyond them begin anew.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#3c3c3c")
GREY = "#9a9a9a"
WIDTH, HEIGHT = 8.0, 2.4
"""Size of a panel [inch]."""
FLAT = 1e-6
"""Depth of what lies in a plane [m]."""


def run(result: SimulationResult, panels: Sequence[str] | None = None, joints: Sequence[str] | None = None) -> list[Axes]:
    """Draws a run over time, a panel below the other.

    Parameters
    ----------
    result
        What `gyroflex.simulate` or `gyroflex.read_mcap` returned.
    panels
        Names of `PANELS`, ``"position"``, ``"torque"``, ``"energy"`` and ``"tracking_error"`` unless given.
    joints
        Names of the joints drawn, all unless given. Torques and positions of turning and of sliding joints share a panel.

    Raises
    ------
    ArgumentError
        A panel or a joint of another name.
    """
    panels = ("position", "torque", "energy", "tracking_error") if panels is None else tuple(panels)
    joints = result.joint_names if joints is None else tuple(joints)
    _known("panels", panels, PANELS)
    _known("joints", joints, result.joint_names)
    columns = [result.joint_names.index(joint) for joint in joints]
    axes = _stacked(len(panels))
    for ax, panel in zip(axes, panels, strict=True):
        PANELS[panel](ax, result, columns)
    axes[-1].set_xlabel("time [s]")
    return axes


def _position(ax: Axes, result: SimulationResult, columns: Sequence[int]) -> None:
    _by_joint(ax, result, "reference", columns, color=GREY, linewidth=2.5, alpha=0.5)
    _by_joint(ax, result, "q", columns)
    _by_joint(ax, result, "theta", columns, linestyle="--")
    _label(ax, result, "q", "position", columns, {"link": "-", "motor": "--"})


def _velocity(ax: Axes, result: SimulationResult, columns: Sequence[int]) -> None:
    _by_joint(ax, result, "qd", columns)
    _by_joint(ax, result, "thetad", columns, linestyle="--")
    _label(ax, result, "qd", "velocity", columns, {"link": "-", "motor": "--"})


def _deflection(ax: Axes, result: SimulationResult, columns: Sequence[int]) -> None:
    _by_joint(ax, result, "deflection", columns)
    _label(ax, result, "deflection", "deflection", columns)


def _torque(ax: Axes, result: SimulationResult, columns: Sequence[int]) -> None:
    _by_joint(ax, result, "tau_j", columns)
    _by_joint(ax, result, "tau", columns, linestyle="--", linewidth=0.8)
    _label(ax, result, "tau_j", "torque", columns, {"transmission": "-", "motor": "--"})


def _gyroscopic(ax: Axes, result: SimulationResult, columns: Sequence[int]) -> None:
    _by_joint(ax, result, "gyroscopic", columns)
    _label(ax, result, "gyroscopic", "of the rotors' coupling", columns)


def _tracking_error(ax: Axes, result: SimulationResult, columns: Sequence[int]) -> None:
    _by_joint(ax, result, "tracking_error", columns)
    _label(ax, result, "tracking_error", "tracking error", columns)


def _energy(ax: Axes, result: SimulationResult, _columns: Sequence[int]) -> None:
    parts = ("kinetic_energy", "gravity_energy", "elastic_energy")
    for part, colour in zip(parts, COLOURS, strict=False):
        ax.plot(result.t, result[part], color=colour, label=part.removesuffix("_energy"))
    ax.plot(result.t, np.sum([result[part] for part in parts], axis=0), color="black", label="sum")
    ax.set_ylabel("energy [J]")
    _legend(ax)


def _significance(ax: Axes, result: SimulationResult, _columns: Sequence[int]) -> None:
    ax.plot(result.t, result["significance"], color=COLOURS[0])
    ax.set_ylabel("significance [-]")


PANELS: dict[str, Callable[[Axes, SimulationResult, Sequence[int]], None]] = {
    "position": _position,
    "velocity": _velocity,
    "deflection": _deflection,
    "torque": _torque,
    "gyroscopic": _gyroscopic,
    "tracking_error": _tracking_error,
    "energy": _energy,
    "significance": _significance,
}
"""What `run` can draw: links and motors, seen from the link side, and the energies and significance ratio of the robot."""


def frequency_response(responses: FrequencyResponse | Iterable[FrequencyResponse], labels: Sequence[str] | None = None) -> list[Axes]:
    """Draws magnitude and phase of `Robot.frequency_response`: motor and link position per motor torque.

    Parameters
    ----------
    responses
        One or several, of several joints or of several robots.
    labels
        What each is called, the joint's name unless given.
    """
    several = list(responses) if isinstance(responses, Iterable) else [responses]
    names = [response.joint for response in several] if labels is None else list(labels)
    if len(names) != len(several):
        problem, remedy = f"{len(names)} labels for {len(several)} responses", "give one for each"
        raise ArgumentError(problem, "argument `labels`", "", remedy)
    axes = _stacked(2, height=3.0)
    magnitude, phase = axes
    for i, (response, name) in enumerate(zip(several, names, strict=True)):
        for side, values, style in (("motor", response.motor, "--"), ("link", response.link, "-")):
            look = {"color": COLOURS[i % len(COLOURS)], "linestyle": style}
            magnitude.loglog(response.frequency, np.abs(values), label=f"{name}, {side}", **look)
            phase.semilogx(response.frequency, _phase(values), **look)
    magnitude.set_ylabel("position per torque\n[rad/(N m) or m/N]")
    _legend(magnitude)
    phase.set_ylabel("phase [°]")
    phase.yaxis.set_major_locator(extra("matplotlib.ticker", "plots").MultipleLocator(90))
    phase.set_xlabel("frequency [Hz]")
    return axes


def _phase(values: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Phase without jumps, from above -360° to 0 at the first frequency [°]."""
    phase = np.rad2deg(np.unwrap(np.angle(values)))
    # Rounding must not make a turn of zero.
    return phase - 360.0 * np.ceil((phase[0] - 1.0) / 360.0)  # type: ignore[no-any-return]


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
    _known("x", (x,), robot.joint_names)
    _known("y", (y,), robot.joint_names)
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
    _, ax = _pyplot().subplots(figsize=(6.4, 5.2), layout="constrained")
    mesh = ax.pcolormesh(across, up, ratios, shading="gouraud", cmap="viridis", vmin=0.0)
    _pyplot().colorbar(mesh, ax=ax, label="largest significance ratio of any velocity [-]")
    ax.set(xlabel=f"{x} [rad or m]", ylabel=f"{y} [rad or m]", title=robot.name)
    return ax


def _largest_significance(robot: Robot, q: NDArray[np.float64]) -> float:
    coupling = robot.coupling_matrix(q, model="complete")
    root = np.linalg.cholesky(robot.mass_matrix(q, model="complete"))
    # With M = L Lᵀ the eigenvalues are those of L⁻¹ (S + Sᵀ) L⁻ᵀ.
    half = np.linalg.solve(root, coupling + coupling.T)
    return float(np.abs(np.linalg.eigvalsh(np.linalg.solve(root, half.T))).max())


def animate(
    robot: Robot,
    result: SimulationResult,
    path: str | os.PathLike[str] | None = None,
    *,
    times: tuple[float, float] | None = None,
    fps: int = 25,
    speed: float = 1.0,
    view: tuple[float, float] = (20.0, -60.0),
) -> FuncAnimation:
    """Animates a run as a stick figure.

    Sticks go from the origin of every link to those of its children; a link without any, or with all of them close to its origin, is
    drawn twice as far as its centre of mass. Links without mass between the world and the first one with mass are left out.

    Parameters
    ----------
    robot
        The robot of the run.
    result
        Its motion. Links that bend are drawn bent.
    path
        Where to write it: ``.gif``, ``.html`` (a player with its pictures inside), or ``.mp4`` and whatever else `ffmpeg` writes.
    times
        From when to when [s], the whole run unless given.
    fps
        Pictures per second.
    speed
        How fast it is played: 0.5 for slow motion.
    view
        Elevation and azimuth of the camera [°]; ``(0, -90)`` looks along y, as for robots that move in the x-z plane.

    Returns
    -------
    matplotlib.animation.FuncAnimation
        Keep it as long as its window is open; ``to_jshtml()`` is for notebooks.

    Raises
    ------
    ArgumentError
        A result of another robot, or a file that cannot be written in this format.
    """
    if result.joint_names != tuple(robot.joint_names):
        problem = f"the robot's joints are {', '.join(robot.joint_names)}, the result's {', '.join(result.joint_names)}"
        raise ArgumentError(problem, "argument `robot`", "", "give the robot that the result is of")
    film = None if path is None else os.fspath(path)
    writer = None if film is None else _writer(film)
    start, stop = (result.t[0], result.t[-1]) if times is None else times
    shown = np.arange(start, stop + 1e-9, speed / fps)
    samples = np.searchsorted(result.t, shown - 1e-9).clip(max=result.t.size - 1)
    sticks = _sticks(robot, _positions(robot, result)[samples])

    plt = _pyplot()
    figure = plt.figure(figsize=(5.6, 5.6), layout="constrained")
    ax = figure.add_subplot(projection="3d")
    low, high = sticks.min(axis=(0, 1, 2)), sticks.max(axis=(0, 1, 2))
    # One metre is as long in every direction; what lies in a plane gets a little depth.
    sides = np.maximum(high - low, 0.25 * (high - low).max() or 1.0)
    middle = (low + high) / 2
    for axis, half, center in zip("xyz", sides / 2, middle, strict=True):
        ax.set(**{f"{axis}lim": (center - half, center + half), f"{axis}label": f"{axis} [m]"})
    elevation, azimuth = np.deg2rad(view)
    towards = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    for axis in np.array(list("xyz"))[(high - low < FLAT) | (np.abs(towards) > 0.999)]:
        ax.set(**{f"{axis}ticks": [], f"{axis}label": ""})
    ax.set_box_aspect(sides)
    ax.view_init(*view)
    lines = [ax.plot(*stick.T, color=COLOURS[0], linewidth=3, marker="o", markersize=4, markerfacecolor="white")[0] for stick in sticks[0]]
    title = ax.set_title("")

    def draw(frame: int) -> Sequence[object]:
        for line, stick in zip(lines, sticks[frame], strict=True):
            line.set_data_3d(*stick.T)
        title.set_text(f"{robot.name}, {result.t[samples[frame]]:.2f} s")
        return [*lines, title]

    module = extra("matplotlib.animation", "plots")
    animation: FuncAnimation = module.FuncAnimation(figure, draw, frames=len(samples), interval=1000.0 / fps, blit=False)
    if film is not None:
        _save(animation, film, writer, fps)
    return animation


def _positions(robot: Robot, result: SimulationResult) -> NDArray[np.float64]:
    """Positions of every sample, shape ``(samples, nq)``."""
    root = [result["base"][:, :7]] if robot.floating else []
    bent = [result["eta"]] if robot.mode_names else []
    return np.hstack([*root, result["q"], *bent])


def _sticks(robot: Robot, positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Both ends of every stick at every position, shape ``(positions, sticks, 2, 3)``, in the world."""
    links = _links(robot)
    poses = np.array([[robot.placement(link, q) for link in links] for q in positions])
    index = {link: i for i, link in enumerate(links)}
    axes, origins = poses[..., :3, :3], poses[..., :3, 3]
    start, end, offset = map(np.array, zip(*_pairs(robot, index, origins[0]), strict=True))
    return np.stack([origins[:, start], origins[:, end] + np.einsum("ksij,sj->ksi", axes[:, end], offset)], axis=2)


def _links(robot: Robot) -> list[str]:
    """Links that are drawn: all but those without mass between the world and the first one with, of joints that stand for a free root."""
    parents, centers = robot.link_parents, robot.centers_of_mass

    def stands_for_root(link: str | None) -> bool:
        return link is None or link not in centers or (centers[link] is None and stands_for_root(parents[link]))

    return [link for link in parents if link not in centers or not stands_for_root(link)]


def _pairs(robot: Robot, index: dict[str, int], origins: NDArray[np.float64]) -> Iterator[tuple[int, int, ArrayLike]]:
    """Sticks as numbers of the links where they start and end, and what to go on by in the axes of the latter."""
    lengths = dict.fromkeys(index, 0.0)
    for link, parent in robot.link_parents.items():
        if link in index and parent is not None and parent in index:
            yield index[parent], index[link], np.zeros(3)
            lengths[parent] = max(lengths[parent], float(np.linalg.norm(origins[index[link]] - origins[index[parent]])))
    for link, center in robot.centers_of_mass.items():
        if link in index and center is not None and lengths[link] < np.linalg.norm(center) / 2:
            yield index[link], index[link], 2 * np.asarray(center)


def _writer(path: str) -> str | None:
    """What writes a film of this name; `None` for a page with its pictures inside."""
    ending = os.path.splitext(path)[1].lower()
    if ending == ".html":
        return None
    writer = "pillow" if ending == ".gif" else "ffmpeg"
    if not extra("matplotlib.animation", "plots").writers.is_available(writer):
        remedy = "install ffmpeg, or write .gif or .html" if writer == "ffmpeg" else "run `pip install pillow`"
        raise ArgumentError(f"{writer} is needed for `{path}` and not installed", "argument `path`", "", remedy)
    return writer


def _save(animation: FuncAnimation, path: str, writer: str | None, fps: int) -> None:
    if writer is not None:
        animation.save(path, writer=writer, fps=fps)
        return
    with open(path, "w", encoding="utf-8") as file:
        file.write(animation.to_jshtml(fps=fps))


def _pyplot() -> Any:
    return extra("matplotlib.pyplot", "plots")


def _stacked(panels: int, height: float = HEIGHT) -> list[Axes]:
    """Panels below each other that share their x-axis."""
    _, axes = _pyplot().subplots(panels, sharex=True, squeeze=False, figsize=(WIDTH, height * panels), layout="constrained")
    for ax in axes[:, 0]:
        ax.grid(visible=True, alpha=0.3)
    return list(axes[:, 0])


def _by_joint(ax: Axes, result: SimulationResult, name: str, columns: Sequence[int], **style: object) -> None:
    for column in columns:
        ax.plot(result.t, result[name][:, column], **({"color": COLOURS[column % len(COLOURS)]} | style))  # type: ignore[arg-type]


def _label(ax: Axes, result: SimulationResult, name: str, text: str, columns: Sequence[int], sides: dict[str, str] | None = None) -> None:
    """Names of joints by colour, and of what is drawn in which style; the unit, or both where joints turn and slide."""
    units = dict.fromkeys(result.units[name][column] for column in columns)
    ax.set_ylabel(f"{text} [{', '.join(units)}]")
    for column in columns:
        ax.plot([], [], color=COLOURS[column % len(COLOURS)], label=result.joint_names[column])
    for side, style in (sides or {}).items():
        ax.plot([], [], color="black", linestyle=style, label=side)
    _legend(ax)


def _legend(ax: Axes) -> None:
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.02), frameon=False, fontsize="small")


def _known(argument: str, names: Iterable[str], known: Iterable[str]) -> None:
    for name in names:
        if name not in known:
            raise ArgumentError(f"`{name}` is unknown", f"argument `{argument}`", "", f"give one of {', '.join(known)}")
