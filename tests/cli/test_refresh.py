"""`linkforge import --refresh`: a vendor's new version, below the overrides that were written."""

from pathlib import Path

import pytest

from tests.cli.in_process import linkforge

URDF = """\
<robot name="arm">
  <link name="base"/>
  <link name="tool0">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="tool0"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="2" velocity="3"/>
  </joint>
</robot>
"""
CELL = """\
linkforge: 1
name: cell
links: {table: }
modules:
  left: {use: specs/arm.robot.yaml, parent: table, override: {links: {tool0: {inertial: {mass: 2 kg}}}}}
"""


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    """Return a folder with a vendor's arm, its imported spec, and a spec that uses it with an override."""
    for name in ("vendor", "specs"):
        (tmp_path / name).mkdir()
    (tmp_path / "vendor/arm.urdf").write_text(URDF, "utf-8")
    (tmp_path / "cell.robot.yaml").write_text(CELL, "utf-8")
    assert linkforge("import", "vendor/arm.urdf", "-o", "specs/arm.robot.yaml", cwd=tmp_path).returncode == 0
    return tmp_path


def refresh(folder: Path, *words: str) -> tuple[int, str, list[str]]:
    done = linkforge("import", "--refresh", "specs/arm.robot.yaml", *words, cwd=folder)
    return done.returncode, done.stdout, done.stderr.splitlines()


def release(folder: Path, old: str, new: str) -> None:
    """Let the vendor change its file."""
    file = folder / "vendor/arm.urdf"
    text = file.read_text("utf-8")
    assert old in text
    file.write_text(text.replace(old, new), "utf-8")


def test_unchanged_files_leave_the_spec(cell: Path):
    before = (cell / "specs/arm.robot.yaml").stat()
    assert refresh(cell) == (0, "", ["specs/arm.robot.yaml is up to date"])
    assert refresh(cell, "--check")[0] == 0
    assert (cell / "specs/arm.robot.yaml").stat().st_mtime_ns == before.st_mtime_ns


def test_a_change_comes_in_below_the_override(cell: Path):
    release(cell, 'upper="1"', 'upper="0.5"')
    code, printed, status = refresh(cell)
    assert (code, status) == (0, ["cell.robot.yaml still fits", "wrote specs/arm.robot.yaml"])
    assert "limits/upper: 57.2958 deg → 28.6479 deg" in printed
    urdf = linkforge("compile", "cell.robot.yaml", "-o", "-", cwd=cell).stdout
    assert 'upper="0.5"' in urdf
    assert '<mass value="2"/>' in urdf
    assert refresh(cell)[2] == ["specs/arm.robot.yaml is up to date"]


def test_a_change_that_an_override_hides_is_marked(cell: Path):
    (cell / "second.robot.yaml").write_text(CELL.replace("cell", "second").replace("2 kg", "3 kg"), "utf-8")
    (cell / "plain.robot.yaml").write_text(
        "linkforge: 1\nname: plain\nmodules: {arm: {use: specs/arm.robot.yaml}}\n", "utf-8"
    )
    release(cell, 'mass value="1"', 'mass value="1.5"')
    release(cell, 'upper="1"', 'upper="0.5"')
    code, printed, _ = refresh(cell)
    assert code == 0
    (mass,) = (line for line in printed.splitlines() if "mass" in line)
    assert mass.endswith(", hidden by the overrides at cell.robot.yaml:5, second.robot.yaml:5")
    (upper,) = (line for line in printed.splitlines() if "limits/upper" in line)
    assert "hidden" not in upper


@pytest.mark.parametrize("options", [(), ("--check",)])
def test_an_override_that_no_longer_fits_is_an_error_at_its_place(options: tuple[str, ...], cell: Path):
    release(cell, "tool0", "flange")
    before = (cell / "specs/arm.robot.yaml").read_text("utf-8")
    code, printed, status = refresh(cell, *options)
    assert code == 1
    assert "breaking: removed names that others may rely on\n  link  tool0, now flange\n" in printed
    assert status[0].startswith("cell.robot.yaml:5:71: error: there is no 'tool0' among the links to override")
    assert "cell.robot.yaml no longer fits: 1 error" in status
    assert ((cell / "specs/arm.robot.yaml").read_text("utf-8") == before) == bool(options)


def test_an_edited_spec_is_not_replaced_without_force(cell: Path):
    spec = cell / "specs/arm.robot.yaml"
    imported = spec.read_text("utf-8")
    spec.write_text(imported.replace("effort: 2", "effort: 9"), "utf-8")
    code, _, (message,) = refresh(cell)
    assert code == 2
    assert "was edited since its import" in message
    assert "effort: 9" in spec.read_text("utf-8")
    assert refresh(cell, "--force")[0] == 0
    assert spec.read_text("utf-8") == imported


def test_the_arguments_of_a_xacro_are_those_of_the_import(tmp_path: Path):
    pytest.importorskip("xacro")
    xacro = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm"><xacro:arg name="mass" default="1"/>
    <link name="a">
    <inertial><mass value="$(arg mass)"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    </link></robot>"""
    (tmp_path / "arm.urdf.xacro").write_text(xacro, "utf-8")
    (tmp_path / "specs").mkdir()
    assert linkforge("import", "arm.urdf.xacro", "mass:=7", "-o", "specs/arm.robot.yaml", cwd=tmp_path).returncode == 0
    (tmp_path / "arm.urdf.xacro").write_text(xacro.replace('name="a"', 'name="b"'), "utf-8")
    assert refresh(tmp_path)[0] == 0
    text = (tmp_path / "specs/arm.robot.yaml").read_text("utf-8")
    assert "mass: 7" in text
    assert "  b:" in text


def test_paths_in_a_package_are_the_same_after_a_refresh(tmp_path: Path):
    pytest.importorskip("xacro")
    (tmp_path / "parts").mkdir()
    (tmp_path / "specs").mkdir()
    (tmp_path / "arm.urdf.xacro").write_text(
        """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm"><link name="a"><visual><geometry>
        <mesh filename="file://$(find part_files)/a.stl"/></geometry></visual></link></robot>""",
        "utf-8",
    )
    words = ("arm.urdf.xacro", "--package", "part_files=parts", "-o", "specs/arm.robot.yaml")
    assert linkforge("import", *words, cwd=tmp_path).returncode == 0
    assert refresh(tmp_path)[2][-1] == "specs/arm.robot.yaml is up to date"


def test_packages_of_the_import_are_found_from_anywhere(tmp_path: Path):
    (tmp_path / "arm_description").mkdir()
    (tmp_path / "arm_description/package.xml").write_text("<package><name>arm_description</name></package>", "utf-8")
    (tmp_path / "arm_description/arm.urdf").write_text(URDF, "utf-8")
    (tmp_path / "specs").mkdir()
    words = ("arm_description/arm.urdf", "--package", "arm_description=arm_description", "-o", "specs/arm.robot.yaml")
    assert linkforge("import", *words, cwd=tmp_path).returncode == 0
    assert refresh(tmp_path) == (0, "", ["specs/arm.robot.yaml is up to date"])
    (tmp_path / "arm_description").rename(tmp_path / "moved")
    code, _, (message,) = refresh(tmp_path)
    assert code == 2
    assert (
        "the command at the top of 'specs/arm.robot.yaml' has --package arm_description=../arm_description" in message
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("cell.robot.yaml",), "does not begin with the command that imported it"),
        (("specs/arm.robot.yaml", "a:=1"), "takes arguments from the spec, so 'a:=1' is not allowed"),
        (("vendor/arm.urdf",), "takes the spec that an import wrote"),
        (("specs/gone.robot.yaml",), "there is no file 'specs/gone.robot.yaml'"),
    ],
)
def test_a_refresh_of_anything_else_is_wrong_usage(words: tuple[str, ...], message: str, cell: Path):
    done = linkforge("import", "--refresh", *words, cwd=cell)
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("", "is wrong: the following arguments are required: ROBOT.urdf"),
        ("a.urdf b.urdf", "names 2 robots"),
        ("a.urdf --frobnicate", "is wrong: unrecognized arguments: --frobnicate"),
        ("a.urdf --help", "is wrong: unrecognized arguments: --help"),
        ("/etc/arm.urdf", "names '/etc/arm.urdf', which is outside of the folders that a spec may read"),
        ("../../../arm.urdf", "which is outside of"),
        ("../vendor/arm.urdf --srdf /etc/arm.srdf", "names '/etc/arm.srdf', which is outside of"),
        ("../vendor/arm.urdf --package x=/etc", "names '/etc', which is outside of"),
    ],
)
def test_a_strangers_command_is_checked(words: str, message: str, cell: Path):
    spec = cell / "specs/arm.robot.yaml"
    text = spec.read_text("utf-8")
    spec.write_text(text.replace("../vendor/arm.urdf", words, 1), "utf-8")
    code, _, (found,) = refresh(cell)
    assert code == 2
    assert "the command at the top of 'specs/arm.robot.yaml'" in found
    assert message in found


def test_a_file_outside_is_read_if_it_is_allowed(cell: Path, tmp_path_factory: pytest.TempPathFactory):
    other = tmp_path_factory.mktemp("other")
    (cell / "vendor/arm.urdf").rename(other / "arm.urdf")
    spec = cell / "specs/arm.robot.yaml"
    text = spec.read_text("utf-8")
    spec.write_text(text.replace("../vendor/arm.urdf", str(other / "arm.urdf"), 1), "utf-8")
    assert refresh(cell)[0] == 2
    assert refresh(cell, "--package", f"arm_description={other}", "--check")[0] == 1
    assert refresh(cell, "--allow-outside", "--check")[0] == 1


def test_bytes_that_are_no_text_are_an_edit(cell: Path):
    spec = cell / "specs/arm.robot.yaml"
    spec.write_bytes(spec.read_bytes() + b"# \xff\n")
    code, _, (message,) = refresh(cell)
    assert code == 2
    assert "was edited since its import" in message


def test_a_vendors_file_that_is_gone_is_an_error(cell: Path):
    (cell / "vendor/arm.urdf").unlink()
    code, _, (message,) = refresh(cell)
    assert code == 1
    assert "specs/../vendor/arm.urdf" in message
    assert (cell / "specs/arm.robot.yaml").exists()


def test_check_is_for_refresh(cell: Path):
    assert "linkforge import: --check is for --refresh" in linkforge("import", "a.urdf", "--check", cwd=cell).stderr
