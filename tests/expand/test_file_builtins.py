"""`prefix`, `link()`, `joint()` and `path()`: what a file's expressions know of the file and its use."""

from pathlib import Path

import pytest

from linkforge_compile import compile_file
from linkforge_compile.expand.instance import Instance
from tests.expand.assembling import assemble, metadata_of, write


def module(instance: Instance, *names: str) -> Instance:
    for name in names:
        (instance,) = (one for one in instance.modules if one.name == name)
    return instance


@pytest.fixture
def arms(tmp_path: Path) -> Path:
    write(
        tmp_path,
        {
            "robot.robot.yaml": """
                links: {base: }
                metadata: {own: $(prefix), all: "$(link('left_hand_palm')) $(joint('left_hinge'))"}
                modules:
                  left: {use: arm.robot.yaml, parent: base}
                  right: {use: arm.robot.yaml, parent: base, prefix: r-}
            """,
            "arm.robot.yaml": """
                links: {base: , tip: }
                joints: {hinge: {type: fixed, parent: base, child: tip}}
                metadata: {own: "<$(prefix)>", tip: $(link('tip')), hinge: "joint $(joint('hinge'))"}
                modules: {hand: {use: hand.robot.yaml, parent: tip}}
            """,
            "hand.robot.yaml": """
                links: {palm: }
                metadata: {own: "<$(prefix)>", palm: $(link('palm'))}
            """,
        },
    )
    return tmp_path


def test_the_prefix_is_the_whole_of_it(arms: Path):
    found = assemble((arms / "robot.robot.yaml").read_text().partition("\n")[2].partition("\n")[2], folder=arms)
    assert found.messages == []
    assert found.metadata == {"own": "", "all": "left_hand_palm left_hinge"}
    assert metadata_of(module(found.instance, "left")) == {
        "own": "<left_>",
        "tip": "left_tip",
        "hinge": "joint left_hinge",
    }
    assert metadata_of(module(found.instance, "right", "hand")) == {"own": "<r-hand_>", "palm": "r-hand_palm"}


def test_a_missing_name_is_reported_once_with_any_prefix(arms: Path):
    hand = arms / "hand.robot.yaml"
    hand.write_text(hand.read_text().replace("link('palm')", "link('plam')"))
    assert [str(one).partition(": ")[2] for one in compile_file(arms / "robot.robot.yaml").diagnostics] == [
        "error: no link named 'plam'; did you mean 'palm'? [LF4102]"
    ]


def test_a_path_is_absolute_and_belongs_to_the_file_that_writes_it(tmp_path: Path):
    write(
        tmp_path,
        {
            "robot.robot.yaml": """
                packages: {tables: data}
                modules:
                  arm: {use: arms/arm.robot.yaml, with: {config: "$(path('package://tables/config.yaml'))"}}
            """,
            "arms/arm.robot.yaml": """
                parameters: {config: {type: string}}
                metadata: {config: $(config), own: "$(path('own.yaml'))"}
            """,
        },
    )
    (tmp_path / "data").mkdir()
    compilation = compile_file(tmp_path / "robot.robot.yaml")
    assert [(one.code.id, one.span.file.path.name) for one in compilation.diagnostics if one.code.id != "LF5401"] == [
        ("LF3092", "arm.robot.yaml")
    ]
    found = assemble((tmp_path / "robot.robot.yaml").read_text().partition("\n")[2].partition("\n")[2], folder=tmp_path)
    assert metadata_of(module(found.instance, "arm")) == {
        "config": str(tmp_path / "data/config.yaml"),
        "own": str(tmp_path / "arms/own.yaml"),
    }


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("metadata: {a: \"$(path('package://nowhere/x'))\"}", "no package named 'nowhere'"),
        ("metadata: {a: \"$(path('https://x/y'))\"}", "'https://x/y' cannot be found"),
        ("variables: {p: $(prefix)}\nlinks: {base: {visual: {box: [1, 1, '$(path(1))']}}}", "path() takes text"),
        ('links: {"$(prefix)base": }', "'$(prefix)base' gets the prefix automatically"),
        ("modules: {arm: {use: a.robot.yaml, prefix: $(prefix)a_}}", "'prefix' gets the prefix automatically"),
        ("modules: {arm: {use: a.robot.yaml, with: {a: $(link('x'))}}}", "link() is allowed only in free parts"),
        ("parameters: {a: {default: $(joint('x'))}}", "joint() is allowed only in free parts"),
        ("links: {a_$(x): {for: {x: $(link('x'))}}}", "link() is allowed only in free parts"),
        (
            "semantic: {passive_joints: [{for: {i: 1}, value: $(prefix)$(i)}]}",
            "'value' gets the prefix automatically",
        ),
        (
            "packages: {a: \"$(path('package://b/c'))\"}\nmetadata: {a: \"$(path('package://a/x'))\"}",
            "no package named",
        ),
    ],
)
def test_misplaced_expressions_are_reported(tmp_path: Path, text: str, expected: str):
    write(tmp_path, {"a.robot.yaml": "parameters: {a: {type: string, default: a}}\n"})
    assert any(one.startswith(expected) for one in assemble(text, folder=tmp_path).messages)


def test_prefix_in_text_of_a_person_is_nothing_special():
    found = assemble("metadata: {a: 'the prefix: $(1 + 1)', b: the $$(prefix)}\n")
    assert (found.messages, found.metadata) == ([], {"a": "the prefix: 2", "b": "the $(prefix)"})


def test_what_an_override_writes_has_the_names_of_its_own_file_and_what_it_deletes_asks_for_none(tmp_path: Path):
    plugin = "gazebo: {plugins: {p: {filename: l.so, parameters: {gone: $(link('no')), other: $(link('none'))}}}}"
    override = "{gazebo: {plugins: {p: {parameters: {gone: null, other: $(link('tip')), more: $(link('arm_tip'))}}}}}"
    arm = "links: {root: , tip: }\njoints: {hinge: {type: fixed, parent: root, child: tip}}\n"
    write(
        tmp_path,
        {
            "arm.robot.yaml": arm + plugin,
            "robot.robot.yaml": "links: {tip: }\n"
            f"modules: {{arm: {{use: arm.robot.yaml, parent: tip, override: {override}}}}}",
        },
    )
    compilation = compile_file(tmp_path / "robot.robot.yaml")
    assert compilation.diagnostics == ()
    [block] = compilation.result().gazebo_elements
    assert block.plugins[0].parameters == {"other": "tip", "more": "arm_tip"}
