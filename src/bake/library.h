// The library of reactions that a game chooses from: one flat row for each.
#pragma once

#include <string>
#include <vector>

#include "bake/baked.h"
#include "prepare/settings.h"

namespace ukemi {

/// CHARACTER_REACTION, or the reaction alone where it begins with CHARACTER_.
std::string library_name(const std::string& character, const std::string& reaction);

/// The row of a reaction as one line of JSON: an object whose members are texts, numbers and booleans, the
/// same in every row (assets/schemas/library.schema.json). Engines' tables have no empty numbers: what does
/// not happen is -1. `character` is its name; Name is library_name's, the verdict is left empty.
std::string library_row(const std::string& character, const BakeSettings& settings, const BakedFile& baked);

/// Whether a text is such a row, so far as the functions below need it: an object with a text Name, whose
/// members are texts, numbers and booleans.
bool is_library_row(const std::string& text);

struct LibraryEntry {
  std::string row;      // is_library_row
  std::string verdict;  // a reviewer's: "", "accepted", "rejected"
};

/// An array of the rows; a Name that comes twice (letter case ignored, as in Unreal) gets a number.
std::string library_json(const std::vector<LibraryEntry>& entries);
/// The same as a table (RFC 4180) whose first column is Name. Texts that a spreadsheet would take for a
/// formula get a ' before them.
std::string library_csv(const std::vector<LibraryEntry>& entries);

}  // namespace ukemi
