"""Simulations: a scenario in, arrays by name out."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping

from . import _checks, _gyroflex
from .errors import DivergedError, RobotWarning
from .results import ContactImpact, SimulationResult

__all__ = ["simulate"]


def simulate(
    scenario: str | os.PathLike[str],
    *,
    log: str | os.PathLike[str] | None = None,
    set: Mapping[str, object] | None = None,
) -> SimulationResult:
    """Runs a scenario YAML and returns what it recorded. Other threads go on meanwhile; Ctrl-C stops it.

    Parameters
    ----------
    scenario
        The scenario's file; the robot it names is looked for beside it.
    log
        Where to write an MCAP log as well. It is complete also after a run that diverged or was stopped.
    set
        Other values of keys, such as ``{"controller.kp": 400, "drives.joint2.transmission.stiffness": 1e4}``: keys of the
        scenario, else of its robot's YAML (``robot.gravity`` where both have one), and anything that could be written there.

    Raises
    ------
    DivergedError
        With joint and time; its ``result`` is what was recorded up to there.
    ScenarioError, FormatError, ModelError, FileError
        What is wrong with which file, before anything runs.

    What was ignored or assumed is issued as ``RobotWarning`` and kept in the result's ``warnings``.
    """
    result, error = attempt(scenario, log, set)
    for message in result.warnings:
        warnings.warn(message, RobotWarning, stacklevel=2)
    if error is not None:
        raise error
    return result


def attempt(
    scenario: str | os.PathLike[str],
    log: str | os.PathLike[str] | None,
    set: Mapping[str, object] | None,
) -> tuple[SimulationResult, DivergedError | None]:
    """A run, and its error if it diverged; says nothing by itself."""
    path = None if log is None else _checks.path("log", log)
    run = _gyroflex.run_scenario(_checks.path("scenario", scenario), path, set)
    named, joint_names, metadata, messages, impacts, record, error = run
    struck = tuple(ContactImpact(*impact) for impact in impacts)
    result = SimulationResult(*named, joint_names, metadata, tuple(messages), struck, path, record)
    if error is not None:
        error.result = result
    return result, error
