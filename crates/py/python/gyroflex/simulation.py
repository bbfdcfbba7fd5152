"""Simulations: a scenario in, arrays by name out."""

from __future__ import annotations

import os
import warnings

from . import _gyroflex
from .errors import RobotWarning
from .results import ContactImpact, SimulationResult

__all__ = ["simulate"]


def simulate(scenario: str | os.PathLike[str], *, log: str | os.PathLike[str] | None = None) -> SimulationResult:
    """Runs a scenario YAML and returns what it recorded. Other threads go on meanwhile; Ctrl-C stops it.

    Parameters
    ----------
    scenario
        The scenario's file; the robot it names is looked for beside it.
    log
        Where to write an MCAP log as well. It is complete also after a run that diverged or was stopped.

    Raises
    ------
    DivergedError
        With joint and time; its ``result`` is what was recorded up to there.
    ScenarioError, FormatError, ModelError, FileError
        What is wrong with which file, before anything runs.

    What was ignored or assumed is issued as ``RobotWarning`` and kept in the result's ``warnings``.
    """
    named, joint_names, metadata, messages, impacts, record, error = _gyroflex.run_scenario(scenario, log)
    path = None if log is None else os.fspath(log)
    struck = tuple(ContactImpact(*impact) for impact in impacts)
    result = SimulationResult(*named, joint_names, metadata, tuple(messages), struck, path, record)
    for message in messages:
        warnings.warn(message, RobotWarning, stacklevel=2)
    if error is not None:
        error.result = result
        raise error
    return result
