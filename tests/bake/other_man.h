// A man with shorter legs than the mannequin's, from the extra data.
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "load/load.h"
#include "support/extra_data.h"

namespace ukemi {

/// Nothing where the extra data are not there: skip with kNoExtraData.
inline std::optional<Character> other_man() {
  const auto folder = extra_data();
  const auto file = folder.value_or("") / "characters/quaternius_fbx/Male_Casual.fbx";
  if (!folder || !std::filesystem::exists(file)) return std::nullopt;
  Diagnostics diagnostics;
  auto man = load_character(file, {}, diagnostics);
  EXPECT_TRUE(man) << (man ? "" : man.error().message());
  return man ? std::optional(std::move(*man)) : std::nullopt;
}

}  // namespace ukemi
