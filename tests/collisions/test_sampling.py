"""The result does not depend on the number of processes, nor on the convex hulls that make it fast."""

from itertools import pairwise
from pathlib import Path

import pytest

pytest.importorskip("pinocchio")

from linkforge_compile import Robot, compile_file
from linkforge_compile.collisions import collider, sampling
from linkforge_compile.collisions.matrix import Matrix, find_matrix
from linkforge_compile.diagnostics import Diagnostics
from tests.collisions.sampled import HEAD
from tests.conftest import ROOT


@pytest.fixture(scope="module")
def quadruped() -> Robot:
    return compile_file(ROOT / "examples" / "07_quadruped" / "quadruped.robot.yaml").result()


def matrix_of(robot: Robot, settings: sampling.SamplingSettings) -> Matrix:
    matrix = find_matrix(robot, settings, lambda _: None, Diagnostics())
    assert matrix
    return matrix


def test_more_processes_give_the_same_pairs(quadruped: Robot, monkeypatch: pytest.MonkeyPatch):
    one = matrix_of(quadruped, sampling.SamplingSettings(samples=1230))
    monkeypatch.setattr(sampling, "WORTH_PROCESSES", 0.0)
    assert matrix_of(quadruped, sampling.SamplingSettings(samples=1230, jobs=3)) == one


def test_another_seed_gives_other_samples(quadruped: Robot):
    pairs = [matrix_of(quadruped, sampling.SamplingSettings(samples=100, seed=seed)) for seed in (0, 0, 1)]
    assert pairs[0] == pairs[1] != pairs[2]


def test_more_samples_only_find_more_collisions(quadruped: Robot):
    few, many = (matrix_of(quadruped, sampling.SamplingSettings(samples=samples)) for samples in (300, 3000))
    assert set(few.checked) < set(many.checked)


def test_progress_counts_all_samples(quadruped: Robot):
    done: list[int] = []
    find_matrix(quadruped, sampling.SamplingSettings(samples=430), done.append, Diagnostics())
    assert done == sorted(done)
    assert done[-1] == 430


def test_convex_hulls_change_no_pair(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    import trimesh

    hook = trimesh.util.concatenate([trimesh.creation.box((0.05, 0.05, 1)), trimesh.creation.box((1, 0.05, 0.05))])
    (tmp_path / "hook.stl").write_bytes(hook.export(file_type="stl"))
    names = [f"hook{number}" for number in range(5)]
    links = "".join(f"  {name}: {{collision: {{mesh: hook.stl}}}}\n" for name in names)
    joint = "{{type: continuous, parent: {}, child: {}, axis: [1, 1, 0.3], origin: [0.2, 0.1, 0]}}"
    joints = "".join(f"  {pair[1]}: {joint.format(*pair)}\n" for pair in pairwise(names))
    (tmp_path / "hooks.robot.yaml").write_text(f"{HEAD}links:\n{links}joints:\n{joints}", "utf-8")
    robot = compile_file(tmp_path / "hooks.robot.yaml").result()
    fast = matrix_of(robot, sampling.SamplingSettings(samples=600))
    monkeypatch.setattr(collider, "_hull", lambda mesh: mesh)
    assert matrix_of(robot, sampling.SamplingSettings(samples=600)) == fast
    assert fast.checked
