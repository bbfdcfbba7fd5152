"""The robots of the comparison, their states, and what every program must find there.

Run by the Python of the environment that `run install` makes: `models.py FOLDER`. For each robot:
  NAME.tree      the bodies, for programs that take them one by one
  NAME.urdf      the same tree with the joints named j0, j1, … in its order
  NAME.xml       the same for MuJoCo
  NAME.states    256 × [q, v, a, u], little-endian f64
  NAME.expected  256 × [accelerations for u, torques for a, M(q) a, 12 numbers a body for its pose], from Pinocchio's Python module
  NAME.derivatives  256 × [∂v̇/∂q a, ∂v̇/∂v a, ∂v̇/∂u u, ∂τ/∂q a, ∂τ/∂v a]: accelerations with the springs, torques without them
  NAME.still     accelerations of state 0 without torques and springs
  NAME.feet and NAME.held of a robot that stands: see feet.py
NAME_flex is the robot with a rotor on the previous link for every joint: a body of its own in these files, a drive in
NAME_flex.yaml, which is what gyroflex reads. Coordinates run rotor, link, rotor, link, …
"""

import sys
from pathlib import Path

import feet
import numpy as np
import pinocchio as pin
from trees import GRAVITY, Body, Spring, mjcf, tree_text, urdf

STATES = 256
LOCAL = pin.Convention.LOCAL

# One table for all robots: mass [kg], spin inertia, transverse inertia [kg m²], for the first, middle and last third of the
# joints. The sizes are those of frameless motors in arms of 5 to 20 kg payload; times do not depend on them.
ROTORS = [(0.9, 1.0e-4, 2.4e-4), (0.6, 5.0e-5, 1.5e-4), (0.3, 1.5e-5, 7.0e-5)]
GEAR, STIFFNESS, DAMPING = 100.0, 1.0e4, 10.0  # rotor turns a joint turn, N m/rad, N m s/rad

# Links that are held in constrained dynamics.
FEET = {"talos": ["left_sole_link", "right_sole_link"]}


def source(*parts):
    for folder in map(Path, sys.path):
        path = folder.joinpath("cmeel.prefix/share/example-robot-data/robots", *parts)
        if path.is_file():
            return str(path)
    raise SystemExit(f"{parts[-1]} is not installed: run the stage `install`")


def bodies(model):
    kinds = {"JointModelRX": "RX", "JointModelRY": "RY", "JointModelRZ": "RZ", "JointModelFreeFlyer": "floating"}
    axes = {"RX": (1, 0, 0), "RY": (0, 1, 0), "RZ": (0, 0, 1), "floating": (0, 0, 0)}
    found = []
    for i in range(1, model.njoints):
        kind = kinds[model.joints[i].shortname()]
        pose, inertia = model.jointPlacements[i], model.inertias[i]
        found.append(Body(model.parents[i] - 1, kind, np.array(axes[kind], float), pose.rotation, pose.translation,
                          inertia.mass, inertia.lever, inertia.inertia))
    return found


def rotor_of(joint, joints):
    return ROTORS[len(ROTORS) * joint // joints]


def with_rotors(links):
    """Each turning joint's rotor as a body about the same axis on the same link, and the spring between them."""
    tree, springs, place = [], [], {-1: -1}
    floating = links[0].joint == "floating"
    joints = len(links) - floating
    for i, link in enumerate(links):
        if link.joint != "floating":
            mass, spin, transverse = rotor_of(i - floating, joints)
            inertia = transverse * np.eye(3) + (spin - transverse) * np.outer(link.axis, link.axis)
            tree.append(link.moved_to(place[link.parent], mass, np.zeros(3), inertia))
            q, v = (len(tree) + 5, len(tree) + 4) if floating else (len(tree) - 1, len(tree) - 1)
            springs.append(Spring(q, v, q + 1, v + 1, GEAR, STIFFNESS, DAMPING))
        tree.append(link.moved_to(place[link.parent], link.mass, link.centre, link.inertia))
        place[i] = len(tree) - 1
    return tree, springs, place


def drives(name, links):
    """The rotors for gyroflex, whose default mount is the joint frame on the parent link."""
    floating = links[0].joint == "floating"
    lines = [f"urdf: {name}.urdf", "model: complete", f"gravity: [0, 0, {-GRAVITY}]", f"floating: {str(floating).lower()}"]
    joints = [i for i, link in enumerate(links) if link.joint != "floating"]
    with_drives = [*lines, "drives:"]
    for number, i in enumerate(joints):
        mass, spin, transverse = rotor_of(number, len(joints))
        with_drives += [f"  j{i}:", f"    rotor: {{inertia: {spin}, mass: {mass}, transverse_inertia: {transverse}}}",
                        f"    gear_ratio: {GEAR}", f"    transmission: {{stiffness: {STIFFNESS}, damping: {DAMPING}}}"]
    return "\n".join(lines) + "\n", "\n".join(with_drives) + "\n"


def pinocchio_model(tree):
    model = pin.Model()
    model.gravity.linear = np.array([0, 0, -GRAVITY])
    kinds = {"RX": pin.JointModelRX, "RY": pin.JointModelRY, "RZ": pin.JointModelRZ, "floating": pin.JointModelFreeFlyer}
    for i, body in enumerate(tree):
        joint = model.addJoint(body.parent + 1, kinds[body.joint](), pin.SE3(body.rotation, body.position), f"j{i}")
        model.appendBodyToJoint(joint, pin.Inertia(body.mass, body.centre, body.inertia), pin.SE3.Identity())
    return model


def random_state(random, model, springs, floating):
    nq, nv = model.nq, model.nv
    q = random.uniform(-np.pi, np.pi, nq)
    v, a, u = random.uniform(-1, 1, (3, nv))
    if floating:
        q[:3] *= 0.3
        q[3:7] = random.normal(size=4)
        q[3:7] /= np.linalg.norm(q[3:7])
    for s in springs:
        q[s.rotor_q] = s.gear * (q[s.link_q] + random.uniform(-1e-3, 1e-3))
        v[s.rotor_v] = s.gear * (v[s.link_v] + random.uniform(-1e-2, 1e-2))
        a[s.rotor_v] *= s.gear
        u[s.link_v] = 0
    return q, v, a, u


def spring_torques(springs, q, v):
    torques = np.zeros(len(v))
    for s in springs:
        f = s.stiffness * (q[s.rotor_q] / s.gear - q[s.link_q]) + s.damping * (v[s.rotor_v] / s.gear - v[s.link_v])
        torques[s.link_v] += f
        torques[s.rotor_v] -= f / s.gear
    return torques


def spring_slopes(springs, nv):
    """How the springs' torques change with positions and with velocities."""
    slopes = np.zeros((2, nv, nv))
    for s in springs:
        turns = np.zeros(nv)
        turns[s.rotor_v], turns[s.link_v] = 1 / s.gear, -1
        slopes -= np.multiply.outer([s.stiffness, s.damping], np.outer(turns, turns))
    return slopes


def derivatives(model, data, state, spring, slopes):
    """The columns of NAME.derivatives."""
    q, v, a, u = state
    pin.computeABADerivatives(model, data, q, v, u + spring)
    inverse = data.Minv
    forward = [(data.ddq_dq + inverse @ slopes[0]) @ a, (data.ddq_dv + inverse @ slopes[1]) @ a, inverse @ u]
    pin.computeRNEADerivatives(model, data, q, v, a)
    return np.concatenate([*forward, data.dtau_dq @ a, data.dtau_dv @ a])


def write(folder, name, tree, springs, stands):
    model = pinocchio_model(tree)
    data = model.createData()
    floating = tree[0].joint == "floating"
    random = np.random.default_rng(model.nv)
    slopes = spring_slopes(springs, model.nv)
    states, expected, slope, still, loads = [], [], [], None, []
    for _ in range(STATES):
        q, v, a, u = random_state(random, model, springs, floating)
        spring = spring_torques(springs, q, v)
        forward = pin.aba(model, data, q, v, u + spring, LOCAL).copy()
        inverse = pin.rnea(model, data, q, v, a) - spring
        upper = np.triu(pin.crba(model, data, q, LOCAL))
        momentum = (upper + np.triu(upper, 1).T) @ a
        pin.forwardKinematics(model, data, q)
        poses = [x for pose in data.oMi[1:] for x in (*pose.rotation.ravel(), *pose.translation)]
        if still is None:
            still = pin.aba(model, data, q, v, np.zeros(model.nv), LOCAL).copy()
        states.append(np.concatenate([q, v, a, u]))
        loads.append((q, v, u))
        expected.append(np.concatenate([forward, inverse, momentum, poses]))
        slope.append(derivatives(model, data, (q, v, a, u), spring, slopes))
    for kind, numbers in [("states", states), ("expected", expected), ("derivatives", slope), ("still", still)]:
        np.asarray(numbers, "<f8").tofile(folder / f"{name}.{kind}")
    if stands:
        feet.write(folder, name, model, stands, loads, springs, spring_torques)
    (folder / f"{name}.tree").write_text(tree_text(tree, springs, model.nq, model.nv))
    (folder / f"{name}.urdf").write_text(urdf(name, tree))
    (folder / f"{name}.xml").write_text(mjcf(name, tree))
    print(f"{name}: {len(tree)} bodies, {model.nv} velocity coordinates")


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    panda = pin.buildModelFromUrdf(source("panda_description", "urdf", "panda.urdf"))
    fingers = [i for i in range(1, panda.njoints) if "finger" in panda.names[i]]
    robots = {
        "panda": pin.buildReducedModel(panda, fingers, pin.neutral(panda)),
        "ur5": pin.buildModelFromUrdf(source("ur_description", "urdf", "ur5_robot.urdf")),
        "talos": pin.buildModelFromUrdf(source("talos_data", "robots", "talos_reduced.urdf"), pin.JointModelFreeFlyer()),
    }
    for name, model in robots.items():
        links = bodies(model)
        tree, springs, place = with_rotors(links)
        stands = feet.feet_of(model, FEET.get(name, []))
        write(folder, name, links, [], [(link, link, pose) for link, pose in stands])
        write(folder, f"{name}_flex", tree, springs, [(link, place[link], pose) for link, pose in stands])
        without, with_ = drives(name, links)
        (folder / f"{name}.yaml").write_text(without)
        (folder / f"{name}_flex.yaml").write_text(with_)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
