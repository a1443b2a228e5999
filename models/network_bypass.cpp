// SPDX-License-Identifier: Apache-2.0
// Links that are joined to one where the bypass relay of a station that is down joins its cables, and parted again.
#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "models/network.hpp"
#include "sim/check.hpp"

namespace takt::models {

void Network::set_bypass(NodeIndex node, bool joins) {
  bypassed_.resize(plan_.nodes.size());
  bypassed_[node.value] = joins;
  refresh_joints();
}

/// The ports that the bypass of a node joins, over those of further nodes: nothing if a cable is cut, ends nowhere, or
/// at a node that is down.
std::optional<Network::Joint> Network::joint_at(NodeIndex node) const {
  Joint joint;
  joint.over.push_back(node);
  for (std::uint16_t side = 0; side < 2; ++side) {
    NodeIndex at = node;
    std::uint16_t port = side;
    for (std::size_t steps = 0;; ++steps) {
      const auto link = std::find_if(plan_.links.begin(), plan_.links.end(), [&](const LinkPlan& each) {
        return (each.a.node == at && each.a.port == port) || (each.b.node == at && each.b.port == port);
      });
      if (link == plan_.links.end() || cuts_[static_cast<std::size_t>(link - plan_.links.begin())] > 0 ||
          steps > plan_.nodes.size())
        return std::nullopt;
      const LinkPlan::End& peer = link->a.node == at && link->a.port == port ? link->b : link->a;
      joint.delay += link->delay;
      if (!bypassed_[peer.node.value] || peer.port > 1) {
        if (crashes_[peer.node.value] > 0) return std::nullopt;
        joint.ends[side].end = peer;
        break;
      }
      joint.over.push_back(peer.node);
      at = peer.node;
      port = static_cast<std::uint16_t>(1 - peer.port);
    }
  }
  // Seen from either of two nodes that are bypassed together it is the same.
  if (std::pair(joint.ends[1].end.node.value, joint.ends[1].end.port) <
      std::pair(joint.ends[0].end.node.value, joint.ends[0].end.port))
    std::swap(joint.ends[0], joint.ends[1]);
  return joint;
}

/// Those that are no more end before new ones begin.
void Network::refresh_joints() {
  if (bypassed_.empty()) return;
  std::vector<Joint> wanted;
  for (std::uint32_t n = 0; n < bypassed_.size(); ++n)
    if (bypassed_[n])
      if (const std::optional<Joint> joint = joint_at(NodeIndex{n});
          joint && std::find(wanted.begin(), wanted.end(), *joint) == wanted.end())
        wanted.push_back(*joint);
  for (Joint& joint : joints_)
    if (std::find(wanted.begin(), wanted.end(), joint) == wanted.end()) set_joint(joint, false);
  for (Joint& joint : wanted) {
    auto known = std::find(joints_.begin(), joints_.end(), joint);
    if (known == joints_.end()) {
      open_joints([&](const Joint& other) {
        return std::any_of(other.ends.begin(), other.ends.end(),
                           [&](const JoinedEnd& end) { return end == joint.ends[0] || end == joint.ends[1]; });
      });
      join(joint);
      known = joints_.insert(joints_.end(), joint);
    }
    set_joint(*known, true);
  }
}

void Network::set_joint(Joint& joint, bool up) {
  if (joint.is_up == up) return;
  joint.is_up = up;
  for (const JoinedEnd& each : joint.ends) set_port(each.end, up);
}

void Network::set_port(const LinkPlan::End& end, bool up) {
  mutable_ports(end.node)[end.port].set_link_up(*simulation_, up);
  if (stations_[end.node.value]) stations_[end.node.value]->set_link(end.port, up);
}

void Network::join(Joint& joint) {
  EgressPort* ports[2];
  Link::Reception receptions[2];
  for (std::size_t side = 0; side < 2; ++side) {
    const LinkPlan::End& end = joint.ends[side].end;
    ports[side] = &mutable_ports(end.node)[end.port];
    joint.ends[side].before = ports[side]->link().reception();
    // This end has registered its interest in headers at the link by which it received until now.
    receptions[side] = ports[side]->incoming().reception();
    const sim::Duration fixed = fixed_delay_of(end.node);
    receptions[side].far_end = {component_of(end.node), end.port, joint.delay + fixed, fixed};
  }
  for (std::size_t side = 0; side < 2; ++side) {
    ports[side]->link().redirect(receptions[1 - side]);
    ports[side]->receive_by(ports[1 - side]->link());
  }
}

/// The ends receive by their own cables again.
void Network::open_joints(const std::function<bool(const Joint&)>& which) {
  std::erase_if(joints_, [&](const Joint& joint) {
    if (joint.is_up || !which(joint)) return false;
    for (const JoinedEnd& each : joint.ends) {
      EgressPort& port = mutable_ports(each.end.node)[each.end.port];
      port.link().redirect(each.before);
      for (const LinkPlan& link : plan_.links)
        for (const auto& [own, other] : {std::pair(&link.a, &link.b), std::pair(&link.b, &link.a)})
          if (own->node == each.end.node && own->port == each.end.port)
            port.receive_by(mutable_ports(other->node)[other->port].link());
    }
    return true;
  });
}

}  // namespace takt::models
