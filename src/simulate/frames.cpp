#include "simulate/frames.h"

#include <cmath>

namespace ukemi {
namespace {

Rigid between(const Rigid& a, const Rigid& b, double u) {
  return {a.rotation.slerp(u, b.rotation), a.translation + u * (b.translation - a.translation)};
}

BodyPose between(const BodyPose& a, const BodyPose& b, double u) {
  BodyPose pose;
  for (int s = 0; s < kSegmentCount; ++s) pose[s] = between(a[s], b[s], u);
  return pose;
}

}  // namespace

FrameWriter::FrameWriter(double fps, double duration_s, double tick_s, std::vector<Prop> props, State start)
    : duration_s_(duration_s), slack_s_(1e-6 * tick_s), before_(start), now_(std::move(start)) {
  trajectory.fps = fps;
  trajectory.props = std::move(props);
  write_until(0.0);
}

void FrameWriter::add(double time_s, State state) {
  before_ = std::move(now_);
  now_ = std::move(state);
  write_until(time_s);
  before_s_ = time_s;
}

void FrameWriter::hold() {
  before_ = now_;
  write_until(duration_s_);
}

/// Frames whose time lies in (before, time_s].
void FrameWriter::write_until(double time_s) {
  for (;;) {
    const double frame_s = static_cast<double>(trajectory.frames.size()) / trajectory.fps;
    if (frame_s > time_s + slack_s_ || frame_s > duration_s_ + slack_s_) return;
    const double span = time_s - before_s_;
    const double u = span > 0.0 ? (frame_s - before_s_) / span : 1.0;
    const bool on_end = std::abs(frame_s - time_s) <= slack_s_;
    trajectory.frames.push_back(on_end ? now_.segments : between(before_.segments, now_.segments, u));
    for (std::size_t i = 0; i < now_.props.size(); ++i)
      trajectory.props[i].poses.push_back(on_end ? now_.props[i]
                                                 : between(before_.props[i], now_.props[i], u));
  }
}

}  // namespace ukemi
