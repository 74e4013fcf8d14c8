"""Hypothesis strategies that draw specs from the schemas; some of them are valid robots."""

from collections.abc import Mapping, Sequence
from functools import cache

from hypothesis import strategies as st

from linkforge_compile.schema.registry import definitions_with_patches

Strategy = st.SearchStrategy

RAW = frozenset({"extra", "extra_attributes", "extra_inside"})
"""Keys whose values may be any well-formed XML, which URDF readers may reject."""

_USES_OTHER_FILES = frozenset({"modules", "include", "data", "packages", "mount"})
_MAX_DEPTH = 6

_NAMES = st.sampled_from(["a", "b", "c", "ab", "bc", "tool", "m"])
_NUMBERS = st.sampled_from([0, 1, -1, 0.5, 1e-3, 2, 1e6, 3.14])
_TEXTS = st.sampled_from(["a", "ab", "", "x y", "é", "<&\">'", "1.10", "90 deg", "25 mm", "3 kg", "2 N*m"])
_EXPRESSIONS = st.sampled_from(["$(1 + 1)", "$(n / 2)", "$(pi)", "$(n > 1)", "$(nothing)", "$(1 / 0)"])
_FREE = st.recursive(
    _NUMBERS | _TEXTS | st.booleans() | st.none(),
    lambda inner: st.lists(inner, max_size=2) | st.dictionaries(_NAMES, inner, max_size=2),
    max_leaves=4,
)

_SHAPES = st.sampled_from(
    [{"box": [1, 2, 3]}, {"sphere": 1}, {"cylinder": {"radius": 1, "length": 2}}, {"mesh": "package://p/a.stl"}]
)

_TYPICAL: Mapping[str, Strategy] = {
    "number": _NUMBERS | st.just("$(n / 2)"),
    "length": _NUMBERS | st.sampled_from(["25 mm", "$(n * 1)"]),
    "lengths": st.lists(st.sampled_from([0.1, 1, "25 mm"]), min_size=3, max_size=3),
    "angle": _NUMBERS | st.sampled_from(["90 deg", "$(pi)"]),
    "mass": st.sampled_from([1, 0.1, "3 kg", "$(n)"]),
    "density": st.sampled_from([1000, "2.7 g/cm^3"]),
    "moment": st.sampled_from([0.1, 1, 0.05]),
    "position": st.sampled_from([0, 0.5, "30 deg"]),
    "effort": st.sampled_from([1, 0]),
    "velocity": st.sampled_from([1, 0]),
    "when": st.sampled_from([True, False, "$(n > 1)"]),
    "for": st.just({"i": 2}),
    "expression": st.just("$(n)"),
    "frame": st.just({"parent": "a"}),
    "sensor": st.sampled_from([{"type": "imu", "link": "b"}, {"type": "camera", "link": "tool"}]),
    "limits": st.just({"lower": -1, "upper": 1, "effort": 1, "velocity": 1}),
    "mimic": st.sampled_from([{"joint": "ab"}, {"joint": "bc", "multiplier": 2}]),
    "ros2_control": st.just({"hardware_plugin": "mock_components/GenericSystem"}),
    "transmission": st.just(
        {
            "type": "transmission_interface/SimpleTransmission",
            "joints": {"ab": {"hardware_interfaces": "x"}},
            "actuators": {"m": {}},
        }
    ),
    "inertia": st.just({"ixx": 0.1, "iyy": 0.1, "izz": 0.1}),
    "visual": _SHAPES,
    "collision": _SHAPES,
}
"""Typical values for some definitions of the schemas."""

_SCALARS: Mapping[str, Strategy] = {
    "number": _NUMBERS,
    "integer": st.integers(-1, 3),
    "boolean": st.booleans(),
    "null": st.none(),
}

_LINKS = ("a", "b", "c")
_JOINTS = {"ab": ("a", "b"), "bc": ("b", "c")}
_ENTRY = ("when", "for")


@st.composite
def specs(draw: st.DrawFn, without: frozenset[str] = frozenset()) -> dict[str, object]:
    """Draw a spec of three links in a chain with any other keys of the schema; leave out the keys `without`."""
    keys = frozenset((*without, *_USES_OTHER_FILES))
    spec = draw(
        _of_definition("robot", keys | {"linkforge", "name", "links", "joints"}, 0).filter(
            lambda it: isinstance(it, dict)
        )
    )
    link, joint = (_of_definition(name, keys.union(_ENTRY), 1) for name in ("link", "joint"))
    joints = {name: draw(joint) for name in _JOINTS}
    ends = {name: {"type": "fixed", "parent": parent, "child": child} for name, (parent, child) in _JOINTS.items()}
    limits = {"lower": -1, "upper": 1, "effort": 1, "velocity": 1}
    for name, entry in joints.items():
        if isinstance(entry, dict):
            kind = draw(st.sampled_from(["fixed", "revolute", "continuous", "prismatic", "planar", "floating"]))
            moves = {"axis": "z"} if kind not in ("fixed", "floating") else {}
            moves |= {"limits": limits} if kind in ("revolute", "prismatic") else {}
            ends[name] |= {"type": kind, **moves, **({} if kind == "fixed" else entry)}
            ends[name] |= {"parent": _JOINTS[name][0], "child": _JOINTS[name][1]}
    return {
        "linkforge": 1,
        "name": "r",
        **spec,
        "variables": {"n": 2},
        "links": {name: draw(link) for name in _LINKS},
        "joints": ends,
    }


@cache
def _of_definition(name: str, without: frozenset[str], depth: int) -> Strategy:
    allowed = st.deferred(lambda: _of(definitions_with_patches()[name], without, depth))
    if name not in _TYPICAL:
        return allowed
    return _mostly(_near(_TYPICAL[name], allowed), allowed)


def _of(schema: Mapping, without: frozenset[str], depth: int) -> Strategy:
    """Draw a value that a schema allows: mostly one like its examples, sometimes any other."""
    if "$ref" in schema:
        return _of_definition(schema["$ref"].rpartition("/")[2], without, depth)
    if "enum" in schema or "const" in schema:
        return st.sampled_from(schema.get("enum", [schema.get("const")]))
    types = schema.get("type", ())
    usual = [_of(choice, without, depth) for choice in schema.get("anyOf", ()) if not _is_expression(choice)]
    odd = [_EXPRESSIONS] if "\\$\\(" in str(schema) else []
    for kind in (types,) if isinstance(types, str) else types:
        (usual if kind in ("object", "array") else odd).append(_of_type(kind, schema, without, depth))
    if examples := [one for one in schema.get("examples", ()) if not without & _keys_in(one)]:
        usual += [_near(st.sampled_from(examples), choice) for choice in usual] or [st.sampled_from(examples)]
    return _mostly(st.one_of(usual or odd or [_FREE]), st.one_of(odd or usual or [_FREE]))


def _is_expression(schema: Mapping) -> bool:
    return schema.get("$ref") == "#/definitions/expression"


def _mostly(usual: Strategy, odd: Strategy) -> Strategy:
    # Hypothesis prefers the ends of a range, so use a number inside it.
    return st.integers(0, 63).flatmap(lambda dice: odd if dice == 41 else usual)


def _near(examples: Strategy, others: Strategy) -> Strategy:
    """Draw an example; if it is an object, add other keys that the schema allows."""

    def filled(both: tuple[object, object]) -> object:
        example, other = both
        return {**other, **example} if isinstance(example, dict) and isinstance(other, dict) else example

    return st.tuples(examples, others).map(filled) | examples


def _of_type(kind: str, schema: Mapping, without: frozenset[str], depth: int) -> Strategy:
    if kind in _SCALARS:
        return _SCALARS[kind]
    if kind == "string":
        return _EXPRESSIONS if "\\$\\(" in str(schema.get("pattern", "")) else _NAMES | _TEXTS
    if depth >= _MAX_DEPTH:
        return st.just([] if kind == "array" else {})
    if kind == "array":
        least, most = schema.get("minItems", 0), schema.get("maxItems", 3)
        return st.lists(_of(schema.get("items", {}), without, depth + 1), min_size=least, max_size=most)
    properties = {key: inner for key, inner in schema.get("properties", {}).items() if key not in without}
    inner = schema.get("additionalProperties")
    if not properties:
        values = _of(inner if isinstance(inner, dict) else {}, without, depth + 1)
        return st.dictionaries(_NAMES, values, max_size=2)
    some = st.lists(st.sampled_from(sorted(properties)), max_size=3, unique=True)
    drawn = {key: _of(inner, without, depth + 1) for key, inner in properties.items()}
    return some.flatmap(lambda keys: st.fixed_dictionaries({key: drawn[key] for key in keys}))


def _keys_in(value: object) -> set[str]:
    if isinstance(value, Mapping):
        return {*map(str, value), *(key for inner in value.values() for key in _keys_in(inner))}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return {key for inner in value for key in _keys_in(inner)}
    return set()
