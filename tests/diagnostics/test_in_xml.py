"""Mistakes in a URDF that is checked or used are reported in terms of URDF."""

from linkforge_compile import compile_file
from linkforge_compile.diagnostics.codes import REGISTER
from tests.conftest import ROOT
from tests.urdf_case import expected_in_xml
from tests.yaml_case import findings_of

CASE = ROOT / "tests" / "cases" / "urdf_in_its_words"
TOLD_ELSEWHERE = {
    "LF3005": "tests/load/test_xacro_modules.py",
    "LF3301": "tests/importers/test_urdf.py",
    "LF5005": "tests/cases/bad_urdf",
    "LF6114": "tests/cases/refused_urdf",
    "LF7085": "tests/cli/test_compile.py",
}


def test_messages_for_xml_have_their_own_wording():
    found = findings_of(compile_file(CASE / "cell.robot.yaml"))
    files = [CASE / name for name in ("arm.urdf", "arm.srdf")]
    assert found == {one for file in files for one in expected_in_xml(file.name, file.read_text("utf-8"))}
    with_words = {code.id for code in REGISTER.values() if code.in_xml}
    assert with_words == {one.code for one in found} | set(TOLD_ELSEWHERE)
