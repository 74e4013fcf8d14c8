"""Group states whose group, state and joint are nested in another order."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from linkforge_compile.checks.names import Reference
from linkforge_compile.core.models.srdf import GroupState
from linkforge_compile.diagnostics import Diagnostic, UnresolvedNames
from linkforge_compile.diagnostics.codes.names import UNKNOWN_GROUP
from linkforge_compile.diagnostics.entry_fixes import exchange
from linkforge_compile.diagnostics.fix import Fix


def group_of(state: GroupState) -> Reference:
    """Return the reference of a state to its group."""
    return Reference(state.group, f"group state '{state.name}'", state.source, ("group",))


def names_in_order(state: GroupState, groups: Collection[str]) -> tuple[str, ...]:
    """Return group, state and joint of a state that has them in another order; () for any other state."""
    if state.group in groups:
        return ()
    if state.name in groups:
        return state.name, state.group
    group = next((joint for joint in state.joint_values if joint in groups), None)
    return (group, state.name, state.group) if group else ()


def report_states_in_other_order(
    states: Sequence[GroupState], groups: Collection[str], unresolved: UnresolvedNames
) -> Iterator[Diagnostic]:
    """Report each state whose group is not the outermost of its names."""
    for state in states:
        if state.group not in unresolved and (reordered := names_in_order(state, groups)):
            ref = group_of(state)
            names = [name.removeprefix(ref.prefix) for name in reordered]
            hint = f"; the group comes first: write '{': {'.join(names)}: …{'}' * (len(names) - 1)}'"
            fault = ref.report(UNKNOWN_GROUP, name=state.group.removeprefix(ref.prefix), hint=hint)
            is_only = sum(other.group == state.group for other in states) == 1
            yield fault.with_fix(_exchanged_keys(state, names) if is_only else None)


def _exchanged_keys(state: GroupState, names: Sequence[str]) -> Fix | None:
    """Return the fix that exchanges keys so that these names are in this order; None for a state of several joints."""
    source = state.source
    if source is None or (len(names) == 3 and len(state.joint_values) > 1):
        return None
    other = source.node.key_span(names[0]) if len(names) == 3 else source.span
    return exchange(f"write '{names[0]}' first", source.at("group"), other)
