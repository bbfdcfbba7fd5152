// The program's side of the conversation with `run`: says which rows it has and how far they are from the expected values,
// then times one short batch for every row it is asked for.
#pragma once
#include <chrono>
#include <cstring>
#include <functional>
#include <iostream>
#include "tree.hpp"

// The compiler must believe that somebody reads the result.
template <class T>
inline void used(const T& result) {
  asm volatile("" : : "g"(&result) : "memory");
}

class Worker {
  struct Row {
    std::string name;
    std::function<void(int)> calls;
  };
  std::vector<Row> rows;
  std::string counted;
  int count = 0;

 public:
  std::string folder;
  std::vector<std::string> robots;

  // arguments: FOLDER ROBOT... [--count ROW CALLS]
  Worker(int argc, char** argv) {
    if (argc < 3) fail("usage: FOLDER ROBOT... [--count ROW CALLS]");
    folder = argv[1];
    for (int i = 2; i < argc; ++i) {
      if (std::strcmp(argv[i], "--count") == 0 && i + 2 < argc) {
        counted = argv[i + 1];
        count = std::atoi(argv[i + 2]);
        break;
      }
      robots.emplace_back(argv[i]);
    }
  }

  // A tool that counts instructions wants the calls and nothing else.
  bool checks() const { return counted.empty(); }

  // `error(k)` makes the call at state k and compares; `call(k)` is what is timed.
  template <class Error, class Call>
  void add(const std::string& row, double tolerance, Error error, Call call) {
    if (checks()) {
      double worst = 0;
      for (int k = 0; k < STATES; ++k) worst = std::max(worst, error(k));
      if (!(worst <= tolerance)) fail(row + " is " + std::to_string(worst) + " off the expected values");
      std::cout << "row " << row << " " << worst << "\n";
    }
    rows.push_back({row, [call](int calls) mutable { for (int k = 0; k < calls; ++k) call(k % STATES); }});
  }

  int serve() {
    if (!checks()) {
      for (auto& r : rows) if (r.name == counted) r.calls(count);
      return 0;
    }
    std::cout << "ready" << std::endl;
    for (std::string line; std::getline(std::cin, line);)
      for (auto& r : rows) if (r.name == line) batch(r);
    return 0;
  }

 private:
  // One pass over the states to warm up, then passes for three milliseconds: the fastest and the middle one.
  static void batch(Row& r) {
    using Clock = std::chrono::steady_clock;
    r.calls(STATES);
    std::vector<double> ns;
    for (const auto start = Clock::now(); ns.size() < 3 || Clock::now() - start < std::chrono::milliseconds(3);) {
      const auto before = Clock::now();
      r.calls(STATES);
      ns.push_back(std::chrono::duration<double, std::nano>(Clock::now() - before).count() / STATES);
    }
    std::sort(ns.begin(), ns.end());
    std::cout << ns.front() << " " << ns[ns.size() / 2] << std::endl;
  }
};
