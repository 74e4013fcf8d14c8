"""The program that reads SDF with libsdformat resolves poses, and passes on what the parser complains about."""

from pathlib import Path

import pytest

from tests.libsdformat import read_with_libsdformat

NESTED = """\
<sdf version="1.9">
  <model name="outer">
    <link name="a"><pose>1 2 3 0 0 1.5707963267948966</pose>
      <sensor name="imu" type="imu"><pose>1 0 0 0 0 0</pose></sensor>
    </link>
    <model name="inner">
      <pose>1 0 0 0 0 1.5707963267948966</pose>
      <link name="b"><pose>1 0 0 0 0 0</pose></link>
    </model>
    <joint name="j" type="revolute">
      <parent>a</parent><child>inner::b</child>
      <axis><xyz>1 0 0</xyz><limit><lower>-1</lower><upper>2</upper></limit></axis>
    </joint>
  </model>
</sdf>
"""


def test_poses_and_axes_are_in_the_frame_of_the_outermost_model(tmp_path: Path):
    read = read_with_libsdformat(NESTED, tmp_path, is_strict=True)
    assert read.complaints == []
    assert read.links["inner::b"]["pose"][:3] == pytest.approx([1, 1, 0])
    assert read.links["a"]["sensors"][0]["pose"][:3] == pytest.approx([1, 3, 3])
    (axis,) = read.joints["j"]["axes"]
    assert axis["xyz"] == pytest.approx([0, 1, 0])
    assert (axis["lower"], axis["upper"]) == (-1, 2)


def test_an_unknown_element_is_an_error_if_strict(tmp_path: Path):
    faulty = NESTED.replace("<parent>", "<stiction/><parent>")
    assert read_with_libsdformat(faulty, tmp_path).complaints == []
    assert "XML Element[stiction]" in read_with_libsdformat(faulty, tmp_path, is_strict=True).errors[0]


def test_what_the_parser_prints_is_kept(tmp_path: Path):
    read = read_with_libsdformat(NESTED.replace('"1.9"', '"9.9"'), tmp_path)
    assert "Unable to convert from SDF version 9.9" in read.complaints[0]
