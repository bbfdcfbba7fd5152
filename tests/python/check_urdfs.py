"""Compares gyroflex with Pinocchio on every URDF of the PyPI package `example-robot-data`, on a fixed and on a floating base.

A file must load, and then inverse dynamics, forward dynamics, inertia matrix and the pose of every link must agree with
Pinocchio at random states; or it must be refused with one error that says where, what and how to mend it. Anything else makes
the exit code 1. Files refused because joints mimic others are compared once more with those joints independent, which is how
Pinocchio reads them.

The tolerance is 1e-9 for every quantity. A row that misses it is never counted as agreeing. For the files of `ILL_CONDITIONED`,
accelerations alone may miss it and are counted as `exceeds`, with the exit code left 0: two exact ways to solve `M qdd = tau - h`
in floating point differ by up to the condition number of `M` times the rounding unit, which bounds them there, and the torques
that the difference amounts to, `M (qdd - qdd')` over `tau`, must keep the tolerance like everything else.

Two libraries, two conventions; `PinocchioTwin` is the translation.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
import sysconfig
import warnings
from pathlib import Path

import numpy as np
from pinocchio_twin import PinocchioTwin, quiet_stderr

import gyroflex

QUANTITIES = ("inverse", "forward", "balance", "inertia", "frames")
BASES = ("fixed", "floating", "fixed*", "floating*")
ILL_CONDITIONED = {"icub_description/robots/icub.urdf": "links that are points on their joint axes, cond(M) up to 8e8"}
GRAVITY = np.array([0.0, 0.0, -9.81])


@dataclasses.dataclass
class Result:
    """What came out for one file on one kind of base."""

    file: str
    base: str
    verdict: str
    nv: int = 0
    links: int = 0
    warnings: int = 0
    seed: list[int] = dataclasses.field(default_factory=list)
    errors: dict[str, float] = dataclasses.field(default_factory=dict)
    condition: float = 0.0
    message: str = ""


def robots_folder() -> Path:
    """The folder of the installed package that holds the URDFs."""
    return Path(sysconfig.get_path("purelib"), "cmeel.prefix", "share", "example-robot-data", "robots")


def relative_error(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Largest difference over the largest entry; infinite where a number is not one."""
    if not (np.isfinite(ours).all() and np.isfinite(theirs).all()):
        return float("inf")
    if theirs.size == 0:
        return 0.0
    scale = np.abs(theirs).max()
    return float(np.abs(ours - theirs).max() / (scale if scale > 0.0 else 1.0))


@dataclasses.dataclass
class Comparison:
    """Relative difference of each quantity at one random state, and the condition number of the inertia matrix there."""

    errors: dict[str, float]
    condition: float

    def misses(self, tolerance: float) -> dict[str, str]:
        """The quantities that differ by more than the tolerance, in words."""
        return {x: f"{x} differs by {e:.1e}, allowed {tolerance:.1e}" for x, e in self.errors.items() if not e <= tolerance}

    def is_rounding(self, tolerance: float) -> bool:
        """Whether accelerations alone miss the tolerance, and by no more than the condition of the inertia matrix explains."""
        bound = self.condition * float(np.finfo(float).eps)
        return set(self.misses(tolerance)) <= {"forward"} and self.errors["forward"] <= max(tolerance, bound)


def compare_state(robot: gyroflex.Robot, twin: PinocchioTwin, rng: np.random.Generator) -> Comparison:
    """Compares everything at one random state."""
    q, qd, qdd = twin.random_state(rng)
    _, tau = robot.inverse_dynamics(q, qd, qdd)
    expected = twin.inverse_dynamics(q, qd, qdd)
    ours, _ = robot.forward_dynamics(q, qd, tau=expected)
    theirs = twin.forward_dynamics(q, qd, expected)
    m = twin.mass_matrix(q)
    poses = twin.placements(q)
    errors = {
        "inverse": relative_error(tau, expected),
        "forward": relative_error(ours, theirs),
        "balance": relative_error(expected + m @ (ours - theirs), expected),
        "inertia": relative_error(robot.mass_matrix(q), m),
        "frames": max(relative_error(robot.placement(link, q), pose) for link, pose in poses.items()),
    }
    return Comparison(errors, float(np.linalg.cond(m)) if m.size else 1.0)


def is_clear(error: gyroflex.Error) -> bool:
    """Whether an error says where, what, and how to mend it."""
    return bool(error.file and error.problem and (error.element or error.remedy))


def check(path: Path, name: str, base: str, options: argparse.Namespace, number: int) -> Result:
    """Compares one file on one kind of base: one of `BASES`."""
    floating = base.startswith("floating")
    result = Result(name, base, "agrees", seed=[options.seed, number, BASES.index(base)])
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            robot = gyroflex.Robot.load(path, floating=floating, mimic="independent" if base.endswith("*") else None)
        result.warnings = len(caught)
    except gyroflex.Error as error:
        result.verdict = "refused" if is_clear(error) else "UNCLEAR"
        result.message = f"{type(error).__name__}: {error}"
        return result
    except Exception as error:  # anything else that comes out of a load is a defect to report, whatever it is
        result.verdict, result.message = "UNCLEAR", f"{type(error).__name__}: {error}"
        return result

    result.nv, result.links = robot.nv, len(robot.link_names)
    try:
        with quiet_stderr():
            twin = PinocchioTwin(path, floating)
    except ValueError as error:
        result.verdict, result.message = "DISAGREES", f"loads, but Pinocchio refuses it: {error}"
        return result
    complaint = twin.mismatch(robot)
    if complaint or not np.array_equal(robot.gravity, GRAVITY):
        result.verdict, result.message = "DISAGREES", complaint or f"gravity is {robot.gravity}"
        return result

    twin.order_as(robot.joint_names)
    rng = np.random.default_rng(result.seed)
    states = [compare_state(robot, twin, rng) for _ in range(options.states)]
    result.errors = {x: max(state.errors[x] for state in states) for x in QUANTITIES}
    result.condition = max(state.condition for state in states)
    if missing := [state for state in states if state.misses(options.tolerance)]:
        result.message = "; ".join(missing[0].misses(options.tolerance).values())
        explained = name in ILL_CONDITIONED and all(state.is_rounding(options.tolerance) for state in missing)
        result.verdict = "exceeds" if explained else "DISAGREES"
        result.message += f"; {ILL_CONDITIONED[name]}" if explained else ""
    return result


def print_row(r: Result, path: Path) -> None:
    numbers = " ".join(f"{r.errors[x]:8.1e}" for x in QUANTITIES) + f" {r.condition:8.1e}" if r.errors else ""
    print(f"{r.file:62} {r.base:9} {r.verdict:9} {r.nv:3} {r.links:5} {numbers}".rstrip(), flush=True)
    if r.message:
        print("    " + r.message.replace(str(path), path.name).replace("\n", "\n    "))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=Path, default=robots_folder(), help="folder to search for URDFs")
    parser.add_argument("--only", default="", help="check only files whose path contains this")
    parser.add_argument("--seed", type=int, default=20150101, help="first number of each file's seed")
    parser.add_argument("--states", type=int, default=5, help="random states per file and base")
    parser.add_argument("--tolerance", type=float, default=1e-9, help="largest relative difference allowed")
    parser.add_argument("--json", type=Path, help="also write all results to this file")
    options = parser.parse_args()

    paths = [p for p in sorted(options.robots.rglob("*.urdf")) if options.only in str(p)]
    if not paths:
        print(f"no URDF in {options.robots}; install the package `example-robot-data`", file=sys.stderr)
        return 1
    print(f"{len(paths)} files, {options.states} states each, seeds [{options.seed}, number of file, number of base]")
    print("bases: " + ", ".join(BASES) + "; * with joints that mimic others made independent")
    columns = " ".join(f"{x:>8}" for x in (*QUANTITIES, "cond(M)"))
    print(f"{'file':62} {'base':9} {'verdict':9} {'nv':>3} {'links':>5} {columns}")
    results = []
    for number, path in enumerate(paths):
        name = str(path.relative_to(options.robots))
        for base in BASES:
            if base.endswith("*") and not any(r.file == name and "mimics" in r.message for r in results):
                continue
            results.append(check(path, name, base, options, number))
            print_row(results[-1], path)

    verdicts = ("agrees", "exceeds", "refused", "DISAGREES", "UNCLEAR")
    totals = {base: {v: sum(r.base == base and r.verdict == v for r in results) for v in verdicts} for base in BASES}
    for base, counts in totals.items():
        print(f"{base:9} " + ", ".join(f"{count} {verdict}" for verdict, count in counts.items()))
    worst = {x: max((r.errors[x] for r in results if r.errors), default=0.0) for x in QUANTITIES}
    print("largest relative differences: " + ", ".join(f"{x} {e:.1e}" for x, e in worst.items()))
    if options.json:
        document = {"totals": totals, "worst": worst, "results": [dataclasses.asdict(r) for r in results]}
        options.json.write_text(json.dumps(document, indent=1) + "\n")
    return int(any(r.verdict in ("DISAGREES", "UNCLEAR") for r in results))


if __name__ == "__main__":
    sys.exit(main())
