"""Numbers that only just are doubles, whose squares and products are none: a diagnostic, and never a traceback."""

import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile import compile_text, import_urdf, render_urdf
from linkforge_compile.core import Box, Collision, Inertial, InertiaTensor, Link, Robot, RobotGeneratorError, Vector3
from tests.test_any_spec import compiled

EXTREME = st.sampled_from([1e308, 1e200, 1e155, 1e103, 1e-108, 1e-163, 1e-200, 5e-324])
SIZE = EXTREME | st.sampled_from([0.1, 1])
NUMBER = SIZE | EXTREME.map(lambda number: -number) | st.just(0)
VECTOR = st.lists(NUMBER, min_size=3, max_size=3)
ORIGIN = VECTOR | st.fixed_dictionaries({"xyz": VECTOR, "rpy": VECTOR})
SHAPE = (
    st.fixed_dictionaries({"box": st.lists(SIZE, min_size=3, max_size=3), "origin": ORIGIN})
    | st.fixed_dictionaries({"sphere": SIZE, "origin": ORIGIN})
    | st.fixed_dictionaries({"cylinder": st.fixed_dictionaries({"radius": SIZE, "length": SIZE})})
    | st.fixed_dictionaries({"capsule": st.fixed_dictionaries({"radius": SIZE, "length": SIZE}), "origin": ORIGIN})
)
TENSOR = st.fixed_dictionaries({"ixx": SIZE, "iyy": SIZE, "izz": SIZE}, optional={"ixy": NUMBER, "iyz": NUMBER})
INERTIAL = st.fixed_dictionaries(
    {"mass": SIZE, "inertia": TENSOR}, optional={"origin": ORIGIN}
) | st.fixed_dictionaries({"density": SIZE})
LINK = st.fixed_dictionaries(
    {"inertial": INERTIAL, "collision": st.lists(SHAPE, min_size=1, max_size=2)}, optional={"visual": SHAPE}
)
LIMITS = st.fixed_dictionaries(
    {"lower": SIZE.map(lambda number: -number), "upper": SIZE, "effort": SIZE, "velocity": SIZE}
)
JOINT = st.fixed_dictionaries(
    {
        "type": st.sampled_from(["revolute", "prismatic"]),
        "limits": LIMITS,
        "axis": st.sampled_from("xz"),
        "origin": ORIGIN,
    },
    optional={
        "dynamics": st.fixed_dictionaries({"damping": SIZE, "friction": SIZE}),
        "safety_controller": st.fixed_dictionaries({"k_velocity": SIZE, "k_position": SIZE}),
    },
)
MIMIC = st.fixed_dictionaries({"joint": st.just("ab"), "multiplier": NUMBER, "offset": NUMBER})


@st.composite
def extreme_specs(draw: st.DrawFn) -> dict[str, object]:
    """Draw a spec of three links in a chain with extreme numbers."""
    return {
        "linkforge": 1,
        "name": "r",
        "links": {name: draw(LINK) for name in "abc"},
        "joints": {
            "ab": {**draw(JOINT), "parent": "a", "child": "b"},
            "bc": {**draw(JOINT), "parent": "b", "child": "c", "mimic": draw(MIMIC)},
        },
    }


@pytest.mark.parametrize("size", [1e308, 1e200, 1e-200, 1e-320])
def test_a_shape_whose_volume_is_no_double_is_reported(size: float):
    tensor = "{ixx: 1, iyy: 1, izz: 1, ixy: 0.1}"
    shape = f"{{box: [{size}, {size}, {size}]}}"
    found = compile_text(
        f"linkforge: 1\nname: r\nlinks: {{a: {{collision: {shape}, inertial: {{mass: 1, inertia: {tensor}}}}}}}\n"
    ).diagnostics
    # "lighter than air", and "denser than any metal"
    assert ("LF6030" if size > 1 else "LF6031") in {one.code.id for one in found}


@pytest.mark.parametrize(("size", "reason"), [(1e308, "finite"), (1e200, "finite"), (1e-320, "above 0 m³")])
def test_an_inertia_that_no_double_holds_is_refused_with_the_volume(size: float, reason: str):
    spec = f"linkforge: 1\nname: r\nlinks: {{a: {{collision: {{sphere: {size}}}, inertial: {{mass: 1}}}}}}\n"
    [error] = [one for one in compile_text(spec).diagnostics if one.code.id == "LF5011"]
    assert f"volume must be {reason} to compute an inertia" in error.message


@pytest.mark.parametrize("size", [1e308, 1e200, 1e-320])
def test_a_robot_of_such_a_shape_is_exported_and_imported(size: float):
    inertial = Inertial(1.0, inertia=InertiaTensor(1, 1, 1, 0.1))
    link = Link("a", inertial, collisions=[Collision(Box(Vector3(size, size, size)))])
    urdf = Robot("r", links=[link]).export_urdf()
    imported = import_urdf("r.urdf", text=urdf)
    assert compile_text(imported.text).result().links["a"] == link


@given(extreme_specs())
def test_a_spec_of_extreme_numbers_compiles_or_is_refused_at_a_place(spec):
    robot = compiled(spec).robot
    if robot is None:
        return
    urdf = render_urdf(robot)
    import_urdf("r.urdf", text=urdf)
    with contextlib.suppress(RobotGeneratorError):
        assert robot.export_urdf() == urdf
