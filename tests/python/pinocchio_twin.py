"""The same robot in Pinocchio, spoken to in gyroflex's conventions.

| | gyroflex | Pinocchio |
|---|---|---|
| six-vectors | angular part first | linear part first |
| continuous joint | one angle | cosine and sine |
| order of joints | as loaded | alphabetical within the tree |
| `<dynamics>` of the URDF | in the equation of motion | not in `rnea` and `aba` |
"""

from __future__ import annotations

import contextlib
import os
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pinocchio

import gyroflex

ROOT_Q, ROOT_V = 7, 6
# Pinocchio's index of each of our six entries.
ANGULAR_FIRST = [3, 4, 5, 0, 1, 2]
# Velocity over which Coulomb friction turns [rad/s], our default.
SMOOTHING_VELOCITY = 0.01


@contextlib.contextmanager
def quiet_stderr() -> Iterator[None]:
    """Keeps what a C++ library prints about a file out of our table."""
    sys.stderr.flush()
    kept = os.dup(2)
    with open(os.devnull, "w") as null:
        os.dup2(null.fileno(), 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


class PinocchioTwin:
    """A URDF in Pinocchio; arrays in and out are gyroflex's."""

    def __init__(self, path: Path, floating: bool) -> None:
        root = (pinocchio.JointModelFreeFlyer(),) if floating else ()
        self.model = pinocchio.buildModelFromUrdf(str(path), *root)
        self.data = self.model.createData()
        self.floating = floating
        self.names = [n for n in self.model.names[1:]][int(floating) :]
        document = ElementTree.parse(path).getroot()
        self.links = [link.get("name") for link in document.findall("link")]
        self.dynamics = {j.get("name"): j.find("dynamics") for j in document.findall("joint")}
        self.order_as(self.names)

    def order_as(self, names: list[str]) -> None:
        """Sets the order of joints in all arrays."""
        self.joints = [self.model.joints[self.model.getJointId(name)] for name in names]
        root = ANGULAR_FIRST if self.floating else []
        # Pinocchio's index of each entry of ours.
        self.velocities = np.array(root + [joint.idx_v for joint in self.joints], dtype=int)

        def numbers(key: str) -> np.ndarray:
            elements = [self.dynamics[name] for name in names]
            return np.array([0.0] * len(root) + [float(e.get(key, 0.0)) if e is not None else 0.0 for e in elements])

        self.damping, self.coulomb = numbers("damping"), numbers("friction")

    def mismatch(self, robot: gyroflex.Robot) -> str:
        """What of joints or links differs, in words; empty if nothing does."""
        if sorted(robot.joint_names) != sorted(self.names):
            return f"joints differ: {sorted(set(robot.joint_names) ^ set(self.names))}"
        if sorted(robot.link_names) != sorted(self.links):
            return f"links differ: {sorted(set(robot.link_names) ^ set(self.links))}"
        root_q, root_v = (ROOT_Q, ROOT_V) if self.floating else (0, 0)
        sizes = (len(self.names) + root_q, len(self.names) + root_v)
        return "" if (robot.nq, robot.nv) == sizes else f"sizes are {(robot.nq, robot.nv)}, not {sizes}"

    def random_state(self, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """`q`, `qd`, `qdd` anywhere, limits or not."""
        root = np.empty(0)
        if self.floating:
            quaternion = rng.normal(size=4)
            root = np.concatenate([rng.uniform(-2.0, 2.0, 3), quaternion / np.linalg.norm(quaternion)])
        n = len(self.velocities)
        q = np.concatenate([root, rng.uniform(-np.pi, np.pi, len(self.joints))])
        return q, rng.normal(size=n), rng.normal(size=n)

    def q(self, ours: np.ndarray) -> np.ndarray:
        """Our positions in Pinocchio's coordinates."""
        theirs = np.empty(self.model.nq)
        skip = ROOT_Q if self.floating else 0
        theirs[:skip] = ours[:skip]
        for joint, angle in zip(self.joints, ours[skip:], strict=True):
            theirs[joint.idx_q : joint.idx_q + joint.nq] = [np.cos(angle), np.sin(angle)] if joint.nq == 2 else [angle]
        return theirs

    def v(self, ours: np.ndarray) -> np.ndarray:
        """Our velocities, accelerations or forces in Pinocchio's coordinates."""
        theirs = np.empty(self.model.nv)
        theirs[self.velocities] = ours
        return theirs

    def friction(self, qd: np.ndarray) -> np.ndarray:
        """Friction of the URDF's `<dynamics>` [N m or N]."""
        return self.damping * qd + self.coulomb * np.tanh(qd / SMOOTHING_VELOCITY)

    def inverse_dynamics(self, q: np.ndarray, qd: np.ndarray, qdd: np.ndarray) -> np.ndarray:
        tau = pinocchio.rnea(self.model, self.data, self.q(q), self.v(qd), self.v(qdd))
        return np.array(tau)[self.velocities] + self.friction(qd)

    def forward_dynamics(self, q: np.ndarray, qd: np.ndarray, tau: np.ndarray) -> np.ndarray:
        net = self.v(tau - self.friction(qd))
        return np.array(pinocchio.aba(self.model, self.data, self.q(q), self.v(qd), net))[self.velocities]

    def mass_matrix(self, q: np.ndarray) -> np.ndarray:
        upper = np.triu(pinocchio.crba(self.model, self.data, self.q(q)))
        full = upper + np.triu(upper, 1).T
        return full[np.ix_(self.velocities, self.velocities)]

    def placements(self, q: np.ndarray) -> dict[str, np.ndarray]:
        """Pose of every link of the URDF in the world, shape `(4, 4)`."""
        pinocchio.framesForwardKinematics(self.model, self.data, self.q(q))
        frames = {link: self.model.getFrameId(link, pinocchio.FrameType.BODY) for link in self.links}
        return {link: np.array(self.data.oMf[frame].homogeneous) for link, frame in frames.items()}
