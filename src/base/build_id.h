// What the program was built from.
#pragma once

#include <string_view>

namespace ukemi {

/// SHA-256 over the sources, the compiler and its flags, 64 hexadecimal digits: programs with the same id
/// bake the same on the same machine, and a program built anew from changed sources has another. It goes into
/// the digests by which a batch is resumed and into no output.
std::string_view build_id();

}  // namespace ukemi
