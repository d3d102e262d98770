#include "feet/on_feet.h"

namespace ukemi {

void OnFeet::drive(Goals& goals) const {
  for (int j = 0; j < kJointCount; ++j)
    goals.joints[j].insert(goals.joints[j].end(), asked_.joints[j].begin(), asked_.joints[j].end());
  goals.firm_soles = goals.firm_soles || asked_.firm_soles;
  goals.glides = asked_.glides;
  goals.help_n += asked_.help_n;
}

}  // namespace ukemi
