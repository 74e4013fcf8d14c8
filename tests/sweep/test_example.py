"""Lesson 14, which scores the legs of a quadruped with MuJoCo."""

import ast
import importlib.util
import math
import re
from pathlib import Path
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


def test_the_python_example_of_the_page_prints_ten_robots(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    code = re.findall(
        r"^```python\n(.*?)^```", (ROOT / "docs" / "sweep.md").read_text("utf-8"), re.MULTILINE | re.DOTALL
    )
    (tmp_path / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nparameters: {reach: {type: length, default: 0.5 m}, fingers: 2}\n"
        "links: {base: {visual: {box: [$(reach), 0.1, 0.1]}}}\n",
        "utf-8",
    )
    monkeypatch.chdir(tmp_path)
    exec(code[0].replace("jobs=4", "jobs=1"), {"__name__": "__main__"})
    best = ast.literal_eval(capsys.readouterr().out)
    assert [row["payload"] for row in best] == sorted((row["payload"] for row in best), reverse=True)
    assert len(best) == 10
    assert best[0]["reach"] == 0.4
