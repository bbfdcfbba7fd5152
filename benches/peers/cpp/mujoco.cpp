// MuJoCo through its C interface, as its wheel brings it: no contacts, constraints, sensors or actuators.
#include <mujoco/mujoco.h>
#include <memory>
#include "worker.hpp"

// Light fast rotors cost formulations about the centre of mass some digits.
constexpr double TOLERANCE = 1e-9;

struct Robot {
  Tree tree;
  mjModel* model;
  mjData* data;
  std::vector<double> q, v, a, u, result, right;
  size_t nq, nv;

  explicit Robot(const Tree& t, const std::string& folder) : tree(t), nq(size_t(t.nq)), nv(size_t(t.nv)) {
    char problem[1000] = "";
    model = mj_loadXML((folder + "/" + t.name + ".xml").c_str(), nullptr, problem, sizeof problem);
    if (!model) fail(t.name + ".xml: " + problem);
    if (model->nq != t.nq || model->nv != t.nv) fail(t.name + ".xml: the coordinates are not those of the tree");
    model->opt.disableflags = mjDSBL_CONSTRAINT | mjDSBL_EQUALITY | mjDSBL_FRICTIONLOSS | mjDSBL_LIMIT | mjDSBL_CONTACT |
                              mjDSBL_CLAMPCTRL | mjDSBL_WARMSTART | mjDSBL_ACTUATION | mjDSBL_SENSOR | mjDSBL_AUTORESET |
                              mjDSBL_ISLAND | mjDSBL_SPRING | mjDSBL_DAMPER;
    data = mj_makeData(model);
    result.resize(nv);
    right.resize(nv);
    for (int k = 0; k < STATES; ++k) {
      q.insert(q.end(), t.q(k), t.q(k) + nq);
      v.insert(v.end(), t.v(k), t.v(k) + nv);
      a.insert(a.end(), t.a(k), t.a(k) + nv);
      u.insert(u.end(), t.u(k), t.u(k) + nv);
      if (!t.floating()) continue;
      double* place = &q[size_t(k) * nq + 3];
      std::rotate(place, place + 3, place + 4);  // x y z w to w x y z
      turn(k, &v[size_t(k) * nv], true);
      classical(k, &a[size_t(k) * nv], 1.0);
      turn(k, &a[size_t(k) * nv], true);
      turn(k, &u[size_t(k) * nv], true);
    }
  }

  // A free joint's linear velocity, acceleration and force are in world axes here, in the body's in the states.
  void turn(int k, double* x, bool to_world) const {
    if (!tree.floating()) return;
    double matrix[9], turned[3];
    mju_quat2Mat(matrix, &q[size_t(k) * nq + 3]);
    to_world ? mju_mulMatVec3(turned, matrix, x) : mju_mulMatTVec3(turned, matrix, x);
    std::copy(turned, turned + 3, x);
  }

  // Spatial acceleration to that of the origin, or back with sign -1: a + ω × v.
  void classical(int k, double* x, double sign) const {
    if (!tree.floating()) return;
    double cross[3];
    mju_cross(cross, tree.v(k) + 3, tree.v(k));
    mju_addToScl3(x, cross, sign);
  }

  void place(int k) { std::copy_n(&q[size_t(k) * nq], nq, data->qpos); }
  void move(int k) { place(k); std::copy_n(&v[size_t(k) * nv], nv, data->qvel); }
  const double* positions(int k) const { return &q[size_t(k) * nq]; }
  const double* velocities(int k) const { return &v[size_t(k) * nv]; }

  void push(int k) {
    tree.add_springs(positions(k), velocities(k), &u[size_t(k) * nv], 1.0, data->qfrc_applied);
  }

  void forward(int k) {
    move(k);
    push(k);
    mj_forward(model, data);
    used(data->qacc);
  }

  // The shortest sequence of public calls from a state and torques to accelerations.
  void forward_by_stages(int k) {
    move(k);
    push(k);
    mj_kinematics(model, data);
    mj_comPos(model, data);
    mj_makeM(model, data);
    mj_factorM(model, data);
    mj_comVel(model, data);
    mj_rne(model, data, 0, data->qfrc_bias);
    for (size_t i = 0; i < nv; ++i) right[i] = data->qfrc_applied[i] - data->qfrc_bias[i];
    mj_solveM(model, data, result.data(), right.data(), 1);
    used(result);
  }

  void inverse_by_stages(int k) {
    move(k);
    std::copy_n(&a[size_t(k) * nv], nv, data->qacc);
    mj_kinematics(model, data);
    mj_comPos(model, data);
    mj_comVel(model, data);
    mj_rne(model, data, 1, result.data());
    tree.add_springs(positions(k), velocities(k), result.data(), -1.0, result.data());
    used(result);
  }

  void matrix(int k) {
    place(k);
    mj_kinematics(model, data);
    mj_comPos(model, data);
    mj_makeM(model, data);
    used(data->M);
  }

  void poses(int k) {
    place(k);
    mj_kinematics(model, data);
    used(data->xpos);
  }

  double acceleration_error(int k, const double* got) {
    std::copy_n(got, nv, right.data());
    turn(k, right.data(), false);
    classical(k, right.data(), -1.0);
    return tree.error(right.data(), tree.expected_forward(k), true);
  }

  double torque_error(int k, const double* want) {
    turn(k, result.data(), false);
    return tree.error(result.data(), want, false);
  }

  double momentum_error(int k) {
    // The product is with the spatial acceleration, as M is all there is to check.
    std::copy_n(tree.a(k), nv, right.data());
    turn(k, right.data(), true);
    mj_mulM(model, data, result.data(), right.data());
    return torque_error(k, tree.expected_momentum(k));
  }

  double pose_error(int k) const {
    double worst = 0;
    for (size_t b = 0; b < tree.bodies.size(); ++b) {
      const double* want = tree.expected_poses(k) + 12 * b;
      worst = std::max(worst, largest_difference(data->xmat + 9 * (b + 1), want, 9));
      worst = std::max(worst, largest_difference(data->xpos + 3 * (b + 1), want + 9, 3));
    }
    return worst;
  }
};

int main(int argc, char** argv) {
  Worker worker(argc, argv);
  std::vector<std::unique_ptr<Robot>> robots;  // the rows point into it
  for (const auto& name : worker.robots) {
    robots.push_back(std::make_unique<Robot>(Tree(worker.folder, name), worker.folder));
    Robot* r = robots.back().get();
    worker.add(name + "/aba:mj_forward", TOLERANCE, [=](int k) {
      r->forward(k);
      return r->acceleration_error(k, r->data->qacc);
    }, [=](int k) { r->forward(k); });
    worker.add(name + "/aba:stages", TOLERANCE, [=](int k) {
      r->forward_by_stages(k);
      return r->acceleration_error(k, r->result.data());
    }, [=](int k) { r->forward_by_stages(k); });
    worker.add(name + "/rnea:stages", TOLERANCE, [=](int k) {
      r->inverse_by_stages(k);
      return r->torque_error(k, r->tree.expected_inverse(k));
    }, [=](int k) { r->inverse_by_stages(k); });
    worker.add(name + "/crba:stages", TOLERANCE, [=](int k) {
      r->matrix(k);
      return r->momentum_error(k);
    }, [=](int k) { r->matrix(k); });
    worker.add(name + "/fk", TOLERANCE, [=](int k) {
      r->poses(k);
      return r->pose_error(k);
    }, [=](int k) { r->poses(k); });
  }
  return worker.serve();
}
