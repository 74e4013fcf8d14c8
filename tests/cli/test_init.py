"""`linkforge init`, run as a program: its output works, and no file of the user is changed."""

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import NoReturn

import pytest
import yaml

from linkforge_compile import check_file
from linkforge_compile.cli.main import main
from linkforge_compile.importers import xacro
from tests.cli.in_process import linkforge

FILES = {
    ".gitignore",
    ".linkforge/robot.schema.json",
    ".pre-commit-config.yaml",
    ".vscode/extensions.json",
    ".vscode/settings.json",
    ".vscode/tasks.json",
    "CMakeLists.txt",
    "my-arm.robot.yaml",
}


def files_in(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_new_robot_is_one_to_begin_with(tmp_path: Path):
    run = linkforge("init", "my-arm", cwd=tmp_path)
    assert (run.returncode, run.stdout) == (0, "")
    assert files_in(tmp_path / "my-arm").keys() == FILES
    spec = tmp_path / "my-arm" / "my-arm.robot.yaml"
    assert check_file(spec).diagnostics == ()
    robot = check_file(spec).result()
    assert robot.name == "my-arm"
    assert [joint.name for joint in robot.joints] == ["base_joint", "shoulder", "tool0_joint"]
    assert robot.semantic.groups
    assert robot.ros2_controls
    # What it says to do next can be done, word for word.
    steps = [line.split("  ")[0].split()[1:] for line in re.findall(r"^  (linkforge .*)", run.stderr, re.MULTILINE)]
    assert [linkforge(*step, cwd=spec.parent).returncode for step in steps] == [0, 0]
    assert {path.name for path in (spec.parent / "build").iterdir()} == {"my-arm.urdf", "my-arm.srdf"}


def test_it_prints_what_it_wrote_and_the_next_steps(tmp_path: Path):
    lines = linkforge("init", "my-arm", cwd=tmp_path).stderr.splitlines()
    written = {line.removeprefix("wrote my-arm/") for line in lines if line.startswith("wrote ")}
    assert written == FILES
    assert lines[lines.index("next:") + 1] == "  cd my-arm"
    assert lines[-2].startswith("docs/editors.md sets up the language server")
    assert lines[-1] == "  pip install 'linkforge-compile[lsp]'"
    assert linkforge("init", "other", "--quiet", cwd=tmp_path).stderr == ""
    assert "cd " not in linkforge("init", "my-arm", "--dir", ".", cwd=tmp_path).stderr


def test_what_is_there_is_kept(tmp_path: Path):
    mine = {".gitignore": "/secret\n", "CMakeLists.txt": "project(mine)\n", "arm.robot.yaml": "linkforge: 1\n"}
    for name, text in mine.items():
        (tmp_path / name).write_text(text)
    run = linkforge("init", "arm", "--dir", ".", cwd=tmp_path)
    assert run.returncode == 0
    for name, text in mine.items():
        assert (tmp_path / name).read_text() == text
        assert f"kept {name}, which is there already" in run.stderr
    before = files_in(tmp_path)
    assert "wrote" not in linkforge("init", "arm", "--dir", ".", cwd=tmp_path).stderr
    assert files_in(tmp_path) == before


def test_a_second_robot_joins_the_schema_and_is_missed_in_cmake(tmp_path: Path):
    linkforge("init", "arm", "--dir", ".", cwd=tmp_path)
    stderr = linkforge("init", "hand", "--dir", ".", cwd=tmp_path).stderr
    line = "linkforge_add_robot(hand.robot.yaml FORMATS urdf srdf INSTALL)"
    assert stderr.endswith(f"\nput into CMakeLists.txt:\n  {line}\n")
    assert "wrote .linkforge/robot.schema.json\n" in stderr
    assert "hand.robot.yaml" in (tmp_path / ".linkforge/robot.schema.json").read_text()
    cmake = tmp_path / "CMakeLists.txt"
    cmake.write_text(f"{cmake.read_text()}{line}\n")
    assert "put into" not in linkforge("init", "hand", "--dir", ".", cwd=tmp_path).stderr


def test_files_at_the_top_of_a_package_or_repository_are_not_written_twice(tmp_path: Path):
    package = tmp_path / "src" / "arm_description"
    package.mkdir(parents=True)
    (tmp_path / ".git").mkdir()
    (tmp_path / ".pre-commit-config.yaml").write_text("repos: []\n")
    (package / "package.xml").touch()
    (package / "CMakeLists.txt").write_text("project(arm_description)\n")
    stderr = linkforge("init", "arm", "--dir", "robots", cwd=package).stderr
    add = "linkforge_add_robot(robots/arm.robot.yaml FORMATS urdf srdf INSTALL)"
    assert f"put into CMakeLists.txt:\n  find_package(linkforge_compile REQUIRED)\n  {add}\n" in stderr
    assert files_in(package / "robots").keys() == {".gitignore", ".linkforge/robot.schema.json", "arm.robot.yaml"}
    settings = json.loads((tmp_path / ".vscode/settings.json").read_text())
    (schema,) = settings["yaml.schemas"]
    assert (tmp_path / schema).is_file()
    assert "wrote .linkforge/robot.schema.json" in linkforge("init", "hand", cwd=package / "robots").stderr
    assert files_in(package / "robots" / "hand").keys() == {"hand.robot.yaml"}
    spec = (package / "robots" / "hand" / "hand.robot.yaml").read_text()
    assert spec.startswith("# yaml-language-server: $schema=../.linkforge/robot.schema.json\n")


def test_what_tools_read_at_the_top_of_a_repository_is_written_there(tmp_path: Path):
    (tmp_path / ".git").mkdir()
    stderr = linkforge("init", "arm", cwd=tmp_path).stderr
    top = {".pre-commit-config.yaml", ".vscode/settings.json", ".vscode/extensions.json", ".vscode/tasks.json"}
    assert all(f"wrote {name}\n" in stderr for name in top)
    assert top <= files_in(tmp_path).keys()
    assert "compile --check arm/arm.robot.yaml -o arm/urdf/" in (tmp_path / ".pre-commit-config.yaml").read_text()
    _, missed = linkforge("init", "hand", cwd=tmp_path / "arm").stderr.split("\nput into ")
    assert missed.startswith("CMakeLists.txt:")


@pytest.mark.parametrize("link", [".vscode", ".linkforge"])
def test_nothing_is_written_through_a_link_that_leads_out(link: str, tmp_path: Path):
    repository = tmp_path / "repository"
    (repository / ".git").mkdir(parents=True)
    (repository / link).symlink_to(tmp_path / "nowhere")
    run = linkforge("init", "arm", "--dir", ".", cwd=repository)
    assert (run.returncode, "is reached by a link that leads out of its folder" in run.stderr) == (2, True)
    assert {path.name for path in (*tmp_path.iterdir(), *repository.iterdir())} == {"repository", ".git", link}


def test_what_git_ignores_everywhere_is_not_ignored_again(tmp_path: Path):
    (tmp_path / ".git").mkdir()
    (tmp_path / ".gitignore").write_text("build/\n**/install\n/log/\n")
    linkforge("init", "arm", cwd=tmp_path)
    assert (tmp_path / "arm/.gitignore").read_text() == "/log/\n"
    (tmp_path / ".gitignore").write_text("build/\n**/install\nlog\n")
    linkforge("init", "hand", cwd=tmp_path)
    assert not (tmp_path / "hand/.gitignore").exists()


def test_missing_lines_of_existing_files_are_shown_ready_to_insert(tmp_path: Path):
    (tmp_path / ".git").mkdir()
    mine = {
        ".pre-commit-config.yaml": "repos:\n",
        "robots/.gitignore": "build/\n",
        ".vscode/settings.json": '{"editor.tabSize": 2}\n',
        ".vscode/extensions.json": "{}\n",
        ".vscode/tasks.json": "{}\n",
    }
    for name, text in mine.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    run = linkforge("init", "arm", "--dir", "robots", cwd=tmp_path)
    _, *blocks = run.stderr.split("\nput into ")
    missed = dict(block.split(":\n", 1) for block in blocks)
    assert missed.keys() == mine.keys()
    hooks = yaml.safe_load(mine[".pre-commit-config.yaml"] + missed[".pre-commit-config.yaml"])
    (hook,) = hooks["repos"][0]["hooks"]
    assert (hook["id"], hook["pass_filenames"]) == ("linkforge-check", False)
    assert missed["robots/.gitignore"].split() == ["/install/", "/log/"]
    settings = json.loads(f"{{{missed['.vscode/settings.json']}}}")
    assert settings["yaml.schemas"].keys() == {"robots/.linkforge/robot.schema.json"}
    assert missed[".vscode/extensions.json"].strip() == '"recommendations": ["redhat.vscode-yaml"]'
    assert json.loads(missed[".vscode/tasks.json"])["label"] == "linkforge check"
    # Once they are put in, nothing is missed.
    for name, text in missed.items():
        (tmp_path / name).write_text(mine[name] + text)
    assert "put into" not in linkforge("init", "arm", "--dir", "robots", cwd=tmp_path).stderr


def test_files_next_to_it_are_not_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
):
    def run_xacro(*_words: object) -> NoReturn:
        pytest.fail("xacro was run")

    monkeypatch.setattr(xacro, "run_xacro", run_xacro)
    monkeypatch.chdir(tmp_path)
    Path("vendor.urdf.xacro").write_text('<robot name="vendor"><link name="base"/></robot>')
    Path("cell.robot.yaml").write_text("linkforge: 1\nname: cell\nmodules: {arm: {use: vendor.urdf.xacro}}\n")
    assert main(["init", "hand", "--dir", "."]) == 0
    stderr = capfd.readouterr().err
    assert "names of cell.robot.yaml may be missing; `linkforge schema --workspace` may find them\n" in stderr


@pytest.mark.parametrize("blocked", [".vscode", ".linkforge"])
def test_where_it_cannot_write_all_it_writes_nothing(tmp_path: Path, blocked: str):
    (tmp_path / blocked).touch()
    run = linkforge("init", "arm", "--dir", ".", cwd=tmp_path)
    assert run.returncode == 2
    assert f"'{blocked}' is not a folder" in run.stderr
    assert [*tmp_path.rglob("*")] == [tmp_path / blocked]


def test_the_bytes_are_the_same_wherever_it_is_run(tmp_path: Path):
    for place in ("here", "over there"):
        (tmp_path / place).mkdir()
        linkforge("init", "my-arm", cwd=tmp_path / place)
    assert files_in(tmp_path / "here") == files_in(tmp_path / "over there")


@pytest.mark.parametrize("name", ["../arm", "my arm", "1st", "", "arm.robot.yaml"])
def test_a_name_that_is_none_is_refused(tmp_path: Path, name: str):
    run = linkforge("init", name, cwd=tmp_path)
    assert run.returncode == 2
    assert "NAME is letters, digits, _ and -" in run.stderr
    assert files_in(tmp_path) == {}


def test_the_files_for_tools_are_what_these_read(tmp_path: Path):
    linkforge("init", "arm", cwd=tmp_path)
    folder = tmp_path / "arm"
    schemas = json.loads((folder / ".vscode/settings.json").read_text())["yaml.schemas"]
    assert all((folder / schema).is_file() for schema in schemas)
    assert json.loads((folder / ".vscode/extensions.json").read_text())["recommendations"] == ["redhat.vscode-yaml"]
    (repository,) = yaml.safe_load((folder / ".pre-commit-config.yaml").read_text())["repos"]
    (hook,) = repository["hooks"]
    assert hook["id"] == "linkforge-check"
    assert linkforge(*hook["entry"].split()[1:], cwd=folder).returncode == 0
    assert (hook["always_run"], hook["pass_filenames"]) == (True, False)


def test_its_cmake_finds_the_function_and_passes_valid_arguments(tmp_path: Path):
    cmake = shutil.which("cmake")
    assert cmake, "the extra `dev` has it"
    linkforge("init", "arm", cwd=tmp_path)
    # The real one is tested with its builds; here is asked what the file asks of it.
    (tmp_path / "linkforge_compileConfig.cmake").write_text(
        'function(linkforge_add_robot)\n  message(STATUS "asked: ${ARGV}")\nendfunction()\n'
    )
    command = (cmake, "-S", "arm", "-B", "build", f"-Dlinkforge_compile_DIR={tmp_path}")
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=True)
    assert "asked: arm.robot.yaml;FORMATS;urdf;srdf;INSTALL" in run.stdout
