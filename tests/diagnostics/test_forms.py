"""Diagnostics for programs: JSON, GitHub's annotations and SARIF."""

import json
import re
from pathlib import Path
from urllib.parse import unquote

import jsonschema
import pytest
from jsonschema import Draft7Validator

from linkforge_compile.diagnostics import Code, Diagnostic, Note, Severity
from linkforge_compile.diagnostics.render_forms import render_github, render_json, render_sarif
from linkforge_compile.diagnostics.render_text import render_text
from linkforge_compile.resources import matcher_file
from linkforge_compile.source import SourceFile, Span
from tests.conftest import ROOT

HEAVY = Code("LF6001", Severity.WARNING, "{mass} kg is a lot")
UNKNOWN = Code("LF4102", Severity.ERROR, "no link named '{name}'")
HINT = Code("LF3022", Severity.NOTE, "nothing sets {names}")

CHECKOUT = Path("/checkout").absolute()
ARM = SourceFile("robots/a, b.robot.yaml", "joints:\n  elbow: {child: hnad}\n", CHECKOUT / "robots/a, b.robot.yaml")
VENDOR = SourceFile("/opt/vendor/hand.robot.yaml", "x\n", Path("/opt/vendor/hand.robot.yaml"))
STDIN = SourceFile("<stdin>", "x\n")
CHILD = Span(ARM, 2, 18, 2, 22)
USE = Span(ARM, 1, 1, 2, 22)

EVERY = (
    HINT.at(Span(VENDOR, 1, 1, 1, 2), names="'reach'"),
    HEAVY.at(USE, mass="50% of 1:2,"),
    UNKNOWN.at(CHILD, name="hnad", notes=[Note("used here", Span(STDIN, 1, 1, 1, 2)), Note("with variant 'sim' only")]),
    UNKNOWN.at(None, name="tool"),
)
FIXABLE = UNKNOWN.at(CHILD, name="hnad", near=["hand"])


def test_json_is_complete_and_fits_its_schema():
    whole = json.loads(render_json(EVERY))
    schema = json.loads((ROOT / "docs" / "diagnostics.schema.json").read_text("utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    jsonschema.Draft7Validator(schema).validate(whole)
    assert whole["version"] == 1
    assert whole["diagnostics"][2] == {
        "code": "LF4102",
        "severity": "error",
        "message": "no link named 'hnad'",
        "file": "robots/a, b.robot.yaml",
        "line": 2,
        "column": 18,
        "end_line": 2,
        "end_column": 22,
        "notes": [
            {"message": "used here", "file": "<stdin>", "line": 1, "column": 1, "end_line": 1, "end_column": 2},
            {
                "message": "with variant 'sim' only",
                "file": None,
                "line": None,
                "column": None,
                "end_line": None,
                "end_column": None,
            },
        ],
        "help": "run 'linkforge explain LF4102'",
        "fixes": [],
    }


def test_json_has_the_fixes():
    whole = json.loads(render_json([FIXABLE]))
    schema = json.loads((ROOT / "docs" / "diagnostics.schema.json").read_text("utf-8"))
    jsonschema.Draft7Validator(schema).validate(whole)
    place = {"file": "robots/a, b.robot.yaml", "line": 2, "column": 18, "end_line": 2, "end_column": 22}
    assert whole["diagnostics"][0]["fixes"] == [
        {"title": "write 'hand'", "is_safe": False, "edits": [{**place, "text": "hand"}]}
    ]


def test_github_annotations_have_no_file_where_there_is_none():
    assert render_github([UNKNOWN.at(Span(STDIN, 1, 1, 1, 2), name="tool")], root=CHECKOUT) == (
        "::error title=LF4102::<stdin>:1:1: no link named 'tool'\n"
    )


def test_json_of_nothing_is_an_empty_list():
    assert json.loads(render_json(())) == {"version": 1, "diagnostics": []}


def test_the_schema_refuses_what_is_no_diagnostic():
    schema = json.loads((ROOT / "docs" / "diagnostics.schema.json").read_text("utf-8"))
    whole = json.loads(render_json(EVERY))
    del whole["diagnostics"][0]["message"]
    assert not jsonschema.Draft7Validator(schema).is_valid(whole)


def test_github_annotations_are_escaped_with_the_worst_first():
    place = "file=robots/a%2C b.robot.yaml"
    assert render_github(EVERY, root=CHECKOUT).splitlines() == [
        f"::error {place},line=2,col=18,endLine=2,endColumn=22,title=LF4102"
        "::no link named 'hnad'%0Aused here: <stdin>:1:1%0Awith variant 'sim' only",
        "::error title=LF4102::no link named 'tool'",
        f"::warning {place},line=1,endLine=2,title=LF6001::50%25 of 1:2, kg is a lot",
        "::notice file=/opt/vendor/hand.robot.yaml,line=1,col=1,endLine=1,endColumn=2,title=LF3022"
        "::nothing sets 'reach'",
    ]


PAGE = "# LF4102: no link\n\nA link is named that\nthe robot does not have.\n\n## Wrong\n"


def sarif_log(diagnostics: tuple[Diagnostic, ...]) -> dict:
    return json.loads(
        render_sarif(diagnostics, root=CHECKOUT, version="1.2.3", manual=lambda _: PAGE, pages=Path("/doc"))
    )


def sarif_run(diagnostics: tuple[Diagnostic, ...]) -> dict:
    log = sarif_log(diagnostics)
    assert log["version"] == "2.1.0"
    (run,) = log["runs"]
    return run


def test_sarif_has_a_rule_for_each_code_and_a_result_for_each_diagnostic():
    run = sarif_run(EVERY)
    driver = run["tool"]["driver"]
    assert (driver["name"], driver["version"]) == ("linkforge", "1.2.3")
    assert [rule["id"] for rule in driver["rules"]] == ["LF3022", "LF4102", "LF6001"]
    assert driver["rules"][1] == {
        "id": "LF4102",
        "shortDescription": {"text": "no link named '…'"},
        "fullDescription": {"text": "A link is named that the robot does not have."},
        "help": {"text": "run 'linkforge explain LF4102'", "markdown": PAGE},
        "helpUri": "file:///doc/LF4102.md",
        "defaultConfiguration": {"level": "error"},
    }
    assert [result["level"] for result in run["results"]] == ["note", "warning", "error", "error"]
    for result, diagnostic in zip(run["results"], EVERY, strict=True):
        assert driver["rules"][result["ruleIndex"]]["id"] == result["ruleId"] == diagnostic.code.id


def test_sarif_names_files_of_the_checkout_from_its_root_and_others_in_full():
    run = sarif_run(EVERY)
    assert run["originalUriBaseIds"]["%SRCROOT%"]["uri"] == CHECKOUT.as_uri() + "/"
    assert run["columnKind"] == "unicodeCodePoints"
    vendor, heavy, unknown, nowhere = run["results"]
    place = unknown["locations"][0]["physicalLocation"]
    assert unquote(place["artifactLocation"]["uri"]) == "robots/a, b.robot.yaml"
    assert place["artifactLocation"]["uriBaseId"] == "%SRCROOT%"
    assert place["region"] == {"startLine": 2, "startColumn": 18, "endLine": 2, "endColumn": 22}
    assert heavy["locations"][0]["physicalLocation"]["region"]["endLine"] == 2
    assert vendor["locations"][0]["physicalLocation"]["artifactLocation"] == {"uri": VENDOR.path.as_uri()}
    assert "locations" not in nowhere


def test_sarif_relates_the_places_of_notes():
    unknown = sarif_run(EVERY)["results"][2]
    (related,) = unknown["relatedLocations"]
    assert related["message"]["text"] == "used here"
    assert related["physicalLocation"]["artifactLocation"]["uri"] == "%3Cstdin%3E"
    assert unknown["message"]["text"] == "no link named 'hnad'\nwith variant 'sim' only"


def test_sarif_has_the_fixes():
    (fix,) = sarif_run((FIXABLE,))["results"][0]["fixes"]
    assert fix["description"] == {"text": "write 'hand'"}
    (change,) = fix["artifactChanges"]
    assert unquote(change["artifactLocation"]["uri"]) == "robots/a, b.robot.yaml"
    region = {"startLine": 2, "startColumn": 18, "endLine": 2, "endColumn": 22}
    assert change["replacements"] == [{"deletedRegion": region, "insertedContent": {"text": "hand"}}]


TEXT = {"type": "object", "required": ["text"], "properties": {"text": {"type": "string", "minLength": 1}}}
URI = {"type": "string", "pattern": r"^[^\s\\\\]+$", "format": "uri-reference"}
COUNT = {"type": "integer", "minimum": 1}
LEVEL = {"enum": ["none", "note", "warning", "error"]}


def closed(required: tuple[str, ...] = (), **properties: object) -> dict[str, object]:
    """Return the schema of an object with these keys and no others."""
    return {"type": "object", "additionalProperties": False, "required": list(required), "properties": properties}


def some(items: object) -> dict[str, object]:
    return {"type": "array", "minItems": 1, "uniqueItems": True, "items": items}


REGION = closed(("startLine",), startLine=COUNT, startColumn=COUNT, endLine=COUNT, endColumn=COUNT)
PLACE = closed(
    ("artifactLocation",), artifactLocation=closed(("uri",), uri=URI, uriBaseId={"const": "%SRCROOT%"}), region=REGION
)
RULE = closed(
    ("id",),
    id={"pattern": r"^LF\d{4}$"},
    shortDescription=TEXT,
    fullDescription=TEXT,
    helpUri={**URI, "pattern": "^[a-z]+:"},
    help={**TEXT, "properties": {**TEXT["properties"], "markdown": {"type": "string"}}},
    defaultConfiguration=closed(level=LEVEL),
)
FIX = closed(
    ("artifactChanges",),
    description=TEXT,
    artifactChanges=some(
        closed(
            ("artifactLocation", "replacements"),
            artifactLocation=PLACE["properties"]["artifactLocation"],
            replacements=some(
                closed(("deletedRegion",), deletedRegion=REGION, insertedContent=closed(text={"type": "string"}))
            ),
        )
    ),
)
RESULT = closed(
    ("message", "ruleId"),
    ruleId={"type": "string"},
    ruleIndex={"type": "integer", "minimum": 0},
    level=LEVEL,
    message=TEXT,
    locations=some(closed(("physicalLocation",), physicalLocation=PLACE)),
    relatedLocations=some(closed(("physicalLocation",), physicalLocation=PLACE, message=TEXT)),
    fixes=some(FIX),
)
RUN = closed(
    ("tool", "results"),
    tool=closed(
        ("driver",),
        driver=closed(("name",), name={"const": "linkforge"}, version={"type": "string"}, rules=some(RULE)),
    ),
    columnKind={"const": "unicodeCodePoints"},
    originalUriBaseIds={
        "type": "object",
        "additionalProperties": closed(("uri",), uri={"type": "string", "pattern": "/$"}),
    },
    results={"type": "array", "items": RESULT},
)
SARIF = closed(("version", "runs"), version={"const": "2.1.0"}, runs=some(RUN), **{"$schema": {"type": "string"}})
"""The objects and keys of SARIF 2.1.0 that are written here, each with its type; no others."""


def test_sarif_is_as_the_standard_has_it():
    Draft7Validator.check_schema(SARIF)
    log = sarif_log((*EVERY, FIXABLE))
    assert [error.message for error in Draft7Validator(SARIF).iter_errors(log)] == []


@pytest.mark.parametrize(
    ("diagnostic", "severity", "message"),
    [(EVERY[2], "error", "no link named 'hnad'"), (EVERY[1], "warning", "50% of 1:2, kg is a lot")],
)
def test_the_problem_matcher_reads_the_text(diagnostic: Diagnostic, severity: str, message: str):
    (matcher,) = json.loads(matcher_file().read_text("utf-8"))["problemMatcher"]
    (pattern,) = matcher["pattern"]
    lines = [found for line in render_text([diagnostic]).splitlines() if (found := re.match(pattern["regexp"], line))]
    (found,) = lines
    assert diagnostic.span is not None
    assert {key: found[pattern[key]] for key in ("file", "line", "column", "severity", "message", "code")} == {
        "file": ARM.name,
        "line": str(diagnostic.span.line),
        "column": str(diagnostic.span.column),
        "severity": severity,
        "message": message,
        "code": diagnostic.code.id,
    }


def test_the_problem_matcher_reads_an_error_without_a_place():
    """GitHub's runner shows a match without a file as an annotation of the step."""
    (matcher,) = json.loads(matcher_file().read_text("utf-8"))["problemMatcher"]
    (pattern,) = matcher["pattern"]
    found = re.match(pattern["regexp"], render_text([EVERY[3]]).rstrip())
    assert found is not None
    assert (found[pattern["file"]], found[pattern["severity"]]) == (None, "error")
    assert (found[pattern["message"]], found[pattern["code"]]) == ("no link named 'tool'", "LF4102")
