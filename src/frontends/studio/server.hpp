// SPDX-License-Identifier: Apache-2.0
// The studio as a browser sees it: on 127.0.0.1 only, for whoever has the token of its address, for no other origin.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "studio/interface.hpp"

namespace takt::studio {

/// What the page is made of; all empty where takt was built without it.
struct Assets {
  std::string_view html;
  std::string_view script;
  std::string_view style;
  bool is_complete() const { return !html.empty() && !script.empty() && !style.empty(); }
};
Assets built_in_assets();

class Server {
 public:
  /// The interface outlives the server; `token` is what the page must have.
  Server(Interface& interface, const Assets& assets, std::string token);
  ~Server();

  /// Takes a port of 127.0.0.1, `port` or any free one for 0. False if it is not to be had.
  bool bind(std::uint16_t port);
  std::uint16_t port() const;
  /// Whom the address is given to may do everything.
  std::string address() const;
  const std::string& token() const;
  /// Answers until stop() is called, from another thread or from a signal's.
  void listen();
  void stop();

 private:
  class Routes;
  std::unique_ptr<Routes> routes_;
};

}  // namespace takt::studio
