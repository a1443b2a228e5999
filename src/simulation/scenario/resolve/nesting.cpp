// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/nesting.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "plant/program_check.hpp"
#include "scenario/resolve/known_names.hpp"

namespace takt::scenario {
namespace {

class Nester {
 public:
  Nester(Resolved& resolved, json::Diagnostics& diagnostics) : r_(resolved), diagnostics_(diagnostics) {
    for (const Program& program : r_.scenario.programs) programs_.emplace(program.name, &program);
    for (std::uint32_t i = 0; i < r_.programs.size(); ++i) numbers_.emplace(r_.programs[i].name, i);
  }

  void run() {
    plant::check_nesting(r_.scenario.programs, !may_be_unread_program(r_.scenario, diagnostics_), diagnostics_);
    for (ResolvedProgram& program : r_.programs)
      if (program.description->within) note(program);
    for (const Requirement& requirement : r_.scenario.require) check(requirement);
  }

 private:
  const Program* find(const std::string& name) const {
    const auto found = programs_.find(name);
    return found == programs_.end() ? nullptr : found->second;
  }

  void note(ResolvedProgram& program) {
    const auto outer = numbers_.find(*program.description->within);
    if (outer == numbers_.end()) return;
    const auto& slaves = r_.programs[outer->second].description->slaves;
    const auto slave = std::find(slaves.begin(), slaves.end(), program.description->master);
    if (slave == slaves.end()) return;
    program.outer = ResolvedProgram::Outer{outer->second, static_cast<std::uint8_t>(slave - slaves.begin() + 1)};
    program.nested.insert(0);
    r_.programs[outer->second].nested.insert(program.outer->participant);
  }

  void check(const Requirement& requirement) {
    if (!requirement.tree || !requirement.reaction) return;
    if (roots_.empty())
      for (const Program& program : r_.scenario.programs)
        if (program.within) roots_.insert(root_of(program).name);
    const bool has_tree = requirement.program ? roots_.contains(*requirement.program) : !roots_.empty();
    const bool is_unclear =
        (requirement.program && diagnostics_.is_refused(requirement.where.at("program"))) ||
        (requirement.program && find(*requirement.program) == nullptr) ||
        may_be_unread_program(r_.scenario, diagnostics_) ||
        std::any_of(r_.scenario.programs.begin(), r_.scenario.programs.end(),
                    [&](const Program& program) { return diagnostics_.is_refused(program.where.at("within")); });
    if (!has_tree)
      diagnostics_.error_unless(
          is_unclear, requirement.where.at("tree"), "a tree without nested programs",
          {requirement.program ? "nothing is nested in " + json::quote(*requirement.program) + " or it is nested itself"
                               : "no nested programs",
           "the outermost program of a tree"});
  }

  const Program& root_of(const Program& program) const {
    const Program* root = &program;
    for (std::size_t steps = 0; root->within && steps <= r_.scenario.programs.size(); ++steps) {
      const Program* const outer = find(*root->within);
      if (outer == nullptr) break;
      root = outer;
    }
    return *root;
  }

  Resolved& r_;
  json::Diagnostics& diagnostics_;
  std::map<std::string_view, const Program*> programs_;
  std::map<std::string_view, std::uint32_t> numbers_;
  std::set<std::string_view> roots_;  // programs in which others are nested, but that are not themselves
};

}  // namespace

void resolve_nesting(Resolved& resolved, json::Diagnostics& diagnostics) { Nester(resolved, diagnostics).run(); }

std::vector<std::vector<std::uint32_t>> trees_of(const Resolved& resolved) {
  std::vector<std::vector<std::uint32_t>> trees;
  const auto& programs = resolved.programs;
  std::vector<std::vector<std::uint32_t>> inner(programs.size());
  for (std::uint32_t i = 0; i < programs.size(); ++i)
    if (programs[i].outer) inner[programs[i].outer->program].push_back(i);
  for (std::uint32_t root = 0; root < programs.size(); ++root) {
    if (programs[root].outer) continue;
    std::vector<std::uint32_t> tree{root};
    for (std::size_t at = 0; at < tree.size(); ++at)
      tree.insert(tree.end(), inner[tree[at]].begin(), inner[tree[at]].end());
    if (tree.size() > 1) trees.push_back(std::move(tree));
  }
  return trees;
}

}  // namespace takt::scenario
