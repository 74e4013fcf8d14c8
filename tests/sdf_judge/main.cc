// Prints what libsdformat reads in an SDF or URDF file, as JSON: `sdf_judge FILE [--strict]`.
//
// Poses are [x, y, z, qw, qx, qy, qz] in the frame of the outermost model, axes unit vectors in the axes of that
// frame; names inside a nested model are `model::name`. With --strict, a warning of the parser is an error.

#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <sdf/parser.hh>
#include <sdf/sdf.hh>

using ignition::math::Matrix3d;
using ignition::math::Pose3d;
using ignition::math::Vector3d;

using Items = std::vector<std::string>;

static Items errors;

static std::string join(const Items &items, char open, char close)
{
  std::string text(1, open);
  for (const auto &item : items)
    text += (text.size() > 1 ? ",\n" : "") + item;
  return text + close;
}

static std::string list(const Items &items) { return join(items, '[', ']'); }

static std::string object(const Items &items) { return join(items, '{', '}'); }

static std::string quoted(const std::string &text)
{
  std::string result = "\"";
  for (const unsigned char letter : text)
  {
    if (letter == '"' || letter == '\\')
      result += std::string("\\") + static_cast<char>(letter);
    else if (letter < 0x20)
    {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", letter);
      result += code;
    }
    else
      result += static_cast<char>(letter);
  }
  return result + '"';
}

static std::string number(double value)
{
  if (!std::isfinite(value))
    return std::isnan(value) ? "NaN" : value < 0 ? "-Infinity" : "Infinity";
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

static std::string numbers(const std::vector<double> &values)
{
  Items items;
  for (const double value : values)
    items.push_back(number(value));
  return list(items);
}

static std::string pose(const Pose3d &value)
{
  const auto &p = value.Pos();
  const auto &q = value.Rot();
  return numbers({p.X(), p.Y(), p.Z(), q.W(), q.X(), q.Y(), q.Z()});
}

static std::string field(const std::string &name, const std::string &value) { return quoted(name) + ": " + value; }

static void report(const sdf::Errors &found)
{
  for (const auto &error : found)
  {
    std::ostringstream text;
    text << error;
    errors.push_back(quoted(text.str()));
  }
}

// Returns the pose of a part in its model; parts of a link are resolved in the frame of the link.
template <class Part> static Pose3d poseIn(const Part &part, const std::string &frame)
{
  Pose3d result;
  report(part.SemanticPose().Resolve(result, frame));
  return result;
}

// Returns the name of a part, its pose and its element as libsdformat holds it.
template <class Part> static std::string described(const Part &part, const std::string &prefix, const Pose3d &at)
{
  const auto element = part.Element();
  return object({field("name", quoted(prefix + part.Name())), field("pose", pose(at)),
                 field("xml", quoted(element ? element->ToString("") : ""))});
}

static std::string plugins(const sdf::ElementPtr &element)
{
  Items found;
  if (element && element->HasElement("plugin"))
    for (auto plugin = element->GetElement("plugin"); plugin; plugin = plugin->GetNextElement("plugin"))
      found.push_back(object({field("name", quoted(plugin->Get<std::string>("name"))),
                              field("filename", quoted(plugin->Get<std::string>("filename"))),
                              field("xml", quoted(plugin->ToString("")))}));
  return list(found);
}

static std::string linkObject(const sdf::Link &link, const std::string &prefix, const Pose3d &model)
{
  const auto at = model * poseIn(link, "__model__");
  const auto &inertial = link.Inertial();
  // The tensor in the axes of the link, about the centre of mass.
  const Matrix3d turn(inertial.Pose().Rot());
  const Matrix3d tensor = turn * inertial.MassMatrix().Moi() * turn.Transposed();
  Items visuals, collisions, sensors;
  for (uint64_t i = 0; i < link.VisualCount(); ++i)
    visuals.push_back(described(*link.VisualByIndex(i), prefix, at * poseIn(*link.VisualByIndex(i), link.Name())));
  for (uint64_t i = 0; i < link.CollisionCount(); ++i)
    collisions.push_back(
        described(*link.CollisionByIndex(i), prefix, at * poseIn(*link.CollisionByIndex(i), link.Name())));
  for (uint64_t i = 0; i < link.SensorCount(); ++i)
    sensors.push_back(described(*link.SensorByIndex(i), prefix, at * poseIn(*link.SensorByIndex(i), link.Name())));
  const auto element = link.Element();
  return object(
      {field("name", quoted(prefix + link.Name())), field("pose", pose(at)),
       field("mass", number(inertial.MassMatrix().Mass())),
       field("center", numbers({inertial.Pose().Pos().X(), inertial.Pose().Pos().Y(), inertial.Pose().Pos().Z()})),
       field("inertia", numbers({tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(0, 2), tensor(1, 2)})),
       field("has_inertial", element->HasElement("inertial") ? "true" : "false"),
       field("self_collide", element->Get<bool>("self_collide", false).first ? "true" : "false"),
       field("gravity", element->Get<bool>("gravity", true).first ? "true" : "false"),
       field("visuals", list(visuals)), field("collisions", list(collisions)), field("sensors", list(sensors)),
       field("plugins", plugins(element))});
}

static std::string axisObject(const sdf::JointAxis &axis, const Pose3d &model)
{
  Vector3d xyz;
  report(axis.ResolveXyz(xyz, "__model__"));
  xyz = model.Rot().RotateVector(xyz);
  return object({field("xyz", numbers({xyz.X(), xyz.Y(), xyz.Z()})), field("lower", number(axis.Lower())),
                 field("upper", number(axis.Upper())), field("effort", number(axis.Effort())),
                 field("velocity", number(axis.MaxVelocity())), field("damping", number(axis.Damping())),
                 field("friction", number(axis.Friction())),
                 field("xml", quoted(axis.Element() ? axis.Element()->ToString("") : ""))});
}

static std::string jointObject(const sdf::Joint &joint, const std::string &prefix, const Pose3d &model)
{
  std::string parent, child;
  report(joint.ResolveParentLink(parent));
  report(joint.ResolveChildLink(child));
  const auto at = model * poseIn(joint, "__model__");
  Items axes, sensors;
  for (unsigned int i = 0; i < 2; ++i)
    if (joint.Axis(i))
      axes.push_back(axisObject(*joint.Axis(i), model));
  // libsdformat 12 resolves no poses of sensors in joints; without `relative_to`, they are in the frame of the joint.
  for (uint64_t i = 0; i < joint.SensorCount(); ++i)
    sensors.push_back(described(*joint.SensorByIndex(i), prefix, at * joint.SensorByIndex(i)->RawPose()));
  const auto inModel = [&](const std::string &name) { return quoted(name == "world" ? name : prefix + name); };
  return object({field("name", quoted(prefix + joint.Name())),
                 field("type", quoted(joint.Element()->Get<std::string>("type"))), field("parent", inModel(parent)),
                 field("child", inModel(child)), field("pose", pose(at)), field("axes", list(axes)),
                 field("sensors", list(sensors)), field("plugins", plugins(joint.Element())),
                 field("xml", quoted(joint.Element()->ToString("")))});
}

struct Found
{
  Items models, links, joints, frames;
};

static void gather(const sdf::Model &model, const std::string &prefix, const Pose3d &at, Found &found)
{
  const auto element = model.Element();
  found.models.push_back(object({field("name", quoted(prefix + model.Name())), field("pose", pose(at)),
                                 field("static", model.Static() ? "true" : "false"),
                                 field("self_collide", model.SelfCollide() ? "true" : "false"),
                                 field("plugins", plugins(element))}));
  const bool isOutermost = found.models.size() == 1;
  const std::string inside = isOutermost ? "" : prefix + model.Name() + "::";
  for (uint64_t i = 0; i < model.LinkCount(); ++i)
    found.links.push_back(linkObject(*model.LinkByIndex(i), inside, at));
  for (uint64_t i = 0; i < model.JointCount(); ++i)
    found.joints.push_back(jointObject(*model.JointByIndex(i), inside, at));
  for (uint64_t i = 0; i < model.FrameCount(); ++i)
    found.frames.push_back(
        described(*model.FrameByIndex(i), inside, at * poseIn(*model.FrameByIndex(i), "__model__")));
  for (uint64_t i = 0; i < model.ModelCount(); ++i)
  {
    const auto &inner = *model.ModelByIndex(i);
    gather(inner, inside, at * poseIn(inner, "__model__"), found);
  }
}

int main(int count, char **words)
{
  if (count < 2)
    return 2;
  sdf::ParserConfig config;
  if (count > 2 && std::string(words[2]) == "--strict")
  {
    config.SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
    config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
    config.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::ERR);
  }
  sdf::Root root;
  report(root.Load(words[1], config));
  // What `gz sdf --check` does besides; they print to standard error.
  if (const auto element = root.Element())
    sdf::recursiveSiblingUniqueNames(element);
  sdf::checkCanonicalLinkNames(&root);
  sdf::Errors ofJoints;
  sdf::checkJointParentChildNames(&root, ofJoints);
  report(ofJoints);
  sdf::checkFrameAttachedToGraph(&root);
  sdf::checkPoseRelativeToGraph(&root);
  Found found;
  if (root.Model())
    gather(*root.Model(), "", Pose3d::Zero, found);
  std::cout << object({field("errors", list(errors)), field("models", list(found.models)),
                       field("links", list(found.links)), field("joints", list(found.joints)),
                       field("frames", list(found.frames))})
            << "\n";
  return 0;
}
