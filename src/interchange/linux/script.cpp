#include "interchange/linux/script.hpp"

#include <algorithm>
#include <charconv>
#include <functional>

#include "json/suggest.hpp"

namespace takt::interchange::linux_tc {
namespace {

/// The words of one command, taken one after the other.
class Words {
 public:
  Words(const Command& command, json::Diagnostics& diagnostics) : command_(command), diagnostics_(diagnostics) {}

  bool at_end() const { return next_ == command_.size(); }
  const Word& peek() const { return command_[next_]; }
  bool is_next(std::string_view text) const { return !at_end() && peek().text == text; }
  bool take_if(std::string_view text) {
    if (!is_next(text)) return false;
    ++next_;
    return true;
  }
  const Word& take() { return command_[next_++]; }
  /// The next word; empty, and reported, if there is none.
  Word take_value(const std::string& expected) {
    if (!at_end()) return take();
    const Word& last = command_.back();
    json::Place place = last.place;
    place.column += static_cast<std::uint32_t>(last.text.size());
    diagnostics_.error(place, "the command ends", {"nothing behind " + json::quote(last.text), expected});
    failed_ = true;
    return {"", place};
  }
  void refuse(const Word& word, const std::string& message, const std::string& expected, std::string suggestion = {}) {
    diagnostics_.error(word.place, message, {json::quote(word.text), expected, std::move(suggestion)});
    failed_ = true;
  }
  At<std::int64_t> take_number(const std::string& expected, std::int64_t least, std::int64_t most, int base = 10) {
    const Word word = take_value(expected);
    const auto value = number(word.text, base);
    if (!word.text.empty() && (!value || *value < least || *value > most)) refuse(word, "not a number that fits", expected);
    return {value && *value >= least && *value <= most ? *value : least > 0 ? least : std::int64_t{0}, word.place};
  }
  static std::optional<std::int64_t> number(std::string_view text, int base = 10) {
    if (base == 0) {
      base = 10;
      if (text.starts_with("0x") || text.starts_with("0X")) { text.remove_prefix(2); base = 16; }
    }
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (text.empty() || error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
    return value;
  }
  bool failed() const { return failed_; }
  json::Diagnostics& diagnostics() { return diagnostics_; }

 private:
  const Command& command_;
  json::Diagnostics& diagnostics_;
  std::size_t next_ = 0;
  bool failed_ = false;
};

constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();

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
    const Word word = words.at_end() ? words.take_value(what) : words.take();
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
    classes.queues.push_back({{static_cast<std::uint32_t>(*count), static_cast<std::uint32_t>(*offset)}, words.take().place});
  }
  if (classes.queues.empty()) {
    const Word word = words.at_end() ? words.take_value("queues as COUNT@OFFSET") : words.take();
    if (!word.text.empty()) words.refuse(word, "not a range of queues", "COUNT@OFFSET");
  }
}

void read_preemption(Words& words, Classes& classes) {
  while (words.is_next("P") || words.is_next("E")) {
    const Word& word = words.take();
    classes.preemptable.push_back({word.text == "P", word.place});
  }
  if (classes.preemptable.empty() && !words.at_end()) words.refuse(words.take(), "not a preemption status", "P or E for each class");
}

void read_gate_line(Words& words, Classes& classes) {
  GateLine line;
  const Word operation = words.take_value("S, H or R");
  line.place = operation.place;
  if (operation.text.size() == 1 && std::string_view("SHR").find(operation.text[0]) != std::string_view::npos) line.operation = operation.text[0];
  else if (!operation.text.empty()) words.refuse(operation, "not an operation of a gate list", "S (set), H (set and hold) or R (set and release)");
  const At<std::int64_t> mask = words.take_number("a mask of classes, hexadecimal without 0x", 0, 0xFFFF'FFFF, 16);
  line.mask = static_cast<std::uint64_t>(mask.value);
  line.interval = words.take_number("an interval in ns", 0, 0xFFFF'FFFF).value;
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
      {"num_tc", [&] { classes.num_tc = words.take_number("a number of classes from 1 to 16", 1, 16); }},
      {"map", [&] { read_numbers(words, classes.map, "the class of each priority"); }},
      {"queues", [&] { read_queues(words, classes); }},
      {"fp", [&] { read_preemption(words, classes); }},
      {"max-sdu", [&] { read_numbers(words, classes.max_sdu, "octets for each class"); }, true, false},
      {"base-time", [&] { classes.base_time = words.take_number("ns since 1970", -most, most); }, true, false},
      {"cycle-time", [&] { classes.cycle_time = words.take_number("a cycle in ns of at least 1", 1, most); }, true, false},
      {"cycle-time-extension", [&] { classes.extension = words.take_number("ns", 0, most); }, true, false},
      {"sched-entry", [&] { read_gate_line(words, classes); }, true, false},
      {"flags", [&] {
         const At<std::int64_t> flags = words.take_number("flags, 0x1 or 0x2", 0, 0xFFFF'FFFF, 0);
         classes.flags = {static_cast<std::uint64_t>(flags.value), flags.place};
       }, true, false},
      {"txtime-delay", [&] { classes.txtime_delay = words.take_number("ns", 0, 0xFFFF'FFFF); }, true, false},
      {"clockid", [&] { const Word word = words.take_value("the name of a clock"); classes.clock = At<std::string>{word.text, word.place}; }, true, false},
      {"hw", [&] { words.take_number("0 to 2", 0, 2); }, false, true},
      {"mode", [&] { if (const Word word = words.take_value("dcb or channel"); word.text != "dcb" && word.text != "channel") words.refuse(word, "not a mode", "dcb or channel"); }, false, true},
      {"shaper", [&] { if (const Word word = words.take_value("dcb"); word.text != "dcb") words.refuse(word, "a shaper of classes that takt does not have", "dcb"); }, false, true},
  };
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    const bool is_taprio = classes.kind == ClassKind::taprio;
    const auto key = std::ranges::find_if(keys, [&](const Key& each) { return each.name == word.text && (is_taprio ? each.of_taprio : each.of_mqprio); });
    if (key != keys.end()) {
      key->read();
      continue;
    }
    std::vector<std::string_view> names;
    for (const Key& each : keys)
      if (is_taprio ? each.of_taprio : each.of_mqprio) names.push_back(each.name);
    words.refuse(word, is_taprio ? "not a key of taprio" : "not a key of mqprio", "num_tc, map, queues and the like", json::suggest(word.text, names));
  }
}

void read_cbs(Words& words, CreditShaper& shaper) {
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "idleslope") shaper.idleslope = words.take_number("kbit/s", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "sendslope") shaper.sendslope = words.take_number("kbit/s, negative", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "hicredit") shaper.hicredit = words.take_number("octets", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "locredit") shaper.locredit = words.take_number("octets, negative", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "offload") words.take_number("0 or 1", 0, 1);
    else words.refuse(word, "not a key of cbs", "idleslope, sendslope, hicredit, locredit or offload");
  }
}

void read_etf(Words& words, LaunchTimes& launch) {
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "clockid") { const Word clock = words.take_value("the name of a clock"); launch.clock = At<std::string>{clock.text, clock.place}; }
    else if (word.text == "delta") launch.delta = words.take_number("ns", -0x7FFF'FFFF, 0x7FFF'FFFF);
    else if (word.text == "deadline_mode") launch.deadline_mode = true;
    else if (word.text != "offload" && word.text != "skip_sock_check") words.refuse(word, "not a key of etf", "clockid, delta, offload, deadline_mode or skip_sock_check");
  }
}

void read_qdisc(Words& words, const Word& start, Machine& machine) {
  if (!words.take_if("add") && !words.take_if("replace")) {
    if (!words.at_end() && (words.is_next("del") || words.is_next("show"))) return;
    words.refuse(words.at_end() ? start : words.take(), "not what a set of commands does to a qdisc", "add or replace");
    return;
  }
  std::string device, parent, handle;
  json::Place device_place = start.place;
  bool at_root = false;
  while (!words.at_end()) {
    const Word& word = words.take();
    if (word.text == "dev") { const Word name = words.take_value("an interface"); device = name.text; device_place = name.place; }
    else if (word.text == "root") at_root = true;
    else if (word.text == "parent") { parent = words.take_value("root or HANDLE:CLASS").text; at_root = at_root || parent == "root"; }
    else if (word.text == "handle") handle = without_colon(words.take_value("a handle").text);
    else if (word.text == "clsact" || word.text == "ingress") { machine.interface(device, device_place).has_clsact = true; return; }
    else if (word.text == "taprio" || word.text == "mqprio") {
      Classes classes;
      classes.kind = word.text == "taprio" ? ClassKind::taprio : ClassKind::mqprio;
      classes.place = word.place;
      classes.at_root = at_root;
      classes.handle = handle;
      read_classes(words, classes);
      Interface& interface = machine.interface(device, device_place);
      // A second one at another place is told by check(); one at the same place replaces the first, as `replace` does.
      if (!words.failed()) {
        if (!at_root) words.diagnostics().error(word.place, word.text + " that is not at the root", {"parent " + json::quote(parent), "root or \"parent root\""});
        else interface.classes = std::move(classes);
      }
      return;
    } else if (word.text == "cbs") {
      CreditShaper shaper{word.place, parent, {}, {}, {}, {}};
      read_cbs(words, shaper);
      if (!words.failed()) machine.interface(device, device_place).shapers.push_back(shaper);
      return;
    } else if (word.text == "etf") {
      LaunchTimes launch{word.place, parent, {}, {}, false};
      read_etf(words, launch);
      if (!words.failed()) machine.interface(device, device_place).launches.push_back(launch);
      return;
    } else {
      words.refuse(word, "a qdisc or key that is not understood", "dev, root, parent, handle; taprio, mqprio, cbs, etf or clsact");
      return;
    }
    if (words.failed()) return;
  }
  words.refuse(start, "a command without a qdisc", "taprio, mqprio, cbs, etf or clsact");
}

void read_gate_action(Words& words, GateAction& gate) {
  while (!words.at_end() && !words.failed()) {
    if (words.is_next("action")) return;
    const Word& word = words.take();
    if (word.text == "index") gate.index = words.take_number("a number", 0, 0xFFFF'FFFF).value;
    else if (word.text == "clockid") words.take_value("the name of a clock");
    else if (word.text == "base-time") gate.base_time = words.take_number("ns", 0, most);
    else if (word.text == "cycle-time") gate.cycle_time = words.take_number("ns", 1, most);
    else if (word.text == "cycle-time-ext") words.take_number("ns", 0, most);
    else if (word.text == "priority") gate.priority = words.take_number("an internal priority value, or -1", -1, 7).value;
    else if (word.text == "sched-entry") {
      StreamGateLine line;
      const Word state = words.take_value("open or close");
      line.place = state.place;
      line.open = state.text == "open";
      if (!line.open && state.text != "close" && !state.text.empty()) words.refuse(state, "not the state of a gate", "open or close");
      line.interval = words.take_number("ns, at least 1", 1, 0xFFFF'FFFF).value;
      line.priority = words.take_number("an internal priority value, or -1", -1, 7).value;
      line.octets = words.take_number("octets, or -1", -1, 0x7FFF'FFFF).value;
      gate.entries.push_back(line);
    } else {
      words.refuse(word, "not a key of a gate", "index, clockid, base-time, cycle-time, priority or sched-entry");
    }
  }
}

/// "10mbit", "3000": bits per second and octets as tc writes them.
std::optional<std::int64_t> with_suffix(std::string_view text, const std::vector<std::pair<std::string_view, std::int64_t>>& suffixes) {
  for (const auto& [suffix, factor] : suffixes) {
    if (!text.ends_with(suffix)) continue;
    const auto number = Words::number(text.substr(0, text.size() - suffix.size()));
    if (number && *number >= 0 && *number <= most / factor) return *number * factor;
  }
  return std::nullopt;
}

void read_police_action(Words& words, PoliceAction& police) {
  while (!words.at_end() && !words.failed()) {
    if (words.is_next("action")) return;
    const Word& word = words.take();
    if (word.text == "index") police.index = words.take_number("a number", 0, 0xFFFF'FFFF).value;
    else if (word.text == "rate") {
      const Word rate = words.take_value("a rate");
      const auto bits = with_suffix(rate.text, {{"gbit", 1'000'000'000}, {"mbit", 1'000'000}, {"kbit", 1'000}, {"bit", 1}, {"bps", 8}});
      if (!bits) words.refuse(rate, "not a rate", "a whole number with bit, kbit, mbit or gbit");
      police.rate = static_cast<std::uint64_t>(bits.value_or(0));
    } else if (word.text == "burst") {
      const Word burst = words.take_value("octets");
      const auto octets = with_suffix(burst.text, {{"kb", 1024}, {"k", 1024}, {"b", 1}, {"", 1}});
      if (!octets || *octets > 0xFFFF'FFFF) words.refuse(burst, "not a number of octets", "octets");
      else police.burst = *octets;
    } else if (word.text == "conform-exceed") {
      const Word what = words.take_value("drop/pipe");
      if (what.text != "drop" && what.text != "drop/pipe" && what.text != "drop/ok" && what.text != "drop/pass") words.refuse(what, "what takt's meters do not do", "drop, drop/pipe or drop/ok");
    } else {
      words.refuse(word, "not a key of police that takt has", "index, rate, burst or conform-exceed");
    }
  }
}

void read_flower(Words& words, IngressFilter& filter) {
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "vlan_id") filter.vlan = words.take_number("a VLAN from 1 to 4094", 1, 4094).value;
    else if (word.text == "vlan_prio") filter.priority = words.take_number("a priority from 0 to 7", 0, 7).value;
    else if (word.text == "dst_mac") {
      std::string address = words.take_value("an address").text;
      std::ranges::transform(address, address.begin(), [](unsigned char c) { return c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : static_cast<char>(c); });
      filter.address = address;
    } else if (word.text == "skip_sw" || word.text == "skip_hw") continue;
    else if (word.text == "action") {
      const Word kind = words.take_value("gate or police");
      if (kind.text == "gate") { filter.gate.emplace().place = kind.place; read_gate_action(words, *filter.gate); }
      else if (kind.text == "police") { filter.police.emplace().place = kind.place; read_police_action(words, *filter.police); }
      else if (!kind.text.empty()) words.refuse(kind, "an action that takt does not have", "gate or police");
    } else {
      words.refuse(word, "not a key of flower that takt has", "vlan_id, vlan_prio, dst_mac or action");
    }
  }
}

void read_filter(Words& words, const Word& start, Machine& machine) {
  if (!words.take_if("add") && !words.take_if("replace")) {
    words.refuse(words.at_end() ? start : words.take(), "not what a set of commands does to a filter", "add or replace");
    return;
  }
  IngressFilter filter;
  filter.place = start.place;
  std::string device;
  json::Place device_place = start.place;
  bool is_ingress = false;
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "dev") { const Word name = words.take_value("an interface"); device = name.text; device_place = name.place; }
    else if (word.text == "ingress") is_ingress = true;
    else if (word.text == "protocol") words.take_value("802.1Q or all");
    else if (word.text == "pref" || word.text == "prio") filter.preference = words.take_number("a preference", 0, 65535).value;
    else if (word.text == "chain") words.take_number("a chain", 0, 0xFFFF'FFFF);
    else if (word.text == "flower") { read_flower(words, filter); break; }
    else words.refuse(word, "a filter or key that is not understood", "dev, ingress, protocol, pref or flower");
  }
  if (words.failed()) return;
  if (!is_ingress || device.empty()) words.refuse(start, "a filter that is not at the ingress of an interface", "\"dev IF ingress\"");
  else machine.interface(device, device_place).filters.push_back(std::move(filter));
}

void read_set_mm(Words& words, Machine& machine) {
  const Word device = words.take_value("an interface");
  MacMerge merge;
  merge.place = device.place;
  const auto take_switch = [&]() -> At<bool> {
    const Word word = words.take_value("on or off");
    if (!word.text.empty() && word.text != "on" && word.text != "off") words.refuse(word, "not a switch", "on or off");
    return {word.text == "on", word.place};
  };
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "pmac-enabled") merge.pmac = take_switch();
    else if (word.text == "tx-enabled") merge.tx = take_switch();
    else if (word.text == "verify-enabled") merge.verify = take_switch();
    else if (word.text == "verify-time") merge.verify_time = words.take_number("ms", 0, 0x7FFF'FFFF);
    else if (word.text == "tx-min-frag-size") merge.fragment = words.take_number("octets", 0, 0x7FFF'FFFF);
    else words.refuse(word, "not a key of --set-mm", "pmac-enabled, tx-enabled, verify-enabled, verify-time or tx-min-frag-size");
  }
  if (!words.failed()) machine.interface(device.text, device.place).merge = merge;
}

void read_bridge(Words& words, const Word& start, Machine& machine) {
  machine.has_bridge = true;
  if (words.take_if("fdb") || words.take_if("mdb")) return;   // addresses follow from paths in takt
  if (!words.take_if("vlan")) {
    words.refuse(words.at_end() ? start : words.take(), "not what takt knows of a bridge", "vlan, fdb or mdb");
    return;
  }
  const bool adds = words.is_next("add");
  std::string device;
  json::Place place = start.place;
  bool untagged = false;
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "dev") { const Word name = words.take_value("an interface"); device = name.text; place = name.place; }
    else if (word.text == "vid") words.take_number("a VLAN from 1 to 4094", 1, 4094);
    else if (word.text == "untagged") untagged = true;
    else if (word.text != "add" && word.text != "del" && word.text != "pvid" && word.text != "self" && word.text != "master") words.refuse(word, "not a key of bridge vlan", "add, del, dev, vid, pvid or untagged");
  }
  if (!words.failed() && adds) {
    Interface& interface = machine.interface(device, place);
    interface.untagged = interface.untagged || untagged;
  }
}

void read_command(const Command& command, Machine& machine, json::Diagnostics& diagnostics) {
  Words words(command, diagnostics);
  const Word& program = words.take();
  if (program.text == "tc") {
    if (words.take_if("qdisc")) return read_qdisc(words, program, machine);
    if (words.take_if("filter")) return read_filter(words, program, machine);
    words.refuse(words.at_end() ? program : words.take(), "not what takt knows of tc", "qdisc or filter");
  } else if (program.text == "ethtool") {
    if (words.take_if("--set-mm")) return read_set_mm(words, machine);
    words.refuse(words.at_end() ? program : words.take(), "not what takt knows of ethtool", "--set-mm");
  } else if (program.text == "bridge") {
    read_bridge(words, program, machine);
  } else if (program.text == "ip") {
    if (!words.is_next("link")) words.refuse(words.at_end() ? program : words.take(), "not what takt knows of ip", "link");
    for (const Word& word : command)
      if (word.text == "bridge" || word.text == "master") machine.has_bridge = true;
  } else if (program.text != "set") {
    words.refuse(program, "a command that is not understood", "tc, ethtool, bridge or ip");
  }
}

}  // namespace

std::vector<Command> commands_of(std::string_view text, const std::string& file, json::Diagnostics& diagnostics) {
  std::vector<Command> commands;
  Command command;
  Word word;
  bool in_comment = false;
  std::uint32_t line = 1, column = 1;
  const auto end_word = [&] {
    if (!word.text.empty()) command.push_back(std::move(word));
    word = {};
  };
  const auto end_command = [&] {
    end_word();
    if (!command.empty()) commands.push_back(std::move(command));
    command = {};
  };
  for (std::size_t i = 0; i < text.size(); ++i, ++column) {
    const char c = text[i];
    if (c == '\n') {
      in_comment = false;
      end_command();
      ++line;
      column = 0;
    } else if (in_comment) {
      continue;
    } else if (c == '\\' && i + 1 < text.size() && text[i + 1] == '\n') {
      end_word();
      ++i;
      ++line;
      column = 0;
    } else if (c == ' ' || c == '\t' || c == '\r') {
      end_word();
    } else if (c == '#' && word.text.empty()) {
      in_comment = true;
    } else if (std::string_view("$`|;&<>(){}*?\"'\\").find(c) != std::string_view::npos || static_cast<unsigned char>(c) < 0x20) {
      diagnostics.error({file, line, column, ""}, "what only a shell can work out", {json::quote(std::string_view(&text[i], 1)), "commands with plain words"});
      in_comment = true;   // the rest of the line is a consequence
      command.clear();
      word = {};
    } else {
      if (word.text.empty()) word.place = {file, line, column, ""};
      word.text += c;
    }
  }
  end_command();
  return commands;
}

void read_script(std::string_view text, const std::string& file, Machine& machine, json::Diagnostics& diagnostics) {
  for (const Command& command : commands_of(text, file, diagnostics)) read_command(command, machine, diagnostics);
}

}  // namespace takt::interchange::linux_tc
