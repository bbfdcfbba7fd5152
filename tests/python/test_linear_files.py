"""Linear models as MAT and CSV files: what SciPy and Python read there is what the program prints as JSON."""

from __future__ import annotations

import csv
import json
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io

PROJECT = Path(__file__).parents[2]
PUMA = PROJECT / "robots/puma560"
VECTORS = ("q", "qd", "theta", "thetad", "tau")
NAMES = ("states", "inputs", "outputs")


@pytest.fixture(scope="module")
def binary() -> Path:
    """The program: `GYROFLEX_BIN`, or the newest one Cargo built."""
    if chosen := os.environ.get("GYROFLEX_BIN"):
        return Path(chosen)
    target = Path(os.environ.get("CARGO_TARGET_DIR", PROJECT / "target"))
    built = [p for p in (target / profile / "gyroflex" for profile in ("debug", "release")) if p.exists()]
    if not built:
        pytest.fail("no `gyroflex` program: run `cargo build -p gyroflex-cli`, or set GYROFLEX_BIN")
    return max(built, key=lambda p: p.stat().st_mtime)


def linearize(binary: Path, *options: object) -> Any:
    command = [str(binary), "linearize", "--quiet", "--json", str(PUMA / "robot.yaml"), *map(str, options)]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def test_scipy_reads_a_model_from_a_mat_file(binary: Path, tmp_path: Path) -> None:
    file = tmp_path / "puma.mat"
    printed = linearize(binary, "--q", "0,0.5,-1,0.2,0.4,0", "--output", "joint-torque,pose:link6", "--zoh", 1e-3, "--mat", file)
    read = scipy.io.loadmat(file)
    for name in "ABCD":
        np.testing.assert_array_equal(read[name], printed[name])
    for name in VECTORS:
        np.testing.assert_array_equal(read[name].ravel(), printed[name])
    for name in NAMES:
        assert [line.rstrip() for line in read[name]] == printed[name]
    assert read["step"] == [[1e-3]]
    assert scipy.io.whosmat(file)[0] == ("A", (24, 24), "double")


def test_scipy_reads_models_along_a_motion_with_time_as_the_last_index(binary: Path, tmp_path: Path) -> None:
    file = tmp_path / "track.mat"
    times = [0.0, 0.5, 1.25]
    printed = linearize(binary, "--scenario", PUMA / "track.yaml", "--at", "0,0.5,1.25", "--mat", file)
    read = scipy.io.loadmat(file)
    assert read["time"].ravel().tolist() == times == [model["time"] for model in printed]
    assert read["step"] == [[0.0]]
    for i, model in enumerate(printed):
        for name in "ABCD":
            np.testing.assert_array_equal(read[name][:, :, i], model[name])
        for name in VECTORS:
            np.testing.assert_array_equal(read[name][:, 0, i], model[name])


def test_csv_files_have_the_matrices_with_the_names_of_rows_and_columns(binary: Path, tmp_path: Path) -> None:
    folder = tmp_path / "new" / "folder"
    printed = linearize(binary, "--csv", folder)
    sides = {"A": ("states", "states"), "B": ("states", "inputs"), "C": ("outputs", "states"), "D": ("outputs", "inputs")}
    assert sorted(p.name for p in folder.iterdir()) == [f"{name}.csv" for name in sides]
    for name, (rows, columns) in sides.items():
        head, *lines = csv.reader((folder / f"{name}.csv").read_text().splitlines())
        assert head == ["row", *printed[columns]]
        assert [line[0] for line in lines] == printed[rows]
        np.testing.assert_array_equal([[float(x) for x in line[1:]] for line in lines], printed[name])


def test_csv_files_along_a_motion_have_the_times_in_the_first_column(binary: Path, tmp_path: Path) -> None:
    printed = linearize(binary, "--scenario", PUMA / "track.yaml", "--at", "0.5,1", "--csv", tmp_path)
    head, *lines = csv.reader((tmp_path / "A.csv").read_text().splitlines())
    assert head[:2] == ["time", "row"]
    assert [float(line[0]) for line in lines] == [0.5] * 24 + [1.0] * 24
    np.testing.assert_array_equal([[float(x) for x in line[2:]] for line in lines[24:]], printed[1]["A"])
