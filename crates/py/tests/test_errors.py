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
    assert f"shape {given} is given, but (3,) or (batch, 3) is expected" in caught.value.problem
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


def test_one_remedy_for_an_array_that_is_missing(arm: gyroflex.Robot) -> None:
    many = np.zeros((2, 3))
    for q in (Z, many):
        for missing, remedy in (("tau", "motor torques, zeros for none"), ("thetad", "or choose a model with rigid transmissions")):
            given = {"theta": Z, "thetad": Z, "tau": Z} | {missing: None}
            with pytest.raises(gyroflex.ArgumentError, match=f"argument `{missing}`: it is missing") as caught:
                arm.forward_dynamics(q, Z, **given)
            assert remedy in caught.value.remedy


def test_a_batch_is_offered_where_there_is_one(arm: gyroflex.Robot) -> None:
    for call in (arm.mass_matrix, arm.gravity_torques):
        with pytest.raises(gyroflex.ShapeError, match=r"but \(3,\) or \(batch, 3\) is expected"):
            call(np.zeros(4))


def test_roots_may_be_left_out_and_messages_say_so(arm_file: Path) -> None:
    robot = gyroflex.Robot.load(arm_file, floating=True)
    q, qd = np.zeros(10), np.zeros(9)
    q[6] = 1.0
    with pytest.raises(gyroflex.ShapeError) as caught:
        robot.forward_dynamics(q, qd, np.zeros(4), qd, qd)
    assert "(9,) or (batch, 9), or without the root (3,) or (batch, 3), is expected" in caught.value.problem


def test_each_argument_is_blamed_for_itself(arm: gyroflex.Robot) -> None:
    wrong = [
        ("threshold", 2.0),
        ("threshold", np.nan),
        ("point", (0, 0)),
        ("point", "abc"),
        ("point", (0, 0, np.nan)),
        ("directions", "x"),
        ("directions", []),
        ("directions", ["x", "x"]),
        ("rotation", "xyz"),
    ]
    for name, value in wrong:
        with pytest.raises(gyroflex.ArgumentError, match=f"argument `{name}`"):
            arm.operational_space("tool", Z, Z, Z, **{name: value})  # type: ignore[arg-type]
    for name, value in (("samples", -1), ("samples", 10**12), ("seed", -1), ("speed", 10**400), ("rise", 0.0), ("threshold", np.inf)):
        with pytest.raises(gyroflex.ArgumentError, match=f"argument `{name}`"):
            arm.analyze(**{name: value})  # type: ignore[arg-type]
    changes = [("stiffness", {"elbow": np.nan}), ("ratio", {5: 1.0}), ("friction", {"elbow": {"motor": {1: 2}}}), ("gravity", (0, 0)), ("payload", {"mass": np.inf})]
    for name, value in changes:
        with pytest.raises(gyroflex.ArgumentError, match=f"argument `{name}`"):
            arm.with_(**{name: value})  # type: ignore[arg-type]


def test_the_last_word_counts_in_a_copy(arm: gyroflex.Robot) -> None:
    key = "drives.elbow.transmission.stiffness"
    assert arm.with_(stiffness={"elbow": 1e3}, set={key: 2e3}).drives["elbow"].stiffness == 2e3
    assert arm.with_(gravity=(0, 0, -1.62), model="rigid").with_(set={"model": "reduced"}).model == "reduced"


def test_files_with_blanks_in_their_names_are_named_whole(arm_file: Path, tmp_path: Path) -> None:
    (tmp_path / "elastic_arm.urdf").write_text((arm_file.parent / "elastic_arm.urdf").read_text())
    path = tmp_path / "my robot, the arm.yaml"
    path.write_text(arm_file.read_text().replace("gear_ratio: 100.0", "gear_ratio: 0"))
    with pytest.raises(gyroflex.ModelError, match=r"^my robot, the arm\.yaml:7: joint `shoulder`"):
        gyroflex.Robot.load(path)
