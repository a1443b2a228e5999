// SPDX-License-Identifier: Apache-2.0
// What the page may ask: requests of the one address, answered from engine, document and commands; no sockets here.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studio/command.hpp"
#include "studio/document.hpp"
#include "studio/engine.hpp"
#include "studio/timeline.hpp"

namespace takt::studio {

inline constexpr std::size_t most_text = 8'000'000;  ///< octets of a scenario, and of any request
/// What is said of a file with more.
std::string too_large(const std::string& path, std::uintmax_t octets);

struct Request {
  std::function<std::string(const char* name)> parameter;  ///< of the address; empty: not given
  std::string_view body = {};
  static constexpr std::uint64_t no_number = ~std::uint64_t{0};
  std::uint64_t number(
      const char* name) const;  ///< 0 if it is not given, no_number if it is none or too great: nothing has that number
};

struct Answer {
  static constexpr const char* json = "application/json; charset=utf-8";
  static constexpr const char* octets = "application/octet-stream";
  int status = 200;
  std::string body;
  const char* type = json;
};

class Interface {
 public:
  /// `schema` is the JSON Schema of scenarios, `program` the takt that commands are started with. Engine and document
  /// outlive this.
  Interface(Engine& engine, Document& document, std::string schema, std::string program);
  ~Interface();

  struct Route {
    const char* method;
    const char* path;
    Answer (Interface::*answer)(const Request& request);
  };
  static std::span<const Route> routes();
  Answer answer(const Route& route, const Request& request) { return (this->*route.answer)(request); }

  /// What is under way ends soon, and nothing new begins.
  void stop();

 private:
  /// A run of a text that is looked at: as it is, or the worst that was found for a requirement.
  struct Looked {
    std::uint64_t revision = 0;
    std::string run;         // empty, or the number of a requirement, from 0
    std::uint64_t from = 0;  // ps
    auto operator<=>(const Looked&) const = default;
  };
  /// A command of one kind, the last that was asked for.
  struct Errand {
    std::unique_ptr<Command> command;
    std::string store;    // of a study
    std::string problem;  // it could not be started
  };

  Answer schema(const Request& request);
  Answer file(const Request& request);
  Answer save(const Request& request);
  Answer text(const Request& request);
  Answer findings(const Request& request);
  Answer layout(const Request& request);
  Answer keep_layout(const Request& request);
  Answer timeline(const Request& request);
  Answer piece(const Request& request);
  Answer explain(const Request& request);
  Answer studies(const Request& request);
  Answer explore(const Request& request);
  Answer compare(const Request& request);
  Answer study(const Request& request);
  Answer errand(const Request& request);
  Answer end_errand(const Request& request);

  std::shared_ptr<const scenario::Resolved> looked_at(const Request& request, Looked& looked);
  std::shared_ptr<const Timeline> timeline_of(const Request& request, std::string& problem);
  std::function<bool()> interrupted(std::uint64_t revision);
  Answer start(const std::string& name, std::vector<std::string> arguments,
               std::vector<std::shared_ptr<const std::string>> keeps, std::string store = {});

  Engine& engine_;
  Document& document_;
  const std::string schema_;
  const std::string program_;
  std::atomic<bool> ends_ = false;
  std::mutex timelines_mutex_;                                                 // one is made at a time
  std::vector<std::pair<Looked, std::shared_ptr<const Timeline>>> timelines_;  // the last few
  std::mutex errands_mutex_;
  std::map<std::string, Errand> errands_;
};

}  // namespace takt::studio
