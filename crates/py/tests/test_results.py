"""Results of runs as tables and logs."""

from __future__ import annotations

import csv
import pickle
import subprocess
import sys
from pathlib import Path

import gyroflex
import numpy as np
import pytest
from conftest import PROJECT, same_result
from mcap.reader import make_reader

RUNS = ("planar_3r/track.yaml", "biped5/walk.yaml", "book_two_link/move.yaml")


@pytest.fixture(scope="module", params=RUNS)
def logged(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[gyroflex.SimulationResult, Path]:
    """A second of a run of a shipped scenario, and its log."""
    folder = tmp_path_factory.mktemp("run")
    shipped = PROJECT / "robots" / request.param
    lines = shipped.read_text().splitlines()
    assert sum(line.startswith(("robot:", "duration:")) for line in lines) == 2
    robot = shipped.parent / next(line.split()[1] for line in lines if line.startswith("robot:"))
    lines = [line for line in lines if not line.startswith(("robot:", "duration:"))]
    scenario = folder / "scenario.yaml"
    scenario.write_text("\n".join([f"robot: {robot}", "duration: 1.0", *lines]))
    return gyroflex.simulate(scenario, log=folder / "log.mcap"), folder / "log.mcap"


def test_a_log_has_the_numbers_of_the_result(logged: tuple[gyroflex.SimulationResult, Path]) -> None:
    result, log = logged
    again = gyroflex.read_mcap(log)
    same_result(again, result)
    assert again.metadata == result.metadata
    assert again.log == str(log)


def test_a_log_written_afterwards_has_the_messages_of_one_written_on_the_way(
    logged: tuple[gyroflex.SimulationResult, Path], tmp_path: Path
) -> None:
    result, log = logged
    late, copy = tmp_path / "late.mcap", tmp_path / "copy.mcap"
    result.to_mcap(late)
    gyroflex.read_mcap(log).to_mcap(copy)
    assert copy.read_bytes() == log.read_bytes()

    def contents(path: Path) -> list[object]:
        with path.open("rb") as file:
            reader = make_reader(file)
            told = [(a.name, a.data) for a in reader.iter_attachments()]
            told += [(m.name, m.metadata) for m in reader.iter_metadata()]
            messages = reader.iter_messages(log_time_order=False)
            return told + [(channel.topic, m.log_time, m.sequence, m.data) for _, channel, m in messages]

    assert contents(late) == contents(log)


def test_a_table_has_a_row_a_sample_and_the_columns_of_csv_files(
    logged: tuple[gyroflex.SimulationResult, Path], binary: Path, tmp_path: Path
) -> None:
    result, log = logged
    frame = result.to_pandas()
    assert frame.index.name == "time"
    np.testing.assert_array_equal(frame.index.to_numpy(), result.t)
    scenario = log.parent / "scenario.yaml"
    subprocess.run([binary, "simulate", scenario, "--quiet", "--csv", tmp_path / "a.csv", "-o", tmp_path / "a.mcap"], check=True, capture_output=True)
    with (tmp_path / "a.csv").open() as file:
        header, *rows = csv.reader(file)
    wanted = [i for i, name in enumerate(header) if not name.startswith(("time", "frame."))]
    units = frame.attrs["units"]
    assert [header[i] for i in wanted] == [f"{name} [{units[name]}]" for name in frame.columns]
    np.testing.assert_array_equal(frame.to_numpy(), np.array(rows, dtype=float)[:, wanted])


def test_copies_for_other_processes_hold_the_arrays(logged: tuple[gyroflex.SimulationResult, Path], tmp_path: Path) -> None:
    result, log = logged
    again = pickle.loads(pickle.dumps(result))
    same_result(again, result)
    again.to_mcap(tmp_path / "copy.mcap")
    assert (tmp_path / "copy.mcap").read_bytes() == log.read_bytes()


def test_a_copy_without_a_log_says_how_to_get_one(arm_file: Path, tmp_path: Path) -> None:
    scenario = arm_file.parent / "short.yaml"
    scenario.write_text("{robot: robot.yaml, duration: 0.01, integrator: {method: rk4, step: 1.0e-4}}")
    result = gyroflex.simulate(scenario)
    with pytest.raises(gyroflex.ArgumentError, match="give `log`"):
        pickle.loads(pickle.dumps(result)).to_mcap(tmp_path / "log.mcap")
    with pytest.raises(gyroflex.FileError, match="no"):
        result.to_mcap(tmp_path / "no" / "log.mcap")


def test_a_log_cut_short_gives_what_reached_the_file(logged: tuple[gyroflex.SimulationResult, Path], tmp_path: Path) -> None:
    result, log = logged
    cut = tmp_path / "cut.mcap"
    # The index at the end is gone, the chunks are there.
    cut.write_bytes(log.read_bytes()[:-8])
    with pytest.warns(gyroflex.RobotWarning, match=r"cut\.mcap: the log was cut short"):
        again = gyroflex.read_mcap(cut)
    same_result(again, result)
    assert again.metadata == result.metadata
    assert len(again.warnings) == 1


def test_what_is_no_log_is_refused(tmp_path: Path) -> None:
    with pytest.raises(gyroflex.FileError, match=r"nowhere\.mcap"):
        gyroflex.read_mcap(tmp_path / "nowhere.mcap")
    (tmp_path / "text.mcap").write_text("time,q\n" * 10)
    with pytest.raises(gyroflex.FileError, match=r"text\.mcap"):
        gyroflex.read_mcap(tmp_path / "text.mcap")


def test_a_missing_extra_is_named(arm_file: Path) -> None:
    program = (
        "import sys\n"
        "sys.modules['pandas'] = None\n"
        "import gyroflex\n"
        "from gyroflex._extras import extra\n"
        "try:\n    extra('pandas', 'pandas')\n"
        "except gyroflex.MissingExtraError as e:\n    print(e.remedy)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == 'run `pip install "./crates/py[pandas]"` in the repository of gyroflex'
