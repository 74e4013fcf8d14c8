"""`when` and `for` in what plugins and hardware read, and what of it is a plugin's own."""

import re

import pytest

from linkforge_compile import compile_file, compile_text, import_urdf, render_urdf

HEAD = "linkforge: 1\nname: r\nparameters: {real: false, n: 2}\nlinks: {base: }\n"


def written(yaml: str) -> str:
    """Return what a plugin's parameters become, on one line."""
    spec = f"{HEAD}gazebo: {{plugins: {{p: {{filename: p.so, parameters: {yaml}}}}}}}\n"
    urdf = render_urdf(compile_text(spec).result())
    return re.sub(r"\s*\n\s*", "", urdf.partition('filename="p.so"')[2].partition("</plugin>")[0]).removeprefix(">")


@pytest.mark.parametrize(
    ("yaml", "xml"),
    [
        ("{led: {when: $(real), color: red}, on: 1}", "<on>1</on>"),
        ("{led: {when: $(not real), color: red}}", "<led><color>red</color></led>"),
        ("{led: {when: false}, on: 1}", "<on>1</on>"),
        ("{rate: {when: $(not real), value: 1.10}}", "<rate>1.10</rate>"),
        ("{led: {when: true, value: 1, unit: m}}", "<led><value>1</value><unit>m</unit></led>"),
        ("{joint: {for: {i: $(n)}, value: j_$(i)}}", "<joint>j_0</joint><joint>j_1</joint>"),
        ("{joint: {for: {i: 0}, value: j_$(i)}, on: 1}", "<on>1</on>"),
        ("{gain_$(i): {for: {i: 2}, when: $(i > 0), value: $(i)}}", "<gain_1>1</gain_1>"),
        ("{a: [{for: {i: 2}, b: $(i)}, {when: $(real), b: 3}, c]}", "<a><b>0</b></a><a><b>1</b></a><a>c</a>"),
        ("{a: {b: {c: {when: $(real), value: 1}, d: 2}}}", "<a><b><d>2</d></b></a>"),
        ("{when: $(real), a: 1}", "/></gazebo></robot>"),
    ],
)
def test_they_apply_in_what_a_plugin_reads(yaml: str, xml: str):
    assert written(yaml) == xml


@pytest.mark.parametrize(
    ("yaml", "xml"),
    [
        ("{state: {when: idle, value: 3}}", "<state><when>idle</when><value>3</value></state>"),
        ("{state: {when: 1}}", "<state><when>1</when></state>"),
        ("{state: {when: {_text: true}}}", "<state><when>true</when></state>"),
        ("{state: {when: {_text: $(real)}}}", "<state><when>false</when></state>"),
        ("{loop: {for: ever}}", "<loop><for>ever</for></loop>"),
        ("{loop: {for: [{i: 3}]}}", "<loop><for><i>3</i></for></loop>"),
        ("{value: {value: 3}}", "<value><value>3</value></value>"),
    ],
)
def test_other_values_are_the_plugin_s_own(yaml: str, xml: str):
    assert written(yaml) == xml


@pytest.mark.parametrize(
    ("variable", "parameters", "word"),
    [
        ("{led: {when: $(real), color: red}}", "$(v)", "when"),
        ("{when: $(real), color: red}", "{led: $(v)}", "when"),
        ("{for: {i: 3}, value: 1}", "{led: $(v)}", "for"),
        ("[{when: $(real), a: 3}, 2]", "{led: $(v)}", "when"),
    ],
)
def test_in_the_value_of_an_expression_they_are_refused(variable: str, parameters: str, word: str):
    plugin = f"gazebo: {{plugins: {{p: {{filename: p.so, parameters: {parameters}}}}}}}\n"
    (found,) = compile_text(f"{HEAD}variables: {{v: {variable}}}\n{plugin}").diagnostics
    assert (found.code.id, found.message.split()[0]) == ("LF3208", f"'{word}'")


@pytest.mark.parametrize(
    ("variable", "parameters", "xml"),
    [
        ("{when: idle, value: 3}", "{led: $(v)}", "<led><when>idle</when><value>3</value></led>"),
        ("{state: {when: {_text: true}}}", "$(v)", "<state><when>true</when></state>"),
        ("{for: {i: 3}}", "$(v)", "<for><i>3</i></for>"),
    ],
)
def test_a_plugin_s_own_come_through_a_variable(variable: str, parameters: str, xml: str):
    plugin = f"gazebo: {{plugins: {{p: {{filename: p.so, parameters: {parameters}}}}}}}\n"
    urdf = render_urdf(compile_text(f"{HEAD}variables: {{v: {variable}}}\n{plugin}").result())
    assert xml in re.sub(r"\s*\n\s*", "", urdf)


def test_a_misspelled_condition_is_reported():
    spec = f"{HEAD}gazebo: {{properties: {{led: {{when: no, value: 1}}}}}}\n"
    assert [str(one).partition(": ")[2] for one in compile_text(spec).diagnostics] == [
        "error: 'no' is text in YAML 1.2, not true or false; write false [LF3143]"
    ]


HARDWARE = """\
ros2_control:
  h:
    type: sensor
    hardware_plugin: a/B
    parameters:
      ip: {when: $(not real), value: 10.0}
      port: {when: $(real), value: can0}
      id_$(i): {for: {i: 2}, value: 00$(i)}
      when: true
    sensors:
      s:
        state_interfaces: {a: {min: {when: $(not real), value: -1.0}, max: {when: $(real), value: 1.0}}}
        parameters: {k: {when: true, value: 007}}
"""


def test_they_apply_to_parameters_of_hardware_and_interfaces():
    [control] = compile_text(HEAD + HARDWARE).result().ros2_controls
    assert dict(control.parameters) == {"ip": "10.0", "id_0": "000", "id_1": "001", "when": "true"}
    [sensor] = control.sensors
    assert dict(sensor.parameters) == {"k": "007"}
    assert dict(sensor.state_interfaces[0].parameters) == {"min": "-1.0"}


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("id: {for: {i: 2}, value: 1}", "the key must mention 'i' of its 'for', such as 'id_$(i)'"),
        ("id: {when: false, a: 1}", "'a' is not a key of the long form"),
        ("id: {a: 1}", "'id' takes text, found a map"),
        ("id: {when: true, value: [1]}", "'value' takes text, found a list"),
    ],
)
def test_a_parameter_of_hardware_stays_a_text(entry: str, message: str):
    hardware = HARDWARE.replace("port: {when: $(real), value: can0}", entry)
    assert [one.message.startswith(message) for one in compile_text(HEAD + hardware).diagnostics] == [True]


URDF = """\
<robot name="r">
  <link name="base"/>
  <ros2_control name="h" type="sensor">
    <hardware><plugin>a/B</plugin><param name="when">true</param></hardware>
    <sensor name="s"><state_interface name="a"/></sensor>
  </ros2_control>
  <gazebo><when>false</when><led>1</led></gazebo>
  <gazebo><plugin name="p" filename="p.so"><a>1</a><for><i>3</i></for></plugin></gazebo>
  <gazebo><plugin name="q" filename="q.so"><a><when>false</when></a></plugin></gazebo>
</robot>
"""


def test_elements_of_these_names_come_in_and_are_used_as_they_are(tmp_path):
    (tmp_path / "r.urdf").write_text(URDF, "utf-8")
    (tmp_path / "cell.robot.yaml").write_text(
        "linkforge: 1\nname: r\nlinks: {table: }\nmodules: {r: {use: r.urdf, parent: table, prefix: ''}}\n", "utf-8"
    )
    (tmp_path / "r.robot.yaml").write_text(import_urdf(tmp_path / "r.urdf").text, "utf-8")
    for spec in ("r.robot.yaml", "cell.robot.yaml"):
        urdf = re.sub(r"\s*\n\s*", "", render_urdf(compile_file(tmp_path / spec).result()))
        for element in (
            '<param name="when">true</param>',
            "<when>false</when></gazebo>",
            "<for><i>3</i></for>",
            "<a><when>false</when></a>",
        ):
            assert element in urdf
