"""A robot put together link by link."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal
from xml.etree import ElementTree

from . import _checks
from .errors import ArgumentError

KINDS = ("revolute", "continuous", "prismatic", "fixed")

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
        self.name = _checks.name("name", name)
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
        link = ElementTree.Element("link", name=_checks.name("name", name))
        origin = {"xyz": _triple("com", com), "rpy": _triple("rpy", rpy)}
        entries = [*_checks.numbers("inertia", inertia, 3, 6), 0.0, 0.0, 0.0][:6]
        if mass is not None:
            inertial = ElementTree.SubElement(link, "inertial")
            ElementTree.SubElement(inertial, "origin", origin)
            ElementTree.SubElement(inertial, "mass", value=_word("mass", mass))
            names = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
            ElementTree.SubElement(inertial, "inertia", {of: repr(x) for of, x in zip(names, entries, strict=True)})
        elif any(entries) or any(_checks.numbers("com", com, 3)):
            # They would be ignored without a word.
            raise _checks.refused("mass", "it is missing, but `inertia` or `com` is given", "give the mass, or leave them out")
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
            Limits [rad or m, N m or N, per s]; those left out are none. ``lower`` and ``upper`` are given both or not at all.
        """
        if not isinstance(kind, str) or kind not in KINDS:
            raise _checks.refused("kind", f"{_checks.shown(kind)} is no kind of joint", f"give one of {', '.join(KINDS)}")
        joint = ElementTree.Element("joint", name=_checks.name("name", name), type=kind)
        ElementTree.SubElement(joint, "parent", link=_checks.name("parent", parent))
        ElementTree.SubElement(joint, "child", link=_checks.name("child", child))
        ElementTree.SubElement(joint, "origin", xyz=_triple("xyz", xyz), rpy=_triple("rpy", rpy))
        direction = _triple("axis", axis)
        if kind != "fixed":
            ElementTree.SubElement(joint, "axis", xyz=direction)
        limits = {"lower": lower, "upper": upper, "effort": effort, "velocity": velocity}
        given = {key: _word(key, value) for key, value in limits.items() if value is not None}
        _check_limits(kind, given)
        if given:
            # What a URDF leaves out is a limit of zero.
            unlimited = {"lower": "-inf", "upper": "inf"} if kind != "continuous" else {}
            ElementTree.SubElement(joint, "limit", unlimited | given)
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
        if _checks.name("joint", joint) in self.drives:
            raise ArgumentError(f"`{joint}` has a drive already", "argument `joint`", remedy="give each joint one drive")
        keys: dict[str, Any] = {"rotor": rotor, "gear_ratio": _checks.number("ratio", ratio), **more}
        if transmission is not None:
            keys["transmission"] = transmission
        if friction is not None:
            keys["friction"] = friction
        for key in ("rotor", "transmission", "friction"):
            value = keys.get(key, {})
            if not (isinstance(value, Mapping) or (key == "transmission" and isinstance(value, str) and value == "rigid")):
                raise _checks.refused(key, f"{_checks.shown(value)} has no keys", "give a mapping, as in a robot's YAML")
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


def _word(argument: str, number: float) -> str:
    """A number as a URDF has it, to the last bit."""
    return repr(_checks.number(argument, number))


def _triple(argument: str, numbers: Sequence[float]) -> str:
    """Three numbers as a URDF has them."""
    return " ".join(map(repr, _checks.numbers(argument, numbers, 3)))


def _check_limits(kind: str, given: Mapping[str, str]) -> None:
    """Refuses limits that the robot would not have."""
    if kind == "fixed" and given:
        raise _checks.refused(next(iter(given)), "a fixed joint has no limits", "leave it out, or give another `kind`")
    range_ = [key for key in ("lower", "upper") if key in given]
    if kind == "continuous" and range_:
        raise _checks.refused(range_[0], "a continuous joint turns without limits", 'leave it out, or give `kind="revolute"`')
    if len(range_) == 1:
        missing = "upper" if range_ == ["lower"] else "lower"
        raise _checks.refused(missing, f"it is missing, but `{range_[0]}` is given", "give both limits, or none")
    if range_ and float(given["lower"]) > float(given["upper"]):
        raise _checks.refused("lower", f"{given['lower']} is above `upper`, {given['upper']}", "give the smaller one as `lower`")
