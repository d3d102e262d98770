// The same figure under the names that other programs give its bones.
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "humanoid/figures.h"
#include "humanoid/humanoid.h"
#include "support/tab_separated.h"

namespace ukemi {
namespace {

using testing::figure;

/// A row of bone_names.tsv: the bone names of a program. Those of limbs are the left ones; the right ones
/// have `right` where these have `left`.
struct Convention {
  std::string program, left, right;
  std::vector<std::string> bones;  // as in kBones
};

/// The figure's names of the table's columns.
struct Bone {
  const char* name;
  bool on_both_sides;
};
constexpr Bone kBones[] = {{"Hips", false},       {"Spine", false},      {"Neck", false},   {"Head", false},
                           {"Shoulder", true},    {"Arm", true},         {"ForeArm", true}, {"Hand", true},
                           {"HandMiddle1", true}, {"UpLeg", true},       {"Leg", true},     {"Foot", true},
                           {"ToeBase", true},     {"HeadTop_End", false}};

void PrintTo(const Convention& convention, std::ostream* out) { *out << convention.program; }

std::vector<Convention> conventions() {
  std::ifstream table(std::string(UKEMI_TEST_DATA) + "/bone_names.tsv");
  std::vector<Convention> result;
  std::string line;
  std::getline(table, line);  // titles
  while (std::getline(table, line)) {
    const std::vector<std::string> cells = tab_separated(line);
    result.push_back({cells.at(0), cells.at(1), cells.at(2), {cells.begin() + 3, cells.end()}});
  }
  return result;
}

std::string other_side(std::string name, const Convention& convention) {
  return name.replace(name.find(convention.left), convention.left.size(), convention.right);
}

Character renamed(const Convention& convention) {
  std::map<std::string, std::string> names = {{"mixamorig:Spine1", "b2"}, {"mixamorig:Spine2", "b3"}};
  for (std::size_t i = 0; i < std::size(kBones); ++i) {
    const std::string& name = convention.bones.at(i);
    if (kBones[i].on_both_sides) {
      names[std::string("mixamorig:Left") + kBones[i].name] = name;
      names[std::string("mixamorig:Right") + kBones[i].name] = other_side(name, convention);
    } else {
      names[std::string("mixamorig:") + kBones[i].name] = name;
    }
  }
  Character character = figure();
  for (Node& node : character.skeleton.nodes)
    if (names.contains(node.name)) node.name = names[node.name];
  return character;
}

TEST(NamingConventions, OfManyProgramsAreKnown) { EXPECT_GE(conventions().size(), 21u); }

class NamingConvention : public ::testing::TestWithParam<Convention> {};

TEST_P(NamingConvention, MapsLikeTheFigureItself) {
  Diagnostics diagnostics;
  const auto expected = map_humanoid(figure(), {}, diagnostics);
  const Character character = renamed(GetParam());
  const auto found = map_humanoid(character, {}, diagnostics);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_TRUE(diagnostics.warnings().empty()) << diagnostics.warnings().front().what;
  for (int s = 0; s < kSegmentCount; ++s) {
    EXPECT_EQ(found->segments[s].chain, expected->segments[s].chain) << name(segment_at(s));
    const bool is_limb = segment_at(s) >= Segment::clavicle_l;
    EXPECT_EQ(is_limb ? found->segments[s].by : "name", "name") << name(segment_at(s));
  }
  EXPECT_EQ(found->toes, expected->toes);
}

INSTANTIATE_TEST_SUITE_P(Names, NamingConvention, ::testing::ValuesIn(conventions()));

}  // namespace
}  // namespace ukemi
