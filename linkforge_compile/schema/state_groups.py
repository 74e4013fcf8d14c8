"""Group states that name their group: `home: {group: arm, joints: {elbow: 0}}`, for `arm: {home: {elbow: 0}}`."""

from __future__ import annotations

import textwrap
from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.schema import UNKNOWN_KEY, WRONG_KIND
from linkforge_compile.diagnostics.fix import Edit, Fix, edited, shift_lines
from linkforge_compile.schema.shapes import expected, shapes
from linkforge_compile.schema.srdf_habits import srdf_entry
from linkforge_compile.source import Span
from linkforge_compile.syntax.nodes import YamlEntry, YamlMap, YamlScalar, has_expression

_SECTION, _TAG = "group_states", "group_state"
_STEP = "  "


class _State(NamedTuple):
    """The entries of a state, of its group and of its joints, and the name of the group."""

    own: YamlEntry
    group: YamlEntry
    joints: YamlEntry
    group_name: str


def restore_groups_of_states(tree: YamlMap, sink: Diagnostics) -> YamlMap:
    """Report the states of a file if all name their groups; return the file with the states under their groups.

    Later stages then report no errors that follow from it.
    """
    semantic = tree.get("semantic")
    if not isinstance(semantic, YamlMap):
        return tree
    section = semantic.entries.get(_SECTION) or semantic.entries.get(_TAG)
    entries = [*section.value] if section and isinstance(section.value, YamlMap) else []
    states = [state for entry in entries if (state := _state(entry))]
    if section is None or not states or len(states) < len(entries):
        return tree
    sink.report(_fault(section, states).with_fix(_fix(section, states)))
    groups: dict[str, YamlEntry] = {}
    for group in _by_group(states):
        # The place of the key is that of its value: it is generated.
        inner = {state.own.name: YamlEntry(state.own.key, state.joints.value) for state in group}
        name, place = group[0].group_name, group[0].group.value.span
        groups[name] = YamlEntry(YamlScalar(name, name, place), YamlMap(inner, place))
    restored = semantic.without(section.name).with_value(_SECTION, YamlMap(groups, section.value.span))
    return tree.with_value("semantic", restored)


def _state(entry: YamlEntry) -> _State | None:
    """Return a state whose only keys are `group` and `joints`, or `joint`; None for any other entry."""
    inner = entry.value.entries if isinstance(entry.value, YamlMap) and len(entry.value) == 2 else {}
    group, joints = inner.get("group"), inner.get("joints") or inner.get("joint")
    if group is None or joints is None or not isinstance(joints.value, YamlMap):
        return None
    match group.value:
        case YamlScalar(text=name, value=str()) if not has_expression(name):
            return _State(entry, group, joints, name)
    return None


def _by_group(states: Sequence[_State]) -> Sequence[Sequence[_State]]:
    groups: dict[str, list[_State]] = defaultdict(list)
    for state in states:
        groups[state.group_name].append(state)
    return [*groups.values()]


def _fault(section: YamlEntry, states: Sequence[_State]) -> Diagnostic:
    first = states[0]
    element = {"name": YamlEntry(first.own.key, first.own.key), "group": first.group, "joints": first.joints}
    more = ", …" if len(states) > 1 else ""
    hint = f"; write '{_SECTION}: {{{srdf_entry(_SECTION, YamlMap(element, section.value.span))}{more}}}'"
    if section.name == _TAG:
        return UNKNOWN_KEY.at(section.key.span, name=_TAG, owner="a semantic part", hint=hint)
    takes = expected(shapes().under("semantic").under(_SECTION).schema)
    return WRONG_KIND.at(first.own.key.span, field=f"'{_SECTION}'", expected=takes, found=f"states by name{hint}")


def _fix(section: YamlEntry, states: Sequence[_State]) -> Fix | None:
    """Return the fix that writes the states under their groups; None where it would lose a comment."""
    if not _are_written(section, states):
        return None
    edit = _in_braces(section, states) if section.value.span.is_flow else _on_lines(states)
    title = "write each state under its group"
    return Fix(title, (Edit(section.key.span, _SECTION), edit), is_safe=True) if edit else None


def _are_written(section: YamlEntry, states: Sequence[_State]) -> bool:
    """Whether the states are text of a spec, one after the other; an alias is not."""
    file, at = section.key.span.file, section.key.span.end
    for state in states:
        key, whole = state.own.key.span, state.own.value.span
        inner = (each.span for entry in (state.group, state.joints) for each in entry[:2])
        if not at <= key.start < key.end <= whole.start or not all(span.lies_in(whole) for span in inner):
            return False
        if key.text is None or state.group.value.span.text is None:
            return False
        at = whole.end
    return not file.is_xml and file is whole.file


def _in_braces(section: YamlEntry, states: Sequence[_State]) -> Edit | None:
    """Return the edit of states in braces."""
    groups = []
    for group in _by_group(states):
        inner = (f"{state.own.key.span.full_text}: {state.joints.value.span.full_text}" for state in group)
        groups.append(f"{group[0].group.value.span.full_text}: {{{', '.join(inner)}}}")
    whole = section.value.span
    return None if "#" in whole.full_text else Edit(whole, f"{{{', '.join(groups)}}}")


def _on_lines(states: Sequence[_State]) -> Edit | None:
    """Return the edit of states on lines of their own, with the comments above and in each of them."""
    texts: dict[str, list[str]] = defaultdict(list)
    first = states[0].own.key.span
    file, end = first.file, first.line - 1
    for state in states:
        begin, end = end + 1, _last_line(state)
        place = Span(file, begin, 1, end, len(file.line(end)) + 1)
        edits = _edits(state)
        if not edits or not state.own.key.span.begins_line:
            return None
        text = textwrap.indent(edited(place, edits), _STEP)
        if state.group_name not in texts:
            below = text.lstrip("\r\n")
            header = f"{' ' * (first.column - 1)}{state.group.value.span.full_text}:{file.newline}"
            text = text.removesuffix(below) + header + below
        texts[state.group_name].append(text)
    text = file.newline.join(text for group in texts.values() for text in group)
    return Edit(Span(file, first.line, 1, end, len(file.line(end)) + 1), text)


def _last_line(state: _State) -> int:
    """Return the last line of a state, or of the comments below it that are indented further than its key."""
    key, line = state.own.key.span, state.own.value.span.end_line
    while (below := key.file.line(line + 1)).lstrip().startswith("#") and below[: key.column].isspace():
        line += 1
    return line


def _edits(state: _State) -> Sequence[Edit]:
    """Return the edits that write the joints of a state as its value; () where a comment or an anchor is in the way."""
    whole, key, joints = state.own.value.span, state.joints.key.span, state.joints.value.span
    group = Span(key.file, *state.group.key.span.start, *state.group.value.span.end)
    if whole.is_flow:
        return [Edit(whole, joints.full_text)] if whole.full_text.count("#") == joints.full_text.count("#") else ()
    is_block = whole.line > state.own.key.span.line and (joints.is_flow or joints.line > key.line)
    is_apart = group.end_line < key.line or joints.end_line < group.line
    last = whole.file.line(whole.end_line)[: whole.end_column - 1]  # empty if a name of a joint is a map
    if not (is_block and is_apart and last.strip() and group.text and group.begins_line and key.begins_line):
        return ()
    between = Span(key.file, *state.own.key.span.end, *joints.start)
    if joints.is_flow and "#" not in between.full_text:
        return [Edit(between, ": "), *([_removal(group)] if group.start > joints.end else [])]
    colon = key.file.line(key.line).index(":", key.end_column - 1) + 1
    edits = [_removal(group), _removal(key._replace(end_column=colon + 1))]
    if joints.line > key.line:
        lines = joints._replace(end_line=_last_line(state)) if joints.end == whole.end else joints
        edits += shift_lines(lines, key.column - joints.column)
    return edits


def _removal(place: Span) -> Edit:
    """Return the edit that removes text, with its line if nothing follows on it."""
    file, line = place.file, place.file.line(place.end_line)
    rest = line[place.end_column - 1 :]
    if rest.strip():
        return Edit(place._replace(end_column=len(line) - len(rest.lstrip()) + 1), "")
    above = place.line - 1
    return Edit(Span(file, above, len(file.line(above)) + 1, place.end_line, len(line) + 1), "")
