"""What URDF readers refuse is an error when a URDF is compiled; urdfdom itself decides what that is."""

import pytest

from linkforge_compile import check_text, compile_text, render_urdf
from linkforge_compile.diagnostics import Severity
from tests.consumers import check_urdf, pinocchio_model

_LIMIT = '<limit lower="0" upper="1" effort="1" velocity="1"/>'
_INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'


def _joint(inside: str = "", kind: str = "fixed", ends: str = '<parent link="a"/><child link="b"/>') -> str:
    return f'<link name="a"/><link name="b"/><joint name="j" type="{kind}">{ends}{inside}</joint>'


def _box(size: str) -> str:
    return f'<link name="a"><visual><geometry><box size="{size}"/></geometry></visual></link>'


@pytest.mark.parametrize(
    "parts",
    [
        '<link name="a"/><link name="a"/>',
        '<material name="m"><color rgba="1 1 1 1"/></material>' * 2 + '<link name="a"/>',
        _joint() + '<link name="c"/><joint name="j" type="fixed"><parent link="a"/><child link="c"/></joint>',
        _joint(kind="Fixed"),
        _joint(ends='<child link="b"/>'),
        _joint(ends='<parent/><child link="b"/>'),
        _joint('<origin rpy="0 0"/>'),
        _joint(f'<axis xyz="0,0,1"/>{_LIMIT}', "revolute"),
        _joint('<limit lower="-pi" upper="1" effort="1" velocity="1"/>'),
        _joint('<limit effort="1"/>'),
        _joint("<safety_controller/>", "floating"),
        _box("1 1"),
        _box("1,1,1"),
        f'<link name="a"><inertial><mass value="4,5"/>{_INERTIA}</inertial></link>',
        f'<link name="a"><inertial><mass value="1e999"/>{_INERTIA}</inertial></link>',
        '<link name="a"><collision/></link>',
        '<link name="a"><collision><geometry/></collision></link>',
    ],
)
def test_what_urdfdom_complains_of_is_an_error(parts: str):
    text = f'<robot name="r">{parts}</robot>'
    with pytest.raises(AssertionError, match="Error"):
        check_urdf(text)
    assert check_text(text).has_errors


@pytest.mark.parametrize(
    "parts",
    [
        _joint('<axis xyz="0 0"/>'),
        _joint("<origin/><origin xyz='1'/>"),
        _joint(f'{_LIMIT}<limit lower="x"/>'),
        _box("-1 1 1"),
        '<link name="a"/><gazebo><link name="a"/><joint/></gazebo>',
        '<link name="a"/><transmission name="t"><joint name="x"/></transmission>',
    ],
)
def test_what_urdfdom_never_reads_is_none(parts: str):
    text = f'<robot name="r">{parts}</robot>'
    assert check_urdf(text) == "a"
    assert not check_text(text).has_errors


def test_the_child_of_a_joint_at_fault_is_no_second_root():
    diagnostics = check_text(f'<robot name="r">{_joint(kind="revolut")}</robot>').diagnostics
    assert [one.code.id for one in diagnostics] == ["LF8161"]


def test_limits_that_vendors_leave_open_are_raw():
    """Older versions of urdfdom take them, and MuJoCo does."""
    limited = _joint('<axis xyz="0 0 1"/><limit effort="inf" velocity="1"/>', "continuous")
    compilation = compile_text(f'<robot name="r">{limited}</robot>')
    assert [one.code.id for one in compilation.diagnostics] == ["LF8021"]


def test_a_scale_that_readers_cannot_read_is_a_warning():
    """It costs urdfdom the shape, and not the robot, as it is for raw XML."""
    mesh = '<mesh filename="a.stl" scale="1 1 1 1"/>'
    text = f'<robot name="r"><link name="a"><visual><geometry>{mesh}</geometry></visual></link></robot>'
    compilation = check_text(text)
    assert [one.code.id for one in compilation.diagnostics if one.severity is Severity.WARNING] == ["LF8021"]
    assert pinocchio_model(render_urdf(compilation.result())).nbodies == 1
