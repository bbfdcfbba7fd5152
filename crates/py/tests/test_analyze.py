"""`Robot.analyze` says what `gyroflex analyze --json` prints."""

from __future__ import annotations

import json
import math
import subprocess
import warnings
from pathlib import Path

import gyroflex
import pytest
from conftest import PROJECT

PUMA = PROJECT / "robots" / "puma560"


def load() -> gyroflex.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gyroflex.RobotWarning)
        return gyroflex.Robot.load(PUMA / "robot.yaml")


def printed(binary: Path, *options: str | Path) -> dict[str, object]:
    command = [binary, "-q", "analyze", PUMA / "robot.yaml", "--json", *options]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def test_workspace_and_bounds_are_those_of_the_command_line(binary: Path) -> None:
    ours = load().analyze(samples=100, seed=5, speed=math.radians(40.0), threshold=0.01, bounds=True)
    theirs = printed(binary, "--samples", "100", "--seed", "5", "--speed", "40", "--threshold", "0.01", "--bounds")
    assert ours == theirs


def test_scenarios_are_those_of_the_command_line(binary: Path) -> None:
    scenario = PUMA / "push.yaml"
    assert load().analyze(scenario=scenario) == printed(binary, "--scenario", scenario)


def test_what_means_nothing_is_refused() -> None:
    robot = load()
    with pytest.raises(gyroflex.ArgumentError, match="argument `threshold`"):
        robot.analyze(threshold=-1.0)
    with pytest.raises(gyroflex.ArgumentError, match="log"):
        robot.analyze(scenario="a.yaml", log="b.mcap")
    with pytest.raises(gyroflex.FileError):
        robot.analyze(log="none.mcap")
