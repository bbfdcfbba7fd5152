"""A robot that stands: where its feet are, motions that leave them at rest, and the accelerations when they are held there.

  NAME.feet  little-endian f64: for each foot the index of its link among the links, of its body in the tree, and its pose there by rows: 12
  NAME.held  256 × [v, accelerations for u]: v of NAME.states with the feet brought to rest
"""

import numpy as np
import pinocchio as pin

WORLD = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


def feet_of(model, names):
    """Index of the link and pose in it of every foot."""
    frames = [model.frames[model.getFrameId(name)] for name in names]
    return [(frame.parentJoint - 1, frame.placement) for frame in frames]


def accelerations(model, data, q, v, torques, jacobian, frames):
    """From the dense equations, with a step of iterative refinement."""
    upper = np.triu(pin.crba(model, data, q))
    m = upper + np.triu(upper, 1).T
    bias = pin.nonLinearEffects(model, data, q, v)
    pin.forwardKinematics(model, data, q, v, np.zeros(model.nv))
    drift = np.concatenate([pin.getFrameClassicalAcceleration(model, data, *frame, WORLD).vector for frame in frames])
    matrix = np.block([[m, jacobian.T], [jacobian, np.zeros((len(jacobian), len(jacobian)))]])
    right = np.concatenate([torques - bias, -drift])
    found = np.linalg.solve(matrix, right)
    found += np.linalg.solve(matrix, right - matrix @ found)
    return found[: model.nv]


def write(folder, name, model, feet, states, springs, spring_torques):
    """`feet` has index of the link, index of the body, and pose of each; `states` has `q, v, u` of each."""
    data = model.createData()
    frames = [(body + 1, pose) for _, body, pose in feet]
    held = []
    for q, v, u in states:
        pin.computeJointJacobians(model, data, q)
        jacobian = np.vstack([pin.getFrameJacobian(model, data, *frame, WORLD) for frame in frames])
        v = v - np.linalg.pinv(jacobian) @ (jacobian @ v)
        torques = u + spring_torques(springs, q, v)
        held.append(np.concatenate([v, accelerations(model, data, q, v, torques, jacobian, frames)]))
    np.asarray(held, "<f8").tofile(folder / f"{name}.held")
    numbers = [np.concatenate([[link, body], pose.rotation.ravel(), pose.translation]) for link, body, pose in feet]
    np.asarray(numbers, "<f8").tofile(folder / f"{name}.feet")
