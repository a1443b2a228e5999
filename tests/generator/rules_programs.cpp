// SPDX-License-Identifier: Apache-2.0
// Programs, their roles and nesting, and the script that calls their methods.
#include <algorithm>

#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

using Made = std::optional<Node>;

std::string own_name(const Scope& s) { return "p" + std::to_string(s.number); }

const Node* program_of(const Maker& m, std::size_t number) {
  const auto kept = m.kept.find("program" + std::to_string(number));
  return kept == m.kept.end() ? nullptr : &kept->second;
}

std::vector<std::string> texts(const Node* list) {
  std::vector<std::string> all;
  if (list != nullptr)
    for (const Node& each : list->items) all.push_back(each.text);
  return all;
}

/// The hosts of a program: those that may publish or be called.
std::vector<std::string> members_of(const Node& program) {
  std::vector<std::string> names = texts(program.find("slaves"));
  if (const Node* const roles = program.find("roles"))
    for (const Node& each : roles->items) names.push_back(each.find("name")->text);
  if (const Node* const master = program.find("master")) names.push_back(master->text);
  return names;
}

Made programs(Maker& m, const Scope& s) {
  if (m.groups.empty()) return std::nullopt;
  Node made = Node::array();
  for (std::size_t i = 0; i < m.groups.size(); ++i) {
    made.items.push_back(m.object("program", &s, {}, i));
    m.kept["program" + std::to_string(i)] = made.items.back();
  }
  return made;
}

bool is(const Maker& m, const Scope& program, Maker::Group group) { return m.groups[program.number] == group; }

/// Hosts that offer a skill, by what has been made of the network.
std::vector<std::string> offering(const Maker& m, std::string_view skill) {
  std::vector<std::string> hosts;
  const Node* const nodes = m.root().find("network")->find("nodes");
  for (const json::Member& each : nodes->members)
    for (const std::string& offered : texts(each.value.find("offers")))
      if (offered == skill) hosts.push_back(each.key);
  return hosts;
}
std::vector<std::string> offered_skills(const Maker& m) {
  std::vector<std::string> some;
  for (const std::string& skill : m.skills)
    if (!offering(m, skill).empty()) some.push_back(skill);
  return some;
}
bool has_roles(const Maker& m, const Scope& s) {
  return (is(m, s, Maker::Group::roles) || (is(m, s, Maker::Group::inner) && m.inner_has_roles)) &&
         !offered_skills(m).empty();
}
/// Those that may have a role of the program.
std::vector<std::string> candidates_of(const Maker& m, const Node& program) {
  std::vector<std::string> hosts;
  for (const Node& role : program.find("roles")->items)
    for (const std::string& host : offering(m, role.find("skill")->text))
      if (std::ranges::find(hosts, host) == hosts.end() &&
          (program.find("master") == nullptr || host != program.find("master")->text))
        hosts.push_back(host);
  return hosts;
}

Made master(Maker& m, const Scope& s) {
  // The master of an inner program is a slave of the outer one.
  if (is(m, s, Maker::Group::inner))
    if (const std::vector<std::string> slaves = texts(program_of(m, 0)->find("slaves")); !slaves.empty())
      return text(m.draw.any(slaves));
  return text(m.draw.any(m.world.hosts));
}

Made slaves(Maker& m, const Scope& s) {
  std::vector<std::string> others = m.world.hosts;
  m.draw.shuffle(others);
  if (is(m, s, Maker::Group::inner)) {
    // Who is in the outer program may be the master only.
    const std::vector<std::string> outer = members_of(*program_of(m, 0));
    std::erase_if(others, [&](const std::string& each) { return std::ranges::find(outer, each) != outer.end(); });
    if (others.empty()) return std::nullopt;
    others.push_back(outer.back());
  }
  // Who is nested needs a host that is not in the outer program.
  const std::size_t most =
      std::min<std::size_t>(3, others.size() - (is(m, s, Maker::Group::outer) && others.size() > 3 ? 2
                                                : others.size() > 1                                ? 1
                                                                                                   : 0));
  others.resize(m.draw.between(1, most));
  Node made = Node::array();
  for (const std::string& each : others) made.items.push_back(text(each));
  return made;
}

/// Windows are laid out for programs that publish at known times.
bool is_scheduled(const Maker& m, const Scope& s) { return m.wants(Feature::automatic_gates) && !s.has("roles"); }

Made phases(Maker& m, const Scope& s) {
  if (s.has("roles")) return std::nullopt;
  Node made = Node::object();
  const std::vector<std::string> all = members_of(*s.made);
  if (is_scheduled(m, s)) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (made.find(all[i]) == nullptr) made.add(all[i], text(std::to_string(100 * s.number + 200 * i) + "us"));
    return made;
  }
  if (!m.draw.one_in(4)) return std::nullopt;
  const std::string cycle = s.text("cycle");
  for (const std::string& each : m.draw.some(all, m.draw.between(1, all.size())))
    if (made.find(each) == nullptr) made.add(each, m.word(cycle == "100us" ? "0us 30us 75us" : "0us 30us 125us 199us"));
  return made;
}

/// A way between the master and another member.
Made paths(Maker& m, const Scope& s) {
  if (s.has("roles") || s.has("redundancy")) return std::nullopt;
  const std::vector<std::string> all = members_of(*s.made);
  const std::vector<std::string> nodes = m.world.path(m.draw, all.back(), all.front());
  if (all.size() < 2 || all.front() == all.back() || nodes.size() < 2) return std::nullopt;
  Node way = Node::array();
  for (const std::string& each : nodes) way.items.push_back(text(each));
  return list({std::move(way)});
}

/// The master, on which calls are made that say nobody else, and some others.
Made callers(Maker& m, const Scope& s) {
  const Scope& program = *s.around("program");
  Node made = Node::array();
  const std::vector<std::string> all = members_of(*program.made);
  const std::string master = program.text("master");
  made.items.push_back(text(master));
  for (const std::string& each : m.draw.some(all, m.draw.below(all.size())))
    if (std::ranges::none_of(made.items, [&](const Node& item) { return item.text == each; }))
      made.items.push_back(text(each));
  return made;
}
/// The robust handshake starts at the master.
Made starters(Maker& m, const Scope& s) {
  if (s.around("program")->text("variant") == "paper") return callers(m, s);
  Node made = Node::array();
  made.items.push_back(text(s.around("program")->text("master")));
  return made;
}

Made process_data(Maker& m, const Scope& s) {
  return m.objects("process_data", m.wants(Feature::replies) ? 2 : m.draw.between(1, 3), s);
}

Made publisher(Maker& m, const Scope& s) {
  const Scope* const program = s.around("program");
  // Replies: the master's data is answered by a slave.
  if (m.wants(Feature::replies) && s.number == 0) return text(program->text("master"));
  std::vector<std::string> all = members_of(*program->made);
  if (m.wants(Feature::replies) && s.number == 1 && all.size() > 1) all.pop_back();
  return text(m.draw.any(all));
}

Made fields(Maker& m, const Scope& s) {
  Node made = Node::object();
  for (std::size_t i = m.draw.between(1, 3); i > 0; --i) {
    const std::string name = "f" + std::to_string(i);
    made.add(name, m.short_or_object("data_field", &s, name));
  }
  return made;
}

/// The script: each program is started, then called by chance; nodes join and leave; gates are set.
Made script(Maker& m, const Scope& s) {
  std::vector<Node> entries;
  for (std::size_t p = 0; p < m.groups.size(); ++p)
    for (std::size_t i = m.draw.between(1, 4); i > 0; --i) entries.push_back(m.object("script_entry", &s, "call", p));
  if (m.wants(Feature::roles))
    for (std::size_t i = m.draw.between(0, 2); i > 0; --i) entries.push_back(m.object("script_entry", &s, "plug", 0));
  if (m.wants(Feature::set_gates))
    for (std::size_t i = m.draw.between(1, 3); i > 0; --i) entries.push_back(m.object("script_entry", &s, "gates", 0));
  if (entries.empty()) return std::nullopt;
  // Calls come in the order of time.
  std::vector<std::uint64_t> instants;
  for (std::size_t i = 0; i < entries.size(); ++i) instants.push_back(m.draw.below(m.duration_us));
  std::ranges::sort(instants);
  bool is_first = true;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    *entries[i].find("at") = text(std::to_string(instants[i]) + "us");
    if (Node* const called_method = entries[i].find("call"); called_method != nullptr && is_first) {
      *called_method = text("Start");
      is_first = false;
      if (Node* const on = entries[i].find("on")) *on = text(program_of(m, 0)->find("master")->text);
      if (i == 0) *entries[i].find("at") = text(std::to_string(m.duration_us / 20) + "us");
    }
  }
  return list(std::move(entries));
}

Made call(Maker& m, const Scope& s) {
  if (s.name != "call") return std::nullopt;
  return m.word(is(m, s, Maker::Group::inner) ? "Suspend Resume Halt Reset" : "Start Start Suspend Resume Halt Reset");
}
/// Start is called at the master only.
Made called(Maker& m, const Scope& s) {
  if (s.name != "call") return std::nullopt;
  const Node& program = *program_of(m, s.number);
  const Node* const callers = program.find("callers");
  if (const Node* const named = callers == nullptr ? nullptr : callers->find(s.text("call")))
    return text(m.draw.any(named->items).text);
  return text(s.text("call") == "Start" && program.find("variant")->text != "paper" ? program.find("master")->text
                                                                                    : m.draw.any(members_of(program)));
}
Made plug(Maker& m, const Scope& s) {
  if (s.name != "plug") return std::nullopt;
  for (std::size_t p = 0; p < m.groups.size(); ++p)
    if (program_of(m, p)->find("roles") != nullptr)
      if (const std::vector<std::string> some = candidates_of(m, *program_of(m, p)); !some.empty())
        return text(m.draw.any(some));
  return std::nullopt;
}

}  // namespace

std::span<const Rule> program_rules() {
  static const Rule rules[] = {
      {.key = "scenario.programs", .percent = 100, .make = programs},
      {.key = "scenario.script", .percent = 100, .make = script},
      {.key = "program.name", .make = [](Maker&, const Scope& s) -> Made { return text(own_name(s)); }},
      {.key = "program.variant",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         return text(m.wants(Feature::paper_variant) && is(m, s, Maker::Group::plain) ? "paper" : "robust");
       }},
      {.key = "program.master",
       .make = [](Maker& m, const Scope& s) -> Made {
         Made made = master(m, s);
         const std::vector<std::string> taken = texts(s.made->find("slaves"));
         for (std::size_t tries = 0; tries < 20 && std::ranges::find(taken, made->text) != taken.end(); ++tries)
           made = tries < 10 ? master(m, s) : text(m.draw.any(m.world.hosts));
         return made;
       }},
      {.key = "program.slaves",
       .percent = 60,
       .make = [](Maker& m, const Scope& s) -> Made { return has_roles(m, s) ? std::nullopt : slaves(m, s); }},
      {.key = "program.roles",
       .feature = Feature::roles,
       .percent = 60,
       .make = [](Maker& m, const Scope& s) -> Made {
         return has_roles(m, s) ? Made(m.objects("role", m.draw.between(1, 2), s)) : std::nullopt;
       }},
      {.key = "program.candidates",
       .feature = Feature::roles,
       .percent = 25,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!s.has("roles")) return std::nullopt;
         Node made = Node::array();
         for (const std::string& each : candidates_of(m, *s.made)) made.items.push_back(text(each));
         return made;
       }},
      {.key = "program.absent",
       .feature = Feature::roles,
       .percent = 40,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!s.has("roles")) return std::nullopt;
         const std::vector<std::string> some = candidates_of(m, *s.made);
         return some.empty() ? std::nullopt : Made(list({text(m.draw.any(some))}));
       }},
      {.key = "program.announce_every",
       .feature = Feature::roles,
       .percent = 70,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("roles") ? Made(m.word("2ms 5ms")) : std::nullopt;
       }},
      {.key = "program.on_replacement",
       .feature = Feature::roles,
       .percent = 60,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("roles") ? Made(m.word(is(m, s, Maker::Group::inner) ? "stay-halted" : "stay-halted restart"))
                               : std::nullopt;
       }},
      {.key = "program.within",
       .feature = Feature::nesting,
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         return is(m, s, Maker::Group::inner) ? Made(text("p0")) : std::nullopt;
       }},
      {.key = "program.cycle",
       .make = [](Maker& m, const Scope&) -> Made {
         return m.word(m.wants(Feature::automatic_gates) ? "1ms 2ms"
                       : m.is_slow() || m.is_long()      ? "1ms 2ms"
                                                         : "200us 250us 500us 1ms");
       }},
      {.key = "program.offset", .percent = 25, .words = "0us 20us 150us auto"},
      {.key = "program.phases", .percent = 100, .make = phases},
      {.key = "program.publish",
       .percent = 40,
       .make = [](Maker& m, const Scope& s) -> Made {
         return text(is_scheduled(m, s) || m.draw.one_in(2) ? "cyclic" : "on-change");
       }},
      {.key = "program.callers", .percent = 20},
      {.key = "callers.Start", .percent = 40, .make = starters},
      {.key = "callers.Suspend", .percent = 40, .make = callers},
      {.key = "callers.Resume", .percent = 40, .make = callers},
      {.key = "callers.Halt", .percent = 40, .make = callers},
      {.key = "callers.Reset", .percent = 40, .make = callers},
      {.key = "program.security", .feature = Feature::security, .percent = 70},
      {.key = "program_security.mode", .percent = 60},
      {.key = "program_security.policy", .percent = 60},
      {.key = "program.subscription",
       .percent = 30,
       .make = [](Maker& m, const Scope& s) -> Made { return s.has("roles") ? Made() : m.word("star all-to-all"); }},
      {.key = "program.receive_timeout", .percent = 25, .words = "3ms 5ms 20ms"},
      {.key = "program.initialisation", .percent = 70, .words = "0us 100us 500us 1ms"},
      {.key = "program.pcp",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (m.wants(Feature::automatic_gates)) return s.has("roles") ? m.word("5") : Made();
         return m.draw.one_in(3) ? m.word("0 3 5 6 7") : Made();
       }},
      {.key = "program.vlan", .percent = 15, .words = "0 10"},
      {.key = "program.redundancy", .feature = Feature::redundancy, .percent = 60, .words = "2"},
      {.key = "program.paths", .feature = Feature::explicit_path, .percent = 50, .make = paths},
      {.key = "program.violations", .percent = 20},
      {.key = "program.publisher_id",
       .percent = 20,
       .make = [](Maker&, const Scope& s) -> Made { return number(1000 + 100 * s.number); }},
      {.key = "program.process_data",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         return m.wants(Feature::replies) || m.draw.one_in(2) ? process_data(m, s) : std::nullopt;
       }},
      {.key = "program.replies",
       .feature = Feature::replies,
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("process_data") && !s.has("roles") ? Made(m.objects("reply", 1, s)) : std::nullopt;
       }},
      {.key = "role.name", .make = [](Maker&, const Scope& s) -> Made { return text("r" + std::to_string(s.number)); }},
      {.key = "role.skill", .make = [](Maker& m, const Scope&) -> Made { return text(m.draw.any(offered_skills(m))); }},
      {.key = "process_data.name",
       .make = [](Maker&, const Scope& s) -> Made { return text("d" + std::to_string(s.number)); }},
      {.key = "process_data.from", .make = publisher},
      {.key = "process_data.fields", .make = fields},
      {.key = "data_field.type"},
      {.key = "data_field.count", .percent = 30, .words = "1 2 3"},
      {.key = "reply.to", .words = "d0"},
      {.key = "reply.with", .words = "d1"},
      {.key = "script_entry.at", .words = "0us"},
      {.key = "script_entry.program",
       .percent = 100,
       .make = [](Maker&, const Scope& s) -> Made {
         return s.name == "call" ? Made(text("p" + std::to_string(s.number))) : std::nullopt;
       }},
      {.key = "script_entry.call", .percent = 100, .make = call},
      {.key = "script_entry.on", .percent = 30, .make = [](Maker& m, const Scope& s) -> Made { return called(m, s); }},
      {.key = "script_entry.join", .percent = 100, .make = [](Maker& m, const Scope& s) -> Made { return plug(m, s); }},
      {.key = "script_entry.leave",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made { return plug(m, s); }},
      {.key = "script_entry.set_gates",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.name == "gates" ? Made(m.object("set_gates", &s)) : std::nullopt;
       }},
  };
  return rules;
}

}  // namespace takt::generator
