// A robot as `stages/models.py` writes it: a tree of bodies, springs between coordinates, states and expected values.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

constexpr int STATES = 256;

[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  std::exit(1);
}

struct Body {
  int parent;              // -1 is the world
  std::string joint;       // RX, RY, RZ, axis or floating
  double axis[3], rotation[9], position[3];
  double mass, centre[3], inertia[6];  // xx xy yy xz yz zz at the centre of mass
};

// K (q_r / N - q_l) + D (v_r / N - v_l) on the link l, and -1/N of it on the rotor r
struct Spring {
  int rotor_q, rotor_v, link_q, link_v;
  double gear, stiffness, damping;
};

inline std::vector<double> read_numbers(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) fail(path + " is missing: run the stage `models`");
  std::vector<double> numbers(size_t(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(numbers.data()), std::streamsize(numbers.size() * sizeof(double)));
  return numbers;
}

struct Tree {
  std::string name;
  int nq = 0, nv = 0;
  double gravity = 0;
  std::vector<Body> bodies;
  std::vector<Spring> springs;
  std::vector<double> gears;  // per velocity coordinate: N of a rotor, else 1
  std::vector<double> states, expected, derivatives;

  Tree(const std::string& folder, const std::string& name) : name(name) {
    const std::string stem = folder + "/" + name;
    std::ifstream file(stem + ".tree");
    size_t nb = 0, ns = 0;
    if (!(file >> nb >> nq >> nv >> ns >> gravity)) fail(stem + ".tree is missing: run the stage `models`");
    bodies.resize(nb);
    for (auto& b : bodies) {
      file >> b.parent >> b.joint;
      for (double* part : {b.axis, b.rotation, b.rotation + 3, b.rotation + 6, b.position})
        for (int i = 0; i < 3; ++i) file >> part[i];
      file >> b.mass;
      for (double* part : {b.centre, b.inertia, b.inertia + 3})
        for (int i = 0; i < 3; ++i) file >> part[i];
    }
    springs.resize(ns);
    for (auto& s : springs)
      file >> s.rotor_q >> s.rotor_v >> s.link_q >> s.link_v >> s.gear >> s.stiffness >> s.damping;
    if (!file) fail(stem + ".tree ends too early: run the stage `models` again");
    gears.assign(size_t(nv), 1.0);
    for (const auto& s : springs) gears[size_t(s.rotor_v)] = s.gear;
    states = read_numbers(stem + ".states");
    expected = read_numbers(stem + ".expected");
    derivatives = read_numbers(stem + ".derivatives");
  }

  bool floating() const { return bodies.front().joint == "floating"; }
  const double* q(int k) const { return &states[size_t(k) * size_t(nq + 3 * nv)]; }
  const double* v(int k) const { return q(k) + nq; }
  const double* a(int k) const { return v(k) + nv; }
  const double* u(int k) const { return a(k) + nv; }
  const double* row(int k) const { return &expected[size_t(k) * (size_t(3 * nv) + 12 * bodies.size())]; }
  const double* expected_forward(int k) const { return row(k); }
  const double* expected_inverse(int k) const { return row(k) + nv; }
  const double* expected_momentum(int k) const { return row(k) + 2 * nv; }  // M(q) a
  // of accelerations by q and v along a, and by torques along u; of torques by q and v along a
  const double* expected_derivative(int k, int which) const { return &derivatives[size_t((5 * k + which) * nv)]; }
  const double* expected_poses(int k) const { return row(k) + 3 * nv; }

  // out = torques + sign * what the springs exert
  void add_springs(const double* q, const double* v, const double* torques, double sign, double* out) const {
    if (out != torques) std::copy(torques, torques + nv, out);
    for (const auto& s : springs) {
      const double f = sign * (s.stiffness * (q[s.rotor_q] / s.gear - q[s.link_q]) +
                               s.damping * (v[s.rotor_v] / s.gear - v[s.link_v]));
      out[s.link_v] += f;
      out[s.rotor_v] -= f / s.gear;
    }
  }

  // Largest difference over the largest entry, with rotors seen through their gears, so that neither their great
  // accelerations nor their small torques hide an error of a link.
  double error(const double* got, const double* want, bool acceleration) const {
    double worst = 0, largest = 0;
    for (size_t i = 0; i < size_t(nv); ++i) {
      const double scale = acceleration ? 1.0 / gears[i] : gears[i];
      worst = std::max(worst, std::fabs(got[i] - want[i]) * scale);
      largest = std::max(largest, std::fabs(want[i]) * scale);
    }
    return std::isfinite(worst) ? worst / largest : HUGE_VAL;
  }
};

inline double largest_difference(const double* a, const double* b, size_t n) {
  double worst = 0;
  for (size_t i = 0; i < n; ++i) worst = std::max(worst, std::fabs(a[i] - b[i]));
  return worst;
}
