#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "load/load.h"

namespace ukemi {
namespace {

const std::string kHierarchy =
    "HIERARCHY\nROOT Hips\n{\n OFFSET 1 2 3\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
    "Yrotation\n"
    " JOINT Left Arm\n {\n  OFFSET 0 10 0\n  CHANNELS 3 Yrotation Xrotation Zrotation\n"
    "  End Site\n  {\n   OFFSET 0 5 0\n  }\n }\n}\n";
const std::string kMotion =
    "MOTION\nFrames: 2\nFrame Time: .0083333\n4 5 6 0 0 90 0 90 0\n4 5 6 30 20 10 -10 5 7\n";

Result<Character> read(std::string_view text, Diagnostics& diagnostics) {
  return read_bvh(text, "folder/walk.bvh", diagnostics);
}
Result<Character> read(std::string_view text) {
  Diagnostics diagnostics;
  return read(text, diagnostics);
}
std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Bvh, ReadsTheHierarchyInFileOrder) {
  const auto c = read(kHierarchy + kMotion);
  ASSERT_TRUE(c) << c.error().message();
  ASSERT_EQ(c->skeleton.size(), 2);
  EXPECT_EQ(c->name, "walk");
  EXPECT_EQ(c->skeleton.nodes[0].name, "Hips");
  EXPECT_EQ(c->skeleton.nodes[1].name, "Left Arm");
  EXPECT_EQ(c->skeleton.nodes[1].parent, 0);
  EXPECT_EQ(c->skeleton.nodes[1].rest.translation, Vec3(0, 10, 0));
  EXPECT_EQ(c->skeleton.order, (std::vector<int>{0, 1}));
  ASSERT_TRUE(c->bvh);
  EXPECT_EQ(c->bvh->channels[1][0], BvhChannel::y_rotation);
  EXPECT_FALSE(c->bvh->end_site[0]);
  EXPECT_EQ(c->bvh->end_site[1].value(), Vec3(0, 5, 0));
  EXPECT_EQ(c->bvh->frames[1], (std::vector<double>{4, 5, 6, 30, 20, 10, -10, 5, 7}));
}

TEST(Bvh, PositionsReplaceTheOffsetAndRotationsComposeInChannelOrder) {
  const auto c = read(kHierarchy + kMotion);
  ASSERT_TRUE(c) << c.error().message();
  const Animation& animation = c->animations.at(0);
  EXPECT_EQ(animation.fps, 120.0);
  EXPECT_EQ(c->bvh->frame_time_s, 0.0083333);
  const Pose first = sample(c->skeleton, animation, 0.0);
  EXPECT_LT((first[0].translation - Vec3(4, 5, 6)).norm(), 1e-12);
  EXPECT_LT((first[0].rotation * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-12) << "90 degrees about y";
  const Pose second = sample(c->skeleton, animation, animation.end_s);
  const Mat3 expected =
      (Eigen::AngleAxisd(radians(30), Vec3::UnitZ()) * Eigen::AngleAxisd(radians(20), Vec3::UnitX()) *
       Eigen::AngleAxisd(radians(10), Vec3::UnitY()))
          .toRotationMatrix();
  EXPECT_LT((second[0].rotation.toRotationMatrix() - expected).norm(), 1e-12);
  EXPECT_EQ(second[1].translation, Vec3(0, 10, 0)) << "no position channels: the offset stays";
}

TEST(Bvh, ChildPositionsReplaceTheOffsetAxisByAxis) {
  const std::string hierarchy =
      replaced(kHierarchy, "CHANNELS 3 Yrotation Xrotation Zrotation", "CHANNELS 1 Yposition");
  const auto c = read(hierarchy + "MOTION\nFrames: 1\nFrame Time: 0.04\n0 0 0 0 0 0 -7\n");
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_EQ(sample(c->skeleton, c->animations[0], 0.0)[1].translation, Vec3(0, -7, 0));
  EXPECT_EQ(c->animations[0].tracks.size(), 3u) << "root position and rotation, child position";
}

/// A child with six channels whose positions are given for two rows.
std::string with_six_channels(const std::string& first, const std::string& second) {
  return replaced(kHierarchy, "CHANNELS 3 Yrotation", "CHANNELS 6 Xposition Yposition Zposition Yrotation") +
         "MOTION\nFrames: 2\nFrame Time: .01\n1 2 3 0 0 0 " + first + " 0 0 0\n1 2 3 0 0 0 " + second +
         " 0 0 0\n";
}

TEST(Bvh, ChildPositionsAroundZeroAreAddedToTheOffset) {
  const std::tuple<const char*, const char*, Vec3, bool> kCases[] = {
      {"0 0 0", "0 0 0", Vec3(0, 10, 0), true},
      {"0 0 0", "0.5 -1 0", Vec3(0.5, 9, 0), true},
      {"0 10 0", "0.5 9 0", Vec3(0.5, 9, 0), false}};
  for (const auto& [first, second, last, add] : kCases) {
    const auto c = read(with_six_channels(first, second));
    ASSERT_TRUE(c) << c.error().message();
    EXPECT_EQ(c->bvh->positions_add, add) << second;
    const Pose pose = sample(c->skeleton, c->animations.at(0), 1.0);
    EXPECT_LT((pose[1].translation - last).norm(), 1e-12) << second;
    EXPECT_LT((pose[0].translation - Vec3(1, 2, 3)).norm(), 1e-12) << "the root's are never added";
  }
}

TEST(Bvh, BelievesTheUnitInTheNameOfAnEndSite) {
  const auto stated = read(replaced(kHierarchy, "End Site", "End Site unit=0.01m,up=y") + kMotion);
  ASSERT_TRUE(stated) << stated.error().message();
  EXPECT_EQ(stated->metres_per_unit.value(), 0.01);
  EXPECT_TRUE(stated->yup_from_file);
  for (const char* name : {"End Site", "End Site LeftToe", "End Site unit=m,up=y", "End Site unit=-1m,up=y",
                           "End Site unit=0.01"}) {
    const auto c = read(replaced(kHierarchy, "End Site", name) + kMotion);
    ASSERT_TRUE(c) << name;
    EXPECT_FALSE(c->metres_per_unit) << name;
  }
}

TEST(Bvh, WarnsOfLessThanAFrameASecond) {
  for (const auto& [time, warnings] : {std::pair("33.3333", 1u), {"1.5", 1u}, {"1", 0u}, {"0.04", 0u}}) {
    Diagnostics diagnostics;
    ASSERT_TRUE(read(kHierarchy + replaced(kMotion, ".0083333", time), diagnostics));
    EXPECT_EQ(diagnostics.warnings().size(), warnings) << time;
  }
}

TEST(Bvh, AcceptsWhatExportersWrite) {
  std::string crlf;
  for (const char ch : kHierarchy + kMotion) crlf += ch == '\n' ? "\r\n" : std::string(1, ch);
  std::string old_mac = kHierarchy + kMotion;
  std::replace(old_mac.begin(), old_mac.end(), '\n', '\r');
  const std::vector<std::string> texts{
      crlf,
      old_mac,
      "\xEF\xBB\xBF" + kHierarchy + kMotion,
      replaced(kHierarchy, "HIERARCHY", "hierarchy") + kMotion,
      replaced(kHierarchy, "End Site", "End site") + kMotion,
      replaced(kHierarchy, "Xposition", "XPOSITION") + kMotion,
      replaced(kHierarchy, "Left Arm\n {", "Left Arm {") + kMotion,
      kHierarchy + replaced(kMotion, "Frames: 2", "Frames:2"),
      kHierarchy + replaced(kMotion, "Frame Time: ", "Frame Time:\t"),
      kHierarchy + replaced(kMotion, "0 0 90", "+0 0e0  \t90.") + "\n\n  \n",
      (kHierarchy + kMotion).substr(0, (kHierarchy + kMotion).size() - 1),
  };
  for (const std::string& text : texts) {
    const auto c = read(text);
    ASSERT_TRUE(c) << c.error().message() << "\n" << text;
    EXPECT_EQ(c->skeleton.nodes[1].name, "Left Arm");
    EXPECT_EQ(c->bvh->frames.size(), 2u);
    EXPECT_EQ(c->bvh->frames[0][5], 90.0);
  }
}

TEST(Bvh, NamesThatAreNotUtf8AreReadAsLatin1) {
  const auto c = read(replaced(kHierarchy, "Left Arm",
                               "Br\xFC"
                               "cke") +
                      kMotion);
  ASSERT_TRUE(c);
  EXPECT_EQ(c->skeleton.nodes[1].name,
            "Br\xC3\xBC"
            "cke");
}

TEST(Bvh, RoundedFrameTimesGiveTheCommonRate) {
  const auto rate = [](const std::string& time) {
    const auto c = read(kHierarchy + replaced(kMotion, ".0083333", time));
    return c ? c->animations[0].fps : 0.0;
  };
  EXPECT_EQ(rate("0.033333"), 30.0);
  EXPECT_EQ(rate("0.0333"), 30.0);
  EXPECT_EQ(rate("0.033"), 30.0);
  EXPECT_EQ(rate("0.008333"), 120.0);
  EXPECT_EQ(rate("0.016667"), 60.0);
  EXPECT_EQ(rate("0.0416667"), 24.0);
  EXPECT_EQ(rate("0.01"), 100.0);
  EXPECT_EQ(rate("0.0333667"), 1.0 / 0.0333667) << "29.97 is not 30";
  EXPECT_EQ(rate("0.1"), 10.0);
}

TEST(Bvh, MoreRowsThanAnnouncedAreAWarning) {
  Diagnostics diagnostics;
  const auto c = read(kHierarchy + kMotion + "0 0 0 0 0 0 0 0 0\n", diagnostics);
  ASSERT_TRUE(c) << c.error().message();
  EXPECT_EQ(c->bvh->frames.size(), 2u);
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("1 more rows than the 2 that line 17"), std::string::npos)
      << diagnostics.warnings()[0].what;
}

struct Refusal {
  std::string text;
  int line;
  std::string what;
};

TEST(Bvh, RefusesWithTheLine) {
  const std::string good = kHierarchy + kMotion;
  const std::vector<Refusal> refusals{
      {"", 1, "HIERARCHY expected"},
      {"HIERARCHY\n", 2, "ROOT expected"},
      {"HIERARCHY\nROOT a\n{\nOFFSET 0 0", 4, "OFFSET expected, found the end"},
      {replaced(good, "OFFSET 1 2 3", "OFFSET 1 nan 3"), 4, "'nan'"},
      {replaced(good, "OFFSET 1 2 3", "OFFSET 1 2,5 3"), 4, "'2,5'"},
      {replaced(good, " OFFSET 1 2 3\n", ""), 14, "has no OFFSET"},
      {replaced(good, "OFFSET 1 2 3", "OFFSET 1 2 3 OFFSET 1 2 3"), 4, "two OFFSETs"},
      {replaced(good, "CHANNELS 6", "CHANNELS 7"), 5, "has 7 channels"},
      {replaced(good, "CHANNELS 6", "CHANNELS 5"), 5, "found 'Yrotation'"},
      {replaced(good, "CHANNELS 6", "CHANNELS -1"), 5, "has -1 channels"},
      {replaced(good, "CHANNELS 6 Xposition", "CHANNELS 6 Yposition"), 5, "twice"},
      {replaced(good, "Zrotation Xrotation", "Zrotation Wrotation"), 5, "'Wrotation'"},
      {replaced(good, " }\n}\n", " }\n CHANNELS 1 Xrotation\n}\n"), 15, "after a child"},
      {replaced(good, "End Site", "End Foot"), 10, "Site after End"},
      {replaced(good, "MOTION", "ROOT second\n{\n}\nMOTION"), 16, "second ROOT"},
      {replaced(good, "MOTION", "junk"), 16, "MOTION expected"},
      {replaced(good, "Frames: 2", "Frames: 0"), 17, "announces '0' frames"},
      {replaced(good, "Frames: 2", "Frames: -1"), 17, "announces '-1' frames"},
      {replaced(good, "Frames: 2", "Frames: 2.5"), 17, "announces '2.5' frames"},
      {replaced(good, "Frames: 2", "Frames: 99999999999"), 17, "frames"},
      {replaced(good, "Frames: 2", "Frames 2"), 17, "'Frames:' expected"},
      {replaced(good, "Frame Time: .0083333", "Frame Time: 0"), 18, "frame time '0'"},
      {replaced(good, "Frame Time: .0083333", "Frame Time: -1"), 18, "frame time '-1'"},
      {replaced(good, "Frame Time: .0083333", "Frame Time: inf"), 18, "frame time 'inf'"},
      {replaced(good, "4 5 6 0 0 90", "4 5 6 0 90"), 19, "row has 8 numbers; the joints have 9 channels"},
      {replaced(good, "4 5 6 30", "4 5 6 0 30"), 20, "row has 10 numbers"},
      {replaced(good, "4 5 6 30", "4 5 nan 30"), 20, "'nan' is not a finite number"},
      {replaced(good, "4 5 6 30", "4 5 1e999 30"), 20, "'1e999'"},
      {replaced(good, "4 5 6 30", "4 5 6,5 30"), 20, "'6,5'"},
      {good + "trailing junk\n", 21, "'trailing' is not"},
      {replaced(good, "Frames: 2", "Frames: 5"), 21, "ends after 2 of the 5 rows that line 17 announces"},
      {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n}\nMOTION\nFrames: 1\nFrame Time: 1\n\n", 5,
       "no joint has channels"},
      {std::string("\xFF\xFEH\0", 4), 1, "UTF-16"},
  };
  for (const Refusal& refusal : refusals) {
    const auto c = read(refusal.text);
    ASSERT_FALSE(c) << refusal.what;
    EXPECT_EQ(c.error().kind, ErrorKind::input);
    EXPECT_EQ(c.error().file, "folder/walk.bvh");
    EXPECT_EQ(c.error().line, refusal.line) << c.error().message();
    EXPECT_NE(c.error().message().find(refusal.what), std::string::npos) << c.error().message();
    EXPECT_FALSE(c.error().fix.empty());
  }
}

TEST(Bvh, RefusesAClipLongerThanADay) {
  std::string text = kHierarchy + kMotion;
  text.replace(text.find("Frames: 2"), 9, "Frames: 30");
  text.replace(text.find(".0083333"), 8, "3000");
  const auto c = read(text);
  ASSERT_FALSE(c);
  EXPECT_NE(c.error().what.find("longer than a day"), std::string::npos) << c.error().what;
}

TEST(Bvh, SaysThatNobodyFilmsAMillionFramesASecond) {
  Diagnostics diagnostics;
  ASSERT_TRUE(read_bvh(kHierarchy + replaced(kMotion, ".0083333", "0.000001"), "walk.bvh", diagnostics));
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_NE(diagnostics.warnings()[0].what.find("1e+06 frames a second"), std::string::npos);
}

TEST(Bvh, RefusesAnAbsurdDepth) {
  std::string text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n";
  for (int i = 0; i < 2000; ++i) text += "JOINT b\n{\nOFFSET 0 0 0\n";
  const auto c = read(text);
  ASSERT_FALSE(c);
  EXPECT_NE(c.error().what.find("deeper than 1000"), std::string::npos);
  EXPECT_EQ(c.error().line, 2 + 3 * 1000);
}

TEST(Bvh, EveryTruncationIsRefusedOrWhole) {
  const std::string good = kHierarchy + kMotion;
  for (std::size_t length = 0; length + 2 < good.size(); ++length)
    EXPECT_FALSE(read(good.substr(0, length))) << good.substr(0, length);
}

TEST(Bvh, ThreeMegabytesAreReadQuickly) {
  std::string text = replaced(kHierarchy, "CHANNELS 3 Yrotation Xrotation Zrotation",
                              "CHANNELS 3 Yrotation Xrotation Zrotation") +
                     "MOTION\nFrames: 40000\nFrame Time: 0.008333\n";
  for (int i = 0; i < 40000; ++i)
    text += fmt::format("{0:.6f} {0:.6f} {0:.6f} {0:.6f} {0:.6f} {0:.6f} {0:.6f} {0:.6f} {0:.6f}\n",
                        0.37 * i - 8000);
  const auto begin = std::chrono::steady_clock::now();
  const auto c = read(text);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  ASSERT_TRUE(c);
  RecordProperty("seconds", std::to_string(took.count()));
  EXPECT_GT(text.size(), 3'400'000u);
  EXPECT_LT(took.count(), 5.0) << "a hundred times what it takes on a quiet machine";
}

TEST(Bvh, WritesAGltfDocumentOfTheSkeleton) {
  const auto c = read(kHierarchy + kMotion);
  ASSERT_TRUE(c);
  EXPECT_EQ(c->document.json,
            R"({"asset":{"version":"2.0","generator":"ukemi"},"scene":0,"scenes":[{"nodes":[0]}],)"
            R"("nodes":[{"name":"Hips","translation":[1.0,2.0,3.0],"children":[1]},)"
            R"({"name":"Left Arm","translation":[0.0,10.0,0.0]}]})");
}

TEST(Bvh, ReadsWhatABakeSaysOfItsClip) {
  const std::string extras = R"({"ukemi": {"root_motion": "hips"}})";
  const std::string mark = "clip=eyJ1a2VtaSI6IHsicm9vdF9tb3Rpb24iOiAiaGlwcyJ9fQ==";
  for (const std::string before : {"", "unit=0.01m,up=y,"}) {
    const auto c = read(replaced(kHierarchy, "End Site", "End Site " + before + mark) + kMotion);
    ASSERT_TRUE(c) << c.error().message();
    EXPECT_EQ(c->animations.at(0).extras_json, extras);
    EXPECT_EQ(c->metres_per_unit.has_value(), !before.empty());
  }
  for (const char* name : {"End Site", "End Site clip", "End Site clip=e*yJ", "End Site clips=eyJ1"}) {
    const auto c = read(replaced(kHierarchy, "End Site", name) + kMotion);
    ASSERT_TRUE(c) << name;
    EXPECT_EQ(c->animations.at(0).extras_json, "") << name;
  }
}

}  // namespace
}  // namespace ukemi
