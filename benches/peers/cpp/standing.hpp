// A robot whose feet are held, in the three ways Pinocchio has for it; `stages/feet.py` writes the files.
#pragma once
#include <pinocchio/algorithm/constrained-dynamics.hpp>
#include <pinocchio/algorithm/pv.hpp>
#include <pinocchio/constraints.hpp>
#include "tree.hpp"

struct Standing {
  using VectorXd = Eigen::VectorXd;

  const Tree& tree;
  const pinocchio::Model& model;
  std::vector<pinocchio::RigidConstraintModel> feet;
  std::vector<pinocchio::RigidConstraintData> dense_feet;
  // The sparse solvers take constraints of another kind.
  std::vector<pinocchio::FrameAnchorConstraintModel> anchors;
  std::vector<pinocchio::FrameAnchorConstraintData> anchor_feet;
  // Every way keeps what it needs in a workspace of its own.
  pinocchio::Data dense, pv, aba;
  const std::vector<VectorXd>&q, &u;
  std::vector<VectorXd> v, want;
  VectorXd torques;

  static bool has_feet(const std::string& folder, const std::string& name) {
    return std::ifstream(folder + "/" + name + ".feet").good();
  }

  Standing(const std::string& folder, const Tree& t, const pinocchio::Model& m, const std::vector<VectorXd>& positions,
           const std::vector<VectorXd>& loads)
      : tree(t), model(m), dense(m), pv(m), aba(m), q(positions), u(loads), torques(t.nv) {
    const auto numbers = read_numbers(folder + "/" + t.name + ".feet");
    for (size_t i = 0; i + 14 <= numbers.size(); i += 14) {
      const double* foot = &numbers[i];
      const Eigen::Matrix3d by_columns = Eigen::Map<const Eigen::Matrix3d>(foot + 2);
      const pinocchio::SE3 pose(by_columns.transpose(), Eigen::Map<const Eigen::Vector3d>(foot + 11));
      const auto joint = pinocchio::JointIndex(foot[1]) + 1;
      feet.emplace_back(pinocchio::CONTACT_6D, model, joint, pose, pinocchio::LOCAL);
      anchors.emplace_back(model, joint, pose);
    }
    for (const auto& foot : feet) dense_feet.push_back(foot.createData());
    for (const auto& foot : anchors) anchor_feet.push_back(foot.createData());
    pinocchio::initConstraintDynamics(model, dense, feet, dense_feet);
    pinocchio::initPvSolver(model, pv, anchors);
    pinocchio::initPvSolver(model, aba, anchors);
    const auto held = read_numbers(folder + "/" + t.name + ".held");
    for (int k = 0; k < STATES; ++k) {
      const double* row = &held[size_t(k) * size_t(2 * t.nv)];
      v.emplace_back(Eigen::Map<const VectorXd>(row, t.nv));
      want.emplace_back(Eigen::Map<const VectorXd>(row + t.nv, t.nv));
    }
  }

  const VectorXd& load(size_t i) {
    if (tree.springs.empty()) return u[i];
    tree.add_springs(q[i].data(), v[i].data(), u[i].data(), 1.0, torques.data());
    return torques;
  }

  // The constraints are independent: neither damping nor a second iteration is needed.
  void by_dense(int k) {
    const auto i = size_t(k);
    pinocchio::ProximalSettings settings(1e-12, 1e-12, 0, 1);
    pinocchio::constraintDynamics(model, dense, q[i], v[i], load(i), feet, dense_feet, settings);
    used(dense.ddq);
  }

  void by_pv(int k) {
    const auto i = size_t(k);
    pinocchio::ProximalSettings settings(1e-12, 1e-12, 0, 1);
    pinocchio::pv(model, pv, q[i], v[i], load(i), anchors, anchor_feet, settings);
    used(pv.ddq);
  }

  // It lives on damping, and iterates.
  void by_aba(int k) {
    const auto i = size_t(k);
    pinocchio::ProximalSettings settings(1e-10, 1e-10, 1e-6, 10);
    pinocchio::constrainedABA(model, aba, q[i], v[i], load(i), anchors, anchor_feet, settings);
    used(aba.ddq);
  }

  double error(const pinocchio::Data& data, int k) const {
    return tree.error(data.ddq.data(), want[size_t(k)].data(), true);
  }
};
