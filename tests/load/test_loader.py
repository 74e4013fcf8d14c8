"""Test how files are named, found and read, and how unreadable ones are reported."""

import os
import time
from pathlib import Path

import pytest

from linkforge_compile import compile_file
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand import Instance, arguments_from_text, expand
from linkforge_compile.limits import MAX_FILE_BYTES
from linkforge_compile.load import Loader
from linkforge_compile.paths import follow
from tests.expand.assembling import write


def expanded(path: Path, loader: Loader, sink: Diagnostics) -> Instance:
    spec = loader.open(path, sink)
    assert spec, [str(diagnostic) for diagnostic in sink]
    return expand(spec, arguments_from_text((), sink), loader, sink)


def bases(instance: Instance) -> dict[str, str]:
    return {module.name: module.mesh_bases[module.tree.span.file] for module in instance.modules if module.tree}


def test_a_file_is_named_as_typed_from_the_working_directory(tmp_path, monkeypatch):
    write(tmp_path, {"work/robot.robot.yaml": "links: {a: }", "other/arm.robot.yaml": "links: {a: }"})
    monkeypatch.chdir(tmp_path / "work")
    sink, loader = Diagnostics(), Loader()
    for path in ("robot.robot.yaml", tmp_path / "other" / "arm.robot.yaml", "../other/arm.robot.yaml"):
        loader.open(Path(path), sink)
    loader.open(tmp_path / "work" / "robot.robot.yaml", sink)
    assert loader.files == (Path("robot.robot.yaml"), tmp_path / "other" / "arm.robot.yaml")


def test_files_count_in_the_order_they_are_read(tmp_path):
    write(tmp_path, {"a.robot.yaml": "", "b.robot.yaml": ""})
    sink, loader = Diagnostics(), Loader()
    orders = [loader.open(tmp_path / name, sink).file.order for name in ("b.robot.yaml", "a.robot.yaml")]
    assert orders == [0, 1]


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"linkforge: 1\nname: \xff\n", "it is not UTF-8: line 2 has the byte 0xff; save it as UTF-8"),
        ("linkforge: 1\n".encode("utf-16"), "it is UTF-16, as PowerShell writes; save it as UTF-8"),
        (b" " * (MAX_FILE_BYTES + 1), "it is larger than 16 MiB"),
    ],
)
def test_a_file_that_is_not_text_is_reported(tmp_path, content, reason):
    path = tmp_path / "a.robot.yaml"
    path.write_bytes(content)
    sink = Diagnostics()
    assert Loader().open(path, sink) is None
    assert [diagnostic.message for diagnostic in sink] == [f"'{path}' cannot be read: {reason}"]


def test_a_folder_and_a_missing_file_are_reported(tmp_path):
    write(tmp_path, {"arm.robot.yaml": ""})
    sink = Diagnostics()
    assert Loader().open(tmp_path, sink) is None
    assert Loader().open(tmp_path / "amr.robot.yaml", sink) is None
    assert [diagnostic.message for diagnostic in sink] == [
        f"'{tmp_path}' cannot be read: it is a folder",
        f"there is no file '{tmp_path / 'amr.robot.yaml'}'; did you mean 'arm.robot.yaml'?",
    ]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes with names")
def test_a_module_that_is_a_pipe_is_not_waited_for(tmp_path):
    write(tmp_path, {"robot.robot.yaml": "modules: {a: {use: pipe.yaml}}"})
    os.mkfifo(tmp_path / "pipe.yaml")
    sink = Diagnostics()
    expanded(tmp_path / "robot.robot.yaml", Loader(), sink)
    assert [diagnostic.message for diagnostic in sink] == ["'pipe.yaml' cannot be read: it is not a regular file"]


def test_text_in_no_folder_uses_absolute_paths_only(tmp_path):
    write(tmp_path, {"arm.robot.yaml": "links: {a: }"})
    absolute = (tmp_path / "arm.robot.yaml").as_posix()
    sink, loader = Diagnostics(), Loader()
    text = f"linkforge: 1\nname: a\nmodules: {{a: {{use: arm.robot.yaml}}, b: {{use: {absolute}}}}}\n"
    instance = expand(loader.parse(text, "<text>", None, sink), arguments_from_text((), sink), loader, sink)
    assert [diagnostic.message for diagnostic in sink] == [
        "'arm.robot.yaml' cannot be found: it is relative, and this text is not in a folder"
    ]
    assert bases(instance) == {"b": f"{tmp_path.as_posix()}/"}


def test_mesh_paths_of_a_module_are_made_relative_to_the_compiled_file(tmp_path, monkeypatch):
    arm = "modules: {hand: {use: ../hands/hand.robot.yaml}}"
    write(
        tmp_path,
        {
            "robots/robot.robot.yaml": f"""
                packages: {{parts: ../parts}}
                modules:
                  beside: {{use: beside.robot.yaml}}
                  below: {{use: ./below/arm.robot.yaml}}
                  above: {{use: below/../../arms/arm.robot.yaml}}
                  absolute: {{use: {(tmp_path / "arms/arm.robot.yaml").as_posix()}}}
                  url: {{use: {(tmp_path / "arms/arm.robot.yaml").as_uri()}}}
                  packaged: {{use: package://parts/arms/arm.robot.yaml}}
                  packed: {{use: package://parts/hand.robot.yaml}}
            """,
            "robots/beside.robot.yaml": "",
            "robots/below/arm.robot.yaml": "",
            "arms/arm.robot.yaml": arm,
            "hands/hand.robot.yaml": "",
            "parts/hand.robot.yaml": "",
            "parts/arms/arm.robot.yaml": arm,
            "parts/hands/hand.robot.yaml": "",
        },
    )
    for start, path in (
        (tmp_path, "robots/robot.robot.yaml"),
        (tmp_path / "arms", tmp_path / "robots/robot.robot.yaml"),
    ):
        monkeypatch.chdir(start)
        sink = Diagnostics()
        instance = expanded(Path(path), Loader(), sink)
        assert not list(sink)
        assert bases(instance) == {
            "beside": "",
            "below": "below/",
            "above": "../arms/",
            "absolute": "../arms/",
            "url": "../arms/",
            "packaged": "package://parts/arms/",
            "packed": "package://parts/",
        }
        assert bases(instance.modules[2]) == {"hand": "../hands/"}
        assert bases(instance.modules[5]) == {"hand": "package://parts/hands/"}


def test_a_step_back_is_not_taken_through_a_symbolic_link(tmp_path):
    (tmp_path / "real" / "inner").mkdir(parents=True)
    (tmp_path / "link").symlink_to(tmp_path / "real" / "inner")
    assert follow(tmp_path, "link/../a.yaml") == tmp_path / "link" / ".." / "a.yaml"
    assert follow(tmp_path, "real/../a.yaml") == tmp_path / "a.yaml"
    assert follow(Path(), "../a.yaml") == Path("../a.yaml")


MANIFEST = "<package><!-- <name>not_this</name> --><name> {} </name></package>"


def test_packages_are_looked_for_in_the_order_of_the_language(tmp_path, monkeypatch):
    write(
        tmp_path,
        {
            "src/arm/robots/robot.robot.yaml": "modules: {a: {use: package://arm/part.robot.yaml}}",
            "src/arm/part.robot.yaml": "description: source tree",
            "ros/arm/part.robot.yaml": "description: ros path",
            "prefix/share/arm/part.robot.yaml": "description: ament",
            "option/part.robot.yaml": "description: option",
            "key/part.robot.yaml": "description: key",
        },
    )
    robot = tmp_path / "src/arm/robots/robot.robot.yaml"

    def found(packages: dict[str, Path] | None = None) -> object:
        (module,) = expanded(robot, Loader(packages), Diagnostics()).modules
        return module.tree and module.tree.get("description").text

    assert found() is None
    (tmp_path / "ros/arm/package.xml").write_text(MANIFEST.format("arm"))
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"{tmp_path}/nowhere{os.pathsep}{tmp_path}/ros")
    assert found() == "ros path"
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    assert found() == "ament"
    (tmp_path / "src/arm/package.xml").write_text(MANIFEST.format("not_this"))
    assert found() == "ament"
    (tmp_path / "src/arm/package.xml").write_text(MANIFEST.format("arm"))
    assert found() == "source tree"
    robot.write_text(robot.read_text() + "\npackages: {arm: ../../../key}\n")
    assert found() == "key"
    assert found({"arm": tmp_path / "option"}) == "option"


def test_a_sibling_package_is_not_read_but_suggested(tmp_path, monkeypatch):
    """Where a workspace is not sourced: colcon finds packages below src, in repositories as well."""
    use = "links: {base: }\nmodules: {a: {use: 'package://gripper/gripper.robot.yaml', parent: base}}"
    files = {"src/arm/arm.robot.yaml": use, "src/hands/gripper/gripper.robot.yaml": "links: {palm: }"}
    write(tmp_path, files)
    (tmp_path / "src/hands/gripper/package.xml").write_text(MANIFEST.format("gripper"))
    monkeypatch.chdir(tmp_path / "src" / "arm")
    [fault] = compile_file("arm.robot.yaml").diagnostics
    assert fault.code.id == "LF3005"
    # `packages` of the spec would lead out of what may be read.
    assert fault.message == "no package named 'gripper'; specify its folder with --package gripper=FOLDER"
    assert [note.message for note in fault.notes] == ["there is one; write --package gripper=../hands/gripper"]
    assert compile_file("arm.robot.yaml", packages={"gripper": "../hands/gripper"}).robot
    (tmp_path / ".git").mkdir()
    [fault] = compile_file("arm.robot.yaml").diagnostics
    assert "specify its folder with 'packages' of this file or --package gripper=FOLDER" in fault.message


def test_the_option_for_a_package_can_be_pasted_where_its_folder_has_a_space(tmp_path, monkeypatch):
    write(tmp_path, {"src/arm/arm.robot.yaml": "modules: {a: {use: 'package://gripper/gripper.robot.yaml'}}"})
    write(tmp_path, {"src/my hands/package.xml": MANIFEST.format("gripper")})
    monkeypatch.chdir(tmp_path / "src" / "arm")
    [fault] = compile_file("arm.robot.yaml").diagnostics
    assert [note.message for note in fault.notes] == ["there is one; write --package gripper='../my hands'"]


def test_a_package_beyond_the_sources_of_the_workspace_is_none_of_it(tmp_path):
    write(tmp_path, {"ws/src/arm/arm.robot.yaml": "modules: {a: {use: 'package://gripper/gripper.robot.yaml'}}"})
    (tmp_path / "gripper").mkdir()
    (tmp_path / "gripper" / "package.xml").write_text(MANIFEST.format("gripper"))
    assert [one.notes for one in compile_file(tmp_path / "ws/src/arm/arm.robot.yaml").diagnostics] == [()]


@pytest.mark.parametrize("manifest", ["<name>" + " " * 200_000, "<!--" * 100_000])
def test_a_manifest_that_strangers_wrote_is_read_in_time_that_grows_with_its_length(tmp_path, manifest: str):
    mesh = "links: {base: {visual: {mesh: package://parts/base.stl}}}"
    write(tmp_path, {"robot.robot.yaml": f"{mesh}\nmodules: {{a: {{use: 'package://gripper/gripper.robot.yaml'}}}}"})
    (tmp_path / "package.xml").write_text(manifest)
    started = time.process_time()
    assert [one.code.id for one in compile_file(tmp_path / "robot.robot.yaml").diagnostics] == ["LF3005"]
    assert time.process_time() - started < 2


def test_a_missing_file_is_not_suggested_by_its_ending_or_as_the_file_that_uses_it(tmp_path: Path):
    """`nope` and `one` have but `.robot.yaml` in common, and a file that uses itself would be a cycle."""
    for name, module in {"one": "nope", "grip": "gripp"}.items():
        file = tmp_path / f"{name}.robot.yaml"
        file.write_text(
            f"linkforge: 1\nname: a\nlinks: {{base: }}\nmodules: {{m: {{use: {module}.robot.yaml, parent: base}}}}\n"
        )
        (error,) = compile_file(file).diagnostics
        assert error.message == f"there is no file '{module}.robot.yaml'"
    (tmp_path / "grippe.robot.yaml").touch()
    (error,) = compile_file(tmp_path / "grip.robot.yaml").diagnostics
    assert error.message == "there is no file 'gripp.robot.yaml'; did you mean 'grippe.robot.yaml'?"
