"""Formats that only tests have: one of a file that is no XML, one of several files."""

from linkforge_compile.diagnostics import Code, Severity
from linkforge_compile.formats import Document, Format, Option
from linkforge_compile.formats.source_map import Segment, SourceMap
from linkforge_compile.source.provenance import Kind, Provenance

LONG_NAME = Code("LF7999", Severity.WARNING, "'{name}' is longer than {length} characters")


def _map_of_joints(robot, before=0):
    """Return the map of a document with a line for each joint, after lines without origin."""
    places = [Provenance(Kind.WRITTEN, joint.source.span) for joint in robot.joints]
    return SourceMap((*[()] * before, *((Segment(1, place),) for place in places)))


class Joints(Format):
    """The joints of a robot, one a line, as text."""

    name = "joints"
    suffix = ".joints"
    share_folder = "config"
    description = "the names of the joints"
    keeps = "the names of the joints"
    loses = "all else"
    options = (Option("case", ("lower", "upper"), "lower", "the case of the names"),)

    def render(self, robot, rendering):
        case = getattr(str, self.options[0].value(rendering.options))
        text = "".join(f"{case(joint.name)}\n" for joint in robot.joints)
        return (Document(text, map=_map_of_joints(robot) if rendering.has_map else None),)

    def limits(self, robot, options):
        for joint in robot.joints:
            yield LONG_NAME.at(joint.source, name=joint.name, length=4)


class Folder(Format):
    """Two files: one of YAML, with a source map, and one of text."""

    name = "folder"
    suffix = "_config"
    share_folder = ""
    files = ("config/joints.yaml", "links.txt")
    description = "a folder of files"
    keeps = "nothing"
    loses = "everything"

    def render(self, robot, rendering):
        lines = "".join(f"{joint.name}: [0, 1]\n" for joint in robot.joints)
        return (
            Document(f"joints:\n{lines}", self.files[0], _map_of_joints(robot, 1) if rendering.has_map else None),
            Document("links.txt\n", self.files[1]),
        )


class Limits(Format):
    """A document of YAML, whose suffix is the end of a name."""

    name = "limits"
    suffix = "_limits.yaml"
    share_folder = "config"
    description = "a YAML file"
    keeps = "joints"
    loses = "links"

    def render(self, robot, rendering):
        text = "".join(f"{joint.name}: 0\n" for joint in robot.joints)
        return (Document(text, map=_map_of_joints(robot) if rendering.has_map else None),)
