"""A plain command line is read without argparse, and as argparse reads it."""

import io
from contextlib import redirect_stderr
from importlib import import_module

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkforge_compile.cli.parser import Arguments, Parser

COMMANDS = ("compile", "check", "watch", "diff")

WORDS = (
    *("arm.robot.yaml", "reach:=0.7m", "-", "", "a b", "--", "-5", "-h", "build/"),
    *("-o", "--output", "--out", "-obuild/", "--output=build/", "--format", "urdf", "xml", "json"),
    *("-p", "reach=0.7m", "--parameter", "--variant", "sim", "--gazebo", "classic", "--gazebo=gz"),
    *("-q", "-qq", "--quiet", "--werror", "--select", "LF5", "--tolerance", "1e-6", "--before", "--json"),
)

PLAIN = (
    "arm.robot.yaml",
    "arm.robot.yaml -q reach:=0.7m --werror --werror",
    "-p reach=0.7m arm.robot.yaml --parameter gap=1m --package a=b --gazebo classic",
    "- --variant sim --color never --diagnostics json --allow-outside",
)


def parser_of(command: str) -> Parser:
    parser = Parser(f"linkforge {command}", "a summary")
    import_module(f"linkforge_compile.cli.commands.{command}").add_arguments(parser)
    return parser


class ArgparseAskedError(Exception):
    pass


class Plain(Parser):
    def argument_parser(self):
        raise ArgparseAskedError


def read_plainly(command: str, words: list[str]) -> Arguments:
    """Return what is read of words without argparse, ArgparseAskedError for what takes it."""
    parser = parser_of(command)
    parser.__class__ = Plain
    return parser.parse(words)


def read_by_argparse(command: str, words: list[str]) -> dict[str, object]:
    with redirect_stderr(io.StringIO()):
        said = vars(parser_of(command).argument_parser().parse_intermixed_args(words, Arguments()))
    return {name: value for name, value in said.items() if name != "given"}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("line", PLAIN)
def test_what_is_plain_is_read_without_argparse(command: str, line: str):
    words = line.split()
    assert vars(read_plainly(command, words)) == read_by_argparse(command, words)


@given(st.sampled_from(COMMANDS), st.lists(st.sampled_from(WORDS), max_size=6))
@settings(max_examples=150, deadline=None)
def test_argparse_reads_it_so_too(command: str, words: list[str]):
    try:
        said = read_plainly(command, words)
    except ArgparseAskedError:
        return
    assert vars(said) == read_by_argparse(command, words)


@pytest.mark.parametrize(
    "line",
    [
        "",
        "arm.robot.yaml -h",
        "arm.robot.yaml --var sim",
        "arm.robot.yaml --variant",
        "arm.robot.yaml --variant --quiet",
        "arm.robot.yaml --variant sim --variant sim",
        "arm.robot.yaml --gazebo ignition",
        "arm.robot.yaml --select LF5",
        "arm.robot.yaml -- -5",
        "arm.robot.yaml --sparkling",
    ],
)
def test_argparse_is_asked_for_all_else(line: str):
    with pytest.raises(ArgparseAskedError):
        read_plainly("compile", line.split())
