"""The comparison of instruction counts must fail where a count grows, goes missing or depends on the state."""

import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import pytest

PATH = Path(__file__).resolve().parents[2] / "benches/instructions"


@pytest.fixture
def instructions(tmp_path, monkeypatch):
    """The script as a module, with a file of its own: two cases of 1000 instructions, recorded with this compiler."""
    monkeypatch.setattr(sys, "path", [*sys.path])
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    loader = SourceFileLoader("instructions", str(PATH))
    module = module_from_spec(spec_from_loader("instructions", loader))
    loader.exec_module(module)
    monkeypatch.setattr(module, "FILE", tmp_path / "instructions.txt")
    monkeypatch.setattr(module, "compiler", lambda: "rustc 1.0.0")
    module.record({"default arm aba": [1000, 1000], "default arm rnea": [1000]})
    return module


def test_counts_as_recorded_are_accepted(instructions):
    assert instructions.grown({"default arm aba": [1000], "default arm rnea": [1000]}) == []


def test_growth_beyond_three_percent_is_named_and_less_is_not(instructions):
    assert instructions.grown({"default arm aba": [1030], "default arm rnea": [1000]}) == []
    (wrong,) = instructions.grown({"default arm aba": [1031], "default arm rnea": [1000]})
    assert "default arm aba: 1000 to 1031" in wrong


def test_a_gain_is_accepted_and_asks_to_be_recorded(instructions, capsys):
    assert instructions.grown({"default arm aba": [900], "default arm rnea": [1000]}) == []
    assert "benches/instructions record" in capsys.readouterr().out


def test_cases_of_one_side_only_are_named(instructions):
    wrong = instructions.grown({"default arm aba": [1000], "default arm crba": [5]})
    assert len(wrong) == 2 and "default arm crba" in wrong[0] and "default arm rnea" in wrong[1]


def test_another_compiler_is_reported_and_not_judged(instructions, monkeypatch, capsys):
    monkeypatch.setattr(instructions, "compiler", lambda: "rustc 2.0.0")
    assert instructions.grown({"default arm aba": [2000], "default arm rnea": [1000]}) == []
    assert "+50.0 %" in capsys.readouterr().out


def test_a_count_that_depends_on_the_state_is_named(instructions):
    (wrong,) = instructions.dependent({"default arm aba": [1000, 1001], "default arm rnea": [7, 7]})
    assert "default arm aba: 1000 to 1001" in wrong
