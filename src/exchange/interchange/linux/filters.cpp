// SPDX-License-Identifier: Apache-2.0
// tc filter and its actions: what polices at the ingress of an interface. Other filters do things that takt has no
// model for, and are remarked.
#include <algorithm>
#include <array>
#include <vector>

#include "interchange/linux/words.hpp"

namespace takt::interchange::linux_tc {
namespace {

/// A whole number with one of the suffixes, times its factor.
std::optional<std::int64_t> with_suffix(std::string_view text,
                                        const std::vector<std::pair<std::string_view, std::int64_t>>& suffixes) {
  for (const auto& [suffix, factor] : suffixes) {
    if (!text.ends_with(suffix)) continue;
    const auto number = Words::number(text.substr(0, text.size() - suffix.size()), 0);
    if (number && *number >= 0 && *number <= most_ns / factor) return *number * factor;
  }
  return std::nullopt;
}

/// A time of an action: ns, or with a unit.
At<std::int64_t> take_time(Words& words, std::int64_t least) {
  const Word word = words.parse_value("ns, or a time with a unit");
  const auto ns = with_suffix(word.text, {{"ns", 1},
                                          {"nsec", 1},
                                          {"us", 1'000},
                                          {"usec", 1'000},
                                          {"ms", 1'000'000},
                                          {"msec", 1'000'000},
                                          {"s", 1'000'000'000},
                                          {"", 1}});
  if (!word.text.empty() && (!ns || *ns < least))
    words.refuse(word, "not a time that fits",
                 "ns, or a time such as 200us, of at least " + std::to_string(least) + " ns");
  return {ns.value_or(least), word.place};
}

bool is_number(const Words& words) {
  if (words.at_end()) return false;
  const std::string& text = words.peek().text;
  const std::size_t first = text.starts_with('-') ? 1 : 0;
  return text.size() > first && text[first] >= '0' && text[first] <= '9';
}

void read_gate_entry(Words& words, GateAction& gate) {
  StreamGateLine line;
  const Word state = words.parse_value("open or close");
  line.place = state.place;
  std::string lower = state.text;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  line.open = lower == "open";
  if (!line.open && lower != "close" && !state.text.empty())
    words.refuse(state, "not the state of a gate", "open or close");
  line.interval = take_time(words, 1).value;
  if (is_number(words)) line.priority = words.parse_number("an internal priority value, or -1", -1, 7).value;
  if (is_number(words)) {
    const Word octets = words.take();
    const auto count =
        octets.text == "-1"
            ? std::optional<std::int64_t>(-1)
            : with_suffix(octets.text,
                          {{"kb", 1024}, {"k", 1024}, {"mb", 1'048'576}, {"m", 1'048'576}, {"b", 1}, {"", 1}});
    if (!count || *count > 0x7FFF'FFFF)
      words.refuse(octets, "not a number of octets", "octets, or -1");
    else
      line.octets = *count;
  }
  gate.entries.push_back(line);
}

/// Whether the next word begins another action, or says what comes behind one.
bool ends_action(Words& words) {
  return words.is_next("action") || words.is_next("pipe") || words.is_next("reclassify") || words.is_next("continue") ||
         words.is_next("ok") || words.is_next("pass") || words.is_next("drop");
}

void read_gate_action(Words& words, GateAction& gate) {
  while (!words.at_end() && !words.failed() && !ends_action(words)) {
    const Word& word = words.take();
    if (word.text == "index")
      gate.index = words.parse_number("a number", 0, 0xFFFF'FFFF, 0).value;
    else if (word.text == "clockid")
      words.parse_value("the name of a clock");
    else if (word.text == "base-time")
      gate.base_time = take_time(words, 0);
    else if (word.text == "cycle-time")
      gate.cycle_time = take_time(words, 1);
    else if (word.text == "cycle-time-ext")
      take_time(words, 0);
    else if (word.text == "flags")
      words.parse_number("flags", 0, 0xFFFF'FFFF, 0);
    else if (word.text == "priority")
      gate.priority = words.parse_number("an internal priority value, or -1", -1, 7).value;
    else if (word.text == "sched-entry")
      read_gate_entry(words, gate);
    else
      words.refuse(word, "not a key of a gate", "index, clockid, base-time, cycle-time, priority or sched-entry");
  }
}

void read_police_action(Words& words, PoliceAction& police) {
  while (!words.at_end() && !words.failed() && !ends_action(words)) {
    const Word& word = words.take();
    if (word.text == "index")
      police.index = words.parse_number("a number", 0, 0xFFFF'FFFF, 0).value;
    else if (word.text == "rate") {
      const Word rate = words.parse_value("a rate");
      std::string lower = rate.text;
      std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      const auto bits = with_suffix(lower, {{"gbit", 1'000'000'000},
                                            {"mbit", 1'000'000},
                                            {"kbit", 1'000},
                                            {"bit", 1},
                                            {"gbps", 8'000'000'000},
                                            {"mbps", 8'000'000},
                                            {"kbps", 8'000},
                                            {"bps", 8},
                                            {"", 1}});
      if (!bits) words.refuse(rate, "not a rate", "a whole number with bit, kbit, mbit or gbit");
      police.rate = static_cast<std::uint64_t>(bits.value_or(0));
    } else if (word.text == "burst" || word.text == "buffer" || word.text == "maxburst") {
      const Word burst = words.parse_value("octets");
      const auto octets =
          with_suffix(burst.text, {{"mb", 1'048'576}, {"m", 1'048'576}, {"kb", 1024}, {"k", 1024}, {"b", 1}, {"", 1}});
      if (!octets || *octets > 0xFFFF'FFFF)
        words.refuse(burst, "not a number of octets", "octets");
      else
        police.burst = *octets;
    } else if (word.text == "conform-exceed") {
      const Word what = words.parse_value("drop/pipe");
      if (what.text != "drop" && what.text != "drop/pipe" && what.text != "drop/ok" && what.text != "drop/pass")
        words.refuse(what, "what takt's meters do not do", "drop, drop/pipe or drop/ok");
    } else if (word.text == "mtu" || word.text == "overhead") {
      words.parse_value("octets");
    } else {
      words.refuse(word, "not a key of police that takt has", "index, rate, burst or conform-exceed");
    }
  }
}

/// The priority that is set; null if something else is.
std::optional<std::int64_t> read_skbedit(Words& words) {
  if (!words.read_if("priority")) return std::nullopt;
  const Word priority = words.parse_value("a priority");
  return Words::number(priority.text, 0);
}

void remark_action(Words& words, const Word& kind, Machine& machine) {
  while (!words.at_end() && !words.is_next("action")) words.take();
  machine.remarks.push_back(
      {RemarkKind::lost, kind.place,
       "the action " + kind.text + ": takt's streams have their priorities and paths by themselves"});
}

void read_actions(Words& words, IngressFilter& filter, Machine& machine) {
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text != "action") continue;  // pipe, drop and the like behind an action
    const Word kind = words.parse_value("gate or police");
    if (kind.text == "gate") {
      filter.gate.emplace().place = kind.place;
      read_gate_action(words, *filter.gate);
    } else if (kind.text == "police") {
      filter.police.emplace().place = kind.place;
      read_police_action(words, *filter.police);
    } else if (kind.text == "skbedit" && words.is_next("priority")) {
      // The class of a frame is that of its tag in takt.
      if (const auto priority = read_skbedit(words); !filter.priority || priority != filter.priority)
        machine.remarks.push_back(
            {RemarkKind::lost, kind.place,
             "a priority that a filter gives: takt's streams have their priorities by themselves"});
    } else if (!kind.text.empty())
      remark_action(words, kind, machine);
  }
}

/// Keys that match what takt's stream filters cannot; each with one value.
constexpr std::array foreign_keys = {"src_mac",  "vlan_ethtype", "eth_type", "dst_ip",   "src_ip",
                                     "dst_port", "src_port",     "ip_proto", "cvlan_id", "cvlan_prio",
                                     "hw_tc",    "classid",      "ip_tos",   "indev"};

void read_flower(Words& words, IngressFilter& filter, Machine& machine) {
  while (!words.at_end() && !words.failed() && !words.is_next("action")) {
    const Word& word = words.take();
    if (word.text == "vlan_id")
      filter.vlan = words.parse_number("a VLAN from 1 to 4094", 1, 4094).value;
    else if (word.text == "vlan_prio")
      filter.priority = words.parse_number("a priority from 0 to 7", 0, 7).value;
    else if (word.text == "dst_mac") {
      std::string address = words.parse_value("an address").text;
      std::ranges::transform(address, address.begin(),
                             [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      filter.address = address;
    } else if (std::ranges::find(foreign_keys, word.text) != foreign_keys.end()) {
      words.parse_value("a value");
      machine.remarks.push_back(
          {RemarkKind::lost, word.place,
           word.text + " of a filter: takt's stream filters match by destination, VLAN and priority"});
    } else if (word.text != "skip_sw" && word.text != "skip_hw" && word.text != "verbose") {
      words.refuse(word, "not a key of flower that takt has", "vlan_id, vlan_prio, dst_mac or action");
    }
  }
  read_actions(words, filter, machine);
}

}  // namespace

void read_filter(Words& words, const Word& start, Machine& machine) {
  const bool deletes = words.is_next("del") || words.is_next("delete");
  if (words.is_next("show") || words.is_next("list") || words.is_next("ls")) return;
  if (!deletes && !words.is_next("add") && !words.is_next("replace") && !words.is_next("change"))
    return words.refuse(words.at_end() ? start : words.take(), "not what a set of commands does to a filter",
                        "add, replace or del");
  words.take();
  IngressFilter filter;
  filter.place = start.place;
  std::string device;
  json::Place device_place = start.place;
  bool is_ingress = false;
  while (!words.at_end() && !words.failed()) {
    const Word& word = words.take();
    if (word.text == "dev") {
      const Word name = words.parse_value("an interface");
      device = name.text;
      device_place = name.place;
    } else if (word.text == "ingress")
      is_ingress = true;
    else if (word.text == "egress" || word.text == "root")
      continue;
    else if (word.text == "parent") {
      const Word parent = words.parse_value("a handle");
      is_ingress = is_ingress || parent.text == "ffff:";
    } else if (word.text == "protocol")
      words.parse_value("802.1Q or all");
    else if (word.text == "handle")
      words.parse_value("a handle");
    else if (word.text == "pref" || word.text == "prio")
      filter.preference = words.parse_number("a preference", 0, 65535, 0).value;
    else if (word.text == "chain")
      words.parse_number("a chain", 0, 0xFFFF'FFFF, 0);
    else if (word.text == "flower" && is_ingress) {
      read_flower(words, filter, machine);
      break;
    } else if (word.text == "matchall" && is_ingress) {
      read_actions(words, filter, machine);
      break;
    } else if (!is_ingress &&
               (word.text == "flower" || word.text == "matchall" || word.text == "u32" || word.text == "fw" ||
                word.text == "basic" || word.text == "bpf" || word.text == "handle")) {
      machine.remarks.push_back({RemarkKind::lost, start.place,
                                 "a filter at egress: which class a frame is in follows from its priority in takt"});
      return;
    } else if (word.text == "u32" || word.text == "basic" || word.text == "bpf" || word.text == "fw") {
      machine.remarks.push_back({RemarkKind::lost, start.place,
                                 "a filter of kind " + word.text +
                                     ": takt's stream filters match by destination, VLAN and priority (flower)"});
      return;
    } else
      words.refuse(word, "a filter or key that is not understood", "dev, ingress, protocol, pref or flower");
  }
  if (words.failed()) return;
  if (device.empty()) return words.refuse(start, "a filter of no interface", "\"dev IF ingress\"");
  if (!is_ingress && !deletes)
    return words.refuse(start, "a filter that is not at the ingress of an interface", "\"dev IF ingress\"");
  std::vector<IngressFilter>& filters = machine.interface(device, device_place).filters;
  if (deletes)
    std::erase_if(filters, [&](const IngressFilter& each) {
      return filter.preference == 0 || each.preference == filter.preference;
    });
  else if (filter.gate || filter.police)
    filters.push_back(std::move(filter));
}

}  // namespace takt::interchange::linux_tc
