"""A scenario in, arrays by name out."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import threading
import time
from pathlib import Path

import gyroflex
import numpy as np
import pytest
from conftest import PROJECT

SCENARIO = """
robot: robot.yaml
duration: 0.2
reference:
  shoulder: {type: sine, amplitude: 0.2, frequency: 1.0}
  elbow: {type: hold, at: 0.3}
  extend: {type: hold, at: 0.25}
controller: {type: pd, rate: 1000, kp: {default: 400}, kd: 30, gravity_compensation: true}
integrator: {method: rk4, step: 1.0e-4}
log: {rate: 500}
"""


def scenario(arm_file: Path, name: str, text: str = SCENARIO) -> Path:
    path = arm_file.parent / name
    path.write_text(text)
    return path


@pytest.fixture(scope="module")
def path(arm_file: Path) -> Path:
    return scenario(arm_file, "track.yaml")


@pytest.fixture(scope="module")
def result(path: Path) -> gyroflex.SimulationResult:
    return gyroflex.simulate(path)


def test_arrays_have_a_row_a_sample_and_a_column_a_joint(result: gyroflex.SimulationResult) -> None:
    assert result.joint_names == ("shoulder", "elbow", "extend")
    np.testing.assert_allclose(result.t, np.arange(101) / 500.0, rtol=0, atol=1e-12)
    for name in ("q", "qd", "qdd", "theta", "thetad", "thetadd", "tau", "tau_j", "deflection", "tracking_error"):
        assert result[name].shape == (101, 3), name
    assert result["kinetic_energy"].shape == (101,)
    assert set(result.units) == set(result)
    assert (result.units["q"], result.units["kinetic_energy"]) == (("rad", "rad", "m"), ("J",))
    assert all(np.isfinite(array).all() for array in result.values())


def test_samples_obey_the_equations_of_motion(result: gyroflex.SimulationResult, arm: gyroflex.Robot) -> None:
    for k in range(0, len(result.t), 10):
        state = [result[name][k] for name in ("q", "qd", "theta", "thetad")]
        qdd, thetadd = arm.forward_dynamics(*state, result["tau"][k])
        np.testing.assert_allclose(qdd, result["qdd"][k], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(thetadd, result["thetadd"][k], rtol=1e-9, atol=1e-9)


def test_arrays_cannot_be_written_to(result: gyroflex.SimulationResult) -> None:
    with pytest.raises(ValueError, match="read-only"):
        result["q"][0] = 0.0


def test_a_run_repeats_to_the_last_bit(path: Path, result: gyroflex.SimulationResult) -> None:
    again = gyroflex.simulate(path)
    assert all(again[name].tobytes() == result[name].tobytes() for name in result)


def test_log_and_program_have_the_same_numbers(path: Path, result: gyroflex.SimulationResult, binary: Path) -> None:
    ours, theirs = path.parent / "ours.mcap", path.parent / "theirs.csv"
    logged = gyroflex.simulate(str(path), log=ours)
    assert logged.log == str(ours)
    assert ours.read_bytes().startswith(b"\x89MCAP0\r\n")
    assert ours.read_bytes().endswith(b"\x89MCAP0\r\n")
    subprocess.run([binary, "simulate", path, "--quiet", "--csv", theirs, "-o", path.parent / "theirs.mcap"], check=True, capture_output=True)
    with theirs.open() as file:
        header, *rows = csv.reader(file)
    table = np.array(rows, dtype=float)
    for name in ("q", "theta", "tau", "tau_j"):
        for k, joint in enumerate(result.joint_names):
            unit = result.units[name][k]
            np.testing.assert_array_equal(table[:, header.index(f"{name}.{joint} [{unit}]")], result[name][:, k])


def test_other_threads_run_meanwhile(arm_file: Path) -> None:
    long = scenario(arm_file, "long.yaml", SCENARIO.replace("duration: 0.2", "duration: 2.0"))
    started = threading.Event()

    def run() -> None:
        started.set()
        gyroflex.simulate(long)

    thread = threading.Thread(target=run)
    thread.start()
    started.wait()
    ticks = 0
    while thread.is_alive():
        time.sleep(1e-3)
        ticks += 1
    assert ticks > 5


def test_ctrl_c_stops_a_run_and_completes_its_log(arm_file: Path, tmp_path: Path) -> None:
    endless = scenario(arm_file, "endless.yaml", SCENARIO.replace("duration: 0.2", "duration: 1.0e+6"))
    log = tmp_path / "log.mcap"
    program = (
        "import os, signal, threading, gyroflex\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # a test in the background inherits that it is ignored
        "threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
        f"gyroflex.simulate({str(endless)!r}, log={str(log)!r})\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False)
    assert "KeyboardInterrupt" in done.stderr
    assert log.read_bytes().endswith(b"\x89MCAP0\r\n")


def test_a_diverged_run_keeps_what_it_recorded(arm_file: Path, tmp_path: Path) -> None:
    text = SCENARIO.replace("kp: {default: 400}, kd: 30", "kp: 1.0e+7, kd: 1.0e+5").replace("duration: 0.2", "duration: 20.0")
    wild = scenario(arm_file, "wild.yaml", text)
    with pytest.warns(gyroflex.RobotWarning, match="kd"), pytest.raises(gyroflex.DivergedError) as caught:
        gyroflex.simulate(wild, log=tmp_path / "log.mcap")
    kept = caught.value.result
    assert kept is not None
    assert 0 < len(kept.t) < 10_000
    assert (tmp_path / "log.mcap").read_bytes().endswith(b"\x89MCAP0\r\n")


def test_a_scenario_that_cannot_be_is_refused(arm_file: Path, tmp_path: Path) -> None:
    with pytest.raises(gyroflex.FileError, match=r"nowhere\.yaml"):
        gyroflex.simulate(tmp_path / "nowhere.yaml")
    with pytest.raises(gyroflex.FormatError, match="durration"):
        gyroflex.simulate(scenario(arm_file, "typo.yaml", SCENARIO.replace("duration", "durration")))
    with pytest.raises(gyroflex.ScenarioError, match="wrist"):
        gyroflex.simulate(scenario(arm_file, "joint.yaml", SCENARIO.replace("elbow: {type", "wrist: {type")))
    with pytest.raises(gyroflex.FileError, match="log"):
        gyroflex.simulate(scenario(arm_file, "track.yaml"), log=tmp_path / "no" / "folder" / "log.mcap")


def test_a_walk_counts_its_steps_and_the_ground_only_pushes(tmp_path: Path) -> None:
    folder = PROJECT / "robots" / "biped5"
    text = (folder / "walk.yaml").read_text()
    for old, new in (("robot: robot.yaml", f"robot: {folder / 'robot.yaml'}"), ("duration: 15.0", "duration: 2.2")):
        assert old in text
        text = text.replace(old, new)
    walk = tmp_path / "walk.yaml"
    walk.write_text(text)
    result = gyroflex.simulate(walk)
    touched, carried = {}, np.zeros_like(result.t)
    for foot in ("left_foot", "right_foot"):
        force = result[f"contact.{foot}.force"]
        mode, gap = result[f"contact.{foot}.mode"], result[f"contact.{foot}.gap"]
        assert force.shape == (len(result.t), 3)
        assert (result.units[f"contact.{foot}.force"], result.units[f"contact.{foot}.gap"]) == (("N",) * 3, ("m",))
        on = mode > 0
        assert (force[on, 2] > 0).all() and (force[~on] == 0).all() and (force[:, 1] == 0).all()
        assert (np.abs(force[:, 0]) <= 0.8 * force[:, 2] + 1e-6).all()
        assert (np.abs(gap[on]) < 1e-6).all()
        touched[foot] = result.t[1:][on[1:] & ~on[:-1]]
        carried += force[:, 2]
    # Steps of 0.7 m at 1 m/s: feet come down in turn, 0.7 s apart.
    steps = sorted((t, foot) for foot, times in touched.items() for t in times)
    assert len(steps) == 3
    assert steps[0][1] == steps[2][1] != steps[1][1]
    np.testing.assert_allclose(np.diff([t for t, _ in steps]), 0.7, atol=0.02)
    # Over whole strides the ground carries the weight.
    whole = (result.t >= steps[0][0]) & (result.t < steps[2][0])
    weight = 9.81 * (14.79 + 2 * 5.28 + 2 * 2.23)
    assert carried[whole].mean() == pytest.approx(weight, rel=0.02)
    center = result["center_of_mass"]
    assert center.shape == (len(result.t), 3) and result["zero_moment_point"].shape == (len(result.t), 2)
    assert center[-1, 0] - center[0, 0] == pytest.approx(2.2, abs=0.1)
    assert result["constraint_drift"].max() < 1e-9
    # Every step is an impact of the foot that comes down: it was on its way down, and rests.
    blows = [(b.time, b.contacts[int(np.argmin(b.velocity_before[:, 2]))]) for b in result.impacts if b.velocity_before[:, 2].min() < -0.01]
    assert [foot for _, foot in blows] == [foot for _, foot in steps]
    np.testing.assert_allclose([t for t, _ in blows], [t for t, _ in steps], atol=2.1e-3)
    for blow in result.impacts:
        assert blow.impulse.shape == blow.velocity_after.shape == (len(blow.contacts), 3)
        assert (blow.impulse[:, 2] >= 0).all() and blow.energy_lost >= -1e-12


def test_result_is_a_mapping(result: gyroflex.SimulationResult) -> None:
    assert "q" in result
    assert "nothing" not in result
    assert list(result)[0] == "time"
    assert result["time"] is result.t
    assert "101 samples" in repr(result)
    json.dumps(result.metadata)
