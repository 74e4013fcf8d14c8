"""Reads YAML files of parameters as a node of ROS 2 does, and holds them against declared parameters."""

import re
from collections.abc import Iterator, Mapping
from typing import TypeAlias

import yaml

Declared: TypeAlias = Mapping[str, str]
"""The type of each parameter by a pattern of its whole name, such as `joints` and `gains\\.\\w+\\.p`."""

_TYPES = {bool: "bool", int: "int", float: "double", str: "string"}


def parameters_in(text: str) -> dict[str, object]:
    """Return the parameters of a text by name, with a dot between the keys of nested maps."""
    whole = yaml.safe_load(text)
    assert isinstance(whole, dict)
    return dict(_parameters(whole, ()))


def _parameters(node: Mapping[object, object], path: tuple[str, ...]) -> Iterator[tuple[str, object]]:
    for key, value in node.items():
        assert isinstance(key, str), f"{key!r} is no name of a parameter"
        if isinstance(value, dict):
            yield from _parameters(value, (*path, key))
        else:
            yield ".".join((*path, key)), value


def type_of(value: object) -> str:
    """Return the type of a parameter; rcl_yaml_param_parser refuses null, empty maps, and lists of mixed types."""
    if not isinstance(value, list):
        return _TYPES[type(value)]
    types = {_TYPES[type(item)] for item in value}
    assert len(types) == 1, f"not a list of one type: {value}"
    return f"{types.pop()}_array"


def require_declared(parameters: Mapping[str, object], declared: Declared) -> None:
    """Fail for a parameter that is not declared, or whose value has another type: 1 is no double."""
    for name, value in parameters.items():
        types = [kind for pattern, kind in declared.items() if re.fullmatch(pattern, name)]
        assert types, f"{name} is not declared"
        assert type_of(value) == types[0], f"{name} is a {types[0]}, found {value!r}"
