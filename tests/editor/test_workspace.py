"""The schema of one repository: the names of its robots, offered where they are referred to, and nowhere a fault."""

import json
from collections.abc import Mapping
from pathlib import Path

import pytest
from jsonschema import Draft7Validator

from linkforge_compile.editor import (
    TooManyFilesError,
    Vocabulary,
    find_specs,
    folders,
    read_vocabulary,
    workspace_text,
)
from linkforge_compile.roots import Roots
from tests.cli.in_process import linkforge
from tests.conftest import ROOT
from tests.editor.language_server import Fault, LanguageServer

ARM = """\
linkforge: 1
name: arm
parameters:
  reach: {type: length, default: 0.7 m, minimum: 0.2 m, description: From the base to the tool.}
  hand: {type: string, enum: [none, gripper], default: none}
  fast: false
  serial: {type: string}
links:
  base:
  tool0:
joints:
  elbow: {type: revolute, parent: base, child: tool0, axis: y, limits: {effort: 1, velocity: 1}}
semantic:
  groups:
    arm: {chain: {base_link: base, tip_link: tool0}}
"""

CELL = """\
linkforge: 1
name: cell
include: [palette.yaml]
modules:
  left: {use: ../parts/arm.robot.yaml, parent: table, with: {serial: L}}
  right:
    use: ../parts/arm.robot.yaml
    parent: table
    when: false
links:
  table:
"""

PALETTE = """\
linkforge: 1
materials:
  steel: {color: [0.6, 0.6, 0.65, 1]}
"""

FAULTY = """\
linkforge: 1
name: faulty
links:
  base:
  hook: {colour: red}
joints:
  hinge: {type: fixed, parent: base, child: hoook}
frames:
  marker: {parent: base}
"""

MODELINE = "# yaml-language-server: $schema=../.linkforge/robot.schema.json\n"
FILES = {
    "parts/arm.robot.yaml": ARM,
    "cells/cell.robot.yaml": CELL,
    "cells/palette.yaml": MODELINE + PALETTE,
    "faulty.robot.yaml": FAULTY,
}


def written(root: Path, files: Mapping[str, str] = FILES) -> Path:
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    return root


def schema_text(root: Path) -> str:
    return workspace_text([read_vocabulary(spec, root) for spec in find_specs(root)])


@pytest.fixture(scope="session")
def shop(folder: Path) -> str:
    """The folder of a workspace with its schema, as its documents are named to the server."""
    root = written(folder / "shop")
    run = linkforge("schema", "--workspace", cwd=root)
    assert run.returncode == 0
    return root.name


HEAD = f"{MODELINE}linkforge: 1\nname: cell\n"
CELL_LINKS = ["left_base", "left_tool0", "table"]
ARGUMENTS = ["fast", "hand", "reach", "serial"]

OFFERED = {
    # All that is offered at the caret of cells/cell.robot.yaml.
    "a parent": ("joints:\n  weld:\n    parent: |", CELL_LINKS),
    "a child in flow style": ("joints:\n  weld: {type: fixed, child: |}", CELL_LINKS),
    "a module's parent": ("modules:\n  left: {parent: |}", CELL_LINKS),
    "a frame's parent": ("frames:\n  corner: {parent: |}", CELL_LINKS),
    "a sensor's link": ("sensors:\n  front: {link: |}", CELL_LINKS),
    "the joint to follow": ("joints:\n  a:\n    mimic:\n      joint: |", ["left_elbow", "left_joint"]),
    "a chain's end": ("semantic:\n  groups:\n    g:\n      chain: {base_link: |}", CELL_LINKS),
    "a group's joints": ("semantic:\n  groups:\n    g:\n      joints: [|]", ["left_elbow", "left_joint"]),
    "a group's groups": ("semantic:\n  groups:\n    g:\n      subgroups: [|]", ["left_arm"]),
    "an end effector's group": ("semantic:\n  end_effectors:\n    e: {parent_group: |}", ["left_arm"]),
    "a group with states": ("semantic:\n  group_states:\n    |", ["left_arm", "state"]),
    "links that are not checked": ("semantic:\n  no_default_collision_links: [|]", CELL_LINKS),
    "a link of a pair": (
        "semantic:\n  disabled_collisions:\n    table: {le|}",
        ["left_base", "left_tool0", "pair", "table", "value"],
    ),
    "a joint of hardware": ("ros2_control:\n  arm:\n    joints:\n      |", ["joint", "left_elbow", "left_joint"]),
    "a material": ("links:\n  a:\n    visual: {material: |}", ["steel"]),
    "a file": ("modules:\n  left:\n    use: |", ["../faulty.robot.yaml", "../parts/arm.robot.yaml"]),
    "a file to include": ("include: [|]", ["palette.yaml"]),
    "a module's parameters": ("modules:\n  a:\n    use: ../parts/arm.robot.yaml\n    with:\n      |", ARGUMENTS),
    "them before the file": ("modules:\n  a:\n    with:\n      |\n    use: ../parts/arm.robot.yaml\n", ARGUMENTS),
    "half of one in flow style": ("modules: {a: {use: ../parts/arm.robot.yaml, with: {re|}}}", ARGUMENTS),
    "those of another file": ("modules:\n  a:\n    use: ../faulty.robot.yaml\n    with:\n      |", []),
    "what an override reaches": (
        "modules:\n  a:\n    use: ../parts/arm.robot.yaml\n    override:\n      joints:\n        |",
        ["elbow"],
    ),
    "a frame as an override finds it": (
        "modules: {a: {use: ../faulty.robot.yaml, override: {links: {ma|}}}}",
        ["base", "hook", "marker"],
    ),
    "a parameter's value": ("modules: {a: {use: ../parts/arm.robot.yaml, with: {hand: |}}}", ["gripper", "none"]),
    "a flag": ("modules: {a: {use: ../parts/arm.robot.yaml, with: {fast: |}}}", ["false", "true"]),
}
EVERYWHERE = {"for", "when", "extra", "extra_attributes", "extra_inside"}


@pytest.mark.parametrize(("document", "labels"), OFFERED.values(), ids=OFFERED)
def test_what_is_offered(server: LanguageServer, shop: str, document: str, labels: list[str]):
    offered = server.completions(HEAD + document, f"{shop}/cells/cell.robot.yaml")
    assert [found.label for found in offered if found.label not in EVERYWHERE] == labels


VENDOR = {
    "arm.urdf": """\
<robot name="arm">
  <link name="base"/>
  <link name="flange"/>
  <joint name="turn" type="continuous">
    <parent link="base"/>
    <child link="flange"/>
    <axis xyz="0 0 1"/>
  </joint>
</robot>
""",
    "arm.srdf": '<robot name="arm"><group name="all"><joint name="turn"/></group></robot>',
    "hand.urdf.xacro": """\
<robot name="hand" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="width" default="0.1"/>
  <xacro:arg name="side" default="left"/>
  <xacro:macro name="finger" params="reach:=0.1"><link name="tip"/></xacro:macro>
  <link name="$(arg side)_palm"/>
</robot>
""",
    "cell.robot.yaml": """\
linkforge: 1
name: cell
links: {table: }
modules:
  arm: {use: arm.urdf, srdf: arm.srdf, parent: table}
  hand: {use: hand.urdf.xacro, parent: table, with: {side: left}}
  tool: {use: tool.robot.yaml, parent: table}
""",
    "tool.robot.yaml": ARM.replace("  serial: {type: string}\n", ""),
}
OF_VENDORS = {
    "what an override reaches in a URDF": ("use: arm.urdf, override: {links: {fl|}}", ["base", "flange"]),
    "a section of that": (
        "use: arm.urdf, override: {jo|}",
        [
            *("controllers", "gazebo", "joints", "links", "materials", "modules", "mount", "ros2_control", "semantic"),
            *("sensors", "transmissions"),
        ],
    ),
    "the groups of its SRDF": ("use: arm.urdf, override: {semantic: {groups: {al|}}}", ["all"]),
    "the groups of a spec": ("use: tool.robot.yaml, override: {semantic: {groups: {ar|}}}", ["arm"]),
    "what an override reaches in a xacro": ("use: hand.urdf.xacro, override: {links: {pa|}}", ["left_palm"]),
    "the macros of a xacro": ("use: hand.urdf.xacro, macro: |", ["finger"]),
    "the parameters of a macro": (
        "use: hand.urdf.xacro, macro: finger, with: {re|}",
        ["reach", "side", "width"],
    ),
    "the arguments of a xacro": ("use: hand.urdf.xacro, with: {wi|}", ["side", "width"]),
}


@pytest.fixture(scope="session")
def vendors(folder: Path) -> str:
    """The folder of a workspace with a vendor's files, as its documents are named to the server."""
    root = written(folder / "vendors", VENDOR)
    assert linkforge("schema", "--workspace", cwd=root).stderr == "wrote .linkforge/robot.schema.json\n"
    return root.name


@pytest.mark.parametrize(("entry", "labels"), OF_VENDORS.values(), ids=OF_VENDORS)
def test_what_is_offered_for_a_vendors_file(server: LanguageServer, vendors: str, entry: str, labels: list[str]):
    document = f"{HEAD.replace('../', '')}modules: {{a: {{{entry}}}}}"
    offered = server.completions(document, f"{vendors}/cell.robot.yaml")
    assert [found.label for found in offered if found.label not in EVERYWHERE] == labels


def test_an_argument_of_a_xacro_is_put_in_with_its_default(server: LanguageServer, vendors: str):
    document = f"{HEAD.replace('../', '')}modules:\n  a:\n    use: hand.urdf.xacro\n    with:\n      |"
    found = {one.label: one.inserted for one in server.completions(document, f"{vendors}/cell.robot.yaml")}
    assert found == {"side": "side: ${1:left}", "width": 'width: ${1:"0.1"}'}


def test_an_included_file_has_the_names_of_the_robot(server: LanguageServer, shop: str):
    document = f"{MODELINE}linkforge: 1\njoints:\n  weld: {{parent: |}}"
    assert [found.label for found in server.completions(document, f"{shop}/cells/palette.yaml")] == CELL_LINKS


def test_a_file_to_include_is_one_that_specs_include(server: LanguageServer, shop: str):
    document = HEAD.replace("../", "") + "include: [|]\n"
    assert [found.label for found in server.completions(document, f"{shop}/faulty.robot.yaml")] == [
        "cells/palette.yaml"
    ]


def test_a_part_that_is_called_as_a_robot_is_no_module(tmp_path: Path):
    cell = CELL.replace("palette.yaml", "palette.robot.yaml")
    files = {"parts/arm.robot.yaml": ARM, "cells/cell.robot.yaml": cell, "cells/palette.robot.yaml": PALETTE}
    run = linkforge("schema", "--workspace", cwd=written(tmp_path, files))
    assert run.stderr == "wrote .linkforge/robot.schema.json\n"
    schema = json.loads((tmp_path / ".linkforge/robot.schema.json").read_text())
    modules = {name for name in schema["definitions"] if name.startswith("module_")}
    assert len({name for name in modules if name.removeprefix("module_").isdecimal()}) == 2


def test_another_spec_has_its_own_names(server: LanguageServer, shop: str):
    document = f"{HEAD}joints:\n  weld: {{parent: |}}"
    offered = [found.label for found in server.completions(document, f"{shop}/parts/arm.robot.yaml")]
    assert offered == ["base", "tool0"]


def test_a_variant_sets_the_parameters_of_its_file(server: LanguageServer, shop: str):
    document = f"{HEAD}variants:\n  quick:\n    |"
    assert [found.label for found in server.completions(document, f"{shop}/parts/arm.robot.yaml")] == [
        *ARGUMENTS,
        "variant",
    ]


def test_a_parameter_is_inserted_with_its_default_and_reported(server: LanguageServer, shop: str):
    document = f"{HEAD}modules:\n  a:\n    use: ../parts/arm.robot.yaml\n    with:\n      "
    found = {one.label: one for one in server.completions(f"{document}|", f"{shop}/cells/cell.robot.yaml")}
    assert found["reach"].inserted == "reach: ${1:0.7 m}"
    assert found["serial"].inserted == "serial: "
    shown = server.hover(f"{document}rea|ch: 0.9 m", f"{shop}/cells/cell.robot.yaml")
    for phrase in ("From the base to the tool.", "type `length`", "default `0.7 m`", "at least `0.2 m`"):
        assert phrase in shown


def test_a_name_that_is_new_is_no_fault_and_a_wrong_key_is_one(server: LanguageServer, shop: str):
    new = f"{HEAD}joints: {{weld: {{type: fixed, parent: fresh, child: $(name)}}}}\n"
    assert server.faults(new, f"{shop}/cells/cell.robot.yaml") == []
    wrong = f"{HEAD}joints: {{weld: {{parnt: table}}}}\n"
    expected = [Fault("parnt", "Property parnt is not allowed.")]
    assert server.faults(wrong, f"{shop}/cells/cell.robot.yaml") == expected


@pytest.fixture(scope="session")
def lessons(folder: Path) -> Path:
    """The folder with the schema of the examples."""
    (folder / "lessons.schema.json").write_text(schema_text(ROOT / "examples"), "utf-8")
    return folder


@pytest.mark.parametrize("spec", find_specs(ROOT / "examples"), ids=lambda path: path.stem)
def test_nothing_is_underlined_in_an_example(server: LanguageServer, lessons: Path, spec: Path):
    modeline = f"# yaml-language-server: $schema={(lessons / 'lessons.schema.json').as_uri()}\n"
    place = spec.relative_to(ROOT / "examples").as_posix()
    assert server.faults(modeline + spec.read_text("utf-8"), f"lessons/{place}") == []


def test_every_validator_accepts_it_and_finds_no_more_than_the_language(tmp_path: Path):
    schema = json.loads(schema_text(written(tmp_path)))
    Draft7Validator.check_schema(schema)
    assert Draft7Validator(schema).is_valid({"linkforge": 1, "joints": {"weld": {"parent": "anything"}}})
    assert not Draft7Validator(schema).is_valid({"linkforge": 1, "joints": {"weld": {"parnt": "table"}}})


def test_the_bytes_are_the_same_wherever_the_folder_lies(tmp_path: Path):
    here, there = schema_text(written(tmp_path / "a")), schema_text(written(tmp_path / "other place/b"))
    assert here == there
    assert str(tmp_path) not in here


def test_names_are_final_and_of_whatever_can_be_read(tmp_path: Path):
    root = written(tmp_path)
    cell = read_vocabulary(root / "cells/cell.robot.yaml", root)
    assert cell.files == ("cells/cell.robot.yaml", "cells/palette.yaml")
    assert cell.names["joint"] == ("left_elbow", "left_joint")
    assert "base" not in cell.names["link"]
    faulty = read_vocabulary(root / "faulty.robot.yaml", root)
    assert not faulty.is_whole
    assert "base" in faulty.names["link"]
    (root / "faulty.robot.yaml").write_text("links: [", "utf-8")
    assert read_vocabulary(root / "faulty.robot.yaml", root).names == {}


def test_a_name_is_put_in_as_yaml_reads_it(server: LanguageServer, folder: Path):
    names = "linkforge: 1\nname: odd\nlinks: {'007': , 'true': , a.b/c: }\n"
    root = written(folder / "odd shop", {"odd.robot.yaml": names, "$(x) {y}.robot.yaml": ARM})
    (root / "robot.schema.json").write_text(schema_text(root), "utf-8")
    head = "# yaml-language-server: $schema=robot.schema.json\nlinkforge: 1\nname: odd\n"
    links = server.completions(f"{head}joints: {{a: {{parent: |}}}}", "odd shop/odd.robot.yaml")
    assert {found.label: found.inserted for found in links} == {
        "007": '"007"',
        "a.b/c": "a.b/c",
        "true": '"true"',
    }
    (file,) = server.completions(f"{head}modules: {{a: {{use: |}}}}", "odd shop/odd.robot.yaml")
    assert (file.label, file.inserted) == ("$(x) {y}.robot.yaml", '"\\$(x) {y\\}.robot.yaml"')


def test_the_command_tells_of_specs_with_errors_and_writes_once(tmp_path: Path):
    root = written(tmp_path)
    run = linkforge("schema", "--workspace", cwd=root)
    expected = "names of faulty.robot.yaml may be missing; `linkforge check` shows why\n"
    assert (run.returncode, run.stdout, run.stderr) == (0, "", f"{expected}wrote .linkforge/robot.schema.json\n")
    again = linkforge("schema", "--workspace", str(root), "-o", "here.json", cwd=root)
    assert again.stderr == f"{expected.replace('faulty.r', f'{root}/faulty.r')}wrote here.json\n"
    assert (root / "here.json").read_bytes() == (root / ".linkforge/robot.schema.json").read_bytes()
    assert (
        linkforge("schema", "--workspace", cwd=root).stderr == f"{expected}.linkforge/robot.schema.json is up to date\n"
    )
    assert linkforge("schema", "--workspace", "nowhere", cwd=root).returncode == 2


def test_included_files_without_a_schema_are_named(server: LanguageServer, folder: Path):
    cell = "linkforge: 1\nname: cell\ninclude: [parts/colors.yaml, parts/steel.robot.yaml]\nlinks: {table: }\n"
    files = {"cell.robot.yaml": cell, "parts/colors.yaml": PALETTE, "parts/steel.robot.yaml": "linkforge: 1\n"}
    root = written(folder / "included", files)
    stderr = linkforge("schema", "--workspace", cwd=root).stderr
    assert stderr.splitlines()[0] == (
        f"'parts/colors.yaml' has no schema in editors; begin it with '{MODELINE.strip()}', or call it NAME.robot.yaml"
    )
    (root / "parts/colors.yaml").write_text(f"# Colors of the cell.\n{MODELINE}{PALETTE}")
    assert linkforge("schema", "--workspace", cwd=root).stderr == ".linkforge/robot.schema.json is up to date\n"
    offered = server.completions(f"{MODELINE}linkforge: 1\njoints: {{a: {{parent: |}}}}", "included/parts/colors.yaml")
    assert [found.label for found in offered] == ["table"]


def test_the_schema_of_a_folder_is_the_one_that_its_specs_name(tmp_path: Path):
    root = written(tmp_path, {"parts/arm.robot.yaml": ARM})
    (root / ".git").mkdir()
    assert linkforge("schema", "--workspace", cwd=root).stderr == "wrote .linkforge/robot.schema.json\n"
    below = root / "parts"
    assert linkforge("schema", "--workspace", cwd=below).stderr == "../.linkforge/robot.schema.json is up to date\n"
    assert linkforge("schema", "--workspace", ".", cwd=below).stderr == "wrote .linkforge/robot.schema.json\n"
    stderr = linkforge("schema", "--workspace", cwd=root).stderr
    assert stderr.startswith("'parts' has its own schema; `linkforge schema --workspace parts` updates it\n")
    (root / ".linkforge" / "robot.schema.json").unlink()
    (below / "hand.robot.yaml").write_text(ARM)
    assert linkforge("schema", "--workspace", cwd=root).stderr == "wrote parts/.linkforge/robot.schema.json\n"


def test_a_folder_without_specs_gets_no_schema(tmp_path: Path):
    run = linkforge("schema", "--workspace", cwd=tmp_path)
    assert run.returncode == 2
    assert "there is no spec, NAME.robot.yaml, below '.'" in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_package_of_the_command_line_is_found(tmp_path: Path):
    cell = CELL.replace("../parts/arm", "package://arms/arm").replace("include: [palette.yaml]\n", "")
    written(tmp_path / "far", {"arms/arm.robot.yaml": ARM})
    root = written(tmp_path / "near", {"cell.robot.yaml": cell})
    assert "may be missing" in linkforge("schema", "--workspace", cwd=root).stderr
    found = linkforge("schema", "--workspace", "--package", "arms=../far/arms", cwd=root)
    assert (found.returncode, found.stderr) == (0, "wrote .linkforge/robot.schema.json\n")
    assert '"left_tool0"' in (root / ".linkforge/robot.schema.json").read_text()


def test_of_two_specs_of_one_name_each_has_its_own_words(server: LanguageServer, folder: Path):
    root = written(folder / "namesakes", {"arm.robot.yaml": CELL, "parts/arm.robot.yaml": ARM})
    (root / "robot.schema.json").write_text(schema_text(root), "utf-8")
    document = "linkforge: 1\nname: x\njoints: {weld: {parent: |}}"
    for place, schema, links in (("", "", ["table"]), ("parts/", "../", ["base", "tool0"])):
        modeline = f"# yaml-language-server: $schema={schema}robot.schema.json\n"
        offered = server.completions(modeline + document, f"namesakes/{place}arm.robot.yaml")
        assert [found.label for found in offered] == links


def test_the_schema_grows_with_the_specs_and_not_with_their_square():
    def size(specs: int) -> int:
        folders = [f"robots/r{number}" for number in range(specs)]
        return len(workspace_text([Vocabulary((f"{one}/arm.robot.yaml", f"{one}/parts.yaml")) for one in folders]))

    ten, twenty, forty = size(10), size(20), size(40)
    assert forty - twenty < 2.2 * (twenty - ten)


def test_specs_are_those_that_a_person_wrote(tmp_path: Path):
    copies = {f"{folder}/arm.robot.yaml": ARM for folder in (".venv", "build/arm", "install/share", "parts/.hidden")}
    hidden = {"a/.b.robot.yml": ARM, "._c.robot.yaml": "\0"}
    root = written(tmp_path / "repo", {**copies, **hidden, "a/b.robot.yml": ARM, "c.robot.yaml": ARM, "d.yaml": ARM})
    assert [path.relative_to(root).as_posix() for path in find_specs(root)] == ["a/b.robot.yml", "c.robot.yaml"]


def test_a_spec_that_links_lead_to_is_one(tmp_path: Path):
    written(tmp_path / "repo", {".hidden/d.robot.yaml": ARM})
    root = written(tmp_path / "repo", {"parts/a.robot.yaml": ARM})
    (root / "again.robot.yaml").symlink_to("parts/a.robot.yaml")
    (root / "parts again").symlink_to("parts")
    (root / ".#a.robot.yaml").symlink_to("somebody@machine.123")
    (root / "lock.robot.yaml").symlink_to("somebody@machine.123")
    (root / "d.robot.yaml").symlink_to(".hidden/d.robot.yaml")
    assert [path.relative_to(root).as_posix() for path in find_specs(root)] == ["d.robot.yaml", "parts/a.robot.yaml"]


def test_a_link_out_of_the_folders_that_may_be_read_is_no_spec(tmp_path: Path):
    """Whether the file exists or not, which the author of the link must not learn."""
    far = written(tmp_path / "far", {"d.robot.yaml": ARM})
    root = written(tmp_path / "repo", {"a.robot.yaml": ARM})
    links = (root / "d.robot.yaml", root / "gone.robot.yaml", root / "zero.robot.yaml")
    for link, target in zip(links, (far / "d.robot.yaml", far / "gone", Path("/dev/zero")), strict=True):
        link.symlink_to(target)
    outside: list[Path] = []
    assert find_specs(root, outside=outside.append) == (root / "a.robot.yaml",)
    assert sorted(outside) == sorted(links)
    assert find_specs(root, roots=Roots.around(root, (far,))) == (root / "a.robot.yaml", root / "d.robot.yaml")


def test_a_folder_of_more_than_robots_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    root = written(tmp_path)
    with pytest.raises(TooManyFilesError, match="more than 2 specs"):
        find_specs(root, at_most=2)
    monkeypatch.setattr(folders, "MAX_FOLDERS", 2)
    with pytest.raises(TooManyFilesError, match="more than 2 folders"):
        find_specs(root)
