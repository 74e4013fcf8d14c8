"""Complete the parameters of modules under `with`, those of the file under `variants`, and their values."""

from __future__ import annotations

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics
from linkforge_compile.listing import ListedParameter, list_parameters, list_use
from linkforge_compile.lsp.completion.context import Context
from linkforge_compile.lsp.completion.items import KNOWN, LIKELY, REQUIRED, Kind, Offer
from linkforge_compile.schema.json_schema import Json
from linkforge_compile.syntax import YamlScalar

_DEPTH_OF_VARIANT = 2
_COMPOSED = ("list", "map", "vector")
"""Types whose values are not offered."""


def offer_arguments(context: Context) -> list[Offer]:
    """Return the parameters that a map of arguments at the position does not have yet."""
    path = context.cursor.path
    ends = context.after_word.lstrip().startswith(":")
    return [
        Offer(
            one.name,
            one.name if ends else f"{one.name}: $0",
            Kind.Variable,
            REQUIRED if one.is_required else KNOWN if one.field else LIKELY,
            facts_of(one),
            one.description,
            one.description,
            is_snippet=not ends,
        )
        for one in parameters_in(context, path)
        if one.name not in context.around
    ]


def parameter_at(context: Context) -> ListedParameter | None:
    """Return the parameter of which the position is the value."""
    *around, name = context.cursor.path or ("",)
    return next((one for one in parameters_in(context, tuple(around)) if one.name == name), None)


def has_arguments(path: tuple[str | int, ...]) -> bool:
    """Whether the map at a path has values for parameters."""
    is_variant = path[:1] == ("variants",) and len(path) == _DEPTH_OF_VARIANT
    return is_variant or (path[-3:-2] == ("modules",) and path[-1:] == ("with",))


def parameters_in(context: Context, path: tuple[str | int, ...]) -> tuple[ListedParameter, ...]:
    """Return the parameters that the map at a path has values for; none if it is not one of arguments."""
    spec = context.readable.spec if context.readable else None
    if spec is None or not has_arguments(path):
        return ()
    loader = context.settings.loader(context.document.path)
    try:
        if path[-1:] != ("with",):
            return list_parameters(spec, loader, Diagnostics()).parameters
        use, macro = (context.node((*path[:-1], key)) for key in ("use", "macro"))
        listing = list_use(spec, use, loader) if isinstance(use, YamlScalar) else None
    except BeyondLimitError:
        return ()
    return listing.settable(macro.text if isinstance(macro, YamlScalar) else None) if listing else ()


def offer_macros(context: Context) -> list[Offer]:
    """Return the macros of the file that the module around the position uses, with their parameters."""
    path = context.cursor.path
    spec = context.readable.spec if context.readable else None
    use = context.node((*path[:-1], "use")) if path[-3:-2] == ("modules",) and path[-1:] == ("macro",) else None
    if spec is None or not isinstance(use, YamlScalar):
        return []
    try:
        listing = list_use(spec, use, context.settings.loader(context.document.path))
    except BeyondLimitError:
        return []
    macros = listing.macros.items() if listing else ()
    return [Offer(name, name, Kind.Function, REQUIRED, ", ".join(one.name for one in has)) for name, has in macros]


def facts_of(one: ListedParameter) -> str:
    """Return the type, the default and the limits of a parameter in short."""
    default = "required" if one.default is None else f"default {one.default}"
    facts = (one.type or "", f"the module's {one.field}" if one.field else default, one.limits)
    return ", ".join(filter(None, facts))


def values_of(one: ListedParameter) -> list[Offer]:
    """Return the choices of a parameter, or else its default."""
    unit = f" {one.unit}" if one.unit else ""
    if one.choices is not None:
        return [Offer(text := _written(choice) + unit, text, Kind.EnumMember, REQUIRED) for choice in one.choices]
    if one.type == "boolean":
        return [Offer(word, word, Kind.EnumMember, REQUIRED) for word in ("true", "false")]
    if one.default and one.type not in _COMPOSED and "$" not in one.default:
        return [Offer(one.default, one.default, Kind.Value, KNOWN, "the default")]
    return []


def _written(value: Json) -> str:
    return ("true" if value else "false") if isinstance(value, bool) else str(value)
