// Joints of a range of motion as tables inside another TOML document, as a recipe has them.
#pragma once

#include <string>

#include "base/result.h"
#include "restrict/range_of_motion.h"

// As <toml++/toml.h> 3 declares it, so that its headers stay in source files.
namespace toml {
inline namespace v3 {
class array;
}
}  // namespace toml

namespace ukemi {

/// The range with the joints of `joints` in place of its own: tables as the [[joint]] of a region file, which
/// need only the keys that change (polygon, alpha; degrees). One side is changed, not its mirror. The
/// result's name lists them: "human with elbow_l". Errors: input, in `file`, with the table's line and the
/// joint.
Result<RangeOfMotion> with_joint_tables(RangeOfMotion range, const toml::array& joints,
                                        const std::string& file);

}  // namespace ukemi
