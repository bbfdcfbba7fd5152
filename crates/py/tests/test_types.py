"""The stubs say what the module is, and a user's program passes the strictest check."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import pytest
import typed_example

HERE = Path(__file__).parent


def run(*command: str | Path) -> None:
    done = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs_fit_the_module() -> None:
    run("mypy.stubtest", "gyroflex")


def test_package_passes_the_strict_check() -> None:
    run("mypy", "--strict", "-p", "gyroflex")


def test_example_passes_the_strict_check() -> None:
    run("mypy", "--strict", HERE / "typed_example.py")


def test_example_runs(arm_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    typed_example.main(arm_file)
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in lines[:3]] == ["shoulder", "elbow", "extend"]


def test_example_of_pictures_runs(arm_file: Path, tmp_path: Path) -> None:
    scenario = arm_file.parent / "look.yaml"
    scenario.write_text("{robot: robot.yaml, duration: 0.2, integrator: {method: rk4, step: 1.0e-4}, log: {rate: 500}}")
    matplotlib.use("Agg")
    try:
        typed_example.look(scenario, tmp_path)
    finally:
        plt.close("all")
    assert {path.name for path in tmp_path.iterdir()} == {"run.mcap", "run.png", "run.gif"}


def test_float32_is_told_from_float64(tmp_path: Path) -> None:
    program = tmp_path / "precision.py"
    program.write_text(
        "import gyroflex\n"
        "import numpy as np\n"
        "from numpy.typing import NDArray\n"
        "from typing_extensions import assert_type\n\n\n"
        "def both(robot: gyroflex.Robot, q: NDArray[np.float64], s: NDArray[np.float32]) -> None:\n"
        "    assert_type(robot.mass_matrix(q), NDArray[np.float64])\n"
        "    assert_type(robot.mass_matrix(s, out=s), NDArray[np.float32])\n"
        "    assert_type(robot.bias(s, s, s), tuple[NDArray[np.float32], NDArray[np.float32]])\n"
        "    assert_type(robot.bias(s, q, s), tuple[NDArray[np.float64], NDArray[np.float64]])\n"
        "    assert_type(robot.gravity_torques([0.0, 1.0]), NDArray[np.float64])\n"
    )
    run("mypy", "--strict", program)
