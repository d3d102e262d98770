// The pages of `ukemi help`: Markdown files in assets/help.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace ukemi {

/// Names of the pages, in order. Empty where the program's files are missing.
std::vector<std::string> help_topics();

/// Errors: input, where the file cannot be read.
Result<std::string> help_page(const std::string& topic);

/// The page's title, without its mark.
std::string title_of(const std::string& page);

}  // namespace ukemi
