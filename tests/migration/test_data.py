"""Data of YAML files."""

from pathlib import Path

from tests.migration.migrated import migrated

LIMITS = """\
elbow: {upper: 1.5}
elbow: {upper: 2.5}
wrist: {upper: 0.5, note: "$(none)"}
"""


def test_data_that_a_spec_cannot_read_becomes_a_variable_that_is_a_map(tmp_path: Path):
    (tmp_path / "limits.yaml").write_text(LIMITS, "utf-8")
    text = """
<xacro:property name="limits" value="${xacro.load_yaml('limits.yaml')}"/>
<link name="base"/>
<link name="arm"/>
<joint name="elbow" type="revolute">
  <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
  <limit lower="0" upper="${limits['elbow']['upper']}" effort="1" velocity="1"/>
</joint>
"""
    made = migrated(tmp_path, text)
    assert (
        """\
variables:
  # from ../limits.yaml, which a spec does not read as it is
  limits: {elbow: {upper: 2.5}, wrist: {upper: 0.5, note: $$(none)}}
"""
        in made.robot
    )
    assert "upper: $(limits.elbow.upper)" in made.robot
