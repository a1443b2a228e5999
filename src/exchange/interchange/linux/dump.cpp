// SPDX-License-Identifier: Apache-2.0
// What `tc -j qdisc show`, `ip -j -d link show` and `bridge -j vlan show` print of a machine.
#include <algorithm>

#include "interchange/linux/script.hpp"
#include "json/document.hpp"

namespace takt::interchange::linux_tc {
namespace {

class DumpReader {
 public:
  DumpReader(const json::Document& document, Machine& machine, json::Diagnostics& diagnostics)
      : document_(document), machine_(machine), diagnostics_(diagnostics) {}

  void run() {
    if (!expect(document_.root(), json::Kind::array, "an array, as tc -j, ip -j and bridge -j print")) return;
    for (const json::Node& item : document_.root().items) {
      if (!expect(item, json::Kind::object, "an object")) continue;
      if (item.find("kind") != nullptr && item.find("handle") != nullptr)
        read_qdisc(item);
      else if (item.find("ifindex") != nullptr)
        read_link(item);
      else if (item.find("vlans") != nullptr)
        read_vlans(item);
      else if (item.find("mac") != nullptr || item.find("mdb") != nullptr)
        machine_.has_bridge = true;  // addresses follow from paths in takt
      else
        refuse(item, "a qdisc, a link or the VLANs of a port");
    }
  }

 private:
  json::Place place(const json::Node& node) const { return json::place_of(*document_.tree(), node); }
  void refuse(const json::Node& node, std::string expected) {
    diagnostics_.error(place(node), "not what is expected", {json::excerpt(node), std::move(expected)});
  }
  bool expect(const json::Node& node, json::Kind kind, std::string expected) {
    if (node.kind == kind) return true;
    refuse(node, std::move(expected));
    return false;
  }
  std::string text(const json::Node& object, std::string_view key) {
    const json::Node* const found = object.find(key);
    return found != nullptr && found->kind == json::Kind::string ? found->text : std::string();
  }

  /// A number, or a text with one in hexadecimal ("0x2").
  At<std::int64_t> number(const json::Node& node) {
    At<std::int64_t> result{0, place(node)};
    if (node.kind == json::Kind::number) {
      const auto value = json::integer_of(node);
      if (value && *value >= -(sim::int128{1} << 62) && *value < sim::int128{1} << 62)
        result.value = static_cast<std::int64_t>(*value);
      else
        refuse(node, "a whole number");
    } else if (node.kind == json::Kind::string && node.text.starts_with("0x") && node.text.size() > 2 &&
               node.text.size() <= 17 &&
               node.text.find_first_not_of("0123456789abcdefABCDEF", 2) == std::string::npos) {
      result.value = static_cast<std::int64_t>(std::stoull(node.text.substr(2), nullptr, 16));
    } else {
      refuse(node, "a number");
    }
    return result;
  }
  At<std::int64_t> number(const json::Node& object, std::string_view key) {
    const json::Node* const found = object.find(key);
    return found != nullptr ? number(*found) : At<std::int64_t>{0, place(object)};
  }
  std::vector<At<std::int64_t>> numbers(const json::Node& object, std::string_view key) {
    std::vector<At<std::int64_t>> all;
    const json::Node* const found = object.find(key);
    if (found == nullptr || !expect(*found, json::Kind::array, "an array")) return all;
    for (const json::Node& item : found->items) all.push_back(number(item));
    return all;
  }

  void read_qdisc(const json::Node& item) {
    const std::string kind = text(item, "kind");
    const std::string device = text(item, "dev");
    if (device.empty()) return refuse(item, "a qdisc with \"dev\"");
    Interface& interface = machine_.interface(device, place(item));
    const json::Node* const options = item.find("options");
    const bool has_options = options != nullptr && options->kind == json::Kind::object;
    if (kind == "clsact") interface.has_clsact = true;
    if (kind != "taprio" && kind != "mqprio" && kind != "cbs" && kind != "etf")
      return;  // pfifo_fast and the like below a class
    if (!has_options) return refuse(item, "a qdisc with \"options\"");
    if (kind == "cbs") {
      interface.shapers.push_back({place(item), text(item, "parent"), number(*options, "idleslope"),
                                   number(*options, "sendslope"), number(*options, "hicredit"),
                                   number(*options, "locredit")});
    } else if (kind == "etf") {
      LaunchTimes launch{
          place(item), text(item, "parent"), {}, number(*options, "delta"), text(*options, "deadline_mode") == "on"};
      launch.clock = At<std::string>{text(*options, "clockid"), place(*options)};
      interface.launches.push_back(launch);
    } else {
      interface.classes = read_classes(item, *options, kind == "taprio" ? ClassKind::taprio : ClassKind::mqprio);
    }
  }

  Classes read_classes(const json::Node& item, const json::Node& options, ClassKind kind) {
    Classes classes;
    classes.kind = kind;
    classes.place = place(item);
    classes.is_dumped = true;
    classes.handle = text(item, "handle");
    if (classes.handle.ends_with(':')) classes.handle.pop_back();
    const json::Node* const root = item.find("root");
    if (root == nullptr || !root->boolean) refuse(item, "a qdisc at the root");
    classes.num_tc = number(options, "tc");
    if (classes.num_tc.value < 1 || classes.num_tc.value > 16)
      diagnostics_.error(classes.num_tc.place, "not a number of classes",
                         {std::to_string(classes.num_tc.value), "1 to 16"});
    classes.map = numbers(options, "map");
    read_queues(options, classes);
    if (const json::Node* const fp = options.find("fp"); fp != nullptr && expect(*fp, json::Kind::array, "an array"))
      for (const json::Node& status : fp->items) classes.preemptable.push_back({status.text == "P", place(status)});
    // The kernel prints 16, also where nothing is preemptable.
    if (classes.num_tc.value >= 1 && classes.preemptable.size() > static_cast<std::size_t>(classes.num_tc.value))
      classes.preemptable.resize(static_cast<std::size_t>(classes.num_tc.value));
    if (std::ranges::none_of(classes.preemptable, [](const At<bool>& each) { return each.value; }))
      classes.preemptable.clear();
    if (kind == ClassKind::mqprio) return classes;
    // A list that is not in force yet is what the port is set to.
    const json::Node* const admin = options.find("admin");
    const bool has_admin = admin != nullptr && admin->kind == json::Kind::object && admin->find("schedule") != nullptr;
    if (has_admin && options.find("schedule") != nullptr)
      machine_.remarks.push_back(
          {RemarkKind::changed, place(*admin),
           "a gate list that is not in force yet (admin): it is taken, and not the one that runs"});
    const json::Node& list = has_admin ? *admin : options;
    classes.base_time = number(list, "base_time");
    if (const json::Node* const cycle = list.find("cycle_time"); cycle != nullptr) classes.cycle_time = number(*cycle);
    classes.extension = number(list, "cycle_time_extension");
    const At<std::int64_t> flags = number(options, "flags");
    classes.flags = {static_cast<std::uint64_t>(flags.value), flags.place};
    if (options.find("txtime_delay") != nullptr) classes.txtime_delay = number(options, "txtime_delay");
    if (const json::Node* const clock = options.find("clockid"); clock != nullptr && (flags.value & 2) == 0)
      classes.clock = At<std::string>{clock->text, place(*clock)};
    const json::Node* const schedule = list.find("schedule");
    if (schedule == nullptr || !expect(*schedule, json::Kind::array, "an array")) return classes;
    for (const json::Node& entry : schedule->items) {
      if (!expect(entry, json::Kind::object, "an entry of a gate list")) continue;
      const std::string operation = text(entry, "cmd");
      if (operation != "S" && operation != "H" && operation != "R")
        refuse(entry, "an entry with \"cmd\" S, H or R");
      else
        classes.entries.push_back({operation[0], static_cast<std::uint64_t>(number(entry, "gatemask").value),
                                   number(entry, "interval").value, place(entry)});
    }
    return classes;
  }

  /// taprio says {"offset", "count"}, mqprio [first, last].
  void read_queues(const json::Node& options, Classes& classes) {
    const json::Node* const queues = options.find("queues");
    if (queues == nullptr || !expect(*queues, json::Kind::array, "an array")) return;
    for (const json::Node& range : queues->items) {
      std::int64_t first = 0, count = 0;
      if (range.kind == json::Kind::array && range.items.size() == 2) {
        first = number(range.items[0]).value;
        count = number(range.items[1]).value - first + 1;
      } else if (range.kind == json::Kind::object) {
        first = number(range, "offset").value;
        count = number(range, "count").value;
      }
      if (first < 0 || first > 65535 || count < 1 || count > 65535)
        refuse(range, "a range of queues");
      else
        classes.queues.push_back(
            {{static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(first)}, place(range)});
    }
  }

  void read_link(const json::Node& item) {
    const std::string name = text(item, "ifname");
    if (name.empty()) return refuse(item, "a link with \"ifname\"");
    const json::Node* const info = item.find("linkinfo");
    if (info != nullptr && text(*info, "info_kind") == "bridge") machine_.has_bridge = true;
    if (item.find("master") != nullptr) machine_.has_bridge = true;
    const json::Node* const type = item.find("link_type");
    if (type != nullptr && type->text == "loopback") return;
    if (info != nullptr && (text(*info, "info_kind") == "bridge" || text(*info, "info_kind") == "vlan")) return;
    machine_.interface(name, place(item));
  }

  void read_vlans(const json::Node& item) {
    machine_.has_bridge = true;
    const json::Node* const vlans = item.find("vlans");
    if (!expect(*vlans, json::Kind::array, "an array")) return;
    bool untagged = false;
    for (const json::Node& vlan : vlans->items) {
      const json::Node* const flags = vlan.find("flags");
      const bool is_default = vlan.find("vlan") != nullptr &&
                              vlan.find("vlan")->text == "1";  // of every port, unless somebody takes it away
      if (flags != nullptr && flags->kind == json::Kind::array && !is_default)
        untagged = untagged || std::ranges::any_of(
                                   flags->items, [](const json::Node& flag) { return flag.text == "Egress Untagged"; });
    }
    const std::string name = text(item, "ifname");
    if (!name.empty() && untagged) machine_.interface(name, place(item)).untagged = true;
  }

  const json::Document& document_;
  Machine& machine_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

void read_dump(std::string_view text, const std::string& file, Machine& machine, json::Diagnostics& diagnostics) {
  const auto document = json::parse(text, file, diagnostics);
  if (document) DumpReader(*document, machine, diagnostics).run();
}

}  // namespace takt::interchange::linux_tc
