"""`embedded/compare` lets pass what is recorded, within limits and independent of the data, and nothing else."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "embedded" / "compare"
COMPILER = "rustc 1.96.0 (somewhere)"
GOOD = {"m7 rnea_complete": (4000, 4000), "m4f rnea_complete": (5000, 5000), "m7 crba": (6000, 6000)}


def write(path, counts, compiler=COMPILER):
    rows = "".join(f"{name} {least} {most}\n" for name, (least, most) in counts.items())
    path.write_text(f"# compiler: {compiler}\n{rows}", encoding="utf-8")
    return path


def compare(folder, counts, *options, compiler=COMPILER):
    counts = write(folder / "counts.txt", counts)
    call = [sys.executable, SCRIPT, counts, folder / "recorded.txt", compiler, *options]
    return subprocess.run(call, capture_output=True, text=True, check=False)


@pytest.fixture
def folder(tmp_path):
    write(tmp_path / "recorded.txt", GOOD)
    return tmp_path


def test_what_is_recorded_passes_and_three_percent_either_way_too(folder):
    for count in [6000, 6180, 5820]:
        run = compare(folder, {**GOOD, "m7 crba": (count, count)})
        assert run.returncode == 0, run.stderr


@pytest.mark.parametrize(
    ("counts", "words"),
    [
        ({"m7 crba": (6181, 6181)}, ["m7 crba", "more than recorded", "--record"]),
        ({"m7 crba": (5819, 5819)}, ["m7 crba", "fewer than recorded", "--record"]),
        ({"m7 crba": (6000, 6001)}, ["m7 crba", "branch on values"]),
        ({"m7 rnea_complete": (4501, 4501)}, ["m7 rnea_complete", "at most 4500"]),
        ({"m4f rnea_complete": (5851, 5851)}, ["m4f rnea_complete", "at most 5850"]),
        ({"m7 jacobian": (10, 10)}, ["m7 jacobian", "not recorded"]),
    ],
)
def test_what_moved_depends_on_data_or_exceeds_its_limit_fails_by_name(folder, counts, words):
    run = compare(folder, {**GOOD, **counts})
    assert run.returncode == 1
    assert all(word in run.stderr for word in words), run.stderr


def test_another_release_of_the_compiler_is_not_compared_but_held_to_the_limits(folder):
    other = "rustc 1.97.1 (elsewhere)"
    run = compare(folder, {**GOOD, "m7 crba": (7000, 7000)}, compiler=other)
    assert run.returncode == 0 and "not compared" in run.stdout
    assert compare(folder, {**GOOD, "m7 rnea_complete": (4501, 4501)}, compiler=other).returncode == 1


def test_recording_writes_what_was_counted(folder):
    moved = {**GOOD, "m7 crba": (7000, 7000)}
    assert compare(folder, moved, "--record").returncode == 0
    assert compare(folder, moved).returncode == 0
    assert compare(folder, GOOD).returncode == 1
