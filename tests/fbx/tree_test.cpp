#include "fbx/tree.h"

#include <gtest/gtest.h>

#include <string>

#include "fbx/deflate.h"

namespace ukemi {
namespace {

/// A tree with every kind of property, an empty list and a record without an end mark.
FbxTree example(std::uint32_t version) {
  FbxTree tree;
  tree.version = version;
  std::vector<double> many(500);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = 0.25 * static_cast<double>(i % 7);
  tree.records = {
      fbx_branch("Objects", {},
                 {fbx_branch("Model", {fbx_long(7), fbx_text(std::string_view("Hips\0\1Model", 11))},
                             {fbx_leaf("Version", {fbx_int(232)}), fbx_leaf("Weight", {fbx_double(0.5)})}),
                  fbx_leaf("Array", {fbx_array(many), fbx_array(std::vector<float>{1.5f, -2.0f}),
                                     fbx_array(std::vector<std::int32_t>{3, -4}),
                                     fbx_array(std::vector<std::int64_t>{1, 46186158000})}),
                  fbx_leaf("Raw", {fbx_bytes(std::vector<std::uint8_t>{1, 2, 3})})}),
      fbx_branch("References", {}, {})};
  tree.tail.assign(16, 0xFA);
  tree.tail.resize(16 + 4 + 4);
  for (int i = 0; i < 4; ++i) tree.tail.push_back(static_cast<std::uint8_t>(version >> (8 * i)));
  tree.tail.resize(tree.tail.size() + 120);
  tree.tail.insert(tree.tail.end(), 16, 0xF8);
  return tree;
}

std::vector<std::uint8_t> bytes_of(const FbxTree& tree) {
  auto bytes = write_fbx_tree(tree, "out.fbx");
  EXPECT_TRUE(bytes);
  return bytes ? *bytes : std::vector<std::uint8_t>{};
}

TEST(FbxTree, IsWrittenAsItWasRead) {
  for (const std::uint32_t version : {7400u, 7700u}) {
    const auto bytes = bytes_of(example(version));
    const auto tree = read_fbx_tree(bytes, "in.fbx");
    ASSERT_TRUE(tree) << tree.error().message();
    EXPECT_EQ(tree->version, version);
    EXPECT_EQ(bytes_of(*tree), bytes);
    EXPECT_EQ((bytes.size() - 140) % 16, 4u) << "the version at the end stands as the SDK puts it";
  }
}

TEST(FbxTree, HoldsValuesOfEveryKind) {
  const auto tree = read_fbx_tree(bytes_of(example(7400)), "in.fbx");
  ASSERT_TRUE(tree);
  const FbxRecord* model = child_of(tree->records[0], "Model");
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(integer_at(*model, 0), 7);
  EXPECT_EQ(text_at(*model, 1), std::string_view("Hips\0\1Model", 11));
  EXPECT_EQ(number_at(*child_of(*model, "Weight"), 0), 0.5);
  EXPECT_EQ(text_at(*model, 2), std::nullopt);
  EXPECT_EQ(integer_at(*model, 1), std::nullopt);
  const FbxRecord* array = child_of(tree->records[0], "Array");
  const auto many = numbers_at(*array, 0);
  ASSERT_TRUE(many);
  ASSERT_EQ(many->size(), 500u);
  EXPECT_EQ((*many)[13], 0.25 * 6);
  EXPECT_LT(array->properties[0].bytes.size(), 500u) << "long arrays are deflated";
  EXPECT_EQ(numbers_at(*array, 1), (std::vector<double>{1.5, -2.0}));
  EXPECT_EQ(numbers_at(*array, 2), (std::vector<double>{3, -4}));
  EXPECT_EQ(numbers_at(*array, 3), (std::vector<double>{1, 46186158000.0}));
  EXPECT_EQ(numbers_at(*model, 0), std::nullopt) << "no array";
}

TEST(FbxTree, EveryCutIsRefusedOrWhole) {
  const auto bytes = bytes_of(example(7400));
  const std::size_t records_end = bytes.size() - example(7400).tail.size();
  int refused = 0;
  for (std::size_t size = 0; size < records_end - 16; ++size) {
    const auto tree = read_fbx_tree(std::span(bytes).first(size), "cut.fbx");
    if (tree) continue;
    ++refused;
    EXPECT_EQ(tree.error().kind, ErrorKind::input);
  }
  EXPECT_EQ(refused, static_cast<int>(records_end - 16));
}

TEST(FbxTree, RefusesWhatLiesAboutItsLength) {
  auto bytes = bytes_of(example(7400));
  bytes[27] = 0xFF;  // end offset of the first record
  bytes[28] = 0xFF;
  const auto tree = read_fbx_tree(bytes, "lie.fbx");
  ASSERT_FALSE(tree);
  EXPECT_NE(tree.error().what.find("ends outside of what holds it (byte 27)"), std::string::npos)
      << tree.error().what;
}

TEST(FbxTree, RefusesTextAndOldVersions) {
  const std::string text = "; FBX 7.5.0 project file\n; ------------------\n";
  const auto ascii =
      read_fbx_tree({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "a.fbx");
  ASSERT_FALSE(ascii);
  EXPECT_NE(ascii.error().what.find("no binary FBX"), std::string::npos);
  EXPECT_NE(ascii.error().fix.find("binary"), std::string::npos);
  const auto old = read_fbx_tree(bytes_of(example(6100)), "b.fbx");
  ASSERT_FALSE(old);
  EXPECT_NE(old.error().what.find("version 6.1"), std::string::npos) << old.error().what;
}

TEST(FbxTree, InflatesExactlyWhatIsSaid) {
  const std::vector<std::uint8_t> bytes(1000, 5);
  const auto stream = deflated(bytes);
  ASSERT_FALSE(stream.empty());
  EXPECT_EQ(inflated(stream, 1000), bytes);
  EXPECT_EQ(inflated(stream, 999), std::nullopt);
  EXPECT_EQ(inflated(stream, 1001), std::nullopt);
  EXPECT_EQ(inflated(std::span(stream).first(stream.size() / 2), 1000), std::nullopt);
  EXPECT_EQ(inflated(stream, std::size_t{1} << 40), std::nullopt) << "claims more than any stream holds";
}

}  // namespace
}  // namespace ukemi
