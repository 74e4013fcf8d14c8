"""What a xacro expands to: elements whose values and presence depend on names of a spec."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple, TypeAlias

from linkforge_compile.migration.symbols import Parts, Symbol
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode
from linkforge_compile.syntax.writer import write


@dataclass(eq=False)
class Element:
    """An element with texts for its attributes; `calls` are the calls of macros that it comes from, the inner last."""

    tag: str
    attributes: dict[str, Parts]
    content: list[Content]
    origin: XmlElement | None = None
    calls: tuple[object, ...] = ()


@dataclass(eq=False)
class Choice:
    """Content that exists if an expression is true."""

    test: ast.expr
    content: list[Content]
    origin: XmlElement | None = None


@dataclass(eq=False)
class Text:
    """A text between elements."""

    parts: Parts


@dataclass(eq=False)
class Comment:
    """A comment; `follows` if it ends the line of a tag."""

    text: str
    follows: bool = False


class BlockForm(NamedTuple):
    """What a block of a call is: the tag of its elements or `shape`, and whether they are a list."""

    tag: str
    is_list: bool


@dataclass(eq=False)
class Use:
    """A use of a module, with the values of its parameters; `blocks` are those of its block parameters."""

    module: FileDraft
    arguments: dict[str, Parts]
    origin: XmlElement | None = None
    inline: list[Content] | None = None
    """What the call expands to where it is."""
    attachment: Element | None = None
    """The joint among that which attaches the module."""
    comment: str = ""
    blocks: dict[str, list[Content]] = field(default_factory=dict)


@dataclass(eq=False)
class Kept:
    """A call of a macro that stays a macro of its xacro, with the values of its parameters.

    `parent` and `origin` are what the entry of the module says of the joint that attaches it.
    """

    name: str
    file: Path
    arguments: dict[str, Parts]
    parent: Parts | None
    origin: Element | None
    prefix: str | None


Content: TypeAlias = "Element | Choice | Text | Comment | Use | Kept"


@dataclass(eq=False)
class FileDraft:
    """A spec that is being made: a robot, or the module that a macro becomes.

    `attachment` is the joint that the entry of a module writes, with its parent.
    """

    name: str
    symbols: list[Symbol] = field(default_factory=list)
    content: list[Content] = field(default_factory=list)
    root: XmlElement | None = None
    comment: str = ""
    attachment: Element | None = None
    robot_name: Parts = ()
    robot_attributes: dict[str, Parts] = field(default_factory=dict)
    stem: str = ""
    """The name of its file, without the ending."""
    is_module: bool = False
    blocks: dict[str, tuple[Symbol, BlockForm]] = field(default_factory=dict)
    """The parameters of a module for the blocks of its macro."""

    @property
    def parameters(self) -> list[Symbol]:
        return [symbol for symbol in self.symbols if symbol.role == "parameter"]

    def uses(self) -> Iterator[Use]:
        """Yield the uses of modules in this file."""
        yield from (one for one in walk(self.content) if isinstance(one, Use))


def walk(content: list[Content]) -> Iterator[Content]:
    """Yield content and all that is in it, in its order."""
    for one in content:
        yield one
        if isinstance(one, Element | Choice):
            yield from walk(one.content)


def elements_in(content: list[Content]) -> Iterator[Element]:
    """Yield the elements of a content, also those that exist only if something is true, without those in elements."""
    for one in content:
        if isinstance(one, Choice):
            yield from elements_in(one.content)
        elif isinstance(one, Element):
            yield one


def split(content: list[Content], origins: Collection[XmlElement]) -> tuple[list[Content], list[Content]]:
    """Return a content without the elements that certain ones of the xacro make, and these with their conditions."""
    inner: list[Content] = []
    outer: list[Content] = []
    for one in content:
        if isinstance(one, Choice):
            for made, part in zip((inner, outer), split(one.content, origins), strict=True):
                if part:
                    made.append(Choice(one.test, part, one.origin))
        elif isinstance(one, Element) and one.origin in origins:
            outer.append(one)
        else:
            inner.append(one)
    return inner, outer


@dataclass
class Spec:
    """The comment that begins a spec, its tree, the symbols that it declares by their names, and the tags of raw XML.

    `left_out` are elements of the xacro that have no effect, `notes` the messages about texts that are omitted and
    elements that are grouped by tag.
    """

    head: str
    tree: YamlMap
    names: Mapping[Symbol, str]
    used: Mapping[Symbol, None]
    raw: tuple[str, ...] = field(default=())
    left_out: tuple[Element, ...] = ()
    notes: frozenset[str] = frozenset()
    comments: Mapping[YamlNode, str] = field(default_factory=dict)
    endings: Mapping[YamlNode, str] = field(default_factory=dict)

    @property
    def text(self) -> str:
        return f"{self.head}{write(self.tree, self.comments, self.endings)}"
