"""Robots in motion, as stick figures."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .. import _checks
from .._extras import extra
from .._gyroflex import Robot
from ..errors import ArgumentError, FileError
from ..results import SimulationResult
from ._figure import COLOURS, pyplot

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from numpy.typing import ArrayLike, NDArray

FLAT = 1e-6
"""Depth of what lies in a plane [m]."""
MOST_PICTURES = 100_000
FAR = 2.5
"""A way that is so many times as long as the robot is large is not shown as a whole."""


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
    drawn twice as far as its centre of mass. Links without mass between the world and the first one with mass are left out. A robot that
    goes far is followed.

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
        A result of another robot, times that the run has not, or a file that cannot be written in this format.
    """
    _checks.of_kind("robot", robot, Robot)
    _checks.of_kind("result", result, SimulationResult)
    if result.joint_names != tuple(robot.joint_names):
        problem = f"the robot's joints are {', '.join(robot.joint_names)}, the result's {', '.join(result.joint_names)}"
        raise ArgumentError(problem, "argument `robot`", "", "give the robot that the result is of")
    if not result.t.size:
        raise _checks.refused("result", "it has no samples", "give a run that recorded some")
    _checks.positive("fps", fps)
    speed, view = _checks.positive("speed", speed), _pair("view", view)
    film = None if path is None else _checks.path("path", path)
    writer = None if film is None else _writer(film)
    start, stop = (result.t[0], result.t[-1]) if times is None else _pair("times", times)
    if not result.t[0] <= start <= stop <= result.t[-1]:
        problem = f"the run goes from {result.t[0]:g} s to {result.t[-1]:g} s, not from {start:g} s to {stop:g} s"
        raise ArgumentError(problem, "argument `times`", "", "give times of the run")
    pictures = (stop - start) * fps / speed
    if pictures > MOST_PICTURES:
        raise _checks.refused("speed", f"{pictures:.0f} pictures are more than fit", "play it faster, or give fewer `fps` or `times`")
    shown = np.arange(start, stop + 1e-9, speed / fps)
    samples = np.searchsorted(result.t, shown - 1e-9).clip(max=result.t.size - 1)
    sticks = sticks_at(robot, _positions(robot, result)[samples])

    plt = pyplot()
    figure = plt.figure(figsize=(5.6, 5.6), layout="constrained")
    ax = figure.add_subplot(projection="3d", proj_type="ortho")
    low, high = sticks.min(axis=(1, 2)), sticks.max(axis=(1, 2))
    size, middles = (high - low).max(), (low + high) / 2
    low, high = low.min(axis=0), high.max(axis=0)
    # What goes far is followed.
    far = high - low > FAR * size
    middles = np.where(far, middles, (low + high) / 2)
    # One metre is as long in every direction; what lies in a plane gets a little depth.
    sides = np.where(far, FAR * size, high - low)
    sides = np.maximum(sides, 0.25 * sides.max() or 1.0)

    def look_at(middle: NDArray[np.float64]) -> None:
        for axis, half, center in zip("xyz", sides / 2, middle, strict=True):
            ax.set(**{f"{axis}lim": (center - half, center + half)})

    look_at(middles[0])
    ax.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    elevation, azimuth = np.deg2rad(view)
    towards = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    for axis in np.array(list("xyz"))[(high - low < FLAT) | (np.abs(towards) > 0.999)]:
        ax.set(**{f"{axis}ticks": [], f"{axis}label": ""})
    # A tuple: an array would be scaled in place.
    ax.set_box_aspect(tuple(sides))
    ax.view_init(*view)
    lines = [ax.plot(*stick.T, color=COLOURS[0], linewidth=3, marker="o", markersize=4, markerfacecolor="white")[0] for stick in sticks[0]]
    title = ax.set_title("")

    def draw(frame: int) -> Sequence[object]:
        for line, stick in zip(lines, sticks[frame], strict=True):
            line.set_data_3d(*stick.T)
        look_at(middles[frame])
        title.set_text(f"{robot.name}, {result.t[samples[frame]]:.2f} s")
        return [*lines, title]

    module = extra("matplotlib.animation", "plots")
    animation: FuncAnimation = module.FuncAnimation(figure, draw, frames=len(samples), interval=1000.0 / fps, blit=False)
    if film is not None:
        _save(animation, film, writer, fps)
    return animation


def _pair(argument: str, numbers: tuple[float, float]) -> tuple[float, float]:
    first, second = _checks.numbers(argument, numbers, 2)
    return first, second


def _positions(robot: Robot, result: SimulationResult) -> NDArray[np.float64]:
    """Positions of every sample, shape ``(samples, nq)``."""
    root = [result["base"][:, :7]] if robot.floating else []
    bent = [result["eta"]] if robot.mode_names else []
    return np.hstack([*root, result["q"], *bent])


def sticks_at(robot: Robot, positions: NDArray[np.float64]) -> NDArray[np.float64]:
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
        if link in index and center is not None and lengths[link] <= np.linalg.norm(center) / 2:
            yield index[link], index[link], 2 * np.asarray(center)


def _writer(path: str) -> str | None:
    """What writes a film of this name; `None` for a page with its pictures inside."""
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise FileError("its folder does not exist", "", path, "make the folder first")
    ending = os.path.splitext(path)[1].lower()
    if ending == ".html":
        return None
    writer = "pillow" if ending == ".gif" else "ffmpeg"
    if not extra("matplotlib.animation", "plots").writers.is_available(writer):
        remedy = "install ffmpeg, or write .gif or .html" if writer == "ffmpeg" else 'run `pip install "./crates/py[plots]"` in the repository of gyroflex'
        raise ArgumentError(f"{writer} is needed for `{path}` and not installed", "argument `path`", "", remedy)
    return writer


def _save(animation: FuncAnimation, path: str, writer: str | None, fps: int) -> None:
    try:
        if writer is not None:
            animation.save(path, writer=writer, fps=fps)
            return
        with open(path, "w", encoding="utf-8") as file:
            file.write(animation.to_jshtml(fps=fps))
    except (OSError, subprocess.SubprocessError) as error:
        raise FileError(str(error), "", path, "give a file that can be written, in a format of its writer") from error
