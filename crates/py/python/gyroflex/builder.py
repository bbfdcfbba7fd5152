"""A robot put together link by link."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal
from xml.etree import ElementTree

from .errors import ArgumentError, NotFiniteError, ShapeError

__all__ = ["RobotBuilder"]


class RobotBuilder:
    """Collects links, joints and drives; ``gyroflex.Robot.from_builder`` makes a robot of them.

    What is collected is a URDF and its drives, and is checked when the robot is made. SI units; calls may be chained.

    >>> import gyroflex
    >>> arm = gyroflex.RobotBuilder("arm").link("base").link("upper", mass=2.0, com=(0.2, 0, 0), inertia=(0.01, 0.03, 0.03))
    >>> arm = arm.joint("shoulder", "base", "upper", axis=(0, 0, 1))
    >>> arm = arm.drive("shoulder", ratio=100, rotor={"inertia": 1e-4}, transmission={"stiffness": 8e3, "damping": 2.0})
    >>> gyroflex.Robot.from_builder(arm).joint_names
    ['shoulder']
    """

    def __init__(self, name: str) -> None:
        self.name = name
        #: Drives by the names of their joints, as in a robot's YAML.
        self.drives: dict[str, dict[str, Any]] = {}
        self._links: list[ElementTree.Element] = []
        self._joints: list[ElementTree.Element] = []

    def link(
        self,
        name: str,
        *,
        mass: float | None = None,
        com: Sequence[float] = (0, 0, 0),
        rpy: Sequence[float] = (0, 0, 0),
        inertia: Sequence[float] = (0, 0, 0),
    ) -> RobotBuilder:
        """Adds a link.

        Parameters
        ----------
        name
            Its name.
        mass
            Its mass [kg]; without one it is a frame only.
        com, rpy
            Centre of mass in the link's frame [m], and the axes of ``inertia`` there as roll, pitch, yaw [rad].
        inertia
            About the centre of mass: ``(xx, yy, zz)`` or ``(xx, yy, zz, xy, xz, yz)`` [kg m²].
        """
        link = ElementTree.Element("link", name=name)
        if mass is not None:
            inertial = ElementTree.SubElement(link, "inertial")
            ElementTree.SubElement(inertial, "origin", xyz=_words(com, 3, "com"), rpy=_words(rpy, 3, "rpy"))
            ElementTree.SubElement(inertial, "mass", value=_words([mass], 1, "mass"))
            if len(inertia) not in (3, 6) or any(isinstance(x, Sequence) or getattr(x, "ndim", 0) for x in inertia):
                problem = f"{len(inertia)} entries are given"
                raise ShapeError(problem, "argument `inertia`", "", "give xx, yy, zz, or these and xy, xz, yz")
            entries = [*inertia, 0, 0, 0][:6]
            names = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
            numbers = {of: _words([x], 1, "inertia") for of, x in zip(names, entries, strict=True)}
            ElementTree.SubElement(inertial, "inertia", numbers)
        self._links.append(link)
        return self

    def joint(
        self,
        name: str,
        parent: str,
        child: str,
        *,
        kind: Literal["revolute", "continuous", "prismatic", "fixed"] = "continuous",
        xyz: Sequence[float] = (0, 0, 0),
        rpy: Sequence[float] = (0, 0, 0),
        axis: Sequence[float] = (0, 0, 1),
        lower: float | None = None,
        upper: float | None = None,
        effort: float | None = None,
        velocity: float | None = None,
    ) -> RobotBuilder:
        """Adds a joint between two links.

        Parameters
        ----------
        name, parent, child
            Its name and those of the links.
        kind
            ``continuous``, ``revolute`` where the angle has limits, ``prismatic``, or ``fixed``.
        xyz, rpy
            Where the child's frame is in the parent's at zero [m, rad].
        axis
            The joint's axis in the child's frame.
        lower, upper, effort, velocity
            Limits [rad or m, N m or N, per s]; those left out are none.
        """
        joint = ElementTree.Element("joint", name=name, type=kind)
        ElementTree.SubElement(joint, "parent", link=parent)
        ElementTree.SubElement(joint, "child", link=child)
        ElementTree.SubElement(joint, "origin", xyz=_words(xyz, 3, "xyz"), rpy=_words(rpy, 3, "rpy"))
        if kind != "fixed":
            ElementTree.SubElement(joint, "axis", xyz=_words(axis, 3, "axis"))
        limits = {"lower": lower, "upper": upper, "effort": effort, "velocity": velocity}
        given = {key: _words([value], 1, key) for key, value in limits.items() if value is not None}
        if given:
            ElementTree.SubElement(joint, "limit", given)
        self._joints.append(joint)
        return self

    def drive(
        self,
        joint: str,
        *,
        ratio: float,
        rotor: Mapping[str, Any],
        transmission: Mapping[str, Any] | Literal["rigid"] | None = None,
        friction: Mapping[str, Any] | None = None,
        **more: Any,
    ) -> RobotBuilder:
        """Adds the drive of a joint, with the keys of a robot's YAML.

        Parameters
        ----------
        joint
            Name of the joint.
        ratio
            Rotor turns per joint turn, of either sign, or rotor radians per metre.
        rotor
            ``inertia`` about its spin axis, motor side [kg m²], and if known ``mass``, ``transverse_inertia``, ``mount``.
        transmission
            ``stiffness``, ``damping``, …, link side; ``"rigid"``, or none, for a rigid gear.
        friction
            ``motor`` and ``link``, each with ``viscous``, ``coulomb``, ….
        more
            Further keys of a drive, such as ``max_torque``.
        """
        if joint in self.drives:
            raise ArgumentError(f"`{joint}` has a drive already", "argument `joint`", remedy="give each joint one drive")
        _words([ratio], 1, "ratio")
        keys: dict[str, Any] = {"rotor": rotor, "gear_ratio": ratio, **more}
        if transmission is not None:
            keys["transmission"] = transmission
        if friction is not None:
            keys["friction"] = friction
        for key in ("rotor", "transmission", "friction"):
            if not isinstance(keys.get(key, {}), Mapping) and keys[key] != "rigid":
                raise ArgumentError(f"{keys[key]!r} has no keys", f"argument `{key}`", remedy="give a mapping, as in a robot's YAML")
        self.drives[joint] = keys
        return self

    def __repr__(self) -> str:
        return f"<RobotBuilder {self.name!r}: {len(self._links)} links, {len(self._joints)} joints, {len(self.drives)} drives>"

    def urdf(self) -> str:
        """The links and joints as a URDF."""
        robot = ElementTree.Element("robot", name=self.name)
        robot.extend(self._links)
        robot.extend(self._joints)
        ElementTree.indent(robot)
        return ElementTree.tostring(robot, encoding="unicode")


def _words(numbers: Sequence[float], count: int, name: str) -> str:
    """Numbers as a URDF has them, to the last bit."""
    if len(numbers) != count:
        raise ShapeError(f"{len(numbers)} numbers are given", f"argument `{name}`", "", f"give {count}")
    for x in numbers:
        if not math.isfinite(x):
            raise NotFiniteError(f"{x} is not a finite number", f"argument `{name}`", "", "give finite numbers")
    return " ".join(repr(float(x)) for x in numbers)
