// Straight-line C by CasADi: Pinocchio's algorithms on its symbols, for the robots that are named.
// usage: casadi-generator MODELS FOLDER ROBOT...     writes ROBOT_aba.c and ROBOT_rnea.c
#include <pinocchio/autodiff/casadi.hpp>
#include <pinocchio/autodiff/casadi-algo.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include "model.hpp"

using casadi::SX;
using Symbols = Eigen::Matrix<SX, Eigen::Dynamic, 1>;

// A right angle that went through a file of decimal angles has a cosine of 6e-17, of which no product vanishes.
void round_rotations(Tree& tree) {
  for (Body& b : tree.bodies)
    for (double& x : b.rotation)
      if (const double whole = std::round(x); std::fabs(x - whole) < 1e-12) x = whole;
}

Symbols vector_of(const SX& column) {
  Symbols v(column.size1());
  for (casadi_int i = 0; i < column.size1(); ++i) v[i] = column(i);
  return v;
}

SX column_of(const Symbols& v) {
  SX column(v.size(), 1);
  for (Eigen::Index i = 0; i < v.size(); ++i) column(i) = v[i];
  return column;
}

// Like Tree::add_springs, on symbols.
Symbols with_springs(const Tree& tree, const Symbols& q, const Symbols& v, Symbols torques) {
  for (const Spring& s : tree.springs) {
    const SX f = s.stiffness * (q[s.rotor_q] / s.gear - q[s.link_q]) + s.damping * (v[s.rotor_v] / s.gear - v[s.link_v]);
    torques[s.link_v] += f;
    torques[s.rotor_v] -= f / s.gear;
  }
  return torques;
}

// The angle of a rotor that is the same all around matters to its spring alone: everywhere else it is zero, which leaves
// fewer operations.
Symbols rotors_at_zero(const Tree& tree, Symbols q) {
  for (const Spring& s : tree.springs) q[s.rotor_q] = SX(0);
  return q;
}

void write(const std::string& folder, const std::string& name, const std::vector<SX>& arguments, const SX& result) {
  const casadi::Function function(name, arguments, {result}, casadi::Dict{{"cse", true}});
  casadi::CodeGenerator file(name + ".c", casadi::Dict{{"casadi_int", "int"}});
  file.add(function);
  file.generate(folder + "/");
  std::printf("%s.c: %d instructions\n", name.c_str(), int(function.n_instructions()));
}

int main(int argc, char** argv) {
  if (argc < 4) fail("usage: MODELS FOLDER ROBOT...");
  const std::string folder = argv[2];
  for (int i = 3; i < argc; ++i) {
    Tree tree(argv[1], argv[i]);
    round_rotations(tree);
    const auto model = model_of(tree).cast<SX>();
    pin::DataTpl<SX> data(model);
    // Of the call's third argument: accelerations for inverse dynamics, torques for forward dynamics.
    const SX position = SX::sym("q", tree.nq), velocity = SX::sym("v", tree.nv), third = SX::sym("x", tree.nv);
    const Symbols q = vector_of(position), v = vector_of(velocity), x = vector_of(third);
    const Symbols frames = rotors_at_zero(tree, q);
    pin::aba(model, data, frames, v, with_springs(tree, q, v, x), pin::Convention::LOCAL);
    write(folder, tree.name + "_aba", {position, velocity, third}, column_of(data.ddq));
    // What moves links and rotors; how much of it the springs exert is no question of gyroflex's inverse dynamics either.
    pin::rnea(model, data, frames, v, x);
    write(folder, tree.name + "_rnea", {position, velocity, third}, column_of(data.tau));
  }
}
