"""Lesson 14, which scores the legs of a quadruped with MuJoCo."""

import importlib.util
import math
from types import ModuleType

import pytest

from linkforge_compile.sweep import run
from tests.conftest import ROOT

FOLDER = ROOT / "examples/14_sweep"


def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("score_legs", FOLDER / "score_legs.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_knee_holds_a_quarter_of_the_weight_at_its_distance_from_the_foot():
    """Hip, knee and foot are an isosceles triangle with the height of the hip over the foot."""
    pytest.importorskip("mujoco")
    example = script()
    table = run(example.SPEC, {"segment": [0.18, 0.22], "payload": ["2 kg", "6 kg"]}, example.score)
    for row in table.to_pylist():
        arm = math.sqrt(row["segment"] ** 2 - 0.15**2)
        assert row["knee_torque"] == pytest.approx(9.81 * row["robot_mass"] / 4 * arm, rel=0.1)
        assert 0 < row["sag"] < 0.02
        assert row["tilt"] < 0.02
    torques = table["knee_torque"].to_pylist()
    assert torques == sorted(torques)
