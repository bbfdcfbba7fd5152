"""The URDFs of `robots/` against the numbers of their sources, by the sources' own conventions.

Derivatives are taken by complex steps, which are exact to rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import gyroflex
import numpy as np
import pytest

ROBOTS = Path(__file__).parents[2] / "robots"
GRAVITY = 9.81
STEP = 1e-30

# PUMA 560, standard Denavit-Hartenberg (d, a, alpha), masses, centres of mass and inertias in DH frame i.
DH = [(0.67183, 0.0, np.pi / 2), (0.0, 0.4318, 0.0), (0.15005, 0.0203, -np.pi / 2)]
DH += [(0.4318, 0.0, np.pi / 2), (0.0, 0.0, -np.pi / 2), (0.0, 0.0, 0.0)]
PUMA_MASS = [0.0, 17.4, 4.8, 0.82, 0.34, 0.09]
PUMA_COM = [(0, 0, 0), (-0.3638, 0.006, 0.2275), (-0.0203, -0.0141, 0.070), (0, 0.019, 0), (0, 0, 0), (0, 0, 0.032)]
PUMA_INERTIA = [(0, 0.35, 0), (0.13, 0.524, 0.539), (0.066, 0.086, 0.0125)]
PUMA_INERTIA += [(1.8e-3, 1.3e-3, 1.8e-3), (0.3e-3, 0.4e-3, 0.3e-3), (0.15e-3, 0.15e-3, 0.04e-3)]

# Manutec r3, y up: axis of joint i, then from joint i to the next one, masses and centres of mass of what it carries.
R3_AXES = "yxxyxy"
R3_FIRST = (0, 0.351, 0)
R3_NEXT = [(0, 0.324, 0.3), (0, 0.65, 0), (0, 0.414, -0.155), (0, 0.186, 0), (0, 0.125, 0), (0, 0, 0)]
R3_MASSES = [
    [(1.0, (0, 0, 0))],
    [(56.5, (0.172, 0.205, 0))],
    [(26.4, (0.064, -0.034, 0))],
    [(28.7, (0, 0, 0))],
    [(5.2, (0, 0, 0))],
    [(0.5, (0.05, 0.05, 0.05)), (15.0, (0.1, 0.25, 0.1))],
]

# Lightweight arm: axes and where the joints stand, masses with their places from joint to joint, published N² J.
LWR_AXES = "zyzyzyz"
LWR_STEPS = [0.1, 0.1, 0.19, 0.19, 0.175, 0.175, 0.035, 0.035]
LWR_MASSES = [2.5, 3.0, 2.7, 2.4, 2.2, 1.9, 1.5, 0.8]
LWR_REFLECTED = [1.836, 4.447, 3.242, 1.817, 1.392, 1.402, 1.392]


def turn(axis: str, angle: complex) -> np.ndarray:
    """Rotation about a coordinate axis."""
    i = "xyz".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    r = np.eye(3, dtype=complex)
    r[j, j] = r[k, k] = np.cos(angle)
    r[k, j], r[j, k] = np.sin(angle), -np.sin(angle)
    return r


def derivative(f: Callable[[np.ndarray], np.ndarray], q: np.ndarray) -> np.ndarray:
    """Columns of df/dq."""
    return np.array([np.asarray(f(q + 1j * STEP * unit)).imag / STEP for unit in np.eye(len(q))]).T


def dh_frames(q: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Rotation and origin of DH frames 1 to 6."""
    r, p, frames = np.eye(3, dtype=complex), np.zeros(3, dtype=complex), []
    for angle, (d, a, alpha) in zip(q, DH, strict=True):
        r = r @ turn("z", angle)
        p = p + r @ np.array([a, 0.0, d])
        r = r @ turn("x", alpha)
        frames.append((r, p))
    return frames


def centres(q: np.ndarray) -> np.ndarray:
    """Centres of mass of the PUMA's links, shape `(6, 3)`."""
    return np.array([r @ np.array(c) + p for (r, p), c in zip(dh_frames(q), PUMA_COM, strict=True)])


def dh_mass_matrix(q: np.ndarray) -> np.ndarray:
    """`Σ m Jᵀ J + Jωᵀ I Jω` of the PUMA's links."""
    frames = dh_frames(q)
    axes = [np.array([0.0, 0.0, 1.0])] + [r[:, 2].real for r, _ in frames[:-1]]
    slopes = derivative(lambda x: centres(x).ravel(), q).reshape(6, 3, 6)
    total = np.zeros((6, 6))
    for i, (r, _) in enumerate(frames):
        spin = np.zeros((3, 6))
        spin[:, : i + 1] = np.transpose(axes[: i + 1])
        inertia = r.real @ np.diag(PUMA_INERTIA[i]) @ r.real.T
        total += PUMA_MASS[i] * slopes[i].T @ slopes[i] + spin.T @ inertia @ spin
    return total


def r3_potential(q: np.ndarray) -> np.ndarray:
    """Potential energy of the Manutec r3, from the source's chain."""
    r, p, energy = np.eye(3, dtype=complex), np.array(R3_FIRST, dtype=complex), 0.0
    for axis, angle, step, masses in zip(R3_AXES, q, R3_NEXT, R3_MASSES, strict=True):
        r = r @ turn(axis, angle)
        energy = energy + GRAVITY * sum(m * (p + r @ np.array(c))[1] for m, c in masses)
        p = p + r @ np.array(step)
    return energy


def lwr_potential(q: np.ndarray) -> np.ndarray:
    """Potential energy of the lightweight arm: every mass half-way to the next joint. The foot has none."""
    r, height, energy = np.eye(3, dtype=complex), LWR_STEPS[0], 0.0
    for axis, angle, step, mass in zip(LWR_AXES, q, LWR_STEPS[1:], LWR_MASSES[1:], strict=True):
        r = r @ turn(axis, angle)
        energy = energy + GRAVITY * mass * (height + r[2, 2] * step / 2)
        height = height + r[2, 2] * step
    return energy


def holding_torques(robot: gyroflex.Robot, q: np.ndarray) -> np.ndarray:
    still = np.zeros(robot.nv)
    return robot.inverse_dynamics(q, still, still, model="rigid")[1]


@pytest.fixture(scope="module")
def puma() -> gyroflex.Robot:
    with pytest.warns(gyroflex.RobotWarning, match="triangle"):
        return gyroflex.Robot.load(ROBOTS / "puma560" / "robot.yaml")


@pytest.fixture
def poses() -> np.ndarray:
    return np.random.default_rng(560).uniform(-3.0, 3.0, (100, 6))


def test_puma_links_stand_where_denavit_and_hartenberg_put_them(puma: gyroflex.Robot, poses: np.ndarray) -> None:
    for q in poses:
        frames = [(np.eye(3), np.zeros(3)), *dh_frames(q)]
        for i, angle in enumerate(q):
            r, p = frames[i]
            pose = puma.placement(f"link{i + 1}", q)
            np.testing.assert_allclose(pose[:3, :3], (r @ turn("z", angle)).real, rtol=0, atol=1e-13)
            np.testing.assert_allclose(pose[:3, 3], p.real, rtol=0, atol=1e-13)


def test_puma_is_held_by_the_slope_of_its_potential_energy(puma: gyroflex.Robot, poses: np.ndarray) -> None:
    for q in poses:
        slope = derivative(lambda x: GRAVITY * (np.array(PUMA_MASS) @ centres(x)[:, 2]), q)
        np.testing.assert_allclose(holding_torques(puma, q), slope, rtol=0, atol=1e-12)


def test_puma_links_have_the_published_inertia_matrix(puma: gyroflex.Robot, poses: np.ndarray) -> None:
    for q in poses:
        np.testing.assert_allclose(puma.mass_matrix(q, model="reduced"), dh_mass_matrix(q), rtol=0, atol=1e-13)


def test_manutec_is_held_by_the_slope_of_its_potential_energy(poses: np.ndarray) -> None:
    robot = gyroflex.Robot.load(ROBOTS / "manutec_r3" / "robot.yaml")
    for q in poses:
        np.testing.assert_allclose(holding_torques(robot, q), derivative(r3_potential, q), rtol=0, atol=1e-10)


def test_manutec_start_pose_takes_the_published_torques() -> None:
    robot = gyroflex.Robot.load(ROBOTS / "manutec_r3" / "robot.yaml")
    torques = holding_torques(robot, np.deg2rad([-60.0, 20.0, 90.0, 0.0, -110.0, 0.0]))
    np.testing.assert_allclose(torques[1:3], [-460.5734, -256.4001], rtol=0, atol=5e-5)


def test_lwr_is_as_long_and_as_heavy_as_the_paper_says() -> None:
    robot = gyroflex.Robot.load(ROBOTS / "lwr" / "robot.yaml")
    assert robot.placement("tool", np.zeros(7))[2, 3] == pytest.approx(1.0, abs=1e-15)
    masses = [float(m.attrib["value"]) for m in ElementTree.parse(ROBOTS / "lwr" / "lwr.urdf").iter("mass")]
    assert masses == LWR_MASSES
    assert sum(masses) == pytest.approx(17.0, abs=1e-12)


def test_lwr_has_the_published_reflected_inertias() -> None:
    robot = gyroflex.Robot.load(ROBOTS / "lwr" / "robot.yaml")
    q = np.zeros(7)
    reflected = np.diag(robot.mass_matrix(q, model="rigid_reflected") - robot.mass_matrix(q, model="reduced"))
    np.testing.assert_allclose(reflected, LWR_REFLECTED, rtol=0, atol=5e-4)


def test_lwr_is_held_by_the_slope_of_its_potential_energy() -> None:
    robot = gyroflex.Robot.load(ROBOTS / "lwr" / "robot.yaml")
    for q in np.random.default_rng(2).uniform(-3.0, 3.0, (100, 7)):
        np.testing.assert_allclose(holding_torques(robot, q), derivative(lwr_potential, q), rtol=0, atol=1e-11)
