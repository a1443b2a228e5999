// SPDX-License-Identifier: Apache-2.0
#include "tests/experiments/property/random_scenario.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "sim/random.hpp"

namespace takt::property {
namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(Feature::count)> names = {
    "gates",      "shapers",          "ats",          "preemption", "cut_through",  "policing",  "redundancy",
    "cqf",        "max_sdu",          "queue_limits", "launch",     "frame_errors", "link_down", "crash",
    "stuck_gate", "rerouting",        "babble",       "multicast",  "rates",        "set_gates", "latencies",
    "untagged",   "identity_classes", "overload",     "hold"};

/// Draws for one element of the scenario.
class Draw {
 public:
  Draw(std::uint64_t seed, const std::string& element) : chance_(seed, element, "random scenario") {}
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(chance_.below(n)); }
  bool one_in(std::size_t n) { return below(n) == 0; }
  template <std::size_t N>
  std::string any(const char* const (&values)[N]) {
    return values[below(N)];
  }
  /// Classes of 0 to 7, each with probability 1/n, among `from`.
  std::vector<int> classes(std::size_t n, const std::vector<int>& from = {0, 1, 2, 3, 4, 5, 6, 7}) {
    std::vector<int> set;
    for (const int q : from)
      if (one_in(n)) set.push_back(q);
    return set;
  }

 private:
  sim::RandomStream chance_;
};

std::string in_quotes(const std::string& text) { return "\"" + text + "\""; }
std::string list(const std::vector<int>& numbers) {
  std::string text;
  for (const int number : numbers) text += (text.empty() ? "" : ", ") + std::to_string(number);
  return "[" + text + "]";
}
/// Members of an object, or elements of an array.
class Parts {
 public:
  void add(const std::string& part) { text_ += (text_.empty() ? "" : ", ") + part; }
  void add(const char* key, const std::string& value) { add(in_quotes(key) + ": " + value); }
  bool empty() const { return text_.empty(); }
  std::string object() const { return "{" + text_ + "}"; }
  std::string array() const { return "[" + text_ + "]"; }
  std::string lines() const { return "[\n    " + broken() + "]"; }

 private:
  std::string broken() const {
    std::string text;
    int depth = 0;
    for (std::size_t i = 0; i < text_.size(); ++i) {
      depth += text_[i] == '{' || text_[i] == '[' ? 1 : text_[i] == '}' || text_[i] == ']' ? -1 : 0;
      text += text_[i];
      if (depth == 0 && text_[i] == ',') text += "\n   ";
    }
    return text;
  }
  std::string text_;
};

class Maker {
 public:
  explicit Maker(const Wishes& wishes) : w_(wishes) {}

  std::string make() {
    Parts links = links_and_rates();
    Parts nodes;
    for (std::size_t s = 0; s < w_.switches; ++s) nodes.add(switch_name(s).c_str(), switch_node(s));
    for (std::size_t h = 0; h < w_.hosts; ++h) nodes.add(host_name(h).c_str(), host_node(h));
    Parts streams;
    for (std::size_t s = 0; s < w_.streams; ++s) streams.add(stream(s));
    std::string text = "{\n  \"name\": \"random\", \"seed\": " + std::to_string(w_.seed % 1000) +
                       ", \"duration\": \"4ms\", \"allow_overload\": true,\n  \"network\": {\"nodes\": {\n    ";
    text += nodes.lines().substr(6, nodes.lines().size() - 7) + "},\n   \"links\": " + links.lines() +
            "},\n  \"streams\": " + streams.lines();
    if (const Parts script = script_of(); !script.empty()) text += ",\n  \"script\": " + script.lines();
    if (const Parts faults = faults_of(); !faults.empty()) {
      text += ",\n  \"faults\": " + faults.lines();
      if (has(Feature::rerouting))
        text += ",\n  \"rerouting\": " + in_quotes(Draw(w_.seed, "rerouting").any({"0ns", "10us", "200us", "1ms"}));
    }
    return text + "\n}\n";
  }

 private:
  bool has(Feature feature) const {
    return std::find(w_.features.begin(), w_.features.end(), feature) != w_.features.end();
  }
  static std::string switch_name(std::size_t s) { return "sw" + std::to_string(s); }
  static std::string host_name(std::size_t h) { return "h" + std::to_string(h); }
  static std::string stream_name(std::size_t s) { return "s" + std::to_string(s); }
  std::size_t switch_of(std::size_t host) const { return host % w_.switches; }
  bool is_ring() const { return w_.switches > 2; }

  Parts links_and_rates() {
    Parts links;
    const auto link = [&](const std::string& a, const std::string& b) {
      Draw draw(w_.seed, "link " + a + " " + b);
      Parts one;
      one.add("ends", "[" + in_quotes(a) + ", " + in_quotes(b) + "]");
      std::string rate = "100Mbps";
      if (has(Feature::rates)) rate = draw.any({"10Mbps", "100Mbps", "100Mbps", "1Gbps"});
      slow_ = slow_ || rate == "10Mbps";
      one.add("rate", in_quotes(rate));
      one.add("delay", in_quotes(draw.any({"0ns", "50ns", "500ns", "3us"})));
      links.add(one.object());
      if (a.starts_with("sw") && b.starts_with("sw"))
        trunks_.push_back("[" + in_quotes(a) + ", " + in_quotes(b) + "]");
      else
        edges_.push_back("[" + in_quotes(a) + ", " + in_quotes(b) + "]");
    };
    for (std::size_t s = 1; s < w_.switches; ++s) link(switch_name(s - 1), switch_name(s));
    if (is_ring()) link(switch_name(w_.switches - 1), switch_name(0));
    for (std::size_t h = 0; h < w_.hosts; ++h) link(host_name(h), switch_name(switch_of(h)));
    return links;
  }

  std::string gate_entry(Draw& draw, const std::vector<int>& open, const std::string& duration) const {
    Parts entry;
    entry.add("open", list(open));
    entry.add("for", in_quotes(duration));
    if (has(Feature::hold) && draw.one_in(2)) entry.add("mac", in_quotes(draw.any({"hold", "release"})));
    return entry.object();
  }
  /// Some entries, then one that is open to all and long enough for the longest frame.
  std::string gates(const std::string& element) const {
    Draw draw(w_.seed, "gates " + element);
    Parts entries;
    const std::size_t count = draw.below(5);
    for (std::size_t i = 0; i < count; ++i)
      entries.add(
          gate_entry(draw, draw.classes(2), draw.any({"5us", "10us", "20us", "50us", "12360ns", "123360ns", "1ns"})));
    entries.add(gate_entry(draw, {0, 1, 2, 3, 4, 5, 6, 7}, slow_ ? "1300us" : draw.any({"130us", "125us", "200us"})));
    if (draw.one_in(2)) entries.add(gate_entry(draw, draw.classes(2), "30us"));
    Parts all;
    all.add("entries", entries.array());
    all.add("base_time", in_quotes(draw.any({"0ns", "0ns", "-1ms", "37us", "500us", "-123456789ps"})));
    if (draw.one_in(3)) all.add("extension", in_quotes(draw.any({"20us", "100us", "1ms"})));
    if (draw.one_in(4)) all.add("cycle", in_quotes(slow_ ? "3ms" : draw.any({"1ms", "500us", "700us"})));
    return all.object();
  }

  std::string egress(const std::string& element, bool is_switch) const {
    Draw draw(w_.seed, "egress " + element);
    std::vector<int> ats, preemptable, shaped, cut;
    const std::vector<int> any_ats = draw.classes(3), any_preemptable = draw.classes(2), any_shaped = draw.classes(3),
                           any_cut = draw.classes(2);
    const auto without = [](std::vector<int> from, const std::vector<int>& what) {
      std::erase_if(from, [&](int q) { return std::find(what.begin(), what.end(), q) != what.end(); });
      return from;
    };
    if (has(Feature::ats) && is_switch) ats = any_ats;
    if (has(Feature::preemption) || has(Feature::hold))
      preemptable = any_preemptable.empty() ? std::vector<int>{0, 1} : any_preemptable;
    if (has(Feature::shapers)) shaped = without(any_shaped, ats);
    if (has(Feature::cut_through) && is_switch) cut = without(without(any_cut, ats), preemptable);
    Parts parts;
    if ((has(Feature::gates) || has(Feature::hold)) && !(has(Feature::cqf) && is_switch) && !draw.one_in(5))
      parts.add("gates", gates(element));
    Parts shapers;
    // Over a whole cycle of which the gate is open for a part a slope is several times as steep.
    const bool gated = has(Feature::gates) || has(Feature::hold) || has(Feature::cqf) || has(Feature::set_gates);
    for (const int q : shaped)
      shapers.add("{\"class\": " + std::to_string(q) + ", \"idle_slope\": " +
                  in_quotes(gated && !slow_ ? draw.any({"3Mbps", "7Mbps", "10Mbps", "10666667bps"})
                            : slow_         ? draw.any({"1Mbps", "3Mbps", "2500000bps"})
                                            : draw.any({"10Mbps", "33Mbps", "7Mbps", "20Mbps", "75Mbps"})) +
                  ", \"of\": " + in_quotes(draw.any({"cycle", "window"})) + "}");
    if (!shapers.empty()) parts.add("shapers", shapers.array());
    if (!ats.empty()) parts.add("ats", list(ats));
    if (!preemptable.empty()) {
      Parts preemption;
      preemption.add("preemptable", list(preemptable));
      preemption.add("add_frag_size", std::to_string(draw.below(4)));
      if (draw.one_in(4)) preemption.add("hold_advance", in_quotes(draw.any({"0ns", "5us", "30us"})));
      if (draw.one_in(4)) preemption.add("release_advance", in_quotes(draw.any({"1us", "10us"})));
      parts.add("preemption", preemption.object());
    }
    if (!cut.empty()) parts.add("cut_through", list(cut));
    if (has(Feature::max_sdu))
      parts.add("max_sdu", "[{\"class\": " + std::to_string(draw.below(8)) +
                               ", \"size\": " + in_quotes(draw.any({"100B", "500B", "1000B"})) +
                               "}, {\"class\": 0, \"size\": \"1200B\"}]");
    return parts.empty() ? "" : parts.object();
  }

  std::string queues(const std::string& element) const {
    Draw draw(w_.seed, "queues " + element);
    Parts parts;
    if (draw.one_in(2)) parts.add("frames", std::to_string(1 + draw.below(4)));
    if (draw.one_in(2)) parts.add("octets", in_quotes(draw.any({"700B", "2000B", "3100B"})));
    if (Draw(w_.seed, "drop " + element).one_in(3)) parts.add("drop", "\"oldest\"");
    return parts.object();
  }

  std::string ingress(std::size_t s) const {
    Draw draw(w_.seed, "ingress " + switch_name(s));
    Parts parts, filters, schedulers, gate_lists, meters;
    for (std::size_t i = 0; i < w_.streams; ++i) {
      Draw mine(w_.seed, "filter " + switch_name(s) + stream_name(i));
      Parts filter;
      filter.add("stream", in_quotes(stream_name(i)));
      const bool polices = has(Feature::policing) && !mine.one_in(3);
      if (polices && mine.one_in(3)) filter.add("max_sdu", in_quotes(mine.any({"200B", "600B", "1400B"})));
      if (polices && mine.one_in(2))
        filter.add("gate", in_quotes(mine.any({"g0", "g1"})));
      else if (has(Feature::cqf) && mine.one_in(2))
        filter.add("gate", "\"cqf\"");
      if (polices && mine.one_in(2)) filter.add("meter", in_quotes(mine.any({"m0", "m1"})));
      if (has(Feature::ats) && !mine.one_in(4)) filter.add("ats", in_quotes("a" + std::to_string(mine.below(3))));
      filters.add(filter.object());
    }
    if (has(Feature::ats)) {
      for (int i = 0; i < 3; ++i)
        schedulers.add("{\"name\": \"a" + std::to_string(i) + "\", \"rate\": " +
                       in_quotes(slow_ ? draw.any({"1Mbps", "3Mbps"}) : draw.any({"5Mbps", "12Mbps", "33333333bps"})) +
                       ", \"burst\": " + in_quotes(draw.any({"1550B", "2000B", "5000B"})) + ", \"length\": " +
                       in_quotes(draw.any({"wire", "frame"})) + (draw.one_in(3) ? ", \"group\": \"all\"" : "") + "}");
      parts.add("ats", schedulers.array());
      parts.add("ats_groups", "[{\"name\": \"all\", \"max_residence_time\": \"800us\"}]");
      if (draw.one_in(2)) parts.add("max_residence_time", in_quotes(draw.any({"100us", "500us", "2ms"})));
    }
    if (has(Feature::policing)) {
      for (int i = 0; i < 2; ++i) {
        Parts entries;
        const std::size_t count = 1 + draw.below(3);
        for (std::size_t e = 0; e < count; ++e) {
          const bool open = e == 0 || draw.one_in(2);
          entries.add(std::string("{\"open\": ") + (open ? "true" : "false") +
                      ", \"for\": " + in_quotes(draw.any({"40us", "100us", "77us"})) +
                      (open && draw.one_in(2) ? ", \"ipv\": " + std::to_string(draw.below(8)) : "") +
                      (open && draw.one_in(3) ? ", \"octets\": \"1600B\"" : "") + "}");
        }
        gate_lists.add("{\"name\": \"g" + std::to_string(i) + "\", \"entries\": " + entries.array() +
                       ", \"base_time\": " + in_quotes(draw.any({"0ns", "13us", "-5us"})) +
                       (draw.one_in(5) ? ", \"block_invalid_rx\": true" : "") +
                       (draw.one_in(5) ? ", \"block_octets_exceeded\": true" : "") + "}");
        meters.add("{\"name\": \"m" + std::to_string(i) +
                   "\", \"cir\": " + in_quotes(slow_ ? "2Mbps" : draw.any({"5Mbps", "20Mbps"})) +
                   ", \"cbs\": \"1600B\", \"eir\": " + in_quotes(slow_ ? "1Mbps" : draw.any({"3Mbps", "0bps"})) +
                   ", \"ebs\": \"1600B\"" + (draw.one_in(2) ? ", \"drop_on_yellow\": true" : "") +
                   (draw.one_in(2) ? ", \"coupling\": true" : "") + (draw.one_in(2) ? ", \"color_aware\": true" : "") +
                   (draw.one_in(6) ? ", \"block_red\": true" : "") + "}");
      }
      parts.add("gates", gate_lists.array());
      parts.add("meters", meters.array());
    }
    if (!filters.empty()) parts.add("filters", filters.array());
    if (has(Feature::cqf)) {
      Draw all(w_.seed, "cqf");
      parts.add("cqf", "{\"cycle\": " + in_quotes(slow_ ? "2ms" : all.any({"250us", "300us"})) +
                           ", \"classes\": " + (all.one_in(2) ? "[5, 6]" : "[4, 5, 6]") + ", \"pcp\": [5, 6]}");
    }
    return parts.object();
  }

  std::string switch_node(std::size_t s) const {
    const std::string name = switch_name(s);
    Draw draw(w_.seed, "node " + name);
    Parts node, egresses;
    node.add("kind", "\"switch\"");
    node.add("forwarding_delay", in_quotes(draw.any({"0ns", "1us", "500ns", "3us"})));
    if (Draw jitter(w_.seed, "jitter " + name); !has(Feature::cut_through) && !has(Feature::cqf) &&
                                                !has(Feature::policing) && !has(Feature::ats) && jitter.one_in(4))
      node.add("forwarding_jitter",
               "{\"uniform\": {\"from\": \"10ns\", \"to\": " + in_quotes(jitter.any({"170ns", "5us", "20us"})) + "}}");
    if (has(Feature::identity_classes)) node.add("traffic_classes", "\"identity\"");
    if (has(Feature::queue_limits)) node.add("queues", queues(name));
    if (const std::string all = egress(name, true); !all.empty()) egresses.add(all);
    if (has(Feature::untagged) && draw.one_in(2)) {
      for (std::size_t h = 0; h < w_.hosts; ++h)
        if (switch_of(h) == s)
          egresses.add("{\"to\": " + in_quotes(host_name(h)) + ", \"untagged\": true" +
                       (has(Feature::gates) && !has(Feature::cqf) ? ", \"gates\": " + gates(name + host_name(h)) : "") +
                       "}");
    }
    if (!egresses.empty()) node.add("egress", egresses.array());
    if (has(Feature::ats) || has(Feature::policing) || has(Feature::cqf)) node.add("ingress", ingress(s));
    return node.object();
  }

  std::string host_node(std::size_t h) const {
    const std::string name = host_name(h);
    Draw draw(w_.seed, "node " + name);
    Parts node;
    node.add("kind", "\"host\"");
    if (has(Feature::latencies))
      node.add("os", "{\"transmit\": " + draw.any({"\"2us\"", "{\"uniform\": {\"from\": \"0ns\", \"to\": \"20us\"}}"}) +
                         ", \"receive\": " + draw.any({"\"3us\"", "{\"exponential\": {\"mean\": \"5us\"}}"}) + "}");
    if (has(Feature::identity_classes) && draw.one_in(2)) node.add("traffic_classes", "\"identity\"");
    if (has(Feature::queue_limits) && draw.one_in(2)) node.add("queues", queues(name));
    const std::string all = egress(name, false);
    if (!all.empty() && draw.one_in(2))
      node.add("egress", "[" + all + "]");
    else if (const std::string shaped = talker_ats(h); !shaped.empty()) {
      node.add("egress", "[{\"ats\": [0, 1, 2, 3, 4, 5, 6, 7]}]");
      node.add("ats", shaped);
    }
    return node.object();
  }

  /// Schedulers for some of what the host sends; nothing if there are none, or something else would select frames.
  std::string talker_ats(std::size_t h) const {
    Draw draw(w_.seed, "talker ats " + host_name(h));
    if (!has(Feature::ats) || has(Feature::shapers) || has(Feature::launch) || draw.one_in(3)) return "";
    Parts schedulers;
    for (std::size_t s = 0; s < w_.streams; ++s) {
      if (talker_of(s) != h || draw.one_in(4)) continue;
      schedulers.add("{\"stream\": " + in_quotes(stream_name(s)) + ", \"rate\": " +
                     in_quotes(slow_ ? draw.any({"1Mbps", "3Mbps"}) : draw.any({"4Mbps", "10Mbps", "33333333bps"})) +
                     ", \"burst\": " + in_quotes(draw.any({"1550B", "2000B", "4000B"})) +
                     ", \"length\": " + in_quotes(draw.any({"wire", "frame"})) + "}");
    }
    return schedulers.empty() ? "" : schedulers.array();
  }

  std::size_t talker_of(std::size_t s) const { return Draw(w_.seed, "stream " + stream_name(s)).below(w_.hosts); }

  std::string stream(std::size_t s) const {
    Draw draw(w_.seed, "stream " + stream_name(s));
    Parts parts;
    const std::size_t from = draw.below(w_.hosts);  // talker_of(s)
    const std::size_t to = (from + 1 + draw.below(w_.hosts - 1)) % w_.hosts;
    parts.add("name", in_quotes(stream_name(s)));
    parts.add("from", in_quotes(host_name(from)));
    const bool redundant = has(Feature::redundancy) && is_ring() && switch_of(from) != switch_of(to) && !draw.one_in(3);
    std::string receivers = in_quotes(host_name(to));
    if (has(Feature::multicast) && !redundant)
      for (std::size_t h = 0; h < w_.hosts; ++h)
        if (h != from && h != to && draw.one_in(2)) receivers += ", " + in_quotes(host_name(h));
    parts.add("to", "[" + receivers + "]");
    parts.add("payload", in_quotes(draw.any({"18B", "60B", "100B", "200B", "500B", "900B", "1200B", "1400B"})));
    if (draw.one_in(4)) parts.add("encapsulation", "\"ethernet\"");
    if (!draw.one_in(6)) parts.add("pcp", std::to_string(draw.below(8)));
    bool is_periodic = false;
    switch (draw.below(4)) {
      case 0:
        if (Draw gaps(w_.seed, "gaps " + stream_name(s)); gaps.one_in(2))
          parts.add("normal", "{\"mean\": " + in_quotes(gaps.any({"400us", "700us"})) +
                                  ", \"deviation\": " + in_quotes(gaps.any({"1us", "100us", "1ms"})) +
                                  ", \"min\": " + in_quotes(gaps.any({"120us", "250us", "399us"})) +
                                  (gaps.one_in(2) ? ", \"max\": \"900us\"" : "") + "}");
        else
          parts.add("exponential", in_quotes(draw.any({"100us", "200us", "500us"})));
        break;
      case 1:
        parts.add("burst", "{\"frames\": " + std::to_string(1 + draw.below(6)) + ", \"every\": \"1ms\", \"spacing\": " +
                               in_quotes(draw.any({"0ns", "6720ns", "50us"})) + "}");
        break;
      default:
        is_periodic = true;
        parts.add("every", in_quotes(draw.any({"100us", "125us", "250us", "333us", "1ms"})));
        if (draw.one_in(2)) parts.add("jitter", in_quotes(draw.any({"10us", "100us"})));
        if (has(Feature::launch) && draw.one_in(2)) parts.add("launch", in_quotes(draw.any({"0ns", "10us", "100us"})));
    }
    if (draw.one_in(2))
      parts.add("offset", in_quotes(draw.any({"1us", "10us", "100us", "37us"})));
    else if (Draw chosen(w_.seed, "offset " + stream_name(s)); is_periodic && chosen.one_in(2))
      parts.add("offset", in_quotes("auto"));
    if (redundant)
      parts.add("redundancy",
                "{\"count\": 2, \"history\": " + std::to_string(2 + draw.below(30)) + ", \"reset_timeout\": " +
                    in_quotes(draw.any({"1ms", "200us", "1s"})) + (draw.one_in(4) ? ", \"individual\": true" : "") +
                    (draw.one_in(4) ? ", \"algorithm\": \"match\"" : "") +
                    (draw.one_in(4) ? ", \"keep_tag\": true" : "") +
                    (draw.one_in(4) ? ", \"split\": " + in_quotes(switch_name(switch_of(from))) : "") + "}");
    return parts.object();
  }

  std::string port_of_a_switch(Draw& draw) const {
    const std::size_t s = draw.below(w_.switches);
    return "\"node\": " + in_quotes(switch_name(s)) +
           (w_.switches > 1 && draw.one_in(2) ? ", \"to\": " + in_quotes(switch_name(s == 0 ? 1 : s - 1)) : "");
  }
  Parts script_of() const {
    Parts script;
    if (!has(Feature::set_gates)) return script;
    Draw draw(w_.seed, "script");
    const std::size_t count = 1 + draw.below(3);
    for (std::size_t i = 0; i < count; ++i)
      script.add("{\"at\": " + in_quotes(draw.any({"300us", "1ms", "1100us", "1234567ns", "2ms"})) +
                 ", \"set_gates\": {" + port_of_a_switch(draw) +
                 ", \"gates\": " + gates("script " + std::to_string(i)) + "}}");
    return script;
  }
  std::string when(Draw& draw) const {
    return "\"at\": " + in_quotes(draw.any({"0ns", "500us", "777us", "1ms", "1500us"})) +
           (draw.one_in(3) ? "" : ", \"for\": " + in_quotes(draw.any({"10us", "300us", "1ms"})));
  }
  std::string any_link(Draw& draw) const {
    const std::size_t n = draw.below(trunks_.size() + edges_.size());
    return n < trunks_.size() ? trunks_[n] : edges_[n - trunks_.size()];
  }
  Parts faults_of() const {
    Parts faults;
    Draw draw(w_.seed, "faults");
    const auto repeat = [&](Feature feature, const auto& make) {
      if (!has(feature)) return;
      const std::size_t count = 1 + draw.below(2);
      for (std::size_t i = 0; i < count; ++i) faults.add(make());
    };
    repeat(Feature::link_down,
           [&] { return "{\"kind\": \"link-down\", \"link\": " + any_link(draw) + ", " + when(draw) + "}"; });
    repeat(Feature::crash, [&] {
      return "{\"kind\": \"crash\", \"node\": " +
             in_quotes(draw.one_in(2) ? switch_name(draw.below(w_.switches)) : host_name(draw.below(w_.hosts))) + ", " +
             when(draw) + "}";
    });
    repeat(Feature::frame_errors, [&] {
      return "{\"kind\": \"frame-errors\", \"link\": " + any_link(draw) + ", " +
             draw.any({"\"loss\": 0.1", "\"corruption\": 0.2", "\"duplication\": 0.2",
                       "\"loss\": 0.05, \"corruption\": 0.05, \"duplication\": 0.05", "\"bit_error_rate\": 0.00001"}) +
             ", " + when(draw) + "}";
    });
    repeat(Feature::stuck_gate, [&] {
      return "{\"kind\": \"stuck-gate\", " + port_of_a_switch(draw) + ", \"class\": " + std::to_string(draw.below(8)) +
             ", \"state\": " + in_quotes(draw.any({"open", "closed"})) + ", " + when(draw) + "}";
    });
    repeat(Feature::babble, [&] {
      return "{\"kind\": \"babble\", \"stream\": " + in_quotes(stream_name(draw.below(w_.streams))) + ", " +
             when(draw) + (draw.one_in(2) ? ", \"every\": \"20us\"" : "") + "}";
    });
    return faults;
  }

  const Wishes& w_;
  bool slow_ = false;
  std::vector<std::string> trunks_, edges_;
};

}  // namespace

std::string_view name_of(Feature feature) { return names[static_cast<std::size_t>(feature)]; }

std::string scenario_text(const Wishes& wishes) { return Maker(wishes).make(); }

}  // namespace takt::property
