// Pinocchio, header-only: every algorithm is compiled with this program's own flags.
#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <memory>
#include "model.hpp"
#include "worker.hpp"
#include "standing.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Vector = Map<const VectorXd>;

constexpr double TOLERANCE = 1e-9;

// One robot with its data; Pinocchio wants its own vectors, so the states are copied once.
struct Robot {
  Tree tree;
  pin::Model model;
  pin::Data data;
  std::vector<VectorXd> q, v, a, u;
  VectorXd torques, column;

  explicit Robot(const Tree& t) : tree(t), model(model_of(t)), data(model), torques(t.nv), column(t.nv) {
    for (int k = 0; k < STATES; ++k) {
      q.emplace_back(Vector(t.q(k), t.nq));
      v.emplace_back(Vector(t.v(k), t.nv));
      a.emplace_back(Vector(t.a(k), t.nv));
      u.emplace_back(Vector(t.u(k), t.nv));
    }
  }

  void forward(int k, pin::Convention convention) {
    const auto i = size_t(k);
    if (tree.springs.empty()) {
      pin::aba(model, data, q[i], v[i], u[i], convention);
    } else {
      tree.add_springs(q[i].data(), v[i].data(), u[i].data(), 1.0, torques.data());
      pin::aba(model, data, q[i], v[i], torques, convention);
    }
    used(data.ddq);
  }

  void inverse(int k) {
    const auto i = size_t(k);
    pin::rnea(model, data, q[i], v[i], a[i]);
    tree.add_springs(q[i].data(), v[i].data(), data.tau.data(), -1.0, torques.data());
    used(torques);
  }

  void matrix(int k, pin::Convention convention) {
    pin::crba(model, data, q[size_t(k)], convention);
    used(data.M);
  }

  // Accelerations too, as a by-product. What the springs add is two columns of the inverse inertia matrix each.
  void forward_derivatives(int k) {
    const auto i = size_t(k);
    if (tree.springs.empty()) {
      pin::computeABADerivatives(model, data, q[i], v[i], u[i]);
    } else {
      tree.add_springs(q[i].data(), v[i].data(), u[i].data(), 1.0, torques.data());
      pin::computeABADerivatives(model, data, q[i], v[i], torques);
      for (const Spring& s : tree.springs) {
        column = data.Minv.col(s.link_v) - data.Minv.col(s.rotor_v) / s.gear;
        data.ddq_dq.col(s.link_v) -= s.stiffness * column;
        data.ddq_dv.col(s.link_v) -= s.damping * column;
        data.ddq_dq.col(s.rotor_v) += s.stiffness / s.gear * column;
        data.ddq_dv.col(s.rotor_v) += s.damping / s.gear * column;
      }
    }
    used(data.ddq_dq);
  }

  // The springs add constants, which are nobody's work.
  void inverse_derivatives(int k) {
    pin::computeRNEADerivatives(model, data, q[size_t(k)], v[size_t(k)], a[size_t(k)]);
    used(data.dtau_dq);
  }

  double product_error(int k, int which, const MatrixXd& matrix, const VectorXd& direction) const {
    const VectorXd product = matrix * direction;
    return tree.error(product.data(), tree.expected_derivative(k, which), which < 3);
  }

  double forward_derivative_error(int k) const {
    const auto i = size_t(k);
    return std::max({product_error(k, 0, data.ddq_dq, a[i]), product_error(k, 1, data.ddq_dv, a[i]),
                     product_error(k, 2, data.Minv, u[i]),
                     tree.error(data.ddq.data(), tree.expected_forward(k), true)});
  }

  double inverse_derivative_error(int k) const {
    const auto i = size_t(k);
    return std::max({product_error(k, 3, data.dtau_dq, a[i]), product_error(k, 4, data.dtau_dv, a[i]),
                     momentum_error(k)});
  }

  double momentum_error(int k) const {
    const VectorXd product = data.M.selfadjointView<Eigen::Upper>() * a[size_t(k)];
    return tree.error(product.data(), tree.expected_momentum(k), false);
  }

  double pose_error(int k) const {
    double worst = 0;
    for (size_t b = 0; b < tree.bodies.size(); ++b) {
      const double* want = tree.expected_poses(k) + 12 * b;
      const Matrix3d by_rows = data.oMi[b + 1].rotation().transpose();
      worst = std::max(worst, largest_difference(by_rows.data(), want, 9));
      worst = std::max(worst, largest_difference(data.oMi[b + 1].translation().data(), want + 9, 3));
    }
    return worst;
  }
};

int main(int argc, char** argv) {
  Worker worker(argc, argv);
  for (const auto& name : worker.robots) {
    auto robot = std::make_shared<Robot>(Tree(worker.folder, name));
    Robot* r = robot.get();
    for (auto [label, convention] : {std::pair{"local", pin::Convention::LOCAL}, {"world", pin::Convention::WORLD}}) {
      const auto c = convention;
      const std::string variant = std::string(":") + label;
      worker.add(name + "/aba" + variant, TOLERANCE, [=](int k) {
        r->forward(k, c);
        return r->tree.error(r->data.ddq.data(), r->tree.expected_forward(k), true);
      }, [=](int k) { r->forward(k, c); });
      worker.add(name + "/crba" + variant, TOLERANCE, [=](int k) {
        r->matrix(k, c);
        return r->momentum_error(k);
      }, [=](int k) { r->matrix(k, c); });
    }
    worker.add(name + "/rnea", TOLERANCE, [=](int k) {
      r->inverse(k);
      return r->tree.error(r->torques.data(), r->tree.expected_inverse(k), false);
    }, [=](int k) { r->inverse(k); });
    worker.add(name + "/aba_derivatives", TOLERANCE, [=](int k) {
      r->forward_derivatives(k);
      return r->forward_derivative_error(k);
    }, [=](int k) { r->forward_derivatives(k); });
    worker.add(name + "/rnea_derivatives", TOLERANCE, [=](int k) {
      r->inverse_derivatives(k);
      return r->inverse_derivative_error(k);
    }, [=](int k) { r->inverse_derivatives(k); });
    worker.add(name + "/fk", TOLERANCE, [=](int k) {
      pin::forwardKinematics(r->model, r->data, r->q[size_t(k)]);
      return r->pose_error(k);
    }, [=](int k) {
      pin::forwardKinematics(r->model, r->data, r->q[size_t(k)]);
      used(r->data.oMi);
    });
    if (Standing::has_feet(worker.folder, name)) {
      auto standing = std::make_shared<Standing>(worker.folder, r->tree, r->model, r->q, r->u);
      worker.add(name + "/constrained:constraintDynamics", TOLERANCE, [=](int k) {
        standing->by_dense(k);
        return standing->error(standing->dense, k);
      }, [=](int k) { standing->by_dense(k); });
      worker.add(name + "/constrained:pv", TOLERANCE, [=](int k) {
        standing->by_pv(k);
        return standing->error(standing->pv, k);
      }, [=](int k) { standing->by_pv(k); });
      // As near as its damping lets it come.
      worker.add(name + "/constrained:constrainedABA", 1e-5, [=](int k) {
        standing->by_aba(k);
        return standing->error(standing->aba, k);
      }, [=](int k) { standing->by_aba(k); });
    }
    static std::vector<std::shared_ptr<Robot>> alive;  // the rows point into it
    alive.push_back(robot);
  }
  return worker.serve();
}
