"""Reads YAML files of parameters as rcl_yaml_param_parser does, and holds them against declared parameters."""

import re
from collections.abc import Iterator, Mapping
from typing import TypeAlias

import yaml

Declared: TypeAlias = Mapping[str, str]
"""The type of each parameter by a pattern of its whole name, such as `joints` and `gains\\.\\w+\\.p`."""

_TYPES = {bool: "bool", int: "int", float: "double", str: "string"}

_WORDS = {"y": True, "yes": True, "true": True, "on": True, "n": False, "no": False, "false": False, "off": False}
_BOOLEANS = {spelling: value for word, value in _WORDS.items() for spelling in (word, word.capitalize(), word.upper())}
_DECIMAL = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|[-+]?(inf|infinity|nan)|[-+]?\.(inf|nan)", re.IGNORECASE)
_HEXADECIMAL = re.compile(r"[-+]?0x([0-9a-f]+\.?[0-9a-f]*|\.[0-9a-f]+)(p[-+]?\d+)?", re.IGNORECASE)
_INTEGER = re.compile(r"[-+]?(0x[0-9a-f]+|0[0-7]*|[1-9]\d*)", re.IGNORECASE)


def parameters_in(text: str) -> dict[str, object]:
    """Return the parameters of a text by name, with a dot between the keys of nested maps."""
    return _unique(_parameters(_map(yaml.compose(text)), ()))


def nodes_in(text: str) -> dict[str, dict[str, object]]:
    """Return the parameters of each node of ROS by its name."""
    nodes = {name: _map(node) for name, node in _map(yaml.compose(text)).items()}
    assert all(list(node) == ["ros__parameters"] for node in nodes.values())
    return {name: _unique(_parameters(_map(node["ros__parameters"]), ())) for name, node in nodes.items()}


def _unique(parameters: Iterator[tuple[str, object]]) -> dict[str, object]:
    """Return the parameters by name, of which no two are the same with their dots."""
    items = list(parameters)
    by_name = dict(items)
    assert len(by_name) == len(items), f"a parameter is there twice: {[name for name, _ in items]}"
    return by_name


def _map(node: yaml.Node | None) -> dict[str, yaml.Node]:
    assert isinstance(node, yaml.MappingNode)
    names = [key.value for key, _ in node.value]
    assert len(set(names)) == len(names), f"a key is there twice: {names}"
    return {key.value: value for key, value in node.value}


def _parameters(nodes: Mapping[str, yaml.Node], path: tuple[str, ...]) -> Iterator[tuple[str, object]]:
    for key, node in nodes.items():
        if isinstance(node, yaml.MappingNode) and node.value:
            yield from _parameters(_map(node), (*path, key))
        elif isinstance(node, yaml.SequenceNode):
            yield ".".join((*path, key)), [_scalar(item) for item in node.value]
        else:
            yield ".".join((*path, key)), _scalar(node)


def _scalar(node: yaml.Node) -> object:
    """Return the value of a scalar: text in quotes is text; else a boolean, then `strtoll`, then `strtod`."""
    assert isinstance(node, yaml.ScalarNode), f"not a parameter: {node}"
    text: str = node.value
    if node.style in ("'", '"'):
        return text
    assert text not in ("", "~", "null"), "a parameter without a value"
    if text in _BOOLEANS:
        return _BOOLEANS[text]
    if _INTEGER.fullmatch(text):
        is_octal = re.fullmatch(r"[-+]?0\d+", text)
        return int(text, 8 if is_octal else 0)
    if _DECIMAL.fullmatch(text):
        return float(text.replace(".inf", "inf").replace(".nan", "nan"))
    return float.fromhex(text) if _HEXADECIMAL.fullmatch(text) else text


def type_of(value: object) -> str:
    """Return the type of a parameter; rcl_yaml_param_parser refuses empty maps and lists of mixed types."""
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
