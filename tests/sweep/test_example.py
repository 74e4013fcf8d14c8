"""Lesson 14, which scores the legs of a quadruped with MuJoCo."""

import ast
import importlib.util
import math
import re
import shlex
from pathlib import Path
from types import ModuleType

import pytest

from linkforge_compile.sweep import run
from tests.cli.in_process import linkforge
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


def blocks_of_page(language: str) -> list[str]:
    page = (ROOT / "docs" / "sweep.md").read_text("utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", page, re.MULTILINE | re.DOTALL)


def test_the_examples_of_the_page_do_what_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    (spec,), table, (reading, scoring) = blocks_of_page("yaml"), blocks_of_page("text")[1], blocks_of_page("python")
    Path("arm.robot.yaml").write_text(spec, "utf-8")
    command = shlex.split(blocks_of_page("sh")[0])[1:]
    assert linkforge(*command, "--quiet", cwd=tmp_path).returncode == 0
    assert sorted(path.name for path in Path("out/robots/000000").iterdir()) == ["arm.srdf", "arm.urdf"]
    exec(reading)
    assert capsys.readouterr().out == "{b'unit': b'm'}\n"
    assert len(Path("out.csv").read_text("utf-8").splitlines()) == 61
    Path("points.csv").write_text(table, "utf-8")
    for options in (
        ["--values", "points.csv"],
        ["--sample", "3"],
        ["--set", "reach=1", "--where", "$(reach > 2 * base)"],
    ):
        done = linkforge("sweep", "arm.robot.yaml", *options, "-o", f"of{options[0]}", "--quiet", cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
    exec(scoring, {"__name__": "__main__"})
    best = ast.literal_eval(capsys.readouterr().out)
    assert [row["payload"] for row in best] == sorted((row["payload"] for row in best), reverse=True)
    assert len(best) == 10
    assert best[0]["reach"] == 0.4
