#include "batch/recipe.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "prepare/impact.h"
#include "prepare/setting_table.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

const std::string kHead = "format = 1\ncharacters = [\"mannequin\"]\n";

Recipe recipe_of(const std::string& toml, const fs::path& file = "r.toml") {
  auto recipe = parse_recipe(toml, file);
  EXPECT_TRUE(recipe) << recipe.error().message();
  return recipe ? std::move(*recipe) : Recipe();
}

std::vector<Reaction> reactions(const std::string& toml, const Takes& takes = {}) {
  const Recipe recipe = recipe_of(toml);
  auto expanded = reactions_of(recipe, takes);
  EXPECT_TRUE(expanded) << expanded.error().message();
  return expanded ? std::move(*expanded) : std::vector<Reaction>();
}

std::vector<std::string> names(const std::vector<Reaction>& reactions) {
  std::vector<std::string> result;
  for (const Reaction& reaction : reactions) result.push_back(reaction.name);
  return result;
}

void expect_refused(const std::string& toml, int line, int column, const std::string& what,
                    const std::string& fix) {
  SCOPED_TRACE(toml);
  const auto recipe = parse_recipe(toml, "r.toml");
  ASSERT_FALSE(recipe);
  EXPECT_EQ(recipe.error().file, "r.toml");
  EXPECT_EQ(recipe.error().line, line);
  EXPECT_EQ(recipe.error().column, column);
  EXPECT_NE(recipe.error().what.find(what), std::string::npos) << recipe.error().what;
  EXPECT_NE(recipe.error().fix.find(fix), std::string::npos) << recipe.error().fix;
  EXPECT_EQ(exit_status(recipe.error().kind), 2);
}

/// A folder of its own with files in it.
class RecipeFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) / ("ukemi_recipe_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  void write(const fs::path& name, const std::string& text = "") const {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << text;
  }
  fs::path folder;
};

TEST(Recipe, AMatrixIsEveryCombinationTheFirstAxisSlowest) {
  const auto all = reactions(kHead + "[[matrix]]\nhit = [\"head\", \"chest\"]\nfrom = [\"left\", 45]\n");
  EXPECT_EQ(names(all), (std::vector<std::string>{"head_left", "head_45", "chest_left", "chest_45"}));
  EXPECT_EQ(all[1].settings.hit, Segment::head);
  EXPECT_EQ(all[1].settings.from.text, "45");
  EXPECT_EQ(all[1].settings.reaction, "head_45");
  EXPECT_EQ(all[1].settings.outputs, std::vector<fs::path>{"mannequin/head_45.glb"});
  EXPECT_EQ(all[1].settings.sheet, "mannequin/head_45.png");
  EXPECT_EQ(all[1].settings.report, "mannequin/head_45.json");
}

TEST(Recipe, TheOrderOfAxesIsThatOfTheFile) {
  const auto all =
      reactions(kHead + "[[matrix]]\npreset = [\"punch\", \"kick\"]\nhit = [\"head\", \"chest\"]\n");
  EXPECT_EQ(names(all), (std::vector<std::string>{"head_front_punch", "chest_front_punch", "head_front_kick",
                                                  "chest_front_kick"}));
}

TEST(Recipe, LaterPlacesOverrideEarlierOnes) {
  const auto all = reactions(kHead + R"(
[settings]
fps = 10
duration = 1
mass = 60
tone = 0.1
[character.mannequin]
duration = 2
mass = 70
tone = 0.2
[[matrix]]
mass = 80
tone = [0.5, 0.6]
)");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].settings.simulation.fps, 10.0);
  EXPECT_EQ(all[1].settings.simulation.duration_s, 2.0);
  EXPECT_EQ(all[1].settings.mass_kg, 80.0);
  EXPECT_EQ(all[1].settings.simulation.tone, 0.6);
  EXPECT_EQ(all[1].settings.hold_s, BakeSettings().hold_s);
}

TEST(Recipe, AListReplacesTheListOfAnEarlierPlace) {
  const auto all = reactions(kHead + R"(
[settings]
map = ["head=A", "pelvis=B"]
[[reaction]]
map = ["head=C"]
)");
  EXPECT_EQ(all.at(0).settings.humanoid.map, (std::map<std::string, std::string>{{"head", "C"}}));
}

TEST(Recipe, MatricesAndReactionsComeInTheOrderOfTheFile) {
  const auto all = reactions(kHead + R"(
[[reaction]]
name = "first"
[[matrix]]
hit = ["head"]
[[reaction]]
name = "last"
)");
  EXPECT_EQ(names(all), (std::vector<std::string>{"first", "head_front", "last"}));
}

TEST(Recipe, NamesAreSafeAndUnique) {
  const auto all = reactions(kHead + R"(
[[matrix]]
name = "../../{hit}"
from = ["left", "10,20"]
[[matrix]]
name = "{hit} {from}"
from = ["10,20"]
)");
  EXPECT_EQ(names(all), (std::vector<std::string>{"_chest", "_chest_2", "chest_10_20"}));
  for (const Reaction& reaction : all)
    EXPECT_EQ(reaction.settings.outputs.at(0).parent_path(), "mannequin") << reaction.settings.outputs.at(0);
}

TEST(Recipe, VariationsDifferWithinTheJitterAndAreTheSameEveryTime) {
  const std::string toml = kHead + R"(
seed = 7
[[matrix]]
hit = ["head"]
from = "90,5"
variations = 40
jitter = { direction-deg = 10, point-m = 0.03, strength-percent = 20 }
)";
  const auto all = reactions(toml);
  ASSERT_EQ(all.size(), 40u);
  EXPECT_EQ(all[3].name, "head_90_5_03");
  std::set<std::string> directions;
  double strongest = 0.0, farthest = 0.0;
  for (const Reaction& reaction : all) {
    const Direction& from = reaction.settings.from;
    EXPECT_NEAR(degrees(from.azimuth), 90.0, 10.0);
    EXPECT_NEAR(degrees(from.elevation), 5.0, 10.0);
    EXPECT_NEAR(reaction.settings.strength, 1.0, 0.2);
    EXPECT_LE(std::abs(reaction.settings.aim_up_m), 0.03);
    EXPECT_LE(std::abs(reaction.settings.aim_left_m), 0.03);
    EXPECT_EQ(reaction.seed, 7u);
    strongest = std::max(strongest, reaction.settings.strength);
    farthest = std::max(farthest, std::abs(reaction.settings.aim_up_m));
    directions.insert(reaction.settings.from.text);
  }
  EXPECT_EQ(directions.size(), 40u);
  EXPECT_GT(strongest, 1.1);
  EXPECT_GT(farthest, 0.015);
  const auto again = reactions(toml);
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(all[i].settings.from.text, again[i].settings.from.text);
}

TEST(Recipe, ARejectedTakeGetsTheNextSeedAndNoOtherChanges) {
  const std::string toml =
      kHead + "[[matrix]]\nhit = [\"head\", \"chest\"]\njitter = { direction-deg = 5 }\n";
  const auto before = reactions(toml);
  const auto after = reactions(toml, {{{"mannequin", "chest_front"}, 2}});
  EXPECT_EQ(after[0].settings.from.text, before[0].settings.from.text);
  EXPECT_NE(after[1].settings.from.text, before[1].settings.from.text);
  EXPECT_EQ(after[1].seed, 2u);
  EXPECT_EQ(names(after), names(before));
}

TEST(RecipeRefusal, AtItsTopSaysWhereAndWhatIsNear) {
  expect_refused("format = 1\n", 1, 1, "'characters' is missing", "mannequin");
  expect_refused("characters = [\"mannequin\"]\n", 1, 1, "'format' is missing", "format = 1");
  expect_refused("format = 2\n", 1, 10, "'format'", "format = 1");
  expect_refused(kHead, 1, 1, "neither [[matrix]] nor [[reaction]]", "add one");
  expect_refused(kHead + "charcters = 1\n", 3, 1, "unknown key 'charcters'", "did you mean 'characters'?");
  expect_refused(kHead + "fps = 30\n", 3, 1, "unknown key 'fps'", "below [settings]");
  expect_refused(kHead + "outputs = [\"glb\", \"gbl\"]\n", 3, 19, "unknown output 'gbl'",
                 "did you mean 'glb'?");
}

TEST(RecipeRefusal, InSettingsSaysWhereAndWhatIsNear) {
  expect_refused(kHead + "[settings]\nfsp = 30\n", 4, 1, "unknown setting 'fsp'", "did you mean 'fps'?");
  expect_refused(kHead + "[settings]\nfps = \"30\"\n", 4, 7, "'fps' is a text", "give a number, 1 to 1000");
  expect_refused(kHead + "[settings]\nfps = 0\n", 4, 7, "'fps': 0 is out of range", "1 to 1000");
  expect_refused(kHead + "[settings]\nuntil-rest = 1\n", 4, 14, "'until-rest' is a number", "true or false");
  expect_refused(kHead + "[settings]\nregion = 5\n", 4, 10, "'region' is a number", "quotes");
  expect_refused(kHead + "[settings]\nkeys = \"al\"\n", 4, 8, "unknown word 'al'", "did you mean 'all'?");
  expect_refused(kHead + "[settings]\nhit = [\"head\"]\n", 4, 7, "several values", "[[matrix]]");
}

TEST(RecipeRefusal, InAMatrixSaysWhereAndWhatIsNear) {
  expect_refused(kHead + "[[matrix]]\nhit = [\"head\", \"haed\"]\n", 4, 16, "unknown segment 'haed'",
                 "did you mean 'head'?");
  expect_refused(kHead + "[[matrix]]\nhti = [\"head\"]\n", 4, 1, "unknown setting 'hti'",
                 "did you mean 'hit'?");
  expect_refused(kHead + "[[matrix]]\nvariation = 3\n", 4, 1, "unknown setting 'variation'",
                 "did you mean 'variations'?");
  expect_refused(kHead + "[[matrix]]\nhit = []\n", 4, 7, "has no values", "at least one");
  expect_refused(kHead + "[[reaction]]\nhit = [\"head\"]\n", 4, 7, "several values", "[[matrix]]");
  expect_refused(kHead + "[[matrix]]\nvariations = 0\n", 4, 14, "whole number from 1 to", "whole number");
}

TEST(RecipeRefusal, InJitterAndNamesSaysWhereAndWhatIsNear) {
  expect_refused(kHead + "[[matrix]]\njitter = { direction = 5 }\n", 4, 12, "unknown jitter 'direction'",
                 "did you mean 'direction-deg'?");
  expect_refused(kHead + "[[matrix]]\njitter = { direction-deg = -5 }\n", 4, 28, "jitter of 'direction-deg'",
                 "0 to 180");
  expect_refused(kHead + "[[matrix]]\nname = \"{hti}\"\n", 4, 8, "unknown part '{hti}'",
                 "did you mean 'hit'?");
  expect_refused(kHead + "[[matrix]]\nname = \"{hit\"\n", 4, 8, "{ without }", "{hit}");
}

TEST(RecipeRefusal, OfCharactersJointsAndSyntaxSaysWhere) {
  expect_refused(kHead + "[character.\"maneqin\"]\nfps = 30\n", 3, 12, "no character is named 'maneqin'",
                 "did you mean 'mannequin'?");
  expect_refused("format = 1\ncharacters = [\"none/*.glb\"]\n", 2, 15, "no file matches 'none/*.glb'",
                 "relative to the recipe");
  expect_refused(kHead + "[[joint]]\nname = \"elbow\"\n", 3, 1, "unknown joint", "elbow_r");
  expect_refused(kHead + "[settings\n", 3, 10, "", "TOML syntax");
}

TEST(Recipe, ACharactersJointsComeAfterThoseOfAll) {
  const auto all = reactions(kHead + R"(
[[joint]]
name = "elbow_l"
alpha = [-10, 10]
[[joint]]
name = "elbow_r"
alpha = [-10, 10]
[[character.mannequin.joint]]
name = "elbow_r"
alpha = [-20, 20]
[[reaction]]
)");
  ASSERT_TRUE(all.at(0).settings.range);
  const auto& joints = all[0].settings.range->joints;
  EXPECT_NEAR(degrees(joints[index(*joint_named("elbow_l"))].twist_max), 10.0, 1e-9);
  EXPECT_NEAR(degrees(joints[index(*joint_named("elbow_r"))].twist_max), 20.0, 1e-9);
}

TEST_F(RecipeFolder, CharactersAreFilesBesideTheRecipeEachWithAFolderOfItsOwn) {
  write("heroes/b.glb");
  write("heroes/a.glb");
  write("heroes/a.fbx");
  write("heroes/notes.txt");
  write("odd [1].bvh");
  const Recipe recipe = recipe_of(
      "format = 1\ncharacters = [\"heroes/*.glb\", \"mannequin\", \"heroes/a.*\", \"odd*.bvh\"]\n"
      "[character.\"*.fbx\"]\nmass = 90\n[[matrix]]\ncharacters = [\"b.glb\", \"a.fbx\"]\nhit = [\"head\"]\n",
      folder / "r.toml");
  std::vector<std::string> folders, files;
  for (const RecipeCharacter& character : recipe.characters) {
    folders.push_back(character.name);
    files.push_back(character.written);
  }
  EXPECT_EQ(files, (std::vector<std::string>{"heroes/a.glb", "heroes/b.glb", "mannequin", "heroes/a.fbx",
                                             "odd [1].bvh"}));
  EXPECT_EQ(folders, (std::vector<std::string>{"a", "b", "mannequin", "a_2", "odd_1"}));
  EXPECT_EQ(recipe.characters[0].file, (folder / "heroes/a.glb").string());
  const auto all = reactions_of(recipe, {});
  ASSERT_TRUE(all) << all.error().message();
  ASSERT_EQ(all->size(), 2u);
  EXPECT_EQ((*all)[0].character, 1u);
  EXPECT_EQ((*all)[1].character, 3u);
  EXPECT_EQ((*all)[1].settings.mass_kg, 90.0);
  EXPECT_FALSE((*all)[0].settings.mass_kg);
}

TEST_F(RecipeFolder, FilesThatSettingsNameAreThoseBesideTheRecipe) {
  write("own.toml", "format = 1\n");
  const Recipe recipe =
      recipe_of(kHead + "[settings]\nactive-file = \"own.toml\"\nregion = \"diamond\"\n[[reaction]]\n",
                folder / "r.toml");
  const auto all = reactions_of(recipe, {});
  ASSERT_TRUE(all);
  EXPECT_EQ(all->at(0).settings.active_file, (folder / "own.toml").string());
  EXPECT_EQ(all->at(0).settings.region, "diamond");
}

TEST(Recipe, TakesTheWordsOfArtistsButNotTwoForOneSetting) {
  const auto all =
      reactions(kHead + "[settings]\npre-roll = 0.5\n[[matrix]]\nname = \"a{blend-out}\"\nreturn = [1, 2]\n");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].settings.lead_s, 0.5);
  EXPECT_EQ(all[1].settings.recover_s, 2.0);
  EXPECT_EQ(all[1].name, "a2");
  EXPECT_EQ(all[1].written.at("recover"), "2");
  expect_refused(kHead + "[settings]\nlead = 1\npre-roll = 2\n[[reaction]]\n", 5, 1, "under two names",
                 "write pre-roll once");
  expect_refused(kHead + "[[matrix]]\nlead = [1, 2]\npre-roll = 2\n", 5, 1, "under two names",
                 "write pre-roll once");
}

/// The reference with its lines of one # put to work.
std::string uncommented(const std::string& reference) {
  std::istringstream lines(reference);
  std::string text;
  for (std::string line; std::getline(lines, line);)
    text += (line.starts_with("# ") ? line.substr(2) : line) + "\n";
  return text;
}

TEST(RecipeReference, IsAValidRecipe) {
  const auto all = reactions(recipe_reference());
  EXPECT_EQ(all.size(), 8u);
}

TEST(RecipeReference, IsOneToWhenItsCommentsAreTakenAway) {
  const std::string text = uncommented(recipe_reference());
  EXPECT_NE(text.find("\n[settings]\n"), std::string::npos);
  const auto all = reactions(text);
  EXPECT_EQ(all.size(), 2u * 4u * 3u + 1u);
}

TEST(RecipeReference, NamesEverySettingWithItsDefault) {
  const std::string text = recipe_reference();
  for (const Setting& setting : bake_settings())
    EXPECT_NE(text.find(std::string(setting.shown()) + " = "), std::string::npos) << setting.name;
  EXPECT_NE(text.find("\n# fps = 60\n"), std::string::npos);
  EXPECT_NE(text.find("\n# keys = \"reduced\"\n"), std::string::npos);
  EXPECT_NE(text.find("\n# until-rest = true\n"), std::string::npos);
}

TEST(RecipeReference, FitsAPage) {
  std::istringstream lines(recipe_reference());
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 112u) << line;
}

}  // namespace
}  // namespace ukemi
