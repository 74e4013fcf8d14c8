"""What the options of a sweep vary, without compiling anything."""

import re
from pathlib import Path

import pyarrow
import pyarrow.parquet
import pytest

from linkforge_compile.sweep import _set_text, run
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.sweep.plan import Choice, Plan, plan_of
from linkforge_compile.sweep.rows import reserved_columns
from linkforge_compile.sweep.store import Chunk
from linkforge_compile.sweep.work import Request, values_of
from tests.sweep.specs import write_arm


def plan(tmp_path: Path, *sets: str, fixed: tuple[str, ...] = (), **choice: object) -> Plan:
    request = Request(str(write_arm(tmp_path)), "arm", fixed)
    return plan_of(request, Choice(sets, **choice))


def texts(plan: Plan, name: str) -> list[str]:
    return [point.values[name] for point in plan.points_of(Chunk(0, plan.size))]


def numbers(plan: Plan, name: str) -> list[object]:
    return [values_of(plan.request, point)[name] for point in plan.points_of(Chunk(0, plan.size))]


def test_a_range_has_both_ends_and_equal_steps(tmp_path: Path):
    assert texts(plan(tmp_path, "reach=0.4m:1m:4"), "reach") == ["0.4 m", "0.6 m", "0.8 m", "1 m"]


def test_a_range_is_computed_exactly_and_rounded_once(tmp_path: Path):
    """0.1 + 2 * 0.1 is 0.30000000000000004 as a sum of doubles."""
    assert numbers(plan(tmp_path, "reach=0.2:0.4:3"), "reach") == [0.2, 0.3, 0.4]


def test_a_range_in_degrees_has_whole_degrees(tmp_path: Path):
    assert texts(plan(tmp_path, "bend=10deg:90deg:5"), "bend") == ["10 deg", "30 deg", "50 deg", "70 deg", "90 deg"]


def test_the_units_of_the_ends_may_differ(tmp_path: Path):
    assert numbers(plan(tmp_path, "reach=40cm:0.8:3"), "reach") == [0.4, 0.6, 0.8]


def test_the_last_axis_varies_fastest(tmp_path: Path):
    grid = plan(tmp_path, "reach=0.4m,1m", "tool=hand,hook", variants=("sim", "real"))
    points = grid.points_of(Chunk(0, grid.size))
    assert [(one.values["reach"], one.values["tool"], one.variant) for one in points] == [
        (reach, tool, variant) for reach in ("0.4m", "1m") for tool in ("hand", "hook") for variant in ("sim", "real")
    ]
    assert [one.index for one in points] == list(range(8))


def test_integers_and_booleans_are_listed(tmp_path: Path):
    grid = plan(tmp_path, "fingers=1:5:3", "is_long=true,false")
    assert numbers(grid, "fingers") == [1, 1, 3, 3, 5, 5]
    assert numbers(grid, "is_long") == [True, False] * 3


def test_a_value_in_quotes_may_have_commas(tmp_path: Path):
    assert texts(plan(tmp_path, 'title="a,b",c'), "title") == ["a,b", "c"]
    assert texts(plan(tmp_path, 'offset="[0, 0, 1 m]", "[0, 1 cm, 0]"'), "offset") == ["[0, 0, 1 m]", "[0, 1 cm, 0]"]


def test_values_of_python_are_written_as_set_has_them():
    """Commas, lists and truth values survive."""
    assert _set_text("title", ["a,b", 'say "c"']) == 'title="a,b","say ""c"""'
    assert _set_text("offset", [[0, 0, "1 m"]]) == 'offset="[0, 0, ""1 m""]"'
    assert _set_text("is_long", [True, False]) == "is_long=true,false"
    assert _set_text("reach", [0.1 + 0.2]) == "reach=0.30000000000000004"


@pytest.mark.parametrize(
    ("sets", "message"),
    [
        (["offset=[0,0,1],[0,0,2]"], "'offset' is a vector; write each in double quotes"),
        (['title="a,b'], "the values of 'title' cannot be read: unexpected end of data"),
        (["reach=0.4m:1m"], "a range is START:STOP:COUNT, found 'reach=0.4m:1m'; add a COUNT, or --sample N"),
        (["reach=0.4m:1m:1"], "the COUNT of 'reach' is a whole number from 2, found '1'"),
        (["fingers=2:5:3"], "'fingers' takes whole numbers, and this range gives 3.5; .* such as 2:5:4"),
        (["reach=a:b:3"], "an end of a range of 'reach' is a length"),
        (["reach=0.4m,,1m"], "'reach' has an empty value"),
        (["reach"], "takes NAME=START:STOP:COUNT"),
        (["reach=0.2:1:2000", "bend=0:1:2000"], "this sweep has 4,000,000 points, more than 1,000,000"),
        (["reach=0.2:1:2000000"], "this sweep has 2,000,000 points"),
        ([], r"nothing is varied; .*\(parameters: reach, fingers, tool, bend, is_long, offset, title\)"),
    ],
)
def test_what_cannot_be_read_is_refused(tmp_path: Path, sets: list[str], message: str):
    with pytest.raises(SweepError, match=message):
        plan(tmp_path, *sets)


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ('offset="[0, 0]","[0, 0, 1]"', "1:14", "parameter 'offset' takes three numbers, found a list of 2"),
        ("raech=1m,2m", "1:7", "no parameter named 'raech'; did you mean 'reach'?"),
        ("reach=1m,5m", "1:16", "parameter 'reach' must be at most 2 m, found '5m'"),
        ("reach=0.1m:1m:3", "1:13", "parameter 'reach' must be at least 0.2 m, found '0.1m'"),
        ("tool=hand,hok", "1:17", "parameter 'tool' must be one of hand, hook, found 'hok'; did you mean 'hook'?"),
        ("reach=1kg,2kg", "1:13", "parameter 'reach' takes a length in m, cm or mm, found '1kg', which is a mass"),
    ],
)
def test_a_wrong_value_is_reported_at_its_place(tmp_path: Path, text: str, place: str, message: str):
    with pytest.raises(SweepError) as caught:
        plan(tmp_path, text)
    first = caught.value.diagnostics[0]
    assert (str(first.span), first.message) == (f"<command line>:{place}", message)


def test_a_parameter_is_not_varied_twice_or_fixed_as_well(tmp_path: Path):
    with pytest.raises(SweepError) as caught:
        plan(tmp_path, "reach=1m,2m", "reach=1.5m,1m")
    assert caught.value.diagnostics[0].message == "parameter 'reach' is set twice"
    with pytest.raises(SweepError, match="no parameter named 'raech'; did you mean 'reach'"):
        plan(tmp_path, "reach=1m,2m", fixed=("raech=1m",))
    with pytest.raises(SweepError, match="'reach' is varied, and set for all robots with -p reach=VALUE"):
        plan(tmp_path, "reach=1m,2m", fixed=("reach=1m",))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"grid": {"reach": [9]}}, "<grid>:1:7: error: parameter 'reach' must be at most 2 m, found '9 m'"),
        (
            {"grid": {"reach": "0.4m:1m"}},
            "found 'reach=0.4m:1m'; add a COUNT, or sample=N",
        ),
        ({"grid": {"reach": []}}, "grid takes values by parameter, such as {'reach': '0.4m:1m:20'}"),
        ({}, "nothing is varied; write grid={'NAME': 'START:STOP:COUNT'}"),
        ({"grid": {"reach": "0.2:1:2000000"}}, "allow it with max_points=2000000"),
        ({"grid": {"reach": [1]}, "where": "$(raech > 1)"}, "<where>:1:3: error: no parameter"),
        ({"grid": {"reach": [1]}, "parameters": {"raech": 1}}, "<parameters>:1:1: error: no parameter named 'raech'"),
        ({"values": "none.csv"}, "values none.csv: No such file or directory"),
        ({"grid": {"reach": [1]}, "jobs": 0}, "jobs takes a whole number from 1, found 0"),
        ({"sample": 9, "seed": 1.5}, "seed takes a whole number, found 1.5"),
        ({"sample": 0}, "sample takes a whole number from 1, found 0"),
        ({"grid": {"reach": [1]}, "chunk": 1.5}, "chunk takes a whole number from 1, found 1.5"),
        ({"grid": {"reach": [1]}, "pack": "rar"}, "pack takes folders, tar, zip or none, found 'rar'"),
        ({"grid": {"reach": [1]}, "variants": ["simm"]}, "there is no variant 'simm'"),
    ],
)
def test_in_python_messages_name_the_arguments(tmp_path: Path, arguments: dict[str, object], message: str):
    with pytest.raises(SweepError, match=re.escape(message)) as caught:
        run(write_arm(tmp_path), **arguments)
    assert "--" not in str(caught.value)


def test_in_python_a_sweep_that_differs_names_the_arguments(tmp_path: Path):
    spec, output = write_arm(tmp_path), tmp_path / "out"
    run(spec, {"reach": [1, 2]}, output=output)
    with pytest.raises(SweepError, match="continue it with resume=True"):
        run(spec, {"reach": [1, 2]}, output=output)
    with pytest.raises(SweepError, match="resume=True cannot continue it:\n  grid: reach=1,2 before, reach=1 now"):
        run(spec, {"reach": [1]}, output=output, resume=True)


# Samples


def test_samples_lie_within_the_limits_of_each_parameter(tmp_path: Path):
    """`bend` is unbounded, so that it keeps its default."""
    drawn = plan(tmp_path, sample=200, seed=3)
    assert all(0.2 <= one <= 2 for one in numbers(drawn, "reach"))
    assert set(numbers(drawn, "fingers")) == {1, 2, 3, 4, 5}
    assert set(numbers(drawn, "tool")) == {"hand", "hook"}
    assert set(numbers(drawn, "is_long")) == {True, False}
    assert "bend" not in drawn.points[0].values


def test_an_integer_needs_a_whole_number_between_its_limits(tmp_path: Path):
    spec = write_arm(tmp_path)
    spec.write_text(spec.read_text().replace("minimum: 1, maximum: 5", "minimum: 1.2, maximum: 1.8"))
    with pytest.raises(SweepError, match=r"'fingers' has no integer to draw between 1\.2 and 1\.8"):
        plan_of(Request(str(spec), "arm"), Choice(sample=3))


def test_a_sample_is_uniform_over_its_interval(tmp_path: Path):
    drawn = numbers(plan(tmp_path, "reach=50cm:1m", sample=2000), "reach")
    quarters = [sum(0.5 + 0.125 * i <= one < 0.625 + 0.125 * i for one in drawn) for i in range(4)]
    assert all(430 < count < 570 for count in quarters)


def test_more_samples_and_another_parameter_keep_those_drawn_before(tmp_path: Path):
    few, many = plan(tmp_path, sample=5, seed=7), plan(tmp_path, "bend=0:1", sample=50, seed=7)
    assert numbers(many, "reach")[:5] == numbers(few, "reach")
    assert numbers(plan(tmp_path, sample=5, seed=8), "reach") != numbers(few, "reach")


def test_the_text_of_a_sample_reads_back_to_its_number(tmp_path: Path):
    drawn = plan(tmp_path, "bend=0:90deg", sample=50)
    for text, number in zip(texts(drawn, "bend"), numbers(drawn, "bend"), strict=True):
        assert text == f"{number!r} rad"


def test_a_named_parameter_without_limits_needs_an_interval(tmp_path: Path):
    with pytest.raises(
        SweepError, match=r"'bend' has no minimum and maximum to sample between; write --set bend=LO:HI"
    ):
        plan(tmp_path, "bend", sample=3)


# Tables of values


def test_the_rows_of_a_csv_are_points(tmp_path: Path):
    table = tmp_path / "points.csv"
    table.write_text("reach,tool,variant\n0.5m,hand,sim\n1.5,hook,real\n")
    read = plan(tmp_path, values=table)
    assert numbers(read, "reach") == [0.5, 1.5]
    assert [read.points[i].variant for i in (0, 1)] == ["sim", "real"]


def test_a_csv_of_a_spreadsheet(tmp_path: Path):
    """With a mark of the byte order, carriage returns, an empty last line, and quotes around commas and line ends."""
    table = tmp_path / "points.csv"
    table.write_bytes(
        b'\xef\xbb\xbfreach,fingers,title,offset\r\n0.5m,2.0,"a,b","[0, 0, 1]"\r\n1,3,"c\nd","[0, 1, 0]"\r\n\r\n'
    )
    read = plan(tmp_path, values=table)
    assert (numbers(read, "reach"), numbers(read, "fingers")) == ([0.5, 1], [2, 3])
    assert (texts(read, "title"), texts(read, "offset")) == (["a,b", "c\nd"], ["[0, 0, 1]", "[0, 1, 0]"])


def test_an_empty_cell_leaves_the_default(tmp_path: Path):
    """In a CSV and, as null, in Parquet; without a variant, the robot has none."""
    table = tmp_path / "points.csv"
    table.write_text("reach,tool,variant\n0.5m,,sim\n,hook,\n")
    rows = [{"reach": 0.5}, {"tool": "hook"}]
    read = plan(tmp_path, values=table)
    assert [values_of(read.request, read.points[i]) for i in (0, 1)] == rows
    assert [read.points[i].variant for i in (0, 1)] == ["sim", None]
    columns = {"reach": [0.5, None], "tool": [None, "hook"]}
    pyarrow.parquet.write_table(pyarrow.table(columns), tmp_path / "points.parquet")
    read = plan(tmp_path, values=tmp_path / "points.parquet")
    assert [values_of(read.request, read.points[i]) for i in (0, 1)] == rows


@pytest.mark.parametrize(("mark", "shown"), [(";", "';'"), ("\t", "tabs")])
def test_columns_without_commas_are_refused(tmp_path: Path, mark: str, shown: str):
    table = tmp_path / "points.csv"
    table.write_text(f"reach{mark}tool\n0,5{mark}hand\n")
    with pytest.raises(SweepError, match=rf"points\.csv: the columns are separated by {shown}; write commas"):
        plan(tmp_path, values=table)


def test_the_table_of_another_sweep_is_refused(tmp_path: Path):
    names = sorted({*reserved_columns(), "width"})
    (tmp_path / "points.csv").write_text(",".join(names) + "\n" + ",".join("1" for _ in names) + "\n")
    spec = tmp_path / "bare.robot.yaml"
    spec.write_text("linkforge: 1\nname: bare\nparameters: {reach: 1 m}\nlinks: {base: {}}\n")
    with pytest.raises(SweepError, match="the table of a sweep, whose parameters are not those of this spec"):
        plan_of(Request(str(spec), "bare"), Choice(values=tmp_path / "points.csv"))


def test_a_parquet_has_numbers_in_si(tmp_path: Path):
    table = tmp_path / "points.parquet"
    pyarrow.parquet.write_table(pyarrow.table({"reach": [0.1 + 0.2, 1.0], "is_long": [True, False]}), table)
    read = plan(tmp_path, values=table)
    assert numbers(read, "reach") == [0.1 + 0.2, 1.0]
    assert numbers(read, "is_long") == [True, False]


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("tool,raech\nhand,1\n", "1:6", "no parameter named 'raech'; did you mean 'reach'?"),
        ("tool,reach\nhand,1\nhand,3\n", "3:6", "parameter 'reach' must be at most 2 m, found '3 m'"),
    ],
)
def test_a_wrong_table_is_reported_at_its_line(tmp_path: Path, text: str, place: str, message: str):
    table = tmp_path / "points.csv"
    table.write_text(text)
    with pytest.raises(SweepError) as caught:
        plan(tmp_path, values=table)
    first = caught.value.diagnostics[0]
    assert (str(first.span), first.message) == (f"{table}:{place}", message)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("points.csv", "reach,tool\n1m,hand\n1m\n", ":3:1: expected 2 values, as the first line has, found 1"),
        ("points.csv", 'reach,tool\n1m,hand\n"1m,hand\n', ":3: cannot be read as CSV: unexpected end of data"),
        ("points.csv", "reach\n", ": the table has no rows; the first line has names, the others values"),
        ("points.pq", "PAR1\xff", "; save it as UTF-8; the name of a Parquet file ends in .parquet"),
        ("points.parquet", "reach\n1m\n", " cannot be read as Parquet: "),
    ],
)
def test_a_file_that_is_no_table_is_refused(tmp_path: Path, name: str, content: str, message: str):
    table = tmp_path / name
    table.write_text(content, "latin-1")
    with pytest.raises(SweepError, match=f"{re.escape(name)}.*{re.escape(message)}"):
        plan(tmp_path, values=table)


def test_what_is_wrong_with_a_header_is_reported_with_the_rows(tmp_path: Path):
    """As of a file that is no table."""
    table = tmp_path / "points.csv"
    table.write_text("linkforge: 1\nname: arm\nlinks: {a: {}, b: {}}\n")
    with pytest.raises(
        SweepError, match=r"points\.csv:3:1: expected 1 value, as the first line has, found 2"
    ) as caught:
        plan(tmp_path, values=table)
    assert [one.message for one in caught.value.diagnostics] == ["no parameter named 'linkforge: 1'"]


def test_a_table_that_is_missing(tmp_path: Path):
    with pytest.raises(SweepError, match=r"points\.parquet: No such file or directory$"):
        plan(tmp_path, values=tmp_path / "points.parquet")


# Conditions


def test_points_that_a_condition_leaves_out_keep_their_index(tmp_path: Path):
    kept = plan(tmp_path, "reach=0.4m,0.8m,1.2m,1.6m", "fingers=1,4", where="$(reach > 0.3 * fingers and half < 0.8)")
    assert [point.index for point in kept.points_of(Chunk(0, kept.size))] == [0, 2, 4]
    assert (kept.size, len(kept.points)) == (3, 8)


def test_a_condition_may_be_written_without_brackets(tmp_path: Path):
    assert texts(plan(tmp_path, "reach=0.4m,1m", where="reach > 0.5"), "reach") == ["1m"]


@pytest.mark.parametrize(
    ("where", "column", "message"),
    [
        ("$(raech > 1)", 11, "no parameter, variable or 'for' name 'raech' here; did you mean 'reach'?"),
        ("$(reach > )", 19, None),
        ("$(reach > tool)", 19, None),
        ("$(1 / (fingers - 2) > 1)", 16, "'/' divides by zero"),
    ],
)
def test_a_fault_of_a_condition_is_reported_at_its_place(tmp_path: Path, where: str, column: int, message: str | None):
    with pytest.raises(SweepError) as caught:
        plan(tmp_path, "reach=1m,2m", "fingers=2,3", where=where)
    first = caught.value.diagnostics[0]
    assert first.span.file.text == f"--where {where}"
    assert first.span.column == column
    assert message in (None, first.message)


def test_a_condition_is_true_or_false(tmp_path: Path):
    with pytest.raises(SweepError, match="--where takes an expression that is true or false, found a length"):
        plan(tmp_path, "reach=1m,2m", where="$(reach)")
    with pytest.raises(SweepError, match="is true at no point"):
        plan(tmp_path, "reach=1m,2m", where="$(reach > 9)")
