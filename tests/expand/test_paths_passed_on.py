"""Paths among the parameters, where they are passed on as text: written as the compiled file would."""

import pytest

from linkforge_compile import compile_file
from tests.expand.assembling import assemble, metadata_of, write

ARM = """
    parameters: {config: {type: file}, gains: {type: file, default: gains.yaml}, folder: {type: file, default: conf}}
    variables: {both: {own: $(gains), inside: "$(folder)/a.yaml"}, sum: $(folder + '/b.yaml')}
"""


def test_a_path_in_a_part_that_is_passed_on_is_relative_to_the_compiled_file(tmp_path):
    arm = f"""{ARM}
    links: {{base: }}
    extra: <config>$(config)</config>
    extra_attributes: {{gains: $(gains)}}
    gazebo:
      plugins:
        control:
          filename: lib.so
          parameters:
            file: [$(gains), $(both.inside), $(sum), --params=$(gains)]
            map: $(both)
            at: $(path(gains))
    """
    write(tmp_path, {"arms/arm.robot.yaml": arm})
    use = "use: arms/arm.robot.yaml, parent: base, with: {config: own/c.yaml}"
    write(tmp_path, {"robot.robot.yaml": f"links: {{base: }}\nmodules: {{arm: {{{use}}}}}"})
    robot = compile_file(tmp_path / "robot.robot.yaml").result()
    [plugin] = [plugin for block in robot.gazebo_elements for plugin in block.plugins]
    assert plugin.parameters == {
        "file": ("arms/gains.yaml", "arms/conf/a.yaml", "arms/conf/b.yaml", "--params=arms/gains.yaml"),
        "map": {"own": "arms/gains.yaml", "inside": "arms/conf/a.yaml"},
        "at": str(tmp_path / "arms" / "gains.yaml"),
    }
    assert robot.extra_elements == ("<config>own/c.yaml</config>",)
    assert robot.extra_attributes == (("gains", "arms/gains.yaml"),)


def test_it_is_so_through_an_include_and_through_the_text_of_another_module(tmp_path):
    write(
        tmp_path,
        {
            "arms/arm.robot.yaml": f"""{ARM}
    links: {{base: }}
    include: [parts/control.yaml]
    modules: {{hand: {{use: ../hands/hand.robot.yaml, parent: base, with: {{text: $(gains)}}}}}}
    """,
            "hands/hand.robot.yaml": "parameters: {text: {type: string}}\nlinks: {palm: }\nmetadata: {text: $(text)}",
        },
    )
    control = "linkforge: 1\nmetadata: {gains: $(gains), config: $(config), sum: $(sum)}\n"
    (tmp_path / "arms" / "parts").mkdir()
    (tmp_path / "arms" / "parts" / "control.yaml").write_text(control)
    use = "{use: arms/arm.robot.yaml, with: {config: package://tables/c.yaml}}"
    found = assemble(f"modules: {{arm: {use}}}", folder=tmp_path)
    assert found.messages == []
    [arm] = found.instance.modules
    paths = {"gains": "arms/gains.yaml", "config": "package://tables/c.yaml", "sum": "arms/conf/b.yaml"}
    assert metadata_of(arm) == paths
    assert metadata_of(arm.modules[0]) == {"text": "arms/gains.yaml"}


def test_an_expression_sees_the_path_as_it_was_written(tmp_path):
    module = """
        parameters: {table: {type: file, default: small.yaml}}
        variables: {is_small: $(table == 'small.yaml'), read: $(content.mass)}
        data: {content: $(table)}
        metadata: {is_small: $(is_small), mass: $(read), length: $(len(table))}
    """
    write(tmp_path, {"arms/arm.robot.yaml": module})
    (tmp_path / "arms" / "small.yaml").write_text("mass: 3\n")
    found = assemble("modules: {arm: {use: arms/arm.robot.yaml}}", folder=tmp_path)
    assert found.messages == []
    assert metadata_of(found.instance.modules[0]) == {"is_small": True, "mass": 3, "length": 10}


def test_text_that_grows_by_the_way_to_a_file_is_bounded(tmp_path):
    far = "/".join(["a" * 100] * 10)
    doubled = ", ".join(f"x{n}: $(x{n - 1})$(x{n - 1})" for n in range(1, 10))
    module = (
        f"parameters: {{p: {{type: file, default: q}}}}\nvariables: {{x0: $(p), {doubled}}}\nmetadata: {{x: $(x9)}}"
    )
    write(tmp_path, {f"{far}/arm.robot.yaml": module})
    found = assemble(f"modules: {{arm: {{use: {far}/arm.robot.yaml}}}}", folder=tmp_path)
    assert found.messages == ["the text grows beyond 65,536 characters"]


def test_it_is_so_in_the_free_parts_of_a_whole_object_that_one_expression_gives(tmp_path):
    arm = """
    parameters: {gains: {type: file, default: gains.yaml}}
    variables:
      plugin: {filename: lib.so, parameters: {file: "$(gains)", all: ["$(gains)"]}}
      block: {plugins: {second: $(plugin)}}
    links: {base: {gazebo: $(block)}}
    gazebo: {plugins: {first: $(plugin)}}
    """
    write(tmp_path, {"arms/arm.robot.yaml": arm, "robot.robot.yaml": "modules: {arm: {use: arms/arm.robot.yaml}}"})
    robot = compile_file(tmp_path / "robot.robot.yaml").result()
    plugins = [plugin for block in robot.gazebo_elements for plugin in block.plugins]
    assert [plugin.name for plugin in plugins] == ["arm_second", "arm_first"]
    for plugin in plugins:
        assert plugin.parameters == {"file": "arms/gains.yaml", "all": ("arms/gains.yaml",)}


def test_a_mesh_that_a_variable_names_is_where_the_file_that_writes_it_lies(tmp_path):
    main = """
    include: [parts/shapes.yaml]
    parameters: {given: {type: file, default: meshes/b.stl}}
    variables: {named: meshes/a.stl}
    links: {base: }
    """
    write(tmp_path, {"arms/arm.robot.yaml": main, "robot.robot.yaml": "modules: {arm: {use: arms/arm.robot.yaml}}"})
    (tmp_path / "arms" / "parts").mkdir()
    shapes = "[{mesh: $(named)}, {mesh: $(given)}, {mesh: c.stl}, {mesh: {file: $(own)}}]"
    (tmp_path / "arms" / "parts" / "shapes.yaml").write_text(
        f"linkforge: 1\nvariables: {{own: d.stl}}\nlinks: {{body: {{visual: {shapes}}}}}\n"
        "joints: {j: {type: fixed, parent: base, child: body}}\n"
    )
    robot = compile_file(tmp_path / "robot.robot.yaml").result()
    assert [visual.geometry.resource for visual in robot.link("arm_body").visuals] == [
        "arms/meshes/a.stl",
        "arms/meshes/b.stl",
        "arms/parts/c.stl",
        "arms/parts/d.stl",
    ]


@pytest.mark.parametrize("kind", ["file", "string"])
def test_a_package_that_is_handed_on_is_one_of_the_file_that_hands_it_on(tmp_path, kind: str):
    module = (
        f"parameters: {{table: {{type: {kind}}}}}\ndata: {{content: $(table)}}\nmetadata: {{mass: $(content.mass)}}"
    )
    between = f"""
        parameters: {{table: {{type: {kind}}}}}
        packages: {{other: .}}
        modules: {{hand: {{use: hand.robot.yaml, with: {{table: $(table)}}}}}}
    """
    write(tmp_path, {"arms/hand.robot.yaml": module, "arms/arm.robot.yaml": between})
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "masses.yaml").write_text("mass: 3\n")
    use = "packages: {mine: tables}\nmodules: {arm: {use: arms/arm.robot.yaml, with: {table: package://mine/masses.yaml}}}"
    found = assemble(use, folder=tmp_path)
    assert found.messages == []
    assert metadata_of(found.instance.modules[0].modules[0]) == {"mass": 3}


def test_a_module_s_own_package_comes_before_its_user_s(tmp_path):
    write(
        tmp_path, {"arms/arm.robot.yaml": "packages: {p: tables}\ndata: {d: package://p/d.yaml}\nmetadata: {d: $(d.d)}"}
    )
    for folder, value in (("arms/tables", 1), ("tables", 2)):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "d.yaml").write_text(f"d: {value}\n")
    found = assemble("packages: {p: tables}\nmodules: {arm: {use: arms/arm.robot.yaml}}", folder=tmp_path)
    assert metadata_of(found.instance.modules[0]) == {"d": 1}


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        (
            "string",
            "arms/gone.yaml: a path in text starts at the file that uses it; "
            "declare 'type: file' for one that starts where it is written",
        ),
        ("file", "gone.yaml"),
    ],
)
def test_a_missing_file_is_reported_with_the_start_of_its_path(tmp_path, monkeypatch, kind: str, expected: str):
    monkeypatch.chdir(tmp_path)
    write(tmp_path, {"arms/arm.robot.yaml": f"parameters: {{t: {{type: {kind}}}}}\ndata: {{d: $(t)}}\nlinks: {{a: }}"})
    write(tmp_path, {"robot.robot.yaml": "modules: {arm: {use: arms/arm.robot.yaml, with: {t: gone.yaml}}}"})
    (fault,) = compile_file("robot.robot.yaml").diagnostics
    assert fault.code.id == "LF3001"
    message = fault.notes[0].message
    assert message == f"looked for it at {expected}"


def test_a_default_outside_the_package_of_its_module_is_reported(tmp_path):
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared" / "shape.yaml").write_text(
        "linkforge: 1\nparameters: {shape: {type: file, default: cube.obj}}\n"
    )
    write(tmp_path, {"hands/hand.robot.yaml": "include: [../shared/shape.yaml]\nmetadata: {shape: $(shape)}"})
    found = assemble(
        "packages: {hands: hands}\nmodules: {hand: {use: package://hands/hand.robot.yaml}}", folder=tmp_path
    )
    assert found.messages == [
        "'cube.obj' is outside the module's package, so its absolute path ties the output to this machine; "
        "write 'package://NAME/PATH'"
    ]
