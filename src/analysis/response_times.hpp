// stub
#pragma once
#include <string>
#include <vector>
#include "analysis/frame_arrivals.hpp"
#include "analysis/host_times.hpp"
namespace takt::analysis {
struct JobSource { FrameArrivals arrivals; Ps work = 0; std::string what; };
std::vector<ThreadTime> response_times(const models::CpuPlan& plan, const std::vector<std::vector<JobSource>>& jobs);
}
