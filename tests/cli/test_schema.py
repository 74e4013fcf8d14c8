"""`linkforge schema`, run as a program."""

import json
from pathlib import Path

from jsonschema import Draft7Validator

from tests.cli.in_process import linkforge


def test_the_schema_is_one_that_validators_take(tmp_path: Path):
    run = linkforge("schema", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    schema = json.loads(run.stdout)
    Draft7Validator.check_schema(schema)
    assert Draft7Validator(schema).is_valid({"linkforge": 1, "name": "arm", "links": {"base": None}})
    assert not Draft7Validator(schema).is_valid({"linkforge": 1, "name": "arm", "linkss": {}})


def test_the_schema_goes_to_a_file_that_is_one(tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text("linkforge: 1")
    assert linkforge("schema", "-o", "arm.robot.yaml", cwd=tmp_path).returncode == 2
    assert (tmp_path / "arm.robot.yaml").read_text() == "linkforge: 1"
    assert linkforge("schema", "-o", "robot.schema.json", cwd=tmp_path).stderr == "wrote robot.schema.json\n"
    assert linkforge("schema", "-o", "robot.schema.json", "-q", cwd=tmp_path).stderr == ""
    assert (tmp_path / "robot.schema.json").read_text() == linkforge("schema", cwd=tmp_path).stdout


def test_the_schema_of_a_workspace_is_not_written_through_a_link_that_leads_out(tmp_path: Path):
    repository, other = tmp_path / "repository", tmp_path / "other.txt"
    (repository / ".git").mkdir(parents=True)
    (repository / ".linkforge").mkdir()
    other.write_text("mine")
    (repository / "a.robot.yaml").write_text("linkforge: 1\nname: a\nlinks: {base: }\n")
    (repository / ".linkforge" / "robot.schema.json").symlink_to(other)
    run = linkforge("schema", "--workspace", cwd=repository)
    assert (run.returncode, other.read_text()) == (2, "mine")
    assert "'.linkforge/robot.schema.json' is reached by a link that leads out of its folder" in run.stderr
    assert linkforge("schema", "--workspace", "-o", "here.json", cwd=repository).returncode == 0
