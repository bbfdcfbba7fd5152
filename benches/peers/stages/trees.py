"""A tree of bodies and the three ways its readers want it written."""

import math
from typing import NamedTuple

import numpy as np

# dynibo has this value compiled in, so everybody gets it.
GRAVITY = 9.80665


class Body(NamedTuple):
    parent: int  # -1 is the world
    joint: str  # RX, RY, RZ or floating
    axis: np.ndarray
    rotation: np.ndarray  # of the joint frame in the parent's
    position: np.ndarray
    mass: float
    centre: np.ndarray
    inertia: np.ndarray  # at the centre of mass

    def moved_to(self, parent, mass, centre, inertia):
        return self._replace(parent=parent, mass=mass, centre=centre, inertia=inertia)


class Spring(NamedTuple):
    rotor_q: int
    rotor_v: int
    link_q: int
    link_v: int
    gear: float
    stiffness: float
    damping: float


def words(numbers):
    return " ".join(repr(float(x)) for x in np.ravel(numbers))


def tree_text(tree, springs, nq, nv):
    lines = [f"{len(tree)} {nq} {nv} {len(springs)} {GRAVITY}"]
    for b in tree:
        i = b.inertia
        inertia = [i[0, 0], i[0, 1], i[1, 1], i[0, 2], i[1, 2], i[2, 2]]
        numbers = np.concatenate([b.axis, b.rotation.ravel(), b.position, [b.mass], b.centre, inertia])
        lines.append(f"{b.parent} {b.joint} {words(numbers)}")
    lines += [f"{s.rotor_q} {s.rotor_v} {s.link_q} {s.link_v} {words(s[4:])}" for s in springs]
    return "\n".join(lines) + "\n"


def roll_pitch_yaw(r):
    yaw = math.atan2(r[1, 0], r[0, 0])
    pitch = math.atan2(-r[2, 0], math.hypot(r[0, 0], r[1, 0]))
    s, c = math.sin(yaw), math.cos(yaw)
    return math.atan2(s * r[0, 2] - c * r[1, 2], c * r[1, 1] - s * r[0, 1]), pitch, yaw


def urdf(name, tree):
    floating = tree[0].joint == "floating"
    lines = [f'<robot name="{name}">'] + ([] if floating else ['  <link name="world"/>'])
    for k, b in enumerate(tree):
        i = b.inertia
        terms = {"ixx": i[0, 0], "ixy": i[0, 1], "ixz": i[0, 2], "iyy": i[1, 1], "iyz": i[1, 2], "izz": i[2, 2]}
        inertia = " ".join(f'{key}="{words(value)}"' for key, value in terms.items())
        lines.append(f'  <link name="b{k}"><inertial><origin xyz="{words(b.centre)}" rpy="0 0 0"/>'
                     f'<mass value="{words(b.mass)}"/><inertia {inertia}/></inertial></link>')
        if b.joint == "floating":
            continue
        parent = "world" if b.parent < 0 else f"b{b.parent}"
        lines.append(f'  <joint name="j{k}" type="continuous">'
                     f'<origin xyz="{words(b.position)}" rpy="{words(roll_pitch_yaw(b.rotation))}"/>'
                     f'<parent link="{parent}"/><child link="b{k}"/><axis xyz="{words(b.axis)}"/></joint>')
    return "\n".join(lines) + "\n</robot>\n"


def quaternion(r):
    """w x y z, from the largest of its four components, so that nothing small is divided by."""
    trace = np.trace(r)
    squares = [trace, r[0, 0], r[1, 1], r[2, 2]]
    q = np.empty(4)
    k = int(np.argmax(squares))
    if k == 0:
        q[:] = 1 + trace, r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    else:
        a, b, c = k - 1, k % 3, (k + 1) % 3
        q[0] = r[c, b] - r[b, c]
        q[1 + a] = 1 + r[a, a] - r[b, b] - r[c, c]
        q[1 + b] = r[b, a] + r[a, b]
        q[1 + c] = r[c, a] + r[a, c]
    return q / np.linalg.norm(q)


def mjcf(name, tree):
    children = {}
    for k, b in enumerate(tree):
        children.setdefault(b.parent, []).append(k)
    lines = [f'<mujoco model="{name}">',
             '<compiler angle="radian" inertiafromgeom="false" balanceinertia="false" boundmass="0" boundinertia="0"/>',
             f'<option gravity="0 0 {-GRAVITY}"/>', "<worldbody>"]

    def add(k):
        b, i = tree[k], tree[k].inertia
        inertia = words([i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]])
        lines.append(f'<body name="b{k}" pos="{words(b.position)}" quat="{words(quaternion(b.rotation))}">'
                     f'<inertial pos="{words(b.centre)}" mass="{words(b.mass)}" fullinertia="{inertia}"/>')
        lines.append("<freejoint/>" if b.joint == "floating" else f'<joint type="hinge" axis="{words(b.axis)}"/>')
        for child in children.get(k, []):
            add(child)
        lines.append("</body>")

    for k in children[-1]:
        add(k)
    return "\n".join(lines) + "\n</worldbody>\n</mujoco>\n"
