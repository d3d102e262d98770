#include "simulate/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "base/quantile.h"

namespace ukemi {
namespace {

constexpr double kAfterBlow_s = 1.0;   // after the blow
constexpr double kContact_s = 0.3;     // within which a blow is over
constexpr double kJitterSpan_s = 0.5;  // before the end
constexpr double kSettled_s = 0.1;     // after the start: what touches the floor by then stood on it

}  // namespace

Vec3 angular_momentum_about_centre(const std::vector<ModelBody>& bodies) {
  Vec3 centre = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  double mass = 0.0;
  for (const ModelBody& body : bodies) {
    const RigidState s = read_state(body.id);
    centre += body.mass_kg * s.position;
    velocity += body.mass_kg * s.linear_velocity;
    mass += body.mass_kg;
  }
  centre /= mass;
  velocity /= mass;
  Vec3 momentum = Vec3::Zero();
  for (const ModelBody& body : bodies) {
    const RigidState s = read_state(body.id);
    momentum += body.mass_kg * (s.position - centre).cross(s.linear_velocity - velocity) +
                s.rotation * (body.inertia * (s.rotation.conjugate() * s.angular_velocity));
  }
  return momentum;
}

Recorder::Recorder(const Model& model, double gravity)
    : model_(model), gravity_(gravity), lowest_energy_(std::numeric_limits<double>::infinity()) {}

void Recorder::excess_of_step(const std::vector<double>& excess_by_joint, double projected_max) {
  for (std::size_t j = 0; j < excess_by_joint.size(); ++j) {
    const double value = excess_by_joint[j];
    ++samples_;
    if (value <= 0.0) continue;
    outside_.push_back(value);
    if (value > radians(1.0)) ++over_1deg_;
    if (value > excess_max_) {
      excess_max_ = value;
      worst_ = model_.joints()[j].joint;
    }
  }
  projected_max_ = std::max(projected_max_, projected_max);
}

void Recorder::hash_state() {
  for (const ModelBody& body : model_.bodies()) {
    const RigidState s = read_state(body.id);
    const std::array<double, 13> numbers = {
        s.position.x(),        s.position.y(),        s.position.z(),         s.rotation.w(),
        s.rotation.x(),        s.rotation.y(),        s.rotation.z(),         s.linear_velocity.x(),
        s.linear_velocity.y(), s.linear_velocity.z(), s.angular_velocity.x(), s.angular_velocity.y(),
        s.angular_velocity.z()};
    hash_.add(std::span(reinterpret_cast<const std::uint8_t*>(numbers.data()), sizeof numbers));
  }
}

void Recorder::step(double time_s, double h, const Contacts& contacts, double extra_energy, double work,
                    double separation) {
  double energy = extra_energy;
  double mean_square = 0.0;
  for (const ModelBody& body : model_.bodies()) {
    const RigidState s = read_state(body.id);
    energy += kinetic_energy(body.mass_kg, body.inertia, s) + body.mass_kg * gravity_ * s.position.y();
    mean_square += s.angular_velocity.squaredNorm() / static_cast<double>(model_.bodies().size());
  }
  work_ += work;
  energy -= work_;
  lowest_energy_ = std::min(lowest_energy_, energy);
  figures_.energy_gain_max_j = std::max(figures_.energy_gain_max_j, energy - lowest_energy_);
  if (h <= 0.0) return;  // the start: energy alone
  ++figures_.steps;
  figures_.joint_separation_max_m = std::max(figures_.joint_separation_max_m, separation);
  figures_.floor_penetration_max_m = std::max(figures_.floor_penetration_max_m, contacts.floor_penetration);
  figures_.floor_penetration_end_m = contacts.floor_penetration;
  figures_.self_penetration_max_m = std::max(figures_.self_penetration_max_m, contacts.self_penetration);
  if (!contacts.ground) airborne_ += h;
  if (time_s <= kAfterBlow_s + 1e-9) {
    momentum_integral_ += h * angular_momentum_about_centre(model_.bodies()).norm();
    momentum_time_ += h;
  }
  turning_.push_back({time_s, h, mean_square});
  hash_state();
}

void Recorder::touches(const Senses& senses) {
  for (const SegmentContact& contact : senses.contacts) {
    if (contact.with != SegmentContact::With::floor) continue;
    const int s = index(contact.segment);
    if (!before_ || senses.time_s <= kSettled_s) stood_[s] = true;
    if (stood_[s] || figures_.touch_down[s]) continue;
    const bool foot = contact.segment == Segment::foot_l || contact.segment == Segment::foot_r;
    if (!foot && !figures_.first_ground_contact_s) figures_.first_ground_contact_s = senses.time_s;
    const Vec3 velocity =
        before_->velocity[s] + before_->angular_velocity[s].cross(contact.place - before_->centre[s]);
    figures_.touch_down[s] = TouchDown{contact.segment, senses.time_s, std::max(0.0, -velocity.y())};
  }
  before_ = senses;
}

void Recorder::delivered(double time_s, double n_s) {
  if (time_s <= kContact_s) figures_.delivered_n_s = std::max(figures_.delivered_n_s, n_s);
}

double Recorder::root_mean_square_turning(double from_s, double to_s) const {
  double weight = 0.0;
  double sum = 0.0;
  for (const Turning& t : turning_) {
    if (t.time_s < from_s || t.time_s > to_s) continue;
    sum += t.h * t.mean_square;
    weight += t.h;
  }
  return weight > 0.0 ? std::sqrt(sum / weight) : 0.0;
}

LimitFigures Recorder::limits(bool projected) const {
  LimitFigures result;
  result.samples = samples_;
  result.over_1deg = over_1deg_;
  result.excess_max_deg = degrees(excess_max_);
  result.worst_joint = worst_;
  result.projected = projected;
  result.excess_projected_max_deg = degrees(projected_max_);
  result.excess_p999_deg = degrees(exceeded_by(outside_, samples_, 0.001));
  return result;
}

SimulationFigures Recorder::figures() const {
  SimulationFigures result = figures_;
  result.airborne_mean_s = airborne_;
  if (momentum_time_ > 0.0) result.angular_momentum_mean_kg_m2_s = momentum_integral_ / momentum_time_;
  if (!turning_.empty())
    result.jitter_rad_s =
        root_mean_square_turning(turning_.back().time_s - kJitterSpan_s, turning_.back().time_s);
  result.turning_mean_rad_s = root_mean_square_turning(0.0, kAfterBlow_s + 1e-9);
  result.hash = fmt::format("{:016x}", hash_.value());
  return result;
}

}  // namespace ukemi
