// SPDX-License-Identifier: Apache-2.0
#include "interchange/linux/script.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <iterator>

#include "interchange/linux/words.hpp"
#include "json/suggest.hpp"

namespace takt::interchange::linux_tc {
namespace {

std::string without_colon(std::string handle) {
  if (handle.ends_with(':')) handle.pop_back();
  return handle;
}

/// A list of numbers that ends where the next keyword begins.
void read_numbers(Words& words, std::vector<At<std::int64_t>>& into, const std::string& what) {
  while (!words.at_end() && into.size() < 16) {
    const auto value = Words::number(words.peek().text);
    if (!value) break;
    into.push_back({*value, words.take().place});
  }
  if (into.empty()) {
    const Word word = words.at_end() ? words.parse_value(what) : words.take();
    if (!word.text.empty()) words.refuse(word, "not a number", what);
  }
}

void read_queues(Words& words, Classes& classes) {
  while (!words.at_end() && classes.queues.size() < 16) {
    const std::string& text = words.peek().text;
    const std::size_t at = text.find('@');
    const auto count = Words::number(std::string_view(text).substr(0, at));
    const auto offset = at == std::string::npos ? std::nullopt : Words::number(std::string_view(text).substr(at + 1));
    if (!count || !offset || *count < 0 || *count > 65535 || *offset < 0 || *offset > 65535) break;
    classes.queues.push_back(
        {{static_cast<std::uint32_t>(*count), static_cast<std::uint32_t>(*offset)}, words.take().place});
  }
  if (classes.queues.empty()) {
    const Word word = words.at_end() ? words.parse_value("queues as COUNT@OFFSET") : words.take();
    if (!word.text.empty()) words.refuse(word, "not a range of queues", "COUNT@OFFSET");
  }
}

void read_preemption(Words& words, Classes& classes) {
  while (words.is_next("P") || words.is_next("E")) {
    const Word& word = words.take();
    classes.preemptable.push_back({word.text == "P", word.place});
  }
  if (classes.preemptable.empty() && !words.at_end())
    words.refuse(words.take(), "not a preemption status", "P or E for each class");
}

void read_gate_line(Words& words, Classes& classes) {
  GateLine line;
  const Word operation = words.parse_value("S, H or R");
  line.place = operation.place;
  if (operation.text.size() == 1 && std::string_view("SHR").find(operation.text[0]) != std::string_view::npos)
    line.operation = operation.text[0];
  else if (!operation.text.empty())
    words.refuse(operation, "not an operation of a gate list", "S (set), H (set and hold) or R (set and release)");
  const At<std::int64_t> mask =
      words.parse_number("a mask of classes, hexadecimal with or without 0x", 0, 0xFFFF'FFFF, 16);
  line.mask = static_cast<std::uint64_t>(mask.value);
  line.interval = words.parse_number("an interval in ns", 0, 0xFFFF'FFFF, 0).value;
  classes.entries.push_back(line);
}

void read_classes(Words& words, Classes& classes) {
  struct Key {
    std::string_view name;
    std::function<void()> read;
    bool of_taprio = true;
    bool of_mqprio = true;
  };
  const std::vector<Key> keys = {
      {"num_tc", [&] { classes.num_tc = words.parse_number("a number of classes from 1 to 16", 1, 16); }},
      {"map", [&] { read_numbers(words, classes.map, "the class of each priority"); }},
      {"queues", [&] { read_queues(words, classes); }},
      {"fp", [&] { read_preemption(words, classes); }},
      {"max-sdu", [&] { read_numbers(words, classes.max_sdu, "octets for each class"); }, true, false},
      {"base-time", [&] { classes.base_time = words.parse_number("ns since 1970", -most_ns, most_ns, 10); }, true,
       false},
      {"cycle-time", [&] { classes.cycle_time = words.parse_number("a cycle in ns of at least 1", 1, most_ns, 0); },
       true, false},
      {"cycle-time-extension", [&] { classes.extension = words.parse_number("ns", 0, most_ns, 0); }, true, false},
      {"sched-entry", [&] { read_gate_line(words, classes); }, true, false},
      {"flags",
       [&] {
         const At<std::int64_t> flags = words.parse_number("flags, 0x1 or 0x2", 0, 0xFFFF'FFFF, 0);
         classes.flags = {static_cast<std::uint64_t>(flags.value), flags.place};
       },
       true, false},
      {"txtime-delay", [&] { classes.txtime_delay = words.parse_number("ns", 0, 0xFFFF'FFFF, 0); }, true, false},
      {"clockid",
       [&] {
         const Word word = words.parse_value("the name of a clock");
         classes.clock = At<std::string>{word.text, word.place};
       },
       true, false},
      {"hw", [&] { words.parse_number("0 to 2", 0, 2); }, false, true},
      {"mode",
       [&] {
         if (const Word word = words.parse_value("dcb or channel"); word.text != "dcb" && word.text != "channel")
           words.refuse(word, "not a mode", "dcb or channel");
       },
       false, true},
      {"shaper",
       [&] {
         if (const Word word = words.parse_value("dcb"); word.text != "dcb")
           words.refuse(word, "a shaper of classes that takt does not have", "dcb");
       },
       false, true},
  };
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    const bool is_taprio = classes.kind == ClassKind::taprio;
    const auto key = std::ranges::find_if(
        keys, [&](const Key& each) { return each.name == word.text && (is_taprio ? each.of_taprio : each.of_mqprio); });
    if (key != keys.end()) {
      key->read();
      continue;
    }
    std::vector<std::string_view> names;
    for (const Key& each : keys)
      if (is_taprio ? each.of_taprio : each.of_mqprio) names.push_back(each.name);
    words.refuse(word, is_taprio ? "not a key of taprio" : "not a key of mqprio", "num_tc, map, queues and the like",
                 json::suggest(word.text, names));
  }
}

void read_cbs(Words& words, CreditShaper& shaper) {
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "idleslope")
      shaper.idleslope = words.parse_number("kbit/s", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "sendslope")
      shaper.sendslope = words.parse_number("kbit/s, negative", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "hicredit")
      shaper.hicredit = words.parse_number("octets", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "locredit")
      shaper.locredit = words.parse_number("octets, negative", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "offload")
      words.parse_number("0 or 1", 0, 1);
    else
      words.refuse(word, "not a key of cbs", "idleslope, sendslope, hicredit, locredit or offload");
  }
}

void read_etf(Words& words, LaunchTimes& launch) {
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "clockid") {
      const Word clock = words.parse_value("the name of a clock");
      launch.clock = At<std::string>{clock.text, clock.place};
    } else if (word.text == "delta")
      launch.delta = words.parse_number("ns", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "deadline_mode")
      launch.deadline_mode = true;
    else if (word.text != "offload" && word.text != "skip_sock_check")
      words.refuse(word, "not a key of etf", "clockid, delta, offload, deadline_mode or skip_sock_check");
  }
}

constexpr std::array other_qdiscs = {"pfifo",  "bfifo",   "pfifo_fast", "pfifo_head_drop",
                                     "mq",     "noqueue", "fq",         "fq_codel",
                                     "fq_pie", "codel",   "sfq",        "prio",
                                     "multiq", "htb",     "hfsc",       "ets",
                                     "tbf",    "netem",   "red",        "cake",
                                     "drr",    "qfq",     "skbprio",    "plug",
                                     "choke"};

/// A size table says which octets the kernel counts of a frame; takt counts those on the wire.
void skip_size_table(Words& words, const Word& start, Machine& machine) {
  while (!words.at_end() && (words.is_next("overhead") || words.is_next("linklayer") || words.is_next("mtu") ||
                             words.is_next("tsize") || words.is_next("mpu"))) {
    words.take();
    words.parse_value("a value");
  }
  machine.remarks.push_back(
      {RemarkKind::ignored, start.place, "a size table (stab): takt counts what a frame takes on the wire"});
}

/// What a machine is set to by one qdisc of a parent is replaced by the next.
template <class T>
void set_below(std::vector<T>& all, T value) {
  std::erase_if(all, [&](const T& each) { return each.parent == value.parent; });
  all.push_back(std::move(value));
}

void delete_qdisc(const std::string& parent, bool at_root, bool at_ingress, Interface& interface) {
  if (at_root) {
    interface.classes.reset();
    interface.shapers.clear();
    interface.launches.clear();
  } else if (at_ingress) {
    interface.has_clsact = false;
    interface.filters.clear();
  } else {
    std::erase_if(interface.shapers, [&](const CreditShaper& each) { return each.parent == parent; });
    std::erase_if(interface.launches, [&](const LaunchTimes& each) { return each.parent == parent; });
  }
}

void read_qdisc(Words& words, const Word& start, Machine& machine) {
  if (words.at_end() || words.is_next("show") || words.is_next("list") || words.is_next("ls")) return;
  const bool deletes = words.is_next("del") || words.is_next("delete");
  if (!deletes && !words.is_next("add") && !words.is_next("replace") && !words.is_next("change")) {
    words.refuse(words.take(), "not what a set of commands does to a qdisc", "add, replace, change or del");
    return;
  }
  words.take();
  std::string device, parent, handle;
  json::Place device_place = start.place;
  bool at_root = false, at_ingress = false;
  while (!words.at_end()) {
    const Word& word = words.take();
    if (word.text == "dev") {
      const Word name = words.parse_value("an interface");
      device = name.text;
      device_place = name.place;
    } else if (word.text == "root")
      at_root = true;
    else if (word.text == "parent") {
      parent = words.parse_value("root or HANDLE:CLASS").text;
      at_root = at_root || parent == "root";
    } else if (word.text == "handle")
      handle = without_colon(words.parse_value("a handle").text);
    else if (word.text == "stab")
      skip_size_table(words, word, machine);
    else if (word.text == "clsact" || word.text == "ingress") {
      at_ingress = true;
      if (deletes) continue;
      machine.interface(device, device_place).has_clsact = true;
      return;
    } else if (deletes) {
      continue;  // of which kind it is that goes
    } else if (word.text == "taprio" || word.text == "mqprio") {
      Classes classes;
      classes.kind = word.text == "taprio" ? ClassKind::taprio : ClassKind::mqprio;
      classes.place = word.place;
      classes.at_root = at_root;
      classes.handle = handle;
      read_classes(words, classes);
      Interface& interface = machine.interface(device, device_place);
      // One at the same place replaces the first, as `replace` does.
      if (!words.failed()) {
        if (!at_root)
          words.diagnostics().error(word.place, word.text + " that is not at the root",
                                    {"parent " + json::quote(parent), "root or \"parent root\""});
        else
          interface.classes = std::move(classes);
      }
      return;
    } else if (word.text == "cbs") {
      CreditShaper shaper{word.place, parent, {}, {}, {}, {}};
      read_cbs(words, shaper);
      if (!words.failed()) set_below(machine.interface(device, device_place).shapers, shaper);
      return;
    } else if (word.text == "etf") {
      LaunchTimes launch{word.place, parent, {}, {}, false};
      read_etf(words, launch);
      if (!words.failed()) set_below(machine.interface(device, device_place).launches, launch);
      return;
    } else if (std::ranges::find(other_qdiscs, word.text) != other_qdiscs.end()) {
      machine.interface(device, device_place);
      const bool only_stores = word.text == "pfifo" || word.text == "bfifo" || word.text == "pfifo_fast" ||
                               word.text == "mq" || word.text == "noqueue";
      machine.remarks.push_back({only_stores ? RemarkKind::ignored : RemarkKind::lost, word.place,
                                 "the qdisc " + word.text +
                                     (only_stores ? ", which stores frames as takt's queues do; its limit is not read"
                                                  : ", which takt has no model for")});
      return;
    } else {
      words.refuse(word, "a qdisc or key that is not understood",
                   "dev, root, parent, handle; taprio, mqprio, cbs, etf or clsact");
      return;
    }
    if (words.failed()) return;
  }
  if (deletes) return delete_qdisc(parent, at_root, at_ingress, machine.interface(device, device_place));
  words.refuse(start, "a command without a qdisc", "taprio, mqprio, cbs, etf or clsact");
}

void read_set_mm(Words& words, Machine& machine) {
  const Word device = words.parse_value("an interface");
  MacMerge merge;
  merge.place = device.place;
  const auto read_switch = [&]() -> At<bool> {
    const Word word = words.parse_value("on or off");
    if (!word.text.empty() && word.text != "on" && word.text != "off") words.refuse(word, "not a switch", "on or off");
    return {word.text == "on", word.place};
  };
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "pmac-enabled")
      merge.pmac = read_switch();
    else if (word.text == "tx-enabled")
      merge.tx = read_switch();
    else if (word.text == "verify-enabled")
      merge.verify = read_switch();
    else if (word.text == "verify-time")
      merge.verify_time = words.parse_number("ms", 0, 0x7FFF'FFFF);
    else if (word.text == "tx-min-frag-size")
      merge.fragment = words.parse_number("octets", 0, 0x7FFF'FFFF);
    else
      words.refuse(word, "not a key of --set-mm",
                   "pmac-enabled, tx-enabled, verify-enabled, verify-time or tx-min-frag-size");
  }
  if (!words.failed()) machine.interface(device.text, device.place).merge = merge;
}

/// ethtool -s IF speed 100: the rate of the port. The rest sets nothing that takt has.
void read_ethtool(Words& words, const Word& start, Machine& machine) {
  if (words.read_if("--set-mm")) return read_set_mm(words, machine);
  if (words.read_if("-s") || words.read_if("--change")) {
    const Word device = words.parse_value("an interface");
    while (!words.at_end() && !words.failed())
      if (words.take().text == "speed")
        machine.interface(device.text, device.place).rate =
            static_cast<std::uint64_t>(words.parse_number("Mbit/s", 1, 800'000).value) * 1'000'000;
    return;
  }
  if (words.read_if("--set-frame-preemption")) {
    machine.remarks.push_back({RemarkKind::lost, start.place,
                               "ethtool --set-frame-preemption, which no released ethtool has: write --set-mm"});
    return;
  }
  machine.remarks.push_back(
      {RemarkKind::ignored, start.place,
       "ethtool" + (words.at_end() ? "" : " " + words.peek().text) + ": offloads, counters and rings have no model"});
}

void read_vlan(Words& words, const Word& start, Machine& machine) {
  const bool adds = words.is_next("add");
  std::string device;
  json::Place place = start.place;
  bool untagged = false, is_of_bridge = false;
  if (words.is_next("show")) return;
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "dev") {
      const Word name = words.parse_value("an interface");
      device = name.text;
      place = name.place;
    } else if (word.text == "vid")
      words.parse_value("a VLAN from 1 to 4094, or a range");
    else if (word.text == "untagged")
      untagged = true;
    else if (word.text == "self")
      is_of_bridge = true;
    else if (word.text != "add" && word.text != "del" && word.text != "pvid" && word.text != "master")
      words.refuse(word, "not a key of bridge vlan", "add, del, dev, vid, pvid or untagged");
  }
  if (words.failed() || !adds || is_of_bridge) return;
  Interface& interface = machine.interface(device, place);
  interface.untagged = interface.untagged || untagged;
}

void read_bridge(Words& words, const Word& start, Machine& machine) {
  machine.has_bridge = true;
  if (words.is_next("fdb") || words.is_next("mdb")) return;  // addresses follow from paths in takt
  if (words.read_if("vlan")) return read_vlan(words, start, machine);
  if (words.is_next("link") || words.is_next("monitor") || words.is_next("vni")) {
    machine.remarks.push_back(
        {RemarkKind::ignored, start.place,
         "bridge " + words.peek().text + ": spanning trees, learning and flooding follow from paths in takt"});
    return;
  }
  words.refuse(words.at_end() ? start : words.take(), "not what takt knows of a bridge", "vlan, fdb, mdb or link");
}

void read_ip(const Command& command, Machine& machine) {
  const auto has = [&](std::string_view text) {
    return std::ranges::any_of(command, [&](const Word& word) { return word.text == text; });
  };
  const bool is_of_link = command.size() > 1 && std::string_view("link").starts_with(command[1].text);
  if (is_of_link && !has("show") && (has("bridge") || has("master"))) machine.has_bridge = true;
  if (is_of_link || command.size() < 2) return;
  machine.remarks.push_back({RemarkKind::ignored, command[0].place,
                             "ip " + command[1].text + ": addresses, routes and namespaces follow from the scenario"});
}

/// Commands that set nothing of a network, which every script has.
constexpr std::array common_commands = {"set",    "echo",     "printf",   "sleep",  "cd",    "which", "type",  "return",
                                        "unset",  "trap",     "wait",     "cat",    "grep",  "id",    "dmesg", "date",
                                        "break",  "continue", "modprobe", "read",   "}",     "mount", "mkdir", "rm",
                                        "logger", "tput",     "clear",    "ulimit", "umask", "hash",  "pwd",   "ls",
                                        "head",   "tail",     "awk",      "sed",    "xargs", "sort",  "uname"};

/// A value that only a run can say: a base time is folded into the cycle anyhow. False if the command cannot be read
/// without it.
bool settle_unknown(Command& command, Machine& machine, json::Diagnostics& diagnostics) {
  bool is_read = true;
  for (std::size_t i = 0; i < command.size(); ++i) {
    if (command[i].unknown.empty()) continue;
    if (i > 0 && command[i - 1].text == "base-time") {
      machine.remarks.push_back(
          {RemarkKind::lost, command[i].place,
           "the base time " + command[i].unknown + ", which only a run of the script can say: 0 is taken"});
      command[i] = {"0", command[i].place, {}};
      continue;
    }
    is_read = false;
    diagnostics.error(command[i].place, "what only a run of the script can say",
                      {json::quote(command[i].unknown), "a value that the script has, such as NAME=value before it"});
  }
  return is_read;
}

void read_command(Command command, Machine& machine, json::Diagnostics& diagnostics) {
  const std::string name = command[0].text;
  if (name == "qdisc" || name == "filter" || name == "class" || name == "actions")
    command.insert(command.begin(), Word{"tc", command[0].place, {}});  // a line of a batch
  if (name == "fdb" || name == "mdb" || name == "vlan")
    command.insert(command.begin(), Word{"bridge", command[0].place, {}});
  if (name == "link" && command.size() > 2) command.insert(command.begin(), Word{"ip", command[0].place, {}});
  const std::string program = command[0].text;
  const bool is_of_network = program == "tc" || program == "ethtool" || program == "bridge";
  if (is_of_network && !settle_unknown(command, machine, diagnostics)) return;
  while ((is_of_network && program != "ethtool") && command.size() > 1 && command[1].text.starts_with('-')) {
    const bool has_value = command[1].text == "-n" || command[1].text == "-netns";
    command.erase(command.begin() + 1, command.begin() + (has_value && command.size() > 2 ? 3 : 2));
  }
  Words words(command, diagnostics);
  const Word start = words.take();
  if (program == "tc") {
    if (words.read_if("qdisc")) return read_qdisc(words, start, machine);
    if (words.read_if("filter")) return read_filter(words, start, machine);
    if (words.at_end() || words.is_next("class") || words.is_next("actions") || words.is_next("action") ||
        words.is_next("chain") || words.is_next("monitor") || words.is_next("exec")) {
      machine.remarks.push_back({RemarkKind::lost, start.place,
                                 "tc" + (words.at_end() ? "" : " " + words.peek().text) +
                                     ": classes and actions by themselves have no model"});
      return;
    }
    words.refuse(words.take(), "not what takt knows of tc", "qdisc or filter");
  } else if (program == "ethtool") {
    read_ethtool(words, start, machine);
  } else if (program == "bridge") {
    read_bridge(words, start, machine);
  } else if (program == "ip") {
    read_ip(command, machine);
  } else if (std::ranges::find(common_commands, program) == common_commands.end()) {
    machine.remarks.push_back({RemarkKind::ignored, start.place,
                               "the command " + json::quote(program) + ": only tc, ethtool, bridge and ip are read"});
  }
}

/// A line that goes on the command before it, from which a backslash is missing, as those of taprio are long.
bool goes_on(const Command& line) {
  constexpr std::array keys = {"flags",       "base-time", "cycle-time",   "cycle-time-extension",
                               "sched-entry", "clockid",   "txtime-delay", "num_tc",
                               "map",         "queues",    "fp",           "max-sdu",
                               "idleslope",   "sendslope", "hicredit",     "locredit",
                               "offload"};
  return std::ranges::find(keys, line[0].text) != keys.end();
}

}  // namespace

void read_script(std::string_view text, const std::string& file, Machine& machine, json::Diagnostics& diagnostics) {
  std::vector<Command> commands;
  for (Command& command : commands_of(text, file, machine.remarks, diagnostics)) {
    if (!commands.empty() && goes_on(command)) {
      machine.remarks.push_back(
          {RemarkKind::odd, command[0].place,
           "a line without a command, taken as the end of the one before it: the backslash is missing there"});
      std::ranges::move(command, std::back_inserter(commands.back()));
    } else {
      commands.push_back(std::move(command));
    }
  }
  for (Command& command : commands) read_command(std::move(command), machine, diagnostics);
}

}  // namespace takt::interchange::linux_tc
