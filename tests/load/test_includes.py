"""`include`: files laid into one, with their places, their paths and their bounds."""

import pytest

from linkforge_compile import compile_file, render_urdf
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import INCLUDE_TOO_DEEP, TOO_MANY_INCLUDES
from linkforge_compile.expand import arguments_from_text, expand
from linkforge_compile.load import Loader
from linkforge_compile.load.spec_tree import MAX_DEPTH, MAX_INCLUDES
from tests.expand.assembling import plain


def write(folder, files):
    """Write files with a first line `linkforge: 1`."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(f"linkforge: 1\n{text}")


def expanded(path):
    sink, loader = Diagnostics(), Loader()
    spec = loader.open(path, sink)
    instance = expand(spec, arguments_from_text((), sink), loader, sink)
    return instance, [diagnostic.message for diagnostic in sink.sorted()], loader.files


def test_the_files_are_one_afterwards(tmp_path):
    write(
        tmp_path,
        {
            "arm.yaml": "name: arm\ninclude: [links.yaml, more/palette.yaml]\nparameters: {reach: 1 m}\n"
            "links: {base: }\nsemantic: {groups: {all: {links: [base]}}, passive_joints: [a]}\n",
            "links.yaml": "include: [tools.yaml]\nlinks: {arm: {visual: {box: [$(reach), $(half), 1]}}}\n",
            "tools.yaml": "links: {tool: }\nsemantic: {groups: {tool: {links: [tool]}}, passive_joints: [b]}\n",
            "more/palette.yaml": "variables: {half: $(reach / 2)}\nmaterials: {steel: {color: [1, 1, 1]}}\nlinks:\n",
        },
    )
    instance, messages, files = expanded(tmp_path / "arm.yaml")
    tree = plain(instance.tree)
    assert messages == []
    assert list(tree["links"]) == ["base", "arm", "tool"]
    assert tree["links"]["arm"]["visual"]["box"][0].value == 1
    assert tree["links"]["arm"]["visual"]["box"][1].value == 0.5
    assert list(tree["semantic"]["groups"]) == ["all", "tool"]
    assert tree["semantic"]["passive_joints"] == ["a", "b"]
    assert [path.name for path in files] == ["arm.yaml", "links.yaml", "tools.yaml", "palette.yaml"]


def test_paths_are_relative_to_the_file_that_wrote_them(tmp_path):
    write(
        tmp_path,
        {
            "robot.yaml": "name: robot\nmodules: {arm: {use: arms/arm.yaml, with: {skin: skins/a.png}}}\n",
            "arms/arm.yaml": "name: arm\ninclude: [looks/links.yaml]\n"
            "parameters: {skin: {type: file, default: plain.png}, shell: {type: file, default: shells/shell.stl}}\n"
            "links: {base: {visual: {mesh: meshes/base.stl, material: {texture: $(skin)}}}}\n"
            "joints: {hinge: {type: fixed, parent: base, child: tip}}\n",
            "arms/looks/links.yaml": "modules: {tool: {use: tool.yaml, parent: tip, with: {grip: grip.stl}}}\n"
            "links: {tip: {visual: [{mesh: tip.stl}, {mesh: $(shell)}, {mesh: ../own.stl}]}}\n",
            "arms/looks/tool.yaml": "name: tool\nparameters: {grip: {type: file}}\n"
            "links: {palm: {visual: {mesh: {file: $(grip)}}}}\n",
        },
    )
    compilation = compile_file(tmp_path / "robot.yaml")
    assert not compilation.has_errors
    urdf = render_urdf(compilation.result())
    for path in ("meshes/base.stl", "looks/tip.stl", "shells/shell.stl", "own.stl", "looks/grip.stl"):
        assert f'filename="arms/{path}"' in urdf
    assert 'filename="skins/a.png"' in urdf


def test_a_fault_in_an_included_file_has_a_note_of_the_include(tmp_path):
    write(
        tmp_path,
        {
            "robot.yaml": "name: robot\nmodules: {arm: {use: arm.yaml}}\n",
            "arm.yaml": "name: arm\ninclude: [links.yaml]\nlinks: {base: }\n",
            "links.yaml": "include: [joints.yaml]\nlinks: {tip: {visual: {box: [1, 1, $(heigt)]}}}\n",
            "joints.yaml": "joints: {hinge: {type: fixed, parent: base, child: tp}}\n",
        },
    )
    diagnostics = compile_file(tmp_path / "robot.yaml").diagnostics
    notes = {one.code.id: [(note.message, note.span.file.path.name) for note in one.notes] for one in diagnostics}
    assert notes == {
        "LF3107": [("included here", "arm.yaml"), ("used here", "robot.yaml")],
        "LF4102": [("included here", "links.yaml"), ("included here", "arm.yaml"), ("used here", "robot.yaml")],
    }


def test_one_palette_may_be_included_by_several_modules(tmp_path):
    write(
        tmp_path,
        {
            "robot.yaml": "name: robot\ninclude: [palette.yaml]\nlinks: {base: {visual: {sphere: 1, material: red}}}\n"
            "modules: {a: {use: part.yaml, parent: base}, b: {use: part.yaml, parent: base}}\n",
            "part.yaml": "name: part\ninclude: [palette.yaml]\nlinks: {base: {visual: {sphere: 1, material: red}}}\n",
            "palette.yaml": "materials: {red: {color: [1, 0, 0]}}\n",
        },
    )
    compilation = compile_file(tmp_path / "robot.yaml")
    assert not compilation.diagnostics
    assert list(compilation.result().materials) == ["red", "a_red", "b_red"]
    assert [path.name for path in compilation.files] == ["robot.yaml", "palette.yaml", "part.yaml"]


def test_names_of_an_unreadable_file_are_not_reported_as_missing(tmp_path):
    write(
        tmp_path,
        {
            "robot.yaml": "name: robot\ninclude: [broken.yaml]\nvariants: {a: {b: 1}}\n"
            "links: {base: {visual: {sphere: $(r), material: red}}}\n"
            "joints: {hinge: {type: fixed, parent: base, child: tip}}\n",
            "broken.yaml": "links: [}",
        },
    )
    assert [one.code.id for one in compile_file(tmp_path / "robot.yaml").diagnostics] == ["LF1017"]


@pytest.mark.parametrize(
    ("count", "expected"), [(MAX_DEPTH, []), (MAX_DEPTH + 1, [INCLUDE_TOO_DEEP.message.format(limit=MAX_DEPTH)])]
)
def test_includes_nest_to_a_limit(tmp_path, count, expected):
    files = {f"{i}.yaml": f"include: [{i + 1}.yaml]\n" for i in range(1, count)}
    write(tmp_path, {**files, "robot.yaml": "name: robot\ninclude: [1.yaml]\n", f"{count}.yaml": "links: {tip: }\n"})
    assert expanded(tmp_path / "robot.yaml")[1] == expected


@pytest.mark.parametrize(
    ("count", "expected"),
    [(MAX_INCLUDES, []), (MAX_INCLUDES + 2, [TOO_MANY_INCLUDES.message.format(limit=MAX_INCLUDES)])],
)
def test_includes_are_counted(tmp_path, count, expected):
    names = [f"{i}.yaml" for i in range(count)]
    write(tmp_path, {**dict.fromkeys(names, ""), "robot.yaml": f"name: robot\ninclude: [{', '.join(names)}]\n"})
    assert expanded(tmp_path / "robot.yaml")[1] == expected


def test_text_that_lies_in_no_folder_includes_absolute_paths_only(tmp_path):
    write(tmp_path, {"part.yaml": "metadata: {a: 1}\n"})
    sink = Diagnostics()
    text = f"linkforge: 1\nname: robot\ninclude: [part.yaml, {(tmp_path / 'part.yaml').as_posix()}]\n"
    spec = Loader().parse(text, "<text>", None, sink)
    assert plain(spec.tree.get("metadata")) == {"a": 1}
    assert [one.code.id for one in sink] == ["LF3060"]
