"""What one call costs, and how many states a second batches take: gyroflex beside Pinocchio and MuJoCo.

Needs `pip install ./crates/py pin mujoco`; what is not installed is left out. Run it once a number of cores:

    RAYON_NUM_THREADS=1 python benches/python/batches.py
    RAYON_NUM_THREADS=2 python benches/python/batches.py

Pinocchio and MuJoCo compute the rigid robot without rotors of their own; gyroflex the complete model, motors included.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import gyroflex
import numpy as np

ROBOT = Path(__file__).parents[2] / "robots" / "iiwa14" / "robot.yaml"
ROWS, STEPS, DT = 8192, 100, 1e-4
CORES = int(os.environ.get("RAYON_NUM_THREADS", os.cpu_count() or 1))


def best(call: Callable[[], object], repeat: int = 7, times: int = 1) -> float:
    """Seconds of the fastest of some repetitions, of one call."""
    call()
    taken = []
    for _ in range(repeat):
        start = time.perf_counter()
        for _ in range(times):
            call()
        taken.append((time.perf_counter() - start) / times)
    return min(taken)


def report(what: str, seconds: float, states: int) -> None:
    print(f"{what:58} {seconds / states * 1e9:10.0f} ns {states / seconds:14,.0f} /s", flush=True)


def main() -> None:
    robot = gyroflex.Robot.load(ROBOT)
    rng = np.random.default_rng(1)
    n = robot.nv
    q, qd, tau = (rng.uniform(-1, 1, (ROWS, n)) for _ in range(3))
    theta, thetad = q + rng.normal(scale=1e-3, size=(ROWS, n)), qd.copy()
    state = (q, qd, theta, thetad)
    single = [np.ascontiguousarray(a[0]) for a in (*state, tau)]
    print(f"{n} joints, complete model, {CORES} cores, batches of {ROWS}")

    report("gyroflex forward_dynamics, one call", best(lambda: robot.forward_dynamics(*single), times=20000), 1)
    report("gyroflex gravity_torques, one call", best(lambda: robot.gravity_torques(single[0]), times=20000), 1)
    report("gyroflex forward_dynamics, batch", best(lambda: robot.forward_dynamics(*state, tau)), ROWS)
    out = (np.empty((ROWS, n)), np.empty((ROWS, n)))
    report("gyroflex forward_dynamics, batch, out=", best(lambda: robot.forward_dynamics(*state, tau, out=out)), ROWS)
    narrow = [a.astype(np.float32) for a in (*state, tau)]
    report("gyroflex forward_dynamics, batch, float32", best(lambda: robot.forward_dynamics(*narrow)), ROWS)
    accelerations = (qd, theta, thetad, qd)
    report("gyroflex inverse_dynamics, batch", best(lambda: robot.inverse_dynamics(q, qd, *accelerations)), ROWS)
    report("gyroflex mass_matrix, batch", best(lambda: robot.mass_matrix(q)), ROWS)
    room = np.empty((ROWS, n, n))
    report("gyroflex mass_matrix, batch, out=", best(lambda: robot.mass_matrix(q, out=room)), ROWS)
    few = [a[:512] for a in state]
    start = dict(zip(("q0", "qd0", "theta0", "thetad0"), few, strict=True))
    torques = rng.normal(size=(512, STEPS, n))
    for integrator in ("semi_implicit_euler", "rk4"):
        seconds = best(lambda: robot.rollout(**start, tau=torques, dt=DT, integrator=integrator), repeat=3)  # noqa: B023
        report(f"gyroflex rollout, {integrator}, a step", seconds, 512 * STEPS)
    pinocchio(q, qd, tau)
    mujoco_rollout(few, torques)


def pinocchio(q: np.ndarray, qd: np.ndarray, tau: np.ndarray) -> None:
    """`pin.aba` in a loop of Python, and over a batch where the wheel has it."""
    try:
        import pinocchio as pin
    except ImportError:
        return
    model = pin.buildModelFromUrdf(str(next(ROBOT.parent.glob("*.urdf"))))
    data = model.createData()
    rows = [(q[i].copy(), qd[i].copy(), tau[i].copy()) for i in range(1000)]
    report("pinocchio aba, loop", best(lambda: [pin.aba(model, data, *row) for row in rows]), len(rows))
    if hasattr(pin, "abaInParallel"):
        pool = pin.ModelPool(model, CORES)
        columns = [np.asfortranarray(a.T) for a in (q, qd, tau)]
        report("pinocchio abaInParallel", best(lambda: pin.abaInParallel(CORES, pool, *columns)), len(q))


def mujoco_rollout(state: list[np.ndarray], torques: np.ndarray) -> None:
    """MuJoCo's `rollout` of the same number of motions and steps, semi-implicit Euler."""
    try:
        import mujoco
        from mujoco import rollout
    except ImportError:
        return
    urdf = next(ROBOT.parent.glob("*.urdf")).read_text()
    spec = mujoco.MjSpec.from_string(urdf)
    for geom in list(spec.geoms):
        spec.delete(geom)
    for joint in spec.joints:
        actuator = spec.add_actuator(name=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        actuator.target = joint.name
    model = spec.compile()
    model.opt.timestep = DT
    count, n = len(state[0]), state[0].shape[1]
    data = [mujoco.MjData(model) for _ in range(CORES)]
    initial = np.concatenate([np.zeros((count, 1)), state[0], state[1]], axis=1)
    padding = np.zeros((count, mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS) - 1 - 2 * n))
    initial = np.concatenate([initial, padding], axis=1)
    seconds = best(lambda: rollout.rollout(model, data, initial, torques), repeat=3)
    report("mujoco rollout, Euler, a step", seconds, torques.shape[0] * torques.shape[1])


if __name__ == "__main__":
    main()
