#include "base/version.h"

namespace ukemi {

std::string generator() { return std::string("ukemi ") + UKEMI_VERSION; }

}  // namespace ukemi
