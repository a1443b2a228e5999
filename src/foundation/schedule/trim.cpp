// SPDX-License-Identifier: Apache-2.0
#include "schedule/trim.hpp"

#include <algorithm>
#include <charconv>
#include <unordered_map>

namespace takt::schedule {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

/// Takes clauses one after the other and finds for each from which it follows.
class Propagator {
 public:
  explicit Propagator(std::size_t variables)
      : value_(variables + 1),
        reason_(variables + 1, none),
        unit_(variables + 1, none),
        seen_(variables + 1),
        watched_(2 * variables + 2) {}

  bool is_refuted() const { return refuted_; }
  std::vector<Clause>& clauses() { return clauses_; }
  std::vector<std::vector<std::uint32_t>>& from() { return from_; }

  void add_axiom(const Clause& clause) {
    axioms_.emplace(clauses_.size(), axiom_count_++);
    add(clause, {});
  }
  /// Which of the axioms that clause is.
  std::uint32_t axiom(std::size_t clause) const { return axioms_.at(clause); }

  /// False: it does not follow by propagation.
  bool add_step(const Clause& clause) {
    for (const std::int32_t literal : clause)
      if (value(literal) > 0) return true;  // already said by a unit
    const std::size_t before = trail_.size();
    for (const std::int32_t literal : clause)
      if (value(literal) == 0) assign(-literal, none);
    const std::uint32_t conflict = propagate(before);
    std::vector<std::uint32_t> from;
    if (conflict != none) from = explain(conflict, before, clause);
    undo(before);
    if (conflict == none) return false;
    add(clause, std::move(from));
    return true;
  }

  void remove(const Clause& clause) {
    const auto range = by_hash_.equal_range(hash(clause));
    for (auto each = range.first; each != range.second; ++each) {
      if (!same(clauses_[each->second], clause)) continue;
      removed_[each->second] = 1;
      by_hash_.erase(each);
      return;
    }
  }

 private:
  int value(std::int32_t literal) const {
    return literal > 0 ? value_[static_cast<std::size_t>(literal)] : -value_[static_cast<std::size_t>(-literal)];
  }
  static std::size_t variable(std::int32_t literal) {
    return static_cast<std::size_t>(literal > 0 ? literal : -literal);
  }
  static std::size_t index(std::int32_t literal) { return 2 * variable(literal) + (literal < 0 ? 1 : 0); }

  static std::uint64_t hash(const Clause& clause) {
    std::uint64_t sum = 0;
    for (const std::int32_t literal : clause) {
      std::uint64_t x = static_cast<std::uint64_t>(static_cast<std::int64_t>(literal)) * 0x9E3779B97F4A7C15u;
      x ^= x >> 29;
      sum += x * 0xBF58476D1CE4E5B9u;
    }
    return sum;
  }

  static bool same(Clause a, Clause b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
  }

  void assign(std::int32_t literal, std::uint32_t reason) {
    value_[variable(literal)] = literal > 0 ? 1 : -1;
    reason_[variable(literal)] = reason;
    trail_.push_back(literal);
  }

  void undo(std::size_t to) {
    for (; trail_.size() > to; trail_.pop_back()) value_[variable(trail_.back())] = 0;
  }

  std::uint32_t keep(Clause clause, std::vector<std::uint32_t> from) {
    clauses_.push_back(std::move(clause));
    from_.push_back(std::move(from));
    removed_.push_back(0);
    return static_cast<std::uint32_t>(clauses_.size() - 1);
  }

  /// Precondition: nothing but units is assigned.
  void add(Clause clause, std::vector<std::uint32_t> from) {
    const bool is_axiom = from.empty();
    std::vector<std::uint32_t> units;  // that make its other literals false
    std::stable_partition(clause.begin(), clause.end(), [&](std::int32_t literal) { return value(literal) >= 0; });
    const std::uint32_t id = keep(clause, std::move(from));
    by_hash_.emplace(hash(clause), id);
    if (refuted_ && !is_axiom) return;
    const auto open = static_cast<std::size_t>(
        std::count_if(clause.begin(), clause.end(), [&](std::int32_t literal) { return value(literal) >= 0; }));
    if (open >= 2) {
      watched_[index(clause[0])].push_back(id);
      watched_[index(clause[1])].push_back(id);
      return;
    }
    if (open == 1 && value(clause[0]) > 0) return;
    fix(id, open == 1 ? clause[0] : 0);
  }

  /// The clause leaves that literal alone to hold, or none (0): a unit, with what it follows from, and all that follows
  /// from it.
  void fix(std::uint32_t id, std::int32_t literal) {
    if (refuted_) return;
    const std::size_t before = trail_.size();
    if (literal == 0) return derive(id, 0);
    derive(id, literal);
    const std::uint32_t conflict = propagate(before);
    // What was assigned on the way becomes a unit of its own.
    for (std::size_t i = before + 1; i < trail_.size(); ++i) derive_assigned(trail_[i]);
    if (conflict != none) derive(conflict, 0);
  }

  void derive(std::uint32_t id, std::int32_t literal) {
    std::vector<std::uint32_t> from;
    for (const std::int32_t other : clauses_[id])
      if (other != literal) from.push_back(unit_[variable(other)]);
    std::uint32_t unit = id;
    if (clauses_[id].size() > (literal == 0 ? 0u : 1u)) {
      from.push_back(id);
      unit = keep(literal == 0 ? Clause{} : Clause{literal}, std::move(from));
    }
    if (literal == 0) {
      refuted_ = true;
      return;
    }
    unit_[variable(literal)] = unit;
    assign(literal, unit);
  }

  void derive_assigned(std::int32_t literal) {
    const std::uint32_t id = reason_[variable(literal)];
    std::vector<std::uint32_t> from;
    for (const std::int32_t other : clauses_[id])
      if (other != literal) from.push_back(unit_[variable(other)]);
    from.push_back(id);
    unit_[variable(literal)] = keep(Clause{literal}, std::move(from));
    reason_[variable(literal)] = unit_[variable(literal)];
  }

  /// Returns a clause of which no literal holds.
  std::uint32_t propagate(std::size_t from) {
    for (std::size_t i = from; i < trail_.size(); ++i) {
      const std::int32_t falsified = -trail_[i];
      auto& list = watched_[index(falsified)];
      std::size_t kept = 0;
      for (std::size_t k = 0; k < list.size(); ++k) {
        const std::uint32_t id = list[k];
        if (removed_[id]) continue;
        Clause& clause = clauses_[id];
        if (clause[0] == falsified) std::swap(clause[0], clause[1]);
        if (value(clause[0]) > 0) {
          list[kept++] = id;
          continue;
        }
        std::size_t other = 2;
        while (other < clause.size() && value(clause[other]) < 0) ++other;
        if (other < clause.size()) {
          std::swap(clause[1], clause[other]);
          watched_[index(clause[1])].push_back(id);
          continue;
        }
        list[kept++] = id;
        if (value(clause[0]) == 0) {
          assign(clause[0], id);
          continue;
        }
        for (++k; k < list.size(); ++k) list[kept++] = list[k];
        list.resize(kept);
        return id;
      }
      list.resize(kept);
    }
    return none;
  }

  /// What led to the conflict, in the order in which it did. A unit that makes a literal of the step false is no part
  /// of that: if none of the literals holds it leaves nothing to hold.
  std::vector<std::uint32_t> explain(std::uint32_t conflict, std::size_t before, const Clause& step) {
    std::vector<std::uint32_t> units, later;
    marked_.clear();
    for (const std::int32_t literal : step) {
      if (unit_[variable(literal)] == none) continue;
      seen_[variable(literal)] = 1;
      marked_.push_back(variable(literal));
    }
    const auto mark = [&](std::uint32_t id, std::int32_t but) {
      for (const std::int32_t literal : clauses_[id]) {
        const std::size_t v = variable(literal);
        if (literal == but || seen_[v]) continue;
        seen_[v] = 1;
        marked_.push_back(v);
        if (unit_[v] != none) units.push_back(unit_[v]);
      }
    };
    mark(conflict, 0);
    for (std::size_t i = trail_.size(); i-- > before;) {
      const std::size_t v = variable(trail_[i]);
      if (!seen_[v] || reason_[v] == none) continue;
      mark(reason_[v], trail_[i]);
      later.push_back(reason_[v]);
    }
    for (const std::size_t v : marked_) seen_[v] = 0;
    std::reverse(later.begin(), later.end());
    units.insert(units.end(), later.begin(), later.end());
    units.push_back(conflict);
    return units;
  }

  std::vector<Clause> clauses_;
  std::vector<std::vector<std::uint32_t>> from_;
  std::vector<std::uint8_t> removed_;
  std::vector<std::int8_t> value_;
  std::vector<std::uint32_t> reason_;
  std::vector<std::uint32_t> unit_;  ///< by variable: the clause that says its value alone
  std::vector<std::uint8_t> seen_;
  std::vector<std::size_t> marked_;
  std::vector<std::int32_t> trail_;
  std::vector<std::vector<std::uint32_t>> watched_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> by_hash_;
  std::unordered_map<std::size_t, std::uint32_t> axioms_;
  std::uint32_t axiom_count_ = 0;
  bool refuted_ = false;
};

/// The next line of numbers up to a 0. False at the end, or where there are no numbers.
bool next_clause(std::string_view& text, bool& is_removal, Clause& clause) {
  clause.clear();
  is_removal = text.starts_with("d ");
  if (is_removal) text.remove_prefix(2);
  for (;;) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\n')) text.remove_prefix(1);
    std::int32_t literal = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), literal);
    if (error != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (literal == 0) break;
    clause.push_back(literal);
  }
  while (!text.empty() && text.front() == '\n') text.remove_prefix(1);
  return true;
}

/// What the last clause rests on, with new numbers; variables, too.
TrimmedProof gather(Propagator& propagator, const std::vector<Threshold>& thresholds) {
  auto& clauses = propagator.clauses();
  auto& from = propagator.from();
  std::vector<std::uint8_t> needed(clauses.size());
  needed.back() = 1;
  for (std::size_t i = clauses.size(); i-- > 0;)
    if (needed[i])
      for (const std::uint32_t each : from[i]) needed[each] = 1;
  TrimmedProof result;
  ClausalProof& proof = result.proof;
  std::vector<std::uint32_t> number(clauses.size());
  std::vector<std::int32_t> variable(thresholds.size() + 1);
  const auto renamed = [&](const Clause& clause) {
    Clause renamed_clause;
    for (const std::int32_t literal : clause) {
      std::int32_t& name = variable[static_cast<std::size_t>(literal > 0 ? literal : -literal)];
      if (name == 0) {
        proof.thresholds.push_back(thresholds[static_cast<std::size_t>(literal > 0 ? literal : -literal) - 1]);
        name = static_cast<std::int32_t>(proof.thresholds.size());
      }
      renamed_clause.push_back(literal > 0 ? name : -name);
    }
    return renamed_clause;
  };
  // Units that follow from axioms alone stand among the axioms: those come first.
  std::uint32_t count = 0;
  for (const bool is_axiom : {true, false})
    for (std::size_t i = 0; i < clauses.size(); ++i) {
      if (!needed[i] || from[i].empty() != is_axiom) continue;
      number[i] = count++;
      if (is_axiom) {
        proof.axioms.push_back(renamed(clauses[i]));
        result.axioms.push_back(propagator.axiom(i));
        continue;
      }
      ClausalProof::Step step{renamed(clauses[i]), {}};
      for (const std::uint32_t each : from[i]) step.from.push_back(number[each]);
      proof.steps.push_back(std::move(step));
    }
  return result;
}

}  // namespace

std::optional<TrimmedProof> trim(std::span<const Clause> axioms, const std::vector<Threshold>& thresholds,
                                 std::string_view proof) {
  Propagator propagator(thresholds.size());
  for (const Clause& clause : axioms) {
    propagator.add_axiom(clause);
    if (propagator.is_refuted()) return gather(propagator, thresholds);
  }
  bool is_removal = false;
  Clause clause;
  while (!propagator.is_refuted() && next_clause(proof, is_removal, clause)) {
    for (const std::int32_t literal : clause)
      if (static_cast<std::size_t>(literal > 0 ? literal : -literal) > thresholds.size()) return std::nullopt;
    if (is_removal)
      propagator.remove(clause);
    else if (!propagator.add_step(clause))
      return std::nullopt;
  }
  if (!propagator.is_refuted()) return std::nullopt;
  return gather(propagator, thresholds);
}

}  // namespace takt::schedule
