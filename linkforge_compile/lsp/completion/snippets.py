"""Write the bodies of the schema's snippets as YAML, in block and in flow style."""

from __future__ import annotations

import re

from linkforge_compile.schema.json_schema import Json

_STOP = re.compile(r"\$\{\d+(?::(?P<word>[^}]*)|\|(?P<choice>[^,|]*)[^|]*\|)\}|\$\d+")


def in_block(body: Json, indent: int) -> str:
    """Return a map as lines of which all but the first are indented; any other body as in flow style."""
    if not isinstance(body, dict):
        return in_flow(body)
    return f"\n{' ' * indent}".join(_entry(key, value, indent) for key, value in body.items())


def _entry(key: str, value: Json, indent: int) -> str:
    if isinstance(value, dict) and value:
        return f"{key}:\n{' ' * (indent + 2)}{in_block(value, indent + 2)}"
    return f"{key}: {in_flow(value)}"


def in_flow(body: Json) -> str:
    """Return a body on one line, a map in braces."""
    match body:
        case dict():
            return f"{{{entries_in_flow(body)}}}"
        case list():
            return f"[{', '.join(map(in_flow, body))}]"
        case bool():
            return "true" if body else "false"
        case None:
            return ""
    return str(body)


def entries_in_flow(body: dict[str, Json]) -> str:
    """Return the entries of a map on one line, without braces."""
    return ", ".join(f"{key}: {in_flow(value)}" for key, value in body.items())


def without_stops(text: str) -> str:
    """Return the text of a snippet for an editor without snippets: with the first choice at each stop."""
    return _STOP.sub(lambda found: found["word"] or found["choice"] or "", text)


def escaped(text: str) -> str:
    """Return a text as a part of a snippet."""
    return re.sub(r"[$}\\]", r"\\\g<0>", text)
