#include "judge/judgement.h"

namespace ukemi {

double score_of(const std::vector<Criterion>& criteria) {
  int passed = 0, applicable = 0;
  for (const Criterion& criterion : criteria) {
    passed += criterion.passed.value_or(false);
    applicable += criterion.passed.has_value();
  }
  return applicable == 0 ? 1.0 : static_cast<double>(passed) / applicable;
}

const Criterion* find_criterion(const Judgement& judgement, int number) {
  for (const Criterion& criterion : judgement.criteria)
    if (criterion.number == number) return &criterion;
  return nullptr;
}

}  // namespace ukemi
