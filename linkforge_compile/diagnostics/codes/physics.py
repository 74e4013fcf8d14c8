"""LF6xxx: masses and inertias that no body has, and interfaces that no hardware can serve."""

from linkforge_compile.diagnostics.diagnostic import Code, Severity
from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.source.provenance import Location

_E, _W, _N = Severity.ERROR, Severity.WARNING, Severity.NOTE
_VALUE = Location.VALUE

# LF60xx: mass and inertia
ZERO_INERTIA = Code(
    "LF6001",
    _W,
    "link '{link}' has a mass of {mass} kg and an inertia of zero",
    _VALUE,
    subject="link",
    grouped_by=("mass",),
)
INDEFINITE_INERTIA = Code(
    "LF6002", _W, "principal moments of inertia of link '{link}' must be above 0, found {moments}", _VALUE
)
IMPOSSIBLE_INERTIA = Code(
    "LF6003",
    _W,
    "one principal moment of inertia of link '{link}' exceeds the sum of the others, found {moments}",
    _VALUE,
)
FLATTER_THAN_A_PLATE = Code(
    "LF6007",
    _N,
    "the largest principal moment of inertia of link '{link}' exceeds the sum of the others by {excess} %; "
    'MuJoCo refuses such a link, unless <compiler balanceinertia="true"/> is set',
    _VALUE,
    subject="link",
    grouped_by=("excess",),
)
MASSLESS_BODY = Code(
    "LF6004",
    _N,
    "joint '{joint}' moves link '{link}', which has no mass: Gazebo drops it with everything below it{also}",
)
MASSLESS_ROOT = Code("LF6006", _N, "root link '{link}' has no mass: Gazebo drops it with everything below it{also}")
TINY_MASS = Code("LF6005", _W, "joint '{joint}' moves link '{link}' of {mass} kg, which Gazebo drops as massless")

# LF601x: meshes whose inertia is to be computed
NO_MESH_LIBRARY = Code(
    "LF6010",
    _E,
    "the inertia of mesh '{path}' needs the Python package {library}; run \"pip install "
    "'linkforge-compile[mesh]'\", or specify 'inertia'",
)
NO_SUCH_MESH = Code("LF6011", _E, "there is no mesh '{path}', so no inertia can be computed from it", _VALUE)
UNREADABLE_MESH = Code("LF6012", _E, "mesh '{path}' cannot be read, so no inertia can be computed from it: {reason}")
MESH_OF_OTHER_FORMAT = Code("LF6013", _E, "no inertia can be computed from '{path}': {reason}")
MESH_TOO_LARGE = Code(
    "LF6014", _E, "mesh '{path}' is too large to compute an inertia from: {reason}; give it a simpler collision mesh"
)
EMPTY_MESH = Code("LF6015", _E, "mesh '{path}' has no shape: {reason}")
OPEN_MESH = Code("LF6016", _E, "mesh '{path}' is not watertight: {reason}; close it, or specify 'inertia'")
TWISTED_MESH = Code("LF6017", _E, "mesh '{path}' faces both ways: {reason}; make its normals consistent")
INSIDE_OUT_MESH = Code("LF6018", _E, "mesh '{path}' is inside out: {reason}; flip its normals")
FLAT_MESH = Code("LF6019", _E, "mesh '{path}' is not a solid body: {reason}")
WIDE_MESH = Code(
    "LF6020",
    _W,
    "mesh '{path}' is {size} metres wide; write 'scale: 0.001' if it is in millimetres",
    in_xml="mesh '{path}' is {size} metres wide; write 'scale=\"0.001 0.001 0.001\"' if it is in millimetres",
)

# LF602x, past the width: mesh files that are at hand
MISSING_MESH = Code("LF6021", _W, "there is no mesh '{path}'")
HOLLOW_MESH_FILE = Code("LF6022", _W, "mesh '{path}' contains no shape: {reason}")
CAD_MESH = Code(
    "LF6023", _W, "mesh '{path}' is a .{ending} file, which no URDF reader loads; export it as .stl or .dae"
)
MIRRORED_COLLISIONS = Code(
    "LF6024",
    _N,
    "collision meshes of {links} are mirrored by their scale, and Gazebo Sim creates no collisions from them",
)
FINE_COLLISIONS = Code(
    "LF6025", _N, "collisions of {links} are the visual meshes, with {triangles} triangles; contacts will be slow"
)
MISSPELT_PACKAGE = Code("LF6026", _W, "package '{name}' of mesh '{path}' is not found")

# LF603x: mass and inertia against the shapes
LIGHT_LINK = Code(
    "LF6030",
    _W,
    "link '{link}' of {mass} kg is lighter than air: {density} kg/m³ in its shapes; is one of the units wrong?",
)
DENSE_LINK = Code(
    "LF6031",
    _W,
    "link '{link}' of {mass} kg is denser than any metal: {density} kg/m³ in the box around its shapes; "
    "is one of the units wrong?",
)
LARGE_INERTIA = Code("LF6032", _W, "inertia of link '{link}' is {factor} times that of the box around its shapes{hint}")
SMALL_INERTIA = Code("LF6033", _N, "inertia of link '{link}' is {factor} of that of the box around its shapes")
WIDE_INERTIA = Code(
    "LF6034", _W, "inertia of link '{link}' is that of {mass} kg in a body {size} m wide; is it in kg*mm^2 or g*mm^2?"
)
FAR_CENTRE = Code(
    "LF6035", _W, "centre of mass of link '{link}' is {distance} m away from its shapes, which are {size} m in size"
)
TURNED_PRODUCTS = Code(
    "LF6036",
    _W,
    "inertia of link '{link}' is that of its shapes with the opposite signs of ixy, ixz and iyz; change all three",
)

# LF604x: links that Gazebo merges
BLOCK_OF_MERGED_JOINT = Code(
    "LF6040",
    _N,
    "Gazebo merges the links of fixed joint '{joint}' and drops this; set `preserveFixedJoint: true` in it",
    in_xml="Gazebo merges the links of fixed joint '{joint}' and drops this; write "
    "<preserveFixedJoint>true</preserveFixedJoint> in it",
    subject="joint",
)
MERGED_LINK_NAMED = Code(
    "LF6041",
    _N,
    "Gazebo merges '{link}' into '{parent}', so this plugin finds no such link; set "
    "`preserveFixedJoint: true` in the `gazebo` of joint '{joint}'",
    in_xml="Gazebo merges '{link}' into '{parent}', so this plugin finds no such link; write "
    "<preserveFixedJoint>true</preserveFixedJoint> in the <gazebo> of joint '{joint}'",
)

# LF605x: shapes to see and to touch
UNTOUCHED_VISUALS = Code(
    "LF6050",
    _N,
    "link '{link}' has a visual and no collision, so everything passes through it",
    subject="link",
)
UNSEEN_COLLISIONS = Code(
    "LF6051",
    _N,
    "link '{link}' has a collision and no visual, so it collides but is invisible",
    subject="link",
)

# LF61xx: ros2_control
COMMANDED_TWICE = Code("LF6101", _E, "interface '{interface}' is already commanded by {first}")
READ_TWICE = Code("LF6102", _W, "interface '{interface}' is already read by {first}")
FIXED_JOINT_CONTROLLED = Code("LF6103", _W, "joint '{joint}' is fixed, so ros2_control has nothing to read or command")
MIMIC_COMMANDED = Code(
    "LF6104",
    _W,
    "joint '{joint}' mimics '{leader}', so ros2_control refuses to command it; keep only its state interfaces",
)
MIMIC_APART = Code(
    "LF6105",
    _W,
    "joint '{joint}' mimics '{leader}', which is not in this ros2_control system; list both joints in one system",
)
NO_MIMIC = Code("LF6106", _W, "joint '{joint}' should mimic another joint in ros2_control, but has no 'mimic' itself")
UNKNOWN_INTERFACE = Code("LF6107", _W, "ros2_control defines no interface '{name}'")
PARAMETER_NO_NUMBER = Code("LF6108", _W, "{parameter} must be a number in SI units for ros2_control, found '{found}'")
RANGE_CROSSED = Code("LF6109", _W, "min must not be above max, found {min} and {max}")
RANGE_OUTSIDE_LIMITS = Code("LF6110", _W, "joint '{joint}' goes {range}, which does not overlap with {min} to {max}")
STARTS_OUTSIDE_LIMITS = Code("LF6111", _W, "joint '{joint}' goes {range}, but starts at {found}")
NO_INTERFACE = Code("LF6112", _N, "{owner} has no interface, so no controller can use it")
UNRESOLVED_PACKAGE = Code(
    "LF6114",
    _W,
    "plugin '{plugin}' opens '{path}' as a plain file name, without resolving the package; write '$(path('{path}'))'",
    fix=Replacement("{path}", "$(path('{path}'))"),
    in_xml="plugin '{plugin}' opens '{path}' as a plain file name, without resolving the package; write the path of "
    "the file, in a xacro '$(find {package})'",
)
RANGE_FAR_BEYOND = Code(
    "LF6185",
    _W,
    "{interface} of joint '{joint}' has a range to {found}, far beyond its limit of {limit} {si}; {remedy}",
    in_xml="{interface} of joint '{joint}' has a range to {found}, far beyond its limit of {limit} {si}; {in_si}",
)
NO_SIMULATOR_PLUGIN = Code(
    "LF6113",
    _N,
    "'{plugin}' runs in Gazebo's plugin '{needed}', which this robot does not load; add it to 'gazebo'",
    in_xml="'{plugin}' runs in Gazebo's plugin '{needed}', which this robot does not load; add it in a <gazebo>",
)
