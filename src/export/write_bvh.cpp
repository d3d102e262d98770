// BVH: the hierarchy of a BVH source as it was, or one of our own from the humanoid's joints.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/base64.h"
#include "base/errors.h"
#include "export/euler.h"
#include "export/export.h"
#include "export/lift_hips.h"

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
  bool positions_add = false;             // see BvhSource
  std::optional<double> metres_per_unit;  // said in the file
  std::string extras_json;                // likewise
};

/// A node of the character as a joint of the BVH.
struct ChosenNode {
  int node = -1;
  int parent = -1;  // index among the chosen
};

// ---- text

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

/// What the file says of itself, as the name of an End Site: one word.
std::string mark_of(const BvhFile& file) {
  std::string mark;
  if (file.metres_per_unit) {
    mark = "unit=";
    put(mark, *file.metres_per_unit);
    mark += "m,up=y";
  }
  const std::string& extras = file.extras_json;
  if (!extras.empty())
    mark += (mark.empty() ? "clip=" : ",clip=") +
            base64({reinterpret_cast<const std::uint8_t*>(extras.data()), extras.size()});
  return mark;
}

/// Writes a joint and all below it; `mark` names the first End Site and is then emptied.
void put_joint(std::string& out, const BvhFile& file, const std::vector<std::vector<int>>& below, int joint,
               int depth, std::string& mark) {
  const BvhJoint& j = file.joints[joint];
  const std::string indent(static_cast<std::size_t>(depth), '\t');
  out += indent + (j.parent < 0 ? "ROOT " : "JOINT ") + j.name + '\n' + indent + "{\n" + indent + "\tOFFSET";
  put(out, j.offset);
  out += '\n' + indent + "\tCHANNELS " + std::to_string(j.channels.size());
  for (const BvhChannel channel : j.channels) (out += ' ') += channel_name(channel);
  out += '\n';
  for (const int child : below[joint]) put_joint(out, file, below, child, depth + 1, mark);
  if (j.end_site) {
    out += indent + "\tEnd Site";
    if (!mark.empty()) out += " " + std::exchange(mark, "");
    out += '\n' + indent + "\t{\n" + indent + "\t\tOFFSET";
    put(out, *j.end_site);
    out += '\n' + indent + "\t}\n";
  }
  out += indent + "}\n";
}

// ---- rows

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
      const bool add = file.positions_add && file.joints[j].parent >= 0;
      const Vec3 place = frame[j].translation - (add ? file.joints[j].offset : Vec3(Vec3::Zero()));
      for (const BvhChannel channel : file.joints[j].channels) {
        if (out.size() > start) out += ' ';
        put(out, is_rotation(channel) ? degrees(turn[next++]) : place[axis_of(channel)]);
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
  std::string mark = mark_of(file);
  for (std::size_t j = 0; j < file.joints.size(); ++j)
    if (file.joints[j].parent < 0) put_joint(out, file, below, static_cast<int>(j), 0, mark);
  out += "MOTION\nFrames: " + std::to_string(file.frames.size()) + "\nFrame Time: ";
  put(out, file.frame_time_s);
  out += '\n';
  put_rows(out, file);
  return out;
}

// ---- what a hierarchy of fixed bones cannot hold

/// The joint that lies farthest from its place.
struct Misfit {
  double distance = 0.0;  // units of the file
  std::string joint;

  void note(double away, const std::string& name) {
    if (away <= distance * (1.0 + 1e-9)) return;  // the first of those that hang on one another
    distance = away;
    joint = name;
  }

  /// `row`: local transforms of the joints; `places`: where the nodes are.
  void look_at(const BvhFile& file, const Pose& row, const std::vector<ChosenNode>& chosen,
               const std::vector<Vec3>& places) {
    std::vector<Affine> world(row.size());
    for (std::size_t j = 0; j < row.size(); ++j) {
      world[j] = row[j].affine();
      if (chosen[j].parent >= 0) world[j] = world[static_cast<std::size_t>(chosen[j].parent)] * world[j];
      note((world[j].translation() - places[static_cast<std::size_t>(chosen[j].node)]).norm(),
           file.joints[j].name);
    }
  }

  /// Lengths that differ from the rest's where nothing can say so.
  void look_at(const BvhFile& file, const Pose& row) {
    for (std::size_t j = 0; j < row.size(); ++j)
      for (int axis = 0; axis < 3; ++axis) {
        const auto& channels = file.joints[j].channels;
        const bool has_channel =
            std::find(channels.begin(), channels.end(), static_cast<BvhChannel>(axis)) != channels.end();
        if (!has_channel)
          note(std::abs(row[j].translation[axis] - file.joints[j].offset[axis]), file.joints[j].name);
      }
  }

  void warn(const Character& character, double unit_m, Diagnostics& diagnostics) const {
    constexpr double kNoticed_m = 0.0005;
    if (distance * unit_m <= kNoticed_m) return;
    diagnostics.warn(
        character.path.string(),
        fmt::format("the BVH holds '{}' up to {:.1f} mm away from its place: its bones keep their "
                    "lengths, and only joints with position channels move",
                    joint, 1000.0 * distance * unit_m));
  }
};

// ---- the source's hierarchy

BvhFile file_of_source(const Character& character, const Humanoid& humanoid, const Clip& clip,
                       Diagnostics& diagnostics) {
  BvhFile file{{}, clip.frames, 1.0 / clip.fps, character.bvh->positions_add, character.metres_per_unit, {}};
  for (int i = 0; i < character.skeleton.size(); ++i) {
    const Node& node = character.skeleton.nodes[i];
    file.joints.push_back({node.name, node.parent, node.rest.translation, character.bvh->channels[i],
                           character.bvh->end_site[i]});
  }
  lift_hips(character, humanoid, file.frames);
  Misfit misfit;
  for (const Pose& frame : file.frames) misfit.look_at(file, frame);
  misfit.warn(character, humanoid.world_from_file.scale, diagnostics);
  return file;
}

// ---- a hierarchy of our own

/// Node of the nearest segment above that has one.
int node_above(const Humanoid& humanoid, Segment segment) {
  while (segment != Segment::pelvis) {
    segment = parent_of(segment);
    if (!humanoid.segments[index(segment)].fused()) return humanoid.segments[index(segment)].node();
  }
  return humanoid.root;
}

/// Parent of every node that becomes a joint; -2 for the others. What the segment above does not carry hangs
/// on it all the same.
std::vector<int> chosen_parents(const Skeleton& skeleton, const Humanoid& humanoid) {
  std::vector<int> parent(skeleton.nodes.size(), -2);
  parent[humanoid.root] = -1;
  for (int s = 0; s < kSegmentCount; ++s) {
    const std::vector<int>& chain = humanoid.segments[s].chain;
    for (std::size_t k = 0; k < chain.size(); ++k) {
      const bool hangs_elsewhere = k == 0 && humanoid.segments[s].detached;
      if (skeleton.is_ancestor(humanoid.root, chain[k]) && !hangs_elsewhere) {
        for (int i = chain[k]; i != humanoid.root && parent[i] == -2; i = skeleton.nodes[i].parent)
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

std::vector<ChosenNode> chosen_nodes(const Skeleton& skeleton, const Humanoid& humanoid) {
  std::vector<ChosenNode> chosen;
  choose(chosen_parents(skeleton, humanoid), {humanoid.root, -1}, chosen);
  return chosen;
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

/// How nodes have turned in the y-up world since a pose.
class WorldTurns {
 public:
  WorldTurns(const Skeleton& skeleton, const Humanoid& humanoid, const Pose& zero)
      : skeleton_(skeleton), humanoid_(humanoid), zero_(world_rotations(skeleton, humanoid, zero)) {
    const std::vector<Affine> world = world_transforms(skeleton, zero);
    mirrored_ = std::any_of(world.begin(), world.end(),
                            [](const Affine& m) { return m.linear().determinant() < 0.0; });
    if (mirrored_) zero_world_ = world;
  }

  std::vector<Quat> of(const Pose& pose) const {
    std::vector<Quat> turns = world_rotations(skeleton_, humanoid_, pose);
    const std::vector<Affine> world = mirrored_ ? world_transforms(skeleton_, pose) : std::vector<Affine>();
    const Quat& upright = humanoid_.world_from_file.rotation;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (!mirrored_)
        turns[i] = turns[i] * zero_[i].conjugate();
      else  // below a mirror rotations turn the other way: only the whole matrices say how
        turns[i] = upright * rotation_part(world[i].linear() * zero_world_[i].linear().inverse()) *
                   upright.conjugate();
    }
    return turns;
  }

 private:
  const Skeleton& skeleton_;
  const Humanoid& humanoid_;
  std::vector<Quat> zero_;
  std::vector<Affine> zero_world_;
  bool mirrored_ = false;
};

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

/// Names of joints: those of their nodes, whatever meshes are called; a node's number where two bones share
/// one.
std::vector<std::string> joint_names(const Skeleton& skeleton, const std::vector<ChosenNode>& chosen) {
  std::vector<char> is_chosen(skeleton.nodes.size(), 0);
  for (const ChosenNode& c : chosen) is_chosen[static_cast<std::size_t>(c.node)] = 1;
  const std::map<std::string, int> by_name = nodes_by_plain_name(skeleton, is_chosen);
  std::vector<std::string> names;
  for (const ChosenNode& c : chosen) {
    const std::string name = plain_name(skeleton.nodes[c.node].name);
    const auto found = by_name.find(name);
    names.push_back(found != by_name.end() && found->second == c.node ? name : fmt::format("#{}", c.node));
  }
  return names;
}

std::vector<BvhJoint> own_joints(const Character& character, const Humanoid& humanoid,
                                 const std::vector<ChosenNode>& chosen, const std::vector<Vec3>& positions) {
  using enum BvhChannel;
  const Skeleton& skeleton = character.skeleton;
  std::vector<bool> is_leaf(chosen.size(), true);
  const std::vector<std::string> names = joint_names(skeleton, chosen);
  std::vector<BvhJoint> joints;
  for (const ChosenNode& c : chosen) {
    BvhJoint joint{names[joints.size()], c.parent, Vec3::Zero(), {z_rotation, y_rotation, x_rotation}, {}};
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

/// Moves a detached segment to where it is in `first`, seen from the node above it.
void hang_as_in(const Skeleton& skeleton, const Humanoid& humanoid, Segment segment, const Pose& first,
                Pose& pose) {
  const int node = humanoid.segments[index(segment)].chain.front(), parent = skeleton.nodes[node].parent;
  const int above = node_above(humanoid, segment);
  const std::vector<Affine> there = world_transforms(skeleton, first),
                            here = world_transforms(skeleton, pose);
  const Vec3 place = here[above] * (there[above].inverse() * there[node].translation());
  pose[node].translation = parent < 0 ? place : Vec3(here[parent].inverse() * place);
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
  for (int s = 1; s < kSegmentCount; ++s)
    if (humanoid.segments[s].detached) hang_as_in(skeleton, humanoid, segment_at(s), first, pose);
  return pose;
}

BvhFile own_file(const Character& character, const Humanoid& humanoid, const Clip& clip, double unit_m,
                 Diagnostics& diagnostics) {
  const Skeleton& skeleton = character.skeleton;
  const Pose reference = zero_pose(skeleton, humanoid, clip.frames.front());
  const WorldTurns turns(skeleton, humanoid, reference);
  const std::vector<ChosenNode> chosen = chosen_nodes(skeleton, humanoid);
  Misfit misfit;
  BvhFile file;
  file.frame_time_s = 1.0 / clip.fps;
  file.metres_per_unit = unit_m;
  file.joints =
      own_joints(character, humanoid, chosen, world_positions(skeleton, humanoid, reference, unit_m));
  for (const Pose& pose : clip.frames) {
    const std::vector<Quat> turn = turns.of(pose);
    const std::vector<Vec3> places = world_positions(skeleton, humanoid, pose, unit_m);
    Pose row(chosen.size());
    for (std::size_t j = 0; j < chosen.size(); ++j) {
      const Quat above = chosen[j].parent < 0 ? Quat::Identity() : turn[chosen[chosen[j].parent].node];
      row[j].rotation = above.conjugate() * turn[chosen[j].node];
      row[j].translation = file.joints[j].offset;
    }
    row[0].translation = places[humanoid.root];
    misfit.look_at(file, row, chosen, places);
    file.frames.push_back(std::move(row));
  }
  misfit.warn(character, unit_m, diagnostics);
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
                              const BvhOptions& options, Diagnostics& diagnostics) {
  if (const Status status = check(character, humanoid, clip, options); !status) return status.error();
  BvhFile file = character.bvh ? file_of_source(character, humanoid, clip, diagnostics)
                               : own_file(character, humanoid, clip, options.metres_per_unit, diagnostics);
  file.extras_json = options.extras_json;
  return text_of(file);
}

std::vector<int> bvh_nodes(const Character& character, const Humanoid& humanoid) {
  std::vector<int> nodes;
  if (character.bvh)
    for (int i = 0; i < character.skeleton.size(); ++i) nodes.push_back(i);
  else
    for (const ChosenNode& chosen : chosen_nodes(character.skeleton, humanoid)) nodes.push_back(chosen.node);
  return nodes;
}

}  // namespace ukemi
