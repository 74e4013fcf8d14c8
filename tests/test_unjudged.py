"""What is made of judged values is what the constructor makes of them."""

import copy
import pickle

import pytest

from linkforge_compile.core.models.geometry import IDENTITY, Cylinder, Transform, Vector3
from linkforge_compile.core.models.joint import Joint, JointLimits, JointType
from linkforge_compile.frozen import fields
from linkforge_compile.source import SourceFile, SourceRef
from linkforge_compile.syntax import YamlFault
from linkforge_compile.unjudged import unjudged

WRITTEN = SourceRef(YamlFault(SourceFile("arm.robot.yaml", "").whole))
UP = Vector3(0.0, 0.0, 1.0)
LIMITS = JointLimits(-1.0, 1.0, 5.0, 2.0)


@pytest.mark.parametrize(
    ("kind", "values", "named"),
    [
        (Vector3, (1.0, 2.0, 3.0), {}),
        (Transform, (UP,), {"is_stated": True, "source": WRITTEN}),
        (Cylinder, (0.1, 0.5), {"source": WRITTEN, "extra_attributes": (("a", "b"),)}),
        (Joint, ("elbow", JointType.FIXED, "base"), {"child": "arm"}),
        (Joint, ("elbow", JointType.REVOLUTE, "base", "arm", IDENTITY, UP, LIMITS), {"axis_as_written": UP}),
    ],
)
def test_it_is_what_the_constructor_makes(kind, values, named):
    made, constructed = unjudged(kind)(*values, **named), kind(*values, **named)
    assert type(made) is kind
    assert [getattr(made, one.name) for one in fields(kind)] == [getattr(constructed, one.name) for one in fields(kind)]
    assert made == constructed
    assert pickle.loads(pickle.dumps(made)) == constructed
    assert copy.copy(made) is made
    with pytest.raises(AttributeError, match="cannot assign to field"):
        made.source = None


def test_values_are_not_looked_at():
    assert unjudged(Cylinder)(-1.0, 0.5).radius == -1.0


def test_a_class_is_opened_once():
    for _ in range(2):
        unjudged(Joint)
        Joint("elbow", JointType.FIXED, "base", "arm").with_prefix("left_")
    assert [kind.__name__ for kind in Joint.__subclasses__()].count("OpenedJoint") == 1


def test_it_is_called_as_the_class_is():
    with pytest.raises(TypeError, match=r"Cylinder\(\) missing 1 required positional argument: 'length'"):
        unjudged(Cylinder)(0.1)
    with pytest.raises(TypeError, match=r"Cylinder\(\) takes 2 positional arguments but 3"):
        unjudged(Cylinder)(0.1, 0.5, ())
