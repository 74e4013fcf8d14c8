"""Bad specs, each with its expected diagnostics on the lines at fault; what is not expected fails as well."""

import re
from pathlib import Path

import pytest

from linkforge_compile.diagnostics import Code, codes
from linkforge_compile.diagnostics.codes import REGISTER
from tests.urdf_case import check_urdf_case, expected_in_urdf
from tests.yaml_case import check_case, expected

BAD = sorted((Path(__file__).parent / "cases" / "bad").glob("*.yaml"))
BAD_URDF = sorted(path for path in (Path(__file__).parent / "cases").glob("*_urdf/*") if path.suffix != ".srdf")

FAMILIES = [module for module in vars(codes).values() if getattr(module, "__package__", None) == codes.__name__]

# Raised where no spec file of today's language can show them; the named test file does.
WITHOUT_A_CASE = {
    "LF1113": "syntax/test_data.py",
    "LF1115": "formatter/test_format.py",
    "LF3013": "expand/test_modules.py",
    "LF3022": "expand/test_expand.py",
    "LF3028": "expand/test_parameters.py",
    "LF3065": "load/test_includes.py",
    "LF3066": "load/test_includes.py",
    "LF3067": "cli/test_check.py",
    "LF3080": "expand/test_variants.py",
    "LF3081": "expand/test_variants.py",
    "LF3029": "expand/test_parameters.py",
    "LF3302": "diagnostics/test_floods.py",
    "LF3303": "diagnostics/test_floods.py",
    "LF3304": "expand/test_variants.py",
    "LF3403": "checks/test_meshes.py",
    "LF5754": "expand/test_urdf_modules.py",
    "LF6010": "lower/test_mesh_inertia.py",
    "LF6014": "lower/test_mesh_inertia.py",
    "LF6025": "checks/test_meshes.py",
    "LF7006": "cli/test_compile.py",
    "LF7085": "cli/test_compile.py",
    "LF7086": "cli/test_where.py",
    "LF7087": "cli/test_where.py",
    "LF7095": "cli/test_uptodate.py",
    "LF7096": "cli/test_uptodate.py",
    "LF8040": "migration/test_diagnostics.py",
    "LF8041": "migration/test_diagnostics.py",
    "LF8042": "migration/test_diagnostics.py",
    "LF8043": "migration/test_diagnostics.py",
    "LF8044": "migration/test_diagnostics.py",
    "LF8045": "migration/test_diagnostics.py",
    "LF8048": "migration/test_without_effect.py",
    "LF8049": "migration/test_proof.py",
    "LF8050": "migration/test_proof.py",
    "LF8051": "migration/test_bounds.py",
    "LF8052": "migration/test_robot.py",
    "LF7104": "cli/test_compile.py",
    "LF7201": "formats/test_user_templates.py",
    "LF7202": "formats/test_user_templates.py",
    "LF7203": "formats/test_user_templates.py",
    "LF7204": "formats/test_user_templates.py",
    "LF7205": "formats/test_user_templates.py",
    "LF7206": "formats/test_user_templates.py",
    "LF7207": "formats/test_user_templates.py",
    "LF7208": "cli/test_template.py",
    "LF7401": "formats/test_mjcf.py",
    "LF7402": "formats/test_mjcf.py",
    "LF7403": "formats/test_mjcf.py",
    "LF7404": "formats/test_mjcf.py",
    "LF7405": "formats/test_mjcf.py",
    "LF7406": "formats/test_mjcf.py",
    "LF7407": "formats/test_mjcf_control.py",
    "LF7408": "formats/test_mjcf_control.py",
    "LF7409": "formats/test_mjcf_control.py",
    "LF7410": "formats/test_mjcf_losses.py",
    "LF7411": "formats/test_mjcf_losses.py",
    "LF7412": "formats/test_mjcf_losses.py",
    "LF7413": "formats/test_mjcf_losses.py",
    "LF7414": "formats/test_mjcf_losses.py",
    "LF7415": "formats/test_mjcf_losses.py",
    "LF7501": "formats/test_sdf.py",
    "LF7502": "formats/test_sdf.py",
    "LF7503": "formats/test_sdf.py",
    "LF7504": "formats/test_sdf.py",
    "LF7505": "formats/test_sdf.py",
    "LF7506": "formats/test_sdf.py",
    "LF7507": "formats/test_sdf.py",
    "LF7508": "formats/test_sdf.py",
    "LF7509": "formats/test_sdf_names.py",
    "LF7510": "formats/test_sdf_names.py",
    "LF7511": "formats/test_sdf_names.py",
    "LF7512": "formats/test_sdf_nested.py",
    "LF7513": "formats/test_sdf.py",
    "LF7514": "formats/test_sdf.py",
    "LF7515": "formats/test_sdf.py",
    "LF7601": "formats/test_joint_limits.py",
    "LF7602": "formats/test_joint_limits.py",
    "LF7603": "formats/test_ros2_controllers.py",
    "LF7604": "formats/test_ros2_controllers.py",
    "LF7605": "formats/test_ros2_controllers.py",
    "LF7606": "formats/test_ros2_controllers.py",
    "LF7607": "formats/test_ros2_controllers.py",
    "LF7608": "formats/test_moveit.py",
    "LF7609": "formats/test_moveit.py",
    "LF7611": "formats/test_ros2_controllers.py",
    "LF7612": "formats/test_ros2_controllers.py",
    "LF7613": "formats/test_ros2_controllers.py",
    "LF7614": "formats/test_ros2_controllers.py",
    "LF7615": "formats/test_moveit.py",
    "LF7616": "formats/test_moveit.py",
    "LF7617": "formats/test_moveit.py",
    "LF7621": "formats/test_ros2_controllers.py",
    "LF7622": "formats/test_ros2_controllers.py",
    "LF7623": "formats/test_ros2_controllers.py",
    "LF7624": "formats/test_ros2_controllers.py",
    "LF7701": "collisions/test_command.py",
    "LF7702": "collisions/test_command.py",
    "LF7703": "collisions/test_command.py",
    "LF7704": "formats/test_moveit.py",
    "LF8003": "importers/test_xml.py",
    "LF8004": "importers/test_xml.py",
    "LF8098": "importers/test_xml.py",
    "LF8130": "cli/test_import.py",
    "LF8025": "load/test_xacro_arguments.py",
    "LF8031": "load/test_xacro_modules.py",
    "LF8032": "load/test_xacro_modules.py",
    "LF8033": "load/test_xacro_modules.py",
    "LF8034": "load/test_xacro_modules.py",
    "LF8035": "load/test_xacro_modules.py",
    "LF8036": "load/test_xacro_macros.py",
    "LF8037": "load/test_xacro_macros.py",
    "LF8046": "load/test_xacro_macros.py",
    "LF8047": "load/test_xacro_macros.py",
    "LF8038": "load/test_xacro_macros.py",
    "LF8039": "load/test_xacro_faults.py",
    "LF8063": "load/test_xacro_faults.py",
    "LF8066": "load/test_xacro_faults.py",
    "LF8064": "load/test_xacro_faults.py",
    "LF8061": "load/test_xacro_arguments.py",
    "LF8062": "load/test_xacro_arguments.py",
    "LF8190": "importers/test_losses.py",
    "LF8191": "importers/test_losses.py",
    "LF8192": "importers/test_losses.py",
}


@pytest.mark.parametrize("path", BAD, ids=lambda path: path.name)
def test_a_bad_spec_is_reported_at_its_line(path: Path):
    check_case(path)


def test_a_case_is_named_after_a_code_that_it_expects():
    of_modules = {code for file in (BAD[0].parent / "modules").rglob("*.yaml") for code in expected_codes(file)}
    for path in BAD:
        assert path.name.partition("_")[0] in of_modules | expected_codes(path), path.name


def expected_codes(file: Path) -> set[str]:
    return {one.code for one in expected(file.name, file.read_text("utf-8", "replace"))}


@pytest.mark.parametrize("path", BAD_URDF, ids=lambda path: path.name)
def test_a_bad_urdf_is_reported_at_its_line(path: Path):
    check_urdf_case(path)


def test_a_urdf_is_named_after_a_code_that_it_expects():
    for path in BAD_URDF:
        assert path.name.partition("_")[0] in {one.code for one in expected_in_urdf(path)}, path.name


def test_every_code_has_a_case():
    shown = {path.name.partition("_")[0] for path in (*BAD, *BAD_URDF)}
    assert shown | set(WITHOUT_A_CASE) == set(REGISTER)


@pytest.mark.parametrize(("code", "file"), WITHOUT_A_CASE.items())
def test_a_code_without_a_case_is_in_its_test(code: str, file: str):
    """By its id, its name, or the longest run of its words."""
    one = REGISTER[code]
    words = max(re.split(r"\{\w+\}", one.message), key=len).strip()
    names = [name for family in FAMILIES for name, value in vars(family).items() if value is one]
    text = (Path(__file__).parent / file).read_text("utf-8")
    assert any(sign in text for sign in (code, words, *names))


def test_codes_are_numbered_by_family():
    for code in REGISTER.values():
        assert re.fullmatch(r"LF[1-8]\d{3}", code.id)


def test_no_two_codes_share_an_id():
    assert len(FAMILIES) >= 7
    ids = [code.id for family in FAMILIES for code in vars(family).values() if isinstance(code, Code)]
    assert sorted(ids) == sorted(set(ids))
