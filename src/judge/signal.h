// Sequences of vectors over time: filtered without delay, differentiated, summed up.
#pragma once

#include <vector>

#include "base/math.h"

namespace ukemi {

/// A point or vector over time, one value per frame.
using Course = std::vector<Vec3>;

/// Second-order Butterworth low-pass run forwards and backwards: no delay, half the amplitude at `cutoff_hz`.
/// The course is continued beyond its ends by its point reflection, so that a steady motion stays as it is. A
/// cutoff of 0.45 of the rate and more changes nothing.
Course low_passed(const Course& values, double fps, double cutoff_hz);

/// Per second: central differences, one-sided at the ends.
Course rate_of(const Course& values, double fps);

/// Lengths of the vectors, of their horizontal parts.
std::vector<double> norms(const Course& values);
std::vector<double> horizontal_norms(const Course& values);
double horizontal_norm(const Vec3& v);

}  // namespace ukemi
