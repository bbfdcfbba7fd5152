// A tree as Pinocchio's model, without its library and its readers of files.
#pragma once
#include <pinocchio/multibody.hpp>
#include <pinocchio/multibody/joint.hpp>
#include "tree.hpp"

namespace pin = pinocchio;
using Eigen::Map;
using Eigen::Matrix3d;
using Eigen::Vector3d;

inline pin::Model model_of(const Tree& tree) {
  pin::Model model;
  model.gravity.linear(Vector3d(0, 0, -tree.gravity));
  for (const Body& b : tree.bodies) {
    pin::JointModel joint = pin::JointModelRevoluteUnaligned(b.axis[0], b.axis[1], b.axis[2]);
    if (b.joint == "RX") joint = pin::JointModelRX();
    if (b.joint == "RY") joint = pin::JointModelRY();
    if (b.joint == "RZ") joint = pin::JointModelRZ();
    if (b.joint == "floating") joint = pin::JointModelFreeFlyer();
    const pin::SE3 pose(Matrix3d(Map<const Matrix3d>(b.rotation).transpose()), Map<const Vector3d>(b.position));
    Matrix3d inertia;
    const double* I = b.inertia;
    inertia << I[0], I[1], I[3], I[1], I[2], I[4], I[3], I[4], I[5];
    const auto index = model.addJoint(pin::JointIndex(b.parent + 1), joint, pose, "j" + std::to_string(model.njoints));
    model.appendBodyToJoint(index, pin::Inertia(b.mass, Map<const Vector3d>(b.centre), inertia), pin::SE3::Identity());
  }
  return model;
}
