"""Every mistake is an exception of one tree that names the argument, or the file, and the remedy."""

from __future__ import annotations

import pickle
from pathlib import Path

import gyroflex
import numpy as np
import pytest

Z = np.zeros(3)


def test_all_errors_are_one_tree() -> None:
    kinds = [getattr(gyroflex, name) for name in gyroflex.__all__ if name.endswith("Error")]
    assert len(kinds) == 10
    assert all(issubclass(kind, gyroflex.Error) for kind in kinds)


@pytest.mark.parametrize("kind", ["Error", "FileError", "ModelError", "ShapeError", "DivergedError"])
def test_errors_survive_pickling(kind: str) -> None:
    error = getattr(gyroflex, kind)("wrong", "joint `a`", "robot.urdf:3", "mend it")
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert str(again) == str(error) == "robot.urdf:3: joint `a`: wrong\n  remedy: mend it"
    assert (again.problem, again.element, again.file, again.remedy) == error.args


@pytest.mark.parametrize(
    ("name", "value", "given"),
    [
        ("q", np.zeros(4), "(4,)"),
        ("q", np.zeros((3, 1, 3)), "(3, 1, 3)"),
        ("qd", 1.0, "()"),
        ("theta", [], "(0,)"),
        ("thetad", np.zeros(2), "(2,)"),
        ("tau", np.zeros(9), "(9,)"),
        ("tau_ext", np.zeros((1, 1, 3)), "(1, 1, 3)"),
    ],
)
def test_a_wrong_shape_is_named_with_the_expected_one(arm: gyroflex.Robot, name: str, value: object, given: str) -> None:
    arguments: dict[str, object] = {"q": Z, "qd": Z, "theta": Z, "thetad": Z, "tau": Z, name: value}
    with pytest.raises(gyroflex.ShapeError) as caught:
        arm.forward_dynamics(**arguments)  # type: ignore[arg-type]
    assert isinstance(caught.value, ValueError)
    assert caught.value.element == f"argument `{name}`"
    assert f"shape {given} is given, but (3,) is expected" in caught.value.problem
    assert caught.value.remedy


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", ["q", "qd", "qdd", "theta", "thetad", "thetadd", "tau_ext"])
def test_what_is_not_finite_is_refused(arm: gyroflex.Robot, name: str, bad: float) -> None:
    names = ("q", "qd", "qdd", "theta", "thetad", "thetadd", "tau_ext")
    arguments = dict.fromkeys(names, Z) | {name: np.array([0.0, bad, 0.0])}
    with pytest.raises(gyroflex.NotFiniteError, match=f"argument `{name}`, entry 1"):
        arm.inverse_dynamics(**arguments)


@pytest.mark.parametrize("value", [["a", "b", "c"], [1j, 0, 0], [True, False, True], [None] * 3, [[1], [1, 2]], object()])
def test_what_is_not_a_real_number_is_refused(arm: gyroflex.Robot, value: object) -> None:
    with pytest.raises(gyroflex.ArgumentError, match="argument `q`"):
        arm.mass_matrix(value)  # type: ignore[arg-type]


def test_missing_arrays_are_named(arm: gyroflex.Robot) -> None:
    with pytest.raises(gyroflex.ArgumentError, match="argument `tau`: it is missing"):
        arm.forward_dynamics(Z, Z, Z, Z)
    with pytest.raises(gyroflex.ArgumentError, match="argument `thetad`: it is missing.*elastic"):
        arm.forward_dynamics(Z, Z, Z, tau=Z)
    with pytest.raises(gyroflex.ArgumentError, match="argument `thetadd`"):
        arm.inverse_dynamics(Z, Z, Z, Z, Z)
    arm.forward_dynamics(Z, Z, tau=Z, model="rigid")


def test_unknown_names_come_with_the_nearest_known_one(arm: gyroflex.Robot) -> None:
    with pytest.raises(gyroflex.ArgumentError, match="`complet` is not a choice\n.*`complete`"):
        arm.mass_matrix(Z, model="complet")
    with pytest.raises(gyroflex.ArgumentError, match="no link `toool`\n.*`tool`"):
        arm.placement("toool", Z)


def test_a_quaternion_must_have_length_one(arm_file: Path) -> None:
    robot = gyroflex.Robot.load(arm_file, floating=True)
    q = np.zeros(10)
    with pytest.raises(gyroflex.ArgumentError, match="quaternion.*length 0"):
        robot.mass_matrix(q)
    q[6] = 1.1
    with pytest.raises(gyroflex.ArgumentError, match=r"quaternion.*length 1\.1"):
        robot.mass_matrix(q)


def test_a_result_too_large_for_a_number_is_an_error(arm: gyroflex.Robot) -> None:
    with pytest.raises(gyroflex.DivergedError, match="`tau_j`"):
        arm.inverse_dynamics(Z, np.full(3, 1e200), Z, model="rigid")


def test_a_missing_file_is_also_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(OSError, match=r"nowhere\.urdf") as caught:
        gyroflex.Robot.load(tmp_path / "nowhere.urdf")
    assert isinstance(caught.value, gyroflex.FileError)


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("robot.yaml", "drives: [", "robot.yaml"),
        ("robot.yaml", "- a\n- b\n", "robot.yaml"),
        ("robot.yaml", "urfd: arm.urdf\n", "urdf"),
        ("robot.urdf", "<robot name='x'><link name='a'>", "robot.urdf"),
        ("robot.urdf", "not xml", "robot.urdf"),
    ],
)
def test_a_malformed_file_is_named(tmp_path: Path, name: str, text: str, words: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(gyroflex.FormatError, match=words):
        gyroflex.Robot.load(tmp_path / name)


def test_a_robot_that_cannot_be_is_named(arm_file: Path, tmp_path: Path) -> None:
    urdf = (arm_file.parent / "elastic_arm.urdf").read_text()
    (tmp_path / "robot.urdf").write_text(urdf.replace('<mass value="0.6"/>', '<mass value="-0.6"/>'))
    with pytest.raises(gyroflex.ModelError) as caught:
        gyroflex.Robot.load(tmp_path / "robot.urdf")
    assert "slider" in str(caught.value)


def test_what_a_file_has_in_vain_is_a_warning(arm_file: Path, tmp_path: Path) -> None:
    urdf = (arm_file.parent / "elastic_arm.urdf").read_text()
    (tmp_path / "robot.urdf").write_text(urdf.replace('friction="0.2"/>', 'friction="0.2" stiction="3"/>'))
    with pytest.warns(gyroflex.RobotWarning, match="stiction"):
        robot = gyroflex.Robot.load(tmp_path / "robot.urdf")
    assert any("stiction" in warning for warning in robot.warnings)
