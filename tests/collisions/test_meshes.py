"""The meshes of collisions: which files are read, and what is refused."""

import os
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.collisions.sampled import HEAD

_TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def _sample(name: str, folder: Path):
    spec = f"{HEAD}links: {{hand: {{collision: {{mesh: {name}}}}}}}\n"
    (folder / "robot.robot.yaml").write_text(spec, "utf-8")
    return linkforge("collisions", "robot.robot.yaml", "--samples", "1", cwd=folder)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_mesh_opens_no_other_file(tmp_path: Path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "hand.obj").write_text(f"mtllib pipe\nusemtl steel\n{_TETRAHEDRON}", "utf-8")
    done = _sample("hand.obj", tmp_path)
    assert (done.returncode, done.stderr.count("error")) == (0, 0), done.stderr


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_mesh_is_a_regular_file(tmp_path: Path):
    os.mkfifo(tmp_path / "hand.obj")
    done = _sample("hand.obj", tmp_path)
    assert done.returncode == 1
    assert "LF7701" in done.stderr


def test_a_format_that_may_name_other_files_is_refused(tmp_path: Path):
    (tmp_path / "hand.gltf").write_text('{"asset": {"version": "2.0"}, "buffers": [{"uri": "pipe"}]}', "utf-8")
    done = _sample("hand.gltf", tmp_path)
    assert done.returncode == 1
    assert "its name must end in .stl, .obj or .dae [LF7702]" in done.stderr


def test_a_vertex_that_is_not_finite_is_refused(tmp_path: Path):
    import numpy as np

    triangles = np.zeros(4, dtype=[("numbers", "<f4", 12), ("attribute", "<u2")])
    triangles["numbers"][:, 3:] = np.arange(36).reshape(4, 9)
    triangles["numbers"][2, 5] = np.nan
    (tmp_path / "hand.stl").write_bytes(bytes(80) + (4).to_bytes(4, "little") + triangles.tobytes())
    done = _sample("hand.stl", tmp_path)
    assert done.returncode == 1
    assert "the coordinates of a vertex are not finite [LF7702]" in done.stderr
