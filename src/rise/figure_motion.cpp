#include "rise/figure_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ukemi {

FigurePose between(const WholeBody& whole, const FigurePose& a, const FigurePose& b, double u) {
  FigurePose figure;
  figure.place = (1.0 - u) * a.place + u * b.place;
  figure.turn = a.turn.slerp(u, b.turn);
  PerJoint<SwingTwist> charts = whole.charts(a.joints);
  const PerJoint<SwingTwist> to = whole.charts(b.joints);
  for (int j = 0; j < kJointCount; ++j) {
    charts[j].swing = (1.0 - u) * charts[j].swing + u * to[j].swing;
    charts[j].twist = (1.0 - u) * charts[j].twist + u * to[j].twist;
  }
  figure.joints = whole.joints(charts);
  return figure;
}

FigurePose carried_on(const FigurePose& reference, const FigurePose& figure, const FigurePose& next) {
  FigurePose result;
  result.place = next.place + figure.place - reference.place;
  result.turn = (figure.turn * reference.turn.conjugate() * next.turn).normalized();
  for (int j = 0; j < kJointCount; ++j)
    result.joints[j] = (next.joints[j] * reference.joints[j].conjugate() * figure.joints[j]).normalized();
  return result;
}

std::vector<FigurePose> smoothed(const WholeBody& whole, const std::vector<FigurePose>& figures,
                                 double sigma_frames) {
  const int count = static_cast<int>(figures.size());
  std::vector<FigurePose> result;
  std::vector<PerJoint<SwingTwist>> charts;
  for (const FigurePose& figure : figures) charts.push_back(whole.charts(figure.joints));
  for (int f = 0; f < count; ++f) {
    const int edge = std::min(f, count - 1 - f);
    const double sigma = std::min(sigma_frames, edge / 2.5);
    const int reach = std::min(edge, static_cast<int>(std::ceil(2.5 * sigma)));
    if (sigma < 1e-6) {
      result.push_back(figures[f]);
      continue;
    }
    Vec3 place = Vec3::Zero(), turn = Vec3::Zero();
    PerJoint<SwingTwist> mean_chart{};
    double sum = 0.0;
    for (int k = -reach; k <= reach; ++k) {
      const double weight = std::exp(-0.5 * k * k / (sigma * sigma));
      const FigurePose& other = figures[f + k];
      sum += weight;
      place += weight * other.place;
      turn += weight * log_rotation(figures[f].turn.conjugate() * other.turn);
      for (int j = 0; j < kJointCount; ++j) {
        mean_chart[j].swing += weight * charts[f + k][j].swing;
        mean_chart[j].twist += weight * charts[f + k][j].twist;
      }
    }
    FigurePose mean = figures[f];
    mean.place = place / sum;
    mean.turn = (mean.turn * exp_rotation(turn / sum)).normalized();
    for (SwingTwist& chart : mean_chart) chart.swing /= sum, chart.twist /= sum;
    mean.joints = whole.joints(mean_chart);
    result.push_back(mean);
  }
  return result;
}

double growing(double x) {
  constexpr double kTimes = 300.0;
  return (std::pow(kTimes, x) - 1.0) / (kTimes - 1.0);
}

OuterSkin trunk_skin(const WholeBody& whole) {
  OuterSkin skin;
  for (const Segment s :
       {Segment::pelvis, Segment::abdomen, Segment::chest, Segment::thigh_l, Segment::thigh_r})
    skin[index(s)] = whole.skin()[index(s)];
  return skin;
}

double lowest_of(const OuterSkin& skin, const BodyPose& pose) {
  double low = std::numeric_limits<double>::infinity();
  for (int s = 0; s < kSegmentCount; ++s)
    for (const Vec3& p : skin[s]) low = std::min(low, (pose[s] * p).y());
  return std::isfinite(low) ? low : 0.0;
}

}  // namespace ukemi
