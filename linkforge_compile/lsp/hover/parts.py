"""Show the parts of the robot that a name at a position names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkforge_compile.analysis import Analysis
from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.graph import child_joints, parent_joints, walk_up
from linkforge_compile.core.models.joint import Joint
from linkforge_compile.core.models.link import Inertial, Link
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Severity
from linkforge_compile.editor.completions import marked_names
from linkforge_compile.export_spec import UnknownPathError, explain
from linkforge_compile.export_spec.explain import computed_from
from linkforge_compile.export_spec.explanation_lines import computed_lines
from linkforge_compile.lsp.cursor import Cursor, Role
from linkforge_compile.lsp.hover.modules import describe_module
from linkforge_compile.lsp.hover.text import MAX_SHOWN, RULE, and_more, bullets, code, code_block
from linkforge_compile.lsp.hover.values import quantity_of
from linkforge_compile.lsp.occurrence import Occurrence
from linkforge_compile.lsp.occurrences import DECLARING, Occurrences
from linkforge_compile.lsp.placed import nodes_in, uses_of
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.overview.joint_text import short
from linkforge_compile.roots import identity
from linkforge_compile.schema.descriptions import described_at
from linkforge_compile.source import Position, SourceRef, Span
from linkforge_compile.syntax import YamlFault, YamlMap, YamlNode
from linkforge_compile.units import ACCELERATION, EFFORT, JERK, POSITION, SPEED, FieldUnit

_MAX_LINES = 20
_UNKNOWN = "values are shown once the errors in it are mended"
_SECTIONS = {kind: "/".join(path) for path, kind in DECLARING.items() if path != ("frames",)}
_LIMITS = {
    "lower": POSITION,
    "upper": POSITION,
    "effort": EFFORT,
    "velocity": SPEED,
    "acceleration": ACCELERATION,
    "deceleration": ACCELERATION,
    "jerk": JERK,
}


def show_parts(document: Document, at: Position, cursor: Cursor) -> str:
    """Return the parts that the name at a position names, in each use of the file; "" if it names none."""
    named = _named_before(document, cursor) if document.is_malformed else _named(document, at)
    texts = list(dict.fromkeys(text for one, analysis in named if (text := _describe(one, analysis))))
    return RULE.join(filter(None, (*texts[:MAX_SHOWN], and_more(len(texts) - MAX_SHOWN))))


def _named(document: Document, at: Position) -> Iterator[tuple[Occurrence, Analysis]]:
    for analysis in document.analyses:
        here = Occurrences(analysis).at(identity(document.path), at)
        yield from ((one, analysis) for one in _innermost(here))


def _named_before(document: Document, cursor: Cursor) -> Iterator[tuple[Occurrence, Analysis]]:
    """Yield what the word at a position names by its path, of the latest text that could be read."""
    word = cursor.word.text or ""
    if cursor.role is Role.KEY:
        kinds = [kind for path, kind in DECLARING.items() if path == cursor.path]
    else:
        kinds = [kind for one in described_at(cursor.path) for kind in marked_names(one.schema)[1]]
    for use in uses_of(document):
        for kind in dict.fromkeys(kinds):
            yield Occurrence(kind, use.prefix + word, word, cursor.word), use.analysis


def _innermost(found: Sequence[Occurrence]) -> Iterator[Occurrence]:
    """Yield the occurrences that have the innermost place."""
    return (one for one in found if one.span == found[0].span)


def _describe(one: Occurrence, analysis: Analysis) -> str:
    robot = analysis.robot
    if one.kind == "module":
        return describe_module(one, analysis)
    if robot is None:
        return ""
    if one.kind == "link" and one.name in robot.links:
        return _link(robot.link(one.name), robot, is_faulty=_has_error(robot.link(one.name).source, analysis))
    if one.kind == "joint" and one.name in robot.joints:
        return _joint(robot.joint(one.name), robot, is_faulty=_has_error(robot.joint(one.name).source, analysis))
    return _other(one, robot)


def _has_error(source: SourceRef | None, analysis: Analysis) -> bool:
    """Whether an error is in a part or leads into it, so that some of its values only stand in for others."""
    if source is None:
        return False
    whole = source.node.span
    errors = (one.span for one in analysis.compilation.diagnostics if one.severity is Severity.ERROR and one.span)
    tree = source.node if isinstance(source.node, YamlMap) else None
    return any(isinstance(node, YamlFault) for _, node, _ in nodes_in(tree)) or any(
        at.file.name == whole.file.name and whole.start <= at.start <= whole.end for at in errors
    )


def _other(one: Occurrence, robot: Robot) -> str:
    """Return a part as a spec would write it."""
    section = "semantic/group_states" if one.kind == "state" else _SECTIONS.get(one.kind)
    if section is None:
        return ""
    try:
        text = explain(robot, f"{section}/{one.name}").text
    except (UnknownPathError, RobotGeneratorError):
        return ""
    lines = text.split("\n")
    shown = [*lines[:_MAX_LINES], *(["…"] if len(lines) > _MAX_LINES else [])]
    return f"**{one.kind} {code(one.name)}**\n\n{code_block(shown, 'yaml')}"


def _link(link: Link, robot: Robot, *, is_faulty: bool) -> str:
    above, below = parent_joints(robot.joints).get(link.name), child_joints(robot.joints).get(link.name, ())
    ends = (f"{code(joint.name)} to {code(joint.child)}" for joint in below[:MAX_SHOWN])
    facts = [
        *([_UNKNOWN] if is_faulty else _inertial(link.inertial) if link.inertial else ["no mass"]),
        f"parent {code(above.parent)}, by the {above.type} joint {code(above.name)}" if above else "the root",
        *(f"joint {end}" for end in ends),
        and_more(len(below) - MAX_SHOWN),
    ]
    computed = computed_from(robot, ("links", link.name, "inertial"))
    lines = computed_lines(computed, _place_lines) if computed else ()
    return "\n\n".join(filter(None, (f"**link {code(link.name)}**", bullets(facts), code_block(lines))))


def _place_lines(what: str, place: Span) -> Iterator[str]:
    yield f"{what} at {place}"


def _inertial(inertial: Inertial) -> list[str]:
    tensor = inertial.inertia
    moments = ", ".join(f"{name} {short(getattr(tensor, name))}" for name in ("ixx", "iyy", "izz"))
    products = [f"{name} {short(value)}" for name in ("ixy", "ixz", "iyz") if (value := getattr(tensor, name))]
    return [
        f"mass {short(inertial.mass)} kg",
        f"centre of mass [{', '.join(map(short, inertial.origin.xyz))}] m",
        f"inertia {', '.join((moments, *products))} kg·m²",
    ]


def _joint(joint: Joint, robot: Robot, *, is_faulty: bool) -> str:
    facts = [
        f"from {code(joint.parent)} to {code(joint.child)}",
        *([_UNKNOWN] if is_faulty else _joint_values(joint)),
        f"mimics {code(joint.mimic.joint)}" if joint.mimic else "",
    ]
    title = f"**{joint.type} joint {code(joint.name)}**"
    return "\n\n".join((title, bullets(facts), code_block(tree_lines(joint, robot))))


def _joint_values(joint: Joint) -> Iterator[str]:
    xyz, rpy = joint.origin.xyz, joint.origin.rpy
    turned = f", rpy [{', '.join(map(short, rpy))}] rad" if any(rpy) else ""
    if joint.axis:
        yield f"axis [{', '.join(map(short, joint.axis))}]"
    if any(xyz) or turned:
        yield f"origin [{', '.join(map(short, xyz))}] m{turned}"
    yield from _limits(joint)


def _limits(joint: Joint) -> Iterator[str]:
    """Yield the limits in SI, and as written where that is another unit."""
    source = joint.source.node if joint.source else None
    written = source.get("limits") if isinstance(source, YamlMap) else None
    for name, unit in _LIMITS.items():
        value = getattr(joint.limits, name, None)
        if value is not None:
            node = written.get(name) if isinstance(written, YamlMap) else None
            yield f"{name} {_with_unit(value, unit, joint)}{_as_written(node)}"


def _with_unit(value: float, unit: FieldUnit, joint: Joint) -> str:
    return f"{short(value)} {unit.text(joint.type.motion)}".strip()


def _as_written(node: YamlNode | None) -> str:
    quantity = quantity_of(node) if node is not None else None
    if quantity is None or quantity.written in (None, quantity.in_si):
        return ""
    return f" ({code(str(quantity))})"


def tree_lines(joint: Joint, robot: Robot) -> Iterator[str]:
    """Yield the chain of links from the root to the child of a joint, and the joints below that, as a tree."""
    above, below = parent_joints(robot.joints), child_joints(robot.joints)
    chain = [*walk_up(joint.parent, {child: one.parent for child, one in above.items()})][::-1]
    left_out = max(len(chain) - MAX_SHOWN, 0)
    if left_out:
        yield f"… {left_out} links above"
    depth = -1
    for depth, link in enumerate(chain[left_out:]):
        by = above.get(link)
        yield _branch(depth, link, by if depth or left_out else None)
    yield f"{_branch(depth + 1, joint.child, joint)}  ◄"
    inside = below.get(joint.child, [])
    for one in inside[:MAX_SHOWN]:
        deeper = len(below.get(one.child, ()))
        yield _branch(depth + 2, one.child, one) + (f" … {deeper} below" if deeper else "")
    if more := and_more(len(inside) - MAX_SHOWN):
        yield f"{'   ' * (depth + 2)}{more}"


def _branch(depth: int, link: str, by: Joint | None) -> str:
    mark = f"{'   ' * (depth - 1)}└─ " if depth > 0 else ""
    return f"{mark}{link}" + (f"  ({by.name}, {by.type})" if by else "")
