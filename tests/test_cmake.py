"""`linkforge_add_robot` under real CMake: the ROS 2 package of the examples, configured, built and installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
import yaml

from linkforge_compile import __version__
from linkforge_compile.cli.targets import name_of
from linkforge_compile.formats import FORMATS, format_named
from tests.conftest import ROOT
from tests.programs import program

PACKAGE = ROOT / "examples" / "11_ros2_package"

# What the package asks of ament_cmake: `ament_package()` installs the manifest.
AMENT = "macro(ament_package)\n  install(FILES package.xml DESTINATION share/${PROJECT_NAME})\nendmacro()\n"


class Linkforge(NamedTuple):
    """A copy of linkforge whose files may be touched, and the command that runs it."""

    folder: Path
    command: Path

    @classmethod
    def copied(cls, folder: Path) -> Linkforge:
        for name in ("linkforge_compile", "schemas", "templates", "cmake"):
            shutil.copytree(ROOT / name, folder / name)
        command = folder / "linkforge"
        command.write_text(f'#!/bin/sh\nPYTHONPATH="{folder}" exec "{sys.executable}" -m linkforge_compile "$@"\n')
        command.chmod(0o755)
        return cls(folder, command)


@pytest.fixture(scope="module")
def linkforge(tmp_path_factory: pytest.TempPathFactory) -> Linkforge:
    return Linkforge.copied(tmp_path_factory.mktemp("linkforge"))


class Workspace:
    """The package in a workspace as colcon lays one out, in a folder with a space, and its build."""

    def __init__(self, folder: Path, generator: str, linkforge: Linkforge, package: Path = PACKAGE) -> None:
        self.source, self.build, self.prefix = (folder / name for name in ("src/pan_tilt", "build", "install"))
        shutil.copytree(package, self.source)
        ament = folder / "ros" / "share" / "ament_cmake" / "cmake"
        ament.mkdir(parents=True)
        (ament / "ament_cmakeConfig.cmake").write_text(AMENT)
        self._cmake = program("cmake")
        made_by = program("ninja" if generator == "Ninja" else "make")
        self._configure = (
            *(self._cmake, "-S", self.source, "-B", self.build, "-G", generator),
            f"-DCMAKE_MAKE_PROGRAM={made_by}",
            f"-DCMAKE_INSTALL_PREFIX={self.prefix}",
            f"-DCMAKE_PREFIX_PATH={folder / 'ros'}",
            f"-Dlinkforge_compile_DIR={linkforge.folder / 'cmake'}",
            f"-DLINKFORGE_EXECUTABLE={linkforge.command}",
        )

    def _run(self, *words: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(words, capture_output=True, text=True, check=False, timeout=120)

    def configure(self) -> None:
        run = self._run(*self._configure)
        assert run.returncode == 0, run.stderr
        assert "Warning" not in run.stderr, run.stderr

    def make(self) -> set[str]:
        """Build, and return the robots that were compiled."""
        run = self._run(self._cmake, "--build", self.build)
        assert run.returncode == 0, run.stdout + run.stderr
        assert run.stderr == ""
        _, *compiled = run.stdout.split("Compiling robot ")
        return {text.split()[0] for text in compiled}

    def make_in_vain(self) -> str:
        """Build a spec with errors, and return the output."""
        run = self._run(self._cmake, "--build", self.build)
        assert run.returncode != 0
        return run.stdout + run.stderr

    def install(self) -> None:
        run = self._run(self._cmake, "--install", self.build)
        assert run.returncode == 0, run.stderr


@pytest.fixture
def workspace(request: pytest.FixtureRequest, tmp_path: Path, linkforge: Linkforge) -> Workspace:
    """Build with Ninja, or with a test's own generator."""
    made = Workspace(tmp_path / "my ws", getattr(request, "param", "Ninja"), linkforge)
    made.configure()
    return made


by_both = pytest.mark.parametrize("workspace", ["Unix Makefiles", "Ninja"], indirect=True)
"""For what depends on the generator: how it learns what a robot is made from, and what follows an error."""


BOTH = {"pan_tilt", "pan_tilt_sim"}


def changed(path: Path) -> None:
    """Make a file newer than whatever is built, without another byte."""
    os.utime(path)


def test_the_package_installs_the_robots_that_its_specs_compile_to(workspace: Workspace):
    assert workspace.make() == BOTH
    workspace.install()
    share = workspace.prefix / "share" / "pan_tilt_description"
    for name in ("pan_tilt.urdf", "pan_tilt.srdf"):
        assert (share / "urdf" / name).read_bytes() == (PACKAGE / "robots" / name).read_bytes()
    sim = (share / "urdf" / "pan_tilt_sim.urdf").read_text("utf-8")
    assert "GazeboSimSystem" in sim
    assert "<update_rate>15</update_rate>" in sim
    assert not (share / "urdf" / "pan_tilt_sim.srdf").exists()
    controllers = yaml.safe_load((share / "config" / "pan_tilt_controllers.yaml").read_text("utf-8"))
    assert controllers["head_controller"]["ros__parameters"]["joints"] == ["pan_turn", "tilt_turn"]
    assert {path.name for path in (share / "robots").iterdir()} == {"pan_tilt.robot.yaml", "servo.robot.yaml"}
    assert str(workspace.source) not in sim


def test_the_package_for_moveit_installs_its_configuration(tmp_path: Path, linkforge: Linkforge):
    workspace = Workspace(tmp_path, "Ninja", linkforge, ROOT / "examples" / "13_moveit_package")
    workspace.configure()
    assert workspace.make() == {"picker"}
    workspace.install()
    share = workspace.prefix / "share" / "picker_moveit_config"
    installed = {path.relative_to(share).as_posix() for path in share.rglob("*") if path.is_file()}
    assert installed == {*format_named("moveit").files, "launch/move_group.launch.py", "package.xml"}


@by_both
def test_what_a_robot_is_made_from_builds_it_again_and_nothing_else_does(workspace: Workspace, linkforge: Linkforge):
    assert workspace.make() == BOTH
    assert workspace.make() == set()
    for name in ("package.xml", "launch/view.launch.py", "robots/pan_tilt.urdf"):
        changed(workspace.source / name)
    assert workspace.make() == set()
    made_from = (
        workspace.source / "robots" / "pan_tilt.robot.yaml",
        workspace.source / "robots" / "servo.robot.yaml",
        workspace.source / "config" / "servos.yaml",
        linkforge.folder / "templates" / "urdf" / "link.xml.j2",
    )
    for path in made_from:
        changed(path)
        assert workspace.make() == BOTH, path
        assert workspace.make() == set(), path


def test_another_value_in_a_file_of_data_reaches_the_robot(workspace: Workspace):
    workspace.make()
    catalogue, urdf = workspace.source / "config" / "servos.yaml", workspace.build / "pan_tilt.urdf"
    before = urdf.read_text("utf-8")
    catalogue.write_text(catalogue.read_text("utf-8").replace("1.5 N*m", "1.7 N*m"))
    assert workspace.make() == BOTH
    assert urdf.read_text("utf-8") == before.replace('effort="1.5"', 'effort="1.7"')


@by_both
def test_a_fault_stops_the_build_at_its_place_until_it_is_mended(workspace: Workspace):
    workspace.make()
    module = workspace.source / "robots" / "servo.robot.yaml"
    right = module.read_text("utf-8")
    urdf = (workspace.build / "pan_tilt.urdf").read_bytes()
    module.write_text(right.replace("child: horn", "child: hron"))
    stderr = workspace.make_in_vain()
    line = right[: right.index("child: horn")].count("\n") + 1
    assert f"{module}:{line}:12: error: no link named 'hron'; did you mean 'horn'? [LF4102]" in stderr
    assert (workspace.build / "pan_tilt.urdf").read_bytes() == urdf
    assert "[LF4102]" in workspace.make_in_vain()
    module.write_text(right)
    assert workspace.make() == BOTH
    assert workspace.make() == set()


def test_a_module_that_is_no_more_is_missed(workspace: Workspace):
    workspace.make()
    (workspace.source / "robots" / "servo.robot.yaml").unlink()
    assert "there is no file 'servo.robot.yaml'" in workspace.make_in_vain()


NAMES = ", ".join(one.name for one in FORMATS)

FIND = f'find_package(linkforge_compile REQUIRED PATHS "{ROOT / "cmake"}" NO_DEFAULT_PATH)'


def script(folder: Path, text: str, *words: str) -> subprocess.CompletedProcess[str]:
    """Run lines of CMake in a project that builds nothing."""
    (folder / "CMakeLists.txt").write_text(f"cmake_minimum_required(VERSION 3.20)\nproject(p NONE)\n{text}\n")
    (folder / "arm.robot.yaml").write_text("linkforge: 1\nname: arm\nlinks: {base: }\n")
    words = (program("cmake"), "-S", str(folder), "-B", str(folder / "b"), *words)
    return subprocess.run(words, capture_output=True, text=True, check=False, timeout=60)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ("FORMAT urdf", "it has no argument 'FORMAT'; it takes PARAMS, VARIANT,"),
        ("PARAMS reach:=1 FORMAT urdf", "PARAMS takes NAME:=VALUE, found 'FORMAT'"),
        ("FORMATS xyz", f"FORMATS takes {NAMES}, found 'xyz'"),
        ("BASE loose", "BASE takes fixed or free, found 'loose'"),
        ("NESTED true", "NESTED takes no or yes, found 'true'"),
        ("GAZEBO ignition", "GAZEBO takes gz or classic, found 'ignition'"),
        ("FORMATS INSTALL", "no value comes after FORMATS"),
        ("NAME ../arm", "NAME is that of files in the build folder, without their ending; found '../arm'"),
        ("DESTINATION urdf", "DESTINATION needs INSTALL"),
        ("PACKAGES arm", "PACKAGES takes NAME=FOLDER, found 'arm'"),
        ("PACKAGES arm=nowhere", "PACKAGES arm=nowhere: there is no folder '"),
        (
            ")\nlinkforge_add_robot(arm.robot.yaml",
            "another one makes arm.urdf already; call the files of this one by NAME",
        ),
        (
            ")\nlinkforge_add_robot(arm.robot.yaml NAME b TARGET robot_arm",
            "there is a target 'robot_arm' already; call that of this one by TARGET",
        ),
    ],
)
def test_cmake_configure_reports_wrong_arguments(tmp_path: Path, arguments: str, expected: str):
    run = script(
        tmp_path,
        f"{FIND}\nlinkforge_add_robot(arm.robot.yaml {arguments})",
        f"-DLINKFORGE_EXECUTABLE={program('linkforge')}",
    )
    assert run.returncode != 0
    assert f"linkforge_add_robot(arm.robot.yaml): {expected}" in " ".join(run.stderr.split())


def test_two_robots_install_into_files_of_their_own(tmp_path: Path):
    adds = [f"linkforge_add_robot(arm.robot.yaml {name} INSTALL)" for name in ("NAME a/head", "NAME b/head", "")]
    (tmp_path / "sub").mkdir()
    beneath = tmp_path / "sub" / "CMakeLists.txt"
    text = "\n".join((FIND, *adds, "add_subdirectory(sub)"))
    words = (f"-DLINKFORGE_EXECUTABLE={program('linkforge')}", "-DCMAKE_INSTALL_PREFIX=/prefix")
    beneath.write_text("linkforge_add_robot(../arm.robot.yaml TARGET other INSTALL DESTINATION ./urdf)\n")
    stderr = " ".join(script(tmp_path, text, *words).stderr.split())
    assert "(../arm.robot.yaml): another one installs '/prefix/share/p/urdf/arm.urdf' already; call the files" in stderr
    beneath.write_text("linkforge_add_robot(../arm.robot.yaml TARGET other INSTALL DESTINATION config)\n")
    assert script(tmp_path, text, *words).returncode == 0
    installs = "".join(path.read_text() for path in (tmp_path / "b").rglob("cmake_install.cmake"))
    for folder in ("urdf/a", "urdf/b", "urdf", "config"):
        assert f'"${{CMAKE_INSTALL_PREFIX}}/share/p/{folder}" TYPE FILE' in installs


@pytest.mark.parametrize("value", ["${none}", '"${none}"'])
def test_an_empty_variable_has_no_effect(tmp_path: Path, value: str):
    add = (
        f'linkforge_add_robot(arm.robot.yaml VARIANT {value} PARAMS ${{none}} NAME "" TARGET "" INSTALL DESTINATION "")'
    )
    run = script(tmp_path, f"{FIND}\n{add}", f"-DLINKFORGE_EXECUTABLE={program('linkforge')}")
    assert (run.returncode, run.stderr) == (0, "")
    rules = "".join(path.read_text() for path in (tmp_path / "b").rglob("build.make"))
    assert "arm.robot.yaml --installed-in" in rules


def test_cmake_configure_reports_a_missing_spec_unless_the_build_makes_it(tmp_path: Path):
    add = "linkforge_add_robot(amr.robot.yaml)"
    run = script(tmp_path, f"{FIND}\n{add}", f"-DLINKFORGE_EXECUTABLE={program('linkforge')}")
    assert "linkforge_add_robot(amr.robot.yaml): there is no spec '" in " ".join(run.stderr.split())
    run = script(
        tmp_path, f'{FIND}\nlinkforge_add_robot("a;b.robot.yaml")', f"-DLINKFORGE_EXECUTABLE={program('linkforge')}"
    )
    assert "for it has ';' in it; rename it" in " ".join(run.stderr.split())
    makes = "set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/amr.robot.yaml PROPERTIES GENERATED TRUE)"
    assert script(tmp_path, f"{FIND}\n{makes}\n{add}", f"-DLINKFORGE_EXECUTABLE={program('linkforge')}").returncode == 0


def test_arguments_reach_the_command_unchanged(tmp_path: Path):
    echo = tmp_path / "echo words"
    linkforge = program("linkforge")
    echo.write_text(
        f"#!/bin/sh\n[ $1 = formats ] && exec '{linkforge}' \"$@\"\nprintf '%s\\n' \"$@\"\ntouch arm.urdf\n"
    )
    echo.chmod(0o755)
    (tmp_path / "parts").mkdir()
    add = 'PARAMS "name:=two words; and more" "axes:=[1;2]" VARIANT sim GAZEBO classic NESTED yes'
    add += " PACKAGES parts=parts STRICT IGNORE LF5616 LF74,LF75 INSTALL"
    text = f"{FIND}\nlinkforge_add_robot(arm.robot.yaml {add} DESTINATION robots)"
    assert script(tmp_path, text, f"-DLINKFORGE_EXECUTABLE={echo}").returncode == 0
    build = subprocess.run(
        [program("cmake"), "--build", tmp_path / "b"], capture_output=True, text=True, check=True, timeout=60
    )
    lines = build.stdout.splitlines()
    assert lines[lines.index("-p") : lines.index("-o")] == [
        *("-p", "name:=two words; and more", "-p", "axes:=[1;2]", "--package", f"parts={tmp_path / 'parts'}"),
        *("--strict", "--ignore", "LF5616", "--ignore", "LF74,LF75"),
        *("--variant", "sim", "--gazebo", "classic", "--nested"),
        *("--installed-in", f"urdf={tmp_path / 'robots'}"),
        *("--format", "urdf"),
    ]


def test_cmake_names_files_after_the_spec_as_the_command_does(tmp_path: Path):
    parts = ("robot.yaml", "yaml", "robot.yml", "yml", "urdf.xacro", "xacro", "urdf", "urdf.robot.yaml", "xacro.yaml")
    specs = [f"arm{number}.{part}" for number, part in enumerate(parts)]
    for spec in specs:
        (tmp_path / spec).touch()
    text = f"{FIND}\n"
    text += "".join(f'linkforge_add_robot({spec} OUTPUT made)\nmessage("made ${{made}}")\n' for spec in specs)
    run = script(tmp_path, text, f"-DLINKFORGE_EXECUTABLE={program('linkforge')}")
    made = [Path(line).stem for line in run.stderr.splitlines() if line.startswith("made ")]
    assert made == [name_of(spec) for spec in specs]


@pytest.mark.parametrize(("version", "is_found"), [("", True), (__version__, True), ("0.1", True), ("99", False)])
def test_the_version_that_cmake_finds_is_that_of_the_package(tmp_path: Path, version: str, is_found: bool):
    find = f'find_package(linkforge_compile {version} PATHS "{ROOT / "cmake"}" NO_DEFAULT_PATH)'
    text = f'{find}\nmessage("found ${{linkforge_compile_FOUND}} ${{linkforge_compile_VERSION}}")'
    run = script(tmp_path, text, f"-DLINKFORGE_EXECUTABLE={program('linkforge')}")
    assert (f"found 1 {__version__}" in run.stderr) is is_found


def test_a_missing_command_is_reported(tmp_path: Path):
    run = script(tmp_path, f'set(ENV{{PATH}} "")\n{FIND}')
    assert run.returncode != 0
    stderr = " ".join(run.stderr.split())
    assert "there is no command 'linkforge' beside it nor on the PATH; set LINKFORGE_EXECUTABLE" in stderr


class Fleet:
    """A project that compiles three robots, two of which use one module, by `linkforge_add_robots`."""

    def __init__(self, folder: Path, generator: str, linkforge: Linkforge) -> None:
        self.source, self.build, self.prefix = (folder / name for name in ("src", "build", "install"))
        self._runs = folder / "runs"
        counted = folder / "linkforge"
        folder.mkdir()
        counted.write_text(f'#!/bin/sh\necho >> "{self._runs}"\nexec "{linkforge.command}" "$@"\n')
        counted.chmod(0o755)
        self.source.mkdir()
        hand = "linkforge: 1\nname: hand\nlinks: {palm: }\n"
        (self.source / "part.yaml").write_text(hand)
        semantic = "semantic: {groups: {all: {links: [base]}}}\n"
        use = "modules: {part: {use: part.yaml, parent: base}}\n"
        for name, uses in (("arm", use), ("base", ""), ("cell", use)):
            text = f"linkforge: 1\nname: {name}\nlinks: {{base: }}\n{uses}{semantic}"
            (self.source / f"{name}.robot.yaml").write_text(text)
        (self.source / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.20)\nproject(fleet NONE)\n"
            f'find_package(linkforge_compile REQUIRED PATHS "{linkforge.folder / "cmake"}" NO_DEFAULT_PATH)\n'
            "file(GLOB specs CONFIGURE_DEPENDS *.robot.yaml)\n"
            # The order of FORMATS is not that of linkforge, and has no effect on what is built again.
            "linkforge_add_robots(${specs} TARGET fleet FORMATS srdf urdf INSTALL OUTPUT made)\n"
            'add_custom_command(OUTPUT joined COMMAND "${CMAKE_COMMAND}" -E echo joining COMMAND "${CMAKE_COMMAND}" '
            "-E touch joined DEPENDS ${made})\nadd_custom_target(join ALL DEPENDS joined)\n"
        )
        self._cmake = program("cmake")
        made_by = program("ninja" if generator == "Ninja" else "make")
        run = self._run(
            *(self._cmake, "-S", self.source, "-B", self.build, "-G", generator, f"-DCMAKE_MAKE_PROGRAM={made_by}"),
            *(f"-DCMAKE_INSTALL_PREFIX={self.prefix}", f"-DLINKFORGE_EXECUTABLE={counted}"),
        )
        assert (run.returncode, "Warning" in run.stderr) == (0, False), run.stderr

    def _run(self, *words: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(words, capture_output=True, text=True, check=False, timeout=120)

    def make(self) -> tuple[int, bool, str]:
        """Build, and return how often linkforge ran, whether what depends on the outputs was built, and the errors."""
        self._runs.write_text("")
        run = self._run(self._cmake, "--build", self.build)
        return (
            self._runs.read_text().count("\n"),
            "joining" in run.stdout,
            run.stdout + run.stderr if run.returncode else "",
        )

    def install(self) -> None:
        assert self._run(self._cmake, "--install", self.build).returncode == 0


@pytest.mark.parametrize("generator", ["Unix Makefiles", "Ninja"])
def test_several_robots_are_compiled_by_one_process_when_one_changes(
    tmp_path: Path, generator: str, linkforge: Linkforge
):
    fleet = Fleet(tmp_path / "my ws", generator, linkforge)
    assert fleet.make() == (1, True, "")
    assert fleet.make() == (0, False, "")
    fleet.install()
    installed = fleet.prefix / "share" / "fleet" / "urdf"
    names = [f"{name}.{format_}" for name in ("arm", "base", "cell") for format_ in ("srdf", "urdf")]
    assert sorted(path.name for path in installed.iterdir()) == names
    # A touched module renews no byte: Ninja then spares what depends on the outputs.
    os.utime(fleet.source / "part.yaml")
    assert fleet.make() == (1, generator != "Ninja", "")
    assert fleet.make() == (0, False, "")
    base = (fleet.build / "base.urdf").stat().st_mtime_ns
    (fleet.source / "part.yaml").write_text("linkforge: 1\nname: hand\nlinks: {finger: }\n")
    assert fleet.make() == (1, True, "")
    assert "finger" in (fleet.build / "cell.urdf").read_text()
    assert ((fleet.build / "base.urdf").stat().st_mtime_ns == base) is (generator == "Ninja")
    assert fleet.make() == (0, False, "")


def test_an_error_in_one_of_several_robots_stops_the_build(tmp_path: Path, linkforge: Linkforge):
    fleet = Fleet(tmp_path / "fleet", "Ninja", linkforge)
    arm = fleet.source / "arm.robot.yaml"
    right = arm.read_text()
    arm.write_text(right.replace("links: [base]", "links: [bass]"))
    for _ in range(2):
        runs, is_joined, errors = fleet.make()
        assert (runs, is_joined) == (1, False)
        assert f"{arm}:5:35: error: " in errors
    arm.write_text(right)
    assert fleet.make() == (1, True, "")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("arm.robot.yaml", "TARGET is missing, the name of the target of all these robots"),
        ("TARGET all_robots", "it takes one spec or more before its keywords"),
        ("arm.robot.yaml amr.robot.yaml TARGET r", "there is no spec '"),
        (
            "arm.robot.yaml ./arm.robot.yaml TARGET r",
            "makes arm.urdf already; add this one by linkforge_add_robot, with",
        ),
        ("arm.robot.yaml TARGET r FORMATS xyz", f"FORMATS takes {NAMES}, found 'xyz'"),
    ],
)
def test_wrong_arguments_of_several_robots_are_reported_when_cmake_configures(
    tmp_path: Path, arguments: str, message: str
):
    run = script(
        tmp_path, f"{FIND}\nlinkforge_add_robots({arguments})", f"-DLINKFORGE_EXECUTABLE={program('linkforge')}"
    )
    assert run.returncode != 0
    assert message in " ".join(run.stderr.split())


def test_meshes_are_looked_for_from_the_folder_of_each_format(tmp_path: Path):
    add = "linkforge_add_robot(arm.robot.yaml FORMATS urdf srdf sdf INSTALL)"
    run = script(tmp_path, f"{FIND}\n{add}", f"-DLINKFORGE_EXECUTABLE={program('linkforge')}")
    assert (run.returncode, run.stderr) == (0, "")
    rules = "".join(path.read_text() for path in (tmp_path / "b").rglob("build.make"))
    for format_ in ("urdf", "sdf"):
        assert f"--installed-in {format_}={tmp_path / format_} " in rules
    assert "--installed-in srdf" not in rules


@pytest.mark.parametrize("generator", ["Unix Makefiles", "Ninja"])
def test_any_format_is_built_and_installed_into_its_folder(tmp_path: Path, generator: str):
    """The formats of `tests.formats.example_formats` are known to Python alone."""
    command = tmp_path / "linkforge"
    command.write_text(
        f"#!{sys.executable}\nimport sys\nsys.path.insert(0, {str(ROOT)!r})\n"
        "from linkforge_compile import formats\nfrom linkforge_compile.cli.main import main\n"
        "from tests.formats.example_formats import Folder, Joints\n"
        "formats.FORMATS += (Joints(), Folder())\nsys.exit(main())\n"
    )
    command.chmod(0o755)
    made_by = program("ninja" if generator == "Ninja" else "make")
    add = "arm.robot.yaml FORMATS urdf mjcf joints folder CASE upper BASE free NAME left INSTALL OUTPUT made"
    words = ("-G", generator, f"-DCMAKE_MAKE_PROGRAM={made_by}", f"-DCMAKE_INSTALL_PREFIX={tmp_path / 'install'}")
    run = script(
        tmp_path,
        f"{FIND}\nlinkforge_add_robot({add})\nlinkforge_add_robots(arm.robot.yaml TARGET all_robots FORMATS folder)",
        *(*words, f"-DLINKFORGE_EXECUTABLE={command}"),
    )
    assert (run.returncode, run.stderr) == (0, "")
    build = (program("cmake"), "--build", str(tmp_path / "b"))
    first, second = (subprocess.run(build, capture_output=True, text=True, check=True, timeout=60) for _ in range(2))
    assert "Compiling robot left" in first.stdout
    assert "Compiling" not in second.stdout, "nothing changed"
    assert (tmp_path / "b/arm_config/links.txt").exists()
    subprocess.run((program("cmake"), "--install", str(tmp_path / "b")), capture_output=True, check=True, timeout=60)
    share = tmp_path / "install" / "share" / "p"
    files = {path.relative_to(share).as_posix() for path in share.rglob("*") if path.is_file()}
    assert files == {"urdf/left.urdf", "mjcf/left.mjcf", "config/left.joints", "config/joints.yaml", "links.txt"}


def test_a_command_that_lists_no_formats_is_reported(tmp_path: Path):
    run = script(tmp_path, f"{FIND}\nlinkforge_add_robot(arm.robot.yaml)", "-DLINKFORGE_EXECUTABLE=/bin/false")
    assert run.returncode != 0
    assert "'/bin/false formats --json' fails" in " ".join(run.stderr.split())
