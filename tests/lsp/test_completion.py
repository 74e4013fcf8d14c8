"""What the server offers at positions in specs of examples/, and what accepting an item makes of them."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from lsprotocol import types
from pygls.workspace import PositionCodec

from linkforge_compile.analysis import analyse_path
from linkforge_compile.lsp.completion import Client, complete
from linkforge_compile.lsp.convert import Columns
from linkforge_compile.lsp.workspace import Workspace
from tests.lsp.completion_cases import CASES, EXAMPLES, Case
from tests.lsp.editor import Editor, split_at_cursor


@pytest.fixture(scope="module")
def examples() -> Iterator[Editor]:
    """A server whose workspace is examples/."""
    with Editor(EXAMPLES) as editor:
        yield editor


def completions(editor: Editor, file: Path, text: str, position: types.Position) -> list[types.CompletionItem]:
    """Return what is offered at a position of a text, in the order shown."""
    document = editor.open(file, text)
    params = types.CompletionParams(document, position)
    found = editor.ask(lambda client: client.text_document_completion_async(params))
    assert isinstance(found, types.CompletionList)
    return sorted(found.items, key=lambda item: item.sort_text or item.label)


def accept(item: types.CompletionItem, text: str) -> str:
    """Return the text after an item is accepted."""
    edit = item.text_edit
    assert isinstance(edit, types.TextEdit)
    start, end = edit.range.start, edit.range.end
    assert start.line == end.line
    lines = text.split("\n")
    line = lines[start.line]
    lines[start.line] = line[: start.character] + edit.new_text + line[end.character :]
    return "\n".join(lines)


def show(case: Case) -> str:
    return f"{case.file.partition('/')[0]}: {case.new.strip().splitlines()[0]}"


@pytest.mark.parametrize("case", CASES, ids=show)
def test_a_position_in_an_example(case: Case, examples: Editor):
    file = EXAMPLES / case.file
    saved = file.read_text("utf-8")
    assert saved.count(case.old) >= 1
    examples.open(file, saved)
    assert examples.diagnostics(file) == []
    text, position = split_at_cursor(saved.replace(case.old, case.new, 1))
    found = completions(examples, file, text, position)
    labels = [item.label for item in found]
    offered = case.offered.split()
    assert set(offered) <= set(labels), labels
    assert not set(case.hidden.split()) & set(labels), labels
    assert len(set(labels)) == len(labels)
    if case.accepted:
        accepted = accept(next(item for item in found if item.label == case.accepted), text)
        assert accepted == saved.replace(case.old, case.makes, 1)
        examples.open(file, accepted)
        codes = [str(one.code) for one in examples.diagnostics(file)]
        assert not [code for code in codes if code.startswith("LF1")] if not case.is_clean else not codes


def labels_at(editor: Editor, file: Path, marked: str) -> list[str]:
    """Return the labels offered at the ¦ of a text."""
    return [item.label for item in completions(editor, file, *split_at_cursor(marked))]


def test_an_editor_with_snippets_and_markdown_gets_both(tmp_path: Path):
    item = types.ClientCompletionItemOptions(
        snippet_support=True,
        documentation_format=[types.MarkupKind.Markdown],
        insert_text_mode_support=types.ClientCompletionItemInsertTextModeOptions([types.InsertTextMode.AsIs]),
    )
    completion = types.CompletionClientCapabilities(completion_item=item)
    document = types.TextDocumentClientCapabilities(completion=completion)
    file = tmp_path / "arm.robot.yaml"
    with Editor(tmp_path, abilities=types.ClientCapabilities(text_document=document)) as editor:
        found = completions(editor, file, *split_at_cursor("linkforge: 1\nname: arm\njoints:\n  elbow:\n    lim¦\n"))
        [limits] = [item for item in found if item.label == "limits"]
        [joint] = [
            item
            for item in completions(editor, file, *split_at_cursor("linkforge: 1\nname: arm\njoints:\n  ¦\n"))
            if item.label == "fixed joint"
        ]
    assert isinstance(limits.text_edit, types.TextEdit)
    assert limits.text_edit.new_text == "limits:\n      $0"
    assert limits.insert_text_format is types.InsertTextFormat.Snippet
    assert limits.insert_text_mode is types.InsertTextMode.AsIs
    assert isinstance(limits.documentation, types.MarkupContent)
    assert limits.documentation.kind is types.MarkupKind.Markdown
    assert "```yaml\nlimits:" in limits.documentation.value
    assert isinstance(joint.text_edit, types.TextEdit)
    assert joint.text_edit.new_text.startswith("${1:joint_name}:\n    type: fixed\n    parent: ${2:base}\n")


def test_required_keys_come_first_and_common_ones_last(editor: Editor, tmp_path: Path):
    found = labels_at(editor, tmp_path / "arm.robot.yaml", "linkforge: 1\njoints:\n  elbow: {¦}\n")
    assert found[:5] == ["type", "parent", "child", "origin", "axis"]
    assert found[-5:] == ["extra", "extra_attributes", "extra_inside", "when", "for"]
    typed = "linkforge: 1\njoints:\n  elbow: {type: revolute, ¦}\n"
    assert labels_at(editor, tmp_path / "arm.robot.yaml", typed)[:3] == ["parent", "child", "limits"]


def test_the_name_of_a_robot_is_that_of_its_file(editor: Editor, tmp_path: Path):
    assert labels_at(editor, tmp_path / "bot.robot.yaml", "linkforge: 1\nname: ¦\n") == ["bot"]


def test_names_in_a_module_have_no_prefix_and_those_in_its_user_do(editor: Editor, tmp_path: Path):
    arm, cell = tmp_path / "arm.robot.yaml", tmp_path / "cell.robot.yaml"
    arm.write_text("linkforge: 1\nname: arm\nlinks: {base: {}}\n")
    editor.open(arm)
    editor.open(cell, "linkforge: 1\nname: cell\nlinks: {world: {}}\nmodules: {left: {use: arm.robot.yaml}}\n")
    assert editor.diagnostics(arm) == []
    assert editor.diagnostics(cell)
    joint = "joints: {j: {type: fixed, parent: ¦}}\n"
    assert labels_at(editor, arm, arm.read_text() + joint) == ["base"]
    assert labels_at(editor, cell, f"linkforge: 1\nname: cell\n{joint}") == ["world", "left_base"]


def test_arguments_of_a_xacro_are_offered(editor: Editor, tmp_path: Path):
    xacro = (
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm"><xacro:arg name="reach" default="1"/></robot>'
    )
    (tmp_path / "arm.xacro").write_text(xacro)
    cell = tmp_path / "cell.robot.yaml"
    text = "linkforge: 1\nname: cell\nmodules:\n  arm:\n    use: arm.xacro\n    with: {¦}\n"
    editor.open(cell, text.replace("¦", ""))
    editor.diagnostics(cell)
    assert labels_at(editor, cell, text) == ["reach"]


def test_macros_of_a_xacro_are_offered_and_their_parameters(editor: Editor, tmp_path: Path):
    root = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
    macro = '<xacro:macro name="{}" params="{}"><link name="l"/></xacro:macro>'
    (tmp_path / "parts.xacro").write_text(
        root.format(macro.format("lidar", "radius:=1") + macro.format("wheel", "name"))
    )
    cell = tmp_path / "cell.robot.yaml"
    entry = "linkforge: 1\nname: cell\nmodules:\n  arm:\n    use: parts.xacro\n    macro: {}"
    editor.open(cell, entry.format("lidar\n"))
    editor.diagnostics(cell)
    assert labels_at(editor, cell, entry.format("¦\n")) == ["lidar", "wheel"]
    assert labels_at(editor, cell, entry.format("lidar\n    with: {¦}\n")) == ["radius"]


@pytest.mark.parametrize(
    ("marked", "offered"),
    [
        ("semantic: {disabled_collisions: {base: {¦}}}", "palm finger thumb"),
        ("semantic: {enabled_collisions: {base: {¦}}}", "palm finger thumb"),
        ("semantic: {groups: {inner: {subgroups: [¦]}}}", "rest"),
        ("semantic: {groups: {outer: {subgroups: [¦]}}}", "inner rest"),
        ("semantic: {group_states: {inner: {home: {¦}}}}", "curl"),
        ("semantic: {end_effectors: {hand: {group: inner, parent_group: ¦}}}", "outer rest"),
        ("joints: {pinch: {mimic: {joint: ¦}}}", "curl"),
        ("joints: {curl: {mimic: {joint: ¦}}}", ""),
    ],
)
def test_names_that_check_refuses_are_not_offered(editor: Editor, tmp_path: Path, marked: str, offered: str):
    file = tmp_path / "hand.robot.yaml"
    joint = "type: revolute, parent: palm, limits: {lower: -1, upper: 1, effort: 1, velocity: 1}, axis: x"
    joints = [
        "weld: {type: fixed, parent: base, child: palm}",
        f"curl: {{{joint}, child: finger}}",
        f"pinch: {{{joint}, child: thumb, mimic: {{joint: curl}}}}",
    ]
    whole = {
        "links": "links: {base: {}, palm: {}, finger: {}, thumb: {}}",
        "joints": f"joints: {{{', '.join(joints)}}}",
        "semantic": "semantic: {groups: {inner: {joints: [curl]}, outer: {subgroups: [inner]}, rest: {links: [palm]}}}",
    }
    header = "linkforge: 1\nname: hand\n"
    editor.open(file, header + "\n".join(whole.values()))
    editor.diagnostics(file)
    text = header + "\n".join({**whole, marked.partition(":")[0]: marked}.values())
    names = ["base", "palm", "finger", "thumb", "weld", "curl", "pinch", "inner", "outer", "rest"]
    assert [label for label in labels_at(editor, file, text) if label in names] == offered.split()


def test_of_a_macros_parameters_those_that_a_field_gives_come_last(editor: Editor, tmp_path: Path):
    (tmp_path / "parts.xacro").write_text(
        """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
        <xacro:macro name="lidar" params="prefix parent *origin radius:=1 topic"><link name="${prefix}l"/>
        <joint name="${prefix}j" type="fixed"><xacro:insert_block name="origin"/><parent link="${parent}"/>
        <child link="${prefix}l"/></joint></xacro:macro></robot>"""
    )
    cell = tmp_path / "cell.robot.yaml"
    entry = "linkforge: 1\nname: cell\nmodules:\n  arm:\n    use: parts.xacro\n    macro: lidar\n"
    editor.open(cell, entry)
    editor.diagnostics(cell)
    items = completions(editor, cell, *split_at_cursor(entry + "    with: {¦}\n"))
    in_order = [item.label for item in sorted(items, key=lambda item: item.sort_text or "")]
    assert in_order[:2] == ["topic", "radius"]
    assert {*in_order[2:]} == {"prefix", "parent", "origin"}


def test_files_outside_of_what_a_spec_may_read_are_not_offered(editor: Editor, tmp_path: Path):
    (tmp_path / "rest" / "secret").mkdir(parents=True)
    (tmp_path / "robot" / "meshes").mkdir(parents=True)
    (tmp_path / "robot" / "package.xml").write_text("<package><name>arm</name></package>")
    (tmp_path / "robot" / "meshes" / "hand.stl").write_bytes(b"")
    (tmp_path / "robot" / "link").symlink_to(tmp_path / "rest")
    file = tmp_path / "robot" / "arm.robot.yaml"
    text = "linkforge: 1\nname: arm\nlinks: {hand: {visual: {mesh: ¦}}}\n"
    assert labels_at(editor, file, text) == ["meshes/", "package://"]
    assert labels_at(editor, file, text.replace("¦", "../¦")) == []
    assert labels_at(editor, file, text.replace("¦", "link/¦")) == []
    assert labels_at(editor, file, text.replace("¦", "/¦")) == []
    assert labels_at(editor, file, text.replace("¦", "meshes/¦")) == ["hand.stl"]
    assert "arm/" in labels_at(editor, file, text.replace("¦", "package://¦"))
    assert labels_at(editor, file, text.replace("¦", "package://arm/meshes/¦")) == ["hand.stl"]


@pytest.mark.parametrize(
    "text", ["¦", "¦\n", "# a ¦ comment", "{¦", "[¦", '"¦', "links: {a: $(¦", "- ¦", "a: |\n  text ¦", "\ufeffname: ¦"]
)
def test_a_strange_text_has_completions_or_none(text: str, editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    labels_at(editor, file, text)
    assert "links" in labels_at(editor, file, "¦")


def test_a_position_beyond_the_text_and_a_closed_document_end_nothing(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    document = editor.open(file, "linkforge: 1\n")
    beyond = types.CompletionParams(document, types.Position(1000, 1000))
    assert isinstance(editor.ask(lambda client: client.text_document_completion_async(beyond)), types.CompletionList)
    editor.close(file)
    assert editor.ask(lambda client: client.text_document_completion_async(beyond)) is None


def test_a_text_that_was_never_readable_has_completions(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    text = "linkforge: 1\nname: [arm\nparameters: {reach: 1 m}\nlinks: {base: {}}\nframes: {tool: {parent: base}}\n"
    assert labels_at(editor, file, text + "joints:\n  j: {parent: ¦}\nmaterials: ]\n") == ["base", "tool"]
    assert "reach" in labels_at(editor, file, text + "joints:\n  j: {origin: [0, 0, $(¦)]}\nmaterials: ]\n")


def test_an_include_offers_files_and_no_packages(editor: Editor, tmp_path: Path):
    (tmp_path / "palette.yaml").write_text("materials: {}\n")
    text = "linkforge: 1\nname: arm\ninclude: [¦]\n"
    assert labels_at(editor, tmp_path / "arm.robot.yaml", text) == ["palette.yaml"]


def test_a_part_has_the_names_and_parameters_of_the_spec_that_includes_it(editor: Editor, tmp_path: Path):
    part, whole = tmp_path / "joints.robot.yaml", tmp_path / "arm.robot.yaml"
    whole.write_text(
        "linkforge: 1\nname: arm\ninclude: [joints.robot.yaml]\nparameters: {reach: 1 m}\nlinks: {base: {}}\n"
    )
    text = "linkforge: 1\nvariables: {half: $(reach / 2)}\njoints: {j: {type: fixed, parent: ¦}}\n"
    editor.open(whole)
    editor.open(part, text.replace("¦", "base"))
    editor.diagnostics(part)
    assert labels_at(editor, part, text) == ["base"]
    assert {"reach", "half"} <= set(labels_at(editor, part, text.replace("¦", "$(¦)")))


def test_items_of_a_block_list_are_names_that_it_does_not_have(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    text = "linkforge: 1\nname: arm\nlinks: {base: {}, tip: {}}\nsemantic:\n  groups:\n    arm:\n"
    text += "      links:\n      - base\n"
    assert labels_at(editor, file, text + "      - ¦\n")[:1] == ["tip"]
    assert "base" not in labels_at(editor, file, text + "      - ¦\n")


@pytest.mark.parametrize(
    ("value", "offered"),
    [("child: ¦", "palm thumb"), ("mimic: {joint: ¦}", "curl"), ("type: ¦", "revolute")],
)
def test_values_of_an_override_are_names_of_the_module(tmp_path: Path, value: str, offered: str):
    joint = (
        "knuckle: {type: continuous, parent: palm, child: thumb}, curl: {type: continuous, parent: thumb, child: tip}"
    )
    links = "links: {palm: {}, thumb: {}, tip: {}}"
    (tmp_path / "hand.robot.yaml").write_text(f"linkforge: 1\nname: hand\n{links}\njoints: {{{joint}}}\n")
    path, use = tmp_path / "cell.robot.yaml", "use: hand.robot.yaml, parent: world"
    saved = f"linkforge: 1\nname: cell\nlinks: {{world: {{}}}}\nmodules: {{h: {{{use}}}}}\n"
    text, position = split_at_cursor(
        saved.replace("world}", f"world, override: {{joints: {{knuckle: {{{value}}}}}}}}}")
    )
    with Editor(tmp_path) as editor:
        editor.open(path, saved)
        editor.diagnostics(path)
        labels = [item.label for item in completions(editor, path, text, position)]
    assert set(offered.split()) <= set(labels), labels
    assert not {"forearm", "left_finger", "world"} & set(labels), labels


def test_a_state_offers_the_joints_of_its_group(editor: Editor, tmp_path: Path):
    links = "".join(f"  l{number}: {{}}\n" for number in range(5))
    joints = "".join(
        f"  {name}: {{type: continuous, parent: l{number}, child: l{number + 1}}}\n"
        for number, name in enumerate("abcd")
    )
    groups = "groups: {arm: {chains: [{base_link: l2, tip_link: l4}]}}"
    semantic = f"semantic:\n  {groups}\n  group_states:\n    arm: {{up: {{¦}}}}\n"
    text = f"linkforge: 1\nname: r\nlinks:\n{links}joints:\n{joints}{semantic}"
    file = tmp_path / "r.robot.yaml"
    editor.open(file, text.replace("¦", ""))
    editor.diagnostics(file)
    assert [label for label in labels_at(editor, file, text) if label in "abcd"] == ["c", "d"]


def test_a_joint_offers_links_with_which_the_robot_stays_a_tree(editor: Editor, tmp_path: Path):
    """Neither its own child, nor what is below that, nor a link that another joint has as its child."""
    joints = "joints:\n  a: {type: fixed, parent: one, child: two}\n  b: {type: fixed, parent: two, child: three}\n"
    text = f"linkforge: 1\nname: r\nlinks: {{one: , two: , three: , four: }}\n{joints}"
    file = tmp_path / "r.robot.yaml"
    editor.open(file, text)
    editor.diagnostics(file)
    assert labels_at(editor, file, text.replace("parent: one", "parent: ¦")) == ["one", "four"]
    assert labels_at(editor, file, text.replace("child: two", "child: ¦")) == ["two", "four"]
    assert labels_at(editor, file, text + "  c: {type: fixed, parent: three, child: ¦}\n") == ["one", "four"]


@pytest.mark.parametrize("value", ["$(¦)", "$(r¦"])
def test_a_value_that_is_being_written_is_not_shown(editor: Editor, tmp_path: Path, value: str):
    text, at = split_at_cursor(
        f"linkforge: 1\nname: arm\nvariables:\n  reach: 1 m\n  half: {value}\nlinks: {{base: {{}}}}\n"
    )
    found = {item.label: item.detail for item in completions(editor, tmp_path / "arm.robot.yaml", text, at)}
    assert (found["reach"], found["half"]) == ("variable: 1 m", "variable")


def test_arguments_have_no_example_of_another_module(editor: Editor, tmp_path: Path):
    hand = "linkforge: 1\nname: hand\nparameters: {grip: 1 N}\nlinks: {palm: {}}\n"
    (tmp_path / "hand.robot.yaml").write_text(hand)
    file, text = tmp_path / "arm.robot.yaml", "linkforge: 1\nname: arm\nlinks: {base: {}}\n"
    text += "modules: {h: {use: hand.robot.yaml, parent: base, with: {¦}}}\n"
    editor.open(file, text.replace("¦", ""))
    editor.diagnostics(file)
    assert labels_at(editor, file, text) == ["grip"]


def test_a_list_is_incomplete_until_the_first_analysis(tmp_path: Path):
    path, text = tmp_path / "arm.robot.yaml", "linkforge: 1\nname: arm\nlinks: {base: {}}\n"
    specs = Workspace()
    specs.put(path, 1, text)
    for is_incomplete in (True, False):
        document = specs.document(path, Columns(PositionCodec()))
        assert document is not None
        found = complete(document, types.Position(3, 0), specs.settings(), Client())
        assert found.is_incomplete is is_incomplete
        assert "joints" in [item.label for item in found.items]
        specs.keep(path, analyse_path(path, specs.begin(path)))
