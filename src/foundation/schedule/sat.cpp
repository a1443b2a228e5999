// SPDX-License-Identifier: Apache-2.0
#include "schedule/sat.hpp"

#ifdef TAKT_WITH_CADICAL
#include <cadical.hpp>
#include <cstdio>
#include <cstdlib>
#endif

namespace takt::schedule {

#ifdef TAKT_WITH_CADICAL

namespace {

class Terminator : public CaDiCaL::Terminator {
 public:
  explicit Terminator(const std::function<bool()>& stop) : stop_(stop) {}
  bool terminate() override { return stop_(); }

 private:
  const std::function<bool()>& stop_;
};

/// A file in memory: what is written there is a text.
class TextFile {
 public:
  TextFile() : file_(open_memstream(&data_, &size_)) {}
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  ~TextFile() {
    if (file_ != nullptr) std::fclose(file_);
    std::free(data_);
  }
  std::FILE* file() const { return file_; }
  std::string text() {
    std::fflush(file_);
    return {data_, size_};
  }

 private:
  char* data_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* file_;
};

}  // namespace

bool has_sat_solver() { return true; }

SatAnswer solve(std::span<const Clause> clauses, std::uint32_t variables, std::uint32_t conflicts,
                const std::function<bool()>& stop) {
  SatAnswer answer;
  TextFile proof;
  if (proof.file() == nullptr) return answer;
  Terminator terminator(stop);
  CaDiCaL::Solver solver;
  solver.set("binary", 0);
  solver.set("quiet", 1);
  if (!solver.trace_proof(proof.file(), "proof")) return answer;
  solver.connect_terminator(&terminator);
  solver.reserve(static_cast<int>(variables));
  for (const Clause& clause : clauses) {
    for (const std::int32_t literal : clause) solver.add(literal);
    solver.add(0);
  }
  solver.limit("conflicts", static_cast<int>(conflicts));
  const int result = solver.solve();
  solver.disconnect_terminator();
  if (result == 10) answer.verdict = SatAnswer::Verdict::satisfiable;
  if (result == 20) {
    answer.verdict = SatAnswer::Verdict::unsatisfiable;
    solver.flush_proof_trace();
    answer.proof = proof.text();
  }
  solver.close_proof_trace();
  return answer;
}

#else

bool has_sat_solver() { return false; }

SatAnswer solve(std::span<const Clause>, std::uint32_t, std::uint32_t, const std::function<bool()>&) { return {}; }

#endif

}  // namespace takt::schedule
