#include "base/file_names.h"

#include <gtest/gtest.h>

namespace ukemi {
namespace {

TEST(FileNames, KeepWhatEveryFileSystemTakes) {
  EXPECT_EQ(file_name_from("head_left-2.5"), "head_left-2.5");
  EXPECT_EQ(file_name_from("Größe"), "Größe");
}

TEST(FileNames, LeaveNoFolderControlCharacterOrReservedName) {
  EXPECT_EQ(file_name_from("../../etc/passwd"), "_etc_passwd");
  EXPECT_EQ(file_name_from("a\\b:c*d?e\"f<g>h|i\nj\x01k"), "a_b_c_d_e_f_g_h_i_j_k");
  EXPECT_EQ(file_name_from("head__left"), "head_left");
  EXPECT_EQ(file_name_from("-o"), "_o");
  EXPECT_EQ(file_name_from(".hidden"), "_hidden");
  EXPECT_EQ(file_name_from("name. "), "name");
  EXPECT_EQ(file_name_from("CON"), "CON_");
  EXPECT_EQ(file_name_from("lpt1.x"), "lpt1.x_");
  EXPECT_EQ(file_name_from("/"), "unnamed");
  EXPECT_EQ(file_name_from(""), "unnamed");
  EXPECT_EQ(file_name_from("com"), "com");
}

TEST(FileNames, AreUtf8WithoutWhatHidesThem) {
  EXPECT_EQ(file_name_from("bad\xff\xfename"), "bad_name");
  EXPECT_EQ(file_name_from("cut\xe2\x82"), "cut");
  EXPECT_EQ(file_name_from("long\xc0\xafslash"), "long_slash");
  EXPECT_EQ(file_name_from("surrogate\xed\xa0\x80x"), "surrogate_x");
  EXPECT_EQ(file_name_from("a\xc2\x9b"
                           "31m"),
            "a_31m");
  EXPECT_EQ(file_name_from("gpj\xe2\x80\xae.exe"), "gpj_.exe");
  EXPECT_EQ(file_name_from("line\xe2\x80\xa8"
                           "end"),
            "line_end");
  EXPECT_EQ(file_name_from("\xe6\x97\xa5\xe6\x9c\xac \xf0\x9f\x99\x82"),
            "\xe6\x97\xa5\xe6\x9c\xac_\xf0\x9f\x99\x82");
}

TEST(FileNames, AreCutBetweenCharacters) {
  std::string umlauts = "a";
  for (int i = 0; i < 80; ++i) umlauts += "ä";
  const std::string cut = file_name_from(umlauts);
  EXPECT_EQ(cut.size(), 99u);  // 1 + 49 * 2
  EXPECT_EQ(umlauts.compare(0, cut.size(), cut), 0);
}

TEST(FileNames, AreUniqueWhateverTheCase) {
  UniqueNames names;
  EXPECT_EQ(names.take("Head"), "Head");
  EXPECT_EQ(names.take("head"), "head_2");
  EXPECT_EQ(names.take("head"), "head_3");
  EXPECT_EQ(names.take("head_2"), "head_2_2");
}

}  // namespace
}  // namespace ukemi
