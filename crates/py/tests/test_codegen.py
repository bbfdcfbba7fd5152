"""Generated code as the wheel gives it: it computes what the robot does, and says what it cannot be."""

from __future__ import annotations

import subprocess
from pathlib import Path

import gyroflex
import numpy as np
import pytest
from conftest import PROJECT

ROBOTS = PROJECT / "robots"


@pytest.fixture(scope="module")
def puma() -> gyroflex.Robot:
    with pytest.warns(gyroflex.RobotWarning, match="triangle inequality"):
        return gyroflex.Robot.load(ROBOTS / "puma560" / "robot.yaml")


def states(robot: gyroflex.Robot, count: int) -> list[np.ndarray]:
    dice = np.random.default_rng(3)
    q, qd, theta, thetad, last = dice.uniform(-1.0, 1.0, (5, count, robot.nv))
    return [2 * q, qd, 2 * q + 1e-3 * theta, qd + 0.1 * thetad, 20 * last]


def test_module_computes_what_the_robot_does(puma: gyroflex.Robot) -> None:
    module = puma.codegen("forward").module()
    rows = states(puma, 50)
    qdd, thetadd, _ = module.forward_dynamics(*rows)
    for k in range(50):
        want = puma.forward_dynamics(*(row[k] for row in rows))
        np.testing.assert_allclose(qdd[k], want[0], rtol=1e-11, atol=1e-9)
        np.testing.assert_allclose(thetadd[k], want[1], rtol=1e-11, atol=1e-9)


def test_kept_symbol_is_an_argument(puma: gyroflex.Robot) -> None:
    code = puma.codegen("gravity", keep_symbol=["link6.mass"])
    arguments = code.report["functions"][0]["arguments"]
    assert [name for name, _ in arguments] == ["q", "parameters"]
    module = code.module()
    q = np.full((1, puma.nv), 0.3)
    light, heavy = (module.gravity_torques(q, np.array([[mass]]))[0] for mass in (0.09, 1.09))
    np.testing.assert_allclose(light[0], puma.inverse_dynamics(q[0], 0 * q[0], 0 * q[0], model="rigid")[1], atol=1e-12)
    assert np.abs(heavy - light).max() > 1.0


@pytest.mark.parametrize("lang", ["rust", "c", "python", "json", "latex"])
def test_files_are_those_of_the_command_line(puma: gyroflex.Robot, lang: str, binary: Path, tmp_path: Path) -> None:
    code = puma.codegen(["forward", "inverse"], lang=lang)
    robot = str(ROBOTS / "puma560" / "robot.yaml")
    command = [binary, "-q", "codegen", robot, "--lang", lang, "-o", tmp_path / "cli"]
    subprocess.run(command, check=True, capture_output=True)
    written = code.write(tmp_path / "wheel")
    assert sorted(path.name for path in written) == sorted(path.name for path in (tmp_path / "cli").iterdir())
    for path in written:
        assert path.read_text() == (tmp_path / "cli" / path.name).read_text() == code.files[path.name]


def test_weighing_and_splitting_are_reported(puma: gyroflex.Robot) -> None:
    weighed = puma.codegen("inverse", simplify_to=1e-2, along=ROBOTS / "puma560" / "track.yaml").report["weighing"]
    kept = [row["kept"] for row in weighed]
    assert kept == sorted(kept) and kept[0] < kept[-1] == weighed[0]["terms"]
    parts = puma.codegen("forward", lang="rust", split=2).report["parts"]
    assert len(parts[0]["parts"]) == 2


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"what": "forwards"}, "nothing is called `forwards`"),
        ({"lang": "fortran"}, "known: python, rust, c, json, latex"),
        ({"scalar": "f16"}, "f64"),
        ({"keep_symbol": ["link9.mass"]}, "link9"),
        ({"along": "track.yaml"}, "simplify_to"),
        ({"split": 2}, 'lang="rust"'),
        ({"link": "nobody", "what": "jacobian"}, "nobody"),
    ],
)
def test_what_cannot_be_generated_is_refused(puma: gyroflex.Robot, arguments: dict[str, object], words: str) -> None:
    if "along" in arguments:
        arguments = {"along": ROBOTS / "puma560" / "track.yaml"}
    with pytest.raises(gyroflex.Error, match=words.replace("-", "[-]")):
        puma.codegen(**arguments)


@pytest.mark.parametrize(
    ("argument", "value", "words"),
    [
        ("what", "forwards", "nothing is called `forwards`"),
        ("what", ["all", 5], "list of names"),
        ("keep_symbol", "gravity", "the text 'gravity' is given\n.*list of names"),
        ("split", 2, 'choose `lang="rust"`'),
        ("split", -1, "it is negative"),
        ("lanes", 10**30, "smaller number"),
        ("simplify_to", float("nan"), "part of a torque"),
        ("simplify_to", 10**400, "too large"),
        ("link", "nobody", "there is no link `nobody`"),
        ("name", "a b", "letters, digits"),
    ],
)
def test_errors_name_arguments_and_not_options(puma: gyroflex.Robot, argument: str, value: object, words: str) -> None:
    with pytest.raises(gyroflex.ArgumentError, match=words) as caught:
        puma.codegen(**{argument: value})  # type: ignore[arg-type]
    assert caught.value.element == f"argument `{argument}`"
    assert "--" not in str(caught.value)


def test_more_parts_than_processors_are_refused(puma: gyroflex.Robot) -> None:
    for argument in ("split", "lanes"):
        with pytest.raises(gyroflex.ArgumentError, match=f"argument `{argument}`: no "):
            puma.codegen(lang="rust", **{argument: 10**6})  # type: ignore[arg-type]


def test_a_urdf_with_keys_is_made_again_from_its_own_file(arm_file: Path) -> None:
    robot = gyroflex.Robot.load(arm_file.parent / "elastic_arm.urdf", set={"gravity": [0, 0, -1.62]})
    assert "gyroflex codegen elastic_arm.urdf --model" in robot.codegen("gravity").files["elastic_arm.py"]


def test_only_python_is_a_module(puma: gyroflex.Robot) -> None:
    with pytest.raises(gyroflex.ArgumentError, match="code in rust is no module"):
        puma.codegen(lang="rust").module()


def test_modules_of_one_robot_are_independent(puma: gyroflex.Robot) -> None:
    complete = puma.codegen("forward", model="complete").module()
    reduced = puma.codegen("forward", model="reduced", name="json").module()
    rows = states(puma, 1)
    assert complete is not reduced
    assert np.abs(complete.forward_dynamics(*rows)[0] - reduced.forward_dynamics(*rows)[0]).max() > 0
    import json

    assert not hasattr(json, "forward_dynamics")


@pytest.mark.parametrize("name", ["../evil", "", "a b", "a\0b"])
def test_names_are_names_of_files_and_functions(puma: gyroflex.Robot, name: str) -> None:
    with pytest.raises(gyroflex.Error, match="letters, digits"):
        puma.codegen(name=name)
    with pytest.raises(gyroflex.Error, match="nothing is asked for"):
        puma.codegen([])


def test_files_say_what_a_changed_copy_has_otherwise(puma: gyroflex.Robot) -> None:
    with pytest.warns(gyroflex.RobotWarning):
        soft = puma.with_(stiffness={"joint2": 1e4})
    assert "--set 'drives.joint2.transmission.stiffness=10000.0'" in soft.codegen("inverse").files["puma560.py"]
