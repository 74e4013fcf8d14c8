"""`linkforge check`, run as a program."""

import errno
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.in_process import linkforge
from tests.cli.test_compile import PENDULUM

FAULTY = """\
linkforge: 1
name: faulty
links:
  base: {visual: {box: [1, 1, 1], material: stele}}
  arm: {inertial: {mas: 3}}
materials:
  steel: {color: [1, 1, 1]}
joints:
  hinge: {type: revolut, parent: base, child: arm, axis: y}
"""


def test_every_error_is_reported_in_one_run(tmp_path: Path):
    (tmp_path / "faulty.robot.yaml").write_text(FAULTY)
    run = linkforge("check", "faulty.robot.yaml", cwd=tmp_path)
    assert run.returncode == 1
    assert run.stdout == ""
    places = [line.split(": error: ")[0] for line in run.stderr.splitlines() if ": error: " in line]
    assert places == ["faulty.robot.yaml:4:45", "faulty.robot.yaml:5:20", "faulty.robot.yaml:9:17"]
    assert "did you mean 'steel'?" in run.stderr
    assert run.stderr.splitlines()[-1] == "checked 1 spec: 3 errors"


def test_several_specs_are_checked_in_one_run(tmp_path: Path):
    (tmp_path / "good.robot.yaml").write_text(PENDULUM)
    (tmp_path / "faulty.robot.yaml").write_text(FAULTY)
    run = linkforge("check", "good.robot.yaml", "faulty.robot.yaml", cwd=tmp_path)
    assert run.returncode == 1
    assert run.stderr.splitlines()[-1] == "checked 2 specs: 3 errors"


def test_a_clean_spec_is_reported_as_clean(tmp_path: Path):
    (tmp_path / "good.robot.yaml").write_text(PENDULUM)
    run = linkforge("check", "good.robot.yaml", cwd=tmp_path)
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "checked 1 spec: no errors\n")


def test_an_unset_parameter_is_an_error_only_when_compiling(tmp_path: Path):
    (tmp_path / "open.robot.yaml").write_text(PENDULUM.replace(", default: 0.5 m", ""))
    assert linkforge("check", "open.robot.yaml", cwd=tmp_path).returncode == 0
    assert linkforge("compile", "open.robot.yaml", cwd=tmp_path).returncode == 1


def test_a_missing_file_is_reported(tmp_path: Path):
    run = linkforge("check", "nowhere.robot.yaml", cwd=tmp_path)
    assert run.returncode == 1
    assert "nowhere.robot.yaml" in run.stderr


def test_a_fault_of_a_shared_module_is_reported_once(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(FAULTY)
    for name in ("a", "b"):
        user = f"linkforge: 1\nname: {name}\nlinks: {{base: }}\nmodules: {{m: {{use: arm.robot.yaml, parent: base}}}}\n"
        (tmp_path / f"{name}.robot.yaml").write_text(user)
    run = linkforge("check", "a.robot.yaml", "b.robot.yaml", cwd=tmp_path)
    assert run.stderr.count("[LF4105]") == 1
    assert run.stderr.splitlines()[-1] == "checked 2 specs: 3 errors"


def test_of_two_variants_none_is_forgotten_in_silence(tmp_path: Path):
    run = linkforge("deps", "arm.robot.yaml", "--variant", "sim", "--variant", "real", cwd=tmp_path)
    assert run.returncode == 2
    assert "argument --variant: may be given once, found 'sim' and 'real'" in run.stderr


def test_a_folder_means_every_spec_in_it_and_below(tmp_path: Path):
    (tmp_path / "robots" / "parts").mkdir(parents=True)
    (tmp_path / "robots" / "good.robot.yaml").write_text(PENDULUM)
    (tmp_path / "robots" / "parts" / "faulty.robot.yaml").write_text(FAULTY)
    (tmp_path / "robots" / "parts" / "values.yaml").write_text("no: [spec")
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "copy.robot.yaml").write_text(FAULTY)
    for words in ((), (".",), ("robots", "robots/good.robot.yaml")):
        run = linkforge("check", *words, cwd=tmp_path)
        assert run.returncode == 1
        assert "robots/parts/faulty.robot.yaml:4:45: error: " in run.stderr
        assert run.stderr.splitlines()[-1] == "checked 2 specs: 3 errors"


def test_a_file_without_a_name_is_checked_with_the_spec_that_includes_it(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text("linkforge: 1\nname: arm\ninclude: [links.robot.yaml]\n")
    part = tmp_path / "links.robot.yaml"
    part.write_text("linkforge: 1\nlinks: {base: }\n")
    run = linkforge("check", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "checked 1 spec: no errors\n")
    assert linkforge("check", "arm.robot.yaml", "./links.robot.yaml", cwd=tmp_path).returncode == 0
    part.write_text("linkforge: 1\nlinks: {base: {visual: {sphere: -1}}}\n")
    run = linkforge("check", cwd=tmp_path)
    assert run.stderr.splitlines()[-1] == "checked 1 spec: 1 error"
    # What nobody includes, and what is used as a module, is to be a robot.
    (tmp_path / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nlinks: {a: }\nmodules: {m: {use: links.robot.yaml, parent: a}}\n"
    )
    assert "[LF2003]" in linkforge("check", cwd=tmp_path).stderr
    (tmp_path / "arm.robot.yaml").unlink()
    assert "[LF2003]" in linkforge("check", cwd=tmp_path).stderr


def test_a_folder_without_specs_is_no_clean_one(tmp_path: Path):
    (tmp_path / "empty").mkdir()
    (tmp_path / "good.robot.yaml").write_text(PENDULUM)
    run = linkforge("check", "empty", "good.robot.yaml", cwd=tmp_path)
    assert run.returncode == 1
    assert "there is no spec, NAME.robot.yaml, in the folder 'empty' or below it [LF3067]" in run.stderr


def test_a_link_out_of_the_repository_found_by_searching_is_reported_and_not_opened(tmp_path: Path):
    """Whoever made the repository has named the file, and not who checks it: nothing of it is shown."""
    (tmp_path / "far").mkdir()
    (tmp_path / "far" / "secret.yaml").write_text("password: hunter2\n")
    repository = tmp_path / "repository"
    (repository / ".git").mkdir(parents=True)
    (repository / "good.robot.yaml").write_text(PENDULUM)
    (repository / "evil.robot.yaml").symlink_to("../far/secret.yaml")
    run = linkforge("check", cwd=repository)
    assert run.returncode == 1
    assert "error: 'evil.robot.yaml' is outside of the folders that may be read" in run.stderr
    assert "[LF3401]\nnote: the link 'evil.robot.yaml' leads out\nnote: files may be read only in" in run.stderr
    assert run.stderr.endswith("checked 1 spec: 1 error\n")
    schema = linkforge("schema", "--workspace", cwd=repository)
    expected = "the link 'evil.robot.yaml' leads out of the folders that may be read, and is not opened"
    assert schema.stderr.count(expected) == 1
    assert not any("hunter2" in text for text in (run.stderr, schema.stderr, schema.stdout))
    for allowed in (("--allow-outside",), ("--package", "far=../far")):
        assert "evil.robot.yaml:1:1: " in linkforge("check", *allowed, cwd=repository).stderr


HOSTILE = "x\n::error::injected\x1b]0;title\x07\x9b31m.robot.yaml"
SPELT = r"x\n::error::injected\x1b]0;title\x07\x9b31m.robot.yaml"


@pytest.mark.skipif(os.name == "nt", reason="no such names")
def test_names_of_files_are_spelled_out_in_every_form(tmp_path: Path):
    """A repository of a stranger writes neither to the terminal nor commands to a build."""
    (tmp_path / HOSTILE).write_text("wrong\n")
    (tmp_path / "arm.robot.yaml").symlink_to(tmp_path.parent / HOSTILE)
    for form in ("text", "json", "github", "sarif"):
        run = linkforge("check", "--format", form, cwd=tmp_path)
        assert run.returncode == 1, run.stderr
        text = (run.stdout + run.stderr).replace("\n", "")
        assert text.isprintable()
        assert "\n::error::injected" not in run.stdout + run.stderr
    report = json.loads(linkforge("check", "--format", "json", cwd=tmp_path).stdout)
    assert {one["file"] for one in report["diagnostics"]} == {None, SPELT}


@pytest.mark.skipif(os.name == "nt", reason="no such names")
def test_lines_that_name_a_file_spell_it_out(tmp_path: Path):
    (tmp_path / HOSTILE).write_text(PENDULUM)
    written = linkforge("compile", HOSTILE, "-o", "build/", cwd=tmp_path)
    assert written.returncode == 0
    assert written.stderr == r"wrote build/x\n::error::injected\x1b]0;title\x07\x9b31m.urdf" + "\n"
    (urdf,) = (tmp_path / "build").iterdir()
    assert f"Compiled by linkforge from {SPELT};" in urdf.read_text("utf-8")
    expanded = linkforge("expand", HOSTILE, cwd=tmp_path).stdout
    assert SPELT in expanded
    assert "\n::error" not in expanded
    for words in (
        ("diff", HOSTILE, HOSTILE),
        ("compile", HOSTILE, HOSTILE, "-o", "b/"),
        ("where", f"build/{urdf.name}", "base"),
    ):
        run = linkforge(*words, cwd=tmp_path)
        assert r"\n::error" in run.stdout + run.stderr
        assert (run.stdout + run.stderr).replace("\n", "").isprintable()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no such names")
def test_a_name_that_is_not_utf8_is_shown_and_the_rest_reported(tmp_path: Path):
    (tmp_path / os.fsdecode(b"b\xffad.robot.yaml")).write_bytes(b"a\xff")
    (tmp_path / os.fsdecode(b"c\xff.robot.yaml")).write_text(PENDULUM)
    (tmp_path / "z.robot.yaml").write_text("wrong\n")
    for form in ("text", "json", "github"):
        run = linkforge("check", "--format", form, cwd=tmp_path)
        assert run.returncode == 1, run.stderr
        assert r"b\udcffad.robot.yaml" in (run.stdout + run.stderr).replace(r"\\", "\\")
        assert "z.robot.yaml" in run.stdout + run.stderr
    log = json.loads(linkforge("check", "--format", "sarif", cwd=tmp_path).stdout)
    places = [result["locations"][0]["physicalLocation"] for result in log["runs"][0]["results"]]
    assert [place["artifactLocation"]["uri"] for place in places] == ["b%FFad.robot.yaml", "z.robot.yaml"]
    spec = os.fsdecode(b"c\xff.robot.yaml")
    assert r"from c\udcff.robot.yaml;" in linkforge("compile", spec, cwd=tmp_path).stdout
    assert r"a depfile cannot contain 'c\udcff" in linkforge("deps", spec, cwd=tmp_path).stderr
    assert json.loads(linkforge("deps", "--format", "json", spec, cwd=tmp_path).stdout)["files"] == [spec]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
def test_a_pipe_that_is_found_by_searching_is_no_spec(tmp_path: Path):
    os.mkfifo(tmp_path / "pipe.robot.yaml")
    (tmp_path / "good.robot.yaml").write_text(PENDULUM)
    assert linkforge("check", cwd=tmp_path).stderr.startswith("checked 1 spec:")


def test_an_unreadable_folder_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Its specs are not checked, so the check fails; and the schema of the workspace may lack their names."""
    (tmp_path / "closed").mkdir()
    (tmp_path / "good.robot.yaml").write_text(PENDULUM)
    look: Callable[[str], object] = os.scandir

    def scandir(folder: str) -> object:
        if Path(folder).name == "closed":
            raise PermissionError(errno.EACCES, "Permission denied", folder)
        return look(folder)

    monkeypatch.setattr(os, "scandir", scandir)
    run = linkforge("check", ".", cwd=tmp_path)
    assert run.returncode == 1
    assert "error: './closed' cannot be read: permission denied [LF3002]" in run.stderr
    assert "checked 1 spec: 1 error" in run.stderr
    assert "closed' cannot be read: permission denied; names may be missing" in (
        linkforge("schema", "--workspace", ".", cwd=tmp_path).stderr
    )
