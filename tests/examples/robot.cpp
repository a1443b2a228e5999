// SPDX-License-Identifier: Apache-2.0
// A robot as a slave: it goes half of the way to its target in each cycle and says where it is.
//
//   robot NODE.json      the file of the node, as takt node reads it; "targets" and "actual" are its data sets
#include <array>
#include <csignal>
#include <cstdio>
#include <tuple>

#include "node/data_set_binding.hpp"
#include "node/real_node.hpp"

namespace {

using Joints = std::array<double, 6>;

volatile std::sig_atomic_t stopped = 0;

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, [](int) { stopped = 1; });
  std::signal(SIGTERM, [](int) { stopped = 1; });

  takt::json::Diagnostics mistakes;
  const auto file = takt::node::load_config(argc == 2 ? argv[1] : "robot.json", mistakes);
  std::fputs(mistakes.to_text().c_str(), stderr);
  if (!file) return 2;

  takt::pubsub::DataSet<Joints> targets;
  takt::pubsub::DataSet<std::tuple<Joints, std::uint32_t>> actual;  // joints, and how many targets have come
  takt::node::DataSetBinding data(file->programs[0].endpoint.format->shape());
  if (!data.bind("targets", targets) || !data.bind("actual", actual)) {
    std::fputs("robot: the Program has other data sets\n", stderr);
    return 2;
  }
  targets.on_received([&actual](const Joints& wanted) {
    auto [joints, count] = actual.get();
    for (std::size_t i = 0; i < joints.size(); ++i) joints[i] += (wanted[i] - joints[i]) / 2;
    actual.set({joints, count + 1});
  });

  std::string problem;
  std::string warnings;
  takt::node::Log log(stdout);
  const auto robot = takt::node::RealNode::make(*file, log, {&data}, problem, warnings);
  std::fputs((problem + warnings).c_str(), stderr);
  if (!robot) return 3;
  robot->run([](const void*) { return stopped != 0; }, nullptr);
  return 0;
}
