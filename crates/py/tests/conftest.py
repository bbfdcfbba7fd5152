"""Robots the tests are about, and the command line program they compare with."""

from __future__ import annotations

import os
from pathlib import Path

import gyroflex
import numpy as np
import pytest

PROJECT = Path(__file__).parents[3]
MODELS = ("complete", "reduced", "rigid", "rigid_reflected")

URDF = """<?xml version="1.0"?>
<robot name="elastic_arm">
  <link name="base">
    <inertial><origin xyz="0 0 0.1"/><mass value="4"/>
      <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.06" iyz="0" izz="0.04"/></inertial>
  </link>
  <link name="upper">
    <inertial><origin xyz="0.2 0.01 0"/><mass value="2.5"/>
      <inertia ixx="0.01" ixy="0.001" ixz="0" iyy="0.04" iyz="0" izz="0.045"/></inertial>
  </link>
  <link name="fore">
    <inertial><origin xyz="0.15 0 0.02"/><mass value="1.5"/>
      <inertia ixx="0.004" ixy="0" ixz="0.0005" iyy="0.02" iyz="0" izz="0.021"/></inertial>
  </link>
  <link name="slider">
    <inertial><origin xyz="0 0 0.05"/><mass value="0.6"/>
      <inertia ixx="0.002" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.001"/></inertial>
  </link>
  <link name="tool"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 0.3" rpy="0.3 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="100" velocity="5"/>
  </joint>
  <joint name="elbow" type="continuous">
    <parent link="upper"/><child link="fore"/><origin xyz="0.4 0 0" rpy="0 0.5 0"/><axis xyz="0 1 0"/>
    <dynamics damping="0.4" friction="0.2"/>
  </joint>
  <joint name="extend" type="prismatic">
    <parent link="fore"/><child link="slider"/><origin xyz="0.3 0 0" rpy="0 0 0.2"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.5" effort="50" velocity="1"/>
  </joint>
  <joint name="mount" type="fixed">
    <parent link="slider"/><child link="tool"/><origin xyz="0.1 0 0.05" rpy="0 1.5707963267948966 0"/>
  </joint>
</robot>
"""

YAML = """
urdf: elastic_arm.urdf
model: complete
drives:
  shoulder:
    rotor: {inertia: 2.0e-4, mass: 0.8}
    gear_ratio: 100.0
    transmission: {stiffness: 8.0e3, damping: 4.0}
    friction: {motor: {viscous: 1.0e-4, coulomb: 0.02}}
  elbow:
    rotor: {inertia: 1.0e-4, mass: 0.5, mount: {link: upper, xyz: [0.1, 0, 0], axis: [0.6, 0, 0.8]}}
    gear_ratio: -80.0
    transmission: {stiffness: 3.0e3, damping: 2.0, cubic: 1.0e5}
"""


@pytest.fixture(scope="session")
def arm_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A robot of three joints: two elastic ones, and a sliding one without a drive."""
    folder = tmp_path_factory.mktemp("robot")
    (folder / "elastic_arm.urdf").write_text(URDF)
    (folder / "robot.yaml").write_text(YAML)
    return folder / "robot.yaml"


@pytest.fixture(scope="session")
def arm(arm_file: Path) -> gyroflex.Robot:
    return gyroflex.Robot.load(arm_file)


@pytest.fixture(scope="session")
def binary() -> Path:
    """The program `gyroflex`: `GYROFLEX_BIN`, or the newest one Cargo built."""
    if chosen := os.environ.get("GYROFLEX_BIN"):
        return Path(chosen)
    target = Path(os.environ.get("CARGO_TARGET_DIR", PROJECT / "target"))
    built = [p for p in (target / profile / "gyroflex" for profile in ("debug", "release")) if p.exists()]
    if not built:
        pytest.fail("no `gyroflex` program: run `cargo build -p gyroflex-cli`, or set GYROFLEX_BIN")
    return max(built, key=lambda p: p.stat().st_mtime)


def random_state(robot: gyroflex.Robot, rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Positions and velocities of joints and motors, the latter near the former; links that bend are bent a little."""
    joints, modes = len(robot.joint_names), len(robot.mode_names)
    angles = rng.uniform(-1.0, 1.0, joints)
    root = np.empty(0)
    if robot.floating:
        quaternion = rng.normal(size=4)
        root = np.concatenate([rng.normal(size=3), quaternion / np.linalg.norm(quaternion)])
    theta = np.zeros(robot.nv)
    theta[robot.nv - modes - joints : robot.nv - modes] = angles + rng.normal(scale=1e-3, size=joints)
    return {
        "q": np.concatenate([root, angles, rng.uniform(-1e-3, 1e-3, modes)]),
        "qd": rng.normal(size=robot.nv),
        "theta": theta,
        "thetad": rng.normal(size=robot.nv),
    }


def same_result(one: gyroflex.SimulationResult, other: gyroflex.SimulationResult) -> None:
    """Fails unless two results have the same numbers and impacts. Logs keep no sign of zeros."""
    assert list(one) == list(other)
    assert (one.units, one.columns, one.joint_names) == (other.units, other.columns, other.joint_names)
    for name in one:
        np.testing.assert_array_equal(one[name], other[name], err_msg=name)
    assert len(one.impacts) == len(other.impacts)
    for a, b in zip(one.impacts, other.impacts, strict=True):
        assert (a.time, a.energy_lost, a.contacts) == (b.time, b.energy_lost, b.contacts)
        np.testing.assert_array_equal(
            [a.impulse, a.velocity_before, a.velocity_after], [b.impulse, b.velocity_before, b.velocity_after]
        )
