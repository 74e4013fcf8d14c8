"""Describe a module: its file, prefix, arguments and size."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkforge_compile.analysis import Analysis
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.expand import Instance
from linkforge_compile.listing import as_written
from linkforge_compile.lsp.hover.text import bullets, code
from linkforge_compile.lsp.occurrence import Occurrence
from linkforge_compile.source import SourceRef
from linkforge_compile.source.provenance import Kind


def describe_module(one: Occurrence, analysis: Analysis) -> str:
    """Return the module that a name names; "" if it could not be read."""
    whole = analysis.instance
    found = next((use for use in _with_names(whole, (), "") if use[2] == one.name), None) if whole else None
    if found is None:
        return ""
    instance, names, name = found
    tree = instance.tree
    file = tree.span.file.shown if tree is not None else "a file that cannot be read"
    prefix = name.removesuffix(one.written) + instance.prefix
    facts = [
        f"uses {code(file)}",
        f"prefix {code(prefix)}" if prefix else "no prefix",
        *_arguments(instance),
        _size(analysis.robot, names) if analysis.robot else "",
    ]
    return f"**module {code(one.name)}**\n\n{bullets(facts)}"


def _with_names(
    instance: Instance, names: tuple[str, ...], outer: str
) -> Iterator[tuple[Instance, tuple[str, ...], str]]:
    """Yield each module with the names of the modules around it and its own, and its name with their prefixes."""
    prefix = outer + instance.prefix
    for module in instance.modules:
        yield module, (*names, module.name), prefix + module.name
        yield from _with_names(module, (*names, module.name), prefix)


def _arguments(module: Instance) -> Iterator[str]:
    for name, setting in module.names.settings.items() if module.names else ():
        if setting.kind is Kind.WITH:
            yield f"with {code(f'{name}: {as_written(setting.node)}')}"


def _size(robot: Robot, names: Sequence[str]) -> str:
    links = sum(_is_within(link.source, names) for link in robot.links)
    joints = sum(_is_within(joint.source, names) for joint in robot.joints)
    return f"{links} link{'s' * (links != 1)}, {joints} joint{'s' * (joints != 1)}"


def _is_within(source: SourceRef | None, names: Sequence[str]) -> bool:
    return source is not None and source.modules[: len(names)] == tuple(names)
