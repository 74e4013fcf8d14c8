"""What was not computed keeps its spelling through variables, data and parameters, because plugins read text."""

import re

import pytest

from linkforge_compile import compile_file, compile_text, render_urdf

SPEC = """\
linkforge: 1
name: r
parameters:
  firmware: 1.10
  table: {type: map, default: {rate: 20.0}}
  typed: {type: number, default: 1}
  count: {type: integer, default: 1}
  is_real: {type: boolean, default: false}
variables:
  id: 007
  timeout: 1e6
  enabled: True
  endless: .inf
  copy: $(id)
  both: {id: $(id), list: [1.50, $(timeout)]}
data: {file: table.yaml}
links: {base: }
ros2_control:
  h:
    type: sensor
    hardware_plugin: a/B
    parameters: $(merge(file, table))
    sensors: {s: {state_interfaces: [a]}}
gazebo: {plugins: {p: {filename: p.so, parameters: {value: VALUE}}}}
"""


def written(tmp_path, value: str, **parameters: str) -> str:
    """Return what the plugin reads."""
    spec = tmp_path / "r.robot.yaml"
    spec.write_text(SPEC.replace("VALUE", value), "utf-8")
    (tmp_path / "table.yaml").write_text("gain: 0.50\nsteps: 0100\n", "utf-8")
    urdf = render_urdf(compile_file(spec, parameters=parameters).result())
    return " ".join(re.findall(r"<value>(.*?)</value>", urdf))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("$(firmware)", "1.10"),
        ("$(id)", "007"),
        ("$(copy)", "007"),
        ("$(timeout)", "1e6"),
        ("$(table.rate)", "20.0"),
        ("$(file.gain)", "0.50"),
        ("$(file.steps)", "0100"),
        ("$(both.id)", "007"),
        ("$(both.list)", "1.50 1e6"),
        ("$(id if firmware > 1 else timeout)", "007"),
        ("{for: {i: [0.10, 2.0]}, value: $(i)}", "0.10 2.0"),
        ("'$(merge(table, both).rate)'", "20.0"),
        ("'$(merge(merge(both, table), file).rate)'", "20.0"),
        ("$(enabled)", "True"),
    ],
)
def test_a_value_that_was_not_computed_is_as_written(value: str, text: str, tmp_path):
    assert written(tmp_path, value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("$(firmware * 1)", "1.1"),
        ("v$(firmware)", "v1.1"),
        ("$(str(id))", "7"),
        ("$(enabled and enabled)", "true"),
        ("$(endless)", "inf"),
        ("$(id + 0)", "7"),
        ("$(-id)", "-7"),
        ("$(int(id))", "7"),
        ("$(float(timeout))", "1000000"),
        ("$(table.rate / 2)", "10"),
        ("$(abs(id))", "7"),
        ("'$(round(firmware, 2))'", "1.1"),
    ],
)
def test_a_computed_value_has_its_shortest_text(value: str, text: str, tmp_path):
    assert written(tmp_path, value) == text


def test_parameters_of_hardware_are_as_written(tmp_path):
    spec = tmp_path / "r.robot.yaml"
    written(tmp_path, "1")
    [hardware] = compile_file(spec).result().ros2_controls
    assert dict(hardware.parameters) == {"gain": "0.50", "steps": "0100", "rate": "20.0"}


def test_a_typed_parameter_is_as_typed(tmp_path):
    assert written(tmp_path, "$(typed)", typed="2.50") == "2.50"
    assert written(tmp_path, "$(table.rate)", table="{rate: 5.0}") == "5.0"


def test_a_type_decides_the_spelling_of_whole_numbers_and_truth_values(tmp_path):
    assert written(tmp_path, "$(count)", count="03") == "3"
    assert written(tmp_path, "$(count)", count="3.0") == "3"
    assert written(tmp_path, "$(is_real)", is_real="True") == "true"


@pytest.mark.parametrize("numbers", ["[01, 02, 03]", "[1.0, 2.0, 3.0]", "[1, 2, 3]"])
def test_names_do_not_depend_on_the_spelling_of_numbers(numbers: str):
    robot = compile_text(
        f"""\
linkforge: 1
name: r
links:
  l_0:
  l_$(i): {{for: {{i: {numbers}}}}}
joints:
  j_$(i): {{for: {{i: {numbers}}}, type: fixed, parent: "$('l_' + str(i - 1))", child: l_$(i)}}
"""
    ).result()
    assert [link.name for link in robot.links] == ["l_0", "l_1", "l_2", "l_3"]


def test_fields_that_are_numbers_are_as_before(tmp_path):
    spec = tmp_path / "r.robot.yaml"
    spec.write_text(
        "linkforge: 1\nname: r\nvariables: {m: 1.50, i: 010, s: 1e-1}\n"
        "links: {a: {inertial: {mass: $(m), inertia: {ixx: $(i), iyy: $(i), izz: $(i)}}, collision: {sphere: $(s)}}}\n"
    )
    urdf = render_urdf(compile_file(spec).result())
    assert '<mass value="1.5"/>' in urdf
    assert 'ixx="10"' in urdf
    assert '<sphere radius="0.1"/>' in urdf
