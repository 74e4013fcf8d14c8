"""`linkforge compile --template`: which documents are written where, and that a fault in one leaves all as it was."""

import json
import re
from pathlib import Path

import pytest

from linkforge_compile import compile_file, render_templates, render_urdf
from linkforge_compile.diagnostics.enumerations import alternatives
from linkforge_compile.formats.user_templates import own_folders
from tests.cli.in_process import linkforge

SPEC = """\
linkforge: 1
name: arm
links: {base: , rod: {collision: {box: [1, 1, 1]}}}
joints: {turn: {type: fixed, parent: base, child: rod}}
semantic: {groups: {arm: {joints: [turn]}}}
"""

BANNER = "Compiled by linkforge from arm.robot.yaml; edit that file, not this one."


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with a spec, and a folder of templates in it."""
    (tmp_path / "arm.robot.yaml").write_text(SPEC)
    (tmp_path / "t").mkdir()
    (tmp_path / "t" / "notes.md.j2").write_text("{% include '_head.j2' %}\n{{ robot.links | length }} links\n")
    (tmp_path / "t" / "_head.j2").write_text("# {{ banner }}\n")
    return tmp_path


def compile_by(folder: Path, *words: str, stdin: str = "", expect: int = 0) -> tuple[str, str]:
    """Compile by the templates and return what was written to standard output and error."""
    done = linkforge("compile", "arm.robot.yaml", "--template", "t", *words, cwd=folder, stdin=stdin)
    assert done.returncode == expect, done.stderr
    return done.stdout, done.stderr


def test_documents_are_written_in_place_of_urdf_and_srdf(folder: Path):
    (folder / "t" / "joints.csv.j2").write_text("{% for joint in robot.joints %}\n{{ joint.name }}\n{% endfor %}")
    _, stderr = compile_by(folder, "-o", "out/")
    assert stderr == "wrote out/joints.csv\nwrote out/notes.md\n"
    assert sorted(path.name for path in (folder / "out").iterdir()) == ["joints.csv", "notes.md"]
    assert (folder / "out" / "notes.md").read_text() == f"# {BANNER}\n2 links\n"
    assert compile_by(folder, "-o", "out/")[1] == "out/joints.csv is up to date\nout/notes.md is up to date\n"


@pytest.mark.parametrize("words", [(), ("-o", "-")])
def test_the_only_document_goes_to_standard_output(words: tuple[str, ...], folder: Path):
    assert compile_by(folder, *words) == (f"# {BANNER}\n2 links\n", "")


def test_several_documents_need_a_folder(folder: Path):
    (folder / "t" / "a.txt.j2").write_text("a")
    expected = "standard output takes one document of --template, found 2: a.txt, notes.md; write -o FOLDER/"
    assert compile_by(folder, expect=2) == ("", f"linkforge compile: {expected}\n")


@pytest.mark.parametrize("words", [("--format", "urdf"), ("-o", "arm.urdf"), ("-o", "arm.urdf", "-o", "arm.srdf")])
def test_urdf_is_written_by_the_templates_on_request(words: tuple[str, ...], folder: Path):
    (folder / "t" / "urdf").mkdir()
    (folder / "t" / "urdf" / "joint.xml.j2").write_text("<mine n='{{ robot.joints.names[0] }}'/>")
    written, _ = compile_by(folder, *words)
    urdf = written or (folder / "arm.urdf").read_text()
    assert "<mine n='turn'/>" in urdf
    assert urdf.startswith(f'<?xml version="1.0"?>\n<!-- {BANNER} -->\n<robot name="arm">\n')
    assert not (folder / "notes.md").exists()
    assert "<link name=" in urdf


def test_a_folder_without_documents_writes_urdf_and_srdf(folder: Path):
    (folder / "t" / "notes.md.j2").unlink()
    (folder / "t" / "srdf").mkdir()
    (folder / "t" / "srdf" / "group.xml.j2").write_text("<mine/>")
    _, stderr = compile_by(folder, "-o", "out/")
    assert stderr == "wrote out/arm.urdf\nwrote out/arm.srdf\n"
    assert "<mine/>" in (folder / "out" / "arm.srdf").read_text()


def test_a_template_that_goes_before_none_of_ours_is_warned_of(folder: Path):
    (folder / "t" / "urdf" / "sub").mkdir(parents=True)
    for name in ("lnik.xml.j2", "joint.xml", "_used.xml.j2", "joint.xml.j2", "README.md", "sub/x.j2"):
        (folder / "t" / "urdf" / name).write_text("{# nothing #}")
    (folder / "t" / "urdf" / "joint.xml.j2").write_text("{% include 'urdf/_used.xml.j2' %}")
    for words in ((), ("--format", "urdf")):
        _, stderr = compile_by(folder, *words)
        assert [line for line in stderr.split("\n") if "LF7208" in line] == [
            f"t/urdf/{name}:1:1: warning: 'urdf/{name}' is unused: linkforge has no template of that name to replace, "
            f"and no template includes it{hint} [LF7208]"
            for name, hint in (
                ("joint.xml", "; did you mean 'urdf/joint.xml.j2'?"),
                ("lnik.xml.j2", "; did you mean 'urdf/link.xml.j2'?"),
                ("sub/x.j2", ""),
            )
        ]
    assert compile_by(folder, "--werror", expect=1)[0] == ""
    (folder / "t" / "_other.j2").write_text("{% include name %}")
    assert "LF7208" not in compile_by(folder)[1], "it may include any of them"


def test_the_only_document_may_have_a_file_of_another_name(folder: Path):
    assert compile_by(folder, "-o", "TABLE.md")[1] == "wrote TABLE.md\n"
    assert (folder / "TABLE.md").read_text() == f"# {BANNER}\n2 links\n"
    assert compile_by(folder, "-o", "TABLE.md", "--check")[1] == "TABLE.md is up to date\n"
    assert compile_by(folder, "-o", "docs/")[1] == "wrote docs/notes.md\n"
    assert compile_by(folder, "-o", "v1.d/")[1] == "wrote v1.d/notes.md\n"
    assert "would be replaced" in compile_by(folder, "-o", "arm.robot.yaml", expect=2)[1]


@pytest.mark.parametrize("name", ["scene.xml", "scene.urdf"])
def test_a_document_of_xml_is_not_taken_for_the_urdf(name: str, folder: Path):
    (folder / "own").mkdir()
    (folder / "own" / f"{name}.j2").write_text("<mujoco/>")
    (folder / "t").rename(folder / "notes")
    (folder / "own").rename(folder / "t")
    compile_by(folder, "-o", f"my_{name}")
    assert (folder / f"my_{name}").read_text() == "<mujoco/>\n"


def test_a_folder_without_templates_is_refused_in_python_as_by_the_command(folder: Path):
    (folder / "other" / "urdf").mkdir(parents=True)
    (folder / "other" / "urdf" / "lnik.xml.j2").touch()
    robot = compile_file(folder / "arm.robot.yaml").result()
    reason = (
        f"it has no NAME.j2 for a document, nor {alternatives([f'{name}/' for name in own_folders()])} with a template "
        "that overrides one of linkforge's; 'urdf/lnik.xml.j2' is like 'urdf/link.xml.j2'"
    )
    for render in (render_templates, lambda robot, folder: render_urdf(robot, templates=folder)):
        with pytest.raises(ValueError, match=f"^{re.escape(reason)}$"):
            render(robot, folder / "other")
    done = linkforge("compile", "arm.robot.yaml", "--template", "other", cwd=folder)
    assert (done.returncode, reason in done.stderr) == (2, True)


def test_standard_input_has_no_banner(folder: Path):
    done = linkforge("compile", "-", "--template", "t", cwd=folder, stdin=SPEC)
    assert done.stdout == "# \n2 links\n"


def test_a_fault_leaves_all_documents_as_they_were(folder: Path):
    (folder / "t" / "z.txt.j2").write_text("one")
    compile_by(folder, "-o", "out/")
    (folder / "t" / "notes.md.j2").write_text("changed")
    (folder / "t" / "z.txt.j2").write_text("\n{{ robot.nam }}")
    _, stderr = compile_by(folder, "-o", "out/", expect=1)
    assert stderr.startswith("t/z.txt.j2:2:1: error: this template uses an undefined name: a Robot has no 'nam'")
    assert "\n     2 | {{ robot.nam }}\n       | ^^^^^^^^^^^^^^^\n" in stderr
    assert (folder / "out" / "notes.md").read_text() == f"# {BANNER}\n2 links\n"


def test_faults_of_templates_are_reported_as_all_others_are(folder: Path):
    (folder / "t" / "notes.md.j2").write_text("{{ robot.nam }}")
    _, stderr = compile_by(folder, "-o", "out/", "--diagnostics", "json", expect=1)
    (diagnostic,) = json.loads(stderr)["diagnostics"]
    assert (diagnostic["code"], diagnostic["file"]) == ("LF7202", "t/notes.md.j2")


def test_an_error_in_the_spec_renders_nothing(folder: Path):
    (folder / "arm.robot.yaml").write_text("linkforge: 1\nname: arm\nlinks: {base: }\njoints: {x: 1}\n")
    (folder / "t" / "notes.md.j2").write_text("{{ nosuch }}")
    assert "LF7202" not in compile_by(folder, "-o", "out/", expect=1)[1]


def test_check_compares_documents(folder: Path):
    compile_by(folder, "-o", "out/")
    assert compile_by(folder, "-o", "out/", "--check")[1] == "out/notes.md is up to date\n"
    (folder / "t" / "notes.md.j2").write_text("# other\n")
    _, stderr = compile_by(folder, "-o", "out/", "--check", expect=1)
    assert stderr.startswith("out/notes.md:1:1: error: out of date: 'arm.robot.yaml' now compiles to '# other'")
    assert "note: the templates in 't' make it of the spec, and may have changed" in stderr


def test_a_depfile_names_the_templates_that_were_read(folder: Path):
    (folder / "t" / "_other.j2").write_text("not read")
    assert compile_by(folder, "-o", "out/", "--depfile", "out/d") == ("", "")
    rule = (folder / "out" / "d").read_text()
    assert rule.startswith("out/notes.md: \\\n  arm.robot.yaml \\\n  t/notes.md.j2 \\\n  t/_head.j2 \\\n")
    assert "_other" not in rule


def test_no_template_is_written_over(folder: Path):
    (folder / "t" / "notes.md").symlink_to("notes.md.j2")
    _, stderr = compile_by(folder, "-o", "t/", expect=2)
    assert "'t/notes.md' would be replaced, and the robot is made from it" in stderr


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--template", "nosuch"), "--template takes a folder of templates, found 'nosuch': No such file or directory"),
        (
            ("--template", "arm.robot.yaml"),
            "--template takes a folder of templates, found 'arm.robot.yaml': Not a directory",
        ),
        (("--template", "a\0b"), "--template takes a folder of templates, found 'a\\x00b': "),
        (
            ("--template", "empty"),
            "--template takes a folder of templates, found 'empty': it has no NAME.j2 for a document, nor urdf/",
        ),
        (("--template", ""), "--template takes a folder, found '': is a variable of the shell empty?"),
        (("--template", "t", "--source-map", "-o", "out/"), "--source-map cannot be combined with --template"),
        (
            ("--template", "two", "-o", "notes.md"),
            "-o takes a folder, or a file that ends in .urdf, ",
        ),
        (("--template", "t", "--check"), "--check compares with files"),
    ],
)
def test_contradictory_options_are_wrong_usage(words: tuple[str, ...], expected: str, folder: Path):
    (folder / "empty").mkdir()
    (folder / "two").mkdir()
    (folder / "two" / "a.md.j2").touch()
    (folder / "two" / "b.md.j2").touch()
    done = linkforge("compile", "arm.robot.yaml", *words, cwd=folder)
    assert done.returncode == 2
    assert done.stderr.startswith(f"linkforge compile: {expected}")


def test_a_package_that_the_user_names_may_be_linked_to(folder: Path, tmp_path_factory: pytest.TempPathFactory):
    shared = tmp_path_factory.mktemp("shared")
    (shared / "head.j2").write_text("shared\n")
    (folder / "t" / "_head.j2").unlink()
    (folder / "t" / "_head.j2").symlink_to(shared / "head.j2")
    assert "[LF3401]" in compile_by(folder, expect=1)[1]
    assert compile_by(folder, "--package", f"shared={shared}")[0] == "shared\n2 links\n"
    assert compile_by(folder, "--allow-outside")[0] == "shared\n2 links\n"
