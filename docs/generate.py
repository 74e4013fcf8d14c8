"""Writes docs/language.md: the prose of docs/language.in.md, with the keys, units and bounds that the compiler has.

`python docs/generate.py` writes the page. A line `<!-- keys of: a joint -->` becomes the table of what the schema calls
"a joint"; `, besides an object` leaves out the keys that the object has too. `<!-- units -->`, `<!-- functions -->` and
`<!-- bounds -->` become those of the compiler.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import yaml

from linkforge_compile.core.meshes import MAX_TRIANGLES
from linkforge_compile.diagnostics.render_text import MOST_SHOWN
from linkforge_compile.diagnostics.sink import MAX_COUNTED, MAX_KEPT, MAX_REPORTED
from linkforge_compile.expand import parameters
from linkforge_compile.expand.expand_uses import MAX_DEPTH
from linkforge_compile.expressions import operators, parse, refused_syntax
from linkforge_compile.expressions.functions import SIGNATURES
from linkforge_compile.limits import MAX_FILE_BYTES, Limit
from linkforge_compile.load import spec_tree
from linkforge_compile.lower import mesh_solids
from linkforge_compile.schema.json_schema import LONG_FORM, WORDS, Json, Schema, branches, mapping, reference
from linkforge_compile.schema.registry import definitions
from linkforge_compile.syntax import nodes
from linkforge_compile.units import Dimension, number_text, spellings_of, units_of

HERE = Path(__file__).parent
SOURCE = HERE / "language.in.md"
PAGE = HERE / "language.md"

BANNER = "<!-- Written by docs/generate.py from docs/language.in.md and schemas/: edit those, not this page. -->\n\n"

EVERYWHERE = ("when", "for", "extra", "extra_attributes", "extra_inside")
"""What stands in most objects, so that it has a table of its own and no line in theirs."""

_LONGEST_CELL = 72
_DIRECTIVE = re.compile(r"<!-- (keys of: .+|units|functions|bounds) -->")
_DEFAULT = re.compile(r"(?:^|(?<=[.;] ))(?P<value>(?:(?![.;] ).)+?) by default(?P<more>.*?)\.(?:\s|$)")
_REQUIRED = re.compile(r"(?:^|(?<=[.;] ))(?P<value>[Rr]equired[^.]*)\.\s?")
_UNIT = re.compile(r"\[([^\]]+)\]")
_CODE = re.compile(r"`[^`]*`")


def page() -> str:
    """Return the whole page."""
    text = SOURCE.read_text("utf-8")
    sections = _sections(text)

    def written(directive: re.Match[str]) -> str:
        name, _, title = directive[1].partition(": ")
        return _keys_of(*_titles_in(title), sections) if title else _TABLES[name]()

    return BANNER + _DIRECTIVE.sub(written, text)


def objects() -> dict[str, Schema]:
    """Return every object that has keys of its own, by its title."""
    parts = [branch for whole in definitions().values() for branch in branches(whole)]
    known = (part for part in parts if not mapping(part.get("properties", {})).keys() <= {*WORDS, *EVERYWHERE})
    return {str(part["title"]): part for part in known if part.get("title") != LONG_FORM}


def _sections(text: str) -> dict[str, str]:
    """Return the anchor of the section that has the table of each object, by the object's title."""
    anchors, anchor = {}, ""
    for line in text.splitlines():
        if line.startswith("#"):
            anchor = re.sub(r"[^\w -]", "", line.lstrip("# ").lower()).replace(" ", "-")
        elif found := _DIRECTIVE.fullmatch(line):
            anchors[_titles_in(found[1].removeprefix("keys of: "))[0]] = anchor
    return anchors


def _titles_in(directive: str) -> tuple[str, str]:
    title, _, other = directive.partition(", besides ")
    return title, other


def _keys(title: str, other: str) -> Schema:
    if title == "every object":
        return {key: {"$ref": f"#/definitions/{key}"} for key in EVERYWHERE}
    left_out = {*EVERYWHERE, *WORDS, *(mapping(objects()[other]["properties"]) if other else ())}
    return {key: part for key, part in mapping(objects()[title]["properties"]).items() if key not in left_out}


def _keys_of(title: str, other: str, sections: dict[str, str]) -> str:
    """Return an object's keys as a table, then the examples that no cell holds and what the words of keys mean."""
    rows: list[list[str]] = []
    examples: list[str] = []
    meanings: list[str] = []
    for key, part in _keys(title, other).items():
        whole = _whole(mapping(part))
        example = _example(key, whole)
        in_cell = "\n" not in example
        said, unit, default = _told(str(whole["markdownDescription"]).partition("\n\n")[0])
        examples += [] if in_cell else [example]
        meanings += _meanings(key, whole)
        cells = [f"`{key}`", said, _takes(whole, sections), unit, default, f"`{example}`" if in_cell else "below"]
        rows.append(cells)
    table = _table(("key", "what it is", "takes", "unit", "default", "example"), rows)
    block = ["```yaml\n" + "\n".join(examples) + "\n```"] if examples else []
    return "\n\n".join([table, *block, *meanings])


def _whole(schema: Schema) -> Schema:
    """Return a schema with what it refers to; its own words come first."""
    name = reference(schema)
    return {**_whole(mapping(definitions()[name])), **schema} if name else schema


def _example(key: str, schema: Schema) -> str:
    """Return `key: example` on one line, or on several where one would be too long for a cell."""
    block = re.search(r"```yaml\n(.*?)\n```", str(schema["markdownDescription"]), re.DOTALL)
    if block is None:
        listed = schema["examples"]
        assert isinstance(listed, list), "a key without a block has examples"
        return f"{key}: {_scalar(listed[0])}"
    line = _on_one_line(block[1])
    has_empty = "''" in line and "''" not in block[1]
    return block[1] if has_empty or len(line) > _LONGEST_CELL else line


def _scalar(value: Json) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return number_text(value) if isinstance(value, int | float) else str(value)


def _on_one_line(block: str) -> str:
    top = yaml.compose(block, yaml.BaseLoader)
    if not isinstance(top, yaml.MappingNode):
        return block
    for _, value in top.value:
        _flow(value)
    return yaml.serialize(top, Dumper=yaml.BaseDumper, width=1_000).strip()


def _flow(node: yaml.Node) -> None:
    if isinstance(node, yaml.CollectionNode):
        node.flow_style = True
        for part in node.value:
            for one in part if isinstance(part, tuple) else (part,):
                _flow(one)


def _told(description: str) -> tuple[str, str, str]:
    """Return what a description says, its unit, and its default, the latter two as cells of their own."""
    found = _DEFAULT.search(description) or _REQUIRED.search(description)
    said = description.replace(found[0], "", 1).strip().rstrip(";") if found else description
    default = found["value"] + found.groupdict().get("more", "") if found else ""
    units = dict.fromkeys(_UNIT.findall(_CODE.sub("", said)))
    if len(units) == 1:
        said = re.sub(rf"\s*{re.escape('[' + next(iter(units)) + ']')}", "", said)
    ending = "" if not said or said.endswith((".", ")")) else "."
    return said + ending, " or ".join(units), default[:1].lower() + default[1:]


def _takes(schema: Schema, sections: dict[str, str]) -> str:
    """Return what a key takes, linked to the section that tells more."""
    words = [word for branch in branches(schema) for word in _nouns(_whole(branch), sections)]
    return " or ".join(dict.fromkeys(words)) or "any value"


def _nouns(schema: Schema, sections: dict[str, str]) -> Iterator[str]:
    if "anyOf" in schema:
        yield from (word for branch in branches(schema) for word in _nouns(_whole(branch), sections))
        return
    title = str(schema.get("title", ""))
    if title in {"", "an expression", LONG_FORM}:
        return
    inner = schema.get("additionalProperties", schema.get("items"))
    told = title in sections or not isinstance(inner, dict)
    owner = title if told else next(_titles(mapping(inner)), "")
    if "enum" in schema and isinstance(words := schema["enum"], list) and len(words) <= 3:
        yield " or ".join(f"`{word}`" for word in words)
    else:
        yield f"[{title}](#{sections[owner]})" if owner in sections else title


def _titles(schema: Schema) -> Iterator[str]:
    for branch in branches(_whole(schema)):
        yield str(_whole(branch).get("title", ""))


def _meanings(key: str, schema: Schema) -> Iterator[str]:
    for branch in branches(schema):
        words, meanings = _whole(branch).get("enum"), _whole(branch).get("markdownEnumDescriptions")
        if isinstance(words, list) and isinstance(meanings, list) and len(words) > 1:
            listed = [f"- `{word}`: {meaning}" for word, meaning in zip(words, meanings, strict=True)]
            yield "\n".join([f"Words of `{key}`:", "", *listed])


def _table(head: tuple[str, ...], rows: list[list[str]]) -> str:
    """Return a table, without the columns in which no row says anything."""
    kept = [column for column in range(len(head)) if any(row[column] for row in rows)]
    lines = [[head[column] for column in kept], ["---" for _ in kept]]
    lines += [[row[column].replace("|", "\\|") for column in kept] for row in rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _units() -> str:
    rows = [
        [
            dimension.name.lower().replace("_", " "),
            f"`{first}`",
            " ".join(f"`{unit}`" for unit in others),
            _spellings(dimension),
        ]
        for dimension in Dimension
        for first, *others in [units_of(dimension)]
    ]
    return _table(("dimension", "a bare number is in", "other units", "also written"), rows)


def _spellings(dimension: Dimension) -> str:
    """Return the other words that are taken for units of a dimension."""
    return " ".join(f"`{spelling}`" for unit in units_of(dimension) for spelling in spellings_of(unit))


def _functions() -> str:
    return "\n".join(f"- `{function.signature}`".replace(" or ", "`, `") for function in SIGNATURES.values())


def _bounds() -> str:
    mebibyte = 1024 * 1024
    bounds: dict[str, int | str] = {
        "size of a spec or data file": f"{MAX_FILE_BYTES // mebibyte} MiB",
        "depth of nested lists and maps": nodes.MAX_DEPTH,
        "modules within modules": MAX_DEPTH,
        "files included from included files": spec_tree.MAX_DEPTH,
        "included files in all": spec_tree.MAX_INCLUDES,
        "characters of one expression": parse.MAX_LENGTH,
        "depth of one expression": refused_syntax.MAX_DEPTH,
        "bits of a whole number": operators.MAX_INTEGER_BITS,
        "characters of a computed text": operators.MAX_TEXT,
        "characters of a `pattern`, and of the text it is held against": (
            f"{parameters.MAX_PATTERN:,} and {parameters.MAX_TEXT:,}"
        ),
        "size of a mesh file that is read": f"{mesh_solids.MAX_BYTES // mebibyte} MiB",
    }
    shared = {limit.counted.replace("'for'", "`for`"): limit.most for limit in Limit}
    shared["triangles of one of these meshes"] = MAX_TRIANGLES
    reported = {"errors that are reported, and warnings": MAX_KEPT, "errors that are found": MAX_REPORTED}
    reported |= {"warnings and notes that are counted beyond those": MAX_COUNTED}
    reported |= {"diagnostics that the command shows as text": MOST_SHOWN}
    bounds = {**shared, **bounds, **reported}
    rows = [[what, f"{most:,}" if isinstance(most, int) else most] for what, most in bounds.items()]
    return _table(("what", "at most"), rows)


_TABLES: dict[str, Callable[[], str]] = {"units": _units, "functions": _functions, "bounds": _bounds}


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8", newline="\n")
