// Straight-line C for the arms: what CasADi wrote (`casadi.cpp`), and what `gyroflex codegen` wrote.
#include <array>
#include <memory>
#include "worker.hpp"

constexpr double TOLERANCE = 1e-10;

extern "C" {
// CasADi's functions take their arguments and results by pointers to them, and need no work space if all lies in variables.
using Casadi = int(const double** arguments, double** results, int* integers, double* numbers, int memory);
Casadi panda_aba, panda_rnea, panda_flex_aba, panda_flex_rnea, ur5_aba, ur5_rnea, ur5_flex_aba, ur5_flex_rnea;
using Sizes = int(int* arguments, int* results, int* integers, int* numbers);
Sizes panda_aba_work, panda_rnea_work, panda_flex_aba_work, panda_flex_rnea_work, ur5_aba_work, ur5_rnea_work,
    ur5_flex_aba_work, ur5_flex_rnea_work;

#include "panda.h"
#include "panda_flex.h"
#include "ur5.h"
#include "ur5_flex.h"
}

// A state in gyroflex's coordinates: motors reflected.
struct State {
  std::vector<double> q, qd, theta, thetad, tau, qdd, thetadd;

  State(const Tree& tree, int k) {
    const auto take = [](std::vector<double>& to, const double* from, int index, double divisor) {
      to.push_back(from[index] / divisor);
    };
    if (tree.springs.empty()) {
      q.assign(tree.q(k), tree.q(k) + tree.nq);
      qd.assign(tree.v(k), tree.v(k) + tree.nv);
      tau.assign(tree.u(k), tree.u(k) + tree.nv);
      qdd.assign(tree.a(k), tree.a(k) + tree.nv);
    }
    for (const Spring& s : tree.springs) {
      take(q, tree.q(k), s.link_q, 1.0);
      take(qd, tree.v(k), s.link_v, 1.0);
      take(qdd, tree.a(k), s.link_v, 1.0);
      take(theta, tree.q(k), s.rotor_q, s.gear);
      take(thetad, tree.v(k), s.rotor_v, s.gear);
      take(thetadd, tree.a(k), s.rotor_v, s.gear);
      take(tau, tree.u(k), s.rotor_v, 1.0 / s.gear);
    }
  }
};

// Three vectors of results; what is in them depends on the function.
using Results = std::array<std::vector<double>, 3>;
using Generated = void (*)(const State&, Results&);

// The functions for one arm. Those of gyroflex get one signature, since a robot without rotors has no motor coordinates.
struct Arm {
  const char* name;
  Casadi *aba, *rnea;
  Sizes *aba_work, *rnea_work;
  Generated forward, inverse;
};

#define OF_CASADI(robot) robot##_aba, robot##_rnea, robot##_aba_work, robot##_rnea_work
#define IN(x) s.x.data()
#define OUT(i) r[i].data()
#define RIGID(robot)                                                                                                     \
  Arm {                                                                                                                  \
    #robot, OF_CASADI(robot),                                                                                            \
        [](const State& s, Results& r) { robot##_forward_dynamics(IN(q), IN(qd), IN(tau), OUT(0), OUT(2)); },            \
        [](const State& s, Results& r) { robot##_inverse_dynamics(IN(q), IN(qd), IN(qdd), OUT(0), OUT(1)); }             \
  }
#define ELASTIC(robot)                                                                                                   \
  Arm {                                                                                                                  \
    #robot, OF_CASADI(robot),                                                                                            \
        [](const State& s, Results& r) {                                                                                 \
          robot##_forward_dynamics(IN(q), IN(qd), IN(theta), IN(thetad), IN(tau), OUT(0), OUT(1), OUT(2));               \
        },                                                                                                               \
        [](const State& s, Results& r) {                                                                                 \
          robot##_inverse_dynamics(IN(q), IN(qd), IN(theta), IN(thetad), IN(qdd), IN(thetadd), OUT(0), OUT(1));          \
        }                                                                                                                \
  }
const Arm ARMS[] = {RIGID(panda), ELASTIC(panda_flex), RIGID(ur5), ELASTIC(ur5_flex)};

struct Robot {
  Tree tree;
  const Arm& arm;
  std::vector<State> states;
  Results results;
  std::vector<double> out;

  Robot(const Tree& t, const Arm& a) : tree(t), arm(a), out(size_t(t.nv)) {
    for (int k = 0; k < STATES; ++k) states.emplace_back(tree, k);
    for (auto& x : results) x.resize(states[0].q.size());
    for (Sizes* of : {arm.aba_work, arm.rnea_work}) {
      int arguments, outputs, integers, numbers;
      of(&arguments, &outputs, &integers, &numbers);
      if (arguments != 3 || outputs != 1 || integers != 0 || numbers != 0)
        fail(tree.name + ": CasADi's code wants work space, which this program does not give");
    }
  }

  void casadi(Casadi* function, int k, const double* third) {
    const double* arguments[] = {tree.q(k), tree.v(k), third};
    double* result[] = {out.data()};
    function(arguments, result, nullptr, nullptr, 0);
    used(out);
  }

  void gyroflex(Generated function, int k) {
    function(states[size_t(k)], results);
    used(results);
  }

  // Back to the tree's coordinates: accelerations of links and motors.
  double forward_error(int k) {
    const auto& [qdd, thetadd, tau_j] = results;
    if (tree.springs.empty()) out = qdd;
    for (size_t i = 0; i < tree.springs.size(); ++i) {
      const Spring& s = tree.springs[i];
      out[size_t(s.link_v)] = qdd[i];
      out[size_t(s.rotor_v)] = thetadd[i] * s.gear;
    }
    return tree.error(out.data(), tree.expected_forward(k), true);
  }

  // A motor's torque less what its transmission passes on is what its rotor needs; the springs are in both.
  double inverse_error(int k) {
    const auto& [tau_j, tau, none] = results;
    if (tree.springs.empty()) out = tau_j;
    for (size_t i = 0; i < tree.springs.size(); ++i) {
      const Spring& s = tree.springs[i];
      out[size_t(s.link_v)] = tau_j[i];
      out[size_t(s.rotor_v)] = (tau[i] - tau_j[i]) / s.gear;
    }
    tree.add_springs(tree.q(k), tree.v(k), out.data(), -1.0, out.data());
    return tree.error(out.data(), tree.expected_inverse(k), false);
  }
};

int main(int argc, char** argv) {
  Worker worker(argc, argv);
  for (const Arm& arm : ARMS) {
    if (std::find(worker.robots.begin(), worker.robots.end(), arm.name) == worker.robots.end()) continue;
    const std::string name = arm.name;
    auto r = std::make_shared<Robot>(Tree(worker.folder, name), arm);
    worker.add(name + "/aba:casadi", TOLERANCE, [=, &arm](int k) {
      r->casadi(arm.aba, k, r->tree.u(k));
      return r->tree.error(r->out.data(), r->tree.expected_forward(k), true);
    }, [=, &arm](int k) { r->casadi(arm.aba, k, r->tree.u(k)); });
    worker.add(name + "/rnea:casadi", TOLERANCE, [=, &arm](int k) {
      r->casadi(arm.rnea, k, r->tree.a(k));
      r->tree.add_springs(r->tree.q(k), r->tree.v(k), r->out.data(), -1.0, r->out.data());
      return r->tree.error(r->out.data(), r->tree.expected_inverse(k), false);
    }, [=, &arm](int k) { r->casadi(arm.rnea, k, r->tree.a(k)); });
    worker.add(name + "/aba:gyroflex-c", TOLERANCE, [=, &arm](int k) {
      r->gyroflex(arm.forward, k);
      return r->forward_error(k);
    }, [=, &arm](int k) { r->gyroflex(arm.forward, k); });
    worker.add(name + "/rnea:gyroflex-c", TOLERANCE, [=, &arm](int k) {
      r->gyroflex(arm.inverse, k);
      return r->inverse_error(k);
    }, [=, &arm](int k) { r->gyroflex(arm.inverse, k); });
  }
  return worker.serve();
}
