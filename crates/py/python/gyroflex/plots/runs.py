"""Runs over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .. import _checks
from ..results import SimulationResult
from ._figure import COLOURS, GREY, legend, several, stacked

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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
    _checks.of_kind("result", result, SimulationResult)
    panels = ("position", "torque", "energy", "tracking_error") if panels is None else several("panels", panels, PANELS)
    joints = result.joint_names if joints is None else several("joints", joints, result.joint_names)
    columns = [result.joint_names.index(joint) for joint in joints]
    axes = stacked(len(panels))
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
    legend(ax)


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
    legend(ax)
