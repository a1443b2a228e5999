// The observer of an explored tree: S1, S2 and S4 of each group, S1 and S2 of the tree, by the rules of handshake::TreeObserver, as a small value.
//
// One rule more, which S1 of the tree rests on: a node is Ready in the outer group only after all slaves of its inner group were Ready
// in the run that was started for it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "explore/ghost.hpp"
#include "explore/tree_shape.hpp"

namespace takt::explore {

/// What one participant's part of a node's step means to whoever watches.
struct TreeEffect {
  handshake::Side side = handshake::Side::Outer;
  Effect effect;
  std::uint32_t inner_run = 0;    ///< an inner group was started: its run, and the outer one for which it was
  std::uint32_t outer_run = 0;
  constexpr bool operator==(const TreeEffect&) const = default;
};

class TreeGhost {
 public:
  explicit TreeGhost(const TreeShape& shape);

  PropertySet on_effect(const TreeShape& shape, std::size_t participant, const TreeEffect& effect);
  void on_restart(const TreeShape& shape, std::size_t participant);

  bool operator==(const TreeGhost&) const = default;
  std::uint64_t hash() const;

 private:
  /// Which participants were Ready and Running in a run of the outer group.
  struct Facts {
    std::uint32_t run = 0;
    std::uint16_t ready = 0;
    std::uint16_t running = 0;
    bool operator==(const Facts&) const = default;
  };
  /// For which run of the outer group a run of the inner one was started.
  struct Link {
    std::uint32_t run = 0;
    std::uint32_t outer = 0;
    bool operator==(const Link&) const = default;
  };
  std::uint32_t tree_run(std::size_t group, std::uint32_t run) const;
  bool became_ready(const TreeShape& shape, std::size_t participant, std::uint32_t run);
  PropertySet became_running(const TreeShape& shape, std::size_t participant, std::uint32_t run);

  std::array<Ghost, 2> groups_;
  ByRun<Link> links_;
  ByRun<Facts> facts_;
};

}  // namespace takt::explore
