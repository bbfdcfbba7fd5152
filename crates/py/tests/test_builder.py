"""Robots put together in Python."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gyroflex
import numpy as np
import pytest
from conftest import URDF, YAML, random_state


def builder() -> gyroflex.RobotBuilder:
    """The robot of the tests' files, link by link."""
    rotor = {"inertia": 1.0e-4, "mass": 0.5, "mount": {"link": "upper", "xyz": [0.1, 0, 0], "axis": [0.6, 0, 0.8]}}
    return (
        gyroflex.RobotBuilder("elastic_arm")
        .link("base", mass=4, com=(0, 0, 0.1), inertia=(0.05, 0.06, 0.04))
        .link("upper", mass=2.5, com=(0.2, 0.01, 0), inertia=(0.01, 0.04, 0.045, 0.001, 0, 0))
        .link("fore", mass=1.5, com=(0.15, 0, 0.02), inertia=(0.004, 0.02, 0.021, 0, 0.0005, 0))
        .link("slider", mass=0.6, com=(0, 0, 0.05), inertia=(0.002, 0.002, 0.001))
        .link("tool")
        .joint("shoulder", "base", "upper", kind="revolute", xyz=(0, 0, 0.3), rpy=(0.3, 0, 0), lower=-3, upper=3, velocity=5, effort=100)
        .joint("elbow", "upper", "fore", xyz=(0.4, 0, 0), rpy=(0, 0.5, 0), axis=(0, 1, 0))
        .joint("extend", "fore", "slider", kind="prismatic", xyz=(0.3, 0, 0), rpy=(0, 0, 0.2), axis=(1, 0, 0), lower=0, upper=0.5, velocity=1, effort=50)
        .joint("mount", "slider", "tool", kind="fixed", xyz=(0.1, 0, 0.05), rpy=(0, 1.5707963267948966, 0))
        .drive(
            "shoulder",
            ratio=100.0,
            rotor={"inertia": 2.0e-4, "mass": 0.8},
            transmission={"stiffness": 8.0e3, "damping": 4.0},
            friction={"motor": {"viscous": 1.0e-4, "coulomb": 0.02}},
        )
        .drive("elbow", ratio=-80.0, rotor=rotor, transmission={"stiffness": 3.0e3, "damping": 2.0, "cubic": 1.0e5})
    )


def test_a_built_robot_is_that_of_its_files() -> None:
    # The builder has no friction of the URDF's kind.
    urdf = URDF.replace('<dynamics damping="0.4" friction="0.2"/>', "")
    files = gyroflex.Robot.from_urdf(urdf, YAML)
    built = gyroflex.Robot.from_builder(builder(), model="complete")
    assert built.joint_names == files.joint_names and built.link_names == files.link_names
    state = random_state(files, np.random.default_rng(1))
    tau = np.array([1.0, 2.0, 3.0])
    for a, b in zip(built.forward_dynamics(**state, tau=tau), files.forward_dynamics(**state, tau=tau), strict=True):
        np.testing.assert_array_equal(a, b)


def test_a_urdf_is_its_text_or_its_path(tmp_path: Path) -> None:
    path = tmp_path / "elastic_arm.urdf"
    path.write_text(URDF)
    drives = builder().drives
    q = np.array([0.1, 0.2, 0.3])
    masses = [gyroflex.Robot.from_urdf(urdf, drives).mass_matrix(q) for urdf in (URDF, path, str(path))]
    masses.append(gyroflex.Robot.from_urdf(path, YAML).mass_matrix(q))
    for mass in masses[1:]:
        np.testing.assert_array_equal(mass, masses[0])
    with pytest.raises(gyroflex.FileError, match="nowhere"):
        gyroflex.Robot.from_urdf(tmp_path / "nowhere.urdf", YAML)


def test_what_is_built_wrong_is_refused() -> None:
    with pytest.raises(gyroflex.ShapeError, match="`com`.*2 numbers"):
        gyroflex.RobotBuilder("arm").link("base", mass=1, com=(0, 0))
    with pytest.raises(gyroflex.ShapeError, match="`inertia`"):
        gyroflex.RobotBuilder("arm").link("base", mass=1, inertia=(1, 1))
    with pytest.raises(gyroflex.NotFiniteError, match="`mass`"):
        gyroflex.RobotBuilder("arm").link("base", mass=float("nan"))
    with pytest.raises(gyroflex.Error, match="nobody"):
        gyroflex.Robot.from_builder(gyroflex.RobotBuilder("arm").link("base").joint("joint", "base", "nobody"))
    with pytest.raises(gyroflex.Error, match="nobody"):
        gyroflex.Robot.from_builder(builder().drive("nobody", ratio=1, rotor={"inertia": 1e-4}))


def links() -> gyroflex.RobotBuilder:
    return gyroflex.RobotBuilder("arm").link("base").link("upper", mass=1, inertia=(1, 1, 1))


@pytest.mark.parametrize(
    ("joint", "words"),
    [
        ({"lower": -1, "upper": 1}, "argument `lower`: a continuous joint"),
        ({"kind": "fixed", "velocity": 1}, "argument `velocity`: a fixed joint"),
        ({"kind": "revolute", "lower": -1}, "argument `upper`: it is missing"),
        ({"kind": "prismatic", "lower": 2, "upper": 1}, "argument `lower`: 2.0 is above"),
        ({"kind": "ball"}, "argument `kind`: 'ball'.*\n.*revolute, continuous"),
        ({"axis": "xyz"}, "argument `axis`"),
        ({"upper": 10**400}, "argument `upper`: it is too large"),
    ],
)
def test_limits_that_no_joint_would_have_are_refused(joint: dict[str, Any], words: str) -> None:
    with pytest.raises(gyroflex.ArgumentError, match=words):
        links().joint("joint", "base", "upper", **joint)


def test_limits_left_out_are_none() -> None:
    # A URDF without them has limits of zero, which would leave the joint no range at all.
    peaks = []
    for limits in ({}, {"effort": 5, "velocity": 2}, {"lower": -0.1, "upper": 0.1}):
        arm = gyroflex.RobotBuilder("arm").link("base").link("upper", mass=1, com=(0, 1, 0), inertia=(1, 1, 1))
        robot = gyroflex.Robot.from_builder(arm.joint("joint", "base", "upper", kind="revolute", axis=(1, 0, 0), **limits))  # type: ignore[arg-type]
        assert robot.warnings == []
        (joint,) = robot.analyze(samples=8, speed=1.0)["joints"]
        peaks.append(joint["tau_j"]["rms"])
    assert peaks[0] == peaks[1] != peaks[2]


def test_inertia_without_mass_is_refused() -> None:
    for given in ({"inertia": (1, 1, 1)}, {"com": (0, 0, 1)}):
        with pytest.raises(gyroflex.ArgumentError, match="argument `mass`: it is missing"):
            gyroflex.RobotBuilder("arm").link("base", **given)  # type: ignore[arg-type]


def test_texts_are_named_as_such_and_files_by_their_names(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(URDF.replace('<mass value="0.6"/>', '<mass value="-0.6"/>'))
    with pytest.raises(gyroflex.Error, match=r"^arm\.urdf.*slider"):
        gyroflex.Robot.from_urdf(path, YAML)
    with pytest.raises(gyroflex.FormatError, match="^the URDF text:10: joint `joint`.*`nobody`"):
        gyroflex.Robot.from_builder(links().joint("joint", "base", "nobody"))
    with pytest.raises(gyroflex.ModelError, match="^the YAML text:7: joint `shoulder`, gear_ratio"):
        gyroflex.Robot.from_urdf(URDF, YAML.replace("gear_ratio: 100.0", "gear_ratio: 0"))
    robots = [gyroflex.Robot.from_urdf(URDF, YAML), gyroflex.Robot.from_urdf(URDF, set={"gravity": [0, 0, -1.62]})]
    for robot in robots:
        assert "gyroflex codegen ROBOT --model" in robot.codegen("gravity").files["elastic_arm.py"]
    assert gyroflex.Robot.from_urdf(URDF.replace(' name="elastic_arm"', "")).name == "robot"


def test_what_is_no_builder_is_refused() -> None:
    with pytest.raises(gyroflex.ArgumentError, match="argument `builder`: it is of type `str`\n.*RobotBuilder"):
        gyroflex.Robot.from_builder("x")  # type: ignore[arg-type]
    arm = links().joint("joint", "base", "upper").drive("joint", ratio=2, rotor={"inertia": float("nan")})
    with pytest.raises(gyroflex.ArgumentError, match=r"argument `drives`: `drives\.joint\.rotor\.inertia`: NaN is not a finite"):
        gyroflex.Robot.from_builder(arm)


def test_drives_built_wrong_are_refused() -> None:
    with pytest.raises(gyroflex.ArgumentError, match="has a drive already"):
        builder().drive("shoulder", ratio=1, rotor={"inertia": 1e-4})
    with pytest.raises(gyroflex.NotFiniteError, match="`ratio`"):
        builder().drive("extend", ratio=float("nan"), rotor={"inertia": 1e-4})
    with pytest.raises(gyroflex.ArgumentError, match="`rotor`"):
        builder().drive("extend", ratio=1, rotor=1e-4)  # type: ignore[arg-type]
    with pytest.raises(gyroflex.ShapeError, match="`inertia`"):
        gyroflex.RobotBuilder("arm").link("base", mass=1, inertia=np.eye(3))  # type: ignore[arg-type]
    rigid = builder().drive("extend", ratio=20, rotor={"inertia": 1e-4}, transmission="rigid", max_torque=5.0)
    assert gyroflex.Robot.from_builder(rigid).drives["extend"].stiffness is None
