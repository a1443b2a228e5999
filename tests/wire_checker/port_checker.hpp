// SPDX-License-Identifier: Apache-2.0
// One direction of a link as the rules see it: what may start, when, for how long. Fed with the trace records of its
// port.
//
// Within an instant: begin(), changes of the script, advance_gates(), the records in their order, end().
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "models/egress/port_config.hpp"
#include "models/ethernet/traffic.hpp"
#include "tests/wire_checker/credit_account.hpp"
#include "tests/wire_checker/list_machine.hpp"
#include "tests/wire_checker/share_account.hpp"
#include "tests/wire_checker/violations.hpp"

namespace takt::wire_checker {

/// A frame as it stood in a trace record.
struct SeenFrame {
  models::FrameIndex handle;
  models::Frame frame;
  Ps eligible = long_ago;       ///< counts in timed classes
  bool is_cut_through = false;  ///< only its header has come
};

class PortChecker {
 public:
  PortChecker(std::string name, const models::PortConfig& config, sim::DataRate rate, Violations& violations);

  // The script, between begin() and advance_gates().
  void request_gates(const ListConfig& gates);
  void force_gate(models::TrafficClass q, std::optional<bool> open);
  void set_up(bool up) { up_ = up; }

  void begin(Ps now);
  void advance_gates();
  void started(const SeenFrame& seen, models::TransmissionDetail detail);
  void enqueued(const SeenFrame& seen, models::TrafficClass q);
  void dequeued(const SeenFrame& seen, models::TrafficClass q);
  void cut(const SeenFrame& seen, models::TransmissionDetail detail);
  void resumed(const SeenFrame& seen, models::TransmissionDetail detail);
  /// True if the frame has waited here, or was the rest of one that had been cut.
  bool dropped(models::FrameIndex handle, models::DropReason reason);
  /// It never came to wait.
  void refused(const SeenFrame& seen, models::DropReason reason);
  void end();
  /// After end(): of a frame of which only the header is here, whether nothing kept it from being cut through.
  bool could_cut_through(const models::Frame& frame, models::Priority priority) const;
  /// Nothing happens any more up to and at `now`.
  void finish(Ps now);

  Ps octet_time() const { return octet_; }
  Ps last_bit() const { return last_bit_; }
  bool is_preemptable(models::TrafficClass q) const {
    return config_.preemption && models::contains(config_.preemption->preemptable, q);
  }
  const models::PortConfig& config() const { return config_; }
  const std::string& name() const { return name_; }
  bool has_rest_of(models::FrameIndex handle) const { return rest_ && rest_->item.handle == handle; }
  bool is_up() const { return up_; }
  /// Calls visit(stream) for each frame that waits, or of which a rest waits.
  template <class Visit>
  void for_each_waiting(const Visit& visit) const {
    for (const std::vector<Item>& queue : queues_)
      for (const Item& item : queue) visit(item.stream);
    if (rest_) visit(rest_->item.stream);
  }

 private:
  struct Item {
    models::FrameIndex handle;
    models::StreamIndex stream;
    std::uint64_t sequence = 0;
    std::uint32_t length = 0;
    Ps eligible = long_ago;
  };
  struct Fragment {
    Item item;
    models::TrafficClass q = 0;
    Ps start = 0;
    std::uint32_t remaining = 0;  // of the frame when the fragment starts
    Ps occupied = 0;              // by the fragments before
  };
  struct HoldState {
    bool asked = false;
    Ps until = never;
  };
  struct Pending {  // left its queue; the next record says why
    Item item;
    models::TrafficClass q = 0;
  };
  struct Displaced {  // the last one of those that a frame has pushed out
    Item item;
    models::TrafficClass q = 0;
  };

  Item item_of(const SeenFrame& seen) const;
  std::optional<models::DropReason> why_no_room(models::TrafficClass q, std::uint64_t frames, std::uint64_t octets,
                                                const Item& item) const;
  void check_displacing();
  void note_gates(const ListConfig& gates);
  models::TrafficClass class_of(const models::Frame& frame) const;
  bool is_timed(models::TrafficClass q) const { return config_.shaping.is_timed(q); }
  Ps duration_of(std::uint32_t octets) const { return octet_ * (models::preamble_and_sfd.count + Ps{octets}); }
  bool is_shared(models::TrafficClass q) const { return config_.shaping.is_shared(q); }
  /// Express frames come before preemptable ones, and classes that share bandwidth behind all others. Among these
  /// nobody comes first.
  bool comes_before(models::TrafficClass p, models::TrafficClass q) const {
    if (is_preemptable(p) != is_preemptable(q)) return !is_preemptable(p);
    return !is_shared(p) && (is_shared(q) || p > q);
  }
  void fail(const std::string& what) { violations_.add(now_, name_, what); }
  void fail(const Item& item, const std::string& what) {
    fail(wire_checker::name_of(item.stream, item.sequence) + " " + what);
  }
  void check_start(const Item& item, models::TrafficClass q, std::uint32_t octets);
  void check_nobody_is_passed_over(const Item& item, models::TrafficClass q);
  void check_nobody_else_may_start(const Item& item);
  void transmit(const Fragment& fragment);
  void note_turn(const Item& item, models::TrafficClass q);
  void check_turn();
  void report_credit(models::TrafficClass q);
  void drop_pending();
  void check_credits();

  // port_outlook.cpp
  bool gate_open(models::TrafficClass q, const ListMachine& gates) const;
  Ps fit(models::TrafficClass q, Ps from, Ps duration, ListMachine gates) const;
  void follow(models::TrafficClass q, CreditAccount& credit, ListMachine& gates, Ps time) const;
  /// How a class fares from now on, as far as somebody has looked.
  struct Outlook {
    std::optional<CreditAccount> credit;
    ListMachine gates;
  };
  Ps ready_time(models::TrafficClass q, Ps from, Ps eligible, Ps duration) const;
  Ps ready_time(models::TrafficClass q, Ps from, Ps eligible, Ps duration, Outlook& outlook) const;
  bool is_ready(models::TrafficClass q, const Item& item) const;
  HoldState hold_at(Ps time, ListMachine gates) const;
  Ps idle_due(Ps from) const;
  Ps cut_due() const;
  std::optional<std::uint32_t> cut_after(Ps time) const;

  std::string name_;
  models::PortConfig config_;
  Violations& violations_;
  Ps octet_;
  ListMachine gates_;
  bool has_gates_ = false;
  bool may_hold_ = false;
  Ps hold_advance_ = 0;
  std::array<std::optional<bool>, models::traffic_class_count> forced_{};
  std::array<std::optional<CreditAccount>, models::traffic_class_count> credits_;
  ShareAccount shares_;
  std::optional<ShareAccount::PerClass> turn_;  // at this instant a class with a share has started: what could have
  bool somebody_dropped_ = false;               // at this instant
  models::ClassSet displaced_ = 0;       // at this instant: classes that have lost their first frame to one that came
  std::optional<Displaced> displacing_;  // the frame that comes next is to blame
  std::array<Ps, models::traffic_class_count> longest_occupation_{};
  std::uint8_t classes_seen_ = 0;
  std::array<std::vector<Item>, models::traffic_class_count> queues_;
  std::array<std::uint64_t, models::traffic_class_count> octets_{};

  Ps now_ = 0;
  Ps free_at_ = 0;
  Ps last_bit_ = 0;
  Ps due_ = never;  // when something must happen, and what is wrong if it does not
  const char* due_text_ = "";
  bool up_ = true;
  bool cut_wants_reason_ = false;
  std::optional<Fragment> under_way_;  // the last transmission, if its frame is preemptable
  std::optional<Fragment> rest_;
  std::optional<Pending> pending_;
  std::optional<models::TrafficClass> started_class_;  // at this instant
  bool started_is_rest_ = false;
  bool started_is_cut_through_ = false;
  bool somebody_found_no_room_ = false;  // at this instant
  Item started_item_;
};

}  // namespace takt::wire_checker
