"""What the comparison with xacro's robot may read, and what it notices."""

from pathlib import Path

import pytest

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics.codes.importing import NOTHING_EXPANDED
from linkforge_compile.importing import ReadBack
from linkforge_compile.migration import proof
from linkforge_compile.migration.proof import Prover, Specs
from tests.cli.in_process import linkforge
from tests.migration.migrated import write

SPHERE = '<link name="base"><collision><geometry><sphere radius="{}"/></geometry></collision></link>'
SIZES = """<xacro:property name="sizes" value="${xacro.load_yaml('sizes.yaml')}"/>""" + SPHERE.format("${sizes.base}")


def _robot(folder: Path, text: str) -> Path:
    """Write a xacro and its data into a repository of their own."""
    (folder / "robot/.git").mkdir(parents=True)
    (folder / "robot/sizes.yaml").write_text("base: 1\n", "utf-8")
    return write(folder / "robot", robot=text)


def _compared(main: Path, spec: Path, text: str) -> str | None:
    prover = Prover(main, Settings().loader(main))
    (one,) = prover.compare(Specs(spec, {}, {spec.name: text}), [{}])
    return one.fault


def test_specs_read_what_the_xacro_may_and_nothing_else(tmp_path: Path):
    main = _robot(tmp_path, SPHERE.format("1"))
    (tmp_path / "secret.yaml").write_text("base: 1\n", "utf-8")
    text = "linkforge: 1\nname: robot\ndata: {{sizes: {}}}\nlinks: {{base: {{collision: {{sphere: $(sizes.base)}}}}}}\n"
    spec = tmp_path / "specs/robot.robot.yaml"
    assert _compared(main, spec, text.format("../robot/sizes.yaml")) is None
    assert "LF3401" in (_compared(main, spec, text.format("../secret.yaml")) or "")
    assert not spec.parent.exists()


def test_a_robot_that_cannot_be_read_back_is_a_fault(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    main = _robot(tmp_path, SPHERE.format("1"))
    text = "linkforge: 1\nname: robot\nlinks: {base: {collision: {sphere: 1}}}\n"
    spec = tmp_path / "robot/robot.robot.yaml"
    assert _compared(main, spec, text) is None
    fault = NOTHING_EXPANDED.at(None)
    monkeypatch.setattr(proof, "as_read_back", lambda _robot: ReadBack(None, (fault,)))
    assert fault.message in (_compared(main, spec, text) or "")


def test_specs_that_need_a_file_of_another_repository_say_how_to_compile_them(tmp_path: Path):
    _robot(tmp_path, SIZES)
    ran = linkforge("migrate", "robot/robot.xacro", "-o", "specs", cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert "'linkforge compile specs/robot.robot.yaml' will fail here: '../robot/sizes.yaml'" in ran.stderr  # LF8049
    assert linkforge("compile", "specs/robot.robot.yaml", cwd=tmp_path).returncode == 1
    assert linkforge("compile", "specs/robot.robot.yaml", "--allow-outside", cwd=tmp_path).returncode == 0
    assert "LF8049" not in linkforge("migrate", "robot/robot.xacro", "-o", "robot", cwd=tmp_path).stderr


def test_verify_tells_that_a_parameter_is_gone(tmp_path: Path):
    text = '<xacro:arg name="name" default="left"/><link name="$(arg name)"/>'
    write(tmp_path, robot=text)
    assert linkforge("migrate", "robot.xacro", cwd=tmp_path).returncode == 0
    spec = tmp_path / "robot.robot.yaml"
    spec.write_text(spec.read_text("utf-8").replace("base_name", "side"), "utf-8")
    ran = linkforge("migrate", "robot.xacro", "--verify", cwd=tmp_path)
    assert ran.returncode == 1
    assert "'robot.robot.yaml' has no parameter 'base_name', which is the argument 'name'" in ran.stderr  # LF8050


@pytest.mark.parametrize("folder", ["work/robots", "my work/robots"])
def test_a_path_through_a_parent_folder_is_the_same_file(tmp_path: Path, folder: str):
    """What a working folder or `$(find)` puts before a path does not make it another file."""
    here, vendor = tmp_path / folder, tmp_path / "vendor/arm"
    here.mkdir(parents=True)
    (vendor / "meshes").mkdir(parents=True)
    (vendor / "package.xml").write_text("<package><name>arm</name></package>", "utf-8")
    meshes = [
        "$(find arm)/meshes/a.stl",
        "$(find arm)/../arm/meshes/b.stl",
        "${'$(find arm)/meshes/../meshes/c.stl'}",
    ]
    visual = '<visual name="v{}"><geometry><mesh filename="file://{}"/></geometry></visual>'
    plugin = '<gazebo><plugin name="p" filename="p.so"><file>$(find arm)/../arm/p.yaml</file></plugin></gazebo>'
    visuals = "".join(visual.format(number, mesh) for number, mesh in enumerate(meshes))
    write(vendor, robot=f'<link name="base">{visuals}</link>{plugin}')
    up = "../../vendor/arm"
    for packages in ([], ["--package", f"arm={up}"]):
        command = ["migrate", f"{up}/robot.xacro", *packages, "-o", ".", "--allow-outside"]
        ran = linkforge(*command, "--force", cwd=here)
        assert ran.returncode == 0, ran.stderr
        assert "1 of 1 combination" in ran.stdout
        assert linkforge(*command, "--verify", cwd=here).returncode == 0
    spec = here / "robot.robot.yaml"
    spec.write_text(spec.read_text("utf-8").replace("a.stl", "other.stl"), "utf-8")
    ran = linkforge(*command, "--verify", cwd=here)
    assert ran.returncode == 1
    assert "other.stl" in ran.stderr
