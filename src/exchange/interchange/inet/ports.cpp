// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numeric>
#include <set>

#include "interchange/inet/gate_circles.hpp"
#include "interchange/inet/reader.hpp"

namespace takt::interchange::inet {
namespace {

/// The class of each priority where there are so many classes: IEEE 802.1Q, table 8-5.
constexpr std::array<std::array<std::uint8_t, 8>, 8> class_of_priority = {{{0, 0, 0, 0, 0, 0, 0, 0},
                                                                           {0, 0, 0, 0, 1, 1, 1, 1},
                                                                           {0, 0, 0, 0, 1, 1, 2, 2},
                                                                           {0, 0, 1, 1, 2, 2, 3, 3},
                                                                           {0, 0, 1, 1, 2, 2, 3, 4},
                                                                           {1, 0, 2, 2, 3, 3, 4, 5},
                                                                           {1, 0, 2, 3, 4, 4, 5, 6},
                                                                           {1, 0, 2, 3, 4, 5, 6, 7}}};

}  // namespace

void InetReader::read_filters(const Submodule& node, scenario::Relay& relay) {
  const std::string ingress = node.name + ".bridging.streamFilter.ingress.";
  const std::uint64_t count = number(ingress + "numStreams", 1024).value_or(0);
  const auto classifier = value(ingress + "classifier.mapping", json::Kind::object, "{\"s\": 0, ..}");
  if (!classifier)
    return error(node.place, "filters without streams", json::quote(node.name),
                 "bridging.streamFilter.ingress.classifier.mapping");
  scenario::Ingress made = relay.ingress.value_or(scenario::Ingress{});
  for (const json::Member& each : classifier->members) {
    const std::string index = "[" + each.value.text + "].";
    const std::string meter = ingress + "meter" + index;
    const auto type = text(meter + "typename");
    const auto filter = text(ingress + "filter" + index + "typename");
    const json::Place place = line(ingress + "classifier.mapping")->place;
    std::vector<std::string> meant;
    for (const scenario::Stream& stream : scenario_.streams)
      if (identity_of_stream_[stream.name] == each.key) meant.push_back(stream.name);
    if (meant.empty()) {
      imported_.remark(RemarkKind::ignored, place, "a filter of " + json::quote(each.key) + ", which no stream is");
      continue;
    }
    if (!type) {
      error(place, "a filter without a meter", meter + "typename", "EligibilityTimeMeter or SingleRateTwoColorMeter");
      continue;
    }
    const IniLine* const cir = line(meter + "committedInformationRate");
    const IniLine* const cbs = line(meter + "committedBurstSize");
    const auto committed = cir == nullptr ? std::nullopt : rate(cir->value, cir->place);
    const auto burst = cbs == nullptr ? std::nullopt : octets(cbs->value, cbs->place);
    if (!committed || !burst) {
      error(place, "a meter without a rate and a burst", meter, "committedInformationRate and committedBurstSize");
      continue;
    }
    scenario::StreamFilterEntry entry;
    entry.stream = each.key;
    if (*type == "EligibilityTimeMeter") {
      entry.ats = each.key;
      scenario::AtsEntry scheduler;
      scheduler.name = each.key;
      scheduler.rate = *committed;
      scheduler.burst = *burst;
      scheduler.length = scenario::LengthOf::frame;
      made.ats.push_back(std::move(scheduler));
      if (const auto longest = duration(meter + "maxResidenceTime")) made.max_residence_time = *longest;
    } else if (*type == "SingleRateTwoColorMeter") {
      entry.meter = each.key;
      scenario::Meter token;
      token.name = each.key;
      token.cir = *committed;
      token.cbs = *burst;
      made.meters.push_back(std::move(token));
    } else {
      error(line(meter + "typename")->place, "a meter that takt has no model for", json::quote(*type),
            "EligibilityTimeMeter or SingleRateTwoColorMeter");
    }
    static_cast<void>(filter);
    for (const std::string& name : meant) {
      entry.stream = name;
      made.filters.push_back(entry);
    }
  }
  static_cast<void>(count);
  relay.ingress = std::move(made);
}

void InetReader::read_port(const Submodule& node, std::uint32_t eth, const std::string& peer, bool is_shaped,
                           scenario::NodePorts& ports) {
  const std::string queue = node.name + ".eth[" + std::to_string(eth) + "].macLayer.queue.";
  const std::size_t count = std::clamp<std::size_t>(number(queue + "numTrafficClasses", 8).value_or(8), 1, 8);
  scenario::Egress egress;
  egress.to = peer;
  if (count == 8)
    read_map(queue, ports);
  else
    value(queue + "classifier.mapping", json::Kind::array, "a row for each priority");
  read_gates(queue, count, egress);
  for (std::uint8_t q = 0; q < count; ++q) {
    const std::string algorithm = queue + "transmissionSelectionAlgorithm[" + std::to_string(q) + "].";
    const IniLine* const type = line(algorithm + "typename");
    const IniLine* const slope = line(algorithm + "idleSlope");
    const bool shapes_credit = type != nullptr && type->value == "\"Ieee8021qCreditBasedShaper\"",
               shapes_times = type != nullptr && type->value == "\"Ieee8021qAsynchronousShaper\"";
    if (type != nullptr && !shapes_credit && !shapes_times)
      error(type->place, "an algorithm that is not read", type->value,
            "Ieee8021qCreditBasedShaper or Ieee8021qAsynchronousShaper");
    else if (shapes_credit && slope == nullptr)
      error(type->place, "a shaper without a slope", type->key, "idleSlope");
    else if (shapes_credit) {
      if (const auto own = class_of(q, count, type->place); own)
        if (const auto parsed = rate(slope->value, slope->place))
          egress.shapers.push_back({{}, *own, *parsed, scenario::SlopeOf::window});
    } else if (shapes_times) {
      if (const auto own = class_of(q, count, type->place); own) egress.ats.push_back(*own);
    }
    line(queue + "queue[" + std::to_string(q) + "].typename");
    if (count == 8) read_limits(queue, q, ports);
  }
  const bool is_shaping = egress.gates || !egress.shapers.empty() || !egress.ats.empty();
  if (node.type.find("Switch") != std::string::npos && truth(node.name + ".hasCutthroughSwitching"))
    egress.cut_through = {0, 1, 2, 3, 4, 5, 6, 7};
  const bool says_something = is_shaping || !egress.cut_through.empty();
  if (is_shaping && !is_shaped)
    error(node.place, "gates or shapers of a node without traffic shaping", json::quote(node.name),
          "*." + node.name + ".hasEgressTrafficShaping = true");
  if (says_something) ports.egress.push_back(std::move(egress));
}

/// A configurator that lays out gates: takt does it, for the streams that it names.
void InetReader::read_schedule() {
  const IniLine* const type = line("gateScheduleConfigurator.typename");
  if (type == nullptr || type->value == "\"\"" || type->value == "\"AlwaysOpenGateScheduleConfigurator\"") return;
  line("gateScheduleConfigurator.gateCycleDuration");
  const auto entries = value("gateScheduleConfigurator.configuration", json::Kind::array,
                             "[{pcp: N, source: \"a\", destination: \"b\", maxLatency: 1ms, ..}, ..]");
  if (!entries) return;
  const json::Place place = line("gateScheduleConfigurator.configuration")->place;
  imported_.remark(
      RemarkKind::changed, place,
      "gates that " + type->value + " would lay out: takt lays them out and chooses the offsets, by its own cycle");
  std::set<std::uint8_t> classes;
  for (const json::Node& entry : entries->items) {
    const json::Node* const source = entry.find("source");
    const json::Node* const destination = entry.find("destination");
    const json::Node* const pcp = entry.find("pcp");
    if (source == nullptr || destination == nullptr) {
      error(place, "a stream of the gates that is not read", json::compact(entry).substr(0, 80),
            "source and destination");
      continue;
    }
    const auto stream = std::ranges::find_if(scenario_.streams, [&](const scenario::Stream& each) {
      return each.from == source->text && each.to.names.front() == destination->text &&
             (pcp == nullptr || std::to_string(each.pcp.value_or(0)) == pcp->text) &&
             !(each.offset && each.offset->is_auto);
    });
    if (stream == scenario_.streams.end()) {
      error(place, "a stream of the gates that nobody sends", json::quote(source->text + " to " + destination->text),
            "an application with that destination and priority");
      continue;
    }
    if (stream->every > Duration()) stream->offset.emplace().is_auto = true;
    classes.insert(class_of_priority[7][stream->pcp.value_or(0)]);
    if (const json::Node* const latency = entry.find("maxLatency"); latency != nullptr)
      if (const auto longest = duration(latency->text, place)) {
        scenario::Requirement requirement;
        requirement.stream = stream->name;
        requirement.latency.emplace().at_most = *longest;
        scenario_.require.push_back(std::move(requirement));
      }
  }
  auto& gates = scenario_.gates.emplace();
  gates.plan = scenario::GatePlanning::automatic;
  gates.classes.assign(classes.begin(), classes.end());
}

std::vector<std::uint8_t> InetReader::classes_of(std::size_t q, std::size_t count) {
  std::vector<std::uint8_t> classes;
  for (std::size_t p = 0; p < 8; ++p)
    if (class_of_priority[count - 1][p] == q) classes.push_back(class_of_priority[7][p]);
  std::ranges::sort(classes);
  return classes;
}

std::optional<std::uint8_t> InetReader::class_of(std::size_t q, std::size_t count, const json::Place& place) {
  const std::vector<std::uint8_t> classes = classes_of(q, count);
  if (classes.size() == 1) return classes.front();
  std::set<std::uint8_t> used;
  for (const scenario::Stream& stream : scenario_.streams)
    if (const std::uint8_t own = class_of_priority[7][stream.pcp.value_or(0)];
        std::ranges::find(classes, own) != classes.end())
      used.insert(own);
  if (used.size() == 1) return *used.begin();
  if (used.empty())
    imported_.remark(RemarkKind::ignored, place, "the shaper of a class that no stream is in");
  else
    error(place, "one shaper for several queues",
          "class " + std::to_string(q) + " of " + std::to_string(count) + ", with " + std::to_string(used.size()) +
              " priorities that streams have",
          "one priority, as takt's queues have");
  return std::nullopt;
}

void InetReader::read_map(const std::string& queue, scenario::NodePorts& ports) {
  const auto mapping = value(queue + "classifier.mapping", json::Kind::array, "a row for each priority");
  if (!mapping) return;
  std::string column;
  for (const json::Node& row : mapping->items)
    column += row.kind == json::Kind::array && row.items.size() == 8 ? row.items[7].text : "?";
  if (column == "01234567")
    ports.traffic_classes = scenario::TrafficClasses::identity;
  else if (column != "10234567")
    error(line(queue + "classifier.mapping")->place, "a map from priorities to classes that takt does not have",
          json::quote(column), "10234567 or 01234567 in the column of eight classes");
}

void InetReader::read_limits(const std::string& queue, std::uint8_t q, scenario::NodePorts& ports) {
  const std::string prefix = queue + "queue[" + std::to_string(q) + "].";
  const auto frames = number(prefix + "packetCapacity", 0xFFFF'FFFE);
  const IniLine* const octets = line(prefix + "dataCapacity");
  if (!frames && octets == nullptr) return;
  scenario::Queues::PerClass limit;
  limit.traffic_class = q;
  if (frames) limit.frames = static_cast<std::uint32_t>(*frames);
  if (octets != nullptr) {
    if (const auto parsed = this->octets(octets->value, octets->place)) limit.octets = *parsed;
  }
  const auto other = std::ranges::find(ports.queues.classes, q, &scenario::Queues::PerClass::traffic_class);
  if (other == ports.queues.classes.end())
    ports.queues.classes.push_back(limit);
  else if (!(*other == limit))
    error(octets != nullptr ? octets->place : line(prefix + "packetCapacity")->place,
          "limits that differ from port to port", "class " + std::to_string(q),
          "the same for all ports of a node, as takt has it");
}

void InetReader::read_gates(const std::string& queue, std::size_t count, scenario::Egress& egress) {
  std::array<ClassGate, 8> gates;
  std::int64_t cycle = 1;
  bool any = false;
  for (std::size_t own = 0; own < count; ++own) {
    const std::vector<std::uint8_t> classes =
        count == 8 ? std::vector<std::uint8_t>{static_cast<std::uint8_t>(own)} : classes_of(own, count);
    const std::size_t q = own;
    const std::string gate = queue + "transmissionGate[" + std::to_string(q) + "].";
    const IniLine* const durations = line(gate + "durations");
    ClassGate made;
    const auto keep = [&] {
      for (const std::uint8_t c : classes) gates[c] = made;
    };
    made.initially = truth(gate + "initiallyOpen", true);
    if (const auto offset = duration(gate + "offset")) made.offset = offset->ps();
    if (!truth(gate + "enableImplicitGuardBand", true))
      error(line(gate + "enableImplicitGuardBand")->place, "gates that do not look at lengths", "false",
            "true, as takt's gates");
    any = any || !made.initially;
    keep();
    const auto list = value(gate + "durations", json::Kind::array, "a list of times");
    if (!list) continue;
    for (const json::Node& item : list->items) {
      const auto length = duration(item.text, durations->place);
      made.durations.push_back(length ? length->ps() : 1);
      made.sum += made.durations.back();
      if (made.durations.back() <= 0 || made.sum > 3'600'000'000'000'000) {
        error(durations->place, "not a duration of a gate", json::quote(item.text),
              "more than 0, in all at most an hour");
        return;
      }
    }
    if (made.durations.size() % 2 != 0) {
      error(durations->place, "an odd number of durations", std::to_string(made.durations.size()),
            "an even number, so that the cycle ends as it began");
      return;
    }
    keep();
    if (made.sum > 0) {
      any = true;
      cycle = cycle == 1 ? made.sum : std::lcm(cycle, made.sum);
      if (cycle > 3'600'000'000'000'000) {
        error(durations->place, "cycles without a common one of at most an hour", std::to_string(made.sum) + " ps",
              "cycles that go into each other");
        return;
      }
    }
  }
  if (!any || diagnostics_.has_errors()) return;
  scenario::Gates made = one_list(gates, cycle == 1 ? 1'000'000'000 : cycle);
  if (made.entries.size() > 1024) {
    error(line(queue + "transmissionGate[0].durations") != nullptr
              ? line(queue + "transmissionGate[0].durations")->place
              : network_.place,
          "a gate list that takt does not have", std::to_string(made.entries.size()) + " entries", "at most 1024");
    return;
  }
  if (made.entries.size() == 1 && made.entries.front().open.size() == 8) return;
  egress.gates = std::move(made);
}

}  // namespace takt::interchange::inet
