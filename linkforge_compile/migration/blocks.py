"""Blocks of calls, such as `*origin`, that a module takes as parameters.

In a module, an element whose number stands for the parameter is where the block goes. What a call gives is read on a
link that carries it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from linkforge_compile.importers.link import SHAPES
from linkforge_compile.migration.nodes import map_of, scalar
from linkforge_compile.migration.symbols import LIST, MAP, Symbol, refer
from linkforge_compile.migration.template import BlockForm, Comment, Content, Element, Text
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode

_SHAPE = "shape"
_IN_LINKS = ("collision", "visual", "inertial")


def form_of(contents: Sequence[Iterable[Content]], *, is_list: bool) -> BlockForm | None:
    """Return what the blocks of all calls are; None if that is no one thing that a parameter can hold."""
    found: set[str] = set()
    for content in contents:
        for one in content:
            if isinstance(one, Comment) or (isinstance(one, Text) and not "".join(map(str, one.parts)).strip()):
                continue
            if not isinstance(one, Element) or _has_material(one):
                return None
            found.add(_SHAPE if one.tag in SHAPES else one.tag)
    tag = found.pop() if len(found) == 1 else ""
    if tag in _IN_LINKS[:2]:
        return BlockForm(tag, is_list)
    one_each = all(sum(isinstance(one, Element) for one in content) == 1 for content in contents)
    return BlockForm(tag, False) if one_each and tag in ("origin", "inertial", _SHAPE) else None


def _has_material(element: Element) -> bool:
    # A module sees no material of its user.
    return any(isinstance(one, Element) and one.tag == "material" for one in element.content)


def block_symbol(name: str, form: BlockForm) -> Symbol:
    """Return the parameter for a block, such as `*origin`."""
    symbol = Symbol(name.lstrip("*"), "parameter", kind=LIST if form.is_list else MAP)
    symbol.is_block = True
    return symbol


def marker(symbol: Symbol, form: BlockForm) -> Element:
    """Return an element that stands where a block goes."""
    stands = (refer(symbol),)
    calls = ("block", symbol.wish)
    ball = Element("sphere", {"radius": stands}, [], calls=calls)
    match form.tag:
        case "origin":
            return Element("origin", {"xyz": stands}, [], calls=calls)
        case "inertial":
            moments: dict[str, tuple[str]] = {f"i{axes}": ("1",) for axes in ("xx", "yy", "zz")}
            moments |= {f"i{axes}": ("0",) for axes in ("xy", "xz", "yz")}
            content: list[Content] = [Element("mass", {"value": stands}, []), Element("inertia", {**moments}, [])]
            return Element("inertial", {}, content, calls=calls)
        case "shape":
            return ball
    return Element(form.tag, {}, [Element("geometry", {}, [ball])], calls=calls)


def carrier(name: str, form: BlockForm, content: Iterable[Content]) -> Element:
    """Return a link that has the elements of a block."""
    inner = list(content)
    if form.tag == "origin":
        ball: Content = Element("geometry", {}, [Element("sphere", {"radius": ("1",)}, [])])
        inner = [Element("collision", {}, [*inner, ball])]
    elif form.tag == _SHAPE:
        inner = [Element("collision", {}, [Element("geometry", {}, inner)])]
    return Element("link", {"name": (name,)}, inner)


def given_block(form: BlockForm, link: YamlMap, where: Span) -> YamlNode | None:
    """Return the value of a parameter that a link carries."""
    if form.tag == "origin":
        collision = link.get("collision")
        origin = collision.get("origin") if isinstance(collision, YamlMap) else None
        if isinstance(origin, YamlMap):
            return origin
        zeros = YamlList(tuple(scalar("0", where, is_text=False) for _ in range(3)), where)
        return map_of({"xyz": origin or zeros}, where)
    node = link.get("collision" if form.tag == _SHAPE else form.tag)
    if not form.is_list or isinstance(node, YamlList):
        return node
    return None if node is None else YamlList((node,), where)


def stands_for_block(node: YamlMap) -> YamlNode | None:
    """Return the number in an element that stands where a block goes; None for one that holds anything else."""
    keys: Collection[str] = node.entries.keys()
    if keys in ({"sphere"}, {"when", "sphere"}):
        return node.get("sphere")
    return node.get("mass") if keys in ({"mass", "inertia"}, {"when", "mass", "inertia"}) else None
