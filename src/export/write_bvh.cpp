// BVH: the hierarchy of a BVH source as it was, or one of our own from the humanoid's joints.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/errors.h"
#include "export/euler.h"
#include "export/export.h"

namespace ukemi {
namespace {

struct BvhJoint {
  std::string name;
  int parent = -1;
  Vec3 offset = Vec3::Zero();
  std::vector<BvhChannel> channels;
  std::optional<Vec3> end_site;
};

/// Joints, depth first, and for each frame their transforms below their parents.
struct BvhFile {
  std::vector<BvhJoint> joints;
  std::vector<Pose> frames;
  double frame_time_s = 0.0;
};

// ---- text
// ------------------------------------------------------------------------------------------------------

void put(std::string& out, double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value == 0.0 ? 0.0 : value).ptr;
  out.append(text, end);
}

void put(std::string& out, const Vec3& v) {
  for (const double part : v) {
    out += ' ';
    put(out, part);
  }
}

std::string_view channel_name(BvhChannel channel) {
  constexpr std::array<std::string_view, 6> kNames{"Xposition", "Yposition", "Zposition",
                                                   "Xrotation", "Yrotation", "Zrotation"};
  return kNames[static_cast<std::size_t>(channel)];
}

void put_joint(std::string& out, const BvhFile& file, const std::vector<std::vector<int>>& below, int joint,
               int depth) {
  const BvhJoint& j = file.joints[joint];
  const std::string indent(static_cast<std::size_t>(depth), '\t');
  out += indent + (j.parent < 0 ? "ROOT " : "JOINT ") + j.name + '\n' + indent + "{\n" + indent + "\tOFFSET";
  put(out, j.offset);
  out += '\n' + indent + "\tCHANNELS " + std::to_string(j.channels.size());
  for (const BvhChannel channel : j.channels) (out += ' ') += channel_name(channel);
  out += '\n';
  for (const int child : below[joint]) put_joint(out, file, below, child, depth + 1);
  if (j.end_site) {
    out += indent + "\tEnd Site\n" + indent + "\t{\n" + indent + "\t\tOFFSET";
    put(out, *j.end_site);
    out += '\n' + indent + "\t}\n";
  }
  out += indent + "}\n";
}

// ---- rows
// --------------------------------------------------------------------------------------------------------

bool is_rotation(BvhChannel channel) { return channel >= BvhChannel::x_rotation; }
int axis_of(BvhChannel channel) { return static_cast<int>(channel) % 3; }

/// Turns rotations into the angles of a joint's rotation channels, row by row without jumps.
class JointAngles {
 public:
  explicit JointAngles(const std::vector<BvhChannel>& channels) {
    std::array<bool, 3> used{};
    for (const BvhChannel channel : channels) {
      if (!is_rotation(channel)) continue;
      order_[static_cast<std::size_t>(count_++)] = axis_of(channel);
      used[static_cast<std::size_t>(axis_of(channel))] = true;
    }
    for (int axis = 0, next = count_; axis < 3 && next < 3; ++axis)
      if (!used[static_cast<std::size_t>(axis)]) order_[static_cast<std::size_t>(next++)] = axis;
  }

  /// Radians, in the order of the channels. Of fewer than three channels the ones that are missing are left
  /// out.
  const Vec3& of(const Quat& rotation) {
    Quat possible = rotation;
    if (count_ == 1)
      possible = exp_rotation(twist_angle(rotation, Vec3::Unit(order_[0])) * Vec3::Unit(order_[0]));
    last_ = to_euler(possible, order_, last_);
    return *last_;
  }

 private:
  int count_ = 0;
  AxisOrder order_{};
  std::optional<Vec3> last_;
};

void put_rows(std::string& out, const BvhFile& file) {
  std::vector<JointAngles> angles;
  for (const BvhJoint& joint : file.joints) angles.emplace_back(joint.channels);
  for (const Pose& frame : file.frames) {
    const std::size_t start = out.size();
    for (std::size_t j = 0; j < file.joints.size(); ++j) {
      const Vec3& turn = angles[j].of(frame[j].rotation);
      int next = 0;
      for (const BvhChannel channel : file.joints[j].channels) {
        if (out.size() > start) out += ' ';
        put(out, is_rotation(channel) ? degrees(turn[next++]) : frame[j].translation[axis_of(channel)]);
      }
    }
    out += '\n';
  }
}

std::string text_of(const BvhFile& file) {
  std::vector<std::vector<int>> below(file.joints.size());
  for (std::size_t j = 0; j < file.joints.size(); ++j)
    if (file.joints[j].parent >= 0) below[file.joints[j].parent].push_back(static_cast<int>(j));
  std::string out = "HIERARCHY\n";
  for (std::size_t j = 0; j < file.joints.size(); ++j)
    if (file.joints[j].parent < 0) put_joint(out, file, below, static_cast<int>(j), 0);
  out += "MOTION\nFrames: " + std::to_string(file.frames.size()) + "\nFrame Time: ";
  put(out, file.frame_time_s);
  out += '\n';
  put_rows(out, file);
  return out;
}

// ---- the source's hierarchy
// ------------------------------------------------------------------------------------------

BvhFile file_of_source(const Character& character, const Clip& clip) {
  BvhFile file{{}, clip.frames, 1.0 / clip.fps};
  for (int i = 0; i < character.skeleton.size(); ++i) {
    const Node& node = character.skeleton.nodes[i];
    file.joints.push_back({node.name, node.parent, node.rest.translation, character.bvh->channels[i],
                           character.bvh->end_site[i]});
  }
  return file;
}

// ---- a hierarchy of our own
// ------------------------------------------------------------------------------------------

/// A node of the character as a joint of the BVH.
struct ChosenNode {
  int node = -1;
  int parent = -1;  // index among the chosen
};

/// Node of the nearest segment above that has one.
int node_above(const Humanoid& humanoid, Segment segment) {
  while (segment != Segment::pelvis) {
    segment = parent_of(segment);
    if (!humanoid.segments[index(segment)].fused()) return humanoid.segments[index(segment)].node();
  }
  return humanoid.root;
}

/// Parent of every node that becomes a joint; -2 for the others. What does not hang below the root hangs on
/// the segment above.
std::vector<int> chosen_parents(const Skeleton& skeleton, const Humanoid& humanoid) {
  std::vector<int> parent(skeleton.nodes.size(), -2);
  parent[humanoid.root] = -1;
  for (int s = 0; s < kSegmentCount; ++s) {
    const std::vector<int>& chain = humanoid.segments[s].chain;
    for (std::size_t k = 0; k < chain.size(); ++k) {
      if (skeleton.is_ancestor(humanoid.root, chain[k])) {
        for (int i = chain[k]; i != humanoid.root; i = skeleton.nodes[i].parent)
          parent[i] = skeleton.nodes[i].parent;
      } else if (chain[k] != humanoid.root) {
        parent[chain[k]] = k > 0 ? chain[k - 1] : node_above(humanoid, segment_at(s));
      }
    }
  }
  return parent;
}

/// Depth first, the order in which the rows of a BVH list its joints.
void choose(const std::vector<int>& parents, ChosenNode chosen, std::vector<ChosenNode>& out) {
  const int at = static_cast<int>(out.size());
  out.push_back(chosen);
  for (std::size_t i = 0; i < parents.size(); ++i)
    if (parents[i] == chosen.node) choose(parents, {static_cast<int>(i), at}, out);
}

/// Rotations of all nodes in the y-up world; scales are taken to be uniform.
std::vector<Quat> world_rotations(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose) {
  std::vector<Quat> result(pose.size());
  for (const int i : skeleton.order) {
    const int parent = skeleton.nodes[i].parent;
    result[i] =
        (parent < 0 ? humanoid.world_from_file.rotation : result[parent]) * pose[i].rotation.normalized();
  }
  return result;
}

std::vector<Vec3> world_positions(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& pose,
                                  double unit_m) {
  std::vector<Vec3> result;
  for (const Affine& node : world_transforms(skeleton, pose))
    result.push_back(humanoid.world_from_file * Vec3(node.translation()) / unit_m);
  return result;
}

/// The node at the far end of a leaf joint; -1 where there is none.
int tip_of(const Skeleton& skeleton, const Humanoid& humanoid, int node) {
  const std::array<int, 5> known{humanoid.head_top, humanoid.middle_finger[0], humanoid.middle_finger[1],
                                 humanoid.toes[0], humanoid.toes[1]};
  for (const int tip : known)
    if (tip >= 0 && skeleton.is_ancestor(node, tip)) return tip;
  for (int i = 0; i < skeleton.size(); ++i)
    if (skeleton.nodes[i].parent == node) return i;
  return -1;
}

/// Readers split names at blanks and braces.
std::string plain_name(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) <= ' ' || c == '{' || c == '}') c = '_';
  return name;
}

std::vector<BvhJoint> own_joints(const Character& character, const Humanoid& humanoid,
                                 const std::vector<ChosenNode>& chosen, const std::vector<Vec3>& positions) {
  using enum BvhChannel;
  const Skeleton& skeleton = character.skeleton;
  std::vector<bool> is_leaf(chosen.size(), true);
  std::vector<BvhJoint> joints;
  for (const ChosenNode& c : chosen) {
    BvhJoint joint{
        plain_name(skeleton.label(c.node)), c.parent, Vec3::Zero(), {z_rotation, y_rotation, x_rotation}, {}};
    if (c.parent < 0)
      joint.channels = {x_position, y_position, z_position, z_rotation, y_rotation, x_rotation};
    else
      joint.offset = positions[c.node] - positions[chosen[c.parent].node];
    if (c.parent >= 0) is_leaf[c.parent] = false;
    joints.push_back(std::move(joint));
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!is_leaf[j]) continue;
    const int tip = tip_of(skeleton, humanoid, chosen[j].node);
    const Vec3 reach = tip < 0 ? Vec3::Zero() : Vec3(positions[tip] - positions[chosen[j].node]);
    joints[j].end_site = reach.isZero() ? Vec3(0.5 * joints[j].offset) : reach;
  }
  return joints;
}

/// The reference pose with the lengths that the bones have in the clip, which started perhaps from a moment
/// of another motion.
Pose zero_pose(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& first) {
  const bool has_reference = humanoid.reference.size() == skeleton.nodes.size();
  Pose pose = has_reference ? humanoid.reference : rest_pose(skeleton);
  std::vector<bool> moves(skeleton.nodes.size(), false);
  for (const SegmentNodes& segment : humanoid.segments)
    if (segment.detached) moves[segment.chain.front()] = true;
  for (int i = 0; i < skeleton.size(); ++i) {
    pose[i].scale = first[i].scale;
    if (!moves[i] && skeleton.is_ancestor(humanoid.root, i)) pose[i].translation = first[i].translation;
  }
  return pose;
}

BvhFile own_file(const Character& character, const Humanoid& humanoid, const Clip& clip, double unit_m) {
  const Skeleton& skeleton = character.skeleton;
  const Pose reference = zero_pose(skeleton, humanoid, clip.frames.front());
  const std::vector<Quat> zero = world_rotations(skeleton, humanoid, reference);
  std::vector<ChosenNode> chosen;
  choose(chosen_parents(skeleton, humanoid), {humanoid.root, -1}, chosen);
  BvhFile file;
  file.frame_time_s = 1.0 / clip.fps;
  file.joints =
      own_joints(character, humanoid, chosen, world_positions(skeleton, humanoid, reference, unit_m));
  for (const Pose& pose : clip.frames) {
    const std::vector<Quat> now = world_rotations(skeleton, humanoid, pose);
    Pose row(chosen.size());
    for (std::size_t j = 0; j < chosen.size(); ++j) {
      const auto turn = [&](int node) { return Quat(now[node] * zero[node].conjugate()); };
      const Quat above = chosen[j].parent < 0 ? Quat::Identity() : turn(chosen[chosen[j].parent].node);
      row[j].rotation = above.conjugate() * turn(chosen[j].node);
    }
    row[0].translation = world_positions(skeleton, humanoid, pose, unit_m)[humanoid.root];
    file.frames.push_back(std::move(row));
  }
  return file;
}

Status check(const Character& character, const Humanoid& humanoid, const Clip& clip,
             const BvhOptions& options) {
  const std::size_t nodes = character.skeleton.nodes.size();
  const auto fits = [&](const Pose& pose) { return pose.size() == nodes; };
  const auto error = [&](const char* what, const char* fix) {
    return input_error(character.path, what, fix);
  };
  if (clip.frames.empty() || !(clip.fps > 0.0)) return error("the clip is empty", "bake at least one frame");
  if (!std::all_of(clip.frames.begin(), clip.frames.end(), fits))
    return error("the clip is not of this skeleton", "bake the clip for this character");
  if (character.bvh && (character.bvh->channels.size() != nodes || character.bvh->end_site.size() != nodes))
    return error("the BVH hierarchy does not fit the skeleton", "load the file again");
  if (!character.bvh && (humanoid.root < 0 || static_cast<std::size_t>(humanoid.root) >= nodes))
    return error("the character has no humanoid root", "map the pelvis with --map pelvis=NODE");
  if (!(options.metres_per_unit > 0.0))
    return error("the BVH's unit is not positive", "give --bvh-unit cm or m");
  return Done{};
}

}  // namespace

Result<std::string> write_bvh(const Character& character, const Humanoid& humanoid, const Clip& clip,
                              const BvhOptions& options) {
  if (const Status status = check(character, humanoid, clip, options); !status) return status.error();
  return text_of(character.bvh ? file_of_source(character, clip)
                               : own_file(character, humanoid, clip, options.metres_per_unit));
}

}  // namespace ukemi
