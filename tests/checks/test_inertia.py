import sys

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.checks import check
from linkforge_compile.core import Inertial, InertiaTensor, Link, Robot
from linkforge_compile.core.moments import principal_moments
from linkforge_compile.diagnostics import Severity, UnresolvedNames
from linkforge_compile.formats.render import render_urdf
from tests.checks.robots import body, messages_of, turning

FLAT_PLATE = InertiaTensor(0.001, 0.002, 0.003)
TURNED_ROD = InertiaTensor(1.0, 1.0, 1.9, ixy=0.95)


@pytest.mark.parametrize("inertia", [FLAT_PLATE, TURNED_ROD, InertiaTensor(1e-12, 1e-12, 1e-12)])
def test_what_a_body_can_have_is_fine(inertia: InertiaTensor):
    assert messages_of(Robot("r", links=[body("a", inertia=inertia)])) == []


def test_a_moment_rounded_to_six_digits_is_fine():
    assert messages_of(Robot("r", links=[body("plate", inertia=InertiaTensor(0.123456, 0.234567, 0.3580231))])) == []


@pytest.mark.parametrize(
    ("inertia", "message"),
    [
        (InertiaTensor(0, 0, 0), "LF6001 link 'a' has a mass of 2 kg and an inertia of zero"),
        (InertiaTensor(1, 1, 0), "LF6002 principal moments of inertia of link 'a' must be above 0, found 0 1 1 kg·m²"),
        (
            InertiaTensor(1, 1, 1, ixy=2),
            "LF6002 principal moments of inertia of link 'a' must be above 0, found -1 1 3 kg·m²",
        ),
        (
            InertiaTensor(1, 1, 3),
            "LF6003 one principal moment of inertia of link 'a' exceeds the sum of the others, found 1 1 3 kg·m²",
        ),
    ],
)
def test_what_no_body_can_have_is_a_warning(inertia: InertiaTensor, message: str):
    subject = Robot("r", links=[body("a", 2.0, inertia=inertia)])
    assert messages_of(subject) == [message]
    assert next(check(subject, UnresolvedNames())).severity is Severity.WARNING


@pytest.mark.parametrize(
    ("largest", "code"), [(2.0, []), (2.0000001, []), (2.001, ["LF6007"]), (2.02, ["LF6007"]), (2.03, ["LF6003"])]
)
def test_a_moment_just_above_the_sum_of_the_others_is_noted(largest: float, code: list[str]):
    inertia = InertiaTensor(1, 1, largest)
    assert [one[:6] for one in messages_of(Robot("r", links=[body("a", inertia=inertia)]))] == code


def test_mujoco_refuses_what_is_noted_but_for_the_option_that_the_note_names():
    arm = Link("arm", Inertial(1.0, inertia=InertiaTensor(1, 1, 2.001)))
    text = render_urdf(Robot("r", links=[Link("base"), arm], joints=[turning("j", "base", "arm")]))
    load = pytest.importorskip("mujoco").MjModel.from_xml_string
    with pytest.raises(ValueError, match="balanceinertia"):
        load(text)
    assert load(text.replace("</robot>", '<mujoco><compiler balanceinertia="true"/></mujoco></robot>')).njnt == 1


def test_a_frame_without_mass_may_have_any_tensor():
    assert messages_of(Robot("r", links=[Link("tool0", Inertial(0.0, inertia=InertiaTensor(0, 0, 0)))])) == []


entries = st.floats(-1e6, 1e6) | st.floats(-1e-6, 1e-6) | st.just(0.0)


@given(st.builds(InertiaTensor, *[entries] * 6))
def test_principal_moments_are_the_eigenvalues(inertia: InertiaTensor):
    matrix = [
        [inertia.ixx, inertia.ixy, inertia.ixz],
        [inertia.ixy, inertia.iyy, inertia.iyz],
        [inertia.ixz, inertia.iyz, inertia.izz],
    ]
    wanted = numpy.linalg.eigvalsh(matrix)
    # Below the smallest normal number a double has fewer digits than the bound asks for.
    bound = max(2e-12 * max(abs(wanted)), sys.float_info.min)
    numpy.testing.assert_allclose(principal_moments(inertia), wanted, rtol=0, atol=bound)
