"""The files that meshes and materials name: those of OBJ, MTL, COLLADA and glTF; and why a mesh cannot be read.

A name is given as it is written, as the loaders of the page request it, and as a path.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple
from urllib.parse import unquote

from linkforge_compile.core.meshes.stl import HEADER, fault_of, is_binary
from linkforge_compile.source.characters import UnreadableError

MESHES = frozenset(("stl", "obj", "dae", "gltf", "glb", "ply"))
TEXTURES = frozenset(("png", "jpg", "bmp", "gif", "webp", "tga"))
_MATERIALS = frozenset(("mtl",))
_BUFFERS = frozenset(("bin",))
_WITH_URIS = ("dae", "gltf", "glb")

_MAX_JSON = 16 * 1024 * 1024
"""The longest JSON of a glTF that is searched for names; its values take twenty times as much memory."""

KINDS: Mapping[str, str] = {"jpeg": "jpg"}
"""The kinds of files by their endings, where these differ."""


class NamedFile(NamedTuple):
    """A name as it is written, its path, and the kinds that the file may have."""

    name: str
    place: str
    kinds: frozenset[str]


def named_files(kind: str, content: bytes) -> Iterator[NamedFile]:
    """Yield each file that a file of some kind names.

    Raises:
        UnreadableError: It is not a file of its kind. Not every fault is found.

    """
    find = _FINDERS.get(kind)
    for name, kinds in dict(find(content)).items() if find else ():
        if name and "\0" not in name and not name.startswith(("data:", "http:", "https:")):
            place = name.removeprefix("file://")
            # Names are URIs in glTF and COLLADA; exporters on Windows write them with backslashes.
            path = unquote(place) if kind in _WITH_URIS else place
            yield NamedFile(name, path.replace("\\", "/"), kinds)


_CUT_OFF = "the file ends before its data does"

_VERTEX = re.compile(rb"vertex", re.IGNORECASE)
_LIBRARY = re.compile(rb"^mtllib[ \t]+([^\r\n]+)", re.MULTILINE)
_MAP = re.compile(rb"^[ \t]*(?:map_\w+|bump|norm|disp)[ \t]+([^\r\n]+)", re.MULTILINE | re.IGNORECASE)
_OPTION = re.compile(r"-(?:bm\s+\S+|[so]\s+\S+\s+\S+\s+\S+)\s*")


def _in_obj(content: bytes) -> Iterator[tuple[str, frozenset[str]]]:
    for match in _LIBRARY.finditer(content):
        yield _text(match[1]), _MATERIALS


def _in_mtl(content: bytes) -> Iterator[tuple[str, frozenset[str]]]:
    for match in _MAP.finditer(content):
        yield " ".join(_OPTION.sub("", _text(match[1])).split()), TEXTURES


def _in_collada(content: bytes) -> Iterator[tuple[str, frozenset[str]]]:
    from lxml import etree

    images = _Images()
    parser = etree.XMLParser(target=images, resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True)
    try:
        etree.fromstring(content.lstrip(), parser)  # RViz reads a file with blanks before its declaration
    except etree.XMLSyntaxError as error:
        raise UnreadableError(_xml_fault(error, content)) from error
    yield from ((name, TEXTURES) for name in images.names)


def _xml_fault(error: SyntaxError, content: bytes) -> str:
    line, rest = error.lineno or 0, content.splitlines()
    is_at_end = line >= len(rest) and (error.offset or 0) >= len(rest[-1].decode("utf-8", "replace"))
    return _CUT_OFF if is_at_end else f"it is not well-formed XML at line {line}"


class _Images:
    """Collect the names of the files of the images in a COLLADA document; keep nothing else.

    The `init_from` of a surface names an image, not a file.
    """

    def __init__(self) -> None:
        self.names: list[str] = []
        self._tags: list[str] = []
        self._text = ""

    def start(self, tag: str | bytes, attrib: object) -> None:
        self._tags.append(str(tag).rpartition("}")[2])
        self._text = ""

    def data(self, data: str | bytes) -> None:
        if self._tags[-1] in _NAMING:
            self._text += str(data)

    def end(self, tag: str | bytes) -> None:
        is_inside, name_of_tag = "image" in self._tags[-3:-1], self._tags.pop()
        if is_inside and name_of_tag in _NAMING and (name := self._text.strip()):
            self.names.append(name)
        self._text = ""

    def comment(self, text: str | bytes) -> None:
        """Called for each comment."""

    def close(self) -> None:
        """Called at the end of the document."""


_NAMING = ("init_from", "ref")


def _in_gltf(content: bytes) -> Iterator[tuple[str, frozenset[str]]]:
    if len(content) > _MAX_JSON:
        return
    try:
        document = json.loads(content)
    except json.JSONDecodeError as error:
        is_cut_off = error.msg.startswith("Unterminated") or not error.doc[error.pos :].strip()
        raise UnreadableError(_CUT_OFF if is_cut_off else f"it is not JSON at line {error.lineno}") from error
    except (ValueError, RecursionError) as error:
        raise UnreadableError("it is not JSON in UTF-8") from error
    for key, kinds in (("buffers", _BUFFERS), ("images", TEXTURES)):
        entries = document.get(key) if isinstance(document, dict) else None
        for entry in entries if isinstance(entries, list) else ():
            if isinstance(entry, dict) and isinstance(uri := entry.get("uri"), str):
                yield uri, kinds


def _in_glb(content: bytes) -> Iterator[tuple[str, frozenset[str]]]:
    """The first chunk of a binary glTF is its JSON, after 12 bytes of the file's header and 8 of the chunk's."""
    if not content.startswith(b"glTF"):
        raise UnreadableError("it does not begin with 'glTF', as a binary glTF does")
    if len(content) < int.from_bytes(content[8:12], "little"):
        raise UnreadableError(_CUT_OFF)
    yield from _in_gltf(content[20 : 20 + int.from_bytes(content[12:16], "little")])


def _in_stl(content: bytes) -> Iterator[tuple[str, frozenset[str]]]:
    """An STL names no file."""
    start = content[:HEADER]
    fault = fault_of(start, len(content))
    if not fault and not is_binary(start, len(content)) and not _VERTEX.search(content):
        fault = "it has no triangles"
    if fault:
        raise UnreadableError(fault)
    return iter(())


def _in_ply(content: bytes) -> Iterator[tuple[str, frozenset[str]]]:
    """A PLY names no file."""
    if not content.startswith(b"ply"):
        raise UnreadableError("it does not begin with 'ply'")
    return iter(())


def _text(name: bytes) -> str:
    return name.decode("utf-8", "replace").strip()


_FINDERS: Mapping[str, Callable[[bytes], Iterator[tuple[str, frozenset[str]]]]] = {
    "obj": _in_obj,
    "mtl": _in_mtl,
    "stl": _in_stl,
    "ply": _in_ply,
    "dae": _in_collada,
    "gltf": _in_gltf,
    "glb": _in_glb,
}
