"""`linkforge diff SPEC --git REV` and `--before-package`, with real repositories."""

import hashlib
import json
import os
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.cli.test_diff import SCHEMA
from tests.programs import program

ARM = """\
linkforge: 1
name: arm
data: {table: ../data/masses.yaml}
links: {base: , tool: }
modules: {hand: {use: hand.robot.yaml, parent: tool}}
joints: {flange: {type: fixed, parent: base, child: tool, origin: [0, 0, $(table.reach)]}}
"""
HAND = "linkforge: 1\nname: hand\nlinks: {palm: {inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}}\n"


class Repository:
    """A git repository whose first commit holds an arm, a module of it and its data."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.git("init", "-q")
        self.write("robots/arm.robot.yaml", ARM)
        self.write("robots/hand.robot.yaml", HAND)
        self.write("data/masses.yaml", "reach: 1 m\n")
        self.commit()

    def git(self, *words: str) -> str:
        who = ("-c", "user.name=a", "-c", "user.email=a@example.com")
        command = [program("git"), *who, *words]
        return subprocess.run(command, cwd=self.folder, check=True, capture_output=True, text=True, timeout=60).stdout

    def write(self, name: str, text: str) -> None:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def commit(self) -> None:
        self.git("add", "--all")
        self.git("commit", "-q", "--message", "state")

    def state(self) -> dict[str, bytes]:
        """Return the content of each file by its path, git's own ones included."""
        files = (path for path in self.folder.rglob("*") if path.is_file())
        return {path.relative_to(self.folder).as_posix(): path.read_bytes() for path in files}

    def blob(self, text: str) -> str:
        """Store a text as an object; return its name."""
        return self._store("blob", text.encode())

    def forge_tree(self, *entries: tuple[str, str, str]) -> str:
        """Store a tree of entries (mode, name, object) that git itself might refuse to make; return its name."""
        body = b"".join(f"{mode} {name}\0".encode() + bytes.fromhex(object_) for mode, name, object_ in entries)
        return self._store("tree", body)

    def _store(self, kind: str, body: bytes) -> str:
        """Write a loose object, as `git hash-object --literally` does, without its checks."""
        content = f"{kind} {len(body)}\0".encode() + body
        name = hashlib.sha1(content, usedforsecurity=False).hexdigest()
        path = self.folder / ".git" / "objects" / name[:2] / name[2:]
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(zlib.compress(content))
        return name


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Repository:
    for name in [name for name in os.environ if name.startswith("GIT_")]:  # as in a hook of git
        monkeypatch.delenv(name)
    monkeypatch.setenv("TMPDIR", str(tmp_path / "temporary"))
    monkeypatch.setattr("tempfile.tempdir", None)
    (tmp_path / "temporary").mkdir()
    folder = tmp_path / "repository"
    folder.mkdir()
    return Repository(folder)


def test_a_spec_and_all_that_it_includes_are_read_as_of_the_revision(repository: Repository):
    arm = "robots/arm.robot.yaml"
    same = linkforge("diff", arm, "--git", "HEAD", cwd=repository.folder)
    assert (same.returncode, same.stdout) == (0, f"{arm} (HEAD) and {arm} are the same robot\n")
    repository.write("robots/hand.robot.yaml", HAND.replace("mass: 1", "mass: 2"))
    repository.commit()
    repository.write("data/masses.yaml", "reach: 2 m\n")
    before = repository.state()
    for cwd, spec in ((repository.folder, arm), (repository.folder / "robots", "arm.robot.yaml")):
        run = linkforge("diff", spec, "--git", "HEAD~1", cwd=cwd)
        assert run.returncode == 1, run.stderr
        assert run.stdout.startswith(f"{spec} (HEAD~1) → {spec}: 2 changed\n")
        assert "inertial/mass: 1 kg → 2 kg (+100 %)" in run.stdout
        assert "origin: moved by 1000 mm (z +1000 mm)" in run.stdout
    assert repository.state() == before
    assert not list((repository.folder.parent / "temporary").iterdir())


def test_json_has_the_revision(repository: Repository):
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", "HEAD", "--json", cwd=repository.folder)
    document = json.loads(run.stdout)
    SCHEMA.validate(document)
    assert (document["before_settings"]["git"], document["after_settings"]["git"]) == ("HEAD", None)


def test_a_spec_that_was_renamed_is_compared_with_the_old_one(repository: Repository):
    repository.git("mv", "robots/arm.robot.yaml", "robots/new.robot.yaml")
    repository.commit()
    run = linkforge("diff", "robots/new.robot.yaml", "--git", "HEAD~1", cwd=repository.folder)
    assert run.returncode == 2
    assert "'robots/new.robot.yaml' is not in revision 'HEAD~1'" in run.stderr
    words = ("robots/arm.robot.yaml", "robots/new.robot.yaml", "--git", "HEAD~1")
    run = linkforge("diff", *words, cwd=repository.folder)
    assert run.returncode == 0, run.stderr
    (repository.folder / "old").mkdir()
    moved = linkforge("diff", "old/arm.robot.yaml", words[1], "--git", "HEAD~1", cwd=repository.folder)
    assert "is not in revision 'HEAD~1'; there is 'robots/arm.robot.yaml'" in moved.stderr


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ("robots", "'robots' is a folder in revision 'HEAD'; name a file in it"),
        (".", "'.' is a folder in revision 'HEAD'; name a file in it"),
        ("link.robot.yaml", "'link.robot.yaml' is a link to 'lib/gone.robot.yaml', which revision 'HEAD' lacks"),
        ("data/robots", "'data/robots' is not in revision 'HEAD'"),
        ("robots/arn.robot.yaml", "is not in revision 'HEAD'; did you mean 'arm.robot.yaml'?"),
    ],
)
def test_a_spec_that_the_revision_lacks_is_an_error(repository: Repository, spec: str, message: str):
    (repository.folder / "link.robot.yaml").symlink_to("lib/gone.robot.yaml")
    repository.commit()
    run = linkforge("diff", spec, "--git", "HEAD", cwd=repository.folder)
    assert run.returncode == 2
    assert run.stderr.rstrip("\n").endswith(message)


def test_a_hook_in_a_linked_worktree_compares_with_its_own_repository(repository: Repository):
    hook = repository.folder / ".git" / "hooks" / "pre-commit"
    command = f"'{sys.executable}' -m linkforge_compile diff arm.robot.yaml --git HEAD"
    hook.write_text(f'#!/bin/sh\nset -e; test -n "$GIT_DIR"; cd robots; {command} > ../../output\n')
    hook.chmod(0o755)
    repository.git("worktree", "add", "-q", "../linked")
    repository.git("-C", "../linked", "commit", "-q", "--allow-empty", "--message", "state")
    output = repository.folder.parent / "output"
    assert output.read_text() == "arm.robot.yaml (HEAD) and arm.robot.yaml are the same robot\n"


def test_the_repository_is_the_one_around_the_spec(repository: Repository):
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", "HEAD", cwd=repository.folder, GIT_DIR="/nowhere")
    assert (run.returncode, run.stderr) == (0, "")


def test_an_error_in_the_revision_is_reported_at_its_place_there(repository: Repository):
    repository.write("robots/hand.robot.yaml", HAND.replace("mass: 1", "mass: 3 mm"))
    repository.commit()
    repository.write("robots/hand.robot.yaml", HAND)
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", "HEAD", cwd=repository.folder)
    assert run.returncode == 2
    assert run.stderr.startswith("HEAD:robots/hand.robot.yaml:3:")
    assert "HEAD:robots/arm.robot.yaml:5:" in run.stderr  # the note of its use
    assert "linkforge-git" not in run.stderr


def test_nothing_that_a_repository_configures_is_run(repository: Repository):
    mark = repository.folder.parent / "was_run"
    script = repository.folder / "run.sh"
    script.write_text(f'#!/bin/sh\necho "$0" >> "{mark}"\ncat\n')
    script.chmod(0o755)
    repository.write(".gitattributes", "*.yaml filter=hostile diff=hostile export-subst\n")
    repository.commit()
    for hook in ("post-checkout", "post-index-change", "reference-transaction", "pre-commit"):
        (repository.folder / ".git" / "hooks" / hook).symlink_to(script)
    for name in (
        *("filter.hostile.smudge", "filter.hostile.process", "filter.hostile.clean"),
        *("diff.hostile.textconv", "diff.external", "core.fsmonitor", "core.pager", "core.sshCommand"),
    ):
        repository.git("config", name, str(script))
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", "HEAD", cwd=repository.folder)
    assert (run.returncode, run.stderr) == (0, "")
    assert not mark.exists()
    # What is configured runs in the commands that were not used.
    repository.git("status")
    assert mark.exists()


def test_a_partial_clone_fetches_nothing(repository: Repository):
    mark = repository.folder.parent / "was_run"
    clone = repository.folder.parent / "clone"
    origin = repository.folder.as_uri()
    repository.git("config", "uploadpack.allowFilter", "true")
    repository.git("clone", "-q", "--filter=blob:none", "--no-checkout", origin, str(clone))
    repository.git("-C", str(clone), "config", "remote.origin.url", f"ext::touch {mark}")
    repository.git("-C", str(clone), "config", "protocol.ext.allow", "always")
    (clone / "robots").mkdir()
    (clone / "robots" / "arm.robot.yaml").write_text(ARM)
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", "HEAD", cwd=clone)
    assert run.returncode == 2
    assert "the revision is not here as a whole" in run.stderr
    assert not mark.exists()


def test_a_link_that_leads_out_of_the_revision_is_not_followed(repository: Repository):
    secret = repository.folder.parent / "secret.yaml"
    secret.write_text("reach: 1 m\n")
    (repository.folder / "data" / "masses.yaml").unlink()
    (repository.folder / "data" / "masses.yaml").symlink_to(secret)
    (repository.folder / "robots" / "hand.robot.yaml").rename(repository.folder / "hand.robot.yaml")
    (repository.folder / "robots" / "hand.robot.yaml").symlink_to("../hand.robot.yaml")
    repository.commit()
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", "HEAD", cwd=repository.folder)
    assert run.returncode == 2
    assert "HEAD:robots/arm.robot.yaml:3:15: error: " in run.stderr
    assert "masses.yaml' leads out" in run.stderr
    assert "hand" not in run.stderr


def test_a_forged_path_is_not_written(repository: Repository):
    blob = repository.git("hash-object", "-w", "data/masses.yaml").strip()
    tree = repository.forge_tree(("100644", "..", blob))
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", tree, cwd=repository.folder)
    assert run.returncode == 2
    assert "the revision has a file that may not be written, '..'" in run.stderr


@pytest.mark.parametrize("inner_mode", ["120000", "100644"])
def test_nothing_is_written_through_a_link_of_the_revision(repository: Repository, inner_mode: str):
    victim = repository.folder.parent / "victim"
    victim.mkdir()
    inner = repository.forge_tree((inner_mode, "injected", repository.blob("/etc/passwd")))
    tree = repository.forge_tree(("120000", "d", repository.blob(str(victim))), ("40000", "d", inner))
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", tree, cwd=repository.folder)
    assert run.returncode == 2
    assert "the revision has a file that may not be written, 'd'" in run.stderr
    assert not list(victim.iterdir())
    assert not list((repository.folder.parent / "temporary").iterdir())


@pytest.mark.parametrize("has_files", [True, False])
def test_a_revision_of_few_objects_and_endless_paths_is_refused(repository: Repository, has_files: bool):
    tree = repository.forge_tree(*([("100644", "leaf", repository.blob("x"))] if has_files else []))
    for _ in range(12):
        tree = repository.forge_tree(*(("40000", str(number), tree) for number in range(10)))
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", tree, cwd=repository.folder)
    assert run.returncode == 2
    assert "the revision has more than 100,000 files and folders" in run.stderr
    assert not list((repository.folder.parent / "temporary").iterdir())


def test_folders_deeper_than_any_robot_needs_are_refused(repository: Repository):
    tree = repository.forge_tree(("100644", "leaf", repository.blob("x")))
    for _ in range(1500):
        tree = repository.forge_tree(("40000", "d", tree))
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", tree, cwd=repository.folder)
    assert run.returncode == 2
    assert "the revision has a file that may not be written, 'd/d/" in run.stderr


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("robots/arm.robot.yaml", "--git", "nowhere"), "repository' has no revision 'nowhere'"),
        (("robots/arm.robot.yaml", "--git="), "--git takes a revision, such as HEAD~1 or a branch, found ''"),
        (
            ("robots/arm.robot.yaml", "--git=--output=x"),
            "--git takes a revision, such as HEAD~1 or a branch, found '--o",
        ),
        (("../arm.robot.yaml", "--git", "HEAD"), "cannot read the git repository of '..': not a git repository"),
        (("-", "robots/arm.robot.yaml", "--git", "HEAD"), "--git takes a file, not standard input"),
        (("nowhere/arm.robot.yaml", "--git", "HEAD"), "there is no folder 'nowhere'"),
        (("robots/arm.robot.yaml",), "takes two robots, found 1"),
        (("robots/arm.robot.yaml", "--before-package", "hands"), "--before-package takes NAME=PATH, found 'hands'"),
        (("robots/arm.robot.yaml", "--after-package", "hands=no"), "--after-package hands=no: there is no folder 'no'"),
    ],
)
def test_what_cannot_be_compared_is_wrong_usage(repository: Repository, words: tuple[str, ...], message: str):
    run = linkforge("diff", *words, cwd=repository.folder)
    assert run.returncode == 2
    assert message in run.stderr


def test_a_machine_without_git_is_an_error_that_says_so(repository: Repository):
    run = linkforge("diff", "robots/arm.robot.yaml", "--git", "HEAD", cwd=repository.folder, PATH="/nowhere")
    assert run.returncode == 2
    assert "--git needs the command 'git', which is not on the PATH" in run.stderr


def test_a_package_is_compared_with_its_older_version(tmp_path: Path):
    for version, mass in (("old", 1), ("new", 2)):
        folder = tmp_path / version
        folder.mkdir()
        (folder / "hand.robot.yaml").write_text(HAND.replace("mass: 1", f"mass: {mass}"))
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nlinks: {tool: }\n"
        'modules: {hand: {use: "package://hands/hand.robot.yaml", parent: tool}}\n'
    )
    words = ("diff", "arm/arm.robot.yaml", "--package", "hands=new")
    run = linkforge(*words, "--before-package", "hands=old", cwd=tmp_path)
    assert run.returncode == 1, run.stderr
    assert run.stdout.startswith("arm/arm.robot.yaml (package hands=old) → arm/arm.robot.yaml: 1 changed\n")
    assert "inertial/mass: 1 kg → 2 kg (+100 %)" in run.stdout
    run = linkforge(*words, "--after-package", "hands=old", "--json", cwd=tmp_path)
    document = json.loads(run.stdout)
    SCHEMA.validate(document)
    assert document["after_settings"]["packages"] == {"hands": "old"}
    assert document["differences"][0]["after"] == 1


def test_a_package_in_the_repository_is_read_as_of_the_revision(repository: Repository):
    repository.write("vendor/hand.robot.yaml", HAND)
    repository.write(
        "robots/cell.robot.yaml",
        "linkforge: 1\nname: cell\nlinks: {tool: }\n"
        'modules: {hand: {use: "package://hands/hand.robot.yaml", parent: tool}}\n',
    )
    repository.commit()
    repository.write("vendor/hand.robot.yaml", HAND.replace("mass: 1", "mass: 2"))
    words = ("diff", "robots/cell.robot.yaml", "--package", "hands=vendor", "--git", "HEAD")
    run = linkforge(*words, cwd=repository.folder)
    assert (run.returncode, "inertial/mass: 1 kg → 2 kg" in run.stdout) == (1, True), run.stderr


@pytest.mark.parametrize("variable", ["ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"])
@pytest.mark.parametrize("is_src_alone", [False, True], ids=["workspace", "src"])
def test_a_package_of_the_environment_is_read_as_of_the_revision(
    repository: Repository, variable: str, is_src_alone: bool
):
    repository.write("src/hands/package.xml", "<package><name>hands</name></package>\n")
    repository.write("src/hands/urdf/hand.robot.yaml", HAND)
    repository.write(
        "src/app/cell.robot.yaml",
        "linkforge: 1\nname: cell\nlinks: {tool: }\n"
        'modules: {hand: {use: "package://hands/urdf/hand.robot.yaml", parent: tool}}\n',
    )
    if is_src_alone:
        (repository.folder / ".git").rename(repository.folder / "src" / ".git")
        repository.folder = repository.folder / "src"
    repository.commit()
    src = repository.folder if is_src_alone else repository.folder / "src"
    (src / "hands" / "urdf" / "hand.robot.yaml").write_text(HAND.replace("mass: 1", "mass: 2"))
    value = src if variable == "ROS_PACKAGE_PATH" else install_with_links(src.parent / "install", src / "hands")
    run = linkforge("diff", "app/cell.robot.yaml", "--git", "HEAD", cwd=src, **{variable: str(value)})
    assert (run.returncode, "inertial/mass: 1 kg → 2 kg" in run.stdout) == (1, True), run.stdout + run.stderr


def install_with_links(prefix: Path, package: Path) -> Path:
    """Install each file of a package as a link, as `colcon build --symlink-install` does."""
    for file in [file for file in package.rglob("*") if file.is_file()]:
        link = prefix / "share" / package.name / file.relative_to(package)
        link.parent.mkdir(parents=True, exist_ok=True)
        link.symlink_to(file)
    return prefix


@pytest.mark.parametrize("option", ["-p", "--before"])
def test_a_file_as_the_value_of_a_parameter_is_read_as_of_the_revision(repository: Repository, option: str):
    repository.write("robots/cell.robot.yaml", CELL_WITH_FILE)
    repository.commit()
    repository.write("data/masses.yaml", "reach: 2 m\n")
    for cwd, value in (
        (repository.folder, "data/masses.yaml"),
        (repository.folder / "robots", "../data/masses.yaml"),
        (repository.folder / "robots", str(repository.folder / "data" / "masses.yaml")),
    ):
        words = [os.path.relpath(repository.folder / "robots" / "cell.robot.yaml", cwd), "--git", "HEAD"]
        settings = [option, f"table={value}"] + (["--after", f"table={value}"] if option == "--before" else [])
        run = linkforge("diff", *words, *settings, cwd=cwd)
        assert (run.returncode, "moved by 1000 mm" in run.stdout) == (1, True), run.stdout + run.stderr
    missing = linkforge("diff", "cell.robot.yaml", "--git", "HEAD", "--before", "table=new.yaml", cwd=cwd)
    assert missing.returncode == 2
    assert "looked for it at HEAD:robots/new.yaml" in missing.stderr


CELL_WITH_FILE = """\
linkforge: 1
name: cell
parameters: {table: {type: file, default: ../data/masses.yaml}}
data: {facts: $(table)}
links: {base: , tool: }
joints: {flange: {type: fixed, parent: base, child: tool, origin: [0, 0, $(facts.reach)]}}
"""


def test_a_mesh_as_the_value_of_a_parameter_is_the_same_in_the_revision(repository: Repository):
    repository.write("robots/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    spec = "links: {a: {visual: {mesh: $(m)}}, b: {visual: {mesh: a.obj}}}"
    joints = "joints: {j: {type: fixed, parent: a, child: b}}"
    repository.write(
        "robots/r.robot.yaml", f"linkforge: 1\nname: r\nparameters: {{m: {{type: file}}}}\n{spec}\n{joints}\n"
    )
    repository.commit()
    run = linkforge("diff", "robots/r.robot.yaml", "--git", "HEAD", "-p", "m=robots/a.obj", cwd=repository.folder)
    assert (run.returncode, run.stderr) == (0, ""), run.stdout + run.stderr


CELL = """\
linkforge: 1
name: cell
links: {tool: }
modules: {hand: {use: "package://hands/hand.robot.yaml", parent: tool}}
"""


def test_messages_name_no_temporary_file(repository: Repository):
    repository.write("src/hands/package.xml", "<package><name>hands</name></package>\n")
    repository.write("src/hands/hand.robot.yaml", HAND)
    repository.write("src/app/cell.robot.yaml", CELL)
    repository.write("src/app/arm.robot.yaml", ARM)
    repository.commit()
    run = linkforge("diff", "src/app/cell.robot.yaml", "--git", "HEAD", cwd=repository.folder)
    assert run.stderr.count("there is one; write --package hands=./src/hands\n") == 1
    assert "linkforge-git" not in run.stderr
    run = linkforge("diff", "src/app/arm.robot.yaml", "--git", "HEAD", cwd=repository.folder)
    assert "looked for it at HEAD:src/data/masses.yaml" in run.stderr
    assert "linkforge-git" not in run.stderr


def test_the_folder_of_a_package_that_the_revision_lacks_is_an_error(repository: Repository):
    repository.write("robots/cell.robot.yaml", CELL)
    repository.commit()
    repository.write("new/hand.robot.yaml", HAND)
    repository.write("vendor/hands/hand.robot.yaml", HAND)
    words = ("diff", "robots/cell.robot.yaml", "--git", "HEAD", "--package")
    run = linkforge(*words, "hands=new", cwd=repository.folder)
    assert (run.returncode, "there is no folder 'new' in revision 'HEAD'\n" in run.stderr) == (2, True)
    commit = repository.git("rev-parse", "HEAD").strip()
    repository.git("update-index", "--add", "--cacheinfo", f"160000,{commit},vendor")
    repository.git("commit", "-q", "--message", "submodule")
    run = linkforge(*words, "hands=vendor/hands", cwd=repository.folder)
    expected = "there is no folder 'vendor/hands' in revision 'HEAD'; submodules, here 'vendor', are omitted\n"
    assert (run.returncode, expected in run.stderr) == (2, True)
    run = linkforge("diff", "vendor/hands/hand.robot.yaml", "--git", "HEAD", cwd=repository.folder)
    assert "is not in revision 'HEAD'; submodules, here 'vendor', are omitted\n" in run.stderr


def test_the_absolute_path_of_a_file_is_the_same_in_the_revision(repository: Repository):
    plugin = "{filename: libx.so, parameters: {file: $(path('FILE'))}}"
    spec = f"linkforge: 1\nname: r\nlinks: {{a: }}\ngazebo: {{plugins: {{p: {plugin}}}}}\n"
    plugin = '<plugin name="p" filename="l"><x>$(find app)/x</x></plugin>'
    xacro = f'<robot name="r" xmlns:xacro="x"><link name="a"/><gazebo>{plugin}</gazebo></robot>\n'
    repository.write("package.xml", "<package><name>app</name></package>\n")
    repository.write("robots/r.robot.yaml", spec.replace("FILE", "hand.robot.yaml"))
    repository.write("robots/r.urdf.xacro", xacro)
    repository.commit()
    for name in ("robots/r.robot.yaml", "robots/r.urdf.xacro"):
        same = linkforge("diff", name, "--git", "HEAD", cwd=repository.folder)
        assert (same.returncode, same.stderr) == (0, ""), same.stdout
    repository.write("robots/r.robot.yaml", spec.replace("FILE", "arm.robot.yaml"))
    run = linkforge("diff", "robots/r.robot.yaml", "--git", "HEAD", "--json", cwd=repository.folder)
    (difference,) = json.loads(run.stdout)["differences"]
    assert difference["before"] == str(repository.folder / "robots" / "hand.robot.yaml")
    assert difference["after"] == str(repository.folder / "robots" / "arm.robot.yaml")


ROBOT_WITH_FILES = """\
linkforge: 1
name: robot
links: {base: {visual: {mesh: "file://$(path('meshes/a.stl'))"}}, tool: }
modules: {camera: {use: camera.urdf.xacro, parent: base}}
joints: {flange: {type: fixed, parent: base, child: tool}}
gazebo: {plugins: {p: {filename: libp.so, parameters: {gains: $(path('../data/masses.yaml'))}}}}
"""
CAMERA = """\
<robot name="camera" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="camera"/>
  <gazebo><plugin name="c" filename="c.so"><file>$(find repo)/data/masses.yaml</file></plugin></gazebo>
</robot>
"""


def test_the_path_of_a_file_of_the_repository_is_no_difference(repository: Repository):
    repository.write("package.xml", "<package><name>repo</name></package>\n")
    repository.write("robots/robot.robot.yaml", ROBOT_WITH_FILES)
    repository.write("robots/camera.urdf.xacro", CAMERA)
    repository.commit()
    link = repository.folder.parent / "link"
    link.symlink_to(repository.folder)
    for cwd in (repository.folder, link):
        run = linkforge("diff", str(cwd / "robots/robot.robot.yaml"), "--git", "HEAD", cwd=cwd)
        assert (run.returncode, run.stderr) == (0, ""), run.stdout
    repository.write("robots/robot.robot.yaml", ROBOT_WITH_FILES.replace("../data/masses", "arm.robot"))
    run = linkforge("diff", "robots/robot.robot.yaml", "--git", "HEAD", "--json", cwd=repository.folder)
    (difference,) = json.loads(run.stdout)["differences"]
    expected = [str(repository.folder / name) for name in ("data/masses.yaml", "robots/arm.robot.yaml")]
    assert [difference["before"], difference["after"]] == expected


def test_the_path_of_a_file_of_an_installed_package_is_no_difference(
    repository: Repository, monkeypatch: pytest.MonkeyPatch
):
    for name, text in (("package.xml", "<package><name>hands</name></package>\n"), ("gains.yaml", "a: 1\n")):
        repository.write(f"src/hands/{name}", text)
    path = "$(path('package://hands/gains.yaml'))"
    repository.write("src/cell/cell.robot.yaml", CELL_WITH_GAINS.format(path=path))
    repository.commit()
    prefix = install_with_links(repository.folder.parent / "install", repository.folder / "src" / "hands")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    run = linkforge("diff", "src/cell/cell.robot.yaml", "--git", "HEAD", cwd=repository.folder)
    assert (run.returncode, run.stderr) == (0, ""), run.stdout


CELL_WITH_GAINS = """\
linkforge: 1
name: cell
links: {{base: }}
gazebo: {{plugins: {{p: {{filename: libp.so, parameters: {{gains: "{path}"}}}}}}}}
"""


def test_the_path_of_a_file_in_another_version_of_a_package_is_no_difference(tmp_path: Path):
    for version in ("p1", "p2", "p22"):
        (tmp_path / version).mkdir()
        (tmp_path / version / "gains.yaml").write_text("a: 1\n")
    path = "$(path('package://vend/gains.yaml'))"
    (tmp_path / "cell.robot.yaml").write_text(CELL_WITH_GAINS.format(path=path))
    words = ("diff", "cell.robot.yaml", "--before-package", "vend=p1", "--after-package")
    run = linkforge(*words, "vend=./../" + tmp_path.name + "/p2", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, ""), run.stdout
    spec = CELL_WITH_GAINS.format(path="$(path(g))") + "parameters: {g: {type: file}}\n"
    (tmp_path / "cell.robot.yaml").write_text(spec)
    files = ("--before", "g=p1/gains.yaml", "--after", "g=p22/gains.yaml")
    run = linkforge(*words, "vend=p2", *files, "--json", cwd=tmp_path)
    (difference,) = json.loads(run.stdout)["differences"]
    expected = [str(tmp_path / version / "gains.yaml") for version in ("p2", "p22")]
    assert [difference["before"], difference["after"]] == expected
