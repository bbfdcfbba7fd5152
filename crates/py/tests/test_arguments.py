"""Whatever a user gives wrongly is refused by the package's own errors, by name; or, of a wrong type altogether, by Python's `TypeError`."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import gyroflex
import matplotlib
import numpy as np
import pytest
from conftest import URDF, YAML

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from gyroflex import plots

Z = np.zeros(3)
Call = tuple[Callable[..., object], dict[str, Any]]

WRONG: tuple[object, ...] = (
    *(None, "x", "", b"x", "a\0b", 0, -1, 1.5, 10**30, -(10**30), 10**400, float("nan"), float("-inf"), 1j, True),
    *([], ["x"], ["x", "y", "z"], [1, 2], (1, 2, 3, 4), [10**400] * 3, [None] * 3, [float("nan")] * 3, [[1], [2, 3]]),
    *({}, {"x": 1}, {5: 1}, {"shoulder": float("nan")}, {"shoulder": {5: 1}}, object(), int, lambda *_: 0),
    *(np.zeros((2, 2)), np.full(3, np.nan), np.zeros((2, 3)), np.zeros((2, 2, 3)), np.array(["a"]), np.array(1.0), np.array(1j)),
)


def robots(arm: gyroflex.Robot, file: Path) -> dict[str, Call]:
    """Calls that make robots."""
    rotor = {"inertia": 1e-4}

    def built(**joint: object) -> gyroflex.Robot:
        links = gyroflex.RobotBuilder("arm").link("base").link("upper", mass=1, inertia=(1, 1, 1))
        return gyroflex.Robot.from_builder(links.joint(**joint).drive("joint", ratio=100, rotor=rotor))  # type: ignore[arg-type]

    joint = {"name": "joint", "parent": "base", "child": "upper", "kind": "revolute", "xyz": Z, "rpy": Z, "axis": (0, 0, 1)}
    limits = {"lower": -1, "upper": 1, "effort": 1, "velocity": 1}
    link = {"name": "link", "mass": 1.0, "com": Z, "rpy": Z, "inertia": (1, 1, 1)}
    drive = {"joint": "joint", "ratio": 2.0, "rotor": rotor, "transmission": "rigid", "friction": {}}
    by_joint = {name: {} for name in ("stiffness", "damping", "ratio", "rotor_inertia", "friction")}
    load = {"link": "tool", "mass": 1.0}
    options = {"floating": False, "model": "rigid", "set": {}}
    one = gyroflex.RobotBuilder("arm").link("base", mass=1, inertia=(1, 1, 1))
    return {
        "load": (gyroflex.Robot.load, {"path": file, "mimic": "refuse", **options}),
        "from_urdf": (gyroflex.Robot.from_urdf, {"urdf": URDF, "drives": YAML, **options}),
        "from_builder": (gyroflex.Robot.from_builder, {"builder": one, **options}),
        "with_": (arm.with_, {**by_joint, "model": "rigid", "gravity": (0, 0, 1), "payload": load, "set": {}}),
        "RobotBuilder": (gyroflex.RobotBuilder, {"name": "arm"}),
        "link": (gyroflex.RobotBuilder("arm").link, link),
        "joint": (gyroflex.RobotBuilder("arm").joint, joint | limits),
        "built": (built, joint | limits),
        "drive": (lambda **given: gyroflex.RobotBuilder("arm").drive(**given), drive),
    }


def dynamics(arm: gyroflex.Robot) -> dict[str, Call]:
    """Calls that take states."""
    at, velocity, motors = {"q": Z}, {"q": Z, "qd": Z, "thetad": Z}, {"q": Z, "qd": Z, "theta": Z, "thetad": Z}
    motion = {**motors, "qdd": Z, "thetadd": Z}
    how = {"model": "complete", "out": None}
    held = {"constraints": [gyroflex.Constraint.frame("tool", directions="point")], "threshold": 1e-9, "damping": 0.0}
    sharing = {"passive": ["elbow"], "torque_weights": Z + 1, "multiplier_weights": Z, "wanted": Z}
    load = {"tau_ext": Z}
    order = max(arm.smoothness().values())
    inverse = {"derivatives": np.zeros((order, 3)), "deflection": Z, "step": 1e-3, "torque_derivatives": 0, "damping": 1.0}
    start = {"q0": Z, "qd0": Z, "theta0": Z, "thetad0": Z, "tau": Z, "dt": 1e-3, "steps": 3}
    task = {"directions": ["x"], "rotation": "geometric", "point": Z, "threshold": 1e-6}
    linear = {"model": "complete", "friction": "viscous"}
    calls: dict[str, dict[str, Any]] = {
        "forward_dynamics": {**motors, "tau": Z, **load, **how},
        "inverse_dynamics": {**motion, **load, **how},
        "mass_matrix": {**at, **how},
        "coupling_matrix": {**at, **how},
        "placement": {"frame": "tool", **at, "out": None},
        "energy": {**motors, **how},
        "jacobian": {"frame": "tool", **at, "axes": "world", "out": None},
        "rollout": {**start, "integrator": "rk4", "model": "complete"},
        "coriolis_matrices": {**velocity, **how},
        "inertia_rates": {"q": Z, "qd": Z, **how},
        "bias": {**velocity, **how},
        "gravity_torques": {**at, "out": None},
        "forward_derivatives": {**motors, "tau": Z, **load, **how},
        "inverse_derivatives": {**motion, **load, **how},
        "regressor": {**motion, **how},
        "parameters": {"model": "complete"},
        "operational_space": {"frame": "tool", "q": Z + 0.3, "qd": Z, "thetad": Z, **task, "model": "complete"},
        "constrained_forward_dynamics": {**motors, "tau": Z, **held, **load, "model": "complete"},
        "constrained_inverse_dynamics": {**motion, **held, **sharing, **load, "model": "complete"},
        "impact": {**velocity, **held, "release": False, "model": "complete"},
        "constraint_motion": {"q": Z, "qd": Z, "constraints": held["constraints"], "out": None},
        "smoothness": {"model": "complete", "torque_derivatives": 0, "damping": 1.0},
        "elastic_inverse": {**at, **inverse, **load, "model": "complete"},
        "linearize": {**motors, "tau": Z, "outputs": ["motor_position"], **linear},
        "modes": {**at, **linear},
        "frequency_response": {"joint": "shoulder", **at, "start": 1.0, "stop": 2.0, "points": 5, **linear},
    }
    return {name: (getattr(arm, name), arguments) for name, arguments in calls.items()}


@functools.wraps(plots.animate)
def animated(**given: Any) -> None:
    # Nobody looks at it, of which it would warn.
    plots.animate(**given)._draw_was_started = True


def tools(arm: gyroflex.Robot, folder: Path) -> dict[str, Call]:
    """Calls that analyse, write, hold, and draw."""
    scenario = folder / "wrong.yaml"
    scenario.write_text("{robot: robot.yaml, duration: 0.01, integrator: {method: rk4, step: 1.0e-4}, log: {rate: 500}}")
    result = gyroflex.simulate(scenario, log=folder / "wrong.mcap")
    response = arm.frequency_response("shoulder", points=5)
    drawn = {"panels": ["position"], "joints": ["elbow"]}
    analysis = {"scenario": None, "log": None, "samples": 3, "seed": 0, "speed": 1.0, "rise": 0.25, "threshold": 1.0, "bounds": False}
    code: dict[str, Any] = {"what": "gravity", "lang": "rust", "model": "complete", "scalar": "f64", "lanes": None, "keep_symbol": ()}
    code |= {"link": None, "simplify_to": None, "along": None, "split": 2, "name": None}
    frame = {"link": "tool", "xyz": Z, "rpy": Z, "to": "base", "at_xyz": Z, "at_rpy": Z, "at": None, "directions": "all"}
    frame |= {"stabilisation": 0.0, "contact": "z", "restitution": 0.0, "slip": Z}
    follow = {"joint": "elbow", "follows": "shoulder", "ratio": 1.0, "offset": 0.0, "stabilisation": 0.0}
    runs = {"values": {"duration": [0.002]}, "n_jobs": 1, "measure": None, "overwrite": True, "client": None, "progress": False}
    chart = {"robot": arm, "x": "elbow", "y": "extend", "q": Z, "x_range": (0, 1), "y_range": (0, 1), "points": 2}
    film = {"robot": arm, "result": result, "path": None, "times": (0, 0.01), "fps": 100, "speed": 1.0, "view": (20, -60)}
    return {
        "analyze": (arm.analyze, analysis),
        "codegen": (arm.codegen, code),
        "write": (arm.codegen("gravity").write, {"folder": folder / "code"}),
        "Constraint.frame": (gyroflex.Constraint.frame, frame),
        "Constraint.joints": (gyroflex.Constraint.joints, follow),
        "zero_order_hold": (arm.linearize(friction="viscous").zero_order_hold, {"step": 1e-3}),
        "simulate": (gyroflex.simulate, {"scenario": scenario, "log": None, "set": {}}),
        "read_mcap": (gyroflex.read_mcap, {"path": folder / "wrong.mcap"}),
        "to_mcap": (result.to_mcap, {"path": folder / "copy.mcap"}),
        "sweep": (gyroflex.sweep, {"scenario": scenario, "output": folder / "wrong.csv", **runs}),
        "plot": (result.plot, drawn),
        "plots.run": (plots.run, {"result": result, **drawn}),
        "plots.frequency_response": (plots.frequency_response, {"responses": response, "labels": ["one"]}),
        "plots.significance_map": (plots.significance_map, chart),
        "plots.animate": (animated, film),
    }


@pytest.fixture(scope="module")
def calls(arm: gyroflex.Robot, arm_file: Path) -> dict[str, Call]:
    return robots(arm, arm_file) | dynamics(arm) | tools(arm, arm_file.parent)


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Where files of wrong names go."""
    monkeypatch.chdir(tmp_path)
    yield
    plt.close("all")


def public(of: object) -> set[str]:
    """Methods that take arguments."""
    found = {name: getattr(of, name) for name in dir(of) if not name.startswith("_")}
    return {name for name, value in found.items() if callable(value) and set(inspect.signature(value).parameters) - {"self"}}


def test_all_calls_are_here(calls: Mapping[str, Call]) -> None:
    functions = {"simulate", "sweep", "read_mcap"} | {f"plots.{name}" for name in plots.__all__ if name.islower()}
    inherited = set(dir(Mapping))
    methods = public(gyroflex.Robot) | public(gyroflex.RobotBuilder) | public(gyroflex.Linearization) | public(gyroflex.GeneratedCode)
    methods |= public(gyroflex.SimulationResult) - inherited
    held = {f"Constraint.{name}" for name in public(gyroflex.Constraint)}
    assert functions | methods | held | {"RobotBuilder", "built"} == set(calls)
    for name, (call, arguments) in calls.items():
        if name not in ("built", "drive"):
            taken = inspect.signature(call).parameters.values()
            assert {p.name for p in taken if p.kind is not p.VAR_KEYWORD} == set(arguments), name


NAMES = [
    *("load", "from_urdf", "from_builder", "with_", "RobotBuilder", "link", "joint", "built", "drive"),
    *("forward_dynamics", "inverse_dynamics", "mass_matrix", "coupling_matrix", "placement", "energy", "jacobian", "rollout"),
    *("coriolis_matrices", "inertia_rates", "bias", "gravity_torques", "forward_derivatives", "inverse_derivatives", "regressor"),
    *("parameters", "operational_space", "constraint_motion", "smoothness", "elastic_inverse", "linearize", "modes", "frequency_response"),
    *("constrained_forward_dynamics", "constrained_inverse_dynamics", "impact", "Constraint.frame", "Constraint.joints"),
    *("analyze", "codegen", "write", "zero_order_hold", "simulate", "read_mcap", "to_mcap", "sweep"),
    *("plot", "plots.run", "plots.frequency_response", "plots.significance_map", "plots.animate"),
]


RELATED = {
    "Constraint.frame.directions": {"contact"},
    "built.upper": {"lower"},
    "constrained_inverse_dynamics.constraints": {"multiplier_weights"},
    "elastic_inverse.q": {"derivatives"},
    "elastic_inverse.torque_derivatives": {"derivatives"},
    "frequency_response.stop": {"start"},
    "joint.upper": {"lower"},
    "linearize.qd": {"theta"},
    "plots.animate.fps": {"speed"},
}
"""Of two arguments that do not fit together, either can be the wrong one."""


@pytest.mark.filterwarnings("ignore::gyroflex.RobotWarning")
@pytest.mark.parametrize("name", NAMES)
def test_what_is_wrong_is_refused_by_name(calls: Mapping[str, Call], name: str) -> None:
    call, right = calls[name]
    call(**right)
    for argument in right:
        for wrong in WRONG:
            try:
                call(**(right | {argument: wrong}))
            except gyroflex.Error as error:
                assert error.problem and error.remedy, (argument, wrong)
                if isinstance(error, gyroflex.ArgumentError):
                    blamed = re.match(r"argument `(\w+)", error.element)
                    assert blamed, (argument, wrong, str(error))
                    assert blamed[1] == argument or blamed[1] in RELATED.get(f"{name}.{argument}", ()), (wrong, str(error))
            except TypeError:
                pass
            except Exception as error:
                raise AssertionError(f"{argument}={wrong!r} raises {error!r}") from error


def test_all_calls_are_walked(calls: Mapping[str, Call]) -> None:
    assert sorted(NAMES) == sorted(calls)
