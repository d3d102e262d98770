#include "bake/score.h"

#include "judge/judge.h"

namespace ukemi {

double human_score(const Character& character, const BakedClip& baked) {
  const Timeline& timeline = baked.timeline;
  JudgedMotion motion = judged_motion(character, baked.prepared.humanoid, timeline.clip);
  motion.mass_kg = baked.prepared.body.mass_kg;
  JudgeSettings blow;
  blow.impact_s = timeline.impact_s;
  blow.momentum_n_s = baked.figures.momentum_n_s;
  blow.hit = baked.prepared.scene.target;
  blow.knock_out = baked.behaviour.knocked_out_s.has_value();
  if (baked.returns_s > 0.0) blow.to_s = timeline.clip.duration_s() - baked.returns_s;
  return judge(motion, blow).score;
}

}  // namespace ukemi
