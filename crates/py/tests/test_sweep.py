"""A sweep is its runs one by one, whoever makes them."""

from __future__ import annotations

import csv
import json
import os
import signal
import threading
import time
from pathlib import Path
from typing import Any

import gyroflex
import numpy as np
import pytest
from test_simulate import SCENARIO, scenario

STIFFNESS = "drives.shoulder.transmission.stiffness"
VALUES = {STIFFNESS: np.geomspace(2e3, 2e4, 3), "controller.kd": [20, 30]}
MEASURES = ("rms_tracking_error", "peak_tracking_error", "peak_torque", "saturation")


@pytest.fixture(scope="module")
def path(arm_file: Path) -> Path:
    return scenario(arm_file, "sweep.yaml")


def largest_deflection(result: gyroflex.SimulationResult) -> dict[str, Any]:
    return {"deflection": np.abs(result["deflection"]).max(), "samples": result.t.size, "finite": bool(np.isfinite(result["q"]).all())}


def sweep(path: Path, values: Any = None, **options: Any) -> gyroflex.SweepResult:
    return gyroflex.sweep(path, VALUES if values is None else values, progress=False, **options)


def same(a: gyroflex.SweepResult, b: gyroflex.SweepResult) -> bool:
    return list(a) == list(b) and all(a[name].tolist() == b[name].tolist() or np.array_equal(a[name], b[name], equal_nan=True) for name in a)


def test_overrides_are_as_if_the_file_said_so(arm_file: Path, path: Path) -> None:
    text = arm_file.read_text()
    assert "stiffness: 8.0e3" in text
    edited = arm_file.parent / "edited.yaml"
    edited.write_text(text.replace("stiffness: 8.0e3", "stiffness: 9.5e3"))
    ours = gyroflex.Robot.load(arm_file, set={STIFFNESS: 9.5e3})
    theirs = gyroflex.Robot.load(edited)
    q, rest = np.full(3, 0.3), np.zeros(3)
    for a, b in zip(ours.forward_dynamics(q, rest, rest, rest, rest), theirs.forward_dynamics(q, rest, rest, rest, rest), strict=True):
        assert a.tobytes() == b.tobytes()
    result = gyroflex.simulate(path, set={STIFFNESS: np.float64(9.5e3)})
    assert result.metadata[f"override.{STIFFNESS}"] == "9500.0"
    again = gyroflex.simulate(scenario(arm_file, "edited_sweep.yaml", SCENARIO.replace("robot.yaml", "edited.yaml")))
    assert result["q"].tobytes() == again["q"].tobytes()


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("drives.shoulder.transmission.stifness", 1.0, "`stiffness`"),
        ("contrller.kp", 1.0, "`controller`"),
        (STIFFNESS, "soft", "override"),
        (STIFFNESS, float("nan"), "not a finite number"),
        ("gravity", [0, np.inf, 0], "not a finite number"),
        (STIFFNESS, object(), "object"),
        (STIFFNESS, 1j, "complex"),
        ("gravity", np.zeros(2), "gravity"),
        ("gravity[7]", 0.0, "list of 3 items|not a list|no keys|gravity"),
    ],
)
def test_overrides_that_cannot_be_are_refused(path: Path, key: str, value: object, words: str) -> None:
    with pytest.raises(gyroflex.Error, match=words):
        gyroflex.simulate(path, set={key: value})


def test_a_list_that_contains_itself_is_refused(path: Path) -> None:
    endless: list[Any] = []
    endless.append(endless)
    with pytest.raises(gyroflex.ArgumentError, match="nested too deeply"):
        gyroflex.simulate(path, set={"gravity": endless})


def test_every_row_is_the_run_with_those_values(path: Path) -> None:
    table = sweep(path)
    assert table.swept == tuple(VALUES) and not table.failed.any()
    np.testing.assert_array_equal(table[STIFFNESS], np.repeat(VALUES[STIFFNESS], 2))
    np.testing.assert_array_equal(table["controller.kd"], [20, 30] * 3)
    for i in range(6):
        run = gyroflex.simulate(path, set={key: table[key][i] for key in VALUES})
        error = np.abs(run["tracking_error"])
        for k, joint in enumerate(run.joint_names):
            assert table[f"peak_tracking_error.{joint}"][i] == error[:, k].max()
            assert table[f"rms_tracking_error.{joint}"][i] == pytest.approx(np.sqrt((error[:, k] ** 2).mean()), rel=1e-12)
            assert set(table) >= {f"{name}.{joint}" for name in MEASURES}


def test_measures_of_ones_own_and_single_runs(path: Path) -> None:
    runs = [{"controller.kd": 20, "gravity": [0, 0, 0]}, {"controller.kd": 30, "gravity": np.array([0, 0, -9.81])}]
    table = sweep(path, runs, measure=largest_deflection)
    assert list(table) == ["controller.kd", "gravity", "deflection", "samples", "finite", "error"]
    assert table["finite"].dtype == bool and table["samples"].tolist() == [101, 101]
    assert json.loads(table["gravity"][1]) == [0, 0, -9.81]
    for i, run in enumerate(runs):
        assert table["deflection"][i] == largest_deflection(gyroflex.simulate(path, set=run))["deflection"]


def test_any_number_of_jobs_and_any_interruption_give_the_same_file(path: Path, tmp_path: Path) -> None:
    for ending in ("csv", "parquet"):
        if ending == "parquet":
            pytest.importorskip("pyarrow")
        whole = tmp_path / f"whole.{ending}"
        first = sweep(path, n_jobs=1, output=whole)
        assert os.listdir(tmp_path).count(f"whole.{ending}.journal") == 0
        for stop_after in (0, 1, 4):
            part, ended = tmp_path / f"part{stop_after}.{ending}", 0

            def stopping(result: gyroflex.SimulationResult) -> dict[str, Any]:
                nonlocal ended
                if ended == stop_after:
                    raise KeyboardInterrupt
                ended += 1
                return largest_deflection(result)

            with pytest.raises(KeyboardInterrupt):
                sweep(path, n_jobs=1, measure=stopping, output=part)
            assert not part.exists()
            journal = part.with_name(part.name + ".journal")
            assert len(journal.read_text().splitlines()) == 1 + stop_after
            # A line that was being written when the machine stopped.
            journal.write_text(journal.read_text() + "[5, {")
            resumed = sweep(path, n_jobs=2, measure=largest_deflection, output=part)
            assert same(resumed, sweep(path, measure=largest_deflection))
            assert part.exists() and not journal.exists()
        threads = tmp_path / f"threads.{ending}"
        assert same(first, sweep(path, n_jobs=4, output=threads))
        assert threads.read_bytes() == whole.read_bytes()


def test_files_hold_the_table(path: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    table = sweep(path, output=tmp_path / "table.parquet")
    read = parquet.read_table(tmp_path / "table.parquet").to_pydict()
    assert list(read) == list(table)
    assert all(np.array_equal(read[name], table[name], equal_nan=table[name].dtype == float) for name in table)
    sweep(path, output=tmp_path / "table.csv")
    with (tmp_path / "table.csv").open() as file:
        head, *rows = csv.reader(file)
    assert head == list(table)
    for name, column in zip(head, zip(*rows, strict=True), strict=True):
        if table[name].dtype == float:
            assert [float(x) if x else None for x in column] == [None if np.isnan(x) else x for x in table[name].tolist()]


def test_a_run_that_cannot_be_is_a_row_with_its_error(path: Path) -> None:
    table = sweep(path, {STIFFNESS: [1e13, 8e3], "controller.kd": [30]})
    assert table.failed.tolist() == [True, False]
    assert "step" in table["error"][0] and np.isnan(table["peak_torque.elbow"][0])
    diverged = sweep(path, {"controller.kp": [400, 1e7], "controller.kd": [30, 1e5], "duration": [0.2]}, measure=largest_deflection)
    assert not diverged.failed[0] and diverged.failed[3] and np.isnan(diverged["deflection"][3])


def test_what_would_meet_every_run_ends_the_sweep(path: Path, tmp_path: Path) -> None:
    with pytest.raises(gyroflex.FormatError, match="`stiffness`"):
        sweep(path, {"drives.shoulder.transmission.stifness": [1.0]})
    with pytest.raises(gyroflex.FileError, match=r"nowhere\.yaml"):
        sweep(tmp_path / "nowhere.yaml")
    with pytest.raises(ZeroDivisionError):
        sweep(path, measure=lambda _: {"x": 1 / 0})
    with pytest.raises(gyroflex.ArgumentError, match="measure"):
        sweep(path, measure=lambda _: {"error": 1.0})
    for values in ({STIFFNESS: []}, [], [{"a": 1}, {"b": 1}]):
        with pytest.raises(gyroflex.ArgumentError, match="values"):
            sweep(path, values)
    with pytest.raises(gyroflex.ArgumentError, match="n_jobs"):
        sweep(path, n_jobs=0)
    with pytest.raises(gyroflex.ArgumentError, match="output"):
        sweep(path, output=tmp_path / "table.xlsx")


def test_tables_and_journals_of_something_else_are_not_written_over(path: Path, tmp_path: Path) -> None:
    table = tmp_path / "table.csv"
    sweep(path, output=table)
    before = table.read_bytes()
    with pytest.raises(gyroflex.FileError, match="exists already"):
        sweep(path, output=table)
    sweep(path, output=table, overwrite=True)
    assert table.read_bytes() == before
    other = tmp_path / "other.csv"
    with pytest.raises(ZeroDivisionError):
        sweep(path, n_jobs=1, measure=lambda _: {"x": 1 / 0}, output=other)
    journal = tmp_path / "other.csv.journal"
    journal.write_text(journal.read_text() + json.dumps([0, {"x": 1.0}]) + "\n")
    with pytest.raises(gyroflex.FileError, match="other values"):
        sweep(path, {"controller.kd": [1.0]}, output=other)
    with pytest.raises(gyroflex.FileError, match="comes out otherwise"):
        sweep(path, output=other)


def slow(result: gyroflex.SimulationResult) -> dict[str, Any]:
    time.sleep(0.1)
    return largest_deflection(result)


@pytest.mark.filterwarnings("ignore")
def test_a_cluster_that_loses_a_worker_gives_the_same_file(path: Path, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    pytest.importorskip("pyarrow")
    values = {STIFFNESS: np.geomspace(2e3, 2e4, 10), "controller.kd": [20, 25, 30]}
    sweep(path, values, measure=slow, output=tmp_path / "here.parquet", n_jobs=4)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        client.wait_for_workers(2)
        victim = next(iter(cluster.workers.values())).pid
        threading.Timer(1.0, os.kill, (victim, signal.SIGKILL)).start()
        sweep(path, values, measure=slow, output=tmp_path / "cluster.parquet", client=client)
        assert victim not in {worker.pid for worker in cluster.workers.values()}
    assert (tmp_path / "cluster.parquet").read_bytes() == (tmp_path / "here.parquet").read_bytes()


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({STIFFNESS: 3e3}, "no list of values"),
        ({"robot.model": "rigid"}, "no list of values"),
        ([1, 2], "not every run is a mapping"),
        ({}, "nothing to run"),
        ([{STIFFNESS: 1e3}, {"controller.kd": 3.0}], "same keys"),
    ],
)
def test_values_that_are_none_are_refused(path: Path, values: Any, words: str) -> None:
    with pytest.raises(gyroflex.ArgumentError, match=words):
        sweep(path, values)


def test_a_measure_has_names_of_its_own(path: Path) -> None:
    with pytest.raises(gyroflex.ArgumentError, match="it measures"):
        sweep(path, {STIFFNESS: [3e3]}, measure=lambda _: {STIFFNESS: 1})
    with pytest.raises(gyroflex.ArgumentError, match="not a mapping"):
        sweep(path, {STIFFNESS: [3e3]}, measure=lambda _: None)


def test_a_call_that_ran_nothing_leaves_nothing_in_the_way(path: Path, tmp_path: Path) -> None:
    output = tmp_path / "runs.csv"
    with pytest.raises(gyroflex.Error):
        sweep(path, {"drives.shoulder.transmission.stifness": [3e3]}, output=output)
    assert sweep(path, {STIFFNESS: [3e3]}, output=output)["error"].tolist() == [""]
    with pytest.raises(gyroflex.FileError, match="folder"):
        sweep(path, output=tmp_path / "nowhere" / "runs.csv")


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        ("values", {5: [1.0]}),
        ("values", {STIFFNESS: [float("nan")]}),
        ("values", [{STIFFNESS: object()}]),
        ("values", 5),
        ("values", {STIFFNESS: np.array(3e3)}),
        ("n_jobs", 1.5),
        ("n_jobs", "2"),
        ("measure", 5),
        ("client", "scheduler:8786"),
        ("progress", np.zeros(2)),
        ("output", "a\0b.csv"),
    ],
)
def test_each_argument_is_blamed_for_itself(path: Path, argument: str, value: Any) -> None:
    with pytest.raises(gyroflex.ArgumentError) as caught:
        gyroflex.sweep(**{"scenario": path, "values": {STIFFNESS: [3e3]}, argument: value})  # type: ignore[arg-type]
    assert caught.value.element == f"argument `{argument}`"


def test_outputs_that_cannot_be_written_are_told_before_anything_runs(path: Path, tmp_path: Path) -> None:
    def never(_: gyroflex.SimulationResult) -> dict[str, Any]:
        raise AssertionError

    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "kept.csv.journal").mkdir()
    for name in ("folder.csv", "kept.csv"):
        with pytest.raises(gyroflex.FileError, match=name):
            sweep(path, output=tmp_path / name, overwrite=True, measure=never)
