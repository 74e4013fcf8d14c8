"""When specs are analysed again."""

from pathlib import Path

from linkforge_compile.analysis import analyse_path
from linkforge_compile.lsp.workspace import Workspace


def test_a_spec_whose_included_file_changes_during_its_analysis_is_analysed_again(tmp_path: Path):
    part, whole = tmp_path / "links.robot.yaml", tmp_path / "arm.robot.yaml"
    specs = Workspace()
    specs.put(whole, 1, "linkforge: 1\nname: arm\ninclude: [links.robot.yaml]\n")
    analysis = analyse_path(whole, specs.begin(whole))
    specs.put(part, 1, "linkforge: 1\nlinks: {base: {}}\n")
    specs.keep(whole, analysis)
    assert whole in specs.pending()
    specs.keep(whole, analyse_path(whole, specs.begin(whole)))
    assert whole not in specs.pending()
