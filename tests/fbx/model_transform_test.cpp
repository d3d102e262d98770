#include "fbx/model_transform.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace ukemi {
namespace {

class Numbers {
 public:
  Vec3 vector(double size) { return test::random_vector(random_, size); }
  ModelTransform model() {
    ModelTransform m;
    m.translation = vector(100), m.rotation_deg = vector(170), m.scaling = Vec3(1.5, 0.5, 2) + vector(0.3);
    m.rotation_offset = vector(10), m.rotation_pivot = vector(10);
    m.pre_rotation_deg = vector(180), m.post_rotation_deg = vector(180);
    m.scaling_offset = vector(10), m.scaling_pivot = vector(10);
    return m;
  }

 private:
  Random random_{7};
};

Affine moved(const Vec3& v) { return Affine(Eigen::Translation3d(v)); }

/// R_z R_y R_x and so on, written out: about the axes in the order of the name.
Affine turned(const Vec3& deg, const char* order) {
  Affine result = Affine::Identity();
  for (int i = 0; i < 3; ++i) {
    const int axis = order[i] - 'X';
    result = Affine(Eigen::AngleAxisd(radians(deg[axis]), Vec3::Unit(axis))) * result;
  }
  return result;
}

TEST(ModelTransform, IsTheChainOfTheSdk) {
  const char* orders[] = {"XYZ", "XZY", "YZX", "YXZ", "ZXY", "ZYX"};
  Numbers numbers;
  for (int order = 0; order < 6; ++order) {
    ModelTransform m = numbers.model();
    m.rotation_order = order;
    const Affine chain = moved(m.translation) * moved(m.rotation_offset) * moved(m.rotation_pivot) *
                         turned(m.pre_rotation_deg, "XYZ") * turned(m.rotation_deg, orders[order]) *
                         turned(m.post_rotation_deg, "XYZ").inverse() * moved(-m.rotation_pivot) *
                         moved(m.scaling_offset) * moved(m.scaling_pivot) *
                         Affine(Eigen::Scaling(m.scaling)) * moved(-m.scaling_pivot);
    EXPECT_TRUE(parent_from_model(m).isApprox(chain, 1e-12)) << orders[order];
  }
}

TEST(ModelTransform, ValuesPutItWhereItIsWanted) {
  Numbers numbers;
  for (int i = 0; i < 300; ++i) {
    ModelTransform m = numbers.model();
    m.rotation_order = i % 6;
    if (i % 5 == 0) m.scaling.x() = -m.scaling.x();
    ModelTransform other = m;
    other.translation = numbers.vector(50), other.rotation_deg = numbers.vector(180);
    const Affine wanted = parent_from_model(other);
    const LocalValues values = local_values(m, wanted, m.scaling, m.rotation_deg);
    m.translation = values.translation, m.rotation_deg = values.rotation_deg;
    EXPECT_TRUE(parent_from_model(m).isApprox(wanted, 1e-9)) << i;
  }
}

TEST(ModelTransform, AnglesDoNotJump) {
  ModelTransform model;
  model.pre_rotation_deg = {90, 0, 30};
  Vec3 previous_deg = Vec3::Zero();
  double most = 0.0;
  for (int frame = 0; frame <= 200; ++frame) {
    Affine wanted = Affine::Identity();
    wanted.linear() =
        (exp_rotation(Vec3(0, 0, radians(4.0 * frame))) * from_euler(Vec3(0, 0, radians(90)), axis_order(0)))
            .toRotationMatrix();
    const Vec3 deg = local_values(model, wanted, Vec3::Ones(), previous_deg).rotation_deg;
    if (frame > 0) most = std::max(most, (deg - previous_deg).cwiseAbs().maxCoeff());
    previous_deg = deg;
  }
  EXPECT_LT(most, 10.0);
  EXPECT_GT(previous_deg.cwiseAbs().maxCoeff(), 360.0) << "two turns are counted";
}

}  // namespace
}  // namespace ukemi
